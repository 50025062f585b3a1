//! Periodic reports, so that a listener detects the end of a hold by the end of the reports.

use std::borrow::Cow;
use std::time::Duration;

use crate::outgoing::HeldReport;
use crate::sink::Report;
use crate::units::Instant;
use crate::widget::WidgetId;

/// Time between two reports of held controls: five of them may be lost or late within 100 ms.
const HELD_EVERY: Duration = Duration::from_millis(20);

/// Maximum age of the frame that a report of held controls is based on: a server that works through a backlog of
/// packets does not know the present state. With the listener's 100 ms time-out, a hold ends after 150 ms at the
/// latest.
const CURRENT: Duration = Duration::from_millis(40);

/// Time between two alive reports.
const ALIVE_EVERY: Duration = Duration::from_millis(100);

/// The last report, and the due times of the next ones.
#[derive(Debug, Default)]
pub(super) struct Heartbeat {
    report: HeldReport,
    held_due: Instant,
    alive: u32,
    alive_due: Instant,
}

impl Heartbeat {
    /// Reports the held controls if they have changed or the report is due, and sends the alive report. `seen`: time
    /// of the last frame.
    pub(super) fn beat<'a>(
        &mut self,
        held: impl Iterator<Item = &'a WidgetId> + Clone,
        seen: Instant,
        now: Instant,
        mut tell: impl FnMut(&Report<'_>),
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
            tell(&Report::Held(Cow::Borrowed(report)));
        }
        if now >= *alive_due {
            *alive = alive.wrapping_add(1);
            *alive_due = next(*alive_due, ALIVE_EVERY, now);
            tell(&Report::Alive(now, *alive));
        }
    }
}

/// Returns the next due time: a period after the last due time, or after `now` if the report is late or early.
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
