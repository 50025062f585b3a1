//! The fields of the selection in plain words: made from the descriptions by which its file is read.

mod choice;
mod colour;
mod common;
mod effect;
mod field;
mod kind;
mod number;
mod place;
mod problems;
mod sections;
mod send_choices;
mod send_devices;
mod send_texts;
mod sends;
mod text;
mod value;
mod words;

use eframe::egui::{Margin, Panel, ScrollArea, Ui};

use super::edited::EditedLayout;
use super::findings::findings_list;
use super::several::shared_place;
use super::{Pane, Panes};
use crate::edit::{Address, Edit, FieldSection, RecordList};
use crate::preview::PreviewCommand;
use crate::preview::handheld::panel_at;
use crate::preview::stage::{INSPECTOR_PX, StageOfWindow};
use crate::preview::style::{panel_frame, quiet, section};
use effect::Waveforms;
use field::{FieldEdits, TypedTexts};
use kind::KindWish;
use problems::{FieldProblem, problems_of};
use underfoot_scene::egui_painter::Palette;
use underfoot_scene::scene::{Theme, in_drawn_order};

pub(super) use field::{EDITOR_PX, unit_name, unmarked_name};
pub(super) use words::capital;
#[cfg(test)]
pub(super) use words::label;

/// The state of the inspector.
#[derive(Default)]
pub(super) struct Inspector {
    /// The texts of fields in which the user is typing.
    typed: TypedTexts,
    /// The fields of one record, and the common fields of several.
    own: Shown,
    common: Shown,
    /// The records to which an edit of the first one applies, while common fields are on display.
    shared: Vec<Address>,
    /// Whether the first field gets the keyboard in this frame.
    is_led: bool,
    waves: Waveforms,
    /// The last refused edit of a field.
    refused: Option<RefusedEdit>,
    /// The kind on display instead of the fields, and the selection of which it is one.
    kind: Option<(String, Vec<Address>)>,
    /// The command that waits to be sent to the floor.
    pub(super) wish: Option<PreviewCommand>,
}

/// The fields on display, with their records and revision.
#[derive(Default)]
struct Shown {
    sections: Vec<FieldSection>,
    of: Option<(Vec<Address>, u64)>,
}

/// An edit of a field that could not be made.
struct RefusedEdit {
    record: Address,
    field: String,
    reason: String,
    /// The revision of the layout, which an edit that succeeds changes.
    revision: u64,
}

/// The edits of one frame, and the field from which they come.
type FrameEdits = Option<(String, FieldEdits)>;

impl Inspector {
    /// Shows the inspector beside the floor on `stage`.
    pub(super) fn panel(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        palette: &mut Palette,
        edited: &mut EditedLayout,
        panes: &mut Panes,
        stage: &StageOfWindow,
    ) {
        let frame = panel_frame(theme, Margin { left: 14, right: 6, top: 0, bottom: 6 });
        // A fixed width, whatever the content: the floor beside the panel must not move under the pointer.
        let panel = panel_at(stage.sheet(), || {
            Panel::right("inspector").resizable(false).exact_size(INSPECTOR_PX.min(stage.widest()))
        });
        panel.frame(frame).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.set_width(ui.available_width() - 8.0);
                // The cached fields belong to a revision, and so must the records of which they are made.
                edited.refresh();
                self.waves.begin();
                if !self.shown_kind(ui, theme, palette, edited) {
                    self.show(ui, theme, palette, edited, panes);
                }
            });
        });
    }

    /// Shows the kind that the user opened; returns whether one is on display.
    fn shown_kind(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        palette: &mut Palette,
        edited: &mut EditedLayout,
    ) -> bool {
        let Some((name, _)) = self.kind.as_ref().filter(|(_, selected)| *selected == edited.selected) else {
            self.kind = None;
            return false;
        };
        let Some(kind) = edited.document.all_kinds().get(name) else { return false };
        match kind::show(ui, theme, palette, edited, kind) {
            Some(KindWish::Back) => self.kind = None,
            Some(KindWish::Select(record)) => edited.select_only(record),
            None => {}
        }
        true
    }

    fn show(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        palette: &mut Palette,
        edited: &mut EditedLayout,
        panes: &mut Panes,
    ) {
        self.is_led = panes.leads_to(Pane::Fields);
        let record = match &edited.selected[..] {
            [] => Address::LAYOUT,
            [record] => record.clone(),
            several => {
                section(ui, theme, &format!("{} selected", several.len()), |_| {});
                ui.label(quiet(theme, "Arrange, move, duplicate or delete them together."));
                let several = several.to_vec();
                shared_place(ui, theme, edited, &mut self.typed);
                return self.common_fields(ui, theme, palette, edited, &several);
            }
        };
        let item = edited.item(&record).cloned();
        let title = match (&item, record.split()) {
            (Some(item), _) if item.is_group => format!("Group {}", item.name),
            (Some(item), _) if !item.name.is_empty() => in_drawn_order(&item.name).into(),
            (_, Some(_)) => record.to_string(),
            _ => "The layout".to_owned(),
        };
        section(ui, theme, &title, |_| {});
        if let Some(item) = &item {
            let (at, size) = (item.area.min, item.area.size() * 100.0);
            let text = format!("{:.1} x {:.1} cm, {:.3} m east, {:.3} m north", size.x, size.y, at.x, at.y);
            ui.label(quiet(theme, text));
        }
        if record == Address::LAYOUT {
            findings_list(ui, theme, edited);
        }
        let key = (vec![record.clone()], edited.document.revision());
        if self.own.of.as_ref() != Some(&key) {
            let sections = edited.document.properties(&record, item.as_ref());
            self.own = Shown { sections, of: Some(key) };
            self.typed.clear();
        }
        let shown = std::mem::take(&mut self.own.sections);
        let wanted = self.sections(ui, theme, palette, edited, &record, &shown);
        self.own.sections = shown;
        let widget = item.as_ref().filter(|item| !item.is_group && !item.widgets.is_empty());
        let widget = widget.and_then(|item| edited.layout().widgets.get(item.widgets.start)).cloned();
        let wanted = match widget.filter(|_| record.list() == Some(RecordList::Widgets)) {
            Some(widget) => self.sends(ui, theme, edited, &record, &widget).or(wanted),
            None => wanted,
        };
        let is_edited = wanted.is_some();
        self.apply(edited, &record, wanted);
        if !is_edited && item.is_some_and(|item| item.is_group) {
            self.members(ui, theme, palette, edited, &record);
        }
    }

    /// Applies the edits of a field on display to each record that the field represents, or keeps the reason why it
    /// cannot.
    fn apply(&mut self, edited: &mut EditedLayout, record: &Address, wanted: FrameEdits) {
        let Some((field, FieldEdits { edits, stroke })) = wanted else { return };
        let shared = &self.shared;
        let for_all = |edit: Edit| -> Vec<Edit> {
            match edit {
                Edit::Set { field, value, .. } if !shared.is_empty() => {
                    shared.iter().map(|record| Edit::set(record, &field, value.clone())).collect()
                }
                Edit::Unset { field, .. } if !shared.is_empty() => {
                    shared.iter().map(|record| Edit::unset(record, &field)).collect()
                }
                Edit::Set { record, field, value } if field == "id" => {
                    vec![Edit::Rename { record, id: value.trim_matches('"').to_owned() }]
                }
                other => vec![other],
            }
        };
        let edits: Vec<Edit> = edits.into_iter().flat_map(for_all).collect();
        if edited.edit_in(&edits, stroke) {
            self.typed.remove(&field);
            self.refused = None;
        } else if let Some(message) = &edited.message {
            let (reason, revision) = (message.text.clone(), edited.document.revision());
            self.refused = Some(RefusedEdit { record: record.clone(), field, reason, revision });
        }
    }

    /// The problems of `record`, the last refusal of one of its fields among them; those of several records stand
    /// with each of these alone.
    fn problems(&self, theme: &Theme, edited: &EditedLayout, record: &Address) -> Vec<FieldProblem> {
        let is_alone = self.shared.is_empty();
        let mut all = if is_alone { problems_of(theme, edited, record) } else { Vec::new() };
        let now = edited.document.revision();
        let refused =
            self.refused.as_ref().filter(|refused| refused.record == *record && refused.revision == now);
        all.extend(refused.map(|refused| FieldProblem::refused(theme, &refused.field, &refused.reason)));
        all
    }
}
