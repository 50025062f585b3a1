//! Decides when each message goes out.
//!
//! ```text
//! On      event                                                      -> stroke; a note sounds for its time
//! While   pressed                                                    -> down
//!         released, cancelled, not among the held, link lost, silence -> up
//! Value   changed                                                    -> the latest value, at a bounded rate
//! Contacts                                                           -> the feet on free floor (`feet`)
//! ```
//!
//! After any history, [`Messenger::lost`] and [`Messenger::release_all`] leave nothing down.

use std::sync::Arc;
use std::time::Duration;

use super::content::{self, ControlMoment};
use super::feet::AreaFeet;
use super::order::{Act, Holdable, MessageOrder, Unsent};
use super::outbox::Outbox;
use super::pace::{STROKE, ValuePace};
use super::plan::{MessageLine, MessagePlan};
use super::pointer::{PointerMotion, deflection, wheel};
use super::sending::{Payload, When};
use crate::sense::{Contact, ContactId};
use crate::units::Instant;
use crate::widget::{EventKind, WidgetEvent, WidgetId};

/// Longest time without a report that a control is held: reports come every 20 ms, so three in a row are missing.
const SILENCE: Duration = Duration::from_millis(70);

/// Runs the messages of one layout.
#[derive(Debug)]
pub struct Messenger {
    plan: Arc<MessagePlan>,
    states: Vec<LineState>,
    feet: Vec<AreaFeet>,
    outbox: Outbox,
}

/// The state of one message.
#[derive(Clone, Debug, Default)]
struct LineState {
    /// Whether this message holds something down.
    is_down: bool,
    /// The time at which the note of an event ends; `None` for a hold.
    sounds_until: Option<Instant>,
    /// The last time at which the control was known to be held; `None` while it is not.
    held: Option<Instant>,
    moment: ControlMoment,
    pace: ValuePace,
    motion: PointerMotion,
    /// Steps of the wheel that have gone out.
    steps: i32,
    /// The act that followed the value last.
    told: Option<Act>,
    strike: Strike,
}

/// The press that gives a note its velocity.
#[derive(Clone, Copy, Debug, Default)]
struct Strike {
    contact: Option<ContactId>,
    /// Greatest force of the foot since it pressed, in newtons.
    peak: f32,
}

impl Messenger {
    /// Runs the messages of `plan`; nothing is down.
    #[must_use]
    pub fn new(plan: MessagePlan) -> Self {
        let state = |line: &MessageLine| LineState {
            moment: ControlMoment { value: line.initial, ..ControlMoment::default() },
            steps: match (&line.payload, line.initial) {
                (Payload::Wheel(steps), Some(value)) => wheel(value, line.ends[0], *steps),
                _ => 0,
            },
            ..LineState::default()
        };
        let states = plan.lines.iter().map(state).collect();
        let feet = plan.areas.iter().map(|_| AreaFeet::default()).collect();
        let outbox = Outbox::new(plan.targets.len());
        Self { plan: Arc::new(plan), states, feet, outbox }
    }

    /// The messages that it runs.
    #[must_use]
    pub const fn plan(&self) -> &Arc<MessagePlan> {
        &self.plan
    }

    /// Everything that is down now, with the index of its target.
    pub fn is_down(&self) -> impl Iterator<Item = &(usize, Holdable)> {
        self.outbox.is_down()
    }

    /// The numbers of messages that did not go out since the start.
    #[must_use]
    pub const fn unsent(&self) -> Unsent {
        self.outbox.unsent
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
            state.moment.foot = [event.force.0, event.position.x, event.position.y];
            state.strike.peak = state.strike.peak.max(event.force.0);
        }
        if let EventKind::Changed(value) = event.kind {
            state.moment.value = Some(value);
            state.pace.waits |= line.when == When::Value;
        }
        match event.kind {
            EventKind::Pressed => {
                state.held = Some(event.at);
                state.strike = Strike { contact: event.contact, peak: event.force.0 };
            }
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

    /// Processes the contacts of a frame.
    pub fn contacts(&mut self, at: Instant, contacts: &[Contact], orders: &mut Vec<MessageOrder>) {
        for (line, feet) in self.plan.areas.iter().zip(&mut self.feet) {
            feet.frame(line, at, contacts, &mut self.outbox, orders);
        }
        for strike in self.states.iter_mut().map(|state| &mut state.strike) {
            let Some(id) = strike.contact else { continue };
            match contacts.iter().find(|contact| contact.id == id) {
                Some(contact) => strike.peak = strike.peak.max(contact.force.0),
                None => strike.contact = None,
            }
        }
    }

    /// Processes the report that the controls in `held`, and no others, are held at `at`.
    pub fn held(&mut self, at: Instant, held: &[WidgetId], orders: &mut Vec<MessageOrder>) {
        for index in 0..self.states.len() {
            let is_held = self.plan.lines.get(index).is_some_and(|line| held.contains(&line.control));
            let Some(state) = self.states.get_mut(index) else { continue };
            state.held = state.held.filter(|_| is_held).map(|before| before.max(at));
            if !is_held && state.sounds_until.is_none() {
                self.come_up(index, orders);
            }
        }
    }

    /// Processes the loss of the floor: everything comes up.
    pub fn lost(&mut self, orders: &mut Vec<MessageOrder>) {
        self.release_all(orders);
    }

    /// Passes the time: holds without a report and notes of events end, waiting values go out, the pointer moves.
    pub fn advance(&mut self, now: Instant, orders: &mut Vec<MessageOrder>) {
        for index in 0..self.states.len() {
            let Some(state) = self.states.get_mut(index) else { continue };
            let is_over = state.sounds_until.is_some_and(|end| now >= end);
            if state.held.is_some_and(|held| now.since(held) > SILENCE) {
                state.held = None;
                if state.sounds_until.is_none() {
                    self.come_up(index, orders);
                }
            }
            if is_over {
                self.come_up(index, orders);
            }
            self.follow(index, now, orders);
        }
        for (line, feet) in self.plan.areas.iter().zip(&mut self.feet) {
            feet.advance(line, (now, SILENCE), &mut self.outbox, orders);
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
        for (line, feet) in self.plan.areas.iter().zip(&mut self.feet) {
            feet.leave(line, &mut self.outbox, orders);
        }
    }

    /// Sends the message of an event.
    fn fire(&mut self, index: usize, now: Instant, orders: &mut Vec<MessageOrder>) {
        let (Some(line), Some(state)) = (self.plan.lines.get(index), self.states.get(index)) else { return };
        if let Payload::Note(_, settings) = &line.payload {
            let ends = now + settings.length;
            let sounds = state.is_down;
            if !sounds && line.holdable().is_some_and(|note| self.outbox.holds(line.target, &note)) {
                self.outbox.unsent.held += 1;
                return;
            }
            // A note that still sounds is struck again.
            self.come_up(index, orders);
            self.go_down(index, now, orders);
            if let Some(state) = self.states.get_mut(index) {
                state.sounds_until = state.is_down.then_some(ends);
            }
            return;
        }
        let Some(act) = content::of_event(line, &state.moment) else { return };
        if let Act::Stroke(what) = &act
            && self.outbox.holds(line.target, what)
        {
            self.outbox.unsent.held += 1;
            return;
        }
        self.outbox.send(line.order(act), now, orders);
    }

    fn go_down(&mut self, index: usize, now: Instant, orders: &mut Vec<MessageOrder>) {
        let (Some(line), Some(state)) = (self.plan.lines.get(index), self.states.get_mut(index)) else {
            return;
        };
        let Some(what) = line.holdable() else { return };
        if !self.outbox.allows(line.target, now, STROKE) {
            self.outbox.unsent.limited += 1;
            return;
        }
        if std::mem::replace(&mut state.is_down, true) {
            return;
        }
        let velocity = match &line.payload {
            Payload::Note(_, settings) => settings.velocity_at(state.strike.peak),
            _ => 127,
        };
        self.outbox.press((line.target, what), &line.control, velocity, orders);
    }

    fn come_up(&mut self, index: usize, orders: &mut Vec<MessageOrder>) {
        let (Some(line), Some(state)) = (self.plan.lines.get(index), self.states.get_mut(index)) else {
            return;
        };
        state.sounds_until = None;
        if !std::mem::take(&mut state.is_down) {
            return;
        }
        let Some(what) = line.holdable() else { return };
        self.outbox.lift((line.target, what), &line.control, orders);
    }

    /// Sends the message that follows the value, if a new one is due.
    fn follow(&mut self, index: usize, now: Instant, orders: &mut Vec<MessageOrder>) {
        let (Some(line), Some(state)) = (self.plan.lines.get(index), self.states.get_mut(index)) else {
            return;
        };
        if line.when != When::Value {
            return;
        }
        let Some(value) = state.moment.value else { return };
        let act = match &line.payload {
            Payload::Pointer(speed) if state.held.is_some() => {
                let pixels = state.motion.step(now, deflection(value, line.ends), *speed);
                (pixels != [0, 0]).then_some(Act::Move(pixels))
            }
            Payload::Pointer(_) => {
                state.motion.rest();
                None
            }
            _ if state.pace.is_due(now) => content::of_value(line, &state.moment, value, state.steps),
            _ => None,
        };
        let Some(act) = act else { return };
        // Values between which the message makes no difference go out once.
        let is_old = match &act {
            Act::Wheel(step) => *step == 0,
            Act::Midi(_) | Act::Dmx(_) | Act::Mqtt(_) => state.told.as_ref() == Some(&act),
            _ => false,
        };
        if is_old {
            state.pace.sent(now);
            return;
        }
        // A value that the rate holds back waits and goes out as the latest one; a motion is left out.
        if self.outbox.allows(line.target, now, 1) {
            match &act {
                Act::Wheel(step) => state.steps += step,
                Act::Midi(_) | Act::Dmx(_) | Act::Mqtt(_) => state.told = Some(act.clone()),
                _ => {}
            }
            state.pace.sent(now);
            orders.push(line.order(act));
        } else if matches!(act, Act::Move(_)) {
            self.outbox.unsent.limited += 1;
        }
    }
}
