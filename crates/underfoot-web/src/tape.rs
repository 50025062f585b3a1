//! The button that records, in a page: feet for a link.

use underfoot_window::link::{SharedVisit, VisitTape};
use underfoot_window::preview::{VisitDesk, VisitOrder, VisitSize, VisitState};

/// Records the feet of the floor.
pub(crate) struct TapeDesk(VisitTape);

impl TapeDesk {
    /// A desk for the feet on `tape`.
    pub(crate) const fn new(tape: VisitTape) -> Self {
        Self(tape)
    }
}

impl VisitDesk for TapeDesk {
    fn state(&mut self) -> VisitState {
        if self.0.is_over() {
            self.0.end();
        }
        let recording = self.0.size().map(|(length_s, bytes)| VisitSize { length_s, bytes });
        let kept = self.0.kept().map(|kept| {
            let bytes = kept.visit.as_ref().map_or(0, |visit| visit.letters() as u64);
            VisitSize { length_s: kept.length_s, bytes }
        });
        VisitState {
            recording,
            kept,
            is_unsaved: kept.is_some(),
            is_for_links: true,
            ..VisitState::default()
        }
    }

    fn lead(&mut self, order: VisitOrder) {
        match order {
            VisitOrder::Begin(_) => self.0.begin(),
            VisitOrder::End => self.0.end(),
            VisitOrder::Discard => self.0.discard(),
            // The bar offers none of these for links.
            VisitOrder::Save(_)
            | VisitOrder::PlayAgain
            | VisitOrder::Export { .. }
            | VisitOrder::StopExport => {}
        }
    }

    fn shared(&self) -> Option<Result<SharedVisit, String>> {
        self.0.kept().map(|kept| kept.visit.clone())
    }
}
