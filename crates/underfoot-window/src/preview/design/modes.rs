//! The connection of Design mode to the rest of the window: input from the program, output to the floor.

use std::path::Path;
use std::sync::Arc;

use eframe::egui::{self, Key, Ui};

use super::{Designer, Pane};
use crate::preview::feed::{LayoutCause, PreviewCommand, Warnings};
use crate::preview::floor_view::FloorFeet;
use crate::preview::messages::FileNote;
use crate::preview::shown::ShownFloor;
use crate::preview::stage::StageOfWindow;
use crate::preview::zoom::Zoom;
use underfoot::schema;
use underfoot::widget::WidgetId;
use underfoot_scene::egui_painter::Palette;
use underfoot_scene::scene::Theme;

impl Designer {
    /// Changes between Design and Try; the floor then gets the edited layout, with the text that was just being
    /// typed.
    pub(in crate::preview) fn turn_mode(&mut self, ctx: &egui::Context, feet: &mut FloorFeet) {
        if self.is_open {
            if let Some(id) = ctx.memory(|memory| memory.focused()) {
                ctx.memory_mut(|memory| memory.surrender_focus(id));
            }
            self.delays.leaves_in = 2;
            return ctx.request_repaint();
        }
        self.is_open = true;
        ctx.request_repaint();
        // No simulated foot stands on the canvas in Design mode.
        feet.lift();
    }

    /// Leaves Design mode once the typed text is in the layout, and in the file if a save is pending.
    fn leave(&mut self, ctx: &egui::Context, shown: &ShownFloor) {
        if self.delays.leaves_in == 0 {
            return;
        }
        if self.delays.saves_in == 0 {
            self.delays.leaves_in -= 1;
        }
        if self.delays.leaves_in > 0 {
            return ctx.request_repaint();
        }
        self.is_open = false;
        self.try_layout(shown, LayoutCause::Designed);
    }

    /// Changes the mode on F2; in any mode, reads files that are dropped on the window or saved outside, and keeps a
    /// draft unless the window is closing.
    pub(in crate::preview) fn follow(
        &mut self,
        ui: &Ui,
        shown: &mut ShownFloor,
        feet: &mut FloorFeet,
        is_closing: bool,
    ) {
        if ui.input(|i| i.key_pressed(Key::F2)) {
            self.turn_mode(ui.ctx(), feet);
        }
        let dropped = ui.input(|i| i.raw.dropped_files.first().map(|file| file.path().to_path_buf()));
        if let Some(path) = dropped {
            if self.open(&path) {
                self.try_layout(shown, LayoutCause::Opened);
            } else if let Some(message) = &self.edited.message {
                shown.messages.note(message.text.clone());
            }
        }
        if std::mem::take(&mut shown.messages.files_changed) {
            self.take_in_files(shown);
        }
        if !is_closing {
            self.keep(shown.now_s);
        }
        let path = self.storage.file.path().map(Path::to_path_buf);
        if path != self.storage.watched {
            self.storage.watched.clone_from(&path);
            shown.command(PreviewCommand::Watch(path));
        }
    }

    /// Reads the files that were saved outside and puts the layout on the floor.
    fn take_in_files(&mut self, shown: &mut ShownFloor) {
        let before = self.edited.document.revision();
        let name = self.storage.file.name();
        let reloaded = self.reload();
        let is_changed = self.edited.document.revision() != before;
        if self.storage.conflict.is_some() && !self.is_open {
            shown.messages.note(format!("{name} was changed here and outside: F2 asks which to keep"));
        }
        let had_problems = shown.messages.file.as_ref().is_some_and(|file| file.diagnostics.is_some());
        match reloaded {
            Ok(()) if is_changed || had_problems => self.try_layout(shown, LayoutCause::Saved),
            Ok(()) => {}
            Err(diagnostics) => {
                let diagnostics = Some(diagnostics);
                shown.messages.file = Some(FileNote { name, at_s: shown.now_s, diagnostics, cause: None });
            }
        }
    }

    /// Opens the layout called `name`, which the user has put on the floor: a built-in one, or a file.
    pub(in crate::preview) fn open_choice(&mut self, name: &str) {
        match schema::builtin_layout(name).filter(|_| !Path::new(name).exists()) {
            Some(text) => drop(self.begin_untitled(name, text)),
            None => drop(self.open(Path::new(name))),
        }
    }

    /// Puts the layout on the screen on the floor.
    pub(super) fn try_layout(&self, shown: &ShownFloor, cause: LayoutCause) {
        let layout = Arc::new(self.layout().clone());
        let name = self.storage.file.name();
        let warnings = Warnings::from(&self.edited.review());
        shown.command(PreviewCommand::Try { layout, name, warnings, cause });
    }

    /// Begins a frame of Design mode, before the bars: handles the keys. Returns the revision of the layout before.
    pub(in crate::preview) fn begin_frame(&mut self, ui: &Ui) -> u64 {
        self.edited.refresh();
        self.edited.refresh_undrawn(ui.ctx());
        let before = self.edited.document.revision();
        self.keys(ui);
        before
    }

    /// Draws the window in Design mode. `before` is the revision of the layout at the start of this frame.
    pub(in crate::preview) fn show(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        shown: &ShownFloor,
        palette: &mut Palette,
        stage: &mut StageOfWindow,
        before: u64,
    ) {
        // This frame shows the edits so far: records may have changed places.
        self.edited.refresh();
        // A narrow window has room for one pane: the palette, or the fields of what is selected.
        let (things, fields) = match stage.is_wide() {
            true => (true, stage.has_side),
            false => (self.edited.selected.is_empty(), !self.edited.selected.is_empty() && stage.has_side),
        };
        if things || self.panes.pane == Some(Pane::Things) {
            self.things.panel(
                ui,
                theme,
                palette,
                &mut self.edited,
                &mut self.canvas.placing,
                &mut self.panes,
            );
        }
        if fields || self.panes.pane == Some(Pane::Fields) {
            self.inspector.panel(ui, theme, palette, &mut self.edited, &mut self.panes);
        }
        if stage.is_wide() && !self.text.is_open {
            stage.widths.note(stage.window, ui.available_rect_before_wrap());
        }
        self.text.panel(ui, theme, &mut self.edited, &mut self.panes);
        let frame = egui::Frame::new();
        egui::CentralPanel::default().frame(frame).show(ui, |ui| {
            stage.canvas = ui.available_rect_before_wrap();
            self.canvas.show(ui, theme, palette, &mut self.edited, stage.floor());
        });
        self.panes.focus = None;
        // The floor of a server gets the edits only when the user tries them.
        if self.edited.document.revision() != before && shown.server.is_none() {
            self.try_layout(shown, LayoutCause::Designed);
        }
        if let Some(wish) = self.inspector.wish.take() {
            shown.command(wish);
        }
        self.leave(ui.ctx(), shown);
    }

    /// Selects the control that a foot used last, if it has used another one since the last time.
    pub(in crate::preview) fn select_used(&mut self, used: Option<&WidgetId>) {
        let Some(id) = used.filter(|id| self.used.as_ref() != Some(*id)) else { return };
        self.used = Some(id.clone());
        self.edited.refresh();
        let index = self.edited.layout().widget_index(id.as_str());
        if let Some(record) = index.and_then(|index| self.edited.document.record_of(index)) {
            self.edited.select_only(record);
        }
    }

    /// The part of the floor on the screen.
    pub(in crate::preview) fn zoom_mut(&mut self) -> &mut Zoom {
        &mut self.canvas.view
    }
}
