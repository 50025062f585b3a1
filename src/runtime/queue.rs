//! Bounded queue of events from the sensing thread to the app; the sensing thread never blocks on it.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::Duration;

use super::event::Event;

/// Maximum number of waiting events, not counting those that the app must know: some seconds of every foot of a
/// crowd.
const WAITING: usize = 1024;

/// Events that wait for the app.
#[derive(Debug, Default)]
struct Waiting {
    events: VecDeque<Event>,
    /// Whether every change of a value is kept.
    every_change: bool,
    dropped: u64,
}

impl Waiting {
    /// Adds `event`; a new value replaces one that still waits, unless another event of that control came in between.
    fn put(&mut self, event: Event) {
        if event.is_change() && !self.every_change {
            let last = self.events.iter().rposition(|other| other.id() == event.id());
            if let Some(last) = last.filter(|&last| self.events.get(last).is_some_and(Event::is_change)) {
                self.events.remove(last);
            }
        }
        if self.events.len() >= WAITING {
            self.make_room(&event);
        }
        self.events.push_back(event);
    }

    /// Drops the oldest event that the app need not know or that a later one replaces; none if the app must know all.
    fn make_room(&mut self, next: &Event) {
        let events = &self.events;
        let is_outdated = |(at, event): &(usize, &Event)| {
            let mut later = events.iter().skip(at + 1).chain([next]);
            !event.must_be_known() || later.any(|later| event.is_outdated_by(later))
        };
        let oldest = events.iter().enumerate().find(is_outdated).map(|(at, _)| at);
        if let Some(at) = oldest {
            self.events.remove(at);
            self.dropped += 1;
        }
    }
}

/// The app's end of the queue.
#[derive(Debug, Default)]
pub(super) struct EventQueue {
    state: Mutex<State>,
    arrived: Condvar,
}

#[derive(Debug, Default)]
struct State {
    waiting: Waiting,
    ended: bool,
}

impl EventQueue {
    pub(super) fn new(every_change: bool) -> Self {
        let queue = Self::default();
        queue.lock().waiting.every_change = every_change;
        queue
    }

    /// The next event, if any; never waits.
    pub(super) fn next(&self) -> Option<Event> {
        self.lock().waiting.events.pop_front()
    }

    /// The next event, if one arrives within `patience`; none arrives after the end.
    pub(super) fn next_timeout(&self, patience: Duration) -> Option<Event> {
        let is_empty = |state: &mut State| state.waiting.events.is_empty() && !state.ended;
        let waited = self.arrived.wait_timeout_while(self.lock(), patience, is_empty);
        let (mut state, _) = waited.unwrap_or_else(PoisonError::into_inner);
        state.waiting.events.pop_front()
    }

    /// Whether all events were taken, the last one included.
    pub(super) fn is_drained(&self) -> bool {
        let state = self.lock();
        state.ended && state.waiting.events.is_empty()
    }

    /// Number of events dropped because the app did not take them.
    pub(super) fn dropped(&self) -> u64 {
        self.lock().waiting.dropped
    }

    /// Adds the last event. May block on the app's threads: nothing is held any more.
    pub(super) fn end(&self, event: Event) {
        let mut state = self.lock();
        state.waiting.put(event);
        state.ended = true;
        drop(state);
        self.arrived.notify_all();
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The sensing thread's end of the queue.
#[derive(Debug)]
pub(super) struct QueueInput {
    queue: Arc<EventQueue>,
    /// Events that arrived while the app had the queue locked.
    held_up: Waiting,
}

impl QueueInput {
    pub(super) fn new(queue: Arc<EventQueue>, every_change: bool) -> Self {
        Self { queue, held_up: Waiting { every_change, ..Waiting::default() } }
    }

    /// Passes on `event`, now or with the next call.
    pub(super) fn put(&mut self, event: Event) {
        self.held_up.put(event);
        self.flush();
    }

    /// Passes on the delayed events.
    pub(super) fn flush(&mut self) {
        if self.held_up.events.is_empty() {
            return;
        }
        let queue = Arc::clone(&self.queue);
        let state = match queue.state.try_lock() {
            Ok(state) => state,
            Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
            Err(TryLockError::WouldBlock) => return,
        };
        self.pass_on(state);
    }

    fn pass_on(&mut self, mut state: MutexGuard<'_, State>) {
        state.waiting.dropped += std::mem::take(&mut self.held_up.dropped);
        self.held_up.events.drain(..).for_each(|event| state.waiting.put(event));
        drop(state);
        self.queue.arrived.notify_all();
    }
}

impl Drop for QueueInput {
    /// No more events follow, so this may block on the app.
    fn drop(&mut self) {
        let queue = Arc::clone(&self.queue);
        self.pass_on(queue.lock());
    }
}

#[cfg(test)]
mod tests {
    use std::borrow::Cow;

    use glam::Vec2;

    use super::*;
    use crate::runtime::{EndReason, Kind};
    use crate::sink::Report;
    use crate::units::{Instant, Newtons};
    use crate::widget::{EventKind, Value, WidgetEvent, WidgetId};
    use crate::wire::LinkState;

    fn event(ms: u64, id: &str, kind: EventKind) -> Event {
        let (at, id) = (Instant::from_millis(ms), WidgetId::new(id));
        let (force, position) = (Newtons(100.0), Vec2::ZERO);
        let event = WidgetEvent { at, id, kind, contact: None, force, position };
        Event::of(&Report::Event(Cow::Owned(event))).unwrap()
    }

    fn changed(ms: u64, id: &str) -> Event {
        event(ms, id, EventKind::Changed(Value::Number(ms as f32)))
    }

    fn taken(queue: &EventQueue) -> Vec<(u64, String)> {
        let event = |event: Event| (event.at.micros() / 1000, event.id().to_owned());
        std::iter::from_fn(|| queue.next()).map(event).collect()
    }

    #[test]
    fn of_several_values_that_wait_the_latest_is_told_unless_each_one_is_asked_for() {
        for every_change in [false, true] {
            let queue = Arc::new(EventQueue::new(every_change));
            let mut input = QueueInput::new(Arc::clone(&queue), every_change);
            input.put(event(1, "zoom", EventKind::Pressed));
            for ms in 2..5 {
                input.put(changed(ms, "zoom"));
                input.put(changed(ms, "pan"));
            }
            input.put(event(5, "zoom", EventKind::Released));
            // A value does not replace one before an event in between.
            input.put(changed(6, "zoom"));
            assert_eq!(queue.dropped(), 0);
            let all = taken(&queue);
            assert_eq!(all.len(), if every_change { 9 } else { 5 }, "{all:?}");
            assert!(all.is_sorted_by_key(|(ms, _)| *ms), "{all:?}");
        }
    }

    #[test]
    fn an_app_that_never_reads_misses_no_end_of_a_press_no_state_and_not_how_much() {
        let queue = Arc::new(EventQueue::new(true));
        let mut input = QueueInput::new(Arc::clone(&queue), true);
        input.put(Event::of(&Report::Link(Instant::START, LinkState::Lost)).unwrap());
        let ids: Vec<String> = (0..20).map(|number| format!("control {number}")).collect();
        for ms in 0..5000 {
            let id = &ids[ms as usize % ids.len()];
            input.put(event(ms, id, EventKind::Pressed));
            input.put(changed(ms, id));
            let end = if ms % 3 == 0 { EventKind::Cancelled } else { EventKind::Released };
            input.put(event(ms, id, end));
        }
        drop(input);
        queue.end(Event::ended(Instant::START, EndReason::Stopped, String::new()));
        let dropped = queue.dropped();
        let told: Vec<Event> = std::iter::from_fn(|| queue.next()).collect();
        assert!(told.len() <= WAITING + 1, "{}", told.len());
        assert_eq!(dropped, 15_002 - told.len() as u64);
        assert_eq!(told[0].kind, Kind::Link(LinkState::Lost));
        assert_eq!(told.last().unwrap().kind, Kind::Ended(EndReason::Stopped));
        for id in &ids {
            let last = told.iter().rfind(|event| event.id() == id).unwrap();
            assert!(last.must_be_known(), "{id} was left pressed: {last:?}");
        }
    }

    #[test]
    fn the_sensing_thread_never_waits_for_the_app() {
        let queue = Arc::new(EventQueue::new(false));
        let mut input = QueueInput::new(Arc::clone(&queue), false);
        let held = queue.lock();
        input.put(changed(1, "zoom"));
        drop(held);
        assert!(queue.next().is_none());
        input.flush();
        assert_eq!(taken(&queue), [(1, "zoom".into())]);
    }
}
