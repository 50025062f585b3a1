//! The times of a fit that is repeated less and less often.

use super::params::refits::LATER;

/// The time since the beginning, and that of the next fit (s).
#[derive(Clone, Copy, Debug)]
pub(super) struct Refits {
    age: f64,
    next_s: f64,
}

impl Refits {
    /// Begins now; the first fit is due after `first_s` seconds.
    pub(super) fn first_after(first_s: f64) -> Self {
        Self { age: 0.0, next_s: first_s }
    }

    /// Counts `dt` seconds and returns whether a fit is due; the next one is due at [`LATER`] times its age.
    pub(super) fn is_due_after(&mut self, dt: f64) -> bool {
        self.age += dt;
        let is_due = self.age >= self.next_s;
        if is_due {
            self.next_s = LATER * self.age;
        }
        is_due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_grow_by_half() {
        let mut refits = Refits::first_after(0.0625);
        // Steps and factor are exact in binary.
        let due: Vec<u32> = (1..=64).filter(|_| refits.is_due_after(0.015625)).collect();
        assert_eq!(due, [4, 6, 9, 14, 21, 32, 48]);
    }
}
