//! Two feet on four tiles, before and after their separation (paper, figure 11).

use std::f32::consts::TAU;
use std::fmt::Write;

use glam::Vec2;

use super::chart::{ChartPage, LegendSymbol, MARGIN_M, Map, THEME, Type};
use super::figure::Figure;
use super::rig::{ExperimentError, Rig};
use underfoot::floor::{Corner, Geometry, Rect, TileId};
use underfoot::layout::Colour;
use underfoot::sense::{Contact, Covariance, ForceFrame, Method};
use underfoot::units::Newtons;
use underfoot_scene::scene::{Ink, Paint, Scene, Stroke, sole};
use underfoot_sim::{Foot, shoe_size};

/// Two feet on 2 x 2 tiles, some 20 cm apart: the left one lands first, the right one half a second later.
///
/// # Source
/// Paper, figure 11: tile centroids describe feet badly if two feet share tiles.
#[derive(Clone, Debug, PartialEq)]
pub struct TwoFeet {
    /// The standing feet, left first.
    pub feet: [Foot; 2],
    /// Newtons per tile in tile-index order, each in [`Corner::ALL`] order.
    pub forces: Vec<[f32; 4]>,
    /// Force and centroid of each loaded tile.
    pub tiles: Vec<(TileId, Newtons, Vec2)>,
    /// Contacts according to Eq. 4.
    pub eq4: Vec<Contact>,
    /// Contacts according to the tracker.
    pub tracker: Vec<Contact>,
}

impl TwoFeet {
    /// Measures both feet on four tiles with parts drawn from `seed`.
    ///
    /// # Errors
    /// Errors of [`Rig::of_calibrated_parts`].
    pub fn measure(seed: u64) -> Result<Self, ExperimentError> {
        let geometry = geometry();
        let mut rig = Rig::of_calibrated_parts(geometry, seed)?;
        let [mut eq4, mut tracker] = [Method::Eq4, Method::Tracker].map(|method| rig.sensing(method));
        let mut last = ForceFrame::empty(&geometry);
        for milli in 0..LENGTH_MS {
            let feet = feet(milli as f32);
            rig.step(feet.iter().map(Foot::as_load), |frame| {
                eq4.update(frame);
                tracker.update(frame);
                last.clone_from(frame);
            });
        }
        let readings = geometry.tiles().zip(eq4.tiles());
        Ok(Self {
            feet: feet(LENGTH_MS as f32),
            tiles: readings.filter_map(|(tile, felt)| Some((tile, felt.force, felt.centroid?))).collect(),
            forces: last.forces,
            eq4: eq4.contacts().to_vec(),
            tracker: tracker.contacts().to_vec(),
        })
    }
}

fn geometry() -> Geometry {
    Geometry::of_paper_tiles(2, 2).unwrap_or_default()
}

/// Duration of the simulation (ms): both feet are at rest at its end.
const LENGTH_MS: u32 = 1600;

/// The feet after `milli` milliseconds, left first.
fn feet(milli: f32) -> [Foot; 2] {
    let down = |from: f32| ((milli - from) / 200.0).clamp(0.0, 1.0);
    let (first, second) = (down(50.0), down(550.0));
    let foot = |x: f32, y: f32, heading, force, roll, left| Foot {
        position: Vec2::new(x, y),
        heading,
        length_m: 0.26,
        force: Newtons(force),
        roll,
        left,
    };
    // The whole weight of 690 N is on the left foot until the right one takes its share.
    [
        foot(0.165, 0.335, 0.12, 690.0 * first - 320.0 * second, 0.42, true),
        foot(0.352, 0.285, -0.20, 320.0 * second, 0.40, false),
    ]
}

impl Figure for TwoFeet {
    fn draw(&self) -> Scene {
        let side = 0.104;
        let mut page = ChartPage::new(
            Vec2::new(2.0 * side + 3.0 * MARGIN_M, side + 0.046),
            "Two feet on four tiles",
            "A person of 690 N; each foot stands on two or more tiles, and tiles carry parts of both",
        );
        let south = 0.0150;
        let places = [MARGIN_M, 2.0 * MARGIN_M + side].map(|x| Vec2::new(x, south));
        let titles = ["Before: sensor forces in newtons, and Eq. 4", "After: resolved feet, 95 % ellipses"];
        for (panel, (corner, title)) in places.into_iter().zip(titles).enumerate() {
            let area = Rect::from_min_size(corner, Vec2::splat(side));
            let map = Map::new(geometry().bounds(), area);
            let at = Vec2::new(area.min.x, area.max.y + 0.0022);
            page.text(at, Type { strong: true, ..Type::PLAIN }, format_args!("{title}"));
            self.draw_floor(&mut page, &map);
            if panel == 0 { self.draw_before(&mut page, &map) } else { self.draw_after(&mut page, &map) }
        }
        page.legend(
            Vec2::new(MARGIN_M, 0.0055),
            &[
                (LegendSymbol::Ring, THEME.ink, "true centre of pressure"),
                (LegendSymbol::Cross, THEME.contact, "centroid of one tile"),
                (LegendSymbol::Cross, THEME.warning, "contact by Eq. 4"),
                (LegendSymbol::Cross, THEME.cursor, "resolved foot"),
            ],
        );
        page.scene
    }

    fn csv(&self) -> String {
        let mut csv = String::from("what,column,row,force_n,x_m,y_m,f_sw,f_se,f_nw,f_ne\n");
        // Writing to a `String` does not fail.
        for (tile, force, at) in &self.tiles {
            let sensors = geometry().index(*tile).and_then(|index| self.forces.get(index));
            let [sw, se, nw, ne] = sensors.copied().unwrap_or_default();
            let TileId { column, row } = tile;
            let _ = writeln!(
                csv,
                "tile,{column},{row},{:.1},{:.4},{:.4},{sw:.1},{se:.1},{nw:.1},{ne:.1}",
                force.0, at.x, at.y
            );
        }
        let feet = self.feet.iter().map(|foot| ("true foot", foot.force, foot.centre_of_pressure()));
        let eq4 = self.eq4.iter().map(|contact| ("Eq. 4", contact.force, contact.centroid));
        let tracker = self.tracker.iter().map(|contact| ("tracker", contact.force, contact.centroid));
        for (what, force, at) in feet.chain(eq4).chain(tracker) {
            let _ = writeln!(csv, "{what},,,{:.1},{:.4},{:.4},,,,", force.0, at.x, at.y);
        }
        csv
    }

    fn summary(&self) -> String {
        let mut text =
            String::from("distance from each foot's centre of pressure to the nearest contact, cm\n");
        for (name, contacts) in [("Eq. 4", &self.eq4), ("tracker", &self.tracker)] {
            let _ = write!(text, "{name:8} {} contacts:", contacts.len());
            for foot in &self.feet {
                let _ = write!(text, " {:6.2}", 100.0 * nearest(foot, contacts));
            }
            text.push('\n');
        }
        text
    }
}

/// Distance from a foot to the nearest contact, in metres; infinite without contacts.
fn nearest(foot: &Foot, contacts: &[Contact]) -> f32 {
    let centre = foot.centre_of_pressure();
    contacts.iter().map(|contact| contact.centroid.distance(centre)).fold(f32::INFINITY, f32::min)
}

impl TwoFeet {
    fn draw_floor(&self, page: &mut ChartPage, map: &Map) {
        let geometry = geometry();
        page.scene.add_box(map.area(), 0.0, Paint::fill(Ink::solid(THEME.seam)));
        for tile in geometry.tiles() {
            let plate = map.rect(geometry.plate(tile)).grown(-0.0003);
            page.scene.add_box(plate, 0.0006, Paint::fill(Ink::solid(THEME.plate)));
        }
        let edge = Stroke::new(0.0003, Ink::faint(THEME.shoe, 0.7));
        let paint = Paint::fill(Ink::faint(THEME.shoe, 0.13)).with_stroke(edge);
        for (foot, left) in self.feet.iter().zip([true, false]) {
            let length = shoe_size(foot.length_m).y;
            map.outline(page, sole(foot.position, foot.heading, length, left), paint);
        }
    }

    fn draw_before(&self, page: &mut ChartPage, map: &Map) {
        let geometry = geometry();
        for (tile, forces) in geometry.tiles().zip(&self.forces) {
            for (corner, force) in Corner::ALL.into_iter().zip(forces) {
                let at = map.at(geometry.sensor(tile, corner));
                let dot = Paint::fill(Ink::faint(THEME.contact, 0.55));
                page.scene.add_circle(at, 0.0006 + 0.00014 * force.max(0.0).sqrt(), dot);
                // The number is on the side of its sensor towards the tile's centre.
                let offset = Vec2::new(0.0, -corner.direction().y * 0.0044 - 0.0010);
                // The badge keeps it readable over a shoe's outline.
                let middle = at + offset + Vec2::new(0.0, 0.0010);
                page.scene.add_badge(middle, 0.0024, Ink::solid(THEME.ink), HALO, format_args!("{force:.0}"));
            }
        }
        for (_, force, at) in &self.tiles {
            let at = map.at(*at);
            page.cross(at, THEME.contact);
            let ink = Ink::solid(THEME.contact);
            page.scene.add_badge(
                at + Vec2::new(0.0064, 0.0),
                0.0024,
                ink,
                HALO,
                format_args!("{:.0} N", force.0),
            );
        }
        self.draw_truth(page, map);
        for contact in &self.eq4 {
            draw_contact(page, map, contact, THEME.warning, BADGE_M);
        }
    }

    fn draw_after(&self, page: &mut ChartPage, map: &Map) {
        self.draw_truth(page, map);
        for contact in &self.tracker {
            draw_contact(page, map, contact, THEME.cursor, -BADGE_M);
        }
    }

    fn draw_truth(&self, page: &mut ChartPage, map: &Map) {
        for foot in &self.feet {
            page.ring(map.at(foot.centre_of_pressure()), THEME.ink);
        }
    }
}

/// Background of numbers.
const HALO: Paint = Paint { fill: Some(Ink::faint(THEME.plate, 0.75)), stroke: None };

/// Draws the 95 % ellipse of a contact, a cross, and its force on a badge `badge` page metres north of it.
fn draw_contact(page: &mut ChartPage, map: &Map, contact: &Contact, colour: Colour, badge: f32) {
    let edge = Stroke::new(0.0003, Ink::solid(colour));
    let paint = Paint::fill(Ink::faint(colour, 0.12)).with_stroke(edge);
    // The ellipse of an ambiguous contact may extend beyond the floor.
    let ellipse = within(map.floor, ellipse_95(contact.centroid, contact.covariance).collect());
    map.outline(page, ellipse, paint);
    let at = map.at(contact.centroid);
    let badge_at = at + Vec2::new(0.0, badge);
    page.line(at, badge_at, Stroke::new(0.0003, Ink::faint(colour, 0.7)));
    page.cross(at, colour);
    let plate =
        Paint::fill(Ink::faint(THEME.plate, 0.94)).with_stroke(Stroke::new(0.0003, Ink::solid(colour)));
    page.scene.add_badge(
        badge_at,
        0.0030,
        Ink::solid(colour),
        plate,
        format_args!("{:.0} N", contact.force.0),
    );
}

/// Distance between a contact and its badge (page metres): clear of the sensors along the seam.
const BADGE_M: f32 = 0.0110;

/// Clips a convex outline to `area`.
fn within(area: Rect, outline: Vec<Vec2>) -> Vec<Vec2> {
    // Clips by one side after the other; each function returns the distance of a point inside that side.
    let sides: [fn(Rect, Vec2) -> f32; 4] = [
        |area, point| point.x - area.min.x,
        |area, point| area.max.x - point.x,
        |area, point| point.y - area.min.y,
        |area, point| area.max.y - point.y,
    ];
    sides.into_iter().fold(outline, |outline, inside| {
        let mut kept = Vec::with_capacity(outline.len() + 2);
        for (&from, &to) in outline.iter().zip(outline.iter().cycle().skip(1)) {
            let (start, end) = (inside(area, from), inside(area, to));
            if start >= 0.0 {
                kept.push(from);
            }
            if (start >= 0.0) != (end >= 0.0) {
                kept.push(from.lerp(to, start / (start - end)));
            }
        }
        kept
    })
}

/// Points on the ellipse that contains the true point with a probability of 95 %.
fn ellipse_95(middle: Vec2, covariance: Covariance) -> impl Iterator<Item = Vec2> {
    let (long, short) = covariance.ellipse_95_m();
    let turn = 0.5 * (2.0 * covariance.xy).atan2(covariance.xx - covariance.yy);
    (0..120_u16).map(move |step| {
        let around = Vec2::from_angle(f32::from(step) / 120.0 * TAU) * Vec2::new(long, short);
        middle + Vec2::from_angle(turn).rotate(around)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eq4_puts_one_contact_between_the_feet_and_the_tracker_two_where_they_are() {
        for seed in 1..=5 {
            let figure = TwoFeet::measure(seed).unwrap();
            assert_eq!(figure.eq4.len(), 1);
            assert!(figure.feet.iter().all(|foot| nearest(foot, &figure.eq4) > 0.05));
            assert_eq!(figure.tracker.len(), 2, "seed {seed}");
            for foot in &figure.feet {
                assert!(nearest(foot, &figure.tracker) < 0.05, "seed {seed}: {}", figure.summary());
            }
            assert!(figure.tiles.len() >= 3);
        }
    }

    #[test]
    fn outlines_are_cut_at_the_floor_s_edge() {
        let area = Rect::new(Vec2::ZERO, Vec2::ONE);
        let diamond = [(0.5, -0.5), (1.5, 0.5), (0.5, 1.5), (-0.5, 0.5)].map(Vec2::from).to_vec();
        let cut = within(area, diamond);
        assert!(cut.iter().all(|point| area.grown(1e-6).contains(*point)), "{cut:?}");
        let inner = [(0.2, 0.2), (0.8, 0.2), (0.5, 0.9)].map(Vec2::from).to_vec();
        assert_eq!(within(area, inner.clone()), inner);
        assert!(within(area, vec![Vec2::splat(2.0), Vec2::splat(3.0), Vec2::new(2.0, 3.0)]).is_empty());
    }

    #[test]
    fn an_ellipse_holds_what_its_covariance_says() {
        let covariance = Covariance { xx: 4e-4, xy: 3e-4, yy: 4e-4 };
        for point in ellipse_95(Vec2::ONE, covariance) {
            let distance = covariance.mahalanobis_squared(point - Vec2::ONE);
            assert!((distance - 5.991).abs() < 0.02, "{distance}");
        }
    }
}
