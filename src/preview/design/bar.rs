//! The strip of Design mode: files, steps, order; and the questions that only a person can answer.

use std::path::{Path, PathBuf};

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Margin, Panel, Ui, WidgetInfo};

use super::{Ask, Asking, Designer};
use crate::edit::{Address, Align, LayoutFile, Template, align, distribute};
use crate::egui_painter::color;
use crate::floor::Rect;
use crate::preview::style::{panel_colour, panel_frame, pill, quiet};
use crate::scene::Theme;
use crate::schema;

impl Designer {
    /// Files, steps, arrangement, and what is wrong, counted.
    pub(super) fn bar(&mut self, ui: &mut Ui, theme: &Theme, choices: &[String]) {
        let frame = panel_frame(theme, Margin::symmetric(14, 5));
        Panel::top("design bar").frame(frame).resizable(false).show(ui, |ui| {
            ui.horizontal_wrapped(|ui| {
                self.files(ui, choices);
                ui.separator();
                let (can_undo, can_redo) = (self.document.can_undo(), self.document.can_redo());
                let button = |ui: &mut Ui, on, name: &str, hint: &str| {
                    ui.add_enabled(on, egui::Button::new(name)).on_hover_text(hint).clicked()
                };
                if button(ui, can_undo, "Undo", "Ctrl+Z") {
                    self.undo();
                }
                if button(ui, can_redo, "Redo", "Ctrl+Shift+Z") {
                    self.redo();
                }
                ui.separator();
                let any = !self.selected.is_empty();
                if button(ui, any, "Duplicate", "Ctrl+D") {
                    self.duplicate();
                }
                if button(ui, any, "Delete", "Delete") {
                    self.delete();
                }
                if button(ui, any, "Turn", "R: a quarter turn") {
                    self.turn();
                }
                self.arrange(ui);
                ui.separator();
                if button(ui, true, "Fit", "See the whole floor; the wheel zooms, Space and drag moves") {
                    self.fit();
                }
                let text = egui::Button::selectable(self.text.is_open, "Text").frame_when_inactive(true);
                if ui.add(text).on_hover_text("The layout as text, beside the floor").clicked() {
                    self.text.is_open = !self.text.is_open;
                }
                self.count(ui, theme);
                if let Some(message) = &self.message {
                    let colour = if message.is_bad { theme.fault } else { theme.good };
                    pill(ui, colour, theme, &message.text);
                }
            });
        });
    }

    fn files(&mut self, ui: &mut Ui, choices: &[String]) {
        let is_saved = self.is_saved();
        ui.menu_button("File", |ui| {
            ui.menu_button("New", |ui| {
                for template in Template::ALL {
                    if ui.button(template.name()).clicked() {
                        let text = template.text(&self.document.floor().geometry);
                        let file = LayoutFile::untitled(Path::new(""), "");
                        self.begin("untitled.ron", &text, file);
                        ui.close();
                    }
                }
            });
            ui.menu_button("Open shipped", |ui| {
                for name in choices.iter().filter(|name| schema::builtin_layout(name).is_some()) {
                    if ui.button(name).clicked() {
                        let text = schema::builtin_layout(name).unwrap_or_default();
                        self.begin(name, text, LayoutFile::untitled(Path::new(""), text));
                        ui.close();
                    }
                }
            });
            for (to, name) in [(Ask::Open, "Open file"), (Ask::SaveAs, "Save as")] {
                if ui.button(name).clicked() {
                    let path = self.file.path().map(|path| path.display().to_string());
                    self.asking = Some(Asking { to, path: path.unwrap_or_else(|| self.file.name()) });
                    ui.close();
                }
            }
        });
        let save = ui.add_enabled(!is_saved || self.file.path().is_none(), egui::Button::new("Save"));
        if save.on_hover_text("Ctrl+S").clicked() {
            self.save();
        }
        let name = self.file.name();
        ui.label(if is_saved { name } else { format!("{name} (not saved)") });
    }

    fn arrange(&mut self, ui: &mut Ui) {
        let items = self.selected_items();
        let areas: Vec<Rect> = items.iter().map(|item| item.area).collect();
        let mut wanted = None;
        ui.add_enabled_ui(areas.len() > 1, |ui| {
            ui.menu_button("Arrange", |ui| {
                let names = ["West edges", "Centres", "East edges", "South edges", "Middles", "North edges"];
                for (how, name) in Align::ALL.into_iter().zip(names) {
                    if ui.button(format!("Align {}", name.to_lowercase())).clicked() {
                        wanted = Some(align(&areas, how));
                        ui.close();
                    }
                }
                for (axis, name) in ["west to east", "south to north"].into_iter().enumerate() {
                    let button = egui::Button::new(format!("Distribute {name}"));
                    if ui.add_enabled(areas.len() > 2, button).clicked() {
                        wanted = Some(distribute(&areas, axis));
                        ui.close();
                    }
                }
            });
        });
        if let Some(areas) = wanted {
            self.move_to(&areas);
        }
    }

    /// How much is wrong; a click goes to the next one.
    fn count(&mut self, ui: &mut Ui, theme: &Theme) {
        let all: Vec<Address> = self
            .findings
            .iter()
            .filter_map(|finding| self.document.found_in(finding))
            .chain(self.document.warnings().iter().filter_map(|problem| self.document.told_of(problem)))
            .collect();
        let count = self.findings.len() + self.document.warnings().len();
        if count == 0 {
            ui.label(quiet(theme, "no warnings"));
            return;
        }
        let noun = if count == 1 { "warning" } else { "warnings" };
        let text = egui::RichText::new(format!("{count} {noun}")).color(color(theme.warning));
        if ui.button(text).on_hover_text("Select the next control that has one").clicked() {
            let at = self.selected.first().and_then(|record| all.iter().rposition(|other| other == record));
            let next = at.map_or(0, |at| at + 1);
            if let Some(record) = all.get(next).or(all.first()).cloned() {
                self.select_only(record);
            }
        }
    }

    /// What only the person can say.
    pub(super) fn questions(&mut self, ui: &mut Ui, theme: &Theme) {
        let ground = color(panel_colour(theme).mix(theme.warning, 0.12));
        let frame = egui::Frame::new().fill(ground).inner_margin(Margin::symmetric(14, 5));
        if let Some(draft) = self.left_over.clone() {
            Panel::top("left over").frame(frame).resizable(false).show(ui, |ui| {
                ui.horizontal_wrapped(|ui| {
                    let name = self.file.name();
                    ui.label(format!("{name} was being edited when a window ended without saving."));
                    if ui.button("Recover the draft").clicked() {
                        match self.document.write(&draft, None) {
                            Ok(()) => self.left_over = None,
                            Err(problems) => self.complain(problems.to_string()),
                        }
                    }
                    if ui.button("Drop it").clicked() {
                        self.file.drop_draft();
                        self.left_over = None;
                    }
                });
            });
        }
        if let Some((theirs, records)) = self.conflict.clone() {
            Panel::top("conflict").frame(frame).resizable(false).show(ui, |ui| {
                ui.horizontal_wrapped(|ui| {
                    let what = if records.is_empty() { "the same lines".into() } else { records.join(", ") };
                    ui.label(format!("Another program has changed {what} as well, and saved it."));
                    if ui
                        .button("Keep mine")
                        .on_hover_text("Saving then replaces theirs, which stays as a backup")
                        .clicked()
                    {
                        self.file.know(theirs.clone());
                        self.conflict = None;
                    }
                    if ui.button("Take theirs").on_hover_text("Undo brings mine back").clicked() {
                        self.conflict = None;
                        self.file.know(theirs.clone());
                        if let Err(problems) = self.document.write(&theirs, None) {
                            self.complain(problems.to_string());
                        }
                    }
                });
            });
        }
        self.ask(ui, frame);
    }

    fn ask(&mut self, ui: &mut Ui, frame: egui::Frame) {
        let Some(mut asking) = self.asking.take() else { return };
        let mut goes_on = true;
        Panel::top("path").frame(frame).resizable(false).show(ui, |ui| {
            ui.horizontal(|ui| {
                let name = if asking.to == Ask::Open { "Open" } else { "Save as" };
                ui.label(name);
                let field = ui.add(egui::TextEdit::singleline(&mut asking.path).desired_width(420.0));
                field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Path"));
                if ui.memory(|memory| memory.focused().is_none()) {
                    field.request_focus();
                }
                let entered = field.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter));
                if ui.button(format!("{name} it")).clicked() || entered {
                    goes_on = !self.answer(&asking);
                }
                if ui.button("Cancel").clicked() || ui.input(|i| i.key_pressed(Key::Escape)) {
                    goes_on = false;
                }
            });
        });
        if goes_on {
            self.asking = Some(asking);
        }
    }

    /// Opens or saves; whether that could be done.
    fn answer(&mut self, asking: &Asking) -> bool {
        let path = PathBuf::from(asking.path.trim());
        match asking.to {
            Ask::Open => match LayoutFile::open(&path) {
                Ok((file, text)) => {
                    self.begin(&path.display().to_string(), &text, file);
                    !self.message.as_ref().is_some_and(|message| message.is_bad)
                }
                Err(error) => {
                    self.complain(format!("{} can't be opened: {error}", path.display()));
                    false
                }
            },
            Ask::SaveAs => {
                let text = self.document.file_text();
                match self.file.save_as(&text, &path) {
                    Ok(()) => {
                        self.document.rename(&path.display().to_string());
                        self.say(format!("Saved in {}", path.display()));
                        true
                    }
                    Err(error) => {
                        self.complain(error.to_string());
                        false
                    }
                }
            }
        }
    }
}
