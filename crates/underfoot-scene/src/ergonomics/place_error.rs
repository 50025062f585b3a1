//! Position error of a foot, by its force and its distance from a seam.

use glam::Vec2;

use underfoot::floor::{Floor, Geometry, Rect};
use underfoot::units::Newtons;

/// Distance class of a point from the nearest edge of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Zone {
    /// Less than 3 cm from a seam.
    Seam,
    /// From 3 to 8 cm.
    Beside,
    /// More than 8 cm from a seam.
    Middle,
}

impl Zone {
    /// All zones, from the seam inwards.
    pub const ALL: [Self; 3] = [Self::Seam, Self::Beside, Self::Middle];

    /// Forces of the error measurements (N).
    pub const FORCES_N: [f32; 6] = [40.0, 60.0, 80.0, 120.0, 200.0, 400.0];

    /// Outer limits of the first and the second zone, in metres from the seam.
    const ENDS_M: [f32; 2] = [0.03, 0.08];

    /// Returns the zone of `point`, by its distance from the nearest edge of a tile.
    #[must_use]
    pub fn of(geometry: &Geometry, point: Vec2) -> Self {
        let pitch = geometry.pitch_m();
        let within = (point / pitch - (point / pitch).floor()) * pitch;
        let distance = within.min(pitch - within).min_element();
        match Self::ENDS_M.iter().position(|end| distance < *end) {
            Some(0) => Self::Seam,
            Some(_) => Self::Beside,
            None => Self::Middle,
        }
    }

    /// Returns the name for tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Seam => "up to 3 cm from seam",
            Self::Beside => "3 to 8 cm",
            Self::Middle => "8 cm and more",
        }
    }
}

/// Position error of standing feet, 95th percentile in centimetres, by zone and force, without position maps.
///
/// # Source
/// Measured on 60 simulated floors of the paper's parts, calibrated, with each sensor's zero off by half a newton,
/// tracked for a second: `underfoot experiment place --floors 60 --quality paper`.
const P95_CM: [[f32; 6]; 3] = [
    [1.42, 1.43, 1.46, 1.48, 1.58, 1.42],
    [1.61, 1.62, 1.60, 1.69, 1.77, 1.58],
    [1.77, 1.84, 1.90, 2.01, 2.03, 1.75],
];

/// The same, with position maps.
const MAPPED_P95_CM: [[f32; 6]; 3] = [
    [0.30, 0.21, 0.14, 0.11, 0.10, 0.10],
    [0.46, 0.28, 0.20, 0.14, 0.10, 0.15],
    [0.27, 0.20, 0.16, 0.11, 0.09, 0.18],
];

/// Returns the 95th percentile of the position error of feet that press in `area` with `force`, in metres, for the
/// zone under `area` with the largest error.
///
/// Forces between the measured ones are interpolated; forces outside use the nearest one. The errors with position
/// maps apply if `floor` has a map for every tile under `area`.
#[must_use]
pub fn predicted_error_m(floor: &Floor, area: Rect, force: Newtons) -> f32 {
    let geometry = &floor.geometry;
    let is_mapped = |tile| {
        geometry.index(tile).is_some_and(|index| matches!(floor.position_maps.get(index), Some(Some(_))))
    };
    let mapped = geometry.tiles().filter(|tile| geometry.plate(*tile).overlaps(area)).all(is_mapped);
    let table = if mapped { &MAPPED_P95_CM } else { &P95_CM };
    let worst =
        zones_under(geometry, area).map(|zone| at_force(&table[zone as usize], force)).fold(0.0, f32::max);
    worst / 100.0
}

/// Zones that overlap `area`.
fn zones_under(geometry: &Geometry, area: Rect) -> impl Iterator<Item = Zone> {
    // Grid spacing (m), half the width of the narrowest zone.
    const GRID_M: f32 = 0.015;
    let size = area.size();
    let steps = (size / GRID_M).ceil().clamp(Vec2::ONE, Vec2::splat(64.0));
    let share = move |step: u16, steps: f32| f32::from(step) / steps;
    let geometry = *geometry;
    let mut seen = [false; 3];
    for row in 0..=steps.y as u16 {
        for column in 0..=steps.x as u16 {
            let at = area.min + size * Vec2::new(share(column, steps.x), share(row, steps.y));
            seen[Zone::of(&geometry, at) as usize] = true;
        }
        if seen == [true; 3] {
            break;
        }
    }
    Zone::ALL.into_iter().filter(move |zone| seen[*zone as usize])
}

/// Value of the row at `force`, by linear interpolation.
fn at_force(row: &[f32; 6], force: Newtons) -> f32 {
    let forces = Zone::FORCES_N;
    let above = forces.iter().position(|measured| force.0 < *measured);
    match above {
        Some(0) => row[0],
        Some(above) => {
            let share = (force.0 - forces[above - 1]) / (forces[above] - forces[above - 1]);
            row[above - 1] + (row[above] - row[above - 1]) * share
        }
        None => row[row.len() - 1],
    }
}
