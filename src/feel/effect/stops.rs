//! Effects that a value drives: detents and end stops.

use arrayvec::ArrayVec;

use super::Hum;
use super::click::SHARE;
use crate::feel::Click;
use underfoot_format::{Flat, Opt, Pair, Rec, list, num, record};

/// Maximum number of marks of a row of detents.
pub const MAX_MARKS: usize = 8;

/// Factors of the frequencies at the low and the high end of a range.
const PITCH: Pair = Pair {
    each: num(0.1..=10.0).hand(0.5..=2.0),
    pattern: "(low end, high end)",
    parts: ["pitch, low end", "pitch, high end"],
};

record! {
    /// A click at each step of a number, different by value and by direction.
    pub struct Detents = "Detents";
    /// The click of each step, at the middle of the range and upwards.
    pub click: Click = "", Flat;
    /// Distance between two detents, as a share of the range; 0 for the control's own steps and detents.
    pub every: f32 = "every", num(0.0..=1.0).hand(0.0..=0.5) => 0.0;
    /// Factor of the level of detents passed downwards.
    pub falling: f32 = "falling", num(0.0..=4.0).hand(0.0..=2.0) => 1.0;
    /// Factors of the frequencies at the low and at the high end.
    pub pitch: [f32; 2] = "pitch", PITCH => [1.0; 2];
    /// Positions of stronger detents, as shares of the range.
    pub marks: ArrayVec<f32, MAX_MARKS> = "marks", list("mark", MAX_MARKS, SHARE) => ArrayVec::new();
    /// Factor of the level at the marks.
    pub mark: f32 = "mark", num(0.0..=4.0) => 1.6;
}

impl Detents {
    /// The click of the detent at `share` of the range (0 to 1), passed upwards or downwards.
    #[must_use]
    pub(crate) fn click_at(&self, share: f32, rising: bool) -> Click {
        let side = if rising { 1.0 } else { self.falling };
        // Tolerance between a mark and the control's own step.
        let near = if self.every > 0.0 { 0.25 * self.every } else { 1e-3 };
        let marked = self.marks.iter().any(|mark| (mark - share).abs() <= near);
        let mark = if marked { self.mark } else { 1.0 };
        let [low, high] = self.pitch;
        self.click.scaled(side * mark, low + (high - low) * share)
    }

    /// The detent (as a share of the range) that a number passes on its way from `from` to `to`: the last one of
    /// several; `None` if it passes none or if the control's own steps count.
    #[must_use]
    pub fn passed(&self, from: f32, to: f32) -> Option<f32> {
        let way = to - from;
        if self.every <= 0.0 || way == 0.0 || way.is_nan() {
            return None;
        }
        let (a, b) = (from / self.every, to / self.every);
        let detent = if to > from { (b + 1e-4).floor() } else { (b - 1e-4).ceil() };
        let is_between = if to > from { detent > a + 1e-4 } else { detent < a - 1e-4 };
        is_between.then_some((detent * self.every).clamp(0.0, 1.0))
    }
}

record! {
    /// The effect of the ends of a number.
    pub struct EndStop = "EndStop";
    /// Felt when an end is reached; stronger at higher speed.
    pub click: Click = "", Flat;
    /// Factors of the frequencies at the low and at the high end.
    pub pitch: [f32; 2] = "pitch", PITCH => [1.0; 2];
    /// Felt while a foot pushes on against the end.
    pub push: Option<Push> = "push", Opt(Rec) => None;
}

record! {
    /// The effect of pushing against an end.
    pub struct Push = "Push", Copy;
    /// The tone or noise at its full level.
    pub hum: Hum = "", Flat;
    /// Distance beyond the end at which it has its full level, in metres.
    pub full_m: f32 = "full_m", num(0.001..=0.5).hand(0.001..=0.2) => 0.03;
}

/// Speed at which an end is hit at its full level, in metres per second (our choice: a brisk slide).
const FULL_HIT_M_S: f32 = 0.4;

/// Share of the level for an end that is reached very slowly (our choice).
const SOFTEST: f32 = 0.4;

impl EndStop {
    /// The click of an end that is hit at this speed, in metres per second: level factor `SOFTEST + (1 - SOFTEST) *
    /// min(speed / FULL_HIT_M_S, 1)`. Without a speed (NaN), soft.
    #[must_use]
    pub(crate) fn click_at(&self, high: bool, speed_m_s: f32) -> Click {
        let hit = (speed_m_s / FULL_HIT_M_S).clamp(0.0, 1.0);
        let hit = if hit.is_nan() { 0.0 } else { hit };
        self.click.scaled(SOFTEST + (1.0 - SOFTEST) * hit, self.pitch[usize::from(high)])
    }
}

impl Push {
    /// The hum with the foot this far beyond the end.
    #[must_use]
    pub(crate) fn hum_at(&self, beyond_m: f32) -> Hum {
        let share = (beyond_m / self.full_m).clamp(0.0, 1.0);
        let share = if share.is_nan() { 0.0 } else { share };
        Hum { level: self.hum.level * share, ..self.hum }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::feel::{Impulse, Mode};
    use crate::units::Newtons;

    fn detents(every: f32) -> Detents {
        let modes = [Mode { frequency_hz: 200.0, decay_s: 0.01, amplitude: 1.0 }].into_iter().collect();
        Detents {
            click: Click { modes, level: Newtons(10.0), impulse: Impulse::default() },
            every,
            falling: 0.5,
            pitch: [0.8, 1.2],
            marks: [0.5].into_iter().collect(),
            mark: 1.5,
        }
    }

    #[test]
    fn value_and_side_say_what_a_detent_feels_like() {
        let detents = detents(0.1);
        let low = detents.click_at(0.0, true);
        let high = detents.click_at(1.0, false);
        assert_eq!((low.level, low.modes[0].frequency_hz), (Newtons(10.0), 160.0));
        assert_eq!((high.level, high.modes[0].frequency_hz.round()), (Newtons(5.0), 240.0));
        assert_eq!(detents.click_at(0.5, true).level, Newtons(15.0));
    }

    #[test]
    fn a_detent_is_passed_once_whatever_the_way_is_cut_into() {
        let detents = detents(0.25);
        for pieces in [1_u16, 7, 100, 999] {
            for rising in [true, false] {
                let mut passed = Vec::new();
                let mut from = if rising { 0.05 } else { 0.95 };
                for piece in 1..=pieces {
                    let way = 0.9 * f32::from(piece) / f32::from(pieces);
                    let to = if rising { 0.05 + way } else { 0.95 - way };
                    passed.extend(detents.passed(from, to));
                    from = to;
                }
                let mut wanted = vec![0.25, 0.5, 0.75];
                if !rising {
                    wanted.reverse();
                }
                // One long way passes several at once: only the last one is felt.
                let wanted = if pieces == 1 { vec![wanted[2]] } else { wanted };
                assert_eq!(passed, wanted, "{pieces} pieces");
            }
        }
        assert_eq!(detents.passed(0.3, f32::NAN), None);
        assert_eq!(self::detents(0.0).passed(0.0, 1.0), None);
    }
}
