//! Pointer and wheel from the value of a control.

use std::time::Duration;

use glam::Vec2;

use crate::units::Instant;
use crate::widget::Value;

/// Longest time that one motion covers: after a pause of the caller the pointer does not leap.
const LONGEST: Duration = Duration::from_millis(50);

/// The pointer moved by a pad or by leaning: it moves by `speed * deflection * time`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PointerMotion {
    last: Option<Instant>,
    /// Parts of pixels that have not been moved yet.
    rest: Vec2,
}

impl PointerMotion {
    /// Returns the pixels to move at `now`, rightwards and downwards, with the control at `deflection` (-1 to 1,
    /// eastwards and northwards) and the speed in pixels per second.
    pub(super) fn step(&mut self, now: Instant, deflection: Vec2, speed: f32) -> [i32; 2] {
        let time = self.last.map_or(Duration::ZERO, |last| now.since(last)).min(LONGEST);
        self.last = Some(now);
        self.rest += Vec2::new(deflection.x, -deflection.y) * speed * time.as_secs_f32();
        let whole = self.rest.trunc();
        self.rest -= whole;
        whole.as_ivec2().to_array()
    }

    /// The pointer rests.
    pub(super) fn rest(&mut self) {
        *self = Self::default();
    }
}

/// Returns the two numbers of a value; a control with one number has it in both.
pub(super) fn numbers(value: Value) -> Vec2 {
    match value {
        Value::Switch(on) => Vec2::splat(f32::from(u8::from(on))),
        Value::Number(number) => Vec2::splat(number),
        Value::Choice(choice) => Vec2::splat(f32::from(choice)),
        Value::Pair(pair) => pair,
    }
}

/// Returns the place of `number` between the `ends`, 0 to 1.
pub(super) fn share(number: f32, [min, max]: [f32; 2]) -> f32 {
    let width = max - min;
    if width > 0.0 { ((number - min) / width).clamp(0.0, 1.0) } else { 0.0 }
}

/// Returns the deflection of `value` from the middle of its range, -1 to 1 on each axis; a control with one number
/// deflects eastwards only.
pub(super) fn deflection(value: Value, ends: [[f32; 2]; 2]) -> Vec2 {
    let both = numbers(value);
    let of = |number, ends| 2.0 * share(number, ends) - 1.0;
    let east = of(both.x, ends[0]);
    match value {
        Value::Pair(_) => Vec2::new(east, of(both.y, ends[1])),
        _ => Vec2::new(east, 0.0),
    }
}

/// Returns the steps of a wheel that `value` stands for, where the whole range is `steps`.
pub(super) fn wheel(value: Value, ends: [f32; 2], steps: i32) -> i32 {
    (share(numbers(value).x, ends) * steps as f32).round() as i32
}
