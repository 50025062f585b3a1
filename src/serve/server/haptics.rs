//! What feet feel: cues to the renderer, the actuators that play it, and what is muted.

use std::time::Duration;

use thiserror::Error;
use tracing::warn;

use crate::engine::Step;
use crate::feel::{Cue, CueSender, DeviceStatus, FeelCounters, Muted};
use crate::floor::{Geometry, TileId};
use crate::serve::Neighbours;
use crate::serve::trial::Trial;
use crate::sink::{ActuatorSink, LatencyStages};
use crate::units::Instant;

/// How long the actuators are given to fade out: the 5 ms of the fade, and the longest usual block of a card.
const FADE: Duration = Duration::from_millis(50);

/// How often at most it is told how the device is doing.
const DEVICE_PERIOD: Duration = Duration::from_secs(1);

/// Why something can't be muted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub(super) enum MuteError {
    /// There are no actuators.
    #[error("this floor plays nothing that could be muted")]
    Unplayed,
    /// The floor is smaller.
    #[error("the floor has no such tile")]
    OffTheFloor,
    /// The tile has no actuator.
    #[error("nothing moves that tile")]
    Unmoved,
}

/// Cues out, and the device that plays them; without a renderer nothing is felt.
#[derive(Default)]
pub(super) struct Haptics {
    pub(super) feel: Option<CueSender>,
    pub(super) actuators: Option<Box<dyn ActuatorSink>>,
    /// Who moves the tiles beside this computer's.
    pub(super) neighbours: Option<Box<dyn Neighbours>>,
    /// What they handed on last.
    handed: Vec<Cue>,
    /// An effect that somebody tries.
    pub(super) trial: Option<Trial>,
    /// Measures latency, if wanted, and when the last packet was taken.
    pub(super) latency: Option<(LatencyStages, Instant)>,
    muted: Muted,
    /// How the device is doing, if there is one, and what was last told of it.
    device: Option<DeviceStatus>,
    device_told: Option<(Instant, DeviceStatus)>,
}

impl Haptics {
    /// Notes that a packet was taken at `now`.
    pub(super) fn note_packet(&mut self, now: Instant) {
        if let Some((_, taken)) = &mut self.latency {
            *taken = now;
        }
    }

    /// Sends what is due to neighbours at `now`.
    pub(super) fn poll_neighbours(&mut self, now: Instant) {
        if let Some(neighbours) = &mut self.neighbours {
            neighbours.poll(now);
        }
    }

    /// Sends what a frame of time `at` leads to; `now` is the present.
    pub(super) fn send(&mut self, step: &Step<'_>, at: Instant, now: Instant) {
        let Some(feel) = &mut self.feel else { return };
        if let Some((stages, taken)) = self.latency.as_ref().filter(|_| !step.cues.is_empty()) {
            feel.note_time(now);
            for cue in step.cues {
                stages.link.record(taken.since(cue.received));
                stages.engine.record(now.since(*taken));
            }
        }
        for cue in step.cues {
            // What could not be sent is counted by the sender.
            feel.send(cue);
        }
        let mut both = None;
        if let Some(neighbours) = &mut self.neighbours {
            if !feel.is_silenced() {
                neighbours.give(step.cues, step.sustained, now);
            }
            self.handed.clear();
            neighbours.take(at, now, &mut self.handed, both.insert(step.sustained.clone()));
            self.handed.iter().for_each(|cue| _ = feel.send(cue));
        }
        let sustained = both.as_ref().unwrap_or(step.sustained);
        match &mut self.trial {
            Some(trial) => {
                if !trial.step(at, sustained, feel) {
                    self.trial = None;
                }
            }
            None => feel.sustain(sustained),
        }
    }

    /// Plays up to `until`; actuators that fail are dropped with a warning.
    pub(super) fn play_until(&mut self, until: Instant) {
        if let Some(actuators) = &mut self.actuators
            && let Err(error) = actuators.advance(until)
        {
            warn!("the actuators are dropped: {error}");
            self.actuators = None;
        }
    }

    /// Lets the actuators fade out; a second time changes nothing.
    pub(super) fn fade_out(&mut self, now: Instant) {
        let Some(feel) = self.feel.as_mut().filter(|feel| !feel.is_silenced()) else { return };
        feel.silence();
        self.play_until(now + FADE);
        let keeps_its_own_time =
            self.actuators.as_ref().is_some_and(|actuators| actuators.device(&mut DeviceStatus::default()));
        if keeps_its_own_time {
            std::thread::sleep(FADE);
        }
    }

    /// Mutes everything, or ends that; whether that is new.
    pub(super) fn mute(&mut self, on: bool, floor_is_lost: bool) -> Result<bool, MuteError> {
        if self.feel.is_none() {
            return Err(MuteError::Unplayed);
        }
        let is_news = std::mem::replace(&mut self.muted.all, on) != on;
        self.update_mute(floor_is_lost);
        Ok(is_news)
    }

    /// Mutes one tile, or ends that; tiles on the same channel go with it. Whether that is new.
    pub(super) fn mute_tile(
        &mut self,
        tile: TileId,
        on: bool,
        geometry: &Geometry,
    ) -> Result<bool, MuteError> {
        let feel = self.feel.as_mut().ok_or(MuteError::Unplayed)?;
        let index = geometry.index(tile).ok_or(MuteError::OffTheFloor)?;
        let number = u16::try_from(index).map_err(|_| MuteError::OffTheFloor)?;
        if !feel.mute(number, on) {
            return Err(MuteError::Unmoved);
        }
        let before = self.muted.tiles.len();
        let muted = (0..).zip(geometry.tiles()).filter(|(number, _)| feel.mutes(*number));
        self.muted.tiles.clear();
        self.muted.tiles.extend(muted.map(|(_, tile)| tile));
        Ok(self.muted.tiles.len() != before)
    }

    /// Lets nothing be felt while the floor is lost or somebody wants it so.
    pub(super) fn update_mute(&mut self, floor_is_lost: bool) {
        match &mut self.feel {
            Some(feel) if self.muted.all || floor_is_lost => feel.silence(),
            Some(feel) => feel.resume(),
            None => {}
        }
    }

    /// What is muted.
    pub(super) fn muted(&self) -> &Muted {
        &self.muted
    }

    /// How the device is doing; `None` without one.
    pub(super) fn device(&self) -> Option<&DeviceStatus> {
        self.device.as_ref()
    }

    /// How the device is doing when that has changed, once a second at most.
    pub(super) fn device_news(&mut self, now: Instant) -> Option<&DeviceStatus> {
        let mut status = self.device.take().unwrap_or_default();
        if !self.actuators.as_ref().is_some_and(|actuators| actuators.device(&mut status)) {
            return None;
        }
        let is_news = self
            .device_told
            .as_ref()
            .is_none_or(|(at, told)| now.since(*at) >= DEVICE_PERIOD && status.is_news_after(told));
        if is_news {
            self.device_told = Some((now, status.clone()));
        }
        self.device = Some(status);
        self.device.as_ref().filter(|_| is_news)
    }

    /// What could not be felt as it should so far, or was not to be.
    pub(super) fn counters(&self) -> FeelCounters {
        self.feel.as_ref().map(CueSender::counters).unwrap_or_default()
    }
}
