//! The connection of Design mode to the rest of the window: input from the program, output to the floor.

use std::path::Path;
use std::sync::Arc;

use eframe::egui::{self, Key, Ui};

use super::arrivals::receive_file;
use super::{Designer, Pane};
use crate::platform;
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
        if let Some(dropped) = ui.input(|i| i.raw.dropped_files.first().cloned()) {
            self.storage.inbox.take_dropped(&dropped);
        }
        let next = self.storage.inbox.next(ui.ctx());
        receive_file(self, shown, next);
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
        match schema::builtin_layout(name).filter(|_| !platform::is_file(Path::new(name))) {
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
        self.panes.is_narrow = !stage.is_wide();
        self.panes.sheet = stage.sheet();
        let is_down = ui.input(|i| i.pointer.any_down() || i.pointer.any_released());
        self.panes.puts_down = self.canvas.placing.is_some() && !is_down;
        let [things, fields, text] = self.panes_on_display(stage);
        if things {
            let canvas = &mut self.canvas;
            self.things.panel(ui, theme, palette, &mut self.edited, canvas, &mut self.panes);
        }
        if fields {
            self.inspector.panel(ui, theme, palette, &mut self.edited, &mut self.panes, stage);
        }
        stage.note(ui.available_rect_before_wrap());
        if text {
            self.text.panel(ui, theme, &mut self.edited, &mut self.panes, stage);
        }
        let frame = egui::Frame::new();
        egui::CentralPanel::default().frame(frame).show(ui, |ui| {
            stage.canvas = ui.available_rect_before_wrap();
            self.canvas.show(ui, theme, palette, &mut self.edited, stage.view_room());
        });
        self.panes.focus = None;
        let pressed = ui.input(|i| i.pointer.interact_pos().filter(|_| i.pointer.any_pressed()));
        if pressed.is_some_and(|at| stage.canvas.contains(at)) {
            self.panes.is_led = false;
        }
        // The floor of a server gets the edits only when the user tries them.
        if self.edited.document.revision() != before && shown.server.is_none() {
            self.try_layout(shown, LayoutCause::Designed);
        }
        if let Some(wish) = self.inspector.wish.take() {
            shown.command(wish);
        }
        self.leave(ui.ctx(), shown);
    }

    /// Whether the palette, the fields and the text are on display. A narrow window has room for one panel: the one to
    /// which F6 led, the text, the fields of the selection, or the palette.
    fn panes_on_display(&self, stage: &StageOfWindow) -> [bool; 3] {
        let (pane, text) = (self.panes.pane.filter(|_| self.panes.is_led), self.text.is_open);
        if stage.is_wide() {
            return [true, stage.has_side || pane == Some(Pane::Fields), text];
        }
        if stage.sheet().is_some() {
            let [things, fields] = [self.panes.shows_things && !self.panes.puts_down, stage.has_side];
            return [things, fields && !things, text && !fields && !things];
        }
        let is_selected = !self.edited.selected.is_empty();
        match pane {
            Some(Pane::Things | Pane::Floor) => [true, false, false],
            Some(Pane::Fields) => [false, true, false],
            _ if text => [false, false, true],
            _ => [!is_selected, is_selected && stage.has_side, false],
        }
    }

    /// Whether the list of things and the text are open, in a window in a hand.
    pub(in crate::preview) fn sheets(&mut self) -> [&mut bool; 2] {
        [&mut self.panes.shows_things, &mut self.text.is_open]
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
