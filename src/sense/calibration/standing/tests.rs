use glam::Vec2;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::*;
use crate::floor::{Calibration, Corner, Geometry, LawKind, SensorId, TileId};
use crate::units::Newtons;

const WEIGHT: Newtons = Newtons(700.0);

/// Weight of a plate on each sensor (N).
const REST_N: f32 = 11.0;

/// A floor of rigid plates whose parts follow one kind of law, differing by a quarter.
struct Plates {
    geometry: Geometry,
    parts: Vec<[Calibration; 4]>,
    rng: Pcg64Mcg,
}

impl Plates {
    fn new(kind: LawKind, columns: u16, rows: u16, seed: u64) -> Self {
        let mut rng = Pcg64Mcg::seed_from_u64(seed);
        let usual = match kind {
            LawKind::Exponential => [0.5, 1.34],
            LawKind::Power => [2.0, 3.2],
            LawKind::Divider => [45.0, 5.0],
            LawKind::Linear => [90.0, 0.4],
        };
        let geometry = Geometry::of_paper_tiles(columns, rows).unwrap();
        let mut part = || {
            let [a, b] = usual;
            let (a, b) = (a * rng.random_range(0.75..1.25), b * rng.random_range(0.97..1.03));
            Calibration::of(kind, [a, b])
        };
        let parts = geometry.tiles().map(|_| std::array::from_fn(|_| part())).collect();
        Self { geometry, parts, rng }
    }

    /// Forces of all sensors under a load on one tile, on top of the plate's weight.
    fn loads(&self, at: Vec2, force: f32) -> Vec<[f32; 4]> {
        let on = self.geometry.tile_under(at).unwrap();
        let share = |tile: TileId, corner: Corner| {
            let reach = self.geometry.sensor(tile, corner) - self.geometry.centre(tile);
            let off = (at - self.geometry.centre(tile)) / reach;
            if tile == on { 0.25 * (1.0 + off.x + off.y) } else { 0.0 }
        };
        self.geometry.tiles().map(|tile| Corner::ALL.map(|corner| force * share(tile, corner))).collect()
    }

    fn volts(&self, at: Vec2, force: f32) -> Vec<f32> {
        let loads = self.loads(at, force).into_iter().flatten();
        let parts = self.parts.iter().flatten();
        parts.zip(loads).map(|(part, load)| part.volts_at(Newtons(REST_N + load))).collect()
    }

    /// A person who stands `off` the marks at random, and leans.
    fn stand(&mut self, off_m: f32, lean: Vec2) -> StandData {
        let sensors =
            self.geometry.tiles().flat_map(|tile| Corner::ALL.map(|corner| SensorId { tile, corner }));
        let rest: Vec<f32> = self.volts(self.geometry.centre(TileId::new(0, 0)), 0.0);
        let empty = sensors.zip(&rest).map(|(sensor, volts)| SensorVolts { sensor, volts: *volts }).collect();
        let marks = StandingMark::of_tiles(&self.geometry, &StandingMark::walk(&self.geometry), 1);
        let stands = marks.into_iter().map(|mark| {
            let away: [f32; 2] = std::array::from_fn(|_| StandardNormal.sample(&mut self.rng));
            let at = mark.at + Vec2::from_angle(mark.facing).rotate(lean) + off_m * Vec2::from(away);
            MeasuredStand { mark, loaded: self.loaded(&rest, at, WEIGHT.0) }
        });
        StandData { stands: stands.collect(), empty, crossings: Vec::new() }
    }

    fn loaded(&self, rest: &[f32], at: Vec2, force: f32) -> Vec<(usize, f32)> {
        let volts = self.volts(at, force).into_iter().enumerate();
        volts.filter(|(sensor, volts)| (volts - rest[*sensor]).abs() > 1e-3).collect()
    }

    /// Error of the force and of the place of a foot at `at`, by the laws that were found.
    fn error(&self, fit: &StandFit, at: Vec2, force: f32) -> (f32, f32) {
        let (mut sum, mut moment) = (0.0, Vec2::ZERO);
        for (sensor, volts) in fit.sensors.iter().zip(self.volts(at, force)) {
            let felt = (sensor.law.force_at(volts) - sensor.tare).0;
            sum += felt;
            moment += felt * self.geometry.sensor(sensor.sensor.tile, sensor.sensor.corner);
        }
        ((sum / force - 1.0).abs(), (moment / sum).distance(at))
    }
}

/// Places and forces at which nobody stood for the calibration.
fn other_feet() -> impl Iterator<Item = (Vec2, f32)> {
    let places = [(0.03, 0.02), (-0.07, 0.01), (0.04, -0.08), (-0.02, 0.07)].map(Vec2::from);
    places.into_iter().flat_map(|off| [150.0, 400.0, 800.0].map(|force| (off, force)))
}

fn fitted(plates: &Plates, data: &StandData) -> StandFit {
    StandFit::of(data, WEIGHT, &plates.geometry, None).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn exact_stands_find_every_kind_of_law_for_other_feet_at_other_places() {
    for kind in LawKind::ALL {
        let mut plates = Plates::new(kind, 2, 2, 3);
        let data = plates.stand(0.0, Vec2::ZERO);
        let fit = fitted(&plates, &data);
        assert_eq!(fit.kind, kind, "{:?}", fit.laws);
        assert!(fit.weight_residual < 0.004 && fit.place_residual_m < 0.004, "{fit:?}");
        for tile in plates.geometry.tiles() {
            for (off, force) in other_feet() {
                let (share, off_m) = plates.error(&fit, plates.geometry.centre(tile) + off, force);
                assert!(share < 0.04 && off_m < 0.006, "{kind:?} {tile} {off} {force} N: {share} {off_m}");
            }
        }
    }
}

#[test]
fn a_person_who_misses_the_marks_and_leans_still_calibrates() {
    for kind in LawKind::ALL {
        let mut plates = Plates::new(kind, 3, 3, 8);
        let lean = Vec2::new(0.005, 0.03);
        let data = plates.stand(0.01, lean);
        let fit = fitted(&plates, &data);
        assert!(fit.lean_m.distance(lean) < 0.01, "{kind:?} {:?}", fit.lean_m);
        let (mut forces, mut places) = (Vec::new(), Vec::new());
        for tile in plates.geometry.tiles() {
            for (off, force) in other_feet() {
                let (share, off_m) = plates.error(&fit, plates.geometry.centre(tile) + off, force);
                forces.push(share);
                places.push(off_m);
            }
        }
        let mean = |values: &[f32]| values.iter().sum::<f32>() / values.len() as f32;
        assert!(mean(&forces) < 0.05 && mean(&places) < 0.01, "{kind:?} {} {}", mean(&forces), mean(&places));
    }
}

#[test]
fn a_stand_elsewhere_is_named_and_does_not_count() {
    let mut plates = Plates::new(LawKind::Exponential, 2, 2, 5);
    let mut data = plates.stand(0.005, Vec2::ZERO);
    let good = fitted(&plates, &data);
    assert!(good.astray.is_empty(), "{:?}", good.astray);
    let rest: Vec<f32> = data.empty.iter().map(|rest| rest.volts).collect();
    let away = data.stands[7].mark.at + Vec2::new(0.0, 0.12);
    data.stands[7].loaded = plates.loaded(&rest, away, WEIGHT.0);
    // One foot beside the floor.
    let at = data.stands[12].mark.at;
    data.stands[12].loaded = plates.loaded(&rest, at, 0.6 * WEIGHT.0);
    assert_eq!(fitted(&plates, &data).astray, [7, 12]);
    let wild = data.stands.iter_mut().step_by(2);
    wild.for_each(|stand| stand.mark.at += Vec2::splat(0.2));
    let refused = StandFit::of(&data, WEIGHT, &plates.geometry, None);
    assert!(matches!(refused, Err(StandError::Astray { .. })) || refused.unwrap().place_residual_m > 0.05);
}

#[test]
fn sensors_under_which_nobody_stood_need_more_and_others_do_not() {
    let mut plates = Plates::new(LawKind::Linear, 3, 1, 2);
    let mut data = plates.stand(0.003, Vec2::ZERO);
    let all = fitted(&plates, &data);
    assert_eq!(all.needy().count(), 0, "{:?}", all.sensors);
    let left_out = TileId::new(2, 0);
    data.stands.retain(|stand| stand.mark.tile != left_out);
    // A sensor that never answers.
    data.stands.iter_mut().for_each(|stand| stand.loaded.retain(|(sensor, _)| *sensor != 6));
    let fit = fitted(&plates, &data);
    assert!(fit.sensors.iter().all(|sensor| sensor.sensor.tile != left_out) && fit.sensors.len() == 8);
    let needy: Vec<_> = fit.needy().filter(|sensor| sensor.determined == 0).collect();
    assert_eq!(needy.len(), 1);
    assert_eq!((needy[0].sensor, needy[0].most), (data.empty[6].sensor, Newtons::ZERO));
}

#[test]
fn walking_between_marks_adds_the_weight_s_mean() {
    let mut plates = Plates::new(LawKind::Exponential, 2, 1, 4);
    let mut data = plates.stand(0.01, Vec2::ZERO);
    let rest: Vec<f32> = data.empty.iter().map(|rest| rest.volts).collect();
    let before = fitted(&plates, &data);
    // Steps whose forces vary about the weight, all over both tiles.
    for way in 0..20 {
        let mut crossing = Crossing::default();
        for moment in 0..400_u16 {
            let phase = f32::from(moment) / 400.0 * std::f32::consts::TAU;
            let y = 0.152 + 0.07 * (phase + way as f32).sin();
            let at = Vec2::new(0.06 + 0.48 * f32::from(moment) / 400.0, y);
            crossing.add(plates.loaded(&rest, at, WEIGHT.0 * (1.0 + 0.2 * (3.0 * phase).sin())));
        }
        data.crossings.push(crossing);
    }
    let after = fitted(&plates, &data);
    assert_eq!((before.crossings, after.crossings), (0, 20));
    let mean = |fit: &StandFit| {
        fit.sensors.iter().map(|sensor| sensor.uncertainty).sum::<f32>() / fit.sensors.len() as f32
    };
    assert!(mean(&after) < mean(&before), "{} after {}", mean(&after), mean(&before));
}

#[test]
fn saturated_stands_and_each_lack_have_their_names() {
    let mut plates = Plates::new(LawKind::Power, 1, 1, 6);
    let data = plates.stand(0.0, Vec2::ZERO);
    let of = |data: &StandData, weight: f32| StandFit::of(data, Newtons(weight), &plates.geometry, None);
    let mut broken = data.clone();
    broken.stands[1].loaded[0].1 = 4.95;
    assert_eq!(of(&broken, 700.0).unwrap().saturated, [1]);
    broken.stands[2].loaded[0].1 = f32::NAN;
    assert_eq!(of(&broken, 700.0), Err(StandError::NotFinite { number: 2 }));
    broken.stands.truncate(2);
    assert_eq!(of(&broken, 700.0), Err(StandError::TooFew { stands: 1 }));
    for weight in [0.0, f32::NAN, -700.0, 1e9] {
        assert!(matches!(of(&data, weight), Err(StandError::Weight { .. })));
    }
    let mut still = data;
    still.stands.iter_mut().for_each(|stand| stand.loaded.clear());
    assert_eq!(of(&still, 700.0), Err(StandError::NoLaw));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn no_readings_make_it_panic_or_give_laws_that_no_sensor_has(
        volts in proptest::collection::vec(-6.0f32..6.0, 4 * 12),
        count in 0usize..=12,
    ) {
        let geometry = Geometry::of_paper_tiles(1, 1).unwrap();
        let tile = TileId::new(0, 0);
        let marks = StandingMark::of_tiles(&geometry, &[tile], 3);
        let empty = Corner::ALL.map(|corner| SensorVolts { sensor: SensorId { tile, corner }, volts: 0.3 });
        let stands = marks.into_iter().zip(volts.chunks(4)).take(count).map(|(mark, volts)| {
            MeasuredStand { mark, loaded: volts.iter().copied().enumerate().collect() }
        });
        let data = StandData { empty: empty.into(), stands: stands.collect(), crossings: Vec::new() };
        if let Ok(fit) = StandFit::of(&data, WEIGHT, &geometry, None) {
            for sensor in fit.sensors.iter().filter(|sensor| !sensor.needs_more()) {
                prop_assert!(sensor.law.numbers().iter().all(|number| number.is_finite()));
                prop_assert!(sensor.law.force_at(4.0) > sensor.law.force_at(1.0));
            }
        }
    }
}
