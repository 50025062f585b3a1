//! Use of controls by keyboard: the control with the focus is under a foot.

use eframe::egui::{Key, Ui};
use glam::Vec2;

use super::feet::{HandInput, Move};
use underfoot::layout::Layout;
use underfoot::widget::Behaviour;

/// Speed at which arrow keys slide the foot, in metres per second.
const SLIDE_M_S: f32 = 0.25;

/// The foot of the keyboard.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Keyboard {
    /// The position at which it presses.
    at: Option<Vec2>,
    /// The control with the focus.
    focused: Option<usize>,
}

impl Keyboard {
    /// Sets the control with the focus, if any.
    pub(super) fn focus(&mut self, control: Option<usize>) {
        self.focused = control;
    }

    /// The input of the foot from the keyboard: Enter or Space presses the control with the focus while held, and the
    /// arrow keys slide the foot over it. `None` while the mouse moves the foot.
    pub(super) fn hand(&mut self, ui: &Ui, layout: &Layout, elapsed_s: f32) -> Option<HandInput> {
        let widget = self.focused.and_then(|index| layout.widgets.get(index));
        let held = widget.is_some() && ui.input(|i| i.key_down(Key::Enter) || i.key_down(Key::Space));
        let mut hand = HandInput { down: held, elapsed_s, ..HandInput::default() };
        match (self.at, widget.filter(|_| held)) {
            (None, None) => return None,
            (None, Some(widget)) => {
                // From there, a relative slider keeps its value, and an absolute one takes the middle.
                let at = widget.area.centre();
                hand.moves = vec![Move::Press(at)];
                self.at = Some(at);
            }
            (Some(at), Some(widget)) => {
                let way = |key: Key| ui.input(|i| f32::from(u8::from(i.key_down(key))));
                let east = way(Key::ArrowRight) - way(Key::ArrowLeft);
                let north = way(Key::ArrowUp) - way(Key::ArrowDown);
                let slides = !matches!(widget.behaviour, Behaviour::Button(_) | Behaviour::Switch(_));
                let way = if slides { Vec2::new(east, north) } else { Vec2::ZERO };
                let to = (at + way * SLIDE_M_S * elapsed_s.min(0.1)).clamp(widget.area.min, widget.area.max);
                hand.moves = vec![Move::To(to)];
                self.at = Some(to);
            }
            (Some(at), None) => {
                hand.moves = vec![Move::Release(at)];
                hand.pointer = Some(at);
                self.at = None;
                return Some(hand);
            }
        }
        hand.pointer = self.at;
        Some(hand)
    }
}
