//! Adjustment of a projector's corners by mouse and keys, with undo.

use eframe::egui::util::undoer::Undoer;
use eframe::egui::{self, Event, Key, Modifiers, PointerButton, Pos2, Rect, Ui};
use glam::Vec2;

use super::picture::Picture;
use super::placement::Placement;

/// Radius of a corner's handle, in points.
pub(super) const HANDLE: f32 = 22.0;

/// Number of pixels that an arrow key moves a corner with Shift; without, it is one.
const WITH_SHIFT: f32 = 10.0;

/// The place of the floor on a picture, while the user adjusts it.
pub(super) struct Adjusted<'a> {
    /// `None` while the floor fits the picture.
    pub(super) placement: &'a mut Option<Placement>,
    /// The placement that fits the picture.
    pub(super) fit: Placement,
    pub(super) picture: Picture,
}

impl Adjusted<'_> {
    /// The placement on display.
    pub(super) fn now(&self) -> Placement {
        self.placement.unwrap_or(self.fit)
    }

    /// Sets the placement if it differs from the one on display.
    fn set(&mut self, placement: Placement) {
        if placement != self.now() {
            *self.placement = Some(placement);
        }
    }
}

/// The corner that the mouse holds.
struct HeldCorner {
    index: usize,
    /// Its offset from the pointer, in points.
    beside: egui::Vec2,
    /// The placement at the press, which Escape restores.
    before: Option<Placement>,
}

/// The editor of the corners of one projector.
#[derive(Default)]
pub(super) struct CornerEditor {
    /// The corner that keys move; `None` while the corners are not adjusted.
    selected: Option<usize>,
    held: Option<HeldCorner>,
    /// The corners that mouse or keys have placed since the adjustment began.
    placed: [bool; 4],
    /// One step for each drag, and for presses of keys that follow each other within a second.
    steps: Undoer<Option<Placement>>,
}

impl CornerEditor {
    /// The corner that keys move, from 0; `None` while the corners are not adjusted.
    pub(super) fn selected(&self) -> Option<usize> {
        self.selected
    }

    /// Whether the mouse holds a corner.
    pub(super) fn is_holding(&self) -> bool {
        self.held.is_some()
    }

    /// Whether all four corners have been placed, and none is held.
    pub(super) fn is_complete(&self) -> bool {
        self.selected.is_some() && self.held.is_none() && self.placed == [true; 4]
    }

    /// Begins or ends the adjustment.
    pub(super) fn toggle(&mut self) {
        let selected = if self.selected.is_some() { None } else { Some(0) };
        self.close();
        self.selected = selected;
    }

    /// Ends the adjustment if all four corners have been placed.
    pub(super) fn end_if_complete(&mut self) {
        if self.is_complete() {
            self.close();
        }
    }

    /// Ends the adjustment; the corners stay.
    pub(super) fn close(&mut self) {
        (self.selected, self.held, self.placed) = (None, None, [false; 4]);
    }

    /// Puts a held corner back, or else ends the adjustment; returns false if there was neither.
    pub(super) fn escape(&mut self, placement: &mut Option<Placement>) -> bool {
        if let Some(held) = self.held.take() {
            *placement = held.before;
            return true;
        }
        self.selected.take().is_some()
    }

    /// Handles the keys of the adjustment.
    pub(super) fn handle_keys(&mut self, ui: &Ui, adjusted: &mut Adjusted<'_>) {
        let Some(selected) = &mut self.selected else { return };
        let presses = |key: Key| ui.input(|i| i.num_presses(key));
        let (now_s, shift) = ui.input(|i| (i.time, i.modifiers.shift));
        if self.held.is_none() {
            self.steps.feed_state(now_s, adjusted.placement);
        }
        let tabs = presses(Key::Tab) % 4;
        *selected = (*selected + if shift { 4 - tabs } else { tabs }) % 4;
        for (index, key) in [Key::Num1, Key::Num2, Key::Num3, Key::Num4].into_iter().enumerate() {
            if presses(key) > 0 {
                *selected = index;
            }
        }
        let corner = *selected;
        self.undo(ui, adjusted.placement);
        let mut placement = adjusted.now();
        placement.mirrored ^= presses(Key::M) % 2 == 1;
        let turns = u8::try_from(presses(Key::R) % 4).unwrap_or_default();
        placement.quarter_turns = (placement.quarter_turns + turns) % 4;
        let by = adjusted.picture.pixel() * if shift { WITH_SHIFT } else { 1.0 };
        for (key, way) in [
            (Key::ArrowLeft, Vec2::NEG_X),
            (Key::ArrowRight, Vec2::X),
            (Key::ArrowUp, Vec2::NEG_Y),
            (Key::ArrowDown, Vec2::Y),
        ] {
            for _ in 0..presses(key) {
                placement = placement.moved(corner, placement.corners[corner] + way * by);
                self.placed[corner] = true;
            }
        }
        adjusted.set(placement);
        if presses(Key::Home) > 0 {
            self.note_step(now_s, adjusted.placement);
            (*adjusted.placement, self.placed) = (None, [false; 4]);
        }
    }

    /// Undoes and repeats steps by the usual keys.
    fn undo(&mut self, ui: &Ui, placement: &mut Option<Placement>) {
        let (undone, redone) = ui.input_mut(|i| {
            let redone = i.count_and_consume_key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z)
                + i.count_and_consume_key(Modifiers::COMMAND, Key::Y);
            (i.count_and_consume_key(Modifiers::COMMAND, Key::Z), redone)
        });
        for _ in 0..undone {
            if let Some(before) = self.steps.undo(placement) {
                *placement = *before;
            }
        }
        for _ in 0..redone {
            if let Some(after) = self.steps.redo(placement) {
                *placement = *after;
            }
        }
    }

    /// Notes the end of a step.
    fn note_step(&mut self, now_s: f64, placement: &Option<Placement>) {
        // `add_undo` alone would keep steps that were undone before this one.
        self.steps.feed_state(now_s, placement);
        self.steps.add_undo(placement);
    }

    /// Moves corners event by event: a window with slow frames gets press, drag and release at once.
    pub(super) fn drag(&mut self, events: &[Event], now_s: f64, adjusted: &mut Adjusted<'_>) {
        if self.selected.is_none() {
            return;
        }
        for event in events {
            let (to, is_release) = match event {
                Event::PointerMoved(to) => (*to, false),
                Event::PointerButton { pos, button: PointerButton::Primary, pressed, .. } => {
                    if *pressed {
                        self.take_corner(*pos, now_s, adjusted);
                    }
                    (*pos, !*pressed)
                }
                _ => continue,
            };
            let Some(HeldCorner { index, beside, .. }) = &self.held else { continue };
            let (placement, picture) = (adjusted.now(), adjusted.picture);
            let to = picture.share(to + *beside);
            let before = placement.corners.get(*index).copied();
            // A corner that is only clicked stays unchanged, bit for bit.
            if before.is_some_and(|before| ((to - before) * picture.size()).length() > 1e-3) {
                adjusted.set(placement.moved(*index, to));
            }
            if is_release {
                if let Some(placed) = self.placed.get_mut(*index) {
                    *placed = true;
                }
                self.held = None;
                self.note_step(now_s, adjusted.placement);
            }
        }
    }

    /// Grabs the corner with its handle at `pointer`, the topmost one.
    fn take_corner(&mut self, pointer: Pos2, now_s: f64, adjusted: &Adjusted<'_>) {
        let picture = adjusted.picture;
        let corners = adjusted.now().corners.map(|corner| picture.point(corner));
        let touched = corners
            .into_iter()
            .enumerate()
            .rev()
            .find(|(_, corner)| handle_of(*corner, picture.area).contains(pointer));
        if let Some((index, corner)) = touched {
            self.note_step(now_s, adjusted.placement);
            self.held = Some(HeldCorner { index, beside: corner - pointer, before: *adjusted.placement });
            self.selected = Some(index);
        }
    }
}

/// The handle of a corner; for a corner beyond the picture, it is at the edge.
pub(super) fn handle_of(corner: Pos2, picture: Rect) -> Rect {
    Rect::from_center_size(picture.shrink(HANDLE).clamp(corner), egui::Vec2::splat(2.0 * HANDLE))
}
