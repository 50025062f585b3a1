//! Snow, gravel and sand, with hollows under former footsteps.

use glam::Vec2;

use super::super::Scene;
use super::super::mark::{Ink, Paint, Stroke};
use super::Land;
use underfoot::ground::Grain;

pub(super) fn draw(scene: &mut Scene, land: &Land<'_>, grain: Grain) {
    match grain {
        Grain::Snow => snow(scene, land),
        Grain::Gravel => gravel(scene, land),
        Grain::Sand => sand(scene, land),
    }
}

/// Soft drifts with blue shadows, and bright crystals.
fn snow(scene: &mut Scene, land: &Land<'_>) {
    land.paint(scene, |column, row| {
        let at = land.point(column, row);
        let drift = 0.5 * land.noise.hills(1, at, 0.45) + 0.2 * land.noise.hills(2, at, 0.13);
        let depth = land.depth(i64::from(column), i64::from(row));
        let shade = 0.10 - 0.10 * drift + 0.42 * depth - 0.75 * land.slope(column, row);
        let lit = (0.75 * land.slope(column, row)).clamp(0.0, 0.6);
        land.surface.mix(land.deep, shade.clamp(0.0, 0.85)).mix(land.white, lit)
    });
    let area = land.area();
    let size = area.size();
    for n in 0..((size.x * size.y * 70.0) as u32).min(260) {
        let at = area.min + size * land.noise.place(5, n);
        let radius = 0.0008 + 0.0014 * land.noise.at(6, n).powi(2);
        scene.add_circle(at, radius, Paint::fill(Ink::faint(land.white, 0.5 + 0.5 * land.noise.at(7, n))));
    }
}

/// Wind ripples, smooth where feet have trodden.
fn sand(scene: &mut Scene, land: &Land<'_>) {
    land.paint(scene, |column, row| {
        let at = land.point(column, row);
        let depth = land.depth(i64::from(column), i64::from(row));
        let shade =
            0.24 + 0.14 * land.noise.hills(2, at, 0.5) + 0.06 * land.noise.hills(3, at, 0.09) + 0.30 * depth;
        let slope = land.slope(column, row);
        land.surface
            .mix(land.deep, (shade - 0.7 * slope).clamp(0.0, 0.9))
            .mix(land.white, (0.5 * slope).clamp(0.0, 0.4))
    });
    ripples(scene, land);
    let area = land.area();
    let size = area.size();
    for n in 0..((size.x * size.y * 260.0) as u32).min(500) {
        let at = area.min + size * land.noise.place(5, n);
        let colour = if land.noise.at(6, n) < 0.5 { land.deep } else { land.white };
        scene.add_circle(at, 0.0009, Paint::fill(Ink::faint(colour, 0.35)));
    }
}

/// Crests of the wind ripples, lit from the north-west; none where feet have trodden.
fn ripples(scene: &mut Scene, land: &Land<'_>) {
    let area = land.area();
    let size = area.size();
    let crests = ((size.y / 0.034) as u32).min(120);
    let steps = ((size.x / 0.03) as u32).clamp(2, 120);
    let place = |crest: u32, step: u32| {
        let along = size.x * step as f32 / steps as f32;
        let line = (crest as f32 + 0.5) * size.y / crests.max(1) as f32;
        let at = area.min + Vec2::new(along, line);
        let bent = 0.030 * land.noise.hills(20, at, 0.34) + 0.008 * land.noise.hills(21, at, 0.11);
        Vec2::new(at.x, (at.y + bent).clamp(area.min.y, area.max.y))
    };
    let trodden = |at: Vec2| land.state.is_some_and(|state| state.relief.depth_at(at, land.now) > 0.22);
    for crest in 0..crests {
        for (aside, colour, opacity, width) in
            [(Vec2::new(0.002, -0.006), land.deep, 0.26, 0.0075), (Vec2::ZERO, land.white, 0.30, 0.0040)]
        {
            let paint = Paint::stroke(Stroke::new(width, Ink::faint(colour, opacity)));
            let mut step = 0;
            while step < steps {
                // Each crest has random gaps.
                let end = (step + 4 + (land.noise.at(22, crest * 64 + step) * 22.0) as u32).min(steps);
                let run = (step..=end).map(|step| place(crest, step)).take_while(|at| !trodden(*at));
                scene.add_path(run.map(|at| (at + aside).clamp(area.min, area.max)), false, paint);
                step = end + 1 + u32::from(land.noise.at(23, crest * 64 + step) < 0.4);
            }
        }
    }
}

/// Maximum number of stones drawn one by one.
const MOST_STONES: u32 = 800;

/// Stones of many greys, each with its shadow.
fn gravel(scene: &mut Scene, land: &Land<'_>) {
    let area = land.area();
    land.paint(scene, |column, row| {
        let at = land.point(column, row);
        let depth = land.depth(i64::from(column), i64::from(row));
        let shade =
            0.62 + 0.20 * land.noise.hills(1, at, 0.12) + 0.25 * depth - 0.6 * land.slope(column, row);
        land.surface.mix(land.deep, shade.clamp(0.0, 1.0))
    });
    // A regular grid with every stone displaced at random, so that stones do not overlap or form rows.
    let size = area.size();
    let spacing = (size.x * size.y / MOST_STONES as f32).sqrt().max(0.024);
    let (columns, rows) = ((size.x / spacing) as u32, (size.y / spacing) as u32);
    for n in 0..columns * rows {
        let jitter = Vec2::new(land.noise.signed(3, n), land.noise.signed(4, n)) * 0.34 * spacing;
        let at = area.min + (Vec2::new((n % columns) as f32, (n / columns) as f32) + 0.5) * spacing + jitter;
        let radius = spacing * (0.34 + 0.22 * land.noise.at(5, n));
        let radii = Vec2::new(radius, radius * (0.62 + 0.38 * land.noise.at(6, n)));
        if at != at.clamp(area.min + radius, area.max - radius) {
            continue;
        }
        let grey = land
            .surface
            .mix(land.deep, 0.55 * land.noise.at(7, n))
            .mix(land.white, 0.25 * land.noise.at(8, n));
        let shadow = Ink::faint(land.deep.mix(super::BLACK, 0.4), 0.55);
        scene.add_ellipse(at + Vec2::new(0.12, -0.16) * radius, radii, Paint::fill(shadow));
        scene.add_ellipse(at, radii, Paint::fill(Ink::solid(grey)));
        let shine = Ink::faint(land.white, 0.28);
        scene.add_ellipse(at + Vec2::new(-0.22, 0.24) * radius, radii * 0.42, Paint::fill(shine));
    }
}
