//! Keeps the controls of a window equal to the server's.

use std::collections::BTreeMap;
use std::time::Duration;

use serde_json::{Value, json};

use super::Greeting;
use crate::engine::{ControlState, Snapshot};
use crate::layout::Layout;
use crate::outgoing::json::{Message, StateRecord};
use crate::widget::WidgetId;
use crate::wire::{ControlMessage, read_json};

/// Time for which the server's state must be unchanged before a differing control here is set: both sides sense the
/// same feet, and one of them a little later.
const SETTLED: Duration = Duration::from_millis(200);

/// Maximum number of attempts to set a control to the same state: a state that is refused so often stays refused.
const MOST_TRIES: u8 = 3;

/// The reported states of a server's controls, and the requests needed here to match them.
///
/// A window that joins later has not seen the earlier feet, so its controls may differ from the server's. The
/// server's values win.
#[derive(Clone, Debug, Default)]
pub struct Follower {
    /// The controls of its layout, with the last report about each.
    controls: BTreeMap<String, Option<Target<StateRecord>>>,
    pages: Vec<String>,
    page: Option<Target<String>>,
}

/// A state to reach, as the server last reported it.
#[derive(Clone, Debug)]
struct Target<T> {
    said: T,
    /// Time of the next comparison.
    due: Duration,
    tries: u8,
}

impl<T> Target<T> {
    fn new(said: T, due: Duration) -> Self {
        Self { said, due, tries: 0 }
    }

    /// Whether a request is due at `now`; counts it as an attempt.
    fn take_try(&mut self, now: Duration) -> bool {
        if now < self.due || self.tries >= MOST_TRIES {
            return false;
        }
        self.tries += 1;
        self.due = now + SETTLED;
        true
    }
}

impl Follower {
    /// Replaces all earlier reports by those of a greeting.
    pub fn begin(&mut self, greeting: &Greeting, now: Duration) {
        let ids = greeting.layout.widgets.iter().map(|widget| (widget.id.to_string(), None));
        self.controls = ids.collect();
        self.pages = greeting.layout.pages.iter().map(|page| page.id.to_string()).collect();
        greeting.controls.iter().for_each(|control| self.hear_state(control, now));
        self.page = greeting.page.as_ref().map(|page| Target::new(page.clone(), now));
    }

    /// Processes a message of the server, at `now` on any monotonic clock. Ignores controls and pages that its layout
    /// does not have.
    pub fn hear(&mut self, message: &Message, now: Duration) {
        match message {
            Message::State(state) => self.hear_state(state, now + SETTLED),
            Message::Control(event) if event.event == "changed" => {
                if let Some(Some(control)) = self.controls.get_mut(event.id.as_str()) {
                    control.said.value = event.value.clone();
                    (control.due, control.tries) = (now + SETTLED, 0);
                }
            }
            Message::Page(shown) => {
                let known = shown.page.as_ref().filter(|page| self.pages.contains(&page.0));
                self.page = known.map(|page| Target::new(page.0.clone(), now + SETTLED));
            }
            _ => {}
        }
    }

    /// Number of controls with stored reports.
    #[cfg(test)]
    pub(super) fn kept(&self) -> usize {
        self.controls.len()
    }

    fn hear_state(&mut self, state: &StateRecord, due: Duration) {
        if let Some(control) = self.controls.get_mut(state.id.as_str()) {
            *control = Some(Target::new(state.clone(), due));
        }
    }

    /// The requests needed on the floor here; none for controls that a foot has pressed.
    pub fn corrections(&mut self, layout: &Layout, here: &Snapshot, now: Duration) -> Vec<ControlMessage> {
        let mut asked = Vec::new();
        for (index, widget) in layout.widgets.iter().enumerate() {
            let target = self.controls.get_mut(widget.id.as_str()).and_then(Option::as_mut);
            let Some(target) = target.filter(|target| now >= target.due) else { continue };
            let Some(state) = ControlState::of(layout, index, here).filter(|state| !state.pressed) else {
                continue;
            };
            let wanted = differences(&widget.id, &StateRecord::from(&state), &target.said);
            if !wanted.is_empty() && target.take_try(now) {
                asked.extend(wanted);
            }
        }
        let shown = layout.pages.get(here.page).map(|page| page.id.as_str());
        if let Some(page) = &mut self.page
            && shown.is_some_and(|shown| shown != page.said)
            && page.take_try(now)
        {
            asked.push(ControlMessage::ShowPage { page: WidgetId::new(&page.said) });
        }
        asked
    }
}

/// The requests that change a control from the state `own` to the state `said`.
fn differences(id: &WidgetId, own: &StateRecord, said: &StateRecord) -> Vec<ControlMessage> {
    let mut asked = Vec::new();
    let mut ask = |request: &str, arguments: &[Value]| {
        asked.extend(read_json(&format!("widget/{id}/{request}"), arguments));
    };
    // The range precedes the value, which must be within it.
    for (own, said, request) in [(&own.range, &said.range, "range/set"), (&own.value, &said.value, "set")] {
        if let Some(arguments) =
            said.arguments().filter(|arguments| own.arguments().as_ref() != Some(arguments))
        {
            ask(request, &arguments);
        }
    }
    for (own, said, request) in
        [(&own.label, &said.label, "label"), (&own.indicator, &said.indicator, "indicator")]
    {
        if let Some(text) = said.as_ref().filter(|_| own != said) {
            ask(request, &[json!(text)]);
        }
    }
    if let Some(on) = said.locked.filter(|_| own.locked != said.locked) {
        ask(if on { "lock" } else { "unlock" }, &[]);
    }
    // All other reasons for a control to be off follow from the same packets here.
    if let Some(off) = said.is_disabled().filter(|off| own.is_disabled() != Some(*off)) {
        ask(if off { "disable" } else { "enable" }, &[]);
    }
    asked
}
