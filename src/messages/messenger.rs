//! Decides when each message goes out.
//!
//! ```text
//! On      event                                                      -> stroke
//! While   pressed                                                    -> down
//!         released, cancelled, not among the held, link lost, silence -> up
//! Value   changed                                                    -> the latest value, at a bounded rate
//! ```
//!
//! After any history, [`Messenger::lost`] and [`Messenger::release_all`] leave nothing down.

use std::collections::BTreeMap;
use std::time::Duration;

use super::order::{Act, Holdable, MessageOrder, OscValue, Unsent};
use super::pace::{self, STROKE, ValuePace};
use super::plan::{MessageLine, MessagePlan};
use super::pointer::{PointerMotion, deflection, numbers, share, wheel};
use super::sending::{OscArgument, OscSettings, Payload, When};
use crate::rate_limit::RateLimit;
use crate::units::Instant;
use crate::widget::{EventKind, Value, WidgetEvent, WidgetId};

/// Longest time without a report that a control is held: reports come every 20 ms, so three in a row are missing.
const SILENCE: Duration = Duration::from_millis(70);

/// Runs the messages of one layout.
#[derive(Debug)]
pub struct Messenger {
    plan: MessagePlan,
    states: Vec<LineState>,
    /// The number of lines that hold each thing down.
    down: BTreeMap<(usize, Holdable), u32>,
    /// The rate of each target.
    budgets: Vec<RateLimit>,
    unsent: Unsent,
}

/// The state of one message.
#[derive(Clone, Debug, Default)]
struct LineState {
    /// Whether this message holds something down.
    is_down: bool,
    /// The last time at which the control was known to be held; `None` while it is not.
    held: Option<Instant>,
    value: Option<Value>,
    pace: ValuePace,
    motion: PointerMotion,
    /// Steps of the wheel that have gone out.
    steps: i32,
    /// Force and place of the foot at the last event.
    foot: [f32; 3],
}

impl Messenger {
    /// Runs the messages of `plan`; nothing is down.
    #[must_use]
    pub fn new(plan: MessagePlan) -> Self {
        let state = |line: &MessageLine| LineState {
            value: line.initial,
            steps: match (&line.payload, line.initial) {
                (Payload::Wheel(steps), Some(value)) => wheel(value, line.ends[0], *steps),
                _ => 0,
            },
            ..LineState::default()
        };
        let states = plan.lines.iter().map(state).collect();
        let budgets = plan.targets.iter().map(|_| pace::of_target()).collect();
        Self { plan, states, down: BTreeMap::new(), budgets, unsent: Unsent::default() }
    }

    /// The messages that it runs.
    #[must_use]
    pub const fn plan(&self) -> &MessagePlan {
        &self.plan
    }

    /// Everything that is down now, with the index of its target.
    pub fn is_down(&self) -> impl Iterator<Item = &(usize, Holdable)> {
        self.down.keys()
    }

    /// The numbers of messages that did not go out since the start.
    #[must_use]
    pub const fn unsent(&self) -> Unsent {
        self.unsent
    }

    /// Processes an event of a control; appends orders.
    pub fn event(&mut self, event: &WidgetEvent, orders: &mut Vec<MessageOrder>) {
        for index in 0..self.plan.lines.len() {
            if self.plan.lines.get(index).is_some_and(|line| line.control == event.id) {
                self.event_of(index, event, orders);
            }
        }
    }

    fn event_of(&mut self, index: usize, event: &WidgetEvent, orders: &mut Vec<MessageOrder>) {
        let (Some(line), Some(state)) = (self.plan.lines.get(index), self.states.get_mut(index)) else {
            return;
        };
        if event.contact.is_some() {
            state.foot = [event.force.0, event.position.x, event.position.y];
        }
        if let EventKind::Changed(value) = event.kind {
            state.value = Some(value);
            state.pace.waits |= line.when == When::Value;
        }
        match event.kind {
            EventKind::Pressed => state.held = Some(event.at),
            EventKind::Released | EventKind::Cancelled => state.held = None,
            _ => {}
        }
        match (line.when, event.kind) {
            (When::On(trigger), kind) if trigger.matches(kind) => self.fire(index, event.at, orders),
            (When::While, EventKind::Pressed) => self.go_down(index, event.at, orders),
            (When::While, EventKind::Released | EventKind::Cancelled) => self.come_up(index, orders),
            (When::Value, EventKind::Changed(_)) => self.follow(index, event.at, orders),
            _ => {}
        }
    }

    /// Processes the report that the controls in `held`, and no others, are held at `at`.
    pub fn held(&mut self, at: Instant, held: &[WidgetId], orders: &mut Vec<MessageOrder>) {
        for index in 0..self.states.len() {
            let is_held = self.plan.lines.get(index).is_some_and(|line| held.contains(&line.control));
            if let Some(state) = self.states.get_mut(index) {
                state.held = state.held.filter(|_| is_held).map(|before| before.max(at));
            }
            if !is_held {
                self.come_up(index, orders);
            }
        }
    }

    /// Processes the loss of the floor: everything comes up.
    pub fn lost(&mut self, orders: &mut Vec<MessageOrder>) {
        self.release_all(orders);
    }

    /// Passes the time: holds without a report end, waiting values go out, the pointer moves.
    pub fn advance(&mut self, now: Instant, orders: &mut Vec<MessageOrder>) {
        for index in 0..self.states.len() {
            let Some(state) = self.states.get_mut(index) else { continue };
            if state.held.is_some_and(|held| now.since(held) > SILENCE) {
                state.held = None;
                self.come_up(index, orders);
            }
            self.follow(index, now, orders);
        }
    }

    /// Lets everything come up; controls that are held must be pressed again.
    pub fn release_all(&mut self, orders: &mut Vec<MessageOrder>) {
        for index in 0..self.states.len() {
            if let Some(state) = self.states.get_mut(index) {
                state.held = None;
            }
            self.come_up(index, orders);
        }
    }

    /// Sends the message of an event.
    fn fire(&mut self, index: usize, now: Instant, orders: &mut Vec<MessageOrder>) {
        let (Some(line), Some(state)) = (self.plan.lines.get(index), self.states.get(index)) else { return };
        let act = match &line.payload {
            Payload::Key(key) => Act::Stroke(Holdable::Key(key.clone())),
            Payload::Button(button) => Act::Stroke(Holdable::Button(*button)),
            Payload::Wheel(steps) => Act::Wheel(*steps),
            Payload::Osc(address, settings) => Act::Osc(address.clone(), arguments(line, state, settings)),
            Payload::Pointer(_) => return,
        };
        if let Act::Stroke(what) = &act
            && self.down.contains_key(&(line.target, what.clone()))
        {
            self.unsent.held += 1;
            return;
        }
        let order = MessageOrder { target: line.target, control: line.control.clone(), act };
        if self.may_send(order.target, now, STROKE) {
            orders.push(order);
        } else {
            self.unsent.limited += 1;
        }
    }

    fn go_down(&mut self, index: usize, now: Instant, orders: &mut Vec<MessageOrder>) {
        let Some(line) = self.plan.lines.get(index) else { return };
        let (target, control) = (line.target, line.control.clone());
        let Some(what) = line.holdable() else { return };
        if !self.may_send(target, now, STROKE) {
            self.unsent.limited += 1;
            return;
        }
        let Some(state) = self.states.get_mut(index) else { return };
        if std::mem::replace(&mut state.is_down, true) {
            return;
        }
        let count = self.down.entry((target, what.clone())).or_default();
        *count += 1;
        if *count == 1 {
            orders.push(MessageOrder { target, control, act: Act::Down(what) });
        }
    }

    fn come_up(&mut self, index: usize, orders: &mut Vec<MessageOrder>) {
        let (Some(line), Some(state)) = (self.plan.lines.get(index), self.states.get_mut(index)) else {
            return;
        };
        if !std::mem::take(&mut state.is_down) {
            return;
        }
        let Some(what) = line.holdable() else { return };
        let key = (line.target, what);
        if let Some(count) = self.down.get_mut(&key).filter(|count| **count > 1) {
            *count -= 1;
            return;
        }
        self.down.remove(&key);
        orders.push(MessageOrder { target: key.0, control: line.control.clone(), act: Act::Up(key.1) });
    }

    /// Sends the message that follows the value, if a new one is due.
    fn follow(&mut self, index: usize, now: Instant, orders: &mut Vec<MessageOrder>) {
        let (Some(line), Some(state)) = (self.plan.lines.get(index), self.states.get_mut(index)) else {
            return;
        };
        if line.when != When::Value {
            return;
        }
        let Some(value) = state.value else { return };
        let act = match &line.payload {
            Payload::Pointer(speed) if state.held.is_some() => {
                let pixels = state.motion.step(now, deflection(value, line.ends), *speed);
                (pixels != [0, 0]).then_some(Act::Move(pixels))
            }
            Payload::Pointer(_) => {
                state.motion.rest();
                None
            }
            Payload::Wheel(steps) if state.pace.is_due(now) => {
                let step = wheel(value, line.ends[0], *steps) - state.steps;
                if step == 0 {
                    state.pace.sent(now);
                }
                (step != 0).then_some(Act::Wheel(step))
            }
            Payload::Osc(address, settings) if state.pace.is_due(now) => {
                Some(Act::Osc(address.clone(), arguments(line, state, settings)))
            }
            _ => None,
        };
        let Some(act) = act else { return };
        let order = MessageOrder { target: line.target, control: line.control.clone(), act };
        // A value that the rate holds back waits and goes out as the latest one; a motion is left out.
        let passes =
            self.budgets.get_mut(order.target).is_some_and(|budget| budget.take_many(now, 1).is_some());
        if passes {
            if let Act::Wheel(step) = order.act {
                state.steps += step;
            }
            state.pace.sent(now);
            orders.push(order);
        } else if matches!(order.act, Act::Move(_)) {
            self.unsent.limited += 1;
        }
    }

    fn may_send(&mut self, target: usize, now: Instant, cost: u32) -> bool {
        self.budgets.get_mut(target).is_some_and(|budget| budget.take_many(now, cost).is_some())
    }
}

/// The arguments of an OSC message now.
fn arguments(line: &MessageLine, state: &LineState, settings: &OscSettings) -> Vec<OscValue> {
    let [force, x, y] = state.foot;
    let usual: &[OscArgument] = if line.when == When::Value { &[OscArgument::Value] } else { &[] };
    let mut values = Vec::new();
    for argument in settings.arguments.as_deref().unwrap_or(usual) {
        match argument {
            OscArgument::Int(number) => values.push(OscValue::Int(*number)),
            OscArgument::Float(number) => values.push(OscValue::Float(*number)),
            OscArgument::Text(text) => values.push(OscValue::Text(text.clone())),
            OscArgument::Force => values.push(OscValue::Float(force)),
            OscArgument::X => values.push(OscValue::Float(x)),
            OscArgument::Y => values.push(OscValue::Float(y)),
            OscArgument::Value => values.extend(state.value.iter().flat_map(|value| {
                let scaled = |number: f32, ends: [f32; 2]| match settings.range {
                    Some([from, to]) => OscValue::Float(from + (to - from) * share(number, ends)),
                    None => OscValue::Float(number),
                };
                let both = numbers(*value);
                match value {
                    Value::Pair(_) => vec![scaled(both.x, line.ends[0]), scaled(both.y, line.ends[1])],
                    Value::Switch(_) | Value::Choice(_) if settings.range.is_none() => {
                        vec![OscValue::Int(both.x as i32)]
                    }
                    _ => vec![scaled(both.x, line.ends[0])],
                }
            })),
        }
    }
    values
}
