//! The check page of a projector: texts of known size, colours and steps of light, edges, and lines of one pixel at
//! the picture's border.

use eframe::egui::{Color32, Mesh, Painter, Pos2, Rect, Shape, pos2, vec2};
use glam::Vec2;

use super::brightness::Brightness;
use super::picture::Picture;
use underfoot::floor;
use underfoot::layout::Colour;
use underfoot_scene::scene::{Anchor, CAP_HEIGHT, Ink, Lettering, Paint, Scene, Stroke};

const BLACK: Colour = Colour::rgb(0, 0, 0);
const WHITE: Colour = Colour::rgb(255, 255, 255);

/// Heights of the capital letters of the texts, in centimetres.
///
/// From two metres, letters are comfortable to read at 1.2 cm: 20 minutes of arc (ISO 9241-303).
const TEXTS_CM: [f32; 6] = [0.5, 1.0, 1.5, 2.0, 3.0, 5.0];

/// Distance between the base lines of two texts, in heights of the capitals of the upper one.
const TEXT_LINE: f32 = 2.0;

/// Average width of a letter, in em; a little more than that of the font.
const LETTER: f32 = 0.58;

/// Colours of the patches with their names.
const COLOURS: [(&str, Colour); 8] = [
    ("white", WHITE),
    ("yellow", Colour::rgb(255, 255, 0)),
    ("cyan", Colour::rgb(0, 255, 255)),
    ("green", Colour::rgb(0, 255, 0)),
    ("magenta", Colour::rgb(255, 0, 255)),
    ("red", Colour::rgb(255, 0, 0)),
    ("blue", Colour::rgb(0, 0, 255)),
    ("grey", Colour::rgb(128, 128, 128)),
];

/// Steps of light, in per cent of white: each must differ from its neighbours.
const STEPS: [u8; 8] = [0, 2, 5, 15, 35, 65, 85, 100];

/// Widths of stripes in millimetres.
const STRIPES_MM: [f32; 4] = [2.0, 5.0, 10.0, 20.0];

/// Maximum side of a block of stripes, in metres.
const BLOCK_M: f32 = 0.25;

/// Draws the page in the true size of the floor with these `bounds` into `scene`, replacing its contents; `heading`
/// names the projector.
pub(super) fn draw(scene: &mut Scene, bounds: floor::Rect, heading: &str) {
    scene.clear(bounds, BLACK);
    scene.add_box(bounds.grown(-0.003), 0.0, Paint::stroke(Stroke::new(0.006, Ink::solid(WHITE))));
    let page = bounds.grown(-0.05 * bounds.size().min_element());
    let [head, texts, colours, light, edges] = bands(page, [0.13, 0.37, 0.15, 0.15, 0.20]);
    let size_m = (0.6 * head.size().y).min(head.size().x / (LETTER * heading.chars().count().max(1) as f32));
    write(scene, Vec2::new(head.min.x, head.max.y - size_m), size_m, heading);
    texts_of_known_size(scene, texts);
    let named = COLOURS.map(|(name, colour)| (name.to_owned(), colour));
    patches(scene, colours, &named);
    let steps = STEPS.map(|percent| {
        let grey = Brightness::new(percent).unwrap_or(Brightness::FULL).dim(Color32::WHITE).r();
        (format!("{percent} %"), Colour::rgb(grey, grey, grey))
    });
    patches(scene, light, &steps);
    stripes(scene, edges);
}

/// `page` cut into bands with these shares of its depth, from the north on.
fn bands<const COUNT: usize>(page: floor::Rect, shares: [f32; COUNT]) -> [floor::Rect; COUNT] {
    let mut north = page.max.y;
    shares.map(|share| {
        let south = north - share * page.size().y;
        let band = floor::Rect::new(Vec2::new(page.min.x, south), Vec2::new(page.max.x, north));
        north = south;
        band
    })
}

/// Writes one line in white.
fn write(scene: &mut Scene, at: Vec2, size_m: f32, text: &str) {
    scene.add_text(Lettering::new(at, Anchor::Start, size_m, Ink::solid(WHITE)), format_args!("{text}"));
}

/// Texts that state the height of their capitals: as many sizes as `band` has room for, the largest first.
fn texts_of_known_size(scene: &mut Scene, band: floor::Rect) {
    let mut depth_m = 0.0;
    let fitting = TEXTS_CM.iter().take_while(|cm| {
        depth_m += TEXT_LINE * 0.01 * *cm;
        depth_m <= band.size().y
    });
    let fitting: Vec<f32> = fitting.copied().collect();
    let mut top = band.max.y;
    for cm in fitting.into_iter().rev() {
        let capital_m = 0.01 * cm;
        let size_m = capital_m / CAP_HEIGHT;
        let letters = (band.size().x / (LETTER * size_m)) as usize;
        let variants =
            [format!("{cm} cm: read this from two metres"), format!("{cm} cm HEX"), format!("{cm}")];
        if let Some(text) = variants.iter().find(|text| text.chars().count() <= letters) {
            write(scene, Vec2::new(band.min.x, top - capital_m), size_m, text);
        }
        top -= TEXT_LINE * capital_m;
    }
}

/// A row of patches with their names.
fn patches(scene: &mut Scene, band: floor::Rect, named: &[(String, Colour)]) {
    let width = band.size().x / named.len().max(1) as f32;
    let size_m = (0.2 * band.size().y).min(0.22 * width).min(0.03);
    for (index, (name, colour)) in named.iter().enumerate() {
        let west = band.min.x + index as f32 * width;
        let patch = floor::Rect::new(
            Vec2::new(west, band.min.y + 0.12 * band.size().y),
            Vec2::new(west + 0.94 * width, band.max.y),
        );
        scene.add_box(patch, 0.0, Paint::fill(Ink::solid(*colour)));
        let ink = if colour.contrast(BLACK) > colour.contrast(WHITE) { BLACK } else { WHITE };
        let at = Vec2::new(patch.centre().x, patch.min.y + 0.6 * size_m);
        scene.add_text(Lettering::new(at, Anchor::Middle, size_m, Ink::solid(ink)), format_args!("{name}"));
    }
}

/// Blocks of upright and of level stripes, with the width of one stripe.
fn stripes(scene: &mut Scene, band: floor::Rect) {
    let room = band.size().x / STRIPES_MM.len() as f32;
    let side = (0.42 * room).min(0.7 * band.size().y).min(BLOCK_M);
    let size_m = (0.2 * band.size().y).min(0.03);
    for (index, mm) in STRIPES_MM.into_iter().enumerate() {
        let (west, width_m) = (band.min.x + index as f32 * room, 0.001 * mm);
        let corner = Vec2::new(west, band.max.y - 0.06 * band.size().y - side);
        let count = (0.5 * side / width_m).ceil().max(1.0) as usize;
        for stripe in 0..count {
            let along = 2.0 * stripe as f32 * width_m;
            let thick = width_m.min(side - along);
            let upright = floor::Rect::from_min_size(corner + Vec2::new(along, 0.0), Vec2::new(thick, side));
            let next = corner + Vec2::new(1.1 * side, along);
            let level = floor::Rect::from_min_size(next, Vec2::new(side, thick));
            for area in [upright, level] {
                scene.add_box(area, 0.0, Paint::fill(Ink::solid(WHITE)));
            }
        }
        write(scene, corner - Vec2::new(0.0, 1.2 * size_m), size_m, &format!("{mm} mm"));
    }
}

/// Side of the patterns at the picture's corners, in pixels.
const PATTERN: u16 = 48;

/// Draws lines of one pixel: a frame of the outermost pixels, and every other pixel in the four corners, upright in two
/// of them and level in the others. A projector that cuts the border off, or scales its picture, shows here.
pub(super) fn draw_border(painter: &Painter, picture: Picture, light: Brightness) {
    let mut mesh = Mesh::default();
    for line in border(picture) {
        mesh.add_colored_rect(line, light.dim(Color32::WHITE));
    }
    painter.add(Shape::mesh(mesh));
}

/// The lines of the border, each one pixel wide.
fn border(picture: Picture) -> Vec<Rect> {
    let (area, pixel) = (picture.area, picture.pixel_points());
    let upright = |x: f32, from: f32, to: f32| Rect::from_min_max(pos2(x, from), pos2(x + pixel, to));
    let level = |y: f32, from: f32, to: f32| Rect::from_min_max(pos2(from, y), pos2(to, y + pixel));
    let mut lines = vec![
        upright(area.left(), area.top(), area.bottom()),
        upright(area.right() - pixel, area.top(), area.bottom()),
        level(area.top(), area.left(), area.right()),
        level(area.bottom() - pixel, area.left(), area.right()),
    ];
    let side = f32::from(PATTERN) * pixel;
    let corner_of = |east: bool, south: bool| -> Pos2 {
        let beyond = area.size() - vec2(side, side);
        area.min + vec2(if east { beyond.x } else { 0.0 }, if south { beyond.y } else { 0.0 })
    };
    for (east, south) in [(false, false), (true, false), (true, true), (false, true)] {
        let corner = corner_of(east, south);
        for line in (0..PATTERN).step_by(2) {
            // From the border on, so that its own line is one of the pattern.
            let along = f32::from(line) * pixel;
            lines.push(if east == south {
                let x = if east { corner.x + side - pixel - along } else { corner.x + along };
                upright(x, corner.y, corner.y + side)
            } else {
                let y = if south { corner.y + side - pixel - along } else { corner.y + along };
                level(y, corner.x, corner.x + side)
            });
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use underfoot_scene::scene::Mark;

    fn page(width_m: f32, depth_m: f32) -> Scene {
        let mut scene = Scene::new();
        let bounds = floor::Rect::from_min_size(Vec2::ZERO, Vec2::new(width_m, depth_m));
        draw(&mut scene, bounds, "Second projector, 50 %");
        scene
    }

    #[test]
    fn texts_are_as_high_as_they_say_on_floors_of_every_size() {
        for (width_m, depth_m, sizes) in [(1.824, 1.824, 6), (0.304, 0.304, 4), (12.0, 8.0, 6), (6.0, 0.6, 5)]
        {
            let scene = page(width_m, depth_m);
            assert!(scene.texts().any(|(text, _)| text == "Second projector, 50 %"));
            let mut count = 0;
            for (text, lettering) in scene.texts() {
                let Some((cm, _)) = text.split_once(" cm") else { continue };
                let cm: f32 = cm.parse().unwrap();
                assert!((100.0 * lettering.size_m * CAP_HEIGHT - cm).abs() < 1e-3, "{text}");
                count += 1;
            }
            assert_eq!(count, sizes, "{width_m} x {depth_m} m");
        }
    }

    #[test]
    fn colours_are_those_of_their_names_and_steps_of_light_grow() {
        let scene = page(1.8, 1.8);
        let fills: Vec<Colour> = scene
            .marks()
            .iter()
            .filter_map(|mark| match mark {
                Mark::Box { paint, .. } => paint.fill.map(|ink| ink.colour),
                _ => None,
            })
            .collect();
        for (name, colour) in COLOURS {
            assert!(fills.contains(&colour), "{name}");
        }
        let greys = &fills[COLOURS.len()..COLOURS.len() + STEPS.len()];
        assert!(greys.windows(2).all(|pair| pair[0].red < pair[1].red), "{greys:?}");
        assert!(greys[0] == BLACK && greys[STEPS.len() - 1] == WHITE);
    }

    #[test]
    fn nothing_of_the_page_lies_off_the_floor() {
        for (width_m, depth_m) in [(1.824, 1.824), (0.304, 0.304), (12.0, 2.0)] {
            for mark in page(width_m, depth_m).marks() {
                let area = match mark {
                    Mark::Box { area, .. } => *area,
                    Mark::Text { lettering, .. } => floor::Rect::new(lettering.at, lettering.at),
                    other => panic!("{other:?}"),
                };
                let floor = floor::Rect::from_min_size(Vec2::ZERO, Vec2::new(width_m, depth_m)).grown(1e-4);
                assert!(floor.contains(area.min) && floor.contains(area.max), "{mark:?}");
            }
        }
    }
}
