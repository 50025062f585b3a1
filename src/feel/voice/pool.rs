//! All voices: assigns effects to voices, and selects the one that is stolen when there are too many.

use super::duck::Ducks;
use super::group::{Group, Model};
use super::single::{STEP, SampleSpan, Voice, VoiceState};
use super::{LANES, LowRate};
use crate::feel::loudspeakers::Loudspeakers;
use crate::feel::mix::{MixBlock, TileChannels};
use crate::feel::{Cue, MAX_SUSTAINED, Manner, SustainedCue, SustainedCues, Tone};

/// Enough for [`MAX_SUSTAINED`] voices with every distribution over the models.
const GROUPS: usize = MAX_SUSTAINED / LANES + 5;

/// A sustained cue without an update for this long is over: its sender may have stopped.
const STALE_S: f32 = 0.05;

/// All voices of lasting effects.
///
/// # Real-time
/// No allocation; without a voice no computation.
#[derive(Clone, Debug)]
pub(in crate::feel) struct Voices {
    rate: LowRate,
    sample_rate: f32,
    voices: Vec<Voice>,
    groups: Vec<Group>,
    ducks: Ducks,
    /// Device samples since the last sample of the low rate.
    phase: usize,
    ramp: Vec<f32>,
    /// Samples since the last [`Voices::follow`].
    age: usize,
    active: usize,
}

/// The result of starting a voice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::feel) struct Started {
    /// Spots that no actuator can play.
    pub(in crate::feel) unfelt: u32,
    /// Voices stolen, including the new one itself if it had the lowest priority.
    pub(in crate::feel) stolen: u32,
}

impl Voices {
    pub(in crate::feel) fn new(sample_rate: f32, channels: usize) -> Self {
        let rate = LowRate::of(sample_rate);
        Self {
            rate,
            sample_rate,
            voices: vec![Voice::default(); MAX_SUSTAINED],
            groups: (0..GROUPS).map(Group::new).collect(),
            ducks: Ducks::new(channels),
            phase: 0,
            ramp: (0..rate.divisor).map(|n| n as f32 / rate.divisor as f32).collect(),
            age: 0,
            active: 0,
        }
    }

    /// Stops everything at once.
    pub(in crate::feel) fn clear(&mut self) {
        for number in 0..self.voices.len() {
            self.free(number);
        }
        self.ducks.clear();
    }

    /// Takes the present sustained cues; a sustained cue that is no longer among them fades out.
    pub(in crate::feel) fn follow(
        &mut self,
        sustained: &SustainedCues,
        wiring: &TileChannels,
        air: &Loudspeakers,
    ) -> Started {
        self.age = 0;
        for voice in &mut self.voices {
            if voice.state == VoiceState::Sustained
                && !sustained.iter().any(|sustained_cue| sustained_cue.key == voice.key)
            {
                voice.state = VoiceState::Fading;
            }
        }
        let mut started = Started::default();
        for sustained_cue in sustained {
            let Some(number) = self.voice_for(sustained_cue, &mut started) else { continue };
            started.unfelt += self.voices[number].follow(
                sustained_cue,
                wiring,
                &air.pan(&sustained_cue.spots, sustained_cue.audio_gain, None),
            );
        }
        started
    }

    /// Plays the tone of `cue` from now on.
    pub(in crate::feel) fn start(
        &mut self,
        cue: &Cue,
        tone: &Tone,
        wiring: &TileChannels,
        air: &Loudspeakers,
    ) -> Started {
        let heard = air.pan(&cue.spots, cue.audio_gain, cue.heard_at);
        let (voice, unfelt) = Voice::sounding(tone, cue.manner, &cue.spots, wiring, &heard);
        let mut started = Started { unfelt, stolen: 0 };
        if let Some(number) = self.claim(Model::Hiss, cue.manner, tone.level.0, &mut started) {
            let (group, lane) = (self.voices[number].group, self.voices[number].lane);
            self.voices[number] = voice.in_lane(group, lane);
        }
        started
    }

    /// Ducks lasting voices on `channel` while a click of this `manner` rings.
    pub(in crate::feel) fn duck(&mut self, channel: usize, manner: &Manner, seconds: f32) {
        self.ducks.press(channel, manner, seconds, None);
    }

    /// The voice that plays `sustained_cue` already, or a new one.
    fn voice_for(&mut self, sustained_cue: &SustainedCue, started: &mut Started) -> Option<usize> {
        let model = Model::of(&sustained_cue.effect);
        let plays = |voice: &Voice| {
            matches!(voice.state, VoiceState::Sustained | VoiceState::Fading)
                && voice.key == sustained_cue.key
        };
        let held = self.voices.iter().position(plays);
        if let Some(number) = held {
            let is_same = self.voices[number].effect == sustained_cue.effect
                && self.voices[number].manner == sustained_cue.manner;
            if Model::of(&self.voices[number].effect) == model {
                if !is_same {
                    let (group, lane) = (self.voices[number].group, self.voices[number].lane);
                    self.groups[group].prepare(
                        lane,
                        &sustained_cue.effect,
                        sustained_cue.manner.band.sound(),
                        self.rate.hz,
                    );
                }
                return Some(number);
            }
            self.free(number);
        }
        let number = self.claim(model, sustained_cue.manner, 0.0, started)?;
        let (group, lane) = (self.voices[number].group, self.voices[number].lane);
        self.groups[group].prepare(
            lane,
            &sustained_cue.effect,
            sustained_cue.manner.band.sound(),
            self.rate.hz,
        );
        self.voices[number] = Voice::of(sustained_cue.key).in_lane(group, lane);
        Some(number)
    }

    /// A free voice with a lane of `model`. If there is none, steals the voice with the lowest priority, the faintest
    /// of several, unless the new one has a lower priority itself.
    fn claim(&mut self, model: Model, manner: Manner, loudness: f32, started: &mut Started) -> Option<usize> {
        loop {
            let free = self.voices.iter().position(|voice| voice.state == VoiceState::Free);
            let lane = self.lane(model);
            if let (Some(number), Some((group, lane))) = (free, lane) {
                self.voices[number].group = group;
                self.voices[number].lane = lane;
                self.active += 1;
                return Some(number);
            }
            if let Some((group, lane)) = lane {
                self.groups[group].release(lane);
            }
            let rank =
                |voice: &Voice| (voice.state != VoiceState::Fading, voice.manner.priority, voice.loudness());
            let victim = (0..self.voices.len())
                .filter(|&number| self.voices[number].state != VoiceState::Free)
                .min_by(|a, b| {
                    let (a, b) = (rank(&self.voices[*a]), rank(&self.voices[*b]));
                    (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2))
                })?;
            started.stolen += 1;
            let (lasts, priority, level) = rank(&self.voices[victim]);
            if lasts && (manner.priority, loudness) < (priority, level) && manner.priority < priority {
                return None;
            }
            self.free(victim);
        }
    }

    /// A lane of `model`; a group that already has the model is better than a fresh one.
    fn lane(&mut self, model: Model) -> Option<(usize, usize)> {
        for fresh in [false, true] {
            for (number, group) in self.groups.iter_mut().enumerate() {
                if group.is_silent() == fresh
                    && let Some(lane) = group.claim(model)
                {
                    return Some((number, lane));
                }
            }
        }
        None
    }

    fn free(&mut self, number: usize) {
        let voice = &mut self.voices[number];
        if voice.state != VoiceState::Free {
            voice.state = VoiceState::Free;
            self.groups[voice.group].release(voice.lane);
            self.active -= 1;
        }
    }

    /// Adds the samples from `start` to `end` of the block at hand to the channels under the feet and of the
    /// loudspeakers.
    pub(in crate::feel) fn render(&mut self, mix: &mut MixBlock, start: usize, end: usize) {
        self.age = self.age.saturating_add(end.saturating_sub(start));
        if self.age as f32 > STALE_S * self.sample_rate {
            for voice in &mut self.voices {
                if voice.state == VoiceState::Sustained {
                    voice.state = VoiceState::Fading;
                }
            }
        }
        for start in (start..end).step_by(STEP) {
            let samples = STEP.min(end - start);
            let ready = self.phase + samples;
            self.ducks.step(samples as f32 / self.sample_rate);
            if self.active > 0 {
                self.render_part(mix, start, samples, ready / self.rate.divisor);
            }
            self.phase = ready % self.rate.divisor;
        }
    }

    fn render_part(&mut self, mix: &mut MixBlock, start: usize, samples: usize, low_samples: usize) {
        let seconds = samples as f32 / self.sample_rate;
        for (number, voice) in self.voices.iter_mut().enumerate() {
            if voice.state == VoiceState::Free {
                continue;
            }
            let drive = voice.step(seconds);
            let band = voice.manner.band.sound();
            self.groups[voice.group].tune(voice.lane, &voice.effect, drive, band, self.rate.hz);
            if voice.manner.duck_db > 0.0 && voice.state != VoiceState::Fading {
                for channel in voice.channels() {
                    self.ducks.press(channel, &voice.manner, 2.0 * seconds, Some(number));
                }
            }
        }
        let mut low = [[0.0; LANES]; STEP];
        let low = &mut low[..low_samples];
        let span = SampleSpan { start, samples, phase: self.phase, ramp: &self.ramp };
        for group in 0..GROUPS {
            if self.groups[group].is_silent() {
                continue;
            }
            self.groups[group].render(low);
            for (number, voice) in self.voices.iter_mut().enumerate() {
                if voice.state != VoiceState::Free && voice.group == group {
                    voice.add(number, low, mix, &self.ducks, &span);
                }
            }
        }
        for number in 0..self.voices.len() {
            if self.voices[number].is_over() {
                self.free(number);
            }
        }
    }
}
