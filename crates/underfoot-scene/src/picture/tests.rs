//! Pictures as files, with checks of single pixels.

use std::path::Path;

use resvg::tiny_skia::Pixmap;

use super::PictureError;
use crate::letters::Fonts;
use crate::scene::sample::{at_rest, map, pressing};
use crate::scene::{Scene, Show, TextDirection, Theme, View, draw};
use underfoot::floor::Geometry;

fn svg(scene: &Scene) -> String {
    super::svg(scene, &Fonts::built_in())
}

fn png(scene: &Scene, width_px: u32) -> Result<Vec<u8>, PictureError> {
    super::png(scene, &Fonts::built_in(), width_px)
}

fn write(scene: &Scene, path: &Path, width_px: u32) -> Result<(), PictureError> {
    super::write(scene, &Fonts::built_in(), path, width_px)
}

fn drawing(theme: &Theme, show: Show) -> Scene {
    let (layout, geometry) = (map(), Geometry::default());
    let snapshot = if show == Show::LAYOUT { at_rest(&layout) } else { pressing(&layout) };
    let mut scene = Scene::new();
    draw(&mut scene, &View { show, ..View::new(&geometry, &layout, &snapshot, theme) });
    scene
}

#[test]
fn a_picture_is_a_png_of_the_width_asked_for_and_the_same_every_time() {
    let scene = drawing(&Theme::LIGHT, Show::PICTURE);
    let bytes = png(&scene, 480).unwrap();
    let pixels = Pixmap::decode_png(&bytes).unwrap();
    let size = scene.bounds().size();
    assert_eq!(pixels.width(), 480);
    assert_eq!(pixels.height(), (480.0 * size.y / size.x).round() as u32);
    assert_eq!(bytes, png(&scene, 480).unwrap());
}

#[test]
fn a_pressed_button_is_seen_in_the_pixels() {
    let scene = drawing(&Theme::LIGHT, Show::PICTURE);
    let pixels = Pixmap::decode_png(&png(&scene, 600).unwrap()).unwrap();
    let button = &map().widgets[0];
    let scale = 600.0 / scene.bounds().size().x;
    // Near the south-west corner of the face: no letters, no contact.
    let at = button.area.min + 0.03;
    let (x, y) = ((at.x - scene.bounds().min.x) * scale, (scene.bounds().max.y - at.y) * scale);
    let pixel = pixels.pixel(x as u32, y as u32).unwrap();
    let lit = button.look.lit;
    for (seen, wanted) in [(pixel.red(), lit.red), (pixel.green(), lit.green), (pixel.blue(), lit.blue)] {
        assert!(seen.abs_diff(wanted) < 12, "{pixel:?} is not {lit}");
    }
}

#[test]
fn letters_are_as_wide_as_the_scene_takes_them_for() {
    // A table of widths makes text fit; this compares the table with the font.
    let fonts = Fonts::built_in();
    for text in ["Zoom in", "Names of places", "0123456789", "WAVE 12.5 %", "Größe – façade"] {
        let seen = 100.0 * fonts.line(text, TextDirection::OfItsLetters).width();
        let mut scene = Scene::new();
        let lettering = crate::scene::Lettering::new(
            glam::Vec2::ZERO,
            crate::scene::Anchor::Start,
            100.0,
            crate::scene::Ink::solid(Theme::LIGHT.ink),
        );
        let taken = scene.add_text(lettering, format_args!("{text}"));
        // Kerning moves some pairs of letters closer together than their widths.
        assert!((0.94..=1.01).contains(&(seen / taken)), "{text}: {seen} seen, {taken} taken");
    }
}

#[test]
fn sizes_that_no_machine_can_hold_are_refused() {
    let scene = drawing(&Theme::DARK, Show::LAYOUT);
    for width in [0, 15, 16_385, u32::MAX] {
        assert!(matches!(png(&scene, width), Err(PictureError::Size { .. })), "{width}");
    }
    assert!(matches!(png(&Scene::new(), 100), Err(PictureError::Drawing(_))));
}

#[test]
fn the_files_name_says_what_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let scene = drawing(&Theme::DARK, Show::LAYOUT);
    let path = folder.path().join("floor.SVG");
    write(&scene, &path, 200).unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), svg(&scene));
    let path = folder.path().join("floor.png");
    write(&scene, &path, 200).unwrap();
    assert!(std::fs::read(&path).unwrap().starts_with(b"\x89PNG"));
    let nowhere = Path::new("/nonexistent/floor.png");
    let message = write(&scene, nowhere, 200).unwrap_err().to_string();
    assert!(message.starts_with("cannot write /nonexistent/floor.png"), "{message}");
}

/// A field from black in the west to white in the east, and a band that fades out northwards.
#[test]
fn fields_and_bands_change_smoothly_in_the_pixels() {
    use crate::scene::Ink;
    use glam::Vec2;
    use underfoot::floor::Rect;
    use underfoot::layout::Colour;

    let (black, white) = (Colour::rgb(0, 0, 0), Colour::rgb(255, 255, 255));
    let mut scene = Scene::new();
    scene.clear(Rect::from_min_size(Vec2::ZERO, Vec2::ONE), Colour::rgb(128, 128, 128));
    let south = Rect::from_min_size(Vec2::ZERO, Vec2::new(1.0, 0.5));
    let inks = [black, white, black, white].map(Ink::solid);
    scene.add_field(south, 2, inks);
    let line = [Vec2::new(0.0, 0.6), Vec2::new(0.5, 0.6), Vec2::new(1.0, 0.6)];
    scene.add_band(line, Vec2::new(0.0, 0.4), Ink::solid(white), Ink::faint(white, 0.0));
    let pixels = Pixmap::decode_png(&png(&scene, 200).unwrap()).unwrap();
    let red = |x: f32, y: f32| {
        i32::from(pixels.pixel((x * 200.0) as u32, ((1.0 - y) * 200.0) as u32).unwrap().red())
    };
    for share in [0.1, 0.5, 0.9] {
        let wanted = (share * 255.0) as i32;
        assert!((red(share, 0.25) - wanted).abs() < 6, "{} at {share}", red(share, 0.25));
    }
    let fading = [0.62, 0.72, 0.82, 0.92].map(|y| red(0.4, y));
    assert!(fading.windows(2).all(|pair| pair[0] > pair[1]), "{fading:?}");
    assert!(fading[0] > 220 && fading[3] < 165, "{fading:?}");
    assert_eq!(red(0.5, 0.55), 128, "nothing between the two");
    // Calls with invalid input for a field or band add no marks.
    let marks = scene.marks().len();
    scene.add_field(south, 3, inks);
    scene.add_band([Vec2::ONE], Vec2::X, inks[0], inks[1]);
    assert_eq!(scene.marks().len(), marks);
}

/// The frames of an animated picture: left, top, width, height, and delay in hundredths of a second.
fn frames(bytes: &[u8]) -> Vec<([u16; 4], u16)> {
    let mut decoder = gif::DecodeOptions::new().read_info(bytes).unwrap();
    let mut frames = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        frames.push(([frame.left, frame.top, frame.width, frame.height], frame.delay));
    }
    frames
}

#[test]
fn an_animated_picture_lasts_as_long_as_the_visit_and_redraws_only_what_the_foot_changes() {
    use super::Film;
    use std::time::Duration;

    let (rest, pressed) = {
        let (layout, geometry) = (map(), Geometry::default());
        let drawn = |snapshot: &_| {
            let mut scene = Scene::new();
            let view = View { show: Show::PICTURE, ..View::new(&geometry, &layout, snapshot, &Theme::LIGHT) };
            draw(&mut scene, &view);
            scene
        };
        (drawn(&at_rest(&layout)), drawn(&pressing(&layout)))
    };
    let fonts = Fonts::built_in();
    let mut film = Film::new(Vec::new(), 300);
    // A moment of rest, drawn twice; then a foot, until the end.
    for (scene, at_ms) in [(&rest, 0), (&rest, 80), (&pressed, 1234), (&rest, 2000)] {
        film.add(scene, &fonts, Duration::from_millis(at_ms)).unwrap();
    }
    let bytes = film.finish(Duration::from_secs(3)).unwrap();
    let frames = frames(&bytes);
    let delays: Vec<u16> = frames.iter().map(|(_, delay)| *delay).collect();
    assert_eq!(delays, [123, 77, 100]);
    let [all, foot, lifted] = frames.iter().map(|(area, _)| *area).collect::<Vec<_>>()[..] else {
        panic!("{frames:?}");
    };
    assert_eq!((all[0], all[1], all[2]), (0, 0, 300));
    assert_eq!(foot, lifted);
    assert!(foot[3] < all[3] || foot[2] < all[2], "{foot:?} of {all:?}");
    let empty = Film::new(Vec::new(), 300).finish(Duration::ZERO);
    assert!(matches!(empty, Err(PictureError::Drawing(_))));
}
