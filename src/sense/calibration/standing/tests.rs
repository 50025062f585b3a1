//! Calibration by people who stand on plates of each law.

use glam::Vec2;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::*;
use crate::floor::{Calibration, Corner, Geometry, LawKind, SensorId, SensorPlaces, TileId};
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
    /// The paper's parts: about one in two reaches the end of its range under a person on an outer mark.
    fn new(kind: LawKind, columns: u16, rows: u16, seed: u64) -> Self {
        Self::with_range(kind, (columns, rows), seed, 1.0)
    }

    /// Parts that no person brings to the end of their range.
    fn strong(kind: LawKind, columns: u16, rows: u16, seed: u64) -> Self {
        Self::with_range(kind, (columns, rows), seed, 1.8)
    }

    /// Parts with `range` times the usual force at an equal output.
    fn with_range(kind: LawKind, (columns, rows): (u16, u16), seed: u64, range: f32) -> Self {
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
            let (a, b) = (range * a * rng.random_range(0.75..1.25), b * rng.random_range(0.97..1.03));
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
        let full = Calibration::FULL_SCALE_VOLTS;
        parts.zip(loads).map(|(part, load)| part.volts_at(Newtons(REST_N + load)).min(full)).collect()
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

    /// Error of the force and of the place of a foot at `at`, by the laws that were found; `None` if a sensor is at the
    /// end of its range.
    fn error(&self, fit: &StandFit, at: Vec2, force: f32) -> Option<(f32, f32)> {
        let (mut sum, mut moment) = (0.0, Vec2::ZERO);
        for (sensor, volts) in fit.sensors.iter().zip(self.volts(at, force)) {
            if data::is_saturated(volts) {
                return None;
            }
            let felt = (sensor.law.force_at(volts) - sensor.tare).0;
            sum += felt;
            moment += felt * self.geometry.sensor(sensor.sensor.tile, sensor.sensor.corner);
        }
        Some(((sum / force - 1.0).abs(), (moment / sum).distance(at)))
    }

    /// Mean and greatest errors of force and place of other feet.
    fn errors(&self, fit: &StandFit) -> [(f32, f32); 2] {
        let tiles = self.geometry.tiles();
        let feet = tiles.flat_map(|tile| {
            let centre = self.geometry.centre(tile);
            other_feet().filter_map(move |(off, force)| self.error(fit, centre + off, force))
        });
        let (mut sum, mut most, mut count) = ((0.0, 0.0), (0.0_f32, 0.0_f32), 0.0);
        for (force, place) in feet {
            sum = (sum.0 + force, sum.1 + place);
            most = (most.0.max(force), most.1.max(place));
            count += 1.0;
        }
        assert!(count > 20.0);
        [(sum.0 / count, sum.1 / count), most]
    }
}

/// Places and forces at which nobody stood for the calibration.
fn other_feet() -> impl Iterator<Item = (Vec2, f32)> {
    let places = [(0.03, 0.02), (-0.07, 0.01), (0.04, -0.08), (-0.02, 0.07)].map(Vec2::from);
    places.into_iter().flat_map(|off| [150.0, 400.0, 800.0].map(|force| (off, force)))
}

/// Mean uncertainty of the sensors.
fn uncertainty(fit: &StandFit) -> f32 {
    fit.sensors.iter().map(|sensor| sensor.uncertainty).sum::<f32>() / fit.sensors.len() as f32
}

fn fitted(plates: &Plates, data: &StandData) -> StandFit {
    fitted_by(plates, data, None)
}

fn fitted_by(plates: &Plates, data: &StandData, kind: Option<LawKind>) -> StandFit {
    StandFit::of(data, WEIGHT, &plates.geometry, kind).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn exact_stands_give_the_laws_for_other_feet_at_other_places() {
    for kind in LawKind::ALL {
        let mut plates = Plates::new(kind, 2, 2, 3);
        let data = plates.stand(0.0, Vec2::ZERO);
        let fit = fitted_by(&plates, &data, Some(kind));
        assert!(fit.weight_residual < 0.004 && fit.place_residual_m < 0.004, "{fit:?}");
        let [(force, place), (most_force, most_place)] = plates.errors(&fit);
        assert!(force < 0.015 && place < 0.004, "{kind:?}: {force} {place}");
        assert!(most_force < 0.06 && most_place < 0.01, "{kind:?}: {most_force} {most_place}");
    }
}

/// The kind of law is found, or one that hardly fits worse: in the range that a person loads, laws can be much alike.
fn is_found_or_serves_as_well(kind: LawKind) {
    let mut plates = Plates::strong(kind, 3, 2, 3);
    let data = plates.stand(0.0, Vec2::ZERO);
    let fit = fitted(&plates, &data);
    let misfit = |kind| fit.laws.iter().find(|laws| laws.kind == kind).unwrap().misfit;
    let is_alike = fit.kind != kind && misfit(kind) < 1.15 * misfit(fit.kind);
    assert!(fit.kind == kind || is_alike, "{kind:?}: {:?}", fit.laws);
    let [(force, place), _] = plates.errors(&fit);
    let most = if is_alike { 0.1 } else { 0.05 };
    assert!(force < most && place < 0.01, "{kind:?}: {force} {place}");
}

#[test]
fn the_kind_of_law_is_found_or_one_that_serves_as_well() {
    [LawKind::Exponential, LawKind::Power, LawKind::Linear].into_iter().for_each(is_found_or_serves_as_well);
}

/// Within the range that a person loads, strong dividers are much like exponential parts.
#[test]
fn where_dividers_may_be_exponential_parts_the_loads_are_named_above_which_that_matters() {
    let mut plates = Plates::strong(LawKind::Divider, 3, 2, 3);
    let data = plates.stand(0.0, Vec2::ZERO);
    let told = fitted_by(&plates, &data, Some(LawKind::Divider));
    assert!(told.sensors.iter().all(|found| found.sure_to.0.is_infinite()), "nothing is compared with it");
    let [(force, place), _] = plates.errors(&told);
    assert!(force < 0.05 && place < 0.01, "{force} {place}");
    let fit = fitted(&plates, &data);
    let sure = |found: &SensorFit, load: f32| load <= found.sure_to.0;
    let mut unsure = 0;
    for tile in plates.geometry.tiles() {
        for (off, force) in other_feet() {
            let at = plates.geometry.centre(tile) + off;
            let loads = plates.loads(at, force).into_iter().flatten();
            let is_sure = fit.sensors.iter().zip(loads).all(|(found, load)| sure(found, load));
            let Some((error, _)) = plates.error(&fit, at, force) else { continue };
            assert!(!is_sure || error < 0.1, "{off} {force} N: {error}");
            unsure += usize::from(!is_sure);
        }
    }
    assert!(unsure > 0, "{:?}", fit.laws);
}

#[test]
fn a_person_who_misses_the_marks_and_leans_still_calibrates() {
    for kind in LawKind::ALL {
        let mut plates = Plates::new(kind, 3, 3, 8);
        let lean = Vec2::new(0.005, 0.03);
        let data = plates.stand(0.01, lean);
        let fit = fitted_by(&plates, &data, Some(kind));
        assert!(fit.lean_m.distance(lean) < 0.01, "{kind:?} {:?}", fit.lean_m);
        let [(force, place), _] = plates.errors(&fit);
        assert!(force < 0.05 && place < 0.01, "{kind:?}: {force} {place}");
        let [(force, place), _] = plates.errors(&fitted(&plates, &data));
        assert!(force < 0.08 && place < 0.01, "{kind:?}, not told: {force} {place}");
    }
}

#[test]
fn stands_with_sensors_at_the_end_of_their_range_still_count() {
    let mut plates = Plates::new(LawKind::Exponential, 2, 2, 3);
    let data = plates.stand(0.003, Vec2::ZERO);
    let fit = fitted(&plates, &data);
    assert!(fit.saturated.len() > 4 && fit.stands == data.stands.len(), "{:?}", fit.saturated);
    let free = |number: &usize| !fit.saturated.contains(number);
    let stands = data.stands.iter().enumerate();
    let free: Vec<_> = stands.filter(|(number, _)| free(number)).map(|(_, stand)| stand.clone()).collect();
    let without = fitted(&plates, &StandData { stands: free, ..data.clone() });
    let [all, less] = [&fit, &without].map(uncertainty);
    assert!(all < 0.9 * less, "{all} and without them {less}");
}

#[test]
fn marks_lie_around_the_middle_of_a_tile_s_sensors_where_each_of_them_carries() {
    let diamond = [(0.0, -0.12), (0.12, 0.0), (-0.12, 0.0), (0.0, 0.12)].map(Vec2::from);
    let legs = [(-0.12, -0.1), (0.12, -0.1), (0.0, 0.13)].map(Vec2::from);
    let square = Geometry::of_paper_tiles(2, 1).unwrap();
    let with = |places: &[Vec2]| square.with_sensors(SensorPlaces::at(places).unwrap()).unwrap();
    for geometry in [square, with(&diamond), with(&legs)] {
        let tile = TileId::new(1, 0);
        let sensors: Vec<Vec2> =
            geometry.sensors(tile).iter().map(|corner| geometry.sensor(tile, *corner)).collect();
        let marks = StandingMark::of_tiles(&geometry, &[tile], 1);
        assert_eq!(marks.len(), 1 + sensors.len());
        let middle = sensors.iter().sum::<Vec2>() / sensors.len() as f32;
        assert!(marks[0].at.distance(middle) < 1e-6);
        for sensor in sensors {
            let near = marks[1..].iter().filter(|mark| mark.at.distance(middle.lerp(sensor, 0.4)) < 1e-6);
            assert_eq!(near.count(), 1);
        }
        // Once around, never across.
        let turns = marks[1..].windows(2).map(|pair| (pair[0].at - middle).perp_dot(pair[1].at - middle));
        assert!(turns.into_iter().all(|turn| turn > 0.0));
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
fn one_round_of_stands_gives_every_sensor_a_law() {
    for kind in [LawKind::Exponential, LawKind::Power] {
        let mut plates = Plates::new(kind, 2, 2, 5);
        let data = plates.stand(0.01, Vec2::ZERO);
        let fit = fitted(&plates, &data);
        assert!(fit.sensors.iter().all(|sensor| sensor.determined > 0), "{:?}", fit.sensors);
    }
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
    let mut plates = Plates::strong(LawKind::Exponential, 2, 1, 4);
    let mut data = plates.stand(0.01, Vec2::ZERO);
    let rest: Vec<f32> = data.empty.iter().map(|rest| rest.volts).collect();
    let before = fitted(&plates, &data);
    // Steps whose forces vary about the weight, in the middle of both tiles: nearer to an edge, a rigid plate on springs
    // alone would lift its far corner.
    for way in 0..20 {
        let mut crossing = Crossing::default();
        for moment in 0..400_u16 {
            let phase = f32::from(moment) / 400.0 * std::f32::consts::TAU;
            let y = 0.152 + 0.05 * (phase + way as f32).sin();
            let along = f32::from(moment % 200) / 200.0;
            let at = Vec2::new(0.092 + 0.304 * f32::from(moment / 200) + 0.12 * along, y);
            crossing.add(plates.loaded(&rest, at, WEIGHT.0 * (1.0 + 0.2 * (3.0 * phase).sin())));
        }
        data.crossings.push(crossing);
    }
    let after = fitted(&plates, &data);
    assert_eq!((before.crossings, after.crossings), (0, 20));
    let [before, after] = [&before, &after].map(uncertainty);
    assert!(after < before, "{after} after {before}");
}

#[test]
fn saturated_stands_and_each_lack_have_their_names() {
    let mut plates = Plates::strong(LawKind::Power, 1, 1, 6);
    let data = plates.stand(0.0, Vec2::ZERO);
    let of = |data: &StandData, weight: f32| StandFit::of(data, Newtons(weight), &plates.geometry, None);
    let mut broken = data.clone();
    broken.stands[1].loaded[0].1 = 4.95;
    assert_eq!(of(&broken, 700.0).unwrap().saturated, [1]);
    broken.stands[2].loaded[0].1 = f32::NAN;
    assert_eq!(of(&broken, 700.0), Err(StandError::NotFinite { number: 2 }));
    broken.stands.truncate(2);
    // The saturated one counts, with two equations of three.
    assert_eq!(of(&broken, 700.0), Err(StandError::TooFew { stands: 2 }));
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
