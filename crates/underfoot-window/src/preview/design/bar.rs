//! The tools of Design mode: files, undo, arrangement; and the questions that need the user's decision.

use std::path::PathBuf;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Ui, WidgetInfo};

use super::edited::EditedLayout;
use super::{Ask, Asking, Designer, shelf};
use crate::edit::{Address, Align, Template, align, distribute};
use crate::platform;
use crate::preview::bars::{MessageStack, message_frame};
use crate::preview::feed::LayoutCause;
use crate::preview::gallery::LayoutGallery;
use crate::preview::handheld::{is_for_fingers, menu_content, with_word};
use crate::preview::icons::{self, Icon, icon_button};
use crate::preview::shown::ShownFloor;
use crate::preview::style::{is_entered, quiet, toggle};
use underfoot::floor::Rect;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Width of the field for a path in a window in a hand, in points.
const PATH: f32 = 130.0;

/// Width of the button Arrange for fingers, in points, rounded up.
const ARRANGE: f32 = 90.0;

/// The action of a menu entry.
type Action = fn(&mut EditedLayout);

impl Designer {
    /// Shows files, undo, arrangement and the number of problems, in the top bar.
    pub(in crate::preview) fn tools(&mut self, ui: &mut Ui, theme: &Theme, gallery: &mut LayoutGallery) {
        if is_for_fingers(ui) {
            let hint = "Things to put down on the floor";
            with_word(ui, |ui| toggle(ui, &mut self.panes.shows_things, "Add", hint));
        }
        self.files(ui, gallery);
        let (can_undo, can_redo) = (self.edited.document.can_undo(), self.edited.document.can_redo());
        let any = !self.edited.selected.is_empty();
        if icon_button(ui, can_undo, Icon::Undo2, "Undo", "Ctrl+Z") {
            self.edited.undo();
        }
        if icon_button(ui, can_redo, Icon::Redo2, "Redo", "Ctrl+Shift+Z") {
            self.edited.redo();
        }
        if icon_button(ui, any, Icon::CopyPlus, "Duplicate", "Ctrl+D") {
            self.edited.duplicate();
        }
        if icon_button(ui, any, Icon::Trash2, "Delete", "the Delete key") {
            self.edited.delete();
        }
        if icon_button(ui, any, Icon::RotateCw, "Turn", "R, a quarter turn") {
            self.edited.turn();
        }
        with_word(ui, |ui| {
            self.arrange(ui);
            ui.menu_button("Show", |ui| menu_content(ui, |ui| self.show_menu(ui)));
        });
        let hint = "see the whole floor; the wheel zooms, Space and drag moves";
        if icon_button(ui, true, Icon::Maximize, "Fit", hint) {
            self.canvas.fit();
        }
        let hint = "The layout as text, beside the floor";
        with_word(ui, |ui| toggle(ui, &mut self.text.is_open, "Text", hint));
        self.count(ui, theme);
    }

    /// Shows the button that puts the layout on a server's floor, if the floor belongs to one.
    pub(in crate::preview) fn put_button(&self, ui: &mut Ui, shown: &ShownFloor) {
        let Some(server) = &shown.server else { return };
        let name = "Put on the floor";
        let button = egui::Button::new(icons::with(Icon::Footprints, "Put"));
        let button = icons::named(ui.add_enabled(server.takes_layouts, button), name);
        let hint = "the server checks the layout, and waits until no foot is on a control";
        let refused = "this server keeps its layout; it takes others if it is started with --web-layouts";
        let button = button.on_hover_text(format!("{name}: {hint}"));
        if button.on_disabled_hover_text(format!("{name}: {refused}")).clicked() {
            self.try_layout(shown, LayoutCause::Designed);
        }
    }

    fn files(&mut self, ui: &mut Ui, gallery: &mut LayoutGallery) {
        with_word(ui, |ui| {
            ui.menu_button("File", |ui| menu_content(ui, |ui| self.file_menu(ui, gallery)));
        });
        let can_save = !self.is_saved() || self.storage.file.path().is_none() || self.storage.file.is_new();
        if icons::icon_button(ui, can_save, Icon::Save, "Save", "Ctrl+S") {
            self.save();
        }
    }

    fn show_menu(&mut self, ui: &mut Ui) {
        ui.checkbox(&mut self.canvas.scale.shoes, "Shoes in true size");
        ui.checkbox(&mut self.canvas.scale.reach, "How far feet reach");
    }

    fn file_menu(&mut self, ui: &mut Ui, gallery: &mut LayoutGallery) {
        ui.menu_button("New", |ui| {
            let geometry = self.edited.document.floor().geometry;
            ui.label(format!("for a floor of {} x {} tiles", geometry.columns(), geometry.rows()))
                .on_hover_text("The window's floor; underfoot preview --grid 8x4 opens it with another one");
            for template in Template::ALL {
                if ui.button(template.name()).clicked() {
                    let text = template.text(&self.edited.document.floor().geometry);
                    self.begin_untitled("untitled.ron", &text);
                    ui.close();
                }
            }
        });
        if ui.add_enabled(!gallery.is_empty(), egui::Button::new("Gallery")).clicked() {
            gallery.open();
            ui.close();
        }
        let recent = shelf::recent(&self.storage.state);
        ui.add_enabled_ui(!recent.is_empty(), |ui| {
            ui.menu_button("Open recent", |ui| {
                for path in &recent {
                    let name = path.file_name().unwrap_or_default().to_string_lossy();
                    if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                        self.open(path);
                        ui.close();
                    }
                }
            });
        });
        for (to, name, keys) in [(Ask::Open, "Open file", "Ctrl+O"), (Ask::SaveAs, "Save as", "Ctrl+Shift+S")]
        {
            if ui.add(egui::Button::new(name).shortcut_text(keys)).clicked() {
                match to {
                    Ask::Open => self.ask_to_open(),
                    Ask::SaveAs => self.ask_for(Ask::SaveAs),
                }
                ui.close();
            }
        }
        if platform::GIVES && ui.button("Download").clicked() {
            if let Err(wrong) = platform::give(&self.name(), &self.file_text()) {
                self.edited.complain(format!("the browser takes no file: {wrong}"));
            }
            ui.close();
        }
    }

    fn arrange(&mut self, ui: &mut Ui) {
        let items = self.edited.selected_items();
        let areas: Vec<Rect> = items.iter().map(|item| item.area).collect();
        let (mut wanted, mut does) = (None, None);
        let is_group = matches!(items[..], [item] if item.is_group);
        let count = areas.len();
        // This part of the line is not wrapped by itself.
        if is_for_fingers(ui) && ui.available_size_before_wrap().x < ARRANGE {
            ui.end_row();
        }
        ui.add_enabled_ui(count > 0, |ui| {
            ui.menu_button("Arrange", |ui| {
                menu_content(ui, |ui| {
                    let entries: [(bool, &str, &str, Action); 7] = [
                        (count > 1, "Make alike", "Ctrl+E", EditedLayout::make_alike),
                        (count > 0, "Group", "Ctrl+G", EditedLayout::group),
                        (is_group, "Ungroup", "Ctrl+Shift+G", EditedLayout::ungroup),
                        (count == 1, "To the front", "Ctrl+]", |edited| edited.reorder(false)),
                        (count == 1, "To the back", "Ctrl+[", |edited| edited.reorder(true)),
                        (true, "Lock or unlock", "Ctrl+L", |edited| {
                            edited.turn_lock(&edited.selected.clone());
                        }),
                        (true, "Hide or show", "Ctrl+H", |edited| {
                            edited.turn_hidden(&edited.selected.clone());
                        }),
                    ];
                    for (is_on, name, keys, action) in entries {
                        let button = egui::Button::new(name).shortcut_text(keys);
                        if ui.add_enabled(is_on, button).clicked() {
                            does = Some(action);
                            ui.close();
                        }
                    }
                    ui.separator();
                    ui.add_enabled_ui(count > 1, |ui| {
                        let names =
                            ["West edges", "Centres", "East edges", "South edges", "Middles", "North edges"];
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
            });
        });
        if let Some(does) = does {
            does(&mut self.edited);
        }
        if let Some(areas) = wanted {
            self.edited.move_to(&areas);
        }
    }

    /// Shows the number of problems; a click selects the next one.
    fn count(&mut self, ui: &mut Ui, theme: &Theme) {
        let all: Vec<Address> = self
            .edited
            .findings
            .iter()
            .filter_map(|finding| self.edited.document.found_in(finding))
            .chain(self.edited.told().filter_map(|problem| self.edited.document.told_of(problem)))
            .collect();
        let count = self.edited.findings.len() + self.edited.told().count();
        if count == 0 {
            let label = ui.label(quiet(theme, Icon::CircleCheck.unicode()));
            label.widget_info(|| WidgetInfo::labeled(Role::Label, true, "no warnings"));
            label.on_hover_text("no warnings");
            return;
        }
        let noun = if count == 1 { "warning" } else { "warnings" };
        let text = icons::with(Icon::TriangleAlert, &count.to_string());
        let button = ui.button(egui::RichText::new(text).color(color(theme.warning)));
        let name = format!("{count} {noun}");
        let button = icons::named(button, &name);
        if button.on_hover_text(format!("{name}: select the next control that has one")).clicked() {
            let at =
                self.edited.selected.first().and_then(|record| all.iter().rposition(|other| other == record));
            let next = at.map_or(0, |at| at + 1);
            if let Some(record) = all.get(next).or(all.first()).cloned() {
                self.edited.select_only(record);
            }
        }
    }

    /// Asks about a draft of an earlier window and about conflicting changes.
    fn questions(&mut self, ui: &mut Ui, theme: &Theme) {
        let frame = message_frame(theme, theme.warning);
        if let Some(draft) = self.storage.left_over.clone() {
            frame.show(ui, |ui| {
                ui.horizontal_wrapped(|ui| {
                    let name = self.storage.file.name();
                    ui.label(format!("{name} was being edited when a window ended without saving."));
                    if ui.button("Recover the draft").clicked() {
                        match self.edited.document.write(&draft, None) {
                            Ok(()) => self.storage.left_over = None,
                            Err(problems) => self.edited.complain(problems.to_string()),
                        }
                    }
                    if ui.button("Drop it").clicked() {
                        self.storage.file.drop_draft();
                        self.storage.left_over = None;
                    }
                });
            });
        }
        if let Some((theirs, records)) = self.storage.conflict.clone() {
            frame.show(ui, |ui| {
                ui.horizontal_wrapped(|ui| {
                    let what = if records.is_empty() { "the same lines".into() } else { records.join(", ") };
                    ui.label(format!("Another program has changed {what} as well, and saved it."));
                    if ui
                        .button("Keep mine")
                        .on_hover_text("Saving then replaces theirs, which stays as a backup")
                        .clicked()
                    {
                        self.storage.file.know(theirs.clone());
                        self.storage.conflict = None;
                    }
                    if ui.button("Take theirs").on_hover_text("Undo brings mine back").clicked() {
                        self.storage.conflict = None;
                        self.storage.file.know(theirs.clone());
                        if let Err(problems) = self.edited.document.write(&theirs, None) {
                            self.edited.complain(problems.to_string());
                        }
                    }
                });
            });
        }
    }

    /// Shows what Design mode asks and reports, over the floor.
    pub(in crate::preview) fn messages(&mut self, ui: &mut Ui, stack: &MessageStack<'_>) {
        if self.is_open {
            self.questions(ui, stack.theme);
        }
        self.ask(ui, stack.theme);
        if let Some(message) = self.edited.message() {
            let colour = if message.is_bad { stack.theme.fault } else { stack.theme.good };
            stack.tell(ui, colour, &message.text);
        }
    }

    /// Shows the path dialogue, if it is open.
    fn ask(&mut self, ui: &mut Ui, theme: &Theme) {
        let Some(mut asking) = self.storage.asking.take() else { return };
        let mut goes_on = true;
        message_frame(theme, theme.accent).show(ui, |ui| {
            ui.horizontal(|ui| {
                let name = if asking.to == Ask::Open { "Open" } else { "Save as" };
                ui.label(name);
                let width = if is_for_fingers(ui) { PATH } else { 300.0 };
                let field = ui.add(
                    egui::TextEdit::singleline(&mut asking.path)
                        .desired_width(width)
                        .align(egui::Align2::LEFT_CENTER),
                );
                field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Path"));
                // Check this before the field regains the focus: after that, the loss of focus would be invisible.
                let entered = is_entered(ui, &field);
                if ui.memory(|memory| memory.focused().is_none()) {
                    field.request_focus();
                }
                if ui.button(format!("{name} it")).clicked() || entered {
                    goes_on = !self.answer(&asking);
                }
                if ui.button("Cancel").clicked() || ui.input(|i| i.key_pressed(Key::Escape)) {
                    goes_on = false;
                }
            });
        });
        if goes_on {
            self.storage.asking = Some(asking);
        }
    }

    /// Opens or saves; returns whether that succeeded.
    fn answer(&mut self, asking: &Asking) -> bool {
        let path = PathBuf::from(asking.path.trim());
        match asking.to {
            Ask::Open => self.open(&path),
            Ask::SaveAs => {
                let text = self.edited.document.file_text();
                match self.storage.file.save_as(&text, &path) {
                    Ok(()) => {
                        self.edited.document.rename(&path.display().to_string());
                        self.storage.slot = None;
                        shelf::note_recent(&self.storage.state, &path);
                        self.edited.say(format!("Saved in {}", path.display()));
                        true
                    }
                    Err(error) => {
                        self.edited.complain(error.to_string());
                        false
                    }
                }
            }
        }
    }
}
