//! A selector: one of several options, selected by the place of the release.
//!
//! ```text
//!  1  press                          -> Pressed; the option under the foot is in question
//!  2  slide onto another option      -> Ticked; that one is in question
//!  3  between two options            -> the one in question stays (hysteresis)
//!  4  release                        -> Released, Changed if the option in question is not the present one
//!  5  lifting                        -> the one in question stays while the force falls
//!  6  slide off, a step, loss        -> Cancelled; the present option stays
//!  7  an app sets it                 -> no event; a number of no option is refused
//! ```

use std::sync::Arc;

use super::moment::{BehaviourInput, BehaviourMachine, FootOnControl};
use super::press::PressOutcome;
use super::{Axis, Emitted, EventKind, SetError, Thresholds, Value};
use underfoot_format::{Flat, Follow, Name, Text, list, num, record};

/// Maximum number of options: more are too narrow for a foot on any control within reach.
const MOST: usize = 12;

record! {
    /// A selector: one of several options.
    pub struct SelectorSpec = "Selector" => |it, faults| {
        let last = it.options.len().saturating_sub(1) as u16;
        if it.initial > last {
            let expected = format!("expected 0 to {last}");
            faults.error(&["initial", "options"], "`initial` is no option", expected);
        }
        it.initial = it.initial.min(last);
    };
    /// The thresholds of its press.
    pub thresholds: Thresholds = "", Flat;
    /// Whether the options stand side by side from the west, or one below the other from the north.
    pub axis: Axis = "axis", Name => Axis::East;
    /// The label of each option; 2 to 12.
    pub options: Arc<[Arc<str>]> = "options", list("option", MOST, Text(32))
        .at_least(2, "a selector needs options to choose from");
    /// The initial option, from 0.
    pub initial: u16 = "initial", Follow { explicit: num(0.0..=MOST as f64 - 1.0), otherwise: "0" };
}

/// Distance of the foot beyond the border between two options for a change, in widths of one (our choice).
const HYSTERESIS: f32 = 0.15;

/// The state of a selector.
#[derive(Clone, Debug)]
pub(super) struct Selector {
    axis: Axis,
    count: u16,
    choice: u16,
    question: Option<u16>,
}

impl Selector {
    pub(super) fn new(spec: &SelectorSpec) -> Self {
        let count = u16::try_from(spec.options.len()).unwrap_or(u16::MAX).max(1);
        Self { axis: spec.axis, count, choice: spec.initial.min(count - 1), question: None }
    }

    fn under(&self, foot: FootOnControl) -> u16 {
        let along = match self.axis {
            Axis::East => foot.place.x,
            Axis::North => 1.0 - foot.place.y,
        } * f32::from(self.count);
        let option = |along: f32| along.clamp(0.0, f32::from(self.count - 1)) as u16;
        match self.question {
            Some(held) if (along - f32::from(held) - 0.5).abs() <= 0.5 + HYSTERESIS => held,
            _ => option(along),
        }
    }
}

impl BehaviourMachine for Selector {
    fn act(&mut self, moment: &BehaviourInput, emitted: &mut Emitted) {
        match moment.outcome {
            Some(PressOutcome::Pressed) => {
                self.question = None;
                emitted.push(EventKind::Pressed);
            }
            Some(PressOutcome::Released) => {
                emitted.push(EventKind::Released);
                if let Some(choice) = self.question.take().filter(|choice| *choice != self.choice) {
                    self.choice = choice;
                    emitted.push(EventKind::Changed(Value::Choice(choice)));
                }
            }
            Some(PressOutcome::Cancelled) => {
                self.question = None;
                emitted.push(EventKind::Cancelled);
            }
            None => {}
        }
        if let Some(foot) = moment.firm_foot() {
            let now = self.under(foot);
            if self.question.is_some_and(|before| before != now) {
                emitted.push(EventKind::Ticked);
            }
            self.question = Some(now);
        }
    }

    fn value(&self) -> Option<Value> {
        Some(Value::Choice(self.choice))
    }

    fn set(&mut self, value: Value) -> Result<(), SetError> {
        let choice = match value {
            Value::Choice(choice) => choice,
            Value::Number(number) if !number.is_finite() => return Err(SetError::NotFinite),
            // Some senders have no whole numbers.
            Value::Number(number) if (0.0..=65535.0).contains(&number) && number.fract() == 0.0 => {
                number as u16
            }
            Value::Number(_) => return Err(SetError::NoSuchChoice),
            Value::Switch(_) | Value::Pair(_) => return Err(SetError::WrongType),
        };
        if choice >= self.count {
            return Err(SetError::NoSuchChoice);
        }
        self.choice = choice;
        Ok(())
    }

    fn pending(&self) -> Option<Value> {
        self.question.filter(|choice| *choice != self.choice).map(Value::Choice)
    }
}
