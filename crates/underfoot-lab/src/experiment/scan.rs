//! Position of a point load on one tile (paper, figure 8).

use std::fmt::Write;

use glam::Vec2;

use super::chart::{ChartAxis, ChartPage, LegendSymbol, MARGIN_M, Plot, THEME, Type};
use super::errors::PositionErrors;
use super::figure::Figure;
use super::rig::{ExperimentError, Rig};
use underfoot::floor::{Corner, Geometry, Rect, TileId};
use underfoot::sense::Method;
use underfoot::units::Newtons;
use underfoot_scene::scene::{Anchor, Ink, Paint, Scene, Stroke};
use underfoot_sim::{Load, Print};

/// One point load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanPoint {
    /// True position, in metres from the tile's south-west corner.
    pub truth: Vec2,
    /// Estimated position.
    pub found: Vec2,
}

/// A scan of a whole tile with one kind of calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct TileSweep {
    /// Name of the calibration: "without position map", "with position map".
    pub name: &'static str,
    /// Row by row from the south-west.
    pub points: Vec<ScanPoint>,
}

impl TileSweep {
    /// Returns the distances between true and estimated positions.
    #[must_use]
    pub fn errors(&self) -> PositionErrors {
        let mut errors = PositionErrors::default();
        self.points.iter().for_each(|point| errors.push(point.truth.distance(point.found)));
        errors
    }
}

/// Estimated against true positions of a point load along straight lines across one tile.
///
/// # Source
/// Paper, figure 8: a constant force at measured positions, formula (3) applied to the recorded forces.
#[derive(Clone, Debug, PartialEq)]
pub struct TileScan {
    /// One entry for each kind of calibration.
    pub scans: Vec<TileSweep>,
}

/// Number of points along each line, and of lines, per tile.
const SIDE: u16 = 8;

/// Distance of the outermost lines from the tile's edges, in metres.
const MARGIN_TO_EDGE_M: f32 = 0.012;

/// Force of the point load.
const FORCE: Newtons = Newtons(100.0);

/// Space for the axis between two tiles (page metres).
const GAP_M: f32 = 0.022;

/// Number of readings averaged at each point.
const READINGS: u32 = 50;

impl TileScan {
    /// Scans a tile with parts drawn from `seed`.
    ///
    /// # Errors
    /// Errors of [`Rig::of_mapped_parts`].
    pub fn measure(seed: u64) -> Result<Self, ExperimentError> {
        let geometry = Geometry::of_paper_tiles(1, 1).unwrap_or_default();
        let rigs = [
            ("without position map", Rig::of_calibrated_parts(geometry, seed)?),
            ("with position map", Rig::of_mapped_parts(geometry, seed)?),
        ];
        let scans = rigs.into_iter().map(|(name, rig)| TileSweep { name, points: scan(rig) });
        Ok(Self { scans: scans.collect() })
    }
}

fn scan(mut rig: Rig) -> Vec<ScanPoint> {
    let geometry = *rig.geometry();
    let mut sensing = rig.sensing(Method::Eq4);
    let span = geometry.tile_m().x - 2.0 * MARGIN_TO_EDGE_M;
    let along = |step: u16| MARGIN_TO_EDGE_M + span * f32::from(step) / f32::from(SIDE - 1);
    let places = (0..SIDE).flat_map(|row| (0..SIDE).map(move |column| Vec2::new(along(column), along(row))));
    let mut points = Vec::new();
    for truth in places {
        let load = Load { print: Print::Point, position: truth, heading: 0.0, force: FORCE };
        let (mut sum, mut count) = (Vec2::ZERO, 0.0);
        rig.hold(5, &[], |frame| {
            sensing.update(frame);
        });
        rig.hold(READINGS, &[load], |frame| {
            if let Some(contact) = sensing.update(frame).first() {
                sum += contact.centroid;
                count += 1.0;
            }
        });
        if count > 0.0 {
            points.push(ScanPoint { truth, found: sum / count });
        }
    }
    points
}

impl Figure for TileScan {
    fn draw(&self) -> Scene {
        let side = 0.105;
        let left = MARGIN_M + 0.011;
        let width = left + self.scans.len() as f32 * (side + GAP_M);
        let mut page = ChartPage::new(
            Vec2::new(width - GAP_M + MARGIN_M, side + 0.050),
            "Where a point load is found on one tile",
            "100 N at 64 places; sensors (squares) 2 cm inside the edges",
        );
        for (which, scan) in self.scans.iter().enumerate() {
            let corner = Vec2::new(left + which as f32 * (side + GAP_M), 0.022);
            draw_scan(&mut page, Rect::from_min_size(corner, Vec2::splat(side)), scan);
        }
        page.legend(
            Vec2::new(MARGIN_M, 0.0055),
            &[
                (LegendSymbol::Ring, THEME.ink, "true position"),
                (LegendSymbol::Cross, THEME.cursor, "estimated position"),
                (LegendSymbol::Line, THEME.accent, "lines as they are seen"),
            ],
        );
        page.scene
    }

    fn csv(&self) -> String {
        let mut csv = String::from("calibration,true_x_m,true_y_m,found_x_m,found_y_m,error_m\n");
        for scan in &self.scans {
            for ScanPoint { truth, found } in &scan.points {
                // Writing to a `String` does not fail.
                let _ = writeln!(
                    csv,
                    "{},{:.4},{:.4},{:.4},{:.4},{:.4}",
                    scan.name,
                    truth.x,
                    truth.y,
                    found.x,
                    found.y,
                    truth.distance(*found)
                );
            }
        }
        csv
    }

    fn summary(&self) -> String {
        let mut text = String::from("error of a point load of 100 N over one tile, cm\n");
        text += "                        median     p95   worst\n";
        for scan in &self.scans {
            let _ = writeln!(text, "{:22}{}", scan.name, scan.errors());
        }
        text
    }
}

fn draw_scan(page: &mut ChartPage, area: Rect, scan: &TileSweep) {
    let geometry = Geometry::of_paper_tiles(1, 1).unwrap_or_default();
    let centimetres = |label| ChartAxis { from: 0.0, to: 30.4, tick: 5.0, label };
    let plot = Plot::draw(page, area, &capitalised(scan.name), centimetres("x, cm"), centimetres("y, cm"));
    if let Some(found) = scan.errors().summary() {
        let at = Vec2::new(area.max.x, area.max.y + 0.0022);
        let kind = Type { anchor: Anchor::End, ..Type::QUIET };
        page.text(at, kind, format_args!("median {:.2}, worst {:.2} cm", found.median_cm, found.worst_cm));
    }
    for corner in Corner::ALL {
        let at = plot.at(geometry.sensor(TileId::new(0, 0), corner) * 100.0);
        let paint = Paint::fill(Ink::faint(THEME.stance, 0.45));
        page.scene.add_box(Rect::from_centre_size(at, Vec2::splat(0.0042)), 0.0006, paint);
    }
    let seen = Stroke::new(0.0003, Ink::faint(THEME.accent, 0.55));
    for line in 0..usize::from(SIDE) {
        let row = scan.points.iter().skip(line * usize::from(SIDE)).take(SIDE.into());
        let column = scan.points.iter().skip(line).step_by(SIDE.into());
        plot.curve(page, row.map(|point| point.found * 100.0), seen);
        plot.curve(page, column.map(|point| point.found * 100.0), seen);
    }
    for point in &scan.points {
        let (truth, found) = (plot.at(point.truth * 100.0), plot.at(point.found * 100.0));
        page.ring(truth, THEME.ink);
        page.cross(found, THEME.cursor);
    }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tile_is_scanned_as_well_as_the_papers() {
        let figure = TileScan::measure(1).unwrap();
        for scan in &figure.scans {
            assert_eq!(scan.points.len(), 64, "{}", scan.name);
            let found = scan.errors().summary().unwrap();
            assert!(found.median_cm < 2.0 && found.worst_cm < 5.0, "{}: {found:?}", scan.name);
            assert!(found.median_cm > 0.05, "real parts are not exact");
        }
        let [without, with] = [0, 1].map(|which| figure.scans[which].errors().quantile(0.95).unwrap());
        assert!(with < 0.5 * without, "the map takes most of the error away: {with} of {without} m");
        assert_eq!(figure.csv().lines().count(), 1 + 64 * figure.scans.len());
    }

    #[test]
    fn an_exact_tile_is_scanned_exactly() {
        let scan =
            TileSweep { name: "exact", points: scan(Rig::ideal(Geometry::of_paper_tiles(1, 1).unwrap())) };
        assert!(scan.errors().quantile(1.0).unwrap() < 1e-4);
    }
}
