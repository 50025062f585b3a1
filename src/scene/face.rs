//! What all controls have in common: a face that sinks and lights up, its label, its badges.

use glam::Vec2;

use super::fit::{Fitted, fit};
use super::mark::{Anchor, Ink, Lettering, Paint, Stroke};
use super::theme::{contrast, readable};
use super::widths::{CAP_HEIGHT, LINE_HEIGHT};
use super::{Scene, Theme, icon, outline};
use crate::engine::WidgetState;
use crate::floor::Rect;
use crate::layout::{Colour, Shape, Widget};
use crate::sense::HoldDoubt;
use crate::widget::{Guard, Indicator};

/// Largest letters of a label, in metres: read easily from standing height.
const LABEL_M: f32 = 0.046;

/// Smallest letters of a label, in metres: 8 pixels on a floor shown 600 pixels wide.
pub(super) const SMALL_M: f32 = 0.024;

/// Largest side of an icon, in metres.
const ICON_M: f32 = 0.11;

/// Smallest side of an icon that is still told from others, in metres; below it there is only the label.
const ICON_LEAST_M: f32 = 0.02;

/// How far a pressed face shrinks on each side, in metres.
const SINK_M: f32 = 0.004;

/// One control's face, as it is now.
pub(super) struct Face<'a> {
    pub(super) widget: &'a Widget,
    pub(super) state: WidgetState,
    pub(super) theme: &'a Theme,
    /// Its outline.
    pub(super) shape: Shape,
    /// The face as drawn: smaller while pressed.
    pub(super) area: Rect,
    /// Radius of its corners, in metres.
    pub(super) radius_m: f32,
    /// Its colour now.
    pub(super) colour: Colour,
    /// Letters on it.
    pub(super) ink: Colour,
}

impl<'a> Face<'a> {
    /// The face of `widget`; `lit` is how far it has turned from its colour at rest to its lit one, 0 to 1.
    pub(super) fn new(widget: &'a Widget, state: WidgetState, theme: &'a Theme, lit: f32) -> Self {
        let look = &widget.look;
        let (rest, lit_up, ink) =
            theme.faces.map_or((look.face, look.lit, look.ink), |all| (all.rest, all.lit, all.ink));
        let at_rest = rest.mix(lit_up, lit);
        let out_of_use = state.is_off() || state.needs_lift;
        let colour = if out_of_use { at_rest.mix(theme.plate, 0.72) } else { at_rest };
        let ink = readable(ink, colour);
        // Words of what does not work just now step back, but stay legible.
        let faded = ink.mix(colour, 0.4);
        let ink = if state.is_off() && contrast(faded, colour) >= 3.0 { faded } else { ink };
        let area = widget.area.grown(if state.pressed { -SINK_M } else { 0.0 });
        let shape = widget.look.shape;
        let radius_m = match shape {
            Shape::Box => (0.16 * area.size().min_element()).min(0.028),
            Shape::Round => 0.5 * area.size().min_element(),
        };
        Self { widget, state, theme, shape, area, radius_m, colour, ink }
    }

    /// What is written on it; may be empty.
    pub(super) fn label(&self) -> &'a str {
        &self.widget.label
    }

    /// Whether it does not work just now.
    pub(super) fn is_out_of_use(&self) -> bool {
        self.state.is_off() || self.state.needs_lift
    }

    /// What its face turns to.
    fn lit_up(&self) -> Colour {
        self.theme.faces.map_or(self.widget.look.lit, |all| all.lit)
    }

    /// The colour of what is lit on it.
    pub(super) fn lit(&self) -> Colour {
        let lit = self.lit_up();
        if self.is_out_of_use() { lit.mix(self.theme.plate, 0.6) } else { lit }
    }

    /// Draws shadow, face, edge, what guards it and the ring that fills as the force builds.
    pub(super) fn draw(&self, scene: &mut Scene) {
        let flat = self.is_out_of_use();
        if self.state.pressed {
            self.glow(scene);
        } else if !flat {
            self.shadow(scene);
        }
        let edge = self.colour.mix(self.theme.ink, 0.28);
        let stroke = match (self.state.needs_lift, self.state.is_off()) {
            (true, _) => Stroke::new(0.005, Ink::solid(self.theme.warning)).dashed(0.018, 0.012),
            (_, true) => Stroke::new(0.003, Ink::solid(self.theme.quiet)).dashed(0.010, 0.010),
            _ if self.state.warned => Stroke::new(0.008, Ink::solid(self.theme.warning)),
            _ if self.state.armed => Stroke::new(0.008, Ink::solid(self.theme.accent)),
            _ if self.state.locked => Stroke::new(0.005, Ink::solid(self.theme.quiet)),
            _ if self.state.pressed => Stroke::new(0.004, Ink::solid(self.colour.mix(self.theme.ink, 0.45))),
            _ => match self.theme.faces {
                // Nothing else tells a face from the plate that it stands on.
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

    /// A second line inside the edge of what takes more than a press: unbroken where a second press
    /// confirms, broken where it must be held.
    fn guard(&self, scene: &mut Scene) {
        let line = Stroke::new(0.003, Ink::faint(self.ink, 0.55));
        let stroke = match self.widget.behaviour.thresholds().guard {
            Guard::Free => return,
            Guard::Confirm { .. } => line,
            Guard::HoldToRun { .. } => line.dashed(0.016, 0.009),
        };
        self.outlined(scene, -0.0155, Paint::stroke(stroke));
    }

    /// The lamp that apps switch, in the north-east: each state has a shape of its own.
    fn lamp(&self, scene: &mut Scene) {
        // On the rim, clear of everything that is written.
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

    /// A soft shadow that lies to the south, as under a lamp at the floor's far end.
    fn shadow(&self, scene: &mut Scene) {
        let south = Vec2::new(0.0, 0.006);
        let area = Rect::new(self.area.min - south, self.area.max - south);
        // From inside the edge, where the face hides it: the shift to the south leaves no gap in the north.
        self.halo(scene, area.grown(-0.006), 0.018, Ink::faint(self.theme.shadow, 0.26));
    }

    /// A halo in the lit colour around a pressed face.
    fn glow(&self, scene: &mut Scene) {
        self.halo(scene, self.area, 0.030, Ink::faint(self.lit_up(), 0.55));
    }

    fn halo(&self, scene: &mut Scene, area: Rect, reach_m: f32, ink: Ink) {
        let size = area.size();
        match self.shape {
            Shape::Round if size.x != size.y => {
                let stroke = Stroke::new(0.5 * reach_m, Ink::faint(ink.colour, 0.6 * ink.opacity));
                scene.add_ellipse(area.centre(), 0.5 * size, Paint::stroke(stroke));
            }
            Shape::Round => scene.add_halo(area, 0.5 * size.x, reach_m, ink),
            Shape::Box => scene.add_halo(area, self.radius_m, reach_m, ink),
        }
    }

    /// The share of the press threshold that the foot brings up, along the face's edge.
    fn ring(&self, scene: &mut Scene) {
        let share = self.state.press_share;
        // Below this the ring would only flicker under a foot that rests.
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
            Shape::Round => scene.add_ellipse(area.centre(), area.size() * 0.5, paint),
        }
    }

    /// The same face with straight sides, however round the control is: a slider's track needs them.
    pub(super) fn straight(self) -> Self {
        Self { shape: Shape::Box, ..self }
    }

    /// The part of the face that letters may fill: inside the ring, and inside the round of a round face.
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

    /// What is written about a control that does not work as usual just now.
    pub(super) fn badge(&self) -> Option<&'static str> {
        let room = self.widget.area.size();
        let text = match self.state {
            WidgetState { uncalibrated: true, .. } => "calibrate",
            WidgetState { hold_doubt: Some(HoldDoubt::Repeats), .. } => "frozen",
            WidgetState { hold_doubt: Some(_), .. } => "coarse",
            WidgetState { needs_lift: true, .. } => "lift foot",
            WidgetState { disabled: true, .. } => "disabled",
            WidgetState { locked: true, .. } => "locked",
            WidgetState { warned: true, .. } => "let go",
            WidgetState { armed: true, .. } => "again",
            _ => return None,
        };
        (room.x >= 0.15 && room.y >= 0.11).then_some(text)
    }

    /// Draws the lamp, and the badge of a control that does not work as usual just now, over everything else on the
    /// face.
    pub(super) fn draw_badge(&self, scene: &mut Scene) {
        let lift = match self.shape {
            Shape::Box => 0.028,
            // Over the rim: the round has no corner to spare.
            Shape::Round => 0.014,
        };
        self.draw_badge_at(scene, Vec2::new(self.area.centre().x, self.area.min.y + lift));
    }

    /// The same, with its middle elsewhere.
    pub(super) fn draw_badge_at(&self, scene: &mut Scene, middle: Vec2) {
        self.lamp(scene);
        let Some(text) = self.badge() else { return };
        let ground = match self.state {
            WidgetState { uncalibrated: true, .. }
            | WidgetState { hold_doubt: Some(_), .. }
            | WidgetState { needs_lift: true, .. } => self.theme.warning,
            WidgetState { disabled: true, .. } | WidgetState { locked: true, .. } => self.theme.quiet,
            WidgetState { warned: true, .. } => self.theme.warning,
            _ => self.theme.accent,
        };
        let ink = Ink::solid(readable(self.theme.plate, ground));
        scene.add_badge(middle, SMALL_M, ink, Paint::fill(Ink::solid(ground)), format_args!("{text}"));
    }

    /// Writes the label in the middle of the face, under the icon if there is one.
    pub(super) fn write_label(&self, scene: &mut Scene) {
        let room = self.draw_icon(scene, self.room());
        let label = &self.widget.label;
        if self.widget.look.icon.is_some() {
            self.write(scene, label, room, Anchor::Middle);
            return;
        }
        let fitted = fit(label, room.size(), LABEL_M, SMALL_M);
        if self.shape == Shape::Round && self.badge().is_none() {
            // One line may be longer than the square in the circle is wide.
            let middle = Rect::from_centre_size(self.area.centre(), self.area.size() * Vec2::new(0.88, 0.42));
            let flat = fit(label, middle.size(), LABEL_M, SMALL_M);
            if (fitted.shortened && !flat.shortened) || flat.size_m > fitted.size_m {
                set(scene, label, middle, Anchor::Middle, self.ink, &flat);
                return;
            }
        }
        set(scene, label, room, Anchor::Middle, self.ink, &fitted);
    }

    /// Writes `text` into `room`, as large as it fits, with its lines' middle in the room's middle.
    pub(super) fn write(&self, scene: &mut Scene, text: &str, room: Rect, anchor: Anchor) {
        self.write_in(scene, text, room, anchor, self.ink);
    }

    /// Draws the icon, if there is one, and gives back the room that it leaves: beside it where there is width, else
    /// below.
    pub(super) fn draw_icon(&self, scene: &mut Scene, room: Rect) -> Rect {
        let Some(icon) = self.widget.look.icon else { return room };
        let size = room.size();
        let labelled = !self.widget.label.is_empty();
        let beside = labelled && size.x > 1.8 * size.y;
        // The label keeps a line, of small letters at least.
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

/// Height of the strip that a badge takes from the label, in metres.
pub(super) const BADGE_STRIP_M: f32 = 0.036;

fn set(scene: &mut Scene, text: &str, room: Rect, anchor: Anchor, ink: Colour, fitted: &Fitted) {
    let x = match anchor {
        Anchor::Start => room.min.x,
        Anchor::Middle => room.centre().x,
        Anchor::End => room.max.x,
    };
    let top = room.centre().y + 0.5 * fitted.height_m();
    for (line, bytes) in fitted.lines.iter().enumerate() {
        let middle = top - (line as f32 + 0.5) * LINE_HEIGHT * fitted.size_m;
        let lettering = Lettering::new(
            Vec2::new(x, middle - 0.5 * CAP_HEIGHT * fitted.size_m),
            anchor,
            fitted.size_m,
            Ink::solid(ink),
        )
        .strong();
        let last = line + 1 == fitted.lines.len();
        let end = if fitted.shortened && last { "…" } else { "" };
        scene.add_text(lettering, format_args!("{}{end}", &text[bytes.clone()]));
    }
}
