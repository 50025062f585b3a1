//! Keeps controls as the server says they are.

use std::collections::BTreeMap;
use std::time::Duration;

use serde_json::Value;

use super::Greeting;
use super::greeting::spoken;
use crate::engine::{ControlState, Snapshot};
use crate::layout::Layout;
use crate::widget::WidgetId;
use crate::wire::{ControlMessage, read_json};

/// How long the server's word must have stood before a control here that differs is set: both hear of the same feet,
/// and one of them a little later.
const SETTLED: Duration = Duration::from_millis(200);

/// How often a control is set to the same word: what is refused so often stays refused.
const MOST_TRIES: u8 = 3;

/// What the server said of its controls, and what has to be asked here for them to be the same.
///
/// A window that joins in the middle has not seen the feet that came before, so its controls may hold other values than
/// the server's. The server is right.
#[derive(Clone, Debug, Default)]
pub struct Follower {
    controls: BTreeMap<String, Word<Value>>,
    page: Option<Word<String>>,
}

/// Something the server said.
#[derive(Clone, Debug)]
struct Word<T> {
    said: T,
    /// When it may be looked at again.
    due: Duration,
    tries: u8,
}

impl<T> Word<T> {
    fn new(said: T, due: Duration) -> Self {
        Self { said, due, tries: 0 }
    }

    /// Whether it may be asked for at `now`; counts that it is.
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
    /// Takes what a greeting said, in place of all that was said before.
    pub fn begin(&mut self, greeting: &Greeting, now: Duration) {
        self.controls.clear();
        greeting.controls.iter().for_each(|control| self.hear_state(control, now));
        self.page = greeting.page.as_ref().map(|page| Word::new(page.clone(), now));
    }

    /// Takes a line of the server's, at `now` on any clock that does not go back.
    pub fn hear(&mut self, line: &Value, now: Duration) {
        let text = |field: &str| line.get(field).and_then(Value::as_str);
        match text("event") {
            Some("state") => self.hear_state(line, now + SETTLED),
            Some("changed") => {
                let control = text("id").and_then(|id| self.controls.get_mut(id));
                if let (Some(control), Some(value)) = (control, line.get("value")) {
                    if let Some(state) = control.said.as_object_mut() {
                        state.insert("value".into(), value.clone());
                    }
                    (control.due, control.tries) = (now + SETTLED, 0);
                }
            }
            Some("page") => {
                self.page = text("page").map(|page| Word::new(page.to_owned(), now + SETTLED));
            }
            _ => {}
        }
    }

    fn hear_state(&mut self, state: &Value, due: Duration) {
        if let Some(id) = state.get("id").and_then(Value::as_str) {
            self.controls.insert(id.to_owned(), Word::new(state.clone(), due));
        }
    }

    /// What has to be asked of the floor here; nothing about controls that a foot has pressed.
    pub fn corrections(&mut self, layout: &Layout, here: &Snapshot, now: Duration) -> Vec<ControlMessage> {
        let mut asked = Vec::new();
        for (index, widget) in layout.widgets.iter().enumerate() {
            let Some(word) = self.controls.get_mut(widget.id.as_str()).filter(|word| now >= word.due) else {
                continue;
            };
            let Some(state) = ControlState::of(layout, index, here).filter(|state| !state.pressed) else {
                continue;
            };
            let Some(own) = spoken(&state) else { continue };
            let wanted = differences(&widget.id, &own, &word.said);
            if !wanted.is_empty() && word.take_try(now) {
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

/// What makes a control that is as `own` says be as `said` says.
fn differences(id: &WidgetId, own: &Value, said: &Value) -> Vec<ControlMessage> {
    let differs = |field: &str| {
        let said = said.get(field).filter(|said| !said.is_null())?;
        (own.get(field) != Some(said)).then_some(said)
    };
    let mut asked = Vec::new();
    let mut ask = |request: &str, arguments: &[Value]| {
        asked.extend(read_json(&format!("widget/{id}/{request}"), arguments));
    };
    // The range before the value, which must be in it.
    for (field, request) in [("range", "range/set"), ("value", "set"), ("label", "label")] {
        match differs(field) {
            // Choices, and both ranges of a pair, are the layout's.
            Some(Value::Array(all)) if all.iter().all(Value::is_number) => ask(request, all),
            Some(Value::Array(_)) | None => {}
            Some(one) => ask(request, std::slice::from_ref(one)),
        }
    }
    if let Some(lamp) = differs("indicator") {
        ask("indicator", std::slice::from_ref(lamp));
    }
    for (field, set, reset) in [("enabled", "enable", "disable"), ("locked", "lock", "unlock")] {
        if let Some(on) = differs(field).and_then(Value::as_bool) {
            ask(if on { set } else { reset }, &[]);
        }
    }
    asked
}
