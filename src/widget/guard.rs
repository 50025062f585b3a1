//! Conditions besides force for a control to act.

use std::time::Duration;

use underfoot_format::{Opt, choices, num, record};

choices! {
    /// The condition besides force for a control to act.
    pub enum Guard: Copy, Eq = Free;
    /// None: for actions that do no harm.
    Free,
    /// A first press, which only arms it, then a second one.
    Confirm(Confirm),
    /// It acts only while a foot holds it, for a limited time: off as soon as the contact is uncertain.
    HoldToRun(HoldToRun),
}

record! {
    /// A first press, which only arms it, then a second one.
    pub struct Confirm = "Confirm", Copy, Eq;
    /// Maximum time from the release of the first press to the second press.
    pub within: Duration = "within_s", num(0.5..=30.0) => Duration::from_secs(3);
}

record! {
    /// It acts only while a foot holds it, for a limited time: off as soon as the contact is uncertain.
    pub struct HoldToRun = "HoldToRun", Copy, Eq => |it, faults| {
        if it.warn.is_some_and(|warn| warn > it.max) {
            let message = "`warn_s` is longer than `max_s`";
            faults.error(&["warn_s", "max_s"], message, "it counts back from the end");
        }
    };
    /// Maximum time of action; then it must be lifted.
    pub max: Duration = "max_s", num(1.0..=3600.0);
    /// Time of the warning before that; by default half a minute or a quarter of `max`, whichever is shorter.
    pub warn: Option<Duration> = "warn_s", Opt(num(0.0..=3600.0)) => None;
}

impl HoldToRun {
    /// Time of the warning before its end.
    #[must_use]
    pub fn warns(&self) -> Duration {
        self.warn.unwrap_or(Duration::from_secs(30).min(self.max / 4))
    }
}
