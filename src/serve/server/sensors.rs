//! What a server says of its floor's sensors: which are in trouble, where a load jumped, whose floor it is.

use std::time::Duration;

use tracing::warn;

use super::limited::Limited;
use crate::floor::SensorId;
use crate::sense::{Assembler, SensorHealth, Trouble};
use crate::units::Instant;
use crate::wire::LinkState;

/// How often the sensors' health is checked, and how often at most it is told.
const HEALTH_LOOK: Duration = Duration::from_millis(100);
const HEALTH_PERIOD: Duration = Duration::from_secs(1);

/// What is known of the sensors, as far as that has been said.
#[derive(Debug)]
pub(super) struct SensorWatch {
    /// Sensors known to be in trouble, and how often that had changed.
    troubles: Vec<(SensorId, Trouble)>,
    trouble_changes: u64,
    /// Loads that jumped, and when that may be said again.
    jumps: u64,
    next_jumps: Instant,
    /// Whether it has been said that this seems to be another floor.
    said_foreign: bool,
    /// What was last told of the sensors, and when; `None` before the first time.
    told: Option<(Instant, SensorHealth)>,
    /// How they are, for comparing.
    health: SensorHealth,
    /// Until when nothing is checked.
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
            // As many as a large board has channels: one that is unplugged is named sensor by sensor.
            notices: Limited::new(64, Duration::from_secs(2)),
        }
    }
}

impl SensorWatch {
    /// Says which sensors have fallen into trouble or got out of it.
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

    /// Whether it is time for [`SensorWatch::health_news`]: qualities come and go with single readings, so what is
    /// reported is checked a few times a second.
    pub(super) fn is_due(&mut self, now: Instant) -> bool {
        let is_due = now >= self.next_check;
        if is_due {
            self.next_check = now + HEALTH_LOOK;
        }
        is_due
    }

    /// How the sensors are doing when that has changed, once a second at most; says what seems wrong with them.
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
        // That all is well at first is not reported.
        let is_news = known.is_some() || self.health.is_news_after(&SensorHealth::default());
        let (at, told) = self.told.get_or_insert_default();
        *at = now;
        told.clone_from(&self.health);
        is_news.then_some(&self.health)
    }

    /// Says where a load jumped, once a second at most.
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

    /// Says once that the floor file seems to be another floor's.
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
