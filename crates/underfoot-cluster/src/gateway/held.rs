//! The controls held on the whole floor, reported repeatedly.

use std::time::Duration;

use underfoot::sink::HeldReport;
use underfoot::units::Instant;
use underfoot::widget::WidgetId;

/// Interval between two reports: five of them may be lost or late before an app treats a control as released.
const EVERY: Duration = Duration::from_millis(20);

/// Greatest age of the frames from which the holds come. Together with the time-out of 100 ms for silence, a hold
/// ends after 150 ms at the latest, also when this program crashes.
const CURRENT: Duration = Duration::from_millis(40);

/// The last report, and the time of the next one.
#[derive(Clone, Debug, Default)]
pub(super) struct HeldReports {
    last: HeldReport,
    due: Instant,
}

impl HeldReports {
    /// The report of the controls in `held`, if they have changed or a report is due. `age` is that of the oldest
    /// frame behind it.
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
