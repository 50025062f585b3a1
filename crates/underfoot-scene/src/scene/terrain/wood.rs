//! Planks with their grain, and nails at their ends.

use glam::Vec2;

use super::super::Scene;
use super::super::mark::{Ink, Paint, Stroke};
use super::Land;
use underfoot::floor::Rect;
use underfoot::ground::WoodSpec;
use underfoot::widget::Axis;

/// Maximum number of planks drawn one by one.
const MOST: u32 = 120;

pub(super) fn draw(scene: &mut Scene, land: &Land<'_>, spec: &WoodSpec) {
    let (area, noise) = (land.area(), land.noise);
    let size = area.size();
    let is_east = spec.along == Axis::East;
    let (long, wide) = if is_east { (size.x, size.y) } else { (size.y, size.x) };
    // Along the plank and across it.
    let place = |along: f32, across: f32| {
        area.min + if is_east { Vec2::new(along, across) } else { Vec2::new(across, along) }
    };
    scene.add_box(area, 0.0, Paint::fill(Ink::solid(land.deep)));
    let planks = ((wide / spec.plank_m).ceil() as u32).clamp(1, MOST);
    let each = wide / planks as f32;
    for plank in 0..planks {
        let across = plank as f32 * each;
        // Butt joints, at different places on adjacent planks.
        let joint = long * (0.22 + 0.56 * noise.at(1, plank));
        for (part, (from, to)) in [(0.0, joint), (joint, long)].into_iter().enumerate() {
            let n = 2 * plank + part as u32;
            let board =
                Rect::new(place(from, across).min(place(to, across + each)), place(to, across + each));
            let board = board.grown(-0.0013);
            let tone =
                land.surface.mix(land.deep, 0.22 * noise.at(2, n)).mix(land.white, 0.10 * noise.at(3, n));
            scene.add_box(board, 0.002, Paint::fill(Ink::solid(tone)));
            grain(scene, land, n, (from, to), (across, each), place);
            let light = Stroke::new(0.0012, Ink::faint(land.white, 0.20));
            let edge = across + each - 0.0022;
            scene.add_line(place(from + 0.003, edge), place(to - 0.003, edge), Paint::stroke(light));
            for along in [from + 0.016, to - 0.016] {
                for side in [0.22, 0.78] {
                    let nail = place(along, across + side * each);
                    scene.add_circle(nail, 0.0026, Paint::fill(Ink::faint(land.line, 0.8)));
                    scene.add_circle(
                        nail + Vec2::new(-0.0006, 0.0007),
                        0.0010,
                        Paint::fill(Ink::faint(land.white, 0.4)),
                    );
                }
            }
        }
    }
}

/// The grain: nearly parallel wavy lines.
fn grain(
    scene: &mut Scene,
    land: &Land<'_>,
    board: u32,
    (from, to): (f32, f32),
    (across, each): (f32, f32),
    place: impl Fn(f32, f32) -> Vec2,
) {
    let noise = land.noise;
    let lines = ((each / 0.014) as u32).clamp(2, 14);
    for line in 0..lines {
        let middle =
            across + each * (line as f32 + 0.5 + 0.3 * noise.signed(6, board * 16 + line)) / lines as f32;
        let ink = Ink::faint(land.line, 0.14 + 0.16 * noise.at(7, board * 16 + line));
        let points = (0..=20).map(|step| {
            let along = from + 0.004 + (to - from - 0.008) * step as f32 / 20.0;
            let wave = noise.hills(8 + board, Vec2::new(along, middle * 0.6), 0.30);
            place(
                along,
                (middle + 0.20 * each * wave / lines as f32 * 3.0)
                    .clamp(across + 0.003, across + each - 0.003),
            )
        });
        scene.add_path(points, false, Paint::stroke(Stroke::new(0.0011, ink)));
    }
}
