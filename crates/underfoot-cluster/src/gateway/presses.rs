//! The state of controls as reported to apps: pressed, armed, and their values.
//!
//! ```text
//! events of an area that is live      -> told, and noted here
//! the area is lost                    -> what a foot had changed changes back, Cancelled, Disarmed
//! it is back, a control is still held -> nothing of it is told until the foot has let go
//! it is back, a value is another one  -> Changed, which no foot did
//! a hold without its own press        -> refused
//! ```

use std::collections::{BTreeMap, BTreeSet};

use glam::Vec2;
use underfoot::units::{Instant, Newtons};
use underfoot::widget::{EventKind, Value, WidgetEvent, WidgetId};

use crate::message::NodeValue;

/// A reported press that has not ended.
#[derive(Clone, Debug)]
struct Press {
    /// The last event reported about it.
    last: WidgetEvent,
    /// The control's value before it.
    before: Option<Value>,
}

/// The reported state of the controls of one area.
#[derive(Clone, Debug, Default)]
pub(super) struct AreaPresses {
    open: BTreeMap<String, Press>,
    armed: BTreeSet<String>,
    values: BTreeMap<String, Value>,
    /// Controls after the end of their last press: a click may follow some time later.
    let_go: BTreeSet<String>,
    /// Controls without reports until no foot holds them.
    shut: BTreeSet<String>,
    /// Held controls by the node's last list: pressed, and not without reports.
    held: BTreeSet<String>,
    /// Controls in that list that were not pressed.
    unpressed: BTreeSet<String>,
    /// Whether the node's values may differ from the reported ones.
    is_unsure: bool,
}

impl AreaPresses {
    /// Whether `event` is to be reported; if so, this updates the state.
    pub(super) fn takes(&mut self, event: &WidgetEvent) -> bool {
        let id = event.id.as_str();
        if self.shut.contains(id) {
            return false;
        }
        let is_under_way = self.open.contains_key(id) || self.let_go.contains(id);
        match event.kind {
            EventKind::Pressed => {
                let before = self.values.get(id).copied();
                self.open.insert(id.to_owned(), Press { last: event.clone(), before });
            }
            EventKind::Released | EventKind::Cancelled => {
                if self.open.remove(id).is_none() {
                    return false;
                }
                if event.kind == EventKind::Released {
                    self.let_go.insert(id.to_owned());
                } else {
                    self.let_go.remove(id);
                }
            }
            EventKind::Changed(value) => {
                self.values.insert(id.to_owned(), value);
            }
            EventKind::Armed => {
                self.armed.insert(id.to_owned());
            }
            EventKind::Disarmed => return self.armed.remove(id),
            // A consequence of a press that apps have not received, or have received as cancelled.
            EventKind::LongPressed | EventKind::HardPressed | EventKind::HardReleased => return is_under_way,
            EventKind::Clicked | EventKind::DoubleTapped | EventKind::Swiped(_) => return is_under_way,
            EventKind::Ticked | EventKind::Warned | EventKind::Refused => {}
        }
        if let Some(press) = self.open.get_mut(id) {
            press.last = event.clone();
        }
        true
    }

    /// Ends all reported presses and armed states at `at`, and returns the events about it.
    pub(super) fn cancel(&mut self, at: Instant) -> Vec<WidgetEvent> {
        let mut told = Vec::new();
        for (id, Press { last, before }) in std::mem::take(&mut self.open) {
            let event = |kind| WidgetEvent { at, kind, ..last.clone() };
            // Only a foot keeps a momentary control on; so it was off before, even without a report.
            let was_on = self.values.get(&id).copied() == Some(Value::Switch(true));
            let before = before.or(was_on.then_some(Value::Switch(false)));
            if let Some(value) = before.filter(|before| self.values.get(&id) != Some(before)) {
                self.values.insert(id, value);
                told.push(event(EventKind::Changed(value)));
            }
            told.push(event(EventKind::Cancelled));
        }
        for id in std::mem::take(&mut self.armed) {
            told.push(by_nobody(at, &id, EventKind::Disarmed));
        }
        self.held.clear();
        self.unpressed.clear();
        self.let_go.clear();
        self.is_unsure = true;
        told
    }

    /// Stops reports of the `held` controls until their feet have released them.
    pub(super) fn shut(&mut self, held: &[String]) {
        self.shut.extend(held.iter().cloned());
    }

    /// Takes the node's list of held controls; only pressed ones count. Returns the number of new ones without a
    /// press.
    pub(super) fn hold(&mut self, held: &[String]) -> u64 {
        self.shut.retain(|id| held.contains(id));
        let (pressed, not): (BTreeSet<&String>, BTreeSet<&String>) =
            held.iter().filter(|id| !self.shut.contains(*id)).partition(|id| self.open.contains_key(*id));
        self.held = pressed.into_iter().cloned().collect();
        let new = not.iter().filter(|id| !self.unpressed.contains(**id)).count();
        self.unpressed = not.into_iter().cloned().collect();
        new as u64
    }

    /// The controls held by feet.
    pub(super) fn held(&self) -> impl Iterator<Item = &str> {
        self.held.iter().map(String::as_str)
    }

    /// Compares `values` with the reported ones and returns the events for those that differ, as of `at`.
    pub(super) fn compare(&mut self, values: &[(String, NodeValue)], at: Instant) -> Vec<WidgetEvent> {
        let mut told = Vec::new();
        for (id, value) in values {
            if self.open.contains_key(id) || self.shut.contains(id) {
                continue;
            }
            let Some(value) = value.value() else { continue };
            match self.values.get(id) {
                None => {
                    self.values.insert(id.clone(), value);
                }
                Some(known) if self.is_unsure && *known != value => {
                    self.values.insert(id.clone(), value);
                    told.push(by_nobody(at, id, EventKind::Changed(value)));
                }
                Some(_) => {}
            }
        }
        // Controls without reports are compared once their reports resume.
        self.is_unsure &= !self.shut.is_empty();
        told
    }
}

fn by_nobody(at: Instant, id: &str, kind: EventKind) -> WidgetEvent {
    let (id, force, position) = (WidgetId::new(id), Newtons::ZERO, Vec2::ZERO);
    WidgetEvent { at, id, kind, contact: None, force, position }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> Instant {
        Instant::from_millis(ms)
    }

    fn takes(presses: &mut AreaPresses, ms: u64, kind: EventKind) -> bool {
        presses.takes(&by_nobody(at(ms), "drive", kind))
    }

    fn kinds(events: &[WidgetEvent]) -> Vec<EventKind> {
        events.iter().map(|event| event.kind).collect()
    }

    const ON: EventKind = EventKind::Changed(Value::Switch(true));
    const OFF: EventKind = EventKind::Changed(Value::Switch(false));

    #[test]
    fn a_hold_that_is_cut_off_is_off_and_cancelled_and_does_not_come_back_by_itself() {
        let mut presses = AreaPresses::default();
        let held = ["drive".to_owned()];
        assert!(takes(&mut presses, 1, EventKind::Pressed) && takes(&mut presses, 1, ON));
        presses.hold(&held);
        assert_eq!(presses.held().collect::<Vec<_>>(), ["drive"]);
        assert_eq!(kinds(&presses.cancel(at(100))), [OFF, EventKind::Cancelled]);
        assert_eq!(presses.held().count(), 0);
        // The node is back, and the foot is still there.
        presses.shut(&held);
        presses.hold(&held);
        assert_eq!(presses.held().count(), 0);
        assert!(!takes(&mut presses, 200, OFF) && !takes(&mut presses, 200, EventKind::Released));
        presses.hold(&[]);
        assert!(takes(&mut presses, 300, EventKind::Pressed));
    }

    #[test]
    fn a_hold_counts_only_after_its_own_press() {
        let mut presses = AreaPresses::default();
        let held = ["drive".to_owned()];
        assert_eq!(presses.hold(&held), 1);
        assert_eq!(presses.hold(&held), 0, "the same hold");
        assert_eq!(presses.held().count(), 0);
        assert!(!takes(&mut presses, 5, EventKind::Released));
        takes(&mut presses, 6, EventKind::Pressed);
        assert_eq!(presses.hold(&held), 0);
        assert_eq!(presses.held().collect::<Vec<_>>(), ["drive"]);
        takes(&mut presses, 7, EventKind::Released);
        assert_eq!((presses.hold(&held), presses.held().count()), (1, 0));
    }

    #[test]
    fn a_click_is_told_after_its_release_and_never_after_a_cancellation() {
        let mut presses = AreaPresses::default();
        takes(&mut presses, 1, EventKind::Pressed);
        assert!(takes(&mut presses, 9, EventKind::Released) && takes(&mut presses, 300, EventKind::Clicked));
        takes(&mut presses, 320, EventKind::Pressed);
        presses.cancel(at(430));
        assert!(!takes(&mut presses, 440, EventKind::Released));
        assert!(!takes(&mut presses, 440, EventKind::Clicked));
    }

    #[test]
    fn a_slider_changes_back_and_what_it_holds_after_all_is_told_when_the_node_is_back() {
        let mut presses = AreaPresses::default();
        let number = |number| vec![("drive".to_owned(), NodeValue::Number(number))];
        assert!(presses.compare(&number(0.2), at(0)).is_empty(), "what it holds at the start is no news");
        takes(&mut presses, 1, EventKind::Pressed);
        takes(&mut presses, 5, EventKind::Changed(Value::Number(0.6)));
        takes(&mut presses, 6, EventKind::Armed);
        let back = EventKind::Changed(Value::Number(0.2));
        assert_eq!(kinds(&presses.cancel(at(100))), [back, EventKind::Cancelled, EventKind::Disarmed]);
        // The foot released it while the area was lost, and the control has kept the foot's value.
        let news = presses.compare(&number(0.6), at(300));
        assert_eq!(kinds(&news), [EventKind::Changed(Value::Number(0.6))]);
        assert!(presses.compare(&number(0.7), at(400)).is_empty(), "its event tells");
    }
}
