//! The connection of Design mode to the rest of the window: input from the program, output to the floor.

use std::path::Path;
use std::sync::Arc;

use eframe::egui::{self, Key, Ui};

use crate::preview::app::App;
use crate::preview::feed::{LayoutCause, PreviewCommand, Warnings};
use crate::preview::messages::FileNote;
use underfoot::schema;

impl App {
    /// Changes between Design and Try; the floor then gets the edited layout, with the text that was just being
    /// typed.
    pub(in crate::preview) fn turn_mode(&mut self, ctx: &egui::Context) {
        let Some(designer) = &mut self.designer else { return };
        if designer.is_open {
            if let Some(id) = ctx.memory(|memory| memory.focused()) {
                ctx.memory_mut(|memory| memory.surrender_focus(id));
            }
            designer.leaves_in = 2;
            return ctx.request_repaint();
        }
        designer.is_open = true;
        // No simulated foot stands on the canvas in Design mode.
        if let Some((feet, sink)) = &mut self.feet {
            feet.lift_working();
            feet.lift_standing();
            sink.lead(0.0, &[]);
        }
    }

    /// Leaves Design mode once the typed text is in the layout, and in the file if a save is pending.
    fn leave(&mut self, ctx: &egui::Context) {
        let Some(designer) = self.designer.as_mut().filter(|designer| designer.leaves_in > 0) else { return };
        if designer.saves_in == 0 {
            designer.leaves_in -= 1;
        }
        if designer.leaves_in > 0 {
            return ctx.request_repaint();
        }
        designer.is_open = false;
        self.try_layout(LayoutCause::Designed);
    }

    /// Changes the mode on F2; in any mode, reads files that are dropped on the window or saved outside.
    pub(in crate::preview) fn handle_mode_key(&mut self, ui: &Ui) {
        // A check of the floor excludes editing.
        if self.is_checking() {
            return;
        }
        if ui.input(|i| i.key_pressed(Key::F2)) {
            self.turn_mode(ui.ctx());
        }
        let dropped = ui.input(|i| i.raw.dropped_files.first().map(|file| file.path().to_path_buf()));
        let Some(designer) = &mut self.designer else { return };
        if let Some(path) = dropped {
            if designer.open(&path) {
                self.try_layout(LayoutCause::Opened);
            } else if let Some(message) = &designer.message {
                self.messages.note(message.text.clone());
            }
        }
        if std::mem::take(&mut self.messages.files_changed) {
            self.take_in_files();
        }
        let is_closing = self.is_closing();
        let Some(designer) = &mut self.designer else { return };
        if !is_closing {
            designer.keep(self.now_s);
        }
        let path = designer.file.path().map(Path::to_path_buf);
        if path != designer.watched {
            designer.watched.clone_from(&path);
            self.command(PreviewCommand::Watch(path));
        }
    }

    /// Reads the files that were saved outside and puts the layout on the floor.
    fn take_in_files(&mut self) {
        let Some(designer) = &mut self.designer else { return };
        let before = designer.document.revision();
        let name = designer.file.name();
        let reloaded = designer.reload();
        let is_changed = designer.document.revision() != before;
        if designer.conflict.is_some() && !designer.is_open {
            self.messages.note(format!("{name} was changed here and outside: F2 asks which to keep"));
        }
        let had_problems = self.messages.file.as_ref().is_some_and(|file| file.diagnostics.is_some());
        match reloaded {
            Ok(()) if is_changed || had_problems => self.try_layout(LayoutCause::Saved),
            Ok(()) => {}
            Err(diagnostics) => {
                let diagnostics = Some(diagnostics);
                self.messages.file = Some(FileNote { name, at_s: self.now_s, diagnostics, cause: None });
            }
        }
    }

    /// The button that changes the mode, as F2 does.
    pub(in crate::preview) fn mode_button(&mut self, ui: &mut Ui) {
        let Some(designer) = &self.designer else { return };
        let button = egui::Button::selectable(designer.is_open, "Design").frame_when_inactive(true);
        if ui
            .add_enabled(!self.is_checking(), button)
            .on_hover_text("Design the layout, or try it with feet; F2 does the same")
            .clicked()
        {
            self.turn_mode(ui.ctx());
        }
    }

    /// Opens the layout in Design mode too when the user puts another one on the floor by name.
    pub(in crate::preview) fn design_choice(&mut self, choice: usize) {
        let (Some(designer), Some(name)) = (&mut self.designer, self.choices.get(choice)) else { return };
        let name = name.clone();
        match schema::builtin_layout(&name).filter(|_| !Path::new(&name).exists()) {
            Some(text) => drop(designer.begin_untitled(&name, text)),
            None => drop(designer.open(Path::new(&name))),
        }
    }

    /// Puts the layout on the screen on the floor.
    pub(super) fn try_layout(&self, cause: LayoutCause) {
        let Some(designer) = &self.designer else { return };
        let layout = Arc::new(designer.layout().clone());
        let name = designer.file.name();
        let warnings = Warnings::from(&designer.review());
        self.command(PreviewCommand::Try { layout, name, warnings, cause });
    }

    /// Draws the window in Design mode.
    pub(in crate::preview) fn design(&mut self, ui: &mut Ui) {
        let Some(mut designer) = self.designer.take() else { return };
        designer.refresh();
        designer.refresh_undrawn(ui.ctx());
        let before = designer.document.revision();
        let theme = self.theme;
        designer.keys(ui);
        designer.bar(ui, &theme, &self.choices);
        designer.questions(ui, &theme);
        designer.ask(ui, &theme);
        // This frame shows the edits so far: records may have changed places.
        designer.refresh();
        designer.palette_panel(ui, &theme, &mut self.palette);
        self.problems(ui);
        designer.side_panel(ui, &theme);
        designer.text_panel(ui, &theme);
        let frame = egui::Frame::new();
        egui::CentralPanel::default().frame(frame).show(ui, |ui| {
            designer.canvas(ui, &theme, &mut self.palette);
        });
        designer.focus = None;
        let is_changed = designer.document.revision() != before;
        let wish = designer.wish.take();
        self.designer = Some(designer);
        // The floor of a server gets the edits only when the user tries them.
        if is_changed && self.server.is_none() {
            self.try_layout(LayoutCause::Designed);
        }
        if let Some(wish) = wish {
            self.command(wish);
        }
        self.leave(ui.ctx());
    }
}
