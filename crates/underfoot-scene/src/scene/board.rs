//! The scene: marks in order, kept between frames and redrawn.

use std::fmt::{self, Write};

use glam::Vec2;

use super::fit::fit_line;
use super::mark::{Anchor, Ink, Lettering, Mark, Paint, Span};
use super::widths;
use underfoot::floor::Rect;
use underfoot::layout::Colour;

/// A drawing: marks in floor metres, painted one over the other in order.
///
/// Keep the scene between frames: [`Scene::clear`] keeps the memory, so a window that redraws 60 times a second stops
/// allocating after the first few frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    bounds: Rect,
    background: Colour,
    marks: Vec<Mark>,
    points: Vec<Vec2>,
    inks: Vec<Ink>,
    letters: String,
}

impl Scene {
    /// An empty drawing without extent.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Removes all marks, and sets the bounds and the background of the drawing.
    pub fn clear(&mut self, bounds: Rect, background: Colour) {
        self.bounds = bounds;
        self.background = background;
        self.marks.clear();
        self.points.clear();
        self.inks.clear();
        self.letters.clear();
    }

    /// Returns the bounds of the drawing, in floor metres: the floor and the margin around it.
    #[must_use]
    pub const fn bounds(&self) -> Rect {
        self.bounds
    }

    /// Returns the colour beneath all marks.
    #[must_use]
    pub const fn background(&self) -> Colour {
        self.background
    }

    /// Returns the marks, bottom first.
    #[must_use]
    pub fn marks(&self) -> &[Mark] {
        &self.marks
    }

    /// Returns the points of a [`Mark::Path`] or [`Mark::Band`] of this scene; empty for a span of another scene that
    /// is out of range.
    #[must_use]
    pub fn points(&self, span: Span) -> &[Vec2] {
        self.points.get(span.start as usize..span.end as usize).unwrap_or_default()
    }

    /// Returns the inks of a [`Mark::Field`] of this scene; empty for a span of another scene that is out of range.
    #[must_use]
    pub fn inks(&self, span: Span) -> &[Ink] {
        self.inks.get(span.start as usize..span.end as usize).unwrap_or_default()
    }

    /// Returns the letters of a [`Mark::Text`] of this scene; empty for a span of another scene that is out of range.
    #[must_use]
    pub fn letters(&self, span: Span) -> &str {
        self.letters.get(span.start as usize..span.end as usize).unwrap_or_default()
    }

    /// Iterates over all lines of text, in drawing order.
    pub fn texts(&self) -> impl Iterator<Item = (&str, &Lettering)> {
        self.marks.iter().filter_map(|mark| match mark {
            Mark::Text { letters, lettering } => Some((self.letters(*letters), lettering)),
            _ => None,
        })
    }

    /// Iterates over the areas of all lines of text, in floor metres: of their letters with a little room around them.
    pub fn written(&self) -> impl Iterator<Item = Rect> {
        self.texts().map(|(text, lettering)| {
            let size = Vec2::new(widths::width(text), widths::CAP_HEIGHT) * lettering.size_m;
            let west = match lettering.anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => -0.5 * size.x,
                Anchor::End => -size.x,
            };
            let turn = Vec2::from_angle(lettering.turn_rad);
            let (one, other) = (Vec2::new(west, 0.0), Vec2::new(west + size.x, size.y));
            let [one, other] = [one, other].map(|off| lettering.at + turn.rotate(off));
            Rect::new(one.min(other), one.max(other)).grown(0.3 * lettering.size_m)
        })
    }

    /// Adds a rectangle with corners rounded by `radius_m`, which is limited to half of the smaller side.
    pub fn add_box(&mut self, area: Rect, radius_m: f32, paint: Paint) {
        let radius_m = radius_m.clamp(0.0, 0.5 * area.size().min_element().max(0.0));
        self.marks.push(Mark::Box { area, radius_m, paint });
    }

    /// Adds a shade that fades out within `reach_m` around a rectangle with corners rounded by `radius_m`, which is
    /// limited to half of the smaller side.
    pub fn add_halo(&mut self, area: Rect, radius_m: f32, reach_m: f32, ink: Ink) {
        let radius_m = radius_m.clamp(0.0, 0.5 * area.size().min_element().max(0.0));
        self.marks.push(Mark::Halo { area, radius_m, reach_m, ink });
    }

    /// Adds an ellipse.
    pub fn add_ellipse(&mut self, centre: Vec2, radii: Vec2, paint: Paint) {
        self.marks.push(Mark::Ellipse { centre, radii, paint });
    }

    /// Adds a circle.
    pub fn add_circle(&mut self, centre: Vec2, radius_m: f32, paint: Paint) {
        self.add_ellipse(centre, Vec2::splat(radius_m), paint);
    }

    /// Adds a polyline through `points`; nothing for fewer than two points.
    pub fn add_path(&mut self, points: impl IntoIterator<Item = Vec2>, closed: bool, paint: Paint) {
        if let Some(points) = self.line(points) {
            self.marks.push(Mark::Path { points, closed, paint });
        }
    }

    /// Adds a rectangle of changing colour. Its `inks` are in rows of `columns` from the south-west; nothing for less
    /// than two rows of two. Ignores the inks of an incomplete row.
    pub fn add_field(&mut self, area: Rect, columns: u32, inks: impl IntoIterator<Item = Ink>) {
        let start = self.inks.len();
        self.inks.extend(inks);
        let rows = (self.inks.len() - start) / columns.max(1) as usize;
        let end = start + rows * columns as usize;
        if columns < 2 || rows < 2 {
            self.inks.truncate(start);
            return;
        }
        self.inks.truncate(end);
        self.marks.push(Mark::Field { area, columns, inks: Span { start: start as u32, end: end as u32 } });
    }

    /// Adds the area that a polyline through `points` sweeps when it moves by `reach`; nothing for fewer than two
    /// points.
    pub fn add_band(&mut self, points: impl IntoIterator<Item = Vec2>, reach: Vec2, near: Ink, far: Ink) {
        if let Some(points) = self.line(points) {
            self.marks.push(Mark::Band { points, reach, near, far });
        }
    }

    /// Stores the points of a line; `None` for fewer than two.
    fn line(&mut self, points: impl IntoIterator<Item = Vec2>) -> Option<Span> {
        let start = self.points.len();
        self.points.extend(points);
        if self.points.len() < start + 2 {
            self.points.truncate(start);
            return None;
        }
        Some(Span { start: start as u32, end: self.points.len() as u32 })
    }

    /// Adds a straight line.
    pub fn add_line(&mut self, from: Vec2, to: Vec2, paint: Paint) {
        self.add_path([from, to], false, paint);
    }

    /// Adds one line of text and returns its width in metres; omits control characters.
    pub fn add_text(&mut self, lettering: Lettering, text: fmt::Arguments<'_>) -> f32 {
        let start = self.letters.len();
        // Writing to a `String` does not fail.
        let _ = Printable(&mut self.letters).write_fmt(text);
        let width = widths::width(&self.letters[start..]) * lettering.size_m;
        if self.letters.len() > start {
            let letters = Span { start: start as u32, end: self.letters.len() as u32 };
            self.marks.push(Mark::Text { letters, lettering });
        }
        width
    }

    /// Calls `draw`, and enlarges its marks by the factor `by` about the point `about`.
    pub(super) fn magnified(&mut self, about: Vec2, by: f32, draw: impl FnOnce(&mut Self)) {
        let (first_mark, first_point) = (self.marks.len(), self.points.len());
        draw(self);
        let place = |point: Vec2| about + (point - about) * by;
        for point in self.points.iter_mut().skip(first_point) {
            *point = place(*point);
        }
        for mark in self.marks.iter_mut().skip(first_mark) {
            match mark {
                Mark::Box { area, radius_m, paint } => {
                    *area = Rect::new(place(area.min), place(area.max));
                    *radius_m *= by;
                    paint.magnify(by);
                }
                Mark::Ellipse { centre, radii, paint } => {
                    *centre = place(*centre);
                    *radii *= by;
                    paint.magnify(by);
                }
                Mark::Path { paint, .. } => paint.magnify(by),
                Mark::Field { area, .. } => *area = Rect::new(place(area.min), place(area.max)),
                Mark::Halo { area, radius_m, reach_m, .. } => {
                    *area = Rect::new(place(area.min), place(area.max));
                    *radius_m *= by;
                    *reach_m *= by;
                }
                Mark::Band { reach, .. } => *reach *= by,
                Mark::Text { lettering, .. } => {
                    lettering.at = place(lettering.at);
                    lettering.size_m *= by;
                }
            }
        }
    }

    /// Adds `text` on one line within `room_m` metres, between the lettering's size and `smallest_m`.
    pub(super) fn add_line_of(&mut self, lettering: Lettering, text: &str, room_m: f32, smallest_m: f32) {
        let fitted = fit_line(text, room_m, lettering.size_m, smallest_m);
        if let Some(line) = fitted.lines.first() {
            let end = if fitted.shortened { "…" } else { "" };
            let lettering = Lettering { size_m: fitted.size_m, ..lettering };
            self.add_text(lettering, format_args!("{}{end}", &text[line.clone()]));
        }
    }

    /// Adds `text` on a small rounded plate around `middle` and returns the plate.
    pub fn add_badge(
        &mut self,
        middle: Vec2,
        size_m: f32,
        ink: Ink,
        plate: Paint,
        text: fmt::Arguments<'_>,
    ) -> Rect {
        // The plate lies under its text but has the text's width, so a placeholder keeps its position until the width
        // is known.
        let place = self.marks.len();
        self.add_box(Rect::default(), 0.0, plate);
        let at = middle - Vec2::new(0.0, 0.5 * widths::CAP_HEIGHT * size_m);
        let lettering = Lettering::new(at, Anchor::Middle, size_m, ink).strong();
        let width = self.add_text(lettering, text);
        let area = Rect::from_centre_size(middle, Vec2::new(width + 0.9 * size_m, 1.5 * size_m));
        if let Some(Mark::Box { area: plate, radius_m, .. }) = self.marks.get_mut(place) {
            *plate = area;
            *radius_m = 0.5 * area.size().y;
        }
        area
    }
}

/// Writer that drops control characters, which no picture format accepts.
struct Printable<'a>(&'a mut String);

impl Write for Printable<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.extend(text.chars().filter(|letter| !letter.is_control() && !is_noncharacter(*letter)));
        Ok(())
    }
}

/// True for a Unicode letter that XML rejects.
fn is_noncharacter(letter: char) -> bool {
    matches!(letter, '\u{fffe}' | '\u{ffff}')
}

#[cfg(test)]
mod tests {
    use super::super::TextDirection;
    use super::*;

    fn lettering() -> Lettering {
        Lettering {
            at: Vec2::ZERO,
            anchor: Anchor::Start,
            size_m: 0.1,
            strong: false,
            turn_rad: 0.0,
            ink: Ink::solid(Colour::rgb(0, 0, 0)),
            direction: TextDirection::OfItsLetters,
        }
    }

    #[test]
    fn text_keeps_what_can_be_drawn() {
        let mut scene = Scene::new();
        scene.add_text(lettering(), format_args!("Zoom\u{0}\n in \u{ffff}{}", 3));
        assert_eq!(scene.texts().next().unwrap().0, "Zoom in 3");
        scene.add_text(lettering(), format_args!("\u{7}"));
        assert_eq!(scene.texts().count(), 1, "nothing to write, no mark");
    }

    #[test]
    fn magnified_marks_keep_their_shape() {
        let ink = Ink::solid(Colour::rgb(0, 0, 0));
        let stroke = Paint::stroke(super::super::Stroke::new(0.01, ink).dashed(0.02, 0.03));
        let draw = |scene: &mut Scene, at: Vec2, by: f32| {
            scene.add_box(Rect::from_min_size(at, Vec2::splat(0.2 * by)), 0.05 * by, stroke);
            scene.add_circle(at, 0.1 * by, Paint::fill(ink));
            scene.add_line(at, at + Vec2::X * by, Paint::fill(ink));
            scene.add_text(Lettering { at, size_m: 0.1 * by, ..lettering() }, format_args!("it"));
        };
        let (mut small, mut large) = (Scene::new(), Scene::new());
        let about = Vec2::new(1.0, 2.0);
        small.magnified(about, 2.0, |scene| draw(scene, Vec2::new(1.0, 3.0), 1.0));
        draw(&mut large, Vec2::new(1.0, 4.0), 2.0);
        assert_eq!(small.points, large.points);
        assert_eq!(small.marks[1..], large.marks[1..]);
        let Mark::Box { area, paint, .. } = small.marks[0] else { panic!("not a box") };
        assert!(area.size().distance(Vec2::splat(0.4)) < 1e-6);
        assert_eq!(paint.stroke.unwrap().dash, Some((0.04, 0.06)));
    }

    #[test]
    fn a_path_needs_two_points() {
        let mut scene = Scene::new();
        let paint = Paint::fill(Ink::solid(Colour::rgb(0, 0, 0)));
        scene.add_path([Vec2::ONE], true, paint);
        assert!(scene.marks().is_empty());
        scene.add_line(Vec2::ZERO, Vec2::ONE, paint);
        let Mark::Path { points, .. } = scene.marks()[0] else { panic!("not a path") };
        assert_eq!(scene.points(points), [Vec2::ZERO, Vec2::ONE]);
    }

    #[test]
    fn clearing_keeps_nothing_of_the_last_drawing() {
        let mut scene = Scene::new();
        scene.add_text(lettering(), format_args!("gone"));
        scene.clear(Rect::from_min_size(Vec2::ZERO, Vec2::ONE), Colour::rgb(1, 2, 3));
        assert!(scene.marks().is_empty());
        assert_eq!(scene.bounds().size(), Vec2::ONE);
        assert_eq!(scene.background(), Colour::rgb(1, 2, 3));
    }
}
