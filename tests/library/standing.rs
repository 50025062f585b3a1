//! Calibration by standing: a simulated person on marks, packets as from boards, laws at the end.

use underfoot::floor::{Floor, Geometry, SensorPlaces, TileId};
use underfoot::glam::Vec2;
use underfoot::sense::{StandFit, StandingMark};
use underfoot::serve::{StandNews, StandTask, StandWalk};
use underfoot::units::{Instant, Newtons};
use underfoot::wire::{Readings, SensorPacket};
use underfoot_sim::{
    Foot, PartConfig, Person, Script, SimConfig, SimFloor, SimulatedSensors, StandingHabit, standing_on,
};

use crate::sender::standing;

fn parts() -> SimConfig {
    let parts = PartConfig { deviation: 0.0, ..PartConfig::default() };
    SimConfig { sensing: SimulatedSensors::Counts(parts), ..SimConfig::default() }
}

fn person() -> Person {
    Person { mass_kg: 72.0, stand_width_m: 0.12, ..Person::default() }
}

/// A walk over a floor, with the news that it gave.
struct Session {
    floor: Floor,
    sim: SimFloor,
    walk: StandWalk,
    news: Vec<StandNews>,
    ms: u32,
}

impl Session {
    fn new(geometry: Geometry, rounds: usize) -> Self {
        let floor = Floor::of(geometry);
        let marks = StandingMark::of_tiles(&geometry, &StandingMark::walk(&geometry), rounds);
        let (sim, walk) = (SimFloor::new(&floor, parts(), 5), StandWalk::new(&floor, marks));
        Self { floor, sim, walk, news: Vec::new(), ms: 0 }
    }

    /// Passes a millisecond's packets, without those of the boards for which `is_lost` is true.
    fn step(&mut self, loads: &[underfoot_sim::Load], is_lost: impl Fn(u16) -> bool) {
        self.ms += 1;
        let received = Instant::from_millis(self.ms.into());
        for (board, readings) in (0..).zip(self.sim.step_under(loads.iter().copied())) {
            if !is_lost(board) {
                let readings = readings.clone();
                let packet = SensorPacket { board, sequence: self.ms, received, readings };
                self.news.extend(self.walk.take(&packet));
            }
        }
    }

    fn hold(&mut self, ms: u32, feet: &[Foot]) {
        let loads: Vec<_> = feet.iter().map(Foot::as_load).collect();
        (0..ms).for_each(|_| self.step(&loads, |_| false));
    }

    /// A person stands on all marks.
    fn stand(&mut self, habit: StandingHabit) {
        let performance = standing_on(self.walk.marks(), person(), habit, 4).unwrap();
        let script = Script::new(vec![performance], self.floor.geometry.bounds());
        let end = script.duration().as_millis() as u32;
        let mut loads = Vec::new();
        while self.ms < end && self.walk.task() != StandTask::Nothing {
            loads.clear();
            script.loads_at(Instant::from_millis(self.ms.into()), &mut loads);
            self.step(&loads, |_| false);
        }
    }

    /// Median error of the force (share) and of the place (m) of other feet by the laws that were found.
    fn errors(&mut self, fit: &StandFit) -> (f32, f32) {
        let (mut forces, mut places) = (Vec::new(), Vec::new());
        for tile in self.floor.geometry.tiles() {
            for (number, off) in [(0.02, 0.05), (-0.05, 0.01), (0.03, -0.03)].into_iter().enumerate() {
                let at = self.floor.geometry.centre(tile) + Vec2::from(off);
                let force = Newtons(150.0 + 200.0 * number as f32);
                let foot = Foot { force, length_m: 0.24, ..standing(at) };
                let (mut sum, mut moment) = (0.0, Vec2::ZERO);
                let readings = self.sim.step(&[foot]).to_vec();
                for (board, readings) in self.floor.boards.iter().zip(readings) {
                    let Readings::Counts(counts) = readings else { panic!("counts") };
                    for (sensor, count) in board.channels.iter().flatten().zip(counts) {
                        let found = fit.sensors.iter().find(|found| found.sensor == *sensor).unwrap();
                        let force = (found.law.force(count.unwrap()) - found.tare).0;
                        sum += force;
                        moment += force * self.floor.geometry.sensor(sensor.tile, sensor.corner);
                    }
                }
                forces.push((sum / force.0 - 1.0).abs());
                places.push((moment / sum).distance(foot.centre_of_pressure()));
            }
        }
        forces.sort_by(f32::total_cmp);
        places.sort_by(f32::total_cmp);
        (forces[forces.len() / 2], places[places.len() / 2])
    }
}

fn fit(session: &Session) -> StandFit {
    let fit = StandFit::of(session.walk.data(), person().weight(), &session.floor.geometry, None);
    fit.unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_person_who_stands_on_marks_calibrates_a_floor_for_other_feet() {
    let mut session = Session::new(Geometry::of_paper_tiles(2, 2).unwrap(), 1);
    session.stand(StandingHabit::default());
    assert_eq!(session.walk.task(), StandTask::Nothing, "{:?}", session.news);
    let data = session.walk.data();
    assert_eq!((data.stands.len(), data.crossings.len()), (20, 19));
    let fit = fit(&session);
    let (force, place) = session.errors(&fit);
    assert!(force < 0.05 && place < 0.01, "{force} {place} {fit:?}");
}

#[test]
fn a_dance_pad_and_a_plate_on_three_legs_are_calibrated_as_well() {
    let pad = [(0.0, -0.13), (0.13, 0.0), (-0.13, 0.0), (0.0, 0.13)].map(Vec2::from);
    let legs = [(-0.12, -0.1), (0.12, -0.1), (0.0, 0.13)].map(Vec2::from);
    for places in [&pad[..], &legs[..]] {
        let places = SensorPlaces::at(places).unwrap();
        let geometry = Geometry::of_paper_tiles(2, 1).unwrap().with_sensors(places).unwrap();
        let mut session = Session::new(geometry, 2);
        session.stand(StandingHabit { miss_m: 0.003, ..StandingHabit::default() });
        assert_eq!(session.walk.task(), StandTask::Nothing, "{:?}", session.news);
        let fit = fit(&session);
        let (force, place) = session.errors(&fit);
        assert!(force < 0.08 && place < 0.015, "{force} {place}");
    }
}

#[test]
fn a_stand_counts_on_its_own_tile_only_and_while_nobody_moves() {
    let mut session = Session::new(Geometry::of_paper_tiles(2, 1).unwrap(), 1);
    assert_eq!(session.walk.task(), StandTask::KeepOff);
    session.hold(1600, &[]);
    let StandTask::Go(mark) = session.walk.task() else { panic!("{:?}", session.walk.task()) };
    assert_eq!(mark.tile, TileId::new(0, 0));
    let on = |tile: u16| {
        let at = session.floor.geometry.centre(TileId::new(tile, 0));
        Foot { length_m: 0.1, force: Newtons(500.0), ..standing(at) }
    };
    let (own, other) = (on(0), on(1));
    session.hold(4000, &[other]);
    let elsewhere = StandNews::Elsewhere { mark, felt: TileId::new(1, 0) };
    assert_eq!(session.news, [elsewhere], "once, however long somebody stands there");
    // A second of standing is too short.
    session.hold(600, &[]);
    session.hold(1900, &[own]);
    session.hold(600, &[]);
    assert_eq!(session.news[1..], [StandNews::Moved(mark)]);
    session.hold(4000, &[own]);
    assert_eq!(session.news[2..], [StandNews::Kept(mark)], "and not the next mark without moving");
    assert_eq!((session.walk.done(), session.walk.data().crossings.len()), (1, 0));
}

#[test]
fn a_board_that_falls_silent_ends_a_stand_and_is_named() {
    let mut session = Session::new(Geometry::of_paper_tiles(1, 2).unwrap(), 1);
    session.hold(1600, &[]);
    let StandTask::Go(mark) = session.walk.task() else { panic!("{:?}", session.walk.task()) };
    let foot = Foot { length_m: 0.1, force: Newtons(500.0), ..standing(mark.at) };
    session.hold(2000, &[foot]);
    assert!(matches!(session.walk.task(), StandTask::Stay(_)));
    (0..300).for_each(|_| session.step(&[foot.as_load()], |board| board == 1));
    let now = Instant::from_millis(session.ms.into());
    assert_eq!(session.walk.silent(now).collect::<Vec<_>>(), ["/underfoot/board/1"]);
    assert!(matches!(session.walk.task(), StandTask::Go(_)) && session.walk.data().stands.is_empty());
    session.hold(4000, &[foot]);
    assert_eq!(session.news, [StandNews::Kept(mark)]);
}
