//! The visit of a link, as a reel.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

use underfoot_sim::{RecordedFeet, TakeOver};
use underfoot_window::link::SharedLayout;
use underfoot_window::preview::PreviewInput;

use super::floor::PageFloor;
use super::plan::{FloorPlan, NoFloor};
use super::played::Reel;

/// Prepares the input of a live window: its links, for example.
pub type Dressing = Box<dyn Fn(&PageFloor, &mut PreviewInput)>;

/// Plays the samples of a floor.
type Play = Rc<RefCell<dyn FnMut(&[f32])>>;

/// Feet on a floor with a layout.
pub struct VisitReel {
    plan: FloorPlan,
    feet: Arc<RecordedFeet>,
    play: Play,
    dress: Dressing,
}

impl VisitReel {
    /// The visit of `shared`. `play` as in [`PageFloor::new`]; `dress` prepares the input of the window that goes on
    /// after the visit.
    ///
    /// # Errors
    /// As for [`PageFloor::new`], and [`NoFloor::Visit`] for a visit that cannot be played.
    pub fn new(
        shared: &SharedLayout,
        play: impl FnMut(&[f32]) + 'static,
        dress: Dressing,
    ) -> Result<Self, NoFloor> {
        let feet = shared.visit.as_ref().map(|visit| visit.feet()).transpose()?.unwrap_or_default();
        let plan = FloorPlan::of(shared)?;
        Ok(Self { plan, feet: Arc::new(feet), play: Rc::new(RefCell::new(play)), dress })
    }
}

impl Reel for VisitReel {
    fn begin(&self) -> Result<(PageFloor, PreviewInput, Option<TakeOver>), NoFloor> {
        let play = Rc::clone(&self.play);
        let heard = move |samples: &[f32]| (play.borrow_mut())(samples);
        let (floor, mut live, take_over) = PageFloor::of_visit(&self.plan, Arc::clone(&self.feet), heard);
        (self.dress)(&floor, &mut live);
        Ok((floor, live, Some(take_over)))
    }

    fn duration(&self) -> Duration {
        self.feet.duration()
    }
}
