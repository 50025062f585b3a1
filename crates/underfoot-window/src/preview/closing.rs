//! The window's title, saving from either mode, and the question before the window closes.

use eframe::egui::{self, Context, Key, Modal, Modifiers, Ui, ViewportCommand};

use super::app::App;
use super::style::pill;

/// The state of closing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Closing {
    /// No request to close.
    #[default]
    No,
    /// Waits this many frames for the text of a field to get into the layout.
    Settling(u8),
    /// Asks the user about unsaved edits.
    Asks,
    /// Closes once the layout is saved.
    Saves,
    /// Closes.
    Granted,
}

/// Frames after which the text of a field that has lost the focus is in the layout.
const SETTLES: u8 = 3;

impl App {
    pub(super) fn is_closing(&self) -> bool {
        self.closing == Closing::Granted
    }

    /// Lets the window close, unless edits would be lost. The request may come from the window manager, a key or a
    /// button, also while the window is covered and not drawn.
    pub(super) fn handle_close(&mut self, ctx: &Context) {
        if !ctx.input(|i| i.viewport().close_requested()) || self.closing == Closing::Granted {
            return;
        }
        let Some(designer) = &self.designer else { return };
        let is_typing = ctx.text_edit_focused();
        if designer.is_saved() && !is_typing {
            return;
        }
        ctx.send_viewport_cmd(ViewportCommand::CancelClose);
        for seen in [ViewportCommand::Minimized(false), ViewportCommand::Focus] {
            ctx.send_viewport_cmd(seen);
        }
        if is_typing {
            designer.finish_typing(ctx);
        }
        if self.closing == Closing::No {
            self.closing = Closing::Settling(SETTLES);
        }
        ctx.request_repaint();
    }

    /// Ctrl+Q closes the window, as its frame does; Ctrl+S saves, also in Try mode.
    pub(super) fn handle_file_keys(&mut self, ui: &Ui) {
        if ui.input_mut(|i| i.consume_key(Modifiers::COMMAND, Key::Q)) {
            ui.ctx().send_viewport_cmd(ViewportCommand::Close);
        }
        // In Design mode, `Designer::keys_anywhere` handles them, after the text fields.
        if !self.is_designing()
            && let Some(designer) = &mut self.designer
        {
            designer.keys_to_save(ui);
        }
    }

    /// Shows the path dialogue in Try mode.
    pub(super) fn ask_for_path(&mut self, ui: &mut Ui) {
        let theme = self.theme;
        if let Some(designer) = &mut self.designer {
            designer.ask(ui, &theme);
        }
    }

    /// Sets the window's title: the layout's file, with a dot while it is unsaved, or the recording.
    pub(super) fn show_title(&mut self, ctx: &Context) {
        let title = match (&self.designer, &self.time_line) {
            (Some(designer), _) => format!("{} - {}", designer.title(), self.name),
            (None, Some(_)) => format!("{} - {}", self.source, self.name),
            (None, None) => self.name.clone(),
        };
        if self.titled.as_ref() != Some(&title) {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.titled = Some(title);
        }
    }

    /// Shows the layout's file with its dot, and the last message about it.
    pub(super) fn file_name(&self, ui: &mut Ui) {
        let Some(designer) = &self.designer else { return };
        let theme = &self.theme;
        let ink = if designer.is_saved() { theme.quiet } else { theme.ink };
        let name = egui::RichText::new(designer.title()).color(underfoot_scene::egui_painter::color(ink));
        let hint = if designer.is_saved() { "Saved" } else { "Not saved: Ctrl+S saves it" };
        ui.add(egui::Label::new(name).truncate()).on_hover_text(hint);
        if !self.is_designing()
            && let Some((text, is_bad)) = designer.last_message()
        {
            pill(ui, if is_bad { theme.fault } else { theme.good }, theme, text);
        }
    }

    /// Advances the state of closing: asks about unsaved edits and carries out the answer.
    pub(super) fn ask_before_closing(&mut self, ctx: &Context) {
        let Some(designer) = &mut self.designer else { return };
        self.closing = match self.closing {
            Closing::Settling(0) if designer.is_saved() => Closing::Granted,
            Closing::Settling(0) => {
                // The buttons of the question get the keyboard focus.
                designer.finish_typing(ctx);
                Closing::Asks
            }
            Closing::Settling(frames) => {
                ctx.request_repaint();
                Closing::Settling(frames - 1)
            }
            Closing::Saves if designer.is_saved() => Closing::Granted,
            // The screen shows the obstacle.
            Closing::Saves if !designer.is_asking() => Closing::No,
            other => other,
        };
        if self.closing == Closing::Asks {
            self.closing = ask(ctx, &designer.name());
            match self.closing {
                Closing::Saves => designer.save_or_ask(),
                Closing::Granted => designer.discard(),
                _ => {}
            }
            if self.closing != Closing::Asks {
                ctx.request_repaint();
            }
        }
        if self.closing == Closing::Granted {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        }
    }
}

/// Shows the question; returns the next state.
fn ask(ctx: &Context, name: &str) -> Closing {
    let mut decided = Closing::Asks;
    let frame = egui::Frame::popup(&ctx.global_style()).inner_margin(18);
    let modal = Modal::new(egui::Id::unique("before closing")).frame(frame).show(ctx, |ui| {
        ui.set_width(380.0);
        ui.label(egui::RichText::new(format!("Save {name} before closing?")).size(16.0).strong());
        ui.add_space(4.0);
        ui.label("It has changes that are not in its file.");
        ui.add_space(10.0);
        ui.horizontal(|ui| {
            let save = ui.button("Save and close");
            if ui.memory(|memory| memory.focused().is_none()) {
                save.request_focus();
            }
            if save.clicked() {
                decided = Closing::Saves;
            }
            if ui.button("Discard changes").clicked() {
                decided = Closing::Granted;
            }
            if ui.button("Cancel").clicked() {
                decided = Closing::No;
            }
        });
    });
    if decided == Closing::Asks && modal.should_close() { Closing::No } else { decided }
}
