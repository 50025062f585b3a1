//! Places of review remarks about a layout's controls in the text.

use std::ops::Range;

use super::diagnostic::Diagnostics;
use super::pairs::Limits;
use super::places::Places;
use super::problem::Problem;
use super::reader::Reader;
use super::source::Source;
use underfoot_format::diagnostic::Severity;

/// The aspect of a control that a remark concerns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ControlPart {
    /// The control as a whole.
    Id,
    /// The control's position.
    Place,
    /// The control's size.
    Size,
    /// The force that presses it.
    Press,
    /// The step between its values.
    Step,
    /// The control's text.
    Label,
    /// Its colours.
    Look,
}

/// A remark of a review about one control of a layout.
#[derive(Clone, Copy, Debug)]
pub struct Remark<'a> {
    /// Code of the rule that the control breaks, such as `U101`.
    pub code: &'static str,
    /// Severity of the problem.
    pub severity: Severity,
    /// Index of the control in the layout's widgets.
    pub widget: usize,
    /// The aspect of the control that the remark concerns.
    pub part: ControlPart,
    /// The problem, in one clause.
    pub message: &'a str,
    /// The text beside the carets.
    pub expected: &'a str,
    /// Advice on how to solve the problem.
    pub help: Option<&'a str>,
}

impl Places {
    /// Returns the bytes of this part of the control at `index` in the text, without a byte-order mark.
    fn span(&self, index: usize, part: ControlPart) -> Range<usize> {
        let Some(written) = self.widgets.get(index) else { return 0..0 };
        let own = match part {
            ControlPart::Id => None,
            ControlPart::Place => Some(&written.at),
            ControlPart::Size => written.size.as_ref(),
            ControlPart::Press => written.press.as_ref(),
            ControlPart::Step => written.step.as_ref(),
            ControlPart::Label => written.label.as_ref(),
            ControlPart::Look => written.look.as_ref(),
        };
        // A value that is not written here comes from the kind, or for a size from the neighbour.
        let kind = matches!(part, ControlPart::Press | ControlPart::Step | ControlPart::Look)
            .then_some(&written.kind);
        own.or(kind).unwrap_or(&written.id).clone()
    }

    /// Returns the remarks at their places in the file, in the order of the text.
    ///
    /// Similar remarks about the controls of one grid are merged into the first, with their number.
    #[must_use]
    pub fn locate<'a>(&self, remarks: impl IntoIterator<Item = Remark<'a>>) -> Diagnostics {
        // The text has been read before, so it is not too large.
        let Ok(source) = Source::new(&self.name, &self.text) else { return Diagnostics::default() };
        let reader = Reader::new(&source, "Layout", Limits::LAYOUT);
        let mut kept: Vec<(Remark<'_>, Option<usize>, usize)> = Vec::new();
        for remark in remarks {
            let grid = self.widgets.get(remark.widget).and_then(|written| written.repeat.as_ref());
            let grid = grid.map(|repeat| repeat.start);
            let alike = kept.iter_mut().find(|(first, its_grid, _)| {
                grid.is_some() && *its_grid == grid && first.code == remark.code
            });
            match alike {
                Some((_, _, count)) => *count += 1,
                None => kept.push((remark, grid, 1)),
            }
        }
        let list = kept.into_iter().flat_map(|(remark, _, count)| {
            let span = self.span(remark.widget, remark.part);
            let mut message = remark.message.to_owned();
            if count > 1 {
                message.push_str(&format!(" (and {} more of its grid)", count - 1));
            }
            let problem = Problem { severity: remark.severity, ..Problem::error(span, message) };
            let problem = problem.expected(remark.expected).help_if(remark.help.map(str::to_owned));
            let located = reader.only(problem).into_iter();
            located.map(move |problem| problem.with_code(remark.code))
        });
        Diagnostics::new(list.collect(), std::iter::empty())
    }
}
