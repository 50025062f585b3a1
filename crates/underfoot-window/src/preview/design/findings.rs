//! The list of the layout's problems, each with its repair.

use eframe::egui::accesskit::Role;
use eframe::egui::{self, RichText, Ui, WidgetInfo};

use super::edited::EditedLayout;
use crate::edit::{Address, Mend, mend, mend_all, mend_warning, mends_together};
use crate::preview::style::{quiet, section};
use underfoot_format::diagnostic::Severity;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// One problem of the layout.
struct ProblemRow {
    record: Option<Address>,
    severity: Severity,
    text: String,
    mend: Option<Mend>,
    /// Whether *Mend all* looks for a repair, such as moves of several controls.
    is_mendable: bool,
}

/// The problems of one revision, most severe first.
#[derive(Default)]
pub(super) struct Problems {
    of: Option<u64>,
    rows: Vec<ProblemRow>,
}

/// Lists all problems: a click on one selects its record, a button repairs it; another repairs all that it can, as one
/// step.
pub(super) fn findings_list(ui: &mut Ui, theme: &Theme, edited: &mut EditedLayout) {
    refresh(edited);
    let count = edited.problems.rows.len();
    if count == 0 {
        return;
    }
    section(ui, theme, &if count == 1 { "1 problem".into() } else { format!("{count} problems") }, |_| {});
    let mendable = edited.problems.rows.iter().filter(|row| row.is_mendable).count();
    let all = egui::Button::new(format!("Mend all ({mendable} of {count})"));
    let is_all = ui
        .add_enabled(mendable > 0, all)
        .on_hover_text(
            "Moves controls together where one move is not enough; what it cannot mend stays in the list",
        )
        .on_disabled_hover_text("None of these has only one repair: change the controls")
        .clicked();
    let (mut selected, mut chosen) = (None, None);
    for (number, row) in edited.problems.rows.iter().enumerate() {
        let colour = color(if row.severity == Severity::Error { theme.fault } else { theme.warning });
        ui.push_id(("problem", number), |ui| {
            let text = RichText::new(&row.text).color(colour);
            let shown = ui.add_enabled(row.record.is_some(), egui::Button::selectable(false, text).wrap());
            shown.widget_info(|| {
                WidgetInfo::labeled(Role::Button, row.record.is_some(), format!("Problem: {}", row.text))
            });
            if shown.clicked() {
                selected.clone_from(&row.record);
            }
            match &row.mend {
                Some(mend) => {
                    let button = ui.button(&mend.name);
                    button.widget_info(|| {
                        WidgetInfo::labeled(Role::Button, true, format!("{}: {}", mend.name, row.text))
                    });
                    if button.clicked() {
                        chosen = Some(mend.clone());
                    }
                }
                None if row.is_mendable => {
                    drop(ui.label(quiet(theme, "only with others: see above").size(11.5)));
                }
                None => drop(ui.label(quiet(theme, "yours to decide").size(11.5))),
            }
        });
    }
    if let Some(record) = selected {
        edited.select_only(record);
    }
    if let Some(mend) = chosen {
        edited.edit(&mend.edits);
    }
    if is_all {
        repair_all(edited);
    }
}

/// Repairs everything that has a repair, as one step of undo.
fn repair_all(edited: &mut EditedLayout) {
    let count = edited.problems.rows.len();
    let Some((text, mended)) = mend_all(&edited.document) else {
        return edited.complain("every repair would cause another problem: move the controls yourself");
    };
    match edited.document.write(&text, None) {
        Ok(()) if mended == count => edited.say(format!("{mended} mended")),
        Ok(()) => edited.say(format!("{mended} mended, {} are yours to decide", count - mended)),
        Err(problems) => edited.complain(problems.to_string()),
    }
}

/// Reviews the layout again if it has changed.
fn refresh(edited: &mut EditedLayout) {
    edited.refresh();
    let revision = edited.document.revision();
    if edited.problems.of == Some(revision) {
        return;
    }
    let document = &edited.document;
    let found = edited.findings.iter().map(|finding| {
        let mend = mend(document, finding, &edited.items);
        ProblemRow {
            record: document.found_in(finding),
            severity: finding.severity,
            text: format!("{}: {}; {}", finding.rule.code, finding.message, finding.expected),
            is_mendable: mend.is_some() || mends_together(finding),
            mend,
        }
    });
    let told = edited.told().map(|problem| {
        let mend = mend_warning(document, problem, &edited.items);
        ProblemRow {
            record: document.told_of(problem),
            severity: problem.severity,
            text: format!("{}: {}", problem.message, problem.expected),
            is_mendable: mend.is_some(),
            mend,
        }
    });
    let mut rows: Vec<ProblemRow> = found.chain(told).collect();
    rows.sort_by_key(|row| row.severity);
    edited.problems = Problems { of: Some(revision), rows };
}
