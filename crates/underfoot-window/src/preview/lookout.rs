//! Watches the floor for the window, so that the window draws only after a visible change.

use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::time::Duration;

use eframe::egui;
use triple_buffer::triple_buffer;
use web_time::Instant;

use super::feed::PreviewInput;
use crate::platform;
use underfoot::engine::{Snapshot, TileState, WidgetState};
use underfoot::sense::Contact;
use underfoot::wire::LinkState;

/// Time between checks: one for each frame of a window.
const EVERY: Duration = Duration::from_nanos(16_666_667);

/// Time without news after which checks come half as often: each one wakes a processor that may sleep.
const QUIET: Duration = Duration::from_secs(2);

/// Interval at which the window draws without any change: figures such as rates continue.
const AT_LEAST: Duration = Duration::from_secs(15);

/// The same interval during a fault, such as a lost link, for which the window counts tenths of seconds.
const IN_TROUBLE: Duration = Duration::from_millis(100);

/// Time without a snapshot that counts as a fault.
const SILENCE: Duration = Duration::from_millis(400);

/// Invisible differences: of a sensor's force (the noise of an idle one), of a contact's force as a share, of a place
/// in metres (a third of a pixel), and of a press as a share of the threshold.
const UNSEEN_N: f32 = 1.5;
const UNSEEN_SHARE: f32 = 0.01;
const UNSEEN_M: f32 = 0.001;
const UNSEEN_PRESS: f32 = 0.01;

/// Puts a relay between the floor and the window that passes on all messages and wakes the window when there is
/// something to draw. It ends with the window.
pub(super) fn start(mut input: PreviewInput, ctx: &egui::Context) -> PreviewInput {
    let (mut passed, shown) = triple_buffer(input.snapshots.read());
    let mut snapshots = std::mem::replace(&mut input.snapshots, shown);
    let mut events = Relay::before(&mut input.channels.events);
    let mut layouts = Relay::before(&mut input.channels.layouts);
    let mut notices = Relay::before(&mut input.channels.notices);
    let ctx = ctx.clone();
    let mut pace = Pace::new(snapshots.read().clone(), Instant::now());
    let first = Instant::now() + EVERY;
    let mut due = first;
    let look = move || {
        let now = Instant::now();
        let is_fresh = snapshots.update();
        let snapshot = snapshots.output_buffer();
        if is_fresh {
            passed.input_buffer_mut().clone_from(snapshot);
            passed.publish();
        }
        let mut news = false;
        for relayed in [events.pass_on(), layouts.pass_on(), notices.pass_on()] {
            news |= relayed?;
        }
        if pace.is_due(snapshot, is_fresh, news, now) {
            // A delay of zero would request two frames.
            ctx.request_repaint_after(Duration::from_micros(100));
        }
        due = pace.next(due, Instant::now());
        Some(due)
    };
    // Without these looks the window would not update; they are as essential as the window itself.
    platform::repeat("lookout", first, look)
        .unwrap_or_else(|error| tracing::error!("the window can't look at the floor: {error}"));
    input
}

/// Decides when the window draws.
struct Pace {
    drawn: Snapshot,
    drawn_at: Instant,
    fresh_at: Instant,
}

impl Pace {
    fn new(drawn: Snapshot, now: Instant) -> Self {
        Self { drawn, drawn_at: now, fresh_at: now }
    }

    /// Time until the next check.
    fn pause(&self, now: Instant) -> Duration {
        if now.duration_since(self.drawn_at) > QUIET { 2 * EVERY } else { EVERY }
    }

    /// Time of the next check after the one that was due at `due`: late checks do not make the later ones late, or
    /// there would be less than 60 a second.
    fn next(&self, due: Instant, now: Instant) -> Instant {
        (due + self.pause(now)).max(now)
    }

    fn is_due(&mut self, snapshot: &Snapshot, is_fresh: bool, news: bool, now: Instant) -> bool {
        if is_fresh {
            self.fresh_at = now;
        }
        let in_trouble = !matches!(snapshot.link, LinkState::Live | LinkState::Partial)
            || now.duration_since(self.fresh_at) >= SILENCE;
        let pause = if in_trouble { IN_TROUBLE } else { AT_LEAST };
        let due =
            news || now.duration_since(self.drawn_at) >= pause || (is_fresh && differ(&self.drawn, snapshot));
        if due {
            self.drawn.clone_from(snapshot);
            self.drawn_at = now;
        }
        due
    }
}

/// Capacity behind a relay, for one frame of the window; further messages wait before the relay.
const PASSED_ON: usize = 1024;

/// Passes messages on.
struct Relay<T> {
    from: Receiver<T>,
    to: SyncSender<T>,
    /// The message for which the channel had no room.
    late: Option<T>,
}

impl<T> Relay<T> {
    /// Puts a relay before a receiver.
    fn before(receiver: &mut Receiver<T>) -> Self {
        let (to, after) = sync_channel(PASSED_ON);
        Self { from: std::mem::replace(receiver, after), to, late: None }
    }

    /// Returns whether a message arrived; `None` once the receiver is closed.
    fn pass_on(&mut self) -> Option<bool> {
        let mut some = false;
        while let Some(one) = self.late.take().or_else(|| self.from.try_recv().ok()) {
            match self.to.try_send(one) {
                Ok(()) => some = true,
                Err(TrySendError::Full(one)) => {
                    self.late = Some(one);
                    break;
                }
                Err(TrySendError::Disconnected(_)) => return None,
            }
        }
        Some(some)
    }
}

/// Whether the difference is visible.
fn differ(one: &Snapshot, other: &Snapshot) -> bool {
    one.link != other.link
        || one.link_cause != other.link_cause
        || one.page != other.page
        || one.layout_revision != other.layout_revision
        || one.boards_live != other.boards_live
        || one.counters.lost != other.counters.lost
        || one.counters.refused() != other.counters.refused()
        || one.muted.all != other.muted.all
        || one.muted.tiles != other.muted.tiles
        || one.labels != other.labels
        || one.ranges != other.ranges
        || one.held != other.held
        || one.health.counts != other.health.counts
        || one.health.troubles.len() != other.health.troubles.len()
        || one.ignored.last() != other.ignored.last()
        || one.answered.last() != other.answered.last()
        || one.feet != other.feet
        || differ_any(&one.contacts, &other.contacts, contacts)
        || differ_any(&one.widgets, &other.widgets, widgets)
        || differ_any(&one.tiles, &other.tiles, tiles)
        || differ_any(&one.grounds, &other.grounds, |one, other| {
            one.counters != other.counters || one.cracks.len() != other.cracks.len()
        })
}

fn differ_any<T>(one: &[T], other: &[T], differ: impl Fn(&T, &T) -> bool) -> bool {
    one.len() != other.len() || one.iter().zip(other).any(|(one, other)| differ(one, other))
}

fn contacts(one: &Contact, other: &Contact) -> bool {
    one.id != other.id
        || one.centroid.distance(other.centroid) > UNSEEN_M
        || (one.force.0 - other.force.0).abs() > UNSEEN_SHARE * one.force.0.max(other.force.0)
}

fn widgets(one: &WidgetState, other: &WidgetState) -> bool {
    (one.press_share - other.press_share).abs() > UNSEEN_PRESS
        || WidgetState { press_share: 0.0, ..*one } != WidgetState { press_share: 0.0, ..*other }
}

fn tiles(one: &TileState, other: &TileState) -> bool {
    one.quality != other.quality
        || one.forces.iter().zip(other.forces).any(|(one, other)| (one - other).abs() > UNSEEN_N)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preview::sample::{at_rest, map, pressing};

    fn pace(snapshot: &Snapshot) -> (Pace, Instant) {
        let now = Instant::now();
        (Pace::new(snapshot.clone(), now), now)
    }

    #[test]
    fn noise_draws_nothing_and_a_foot_does() {
        let rest = Snapshot { link: LinkState::Live, ..at_rest(&map()) };
        let (mut pace, begun) = pace(&rest);
        let mut drawn = 0;
        for look in 1..=300 {
            let mut noisy = rest.clone();
            noisy.counters.frames += 17 * look;
            noisy.tiles[7].forces[1] += 0.4 * (look as f32).sin();
            let now = begun + EVERY * look as u32;
            drawn += u32::from(pace.is_due(&noisy, true, false, now));
        }
        assert_eq!(drawn, 0, "in five seconds");
        assert_eq!((pace.pause(begun), pace.pause(begun + EVERY * 300)), (EVERY, 2 * EVERY));
        let foot = Snapshot { link: LinkState::Live, ..pressing(&map()) };
        assert!(pace.is_due(&foot, true, false, begun + EVERY * 301));
        assert!(!pace.is_due(&foot, true, false, begun + EVERY * 302), "it rests");
        assert!(pace.is_due(&foot, true, true, begun + EVERY * 303), "news");
    }

    #[test]
    fn late_checks_leave_sixty_a_second_and_missed_ones_are_not_made_up_for() {
        let (pace, begun) = pace(&at_rest(&map()));
        let late = Duration::from_millis(3);
        let last = (0..60).fold(begun, |due, _| pace.next(due, due + late));
        assert_eq!(last - begun, 60 * EVERY);
        let much_later = last + Duration::from_millis(400);
        assert_eq!(pace.next(last, much_later), much_later);
    }

    #[test]
    fn a_lost_link_and_a_silent_thread_are_counted_in_tenths() {
        let rest = Snapshot { link: LinkState::Live, ..at_rest(&map()) };
        let lost = Snapshot { link: LinkState::Lost, ..rest.clone() };
        for (snapshot, is_fresh) in [(lost, true), (rest.clone(), false)] {
            let (mut pace, begun) = pace(&rest);
            let looks =
                (1..=120).filter(|look| pace.is_due(&snapshot, is_fresh, false, begun + EVERY * *look));
            assert!(looks.count() >= 12);
        }
    }
}
