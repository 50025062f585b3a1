//! How a foot or an object spreads its force over the floor it stands on.
//!
//! A print is a set of weighted cells in the frame of the thing that presses:
//! origin in its middle, x to its right, y towards its toes, metres.

use std::sync::LazyLock;

use glam::Vec2;

/// One cell of a print.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Its middle, in the print's frame.
    pub at: Vec2,
    /// Its width (x) and length (y), in metres; zero for a point.
    pub size: Vec2,
    /// Its share of the force, not negative; all shares of a print add up to 1.
    pub share: f32,
}

/// The shape of what presses on the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Print {
    /// The sole of a shoe.
    Shoe {
        /// Length of the bare foot, in metres; people's are 0.22 to 0.30.
        length_m: f32,
        /// How far the load has rolled from the heel (0) to the toes (1).
        roll: f32,
    },
    /// A single point.
    Point,
    /// A disc pressing evenly.
    Disc {
        /// Its radius, in metres.
        radius_m: f32,
    },
    /// An ellipse pressing evenly.
    Ellipse {
        /// Half of its width (x) and of its length (y), in metres.
        half_m: Vec2,
    },
    /// A bar or rectangle pressing evenly.
    Bar {
        /// Half of its width (x) and of its length (y), in metres.
        half_m: Vec2,
    },
}

impl Print {
    /// Calls `visit` with each loaded cell, from heel to toe.
    #[inline]
    pub fn for_each_cell(&self, mut visit: impl FnMut(Cell)) {
        match *self {
            Self::Shoe { length_m, roll } => {
                let (size, zones) = (shoe_size(length_m), zone_shares(roll));
                let cell = size * SOLE.cell;
                for (at, pressure) in &SOLE.cells {
                    let share = pressure.iter().zip(zones).map(|(cell, zone)| cell * zone).sum();
                    if share > 0.0 {
                        visit(Cell { at: *at * size, size: cell, share });
                    }
                }
            }
            Self::Point => visit(Cell { at: Vec2::ZERO, size: Vec2::ZERO, share: 1.0 }),
            Self::Disc { radius_m } => even_cells(Vec2::splat(radius_m), true, visit),
            Self::Ellipse { half_m } => even_cells(half_m, true, visit),
            Self::Bar { half_m } => even_cells(half_m, false, visit),
        }
    }

    /// Where the whole force acts, in the print's frame.
    #[must_use]
    pub fn centre_of_pressure(&self) -> Vec2 {
        match *self {
            Self::Shoe { length_m, roll } => {
                let along: Vec2 =
                    SOLE.centres.iter().zip(zone_shares(roll)).map(|(centre, share)| *centre * share).sum();
                along * shoe_size(length_m)
            }
            Self::Point | Self::Disc { .. } | Self::Ellipse { .. } | Self::Bar { .. } => Vec2::ZERO,
        }
    }

    /// Half of the print's width (x) and length (y), in metres: no cell reaches further.
    #[must_use]
    pub fn half_size(&self) -> Vec2 {
        match *self {
            Self::Shoe { length_m, .. } => shoe_size(length_m) * 0.5,
            Self::Point => Vec2::ZERO,
            Self::Disc { radius_m } => Vec2::splat(radius_m),
            Self::Ellipse { half_m } | Self::Bar { half_m } => half_m,
        }
    }
}

/// Width and length of the shoe on a foot `length_m` long, in metres.
///
/// # Source
/// Breadth about 0.38 of the length (11 cm for 29 cm, the 95th percentile); a
/// shoe adds 1 cm each way.
#[must_use]
pub fn shoe_size(length_m: f32) -> Vec2 {
    Vec2::new(0.38 * length_m, length_m) + 0.01
}

/// Shares of heel, waist, ball and toes in the force while the foot rolls, each
/// row summing to 1 (chosen so that the centre of pressure runs steadily over
/// 0.2 m, as force plates see it).
const ROLLING: [(f32, [f32; 4]); 6] = [
    (0.00, [1.00, 0.00, 0.00, 0.00]),
    (0.15, [0.75, 0.15, 0.10, 0.00]),
    (0.35, [0.45, 0.15, 0.35, 0.05]),
    (0.55, [0.15, 0.12, 0.58, 0.15]),
    (0.75, [0.00, 0.03, 0.70, 0.27]),
    (1.00, [0.00, 0.00, 0.35, 0.65]),
];

fn zone_shares(roll: f32) -> [f32; 4] {
    let roll = if roll.is_nan() { 0.0 } else { roll.clamp(0.0, 1.0) };
    let mut shares = ROLLING[0].1;
    for pair in ROLLING.windows(2) {
        let [(from, start), (to, end)] = [pair[0], pair[1]];
        if roll > from {
            let part = ((roll - from) / (to - from)).min(1.0);
            for zone in 0..4 {
                shares[zone] = start[zone] + (end[zone] - start[zone]) * part;
            }
        }
    }
    shares
}

/// Where the four zones lie, as shares of the shoe's length from its heel end: begin, peak, end.
const ZONES: [[f32; 3]; 4] = [[0.0, 0.13, 0.30], [0.20, 0.42, 0.62], [0.50, 0.70, 0.86], [0.78, 0.89, 1.0]];

/// Half the sole's width as a share of its greatest half width, along its length from the heel end.
const OUTLINE: [(f32, f32); 10] = [
    (0.00, 0.30),
    (0.05, 0.60),
    (0.15, 0.74),
    (0.30, 0.68),
    (0.45, 0.64),
    (0.60, 0.90),
    (0.70, 1.00),
    (0.82, 0.94),
    (0.93, 0.70),
    (1.00, 0.30),
];

/// A sole of length and width 1, from which those of all shoes are scaled.
struct Sole {
    /// Width and length of a cell.
    cell: Vec2,
    /// Each cell's middle and its share of the force on each zone.
    cells: Vec<(Vec2, [f32; 4])>,
    /// Centre of pressure of each zone alone.
    centres: [Vec2; 4],
}

/// Cells across and along the sole: about a centimetre each.
const CELLS_ACROSS: usize = 12;
const CELLS_ALONG: usize = 28;

static SOLE: LazyLock<Sole> = LazyLock::new(|| {
    let cell = Vec2::new(1.0 / CELLS_ACROSS as f32, 1.0 / CELLS_ALONG as f32);
    let mut cells = Vec::new();
    for row in 0..CELLS_ALONG {
        let along = (row as f32 + 0.5) * cell.y;
        let half_width = 0.5 * outline(along);
        for column in 0..CELLS_ACROSS {
            let across = (column as f32 + 0.5) * cell.x - 0.5;
            let rim = across.abs() / half_width;
            if rim < 1.0 {
                // Pressure falls off towards the rim, where the sole bends away.
                let dome = 1.0 - 0.6 * rim * rim;
                cells.push((Vec2::new(across, along - 0.5), ZONES.map(|zone| dome * bump(along, zone))));
            }
        }
    }
    let totals: [f32; 4] = std::array::from_fn(|zone| cells.iter().map(|(_, p)| p[zone]).sum());
    for (_, pressure) in &mut cells {
        for (share, total) in pressure.iter_mut().zip(totals) {
            *share /= total;
        }
    }
    let centres = std::array::from_fn(|zone| cells.iter().map(|(at, p)| *at * p[zone]).sum());
    Sole { cell, cells, centres }
});

fn outline(along: f32) -> f32 {
    OUTLINE.windows(2).find(|pair| along <= pair[1].0).map_or(0.0, |pair| {
        pair[0].1 + (pair[1].1 - pair[0].1) * (along - pair[0].0) / (pair[1].0 - pair[0].0)
    })
}

/// A smooth hill from `begin` over `peak` to `end`, zero outside.
fn bump(along: f32, [begin, peak, end]: [f32; 3]) -> f32 {
    let to_foot = if along < peak { peak - begin } else { end - peak };
    let away = (along - peak).abs() / to_foot;
    if away < 1.0 { 0.5 + 0.5 * (std::f32::consts::PI * away).cos() } else { 0.0 }
}

/// Even pressure on an ellipse or rectangle, in at most 40 x 40 cells of at most about a centimetre.
fn even_cells(half: Vec2, round: bool, mut visit: impl FnMut(Cell)) {
    let half = half.max(Vec2::ZERO);
    let count = (half * 200.0).ceil().clamp(Vec2::splat(8.0), Vec2::splat(40.0));
    let size = 2.0 * half / count;
    let (columns, rows) = (count.x as usize, count.y as usize);
    let inside = |column: usize, row: usize| {
        let at = (Vec2::new(column as f32, row as f32) + 0.5) / count * 2.0 - 1.0;
        (!round || at.length_squared() <= 1.0).then_some(at * half)
    };
    let places = || (0..rows).flat_map(move |row| (0..columns).map(move |column| (column, row)));
    let total = places().filter(|&(column, row)| inside(column, row).is_some()).count();
    for (column, row) in places() {
        if let Some(at) = inside(column, row) {
            visit(Cell { at, size, share: 1.0 / total as f32 });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shoe(roll: f32) -> Print {
        Print::Shoe { length_m: 0.27, roll }
    }

    fn all_prints() -> Vec<Print> {
        let half_m = Vec2::new(0.02, 0.09);
        let mut prints = vec![
            Print::Point,
            Print::Disc { radius_m: 0.05 },
            Print::Ellipse { half_m },
            Print::Bar { half_m },
        ];
        prints.extend((0..=20).map(|step| shoe(step as f32 / 20.0)));
        prints
    }

    #[test]
    fn shares_add_up_to_one_and_balance_at_the_centre_of_pressure() {
        for print in all_prints() {
            let (mut total, mut moment) = (0.0, Vec2::ZERO);
            print.for_each_cell(|cell| {
                assert!(cell.share >= 0.0);
                assert!((cell.at.abs() - print.half_size()).max_element() < 1e-4, "{print:?}: {cell:?}");
                total += cell.share;
                moment += cell.at * cell.share;
            });
            assert!((total - 1.0).abs() < 1e-4, "{print:?}: {total}");
            let off = moment.distance(print.centre_of_pressure());
            assert!(off < 1e-5, "{print:?}: {off}");
        }
    }

    #[test]
    fn load_rolls_steadily_from_heel_to_toe() {
        let centres: Vec<f32> = (0..=50).map(|k| shoe(k as f32 / 50.0).centre_of_pressure().y).collect();
        assert!(centres.windows(2).all(|pair| pair[1] > pair[0]));
        // Force plates see the centre of pressure run 0.13 to 0.27 m along a shoe.
        let run = centres[50] - centres[0];
        assert!((0.15..0.24).contains(&run), "{run}");
    }

    #[test]
    fn only_the_heel_is_loaded_first_and_only_the_forefoot_last() {
        let (mut front, mut back) = (f32::MIN, f32::MAX);
        shoe(0.0).for_each_cell(|cell| front = front.max(cell.at.y));
        shoe(1.0).for_each_cell(|cell| back = back.min(cell.at.y));
        assert!(front < -0.04, "heel strike reaches {front}");
        assert!(back > -0.01, "toe-off reaches back to {back}");
    }

    #[test]
    fn a_shoe_of_a_27_cm_foot_is_28_by_11_cm_in_centimetre_cells() {
        let size = shoe_size(0.27);
        assert!((size.y - 0.28).abs() < 1e-6 && (size.x - 0.1126).abs() < 1e-4, "{size}");
        let mut cells = 0;
        shoe(0.4).for_each_cell(|cell| {
            cells += 1;
            assert!(cell.size.max_element() < 0.0101);
        });
        assert!((200..300).contains(&cells), "{cells}");
    }

    #[test]
    fn a_roll_that_is_no_share_is_clamped() {
        assert_eq!(shoe(-1.0).centre_of_pressure(), shoe(0.0).centre_of_pressure());
        assert_eq!(shoe(7.0).centre_of_pressure(), shoe(1.0).centre_of_pressure());
        assert!(shoe(f32::NAN).centre_of_pressure().is_finite());
    }
}
