//! An effect rendered alone, for a given motion of a foot.

use std::sync::Arc;
use std::time::Duration;

use super::{
    Clicks, Cue, Effect, EffectKind, Lasting, Player, RendererConfig, Spots, SustainedCue, SustainedCues,
    key, renderer,
};
use crate::floor::{Actuator, Floor, Geometry};
use crate::units::{Instant, Newtons};

/// The motion of a foot that tries an effect: a path of moments, with straight lines in between.
#[derive(Clone, Debug, PartialEq)]
pub struct Gesture {
    /// In order of time. Before the first moment its values hold; after the last one its values stay.
    pub moments: Vec<Moment>,
    /// Time of the press, in seconds; a held effect begins then too.
    pub press_s: Option<f32>,
    /// Time of the release, in seconds.
    pub release_s: Option<f32>,
    /// Whether an effect that can be held or played once is held.
    pub holds: bool,
    /// Duration of the whole gesture, in seconds.
    pub length_s: f32,
}

/// The foot at one moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moment {
    /// Seconds from the start.
    pub at_s: f32,
    /// Slip speed, in metres per second.
    pub speed_m_s: f32,
    /// Normal force.
    pub force: Newtons,
    /// Value of the control, 0 to 1.
    pub value: f32,
    /// Distance of the foot beyond an end, in metres.
    pub beyond_m: f32,
}

/// Maximum length of a gesture, in seconds.
const LONGEST_S: f32 = 60.0;

impl Gesture {
    /// The usual gesture for this kind of effect: a press and a release; two strokes, the second one harder; a slide
    /// up and down; a slide into the end and on.
    #[must_use]
    pub fn usual(effect: &Effect) -> Self {
        let still =
            Self { moments: Vec::new(), press_s: Some(0.02), release_s: None, holds: false, length_s: 0.3 };
        match &effect.kind {
            EffectKind::Click(Clicks { press, release }) => {
                let first = 0.02 + press.length_s().clamp(0.08, 0.6);
                let second = release.as_ref().map_or(0.0, |release| release.length_s().clamp(0.08, 0.6));
                let release_s = release.as_ref().map(|_| first);
                Self { release_s, length_s: first + second, ..still }
            }
            EffectKind::Detents(_) => {
                let at = |at_s, value| Moment {
                    at_s,
                    value,
                    speed_m_s: 0.3,
                    force: Newtons(100.0),
                    beyond_m: 0.0,
                };
                let moments = vec![at(0.05, 0.02), at(1.25, 0.98), at(1.45, 0.98), at(2.65, 0.02)];
                Self { moments, press_s: None, length_s: 2.8, ..still }
            }
            EffectKind::EndStop(end) => {
                let full = end.push.map_or(0.03, |push| push.full_m);
                let at = |at_s, speed_m_s, value, beyond_m| Moment {
                    at_s,
                    speed_m_s,
                    value,
                    beyond_m,
                    force: Newtons(100.0),
                };
                let moments = vec![
                    at(0.0, 0.35, 0.7, 0.0),
                    at(0.3, 0.35, 1.0, 0.0),
                    at(0.9, 0.06, 1.0, full),
                    at(1.1, 0.06, 1.0, full),
                    at(1.4, 0.12, 1.0, 0.0),
                    at(1.5, 0.15, 0.9, 0.0),
                ];
                Self { moments, press_s: None, length_s: 1.6, ..still }
            }
            kind if kind.lasting().is_some() => {
                let (speed, force) = full(effect);
                let mut moments = Vec::new();
                for (start, share) in [(0.05_f32, 0.5), (1.35, 1.0)] {
                    for step in 0..=24_u8 {
                        let part = f32::from(step) / 24.0;
                        let at_s = start + 1.2 * part;
                        let speed_m_s = speed * (std::f32::consts::PI * part).sin();
                        moments.push(Moment { at_s, speed_m_s, force: force * share, ..Moment::default() });
                    }
                }
                Self { moments, press_s: None, length_s: 2.65, ..still }
            }
            kind => {
                let played_s = kind.timeline().map(|timeline| timeline.end_s().min(LONGEST_S));
                Self { length_s: played_s.map_or(1.0, |played_s| 0.1 + played_s), ..still }
            }
        }
    }

    /// A foot that slides at constant speed and force for so many seconds.
    #[must_use]
    pub fn steady(speed_m_s: f32, force: Newtons, length_s: f32) -> Self {
        let moment = Moment { speed_m_s, force, ..Moment::default() };
        Self { moments: vec![moment], press_s: None, release_s: None, holds: false, length_s }
    }

    /// The foot `t` seconds after the start.
    #[must_use]
    pub fn at(&self, t: f32) -> Moment {
        let after = self.moments.iter().position(|moment| moment.at_s > t).unwrap_or(self.moments.len());
        let before = after.checked_sub(1).and_then(|before| self.moments.get(before));
        match (before, self.moments.get(after)) {
            (None, None) => Moment::default(),
            (Some(moment), None) | (None, Some(moment)) => Moment { at_s: t, ..*moment },
            (Some(a), Some(b)) => {
                let share = (t - a.at_s) / (b.at_s - a.at_s).max(1e-6);
                let between = |a: f32, b: f32| a + (b - a) * share;
                Moment {
                    at_s: t,
                    speed_m_s: between(a.speed_m_s, b.speed_m_s),
                    force: Newtons(between(a.force.0, b.force.0)),
                    value: between(a.value, b.value),
                    beyond_m: between(a.beyond_m, b.beyond_m),
                }
            }
        }
    }
}

/// Slip speed and normal force at which a rubbed material has its full level.
fn full(effect: &Effect) -> (f32, Newtons) {
    effect.kind.lasting().and_then(|lasting| lasting.full()).unwrap_or((0.6, Newtons(200.0)))
}

/// An effect under a gesture, rendered millisecond by millisecond.
#[derive(Clone, Debug)]
pub struct Audition {
    effect: Arc<Effect>,
    gesture: Gesture,
    start: Instant,
    player: Player,
    last: Option<Moment>,
    pressed: bool,
    released: bool,
    thud: bool,
}

/// The owner number of the audition's only foot; real contacts reach it after millions of steps.
const FOOT: u32 = 0x00FF_FFFF;

impl Audition {
    /// Tries `effect` under `gesture`, beginning at `start`.
    #[must_use]
    pub fn new(effect: Arc<Effect>, gesture: Gesture, start: Instant) -> Self {
        Self {
            effect,
            gesture,
            start,
            player: Player::default(),
            last: None,
            pressed: false,
            released: false,
            thud: false,
        }
    }

    /// Appends the cues at `now`; to be called about once a millisecond. Returns whether more follow.
    pub fn step(
        &mut self,
        now: Instant,
        spots: &Spots,
        cues: &mut Vec<Cue>,
        sustained: &mut SustainedCues,
    ) -> bool {
        let t = now.since(self.start).as_secs_f32();
        let moment = self.gesture.at(t);
        let last = self.last.replace(moment).unwrap_or(moment);
        let cue = |at: Instant| Cue { at, received: now, spots: spots.clone(), ..Cue::default() };
        let effect = Arc::clone(&self.effect);
        match &effect.kind {
            EffectKind::Detents(detents) => {
                // For a control without steps of its own, ten steps.
                let own = detents.every > 0.0;
                let stepped =
                    if own { detents.clone() } else { super::Detents { every: 0.1, ..detents.clone() } };
                if let Some(at) = stepped.passed(last.value, moment.value) {
                    let click = detents.click_at(at, moment.value > last.value);
                    cues.push(Cue { click, manner: effect.manner, ..cue(now) });
                }
            }
            EffectKind::EndStop(end) => {
                let at_end = moment.value >= 1.0 || moment.value <= 0.0;
                if at_end && !self.thud {
                    let click = end.click_at(moment.value >= 1.0, moment.speed_m_s);
                    cues.push(Cue { click, manner: effect.manner, ..cue(now) });
                }
                self.thud = at_end;
                if let Some(push) = end.push.filter(|_| at_end && moment.beyond_m > 0.0) {
                    self.sustain(Lasting::Hum(push.hum_at(moment.beyond_m)), moment, spots, sustained);
                }
            }
            kind => match kind.lasting() {
                Some(lasting) => self.sustain(lasting, moment, spots, sustained),
                None => self.press(t, &cue, cues),
            },
        }
        self.player.due(now, |_| Some(spots.clone()), cues, sustained);
        t < self.gesture.length_s
    }

    fn press(&mut self, t: f32, cue: &impl Fn(Instant) -> Cue, cues: &mut Vec<Cue>) {
        let moment = |seconds: f32| self.start + Duration::from_secs_f32(seconds.clamp(0.0, LONGEST_S));
        let effect = Arc::clone(&self.effect);
        if let Some(press_s) = self.gesture.press_s.filter(|press_s| *press_s <= t)
            && !self.pressed
        {
            self.pressed = true;
            let cue = cue(moment(press_s));
            if self.gesture.holds && !matches!(effect.kind, EffectKind::Click(_)) {
                self.player.hold(&effect, FOOT, &cue);
            } else {
                self.player.play(&effect, FOOT, false, cue, cues);
            }
        }
        if let Some(release_s) = self.gesture.release_s.filter(|release_s| *release_s <= t)
            && !self.released
        {
            self.released = true;
            self.player.let_go(|_| false);
            if matches!(effect.kind, EffectKind::Click(_)) {
                self.player.play(&effect, FOOT, true, cue(moment(release_s)), cues);
            }
        }
    }

    fn sustain(&self, effect: Lasting, moment: Moment, spots: &Spots, sustained: &mut SustainedCues) {
        // A single sustained cue always fits.
        let _ = sustained.try_push(SustainedCue {
            key: key(FOOT, 0),
            spots: spots.clone(),
            effect,
            manner: self.effect.manner,
            speed_m_s: moment.speed_m_s,
            force: moment.force,
            ..SustainedCue::default()
        });
    }
}

/// Full scale of the one actuator in auditions, in newtons: so high that the limiter changes nothing.
const FULL_SCALE_N: f32 = 4000.0;

/// Renders `effect` under `gesture`: newtons at the plate, `sample_rate` samples to the second.
#[must_use]
pub fn audition(effect: &Arc<Effect>, gesture: &Gesture, sample_rate: u32) -> Vec<f32> {
    let Ok(geometry) = Geometry::of_paper_tiles(1, 1) else { return Vec::new() };
    let mut floor = Floor::of(geometry);
    floor.actuators = vec![Some(Actuator { channel: 0, full_scale: Newtons(FULL_SCALE_N) })];
    let (mut sender, mut renderer) = renderer(RendererConfig::of(&floor, sample_rate));
    let rate = u64::from(renderer.sample_rate());
    let mut audition = Audition::new(Arc::clone(effect), gesture.clone(), Instant::START);
    let spots: Spots = [super::Spot { tile: 0, weight: 1.0 }].into_iter().collect();
    let (mut cues, mut samples) = (Vec::new(), Vec::new());
    let mut more = true;
    for ms in 0.. {
        let now = Instant::from_millis(ms);
        let mut sustained = SustainedCues::new();
        cues.clear();
        if more {
            more = audition.step(now, &spots, &mut cues, &mut sustained);
        } else {
            break;
        }
        cues.iter().for_each(|cue| {
            sender.send(cue);
        });
        sender.sustain(&sustained);
        // The present millisecond, in whole samples.
        let (from, to) = (ms * rate / 1000, (ms + 1) * rate / 1000);
        let begin = samples.len();
        samples.resize(begin + (to - from) as usize, 0.0);
        let start = Instant::from_micros(from * 1_000_000 / rate);
        renderer.render(&mut samples[begin..], start);
    }
    samples.iter_mut().for_each(|sample| *sample *= FULL_SCALE_N);
    samples
}
