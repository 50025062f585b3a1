//! The request of a client to replace the layout: one a second, of which one is checked at a time.

use std::sync::mpsc::{Receiver, TryRecvError};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::Shared;
use super::checks::Checked;

/// The request: its argument is the layout as text, made of shipped kinds.
pub(super) const REQUEST: &str = "layout";

/// Maximum size of a request with a layout in bytes: far more than the largest shipped layout.
pub(super) const MOST_BYTES: usize = 1 << 20;

/// Minimum interval between two checks for one client.
const EVERY: Duration = Duration::from_secs(1);

const TOO_OFTEN: &str = "one layout a second is checked: send it again";

/// The layouts of one client.
#[derive(Default)]
pub(super) struct ClientLayouts {
    asked: Option<Instant>,
    checking: Option<Receiver<Checked>>,
}

impl ClientLayouts {
    /// The reason why no layout is accepted now, if any; call it before anything is read.
    pub(super) fn why_not(&self, now: Instant) -> Option<&'static str> {
        let is_soon = self.asked.is_some_and(|asked| now.duration_since(asked) < EVERY);
        (self.checking.is_some() || is_soon).then_some(TOO_OFTEN)
    }

    /// Queues the layout in `arguments` for a check and for the floor; the result comes later, from
    /// [`ClientLayouts::checked`].
    pub(super) fn put(&mut self, arguments: Vec<Value>, shared: &Shared, now: Instant) -> Checked {
        let Some(checks) = &shared.checks else {
            return Err(
                "the server keeps its layout: it takes others if it is started with --web-layouts".into()
            );
        };
        if let Some(why) = self.why_not(now) {
            return Err(why.into());
        }
        let Ok([Value::String(text)]) = <[Value; 1]>::try_from(arguments) else {
            return Err("expected a layout as text".into());
        };
        self.asked = Some(now);
        self.checking = Some(checks.ask(text)?);
        Ok(())
    }

    /// The result of the current check, as soon as it is available.
    pub(super) fn checked(&mut self) -> Option<Checked> {
        let checked = match self.checking.as_ref()?.try_recv() {
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => Err("the layout could not be checked".into()),
            Ok(checked) => checked,
        };
        self.checking = None;
        Some(checked)
    }
}
