//! From force frames to contacts, by either method.

use std::time::Duration;

use super::centroid::cluster::Clusters;
use super::centroid::eq4::Eq4;
use super::centroid::tile::TileReading;
use super::centroid::uncertainty::SensorUncertainty;
use super::contact::pool::ContactPool;
use super::loaded::{LoadThreshold, LoadedTiles};
use super::track::Tracker;
use super::{Contact, ForceFrame};
use crate::floor::{Geometry, PositionMap};
use crate::parallel;
use crate::units::Instant;

/// Method that derives contacts from tile forces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The paper's own: one contact per group of connected tiles (Eq. 4).
    Eq4,
    /// Feet tracked over time, several in one group of tiles.
    #[default]
    Tracker,
}

/// Assumptions about the floor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SensingConfig {
    /// Force above which a tile counts as loaded.
    pub threshold: LoadThreshold,
    /// Uncertainty of the sensors.
    pub uncertainty: SensorUncertainty,
}

/// Converts force frames to contacts, one frame at a time.
///
/// The same frames always give bit-identical contacts.
#[derive(Clone, Debug)]
pub struct Sensing {
    tiles: LoadedTiles,
    maker: Maker,
    pool: ContactPool,
    last: Option<Instant>,
}

/// The method's state.
#[derive(Clone, Debug)]
enum Maker {
    Eq4(Box<Clusters>, Box<Eq4>),
    Tracker(Box<Tracker>),
}

impl Sensing {
    /// Sensing on an empty floor of this geometry.
    #[must_use]
    pub fn new(geometry: Geometry, method: Method) -> Self {
        Self::with_config(geometry, method, SensingConfig::default())
    }

    /// Like [`Sensing::new`], with other assumptions about the floor.
    #[must_use]
    pub fn with_config(geometry: Geometry, method: Method, config: SensingConfig) -> Self {
        let tiles = geometry.tile_count();
        Self {
            tiles: LoadedTiles::new(geometry, config.threshold),
            maker: match method {
                Method::Eq4 => Maker::Eq4(
                    Box::new(Clusters::new(&geometry)),
                    Box::new(Eq4::new(tiles, config.uncertainty)),
                ),
                Method::Tracker => Maker::Tracker(Box::new(Tracker::new(&geometry, config.uncertainty))),
            },
            pool: ContactPool::with_capacity(64),
            last: None,
        }
    }

    /// Corrects each tile by its map; in tile-index order, tiles past the end have none.
    #[must_use]
    pub fn with_maps(mut self, maps: &[Option<PositionMap>]) -> Self {
        self.tiles.set_maps(maps);
        self
    }

    /// Learns the noise of each tile from the first frames of a table, before the first [`Self::update`]: a floor in use
    /// learns it before the first foot. A tile whose readings the frames lack while it is idle takes the median of the
    /// others. Frames in which no idle tile has a reading teach nothing.
    pub fn learn_noise(&mut self, frames: &[ForceFrame]) {
        self.tiles.learn_noise(frames);
    }

    /// The contacts after `frame`, ordered by id.
    ///
    /// Frames count at their own times; for one that is no later than the last, no time passes. A frame of another
    /// floor's size is read up to the smaller of both sizes.
    ///
    /// # Real-time
    /// Allocates nothing once the floor has been at its fullest.
    pub fn update(&mut self, frame: &ForceFrame) -> &[Contact] {
        let dt = self.last.map_or(0.0, |last| seconds(frame.at.since(last)));
        self.last = Some(frame.at);
        let Self { tiles, maker, pool, .. } = self;
        match maker {
            Maker::Eq4(clusters, eq4) => {
                tiles.update(frame);
                clusters.update(tiles);
                eq4.update(tiles, clusters, dt, pool);
            }
            // The helper threads wake while the loaded tiles are found.
            Maker::Tracker(tracker) => parallel::with_pool_awake(tracker.feet(), || {
                tiles.update(frame);
                tracker.update(tiles, dt, pool);
            }),
        }
        self.pool.contacts()
    }

    /// The contacts after the last frame, ordered by id.
    #[must_use]
    pub fn contacts(&self) -> &[Contact] {
        self.pool.contacts()
    }

    /// The reading of each tile in the last frame, in tile-index order.
    pub fn tiles(&self) -> impl ExactSizeIterator<Item = TileReading> + '_ {
        (0..self.tiles.geometry().tile_count()).map(|index| self.tiles.reading(index))
    }
}

/// The elapsed time in seconds from one frame to another one `elapsed` later.
///
/// Boards sample once a millisecond, and the frame clock is steered by up to 500 ppm: two computers see the same
/// frames at slightly different intervals. Intervals this close to whole milliseconds are rounded, so that both get
/// the same result.
fn seconds(elapsed: Duration) -> f32 {
    const STEERED_US: u128 = 2;
    let millis = (elapsed.as_micros() + 500) / 1000;
    let is_whole = elapsed.as_micros().abs_diff(1000 * millis) <= STEERED_US * millis;
    if is_whole { Duration::from_millis(millis as u64).as_secs_f32() } else { elapsed.as_secs_f32() }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::floor::TileId;
    use crate::sense::Quality;
    use crate::units::Newtons;

    fn press(frame: &mut ForceFrame, geometry: &Geometry, at: Vec2, force: f32) {
        frame.add_load(geometry, at, Newtons(force));
    }

    fn eq4() -> (Geometry, Sensing) {
        let geometry = Geometry::default();
        (geometry, Sensing::new(geometry, Method::Eq4))
    }

    #[test]
    fn a_point_load_of_100_n_swept_over_a_tile_is_found_within_a_tenth_of_a_millimetre() {
        let (geometry, mut sensing) = eq4();
        for step in 0..400_u16 {
            let along = f32::from(step % 20) / 20.0;
            let across = f32::from(step / 20) / 20.0;
            let at = (Vec2::new(2.0, 3.0) + Vec2::new(along, across) + 0.01) * 0.304;
            let mut frame = ForceFrame::empty(&geometry);
            press(&mut frame, &geometry, at, 100.0);
            let contacts = sensing.update(&frame);
            assert_eq!(contacts.len(), 1);
            assert!(contacts[0].centroid.distance(at) < 1e-4, "{at}: {contacts:?}");
        }
    }

    #[test]
    fn how_the_clock_is_steered_changes_nothing_that_is_sensed() {
        let (geometry, heel) = (Geometry::default(), Vec2::new(0.30, 0.43));
        let contacts_by = |at_us: &dyn Fn(u64) -> u64| {
            let mut sensing = Sensing::new(geometry, Method::Tracker);
            let roll = |milli: u64| {
                let mut frame = ForceFrame::empty(&geometry);
                frame.at = Instant::from_micros(at_us(milli));
                press(&mut frame, &geometry, heel + Vec2::new(0.0, 0.0004 * milli as f32), 700.0);
                sensing.update(&frame).to_vec()
            };
            (0..500).map(roll).collect::<Vec<_>>()
        };
        let exact = contacts_by(&|milli| 1000 * milli);
        assert_eq!(contacts_by(&|milli| 1_000_500 * milli / 1000), exact);
        assert_eq!(contacts_by(&|milli| 999_500 * milli / 1000), exact);
        assert_ne!(
            contacts_by(&|milli| 1200 * milli),
            exact,
            "a board that samples less often is another matter"
        );
    }

    #[test]
    fn eq4_weighs_the_tiles_of_one_foot() {
        let (geometry, mut sensing) = eq4();
        let mut frame = ForceFrame::empty(&geometry);
        press(&mut frame, &geometry, Vec2::new(0.28, 0.1), 300.0);
        press(&mut frame, &geometry, Vec2::new(0.36, 0.14), 100.0);
        let contacts = sensing.update(&frame);
        assert_eq!(contacts.len(), 1);
        assert!(contacts[0].centroid.distance(Vec2::new(0.30, 0.11)) < 1e-5);
        assert_eq!(contacts[0].tiles[0].tile, TileId::new(0, 0));
        assert_eq!(contacts[0].tiles.len(), 2);
        assert!(contacts[0].difference.unwrap().distance(Vec2::new(-0.08, -0.04)) < 1e-5);
    }

    #[test]
    fn a_name_lasts_as_long_as_the_foot_and_is_never_used_again() {
        let (geometry, mut sensing) = eq4();
        let mut ids = Vec::new();
        for step in 0..600_u16 {
            let mut frame = ForceFrame::empty(&geometry);
            frame.at = Instant::from_millis(step.into());
            // Three passes of a point that slides over seams and corners, with a pause between.
            if step % 200 < 180 {
                let at = Vec2::splat(0.2 + f32::from(step % 200) * 0.002);
                press(&mut frame, &geometry, at, 200.0);
            }
            ids.extend(sensing.update(&frame).first().map(|contact| contact.id.0));
        }
        ids.dedup();
        assert_eq!(ids, [1, 2, 3]);
    }

    #[test]
    fn a_light_contact_is_less_certain_than_a_heavy_one() {
        let geometry = Geometry::default();
        // Load cells with maps: otherwise each part's law and memory outweigh its zero.
        let config =
            SensingConfig { uncertainty: SensorUncertainty::without_memory(), ..SensingConfig::default() };
        let mut sensing =
            Sensing::with_config(geometry, Method::Eq4, config)
                .with_maps(&vec![Some(PositionMap::NONE); geometry.tile_count()]);
        let mut radius = |force| {
            let mut frame = ForceFrame::empty(&geometry);
            press(&mut frame, &geometry, Vec2::splat(0.45), force);
            sensing.update(&frame)[0].covariance.ellipse_95_m().0
        };
        let (light, heavy) = (radius(10.0), radius(100.0));
        assert!(light > 3.0 * heavy && light < 0.05, "{light} and {heavy} m");
    }

    #[test]
    fn tiles_report_force_and_centroid() {
        let (geometry, mut sensing) = eq4();
        let mut frame = ForceFrame::empty(&geometry);
        press(&mut frame, &geometry, Vec2::new(0.45, 0.15), 80.0);
        frame.quality[1][2] = Quality::Stale;
        sensing.update(&frame);
        let readings: Vec<_> = sensing.tiles().collect();
        assert_eq!(readings.len(), 36);
        assert!((readings[1].force.0 - 80.0).abs() < 1e-3);
        assert!(readings[1].centroid.unwrap().distance(Vec2::new(0.45, 0.15)) < 1e-4);
        assert_eq!(readings[1].quality, Quality::Degraded);
        assert_eq!(readings[0], TileReading { centroid: None, ..TileReading::live() });
    }

    /// The identifiers of all contacts of a point with this force and place after `millis` milliseconds, in order.
    fn names_of(point: impl Fn(f32) -> (f32, Vec2), millis: u16) -> Vec<u32> {
        let geometry = Geometry::default();
        let mut sensing = Sensing::new(geometry, Method::Tracker);
        let mut names = Vec::new();
        for milli in 0..millis {
            let mut frame = ForceFrame::empty(&geometry);
            frame.at = Instant::from_millis(milli.into());
            let (force, at) = point(milli.into());
            press(&mut frame, &geometry, at, force);
            names.extend(sensing.update(&frame).iter().map(|contact| contact.id.0));
        }
        names.sort_unstable();
        names.dedup();
        names
    }

    #[test]
    fn a_foot_that_leaves_over_the_tip_of_its_toes_stays_one() {
        // As for recorded walkers: the foot never rests for 0.2 s, and with a sixth of the weight left the centre of
        // pressure moves at 2.5 m/s.
        let toe_off = |milli: f32| {
            let [rolling, leaving, running] = [180.0, 600.0, 680.0].map(|from| (milli - from).max(0.0));
            ((800.0 - 8.2 * leaving).max(130.0), Vec2::new(0.31 + 0.00017 * rolling + 0.0025 * running, 0.45))
        };
        assert_eq!(names_of(toe_off, 730), [1]);
    }

    #[test]
    fn weight_that_rushes_aside_has_gone_over_to_another_foot() {
        // A foot of 1100 N rolls north; within a quarter of a second all weight is 15 cm beside it, on the same tile.
        let goes_over = |milli: f32| {
            let over = ((milli - 900.0) / 250.0).clamp(0.0, 1.0);
            let aside = 0.15 * over * over * (3.0 - 2.0 * over);
            (1100.0, Vec2::new(0.36 + aside, 0.36 + 0.0002 * (milli - 600.0).clamp(0.0, 300.0)))
        };
        assert_eq!(names_of(goes_over, 1150).len(), 2);
    }
}
