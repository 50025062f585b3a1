//! Numbers turned by hand.

use super::codec::Num;
use super::node::Within;

/// What is known of one number of a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Knob {
    /// What it belongs to: empty for the record itself, or `mode 1`, `release`, `part 3, mode 2`.
    pub part: String,
    /// What files call it.
    pub name: &'static str,
    /// Least and greatest, in the unit of its name.
    pub range: (f32, f32),
    /// What its value is multiplied with to be in the unit of its name.
    pub scale: f32,
    /// Whether equal ways of the hand should be equal ratios.
    pub by_ratio: bool,
    /// Whether it takes whole numbers only.
    pub whole: bool,
}

/// What is done with each number in turn.
pub(crate) type Visit<'a> = dyn FnMut(&Knob, &mut f32) + 'a;

/// Goes through the numbers of a record and shows each to a visitor, who may change it within its range.
pub(crate) struct Hand<'v> {
    visit: &'v mut Visit<'v>,
    part: String,
    /// What numbers that are bounded so keep to.
    pub(crate) within: Option<Within>,
}

impl<'v> Hand<'v> {
    pub(crate) fn new(visit: &'v mut Visit<'v>) -> Self {
        Self { visit, part: String::new(), within: None }
    }

    /// What `show` shows belongs to `part` of what is shown now.
    pub(crate) fn part(&mut self, part: &str, show: impl FnOnce(&mut Self)) {
        let before = self.part.len();
        if before > 0 {
            self.part.push_str(", ");
        }
        self.part.push_str(part);
        show(self);
        self.part.truncate(before);
    }

    /// Shows one number; what the visitor makes of it is kept within what a hand may reach, NaN refused.
    pub(crate) fn show(&mut self, number: &Num, whole: bool, name: &'static str, value: &mut f32) {
        let (scale, shown) = (number.scale as f32, *value * number.scale as f32);
        let (mut low, mut high) = (number.hand.0 as f32, number.hand.1 as f32);
        if let Some(within) = self.within.filter(|_| number.bounded) {
            (low, high) = (within.low as f32, within.high as f32);
        }
        // What is beyond a hand's reach already stays in sight.
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
