//! Timing and vertical force of a walking foot.

/// A gait: the timing of steps and the vertical force of a stance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gait {
    /// Walking speed, in metres per second.
    pub speed_m_s: f32,
    /// Distance from one footfall to the next one of the other foot, in metres.
    pub step_m: f32,
    /// Time from one footfall to the next one of the other foot, in seconds.
    pub step_s: f32,
    /// Duration of a stance, in seconds.
    pub stance_s: f32,
    /// Height of the two peaks, in body weights.
    pub peak: f32,
    /// Depth of the valley between them, in body weights.
    pub valley: f32,
    /// Time of the first peak, as a share of the stance; the second peak is as far from the end.
    pub peak_at: f32,
    /// Slope of the force at touchdown, in body weights per stance; the negative of the slope at lift-off.
    pub strike: f32,
}

/// Preferred speed, in metres per second.
pub const PREFERRED_M_S: f32 = 1.32;

impl Gait {
    /// The gait of an adult at this speed; the speed is limited to 0.4 to 2 metres per second.
    ///
    /// # Source
    /// Steps of 0.7 m, stances of 0.65 s, peaks of 1.1 and a valley of 0.75 body weights at the preferred speed;
    /// flatter and longer when slower. Steps grow with the square root of the speed; two feet are down for 23 % of
    /// the cycle, more when slower.
    #[must_use]
    pub fn at_speed(speed_m_s: f32) -> Self {
        let pace = pace(speed_m_s);
        Self::with_step(0.7 * pace.sqrt(), speed_m_s)
    }

    /// As [`Gait::at_speed`], with steps of `step_m` metres (0.05 to 1.2).
    #[must_use]
    pub fn with_step(step_m: f32, speed_m_s: f32) -> Self {
        let pace = pace(speed_m_s);
        let (speed_m_s, step_m) = (pace * PREFERRED_M_S, step_m.clamp(0.05, 1.2));
        let step_s = (step_m / speed_m_s).clamp(SHORTEST_STEP_S, 1.2);
        let stance_s = step_s * (1.0 + 0.23 * pace.powf(-0.4));
        let double_support = 1.0 - step_s / stance_s;
        let vigour = pace.powf(1.5);
        let mut gait = Self {
            speed_m_s,
            step_m,
            step_s,
            stance_s,
            peak: 1.0 + 0.1 * vigour,
            valley: 1.0 - 0.25 * vigour.min(2.0),
            // The peak follows just after the other foot has left the floor.
            peak_at: (1.15 * double_support).clamp(0.15, 0.32),
            strike: 0.0,
        };
        gait.strike = gait.balancing_strike();
        gait
    }

    /// Returns the force at a share of the stance, in body weights; zero before its start (0) and after its end (1).
    #[must_use]
    pub fn load(&self, stance: f32) -> f32 {
        if !(0.0..=1.0).contains(&stance) {
            return 0.0;
        }
        // The two halves are symmetric.
        let phase = stance.min(1.0 - stance);
        if phase < self.peak_at {
            let (share, left) = (phase / self.peak_at, 1.0 - phase / self.peak_at);
            self.peak * share * share * (3.0 - 2.0 * share) + self.strike * self.peak_at * share * left * left
        } else {
            let share = (phase - self.peak_at) / (0.5 - self.peak_at);
            self.peak + (self.valley - self.peak) * share * share * (3.0 - 2.0 * share)
        }
    }

    /// Returns the duration of double support at a change of feet, in seconds.
    #[must_use]
    pub fn double_support_s(&self) -> f32 {
        self.stance_s - self.step_s
    }

    /// Returns the time that a foot is in the air, in seconds.
    #[must_use]
    pub fn swing_s(&self) -> f32 {
        2.0 * self.step_s - self.stance_s
    }

    /// The strike for which the floor carries exactly the body's weight on average over a step.
    fn balancing_strike(&self) -> f32 {
        let needed = self.step_s / self.stance_s;
        let rising = self.peak_at * self.peak;
        let middle = (0.5 - self.peak_at) * (self.peak + self.valley);
        let missing = needed - rising - middle;
        // Each flank gains `strike * peak_at^2 / 12`. A flank without a hump has at most three times its mean slope.
        (missing * 6.0 / (self.peak_at * self.peak_at)).clamp(0.0, 3.0 * self.peak / self.peak_at)
    }
}

/// Minimum duration of a step (s).
const SHORTEST_STEP_S: f32 = 0.4;

/// Speed divided by the preferred speed.
fn pace(speed_m_s: f32) -> f32 {
    let speed = if speed_m_s.is_nan() { PREFERRED_M_S } else { speed_m_s.clamp(0.4, 2.0) };
    speed / PREFERRED_M_S
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stance(gait: &Gait) -> Vec<f32> {
        (0..=1000).map(|k| gait.load(k as f32 / 1000.0)).collect()
    }

    #[test]
    fn preferred_walking_has_the_textbook_s_figures() {
        let gait = Gait::at_speed(PREFERRED_M_S);
        assert!((gait.step_m - 0.7).abs() < 1e-3 && (gait.stance_s - 0.65).abs() < 0.01, "{gait:?}");
        let cycle = 2.0 * gait.step_s;
        let both = 2.0 * gait.double_support_s() / cycle;
        assert!((0.20..=0.24).contains(&both), "{both}");
        let loads = stance(&gait);
        let (first, second) = (
            loads[..500].iter().copied().fold(0.0, f32::max),
            loads[500..].iter().copied().fold(0.0, f32::max),
        );
        assert!((first - 1.1).abs() < 0.02 && (second - 1.1).abs() < 0.02, "{first}, {second}");
        let valley = loads[300..700].iter().copied().fold(f32::MAX, f32::min);
        assert!((0.7..=0.8).contains(&valley), "{valley}");
        let turns = loads.windows(3).filter(|w| w[1] > w[0] && w[1] >= w[2]).count();
        assert_eq!(turns, 2, "two humps and no more");
        assert_eq!((loads[0], loads[1000], gait.load(1.2)), (0.0, 0.0, 0.0));
    }

    #[test]
    fn slow_walking_is_flat_and_brisk_walking_is_vigorous() {
        let (slow, brisk) = (Gait::at_speed(0.7), Gait::at_speed(1.8));
        assert!(slow.peak < 1.05 && slow.valley > 0.88, "{slow:?}");
        assert!(brisk.peak > 1.13 && brisk.valley < 0.68, "{brisk:?}");
        assert!(slow.stance_s > brisk.stance_s && slow.step_m < brisk.step_m);
    }

    #[test]
    fn two_feet_together_carry_the_body_at_any_speed() {
        // In double support the total force exceeds the body weight, more at higher speeds.
        for (speed, most) in [(0.6, 1.15), (0.9, 1.2), (1.32, 1.3), (1.7, 1.5)] {
            let gait = Gait::at_speed(speed);
            // One step of the cycle: this foot from its touchdown, and the other foot, a step ahead.
            let together: Vec<f32> = (0..1000)
                .map(|k| gait.step_s * k as f32 / 1000.0)
                .map(|t| gait.load(t / gait.stance_s) + gait.load((t + gait.step_s) / gait.stance_s))
                .collect();
            let mean = together.iter().sum::<f32>() / 1000.0;
            assert!((mean - 1.0).abs() < 0.03, "at {speed} m/s the floor carries {mean} of the weight");
            let (low, high) = together.iter().fold((9.0f32, 0.0f32), |(l, h), &f| (l.min(f), h.max(f)));
            assert!(low > 0.6 && high < most, "at {speed} m/s: {low} to {high}");
        }
    }

    #[test]
    fn nonsense_becomes_somebody_s_gait() {
        for speed in [f32::NAN, 0.0, -3.0, 99.0] {
            let gait = Gait::at_speed(speed);
            assert!(gait.stance_s > 0.3 && gait.stance_s < 2.5 && gait.swing_s() > 0.1, "{gait:?}");
        }
        let shuffle = Gait::with_step(0.0, 1.3);
        assert!(shuffle.step_s >= SHORTEST_STEP_S && shuffle.swing_s() > 0.1);
    }
}
