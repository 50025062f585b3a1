//! Accuracy of one foot, by its force and its distance from a seam.

use std::fmt;

use serde::Serialize;

use super::errors::{PositionErrors, Summary};
use super::people::quality_note;
use super::rig::ExperimentError;
use super::spot::{Bench, Thing, Way, geometry, spread};
use underfoot::floor::TileId;
use underfoot::units::Newtons;
use underfoot_scene::ergonomics::Zone;
use underfoot_sim::FloorQuality;

/// The compared ways, without and with position maps: indices into [`Way::ALL`].
const WAYS: [usize; 2] = [1, 2];

/// Distances between the estimated position of a standing foot and its true centre of pressure.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaceTable {
    quality: FloorQuality,
    rows: Vec<Row>,
    places: u16,
    floors: usize,
}

#[derive(Clone, Debug, PartialEq)]
struct Row {
    zone: Zone,
    force: Newtons,
    errors: [PositionErrors; WAYS.len()],
}

impl PlaceTable {
    /// Creates an empty table for floors of this quality, with `places` places per tile and force.
    #[must_use]
    pub fn on(quality: FloorQuality, places: u16) -> Self {
        let rows = Zone::ALL.into_iter().flat_map(|zone| {
            Zone::FORCES_N.map(|force| Row { zone, force: Newtons(force), errors: Default::default() })
        });
        Self { quality, rows: rows.collect(), places, floors: 0 }
    }

    /// Tests the middle tile of another floor with parts drawn from `seed`.
    ///
    /// # Errors
    /// Errors of [`super::Rig::of_quality`].
    pub fn add_floor(&mut self, seed: u64) -> Result<(), ExperimentError> {
        let mut bench = Bench::new(self.quality, seed)?;
        self.floors += 1;
        let geometry = geometry();
        let tile = geometry.cell(TileId::new(1, 1));
        for step in 0..self.places {
            let at = tile.min + tile.size() * spread(step);
            let zone = Zone::of(&geometry, at);
            for row in self.rows.iter_mut().filter(|row| row.zone == zone) {
                let found = bench.find(Thing::Foot, at, row.force);
                for (errors, way) in row.errors.iter_mut().zip(WAYS) {
                    // An undetected foot presses nothing: it counts as missed, not as displaced.
                    if let Some(found) = found[way] {
                        errors.push(found.error());
                    }
                }
            }
        }
        Ok(())
    }

    /// Returns the 95th percentile of the error in metres, at this zone and force; `None` before the first floor.
    #[must_use]
    pub fn p95_m(&self, zone: Zone, force: Newtons, mapped: bool) -> Option<f32> {
        let row = self.rows.iter().find(|row| row.zone == zone && row.force == force)?;
        row.errors[usize::from(mapped)].quantile(0.95)
    }

    /// Returns all lines, for programs.
    pub fn lines(&self) -> impl Iterator<Item = PlaceLine> + '_ {
        self.rows.iter().flat_map(|row| {
            WAYS.into_iter().zip(&row.errors).map(|(way, errors)| PlaceLine {
                zone: row.zone.name(),
                force_n: row.force.0,
                found_by: Way::ALL[way].name,
                errors: errors.summary(),
            })
        })
    }
}

/// One line of a [`PlaceTable`], for programs.
#[derive(Debug, Serialize)]
pub struct PlaceLine {
    zone: &'static str,
    force_n: f32,
    found_by: &'static str,
    #[serde(flatten)]
    errors: Option<Summary>,
}

impl fmt::Display for PlaceTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { places, floors, quality, .. } = self;
        writeln!(
            f,
            "error of one standing foot, {places} places per tile on {floors} floors{}, cm",
            quality_note(*quality)
        )?;
        writeln!(f, "place                force_n  found by    median     p95   worst")?;
        for row in &self.rows {
            for (way, errors) in WAYS.into_iter().zip(&row.errors) {
                let (zone, force) = (row.zone.name(), row.force.0);
                writeln!(f, "{zone:20} {force:7.0}  {:10}{errors}", Way::ALL[way].name)?;
            }
        }
        Ok(())
    }
}
