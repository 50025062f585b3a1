//! Accuracy of one contact: over a whole tile, and at its seams.

use std::fmt;

use glam::Vec2;
use serde::Serialize;

use super::errors::{PositionErrors, Summary};
use super::follow::ELLIPSE_95;
use super::people::quality_note;
use super::rig::{ExperimentError, Rig};
use underfoot::floor::{Geometry, TileId};
use underfoot::sense::{Covariance, Method, Sensing};
use underfoot::units::Newtons;
use underfoot_sim::{FloorQuality, Load, Print};

/// Forces of the single contacts (N).
pub const FORCES_N: [f32; 4] = [50.0, 100.0, 200.0, 400.0];

/// Time that a contact rests before its measurement (ms).
const SETTLE_MS: u32 = 60;

/// Time that the floor is empty between two contacts (ms).
const PAUSE_MS: u32 = 60;

/// Duration of a touchdown (ms): real loads do not start instantly.
const LANDS_MS: u32 = 5;

/// Distance of the outermost contacts from the plate's edges (m).
const MARGIN_M: f32 = 0.005;

/// Object on the floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Thing {
    /// A single point, as in the paper's figure 8.
    Point,
    /// A shoe on a 26 cm foot, standing flat, with a different heading at each place.
    Foot,
}

impl Thing {
    /// Both objects, in the order of the tables.
    pub const ALL: [Self; 2] = [Self::Point, Self::Foot];

    /// The load with its centre of pressure at `at`; `turn` varies the heading.
    fn load(self, at: Vec2, force: Newtons, turn: usize) -> Load {
        let (print, heading) = match self {
            Self::Point => (Print::Point, 0.0),
            // Multiples of the golden angle never align with the grid.
            Self::Foot => (Print::Shoe { length_m: 0.26, roll: 0.4 }, turn as f32 * 2.399_963),
        };
        let load = Load { print, position: Vec2::ZERO, heading, force };
        Load { position: at - load.centre_of_pressure(), ..load }
    }

    const fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Foot => "foot",
        }
    }
}

/// A way of locating contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Way {
    /// Method of computing contacts.
    pub method: Method,
    /// True if the position maps of the tiles are used.
    pub mapped: bool,
    /// Name in tables.
    pub name: &'static str,
}

impl Way {
    /// All compared ways, in the order of the tables: the paper's own first.
    pub const ALL: [Self; 3] = [
        Self { method: Method::Eq4, mapped: false, name: "Eq. 4" },
        Self { method: Method::Tracker, mapped: false, name: "tracker" },
        Self { method: Method::Tracker, mapped: true, name: "with map" },
    ];
}

/// Minimum time that the floor is empty at the start (ms).
const EMPTY_MS: u32 = 1_000;

/// A floor of three by three tiles; the test uses the middle one.
pub(super) struct Bench {
    rig: Rig,
    sensing: [Sensing; Way::ALL.len()],
    tried: usize,
}

impl Bench {
    pub(super) fn new(quality: FloorQuality, seed: u64) -> Result<Self, ExperimentError> {
        let mut rig = Rig::of_quality(geometry(), quality, seed)?;
        rig.hold(EMPTY_MS, &[], |_| {});
        Ok(Self::over(rig))
    }

    fn over(rig: Rig) -> Self {
        let sensing = Way::ALL.map(|way| match way.mapped {
            true => rig.sensing(way.method),
            false => rig.sensing_without_maps(way.method),
        });
        Self { rig, sensing, tried: 0 }
    }

    /// Returns the heaviest contact that each way finds for the object, with its covariance; `None` if it finds none.
    pub(super) fn find(
        &mut self,
        thing: Thing,
        at: Vec2,
        force: Newtons,
    ) -> [Option<FoundOffset>; Way::ALL.len()] {
        self.tried += 1;
        let load = thing.load(at, force, self.tried);
        let sensing = &mut self.sensing;
        let mut sense = |frame: &_| {
            for sensing in sensing.iter_mut() {
                sensing.update(frame);
            }
        };
        self.rig.hold(PAUSE_MS, &[], &mut sense);
        for milli in 1..LANDS_MS {
            let share = milli as f32 / LANDS_MS as f32;
            self.rig.hold(1, &[Load { force: Newtons(load.force.0 * share), ..load }], &mut sense);
        }
        self.rig.hold(SETTLE_MS, &[load], &mut sense);
        self.sensing.each_ref().map(|sensing| {
            let heaviest = sensing.contacts().iter().max_by(|a, b| a.force.0.total_cmp(&b.force.0));
            heaviest.map(|contact| FoundOffset { off: contact.centroid - at, covariance: contact.covariance })
        })
    }
}

/// Offset of a contact from the object's true position, and the contact's covariance.
#[derive(Clone, Copy, Debug)]
pub(super) struct FoundOffset {
    off: Vec2,
    covariance: Covariance,
}

impl FoundOffset {
    pub(super) fn error(&self) -> f32 {
        self.off.length()
    }

    fn is_inside(&self) -> bool {
        self.covariance.mahalanobis_squared(self.off) <= ELLIPSE_95
    }
}

pub(super) fn geometry() -> Geometry {
    Geometry::of_paper_tiles(3, 3).unwrap_or_default()
}

/// A grid of `side` by `side` places over the middle tile, row by row from the south-west.
fn raster(geometry: &Geometry, side: u16) -> impl Iterator<Item = Vec2> + use<> {
    let plate = geometry.plate(TileId::new(1, 1)).grown(-MARGIN_M);
    let share = move |step: u16| f32::from(step) / f32::from(side.max(2) - 1);
    (0..side)
        .flat_map(move |row| (0..side).map(move |column| Vec2::new(share(column), share(row))))
        .map(move |share| plate.min + plate.size() * share)
}

/// One line of a [`SpotTable`].
#[derive(Clone, Debug, PartialEq)]
pub struct SpotRow {
    /// Object on the tile.
    pub thing: Thing,
    /// Force of the object.
    pub force: Newtons,
    /// Way of locating the object.
    pub way: Way,
    /// Distances from the true centre of pressure.
    pub errors: PositionErrors,
    /// Number of places without a contact.
    pub missed: usize,
    /// Number of places with the true centre of pressure inside the contact's 95 % ellipse.
    pub inside: usize,
}

impl SpotRow {
    /// Returns the share (0 to 1) of found objects inside their contacts' 95 % ellipses.
    #[must_use]
    pub fn share_inside(&self) -> f32 {
        self.inside as f32 / self.errors.count().max(1) as f32
    }
}

/// Accuracy of a single contact over one whole tile, up to half a centimetre from its edges.
#[derive(Clone, Debug, PartialEq)]
pub struct SpotTable {
    /// One line per object, force and way.
    pub rows: Vec<SpotRow>,
    quality: FloorQuality,
    side: u16,
    floors: usize,
}

impl SpotTable {
    /// Creates an empty table for floors of this quality, with `side` x `side` places per tile.
    #[must_use]
    pub fn on(quality: FloorQuality, side: u16) -> Self {
        let row = |thing, force, way| SpotRow {
            thing,
            force: Newtons(force),
            way,
            errors: PositionErrors::default(),
            missed: 0,
            inside: 0,
        };
        let rows = Thing::ALL
            .into_iter()
            .flat_map(|thing| FORCES_N.map(|force| Way::ALL.map(|way| row(thing, force, way))))
            .flatten()
            .collect();
        Self { quality, rows, side, floors: 0 }
    }

    /// Tests the middle tile of another floor with parts drawn from `seed`.
    ///
    /// # Errors
    /// Errors of [`Rig::of_quality`].
    pub fn add_floor(&mut self, seed: u64) -> Result<(), ExperimentError> {
        let mut bench = Bench::new(self.quality, seed)?;
        self.floors += 1;
        for rows in self.rows.chunks_exact_mut(Way::ALL.len()) {
            let (thing, force) = (rows[0].thing, rows[0].force);
            for at in raster(&geometry(), self.side) {
                for (row, found) in rows.iter_mut().zip(bench.find(thing, at, force)) {
                    match found {
                        Some(found) => {
                            row.errors.push(found.error());
                            row.inside += usize::from(found.is_inside());
                        }
                        None => row.missed += 1,
                    }
                }
            }
        }
        Ok(())
    }
}

impl fmt::Display for SpotTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { side, floors, quality, .. } = self;
        writeln!(
            f,
            "error of one contact over a whole tile, {side} x {side} places on {floors} floors{}, cm",
            quality_note(*quality)
        )?;
        writeln!(f, "thing  force_n  found by    median     p95   worst  missed  in ellipse")?;
        for row in &self.rows {
            let SpotRow { thing, force, way, errors, missed, .. } = row;
            let inside = 100.0 * row.share_inside();
            let (thing, way) = (thing.name(), way.name);
            writeln!(f, "{thing:5}  {:7.0}  {way:10}{errors}  {missed:6}  {inside:8.1} %", force.0)?;
        }
        Ok(())
    }
}

/// One line of a [`SeamTable`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SeamRow {
    /// Errors in the middle of a tile: centre of pressure within 5 cm of the tile's centre.
    pub middle: PositionErrors,
    /// Errors at a seam: centre of pressure within 2 cm of it, and not near a corner.
    pub seam: PositionErrors,
}

impl SeamRow {
    /// Returns the median error at a seam divided by that in the middle; `None` if either has no errors.
    #[must_use]
    pub fn ratio(&self) -> Option<f32> {
        Some(self.seam.quantile(0.5)? / self.middle.quantile(0.5)?)
    }
}

/// Accuracy of a contact at a seam compared with the middle of a tile, at 120 N.
#[derive(Clone, Debug, PartialEq)]
pub struct SeamTable {
    quality: FloorQuality,
    rows: [[SeamRow; Way::ALL.len()]; 2],
    floors: usize,
}

impl SeamTable {
    /// Creates an empty table for floors of this quality.
    #[must_use]
    pub fn on(quality: FloorQuality) -> Self {
        Self { quality, rows: Default::default(), floors: 0 }
    }

    /// Tests another floor with parts drawn from `seed`.
    ///
    /// # Errors
    /// Errors of [`Rig::of_quality`].
    pub fn add_floor(&mut self, seed: u64) -> Result<(), ExperimentError> {
        let mut bench = Bench::new(self.quality, seed)?;
        self.floors += 1;
        let force = Newtons(120.0);
        for (thing, rows) in Thing::ALL.into_iter().zip(&mut self.rows) {
            for step in 0..PLACES {
                let (middle, seam) = (place_in_the_middle(step), place_at_a_seam(step));
                for (row, found) in rows.iter_mut().zip(bench.find(thing, middle, force)) {
                    found.into_iter().for_each(|found| row.middle.push(found.error()));
                }
                for (row, found) in rows.iter_mut().zip(bench.find(thing, seam, force)) {
                    found.into_iter().for_each(|found| row.seam.push(found.error()));
                }
            }
        }
        Ok(())
    }

    /// Returns the lines of one object, one per way ([`Way::ALL`]).
    #[must_use]
    pub const fn rows(&self, thing: Thing) -> &[SeamRow; Way::ALL.len()] {
        &self.rows[thing as usize]
    }
}

/// Number of places per floor, in the middle and at a seam each.
const PLACES: u16 = 48;

/// A low-discrepancy sequence over the unit square.
pub(super) fn spread(step: u16) -> Vec2 {
    // Powers of the plastic number's inverse (R2 sequence).
    let index = f32::from(step) + 0.5;
    Vec2::new((index * 0.754_877_7).fract(), (index * 0.569_840_3).fract())
}

fn place_in_the_middle(step: u16) -> Vec2 {
    geometry().centre(TileId::new(1, 1)) + (spread(step) - 0.5) * 0.10
}

/// Within 2 cm of one of the middle tile's four seams, in the middle half of that seam.
fn place_at_a_seam(step: u16) -> Vec2 {
    let geometry = geometry();
    let half = 0.5 * geometry.pitch_m().x;
    let spread = spread(step) - 0.5;
    let across = half + spread.x * 0.04;
    let way = [Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y][usize::from(step % 4)];
    geometry.centre(TileId::new(1, 1)) + way * across + way.perp() * spread.y * half
}

impl fmt::Display for SeamTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "error of one contact of 120 N at a seam and in mid-tile, {} floors{}, cm",
            self.floors,
            quality_note(self.quality)
        )?;
        writeln!(f, "                 mid-tile                at a seam               ratio of")?;
        writeln!(f, "thing  found by    median     p95   worst  median     p95   worst  medians")?;
        for (thing, rows) in Thing::ALL.into_iter().zip(&self.rows) {
            for (way, row) in Way::ALL.into_iter().zip(rows) {
                let SeamRow { middle, seam } = row;
                let ratio = row.ratio().unwrap_or(f32::NAN);
                writeln!(f, "{:5}  {:10}{middle}{seam}  {ratio:7.2}", thing.name(), way.name)?;
            }
        }
        Ok(())
    }
}

/// One line of a [`SpotTable`] or [`SeamTable`], for programs.
#[derive(Debug, Serialize)]
pub struct SpotLine {
    thing: Thing,
    force_n: f32,
    found_by: &'static str,
    place: &'static str,
    /// Share (0 to 1) within the contact's 95 % ellipse.
    in_ellipse: Option<f32>,
    #[serde(flatten)]
    errors: Option<Summary>,
}

impl SpotTable {
    /// Returns all lines, for programs.
    pub fn lines(&self) -> impl Iterator<Item = SpotLine> + '_ {
        self.rows.iter().map(|row| SpotLine {
            thing: row.thing,
            force_n: row.force.0,
            found_by: row.way.name,
            place: "tile",
            in_ellipse: Some(row.share_inside()),
            errors: row.errors.summary(),
        })
    }
}

impl SeamTable {
    /// Returns all lines, for programs.
    pub fn lines(&self) -> impl Iterator<Item = SpotLine> + '_ {
        Thing::ALL.into_iter().zip(&self.rows).flat_map(|(thing, rows)| {
            Way::ALL.into_iter().zip(rows).flat_map(move |(way, row)| {
                [("middle", &row.middle), ("seam", &row.seam)].map(|(place, errors)| SpotLine {
                    thing,
                    force_n: 120.0,
                    found_by: way.name,
                    place,
                    in_ellipse: None,
                    errors: errors.summary(),
                })
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ideal_floor_finds_points_and_feet_where_they_are() {
        let mut bench = Bench::over(Rig::ideal(geometry()));
        for thing in Thing::ALL {
            for at in raster(&geometry(), 4).chain((0..8).map(place_at_a_seam)) {
                for found in bench.find(thing, at, Newtons(100.0)) {
                    let error = found.unwrap().error();
                    // A tile with less than 6 of the 100 N does not count, up to 10 cm away.
                    assert!(error < 0.01, "{thing:?} at {at}: {error} m");
                }
            }
        }
    }

    #[test]
    fn places_are_where_their_names_say() {
        let geometry = geometry();
        let plate = geometry.plate(TileId::new(1, 1));
        for step in 0..PLACES {
            assert!(place_in_the_middle(step).distance(plate.centre()) <= 0.0708);
            let seam = place_at_a_seam(step);
            let off = (seam - plate.centre()).abs();
            assert!((off.max_element() - 0.152).abs() <= 0.0201, "{seam}");
            assert!(off.min_element() <= 0.0761, "{seam} is near a corner");
        }
    }
}
