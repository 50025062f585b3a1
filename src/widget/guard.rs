//! What a control asks for before it acts, besides force.

use std::time::Duration;

use crate::format::{Opt, choices, num, record};

choices! {
    /// What it takes besides force for a control to act.
    pub enum Guard: Copy, Eq = Free;
    /// Nothing: for what does no harm.
    Free,
    /// A first press, which only arms it, then a second one.
    Confirm(Confirm),
    /// It acts only while a foot holds it, and never longer than a while: off as soon as the contact is uncertain.
    HoldToRun(HoldToRun),
}

record! {
    /// A first press, which only arms it, then a second one.
    pub struct Confirm = "Confirm", Copy, Eq;
    /// How long after the first press was released the second must be down.
    pub within: Duration = "within_s", num(0.5..=30.0) => Duration::from_secs(3);
}

record! {
    /// It acts only while a foot holds it, and never longer than a while: off as soon as the contact is uncertain.
    pub struct HoldToRun = "HoldToRun", Copy, Eq => |it, faults| {
        if it.warn.is_some_and(|warn| warn > it.max) {
            let message = "`warn_s` is longer than `max_s`";
            faults.error(&["warn_s", "max_s"], message, "it counts back from the end");
        }
    };
    /// How long it acts at most; then it must be lifted.
    pub max: Duration = "max_s", num(1.0..=3600.0);
    /// How long before that it warns; half a minute or a quarter of `max` where it doesn't say, whichever is shorter.
    pub warn: Option<Duration> = "warn_s", Opt(num(0.0..=3600.0)) => None;
}

impl HoldToRun {
    /// How long before its end it warns.
    #[must_use]
    pub fn warns(&self) -> Duration {
        self.warn.unwrap_or(Duration::from_secs(30).min(self.max / 4))
    }
}
