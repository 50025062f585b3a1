//! Requests in bundles with a time tag, which wait until then.

use std::time::Duration;

use rosc::OscTime;

use crate::units::Instant;
use crate::wire::{Request, WireError};

/// Maximum waiting time of a request: the margin that apps add against network jitter.
const LONGEST: Duration = Duration::from_secs(1);

/// Requests that wait, in the order in which they are due.
#[derive(Debug, Default)]
pub(super) struct Timed {
    waiting: Vec<(Instant, Request)>,
}

impl Timed {
    pub(super) fn len(&self) -> usize {
        self.waiting.len()
    }

    /// Adds a request that waits until `due`, behind those of the same time.
    pub(super) fn push(&mut self, due: Instant, request: Request) {
        let place = self.waiting.partition_point(|(other, _)| *other <= due);
        self.waiting.insert(place, (due, request));
    }

    /// The next request that is due.
    pub(super) fn take(&mut self, now: Instant) -> Option<Request> {
        let is_due = self.waiting.first().is_some_and(|(due, _)| *due <= now);
        is_due.then(|| self.waiting.remove(0).1)
    }
}

/// Waiting time from `clock`, the wall clock, to the time tag `due`; zero if it is past or "at once".
///
/// # Errors
/// [`WireError::TooEarly`] if the waiting time exceeds a second.
pub(super) fn delay(due: OscTime, clock: OscTime) -> Result<Duration, WireError> {
    let ticks = |time: OscTime| (u64::from(time.seconds) << 32) | u64::from(time.fractional);
    let ahead = ticks(due).saturating_sub(ticks(clock));
    let nanos = (u128::from(ahead) * 1_000_000_000) >> 32;
    let delay = Duration::from_nanos(u64::try_from(nanos).unwrap_or(u64::MAX));
    if delay <= LONGEST {
        return Ok(delay);
    }
    Err(WireError::TooEarly { seconds: u32::try_from(delay.as_secs()).unwrap_or(u32::MAX) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::ControlMessage;

    // P10
    #[test]
    fn a_time_tag_is_waited_for_up_to_a_second() {
        let clock = OscTime { seconds: 3_900_000_000, fractional: 1 << 31 };
        let at = |seconds, fractional| delay(OscTime { seconds, fractional }, clock);
        assert_eq!(at(0, 1), Ok(Duration::ZERO), "at once");
        assert_eq!(at(3_800_000_000, 0), Ok(Duration::ZERO), "past");
        assert_eq!(at(3_900_000_000, 3 << 30), Ok(Duration::from_millis(250)));
        assert_eq!(at(3_900_000_001, 1 << 31), Ok(Duration::from_secs(1)));
        assert_eq!(at(3_900_000_002, 1 << 31), Err(WireError::TooEarly { seconds: 2 }));
        assert!(at(u32::MAX, u32::MAX).is_err());
    }

    #[test]
    fn requests_come_when_they_are_due_and_in_order() {
        let mut timed = Timed::default();
        let request = |on| Request::from(ControlMessage::Mute { on });
        timed.push(Instant::from_millis(20), request(true));
        timed.push(Instant::from_millis(10), Request::from(ControlMessage::GetMute));
        timed.push(Instant::from_millis(20), request(false));
        assert_eq!(timed.take(Instant::from_millis(9)), None);
        assert_eq!(timed.take(Instant::from_millis(15)), Some(Request::from(ControlMessage::GetMute)));
        assert_eq!(timed.take(Instant::from_millis(15)), None);
        assert_eq!(
            [(); 2].map(|()| timed.take(Instant::from_millis(20))),
            [Some(request(true)), Some(request(false))]
        );
        assert_eq!(timed.len(), 0);
    }
}
