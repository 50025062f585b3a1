//! Tracks several feet over time, also where they share tiles.
//!
//! A track is one foot: force, centre of pressure, their rates, and the half widths of a patch around that centre.
//! Each frame goes through the same steps:
//!
//! 1. **Predict and associate** ([`associate`]): a tile belongs to the tracks whose patch reaches it, or to a track
//!    whose shoe has room for it ([`outline`], [`reach`]). A load that no shoe covers becomes a new track after a
//!    short confirmation time.
//! 2. **Initiate** ([`initiate`], [`explanation`]): one foot or two explain a track that is alone on its tiles. A
//!    second track begins when two feet are likely enough to justify the risk and the data show the place.
//! 3. **Estimate**: Eq. 4 measures a track that is alone. An extended Kalman filter ([`groups`], [`joint`],
//!    [`model`]) estimates tracks that share tiles; it predicts the force and both moments of each column and row of
//!    tiles ([`strips`]). A foot put down beside a standing one is placed by the likelihood of each distance
//!    ([`touchdown`]). Two feet that have landed together stand where two soles fit best ([`sole`], [`pair`],
//!    [`stance`]). Where a foot strays, rival explanations compete with the filter's ([`rivals`]); where a touchdown
//!    fits badly, two soles do ([`soles`]).
//! 4. **Delete or rest** ([`delete`], [`dormant`]): a foot whose place is proven empty is deleted. A foot that
//!    carries so little that the other one explains all of the load stays as an ambiguous contact with its identity
//!    until its load returns or it is proven to have left.
//! 5. **Output** ([`output`]): contacts with their ellipses, sized by the remaining uncertainty.
//!
//! [`params`] holds all numbers, with their units and sources.

mod associate;
mod delete;
mod dormant;
mod elapsed;
mod explanation;
mod groups;
mod initiate;
mod joint;
mod model;
mod neighbours;
mod outline;
mod output;
mod pair;
mod params;
mod parts;
mod patch;
mod reach;
mod refits;
mod residual;
mod rival;
mod rivals;
mod sharing;
mod smoothed;
mod sole;
mod soles;
mod stance;
mod state;
mod static_fit;
mod stillness;
mod strips;
#[cfg(test)]
mod tests;
mod touchdown;
mod tracks;

use self::params::tracker::LANDING_S;
use glam::{DVec2, IVec2};
use std::cmp::Reverse;

use self::elapsed::Elapsed;
use self::groups::{BATCHES, GroupEstimator, Link};
use self::neighbours::Near;
use self::sharing::Groups;
use self::state::Track;
use self::strips::StripAxis;
use self::tracks::Tracks;
use super::centroid::tile::LoadedTile;
use super::centroid::uncertainty::SensorUncertainty;
use super::contact::ContactId;
use super::contact::pool::ContactPool;
use super::loaded::LoadedTiles;
use crate::floor::{Geometry, TileBlock, TileId};
use crate::parallel;

/// Tracks the feet on one floor.
#[derive(Clone, Debug)]
pub(super) struct Tracker {
    uncertainty: SensorUncertainty,
    cells: Cells,
    elapsed: Elapsed,
    next: u32,
    tracks: Tracks,
    dormant: Vec<dormant::Dormant>,
    estimators: Vec<GroupEstimator>,
    /// Covariances between feet after the last frame, one list per estimator.
    links: Vec<Vec<Link>>,
    /// For each foot that shares tiles: the number of its group among the groups of several feet.
    group_numbers: Vec<u32>,
    /// For each loaded tile: the first foot that reaches it, or `UNASSIGNED`.
    owner: Vec<u32>,
    /// Pairs of a foot and another one that reaches one of its tiles first.
    sharing: Vec<(u32, u32)>,
    /// All feet that share tiles, in their order.
    members: Vec<u32>,
    /// Loaded tiles beyond the reach of all feet, heaviest first: the bits of the force, and the position in the
    /// list.
    unassigned: Vec<(Reverse<u32>, u32)>,
    pending: Vec<associate::Pending>,
    /// Tracks that had the unassigned tiles in the last frame, and for each loaded tile the last entry found for it.
    previous_owners: Vec<associate::PreviousOwner>,
    last_previous_owner: Vec<u32>,
    /// For each foot, the time for which its place has been empty.
    empty_s: Vec<f64>,
    near: Near,
    mates: Groups,
    /// Each foot and its number in `tracks`, then the dormant feet; ordered by id.
    by_id: Vec<(ContactId, u32)>,
}

const UNASSIGNED: u32 = u32::MAX;

/// The cells of the floor's tiles, without gaps between them.
#[derive(Clone, Copy, Debug)]
struct Cells {
    /// Width and depth of a cell (m).
    pitch: DVec2,
    block: TileBlock,
    /// The floor, if it lacks some of its tiles.
    holed: Option<Geometry>,
}

impl Cells {
    fn new(geometry: &Geometry) -> Self {
        let pitch = geometry.pitch_m().as_dvec2();
        let holed = (!geometry.missing().is_empty()).then_some(*geometry);
        Self { pitch, block: geometry.block(), holed }
    }

    /// Returns whether the column or row of this number has a tile at the place `across` along the other axis (m).
    fn have(&self, axis: StripAxis, number: i32, across: f64) -> bool {
        let numbers = match axis {
            StripAxis::East => self.block.column_range(),
            StripAxis::North => self.block.row_range(),
        };
        (i32::from(numbers.start)..i32::from(numbers.end)).contains(&number)
            && self.holed.as_ref().is_none_or(|floor| !self.is_hole(floor, axis, number, across))
    }

    /// Whether a tile is missing there.
    #[cold]
    fn is_hole(&self, floor: &Geometry, axis: StripAxis, number: i32, across: f64) -> bool {
        let across = number_of(across, axis.across(self.pitch));
        let (column, row) = match axis {
            StripAxis::East => (number, across),
            StripAxis::North => (across, number),
        };
        let tile = |column: u16, row: u16| floor.is_missing(TileId::new(column, row));
        column.try_into().is_ok_and(|column| row.try_into().is_ok_and(|row| tile(column, row)))
    }

    /// Mean of width and depth of a cell (m).
    fn side(&self) -> f64 {
        0.5 * (self.pitch.x + self.pitch.y)
    }

    /// South-west and north-east corner of the floor.
    fn bounds(&self) -> (DVec2, DVec2) {
        let TileId { column, row } = self.block.first;
        let corner = DVec2::new(column.into(), row.into());
        let size = DVec2::new(self.block.columns.into(), self.block.rows.into());
        (corner * self.pitch, (corner + size) * self.pitch)
    }

    /// Calls `visit` with the index of each tile in the columns and rows from `low` to `high` that the floor has.
    #[inline(always)]
    fn visit(&self, low: IVec2, high: IVec2, mut visit: impl FnMut(u32)) {
        let TileBlock { first, columns, rows } = self.block;
        let first = IVec2::new(first.column.into(), first.row.into());
        let (columns, rows) = (i32::from(columns), i32::from(rows));
        let low = low.wrapping_sub(first).max(IVec2::ZERO);
        let high = high.wrapping_sub(first).min(IVec2::new(columns, rows) - 1);
        for row in low.y..high.y + 1 {
            let first = row * columns;
            (first + low.x..first + high.x + 1).for_each(|index| visit(index as u32));
        }
    }

    fn of(&self, tile: &LoadedTile) -> (DVec2, DVec2) {
        let low = DVec2::new(tile.tile.column.into(), tile.tile.row.into()) * self.pitch;
        (low, low + self.pitch)
    }
}

/// Number of the cell of width `pitch` that contains the place `along`, along one axis.
#[inline]
fn number_of(along: f64, pitch: f64) -> i32 {
    // Adding a number this large leaves no bits for a fraction; the last bits of the sum are the nearest integer.
    const WHOLE: f64 = 3.0 * (1_u64 << 51) as f64;
    let number = along / pitch;
    // The floor, with operations of every processor: a function call for each would dominate the run time here.
    let sum = number + WHOLE;
    let (nearest, is_above) = (sum.to_bits() as i32, sum - WHOLE > number);
    nearest.wrapping_sub(i32::from(is_above))
}

/// The cell that contains `place`: [`number_of`] along both axes.
#[inline]
fn cell_of(place: DVec2, pitch: DVec2) -> IVec2 {
    IVec2::new(number_of(place.x, pitch.x), number_of(place.y, pitch.y))
}

/// Orders by the first number, and equal ones by their index.
fn first_of_least(a: &(f64, usize), b: &(f64, usize)) -> std::cmp::Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
}

impl Tracker {
    pub(super) fn new(geometry: &Geometry, uncertainty: SensorUncertainty) -> Self {
        let room = geometry.tile_count().min(1024);
        let cells = Cells::new(geometry);
        Self {
            uncertainty,
            near: Near::new(&cells, room),
            mates: Groups::new(room),
            cells,
            elapsed: Elapsed::new(0.0),
            next: 1,
            tracks: Tracks::with_capacity(room),
            dormant: Vec::with_capacity(room),
            estimators: (0..BATCHES).map(|number| GroupEstimator::new(number, room / BATCHES)).collect(),
            links: (0..BATCHES).map(|_| Vec::with_capacity(room / BATCHES)).collect(),
            group_numbers: Vec::with_capacity(room),
            owner: Vec::with_capacity(room),
            sharing: Vec::with_capacity(room),
            members: Vec::with_capacity(room),
            unassigned: Vec::with_capacity(room),
            pending: Vec::with_capacity(room),
            previous_owners: Vec::with_capacity(room),
            last_previous_owner: Vec::with_capacity(room),
            empty_s: Vec::with_capacity(room),
            by_id: Vec::with_capacity(room),
        }
    }

    /// Number of feet tracked.
    pub(super) fn feet(&self) -> usize {
        self.tracks.len()
    }

    /// Fills `pool` with this frame's contacts; `dt` seconds have passed since the last frame.
    pub(super) fn update(&mut self, tiles: &LoadedTiles, dt: f32, pool: &mut ContactPool) {
        let dt = f64::from(dt);
        if dt != self.elapsed.dt {
            self.elapsed = Elapsed::new(dt);
        }
        let elapsed = self.elapsed;
        let cells = &self.cells;
        parallel::for_each(&mut self.tracks, |_, foot| {
            foot.predict(dt);
            foot.reach(tiles, cells);
        });
        self.near.renew(&self.tracks);
        self.associate(tiles, &elapsed);
        self.forget_pending();
        self.wake(tiles, dt);
        self.initiate(tiles, &elapsed);
        self.note_partners(tiles);
        self.delete_without_tiles();
        self.group(tiles.list().len());
        self.estimate(tiles, &elapsed);
        self.confirm_split(tiles);
        self.delete_empty(tiles, dt);
        self.let_sleep(tiles, dt);
        self.learn(tiles, &elapsed);
        self.describe(tiles, pool);
    }

    /// Records for each foot whether others are near, and keeps the tiles on which it was noticed.
    fn note_partners(&mut self, tiles: &LoadedTiles) {
        let near = &self.near;
        parallel::for_each(&mut self.tracks, |which, foot| {
            let has_partner = if foot.age < LANDING_S {
                let body_n = near.body_n_of_partner(which);
                foot.step.body_n = body_n.unwrap_or(foot.step.body_n);
                body_n.is_some()
            } else {
                near.has_partner(which)
            };
            if has_partner {
                foot.company.partner_s = 0.0;
                foot.company.accompanied = true;
            }
            foot.keep_noticed_tiles(tiles);
        });
    }

    fn delete_without_tiles(&mut self) {
        if self.tracks.iter().any(|foot| foot.tiles.is_empty()) {
            self.near.retain(|which| !self.tracks[which].tiles.is_empty());
            self.tracks.retain(|foot| !foot.tiles.is_empty());
        }
    }

    fn name(&mut self) -> ContactId {
        let id = ContactId(self.next);
        self.next = self.next.wrapping_add(1);
        id
    }

    /// Measures the feet that are alone on their tiles and estimates the others.
    fn estimate(&mut self, tiles: &LoadedTiles, elapsed: &Elapsed) {
        parallel::for_each(&mut self.tracks, |_, foot| {
            if !foot.company.crowded {
                foot.measure(tiles.list(), elapsed);
            }
        });
        self.estimate_groups(tiles, elapsed);
    }

    /// Updates the smoothed state of each foot with this frame.
    fn learn(&mut self, tiles: &LoadedTiles, elapsed: &Elapsed) {
        let (list, cells) = (tiles.list(), self.cells);
        parallel::for_each(&mut self.tracks, |_, foot| foot.learn(list, &cells, elapsed));
    }
}

impl Track {
    /// Updates its smoothed state with this frame.
    fn learn(&mut self, list: &[LoadedTile], cells: &Cells, elapsed: &Elapsed) {
        self.smooth(elapsed);
        self.roll(elapsed);
        self.note_outline(list, elapsed);
        if !self.company.shared {
            self.learn_shape(list, cells.pitch, elapsed);
        }
        self.learn_loads(list, cells, elapsed);
        self.judge();
    }
}
