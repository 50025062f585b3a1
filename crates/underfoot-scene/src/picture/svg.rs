//! A drawing as SVG.

use std::fmt::{self, Write};

use glam::Vec2;

use super::text::{LinePlacing, escape};
use crate::letters::Fonts;
use crate::scene::{Anchor, Ink, Lettering, Mark, Paint, Scene, Stroke};
use underfoot::floor::Rect;

/// The drawing as a stand-alone SVG document; one user unit is a millimetre of floor.
///
/// Printed at 100 %, it is as large as the floor. Text is drawn as outlines of `fonts`, so that it looks the same in
/// every viewer; `aria-label` holds the words for screen readers and search.
#[must_use]
pub fn svg(scene: &Scene, fonts: &Fonts) -> String {
    let size = mm(scene.bounds().size());
    // A mark takes about 120 bytes.
    let mut page = Page {
        out: String::with_capacity(400 + 130 * scene.marks().len()),
        bounds: scene.bounds(),
        fonts,
        gradients: 0,
        signs: 0,
    };
    // Writing to a `String` cannot fail.
    let _ = page.document(scene, size);
    page.out
}

/// Converts metres to the document's millimetres.
fn mm(metres: Vec2) -> Vec2 {
    metres * 1000.0
}

struct Page<'f> {
    out: String,
    bounds: Rect,
    fonts: &'f Fonts,
    /// Number of gradients so far, for their unique names.
    gradients: u32,
    /// Number of signs with their own colours so far; the names inside each begin with its number.
    signs: usize,
}

/// Maximum height of the strips of a field, in millimetres: the steps between strips are invisible.
const STRIP_MM: f32 = 5.0;

/// Number of layers of a band that fades out.
const LAYERS: u16 = 4;

impl Page<'_> {
    fn document(&mut self, scene: &Scene, size: Vec2) -> fmt::Result {
        let Vec2 { x, y } = size;
        write!(
            self.out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{x:.1}mm\" height=\"{y:.1}mm\" \
             viewBox=\"0 0 {x:.1} {y:.1}\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"{}\"/>\n",
            scene.background()
        )?;
        for mark in scene.marks() {
            self.mark(scene, mark)?;
        }
        self.out.write_str("</svg>\n")
    }

    /// Converts a floor point to the page: x to the right, y down, in millimetres.
    fn place(&self, point: Vec2) -> Vec2 {
        mm(Vec2::new(point.x - self.bounds.min.x, self.bounds.max.y - point.y))
    }

    fn mark(&mut self, scene: &Scene, mark: &Mark) -> fmt::Result {
        match mark {
            Mark::Box { area, radius_m, paint } => {
                let at = self.place(Vec2::new(area.min.x, area.max.y));
                let size = mm(area.size());
                write!(
                    self.out,
                    "<rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" rx=\"{:.2}\"",
                    at.x,
                    at.y,
                    size.x.max(0.0),
                    size.y.max(0.0),
                    radius_m * 1000.0
                )?;
                self.paint(paint)
            }
            Mark::Ellipse { centre, radii, paint } => {
                let (at, radii) = (self.place(*centre), mm(*radii));
                write!(
                    self.out,
                    "<ellipse cx=\"{:.2}\" cy=\"{:.2}\" rx=\"{:.2}\" ry=\"{:.2}\"",
                    at.x,
                    at.y,
                    radii.x.max(0.0),
                    radii.y.max(0.0)
                )?;
                self.paint(paint)
            }
            Mark::Path { points, closed, paint } => {
                self.out.write_str("<path d=\"")?;
                for (step, point) in scene.points(*points).iter().enumerate() {
                    let at = self.place(*point);
                    write!(self.out, "{}{:.2} {:.2}", if step == 0 { "M" } else { " " }, at.x, at.y)?;
                }
                write!(self.out, "{}\"", if *closed { "Z" } else { "" })?;
                self.paint(paint)
            }
            Mark::Field { area, columns, inks } => self.field(*area, *columns as usize, scene.inks(*inks)),
            Mark::Band { points, reach, near, far } => self.band(scene.points(*points), *reach, *near, *far),
            Mark::Text { letters, lettering } => self.text(scene.letters(*letters), lettering),
            Mark::Halo { area, radius_m, reach_m, ink } => self.halo(*area, *radius_m, *reach_m, *ink),
        }
    }

    /// Lines around the edge, one over the other, each wider than the previous one.
    fn halo(&mut self, area: Rect, radius_m: f32, reach_m: f32, ink: Ink) -> fmt::Result {
        const LINES: u8 = 3;
        for line in 1..=LINES {
            let width = reach_m * f32::from(line) / f32::from(LINES);
            let stroke = Stroke::new(width, Ink::faint(ink.colour, ink.opacity / f32::from(LINES)));
            let (area, radius_m) = (area.grown(0.5 * width), radius_m + 0.5 * width);
            let paint = Paint::stroke(stroke);
            self.mark(&Scene::new(), &Mark::Box { area, radius_m, paint })?;
        }
        Ok(())
    }

    /// Horizontal strips with a gradient from west to east each.
    fn field(&mut self, area: Rect, columns: usize, inks: &[Ink]) -> fmt::Result {
        let rows = inks.len() / columns;
        let (at, size) = (self.place(Vec2::new(area.min.x, area.max.y)), mm(area.size()));
        let cell = size.y / (rows - 1) as f32;
        let each = (cell / STRIP_MM).ceil().clamp(1.0, 64.0) as usize;
        let strips = (rows - 1) * each;
        for strip in 0..strips {
            // From north to south.
            let from_south = ((strips - 1 - strip) as f32 + 0.5) / each as f32;
            let (row, share) = (from_south as usize, from_south.fract());
            let ink =
                |column: usize| inks[row * columns + column].mix(inks[(row + 1) * columns + column], share);
            self.gradients += 1;
            let name = self.gradients;
            write!(self.out, "<linearGradient id=\"g{name}\">")?;
            for column in 0..columns {
                // A stop that equals both neighbours is redundant.
                let is_plain = column > 0
                    && column + 1 < columns
                    && ink(column) == ink(column - 1)
                    && ink(column) == ink(column + 1);
                if !is_plain {
                    let offset = column as f32 / (columns - 1) as f32;
                    let Ink { colour, opacity } = ink(column);
                    write!(self.out, "<stop offset=\"{offset:.4}\" stop-color=\"{colour}\"")?;
                    self.opacity("stop-opacity", opacity)?;
                    self.out.write_str("/>")?;
                }
            }
            let top = at.y + size.y * strip as f32 / strips as f32;
            writeln!(
                self.out,
                "</linearGradient><rect x=\"{:.2}\" y=\"{top:.2}\" width=\"{:.2}\" height=\"{:.2}\" \
                 fill=\"url(#g{name})\" shape-rendering=\"crispEdges\"/>",
                at.x,
                size.x,
                size.y / strips as f32
            )?;
        }
        Ok(())
    }

    /// Layers of increasing width, which together fade out.
    fn band(&mut self, points: &[Vec2], reach: Vec2, near: Ink, far: Ink) -> fmt::Result {
        for layer in 1..=LAYERS {
            let share = f32::from(layer) / f32::from(LAYERS);
            let Ink { colour, opacity } = near.mix(far, share - 0.5 / f32::from(LAYERS));
            let beyond = near.mix(far, share + 0.5 / f32::from(LAYERS)).opacity;
            // Where layers overlap, their transmissions multiply: own = 1 - (1 - opacity) / (1 - beyond).
            let beyond = if layer == LAYERS { 0.0 } else { beyond };
            let own = 1.0 - (1.0 - opacity) / (1.0 - beyond).max(1e-3);
            if own <= 0.0 {
                continue;
            }
            self.out.write_str("<path d=\"")?;
            let far_side = points.iter().rev().map(|point| *point + reach * share);
            for (step, point) in points.iter().copied().chain(far_side).enumerate() {
                let at = self.place(point);
                write!(self.out, "{}{:.2} {:.2}", if step == 0 { "M" } else { " " }, at.x, at.y)?;
            }
            write!(self.out, "Z\" fill=\"{colour}\"")?;
            self.opacity("fill-opacity", own)?;
            self.out.write_str("/>\n")?;
        }
        Ok(())
    }

    /// The attributes for filling and stroke of a mark, and the end of its element.
    fn paint(&mut self, paint: &Paint) -> fmt::Result {
        match paint.fill {
            Some(ink) => {
                write!(self.out, " fill=\"{}\"", ink.colour)?;
                self.opacity("fill-opacity", ink.opacity)?;
            }
            None => self.out.write_str(" fill=\"none\"")?,
        }
        if let Some(stroke) = paint.stroke {
            write!(
                self.out,
                " stroke=\"{}\" stroke-width=\"{:.2}\" stroke-linecap=\"round\" stroke-linejoin=\"round\"",
                stroke.ink.colour,
                stroke.width_m * 1000.0
            )?;
            self.opacity("stroke-opacity", stroke.ink.opacity)?;
            if let Some((on, off)) = stroke.dash {
                write!(self.out, " stroke-dasharray=\"{:.1} {:.1}\"", on * 1000.0, off * 1000.0)?;
            }
        }
        self.out.write_str("/>\n")
    }

    fn opacity(&mut self, name: &str, opacity: f32) -> fmt::Result {
        if opacity < 1.0 { write!(self.out, " {name}=\"{opacity:.3}\"") } else { Ok(()) }
    }

    fn text(&mut self, letters: &str, lettering: &Lettering) -> fmt::Result {
        let at = self.place(lettering.at);
        let em = lettering.size_m * 1000.0;
        let line = self.fonts.line(letters, lettering.direction);
        let before = match lettering.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5,
            Anchor::End => 1.0,
        };
        let placing = LinePlacing { start: at - Vec2::new(before * line.width() * em, 0.0), em };
        self.out.write_str("<g role=\"img\" aria-label=\"")?;
        escape(&mut self.out, letters)?;
        self.out.write_str("\"")?;
        if lettering.turn_rad != 0.0 {
            // The page's y axis points down: a counter-clockwise turn on the floor is negative here.
            let degrees = -lettering.turn_rad.to_degrees();
            write!(self.out, " transform=\"rotate({degrees:.1} {:.2} {:.2})\"", at.x, at.y)?;
        }
        let colour = lettering.ink.colour;
        write!(self.out, "><path fill=\"{colour}\"")?;
        self.opacity("fill-opacity", lettering.ink.opacity)?;
        if lettering.strong {
            // The font has one weight; a stroke makes it heavier.
            write!(self.out, " stroke=\"{colour}\" stroke-width=\"{:.2}\"", STRONG_EM * em)?;
            self.opacity("stroke-opacity", lettering.ink.opacity)?;
        }
        self.out.write_str(" d=\"")?;
        let mut written = Ok(());
        line.outline(|step| written = written.and(placing.step(&mut self.out, step)));
        written?;
        self.out.write_str("\"/>")?;
        for sign in line.signs() {
            placing.sign(&mut self.out, sign, self.signs)?;
            self.signs += 1;
        }
        self.out.write_str("</g>\n")
    }
}

/// Stroke width of strong letters, in em.
const STRONG_EM: f32 = 0.028;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Ink, Stroke};
    use underfoot::layout::Colour;

    fn scene() -> Scene {
        let mut scene = Scene::new();
        scene.clear(Rect::new(Vec2::new(-1.0, -1.0), Vec2::new(1.0, 1.0)), Colour::rgb(250, 250, 250));
        scene
    }

    #[test]
    fn north_is_up_and_a_metre_is_a_thousand_units() {
        let mut scene = scene();
        let ink = Ink::faint(Colour::rgb(0x10, 0x20, 0x30), 0.5);
        let north_east = Rect::from_min_size(Vec2::ZERO, Vec2::new(0.5, 0.25));
        scene.add_box(north_east, 0.01, Paint::fill(ink));
        scene.add_line(Vec2::ZERO, Vec2::X, Paint::stroke(Stroke::new(0.002, ink).dashed(0.01, 0.02)));
        let text = svg(&scene, &Fonts::built_in());
        assert!(text.contains("viewBox=\"0 0 2000.0 2000.0\""), "{text}");
        assert!(
            text.contains(
                "<rect x=\"1000.00\" y=\"750.00\" width=\"500.00\" height=\"250.00\" rx=\"10.00\" \
                 fill=\"#102030\" fill-opacity=\"0.500\"/>"
            ),
            "{text}"
        );
        assert!(text.contains("d=\"M1000.00 1000.00 2000.00 1000.00\" fill=\"none\""), "{text}");
        assert!(text.contains("stroke-dasharray=\"10.0 20.0\""), "{text}");
    }

    #[test]
    fn text_is_outlines_with_its_words_beside_them() {
        let mut scene = scene();
        let lettering = Lettering::new(Vec2::ZERO, Anchor::Start, 0.05, Ink::solid(Colour::rgb(0, 0, 0)));
        scene.add_text(lettering, format_args!("<Salt & \"Pepper\">"));
        let text = svg(&scene, &Fonts::built_in());
        assert!(text.contains("aria-label=\"&lt;Salt &amp; &quot;Pepper&quot;&gt;\"><path fill"), "{text}");
        // A viewer with other fonts, or without fonts, shows the same.
        assert!(!text.contains("<text") && !text.contains("font-family"), "{text}");
        assert!(text.matches('Z').count() >= 15, "{text}");
    }
}
