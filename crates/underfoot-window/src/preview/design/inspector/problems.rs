//! Problems of a record, shown at the fields to which they belong.

use eframe::egui;
use eframe::egui::{RichText, Ui};

use super::super::edited::EditedLayout;
use crate::edit::{Address, Edit, Property, mend};
use crate::preview::style::quiet;
use underfoot::layout::Colour;
use underfoot_format::diagnostic::Severity;
use underfoot_scene::egui_painter::color;
use underfoot_scene::ergonomics::Part;
use underfoot_scene::scene::Theme;

/// A problem of a record.
pub(super) struct FieldProblem {
    /// The name of its field in files; empty for the record as a whole.
    pub(super) field: String,
    pub(super) colour: Colour,
    pub(super) text: String,
    help: Option<String>,
    /// The source of the rule, on hover.
    source: &'static str,
    /// The repair, in words and as edits.
    mend: Option<(String, Vec<Edit>)>,
}

impl FieldProblem {
    /// The reason why an edit of the field called `name` was refused.
    pub(super) fn refused(theme: &Theme, name: &str, reason: &str) -> Self {
        let text = format!("Not changed: {reason}");
        Self { field: name.into(), colour: theme.fault, text, help: None, source: "", mend: None }
    }

    /// Whether it stands at this field.
    pub(super) fn is_of(&self, property: &Property) -> bool {
        !self.field.is_empty() && self.field == property.name
    }

    /// Shows it; returns the edits of its repair if the user wants them.
    pub(super) fn show(&self, ui: &mut Ui, theme: &Theme) -> Option<Vec<Edit>> {
        let text = RichText::new(&self.text).size(12.0).color(color(self.colour));
        let label = ui.add(egui::Label::new(text).wrap());
        if !self.source.is_empty() {
            label.on_hover_text(self.source);
        }
        if let Some(help) = &self.help {
            ui.add(egui::Label::new(quiet(theme, help).size(12.0)).wrap());
        }
        let (name, edits) = self.mend.as_ref()?;
        ui.button(format!("{name}: do it")).clicked().then(|| edits.clone())
    }
}

/// The findings and warnings about `record`, with a button for each repair.
pub(super) fn problems_of(theme: &Theme, edited: &EditedLayout, record: &Address) -> Vec<FieldProblem> {
    let document = &edited.document;
    let own = edited.findings.iter().filter(|finding| document.found_in(finding).as_ref() == Some(record));
    let found = own.map(|finding| FieldProblem {
        field: field_of(finding.part).into(),
        colour: if finding.severity == Severity::Error { theme.fault } else { theme.warning },
        text: format!("{}: {}; {}", finding.rule.code, finding.message, finding.expected),
        help: finding.help.clone(),
        source: finding.rule.source,
        mend: mend(document, finding, &edited.items).map(|mend| (mend.name, mend.edits)),
    });
    let told = edited.told().filter(|problem| document.told_of(problem).as_ref() == Some(record));
    let told = told.map(|problem| FieldProblem {
        field: field_at(&problem.field).into(),
        colour: theme.warning,
        text: format!("{}: {}", problem.message, problem.expected),
        help: problem.help.clone(),
        source: "",
        mend: None,
    });
    found.chain(told).collect()
}

/// The field of a record that a finding concerns; empty for the record as a whole.
fn field_of(part: Part) -> &'static str {
    match part {
        Part::Id => "",
        Part::Place => "at",
        Part::Size => "size",
        Part::Press => "press_n",
        Part::Step => "step",
        Part::Label => "label",
        Part::Look => "look.ink",
    }
}

/// The field of a record at the end of a path such as `pages[0].widgets[2].look.face`.
fn field_at(path: &str) -> &str {
    path.rsplit_once("].").map_or("", |(_, field)| field)
}

#[cfg(test)]
mod tests {
    use super::field_at;

    #[test]
    fn a_path_ends_with_the_field_of_its_record() {
        assert_eq!(field_at("pages[0].widgets[2].look.face"), "look.face");
        assert_eq!((field_at("widgets[2]"), field_at("")), ("", ""));
    }
}
