//! Mean and standard deviation of readings that come one by one.

/// Running mean and scatter of readings, in any unit.
///
/// # Source
/// Welford's recurrence: `m += (x - m) / n`, `s += (x - m_before)(x - m_after)`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Scatter {
    count: u32,
    mean: f64,
    squares: f64,
}

impl Scatter {
    /// Adds a reading. One that is NaN or infinite makes mean and deviation NaN, so the caller leaves it out.
    pub fn add(&mut self, value: f64) {
        self.count = self.count.saturating_add(1);
        let before = value - self.mean;
        self.mean += before / f64::from(self.count);
        self.squares += before * (value - self.mean);
    }

    /// Number of readings.
    #[must_use]
    pub const fn count(&self) -> u32 {
        self.count
    }

    /// Mean of the readings; 0 before the first.
    #[must_use]
    pub const fn mean(&self) -> f64 {
        self.mean
    }

    /// Standard deviation of the readings, as a sample of them; 0 before the second.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        if self.count < 2 { 0.0 } else { (self.squares / f64::from(self.count - 1)).sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scatter_of_a_steady_load_is_small_beside_it() {
        let mut load = Scatter::default();
        assert_eq!((load.mean(), load.deviation()), (0.0, 0.0));
        // A thousandth around the weight of a person: a plain sum of squares loses it in single precision.
        for at in 0..1000 {
            load.add(700.0 + if at % 2 == 0 { 0.7 } else { -0.7 });
        }
        assert!((load.mean() - 700.0).abs() < 1e-9);
        // 0.7 times the root of 1000 / 999.
        assert!((load.deviation() - 0.700_350_3).abs() < 1e-6, "{}", load.deviation());
    }
}
