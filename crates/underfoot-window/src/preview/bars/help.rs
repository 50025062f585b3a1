//! Help: the keys and gestures of the present mode, at the lower edge and in a menu.

use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{Color32, FontId, Grid, Margin, Panel, PopupCloseBehavior, RichText, Ui};

use crate::preview::OpenSetUp;
use crate::preview::appearance::Appearance;
use crate::preview::handheld::menu_content;
use crate::preview::icons::{Icon, named, short};
use crate::preview::messages::WindowMessages;
use crate::preview::style::{panel_frame, quiet};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Height of the window below which the help bar is hidden, in points.
const HELP: f32 = 560.0;

/// Size of the letters in the help bar, in points.
const LETTERS: f32 = 12.0;

/// The use of the window by its user.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::preview) enum HelpTopic {
    Designing,
    Checking,
    DrawingWalks,
    /// A second window shows the floor for a projector.
    Projecting,
    /// The mouse is a foot.
    Stepping,
    /// A recording is on display.
    Replaying,
    /// A floor is on display only.
    Watching {
        /// Whether it is rendered: without rendering there is nothing to mute.
        is_rendered: bool,
    },
}

impl HelpTopic {
    /// Keys and gestures, each with its action.
    const fn steps(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Designing => &[
                ("Drag", "move"),
                ("Corners", "size"),
                ("Arrows", "nudge"),
                ("Ctrl", "no snapping"),
                ("Shift-click", "select more"),
                ("Ctrl-D, Delete", "double, remove"),
                ("Ctrl-Z", "undo"),
                ("Wheel", "zoom"),
                ("F2", "try it"),
            ],
            Self::Checking => &[("Step", "where the floor is marked"), ("Escape", "end the check")],
            Self::DrawingWalks => &[
                ("Drag", "a way over the floor: somebody walks it"),
                ("End on a control", "they use it"),
                ("Ctrl-wheel", "zoom"),
                ("W, Escape", "be a foot again"),
            ],
            Self::Stepping => &[
                ("Hold", "press"),
                ("Drag", "slide"),
                ("Wheel, R, F", "harder, softer"),
                ("Ctrl-wheel", "zoom"),
                ("Right-drag, Q, E", "turn"),
                ("Space", "stance foot here"),
                ("Shift-click", "look at a tile"),
                ("Tab, Enter", "press by keyboard"),
                ("W", "draw a walk"),
                ("P", "plots"),
                ("M", "mute"),
            ],
            Self::Projecting => &[
                ("In the projected window: C", "adjust the corners"),
                ("Tab, Arrows", "move one by a pixel"),
                ("Ctrl-Z", "undo"),
                ("F, N", "full screen, next screen"),
                ("T", "check page"),
                ("+, -", "brightness"),
                ("M, R", "mirror, turn"),
                ("F11", "close"),
            ],
            Self::Replaying => &[
                ("Space", "pause"),
                ("Comma, Period", "a step back, on"),
                ("Shift-drag", "repeat a part"),
                ("Click", "look at a tile"),
                ("Ctrl-wheel", "zoom"),
            ],
            Self::Watching { is_rendered: true } => {
                &[("Click", "look at a tile"), ("Arrows", "the next one"), ("M", "mute")]
            }
            Self::Watching { is_rendered: false } => {
                &[("Click", "look at a tile"), ("Arrows", "the next one")]
            }
        }
    }
}

/// Shows how to use the floor, if the window is tall enough.
pub(in crate::preview) fn help_bar(ui: &mut Ui, theme: &Theme, activity: HelpTopic) {
    if ui.ctx().content_rect().height() < HELP {
        return;
    }
    let frame = panel_frame(theme, Margin::symmetric(14, 5));
    Panel::bottom("help bar").frame(frame).resizable(false).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 5.0;
            let width = |ui: &Ui, text: &str| {
                let font = FontId::proportional(LETTERS);
                ui.painter().layout_no_wrap(text.to_owned(), font, Color32::PLACEHOLDER).size().x
            };
            // A narrow window shows the first ones only; the menu lists the rest.
            for (key, does) in activity.steps() {
                if width(ui, key) + width(ui, does) + 5.0 > ui.available_width() {
                    break;
                }
                ui.label(RichText::new(*key).size(LETTERS).color(color(theme.ink)));
                ui.label(RichText::new(*does).size(LETTERS).color(color(theme.quiet)));
                ui.add_space(9.0);
            }
        });
    });
}

/// A menu with all keys and gestures of the present mode, a switch for the first steps on the floor, and the set-up of a
/// real floor if there is one.
pub(super) fn help_menu(
    ui: &mut Ui,
    theme: &Theme,
    activity: HelpTopic,
    is_compact: bool,
    appearance: &mut Appearance,
    set_up: Option<OpenSetUp>,
    messages: &mut WindowMessages,
) {
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let (button, _) =
        MenuButton::new(short(Icon::CircleQuestionMark, "Help", is_compact)).config(config).ui(ui, |ui| {
            ui.set_min_width(260.0);
            menu_content(ui, |ui| {
                Grid::new("help").spacing([14.0, 3.0]).min_row_height(LETTERS).show(ui, |ui| {
                    for (key, does) in activity.steps() {
                        ui.label(RichText::new(*key).color(color(theme.ink)));
                        ui.label(quiet(theme, *does));
                        ui.end_row();
                    }
                });
                ui.separator();
                let mut has_steps = appearance.has_steps();
                if ui.checkbox(&mut has_steps, "First steps on the floor").changed() {
                    appearance.show_steps(ui.ctx(), has_steps, messages);
                }
                if let Some(open) = set_up {
                    let button = ui.button("Set up a real floor");
                    if button
                        .on_hover_text("Finds boards, wiring and calibration, in a window of its own")
                        .clicked()
                    {
                        messages.note(open());
                        ui.close();
                    }
                }
            });
        });
    named(button, "Help");
}
