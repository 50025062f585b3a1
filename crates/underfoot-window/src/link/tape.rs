//! Feet recorded for a link while a simulated floor runs.

use underfoot_sim::{FeetTape, FloorBuild};

use super::SharedVisit;

/// Records visits to a floor, one after the other, and keeps the last one.
#[derive(Debug)]
pub struct VisitTape {
    tape: FeetTape,
    build: FloorBuild,
    kept: Option<KeptVisit>,
}

/// The last visit.
#[derive(Clone, Debug)]
pub struct KeptVisit {
    /// The visit, or a sentence that says why it is in no link.
    pub visit: Result<SharedVisit, String>,
    /// Its length in seconds.
    pub length_s: f64,
}

impl VisitTape {
    /// Records the feet on `tape`, on a floor that was built so.
    #[must_use]
    pub const fn new(tape: FeetTape, build: FloorBuild) -> Self {
        Self { tape, build, kept: None }
    }

    /// Begins a visit.
    pub fn begin(&mut self) {
        self.kept = None;
        self.tape.begin();
    }

    /// Ends the visit in progress, if there is one.
    pub fn end(&mut self) {
        let is_cut = self.tape.is_cut();
        let Some(feet) = self.tape.end() else { return };
        let visit = if is_cut {
            Err("no link: another layout came onto the floor within the visit".to_owned())
        } else {
            SharedVisit::new(&feet, self.build.quality, self.build.seed).map_err(|error| error.to_string())
        };
        self.kept = Some(KeptVisit { visit, length_s: feet.duration().as_secs_f64() });
    }

    /// Whether the visit in progress records no more: it has as much as a recording can have, or belongs to a layout
    /// that is gone.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.tape.is_full() || self.tape.is_cut()
    }

    /// Length of the visit in progress in seconds, and about as many bytes as it takes in a link; `None` without one.
    #[must_use]
    pub fn size(&self) -> Option<(f64, u64)> {
        /// Bytes for each point, as a rule.
        const POINT: u64 = 4;
        self.tape.size().map(|(ms, points)| (f64::from(ms) / 1e3, POINT * points as u64))
    }

    /// The last visit.
    #[must_use]
    pub fn kept(&self) -> Option<&KeptVisit> {
        self.kept.as_ref()
    }

    /// Deletes the last visit.
    pub fn discard(&mut self) {
        self.kept = None;
    }
}
