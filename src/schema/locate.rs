//! Places of review findings about a layout's controls in the text.

use std::ops::Range;

use super::diagnostic::Diagnostics;
use super::pairs::Limits;
use super::places::Places;
use super::problem::Problem;
use super::reader::Reader;
use super::source::Source;
use crate::ergonomics::{Finding, Part};

impl Places {
    /// Returns the bytes of this part of the control at `index` in the text, without a byte-order mark.
    fn span(&self, index: usize, part: Part) -> Range<usize> {
        let Some(written) = self.widgets.get(index) else { return 0..0 };
        let own = match part {
            Part::Id => None,
            Part::Place => Some(&written.at),
            Part::Size => written.size.as_ref(),
            Part::Press => written.press.as_ref(),
            Part::Step => written.step.as_ref(),
            Part::Label => written.label.as_ref(),
            Part::Look => written.look.as_ref(),
        };
        // A value that is not written here comes from the kind, or for a size from the neighbour.
        let kind = matches!(part, Part::Press | Part::Step | Part::Look).then_some(&written.kind);
        own.or(kind).unwrap_or(&written.id).clone()
    }

    /// Returns the findings at their places in the file, in the order of the text.
    ///
    /// Similar findings about the controls of one grid are merged into the first, with their number.
    #[must_use]
    pub fn locate(&self, findings: &[Finding]) -> Diagnostics {
        // The text has been read before, so it is not too large.
        let Ok(source) = Source::new(&self.name, &self.text) else { return Diagnostics::default() };
        if findings.is_empty() {
            return Diagnostics::default();
        }
        let reader = Reader::new(&source, "Layout", Limits::LAYOUT);
        let mut kept: Vec<(&Finding, Option<usize>, usize)> = Vec::new();
        for finding in findings {
            let grid = self.widgets.get(finding.widget).and_then(|written| written.repeat.as_ref());
            let grid = grid.map(|repeat| repeat.start);
            let alike = kept.iter_mut().find(|(first, its_grid, _)| {
                grid.is_some() && *its_grid == grid && first.rule.code == finding.rule.code
            });
            match alike {
                Some((_, _, count)) => *count += 1,
                None => kept.push((finding, grid, 1)),
            }
        }
        let list = kept.into_iter().flat_map(|(finding, _, count)| {
            let span = self.span(finding.widget, finding.part);
            let mut message = finding.message.clone();
            if count > 1 {
                message.push_str(&format!(" (and {} more of its grid)", count - 1));
            }
            let problem = Problem { severity: finding.severity, ..Problem::error(span, message) };
            let problem = problem.expected(finding.expected.clone()).help_if(finding.help.clone());
            let located = reader.only(problem).into_iter();
            located.map(|problem| problem.with_code(finding.rule.code))
        });
        Diagnostics::new(list.collect(), std::iter::empty())
    }
}
