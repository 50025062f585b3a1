//! Haptic output: cues to the renderer, the actuators that play it, and muting.

use std::time::Duration;

use thiserror::Error;
use tracing::warn;

use crate::engine::FrameResults;
use crate::feel::{Cue, CueSender, DeviceStatus, FeelCounters, Muted};
use crate::floor::{Geometry, TileId};
use crate::serve::Neighbours;
use crate::serve::trial::EffectTrial;
use crate::sink::{ActuatorSink, LatencyStages};
use crate::units::Instant;

/// Time for the actuators to fade out: the 5 ms of the fade, and the longest usual block of a sound card.
const FADE: Duration = Duration::from_millis(50);

/// Minimum time between two reports of the device status.
const DEVICE_PERIOD: Duration = Duration::from_secs(1);

/// Reasons why muting fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub(super) enum MuteError {
    /// The floor has no actuators.
    #[error("this floor plays nothing that could be muted")]
    Unplayed,
    /// The tile is outside the floor.
    #[error("the floor has no such tile")]
    OffTheFloor,
    /// The tile has no actuator.
    #[error("nothing moves that tile")]
    Unmoved,
}

/// Cues out, and the device that plays them; without a renderer nothing is played.
#[derive(Default)]
pub(super) struct Haptics {
    pub(super) feel: Option<CueSender>,
    pub(super) actuators: Option<Box<dyn ActuatorSink>>,
    /// The computers that drive the tiles next to those of this one.
    pub(super) neighbours: Option<Box<dyn Neighbours>>,
    /// Cues received last from the neighbours.
    handed: Vec<Cue>,
    /// An effect on trial.
    pub(super) trial: Option<EffectTrial>,
    /// Records latency, if requested; the time is that of the last packet.
    pub(super) latency: Option<(LatencyStages, Instant)>,
    muted: Muted,
    /// The device status, if there is a device, and its last report.
    device: Option<DeviceStatus>,
    device_told: Option<(Instant, DeviceStatus)>,
}

impl Haptics {
    /// Records that a packet arrived at `now`.
    pub(super) fn note_packet(&mut self, now: Instant) {
        if let Some((_, taken)) = &mut self.latency {
            *taken = now;
        }
    }

    /// Sends everything that is due to neighbours at `now`.
    pub(super) fn poll_neighbours(&mut self, now: Instant) {
        if let Some(neighbours) = &mut self.neighbours {
            neighbours.poll(now);
        }
    }

    /// Sends the cues of a frame of time `at`; `now` is the present.
    pub(super) fn send(&mut self, step: &FrameResults<'_>, at: Instant, now: Instant) {
        let Some(feel) = &mut self.feel else { return };
        if let Some((stages, taken)) = self.latency.as_ref().filter(|_| !step.cues.is_empty()) {
            feel.note_time(now);
            for cue in step.cues {
                stages.link.record(taken.since(cue.received));
                stages.engine.record(now.since(*taken));
            }
        }
        for cue in step.cues {
            // The sender counts the cues that it cannot send.
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

    /// Plays up to `until`; drops actuators that fail, with a warning.
    pub(super) fn play_until(&mut self, until: Instant) {
        if let Some(actuators) = &mut self.actuators
            && let Err(error) = actuators.advance(until)
        {
            warn!("the actuators are dropped: {error}");
            self.actuators = None;
        }
    }

    /// Lets the actuators fade out; a second call changes nothing.
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

    /// Mutes or unmutes everything; returns whether that is a change.
    pub(super) fn mute(&mut self, on: bool, floor_is_lost: bool) -> Result<bool, MuteError> {
        if self.feel.is_none() {
            return Err(MuteError::Unplayed);
        }
        let is_news = std::mem::replace(&mut self.muted.all, on) != on;
        self.update_mute(floor_is_lost);
        Ok(is_news)
    }

    /// Mutes or unmutes one tile and all tiles on the same channel; returns whether that is a change.
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

    /// Silences the output while the floor is lost or everything is muted.
    pub(super) fn update_mute(&mut self, floor_is_lost: bool) {
        match &mut self.feel {
            Some(feel) if self.muted.all || floor_is_lost => feel.silence(),
            Some(feel) => feel.resume(),
            None => {}
        }
    }

    /// Returns the mute state.
    pub(super) fn muted(&self) -> &Muted {
        &self.muted
    }

    /// Returns the device status; `None` without a device.
    pub(super) fn device(&self) -> Option<&DeviceStatus> {
        self.device.as_ref()
    }

    /// Returns the device status if it has changed, at most once a second.
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

    /// Returns the counts of cues that were lost, altered or muted so far.
    pub(super) fn counters(&self) -> FeelCounters {
        self.feel.as_ref().map(CueSender::counters).unwrap_or_default()
    }
}
