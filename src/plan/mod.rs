//! How many computers a floor takes: from its size, its crowd and what one machine does, which [`measure`] finds out.
//!
//! A floor too large for one computer is cut into areas ([`crate::floor::Area`]). Each computer receives the packets of
//! its area and of 1.2 m around it, assembles and senses those tiles, and moves its own. What that costs is linear in
//! packets, tiles, people and channels, with the [`Machine`]'s constants, but for wake-ups, which cost no more than the
//! time in which a thread would sleep; the fewest areas that stay within a share of every resource are the plan. What the
//! calculation takes for granted is said in [`Plan::assumptions`].

mod area_demand;
mod assumptions;
mod cores;
mod datagram;
mod limit;
mod listener;
mod machine;
mod measure;
mod round;
mod split;
mod whole;
mod work_time;

use serde::Serialize;
use thiserror::Error;

use crate::floor::Floor;
use crate::wire::SensorFormat;

pub use self::area_demand::AreaDemand;
pub use self::limit::{Limit, Resource};
pub use self::machine::{Machine, MachineError};
pub use self::measure::{LOADS, measure};
pub use self::split::Split;
pub use self::whole::Total;

use self::limit::{first, limits};
use self::split::fewest;

/// Most tiles along a side that a plan is made for: three hundred metres of the paper's tiles, four times over.
pub const MOST_SIDE: u32 = 4096;

/// Most people that a plan is made for.
pub const MOST_PEOPLE: u32 = 10_000_000;

/// A floor by its size alone: the paper's tiles, boards of eight tiles of a row, an actuator under each tile or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Tiles from west to east, 1 to [`MOST_SIDE`].
    pub columns: u32,
    /// Tiles from south to north, 1 to [`MOST_SIDE`].
    pub rows: u32,
    /// Whether there is an actuator under each tile.
    pub actuators: bool,
}

/// Who is on the floor, and how its boards write.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crowd {
    /// How many people are on the whole floor, at most [`MOST_PEOPLE`].
    pub people: u32,
    /// How many times denser than on the whole floor people stand in the fullest area, 1 to 1000.
    pub crowding: f64,
    /// How the boards write their readings.
    pub format: SensorFormat,
    /// Which share of each resource may be used, above 0 and at most 1; the rest is headroom.
    pub usable: f64,
}

impl Crowd {
    /// So many people, twice as dense where they are densest, boards that send counts, half of everything kept free.
    #[must_use]
    pub const fn of(people: u32) -> Self {
        Self { people, crowding: 2.0, format: SensorFormat::Counts, usable: 0.5 }
    }
}

/// What a floor and a crowd take.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// Tiles from west to east.
    pub columns: u32,
    /// Tiles from south to north.
    pub rows: u32,
    /// People on the floor.
    pub people: u32,
    /// What the plan was made with.
    pub machine: Machine,
    /// Which share of each resource may be used.
    pub usable: f64,
    /// How the floor is cut; `None` where its file names the areas.
    pub split: Option<Split>,
    /// The area that uses most of a resource.
    pub fullest: AreaDemand,
    /// What that area uses of each resource of its computer, the one used most first.
    pub limits: Vec<Limit>,
    /// All areas together.
    pub total: Total,
    /// What runs out on the whole floor however many computers there are, the one used most first.
    pub whole: Vec<Limit>,
    /// What runs out first: a resource of the whole floor if more of it is needed than there is, else the one that the
    /// fullest area's computer uses most.
    pub first_limit: Resource,
    /// Whether each area's computer, and the whole, stay within their limits.
    pub fits: bool,
    /// What the calculation takes for granted.
    pub assumptions: Vec<String>,
}

/// Why no plan can be made.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PlanError {
    /// The machine's constants are not usable.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// A size, a number of people or a share is out of its range.
    #[error("{what} must be {expected}")]
    Range {
        /// What is.
        what: &'static str,
        /// Its range.
        expected: &'static str,
    },
    /// One tile with what is sensed around it is too much for one computer.
    #[error("even an area of one tile takes more than one computer gives: {what}")]
    TooMuch {
        /// Which resource runs out.
        what: &'static str,
    },
}

/// Plans a floor of which only the size is known: the fewest areas that fit, near-square and of nearly equal sizes.
///
/// # Errors
/// [`PlanError`] if a number is out of its range, or not even single tiles fit.
pub fn plan_size(size: Size, crowd: &Crowd, machine: &Machine) -> Result<Plan, PlanError> {
    check(crowd, machine)?;
    if !(1..=MOST_SIDE).contains(&size.columns) || !(1..=MOST_SIDE).contains(&size.rows) {
        return Err(PlanError::Range { what: "a floor's side", expected: "1 to 4096 tiles" });
    }
    let split = fewest(size, crowd, machine)?;
    let boards = split::boards(size);
    Ok(conclude(
        [size.columns, size.rows],
        boards,
        Some(split),
        |crowd| split.areas(size, crowd),
        crowd,
        machine,
    ))
}

/// Plans a floor by its file: the areas that it names, or as by [`plan_size`] if it names none.
///
/// Areas that the file names are taken as they are, also where they are too large: [`Plan::fits`] tells.
///
/// # Errors
/// As [`plan_size`].
pub fn plan_floor(floor: &Floor, crowd: &Crowd, machine: &Machine) -> Result<Plan, PlanError> {
    check(crowd, machine)?;
    let (columns, rows) = (u32::from(floor.geometry.columns()), u32::from(floor.geometry.rows()));
    let boards = u32::try_from(floor.boards.len()).unwrap_or(u32::MAX);
    if !floor.areas.is_empty() {
        let areas =
            |crowd: &Crowd| floor.areas.iter().map(|area| AreaDemand::of(floor, area, crowd)).collect();
        return Ok(conclude([columns, rows], boards, None, areas, crowd, machine));
    }
    let whole = |crowd: &Crowd| vec![AreaDemand::whole(floor, crowd)];
    let plan = conclude([columns, rows], boards, Some(Split::WHOLE), whole, crowd, machine);
    if first(&plan.limits).share <= 1.0 {
        return Ok(plan);
    }
    plan_size(Size { columns, rows, actuators: floor.actuators.iter().any(Option::is_some) }, crowd, machine)
}

fn check(crowd: &Crowd, machine: &Machine) -> Result<(), PlanError> {
    machine.check()?;
    let is_in = |number: f64, least: f64, most: f64| number.is_finite() && number >= least && number <= most;
    if crowd.people > MOST_PEOPLE {
        return Err(PlanError::Range { what: "the number of people", expected: "at most 10,000,000" });
    }
    if !is_in(crowd.crowding, 1.0, 1000.0) {
        return Err(PlanError::Range { what: "the crowding of the fullest area", expected: "1 to 1000" });
    }
    if !is_in(crowd.usable, 0.01, 1.0) {
        return Err(PlanError::Range { what: "the share that may be used", expected: "0.01 to 1" });
    }
    Ok(())
}

/// The plan for `areas`, which are asked for with the densest crowd and with one that is spread evenly.
fn conclude(
    [columns, rows]: [u32; 2],
    boards: u32,
    split: Option<Split>,
    areas: impl Fn(&Crowd) -> Vec<AreaDemand>,
    crowd: &Crowd,
    machine: &Machine,
) -> Plan {
    let most = |area: &AreaDemand| first(&limits(area, machine, crowd.usable)).share;
    // Of areas that use as much of what is used most, such as channels, the one that senses most.
    let fuller = |a: &AreaDemand, b: &AreaDemand| {
        most(a).total_cmp(&most(b)).then(a.sensing_cores(machine).total_cmp(&b.sensing_cores(machine)))
    };
    let fullest = areas(crowd).into_iter().max_by(fuller).unwrap_or_default();
    let limits = limits(&fullest, machine, crowd.usable);
    let total = Total::of(&areas(&Crowd { crowding: 1.0, ..*crowd }), boards, crowd, machine);
    let whole = whole::limits(columns, rows, &total, machine, crowd.usable);
    let (area_first, whole_first) = (first(&limits), first(&whole));
    let densest = fullest.sensed_people / fullest.sensed_tiles().max(1.0);
    Plan {
        columns,
        rows,
        people: crowd.people,
        machine: *machine,
        usable: crowd.usable,
        split,
        fullest,
        first_limit: if whole_first.share > 1.0 { whole_first.resource } else { area_first.resource },
        fits: area_first.share <= 1.0 && whole_first.share <= 1.0,
        limits,
        total,
        whole,
        assumptions: assumptions::of(crowd, machine, densest),
    }
}

#[cfg(test)]
mod tests {
    use super::machine::tests::ROUND;
    use super::*;
    use crate::floor::{Area, Geometry, TileBlock, TileId};

    #[test]
    fn a_hall_by_hand() {
        // Sensing alone, spread evenly: 500 us, of which 20 are the same for all.
        let size = Size { columns: 100, rows: 100, actuators: false };
        let crowd = Crowd { crowding: 1.0, ..Crowd::of(400) };
        let plan = plan_size(size, &crowd, &ROUND).unwrap();
        assert!(plan.fits, "{plan:?}");
        // Thirteen boards a row.
        assert_eq!((plan.total.boards, plan.total.links), (1300, 1300 + plan.total.computers));
        assert_eq!(plan.first_limit, Resource::Sensing);
        // Each takes 0.2 us a tile and 0.4 us for the 0.04 people on it; the sum is what areas share and their margins.
        let split = plan.split.unwrap();
        assert_eq!(split.areas_count(), plan.total.computers);
        let share = plan.limits[0].share;
        assert!(share <= 1.0, "{share}");
        let fewer = Crowd { people: 399, ..crowd };
        assert!(plan_size(size, &fewer, &ROUND).unwrap().total.computers <= plan.total.computers);
        // 800 feet, 100 times a second.
        assert!((plan.total.contacts_per_s - 80_000.0).abs() < 1e-6);
    }

    #[test]
    fn more_computers_do_not_help_an_app_that_hears_everything() {
        let size = Size { columns: 1000, rows: 1000, actuators: false };
        let plan = plan_size(size, &Crowd::of(30_000), &Machine { person_us: 1.0, ..ROUND }).unwrap();
        assert!(!plan.fits);
        // 125 boards in each of 1000 rows, of 65,536; 1000 tiles of 256.
        let shares = |resource| plan.whole.iter().find(|limit| limit.resource == resource).unwrap().share;
        assert!((shares(Resource::Boards) - 125_000.0 / 65_536.0).abs() < 1e-9);
        assert!((shares(Resource::Side) - 1000.0 / 256.0).abs() < 1e-9);
        // 60,000 feet of 56 bytes 100 times a second are 2,688 Mb/s without headers; 500 may be used.
        assert!(
            plan.total.app_mbit > 2688.0 && plan.total.app_mbit < 1.3 * 2688.0,
            "{}",
            plan.total.app_mbit
        );
        assert_eq!(plan.first_limit, Resource::App);
    }

    #[test]
    fn of_areas_with_as_many_channels_the_one_that_senses_most_is_the_fullest() {
        // Nine areas of 8 x 8 with full cards; the one in the middle senses four tiles more on every side.
        let size = Size { columns: 24, rows: 24, actuators: true };
        let plan = plan_size(size, &Crowd::of(4), &ROUND).unwrap();
        assert_eq!(plan.split, Some(Split { across: 3, up: 3 }));
        assert_eq!((plan.fullest.sensed_columns, plan.fullest.sensed_rows), (16, 16));
    }

    #[test]
    fn areas_of_a_file_are_taken_as_they_are() {
        let half = |id: &str, column| {
            Area::new(id, TileBlock { first: TileId::new(column, 0), columns: 12, rows: 12 })
        };
        let floor = Floor::of(Geometry::of_paper_tiles(24, 12).unwrap())
            .with_areas(vec![half("west", 0), half("east", 12)]);
        let plan = plan_floor(&floor, &Crowd::of(4), &ROUND).unwrap();
        assert_eq!((plan.split, plan.total.computers), (None, 2));
        // 144 channels on a card of 64.
        assert!(!plan.fits && plan.first_limit == Resource::Channels);
        assert!((plan.limits[0].share - 144.0 / 64.0).abs() < 1e-9);
        // Without areas, as many are made as it takes.
        let whole = Floor { areas: Vec::new(), ..floor };
        let plan = plan_floor(&whole, &Crowd::of(4), &ROUND).unwrap();
        assert!(plan.fits && plan.split.unwrap().areas_count() == 5, "{:?}", plan.split);
    }

    #[test]
    fn a_crowd_denser_than_measured_is_told() {
        let said = |people| {
            let plan =
                plan_size(Size { columns: 12, rows: 12, actuators: false }, &Crowd::of(people), &ROUND);
            plan.unwrap().assumptions.iter().any(|said| said.contains("share tiles"))
        };
        assert!(!said(8));
        assert!(said(30));
    }

    #[test]
    fn numbers_out_of_their_range_are_refused() {
        let size = Size { columns: 6, rows: 6, actuators: true };
        let what = |size, crowd: Crowd| match plan_size(size, &crowd, &ROUND) {
            Err(PlanError::Range { what, .. }) => what,
            other => panic!("{other:?}"),
        };
        assert_eq!(what(Size { rows: 0, ..size }, Crowd::of(2)), "a floor's side");
        assert_eq!(what(size, Crowd::of(MOST_PEOPLE + 1)), "the number of people");
        assert_eq!(what(size, Crowd { usable: f64::NAN, ..Crowd::of(2) }), "the share that may be used");
        assert_eq!(what(size, Crowd { crowding: 0.5, ..Crowd::of(2) }), "the crowding of the fullest area");
        let wrong = plan_size(size, &Crowd::of(2), &Machine { base_us: f64::INFINITY, ..ROUND });
        assert!(matches!(wrong, Err(PlanError::Machine(_))));
    }
}
