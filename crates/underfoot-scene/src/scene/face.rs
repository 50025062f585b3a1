//! Common parts of all controls: a face that sinks and lights up, its label, its badges.

use glam::Vec2;

use super::face_colours::FaceColours;
use super::mark::{Ink, Paint, Stroke};
use super::{Scene, Theme, outline};
use underfoot::engine::WidgetState;
use underfoot::floor::Rect;
use underfoot::layout::{Colour, Shape, Widget};
use underfoot::widget::{Guard, Indicator, OffReason};

/// Minimum letter size of a label, in metres: 8 pixels on a floor displayed 600 pixels wide.
pub(super) const SMALL_M: f32 = 0.024;

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
    /// The colours from which the current ones come.
    colours: FaceColours,
}

impl<'a> Face<'a> {
    /// Creates the face of `widget`; `lit` mixes its colour at rest (0) with its lit one (1).
    pub(super) fn new(widget: &'a Widget, state: WidgetState, theme: &'a Theme, lit: f32) -> Self {
        let colours = FaceColours::of(&widget.look, theme);
        let is_off = off(&state).is_some();
        let out_of_use = is_off || state.needs_lift;
        let face = colours.face(if out_of_use && colours.mark.is_some() { 0.0 } else { lit });
        let colour = if out_of_use { face.mix(theme.plate, 0.72) } else { face };
        let ink = theme.readable(colours.ink, colour);
        let ink = if is_off { faded(ink, colour, theme) } else { ink };
        let area = widget.area.grown(if state.pressed { -SINK_M } else { 0.0 });
        let shape = widget.look.shape;
        let radius_m = match shape {
            Shape::Box => (0.16 * area.size().min_element()).min(0.028),
            Shape::Round => 0.5 * area.size().min_element(),
        };
        Self { widget, state, theme, shape, area, radius_m, colour, ink, colours }
    }

    /// The label; may be empty.
    pub(super) fn label(&self) -> &'a str {
        &self.widget.label
    }

    /// True if the control is off, or waits for the foot to lift.
    pub(super) fn is_out_of_use(&self) -> bool {
        off(&self.state).is_some() || self.state.needs_lift
    }

    /// Colour of lit elements on the face.
    pub(super) fn lit(&self) -> Colour {
        let lit = self.colours.lit;
        if self.is_out_of_use() { lit.mix(self.theme.plate, 0.6) } else { lit }
    }

    /// Colour of a line along which a handle slides.
    pub(super) fn groove(&self) -> Colour {
        match self.colours.mark {
            Some(mark) => self.colour.mix(mark, 0.45),
            None => self.colour.mix(self.theme.shadow, 0.14),
        }
    }

    /// Paint of a field in which a handle slides, or of one of several parts.
    pub(super) fn sunk(&self) -> Paint {
        match self.colours.mark {
            // On black a shade is invisible, so that the field has an edge.
            Some(_) => Paint::fill(Ink::solid(self.colour))
                .with_stroke(Stroke::new(0.003, Ink::solid(self.groove()))),
            None => Paint::fill(Ink::solid(self.colour.mix(self.theme.shadow, 0.13))),
        }
    }

    /// Colour of icon and guard on the face: its hue with high contrast, otherwise that of the letters.
    pub(super) fn mark(&self) -> Colour {
        let mark =
            self.colours.mark.filter(|mark| !self.is_out_of_use() && mark.contrast(self.colour) >= 3.0);
        mark.unwrap_or(self.ink)
    }

    /// The edge of the face in its present state.
    fn edge(&self) -> Stroke {
        let theme = self.theme;
        let is_outlined = self.colours.mark.is_some();
        match (self.state.needs_lift, off(&self.state).is_some()) {
            (true, _) => Stroke::new(0.005, Ink::solid(theme.warning)).dashed(0.018, 0.012),
            (_, true) => Stroke::new(0.003, Ink::solid(theme.quiet)).dashed(0.010, 0.010),
            _ if self.state.warned => Stroke::new(0.008, Ink::solid(theme.warning)),
            _ if self.state.armed => Stroke::new(0.008, Ink::solid(theme.accent)),
            _ if self.state.locked => Stroke::new(0.005, Ink::solid(theme.quiet)),
            _ if self.state.pressed && is_outlined => Stroke::new(0.010, Ink::solid(theme.ink)),
            _ if self.state.pressed => Stroke::new(0.004, Ink::solid(self.colour.mix(theme.ink, 0.45))),
            _ => match self.colours.mark {
                // With high contrast only the edge separates a face from the plate.
                Some(mark) => Stroke::new(0.006, Ink::solid(mark)),
                None => Stroke::new(0.002, Ink::faint(self.colour.mix(theme.ink, 0.28), 0.8)),
            },
        }
    }

    /// Draws shadow, face, edge, guard mark, and the ring that fills as the force grows.
    pub(super) fn draw(&self, scene: &mut Scene) {
        let flat = self.is_out_of_use();
        if self.state.pressed {
            self.glow(scene);
        } else if !flat {
            self.shadow(scene);
        }
        self.outlined(scene, 0.0, Paint::fill(Ink::solid(self.colour)).with_stroke(self.edge()));
        if !flat {
            self.guard(scene);
            self.ring(scene);
        }
    }

    /// A second line inside the edge of a guarded control: solid if a second press confirms, dashed if it must be
    /// held.
    fn guard(&self, scene: &mut Scene) {
        let line = match self.colours.mark {
            Some(_) => Stroke::new(0.005, Ink::solid(self.mark())),
            None => Stroke::new(0.003, Ink::faint(self.ink, 0.55)),
        };
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
        let edge = Stroke::new(0.003, Ink::solid(self.theme.readable(self.theme.ink, self.colour)));
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
        self.halo(scene, self.area, 0.030, Ink::faint(self.colours.lit, 0.55));
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
        let ink = Ink::solid(self.theme.readable(self.theme.plate, ground));
        scene.add_badge(middle, SMALL_M, ink, Paint::fill(Ink::solid(ground)), format_args!("{text}"));
    }
}

/// The ink of a control that is off: as faint as text may be.
fn faded(ink: Colour, ground: Colour, theme: &Theme) -> Colour {
    let mixed = [0.4, 0.3, 0.2, 0.1].map(|share| ink.mix(ground, share));
    mixed.into_iter().find(|ink| ink.contrast(ground) >= theme.least_contrast()).unwrap_or(ink)
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
        OffReason::SlowReadings => "too slow",
        OffReason::Waiting => return None,
        // A test checks that each known reason has its own.
        _ => UNNAMED_BADGE,
    })
}

/// Height of the strip that a badge takes from the label, in metres.
pub(super) const BADGE_STRIP_M: f32 = 0.036;

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
