//! What is selected, field by field: made from the same descriptions that its file is read by.

use std::collections::HashMap;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{ComboBox, DragValue, Key, Margin, Panel, RichText, ScrollArea, TextEdit, Ui, WidgetInfo};

use super::Designer;
use crate::edit::{Address, Edit, Origin, Property, Section};
use crate::egui_painter::color;
use crate::format::describe::FieldType;
use crate::format::diagnostic::Severity;
use crate::preview::style::{panel_frame, quiet, section};
use crate::scene::Theme;

/// The inspector's own memory.
#[derive(Default)]
pub(super) struct Inspector {
    /// Fields in which something is being typed.
    typed: HashMap<String, String>,
    /// What is shown, and for which record and revision.
    shown: Vec<Section>,
    of: Option<(Address, u64)>,
}

/// Its width, in points.
const INSPECTOR_PX: f32 = 330.0;

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
        for (number, part) in shown.iter().enumerate() {
            let heading = RichText::new(&part.title).strong().color(color(theme.ink));
            egui::CollapsingHeader::new(heading).id_salt(("part", number)).default_open(number < 2).show(
                ui,
                |ui| {
                    for property in &part.properties {
                        wanted = self.property(ui, theme, &record, property).or(wanted.take());
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
    ) -> Option<Edit> {
        let mut wanted = None;
        let set = |value: String| Some(Edit::set(record, &property.name, value));
        let short = property.name.rsplit('.').next().unwrap_or_default();
        let is_written = property.origin == Origin::Written;
        ui.horizontal(|ui| {
            let source = match &property.origin {
                Origin::Written => "written here".to_owned(),
                Origin::Kind(kind) => format!("from the kind \"{kind}\""),
                Origin::Default => "not written".to_owned(),
            };
            let name = RichText::new(short).color(color(if is_written { theme.ink } else { theme.quiet }));
            let width = 0.42 * ui.available_width();
            ui.allocate_ui_with_layout(
                egui::vec2(width, 20.0),
                egui::Layout::left_to_right(egui::Align::Center),
                |ui| {
                    ui.set_min_width(width);
                    ui.add(egui::Label::new(name).truncate())
                        .on_hover_text(format!("{}\n{}\n{source}", property.about, property.told));
                },
            );
            let value = property.value.as_str();
            wanted = match &property.shape {
                FieldType::Flag => {
                    let mut on = value == "true";
                    let tick = ui.checkbox(&mut on, "");
                    tick.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, on, short));
                    tick.changed().then(|| set(on.to_string())).flatten()
                }
                FieldType::Names(names) => self.choice(ui, short, value, names).and_then(set),
                FieldType::Number { range: (low, high), whole } if value.parse::<f64>().is_ok() => {
                    let mut number: f64 = value.parse().unwrap_or_default();
                    let drag = DragValue::new(&mut number)
                        .range(*low..=*high)
                        .speed(if *whole { 0.1 } else { ((high - low) * 2e-3).min(1.0) })
                        .max_decimals(if *whole { 0 } else { 4 })
                        .update_while_editing(false);
                    let drag = ui.add(drag);
                    drag.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, short));
                    if drag.drag_started() {
                        self.stroke += 1;
                    }
                    if drag.dragged() && drag.changed() {
                        // All of one drag is one step.
                        if let Some(edit) = set(crate::format::number::plain(number)) {
                            self.edit_in(&[edit], Some(self.stroke));
                        }
                        None
                    } else {
                        drag.changed().then(|| set(crate::format::number::plain(number))).flatten()
                    }
                }
                shape => {
                    let is_text = matches!(shape, FieldType::Text(_)) && property.value != "None";
                    self.typed(ui, property, is_text).and_then(set)
                }
            };
            if is_written && property.name != "id" && property.name != "kind" && property.name != "at" {
                let reset = ui.small_button("x");
                reset.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Leave out {short}")));
                if reset.on_hover_text("Take it out: the kind's value counts again").clicked() {
                    wanted = Some(Edit::unset(record, &property.name));
                }
            }
        });
        if property.name == "id"
            && let Some(Edit::Set { value, .. }) = &wanted
        {
            return Some(Edit::Rename { record: record.clone(), id: value.trim_matches('"').to_owned() });
        }
        wanted
    }

    fn choice(&self, ui: &mut Ui, name: &str, value: &str, names: &[&'static str]) -> Option<String> {
        let is_kind = names.is_empty();
        let all: Vec<String> = match is_kind {
            true => self.document.kinds().iter().map(|kind| format!("\"{}\"", kind.name)).collect(),
            false => names.iter().map(|name| (*name).to_owned()).collect(),
        };
        let mut chosen = None;
        let menu =
            ComboBox::from_id_salt(("choice", name)).selected_text(value.trim_matches('"')).width(120.0);
        let menu = menu.show_ui(ui, |ui| {
            for one in &all {
                if ui.selectable_label(one == value, one.trim_matches('"')).clicked() && one != value {
                    chosen = Some(one.clone());
                }
            }
        });
        menu.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, name));
        chosen
    }

    /// A field that is typed; what was typed, once that is done.
    fn typed(&mut self, ui: &mut Ui, property: &Property, is_text: bool) -> Option<String> {
        let shown = if is_text { property.value.trim_matches('"') } else { &property.value };
        let typed = self.inspector.typed.entry(property.name.clone()).or_insert_with(|| shown.to_owned());
        let field = ui.add(TextEdit::singleline(typed).desired_width(ui.available_width() - 48.0));
        field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, &property.name));
        let done = field.lost_focus() && typed != shown;
        if !done {
            return None;
        }
        let typed = self.inspector.typed.remove(&property.name)?;
        if ui.input(|i| i.key_pressed(Key::Escape)) {
            return None;
        }
        Some(if is_text { crate::edit::quoted(&typed) } else { typed })
    }
}
