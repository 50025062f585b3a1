//! An object across a tile's edge, as measured by one tile (paper, figure 9).

use std::fmt::Write;

use glam::Vec2;

use super::chart::{ChartAxis, ChartPage, LegendSymbol, MARGIN_M, Map, Plot, THEME, Type, whole};
use super::errors::PositionErrors;
use super::figure::Figure;
use super::rig::{ExperimentError, Rig};
use underfoot::floor::{Geometry, Rect, TileId};
use underfoot::sense::Method;
use underfoot::units::Newtons;
use underfoot_scene::scene::{Anchor, Ink, Paint, Scene, Stroke};
use underfoot_sim::{Load, Print};

/// Measurement of the object at one angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeamObjectRow {
    /// Angle between the seam's normal and the object's long side, in degrees.
    pub angle_deg: f32,
    /// True centre of the load on the west tile, in metres from the midpoint of the seam.
    pub truth: Vec2,
    /// Centre of the load according to the west tile's sensors.
    pub found: Vec2,
    /// True force on the west tile.
    pub force: Newtons,
    /// Angle of the difference vector of both tiles' centroids from the seam's normal, in degrees.
    pub difference_deg: f32,
}

/// A rectangle of 10 x 24 cm with a uniform pressure of 51 N, across the seam of two tiles at several angles.
///
/// # Source
/// Paper, figure 9.
#[derive(Clone, Debug, PartialEq)]
pub struct SeamObject {
    /// One entry per angle, in order.
    pub rows: Vec<SeamObjectRow>,
}

const HALF_M: Vec2 = Vec2::new(0.05, 0.12);
const FORCE: Newtons = Newtons(51.0);
const ANGLES_DEG: [f32; 6] = [-60.0, -30.0, 0.0, 30.0, 60.0, 90.0];

impl SeamObject {
    /// Measures the object on two tiles with parts drawn from `seed`.
    ///
    /// # Errors
    /// Errors of [`Rig::of_calibrated_parts`].
    pub fn measure(seed: u64) -> Result<Self, ExperimentError> {
        let geometry = geometry();
        let mut rig = Rig::of_calibrated_parts(geometry, seed)?;
        let mut sensing = rig.sensing(Method::Eq4);
        let mut rows = Vec::new();
        for angle_deg in ANGLES_DEG {
            let load = Load {
                print: Print::Bar { half_m: HALF_M },
                position: seam_middle(),
                heading: (angle_deg - 90.0).to_radians(),
                force: FORCE,
            };
            let (mut sums, mut count) = ([Vec2::ZERO; 2], 0.0);
            rig.hold(10, &[], |frame| {
                sensing.update(frame);
            });
            rig.hold(50, &[load], |frame| {
                for load in sensing.update(frame).first().iter().flat_map(|contact| &contact.tiles) {
                    sums[usize::from(load.tile.column == 1)] += load.centroid;
                    count += 0.5;
                }
            });
            let [west, east] = sums.map(|sum| sum / count - seam_middle());
            let carried = load.on_tiles(&geometry);
            let Some(truth) = carried.iter().find(|load| load.tile == TileId::new(0, 0)) else { continue };
            rows.push(SeamObjectRow {
                angle_deg,
                truth: truth.centroid - seam_middle(),
                found: west,
                force: truth.force,
                difference_deg: (east - west).to_angle().to_degrees(),
            });
        }
        Ok(Self { rows })
    }
}

fn geometry() -> Geometry {
    Geometry::of_paper_tiles(2, 1).unwrap_or_default()
}

fn seam_middle() -> Vec2 {
    Vec2::new(1.0, 0.5) * geometry().pitch_m()
}

/// Corners of the object, in metres from the midpoint of the seam.
fn corners(angle_deg: f32) -> [Vec2; 4] {
    let turn = Vec2::from_angle((angle_deg - 90.0).to_radians());
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|corner| turn.rotate(Vec2::from(corner) * HALF_M))
}

impl Figure for SeamObject {
    fn draw(&self) -> Scene {
        let mut page = ChartPage::new(
            Vec2::new(0.234, 0.141),
            "An object over the seam of two tiles",
            "10 × 24 cm, pressing evenly with 51 N; what the west tile's four sensors make of their part, at six angles",
        );
        let (cell, left, top) = (Vec2::new(0.044, 0.044), MARGIN_M, 0.1165);
        for (which, row) in self.rows.iter().enumerate() {
            let (column, line) = ((which % 3) as f32, (which / 3) as f32);
            let corner = Vec2::new(left + column * (cell.x + 0.005), top - (line + 1.0) * (cell.y + 0.0055));
            draw_object(&mut page, Rect::from_min_size(corner, cell), row);
        }
        let area = Rect::new(Vec2::new(0.172, 0.0265), Vec2::new(0.226, 0.111));
        let plot = Plot::draw(
            &mut page,
            area,
            "Centroids on the west tile, cm",
            ChartAxis { from: -8.0, to: 0.0, tick: 2.0, label: "from the seam" },
            ChartAxis { from: -6.0, to: 6.0, tick: 2.0, label: "along the seam" },
        );
        for row in &self.rows {
            let (truth, found) = (plot.at(row.truth * 100.0), plot.at(row.found * 100.0));
            page.line(truth, found, Stroke::new(0.0003, Ink::faint(THEME.accent, 0.7)));
            page.ring(truth, THEME.ink);
            page.cross(found, THEME.cursor);
            let beside = Vec2::new(truth.x.max(found.x) + 0.0028, truth.y - 0.001);
            page.text(beside, Type::QUIET, format_args!("{}°", whole(row.angle_deg)));
        }
        page.legend(
            Vec2::new(MARGIN_M, 0.0055),
            &[
                (LegendSymbol::Dashes, THEME.stance, "object"),
                (LegendSymbol::Ring, THEME.ink, "true centroid of the west part"),
                (LegendSymbol::Cross, THEME.cursor, "estimated"),
            ],
        );
        page.scene
    }

    fn csv(&self) -> String {
        let mut csv = String::from(
            "angle_deg,force_n,true_x_m,true_y_m,found_x_m,found_y_m,error_m,difference_vector_deg\n",
        );
        for row in &self.rows {
            let SeamObjectRow { angle_deg, truth, found, force, difference_deg } = row;
            // Writing to a `String` does not fail.
            let _ = writeln!(
                csv,
                "{angle_deg:.0},{:.2},{:.4},{:.4},{:.4},{:.4},{:.4},{difference_deg:.2}",
                force.0,
                truth.x,
                truth.y,
                found.x,
                found.y,
                truth.distance(*found)
            );
        }
        csv
    }

    fn summary(&self) -> String {
        let mut errors = PositionErrors::default();
        let mut text = String::from(
            "centroid of the west tile under an object of 51 N over the seam, cm from the seam's middle\n\
             angle     true x       y   found x       y     error   difference vector\n",
        );
        for row in &self.rows {
            let [truth, found] = [row.truth, row.found].map(|point| point * 100.0);
            errors.push(row.truth.distance(row.found));
            let _ = writeln!(
                text,
                "{:4.0}°  {:9.2}{:8.2}{:10.2}{:8.2}{:10.2}{:14.1}°",
                row.angle_deg,
                truth.x,
                truth.y,
                found.x,
                found.y,
                truth.distance(found),
                row.difference_deg
            );
        }
        let _ = writeln!(text, "median, 95th percentile and worst error, cm: {errors}");
        text
    }
}

/// Draws the two tiles around the seam with the object on them.
fn draw_object(page: &mut ChartPage, area: Rect, row: &SeamObjectRow) {
    let map = Map::new(Rect::from_centre_size(Vec2::ZERO, Vec2::splat(0.30)), area);
    page.scene.add_box(area, 0.0, Paint::fill(Ink::solid(THEME.plate)));
    let seam = Stroke::new(0.0004, Ink::solid(THEME.stance));
    page.line(map.at(Vec2::new(0.0, -0.15)), map.at(Vec2::new(0.0, 0.15)), seam);
    let edge = Stroke::new(0.0004, Ink::solid(THEME.stance)).dashed(0.0012, 0.0009);
    map.outline(page, corners(row.angle_deg), Paint::fill(Ink::faint(THEME.load, 0.25)).with_stroke(edge));
    page.ring(map.at(row.truth), THEME.ink);
    page.cross(map.at(row.found), THEME.cursor);
    let at = Vec2::new(area.min.x, area.max.y + 0.0015);
    page.text(at, Type::PLAIN, format_args!("{}°", whole(row.angle_deg)));
    let kind = Type { anchor: Anchor::End, ..Type::QUIET };
    let error = row.truth.distance(row.found) * 100.0;
    page.text(Vec2::new(area.max.x, at.y), kind, format_args!("{error:.2} cm off"));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_west_part_is_found_as_well_as_the_papers_was() {
        let figure = SeamObject::measure(1).unwrap();
        assert_eq!(figure.rows.len(), ANGLES_DEG.len());
        for row in &figure.rows {
            assert!((row.force.0 - 25.5).abs() < 0.5, "half of it lies on the west tile: {:?}", row.force);
            assert!(row.truth.x < 0.0 && row.truth.distance(row.found) < 0.05, "{row:?}");
        }
        // The sign shows the direction in which the object leans, as in the paper.
        let [south, north] = [1, 3].map(|which| figure.rows[which].difference_deg);
        assert!(south < -5.0 && north > 5.0, "{south}, {north}");
        assert_eq!(figure.csv().lines().count(), 1 + ANGLES_DEG.len());
    }
}
