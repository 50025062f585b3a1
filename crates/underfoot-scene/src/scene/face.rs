//! Common parts of all controls: a face that sinks and lights up, its label, its badges.

use glam::Vec2;

use super::fit::{Fitted, fit};
use super::mark::{Anchor, Ink, Lettering, Paint, Stroke};
use super::theme::{contrast, readable};
use super::widths::{CAP_HEIGHT, LINE_HEIGHT};
use super::{Scene, TextDirection, Theme, icon, outline};
use underfoot::engine::WidgetState;
use underfoot::floor::Rect;
use underfoot::layout::{Colour, Shape, Widget};
use underfoot::widget::{Guard, Indicator, OffReason};

/// Maximum letter size of a label, in metres: easy to read from standing height.
const LABEL_M: f32 = 0.046;

/// Minimum letter size of a label, in metres: 8 pixels on a floor displayed 600 pixels wide.
pub(super) const SMALL_M: f32 = 0.024;

/// Maximum side of an icon, in metres.
const ICON_M: f32 = 0.11;

/// Minimum side of a recognisable icon, in metres; below it the face has only the label.
const ICON_LEAST_M: f32 = 0.02;

/// Shrinkage of a pressed face on each side, in metres.
const SINK_M: f32 = 0.004;

/// The current face of one control.
pub(super) struct Face<'a> {
    pub(super) widget: &'a Widget,
    pub(super) state: WidgetState,
    pub(super) theme: &'a Theme,
    /// Shape of its outline.
    pub(super) shape: Shape,
    /// The face as drawn: smaller while pressed.
    pub(super) area: Rect,
    /// Radius of the corners, in metres.
    pub(super) radius_m: f32,
    /// Current colour.
    pub(super) colour: Colour,
    /// Colour of the letters.
    pub(super) ink: Colour,
}

impl<'a> Face<'a> {
    /// Creates the face of `widget`; `lit` mixes its colour at rest (0) with its lit one (1).
    pub(super) fn new(widget: &'a Widget, state: WidgetState, theme: &'a Theme, lit: f32) -> Self {
        let look = &widget.look;
        let (rest, lit_up, ink) =
            theme.faces.map_or((look.face, look.lit, look.ink), |all| (all.rest, all.lit, all.ink));
        let at_rest = rest.mix(lit_up, lit);
        let is_off = off(&state).is_some();
        let out_of_use = is_off || state.needs_lift;
        let colour = if out_of_use { at_rest.mix(theme.plate, 0.72) } else { at_rest };
        let ink = readable(ink, colour);
        // The text of a control that is off is fainter, but stays legible.
        let faded = ink.mix(colour, 0.4);
        let ink = if is_off && contrast(faded, colour) >= 3.0 { faded } else { ink };
        let area = widget.area.grown(if state.pressed { -SINK_M } else { 0.0 });
        let shape = widget.look.shape;
        let radius_m = match shape {
            Shape::Box => (0.16 * area.size().min_element()).min(0.028),
            Shape::Round => 0.5 * area.size().min_element(),
        };
        Self { widget, state, theme, shape, area, radius_m, colour, ink }
    }

    /// The label; may be empty.
    pub(super) fn label(&self) -> &'a str {
        &self.widget.label
    }

    /// True if the control is off, or waits for the foot to lift.
    pub(super) fn is_out_of_use(&self) -> bool {
        off(&self.state).is_some() || self.state.needs_lift
    }

    /// Colour of the lit face.
    fn lit_up(&self) -> Colour {
        self.theme.faces.map_or(self.widget.look.lit, |all| all.lit)
    }

    /// Colour of lit elements on the face.
    pub(super) fn lit(&self) -> Colour {
        let lit = self.lit_up();
        if self.is_out_of_use() { lit.mix(self.theme.plate, 0.6) } else { lit }
    }

    /// Draws shadow, face, edge, guard mark, and the ring that fills as the force grows.
    pub(super) fn draw(&self, scene: &mut Scene) {
        let flat = self.is_out_of_use();
        if self.state.pressed {
            self.glow(scene);
        } else if !flat {
            self.shadow(scene);
        }
        let edge = self.colour.mix(self.theme.ink, 0.28);
        let stroke = match (self.state.needs_lift, off(&self.state).is_some()) {
            (true, _) => Stroke::new(0.005, Ink::solid(self.theme.warning)).dashed(0.018, 0.012),
            (_, true) => Stroke::new(0.003, Ink::solid(self.theme.quiet)).dashed(0.010, 0.010),
            _ if self.state.warned => Stroke::new(0.008, Ink::solid(self.theme.warning)),
            _ if self.state.armed => Stroke::new(0.008, Ink::solid(self.theme.accent)),
            _ if self.state.locked => Stroke::new(0.005, Ink::solid(self.theme.quiet)),
            _ if self.state.pressed => Stroke::new(0.004, Ink::solid(self.colour.mix(self.theme.ink, 0.45))),
            _ => match self.theme.faces {
                // With the high-contrast colours only the edge separates a face from the plate.
                Some(all) => Stroke::new(0.005, Ink::solid(all.ink)),
                None => Stroke::new(0.002, Ink::faint(edge, 0.8)),
            },
        };
        self.outlined(scene, 0.0, Paint::fill(Ink::solid(self.colour)).with_stroke(stroke));
        if !flat {
            self.guard(scene);
            self.ring(scene);
        }
    }

    /// A second line inside the edge of a guarded control: solid if a second press confirms, dashed if it must be
    /// held.
    fn guard(&self, scene: &mut Scene) {
        let line = Stroke::new(0.003, Ink::faint(self.ink, 0.55));
        let stroke = match self.widget.behaviour.thresholds().guard {
            Guard::Free => return,
            Guard::Confirm { .. } => line,
            Guard::HoldToRun { .. } => line.dashed(0.016, 0.009),
        };
        self.outlined(scene, -0.0155, Paint::stroke(stroke));
    }

    /// The lamp controlled by apps, in the north-east corner; each state has its own shape.
    fn lamp(&self, scene: &mut Scene) {
        // On the rim, clear of all text.
        let at = match self.shape {
            Shape::Box => self.area.max - Vec2::splat(0.005),
            Shape::Round => self.area.centre() + 0.5 * self.area.size() * std::f32::consts::FRAC_1_SQRT_2,
        };
        let edge = Stroke::new(0.003, Ink::solid(readable(self.theme.ink, self.colour)));
        let radius = 0.0095;
        let paint = |colour: Colour| Paint::fill(Ink::solid(colour)).with_stroke(edge);
        match self.state.indicator {
            Indicator::Off => {}
            Indicator::On => scene.add_circle(at, radius, paint(self.theme.good)),
            Indicator::Busy => {
                scene.add_circle(at, radius, paint(self.theme.plate));
                scene.add_circle(at, 0.45 * radius, Paint::fill(Ink::solid(self.theme.accent)));
            }
            Indicator::Attention => {
                let corner = |degrees: f32| at + 1.35 * radius * Vec2::from_angle(degrees.to_radians());
                scene.add_path([corner(90.0), corner(210.0), corner(330.0)], true, paint(self.theme.warning));
            }
        }
    }

    /// A soft shadow towards the south, as from a lamp at the floor's far end.
    fn shadow(&self, scene: &mut Scene) {
        let south = Vec2::new(0.0, 0.006);
        let area = Rect::new(self.area.min - south, self.area.max - south);
        // The halo starts inside the edge, under the face, so that the shift to the south leaves no gap in the north.
        self.halo(scene, area.grown(-0.006), 0.018, Ink::faint(self.theme.shadow, 0.26));
    }

    /// A halo in the lit colour around a pressed face.
    fn glow(&self, scene: &mut Scene) {
        self.halo(scene, self.area, 0.030, Ink::faint(self.lit_up(), 0.55));
    }

    fn halo(&self, scene: &mut Scene, area: Rect, reach_m: f32, ink: Ink) {
        let size = area.size();
        match self.shape {
            Shape::Round if !is_circle(size) => {
                let stroke = Stroke::new(0.5 * reach_m, Ink::faint(ink.colour, 0.6 * ink.opacity));
                scene.add_ellipse(area.centre(), 0.5 * size, Paint::stroke(stroke));
            }
            Shape::Round => scene.add_halo(area, 0.5 * size.x, reach_m, ink),
            Shape::Box => scene.add_halo(area, self.radius_m, reach_m, ink),
        }
    }

    /// The foot's share of the press threshold, as a ring along the face's edge.
    fn ring(&self, scene: &mut Scene) {
        let share = self.state.press_share;
        // Below this share the ring would only flicker under a resting foot.
        if share.is_nan() || share < 0.03 {
            return;
        }
        let share = if self.state.pressed { 1.0 } else { share.min(1.0) };
        let area = self.area.grown(-0.009);
        let path = |scene: &mut Scene, share: f32, stroke| match self.shape {
            Shape::Box => {
                let arc = outline::box_arc(area, self.radius_m - 0.009, share);
                scene.add_path(arc, false, Paint::stroke(stroke));
            }
            Shape::Round => scene.add_path(outline::ellipse_arc(area, share), false, Paint::stroke(stroke)),
        };
        path(scene, 1.0, Stroke::new(0.006, Ink::faint(self.ink, 0.14)));
        path(scene, share, Stroke::new(0.006, Ink::faint(self.ink, 0.85)));
    }

    /// The face's outline grown by `grow` metres.
    fn outlined(&self, scene: &mut Scene, grow: f32, paint: Paint) {
        self.shaped(scene, self.area.grown(grow), paint);
    }

    fn shaped(&self, scene: &mut Scene, area: Rect, paint: Paint) {
        match self.shape {
            Shape::Box => {
                let grown = 0.5 * (area.size().x - self.area.size().x);
                scene.add_box(area, (self.radius_m + grown).max(0.0), paint);
            }
            // Boxes lie on whole pixels, so all round faces of one size look the same.
            Shape::Round if is_circle(area.size()) => scene.add_box(area, 0.5 * area.size().x, paint),
            Shape::Round => scene.add_ellipse(area.centre(), area.size() * 0.5, paint),
        }
    }

    /// The same face with straight sides, even for a round control: a slider's track needs them.
    pub(super) fn straight(self) -> Self {
        Self { shape: Shape::Box, ..self }
    }

    /// The part of the face for letters: inside the ring, and inside the circle of a round face.
    pub(super) fn room(&self) -> Rect {
        let line = if self.widget.behaviour.thresholds().guard == Guard::Free { 0.0 } else { 0.006 };
        let inside = match self.shape {
            Shape::Box => self.area.grown(-(0.022_f32).min(0.12 * self.area.size().min_element()) - line),
            Shape::Round => Rect::from_centre_size(self.area.centre(), self.area.size() * 0.70),
        };
        match self.badge() {
            // A badge takes the southern strip.
            Some(_) => Rect::new(inside.min + Vec2::new(0.0, BADGE_STRIP_M), inside.max),
            None => inside,
        }
    }

    /// Short text about a control that does not work as usual at present.
    pub(super) fn badge(&self) -> Option<&'static str> {
        let room = self.widget.area.size();
        let text = match self.state {
            state if off(&state).is_some_and(is_fault) => off(&state).and_then(off_badge)?,
            WidgetState { needs_lift: true, .. } => "lift foot",
            state if off(&state).is_some() => off(&state).and_then(off_badge)?,
            WidgetState { locked: true, .. } => "locked",
            WidgetState { warned: true, .. } => "let go",
            WidgetState { armed: true, .. } => "again",
            _ => return None,
        };
        (room.x >= 0.15 && room.y >= 0.11).then_some(text)
    }

    /// Draws the lamp, and the badge of a control that does not work as usual at present, on top of the face.
    pub(super) fn draw_badge(&self, scene: &mut Scene) {
        let lift = match self.shape {
            Shape::Box => 0.028,
            // On the rim: a round face has no free corner.
            Shape::Round => 0.014,
        };
        self.draw_badge_at(scene, Vec2::new(self.area.centre().x, self.area.min.y + lift));
    }

    /// The same, centred elsewhere.
    pub(super) fn draw_badge_at(&self, scene: &mut Scene, middle: Vec2) {
        self.lamp(scene);
        let Some(text) = self.badge() else { return };
        let ground = match self.state {
            state if state.needs_lift || off(&state).is_some_and(is_fault) => self.theme.warning,
            state if state.locked || off(&state).is_some() => self.theme.quiet,
            WidgetState { warned: true, .. } => self.theme.warning,
            _ => self.theme.accent,
        };
        let ink = Ink::solid(readable(self.theme.plate, ground));
        scene.add_badge(middle, SMALL_M, ink, Paint::fill(Ink::solid(ground)), format_args!("{text}"));
    }

    /// Writes the label in the centre of the face, under the icon if there is one.
    pub(super) fn write_label(&self, scene: &mut Scene) {
        let room = self.draw_icon(scene, self.room());
        let label = &self.widget.label;
        if self.widget.look.icon.is_some() {
            self.write(scene, label, room, Anchor::Middle);
            return;
        }
        let fitted = fit(label, room.size(), LABEL_M, SMALL_M);
        if self.shape == Shape::Round && self.badge().is_none() {
            // In a circle, one line may be longer than the width of the inscribed square.
            let middle = Rect::from_centre_size(self.area.centre(), self.area.size() * Vec2::new(0.88, 0.42));
            let flat = fit(label, middle.size(), LABEL_M, SMALL_M);
            if (fitted.shortened && !flat.shortened) || flat.size_m > fitted.size_m {
                set(scene, label, middle, Anchor::Middle, self.ink, &flat);
                return;
            }
        }
        set(scene, label, room, Anchor::Middle, self.ink, &fitted);
    }

    /// Writes `text` into `room`, as large as it fits, with its lines centred vertically.
    pub(super) fn write(&self, scene: &mut Scene, text: &str, room: Rect, anchor: Anchor) {
        self.write_in(scene, text, room, anchor, self.ink);
    }

    /// Draws the icon, if there is one, and returns the remaining room: beside it if the room is wide, otherwise
    /// below.
    pub(super) fn draw_icon(&self, scene: &mut Scene, room: Rect) -> Rect {
        let Some(icon) = self.widget.look.icon else { return room };
        let size = room.size();
        let labelled = !self.widget.label.is_empty();
        let beside = labelled && size.x > 1.8 * size.y;
        // The label keeps at least one line of small letters.
        let strip = if labelled && !beside { (0.36 * size.y).max(LINE_HEIGHT * SMALL_M) } else { 0.0 };
        let side = (0.92 * (size.y - strip)).min(0.8 * size.x).min(ICON_M);
        if side < ICON_LEAST_M {
            return room;
        }
        if beside {
            let middle = Vec2::new(room.min.x + 0.5 * side, room.centre().y);
            icon::draw(scene, icon, middle, side, self.ink);
            return Rect::new(Vec2::new(room.min.x + 1.15 * side, room.min.y), room.max);
        }
        let top = room.centre().y + 0.5 * (side + strip);
        icon::draw(scene, icon, Vec2::new(room.centre().x, top - 0.5 * side), side, self.ink);
        let label = Rect::new(Vec2::new(room.min.x, top - side - strip), Vec2::new(room.max.x, top - side));
        Rect::new(label.min.max(room.min), label.max)
    }

    /// The same in another colour.
    pub(super) fn write_in(&self, scene: &mut Scene, text: &str, room: Rect, anchor: Anchor, ink: Colour) {
        set(scene, text, room, anchor, ink, &fit(text, room.size(), LABEL_M, SMALL_M));
    }
}

/// True if an ellipse of this size is a circle, within the rounding errors of metres.
fn is_circle(size: Vec2) -> bool {
    (size.x - size.y).abs() < 1e-4
}

/// Reason why a control is drawn as off. While the floor waits for its first frame, controls are drawn as ready.
fn off(state: &WidgetState) -> Option<OffReason> {
    let shown = state.off.filter(|reason| *reason != OffReason::Waiting);
    shown.or(state.disabled.then_some(OffReason::Disabled))
}

/// True if the reason is a fault of the floor that needs repair.
fn is_fault(reason: OffReason) -> bool {
    reason.is_lasting() && reason != OffReason::Disabled
}

/// Badge of a reason that this drawing does not know.
const UNNAMED_BADGE: &str = "off";

/// Short text for a reason, for a badge.
fn off_badge(reason: OffReason) -> Option<&'static str> {
    Some(match reason {
        OffReason::Disabled => "disabled",
        OffReason::NotCalibrated | OffReason::OtherFloor => "calibrate",
        OffReason::BoardsSwapped => "swapped",
        OffReason::LinkLost => "silent",
        OffReason::SensorTrouble => "sensors",
        OffReason::RepeatedReadings => "frozen",
        OffReason::CoarseReadings => "coarse",
        OffReason::OtherHeld => "wait",
        OffReason::Waiting => return None,
        // A test checks that each known reason has its own.
        _ => UNNAMED_BADGE,
    })
}

/// Height of the strip that a badge takes from the label, in metres.
pub(super) const BADGE_STRIP_M: f32 = 0.036;

fn set(scene: &mut Scene, text: &str, room: Rect, anchor: Anchor, ink: Colour, fitted: &Fitted) {
    let x = match anchor {
        Anchor::Start => room.min.x,
        Anchor::Middle => room.centre().x,
        Anchor::End => room.max.x,
    };
    let top = room.centre().y + 0.5 * fitted.height_m();
    let direction = TextDirection::of(text);
    for (line, bytes) in fitted.lines.iter().enumerate() {
        let middle = top - (line as f32 + 0.5) * LINE_HEIGHT * fitted.size_m;
        let lettering = Lettering::new(
            Vec2::new(x, middle - 0.5 * CAP_HEIGHT * fitted.size_m),
            anchor,
            fitted.size_m,
            Ink::solid(ink),
        )
        .strong()
        .reading(direction);
        let last = line + 1 == fitted.lines.len();
        let end = if fitted.shortened && last { "…" } else { "" };
        scene.add_text(lettering, format_args!("{}{end}", &text[bytes.clone()]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reason_has_a_badge_of_its_own() {
        for reason in OffReason::ALL {
            assert_eq!(off_badge(reason).is_none(), reason == OffReason::Waiting, "{reason:?}");
            assert_ne!(off_badge(reason), Some(UNNAMED_BADGE), "{reason:?}");
        }
    }
}
