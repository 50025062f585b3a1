use super::moment::{Acts, Moment};
use super::press::Outcome;
use super::{Emitted, EventKind, Thresholds};

/// A push button: `Pressed`, then `Released` and `Clicked`, or `Cancelled`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ButtonSpec {
    /// When it engages.
    pub thresholds: Thresholds,
}

/// A push button at work.
///
/// ```text
/// press              -> Pressed
/// release on itself  -> Released, Clicked
/// slide off, loss    -> Cancelled
/// ```
#[derive(Clone, Debug)]
pub(super) struct Button;

impl Acts for Button {
    fn act(&mut self, moment: &Moment, emitted: &mut Emitted) {
        match moment.outcome {
            Some(Outcome::Pressed) => emitted.push(EventKind::Pressed),
            Some(Outcome::Released) => emitted.extend([EventKind::Released, EventKind::Clicked]),
            Some(Outcome::Cancelled) => emitted.push(EventKind::Cancelled),
            None => {}
        }
    }
}
