//! What a drawing is made of.

use glam::Vec2;

use super::pieces::Direction;
use crate::floor::Rect;
use crate::layout::Colour;

/// A colour, and how much it hides of what lies beneath.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ink {
    /// The colour.
    pub colour: Colour,
    /// 0 (nothing to be seen) to 1 (hides everything).
    pub opacity: f32,
}

impl Ink {
    /// `colour`, hiding everything beneath.
    #[must_use]
    pub const fn solid(colour: Colour) -> Self {
        Self { colour, opacity: 1.0 }
    }

    /// The ink `share` (0 to 1) of the way from this one to `other`.
    #[must_use]
    pub fn mix(self, other: Self, share: f32) -> Self {
        let share = share.clamp(0.0, 1.0);
        let opacity = self.opacity + (other.opacity - self.opacity) * share;
        Self { colour: self.colour.mix(other.colour, share), opacity }
    }

    /// `colour` with `opacity` 0 to 1.
    #[must_use]
    pub const fn faint(colour: Colour, opacity: f32) -> Self {
        Self { colour, opacity }
    }
}

/// A line along an outline, half of it on each side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// Its colour.
    pub ink: Ink,
    /// Its width, in metres.
    pub width_m: f32,
    /// Length of the dashes and of the gaps between them, in metres; `None` for an unbroken line.
    pub dash: Option<(f32, f32)>,
}

impl Stroke {
    /// An unbroken line of `width_m` metres.
    #[must_use]
    pub const fn new(width_m: f32, ink: Ink) -> Self {
        Self { ink, width_m, dash: None }
    }

    /// The same line broken into dashes of `on_m` metres with gaps of `off_m`.
    #[must_use]
    pub const fn dashed(self, on_m: f32, off_m: f32) -> Self {
        Self { dash: Some((on_m, off_m)), ..self }
    }
}

/// How the inside and the outline of a mark are drawn; either may be absent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Paint {
    /// The inside.
    pub fill: Option<Ink>,
    /// The outline, over the inside.
    pub stroke: Option<Stroke>,
}

impl Paint {
    /// Only the inside.
    #[must_use]
    pub const fn fill(ink: Ink) -> Self {
        Self { fill: Some(ink), stroke: None }
    }

    /// Only the outline.
    #[must_use]
    pub const fn stroke(stroke: Stroke) -> Self {
        Self { fill: None, stroke: Some(stroke) }
    }

    /// Makes the outline `by` times as wide.
    pub(super) fn magnify(&mut self, by: f32) {
        if let Some(stroke) = &mut self.stroke {
            stroke.width_m *= by;
            stroke.dash = stroke.dash.map(|(on, off)| (on * by, off * by));
        }
    }

    /// The same inside with this outline.
    #[must_use]
    pub const fn with_stroke(self, stroke: Stroke) -> Self {
        Self { stroke: Some(stroke), ..self }
    }
}

/// Which part of a text stands at its point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Anchor {
    /// Its beginning.
    #[default]
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// How one line of text is set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lettering {
    /// Where its base line is met, in floor metres.
    pub at: Vec2,
    /// What of it is at `at`.
    pub anchor: Anchor,
    /// Height of an em, in metres.
    pub size_m: f32,
    /// Whether it is set heavier than usual.
    pub strong: bool,
    /// Turn about `at`, counter-clockwise in radians; 0 reads eastwards.
    pub turn_rad: f32,
    /// Its colour.
    pub ink: Ink,
    /// The way in which its parts follow each other.
    pub direction: Direction,
}

impl Lettering {
    /// A level line, set no heavier than usual.
    #[must_use]
    pub const fn new(at: Vec2, anchor: Anchor, size_m: f32, ink: Ink) -> Self {
        Self { at, anchor, size_m, strong: false, turn_rad: 0.0, ink, direction: Direction::OfItsLetters }
    }

    /// The same with its parts in this order: a line of a longer text follows the whole.
    #[must_use]
    pub const fn reading(self, direction: Direction) -> Self {
        Self { direction, ..self }
    }

    /// The same, set heavier.
    #[must_use]
    pub const fn strong(self) -> Self {
        Self { strong: true, ..self }
    }
}

/// A stretch of a scene's points, inks or letters; only meaningful to the scene that gave it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    pub(super) start: u32,
    pub(super) end: u32,
}

/// One thing to draw, in floor metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mark {
    /// An upright rectangle.
    Box {
        /// Its outline.
        area: Rect,
        /// Radius of its corners, in metres; at most half its smaller side.
        radius_m: f32,
        /// How it is drawn.
        paint: Paint,
    },
    /// An upright ellipse.
    Ellipse {
        /// Its middle.
        centre: Vec2,
        /// Half its width and half its depth, in metres.
        radii: Vec2,
        /// How it is drawn.
        paint: Paint,
    },
    /// Straight lines from point to point. Where it is filled, its whole
    /// outline can be seen from the mean of its points.
    Path {
        /// Its points: see [`super::Scene::points`].
        points: Span,
        /// Whether a line leads from the last point back to the first.
        closed: bool,
        /// How it is drawn.
        paint: Paint,
    },
    /// An upright rectangle whose colour changes smoothly: inks at an even grid of points, the
    /// outermost on its edges, and between them what lies between.
    Field {
        /// Its outline.
        area: Rect,
        /// Points eastwards, at least two.
        columns: u32,
        /// Rows of inks from the south-west on, at least two: see [`super::Scene::inks`].
        inks: Span,
    },
    /// What straight lines from point to point sweep when they are moved by `reach`: a sheet seen
    /// at a slant, from `near` on the lines to `far` where they end up.
    Band {
        /// The points: see [`super::Scene::points`].
        points: Span,
        /// How far they are moved, in metres.
        reach: Vec2,
        /// The ink on the lines.
        near: Ink,
        /// The ink at the other side.
        far: Ink,
    },
    /// A shade around an upright rectangle, strongest at its edge; the inside stays free.
    Halo {
        /// Where it begins.
        area: Rect,
        /// Radius of the corners there, in metres; at most half its smaller side.
        radius_m: f32,
        /// How far from there nothing is left of it, in metres.
        reach_m: f32,
        /// The ink at the edge.
        ink: Ink,
    },
    /// One line of text.
    Text {
        /// Its letters: see [`super::Scene::letters`].
        letters: Span,
        /// How it is set.
        lettering: Lettering,
    },
}
