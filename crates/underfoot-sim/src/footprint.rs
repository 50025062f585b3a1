//! Distribution of the force of a foot or an object over the floor.
//!
//! A print is a set of weighted cells in the frame of the foot or object: origin in its centre, x to its right, y
//! towards its toes, metres.

use std::sync::LazyLock;

use glam::Vec2;

/// One cell of a print.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintCell {
    /// Centre of the cell, in the print's frame.
    pub at: Vec2,
    /// Width (x) and length (y) in metres; zero for a point.
    pub size: Vec2,
    /// Share of the force, not negative; all shares of a print sum to 1.
    pub share: f32,
}

/// Shape of a contact area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Print {
    /// The sole of a shoe.
    Shoe {
        /// Length of the bare foot, in metres; people's feet have 0.22 to 0.30.
        length_m: f32,
        /// Position of the load along the foot, from the heel (0) to the toes (1).
        roll: f32,
    },
    /// A foot with a given centre and spread of pressure, modelled as two ellipses: heel and forefoot.
    Sole {
        /// Centre of pressure, in the print's frame.
        centre: Vec2,
        /// Root mean square radii of the pressure across (x) and along (y) the foot, in metres, positive.
        radii: Vec2,
        /// Length of the foot or shoe, in metres: the heel presses about 0.33 of it behind the centre, the forefoot
        /// 0.22 in front of it.
        length_m: f32,
        /// Maximum half width and half length of the heel's contact area, in metres; infinite for a bare or flat
        /// heel. A small heel makes the spread a little less than `radii`.
        heel_m: f32,
    },
    /// A single point.
    Point,
    /// A disc with uniform pressure.
    Disc {
        /// Radius, in metres.
        radius_m: f32,
    },
    /// An ellipse with uniform pressure.
    Ellipse {
        /// Half of the width (x) and of the length (y), in metres.
        half_m: Vec2,
    },
    /// A bar or rectangle with uniform pressure.
    Bar {
        /// Half of the width (x) and of the length (y), in metres.
        half_m: Vec2,
    },
}

impl Print {
    /// Calls `visit` with each loaded cell, from heel to toe.
    #[inline]
    pub fn for_each_cell(&self, mut visit: impl FnMut(PrintCell)) {
        match *self {
            Self::Shoe { length_m, roll } => {
                let (size, zones) = (shoe_size(length_m), zone_shares(roll));
                let cell = size * SOLE.cell;
                for (at, pressure) in &SOLE.cells {
                    let share = pressure.iter().zip(zones).map(|(cell, zone)| cell * zone).sum();
                    if share > 0.0 {
                        visit(PrintCell { at: *at * size, size: cell, share });
                    }
                }
            }
            Self::Sole { centre, radii, length_m, heel_m } => {
                for patch in patches(centre, radii, length_m, heel_m) {
                    if patch.share > 0.0 {
                        let share = patch.share / DISC.len() as f32;
                        let size = patch.half_m * (2.0 / DISC_CELLS as f32);
                        for at in DISC.iter() {
                            visit(PrintCell { at: patch.at + *at * patch.half_m, size, share });
                        }
                    }
                }
            }
            Self::Point => visit(PrintCell { at: Vec2::ZERO, size: Vec2::ZERO, share: 1.0 }),
            Self::Disc { radius_m } => even_cells(Vec2::splat(radius_m), true, visit),
            Self::Ellipse { half_m } => even_cells(half_m, true, visit),
            Self::Bar { half_m } => even_cells(half_m, false, visit),
        }
    }

    /// Returns the centre of pressure, in the print's frame.
    #[must_use]
    pub fn centre_of_pressure(&self) -> Vec2 {
        match *self {
            Self::Shoe { length_m, roll } => {
                let along: Vec2 =
                    SOLE.centres.iter().zip(zone_shares(roll)).map(|(centre, share)| *centre * share).sum();
                along * shoe_size(length_m)
            }
            Self::Sole { centre, .. } => centre,
            Self::Point | Self::Disc { .. } | Self::Ellipse { .. } | Self::Bar { .. } => Vec2::ZERO,
        }
    }

    /// Returns half of the print's width (x) and length (y), in metres: no cell extends further.
    #[must_use]
    pub fn half_size(&self) -> Vec2 {
        match *self {
            Self::Shoe { length_m, .. } => shoe_size(length_m) * 0.5,
            Self::Sole { centre, radii, length_m, heel_m } => patches(centre, radii, length_m, heel_m)
                .iter()
                .filter(|patch| patch.share > 0.0)
                .fold(Vec2::ZERO, |half, patch| half.max(patch.at.abs() + patch.half_m)),
            Self::Point => Vec2::ZERO,
            Self::Disc { radius_m } => Vec2::splat(radius_m),
            Self::Ellipse { half_m } | Self::Bar { half_m } => half_m,
        }
    }

    /// Returns the variance of the pressure about its centre, across (x) and along (y), in square metres.
    #[must_use]
    pub fn variance(&self) -> Vec2 {
        match *self {
            Self::Shoe { length_m, roll } => {
                let size = shoe_size(length_m);
                let squares: Vec2 =
                    SOLE.squares.iter().zip(zone_shares(roll)).map(|(square, share)| *square * share).sum();
                let centre = self.centre_of_pressure();
                (squares * size * size - centre * centre).max(Vec2::ZERO)
            }
            Self::Sole { radii, .. } => radii * radii,
            Self::Point => Vec2::ZERO,
            Self::Disc { radius_m } => Vec2::splat(0.25 * radius_m * radius_m),
            Self::Ellipse { half_m } => 0.25 * half_m * half_m,
            Self::Bar { half_m } => half_m * half_m / 3.0,
        }
    }
}

/// An ellipse that carries a share of a sole's force with uniform pressure.
#[derive(Clone, Copy, Debug)]
struct Patch {
    share: f32,
    at: Vec2,
    half_m: Vec2,
}

/// Cells across and along a patch: about a centimetre each.
const DISC_CELLS: usize = 8;

/// Centres of the cells that fill a circle of radius 1.
static DISC: LazyLock<Vec<Vec2>> = LazyLock::new(|| {
    let mut cells = Vec::new();
    even_cells(Vec2::ONE / 25.0, true, |cell| cells.push(cell.at * 25.0));
    cells
});

/// Positions of heel and forefoot, in foot lengths from the centre.
const HEEL_AT: f32 = -0.33;
const FOREFOOT_AT: f32 = 0.22;

/// Root mean square radius of heel or forefoot alone along the foot, in foot lengths.
///
/// # Source
/// Recorded steps (see `rolling_fit`): 0.06 on the heel just after landing, 0.08 on the ball.
const PATCH_RADIUS: f32 = 0.06;

/// Heel and forefoot with this common centre of pressure and these common radii.
///
/// The distance between the two is as large as the radius along the foot allows: under a foot with load on both, it
/// makes most of the spread.
fn patches(centre: Vec2, radii: Vec2, length_m: f32, heel_m: f32) -> [Patch; 2] {
    let (behind, before) = (centre.y - HEEL_AT * length_m, FOREFOOT_AT * length_m - centre.y);
    let apart = behind * before;
    let least = (PATCH_RADIUS * length_m).min(radii.y);
    let stretch = if behind > 0.0 && before > 0.0 && apart > 1e-9 {
        ((radii.y * radii.y - least * least) / apart).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let own = (radii.y * radii.y - stretch * apart.max(0.0)).max(0.0).sqrt();
    let half_m = 2.0 * Vec2::new(radii.x, own);
    if stretch <= 0.0 {
        // All load is on one of the two.
        let half_m = if behind < before { half_m.min(Vec2::splat(heel_m)) } else { half_m };
        return [Patch { share: 1.0, at: centre, half_m }, Patch { share: 0.0, at: centre, half_m }];
    }
    let reach = stretch.sqrt();
    [
        Patch {
            share: before / (behind + before),
            at: centre - Vec2::new(0.0, reach * behind),
            half_m: half_m.min(Vec2::splat(heel_m)),
        },
        Patch { share: behind / (behind + before), at: centre + Vec2::new(0.0, reach * before), half_m },
    ]
}

/// Returns the width and length of the shoe on a foot of `length_m`, in metres.
///
/// # Source
/// Breadth about 0.38 of the length (11 cm for 29 cm, the 95th percentile); a
/// shoe adds 1 cm each way.
#[must_use]
pub fn shoe_size(length_m: f32) -> Vec2 {
    Vec2::new(0.38 * length_m, length_m) + 0.01
}

/// Shares of heel, waist, ball and toes in the force during the roll; each row sums to 1. Chosen so that the centre
/// of pressure moves steadily over 0.2 m, as force plates measure it.
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

/// Positions of the four zones, as shares of the shoe's length from its heel end: begin, peak, end.
const ZONES: [[f32; 3]; 4] = [[0.0, 0.13, 0.30], [0.20, 0.42, 0.62], [0.50, 0.70, 0.86], [0.78, 0.89, 1.0]];

/// Half the sole's width as a share of its maximum half width, along its length from the heel end.
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

/// A sole of length and width 1; scaling gives the soles of all shoes.
struct Sole {
    /// Width and length of a cell.
    cell: Vec2,
    /// Centre of each cell, and its share of the force on each zone.
    cells: Vec<(Vec2, [f32; 4])>,
    /// Centre of pressure of each zone alone.
    centres: [Vec2; 4],
    /// Mean square of the cell positions in each zone.
    squares: [Vec2; 4],
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
                // The pressure decreases towards the rim, where the sole bends up.
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
    let squares = std::array::from_fn(|zone| cells.iter().map(|(at, p)| *at * *at * p[zone]).sum());
    Sole { cell, cells, centres, squares }
});

fn outline(along: f32) -> f32 {
    OUTLINE.windows(2).find(|pair| along <= pair[1].0).map_or(0.0, |pair| {
        pair[0].1 + (pair[1].1 - pair[0].1) * (along - pair[0].0) / (pair[1].0 - pair[0].0)
    })
}

/// A raised-cosine bump from `begin` over `peak` to `end`, zero outside.
fn bump(along: f32, [begin, peak, end]: [f32; 3]) -> f32 {
    let to_foot = if along < peak { peak - begin } else { end - peak };
    let away = (along - peak).abs() / to_foot;
    if away < 1.0 { 0.5 + 0.5 * (std::f32::consts::PI * away).cos() } else { 0.0 }
}

/// Uniform pressure on an ellipse or rectangle, in at most 40 x 40 cells of at most about a centimetre.
fn even_cells(half: Vec2, round: bool, mut visit: impl FnMut(PrintCell)) {
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
            visit(PrintCell { at, size, share: 1.0 / total as f32 });
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
        prints.extend([(-0.11, 0.012), (-0.05, 0.06), (0.0, 0.07), (0.06, 0.022), (0.12, 0.006)].map(
            |(along, radius)| Print::Sole {
                centre: Vec2::new(0.008, along),
                radii: Vec2::new(0.018, radius),
                length_m: 0.27,
                heel_m: f32::INFINITY,
            },
        ));
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
    fn the_variance_is_that_of_the_cells() {
        for print in all_prints() {
            let mut squares = Vec2::ZERO;
            print.for_each_cell(|cell| {
                let away = cell.at - print.centre_of_pressure();
                squares += (away * away + cell.size * cell.size / 12.0) * cell.share;
            });
            // The cells of an ellipse are up to an eighth of its width.
            let (found, told) = (squares, print.variance());
            assert!(
                found.abs_diff_eq(told, 0.06 * told.max_element() + 2e-5),
                "{print:?}: {found} for {told}"
            );
        }
    }

    #[test]
    fn a_standing_sole_presses_with_heel_and_forefoot_and_hardly_between() {
        let sole = |heel_m| Print::Sole {
            centre: Vec2::ZERO,
            radii: Vec2::new(0.018, 0.07),
            length_m: 0.27,
            heel_m,
        };
        let share = |print: &Print, from: f32, to: f32| {
            let mut sum = 0.0;
            print.for_each_cell(|cell| sum += if (from..to).contains(&cell.at.y) { cell.share } else { 0.0 });
            sum
        };
        let flat = sole(f32::INFINITY);
        assert!(share(&flat, -0.2, -0.05) > 0.3 && share(&flat, 0.02, 0.2) > 0.5);
        assert!(share(&flat, -0.045, 0.01) < 0.1, "{}", share(&flat, -0.045, 0.01));
        // A thin heel presses with the same force on a smaller area.
        let thin = sole(0.01);
        assert!((share(&thin, -0.1, -0.07) - share(&flat, -0.2, -0.01)).abs() < 0.05);
    }

    #[test]
    fn load_rolls_steadily_from_heel_to_toe() {
        let centres: Vec<f32> = (0..=50).map(|k| shoe(k as f32 / 50.0).centre_of_pressure().y).collect();
        assert!(centres.windows(2).all(|pair| pair[1] > pair[0]));
        // On force plates the centre of pressure moves 0.13 to 0.27 m along a shoe.
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
