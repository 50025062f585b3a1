//! What is held on the whole floor, said over and over.

use std::time::Duration;

use underfoot::sink::HeldReport;
use underfoot::units::Instant;
use underfoot::widget::WidgetId;

/// Time between two reports: five of them may be lost or late before an app takes a control for released.
const EVERY: Duration = Duration::from_millis(20);

/// How old the frames may be that say what is held. With the 100 ms that silence is believed for, a hold ends after
/// 150 ms at the latest, also when this program dies.
const CURRENT: Duration = Duration::from_millis(40);

/// What was reported last, and when the next report is due.
#[derive(Clone, Debug, Default)]
pub(super) struct HeldReports {
    last: HeldReport,
    due: Instant,
}

impl HeldReports {
    /// The report of what is held, if that has changed or it is due. `age`: of the oldest frame that says so.
    pub(super) fn report(&mut self, held: &[&str], age: Duration, now: Instant) -> Option<&HeldReport> {
        let last = &mut self.last;
        let is_news =
            held.len() != last.held.len() || held.iter().any(|id| !last.held.iter().any(|one| one == id));
        let is_due = !held.is_empty() && now >= self.due && age < CURRENT;
        if !is_news && !is_due {
            return None;
        }
        last.ended = last.held.drain(..).filter(|id| !held.iter().any(|one| id == one)).collect();
        last.held = held.iter().map(|id| WidgetId::new(id)).collect();
        last.sequence = last.sequence.wrapping_add(1);
        last.at = now;
        self.due = now + EVERY;
        Some(last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_repeated_while_frames_are_new_and_its_end_is_told_whatever_their_age() {
        let mut reports = HeldReports::default();
        let mut told = |held: &[&str], age: u64, now: u64| {
            let report = reports.report(held, Duration::from_millis(age), Instant::from_millis(now));
            report.map(|report| (report.sequence, report.ended.len()))
        };
        assert_eq!(told(&[], 0, 0), None);
        assert_eq!(told(&["drive"], 3, 10), Some((1, 0)));
        assert_eq!(told(&["drive"], 3, 29), None);
        assert_eq!(told(&["drive"], 3, 30), Some((2, 0)));
        assert_eq!(told(&["drive"], 45, 60), None, "what is old is not repeated");
        assert_eq!(told(&[], 99, 115), Some((3, 1)));
    }
}
