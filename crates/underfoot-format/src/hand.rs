//! Tuning of the numbers in a record.

use super::codec::Num;
use super::node::Within;

/// Description of one number of a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Knob {
    /// The part that the number belongs to: empty for the record itself, or `mode 1`, `release`, `part 3, mode 2`.
    pub part: String,
    /// Its name in files.
    pub name: &'static str,
    /// Minimum and maximum, in the unit of its name.
    pub range: (f32, f32),
    /// Factor from the value to the unit of its name.
    pub scale: f32,
    /// Whether equal distances on the slider should be equal ratios.
    pub by_ratio: bool,
    /// Whether it takes whole numbers only.
    pub whole: bool,
}

/// The callback for each number.
pub type VisitKnob<'a> = dyn FnMut(&Knob, &mut f32) + 'a;

/// Passes each number of a record to a callback, which may change it within its range.
pub struct Hand<'v> {
    visit: &'v mut VisitKnob<'v>,
    part: String,
    /// Limits of the numbers that are marked as bounded.
    pub within: Option<Within>,
}

impl<'v> Hand<'v> {
    /// Passes the numbers to `visit`.
    pub fn new(visit: &'v mut VisitKnob<'v>) -> Self {
        Self { visit, part: String::new(), within: None }
    }

    /// Prepends `part` to the name of the part while `show` runs.
    pub fn part(&mut self, part: &str, show: impl FnOnce(&mut Self)) {
        let before = self.part.len();
        if before > 0 {
            self.part.push_str(", ");
        }
        self.part.push_str(part);
        show(self);
        self.part.truncate(before);
    }

    /// Passes one number to the callback and clamps the result to the range; NaN keeps the old value.
    pub fn show(&mut self, number: &Num, whole: bool, name: &'static str, value: &mut f32) {
        let (scale, shown) = (number.scale as f32, *value * number.scale as f32);
        let (mut low, mut high) = (number.hand.0 as f32, number.hand.1 as f32);
        if let Some(within) = self.within.filter(|_| number.bounded) {
            (low, high) = (within.low as f32, within.high as f32);
        }
        // A value above the range extends the range, so that it stays visible.
        high = high.max(shown);
        let knob =
            Knob { part: self.part.clone(), name, range: (low, high), scale, by_ratio: low > 0.0, whole };
        let before = *value;
        (self.visit)(&knob, value);
        if *value != before {
            let (low, high) = (low / scale, high / scale);
            *value = if value.is_nan() { before } else { value.clamp(low, high) };
        }
    }
}
