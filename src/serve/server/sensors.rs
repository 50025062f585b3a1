//! Reports of a floor's sensors: faults, jumps of a load, a floor file of another floor.

use std::time::Duration;

use tracing::warn;

use super::limited::Limited;
use crate::floor::SensorId;
use crate::sense::{Assembler, SensorHealth, Trouble};
use crate::units::Instant;
use crate::wire::LinkState;

/// Interval between two checks of the sensors' health, and minimum time between two reports of it.
const HEALTH_LOOK: Duration = Duration::from_millis(100);
const HEALTH_PERIOD: Duration = Duration::from_secs(1);

/// The sensor state as last reported.
#[derive(Debug)]
pub(super) struct SensorWatch {
    /// Sensors with a known trouble, and the counter of changes.
    troubles: Vec<(SensorId, Trouble)>,
    trouble_changes: u64,
    /// Count of jumps, and the time from which the next may be logged.
    jumps: u64,
    next_jumps: Instant,
    /// Whether the log already says that this seems to be another floor.
    said_foreign: bool,
    /// Time and content of the last report; `None` before the first.
    told: Option<(Instant, SensorHealth)>,
    /// The current state, for comparison.
    health: SensorHealth,
    /// Time of the next check.
    next_check: Instant,
    notices: Limited,
}

impl Default for SensorWatch {
    fn default() -> Self {
        Self {
            troubles: Vec::new(),
            trouble_changes: 0,
            jumps: 0,
            next_jumps: Instant::START,
            said_foreign: false,
            told: None,
            health: SensorHealth::default(),
            next_check: Instant::START,
            // As many as a large board has channels: if it is unplugged, the log names each of its sensors.
            notices: Limited::new(64, Duration::from_secs(2)),
        }
    }
}

impl SensorWatch {
    /// Logs which sensors have developed or lost a trouble.
    pub(super) fn note_troubles(&mut self, assembler: &Assembler, now: Instant) {
        let changes = assembler.trouble_changes();
        if changes == self.trouble_changes {
            return;
        }
        self.trouble_changes = changes;
        let current: Vec<_> = assembler.troubles().collect();
        for (sensor, trouble) in current.iter().filter(|found| !self.troubles.contains(found)) {
            self.notices.warn(now, || format!("{sensor}: {trouble}"));
        }
        for (sensor, trouble) in &self.troubles {
            if !current.iter().any(|(still, _)| still == sensor) {
                self.notices.info(now, || format!("{sensor}: well again (was: {trouble})"));
            }
        }
        self.troubles = current;
    }

    /// Whether [`SensorWatch::health_news`] is due: qualities change with single readings, so a few checks a second
    /// suffice.
    pub(super) fn is_due(&mut self, now: Instant) -> bool {
        let is_due = now >= self.next_check;
        if is_due {
            self.next_check = now + HEALTH_LOOK;
        }
        is_due
    }

    /// Returns the sensor health when it has changed, at most once a second, and logs apparent faults.
    pub(super) fn health_news(
        &mut self,
        assembler: &Assembler,
        link: LinkState,
        now: Instant,
    ) -> Option<&SensorHealth> {
        self.note_jumps(assembler, now);
        self.note_foreign(assembler);
        assembler.health(&mut self.health);
        let known = self.told.as_ref();
        let is_due =
            known.is_none_or(|(at, told)| now.since(*at) >= HEALTH_PERIOD && self.health.is_news_after(told));
        if !is_due || link == LinkState::Waiting {
            return None;
        }
        // A healthy state at the start is not reported.
        let is_news = known.is_some() || self.health.is_news_after(&SensorHealth::default());
        let (at, told) = self.told.get_or_insert_default();
        *at = now;
        told.clone_from(&self.health);
        is_news.then_some(&self.health)
    }

    /// Logs where a load jumped, at most once a second.
    fn note_jumps(&mut self, assembler: &Assembler, now: Instant) {
        let (count, last) = assembler.jumps();
        let Some((tile, newtons)) = last.filter(|_| count > self.jumps && now >= self.next_jumps) else {
            return;
        };
        warn!(
            "tile {tile}: its load jumped by {newtons:.0} N within a millisecond, which no body does ({} such jumps); what \
             was held there is cancelled. Look for a loose plug or earth",
            count - self.jumps
        );
        self.jumps = count;
        self.next_jumps = now + HEALTH_PERIOD;
    }

    /// Logs once that the floor file seems to belong to another floor.
    fn note_foreign(&mut self, assembler: &Assembler) {
        if self.said_foreign {
            return;
        }
        if assembler.is_foreign() {
            self.said_foreign = true;
            warn!(
                "most tiles read otherwise than the floor file says of the empty floor: is it the file of another \
                 floor, or was it tared long ago? No force can be trusted, and controls with the guard HoldToRun are off; `underfoot calibrate tare` \
                 measures it anew"
            );
        }
    }
}
