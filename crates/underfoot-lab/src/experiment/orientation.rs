//! Direction of a contact from the difference vector of two tiles' centroids (paper, figure 7).

use std::fmt::Write;

use glam::Vec2;

use super::chart::{ChartAxis, ChartPage, LINE_M, LegendSymbol, MARGIN_M, Map, Plot, THEME, Type, whole};
use super::figure::Figure;
use super::rig::{ExperimentError, Rig};
use underfoot::floor::{Geometry, Rect};
use underfoot::layout::Colour;
use underfoot::sense::{Contact, Method};
use underfoot::units::Newtons;
use underfoot_scene::scene::{Ink, Paint, Scene, Stroke};
use underfoot_sim::{Load, Print};

/// A contact across a seam.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SeamContact {
    name: &'static str,
    print: Print,
    /// Half of the width and half of the length, in metres.
    half: Vec2,
    round: bool,
}

const HALF_LENGTH_M: f32 = 0.11;

const SEAM_CONTACTS: [SeamContact; 4] = [
    SeamContact::bar("line", 0.004),
    SeamContact::ellipse("ellipse 1 : 3", HALF_LENGTH_M / 3.0),
    SeamContact::ellipse("ellipse 2 : 3", HALF_LENGTH_M / 1.5),
    SeamContact::ellipse("disc", HALF_LENGTH_M),
];

impl SeamContact {
    const fn bar(name: &'static str, half_width: f32) -> Self {
        let half = Vec2::new(half_width, HALF_LENGTH_M);
        Self { name, print: Print::Bar { half_m: half }, half, round: false }
    }

    const fn ellipse(name: &'static str, half_width: f32) -> Self {
        let half = Vec2::new(half_width, HALF_LENGTH_M);
        Self { name, print: Print::Ellipse { half_m: half }, half, round: true }
    }

    /// Angle between the seam's normal and the difference vector of a uniform load, in degrees.
    ///
    /// # Source
    /// A cut through the centre of an ellipse gives halves with centroids on the diameter conjugate to the cut: tan =
    /// (a² - b²) sin θ cos θ / (a² cos² θ + b² sin² θ). For the line, b is zero.
    fn expected(self, angle_deg: f32) -> f32 {
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        let (long, wide) = (self.half.y.powi(2), if self.round { self.half.x.powi(2) } else { 0.0 });
        ((long - wide) * sin * cos).atan2(long * cos * cos + wide * sin * sin).to_degrees()
    }

    /// Outline around `middle`.
    fn outline(self, middle: Vec2, angle_deg: f32) -> Vec<Vec2> {
        let turn = Vec2::from_angle((angle_deg - 90.0).to_radians());
        let around = |point: Vec2| middle + turn.rotate(point * self.half);
        if self.round {
            (0..64_u16).map(|step| around(Vec2::from_angle(f32::from(step) * 0.098_174_77))).collect()
        } else {
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(Vec2::from).map(around).to_vec()
        }
    }
}

/// Measurement of one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientationRow {
    /// Shape of the contact.
    shape: SeamContact,
    /// True for sensors without error.
    pub exact: bool,
    /// Angle between the seam's normal and the shape's long axis, in degrees.
    pub true_deg: f32,
    /// Expected angle of the difference vector, in degrees.
    pub expected_deg: f32,
    /// Measured angle of the difference vector, in degrees.
    pub measured_deg: f32,
    /// Centroids of the west and the east tile, in floor metres.
    pub centroids: [Vec2; 2],
}

impl OrientationRow {
    /// Returns the name of the shape.
    #[must_use]
    pub const fn shape(&self) -> &'static str {
        self.shape.name
    }
}

/// Lines, ellipses and a disc across a seam at angles of 0 to 85 degrees, on an exact floor and on a floor of
/// calibrated parts.
///
/// # Source
/// Paper, figure 7: for a line the difference vector points along it, for a disc along the seam's normal. For other
/// contacts it turns towards the normal, more so for rounder ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Orientation {
    /// Sorted by shape, then floor, then angle.
    pub rows: Vec<OrientationRow>,
}

/// Force of each shape.
const FORCE: Newtons = Newtons(200.0);

impl Orientation {
    /// Measures all shapes; `seed` determines the parts of the inexact floor.
    ///
    /// # Errors
    /// Errors of [`Rig::of_calibrated_parts`].
    pub fn measure(seed: u64) -> Result<Self, ExperimentError> {
        let geometry = Geometry::of_paper_tiles(2, 1).unwrap_or_default();
        let mut rows = Vec::new();
        for shape in SEAM_CONTACTS {
            for exact in [true, false] {
                let mut rig =
                    if exact { Rig::ideal(geometry) } else { Rig::of_calibrated_parts(geometry, seed)? };
                let mut sensing = rig.sensing(Method::Eq4);
                for step in 0..=17_u16 {
                    let true_deg = f32::from(step) * 5.0;
                    let position = seam_middle(&geometry);
                    let heading = (true_deg - 90.0).to_radians();
                    let load = Load { print: shape.print, position, heading, force: FORCE };
                    rig.hold(10, &[], |frame| {
                        sensing.update(frame);
                    });
                    rig.hold(20, &[load], |frame| {
                        sensing.update(frame);
                    });
                    let Some(centroids) = sensing.contacts().first().and_then(west_and_east) else {
                        continue;
                    };
                    let difference = centroids[1] - centroids[0];
                    rows.push(OrientationRow {
                        shape,
                        exact,
                        true_deg,
                        expected_deg: shape.expected(true_deg),
                        measured_deg: difference.to_angle().to_degrees(),
                        centroids,
                    });
                }
            }
        }
        Ok(Self { rows })
    }

    fn of(&self, shape: SeamContact, exact: bool) -> impl Iterator<Item = &OrientationRow> {
        self.rows.iter().filter(move |row| row.shape.name == shape.name && row.exact == exact)
    }

    /// Maximum deviation of the measured angles from the expected ones, in degrees.
    fn worst(&self, shape: SeamContact, exact: bool) -> f32 {
        self.of(shape, exact).map(|row| (row.measured_deg - row.expected_deg).abs()).fold(0.0, f32::max)
    }
}

/// Midpoint of the seam between two tiles.
fn seam_middle(geometry: &Geometry) -> Vec2 {
    Vec2::new(1.0, 0.5) * geometry.pitch_m()
}

fn west_and_east(contact: &Contact) -> Option<[Vec2; 2]> {
    let on = |column| contact.tiles.iter().find(|load| load.tile.column == column).map(|load| load.centroid);
    Some([on(0)?, on(1)?])
}

/// One colour per shape.
const COLOURS: [Colour; 4] = [THEME.cursor, THEME.accent, THEME.good, THEME.warning];

impl Figure for Orientation {
    fn draw(&self) -> Scene {
        let mut page = ChartPage::new(
            Vec2::new(0.256, 0.143),
            "Which way a contact points",
            "Difference of two tiles' centroids (arrows) for contacts of 200 N across a seam, on calibrated parts; \
             the rounder the contact, the more it leans to the seam's normal",
        );
        let (cell, left, top) = (Vec2::new(0.0215, 0.0245), MARGIN_M + 0.0235, 0.1135);
        for (line, shape) in SEAM_CONTACTS.into_iter().enumerate() {
            let y = top - (line + 1) as f32 * cell.y;
            let name = Type { strong: true, colour: COLOURS[line], ..Type::PLAIN };
            page.text(Vec2::new(MARGIN_M, y + 0.5 * cell.y - 0.001), name, format_args!("{}", shape.name));
            let drawn = self.of(shape, false).filter(|row| row.true_deg % 15.0 < 0.1 && row.true_deg < 80.0);
            for (column, row) in drawn.enumerate() {
                let corner = Vec2::new(left + column as f32 * cell.x, y);
                if line == 0 {
                    let at = corner + Vec2::new(0.5 * cell.x, cell.y + 0.0015);
                    page.text(at, Type::QUIET.middle(), format_args!("{}°", whole(row.true_deg)));
                }
                draw_cell(&mut page, Rect::from_min_size(corner, cell - 0.0012), row, COLOURS[line]);
            }
        }
        let area = Rect::new(Vec2::new(0.182, 0.0265), Vec2::new(0.248, 0.1135));
        let axis = |label| ChartAxis { from: 0.0, to: 90.0, tick: 15.0, label };
        let title = "Angle from the seam's normal, degrees";
        let plot =
            Plot::draw(&mut page, area, title, axis("of the contact"), axis("of the difference vector"));
        for (shape, colour) in SEAM_CONTACTS.into_iter().zip(COLOURS) {
            let expected = (0..=85).map(|deg| Vec2::new(deg as f32, shape.expected(deg as f32)));
            plot.curve(&mut page, expected, Stroke::new(LINE_M, Ink::faint(colour, 0.55)));
            // At 0 degrees all vectors point along the normal, and their marks would cover the axes.
            for row in self.of(shape, true).filter(|row| row.true_deg > 0.0) {
                page.dot(plot.at(Vec2::new(row.true_deg, row.measured_deg)), colour);
            }
            for row in self.of(shape, false).filter(|row| row.true_deg > 0.0 && row.measured_deg >= 0.0) {
                page.cross(plot.at(Vec2::new(row.true_deg, row.measured_deg)), colour);
            }
        }
        page.legend(
            Vec2::new(MARGIN_M, 0.0055),
            &[
                (LegendSymbol::Arrow, THEME.ink, "difference vector"),
                (LegendSymbol::Dashes, THEME.quiet, "long axis"),
                (LegendSymbol::Line, THEME.quiet, "theory"),
                (LegendSymbol::Dot, THEME.quiet, "exact floor"),
                (LegendSymbol::Cross, THEME.quiet, "calibrated parts"),
            ],
        );
        page.scene
    }

    fn csv(&self) -> String {
        let mut csv = String::from(
            "shape,floor,true_deg,expected_deg,measured_deg,west_x_m,west_y_m,east_x_m,east_y_m\n",
        );
        for row in &self.rows {
            let [west, east] = row.centroids;
            let floor = if row.exact { "exact" } else { "calibrated" };
            // Writing to a `String` does not fail.
            let _ = writeln!(
                csv,
                "{},{floor},{:.1},{:.2},{:.2},{:.4},{:.4},{:.4},{:.4}",
                row.shape.name,
                row.true_deg,
                row.expected_deg,
                row.measured_deg,
                west.x,
                west.y,
                east.x,
                east.y
            );
        }
        csv
    }

    fn summary(&self) -> String {
        let mut text = String::from(
            "angle of the difference vector from the seam's normal, degrees (theory / exact floor / calibrated parts)\n\
             contact at         15                30                45                60                75     worst\n",
        );
        for shape in SEAM_CONTACTS {
            let _ = write!(text, "{:14}", shape.name);
            for deg in [15.0_f32, 30.0, 45.0, 60.0, 75.0] {
                let at = |exact| {
                    self.of(shape, exact)
                        .find(|row| (row.true_deg - deg).abs() < 0.1)
                        .map_or(f32::NAN, |row| row.measured_deg)
                };
                let _ = write!(text, " {:5.1}{:6.1}{:6.1}", shape.expected(deg), at(true), at(false));
            }
            let _ = writeln!(text, "{:10.1}", self.worst(shape, false));
        }
        text
    }
}

/// Draws one contact over a seam with its two centroids and the vector between them.
fn draw_cell(page: &mut ChartPage, area: Rect, row: &OrientationRow, colour: Colour) {
    let geometry = Geometry::of_paper_tiles(2, 1).unwrap_or_default();
    let middle = seam_middle(&geometry);
    let map = Map::new(Rect::from_centre_size(middle, area.size() * (0.25 / area.size().x)), area);
    page.scene.add_box(area, 0.0, Paint::fill(Ink::solid(THEME.plate)));
    let (south, north) = (Vec2::new(middle.x, map.floor.min.y), Vec2::new(middle.x, map.floor.max.y));
    page.line(map.at(south), map.at(north), Stroke::new(0.0003, Ink::solid(THEME.stance)));
    let edge = Stroke::new(0.0003, Ink::faint(colour, 0.8));
    let paint = Paint::fill(Ink::faint(colour, 0.22)).with_stroke(edge);
    map.outline(page, row.shape.outline(middle, row.true_deg), paint);
    if row.shape.half.x < row.shape.half.y {
        let along = Vec2::from_angle(row.true_deg.to_radians()) * (HALF_LENGTH_M + 0.008);
        let dashes = Stroke::new(0.0003, Ink::faint(THEME.quiet, 0.9)).dashed(0.0008, 0.0009);
        page.line(map.at(middle - along), map.at(middle + along), dashes);
    }
    page.arrow(map.at(row.centroids[0]), map.at(row.centroids[1]), THEME.ink);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exact_floor_sees_the_angles_that_geometry_gives() {
        let figure = Orientation::measure(1).unwrap();
        assert_eq!(figure.rows.len(), 4 * 2 * 18);
        for shape in SEAM_CONTACTS {
            // Prints consist of half-centimetre cells, and a tile's lever is half a degree at most.
            assert!(figure.worst(shape, true) < 2.5, "{}: {}", shape.name, figure.worst(shape, true));
        }
        // A line gives its own direction, a disc the normal, and an ellipse an angle in between.
        let at_45 = SEAM_CONTACTS.map(|shape| shape.expected(45.0));
        assert!((at_45[0] - 45.0).abs() < 1e-3 && at_45[3].abs() < 1e-3, "{at_45:?}");
        assert!(at_45[0] > at_45[1] && at_45[1] > at_45[2] && at_45[2] > at_45[3]);
    }

    #[test]
    fn the_table_has_a_line_per_measurement() {
        let figure = Orientation::measure(2).unwrap();
        assert_eq!(figure.csv().lines().count(), figure.rows.len() + 1);
        assert!(figure.draw().marks().len() > 300);
        assert!(figure.summary().contains("disc"));
    }
}
