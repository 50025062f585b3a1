//! A walk from mark to mark, for a calibration by standing.

mod motion;
mod outputs;
mod rest_meter;

use std::time::Duration;

use self::motion::FloorMotion;
use self::outputs::VoltMeter;
use self::rest_meter::RestMeter;
use crate::floor::{Floor, SensorId, TileId};
use crate::sense::{Crossing, MeasuredStand, SensorVolts, StandData, StandingMark};
use crate::units::Instant;
use crate::wire::SensorPacket;

/// Time between two moments.
const MOMENT: Duration = Duration::from_millis(5);

/// Number of moments for which a person must stand still before a stand is measured: half a second.
const SETTLED: u32 = 100;

/// Number of moments of a stand: two seconds, longer than most of the sway of a person.
const STAND: u32 = 400;

/// A walk from mark to mark: at each mark a person stands still for a moment.
///
/// The caller passes every packet. The walk gives the next task, advances by itself, and collects the measurements
/// for [`StandFit`](crate::sense::StandFit). It needs no laws and no tare: it assumes that the floor is empty at the
/// beginning.
#[derive(Clone, Debug)]
pub struct StandWalk {
    meter: VoltMeter,
    rest: RestMeter,
    motion: FloorMotion,
    marks: Vec<StandingMark>,
    /// Number of the present mark.
    number: usize,
    stage: WalkStage,
    /// The way since the last stand, while it is entirely on the floor.
    crossing: Option<Crossing>,
    data: StandData,
    next: Option<Instant>,
}

#[derive(Clone, Debug)]
enum WalkStage {
    /// The floor must be empty.
    Rest,
    /// The person goes to the mark, and has moved since the last stand.
    Way {
        has_moved: bool,
        still: u32,
    },
    /// The person stands: sums of all outputs, their number, and the way to this mark.
    Stand {
        sums: Vec<f64>,
        moments: u32,
        way: Option<Crossing>,
    },
    Done,
}

/// The next task of the person.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StandTask {
    /// Keep off the floor until all boards have sent packets for a while.
    KeepOff,
    /// Go to this mark and stand still.
    Go(StandingMark),
    /// Stay: the stand is being measured.
    Stay(StandingMark),
    /// No task: all marks are done.
    Nothing,
}

/// News of a walk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StandNews {
    /// A stand is measured.
    Kept(StandingMark),
    /// A stand is measured with a sensor at the end of its converter's range: it tells less.
    Saturated(StandingMark),
    /// The person moved before the end of a stand.
    Moved(StandingMark),
    /// The person stands on another tile than that of the mark.
    Elsewhere {
        /// The mark.
        mark: StandingMark,
        /// The tile with the greatest changes, by the floor file.
        felt: TileId,
    },
}

impl StandWalk {
    /// A walk over these marks on `floor`.
    #[must_use]
    pub fn new(floor: &Floor, marks: Vec<StandingMark>) -> Self {
        let meter = VoltMeter::new(floor);
        let rest = RestMeter::new(meter.sensors().len());
        Self {
            rest,
            motion: FloorMotion::default(),
            marks,
            number: 0,
            stage: WalkStage::Rest,
            crossing: None,
            data: StandData::default(),
            next: None,
            meter,
        }
    }

    /// Processes a packet; returns the news that it completes, if any. Ignores packets of other floors.
    pub fn take(&mut self, packet: &SensorPacket) -> Option<StandNews> {
        let now = packet.received;
        let due = *self.next.get_or_insert(now + MOMENT);
        let mut news = None;
        if now >= due {
            // After a pause of the stream there is one moment, not many.
            let late = now.since(due);
            self.next = Some(now + if late < MOMENT { MOMENT - late } else { MOMENT });
            self.meter.close();
            news = self.advance(now);
        }
        self.meter.take(packet);
        news
    }

    fn advance(&mut self, now: Instant) -> Option<StandNews> {
        let volts: Option<Vec<f32>> = self.meter.volts().collect();
        let is_whole = self.meter.silent(now).next().is_none();
        let Some(volts) = volts.filter(|_| is_whole) else {
            self.interrupt();
            return None;
        };
        if matches!(self.stage, WalkStage::Rest) {
            self.rest_on(&volts);
            return None;
        }
        self.motion.add(volts.iter().copied());
        if !self.motion.bears() {
            self.crossing = None;
        }
        if let Some(crossing) = &mut self.crossing {
            crossing.add(self.motion.loaded().filter_map(|(sensor, _)| Some((sensor, *volts.get(sensor)?))));
        }
        let (is_still, is_moving) = (self.motion.is_still(), self.motion.is_moving());
        match &mut self.stage {
            WalkStage::Rest | WalkStage::Done => None,
            WalkStage::Way { has_moved, still } => {
                *has_moved |= is_moving;
                *still = if is_still && *has_moved { *still + 1 } else { 0 };
                if *still >= SETTLED {
                    let sums = vec![0.0; volts.len()];
                    self.stage = WalkStage::Stand { sums, moments: 0, way: self.crossing.clone() };
                }
                None
            }
            WalkStage::Stand { .. } if is_moving => {
                self.stage = WalkStage::Way { has_moved: true, still: 0 };
                self.marks.get(self.number).copied().map(StandNews::Moved)
            }
            WalkStage::Stand { sums, moments, .. } => {
                *moments += 1;
                for (sum, volts) in sums.iter_mut().zip(&volts) {
                    *sum += f64::from(*volts);
                }
                if *moments >= STAND { self.keep() } else { None }
            }
        }
    }

    /// Measures the empty floor.
    fn rest_on(&mut self, volts: &[f32]) {
        self.rest.add(volts);
        if !self.rest.is_done() {
            return;
        }
        if self.rest.is_walked_on() {
            self.interrupt();
            return;
        }
        self.motion = FloorMotion::new(self.rest.outputs());
        let means = self.rest.outputs().map(|(mean, _)| mean);
        self.data.empty =
            self.meter.sensors().zip(means).map(|(sensor, volts)| SensorVolts { sensor, volts }).collect();
        self.stage = self.way(true);
    }

    fn way(&self, has_moved: bool) -> WalkStage {
        if self.number < self.marks.len() { WalkStage::Way { has_moved, still: 0 } } else { WalkStage::Done }
    }

    /// Begins anew what the loss of a board or a walker on the empty floor interrupted.
    fn interrupt(&mut self) {
        match &mut self.stage {
            WalkStage::Rest => self.rest.clear(),
            WalkStage::Way { still, .. } => *still = 0,
            WalkStage::Stand { .. } => self.stage = WalkStage::Way { has_moved: true, still: 0 },
            WalkStage::Done => {}
        }
        self.crossing = None;
    }

    /// Ends a stand.
    fn keep(&mut self) -> Option<StandNews> {
        let mark = *self.marks.get(self.number)?;
        let felt = self.heaviest()?;
        let WalkStage::Stand { sums, moments, way } = std::mem::replace(&mut self.stage, WalkStage::Done)
        else {
            return None;
        };
        if felt != mark.tile {
            self.stage = self.way(false);
            return Some(StandNews::Elsewhere { mark, felt });
        }
        let mean = |sensor: usize| Some((sums.get(sensor)? / f64::from(moments)) as f32);
        let loaded = self.motion.loaded().filter_map(|(sensor, _)| Some((sensor, mean(sensor)?)));
        let stand = MeasuredStand { mark, loaded: loaded.collect() };
        let is_saturated = stand.saturated() > 0;
        self.data.crossings.extend(way);
        self.data.stands.push(stand);
        self.number += 1;
        self.stage = self.way(false);
        self.crossing = Some(Crossing::default());
        Some(if is_saturated { StandNews::Saturated(mark) } else { StandNews::Kept(mark) })
    }

    /// The tile with the greatest changes.
    fn heaviest(&self) -> Option<TileId> {
        let tile = |sensor: usize| Some(self.data.empty.get(sensor)?.sensor.tile);
        let loads: Vec<(TileId, f32)> = self
            .motion
            .loaded()
            .filter_map(|(sensor, motion)| Some((tile(sensor)?, motion.change_v.powi(2))))
            .collect();
        let of = |wanted: TileId| {
            loads.iter().filter(|(tile, _)| *tile == wanted).map(|(_, load)| load).sum::<f32>()
        };
        loads.iter().map(|(tile, _)| *tile).max_by(|one, other| of(*one).total_cmp(&of(*other)))
    }

    /// Leaves out the present mark.
    pub fn skip(&mut self) {
        if matches!(self.stage, WalkStage::Way { .. } | WalkStage::Stand { .. }) {
            self.number += 1;
            self.stage = self.way(true);
        }
    }

    /// Returns the present task.
    #[must_use]
    pub fn task(&self) -> StandTask {
        match (&self.stage, self.marks.get(self.number)) {
            (WalkStage::Rest, _) => StandTask::KeepOff,
            (WalkStage::Way { .. }, Some(mark)) => StandTask::Go(*mark),
            (WalkStage::Stand { .. }, Some(mark)) => StandTask::Stay(*mark),
            (WalkStage::Done | WalkStage::Way { .. } | WalkStage::Stand { .. }, _) => StandTask::Nothing,
        }
    }

    /// Returns the share of the present stand that is measured, 0 to 1; 0 between stands.
    #[must_use]
    pub fn measured_share(&self) -> f32 {
        match self.stage {
            WalkStage::Stand { moments, .. } => moments as f32 / STAND as f32,
            WalkStage::Rest | WalkStage::Way { .. } | WalkStage::Done => 0.0,
        }
    }

    /// Returns the number of marks that are done or left out.
    #[must_use]
    pub const fn done(&self) -> usize {
        self.number
    }

    /// Returns the number of all marks.
    #[must_use]
    pub fn length(&self) -> usize {
        self.marks.len()
    }

    /// Returns all marks.
    #[must_use]
    pub fn marks(&self) -> &[StandingMark] {
        &self.marks
    }

    /// Returns the measurements so far.
    #[must_use]
    pub const fn data(&self) -> &StandData {
        &self.data
    }

    /// Returns the addresses of the boards that have sent nothing for 150 ms before `now`.
    pub fn silent(&self, now: Instant) -> impl Iterator<Item = &str> {
        self.meter.silent(now)
    }

    /// Returns the sensors for which no reading has come.
    pub fn unread(&self) -> impl Iterator<Item = SensorId> {
        self.meter.unread()
    }

    /// Whether a board sends newtons: such boards calibrate themselves.
    #[must_use]
    pub const fn has_newtons(&self) -> bool {
        self.meter.has_newtons()
    }
}
