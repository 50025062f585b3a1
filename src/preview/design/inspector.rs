//! What is selected, field by field: made from the same descriptions that its file is read by.

use std::collections::HashMap;
use std::sync::Arc;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{Margin, Panel, RichText, ScrollArea, Ui, WidgetInfo};

use super::{Designer, Pane};
use crate::edit::{Address, Edit, Origin, Property, Section};
use crate::egui_painter::color;
use crate::feel::{Effect, Feel, Gesture};
use crate::format::diagnostic::Severity;
use crate::layout::Widget;
use crate::preview::PreviewCommand;
use crate::preview::style::{panel_frame, quiet, section};
use crate::scene::Theme;

/// The inspector's own memory.
#[derive(Default)]
pub(super) struct Inspector {
    /// Fields in which something is being typed.
    pub(super) typed: HashMap<String, String>,
    /// What is shown, and for which record and revision.
    shown: Vec<Section>,
    of: Option<(Address, u64)>,
}

/// Its width, in points.
const INSPECTOR_PX: f32 = 330.0;

/// Width of a field's name, in points.
const NAME_PX: f32 = 96.0;

/// Height of a row.
pub(super) const ROW_PX: f32 = 24.0;

/// Fields that no record does without.
const KEPT: [&str; 3] = ["id", "kind", "at"];

impl Designer {
    /// The inspector.
    pub(super) fn side_panel(&mut self, ui: &mut Ui, theme: &Theme) {
        let frame = panel_frame(theme, Margin { left: 14, right: 6, top: 0, bottom: 6 });
        // As wide whatever it shows: the floor beside it must not move under the pointer.
        let panel = Panel::right("inspector").frame(frame).resizable(false);
        panel.exact_size(INSPECTOR_PX).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                ui.set_width(ui.available_width() - 8.0);
                self.inspector(ui, theme);
            });
        });
    }

    fn inspector(&mut self, ui: &mut Ui, theme: &Theme) {
        let record = match &self.selected[..] {
            [] => Address::LAYOUT,
            [record] => record.clone(),
            more => {
                section(ui, theme, &format!("{} selected", more.len()), |_| {});
                ui.label(quiet(theme, "Arrange, move, duplicate or delete them together."));
                return;
            }
        };
        let item = self.item(&record).cloned();
        let title = match (&item, record.split()) {
            (Some(item), _) if !item.name.is_empty() => item.name.clone(),
            (_, Some(_)) => record.to_string(),
            _ => "The layout".to_owned(),
        };
        section(ui, theme, &title, |_| {});
        if let Some(item) = &item {
            let (at, size) = (item.area.min, item.area.size() * 100.0);
            let text = format!("{:.1} x {:.1} cm, {:.3} m east, {:.3} m north", size.x, size.y, at.x, at.y);
            ui.label(quiet(theme, text));
        }
        self.problems_of(ui, theme, &record);
        let revision = self.document.revision();
        if self.inspector.of != Some((record.clone(), revision)) {
            self.inspector.shown = self.document.properties(&record, item.as_ref());
            self.inspector.of = Some((record.clone(), revision));
            self.inspector.typed.clear();
        }
        let shown = std::mem::take(&mut self.inspector.shown);
        let mut wanted = None;
        let mut is_led = self.leads_to(Pane::Fields);
        for (number, part) in shown.iter().enumerate() {
            let heading = RichText::new(&part.title).strong().color(color(theme.ink));
            egui::CollapsingHeader::new(heading).id_salt(("part", number)).default_open(number < 2).show(
                ui,
                |ui| {
                    for property in &part.properties {
                        let is_led = std::mem::take(&mut is_led);
                        // What has the keyboard keeps it, also when a warning comes or goes above.
                        let id = egui::Id::unique(("field", record.to_string(), &property.name));
                        let row = ui.scope_builder(egui::UiBuilder::new().scope_id(id), |ui| {
                            self.property(ui, theme, &record, property, is_led)
                        });
                        wanted = row.inner.or(wanted.take());
                    }
                },
            );
        }
        self.inspector.shown = shown;
        if let Some(edit) = wanted {
            self.edit_in(&[edit], None);
        }
    }

    /// What is wrong with the record, in centimetres, and what mends it.
    fn problems_of(&mut self, ui: &mut Ui, theme: &Theme, record: &Address) {
        let mut mend = None;
        let own =
            self.findings.iter().filter(|finding| self.document.found_in(finding).as_ref() == Some(record));
        for finding in own {
            let colour = if finding.severity == Severity::Error { theme.fault } else { theme.warning };
            let text = format!("{}: {}; {}", finding.rule.code, finding.message, finding.expected);
            ui.add(egui::Label::new(RichText::new(text).color(color(colour))).wrap())
                .on_hover_text(finding.rule.source);
            if let Some(help) = &finding.help {
                ui.add(egui::Label::new(quiet(theme, help)).wrap());
            }
            if let Some((name, edits)) = self.document.mend(finding, &self.items)
                && ui.button(format!("{name}: do it")).clicked()
            {
                mend = Some(edits);
            }
        }
        for problem in self.document.warnings().iter() {
            if self.document.told_of(problem).as_ref() == Some(record) {
                let text = format!("{}: {}", problem.message, problem.expected);
                ui.add(egui::Label::new(RichText::new(text).color(color(theme.warning))).wrap());
            }
        }
        if let Some(edits) = mend {
            self.edit(&edits);
        }
    }

    /// One field; what shall be done to it.
    fn property(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        record: &Address,
        property: &Property,
        is_led: bool,
    ) -> Option<Edit> {
        let mut wanted = None;
        let short = property.short();
        let is_written = property.origin == Origin::Written;
        ui.horizontal(|ui| {
            let source = match &property.origin {
                Origin::Written => "written here".to_owned(),
                Origin::Kind(kind) => format!("from the kind \"{kind}\""),
                Origin::Default => "not written".to_owned(),
            };
            let name =
                if property.is_place() { format!("{short} ({})", self.unit_name()) } else { short.into() };
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
            let (edit, editor) = self.value(ui, record, property);
            wanted = edit;
            if is_led {
                editor.request_focus();
            }
            if editor.gained_focus() {
                editor.scroll_to_me(None);
            }
            self.hear(ui, record, property);
            match &property.origin {
                Origin::Written if !KEPT.contains(&property.name.as_str()) => {
                    let reset = ui.small_button("x");
                    reset.widget_info(|| {
                        WidgetInfo::labeled(Role::Button, true, format!("Leave out {short}"))
                    });
                    if reset.on_hover_text("Take it out: the kind's value counts again").clicked() {
                        wanted = Some(Edit::unset(record, &property.name));
                    }
                }
                Origin::Kind(kind) => {
                    let text = quiet(theme, format!("from {kind}")).size(11.5);
                    ui.add(egui::Label::new(text).truncate()).on_hover_text(source);
                }
                Origin::Default if !property.value.is_empty() => {
                    ui.label(quiet(theme, "default").size(11.5));
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

    pub(super) fn unit_name(&self) -> &'static str {
        if self.document.unit_m() == 1.0 { "m" } else { "tiles" }
    }

    /// A button that plays what the field stands for, on the tile under the control.
    fn hear(&mut self, ui: &mut Ui, record: &Address, property: &Property) {
        let Some(effect) = self.felt(record, property) else { return };
        let button = ui.small_button("Hear");
        button.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Hear {}", property.short())));
        if button.on_hover_text("Play it on the tile under the control").clicked() {
            let geometry = self.document.floor().geometry;
            let centre = self.item(record).map_or(geometry.bounds().centre(), |item| item.area.centre());
            let tile = geometry.tile_under(centre).and_then(|tile| geometry.index(tile)).unwrap_or_default();
            let gesture = Gesture::usual(&effect);
            self.wish = Some(PreviewCommand::Feel { effect, gesture, tile });
        }
    }

    pub(super) fn effect_name(&self, effect: &Effect) -> Option<&str> {
        let mut all = self.document.kinds().effects().iter();
        all.find(|named| *named.effect == *effect).map(|named| named.name.as_str())
    }

    fn widget_of(&self, record: &Address) -> Option<&Widget> {
        let item = self.item(record).filter(|item| !item.is_group)?;
        self.layout().widgets.get(item.widgets.start)
    }

    /// The effect that a field of the feel stands for, be it written here or in the kind.
    pub(super) fn felt(&self, record: &Address, property: &Property) -> Option<Arc<Effect>> {
        let part = property.name.strip_prefix("feel.")?;
        let Feel { press, release, step, end, stage, arm, warn, on, off, hold, drag, sound: _ } =
            &self.widget_of(record)?.feel;
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
}
