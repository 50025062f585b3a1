//! Statistics of position errors.

use std::fmt;

use serde::Serialize;

/// Distances between estimated and true positions, in metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PositionErrors(Vec<f32>);

/// Errors summarised in three numbers, in centimetres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Number of errors.
    pub count: usize,
    /// Median.
    pub median_cm: f32,
    /// 95th percentile.
    pub p95_cm: f32,
    /// Maximum.
    pub worst_cm: f32,
}

impl PositionErrors {
    /// Adds one error, in metres.
    pub fn push(&mut self, error_m: f32) {
        self.0.push(error_m);
    }

    /// Adds all errors of another collection.
    pub fn append(&mut self, mut others: Self) {
        self.0.append(&mut others.0);
    }

    /// Returns the number of errors.
    #[must_use]
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// Returns the error that a share (0 to 1) of all errors do not exceed, in metres; `None` without errors.
    #[must_use]
    pub fn quantile(&self, share: f32) -> Option<f32> {
        let last = self.0.len().checked_sub(1)?;
        let place = (last as f32 * share.clamp(0.0, 1.0)).round() as usize;
        let mut errors = self.0.clone();
        let (_, error, _) = errors.select_nth_unstable_by(place.min(last), f32::total_cmp);
        Some(*error)
    }

    /// Returns the share (0 to 1) of errors of at most `error_m` metres; 0 without errors.
    #[must_use]
    pub fn share_within(&self, error_m: f32) -> f32 {
        let within = self.0.iter().filter(|&&error| error <= error_m).count();
        within as f32 / self.0.len().max(1) as f32
    }

    /// Returns median, 95th percentile and maximum; `None` without errors.
    #[must_use]
    pub fn summary(&self) -> Option<Summary> {
        let cm = |share| self.quantile(share).map(|error| error * 100.0);
        Some(Summary { count: self.count(), median_cm: cm(0.5)?, p95_cm: cm(0.95)?, worst_cm: cm(1.0)? })
    }
}

/// Writes median, 95th percentile and maximum in centimetres with two decimals, in three columns of eight characters.
impl fmt::Display for PositionErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.summary() {
            Some(Summary { median_cm, p95_cm, worst_cm, .. }) => {
                write!(f, "{median_cm:8.2}{p95_cm:8.2}{worst_cm:8.2}")
            }
            None => write!(f, "{:>8}{:>8}{:>8}", "-", "-", "-"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_errors_that_occurred() {
        let mut errors = PositionErrors::default();
        assert_eq!((errors.summary(), errors.to_string().trim()), (None, "-       -       -"));
        // A hundred and one errors from 0 to 1 m, out of order.
        (0..=100).for_each(|step| errors.push((step * 37 % 101) as f32 / 100.0));
        let found = errors.summary().unwrap();
        assert_eq!((found.count, found.median_cm, found.p95_cm, found.worst_cm), (101, 50.0, 95.0, 100.0));
        assert_eq!(errors.share_within(0.5), 51.0 / 101.0);
        assert_eq!(errors.to_string(), "   50.00   95.00  100.00");
    }
}
