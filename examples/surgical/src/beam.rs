//! The simulated X-ray lamp: it is on only while a foot holds its control.

use underfoot::units::Instant;
use underfoot::widget::EventKind;

/// The reason why the lamp went out the last time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// The foot released it.
    Lifted,
    /// It reached its longest time.
    Time,
    /// The floor fell silent, or its session ended.
    FloorLost,
    /// The foot slid off or stepped, or its hold was uncertain.
    Doubt,
}

/// The lamp.
#[derive(Clone, Debug, Default)]
pub struct Beam {
    /// Whether it is on: only while the hold is certain at this time.
    pub is_on: bool,
    /// Whether it will soon stop by itself.
    pub has_warned: bool,
    pub ended: Option<Cause>,
    /// Number of exposures, and their total in seconds.
    pub shots: u32,
    pub seconds: f64,
    /// Duration of the present press, in seconds.
    pub held_s: f64,
    since: Option<Instant>,
    ended_at: Option<Instant>,
}

/// Time after the end of a press in which a report of the floor's silence can explain that end, in seconds.
const TOLD_S: f64 = 0.5;

/// Tolerance within which an end counts as the longest time, in seconds: some frames.
const AT_ONCE_S: f64 = 0.05;

impl Beam {
    /// Processes an event of its control at `at`; `longest_s` is the longest time of a press.
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
                // The loss of the floor may be reported before the cancellation that it causes.
                let Some(since) = self.since else { return };
                let is_time = at.since(since).as_secs_f64() >= longest_s - AT_ONCE_S;
                self.end(if is_time { Cause::Time } else { Cause::Doubt }, at);
            }
            _ => {}
        }
    }

    /// Processes the loss of the floor, which also explains a cancellation just before.
    pub fn lose(&mut self, at: Instant) {
        let is_told_now = self.ended_at.is_some_and(|end| at.since(end).as_secs_f64() < TOLD_S);
        if self.since.is_some() || (self.ended == Some(Cause::Doubt) && is_told_now) {
            self.end(Cause::FloorLost, at);
        }
    }

    /// Advances time; `is_held` is the floor's confirmation at this time.
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
