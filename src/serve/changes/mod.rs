//! How often other programs are told of a value that a foot keeps changing.

use std::collections::BTreeMap;
use std::time::Duration;

use crate::units::Instant;
use crate::widget::{EventKind, Value, WidgetEvent, WidgetId};

/// Least time between two reports of one control: 60 a second, as often as screens show them.
const PERIOD: Duration = Duration::from_micros(16_667);

/// Time without a change after which a value has come to rest: a foot that moves changes it every few milliseconds.
const REST: Duration = Duration::from_millis(100);

/// Second differences that the noise is averaged over: half a second.
const MEMORY: f32 = 30.0;

/// Mean size of the second difference of white noise with standard deviation 1: sqrt(6) sqrt(2 / pi).
const SECOND_DIFFERENCE: f32 = 1.954;

/// Standard deviations that a value must move by. Two readings of a foot at rest differ by sqrt(2) of them, so that
/// it is told once in twelve seconds (3.2 deviations of that difference).
const DEVIATIONS: f32 = 4.5;

/// Lets through as many `changed` of numbers as other programs can use.
///
/// A number is told 60 times a second at most and only when it has moved beyond its own noise; the last one once it
/// rests, and before anything else is told of its control. Switches and choices change once a press and go at once.
#[derive(Debug, Default)]
pub(super) struct ChangeLimiter {
    controls: BTreeMap<WidgetId, Changes>,
    /// Whether a control has a value that is still to be told.
    is_waiting: bool,
    told: Vec<WidgetEvent>,
}

/// What is known of one control's changes.
#[derive(Debug)]
struct Changes {
    /// The value that was told last, and when.
    told: (Instant, Value),
    /// The latest one, if it was not told.
    waiting: Option<WidgetEvent>,
    /// When the value was last sampled, and the samples before.
    sampled: Instant,
    samples: [Option<[f32; 2]>; 2],
    /// Mean size of the second differences of both numbers, and over how many.
    noise: [f32; 2],
    count: f32,
}

impl ChangeLimiter {
    /// Those of `events` that are told now, and those that have waited until `now`; in order.
    pub(super) fn thin(&mut self, events: &[WidgetEvent], now: Instant) -> &[WidgetEvent] {
        self.told.clear();
        for event in events {
            match event.kind {
                EventKind::Changed(value @ (Value::Number(_) | Value::Pair(_))) => self.change(event, value),
                _ => {
                    let changes = self.controls.get_mut(&event.id);
                    self.told.extend(changes.and_then(|changes| changes.tell(event.at)));
                    self.told.push(event.clone());
                }
            }
        }
        if self.is_waiting {
            self.is_waiting = false;
            for changes in self.controls.values_mut() {
                self.told.extend(changes.due(now));
                self.is_waiting |= changes.waiting.is_some();
            }
        }
        &self.told
    }

    fn change(&mut self, event: &WidgetEvent, value: Value) {
        let Some(changes) = self.controls.get_mut(&event.id) else {
            self.controls.insert(event.id.clone(), Changes::new(event.at, value));
            self.told.push(event.clone());
            return;
        };
        changes.waiting = Some(event.clone());
        self.is_waiting = true;
    }
}

fn numbers(value: Value) -> [f32; 2] {
    match value {
        Value::Pair(pair) => pair.into(),
        Value::Number(number) => [number, 0.0],
        Value::Switch(_) | Value::Choice(_) => [0.0; 2],
    }
}

impl Changes {
    fn new(at: Instant, value: Value) -> Self {
        let samples = [Some(numbers(value)), None];
        Self { told: (at, value), waiting: None, sampled: at, samples, noise: [0.0; 2], count: 0.0 }
    }

    /// The value that waits, told as that of `now`: what is told is in order of time.
    fn tell(&mut self, now: Instant) -> Option<WidgetEvent> {
        let event = WidgetEvent { at: now, ..self.waiting.take()? };
        let EventKind::Changed(value) = event.kind else { return None };
        if value == self.told.1 {
            return None;
        }
        self.told = (now, value);
        Some(event)
    }

    /// The value that waits, if its time has come.
    fn due(&mut self, now: Instant) -> Option<WidgetEvent> {
        let WidgetEvent { at, kind: EventKind::Changed(value), .. } = *self.waiting.as_ref()? else {
            return None;
        };
        if now.since(self.sampled) >= PERIOD {
            // Samples before a pause say nothing of the noise.
            if now.since(self.sampled) >= REST {
                self.samples = [None; 2];
            }
            self.sample(now, numbers(value));
        }
        let is_over = now.since(self.told.0) >= PERIOD;
        let has_rested = now.since(at) >= REST;
        (is_over && (has_rested || self.is_beyond_noise(value))).then(|| self.tell(now)).flatten()
    }

    /// Learns the noise: a steady movement has no second difference.
    fn sample(&mut self, now: Instant, value: [f32; 2]) {
        self.sampled = now;
        if let [Some(last), Some(before)] = self.samples {
            self.count = (self.count + 1.0).min(MEMORY);
            for ((noise, now), (last, before)) in
                self.noise.iter_mut().zip(value).zip(last.into_iter().zip(before))
            {
                *noise += ((now - 2.0 * last + before).abs() - *noise) / self.count;
            }
        }
        self.samples = [Some(value), self.samples[0]];
    }

    fn is_beyond_noise(&self, value: Value) -> bool {
        let moved = numbers(value).into_iter().zip(numbers(self.told.1));
        let mut moved = moved.map(|(now, told)| (now - told).abs()).zip(self.noise);
        moved.any(|(moved, noise)| moved > noise * DEVIATIONS / SECOND_DIFFERENCE)
    }
}

#[cfg(test)]
mod tests;
