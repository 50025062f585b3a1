//! Confidence interval of a counted share.

use std::fmt;

use serde::Serialize;

/// A count of hits out of a total.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counted {
    /// Number of hits.
    pub hits: u64,
    /// Total.
    pub of: u64,
}

impl Counted {
    /// Returns the share (0 to 1); 0 for an empty total.
    #[must_use]
    pub fn share(self) -> f64 {
        self.hits as f64 / self.of.max(1) as f64
    }

    /// Returns the 95 % confidence interval of the true share; 0 to 1 for an empty total.
    ///
    /// More hits than the total count as the total.
    ///
    /// # Source
    /// E. B. Wilson, Probable inference, the law of succession, and statistical inference, JASA 22 (1927).
    #[must_use]
    pub fn wilson_95(self) -> (f64, f64) {
        if self.of == 0 {
            return (0.0, 1.0);
        }
        let z = 1.959_964;
        let (n, p) = (self.of as f64, self.share().min(1.0));
        let scale = 1.0 / (1.0 + z * z / n);
        let middle = scale * (p + z * z / (2.0 * n));
        let half = scale * z * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
        ((middle - half).max(0.0), (middle + half).min(1.0))
    }
}

impl std::ops::AddAssign for Counted {
    fn add_assign(&mut self, other: Self) {
        self.hits += other.hits;
        self.of += other.of;
    }
}

/// Writes the share per thousand with its interval, in twenty characters; a dash for an empty total.
impl fmt::Display for Counted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.of == 0 {
            return write!(f, "{:>20}", "-");
        }
        let (low, high) = self.wilson_95();
        let interval = format!("({:.2}-{:.2})", 1e3 * low, 1e3 * high);
        write!(f, "{:6.2} {interval:>13}", 1e3 * self.share())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_those_of_the_textbook() {
        let (low, high) = Counted { hits: 10, of: 100 }.wilson_95();
        assert!((low - 0.0552).abs() < 1e-4 && (high - 0.1744).abs() < 1e-4, "{low} to {high}");
        // No hits in 20,000 still allow a rate of up to 0.19 per thousand.
        let (low, high) = Counted { hits: 0, of: 20_000 }.wilson_95();
        assert!(low == 0.0 && (high - 0.000_192).abs() < 1e-6, "{high}");
        assert_eq!(Counted::default().wilson_95(), (0.0, 1.0));
        assert_eq!(Counted { hits: 3, of: 2000 }.to_string(), "  1.50   (0.51-4.40)");
    }
}
