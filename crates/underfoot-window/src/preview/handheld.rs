//! Windows in a hand: those of phones and tablets, which fingers use, and which have no room beside the floor.

use eframe::egui::{self, Context, Event, Panel, Rect, ScrollArea, Ui, vec2};

use super::stage::WIDE;
use crate::platform;

/// Side of a target for a finger, in points: a finger tip covers some 9 mm, and 44 points of a phone are 7 to 9 mm.
pub(super) const TARGET: f32 = 44.0;

/// Room around the icon of a button for fingers, which makes it about as wide as high, in points.
const ICON_PADDING: egui::Vec2 = vec2(15.5, 4.0);

/// Room beside the word of a button for fingers, in points.
const WORD_PADDING: f32 = 11.5;

/// Width below which a window counts as one in a hand, in points: phones that are held upright have 320 to 480.
const NARROW: f32 = 600.0;

/// Height below which a window counts as one in a hand, in points: phones that are held across have 320 to 400.
const LOW: f32 = 400.0;

/// Share of the window that an open panel takes.
const SHEET: f32 = 0.45;

/// Maximum width of an open panel, in points.
const WIDEST: f32 = 360.0;

/// How a window is held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum WindowHold {
    /// On a desk, with a mouse.
    #[default]
    Desk,
    /// In a hand, higher than wide.
    Upright,
    /// In a hand, wider than high.
    Across,
}

impl WindowHold {
    /// Whether fingers use it.
    pub(super) fn is_in_hand(self) -> bool {
        self != Self::Desk
    }

    /// The place of the open panel in a window with this room for floor and panels; `None` where panels have their usual
    /// places.
    pub(super) fn sheet(self, room: Rect) -> Option<PanelSheet> {
        match self {
            Self::Desk => None,
            _ if room.width() >= WIDE => None,
            Self::Upright => Some(PanelSheet { is_below: true, size: SHEET * room.height() }),
            Self::Across => Some(PanelSheet { is_below: false, size: (SHEET * room.width()).min(WIDEST) }),
        }
    }
}

/// Watches for fingers on the window.
#[derive(Clone, Copy, Debug)]
pub(super) struct HoldWatch {
    /// Whether the system has said so, or fingers were there and are gone.
    is_touched: bool,
    was_touched: bool,
}

impl Default for HoldWatch {
    fn default() -> Self {
        Self { is_touched: platform::has_coarse_pointer(), was_touched: false }
    }
}

impl HoldWatch {
    /// How the window is held in this frame. A window that a finger has touched stays one for fingers.
    pub(super) fn follow(&mut self, ctx: &Context) -> WindowHold {
        let (comes, is_down) = ctx
            .input(|i| (i.events.iter().any(|event| matches!(event, Event::Touch { .. })), i.any_touches()));
        self.was_touched |= comes;
        // Nothing moves under a finger.
        self.is_touched |= self.was_touched && !is_down && !comes;
        let size = ctx.content_rect().size();
        match self.is_touched || size.x < NARROW || size.y < LOW {
            false => WindowHold::Desk,
            true if size.y > size.x => WindowHold::Upright,
            true => WindowHold::Across,
        }
    }
}

/// The place of an open panel in a window in a hand: below the floor, or at its right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PanelSheet {
    is_below: bool,
    /// Height or width, in points.
    size: f32,
}

impl PanelSheet {
    /// The panel; one is open at a time.
    pub(super) fn panel(self) -> Panel {
        let panel = if self.is_below { Panel::bottom("sheet below") } else { Panel::right("sheet beside") };
        panel.resizable(false).exact_size(self.size)
    }
}

/// `sheet`, or the panel that `usual` makes.
pub(super) fn panel_at(sheet: Option<PanelSheet>, usual: impl FnOnce() -> Panel) -> Panel {
    sheet.map_or_else(usual, PanelSheet::panel)
}

/// Gives all buttons and fields the size of a finger, or that of a mouse pointer again.
pub(super) fn fit_targets(ctx: &Context, for_fingers: bool) {
    let usual = egui::Spacing::default();
    ctx.all_styles_mut(|style| {
        let spacing = &mut style.spacing;
        spacing.interact_size.y = if for_fingers { TARGET } else { usual.interact_size.y };
        spacing.button_padding = if for_fingers { ICON_PADDING } else { super::style::BUTTON_PADDING };
        // A hint fits the narrowest phone.
        spacing.tooltip_width = if for_fingers { 280.0 } else { usual.tooltip_width };
        spacing.icon_width = if for_fingers { 22.0 } else { usual.icon_width };
        spacing.icon_width_inner = if for_fingers { 13.0 } else { usual.icon_width_inner };
    });
}

/// Whether the buttons of `ui` have the size of fingers.
pub(super) fn is_for_fingers(ui: &Ui) -> bool {
    ui.spacing().interact_size.y >= TARGET
}

/// Side of a target that has `usual` points for a mouse.
pub(super) fn side(ui: &Ui, usual: f32) -> f32 {
    if is_for_fingers(ui) { TARGET } else { usual }
}

/// Shows a button with a word, whose sides are nearer to it than those of an icon where fingers use it.
pub(super) fn with_word<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) -> R {
    let usual = ui.spacing().button_padding.x;
    if is_for_fingers(ui) {
        ui.spacing_mut().button_padding.x = WORD_PADDING;
    }
    let shown = add(ui);
    ui.spacing_mut().button_padding.x = usual;
    shown
}

/// Shows the content of a menu, which scrolls where it is higher than a screen for fingers.
pub(super) fn menu_content<R>(ui: &mut Ui, add: impl FnOnce(&mut Ui) -> R) -> R {
    if !is_for_fingers(ui) {
        return add(ui);
    }
    let most = ui.ctx().content_rect().height() - TARGET;
    // Otherwise a menu has the usual height of an area.
    ui.set_max_height(most);
    ScrollArea::vertical().max_height(most).show(ui, add).inner
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::pos2;

    /// How a window of this size is held that nobody has touched.
    fn hold(width: f32, height: f32) -> WindowHold {
        let ctx = Context::default();
        let screen_rect = Some(Rect::from_min_size(pos2(0.0, 0.0), vec2(width, height)));
        let mut watch = HoldWatch { is_touched: false, was_touched: false };
        let mut hold = WindowHold::Desk;
        let input = egui::RawInput { screen_rect, ..egui::RawInput::default() };
        ctx.run_ui(input, |ui| hold = watch.follow(ui.ctx())).textures_delta.clear();
        hold
    }

    #[test]
    fn small_screens_are_in_a_hand_and_those_of_desks_only_once_a_finger_touches_them() {
        assert_eq!(hold(390.0, 844.0), WindowHold::Upright);
        assert_eq!(hold(844.0, 390.0), WindowHold::Across);
        for (width, height) in [(640.0, 800.0), (720.0, 480.0), (1280.0, 800.0)] {
            assert_eq!(hold(width, height), WindowHold::Desk, "{width} x {height}");
        }
    }

    #[test]
    fn panels_leave_more_than_half_of_the_room_to_the_floor() {
        let room = |width, height| Rect::from_min_size(pos2(0.0, 100.0), vec2(width, height));
        for (hold, room) in
            [(WindowHold::Upright, room(390.0, 700.0)), (WindowHold::Across, room(844.0, 290.0))]
        {
            let sheet = hold.sheet(room).unwrap();
            let whole = if sheet.is_below { room.height() } else { room.width() };
            assert!(sheet.size < 0.5 * whole, "{sheet:?}");
        }
        assert_eq!(WindowHold::Across.sheet(room(1180.0, 700.0)), None, "a large tablet has room beside it");
        assert_eq!(WindowHold::Desk.sheet(room(640.0, 700.0)), None);
    }
}
