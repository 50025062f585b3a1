//! The window's title, saving from either mode, and the question before the window closes.

use eframe::egui::{self, Context, Key, Modal, Modifiers, Ui, ViewportCommand};

use super::design::Designer;
use underfoot_scene::scene::Theme;

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

/// The window's title: the program's name, behind that of the layout or the recording.
pub(super) struct Title {
    name: String,
    /// The title that the window has.
    pub(super) shown: Option<String>,
}

impl Title {
    /// `name` is the program's name.
    pub(super) fn new(name: &str) -> Self {
        Self { name: name.to_owned(), shown: None }
    }

    /// Sets the window's title: `subject` and the program's name, or that name alone.
    pub(super) fn show(&mut self, ctx: &Context, subject: Option<&str>) {
        let title = subject.map_or_else(|| self.name.clone(), |subject| format!("{subject} - {}", self.name));
        if self.shown.as_ref() != Some(&title) {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.shown = Some(title);
        }
    }
}

impl Closing {
    pub(super) fn is_granted(self) -> bool {
        self == Self::Granted
    }

    /// Lets the window close, unless edits would be lost. The request may come from the window manager, a key or a
    /// button, also while the window is covered and not drawn.
    pub(super) fn handle_request(&mut self, ctx: &Context, designer: &Designer) {
        if !ctx.input(|i| i.viewport().close_requested()) || self.is_granted() {
            return;
        }
        let is_typing = ctx.text_edit_focused();
        if designer.is_saved() && !is_typing {
            return;
        }
        ctx.send_viewport_cmd(ViewportCommand::CancelClose);
        for seen in [ViewportCommand::Minimized(false), ViewportCommand::Focus] {
            ctx.send_viewport_cmd(seen);
        }
        if is_typing {
            finish_typing(ctx);
        }
        if *self == Self::No {
            *self = Self::Settling(SETTLES);
        }
        ctx.request_repaint();
    }

    /// Advances the state of closing: asks about unsaved edits and carries out the answer.
    pub(super) fn ask(&mut self, ctx: &Context, designer: &mut Designer) {
        *self = match *self {
            Self::Settling(0) if designer.is_saved() => Self::Granted,
            Self::Settling(0) => {
                // The buttons of the question get the keyboard focus.
                finish_typing(ctx);
                Self::Asks
            }
            Self::Settling(frames) => {
                ctx.request_repaint();
                Self::Settling(frames - 1)
            }
            Self::Saves if designer.is_saved() => Self::Granted,
            // The screen shows the obstacle.
            Self::Saves if !designer.is_asking() => Self::No,
            other => other,
        };
        if *self == Self::Asks {
            *self = ask(ctx, &designer.name());
            match *self {
                Self::Saves => designer.save(),
                Self::Granted => designer.discard(),
                _ => {}
            }
            if *self != Self::Asks {
                ctx.request_repaint();
            }
        }
        if self.is_granted() {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        }
    }
}

/// Closes the window on Ctrl+Q, as its frame does.
pub(super) fn handle_quit_key(ui: &Ui) {
    if ui.input_mut(|i| i.consume_key(Modifiers::COMMAND, Key::Q)) {
        ui.ctx().send_viewport_cmd(ViewportCommand::Close);
    }
}

/// Shows the layout's file with its dot; outside Design mode also the last message about it.
pub(super) fn file_name(ui: &mut Ui, theme: &Theme, designer: &Designer) {
    let ink = if designer.is_saved() { theme.quiet } else { theme.ink };
    let name = egui::RichText::new(designer.title()).color(underfoot_scene::egui_painter::color(ink));
    let hint = if designer.is_saved() { "Saved" } else { "Not saved: Ctrl+S saves it" };
    ui.add(egui::Label::new(name).truncate()).on_hover_text(hint);
}

/// Ends the typing in a field, so that its text is applied.
fn finish_typing(ctx: &Context) {
    if let Some(id) = ctx.memory(|memory| memory.focused()) {
        ctx.memory_mut(|memory| memory.surrender_focus(id));
    }
}

/// Shows the question; returns the next state.
fn ask(ctx: &Context, name: &str) -> Closing {
    let mut decided = Closing::Asks;
    let frame = egui::Frame::popup(&ctx.global_style()).inner_margin(18);
    let modal = Modal::new(egui::Id::unique("before closing")).frame(frame).show(ctx, |ui| {
        ui.set_width(380.0_f32.min(ctx.content_rect().width() - 60.0));
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
