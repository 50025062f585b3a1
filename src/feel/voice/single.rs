//! The control of one voice from slip speed and force.

use arrayvec::ArrayVec;

use super::duck::{Ducks, MAX_REACHES};
use super::group::VoiceInput;
use super::{Row, within};
use crate::feel::loudspeakers::{PER_NEWTON, Panned};
use crate::feel::mix::{CueOutput, FAINT, MixBlock, TileChannels};
use crate::feel::{Friction, Hum, Lasting, Manner, Spots, SustainedCue, Tone};

/// Time constant with which level, speed and pitch follow the foot: `y += (x - y) * dt / (FOLLOW_S + dt)`.
const FOLLOW_S: f32 = 0.004;

/// Time in which a new sustained cue fades in, and a finished one fades out.
const FADE_S: f32 = 0.015;

/// Maximum level of one voice, in newtons: far above the range of any actuator.
const STRONGEST_N: f32 = 1000.0;

/// One lasting effect in its present state.
#[derive(Clone, Debug, Default)]
pub(super) struct Voice {
    pub(super) key: u32,
    pub(super) state: VoiceState,
    pub(super) effect: Lasting,
    pub(super) manner: Manner,
    pub(super) group: usize,
    pub(super) lane: usize,
    /// The smoothed input, and its target.
    now: Wish,
    wanted: Wish,
    /// The tone in progress, and the time since its start.
    tone: Option<Tone>,
    clock_s: f32,
    /// Rises to 1 in [`FADE_S`] and falls to 0 in the same time when the sustained cue is over.
    fade: f32,
    reaches: ArrayVec<Reach, MAX_REACHES>,
    /// The two samples of the low rate between which the voice is.
    between: [f32; 2],
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum VoiceState {
    #[default]
    Free,
    /// A sustained cue with regular updates.
    Sustained,
    /// A tone that ends by itself.
    Sounding,
    Fading,
}

/// Level in newtons, speed in metres per second, share of the full force, pitch in hertz.
#[derive(Clone, Copy, Debug, Default)]
struct Wish {
    level_n: f32,
    speed: f32,
    force: f32,
    hz: f32,
}

/// A channel under the foot, a channel that it has just left, or the channel of a loudspeaker nearby.
#[derive(Clone, Copy, Debug)]
struct Reach {
    output: CueOutput,
    weight: f32,
    wanted: f32,
    /// The gain at the end of the last part.
    gain: f32,
}

/// A stretch of samples to be added, and the place of the device's samples between the voices'.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampleSpan<'a> {
    pub(super) start: usize,
    pub(super) samples: usize,
    /// Device samples since the last sample of the low rate.
    pub(super) phase: usize,
    /// 0, 1, 2, … over the number of device samples per sample of the low rate.
    pub(super) ramp: &'a [f32],
}

/// Maximum number of samples that are added at once.
pub(super) const STEP: usize = 64;

impl Voice {
    /// A voice for the sustained cue of this key, silent until it follows.
    pub(super) fn of(key: u32) -> Self {
        Self { key, ..Self::default() }
    }

    /// This voice in this lane.
    pub(super) fn in_lane(self, group: usize, lane: usize) -> Self {
        Self { group, lane, ..self }
    }

    /// A voice for a tone, audible from now on; the second value is the number of spots without an actuator.
    pub(super) fn sounding(
        tone: &Tone,
        manner: Manner,
        spots: &Spots,
        wiring: &TileChannels,
        heard: &Panned,
    ) -> (Self, u32) {
        let hum = Hum { level: tone.level, hz: tone.hz, noise: tone.noise };
        let mut voice = Self {
            state: VoiceState::Sounding,
            effect: Lasting::Hum(hum),
            manner,
            tone: Some(tone.clone()),
            fade: 1.0,
            ..Self::default()
        };
        let unfelt = voice.reach(spots, wiring, true);
        voice.sound(heard);
        // At the start there is no earlier place to move from.
        voice.reaches.iter_mut().for_each(|reach| reach.weight = reach.wanted);
        (voice, unfelt)
    }

    /// Sets the target to the present sustained cue; returns the number of spots without an actuator, for a new
    /// sustained cue.
    pub(super) fn follow(
        &mut self,
        sustained_cue: &SustainedCue,
        wiring: &TileChannels,
        heard: &Panned,
    ) -> u32 {
        let new = self.state == VoiceState::Free;
        self.wanted = wish(sustained_cue);
        if new {
            // A new sustained cue starts at its own pitch; its fade makes it start from silence.
            self.now = self.wanted;
        }
        self.effect = sustained_cue.effect;
        self.manner = sustained_cue.manner;
        self.state = VoiceState::Sustained;
        let unfelt = self.reach(&sustained_cue.spots, wiring, new);
        self.sound(heard);
        unfelt
    }

    /// Sets the targets for these spots.
    fn reach(&mut self, spots: &Spots, wiring: &TileChannels, new: bool) -> u32 {
        for reach in &mut self.reaches {
            reach.wanted = 0.0;
        }
        let mut unfelt = 0;
        for spot in spots {
            let weight = if spot.weight > FAINT { spot.weight.min(1.0) } else { 0.0 };
            let Some(output) = wiring.output(spot.tile) else {
                unfelt += u32::from(new);
                continue;
            };
            self.want(output, weight);
        }
        unfelt
    }

    /// Sets the targets for these loudspeakers as well; to be called after [`Voice::reach`].
    fn sound(&mut self, heard: &Panned) {
        for CueOutput { channel, per_newton } in heard {
            // The place of the sound changes as the foot moves: a weight expresses it, so that nothing jumps.
            let output = CueOutput { channel: *channel, per_newton: PER_NEWTON };
            self.want(output, per_newton / PER_NEWTON);
        }
    }

    fn want(&mut self, output: CueOutput, weight: f32) {
        if let Some(reach) = self.reaches.iter_mut().find(|reach| reach.output == output) {
            reach.wanted += weight;
            return;
        }
        if self.reaches.is_full()
            && let Some(left) = self.reaches.iter().position(|reach| reach.wanted == 0.0)
        {
            self.reaches.swap_remove(left);
        }
        // There is room: at most four spots and three loudspeakers are wanted at once.
        let _ = self.reaches.try_push(Reach { output, weight: 0.0, wanted: weight, gain: 0.0 });
    }

    /// The channels on which it is felt or heard.
    pub(super) fn channels(&self) -> impl Iterator<Item = usize> + '_ {
        self.reaches.iter().map(|reach| reach.output.channel)
    }

    /// Its present level, for the selection of the voice to steal.
    pub(super) fn loudness(&self) -> f32 {
        self.now.level_n * self.fade
    }

    /// Advances by `seconds`; returns the present input of the model.
    pub(super) fn step(&mut self, seconds: f32) -> VoiceInput {
        let pull = seconds / (FOLLOW_S + seconds);
        if let Some(tone) = &self.tone {
            self.clock_s += seconds;
            let (share, hz) = tone.at(self.clock_s);
            let level = within(tone.level.0, 0.0, STRONGEST_N);
            self.now = Wish { level_n: felt(level * within(share, 0.0, 4.0)), speed: 0.0, force: 0.0, hz };
        } else {
            let (now, wanted) = (&mut self.now, &self.wanted);
            now.level_n = felt(now.level_n + (wanted.level_n - now.level_n) * pull);
            now.speed = felt(now.speed + (wanted.speed - now.speed) * pull);
            now.force = felt(now.force + (wanted.force - now.force) * pull);
            now.hz += (wanted.hz - now.hz) * pull;
        }
        match self.state {
            VoiceState::Fading => self.fade = (self.fade - seconds / FADE_S).max(0.0),
            _ => self.fade = (self.fade + seconds / FADE_S).min(1.0),
        }
        for reach in &mut self.reaches {
            reach.weight += (reach.wanted - reach.weight) * pull;
        }
        VoiceInput { speed: self.now.speed, force: self.now.force, hz: self.now.hz }
    }

    /// Whether it can be freed.
    pub(super) fn is_over(&self) -> bool {
        match self.state {
            VoiceState::Fading => self.fade == 0.0,
            VoiceState::Sounding => !self.tone.as_ref().is_some_and(|tone| self.clock_s < tone.whole_s()),
            VoiceState::Free | VoiceState::Sustained => false,
        }
    }

    /// Adds its lane of `low` to its channels; the gain goes in a straight line from the last part's to this one's.
    pub(super) fn add(
        &mut self,
        number: usize,
        low: &[Row],
        mix: &mut MixBlock,
        ducks: &Ducks,
        span: &SampleSpan<'_>,
    ) {
        let mut own = [0.0; STEP];
        self.interpolate(low, &mut own[..span.samples], span);
        let level = self.now.level_n * self.fade;
        for reach in &mut self.reaches {
            let ducked = ducks.gain(reach.output.channel, number, self.manner.priority);
            let gain = level * reach.weight * reach.output.per_newton * ducked;
            if gain == 0.0 && reach.gain == 0.0 {
                continue;
            }
            let slope = (gain - reach.gain) / span.samples as f32;
            let row = &mut mix.row(reach.output.channel)[span.start..span.start + span.samples];
            for ((sample, own), n) in row.iter_mut().zip(&own).zip(1_u16..) {
                *sample += own * (reach.gain + slope * f32::from(n));
            }
            reach.gain = gain;
        }
        self.reaches.retain(|reach| reach.wanted > 0.0 || reach.weight > FAINT);
    }

    fn interpolate(&mut self, low: &[Row], own: &mut [f32], span: &SampleSpan<'_>) {
        let divisor = span.ramp.len();
        let mut next = low.iter();
        let (mut phase, mut rest) = (span.phase, own);
        while !rest.is_empty() {
            let run = rest.len().min(divisor - phase);
            let (part, later) = rest.split_at_mut(run);
            let [from, to] = self.between;
            for (sample, share) in part.iter_mut().zip(&span.ramp[phase..]) {
                *sample = from + (to - from) * share;
            }
            phase += run;
            if phase == divisor {
                phase = 0;
                self.between = [to, next.next().map_or(0.0, |row| row[self.lane])];
            }
            rest = later;
        }
    }
}

/// The targets for a sustained cue.
fn wish(sustained_cue: &SustainedCue) -> Wish {
    let level = |level: f32| within(level, 0.0, STRONGEST_N);
    let speed_m_s = within(sustained_cue.speed_m_s, 0.0, 20.0);
    match &sustained_cue.effect {
        Lasting::Hum(hum) => Wish { level_n: felt(level(hum.level.0)), speed: 0.0, force: 0.0, hz: hum.hz },
        Lasting::Friction(friction) => {
            let Friction { low_hz, high_hz, .. } = friction;
            let speed = share(speed_m_s, friction.full_speed_m_s);
            let force = share(sustained_cue.force.0, friction.full_force.0);
            let level_n = felt(level(friction.level.0) * speed * force);
            Wish { level_n, speed: speed_m_s, force, hz: low_hz + (high_hz - low_hz) * speed }
        }
        Lasting::StickSlip(stick) => {
            let material = &stick.material;
            let force = share(sustained_cue.force.0, material.full_force.0);
            let level_n = felt(level(material.level.0 * material.trim) * force);
            Wish { level_n, speed: speed_m_s, force, hz: 0.0 }
        }
        Lasting::Texture(_) | Lasting::Grains(_) => {
            let Some(material) = sustained_cue.effect.material() else { return Wish::default() };
            let force = share(sustained_cue.force.0, material.full_force.0);
            // The level of an impact grows with the root of the speed, and its rate with the speed: their power
            // equals that of a level that is linear in the speed.
            let hit = share(speed_m_s, material.full_speed_m_s).sqrt();
            let level_n = felt(level(material.level.0 * material.trim) * force * hit);
            Wish { level_n, speed: speed_m_s, force, hz: 0.0 }
        }
    }
}

/// `level`, or zero if it is too low to be felt: an endless fade would end in denormal numbers.
fn felt(level: f32) -> f32 {
    if level > 1e-6 { level } else { 0.0 }
}

/// `value` as a share of `full`, 0 to 1; 0 if that is not a number.
fn share(value: f32, full: f32) -> f32 {
    let share = value / full;
    if share > 0.0 { share.min(1.0) } else { 0.0 }
}
