//! Drawing of figures: axes, points, arrows, outlines and legends as scene marks.
//!
//! A page is a scene in page metres, so that letters have their nominal height when printed at full size.

use std::fmt;

use glam::Vec2;

use underfoot::floor::Rect;
use underfoot::layout::Colour;
use underfoot_scene::scene::{Anchor, Ink, Lettering, Paint, Scene, Stroke, Theme};

/// Theme of all figures, for paper.
pub(super) const THEME: Theme = Theme::LIGHT;

/// Height of ordinary letters (page metres).
const LETTER_M: f32 = 0.0032;

/// Width of the main lines (page metres).
pub(super) const LINE_M: f32 = 0.0005;

/// Page of a figure.
#[derive(Debug)]
pub(super) struct ChartPage {
    pub(super) scene: Scene,
}

/// Style of a line of text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Type {
    pub(super) anchor: Anchor,
    pub(super) size_m: f32,
    pub(super) strong: bool,
    pub(super) colour: Colour,
    pub(super) turn_rad: f32,
}

impl Type {
    /// Ordinary letters.
    pub(super) const PLAIN: Self =
        Self { anchor: Anchor::Start, size_m: LETTER_M, strong: false, colour: THEME.ink, turn_rad: 0.0 };

    /// Letters of secondary text.
    pub(super) const QUIET: Self = Self { colour: THEME.quiet, ..Self::PLAIN };

    pub(super) const fn middle(self) -> Self {
        Self { anchor: Anchor::Middle, ..self }
    }

    const fn end(self) -> Self {
        Self { anchor: Anchor::End, ..self }
    }
}

impl ChartPage {
    /// Creates a page of `size` metres with a title, and a line below it that explains the figure.
    pub(super) fn new(size: Vec2, title: &str, about: &str) -> Self {
        let mut scene = Scene::new();
        scene.clear(Rect::from_min_size(Vec2::ZERO, size), THEME.canvas);
        let mut page = Self { scene };
        let top = Vec2::new(MARGIN_M, size.y - 0.0115);
        page.text(top, Type { size_m: 0.0058, strong: true, ..Type::PLAIN }, format_args!("{title}"));
        page.text(top - Vec2::new(0.0, 0.0062), Type::QUIET, format_args!("{about}"));
        page
    }

    /// Sets one line of text and returns its width.
    pub(super) fn text(&mut self, at: Vec2, kind: Type, text: fmt::Arguments<'_>) -> f32 {
        let Type { anchor, size_m, strong, colour, turn_rad } = kind;
        let lettering =
            Lettering { strong, turn_rad, ..Lettering::new(at, anchor, size_m, Ink::solid(colour)) };
        self.scene.add_text(lettering, text)
    }

    /// A ring, for true positions.
    pub(super) fn ring(&mut self, at: Vec2, colour: Colour) {
        let paint = Paint::fill(Ink::faint(THEME.plate, 0.7));
        self.scene.add_circle(at, 0.0014, paint.with_stroke(Stroke::new(0.00045, Ink::solid(colour))));
    }

    /// A dot.
    pub(super) fn dot(&mut self, at: Vec2, colour: Colour) {
        self.scene.add_circle(at, 0.00085, Paint::fill(Ink::solid(colour)));
    }

    /// An X, for estimated positions.
    pub(super) fn cross(&mut self, at: Vec2, colour: Colour) {
        for arm in [Vec2::splat(0.0013), Vec2::new(0.0013, -0.0013)] {
            self.line(at - arm, at + arm, Stroke::new(0.0006, Ink::solid(colour)));
        }
    }

    /// A straight line.
    pub(super) fn line(&mut self, from: Vec2, to: Vec2, stroke: Stroke) {
        self.scene.add_line(from, to, Paint::stroke(stroke));
    }

    /// A line with an arrow head at its end.
    pub(super) fn arrow(&mut self, from: Vec2, to: Vec2, colour: Colour) {
        let stroke = Stroke::new(0.0007, Ink::solid(colour));
        self.line(from, to, stroke);
        let way = (to - from).normalize_or_zero();
        let back = to - way * 0.0022;
        let side = way.perp() * 0.0013;
        self.scene.add_path([back + side, to, back - side], false, Paint::stroke(stroke));
    }

    /// One line of samples with their names, from `at` eastwards.
    pub(super) fn legend(&mut self, at: Vec2, entries: &[(LegendSymbol, Colour, &str)]) {
        let mut x = at.x;
        for &(sample, colour, name) in entries {
            let middle = Vec2::new(x + 0.003, at.y + 0.0011);
            let (west, east) = (middle - Vec2::X * 0.003, middle + Vec2::X * 0.003);
            match sample {
                LegendSymbol::Ring => self.ring(middle, colour),
                LegendSymbol::Cross => self.cross(middle, colour),
                LegendSymbol::Dot => self.dot(middle, colour),
                LegendSymbol::Arrow => self.arrow(west, east, colour),
                LegendSymbol::Line => self.line(west, east, Stroke::new(LINE_M, Ink::solid(colour))),
                LegendSymbol::Dashes => {
                    self.line(west, east, Stroke::new(LINE_M, Ink::solid(colour)).dashed(0.0011, 0.0011));
                }
            }
            let text_x = x + 0.0078;
            x = text_x + self.text(Vec2::new(text_x, at.y), Type::PLAIN, format_args!("{name}")) + 0.0075;
        }
    }
}

/// Formats a number without decimals, with a minus sign instead of a hyphen.
pub(super) fn whole(value: f32) -> String {
    // Adding 0 turns -0 into 0.
    format!("{:.0}", value.round() + 0.0).replace('-', "\u{2212}")
}

/// Margin of the page (m).
pub(super) const MARGIN_M: f32 = 0.008;

/// Symbol in front of a name in a legend.
#[derive(Clone, Copy, Debug)]
pub(super) enum LegendSymbol {
    Ring,
    Cross,
    Dot,
    Arrow,
    Line,
    Dashes,
}

/// One axis: its range, the distance of its ticks, and its label.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChartAxis {
    pub(super) from: f32,
    pub(super) to: f32,
    pub(super) tick: f32,
    pub(super) label: &'static str,
}

/// A rectangle on a page with a scale on two sides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plot {
    area: Rect,
    x: ChartAxis,
    y: ChartAxis,
}

impl Plot {
    /// A plot within `area` of the page, below `title`, with its axes, ticks and a faint grid.
    pub(super) fn draw(page: &mut ChartPage, area: Rect, title: &str, x: ChartAxis, y: ChartAxis) -> Self {
        let plot = Self { area, x, y };
        let edge = Stroke::new(0.0003, Ink::solid(THEME.stance));
        let grid = Stroke::new(0.0002, Ink::solid(THEME.line));
        page.scene.add_box(area, 0.0, Paint::fill(Ink::solid(THEME.plate)));
        for (axis, horizontal) in [(x, true), (y, false)] {
            let count = ((axis.to - axis.from) / axis.tick + 1e-3) as u16;
            for step in 0..=count {
                let value = axis.from + f32::from(step) * axis.tick;
                let said = whole(value);
                if horizontal {
                    let at = Vec2::new(plot.at(Vec2::new(value, y.from)).x, area.min.y);
                    page.line(at, Vec2::new(at.x, area.max.y), grid);
                    let kind = Type { size_m: 0.0028, ..Type::QUIET }.middle();
                    page.text(at - Vec2::new(0.0, 0.0041), kind, format_args!("{said}"));
                } else {
                    let at = Vec2::new(area.min.x, plot.at(Vec2::new(x.from, value)).y);
                    page.line(at, Vec2::new(area.max.x, at.y), grid);
                    let kind = Type { size_m: 0.0028, ..Type::QUIET }.end();
                    page.text(at - Vec2::new(0.0014, 0.001), kind, format_args!("{said}"));
                }
            }
        }
        page.scene.add_box(area, 0.0, Paint::stroke(edge));
        let centre = area.centre();
        page.text(
            Vec2::new(centre.x, area.min.y - 0.0088),
            Type::QUIET.middle(),
            format_args!("{}", x.label),
        );
        let turned = Type { turn_rad: std::f32::consts::FRAC_PI_2, ..Type::QUIET.middle() };
        page.text(Vec2::new(area.min.x - 0.0072, centre.y), turned, format_args!("{}", y.label));
        let title_at = Vec2::new(area.min.x, area.max.y + 0.0022);
        page.text(title_at, Type { strong: true, ..Type::PLAIN }, format_args!("{title}"));
        plot
    }

    /// Position of a value on the page; it may be outside the plot.
    pub(super) fn at(&self, value: Vec2) -> Vec2 {
        let low = Vec2::new(self.x.from, self.y.from);
        let high = Vec2::new(self.x.to, self.y.to);
        self.area.min + self.area.size() * (value - low) / (high - low)
    }

    /// A polyline through these values.
    pub(super) fn curve(&self, page: &mut ChartPage, values: impl IntoIterator<Item = Vec2>, stroke: Stroke) {
        let points: Vec<Vec2> = values.into_iter().map(|value| self.at(value)).collect();
        page.scene.add_path(points, false, Paint::stroke(stroke));
    }
}

/// A part of the floor, drawn to scale on a page.
#[derive(Clone, Copy, Debug)]
pub(super) struct Map {
    /// The drawn part of the floor (floor metres), and the position of its south-west corner on the page.
    pub(super) floor: Rect,
    pub(super) corner: Vec2,
    /// Page metres per floor metre.
    pub(super) scale: f32,
}

impl Map {
    /// Fits `floor` into `area`, at its north-west corner.
    pub(super) fn new(floor: Rect, area: Rect) -> Self {
        let scale = (area.size() / floor.size()).min_element();
        Self { floor, corner: Vec2::new(area.min.x, area.max.y - floor.size().y * scale), scale }
    }

    /// Position of a floor point on the page.
    pub(super) fn at(&self, point: Vec2) -> Vec2 {
        self.corner + (point - self.floor.min) * self.scale
    }

    /// The covered area of the page.
    pub(super) fn area(&self) -> Rect {
        Rect::new(self.at(self.floor.min), self.at(self.floor.max))
    }

    /// A floor rectangle, on the page.
    pub(super) fn rect(&self, area: Rect) -> Rect {
        Rect::new(self.at(area.min), self.at(area.max))
    }

    /// A closed outline through floor points.
    pub(super) fn outline(&self, page: &mut ChartPage, points: impl IntoIterator<Item = Vec2>, paint: Paint) {
        let points: Vec<Vec2> = points.into_iter().map(|point| self.at(point)).collect();
        page.scene.add_path(points, true, paint);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plots_put_values_where_their_axes_say() {
        let mut page = ChartPage::new(Vec2::new(0.1, 0.1), "Title", "about");
        let axis = |from, to| ChartAxis { from, to, tick: 10.0, label: "degrees" };
        let area = Rect::new(Vec2::new(0.02, 0.02), Vec2::new(0.08, 0.08));
        let plot = Plot::draw(&mut page, area, "Plot", axis(0.0, 60.0), axis(-30.0, 30.0));
        assert!(plot.at(Vec2::new(0.0, -30.0)).distance(area.min) < 1e-6);
        assert!(plot.at(Vec2::new(60.0, 30.0)).distance(area.max) < 1e-6);
        let ticks: Vec<&str> = page.scene.texts().map(|(text, _)| text).collect();
        assert!(
            ticks.contains(&"60") && ticks.contains(&"\u{2212}30") && ticks.contains(&"Plot"),
            "{ticks:?}"
        );
    }

    #[test]
    fn maps_keep_the_floor_s_proportions() {
        let floor = Rect::new(Vec2::new(1.0, 1.0), Vec2::new(3.0, 2.0));
        let map = Map::new(floor, Rect::new(Vec2::ZERO, Vec2::splat(0.1)));
        assert!((map.scale - 0.05).abs() < 1e-6);
        assert!(map.area().max.distance(Vec2::splat(0.1)) < 1e-6);
        assert!(map.at(Vec2::new(1.0, 1.0)).distance(Vec2::new(0.0, 0.05)) < 1e-6);
    }
}
