//! How hard controls are pressed, and why presses go unanswered: each visit of a contact to a control is watched from
//! touch to leave.
//!
//! ```text
//! 1  the control was pressed                  -> an answered press, once it is let go
//! 2  something kept it from being pressed     -> that, with the force at which it did
//! 3  never heavy enough, but more than a graze -> too light
//! 4  heavy enough, but not for long enough    -> too short
//! 5  a graze                                  -> nothing to say
//! ```

use std::collections::VecDeque;
use std::fmt;

use crate::sense::{ContactId, HoldDoubt};
use crate::units::{Instant, Newtons};
use crate::widget::WidgetId;

/// Least force of a press that is worth a word: the least that a control may be set to.
const GRAZE: Newtons = Newtons(10.0);

/// How many ignored presses are kept to be shown, and how many answered ones.
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
    /// The guard wants a foot that has settled and does not take the weight over; or the control acts at once, and no
    /// foot stands beside this one, whose force has not settled, or it bears a body.
    Guard,
    /// Another control that acts while it is held is held already.
    OtherRuns,
    /// An app has switched the control off.
    Disabled,
    /// The control acts while it is held, and the floor is not calibrated.
    Uncalibrated,
    /// The control acts while it is held, and the readings under it may not hold it.
    Doubted(HoldDoubt),
    /// The force never came up to the control's threshold.
    TooLight,
    /// The force was enough, but not for long enough.
    TooShort,
}

impl fmt::Display for Ignored {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = match self {
            Self::Doubted(doubt) => return doubt.fmt(f),
            Self::Step => "the foot walks, stands or rests there",
            Self::Object => "it has kept still for a minute and counts as an object",
            Self::Stance => "the foot stands in a stance zone",
            Self::OutsideRegion => "the foot is outside the control's region",
            Self::OtherFoot => "another foot works this region",
            Self::SlidOn => "the foot slid onto it from beside",
            Self::NotSeenUnloaded => "it has to be seen unloaded first",
            Self::Unbelieved => "the forces can't be believed",
            Self::Guard => "it wants a foot that has settled",
            Self::OtherRuns => "another control that acts while it is held is held already",
            Self::Disabled => "an app has switched it off",
            Self::Uncalibrated => "the floor is not calibrated",
            Self::TooLight => "too light",
            Self::TooShort => "too short",
        };
        f.write_str(text)
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

/// A press that a control answered, and that was not cancelled.
#[derive(Clone, Debug, PartialEq)]
pub struct AnsweredPress {
    /// When the control let go.
    pub at: Instant,
    /// Which control.
    pub id: WidgetId,
    /// Which contact.
    pub contact: ContactId,
    /// The greatest force it had there since it came, or since the control let go of it last.
    pub force: Newtons,
}

/// One contact on one control.
#[derive(Clone, Debug)]
struct Visit {
    contact: ContactId,
    widget: usize,
    /// The greatest force since the control let go last.
    peak: Newtons,
    /// Whether the control has answered since then.
    is_press: bool,
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
    answered: VecDeque<AnsweredPress>,
}

impl Default for IgnoredPresses {
    fn default() -> Self {
        let (visits, new) = (Vec::with_capacity(ROOM), Vec::with_capacity(ROOM));
        let (latest, answered) = (VecDeque::with_capacity(SHOWN), VecDeque::with_capacity(SHOWN));
        Self { visits, new, latest, answered }
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

    /// Notes that the control answers a contact, if only with a refusal.
    pub(super) fn note_answer(&mut self, contact: ContactId, widget: usize, force: Newtons) {
        let visit = self.visit(contact, widget);
        (visit.is_there, visit.is_answered, visit.is_press) = (true, true, true);
        visit.peak = visit.peak.max(force);
    }

    /// Notes that the control called `id` has let go of a contact, which may still be there and press again; a press
    /// that was cancelled is not one that a person meant.
    pub(super) fn note_end(&mut self, at: Instant, id: &WidgetId, held: (ContactId, usize), cancelled: bool) {
        let (contact, widget) = held;
        let visit = self.visit(contact, widget);
        let force = std::mem::replace(&mut visit.peak, Newtons::ZERO);
        if std::mem::take(&mut visit.is_press) && !cancelled {
            keep(&mut self.answered, AnsweredPress { at, id: id.clone(), contact, force });
        }
    }

    fn visit(&mut self, contact: ContactId, widget: usize) -> &mut Visit {
        let is_it = |visit: &Visit| visit.contact == contact && visit.widget == widget;
        let at = self.visits.iter().position(is_it).unwrap_or(self.visits.len());
        if at == self.visits.len() {
            let (peak, why) = (Newtons::ZERO, None);
            let (is_press, is_answered, is_there) = (false, false, true);
            self.visits.push(Visit { contact, widget, peak, is_press, why, is_answered, is_there });
        }
        &mut self.visits[at]
    }

    /// Ends a frame of time `at`: what visits that are over led to. `press` is a control's id and threshold.
    pub(super) fn end(&mut self, at: Instant, press: impl Fn(usize) -> Option<(WidgetId, Newtons)>) {
        let Self { visits, latest, new, answered } = self;
        visits.retain(|visit| {
            if visit.is_there {
                return true;
            }
            if !visit.is_press && (visit.is_answered || visit.peak < GRAZE) {
                return false;
            }
            let Some((id, threshold)) = press(visit.widget) else { return false };
            if visit.is_press {
                keep(answered, AnsweredPress { at, id, contact: visit.contact, force: visit.peak });
                return false;
            }
            let otherwise = if visit.peak < threshold { Ignored::TooLight } else { Ignored::TooShort };
            let why = visit.why.unwrap_or(otherwise);
            let press = IgnoredPress { at, id, contact: visit.contact, force: visit.peak, why };
            keep(latest, press.clone());
            new.push(press);
            false
        });
    }

    /// Forgets the visits under way: their controls are another layout's.
    pub(super) fn forget(&mut self) {
        self.visits.clear();
    }

    /// The latest presses that were answered, oldest first.
    pub(super) fn answered(&self) -> impl Iterator<Item = &AnsweredPress> {
        self.answered.iter()
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

/// Puts one behind the others, in place of the oldest of [`SHOWN`].
fn keep<T>(all: &mut VecDeque<T>, one: T) {
    if all.len() == SHOWN {
        all.pop_front();
    }
    all.push_back(one);
}
