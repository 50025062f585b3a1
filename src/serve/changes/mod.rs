//! Limits how often the server reports a value that a foot keeps changing.

use std::collections::BTreeMap;
use std::time::Duration;

use crate::units::Instant;
use crate::widget::{EventKind, Value, WidgetEvent, WidgetId};

/// Minimum time between two reports of one control: 60 a second, the refresh rate of screens.
const PERIOD: Duration = Duration::from_micros(16_667);

/// Time without a change after which a value is at rest: a moving foot changes it every few milliseconds.
const REST: Duration = Duration::from_millis(100);

/// Number of second differences in the noise average: half a second.
const MEMORY: f32 = 30.0;

/// Mean size of the second difference of white noise with standard deviation 1: sqrt(6) sqrt(2 / pi).
const SECOND_DIFFERENCE: f32 = 1.954;

/// Standard deviations that a value must move by. Two readings of a foot at rest differ by sqrt(2) of them, which
/// gives one report in twelve seconds (3.2 deviations of that difference).
const DEVIATIONS: f32 = 4.5;

/// Thins out the `changed` events of numbers to the rate that other programs can use.
///
/// Reports a number at most 60 times a second, and only when it has moved beyond its own noise. It reports the last
/// value once the number is at rest, and before any other event of the control. Switches and choices change once per
/// press and are reported at once.
#[derive(Debug, Default)]
pub(super) struct ChangeLimiter {
    controls: BTreeMap<WidgetId, Changes>,
    /// Whether a control has an unreported value.
    is_waiting: bool,
    told: Vec<WidgetEvent>,
}

/// State of one control's changes.
#[derive(Debug)]
struct Changes {
    /// Time and value of the last report.
    told: (Instant, Value),
    /// The latest event, if it is unreported.
    waiting: Option<WidgetEvent>,
    /// Time of the last sample, and the two samples before.
    sampled: Instant,
    samples: [Option<[f32; 2]>; 2],
    /// Mean absolute second difference of both numbers, and the number of second differences in it.
    noise: [f32; 2],
    count: f32,
}

impl ChangeLimiter {
    /// Returns the events of `events` to report now and the waiting events that are due at `now`, in order.
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

    /// Returns the waiting value with the time `now`, so that reports are in order of time.
    fn tell(&mut self, now: Instant) -> Option<WidgetEvent> {
        let event = WidgetEvent { at: now, ..self.waiting.take()? };
        let EventKind::Changed(value) = event.kind else { return None };
        if value == self.told.1 {
            return None;
        }
        self.told = (now, value);
        Some(event)
    }

    /// Returns the waiting value if it is due.
    fn due(&mut self, now: Instant) -> Option<WidgetEvent> {
        let WidgetEvent { at, kind: EventKind::Changed(value), .. } = *self.waiting.as_ref()? else {
            return None;
        };
        if now.since(self.sampled) >= PERIOD {
            // Samples before a pause contain no information on the noise.
            if now.since(self.sampled) >= REST {
                self.samples = [None; 2];
            }
            self.sample(now, numbers(value));
        }
        let is_over = now.since(self.told.0) >= PERIOD;
        let has_rested = now.since(at) >= REST;
        (is_over && (has_rested || self.is_beyond_noise(value))).then(|| self.tell(now)).flatten()
    }

    /// Updates the noise: `noise += (|value - 2 last + before| - noise) / count`. A steady movement has no second
    /// difference.
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
