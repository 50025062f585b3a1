//! Elements of a drawing.

use glam::Vec2;

use super::pieces::TextDirection;
use underfoot::floor::Rect;
use underfoot::layout::Colour;

/// A colour with its opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ink {
    /// The colour.
    pub colour: Colour,
    /// Opacity from 0 (transparent) to 1 (opaque).
    pub opacity: f32,
}

impl Ink {
    /// Creates an opaque ink of `colour`.
    #[must_use]
    pub const fn solid(colour: Colour) -> Self {
        Self { colour, opacity: 1.0 }
    }

    /// Mixes this ink with a `share` (0 to 1) of `other`.
    #[must_use]
    pub fn mix(self, other: Self, share: f32) -> Self {
        let share = share.clamp(0.0, 1.0);
        let opacity = self.opacity + (other.opacity - self.opacity) * share;
        Self { colour: self.colour.mix(other.colour, share), opacity }
    }

    /// Creates an ink of `colour` with an `opacity` of 0 to 1.
    #[must_use]
    pub const fn faint(colour: Colour, opacity: f32) -> Self {
        Self { colour, opacity }
    }
}

/// A line centred on an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// Colour of the line.
    pub ink: Ink,
    /// Width in metres.
    pub width_m: f32,
    /// Lengths of the dashes and of the gaps between them, in metres; `None` for a solid line.
    pub dash: Option<(f32, f32)>,
}

impl Stroke {
    /// Creates a solid line of `width_m` metres.
    #[must_use]
    pub const fn new(width_m: f32, ink: Ink) -> Self {
        Self { ink, width_m, dash: None }
    }

    /// Returns the same line with dashes of `on_m` metres and gaps of `off_m`.
    #[must_use]
    pub const fn dashed(self, on_m: f32, off_m: f32) -> Self {
        Self { dash: Some((on_m, off_m)), ..self }
    }
}

/// Fill and stroke of a mark; either may be absent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Paint {
    /// Ink of the inside.
    pub fill: Option<Ink>,
    /// Stroke of the outline, over the inside.
    pub stroke: Option<Stroke>,
}

impl Paint {
    /// Paints only the inside.
    #[must_use]
    pub const fn fill(ink: Ink) -> Self {
        Self { fill: Some(ink), stroke: None }
    }

    /// Paints only the outline.
    #[must_use]
    pub const fn stroke(stroke: Stroke) -> Self {
        Self { fill: None, stroke: Some(stroke) }
    }

    /// Multiplies the width of the outline by `by`.
    pub(super) fn magnify(&mut self, by: f32) {
        if let Some(stroke) = &mut self.stroke {
            stroke.width_m *= by;
            stroke.dash = stroke.dash.map(|(on, off)| (on * by, off * by));
        }
    }

    /// Returns the same fill with this outline.
    #[must_use]
    pub const fn with_stroke(self, stroke: Stroke) -> Self {
        Self { stroke: Some(stroke), ..self }
    }
}

/// The part of a text that is at its point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Anchor {
    /// Start of the text.
    #[default]
    Start,
    /// Centre of the text.
    Middle,
    /// End of the text.
    End,
}

/// Style and position of one line of text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lettering {
    /// Point on the base line, in floor metres.
    pub at: Vec2,
    /// Part of the text that is at `at`.
    pub anchor: Anchor,
    /// Height of an em, in metres.
    pub size_m: f32,
    /// True for heavier letters.
    pub strong: bool,
    /// Turn about `at`, counter-clockwise in radians; 0 reads eastwards.
    pub turn_rad: f32,
    /// Ink of the letters.
    pub ink: Ink,
    /// Order of the line's parts.
    pub direction: TextDirection,
}

impl Lettering {
    /// Creates a horizontal line of regular weight.
    #[must_use]
    pub const fn new(at: Vec2, anchor: Anchor, size_m: f32, ink: Ink) -> Self {
        Self { at, anchor, size_m, strong: false, turn_rad: 0.0, ink, direction: TextDirection::OfItsLetters }
    }

    /// Returns the same lettering with this order of its parts; a line of a longer text follows the whole text.
    #[must_use]
    pub const fn reading(self, direction: TextDirection) -> Self {
        Self { direction, ..self }
    }

    /// Returns the same lettering with heavier letters.
    #[must_use]
    pub const fn strong(self) -> Self {
        Self { strong: true, ..self }
    }
}

/// A range of a scene's points, inks or letters; only valid for the scene that returned it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    pub(super) start: u32,
    pub(super) end: u32,
}

/// One element of a drawing, in floor metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mark {
    /// An axis-aligned rectangle.
    Box {
        /// Outline.
        area: Rect,
        /// Radius of the corners, in metres; at most half of the smaller side.
        radius_m: f32,
        /// Fill and stroke.
        paint: Paint,
    },
    /// An axis-aligned ellipse.
    Ellipse {
        /// Centre.
        centre: Vec2,
        /// Half of the width and half of the depth, in metres.
        radii: Vec2,
        /// Fill and stroke.
        paint: Paint,
    },
    /// A polyline. If it is filled, its whole outline is visible from the mean of its points.
    Path {
        /// Points: see [`super::Scene::points`].
        points: Span,
        /// True if a line connects the last point with the first.
        closed: bool,
        /// Fill and stroke.
        paint: Paint,
    },
    /// An axis-aligned rectangle with a smoothly changing colour: inks on a regular grid of points, the outermost on
    /// its edges, with interpolation in between.
    Field {
        /// Outline.
        area: Rect,
        /// Number of points eastwards, at least two.
        columns: u32,
        /// Rows of inks from the south-west on, at least two: see [`super::Scene::inks`].
        inks: Span,
    },
    /// The area that a polyline sweeps when it moves by `reach`, like a sheet seen at a slant. Its ink changes from
    /// `near` on the line to `far` at its final position.
    Band {
        /// Points: see [`super::Scene::points`].
        points: Span,
        /// Displacement of the points, in metres.
        reach: Vec2,
        /// Ink on the line.
        near: Ink,
        /// Ink at the other side.
        far: Ink,
    },
    /// A shade around an axis-aligned rectangle, strongest at its edge; the inside stays free.
    Halo {
        /// Rectangle at which the shade starts.
        area: Rect,
        /// Radius of the rectangle's corners, in metres; at most half of the smaller side.
        radius_m: f32,
        /// Distance at which the shade ends, in metres.
        reach_m: f32,
        /// Ink at the edge.
        ink: Ink,
    },
    /// One line of text.
    Text {
        /// Letters: see [`super::Scene::letters`].
        letters: Span,
        /// Style and position.
        lettering: Lettering,
    },
}
