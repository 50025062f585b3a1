//! The force of presses, and the reasons why controls ignore some: follows each visit of a contact to a control from
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

use crate::sense::ContactId;
use crate::units::{Instant, Newtons};
use crate::widget::{OffReason, WidgetId};

/// Minimum force of a press that is reported: the lowest threshold of any control.
const GRAZE: Newtons = Newtons(10.0);

/// Maximum number of ignored presses in a snapshot, and of answered ones.
pub(super) const SHOWN: usize = 16;

/// Initial capacity for visits; more cost one allocation.
const ROOM: usize = 64;

/// The reason why a control ignored a foot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Ignored {
    /// The foot walks, stands or rests there.
    Step,
    /// The contact has kept still for a minute and counts as an object.
    Object,
    /// The foot stands in a stance zone.
    Stance,
    /// Its centre of pressure is outside the control's region.
    OutsideRegion,
    /// Another foot has the region's cursor.
    OtherFoot,
    /// The foot slid onto the control from beside it.
    SlidOn,
    /// The control has not been seen unloaded since the start, a loss, a cancel or a change of the page.
    NotSeenUnloaded,
    /// The forces are not reliable: a saturated or failing sensor, or a load that does not rise as a foot's does.
    Unbelieved,
    /// The guard requires a foot that has settled without taking the weight over; or the control acts at once, and
    /// the foot carries a body, or its force has not settled and no foot stands beside it.
    Guard,
    /// The control is off.
    Off(OffReason),
    /// The force stayed below the control's threshold.
    TooLight,
    /// The force was high enough, but not for long enough.
    TooShort,
}

impl Ignored {
    /// The reasons that say nothing about the state of the control, in the order of the enum.
    const OF_THE_FOOT: [Self; 11] = [
        Self::Step,
        Self::Object,
        Self::Stance,
        Self::OutsideRegion,
        Self::OtherFoot,
        Self::SlidOn,
        Self::NotSeenUnloaded,
        Self::Unbelieved,
        Self::Guard,
        Self::TooLight,
        Self::TooShort,
    ];

    /// Returns all reasons; those of a control that is off come last.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::OF_THE_FOOT.into_iter().chain(OffReason::ALL.map(Self::Off))
    }

    /// Its name in OSC, JSON, C, Python and metrics; it stays the same in later versions. A control that is off has
    /// the name of that reason: [`OffReason::name`].
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Step => "step",
            Self::Object => "object",
            Self::Stance => "stance",
            Self::OutsideRegion => "outside_region",
            Self::OtherFoot => "other_foot",
            Self::SlidOn => "slid_on",
            Self::NotSeenUnloaded => "not_seen_unloaded",
            Self::Unbelieved => "unbelieved",
            Self::Guard => "guard",
            Self::Off(reason) => reason.name(),
            Self::TooLight => "too_light",
            Self::TooShort => "too_short",
        }
    }

    /// The reason with this [`Ignored::name`]; `None` for any other text.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::all().find(|reason| reason.name() == name)
    }
}

impl fmt::Display for Ignored {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Off(reason) => return reason.fmt(f),
            Self::Step => "the foot walks, stands or rests there",
            Self::Object => "it has kept still for a minute and counts as an object",
            Self::Stance => "the foot stands in a stance zone",
            Self::OutsideRegion => "the foot is outside the control's region",
            Self::OtherFoot => "another foot works this region",
            Self::SlidOn => "the foot slid onto it from beside",
            Self::NotSeenUnloaded => "it has to be seen unloaded first",
            Self::Unbelieved => "the forces can't be believed",
            Self::Guard => "it wants a foot that has settled",
            Self::TooLight => "too light",
            Self::TooShort => "too short",
        })
    }
}

/// A press that a control ignored.
#[derive(Clone, Debug, PartialEq)]
pub struct IgnoredPress {
    /// When the foot left the control.
    pub at: Instant,
    /// The control.
    pub id: WidgetId,
    /// The contact.
    pub contact: ContactId,
    /// The maximum force on the control.
    pub force: Newtons,
    /// The reason.
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
    /// When the press ended.
    pub at: Instant,
    /// The control.
    pub id: WidgetId,
    /// The contact.
    pub contact: ContactId,
    /// The maximum force since the contact came, or since the control last released it.
    pub force: Newtons,
}

/// One contact on one control.
#[derive(Clone, Debug)]
struct Visit {
    contact: ContactId,
    widget: usize,
    /// The maximum force since the control last released the contact.
    peak: Newtons,
    /// Whether the control has responded since then.
    is_press: bool,
    /// The first reason that prevented a press.
    why: Option<Ignored>,
    is_answered: bool,
    is_there: bool,
}

/// The visits under way, and the latest finished ones.
#[derive(Clone, Debug)]
pub(super) struct IgnoredPresses {
    visits: Vec<Visit>,
    /// The presses ignored in this frame.
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

    /// Notes a contact on a control, and the reason that prevents a press now, if any.
    pub(super) fn note(&mut self, contact: ContactId, widget: usize, force: Newtons, why: Option<Ignored>) {
        let visit = self.visit(contact, widget);
        visit.is_there = true;
        visit.peak = visit.peak.max(force);
        if why != Some(Ignored::NotSeenUnloaded) || visit.why.is_none() {
            visit.why = why.or(visit.why);
        }
    }

    /// Notes that a contact is where it was, without new readings of it.
    pub(super) fn note_stay(&mut self, contact: ContactId) {
        let visits = self.visits.iter_mut().filter(|visit| visit.contact == contact);
        visits.for_each(|visit| visit.is_there = true);
    }

    /// Notes that the control responds to a contact, with a press or a refusal.
    pub(super) fn note_answer(&mut self, contact: ContactId, widget: usize, force: Newtons) {
        let visit = self.visit(contact, widget);
        (visit.is_there, visit.is_answered, visit.is_press) = (true, true, true);
        visit.peak = visit.peak.max(force);
    }

    /// Notes that the control named `id` has released a contact, which may still be there and press again; a
    /// cancelled press does not count as meant by a person.
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

    /// Ends the frame at time `at`: reports the visits that are over. `press` gives a control's id and threshold.
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

    /// Drops the visits under way: their controls belong to another layout.
    pub(super) fn forget(&mut self) {
        self.visits.clear();
    }

    /// The latest answered presses, oldest first.
    pub(super) fn answered(&self) -> impl Iterator<Item = &AnsweredPress> {
        self.answered.iter()
    }

    /// The latest ignored presses, oldest first.
    pub(super) fn latest(&self) -> impl Iterator<Item = &IgnoredPress> {
        self.latest.iter()
    }

    /// The ignored presses of the last frame.
    pub(super) fn new_ones(&self) -> &[IgnoredPress] {
        &self.new
    }

    /// Whether a visit of this contact was noted in this frame.
    pub(super) fn is_noted(&self, contact: ContactId) -> bool {
        self.visits.iter().any(|visit| visit.is_there && visit.contact == contact)
    }
}

/// Appends one press; drops the oldest of [`SHOWN`].
fn keep<T>(all: &mut VecDeque<T>, one: T) {
    if all.len() == SHOWN {
        all.pop_front();
    }
    all.push_back(one);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_of_a_reason_leads_back_to_it() {
        for reason in Ignored::all() {
            assert_eq!(Ignored::from_name(reason.name()), Some(reason));
        }
        assert_eq!(Ignored::all().count(), 22, "a reason without a place in the list has no counter");
        assert_eq!(Ignored::from_name("off"), None);
    }
}
