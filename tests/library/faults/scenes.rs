//! People on a floor that breaks: the effect of a fault on the floor and on their events.

use std::f32::consts::TAU;
use std::time::Duration;

use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use underfoot::engine::Engine;
use underfoot::feel::{Cue, CueSender, RendererConfig, renderer};
use underfoot::floor::{Corner, Floor, Geometry, SensorId, TileId};
use underfoot::glam::Vec2;
use underfoot::sense::{ForceFrame, Method, Quality, Trouble};
use underfoot::sink::{ActuatorSink, ManualSink};
use underfoot::units::{Instant, Newtons};
use underfoot::widget::EventKind;
use underfoot::wire::Readings;
use underfoot_lab::experiment::{
    DrawnVisit, FaultHook, Followed, HeavyFoot, PeopleTable, Rig, TapScene, TapScore, TapTable,
};
use underfoot_sim::{Foot, SensorFault};

use crate::support::page;

/// One button over the whole floor: a press anywhere counts.
const ALL_BUTTON: &str = r#"Layout(version: 1, title: "all", regions: [(id: "all", at: (0, 0), size: (6, 6))],
    widgets: [(id: "all", kind: "button", at: (0, 0), size: (6, 6))])"#;

/// A sensor that breaks at one time and recovers at another.
#[derive(Clone, Copy)]
pub struct Break {
    pub sensor: SensorId,
    pub fault: SensorFault,
    pub from_ms: u64,
    pub until_ms: u64,
}

impl Break {
    /// Broken from the beginning to the end.
    pub fn for_good(sensor: SensorId, fault: SensorFault) -> Self {
        Self { sensor, fault, from_ms: 1, until_ms: u64::MAX }
    }
}

impl FaultHook for Break {
    fn before(&mut self, milli: u64, rig: &mut Rig) {
        if milli == self.from_ms {
            rig.set_fault(self.sensor, Some(self.fault));
        }
        if milli == self.until_ms {
            rig.set_fault(self.sensor, None);
        }
    }
}

/// The result of a visit.
pub struct Visited {
    pub followed: Followed,
    /// Presses of a button over the whole floor while it was empty.
    pub out_of_nothing: usize,
    /// All presses.
    pub pressed: usize,
    /// Troubles at the end.
    pub troubles: Vec<(SensorId, Trouble)>,
    /// The worst quality of any reading while a person was on the floor.
    pub worst: Quality,
    /// Whether the button is still down at the end, when all people have left.
    pub left_down: bool,
}

impl std::fmt::Display for Visited {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Followed { one_foot, two_feet, .. } = &self.followed;
        let [alone, both] = self.followed.share_inside().map(|share| 100.0 * share);
        write!(
            f,
            "one foot{one_foot} two feet{two_feet} within 5 cm {:.1} missed {:.2} extra {:.2} ellipse {alone:.1} {both:.1} pressed {} out of nothing {} {:?} {:?}",
            100.0 * self.followed.share_within_5cm(),
            100.0 * self.followed.share_missed(),
            100.0 * self.followed.share_extra(),
            self.pressed,
            self.out_of_nothing,
            self.worst,
            self.troubles,
        )
    }
}

/// Runs the visit of `seed` on the floor of `rig`, with `fault`.
pub fn visited(mut rig: Rig, seed: u64, fault: impl FaultHook) -> Visited {
    let visit = DrawnVisit::of(seed, rig.geometry()).unwrap();
    let geometry = *rig.geometry();
    let engine = rig.engine(page(ALL_BUTTON), Method::default());
    let mut watch = Watch {
        engine,
        geometry,
        visit: &visit,
        fault,
        loaded: None,
        pressed: 0,
        out_of_nothing: 0,
        down: false,
        worst: Quality::Live,
    };
    let mut table = PeopleTable::default();
    table.add_visit(&mut rig, &visit, &mut watch);
    Visited {
        followed: table.whole(1),
        out_of_nothing: watch.out_of_nothing,
        pressed: watch.pressed,
        left_down: watch.down,
        worst: watch.worst,
        troubles: rig.assembler().troubles().collect(),
    }
}

/// An engine beside the experiment's, with knowledge of the people on the floor.
struct Watch<'a, M> {
    engine: Engine,
    geometry: Geometry,
    visit: &'a DrawnVisit,
    fault: M,
    loaded: Option<u64>,
    pressed: usize,
    out_of_nothing: usize,
    down: bool,
    worst: Quality,
}

impl<M: FaultHook> FaultHook for Watch<'_, M> {
    fn before(&mut self, milli: u64, rig: &mut Rig) {
        self.fault.before(milli, rig);
    }

    fn disturb(&mut self, milli: u64, board: usize, readings: &mut Readings) {
        self.fault.disturb(milli, board, readings);
    }

    fn sensed(&mut self, milli: u64, frame: &ForceFrame) {
        let mut feet: Vec<Foot> = Vec::new();
        self.visit.script().feet_at(Instant::from_millis(milli), &mut feet);
        if feet.iter().any(|foot| !foot.on_tiles(&self.geometry).is_empty()) {
            self.loaded = Some(milli);
            self.worst =
                frame.quality.iter().flatten().fold(self.worst, |worst, quality| worst.max(*quality));
        }
        let step = self.engine.step(frame);
        for event in step.events {
            match event.kind {
                EventKind::Pressed => {
                    self.pressed += 1;
                    self.down = true;
                    self.out_of_nothing += usize::from(self.loaded.is_none_or(|last| milli > last + 60));
                }
                EventKind::Released | EventKind::Cancelled => self.down = false,
                _ => {}
            }
        }
        let cues = step.cues.to_vec();
        self.fault.felt(milli, &cues);
    }
}

/// The tile that carries most over the visit of `seed`.
pub fn busiest_tile(seed: u64, geometry: &Geometry) -> TileId {
    let visit = DrawnVisit::of(seed, geometry).unwrap();
    let mut carried = vec![0.0; geometry.tile_count()];
    let mut feet = Vec::new();
    for milli in (0..visit.script().duration().as_millis() as u64).step_by(10) {
        feet.clear();
        visit.script().feet_at(Instant::from_millis(milli), &mut feet);
        for load in feet.iter().flat_map(|foot| foot.on_tiles(geometry)) {
            carried[load.index] += load.force.0;
        }
    }
    let most = (0..carried.len()).max_by(|&a, &b| carried[a].total_cmp(&carried[b])).unwrap();
    geometry.tile_at_index(most)
}

/// The result of the taps of `seeds`' people in both stances; `fault` makes the fault of each scene.
pub fn tapped<M: FaultHook>(
    seeds: impl IntoIterator<Item = u64>,
    rig: impl Fn(u64) -> Rig,
    fault: impl Fn(&TapScene, &Geometry) -> M,
) -> Tapped {
    let mut table = TapTable::default();
    let mut troubles = Vec::new();
    for seed in seeds {
        for stance in HeavyFoot::ALL {
            let geometry = Geometry::default();
            let scene = TapScene::of(seed, stance, &geometry).unwrap();
            let mut rig = rig(seed);
            table.add_scene(&mut rig, &scene, &mut fault(&scene, &geometry));
            troubles.extend(rig.assembler().troubles());
        }
    }
    let [_, [facing, beside]] = table.scores;
    let mut score = facing;
    score.append(beside);
    Tapped { score, troubles }
}

/// The tracker's result for taps.
pub struct Tapped {
    pub score: TapScore,
    pub troubles: Vec<(SensorId, Trouble)>,
}

impl std::fmt::Display for Tapped {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let TapScore { cursor, samples, without_cursor, touches, pressed, repeated, out_of_nothing, flips } =
            &self.score;
        write!(
            f,
            "cursor{cursor} none {without_cursor} of {samples} pressed {pressed} of {touches} again {repeated} out of nothing {out_of_nothing} flips {flips} {:?}",
            self.troubles
        )
    }
}

/// The sensor nearest to the working foot's first press.
pub fn under_the_taps(scene: &TapScene, geometry: &Geometry) -> SensorId {
    let (at, _) = scene.touches().next().unwrap();
    nearest(at, geometry)
}

/// The sensor nearest to the standing foot's centre of pressure.
pub fn under_the_stance(scene: &TapScene, geometry: &Geometry) -> SensorId {
    nearest(scene.feet(1000)[0].centre_of_pressure(), geometry)
}

fn nearest(at: Vec2, geometry: &Geometry) -> SensorId {
    let tile = geometry.tile_under(at).unwrap();
    let distance = |corner: &Corner| geometry.sensor(tile, *corner).distance(at);
    let corner = Corner::ALL.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
    SensorId { tile, corner }
}

/// A load of `newtons` on one sensor that is not on its plate.
pub fn offset(newtons: f32) -> SensorFault {
    SensorFault::Offset(Newtons(newtons))
}

/// Hum that all sensors share, which is the worst case, and independent noise: 5 N together, on boards that send
/// newtons.
pub struct Hum {
    pub mains_hz: f32,
    /// Of each sensor, in newtons.
    pub hum_n: f32,
    pub noise_n: f32,
    pub rng: Pcg64Mcg,
}

impl FaultHook for Hum {
    fn disturb(&mut self, milli: u64, _: usize, readings: &mut Readings) {
        let Readings::Newtons(forces) = readings else { panic!("boards that send counts") };
        let phase = (TAU * self.mains_hz * (milli % 1000) as f32 / 1000.0).sin();
        for force in forces {
            *force += self.hum_n * phase + self.noise_n * self.rng.random_range(-1.0..=1.0f32);
        }
    }
}

/// Actuators with `share` of their force on each sensor of their tiles.
pub struct Coupled {
    share: f32,
    sender: CueSender,
    sink: ManualSink,
    now: Instant,
    /// The present force of each tile's actuator on its sensors, in newtons.
    felt: Vec<f32>,
    /// The greatest of these forces.
    pub peak: f32,
    pub cues: usize,
}

impl Coupled {
    pub fn new(share: f32) -> Self {
        let floor = Floor::default();
        let (sender, renderer) = renderer(RendererConfig::of(&floor, 48_000));
        let sink = ManualSink::new(renderer, Instant::START);
        let felt = vec![0.0; floor.geometry.tile_count()];
        Self { share, sender, sink, now: Instant::START, felt, peak: 0.0, cues: 0 }
    }
}

impl FaultHook for Coupled {
    fn before(&mut self, _: u64, _: &mut Rig) {
        self.now = self.now + Duration::from_millis(1);
        self.sink.advance(self.now).unwrap();
        for (tile, felt) in self.felt.iter_mut().enumerate() {
            *felt = self.sink.channel(tile).last().copied().unwrap_or(0.0) * 40.0 * self.share;
            self.peak = self.peak.max(felt.abs());
        }
    }

    fn disturb(&mut self, _: u64, board: usize, readings: &mut Readings) {
        let Readings::Newtons(forces) = readings else { panic!("boards that send counts") };
        for (at, force) in forces.iter_mut().enumerate() {
            *force += self.felt[board * 6 + at / 4];
        }
    }

    fn felt(&mut self, _: u64, cues: &[Cue]) {
        self.cues += cues.len();
        cues.iter().for_each(|cue| assert!(self.sender.send(cue)));
    }
}
