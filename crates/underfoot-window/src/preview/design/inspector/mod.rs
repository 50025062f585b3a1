//! The fields of the selection in plain words: made from the descriptions by which its file is read.

mod choice;
mod colour;
mod effect;
mod field;
mod kind;
mod number;
mod place;
mod problems;
mod text;
mod value;
mod words;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{Margin, Panel, RichText, ScrollArea, Sense, Ui, WidgetInfo, vec2};

use super::edited::EditedLayout;
use super::findings::findings_list;
use super::palette::draw_widget;
use super::several::shared_place;
use super::{Pane, Panes};
use crate::edit::{Address, Edit, FieldOrigin, FieldSection, Item};
use crate::preview::PreviewCommand;
use crate::preview::style::{panel_frame, quiet, section};
use effect::Waveforms;
use field::{FieldEdits, ShownField, TypedTexts};
use kind::KindWish;
use problems::{FieldProblem, problems_of};
use underfoot_scene::egui_painter::{Palette, color};
use underfoot_scene::scene::{Theme, in_drawn_order};
use words::capital;

pub(super) use field::unit_name;
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

/// Width of the inspector, in points.
const INSPECTOR_PX: f32 = 330.0;

impl Inspector {
    /// Shows the inspector.
    pub(super) fn panel(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        palette: &mut Palette,
        edited: &mut EditedLayout,
        panes: &mut Panes,
    ) {
        let frame = panel_frame(theme, Margin { left: 14, right: 6, top: 0, bottom: 6 });
        // A fixed width, whatever the content: the floor beside the panel must not move under the pointer.
        let panel = Panel::right("inspector").frame(frame).resizable(false);
        panel.exact_size(INSPECTOR_PX).show(ui, |ui| {
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
        let is_edited = wanted.is_some();
        self.apply(edited, &record, wanted);
        if !is_edited && item.is_some_and(|item| item.is_group) {
            self.members(ui, theme, palette, edited, &record);
        }
    }

    /// Lists the members of a group and the common fields of its controls.
    fn members(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        palette: &mut Palette,
        edited: &mut EditedLayout,
        group: &Address,
    ) {
        let is_member = |item: &&Item| item.record.split().is_some_and(|(parent, ..)| parent == *group);
        let members: Vec<Item> = edited.items.iter().filter(is_member).cloned().collect();
        let count = members.len();
        section(ui, theme, &if count == 1 { "1 member".into() } else { format!("{count} members") }, |_| {});
        let mut chosen = None;
        for item in members {
            let what = if item.is_group { "Group" } else { "Control" };
            let name = format!("{what} {}", item.name);
            let row = ui.add(egui::Button::selectable(false, &name).truncate());
            row.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Member: {name}")));
            if row.on_hover_text("Select it alone").clicked() {
                chosen = Some(item.record);
            }
        }
        section(ui, theme, "In common", |_| {});
        self.common_fields(ui, theme, palette, edited, std::slice::from_ref(group));
        if let Some(record) = chosen {
            edited.select_only(record);
        }
    }

    /// The fields that all controls of `records` share, those in groups included; an edit applies to all of them.
    fn common_fields(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        palette: &mut Palette,
        edited: &mut EditedLayout,
        records: &[Address],
    ) {
        let mut controls: Vec<&Item> =
            records.iter().flat_map(|record| edited.document.controls_in(&edited.items, record)).collect();
        controls.dedup();
        let all: Vec<Address> = controls.iter().map(|item| item.record.clone()).collect();
        let Some(first) = all.first().cloned() else {
            ui.label(quiet(theme, "Nothing: none of these is a control."));
            return;
        };
        let key = (all.clone(), edited.document.revision());
        if self.common.of.as_ref() != Some(&key) {
            let sections = edited.document.common(&controls);
            self.common = Shown { sections, of: Some(key) };
            self.typed.clear();
        }
        let shown = std::mem::take(&mut self.common.sections);
        self.shared = all;
        let wanted = self.sections(ui, theme, palette, edited, &first, &shown);
        self.apply(edited, &first, wanted);
        self.shared.clear();
        self.common.sections = shown;
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

    /// Shows sections of fields; returns the edits of one, if any.
    fn sections(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        palette: &mut Palette,
        edited: &EditedLayout,
        record: &Address,
        shown: &[FieldSection],
    ) -> FrameEdits {
        let is_shared = !self.shared.is_empty();
        let problems = self.problems(theme, edited, record);
        let has = |part: &FieldSection, problem: &FieldProblem| {
            part.properties.iter().any(|one| problem.is_of(one))
        };
        let mut wanted: FrameEdits = None;
        for problem in problems.iter().filter(|problem| !shown.iter().any(|part| has(part, problem))) {
            let mend =
                problem.show(ui, theme).map(|edits| (String::new(), FieldEdits { edits, stroke: None }));
            wanted = mend.or(wanted);
        }
        for (number, part) in shown.iter().enumerate() {
            let own: Vec<&FieldProblem> = problems.iter().filter(|problem| has(part, problem)).collect();
            let mut ink = theme.ink;
            let mut title = capital(&part.title);
            if let Some(first) = own.first() {
                ink = first.colour;
                title = format!("{title} ({})", own.len());
            }
            let heading = RichText::new(title).strong().color(color(ink));
            let id = ("part", number, is_shared);
            egui::CollapsingHeader::new(heading).id_salt(id).default_open(number < 2).show(ui, |ui| {
                ui.spacing_mut().item_spacing.x = 6.0;
                self.source(ui, theme, edited, part);
                for property in &part.properties {
                    let is_led = std::mem::take(&mut self.is_led);
                    // The row with the keyboard focus keeps it when a warning appears or disappears above.
                    let id = egui::Id::unique(("field", record.to_string(), &property.name, is_shared));
                    let field = ShownField { theme, edited, record, property, is_shared };
                    let row = ui.scope_builder(egui::UiBuilder::new().scope_id(id), |ui| {
                        self.property(ui, &field, &own, is_led)
                    });
                    let edits = row.inner.map(|edits| (property.name.clone(), edits));
                    wanted = edits.or(wanted.take());
                    if property.name == "look.ink" && !is_shared {
                        faces(ui, &field, palette);
                    }
                }
            });
        }
        wanted
    }

    /// The line that explains the marks of a section, with a link to the kind from which values come.
    fn source(&mut self, ui: &mut Ui, theme: &Theme, edited: &EditedLayout, part: &FieldSection) {
        let kinds = part.properties.iter().filter_map(|property| match &property.origin {
            FieldOrigin::Kind(kind) => Some(kind),
            _ => None,
        });
        let Some(kind) = kinds.into_iter().next() else { return };
        ui.horizontal(|ui| {
            ui.set_height(16.0);
            let origin = FieldOrigin::Kind(kind.clone());
            field::mark(ui, theme, &origin);
            ui.label(quiet(theme, "from").size(11.5));
            let name = words::choice(kind);
            let link = ui.link(RichText::new(&name).size(11.5));
            let title = &part.title;
            link.widget_info(|| WidgetInfo::labeled(Role::Link, true, format!("Kind of {title}: {name}")));
            if link.on_hover_text("Show this kind").clicked() {
                self.kind = Some((kind.clone(), edited.selected.clone()));
            }
            ui.add_space(6.0);
            field::mark(ui, theme, &FieldOrigin::Written);
            ui.label(quiet(theme, "set here").size(11.5));
        });
    }

    /// Shows one field with its problems; returns its edits, if any.
    fn property(
        &mut self,
        ui: &mut Ui,
        field: &ShownField<'_>,
        problems: &[&FieldProblem],
        is_led: bool,
    ) -> Option<FieldEdits> {
        let mut wanted = None;
        ui.horizontal(|ui| {
            field::name(ui, field);
            let (edits, editor) = ui
                .scope(|ui| {
                    ui.visuals_mut().override_text_color = field::value_ink(field);
                    value::value(ui, field, &mut self.typed)
                })
                .inner;
            wanted = edits;
            if is_led {
                editor.request_focus();
            }
            if editor.gained_focus() {
                editor.scroll_to_me(None);
            }
            wanted = field::reset(ui, field).map(FieldEdits::from).or(wanted.take());
        });
        wanted = choice::variant_fields(ui, field).or(wanted);
        if !field.is_shared {
            self.wish = effect::picture(ui, field, &mut self.waves).or(self.wish.take());
        }
        for problem in problems.iter().filter(|problem| problem.is_of(field.property)) {
            let mend = problem.show(ui, field.theme).map(|edits| FieldEdits { edits, stroke: None });
            wanted = mend.or(wanted);
        }
        wanted
    }
}

/// The control at rest and while it is pressed, with the contrast of its text.
fn faces(ui: &mut Ui, field: &ShownField<'_>, palette: &mut Palette) {
    let Some(widget) = field.widget() else { return };
    ui.horizontal(|ui| {
        let width = 0.5 * (ui.available_width() - ui.spacing().item_spacing.x);
        for (is_pressed, moment) in [(false, "at rest"), (true, "while pressed")] {
            let (rect, shown) = ui.allocate_exact_size(vec2(width, 56.0), Sense::hover());
            shown.widget_info(|| WidgetInfo::labeled(Role::Image, true, format!("Look {moment}")));
            shown.on_hover_text(capital(moment));
            draw_widget(ui, field.theme, palette, &field.edited.document, widget, is_pressed, rect);
        }
    });
    colour::contrast(ui, field);
}
