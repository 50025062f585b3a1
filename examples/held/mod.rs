//! What feet hold, as far as an app may believe it.
//!
//! The floor repeats every 20 ms what is held. An app that has not heard for 100 ms that a control
//! is held takes it for released, whatever it heard last: the floor, the network or the cable may
//! be gone, and none of them can say so.

use std::collections::HashMap;
use std::time::{Duration, Instant};

use rosc::{OscMessage, OscType};

/// How long a control that was said to be held is believed to be.
pub const BELIEVED_FOR: Duration = Duration::from_millis(100);

/// After so long without a number a floor that counts from the beginning again is believed.
const FORGOTTEN_AFTER: Duration = Duration::from_secs(1);

/// The controls that feet hold.
#[derive(Debug, Default)]
pub struct Held {
    /// When each was last said to be held.
    heard: HashMap<String, Instant>,
    /// The number of the newest report, and when it came.
    newest: Option<(i32, Instant)>,
}

impl Held {
    /// Takes in a message `…/widget/<id>/held <0 or 1> <sequence>` that came at `now`; true if it is one.
    ///
    /// One that an older report has sent, and a newer one has overtaken, changes nothing.
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

    /// The controls that are held at `now`; to be asked at least every 20 ms, for silence says nothing.
    pub fn at(&mut self, now: Instant) -> Vec<String> {
        self.heard.retain(|_, heard| now.duration_since(*heard) < BELIEVED_FOR);
        let mut held: Vec<String> = self.heard.keys().cloned().collect();
        held.sort();
        held
    }
}
