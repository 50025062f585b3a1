//! Whether a control is held, confirmed often enough for an app to act on it.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant as HostInstant};

use triple_buffer::Output;

use super::app_sink::HeldNow;
use crate::widget::WidgetId;

/// Maximum age of a report of the sensing thread, which reports every 20 ms.
const BELIEVED_FOR: Duration = Duration::from_millis(100);

/// The last report of the sensing thread, shared by all readers.
#[derive(Debug)]
pub(super) struct HeldWatch {
    now: Mutex<Output<HeldNow>>,
    over: AtomicBool,
}

impl HeldWatch {
    pub(super) fn new(now: Output<HeldNow>) -> Self {
        Self { now: Mutex::new(now), over: AtomicBool::new(false) }
    }

    /// Ends the reports: from now on nothing is held.
    pub(super) fn end(&self) {
        self.over.store(true, Ordering::Release);
    }

    pub(super) fn has_ended(&self) -> bool {
        self.over.load(Ordering::Acquire)
    }

    fn is_fresh(&self, id: &WidgetId, now: HostInstant) -> bool {
        let mut said = self.now.lock().unwrap_or_else(PoisonError::into_inner);
        let HeldNow { said, held } = said.read();
        let is_recent = said.is_some_and(|said| now.saturating_duration_since(said) < BELIEVED_FOR);
        is_recent && held.contains(id) && !self.has_ended()
    }
}

/// Whether one control is held; still answers after its session has ended.
#[derive(Clone, Debug)]
pub struct Held {
    watch: Arc<HeldWatch>,
    id: WidgetId,
}

impl Held {
    pub(super) fn new(watch: Arc<HeldWatch>, id: WidgetId) -> Self {
        Self { watch, id }
    }

    /// Whether a foot holds the control now, confirmed by the floor within the last 100 ms.
    ///
    /// False if the layout on the floor lacks the control, and as soon as the foot lifts, the press is cancelled, the
    /// floor's packets stop for 100 ms, the sensing thread stands still for 100 ms or ends for any reason, the wake
    /// callback panics, or the last [`super::Session`] is dropped. Call it at least every 20 ms while something acts:
    /// a missing event does not confirm anything.
    #[must_use]
    pub fn is_fresh(&self) -> bool {
        self.watch.is_fresh(&self.id, HostInstant::now())
    }
}

#[cfg(test)]
mod tests {
    use triple_buffer::triple_buffer;

    use super::*;

    #[test]
    fn what_was_said_is_believed_for_100_ms_and_not_after_the_end() {
        let (mut input, output) = triple_buffer(&HeldNow::default());
        let watch = HeldWatch::new(output);
        let (drive, zoom) = (WidgetId::new("drive"), WidgetId::new("zoom"));
        let begun = HostInstant::now();
        let at = |ms| begun + Duration::from_millis(ms);
        assert!(!watch.is_fresh(&drive, begun), "nothing was said");
        input.write(HeldNow { said: Some(begun), held: vec![drive.clone()] });
        let fresh = [0, 99, 100].map(|ms| watch.is_fresh(&drive, at(ms)));
        assert_eq!((fresh, watch.is_fresh(&zoom, at(0))), ([true, true, false], false));
        watch.end();
        assert!(!watch.is_fresh(&drive, at(1)));
    }
}
