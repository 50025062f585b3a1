//! A recorder between a driver and its floor, which another thread starts and stops.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::{FeetRecorder, RecordedFeet};
use crate::foot::{Foot, FootDriver};
use underfoot::units::Instant;

/// Length of the empty floor before the first foot, in milliseconds: a floor needs it for its tare, and controls press
/// only under a foot that comes.
const LEAD_IN_MS: u64 = 1500;

/// Time in which a foot comes down that stood on the floor when the recording began, in milliseconds.
const LANDING_MS: u64 = 100;

/// Wraps `driver` unchanged, and returns the tape that can record its feet.
#[must_use]
pub fn taped(driver: Box<dyn FootDriver>) -> (FeetTape, Box<dyn FootDriver>) {
    let tape = FeetTape::default();
    (tape.clone(), Box::new(Taped { driver, tape }))
}

/// Records the feet of a simulated floor while it runs; clones share one recording.
#[derive(Clone, Debug, Default)]
pub struct FeetTape(Arc<Mutex<Option<Recording>>>);

#[derive(Debug, Default)]
struct Recording {
    recorder: FeetRecorder,
    /// The moment of the floor at which it began.
    since: Option<Instant>,
    /// Whether it has ended because the floor got another layout.
    is_cut: bool,
}

impl FeetTape {
    /// Begins a recording, and discards one in progress.
    pub fn begin(&self) {
        *self.locked() = Some(Recording::default());
    }

    /// Ends the recording in progress and returns it; `None` without one.
    #[must_use]
    pub fn end(&self) -> Option<RecordedFeet> {
        self.locked().take().map(|recording| recording.recorder.finish())
    }

    /// Length of the recording in progress in milliseconds, and its number of points.
    #[must_use]
    pub fn size(&self) -> Option<(u32, usize)> {
        let recording = self.locked();
        let recorder = &recording.as_ref()?.recorder;
        Some((recorder.length_ms(), recorder.points()))
    }

    /// Whether the recording in progress has as much as it can have, and records no more.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.locked().as_ref().is_some_and(|recording| recording.recorder.is_full())
    }

    /// Stops the recording in progress, if any: the feet after this moment belong to another layout.
    pub fn cut(&self) {
        if let Some(recording) = self.locked().as_mut() {
            recording.is_cut = true;
        }
    }

    /// Whether [`FeetTape::cut`] has stopped the recording in progress.
    #[must_use]
    pub fn is_cut(&self) -> bool {
        self.locked().as_ref().is_some_and(|recording| recording.is_cut)
    }

    /// Held for moments only: the floor's thread notes its feet with it.
    fn locked(&self) -> MutexGuard<'_, Option<Recording>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Recording {
    fn note(&mut self, at: Instant, feet: &[Foot]) {
        if self.is_cut {
            return;
        }
        if self.since.is_none() {
            self.lead_in(feet);
        }
        let since = *self.since.get_or_insert(at);
        let ms = u64::try_from(at.since(since).as_millis()).unwrap_or(u64::MAX);
        self.recorder.note(Instant::from_millis(LEAD_IN_MS.saturating_add(ms)), feet);
    }

    /// An empty floor, on which those come down who are there at the beginning.
    fn lead_in(&mut self, feet: &[Foot]) {
        for ms in 0..LEAD_IN_MS {
            let landing = (ms + LANDING_MS).saturating_sub(LEAD_IN_MS);
            let share = landing as f32 / LANDING_MS as f32;
            let come: Vec<Foot> =
                feet.iter().map(|foot| Foot { force: foot.force * share, ..*foot }).collect();
            self.recorder.note(Instant::from_millis(ms), if landing > 0 { &come } else { &[] });
        }
    }
}

struct Taped {
    driver: Box<dyn FootDriver>,
    tape: FeetTape,
}

impl FootDriver for Taped {
    fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
        let goes_on = self.driver.feet(at, feet);
        if let Some(recording) = self.tape.locked().as_mut() {
            recording.note(at, feet);
        }
        goes_on
    }
}

impl fmt::Debug for Taped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Taped").finish_non_exhaustive()
    }
}
