//! Number of computers that a floor needs, from its size, its crowd and the performance of one machine ([`measure`]).
//!
//! A floor too large for one computer is cut into areas ([`underfoot::floor::Area`]). Each computer receives the packets
//! of its area and of 1.2 m around it, assembles and senses those tiles, and drives its own. The cost is linear in
//! packets, tiles, people and channels, with the [`Machine`]'s constants. Wake-ups are the exception: they cost at
//! most the time in which a thread would sleep. The plan has the fewest areas that stay within a share of every
//! resource. [`Plan::assumptions`] lists the assumptions of the calculation.

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

use underfoot::floor::Floor;
use underfoot::wire::SensorFormat;

pub use self::area_demand::AreaDemand;
pub use self::limit::{Limit, Resource};
pub use self::machine::{Machine, MachineError};
pub use self::measure::{LOADS, measure};
pub use self::split::Split;
pub use self::whole::Total;

use self::limit::{first, limits};
use self::split::fewest;

/// Maximum number of tiles along a side that a plan accepts: four times three hundred metres of the paper's tiles.
pub const MOST_SIDE: u32 = 4096;

/// Maximum number of people that a plan accepts.
pub const MOST_PEOPLE: u32 = 10_000_000;

/// A floor given by its size alone: the paper's tiles, boards for eight tiles of a row, an actuator under each tile
/// or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FloorSize {
    /// Number of tiles from west to east, 1 to [`MOST_SIDE`].
    pub columns: u32,
    /// Number of tiles from south to north, 1 to [`MOST_SIDE`].
    pub rows: u32,
    /// True if there is an actuator under each tile.
    pub actuators: bool,
}

/// People on the floor, and the format of the board packets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crowd {
    /// Number of people on the whole floor, at most [`MOST_PEOPLE`].
    pub people: u32,
    /// Density of people in the fullest area divided by the density on the whole floor, 1 to 1000.
    pub crowding: f64,
    /// Format of the readings in board packets.
    pub format: SensorFormat,
    /// Usable share of each resource, above 0 and at most 1; the rest is headroom.
    pub usable: f64,
}

impl Crowd {
    /// A crowd of `people`, twice as dense in the fullest area, with boards that send counts and half of each
    /// resource as headroom.
    #[must_use]
    pub const fn of(people: u32) -> Self {
        Self { people, crowding: 2.0, format: SensorFormat::Counts, usable: 0.5 }
    }
}

/// Computers and resources that a floor with a crowd needs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// Number of tiles from west to east.
    pub columns: u32,
    /// Number of tiles from south to north.
    pub rows: u32,
    /// Number of people on the floor.
    pub people: u32,
    /// Constants of the computers.
    pub machine: Machine,
    /// Usable share of each resource.
    pub usable: f64,
    /// Division of the floor into areas; `None` if the floor file names the areas.
    pub split: Option<Split>,
    /// The area with the highest share of any resource.
    pub fullest: AreaDemand,
    /// Use of each resource of that area's computer, the highest share first.
    pub limits: Vec<Limit>,
    /// Sums over all areas.
    pub total: Total,
    /// Limits of the whole floor that more computers do not raise, the highest share first.
    pub whole: Vec<Limit>,
    /// The resource that runs out first: a resource of the whole floor if it needs more than is available, else the
    /// resource with the highest share on the fullest area's computer.
    pub first_limit: Resource,
    /// True if each area's computer and the whole floor stay within their limits.
    pub fits: bool,
    /// Assumptions of the calculation.
    pub assumptions: Vec<String>,
}

/// Reason why a plan can't be made.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PlanError {
    /// The machine's constants are not usable.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// A size, a number of people or a share is out of its range.
    #[error("{what} must be {expected}")]
    Range {
        /// Name of the quantity.
        what: &'static str,
        /// Range of the quantity.
        expected: &'static str,
    },
    /// One tile with the sensed tiles around it is too much for one computer.
    #[error("even an area of one tile takes more than one computer gives: {what}")]
    TooMuch {
        /// Name of the resource that runs out.
        what: &'static str,
    },
}

/// Plans a floor from its size alone: the fewest areas that fit, near-square and of nearly equal sizes.
///
/// # Errors
/// [`PlanError`] if a number is out of its range, or if even single tiles do not fit.
pub fn plan_size(size: FloorSize, crowd: &Crowd, machine: &Machine) -> Result<Plan, PlanError> {
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

/// Plans a floor from its file: with the areas that the file names, or as [`plan_size`] does if it names none.
///
/// The areas of the file stay as they are, even if they are too large; [`Plan::fits`] is false then.
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
    plan_size(
        FloorSize { columns, rows, actuators: floor.actuators.iter().any(Option::is_some) },
        crowd,
        machine,
    )
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

/// Makes the plan for `areas`, a function that returns the areas for a crowd: called with the densest crowd, and with
/// people spread evenly.
fn conclude(
    [columns, rows]: [u32; 2],
    boards: u32,
    split: Option<Split>,
    areas: impl Fn(&Crowd) -> Vec<AreaDemand>,
    crowd: &Crowd,
    machine: &Machine,
) -> Plan {
    let most = |area: &AreaDemand| first(&limits(area, machine, crowd.usable)).share;
    // If several areas have the same highest share, as with channels, the one that senses most is the fullest.
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
    use underfoot::floor::{Area, Geometry, TileBlock, TileId};

    #[test]
    fn a_hall_by_hand() {
        // Sensing is the only limit and people are spread evenly: 500 us, of which 20 are the same for all.
        let size = FloorSize { columns: 100, rows: 100, actuators: false };
        let crowd = Crowd { crowding: 1.0, ..Crowd::of(400) };
        let plan = plan_size(size, &crowd, &ROUND).unwrap();
        assert!(plan.fits, "{plan:?}");
        // Thirteen boards per row.
        assert_eq!((plan.total.boards, plan.total.links), (1300, 1300 + plan.total.computers));
        assert_eq!(plan.first_limit, Resource::Sensing);
        // Each tile takes 0.2 us, and 0.4 us for the 0.04 people on it; the fixed time and the margins of the areas
        // add to that.
        let split = plan.split.unwrap();
        assert_eq!(split.areas_count(), plan.total.computers);
        let share = plan.limits[0].share;
        assert!(share <= 1.0, "{share}");
        let fewer = Crowd { people: 399, ..crowd };
        assert!(plan_size(size, &fewer, &ROUND).unwrap().total.computers <= plan.total.computers);
        // 800 feet, 100 reports per second.
        assert!((plan.total.contacts_per_s - 80_000.0).abs() < 1e-6);
    }

    #[test]
    fn more_computers_do_not_help_an_app_that_hears_everything() {
        let size = FloorSize { columns: 1000, rows: 1000, actuators: false };
        let plan = plan_size(size, &Crowd::of(30_000), &Machine { person_us: 1.0, ..ROUND }).unwrap();
        assert!(!plan.fits);
        // 125 boards in each of 1000 rows, of 65,536 board numbers; 1000 tiles of 256 along a side.
        let shares = |resource| plan.whole.iter().find(|limit| limit.resource == resource).unwrap().share;
        assert!((shares(Resource::Boards) - 125_000.0 / 65_536.0).abs() < 1e-9);
        assert!((shares(Resource::Side) - 1000.0 / 256.0).abs() < 1e-9);
        // 60,000 feet of 56 bytes at 100 Hz are 2,688 Mb/s without headers; 500 Mb/s are usable.
        assert!(
            plan.total.app_mbit > 2688.0 && plan.total.app_mbit < 1.3 * 2688.0,
            "{}",
            plan.total.app_mbit
        );
        assert_eq!(plan.first_limit, Resource::App);
    }

    #[test]
    fn of_areas_with_as_many_channels_the_one_that_senses_most_is_the_fullest() {
        // Nine areas of 8 x 8 use all channels of their cards; the one in the middle senses four more tiles on every
        // side.
        let size = FloorSize { columns: 24, rows: 24, actuators: true };
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
        // Without areas in the file, the plan makes as many as it needs.
        let whole = Floor { areas: Vec::new(), ..floor };
        let plan = plan_floor(&whole, &Crowd::of(4), &ROUND).unwrap();
        assert!(plan.fits && plan.split.unwrap().areas_count() == 5, "{:?}", plan.split);
    }

    #[test]
    fn a_crowd_denser_than_measured_is_told() {
        let said = |people| {
            let plan =
                plan_size(FloorSize { columns: 12, rows: 12, actuators: false }, &Crowd::of(people), &ROUND);
            plan.unwrap().assumptions.iter().any(|said| said.contains("share tiles"))
        };
        assert!(!said(8));
        assert!(said(30));
    }

    #[test]
    fn numbers_out_of_their_range_are_refused() {
        let size = FloorSize { columns: 6, rows: 6, actuators: true };
        let what = |size, crowd: Crowd| match plan_size(size, &crowd, &ROUND) {
            Err(PlanError::Range { what, .. }) => what,
            other => panic!("{other:?}"),
        };
        assert_eq!(what(FloorSize { rows: 0, ..size }, Crowd::of(2)), "a floor's side");
        assert_eq!(what(size, Crowd::of(MOST_PEOPLE + 1)), "the number of people");
        assert_eq!(what(size, Crowd { usable: f64::NAN, ..Crowd::of(2) }), "the share that may be used");
        assert_eq!(what(size, Crowd { crowding: 0.5, ..Crowd::of(2) }), "the crowding of the fullest area");
        let wrong = plan_size(size, &Crowd::of(2), &Machine { base_us: f64::INFINITY, ..ROUND });
        assert!(matches!(wrong, Err(PlanError::Machine(_))));
    }
}
