//! The range, steps and detents of a number.

use underfoot_format::Faults;
use underfoot_format::number::plain;
use underfoot_format::{Follow, Num, num, record};

/// Range of values of controls: `f32` still resolves a tenth.
pub(super) const VALUES: Num = num(-1e6..=1e6);

/// The same range for values from apps.
pub(super) const ENDS: std::ops::RangeInclusive<f32> = -1e6..=1e6;

/// An initial value.
pub(super) const INITIAL: Follow<Num> = Follow { explicit: VALUES, otherwise: "the least" };

/// Range of distances between values.
pub(super) const WIDTHS: Num = num(0.0..=1e6);

record! {
    /// The allowed values of a control's number.
    pub struct Scale = "Scale", Copy => |it, faults| it.check(faults, "");
    /// The least value.
    pub min: f32 = "min", VALUES;
    /// The greatest value; more than `min`.
    pub max: f32 = "max", VALUES;
    /// Distance between allowed values, counted from `min`; 0 for any value. `max` is always allowed.
    pub step: f32 = "step", WIDTHS => 0.0;
    /// Distance between values that attract the number, counted from `min`; 0 for none.
    pub detent: f32 = "detent", WIDTHS => 0.0;
}

/// Distance of the foot beyond the middle between two steps at which the number follows, in steps (our choice: a foot
/// that rests between two steps sways by less).
const HYSTERESIS: f32 = 0.15;

/// Distance from a detent within which it attracts a value: in detents, and at most this part of the range.
const PULL: (f32, f32) = (0.15, 0.04);

/// Factor of that distance for leaving the detent.
const GRIP: f32 = 1.5;

/// Minimum change for an event where there are no steps, as a part of the range (our choice).
pub(super) const QUANTUM: f32 = 1e-3;

impl Scale {
    /// Reports faults of the scale; `way` is the direction of a pad's scale, followed by a space.
    pub(super) fn check(&self, faults: &mut Faults, way: &str) {
        let Self { min, max, step, detent } = *self;
        let shown = |value: f32| plain(value.into());
        let range = format!("{way}the range is only {} wide", shown(max - min));
        let steps = (max - min) / step;
        if min >= max {
            let found = format!("{way}min is {}, max is {}", shown(min), shown(max));
            faults.error(&["max", "min"], "`max` must be greater than `min`", found);
            return;
        }
        if step > max - min {
            faults.error(&["step", "max", "min"], "`step` is wider than the range", range.clone());
        } else if step > 0.0 && (steps - steps.round()).abs() > 1e-3 && way.is_empty() {
            let message = "`max` is no whole number of steps from `min`";
            let found = format!("{} to {} is {} steps", shown(min), shown(max), shown(steps));
            faults.warning(&["step", "max", "min"], message, found);
        }
        if detent > max - min {
            faults.error(&["detent", "max", "min"], "`detent` is wider than the range", range);
        } else if detent > 0.0 && step > 0.0 && way.is_empty() {
            let expected = "`step` and `detent` are both given";
            faults.warning(&["detent", "step"], "steps are detents already", expected);
        }
    }

    /// Clamps an initial value to the range; reports it if it was written and lies outside.
    pub(super) fn check_initial(&self, initial: &mut f32, faults: &mut Faults) {
        let nearest = initial.min(self.max).max(self.min);
        if nearest != *initial {
            let range = format!("expected {} to {}", plain(self.min.into()), plain(self.max.into()));
            faults.error(&["initial", "min", "max"], "`initial` lies outside of the range", range);
        }
        *initial = nearest;
    }

    /// Any value from 0 to 1.
    pub const UNIT: Self = Self::new(0.0, 1.0);

    /// Any value from `min` to `max`.
    #[must_use]
    pub const fn new(min: f32, max: f32) -> Self {
        Self { min, max, step: 0.0, detent: 0.0 }
    }

    /// `max - min`.
    #[must_use]
    pub fn range(&self) -> f32 {
        self.max - self.min
    }

    /// Position of `value` on the scale: 0 at `min`, 1 at `max`, clamped; 0 for NaN.
    #[must_use]
    pub fn share(&self, value: f32) -> f32 {
        let share = ((value - self.min) / self.range()).clamp(0.0, 1.0);
        if share.is_nan() { 0.0 } else { share }
    }

    /// The value at `share` (0 to 1) of the scale, before steps and detents.
    #[must_use]
    pub fn at(&self, share: f32) -> f32 {
        self.min + self.range() * share
    }

    /// `value` limited to the range; `min` for a range without values, whose problem the reader of the layout reports.
    pub(super) fn limited(&self, value: f32) -> f32 {
        value.min(self.max).max(self.min)
    }

    /// The nearest allowed value; `min` for NaN.
    #[must_use]
    pub fn settle(&self, value: f32) -> f32 {
        if value.is_nan() {
            return self.min;
        }
        let value = self.limited(value);
        if self.step > 0.0 { nearest(value, self.min, self.step).min(self.max) } else { value }
    }

    /// Whether `value` is a step or a detent, to be felt.
    #[must_use]
    pub(crate) fn is_stop(&self, value: f32) -> bool {
        self.step > 0.0
            || (self.detent > 0.0
                && (nearest(value, self.min, self.detent) - value).abs() <= 1e-5 * self.range())
    }

    /// The next value after `current` when the foot asks for `wanted`; `None` if it stays.
    ///
    /// Without steps, changes of less than `quantum` (a part of the range) are left out.
    pub(super) fn follow(&self, current: f32, wanted: f32, quantum: f32) -> Option<f32> {
        if wanted.is_nan() {
            return None;
        }
        let wanted = self.limited(wanted);
        let at_an_end = wanted == self.min || wanted == self.max;
        let next = if self.step > 0.0 {
            let held = (wanted - current).abs() < (0.5 + HYSTERESIS) * self.step;
            if held && !at_an_end { current } else { self.settle(wanted) }
        } else {
            let next = self.drawn(current, wanted);
            let little = (next - current).abs() < quantum * self.range();
            if little && !at_an_end && next == wanted { current } else { next }
        };
        (next != current).then_some(next)
    }

    /// `wanted`, or a detent within reach.
    fn drawn(&self, current: f32, wanted: f32) -> f32 {
        if self.detent <= 0.0 {
            return wanted;
        }
        let detent = nearest(wanted, self.min, self.detent).min(self.max);
        let pull = (PULL.0 * self.detent).min(PULL.1 * self.range());
        let reach = if current == detent { GRIP * pull } else { pull };
        if (wanted - detent).abs() <= reach { detent } else { wanted }
    }
}

fn nearest(value: f32, from: f32, step: f32) -> f32 {
    from + ((value - from) / step).round() * step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_foot_between_two_steps_does_not_make_them_chatter() {
        let scale = Scale { step: 1.0, ..Scale::new(0.0, 10.0) };
        let mut value = 3.0;
        let mut changes = 0;
        for millis in 0..1000 {
            // Sways by a tenth of a step to either side of the middle.
            let wanted = 3.5 + 0.1 * (millis as f32 / 20.0).sin();
            if let Some(next) = scale.follow(value, wanted, QUANTUM) {
                value = next;
                changes += 1;
            }
        }
        assert!(changes <= 1, "{changes}");
        assert_eq!(scale.follow(3.0, 3.7, QUANTUM), Some(4.0));
    }

    #[test]
    fn both_ends_can_be_reached_however_the_steps_fall() {
        let scale = Scale { step: 4.0, ..Scale::new(0.0, 10.0) };
        assert_eq!(scale.follow(8.0, 10.0, QUANTUM), Some(10.0));
        assert_eq!(scale.follow(10.0, 8.9, QUANTUM), None);
        assert_eq!(scale.follow(10.0, 7.0, QUANTUM), Some(8.0));
        assert_eq!(scale.follow(4.0, -3.0, QUANTUM), Some(0.0));
        assert_eq!(scale.follow(4.0, f32::NAN, QUANTUM), None);
    }

    #[test]
    fn a_detent_draws_the_value_and_holds_it() {
        // A balance: left, middle, right.
        let scale = Scale { detent: 1.0, ..Scale::new(-1.0, 1.0) };
        assert_eq!(scale.follow(0.3, 0.07, QUANTUM), Some(0.0));
        assert_eq!(scale.follow(0.0, 0.1, QUANTUM), None, "held");
        assert_eq!(scale.follow(0.0, 0.13, QUANTUM), Some(0.13));
        assert!(scale.is_stop(0.0) && !scale.is_stop(0.13) && scale.is_stop(-1.0));
    }

    #[test]
    fn nonsense_is_brought_into_the_range() {
        let scale = Scale::new(-2.0, 2.0);
        assert_eq!(scale.settle(f32::NAN), -2.0);
        assert_eq!(scale.settle(f32::INFINITY), 2.0);
        assert_eq!(scale.share(f32::NAN), 0.0);
        assert_eq!(scale.share(99.0), 1.0);
    }
}
