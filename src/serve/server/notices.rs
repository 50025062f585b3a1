//! What a server says of its own accord: of the link, the tare, the sensors and the device.

use std::time::Duration;

use tracing::{info, warn};

use super::Server;
use crate::sense::{SensorHealth, TareOutcome};
use crate::units::Instant;
use crate::wire::LinkState;

/// How long only some boards must have reported for this to be news; controls on the others are long released.
const SETTLING: Duration = Duration::from_millis(100);

/// How often the sensors' health is checked, and how often at most it is told.
const HEALTH_LOOK: Duration = Duration::from_millis(100);
const HEALTH_PERIOD: Duration = Duration::from_secs(1);

impl Server {
    /// Says so when the floor is lost or back, and lets no actuator move while it is lost.
    pub(super) fn note_link(&mut self) {
        self.note_frozen();
        let link = self.settled_link();
        if link != self.link {
            match link {
                LinkState::Lost => self.notices.link.warn(self.source.now(), || {
                    "nothing usable from any board for 100 ms: what was held is cancelled".into()
                }),
                LinkState::Partial => {
                    self.notices
                        .link
                        .warn(self.source.now(), || "nothing usable comes from some boards".into());
                }
                LinkState::Live => {
                    self.notices.link.info(self.source.now(), || "packets arrive from every board".into());
                }
                LinkState::Waiting => {}
            }
            self.link = link;
            self.update_mute();
            self.note_uncalibrated();
            if let Some(events) = &mut self.events {
                events.link(self.source.now(), link);
            }
            // A lost floor has no frames that would show it.
            self.shown = Instant::START;
            self.show(self.source.now());
        }
        let tare = self.assembler.tare_outcome();
        if tare != self.tare {
            match tare {
                TareOutcome::Measuring => info!("measuring the tare: keep off the floor"),
                TareOutcome::Taken => info!("tare measured"),
                TareOutcome::Refused { sensor, mean, deviation } => warn!(
                    "the floor was never empty and quiet enough to tare: {sensor} read {:.1} N, scattered by {:.1} N; \
                     going on with the floor file's tare",
                    mean.0, deviation.0
                ),
                TareOutcome::FromFloor => {}
            }
            self.tare = tare;
        }
    }

    /// Says which boards read the same over and over under a load.
    fn note_frozen(&mut self) {
        let frozen = self.assembler.counters().frozen;
        if std::mem::replace(&mut self.frozen, frozen) == frozen {
            return;
        }
        let boards = (0_u16..).map_while(|board| Some((board, self.assembler.board(board)?)));
        for (board, _) in boards.filter(|(_, status)| status.frozen) {
            warn!(
                "board {board}: all its readings have stood still for 100 ms under a load, which no converter does \
                 that works; what was held on its tiles is cancelled. Look at its converters and their clock"
            );
        }
    }

    /// Says where a load jumped, once a second at most.
    pub(super) fn note_jumps(&mut self, now: Instant) {
        let (count, last) = self.assembler.jumps();
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

    /// Says once how many sensors go by nominal gains.
    fn note_uncalibrated(&mut self) {
        let uncalibrated = self.assembler.uncalibrated();
        if uncalibrated > self.uncalibrated {
            self.uncalibrated = uncalibrated;
            warn!(
                "{uncalibrated} sensors were never calibrated and count as nominal parts: their forces may be off by \
                 a third; `underfoot calibrate curves` measures them. Until then controls with the guard HoldToRun \
                 are off"
            );
        }
    }

    /// The link's state; boards that come back one after the other don't make the floor look half dead for a moment.
    fn settled_link(&mut self) -> LinkState {
        let link = self.assembler.link_state();
        if link != LinkState::Partial {
            self.partial_since = None;
            return link;
        }
        let now = self.source.now();
        let since = *self.partial_since.get_or_insert(now);
        if now.since(since) < SETTLING { self.link } else { link }
    }

    /// Says which sensors have fallen into trouble or got out of it.
    pub(super) fn note_troubles(&mut self) {
        let changes = self.assembler.trouble_changes();
        if changes == self.trouble_changes {
            return;
        }
        self.trouble_changes = changes;
        let now: Vec<_> = self.assembler.troubles().collect();
        for (sensor, trouble) in now.iter().filter(|found| !self.troubles.contains(found)) {
            self.notices.troubles.warn(self.source.now(), || format!("{sensor}: {trouble}"));
        }
        for (sensor, trouble) in &self.troubles {
            if !now.iter().any(|(still, _)| still == sensor) {
                self.notices
                    .troubles
                    .info(self.source.now(), || format!("{sensor}: well again (was: {trouble})"));
            }
        }
        self.troubles = now;
    }

    /// Tells how the sensors are doing when that has changed, once a second at most.
    pub(super) fn note_health(&mut self) {
        let now = self.source.now();
        if now < self.next_check {
            return;
        }
        // Qualities come and go with single readings: what is reported is checked a few times a second.
        self.next_check = now + HEALTH_LOOK;
        self.note_jumps(now);
        self.note_foreign();
        self.note_device(now);
        self.assembler.health(&mut self.health);
        let known = self.told.as_ref();
        let is_due =
            known.is_none_or(|(at, told)| now.since(*at) >= HEALTH_PERIOD && self.health.is_news_after(told));
        if !is_due || self.link == LinkState::Waiting {
            return;
        }
        // That all is well at first is not reported.
        let is_news = known.is_some() || self.health.is_news_after(&SensorHealth::default());
        if let Some(events) = self.events.as_mut().filter(|_| is_news) {
            events.health(now, &self.health);
        }
        match &mut self.told {
            Some((at, told)) => {
                *at = now;
                told.clone_from(&self.health);
            }
            None => self.told = Some((now, self.health.clone())),
        }
    }

    /// Tells how the device is doing when that has changed, once a second at most.
    fn note_device(&mut self, now: Instant) {
        let Some(actuators) = &self.actuators else { return };
        let mut status = self.device.take().unwrap_or_default();
        if !actuators.device(&mut status) {
            return;
        }
        let is_news = match &self.device_told {
            Some((at, told)) => now.since(*at) >= HEALTH_PERIOD && status.is_news_after(told),
            None => true,
        };
        if is_news {
            if let Some(events) = &mut self.events {
                events.device(now, &status);
            }
            self.device_told = Some((now, status.clone()));
        }
        self.device = Some(status);
    }

    /// Says once that the floor file seems to be another floor's.
    fn note_foreign(&mut self) {
        if self.said_foreign {
            return;
        }
        let counters = self.counters();
        if self.assembler.is_foreign() {
            self.said_foreign = true;
            warn!(
                "most tiles read otherwise than the floor file says of the empty floor: is it the file of another \
                 floor, or was it tared long ago? No force can be trusted, and controls with the guard HoldToRun are off; `underfoot calibrate tare` \
                 measures it anew"
            );
        } else if counters.packets == 0 && counters.wrong_shape > 100 {
            self.said_foreign = true;
            warn!(
                "the boards send another number of readings than the floor file says: is it the file of another floor?"
            );
        }
    }
}
