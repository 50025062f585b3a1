//! A drawing of lines, boxes and short texts.

use underfoot::floor::Rect;
use underfoot::glam::Vec2;
use underfoot::layout::Colour;
use underfoot_scene::scene::{Anchor, Ink, Lettering, Paint, Scene, Stroke, Theme};

pub(super) const THEME: Theme = Theme::LIGHT;

/// Colours that differ in print and for the colour-blind.
pub(super) const COLOURS: [Colour; 6] = [
    Colour::rgb(0x1f, 0x5f, 0xa8),
    Colour::rgb(0xc7, 0x5b, 0x12),
    Colour::rgb(0x1d, 0x82, 0x5b),
    Colour::rgb(0x9b, 0x3f, 0x9b),
    Colour::rgb(0x8a, 0x6d, 0x00),
    Colour::rgb(0x4a, 0x55, 0x60),
];

/// A sheet with letters and lines of one size.
pub(super) struct Sheet {
    pub(super) scene: Scene,
    /// Height of the letters, in metres.
    em_m: f32,
}

impl Sheet {
    /// An empty sheet over `area`.
    pub(super) fn new(area: Rect, em_m: f32) -> Self {
        let mut scene = Scene::new();
        scene.clear(area, Colour::rgb(0xff, 0xff, 0xff));
        Self { scene, em_m }
    }

    /// A text whose middle in height is at `at`.
    pub(super) fn text(&mut self, at: Vec2, anchor: Anchor, colour: Colour, text: &str) {
        self.sized(at, anchor, colour, 1.0, text);
    }

    /// The same, so many times as large.
    pub(super) fn sized(&mut self, at: Vec2, anchor: Anchor, colour: Colour, times: f32, text: &str) {
        let size_m = times * self.em_m;
        let at = at - Vec2::new(0.0, 0.35 * size_m);
        self.scene.add_text(Lettering::new(at, anchor, size_m, Ink::solid(colour)), format_args!("{text}"));
    }

    fn stroke(&self, colour: Colour) -> Stroke {
        Stroke::new(0.12 * self.em_m, Ink::solid(colour))
    }

    pub(super) fn line(&mut self, from: Vec2, to: Vec2, colour: Colour) {
        let paint = Paint::stroke(self.stroke(colour));
        self.scene.add_line(from, to, paint);
    }

    pub(super) fn boxed(&mut self, area: Rect, fill: Colour) {
        let paint = Paint::fill(Ink::solid(fill)).with_stroke(self.stroke(THEME.ink));
        self.scene.add_box(area, 0.2 * self.em_m, paint);
    }

    pub(super) fn dot(&mut self, at: Vec2, colour: Colour) {
        self.scene.add_circle(at, 0.35 * self.em_m, Paint::fill(Ink::solid(colour)));
    }

    /// A dot without filling.
    pub(super) fn ring(&mut self, at: Vec2, colour: Colour) {
        let paint = Paint::stroke(self.stroke(colour));
        self.scene.add_circle(at, 0.35 * self.em_m, paint);
    }
}
