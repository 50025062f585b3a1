//! Plays effects part by part as time goes on.

use std::sync::Arc;
use std::time::Duration;

use arrayvec::ArrayVec;

use super::{
    Clicks, Cue, Effect, EffectKind, Hum, Lasting, MAX_SUSTAINED, PartKind, Spots, SustainedCue,
    SustainedCues,
};
use crate::units::{Instant, Newtons};

/// Maximum number of effects that are played or held at once; a further one ends the oldest.
const MAX_PLAYING: usize = 16;

/// Plays effects part by part as time goes on: cues at the start of parts, sustained cues for held ones.
///
/// It has no clock: its owner passes the time about once a millisecond, and gets each part up to a millisecond early,
/// so that the part can begin at its own sample.
///
/// # Real-time
/// No allocation beyond the list of cues that is handed in.
#[derive(Clone, Debug, Default)]
pub struct Player {
    playing: ArrayVec<Playing, MAX_PLAYING>,
}

#[derive(Clone, Debug)]
struct Playing {
    effect: Arc<Effect>,
    owner: u32,
    /// Whether it lasts until [`Player::let_go`].
    held: bool,
    at: Instant,
    received: Instant,
    next: usize,
    spots: Spots,
    audio_gain: f32,
}

/// Time by which a part is returned early.
const AHEAD: Duration = Duration::from_millis(1);

impl Player {
    /// Plays `effect` once from `at` on.
    ///
    /// `owner` identifies the cause, such as a contact's number; [`Player::due`] asks for the place of its foot. A
    /// click plays its release part for a release, if it has one. Effects that only last or are driven by a value
    /// (see [`super::Use::Once`]) are not played.
    pub fn play(&mut self, effect: &Arc<Effect>, owner: u32, release: bool, cue: Cue, cues: &mut Vec<Cue>) {
        match &effect.kind {
            EffectKind::Click(Clicks { press, release: other }) => {
                let click = other.as_ref().filter(|_| release).unwrap_or(press).clone();
                cues.push(Cue { click, manner: effect.manner, ..cue });
            }
            EffectKind::Continuous(tone) => {
                cues.push(Cue { tone: Some(tone.clone()), manner: effect.manner, ..cue });
            }
            kind if kind.timeline().is_some() => self.begin(effect, owner, false, &cue),
            _ => {}
        }
    }

    /// Plays `effect` from the time of `cue` for as long as `owner` holds it; no effect if it is held already.
    pub fn hold(&mut self, effect: &Arc<Effect>, owner: u32, cue: &Cue) {
        let is_same = |playing: &Playing| playing.held && playing.owner == owner;
        if !self.playing.iter().any(is_same) {
            self.begin(effect, owner, true, cue);
        }
    }

    /// Ends the held effects of owners for which `holds` is false.
    pub fn let_go(&mut self, holds: impl Fn(u32) -> bool) {
        self.playing.retain(|playing| !playing.held || holds(playing.owner));
    }

    /// Ends everything.
    pub fn clear(&mut self) {
        self.playing.clear();
    }

    fn begin(&mut self, effect: &Arc<Effect>, owner: u32, held: bool, cue: &Cue) {
        if self.playing.is_full() {
            self.playing.remove(0);
        }
        self.playing.push(Playing {
            effect: Arc::clone(effect),
            owner,
            held,
            at: cue.at,
            received: cue.received,
            next: 0,
            spots: cue.spots.clone(),
            audio_gain: cue.audio_gain,
        });
    }

    /// Appends the parts that begin up to a millisecond after `now`, and the effects held at `now`.
    ///
    /// `spots` gives the place of an owner's foot; with `None` the last place stays.
    pub fn due(
        &mut self,
        now: Instant,
        spots: impl Fn(u32) -> Option<Spots>,
        cues: &mut Vec<Cue>,
        sustained: &mut SustainedCues,
    ) {
        for playing in &mut self.playing {
            if let Some(spots) = spots(playing.owner) {
                playing.spots = spots;
            }
            playing.begin_parts(now + AHEAD, cues);
            if playing.held {
                playing.sound_on(now, sustained);
            }
        }
        self.playing.retain(|playing| !playing.is_over(now));
    }
}

impl Playing {
    /// Appends the parts that begin before `until`; tones of held effects are sustained cues instead.
    fn begin_parts(&mut self, until: Instant, cues: &mut Vec<Cue>) {
        let Some(timeline) = self.effect.kind.timeline() else { return };
        while let Some(begins) = timeline.written(self.next).map(|part| self.at + seconds(part.at_s))
            && begins <= until
            && let Some(part) = timeline.part(self.next)
        {
            self.next += 1;
            let (spots, manner, audio_gain) = (self.spots.clone(), self.effect.manner, self.audio_gain);
            // Only the first part is a response to the foot; the others are never late.
            let received = if part.at_s > 0.0 { begins } else { self.received };
            let cue = Cue { at: begins, received, spots, manner, audio_gain, ..Cue::default() };
            match part.kind {
                PartKind::Click(click) => cues.push(Cue { click, ..cue }),
                PartKind::Tone(tone) if !self.held => cues.push(Cue { tone: Some(tone), ..cue }),
                PartKind::Tone(_) => {}
            }
        }
    }

    /// Appends the sustained cues of a held effect at `now`.
    fn sound_on(&self, now: Instant, sustained: &mut SustainedCues) {
        let t = now.since(self.at).as_secs_f32();
        match &self.effect.kind {
            EffectKind::Continuous(tone) => self.push(0, tone.level, tone.noise, tone.held_at(t), sustained),
            kind => {
                let Some(timeline) = kind.timeline() else { return };
                for (index, part) in (0..).zip(timeline.all_written()) {
                    if let PartKind::Tone(tone) = &part.kind
                        && (part.at_s..part.at_s + tone.whole_s()).contains(&t)
                    {
                        let share = timeline.share_at(t);
                        let (level, hz) = tone.at(t - part.at_s);
                        self.push(index, tone.level, tone.noise, (level * share, hz), sustained);
                    }
                }
            }
        }
    }

    fn push(
        &self,
        part: u32,
        full: Newtons,
        noise: f32,
        (level, hz): (f32, f32),
        sustained: &mut SustainedCues,
    ) {
        // More than feet can distinguish: the latest cues stay silent.
        let _ = sustained.try_push(SustainedCue {
            key: key(self.owner, FIRST_HELD + part),
            spots: self.spots.clone(),
            effect: Lasting::Hum(Hum { level: full * level, hz, noise }),
            manner: self.effect.manner,
            audio_gain: self.audio_gain,
            ..SustainedCue::default()
        });
    }

    fn is_over(&self, now: Instant) -> bool {
        match self.effect.kind.timeline() {
            Some(_) if self.held => false,
            Some(timeline) => timeline.written(self.next).is_none(),
            None => now > self.at,
        }
    }
}

/// The first part number of held effects; lower ones are for frictions and the like.
const FIRST_HELD: u32 = 16;

/// A [`SustainedCue::key`]: one of up to 256 simultaneous cues of the foot `owner`.
#[must_use]
pub fn key(owner: u32, part: u32) -> u32 {
    owner.wrapping_mul(256).wrapping_add(part.min(255))
}

fn seconds(seconds: f32) -> Duration {
    Duration::from_micros((f64::from(seconds.max(0.0)) * 1e6).round() as u64)
}

const _: () = assert!(MAX_SUSTAINED >= MAX_PLAYING);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feel::{Click, Manner, Mode, Part, Sequence, Spot, Tone};

    fn click() -> Click {
        let modes = [Mode { frequency_hz: 200.0, decay_s: 0.01, amplitude: 1.0 }].into_iter().collect();
        Click { modes, level: Newtons(4.0), ..Click::default() }
    }

    fn tone() -> Tone {
        Tone {
            level: Newtons(2.0),
            hz: 90.0,
            length_s: 0.1,
            release_s: 0.02,
            sustain: 1.0,
            ..Tone::default()
        }
    }

    fn sequence() -> Arc<Effect> {
        let part = |at_s, kind| Part { at_s, kind };
        let parts = [
            part(0.0, PartKind::Click(click())),
            part(0.0123, PartKind::Click(click())),
            part(0.02, PartKind::Tone(tone())),
        ];
        let kind = EffectKind::Sequence(Sequence { parts: parts.into(), curve: Default::default() });
        Arc::new(Effect { kind, manner: Manner::PLAIN })
    }

    fn spots(tile: u16) -> Spots {
        [Spot { tile, weight: 1.0 }].into_iter().collect()
    }

    fn at(ms: u64) -> Instant {
        Instant::from_millis(ms)
    }

    #[test]
    fn parts_come_ahead_of_their_time_and_follow_the_foot() {
        let (mut player, mut cues, mut sustained) = (Player::default(), Vec::new(), SustainedCues::new());
        let cue = Cue { at: at(10), received: at(10), spots: spots(3), audio_gain: 0.5, ..Cue::default() };
        player.play(&sequence(), 1, false, cue, &mut cues);
        assert!(cues.is_empty());
        let mut handed_out = Vec::new();
        for ms in 10..60 {
            let tile = if ms < 20 { 3 } else { 4 };
            player.due(at(ms), |_| Some(spots(tile)), &mut cues, &mut sustained);
            handed_out.extend(cues.drain(..).map(|cue| (ms, cue)));
        }
        let when: Vec<(u64, u64, u16)> =
            handed_out.iter().map(|(ms, cue)| (*ms, cue.at.micros(), cue.spots[0].tile)).collect();
        assert_eq!(when, [(10, 10_000, 3), (22, 22_300, 4), (29, 30_000, 4)]);
        assert!(handed_out[2].1.tone.is_some() && sustained.is_empty());
        assert!(handed_out.iter().all(|(_, cue)| cue.audio_gain == 0.5), "each part is heard as the first");
        assert!(player.playing.is_empty());
    }

    #[test]
    fn what_is_held_ends_when_it_is_let_go() {
        let (mut player, mut cues) = (Player::default(), Vec::new());
        let held = Arc::new(Effect { kind: EffectKind::Continuous(tone()), manner: Manner::PLAIN });
        for ms in 0..3000 {
            let mut sustained = SustainedCues::new();
            player.hold(&held, 7, &Cue { spots: spots(1), audio_gain: 0.25, ..Cue::default() });
            player.due(at(ms), |_| None, &mut cues, &mut sustained);
            assert_eq!(sustained.len(), 1, "a held tone goes on beyond its length");
            assert_eq!(sustained[0].audio_gain, 0.25);
        }
        player.let_go(|owner| owner != 7);
        let mut sustained = SustainedCues::new();
        player.due(at(3000), |_| None, &mut cues, &mut sustained);
        assert!(sustained.is_empty() && cues.is_empty());
    }
}
