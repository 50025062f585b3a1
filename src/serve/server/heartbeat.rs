//! What is said over and over, so that whoever hears it no longer knows that it has ended.

use std::time::Duration;

use crate::outgoing::HeldReport;
use crate::sink::Report;
use crate::units::Instant;
use crate::widget::WidgetId;

/// Time between two reports of what is held: five of them may be lost or late before 100 ms are over.
const HELD_EVERY: Duration = Duration::from_millis(20);

/// How old the frame may be that says what is held: a server that works off packets of the past knows nothing of now.
/// With the 100 ms that silence is believed for, a hold ends after 150 ms at the latest.
const CURRENT: Duration = Duration::from_millis(40);

/// Time between two signs of life.
const ALIVE_EVERY: Duration = Duration::from_millis(100);

/// What was last reported, and when the next reports are due.
#[derive(Debug, Default)]
pub(super) struct Heartbeat {
    report: HeldReport,
    held_due: Instant,
    alive: u32,
    alive_due: Instant,
}

impl Heartbeat {
    /// Reports what is held if that has changed or is due, and that the server lives. `seen`: when the last frame came
    /// in.
    pub(super) fn beat<'a>(
        &mut self,
        held: impl Iterator<Item = &'a WidgetId> + Clone,
        seen: Instant,
        now: Instant,
        mut tell: impl FnMut(Report<'_>),
    ) {
        let Self { report, held_due, alive, alive_due } = self;
        let is_news =
            held.clone().count() != report.held.len() || held.clone().any(|id| !report.held.contains(id));
        if is_news || (!report.held.is_empty() && now >= *held_due && now.since(seen) < CURRENT) {
            report.ended.clear();
            report.ended.extend(report.held.drain(..).filter(|id| !held.clone().any(|still| still == id)));
            report.held.extend(held.cloned());
            report.sequence = report.sequence.wrapping_add(1);
            report.at = now;
            *held_due = next(*held_due, HELD_EVERY, now);
            tell(Report::Held(report));
        }
        if now >= *alive_due {
            *alive = alive.wrapping_add(1);
            *alive_due = next(*alive_due, ALIVE_EVERY, now);
            tell(Report::Alive(now, *alive));
        }
    }
}

/// When a report is due again: a period after it was due, or after `now` if it is late or early.
fn next(due: Instant, period: Duration, now: Instant) -> Instant {
    let next = due + period;
    if next > now && due <= now { next } else { now + period }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_old_frame_says_is_held_is_not_repeated_and_an_end_is_told_all_the_same() {
        let drive = [WidgetId::new("drive")];
        let mut heartbeat = Heartbeat::default();
        let mut reports = |held: &[WidgetId], seen_ms: u64, now_ms: u64| {
            let [seen, now] = [seen_ms, now_ms].map(Instant::from_millis);
            let mut count = 0;
            heartbeat
                .beat(held.iter(), seen, now, |report| count += u32::from(matches!(report, Report::Held(_))));
            count
        };
        assert_eq!(reports(&drive, 1000, 1000), 1, "news");
        assert_eq!(reports(&drive, 1020, 1020), 1, "due again");
        assert_eq!(reports(&drive, 1021, 1061), 0, "40 ms behind");
        assert_eq!(reports(&drive, 1090, 1100), 1, "it has caught up");
        assert_eq!(reports(&[], 1100, 1500), 1, "an end is news however late");
    }
}
