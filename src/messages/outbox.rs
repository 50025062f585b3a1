//! Orders on their way out: the rate of each target, and everything that is down.

use std::collections::BTreeMap;

use super::order::{Act, Holdable, MessageOrder, Unsent};
use super::pace::{self, STROKE};
use crate::rate_limit::RateLimit;
use crate::units::Instant;
use crate::widget::WidgetId;

/// The bounds and the held things of all targets.
#[derive(Debug)]
pub(super) struct Outbox {
    /// The number of lines that hold each thing down.
    down: BTreeMap<(usize, Holdable), u32>,
    /// The rate of each target.
    budgets: Vec<RateLimit>,
    pub(super) unsent: Unsent,
}

impl Outbox {
    /// An outbox for this number of targets, with nothing down.
    pub(super) fn new(targets: usize) -> Self {
        let budgets = std::iter::repeat_with(pace::of_target).take(targets).collect();
        Self { down: BTreeMap::new(), budgets, unsent: Unsent::default() }
    }

    /// Everything that is down now, with the index of its target.
    pub(super) fn is_down(&self) -> impl Iterator<Item = &(usize, Holdable)> {
        self.down.keys()
    }

    /// Whether something holds `what` down at `target`.
    pub(super) fn holds(&self, target: usize, what: &Holdable) -> bool {
        self.down.contains_key(&(target, what.clone()))
    }

    /// Whether the rate of `target` allows a message of this `cost`.
    pub(super) fn allows(&mut self, target: usize, now: Instant, cost: u32) -> bool {
        self.budgets.get_mut(target).is_some_and(|budget| budget.take_many(now, cost).is_some())
    }

    /// Sends `order`, which costs a [`STROKE`], or counts it as left out.
    pub(super) fn send(&mut self, order: MessageOrder, now: Instant, orders: &mut Vec<MessageOrder>) {
        if self.allows(order.target, now, STROKE) {
            orders.push(order);
        } else {
            self.unsent.limited += 1;
        }
    }

    /// Notes one more hold of `what`; the first one goes out. The caller has asked whether the rate allows it.
    pub(super) fn press(
        &mut self,
        (target, what): (usize, Holdable),
        control: &WidgetId,
        velocity: u8,
        orders: &mut Vec<MessageOrder>,
    ) {
        let count = self.down.entry((target, what.clone())).or_default();
        *count += 1;
        if *count == 1 {
            orders.push(MessageOrder { target, control: control.clone(), act: Act::Down(what, velocity) });
        }
    }

    /// Notes the end of one hold of `what`; with the last one it comes up.
    pub(super) fn lift(
        &mut self,
        held: (usize, Holdable),
        control: &WidgetId,
        orders: &mut Vec<MessageOrder>,
    ) {
        if let Some(count) = self.down.get_mut(&held).filter(|count| **count > 1) {
            *count -= 1;
        } else if self.down.remove(&held).is_some() {
            let (target, what) = held;
            orders.push(MessageOrder { target, control: control.clone(), act: Act::Up(what) });
        }
    }
}
