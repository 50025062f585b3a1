// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

use std::f32::consts::{FRAC_PI_4, PI};

use arrayvec::ArrayVec;
use multiversion::multiversion;

use super::mix::{Mix, Output, Wiring};
use super::{Friction, MAX_RUBS, MAX_SPOTS, Rub, Rubs};

/// Samples between two settings of the filters; levels are interpolated in between.
const STEP: usize = 32;

/// Voices that are computed side by side.
const LANES: usize = 8;

const GROUPS: usize = MAX_RUBS / LANES;

/// Sharpness of each of the two band-passes: as wide as possible with 95 % of the power inside 50 to 1000 Hz.
const Q: f32 = 2.0;

/// Where the centre of the band is held, for the same reason.
const CENTRE_HZ: std::ops::RangeInclusive<f32> = 75.0..=650.0;

/// Time in which level and centre follow the foot to 1/e.
const FOLLOW_S: f32 = 0.004;

/// Time in which a new rub fades in, and one that is over fades out.
const FADE_S: f32 = 0.015;

/// A share of a texture below this (-100 dB) is none.
const FAINT: f32 = 1e-5;

/// A rub that was not renewed for this long is over: whoever sends them may have died.
const STALE_S: f32 = 0.05;

/// The rubbing textures of all feet.
///
/// Each rub has its own noise, shaped by two band-passes in a row whose centre
/// rises with the slip speed, and is felt on the tiles under the foot.
///
/// The level is a root mean square: a rub of 2 N at full speed and force is as
/// strong as a 2 N sine. Both level and centre are linear in speed, the level
/// in force too; all stop at their upper ends.
///
/// # Source
/// Trapezoidal state-variable filter, stable however its centre moves:
/// A. Simper, "Linear Trapezoidal Integrated State Variable Filter", 2013.
///
/// # Real-time
/// No allocation; without a rub nothing is computed.
#[derive(Clone, Debug)]
pub(super) struct Rubbing {
    sample_rate: f32,
    voices: [Voice; MAX_RUBS],
    groups: [Lanes; GROUPS],
    /// Samples since the last [`Rubbing::follow`].
    age: usize,
}

/// One rub as it sounds now.
#[derive(Clone, Debug, Default)]
struct Voice {
    key: u32,
    state: State,
    speed_share: f32,
    level_n: f32,
    wanted_speed_share: f32,
    wanted_level_n: f32,
    friction: Option<Friction>,
    /// Rises to 1 in [`FADE_S`] and falls to 0 in the same time when the rub is over.
    fade: f32,
    reaches: ArrayVec<Reach, { 2 * MAX_SPOTS }>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    #[default]
    Free,
    Rubbing,
    Fading,
}

/// A channel under the foot, or one it has just left.
#[derive(Clone, Copy, Debug)]
struct Reach {
    output: Output,
    weight: f32,
    wanted: f32,
    /// The gain that the last step ended with.
    gain: f32,
}

/// The noise and filters of several voices.
#[derive(Clone, Debug)]
#[repr(align(64))]
struct Lanes {
    noise: [u32; LANES],
    coefficients: [[f32; LANES]; 3],
    /// 1 for a lane in use, 0 for one at rest.
    drive: [f32; LANES],
    /// The two integrators of each of the two filters.
    integrators: [[f32; LANES]; 4],
}

impl Rubbing {
    pub(super) fn new(sample_rate: f32) -> Self {
        Self {
            sample_rate,
            voices: std::array::from_fn(|_| Voice::default()),
            groups: std::array::from_fn(Lanes::new),
            age: 0,
        }
    }

    /// Stops everything at once.
    pub(super) fn clear(&mut self) {
        for (number, voice) in self.voices.iter_mut().enumerate() {
            voice.state = State::Free;
            self.groups[number / LANES].rest(number % LANES);
        }
    }

    /// Takes the rubs as they are now; a rub that is no longer among them fades out.
    ///
    /// The answer is the number of spots of new rubs that no actuator can play.
    pub(super) fn follow(&mut self, rubs: &Rubs, wiring: &Wiring) -> u32 {
        self.age = 0;
        for voice in &mut self.voices {
            if voice.state == State::Rubbing && !rubs.iter().any(|rub| rub.key == voice.key) {
                voice.state = State::Fading;
            }
        }
        rubs.iter().map(|rub| self.voice_for(rub.key).follow(rub, wiring)).sum()
    }

    /// The voice of this rub; a new one takes a free voice, or the one that has faded furthest.
    fn voice_for(&mut self, key: u32) -> &mut Voice {
        let held = self.voices.iter().position(|voice| voice.state != State::Free && voice.key == key);
        let number = held.unwrap_or_else(|| {
            let remains = |voice: &Voice| match voice.state {
                State::Free => -1.0,
                State::Fading => voice.fade,
                State::Rubbing => 2.0,
            };
            (0..MAX_RUBS)
                .min_by(|a, b| remains(&self.voices[*a]).total_cmp(&remains(&self.voices[*b])))
                .unwrap_or(0)
        });
        if held.is_none() {
            self.groups[number / LANES].rest(number % LANES);
            self.voices[number] = Voice { key, ..Voice::default() };
        }
        &mut self.voices[number]
    }

    /// Adds the next `frames` samples to the channels under the feet.
    pub(super) fn render(&mut self, mix: &mut Mix, frames: usize) {
        self.age = self.age.saturating_add(frames);
        if self.age as f32 > STALE_S * self.sample_rate {
            for voice in &mut self.voices {
                if voice.state == State::Rubbing {
                    voice.state = State::Fading;
                }
            }
        }
        for start in (0..frames).step_by(STEP) {
            let samples = STEP.min(frames - start);
            for group in 0..GROUPS {
                self.render_group(group, mix, start, samples);
            }
        }
    }

    fn render_group(&mut self, group: usize, mix: &mut Mix, start: usize, samples: usize) {
        let voices = &mut self.voices[group * LANES..(group + 1) * LANES];
        if voices.iter().all(|voice| voice.state == State::Free) {
            return;
        }
        let lanes = &mut self.groups[group];
        for (lane, voice) in voices.iter_mut().enumerate() {
            if voice.state != State::Free {
                lanes.tune(lane, voice.step(samples, self.sample_rate), self.sample_rate);
            }
        }
        let mut noise = [[0.0; LANES]; STEP];
        shape_noise(lanes, &mut noise[..samples]);
        for (lane, voice) in voices.iter_mut().enumerate() {
            if voice.state == State::Free {
                continue;
            }
            voice.add(lane, &noise[..samples], mix, start, self.sample_rate);
            if voice.state == State::Fading && voice.fade == 0.0 {
                voice.state = State::Free;
                lanes.rest(lane);
            }
        }
    }
}

impl Voice {
    /// Heads for what the rub is now; the answer is how many spots of a new rub no actuator can play.
    fn follow(&mut self, rub: &Rub, wiring: &Wiring) -> u32 {
        let friction = rub.friction;
        let speed = share(rub.speed_m_s, friction.full_speed_m_s);
        let force = share(rub.force.0, friction.full_force.0);
        let level = if friction.level.0.is_finite() { friction.level.0 } else { 0.0 };
        self.wanted_speed_share = speed;
        self.wanted_level_n = felt(level * speed * force);
        self.friction = Some(friction);
        let new = self.state == State::Free;
        if new {
            // A new rub starts at its own pitch; its fade makes it start from silence.
            self.speed_share = self.wanted_speed_share;
            self.level_n = self.wanted_level_n;
        }
        self.state = State::Rubbing;

        for reach in &mut self.reaches {
            reach.wanted = 0.0;
        }
        let mut unfelt = 0;
        for spot in &rub.spots {
            let weight = if spot.weight > FAINT { spot.weight.min(1.0) } else { 0.0 };
            let Some(output) = wiring.output(spot.tile) else {
                unfelt += u32::from(new);
                continue;
            };
            if let Some(reach) = self.reaches.iter_mut().find(|reach| reach.output == output) {
                reach.wanted += weight;
                continue;
            }
            if self.reaches.is_full()
                && let Some(left) = self.reaches.iter().position(|reach| reach.wanted == 0.0)
            {
                self.reaches.swap_remove(left);
            }
            // There is room: at most four spots are wanted at once.
            let _ = self.reaches.try_push(Reach { output, weight: 0.0, wanted: weight, gain: 0.0 });
        }
        unfelt
    }

    /// Moves on by `samples`; the answer is the centre of the band, in hertz.
    fn step(&mut self, samples: usize, sample_rate: f32) -> f32 {
        let seconds = samples as f32 / sample_rate;
        let pull = 1.0 - (-seconds / FOLLOW_S).exp();
        self.speed_share += (self.wanted_speed_share - self.speed_share) * pull;
        self.level_n = felt(self.level_n + (self.wanted_level_n - self.level_n) * pull);
        match self.state {
            State::Fading => self.fade = (self.fade - seconds / FADE_S).max(0.0),
            State::Rubbing | State::Free => self.fade = (self.fade + seconds / FADE_S).min(1.0),
        }
        for reach in &mut self.reaches {
            reach.weight += (reach.wanted - reach.weight) * pull;
        }
        self.centre_hz()
    }

    fn centre_hz(&self) -> f32 {
        let Some(friction) = self.friction else { return *CENTRE_HZ.start() };
        let centre = friction.low_hz + (friction.high_hz - friction.low_hz) * self.speed_share;
        if centre.is_nan() { *CENTRE_HZ.start() } else { centre.clamp(*CENTRE_HZ.start(), *CENTRE_HZ.end()) }
    }

    /// Adds this voice's column of `noise` to its channels, its gain going evenly from the last step's to this one's.
    fn add(&mut self, lane: usize, noise: &[[f32; LANES]], mix: &mut Mix, start: usize, sample_rate: f32) {
        // White noise in -1..1 has a mean square of 1/3; a pair of band-passes lets pi/4 * centre/Q hertz of it through.
        let through = FRAC_PI_4 * self.centre_hz() / Q / (0.5 * sample_rate) / 3.0;
        // A sine's root mean square is its amplitude over the root of two.
        let level = self.level_n * self.fade / (2.0 * through).sqrt();
        let mut own = [0.0; STEP];
        for (sample, frame) in own.iter_mut().zip(noise) {
            *sample = frame[lane];
        }
        for reach in &mut self.reaches {
            let gain = level * reach.weight * reach.output.per_newton;
            let slope = (gain - reach.gain) / noise.len() as f32;
            let row = &mut mix.row(reach.output.channel)[start..start + noise.len()];
            for ((sample, noise), n) in row.iter_mut().zip(&own).zip(1_u16..) {
                *sample += noise * (reach.gain + slope * f32::from(n));
            }
            reach.gain = gain;
        }
        self.reaches.retain(|reach| reach.wanted > 0.0 || reach.weight > FAINT);
    }
}

/// `level_n`, or zero if it is below any that is felt: a level that fades for ever would end in denormal numbers.
fn felt(level_n: f32) -> f32 {
    if level_n > 1e-6 { level_n } else { 0.0 }
}

/// `value` as a share of `full`, 0 to 1; 0 if there is no sense in it.
fn share(value: f32, full: f32) -> f32 {
    let share = value / full;
    if share > 0.0 { share.min(1.0) } else { 0.0 }
}

impl Lanes {
    fn new(group: usize) -> Self {
        Self {
            // Any odd seeds do, as long as they differ and none is zero.
            noise: std::array::from_fn(|lane| {
                0x9E37_79B9_u32.wrapping_mul((group * LANES + lane) as u32 * 2 + 1)
            }),
            coefficients: [[0.0; LANES]; 3],
            drive: [0.0; LANES],
            integrators: [[0.0; LANES]; 4],
        }
    }

    /// Sets the centre of one lane's filters.
    fn tune(&mut self, lane: usize, centre_hz: f32, sample_rate: f32) {
        let g = (PI * centre_hz / sample_rate).tan();
        let a1 = 1.0 / (1.0 + g * (g + 1.0 / Q));
        self.coefficients[0][lane] = a1;
        self.coefficients[1][lane] = g * a1;
        self.coefficients[2][lane] = g * g * a1;
        self.drive[lane] = 1.0;
    }

    fn rest(&mut self, lane: usize) {
        self.drive[lane] = 0.0;
        for integrator in &mut self.integrators {
            integrator[lane] = 0.0;
        }
    }
}

/// Fills each row of `out` with the next sample of every lane.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx2+fma", "x86_64+avx2+fma", "aarch64+neon"))]
fn shape_noise(lanes: &mut Lanes, out: &mut [[f32; LANES]]) {
    let [a1, a2, a3] = lanes.coefficients;
    for row in out {
        for lane in 0..LANES {
            // Marsaglia's xorshift: cheap, and white enough for skin and ear.
            let mut bits = lanes.noise[lane];
            bits ^= bits << 13;
            bits ^= bits >> 17;
            bits ^= bits << 5;
            lanes.noise[lane] = bits;
            let mut sample = bits as i32 as f32 * (lanes.drive[lane] / 2_147_483_648.0);
            for filter in 0..2 {
                let (s1, s2) = (lanes.integrators[2 * filter][lane], lanes.integrators[2 * filter + 1][lane]);
                let v3 = sample - s2;
                let v1 = a1[lane] * s1 + a2[lane] * v3;
                let v2 = s2 + a2[lane] * s1 + a3[lane] * v3;
                lanes.integrators[2 * filter][lane] = 2.0 * v1 - s1;
                lanes.integrators[2 * filter + 1][lane] = 2.0 * v2 - s2;
                sample = v1 / Q;
            }
            row[lane] = sample;
        }
    }
}
