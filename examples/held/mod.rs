//! The controls held by feet, with the time-out that an app must apply.
//!
//! The floor repeats the held controls every 20 ms. An app that has received no report of a hold for 100 ms treats
//! the control as released, for any last report: the floor, the network or the cable may have failed, and none of
//! them can report that.

use std::collections::HashMap;
use std::time::{Duration, Instant};

use rosc::{OscMessage, OscType};

/// Time after its last report at which a hold expires.
pub const BELIEVED_FOR: Duration = Duration::from_millis(100);

/// Time without a report after which a floor that restarts its sequence numbers is accepted.
const FORGOTTEN_AFTER: Duration = Duration::from_secs(1);

/// The controls held by feet.
#[derive(Debug, Default)]
pub struct Held {
    /// Time of the last report that each is held.
    heard: HashMap<String, Instant>,
    /// The sequence number of the newest report, and the time of its arrival.
    newest: Option<(i32, Instant)>,
}

impl Held {
    /// Processes a message `…/widget/<id>/held <0 or 1> <sequence>` that arrived at `now`. Returns whether it is one.
    ///
    /// A message of an older report that a newer one has overtaken changes nothing.
    pub fn take(&mut self, message: &OscMessage, now: Instant) -> bool {
        let widget = message.addr.split_once("/widget/").map(|(_, widget)| widget);
        let Some(id) = widget.and_then(|widget| widget.strip_suffix("/held")) else { return false };
        let &[OscType::Int(on), OscType::Int(sequence)] = message.args.as_slice() else { return false };
        let is_older = |(newest, at): (i32, Instant)| {
            sequence.wrapping_sub(newest) < 0 && now.duration_since(at) < FORGOTTEN_AFTER
        };
        if self.newest.is_some_and(is_older) {
            return true;
        }
        self.newest = Some((sequence, now));
        if on == 1 {
            self.heard.insert(id.into(), now);
        } else {
            self.heard.remove(id);
        }
        true
    }

    /// The controls that are held at `now`; call it at least every 20 ms, since holds expire in silence.
    pub fn at(&mut self, now: Instant) -> Vec<String> {
        self.heard.retain(|_, heard| now.duration_since(*heard) < BELIEVED_FOR);
        let mut held: Vec<String> = self.heard.keys().cloned().collect();
        held.sort();
        held
    }
}
