//! Presses that no control answered, and why: each visit of a contact to a control is watched from touch to leave.
//!
//! ```text
//! 1  the control was pressed                  -> nothing to say
//! 2  something kept it from being pressed     -> that, with the force at which it did
//! 3  never heavy enough, but more than a graze -> too light
//! 4  heavy enough, but not for long enough    -> too short
//! 5  a graze                                  -> nothing to say
//! ```

use std::collections::VecDeque;
use std::fmt;

use crate::sense::ContactId;
use crate::units::{Instant, Newtons};
use crate::widget::WidgetId;

/// Least force of a press that is worth a word: the least that a control may be set to.
const GRAZE: Newtons = Newtons(10.0);

/// How many ignored presses are kept to be shown.
pub(super) const SHOWN: usize = 16;

/// Visits for which there is room from the start; more cost an allocation once.
const ROOM: usize = 64;

/// Why a control did not answer a foot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Ignored {
    /// The foot walks, stands or rests there.
    Step,
    /// It has kept still for a minute and counts as an object.
    Object,
    /// It stands in a stance zone.
    Stance,
    /// Its centre of pressure is outside the control's region.
    OutsideRegion,
    /// Another foot works the region.
    OtherFoot,
    /// The foot slid onto the control from beside it.
    SlidOn,
    /// The control has to be seen unloaded first: after a start, a loss, a cancel or a change of the page.
    NotSeenUnloaded,
    /// The forces can't be believed: a saturated or failing sensor, or a load that came as no foot does.
    Unbelieved,
    /// The guard wants a foot that has settled and does not take the weight over.
    Guard,
    /// Another control that acts while it is held is held already.
    OtherRuns,
    /// An app has switched the control off.
    Disabled,
    /// The control acts while it is held, and the floor is not calibrated.
    Uncalibrated,
    /// The force never came up to the control's threshold.
    TooLight,
    /// The force was enough, but not for long enough.
    TooShort,
}

impl fmt::Display for Ignored {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Step => "the foot walks, stands or rests there",
            Self::Object => "it has kept still for a minute and counts as an object",
            Self::Stance => "the foot stands in a stance zone",
            Self::OutsideRegion => "the foot is outside the control's region",
            Self::OtherFoot => "another foot works this region",
            Self::SlidOn => "the foot slid onto it from beside",
            Self::NotSeenUnloaded => "it has to be seen unloaded first",
            Self::Unbelieved => "the forces can't be believed",
            Self::Guard => "its guard wants a foot that has settled",
            Self::OtherRuns => "another control that acts while it is held is held already",
            Self::Disabled => "an app has switched it off",
            Self::Uncalibrated => "the floor is not calibrated",
            Self::TooLight => "too light",
            Self::TooShort => "too short",
        })
    }
}

/// A press that a control did not answer.
#[derive(Clone, Debug, PartialEq)]
pub struct IgnoredPress {
    /// When the foot left the control.
    pub at: Instant,
    /// Which control.
    pub id: WidgetId,
    /// Which contact.
    pub contact: ContactId,
    /// The greatest force it had there.
    pub force: Newtons,
    /// Why.
    pub why: Ignored,
}

impl fmt::Display for IgnoredPress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { id, force, why, .. } = self;
        write!(f, "{id}: a press with {:.0} N was ignored: {why}", force.0)
    }
}

/// One contact on one control.
#[derive(Clone, Debug)]
struct Visit {
    contact: ContactId,
    widget: usize,
    peak: Newtons,
    /// What kept the control from being pressed, the first cause of it.
    why: Option<Ignored>,
    is_answered: bool,
    is_there: bool,
}

/// The visits under way, and those that led to nothing.
#[derive(Clone, Debug)]
pub(super) struct IgnoredPresses {
    visits: Vec<Visit>,
    /// Those of this frame.
    new: Vec<IgnoredPress>,
    latest: VecDeque<IgnoredPress>,
}

impl Default for IgnoredPresses {
    fn default() -> Self {
        let (visits, new) = (Vec::with_capacity(ROOM), Vec::with_capacity(ROOM));
        Self { visits, new, latest: VecDeque::with_capacity(SHOWN) }
    }
}

impl IgnoredPresses {
    /// Begins a frame.
    pub(super) fn begin(&mut self) {
        self.new.clear();
        self.visits.iter_mut().for_each(|visit| visit.is_there = false);
    }

    /// Notes a contact on a control, and what keeps that from being pressed now, if anything does.
    pub(super) fn note(&mut self, contact: ContactId, widget: usize, force: Newtons, why: Option<Ignored>) {
        let visit = self.visit(contact, widget);
        visit.is_there = true;
        visit.peak = visit.peak.max(force);
        if why != Some(Ignored::NotSeenUnloaded) || visit.why.is_none() {
            visit.why = why.or(visit.why);
        }
    }

    /// Notes that the control has answered, if only with a refusal.
    pub(super) fn note_answer(&mut self, contact: ContactId, widget: usize) {
        let visit = self.visit(contact, widget);
        (visit.is_there, visit.is_answered) = (true, true);
    }

    fn visit(&mut self, contact: ContactId, widget: usize) -> &mut Visit {
        let is_it = |visit: &Visit| visit.contact == contact && visit.widget == widget;
        let at = self.visits.iter().position(is_it).unwrap_or(self.visits.len());
        if at == self.visits.len() {
            let (peak, why) = (Newtons::ZERO, None);
            self.visits.push(Visit { contact, widget, peak, why, is_answered: false, is_there: true });
        }
        &mut self.visits[at]
    }

    /// Ends a frame of time `at`: what visits that are over led to. `press` is a control's id and threshold.
    pub(super) fn end(&mut self, at: Instant, press: impl Fn(usize) -> Option<(WidgetId, Newtons)>) {
        let Self { visits, latest, new } = self;
        visits.retain(|visit| {
            if visit.is_there {
                return true;
            }
            if visit.is_answered || visit.peak < GRAZE {
                return false;
            }
            let Some((id, threshold)) = press(visit.widget) else { return false };
            let otherwise = if visit.peak < threshold { Ignored::TooLight } else { Ignored::TooShort };
            let why = visit.why.unwrap_or(otherwise);
            let press = IgnoredPress { at, id, contact: visit.contact, force: visit.peak, why };
            if latest.len() == SHOWN {
                latest.pop_front();
            }
            latest.push_back(press.clone());
            new.push(press);
            false
        });
    }

    /// Forgets the visits under way: their controls are another layout's.
    pub(super) fn forget(&mut self) {
        self.visits.clear();
    }

    /// The latest ones, oldest first.
    pub(super) fn latest(&self) -> impl Iterator<Item = &IgnoredPress> {
        self.latest.iter()
    }

    /// Those of the last frame.
    pub(super) fn new_ones(&self) -> &[IgnoredPress] {
        &self.new
    }

    /// Whether something has been noted of this contact in this frame.
    pub(super) fn is_noted(&self, contact: ContactId) -> bool {
        self.visits.iter().any(|visit| visit.is_there && visit.contact == contact)
    }
}
