//! Feet for tests: a `Walker` on a simulated floor, through packets, assembler and engine.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::time::Duration;

use glam::Vec2;
use underfoot::engine::{Engine, Ignored, Snapshot};
use underfoot::feel::{Cue, SustainedCue, SustainedCues};
use underfoot::floor::{Floor, Geometry};
use underfoot::glam;
use underfoot::layout::Layout;
use underfoot::schema::{self, Kinds};
use underfoot::sense::{Assembler, Contact, Cursor, ForceFrame, Method};
use underfoot::units::{Instant, Newtons};
use underfoot::widget::{EventKind, WidgetEvent};
use underfoot::wire::SensorPacket;
use underfoot_sim::{self as sim, Foot, SimConfig, SimFloor};

/// Time in which a foot applies or removes its force: fast, but possible for a foot.
const RAMP_MS: u64 = 40;

/// Place of the working foot's pressure in its shoe: the ball.
const ROLL: f32 = 0.65;

/// A shipped layout, on the paper's floor.
pub fn layout(name: &str) -> Layout {
    let text = schema::builtin_layout(name).expect("a shipped layout");
    page(text)
}

/// A layout from `text`, on the paper's floor.
pub fn page(text: &str) -> Layout {
    match schema::parse_layout(text, "test page", &Kinds::builtin(), &Floor::default().geometry) {
        Ok(loaded) => loaded.layout,
        Err(diagnostics) => panic!("{diagnostics}"),
    }
}

/// A person's feet on a simulated floor with controls.
pub struct Walker {
    pub engine: Engine,
    pub assembler: Assembler,
    /// The simulated parts, in which tests cause faults.
    pub sim: SimFloor,
    sequence: u32,
    now: Instant,
    stance: Option<Foot>,
    foot: Option<Foot>,
    /// Whether the boards' packets arrive.
    pub connected: bool,
    /// Whether the forces of all tiles are marked as unusable.
    pub untrusted: bool,
    /// Whether the boards' packets are held back, until they are released.
    pub hold_back: bool,
    held_back: Vec<SensorPacket>,
    /// Whether a snapshot is taken at each frame.
    pub watched: bool,
    events: Vec<WidgetEvent>,
    cues: Vec<Cue>,
    sustained: Vec<SustainedCue>,
    cursors: Vec<Option<Cursor>>,
}

impl Walker {
    /// An empty floor of the paper's parts (25 % spread, 2 mV of noise), calibrated as in a laboratory.
    pub fn on(layout: Layout) -> Self {
        Self::on_floor(layout, SimConfig::default(), Method::default())
    }

    pub fn on_floor(layout: Layout, config: SimConfig, method: Method) -> Self {
        Self::on_parts(layout, config, method, 7)
    }

    /// Like [`Walker::on`], with other random parts.
    pub fn on_seed(layout: Layout, seed: u64) -> Self {
        Self::on_parts(layout, SimConfig::default(), Method::default(), seed)
    }

    fn on_parts(layout: Layout, config: SimConfig, method: Method, seed: u64) -> Self {
        let wired = Floor::default();
        let sim = SimFloor::new(&wired, config, seed);
        let floor = sim::calibrated(&wired, &sim, seed).unwrap();
        let mut walker = Self {
            engine: Engine::new(floor.geometry, layout, method),
            assembler: Assembler::new(&floor),
            sim,
            sequence: 0,
            now: Instant::START,
            stance: None,
            foot: None,
            connected: true,
            untrusted: false,
            hold_back: false,
            held_back: Vec::new(),
            watched: true,
            events: Vec::new(),
            cues: Vec::new(),
            sustained: Vec::new(),
            cursors: Vec::new(),
        };
        walker.wait(100);
        walker
    }

    /// Stands with one foot in the middle of the layout's first stance, with all the weight on it.
    pub fn stand(&mut self, weight: Newtons) {
        let area = self.engine.layout().stances[0].area;
        self.stance = Some(Foot {
            position: area.centre(),
            heading: 0.0,
            length_m: 0.27,
            force: Newtons::ZERO,
            roll: 0.5,
            left: false,
        });
        self.ramp(|walker, share| walker.stance.as_mut().unwrap().force = weight * share);
    }

    /// Puts the other foot down at `point` too, as a seated person can.
    pub fn also_at(&mut self, point: Vec2, force: Newtons) {
        self.stance = Some(foot_at(point));
        self.ramp(|walker, share| walker.stance.as_mut().unwrap().force = force * share);
    }

    /// Takes all weight off both feet within `millis` milliseconds, and the feet off the floor.
    pub fn leave_floor(&mut self, millis: u64) {
        let before = [self.stance, self.foot].map(|foot| foot.map_or(Newtons::ZERO, |foot| foot.force));
        for step in 1..=millis {
            let share = 1.0 - step as f32 / millis as f32;
            for (foot, before) in [&mut self.stance, &mut self.foot].into_iter().zip(before) {
                if let Some(foot) = foot {
                    foot.force = before * share;
                }
            }
            self.tick();
        }
        (self.stance, self.foot) = (None, None);
    }

    /// Delivers the packets that were held back, all at once.
    pub fn release_packets(&mut self) {
        self.hold_back = false;
        for packet in std::mem::take(&mut self.held_back) {
            self.assembler.take(&SensorPacket { received: self.now, ..packet });
            while let Some(frame) = self.assembler.ready() {
                self.sustained.extend(take(&mut self.engine, frame, &mut self.events, &mut self.cues));
            }
        }
    }

    /// Puts the working foot on a control and presses.
    pub fn step_onto(&mut self, id: &str, force: Newtons) {
        let widget = self.engine.layout().widget_index(id).unwrap_or_else(|| panic!("no control {id}"));
        let middle = self.engine.layout().widgets[widget].area.centre();
        self.step_at(middle, force);
    }

    /// Puts the working foot down with its centre of pressure at `point`.
    pub fn step_at(&mut self, point: Vec2, force: Newtons) {
        self.foot = Some(foot_at(point));
        self.press(force);
    }

    /// Brings the working foot's force to `force`.
    pub fn press(&mut self, force: Newtons) {
        let before = self.foot.unwrap().force;
        self.ramp(|walker, share| {
            walker.foot.as_mut().unwrap().force = before + (force - before) * share;
        });
    }

    /// Advances by a millisecond with the working foot's force at `force`.
    pub fn press_now(&mut self, force: Newtons) {
        self.foot.as_mut().unwrap().force = force;
        self.tick();
    }

    /// Slides the working foot to `point` in a straight line at `speed` metres per second.
    pub fn slide_to(&mut self, point: Vec2, speed: f32) {
        let from = self.foot.unwrap().centre_of_pressure();
        let force = self.foot.unwrap().force;
        let millis = (from.distance(point) / speed * 1000.0).max(1.0) as u64;
        for step in 1..=millis {
            let at = from.lerp(point, step as f32 / millis as f32);
            self.foot = Some(Foot { force, ..foot_at(at) });
            self.tick();
        }
    }

    /// Takes the working foot off the floor.
    pub fn lift(&mut self) {
        self.press(Newtons::ZERO);
        self.foot = None;
    }

    pub fn wait(&mut self, millis: u64) {
        for _ in 0..millis {
            self.tick();
        }
    }

    /// The latest presses without an answer of a control: control and reason.
    pub fn ignored(&self) -> Vec<(String, Ignored)> {
        let mut snapshot = Snapshot::default();
        self.engine.snapshot(&mut snapshot);
        snapshot.ignored.into_iter().map(|press| (press.id.to_string(), press.why)).collect()
    }

    /// The presses with an answer so far: control and greatest force.
    pub fn answered(&self) -> Vec<(String, Newtons)> {
        let mut snapshot = Snapshot::default();
        self.engine.snapshot(&mut snapshot);
        snapshot.answered.into_iter().map(|press| (press.id.to_string(), press.force)).collect()
    }

    /// The events since the last call: control and kind.
    pub fn take_events(&mut self) -> Vec<(String, EventKind)> {
        self.events.drain(..).map(|event| (event.id.to_string(), event.kind)).collect()
    }

    pub fn take_cues(&mut self) -> Vec<Cue> {
        std::mem::take(&mut self.cues)
    }

    /// The sustained cues of each frame since the last call, while the floor was watched.
    pub fn take_sustained(&mut self) -> Vec<SustainedCue> {
        std::mem::take(&mut self.sustained)
    }

    /// The first region's cursor, frame by frame since the last call.
    pub fn take_cursors(&mut self) -> Vec<Option<Cursor>> {
        std::mem::take(&mut self.cursors)
    }

    pub fn geometry(&self) -> &Geometry {
        self.sim.geometry()
    }

    pub fn working_foot(&self) -> Option<Foot> {
        self.foot
    }

    /// The contact nearest to `point`, within a shoe's length.
    pub fn contact_at(&self, point: Vec2) -> Option<Contact> {
        let mut snapshot = Snapshot::default();
        self.engine.snapshot(&mut snapshot);
        let distance = |contact: &Contact| contact.centroid.distance(point);
        let near = snapshot.contacts.into_iter().filter(|contact| distance(contact) < 0.3);
        near.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    pub fn now(&self) -> Instant {
        self.now
    }

    fn ramp(&mut self, set: impl Fn(&mut Self, f32)) {
        for step in 1..=RAMP_MS {
            set(self, step as f32 / RAMP_MS as f32);
            self.tick();
        }
    }

    /// Advances by one millisecond.
    fn tick(&mut self) {
        self.now = self.now + Duration::from_millis(1);
        self.sequence = self.sequence.wrapping_add(1);
        let feet: Vec<Foot> = self.stance.into_iter().chain(self.foot).collect();
        let readings = self.sim.step(&feet);
        if self.connected {
            for (board, readings) in (0..).zip(readings) {
                let readings = readings.clone();
                let packet = SensorPacket { board, sequence: self.sequence, received: self.now, readings };
                if self.hold_back {
                    self.held_back.push(packet);
                } else {
                    self.assembler.take(&packet);
                }
            }
            if self.hold_back {
                self.assembler.poll(self.now);
            }
        } else {
            self.assembler.poll(self.now);
        }
        while let Some(frame) = self.assembler.ready() {
            if self.untrusted {
                let mut frame = frame.clone();
                frame.may_start.fill(false);
                self.sustained.extend(take(&mut self.engine, &frame, &mut self.events, &mut self.cues));
            } else {
                self.sustained.extend(take(&mut self.engine, frame, &mut self.events, &mut self.cues));
            }
        }
        if !self.watched {
            self.sustained.clear();
            return;
        }
        let mut snapshot = Snapshot::default();
        self.engine.snapshot(&mut snapshot);
        self.cursors.push(snapshot.cursors.first().copied().flatten());
    }
}

fn take(
    engine: &mut Engine,
    frame: &ForceFrame,
    events: &mut Vec<WidgetEvent>,
    cues: &mut Vec<Cue>,
) -> SustainedCues {
    let step = engine.step(frame);
    events.extend_from_slice(step.events);
    cues.extend_from_slice(step.cues);
    step.sustained.clone()
}

/// A foot in the air with its centre of pressure at `point`, toes pointing north.
fn foot_at(point: Vec2) -> Foot {
    let mut foot = Foot {
        position: Vec2::ZERO,
        heading: 0.0,
        length_m: 0.26,
        force: Newtons::ZERO,
        roll: ROLL,
        left: false,
    };
    foot.position = point - foot.centre_of_pressure();
    foot
}
