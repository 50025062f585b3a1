//! The simulated X-ray lamp: on while a foot holds its control, and nothing else may keep it on.

use underfoot::units::Instant;
use underfoot::widget::EventKind;

/// Why the lamp went out the last time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// The foot let go.
    Lifted,
    /// It was held for as long as it may be.
    Time,
    /// The floor fell silent, or its session ended.
    FloorLost,
    /// The foot slid off, stepped, or could not be believed.
    Doubt,
}

/// The lamp.
#[derive(Clone, Debug, Default)]
pub struct Beam {
    /// Whether it shines: only what is known to be held at this very moment.
    pub is_on: bool,
    /// Whether it will soon stop by itself.
    pub has_warned: bool,
    pub ended: Option<Cause>,
    /// How often it shone, and for how many seconds together.
    pub shots: u32,
    pub seconds: f64,
    /// For how long it has shone in this press, in seconds.
    pub held_s: f64,
    since: Option<Instant>,
    ended_at: Option<Instant>,
}

/// How long after the end of a press the floor's silence, which ended it, may be told, in seconds.
const TOLD_S: f64 = 0.5;

/// How much earlier than its longest time an end still counts as that, in seconds: some frames.
const AT_ONCE_S: f64 = 0.05;

impl Beam {
    /// What happened to its control, and when; `longest_s` is how long that may be held.
    pub fn hear(&mut self, kind: EventKind, at: Instant, longest_s: f64) {
        match kind {
            EventKind::Pressed => {
                self.since = Some(at);
                self.shots += 1;
                (self.has_warned, self.ended, self.held_s) = (false, None, 0.0);
            }
            EventKind::Warned => self.has_warned = true,
            EventKind::Released if self.since.is_some() => self.end(Cause::Lifted, at),
            EventKind::Cancelled => {
                // That the floor is lost may be told before what it cancelled.
                let Some(since) = self.since else { return };
                let is_time = at.since(since).as_secs_f64() >= longest_s - AT_ONCE_S;
                self.end(if is_time { Cause::Time } else { Cause::Doubt }, at);
            }
            _ => {}
        }
    }

    /// The floor is silent or gone: a press that was cancelled just before was cancelled by that.
    pub fn lose(&mut self, at: Instant) {
        let is_told_now = self.ended_at.is_some_and(|end| at.since(end).as_secs_f64() < TOLD_S);
        if self.since.is_some() || (self.ended == Some(Cause::Doubt) && is_told_now) {
            self.end(Cause::FloorLost, at);
        }
    }

    /// Lets time pass; `is_held` is what the floor confirms at this moment.
    pub fn pass(&mut self, dt_s: f64, is_held: bool) {
        self.is_on = is_held && self.since.is_some();
        if self.is_on {
            self.seconds += dt_s;
            self.held_s += dt_s;
        }
    }

    fn end(&mut self, cause: Cause, at: Instant) {
        (self.since, self.ended_at) = (None, Some(at));
        (self.is_on, self.has_warned, self.ended) = (false, false, Some(cause));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LONGEST_S: f64 = 5.0;

    fn pressed() -> Beam {
        let mut beam = Beam::default();
        beam.hear(EventKind::Pressed, Instant::from_millis(1000), LONGEST_S);
        beam.pass(0.1, true);
        assert!(beam.is_on);
        beam
    }

    #[test]
    fn it_shines_only_while_the_floor_confirms_the_foot() {
        let mut beam = pressed();
        beam.pass(0.1, false);
        assert!(!beam.is_on, "no event has come, and it is dark");
        beam.pass(0.1, true);
        beam.hear(EventKind::Released, Instant::from_millis(1300), LONGEST_S);
        beam.pass(0.1, true);
        assert!(!beam.is_on, "an old hold does not light it again");
        assert_eq!((beam.ended, beam.shots), (Some(Cause::Lifted), 1));
        assert!((beam.seconds - 0.2).abs() < 1e-9);
    }

    #[test]
    fn each_end_has_its_cause() {
        let mut beam = pressed();
        beam.hear(EventKind::Warned, Instant::from_millis(4000), LONGEST_S);
        assert!(beam.has_warned);
        beam.hear(EventKind::Cancelled, Instant::from_millis(6000), LONGEST_S);
        assert_eq!((beam.ended, beam.has_warned), (Some(Cause::Time), false));
        beam.lose(Instant::from_millis(6100));
        assert_eq!(beam.ended, Some(Cause::Time), "what has ended is not ended by what comes later");

        let mut beam = pressed();
        beam.hear(EventKind::Cancelled, Instant::from_millis(2000), LONGEST_S);
        assert_eq!(beam.ended, Some(Cause::Doubt));
        beam.lose(Instant::from_millis(2001));
        assert_eq!(beam.ended, Some(Cause::FloorLost));

        let mut beam = pressed();
        beam.lose(Instant::from_millis(2000));
        beam.hear(EventKind::Cancelled, Instant::from_millis(2000), LONGEST_S);
        assert_eq!((beam.ended, beam.is_on), (Some(Cause::FloorLost), false));
    }
}
