//! A control's value as text.

use std::fmt::Write;

use arrayvec::ArrayString;
use glam::Vec2;

use super::super::widths::width;
use underfoot::widget::Scale;

/// A control's value as text, with the decimals that its steps need.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reading {
    pub(super) text: ArrayString<64>,
    /// Maximum width over the whole range, in em, so that a label beside the value does not move.
    pub(super) widest: f32,
}

impl Reading {
    /// Formats `value`, a number of `scale`.
    pub(super) fn of(scale: &Scale, value: f32) -> Self {
        let widest = width(&number(scale, scale.min)).max(width(&number(scale, scale.max)));
        Self { text: number(scale, value), widest }
    }

    /// Formats two numbers.
    pub(super) fn pair(x: &Scale, y: &Scale, value: Vec2) -> Self {
        let (east, north) = (Self::of(x, value.x), Self::of(y, value.y));
        let mut text = ArrayString::new();
        // The buffer cuts off text beyond 64 letters, which only values far outside the range need.
        let _ = write!(text, "{}  {}", east.text, north.text);
        Self { text, widest: east.widest + north.widest + width("  ") }
    }
}

fn number(scale: &Scale, value: f32) -> ArrayString<64> {
    let decimals = decimals(scale);
    // No minus sign before a value that rounds to zero.
    let half = 0.5 * 10_f32.powi(-(decimals as i32));
    let value = if value.abs() < half { 0.0 } else { value };
    let mut text = ArrayString::new();
    let _ = write!(text, "{value:.decimals$}");
    text
}

fn decimals(scale: &Scale) -> usize {
    let Scale { min, max, step, .. } = *scale;
    let enough = |decimals: &i32| {
        let ten = 10_f32.powi(*decimals);
        if step > 0.0 {
            let scaled = step * ten;
            scaled > 0.5 && (scaled - scaled.round()).abs() < 1e-3 * scaled
        } else {
            // Without steps, a hundredth of the range is the finest resolution of a foot.
            0.01 * (max - min) * ten >= 0.999
        }
    };
    (0..4).find(enough).unwrap_or(4) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_show_the_decimals_their_steps_need() {
        let reading = |min, max, step, value| {
            Reading::of(&Scale { step, ..Scale::new(min, max) }, value).text.to_string()
        };
        assert_eq!(reading(0.0, 1.0, 0.0, 0.333), "0.33");
        assert_eq!(reading(0.0, 10.0, 0.5, 2.5), "2.5");
        assert_eq!(reading(0.0, 1.0, 0.25, 0.75), "0.75");
        assert_eq!(reading(0.0, 200.0, 0.0, 66.6), "67");
        assert_eq!(reading(1.0, 18.0, 1.0, 12.0), "12");
        assert_eq!(reading(-1.0, 1.0, 0.0, -0.001), "0.00");
    }
}
