//! Icons made of strokes, sharp at any size, on a projector as well as in a picture.

use glam::Vec2;

use super::Scene;
use super::mark::{Ink, Paint, Stroke};
use underfoot::layout::{Colour, Icon};

/// One stroke in a square from (-1, -1) in the south-west to (1, 1) in the north-east.
enum TextPiece {
    /// Open lines.
    Lines(&'static [(f32, f32)]),
    /// Closed lines.
    Loop(&'static [(f32, f32)]),
    /// Closed lines, filled.
    Solid(&'static [(f32, f32)]),
    /// A circle: centre and radius.
    Ring(f32, f32, f32),
    /// A filled circle.
    Dot(f32, f32, f32),
    /// Part of a circle: centre, radius, first and last angle in degrees, counted from east to north.
    Arc(f32, f32, f32, f32, f32),
}

use TextPiece::{Arc, Dot, Lines, Loop, Ring, Solid};

/// Width of strokes in a square with side 2.
const STROKE: f32 = 0.24;

/// Degrees between the points of an arc.
const ARC_STEP: f32 = 15.0;

/// Draws `icon` around `middle`, `side_m` wide and deep.
pub(super) fn draw(scene: &mut Scene, icon: Icon, middle: Vec2, side_m: f32, ink: Colour) {
    // Strokes extend half their width beyond their points.
    let scale = 0.5 * side_m / (1.0 + 0.5 * STROKE);
    let at = |&(x, y): &(f32, f32)| middle + Vec2::new(x, y) * scale;
    let line = Paint::stroke(Stroke::new(STROKE * scale, Ink::solid(ink)));
    let fill = Paint::fill(Ink::solid(ink));
    for piece in pieces(icon) {
        match *piece {
            Lines(points) => scene.add_path(points.iter().map(at), false, line),
            Loop(points) => scene.add_path(points.iter().map(at), true, line),
            Solid(points) => scene.add_path(points.iter().map(at), true, fill),
            Ring(x, y, radius) => scene.add_circle(at(&(x, y)), radius * scale, line),
            Dot(x, y, radius) => scene.add_circle(at(&(x, y)), radius * scale, fill),
            Arc(x, y, radius, from, to) => {
                let steps = ((to - from) / ARC_STEP).abs().ceil().max(1.0);
                let point = |step: u16| {
                    let angle = (from + (to - from) * f32::from(step) / steps).to_radians();
                    at(&(x, y)) + Vec2::from_angle(angle) * radius * scale
                };
                scene.add_path((0..=steps as u16).map(point), false, line);
            }
        }
    }
}

const fn pieces(icon: Icon) -> &'static [TextPiece] {
    match icon {
        Icon::Up => &[Lines(&[(0.0, -0.9), (0.0, 0.9)]), Lines(&[(-0.7, 0.2), (0.0, 0.9), (0.7, 0.2)])],
        Icon::Down => &[Lines(&[(0.0, 0.9), (0.0, -0.9)]), Lines(&[(-0.7, -0.2), (0.0, -0.9), (0.7, -0.2)])],
        Icon::Left => &[Lines(&[(0.9, 0.0), (-0.9, 0.0)]), Lines(&[(-0.2, 0.7), (-0.9, 0.0), (-0.2, -0.7)])],
        Icon::Right => &[Lines(&[(-0.9, 0.0), (0.9, 0.0)]), Lines(&[(0.2, 0.7), (0.9, 0.0), (0.2, -0.7)])],
        Icon::Home => &[
            Lines(&[(-1.0, 0.05), (0.0, 0.95), (1.0, 0.05)]),
            Lines(&[(-0.7, 0.2), (-0.7, -0.9), (0.7, -0.9), (0.7, 0.2)]),
            Lines(&[(0.0, -0.9), (0.0, -0.3)]),
        ],
        Icon::Back => &[
            Lines(&[(-0.3, 0.9), (-0.95, 0.35), (-0.3, -0.2)]),
            Lines(&[(-0.95, 0.35), (0.35, 0.35)]),
            Arc(0.35, -0.25, 0.6, 90.0, -90.0),
            Lines(&[(0.35, -0.85), (-0.3, -0.85)]),
        ],
        Icon::Plus => &[Lines(&[(-0.85, 0.0), (0.85, 0.0)]), Lines(&[(0.0, -0.85), (0.0, 0.85)])],
        Icon::Minus => &[Lines(&[(-0.85, 0.0), (0.85, 0.0)])],
        Icon::Check => &[Lines(&[(-0.9, 0.0), (-0.25, -0.7), (0.9, 0.7)])],
        Icon::Cross => &[Lines(&[(-0.75, -0.75), (0.75, 0.75)]), Lines(&[(-0.75, 0.75), (0.75, -0.75)])],
        Icon::Play => &[Solid(&[(-0.65, -0.95), (0.95, 0.0), (-0.65, 0.95)])],
        Icon::Pause => &[
            Solid(&[(-0.7, -0.9), (-0.2, -0.9), (-0.2, 0.9), (-0.7, 0.9)]),
            Solid(&[(0.2, -0.9), (0.7, -0.9), (0.7, 0.9), (0.2, 0.9)]),
        ],
        Icon::Stop => &[Solid(&[(-0.8, -0.8), (0.8, -0.8), (0.8, 0.8), (-0.8, 0.8)])],
        Icon::Power => &[Arc(0.0, -0.1, 0.85, 130.0, 410.0), Lines(&[(0.0, 0.0), (0.0, 1.0)])],
        Icon::Light => &[
            Arc(0.0, 0.3, 0.65, -60.0, 240.0),
            Lines(&[(-0.32, -0.26), (-0.32, -0.55), (0.32, -0.55), (0.32, -0.26)]),
            Lines(&[(-0.2, -0.9), (0.2, -0.9)]),
        ],
        Icon::Lock => &[
            Solid(&[(-0.8, -0.95), (0.8, -0.95), (0.8, 0.1), (-0.8, 0.1)]),
            Lines(&[(-0.5, 0.1), (-0.5, 0.4)]),
            Arc(0.0, 0.4, 0.5, 180.0, 0.0),
            Lines(&[(0.5, 0.4), (0.5, 0.1)]),
        ],
        Icon::Camera => &[
            Loop(&[
                (-1.0, -0.7),
                (1.0, -0.7),
                (1.0, 0.5),
                (0.5, 0.5),
                (0.3, 0.8),
                (-0.3, 0.8),
                (-0.5, 0.5),
                (-1.0, 0.5),
            ]),
            Ring(0.0, -0.1, 0.38),
        ],
        Icon::Search => &[Ring(-0.2, 0.2, 0.65), Lines(&[(0.28, -0.28), (0.95, -0.95)])],
        Icon::Menu => &[
            Lines(&[(-0.9, 0.65), (0.9, 0.65)]),
            Lines(&[(-0.9, 0.0), (0.9, 0.0)]),
            Lines(&[(-0.9, -0.65), (0.9, -0.65)]),
        ],
        Icon::Bell => &[
            Lines(&[(-0.6, 0.2), (-0.6, -0.1), (-0.9, -0.55), (0.9, -0.55), (0.6, -0.1), (0.6, 0.2)]),
            Arc(0.0, 0.2, 0.6, 0.0, 180.0),
            Dot(0.0, -0.85, 0.17),
        ],
        Icon::Sound => &[
            Solid(&[
                (-0.95, -0.35),
                (-0.55, -0.35),
                (-0.05, -0.8),
                (-0.05, 0.8),
                (-0.55, 0.35),
                (-0.95, 0.35),
            ]),
            Arc(0.0, 0.0, 0.4, -45.0, 45.0),
            Arc(0.0, 0.0, 0.85, -45.0, 45.0),
        ],
        Icon::Help => &[
            Arc(0.0, 0.4, 0.55, 170.0, -60.0),
            Lines(&[(0.27, -0.08), (0.0, -0.3), (0.0, -0.45)]),
            Dot(0.0, -0.87, 0.15),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Mark;
    use underfoot::floor::Rect;

    #[test]
    fn every_icon_draws_something_of_its_own_within_its_square() {
        let square = Rect::from_centre_size(Vec2::new(2.0, 1.0), Vec2::splat(0.1));
        let mut drawn: Vec<Scene> = Vec::new();
        for (name, icon) in Icon::ALL {
            let mut scene = Scene::new();
            draw(&mut scene, icon, square.centre(), 0.1, Colour::rgb(0, 0, 0));
            assert!(!scene.marks().is_empty(), "{name}");
            for mark in scene.marks() {
                match mark {
                    Mark::Path { points, .. } => {
                        let inside = |point: &Vec2| square.contains(*point);
                        assert!(scene.points(*points).iter().all(inside), "{name}");
                    }
                    Mark::Ellipse { centre, radii, .. } => {
                        assert!(
                            square.contains(*centre - *radii) && square.contains(*centre + *radii),
                            "{name}"
                        );
                    }
                    other => panic!("{name}: {other:?}"),
                }
            }
            assert!(!drawn.contains(&scene), "{name} looks like another icon");
            drawn.push(scene);
        }
    }
}
