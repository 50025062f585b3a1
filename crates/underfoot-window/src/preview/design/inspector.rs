//! The fields of the selection: made from the descriptions by which its file is read.

use std::collections::HashMap;
use std::sync::Arc;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{Margin, Panel, RichText, ScrollArea, Ui, WidgetInfo};

use super::edited::EditedLayout;
use super::findings::findings_list;
use super::several::shared_place;
use super::{Pane, Panes};
use crate::edit::{Address, Document, Edit, FieldOrigin, FieldSection, Item, Property};
use crate::preview::PreviewCommand;
use crate::preview::style::{panel_frame, quiet, section};
use underfoot::feel::{Effect, Feel, Gesture};
use underfoot::layout::Widget;
use underfoot_format::diagnostic::Severity;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::{Theme, in_drawn_order};

/// The state of the inspector.
#[derive(Default)]
pub(super) struct Inspector {
    /// The text of fields in which the user is typing.
    pub(super) typed: HashMap<String, String>,
    /// The fields of one record, and the common fields of several.
    own: Shown,
    common: Shown,
    /// The records to which an edit of the first one applies, while common fields are on display.
    shared: Vec<Address>,
    /// The command that waits to be sent to the floor.
    pub(super) wish: Option<PreviewCommand>,
}

/// The fields on display, with their records and revision.
#[derive(Default)]
struct Shown {
    sections: Vec<FieldSection>,
    of: Option<(Vec<Address>, u64)>,
}

/// Width of the inspector, in points.
const INSPECTOR_PX: f32 = 330.0;

/// Width of a field's name, in points.
const NAME_PX: f32 = 96.0;

/// Height of a row, in points.
pub(super) const ROW_PX: f32 = 24.0;

/// Fields that every record must keep.
const KEPT: [&str; 3] = ["id", "kind", "at"];

impl Inspector {
    /// Shows the inspector.
    pub(super) fn panel(&mut self, ui: &mut Ui, theme: &Theme, edited: &mut EditedLayout, panes: &mut Panes) {
        let frame = panel_frame(theme, Margin { left: 14, right: 6, top: 0, bottom: 6 });
        // A fixed width, whatever the content: the floor beside the panel must not move under the pointer.
        let panel = Panel::right("inspector").frame(frame).resizable(false);
        panel.exact_size(INSPECTOR_PX).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.set_width(ui.available_width() - 8.0);
                self.show(ui, theme, edited, panes);
            });
        });
    }

    fn show(&mut self, ui: &mut Ui, theme: &Theme, edited: &mut EditedLayout, panes: &mut Panes) {
        // The cached fields belong to a revision, and so must the records of which they are made.
        edited.refresh();
        let is_led = panes.leads_to(Pane::Fields);
        let record = match &edited.selected[..] {
            [] => Address::LAYOUT,
            [record] => record.clone(),
            several => {
                section(ui, theme, &format!("{} selected", several.len()), |_| {});
                ui.label(quiet(theme, "Arrange, move, duplicate or delete them together."));
                let several = several.to_vec();
                shared_place(ui, theme, edited, &mut self.typed);
                return self.common_fields(ui, theme, edited, &several, is_led);
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
        problems_of(ui, theme, edited, &record);
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
        let wanted = self.sections(ui, theme, edited, &record, &shown, is_led);
        self.own.sections = shown;
        if let Some(edit) = wanted {
            edited.edit_in(&[edit], None);
        } else if item.is_some_and(|item| item.is_group) {
            self.members(ui, theme, edited, &record);
        }
    }

    /// Lists the members of a group and the common fields of its controls.
    fn members(&mut self, ui: &mut Ui, theme: &Theme, edited: &mut EditedLayout, group: &Address) {
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
        self.common_fields(ui, theme, edited, std::slice::from_ref(group), false);
        if let Some(record) = chosen {
            edited.select_only(record);
        }
    }

    /// The fields that all controls of `records` share, those in groups included; an edit applies to all of them.
    fn common_fields(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        edited: &mut EditedLayout,
        records: &[Address],
        is_led: bool,
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
        let wanted = self.sections(ui, theme, edited, &first, &shown, is_led);
        if let Some(edit) = wanted {
            self.edit_shared(edited, edit, None);
        }
        self.shared.clear();
        self.common.sections = shown;
    }

    /// Applies an edit of a field on display to each record that the field represents.
    pub(super) fn edit_shared(&self, edited: &mut EditedLayout, edit: Edit, stroke: Option<u64>) {
        let shared = &self.shared;
        let edits: Vec<Edit> = match &edit {
            Edit::Set { field, value, .. } if !shared.is_empty() => {
                shared.iter().map(|record| Edit::set(record, field, value.clone())).collect()
            }
            Edit::Unset { field, .. } if !shared.is_empty() => {
                shared.iter().map(|record| Edit::unset(record, field)).collect()
            }
            _ => vec![edit],
        };
        edited.edit_in(&edits, stroke);
    }

    /// Shows sections of fields; returns the edit of one, if any.
    fn sections(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        edited: &mut EditedLayout,
        record: &Address,
        shown: &[FieldSection],
        mut is_led: bool,
    ) -> Option<Edit> {
        let is_common = !self.shared.is_empty();
        let mut wanted = None;
        for (number, part) in shown.iter().enumerate() {
            let heading = RichText::new(&part.title).strong().color(color(theme.ink));
            let id = ("part", number, is_common);
            egui::CollapsingHeader::new(heading).id_salt(id).default_open(number < 2).show(ui, |ui| {
                for property in &part.properties {
                    let is_led = std::mem::take(&mut is_led);
                    // The row with the keyboard focus keeps it when a warning appears or disappears above.
                    let id = egui::Id::unique(("field", record.to_string(), &property.name, is_common));
                    let row = ui.scope_builder(egui::UiBuilder::new().scope_id(id), |ui| {
                        self.property(ui, theme, edited, record, property, is_led)
                    });
                    wanted = row.inner.or(wanted.take());
                }
            });
        }
        wanted
    }

    /// Shows one field; returns its edit, if any.
    fn property(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        edited: &mut EditedLayout,
        record: &Address,
        property: &Property,
        is_led: bool,
    ) -> Option<Edit> {
        let mut wanted = None;
        let short = property.short();
        let is_written = property.origin == FieldOrigin::Written;
        ui.horizontal(|ui| {
            let source = match &property.origin {
                FieldOrigin::Written => "written here".to_owned(),
                FieldOrigin::Kind(kind) => format!("from the kind \"{kind}\""),
                FieldOrigin::Default => "not written".to_owned(),
                FieldOrigin::Several => "not the same in all of them".to_owned(),
            };
            let name = if property.is_place() {
                format!("{short} ({})", unit_name(&edited.document))
            } else {
                short.into()
            };
            let name = RichText::new(name).color(color(if is_written { theme.ink } else { theme.quiet }));
            ui.allocate_ui_with_layout(
                egui::vec2(NAME_PX, ROW_PX),
                egui::Layout::left_to_right(egui::Align::Center),
                |ui| {
                    ui.set_min_width(NAME_PX);
                    ui.add(egui::Label::new(name).truncate())
                        .on_hover_text(format!("{}\n{}\n{source}", property.about, property.told));
                },
            );
            let (edit, editor) = self.value(ui, edited, record, property);
            wanted = edit;
            if is_led {
                editor.request_focus();
            }
            if editor.gained_focus() {
                editor.scroll_to_me(None);
            }
            self.hear(ui, edited, record, property);
            match &property.origin {
                FieldOrigin::Written if !KEPT.contains(&property.name.as_str()) => {
                    let reset = ui.small_button("x");
                    reset.widget_info(|| {
                        WidgetInfo::labeled(Role::Button, true, format!("Leave out {short}"))
                    });
                    if reset.on_hover_text("Take it out: the kind's value counts again").clicked() {
                        wanted = Some(Edit::unset(record, &property.name));
                    }
                }
                FieldOrigin::Kind(kind) => {
                    let text = quiet(theme, format!("from {kind}")).size(11.5);
                    ui.add(egui::Label::new(text).truncate()).on_hover_text(source);
                }
                FieldOrigin::Default if !property.value.is_empty() => {
                    ui.label(quiet(theme, "default").size(11.5));
                }
                FieldOrigin::Several => {
                    ui.label(quiet(theme, "differs").size(11.5)).on_hover_text(source);
                }
                _ => {}
            }
        });
        if property.name == "id"
            && let Some(Edit::Set { value, .. }) = &wanted
        {
            return Some(Edit::Rename { record: record.clone(), id: value.trim_matches('"').to_owned() });
        }
        wanted
    }

    /// A button that plays the effect of the field on the tile under the control.
    fn hear(&mut self, ui: &mut Ui, edited: &EditedLayout, record: &Address, property: &Property) {
        let Some(effect) = felt(edited, record, property) else { return };
        let button = ui.small_button("Hear");
        button.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Hear {}", property.short())));
        if button.on_hover_text("Play it on the tile under the control").clicked() {
            let geometry = edited.document.floor().geometry;
            let centre = edited.item(record).map_or(geometry.bounds().centre(), |item| item.area.centre());
            let tile = geometry.tile_under(centre).and_then(|tile| geometry.index(tile)).unwrap_or_default();
            let gesture = Gesture::usual(&effect);
            self.wish = Some(PreviewCommand::Feel { effect, gesture, tile });
        }
    }
}

pub(super) fn unit_name(document: &Document) -> &'static str {
    if document.unit_m() == 1.0 { "m" } else { "tiles" }
}

/// The findings about the record, in centimetres, with a button for each repair.
fn problems_of(ui: &mut Ui, theme: &Theme, edited: &mut EditedLayout, record: &Address) {
    let mut mend = None;
    let own =
        edited.findings.iter().filter(|finding| edited.document.found_in(finding).as_ref() == Some(record));
    for finding in own {
        let colour = if finding.severity == Severity::Error { theme.fault } else { theme.warning };
        let text = format!("{}: {}; {}", finding.rule.code, finding.message, finding.expected);
        ui.add(egui::Label::new(RichText::new(text).color(color(colour))).wrap())
            .on_hover_text(finding.rule.source);
        if let Some(help) = &finding.help {
            ui.add(egui::Label::new(quiet(theme, help)).wrap());
        }
        if let Some(found) = crate::edit::mend(&edited.document, finding, &edited.items)
            && ui.button(format!("{}: do it", found.name)).clicked()
        {
            mend = Some(found.edits);
        }
    }
    for problem in edited.told() {
        if edited.document.told_of(problem).as_ref() == Some(record) {
            let text = format!("{}: {}", problem.message, problem.expected);
            ui.add(egui::Label::new(RichText::new(text).color(color(theme.warning))).wrap());
        }
    }
    if let Some(edits) = mend {
        edited.edit(&edits);
    }
}

pub(super) fn effect_name<'d>(document: &'d Document, effect: &Effect) -> Option<&'d str> {
    let mut all = document.kinds().effects().iter();
    all.find(|named| *named.effect == *effect).map(|named| named.name.as_str())
}

fn widget_of<'e>(edited: &'e EditedLayout, record: &Address) -> Option<&'e Widget> {
    let item = edited.item(record).filter(|item| !item.is_group)?;
    edited.layout().widgets.get(item.widgets.start)
}

/// The effect of a field of the feel, from this record or from its kind.
pub(super) fn felt(edited: &EditedLayout, record: &Address, property: &Property) -> Option<Arc<Effect>> {
    let part = property.name.strip_prefix("feel.")?;
    let Feel { press, release, step, end, stage, arm, warn, on, off, hold, drag, sound: _ } =
        &widget_of(edited, record)?.feel;
    let parts = [
        ("press", press),
        ("release", release),
        ("step", step),
        ("end", end),
        ("stage", stage),
        ("arm", arm),
        ("warn", warn),
        ("on", on),
        ("off", off),
        ("hold", hold),
        ("drag", drag),
    ];
    parts.into_iter().find(|(name, _)| *name == part)?.1.clone()
}
