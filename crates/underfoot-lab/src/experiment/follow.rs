//! Compares contacts with the feet that caused them.

use glam::Vec2;
use smallvec::SmallVec;

use super::errors::PositionErrors;
use super::rig::Rig;
use underfoot::sense::{Contact, ContactId};
use underfoot_sim::Load;

/// Force above which a foot counts as down, in newtons.
pub const DOWN_N: f32 = 10.0;

/// True state of one foot on the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Truth {
    /// Position of the shoe, which is constant while the foot stands.
    position: Vec2,
    /// Centre of the force that the floor carries.
    pub(super) centre: Vec2,
    /// Force that the floor carries, in newtons.
    pub(super) force: f32,
}

impl Truth {
    /// Computes the part of `load` on the floor; `None` if there is none.
    ///
    /// For a foot entirely on a level floor this is its centre of pressure. For a foot over the floor's edge, sensors
    /// can only measure the part on the floor.
    pub(super) fn of(load: &Load, rig: &Rig) -> Option<Self> {
        let parts = rig.carried(load);
        let force: f32 = parts.iter().map(|part| part.force.0).sum();
        let moment: Vec2 = parts.iter().map(|part| part.centroid * part.force.0).sum();
        (force > 0.0).then(|| Self { position: load.position, centre: moment / force, force })
    }

    fn is_down(&self) -> bool {
        self.force > DOWN_N
    }
}

/// Accuracy of contacts compared with feet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Followed {
    /// Error of each found foot while two or more are down.
    pub two_feet: PositionErrors,
    /// Error of each found foot while it is down alone.
    pub one_foot: PositionErrors,
    /// Number of feet of `one_foot` and of `two_feet` inside the 95 % ellipse of their contacts.
    pub inside: [usize; 2],
    /// Number of feet to find: one for each foot that is down in a sample.
    pub feet: usize,
    /// Number of feet without a contact within a shoe's length.
    pub missed: usize,
    /// Number of feet to find while two or more were down.
    pub of_two: usize,
    /// Number of feet found within 5 cm while two or more were down.
    pub of_two_within_5cm: usize,
    /// Number of samples with two or more feet down.
    pub several: usize,
    /// Number of samples with two or more feet down in which every foot was found within 5 cm.
    pub several_within_5cm: usize,
    /// Number of feet of `one_foot` with an ambiguous contact.
    pub one_foot_ambiguous: usize,
    /// Number of contacts without a foot.
    pub extra: usize,
    /// Number of touchdowns.
    pub steps: usize,
    /// Number of identity changes of a foot while it was down.
    pub swaps: usize,
}

impl Followed {
    /// Adds the counts of another comparison.
    pub fn append(&mut self, other: Self) {
        let Self {
            two_feet,
            one_foot,
            inside,
            feet,
            missed,
            of_two,
            of_two_within_5cm,
            several,
            several_within_5cm,
            one_foot_ambiguous,
            extra,
            steps,
            swaps,
        } = other;
        self.two_feet.append(two_feet);
        self.one_foot.append(one_foot);
        self.inside.iter_mut().zip(inside).for_each(|(sum, more)| *sum += more);
        self.feet += feet;
        self.missed += missed;
        self.of_two += of_two;
        self.of_two_within_5cm += of_two_within_5cm;
        self.several += several;
        self.several_within_5cm += several_within_5cm;
        self.one_foot_ambiguous += one_foot_ambiguous;
        self.extra += extra;
        self.steps += steps;
        self.swaps += swaps;
    }

    /// Returns the share (0 to 1) of feet found within 5 cm while two or more were down; a missed foot counts as not
    /// found.
    #[must_use]
    pub fn share_within_5cm(&self) -> f32 {
        share(self.of_two_within_5cm, self.of_two)
    }

    /// Returns the share (0 to 1) of all feet that were found within 5 cm; a missed foot counts as not found.
    #[must_use]
    pub fn share_of_all_within_5cm(&self) -> f32 {
        let near = |errors: &PositionErrors| errors.share_within(NEAR_M) * errors.count() as f32;
        (near(&self.one_foot) + near(&self.two_feet)) / self.feet.max(1) as f32
    }

    /// Returns the share (0 to 1) of samples with several feet down in which all were found within 5 cm.
    #[must_use]
    pub fn share_all_within_5cm(&self) -> f32 {
        share(self.several_within_5cm, self.several)
    }

    /// Returns the share (0 to 1) of the time of a foot alone in which its contact was ambiguous.
    #[must_use]
    pub fn share_ambiguous(&self) -> f32 {
        share(self.one_foot_ambiguous, self.one_foot.count())
    }

    /// Returns the share (0 to 1) of feet without a contact.
    #[must_use]
    pub fn share_missed(&self) -> f32 {
        share(self.missed, self.feet)
    }

    /// Returns the number of contacts without a foot, as a share of the feet.
    #[must_use]
    pub fn share_extra(&self) -> f32 {
        share(self.extra, self.feet)
    }

    /// Returns the shares (0 to 1) of feet inside the 95 % ellipse of their contacts: of a foot alone, and while two
    /// or more were down.
    #[must_use]
    pub fn share_inside(&self) -> [f32; 2] {
        [share(self.inside[0], self.one_foot.count()), share(self.inside[1], self.two_feet.count())]
    }

    /// Returns the number of identity changes per 1000 steps; `None` without a step.
    #[must_use]
    pub fn swaps_per_1000_steps(&self) -> Option<f32> {
        (self.steps > 0).then(|| 1000.0 * share(self.swaps, self.steps))
    }
}

fn share(part: usize, whole: usize) -> f32 {
    part as f32 / whole.max(1) as f32
}

/// Matches feet and their contacts from frame to frame.
#[derive(Clone, Debug, Default)]
pub(super) struct ContactMatcher {
    /// The feet that were down in the last frame, each with the identity of its contact.
    down: SmallVec<[(Truth, Option<ContactId>); 4]>,
}

/// Maximum distance that a foot moves in a millisecond while it is down (m).
const SAME_FOOT_M: f32 = 0.02;

impl ContactMatcher {
    /// Compares one frame's contacts with its feet. Identities are compared in every frame; errors and missed feet
    /// count only if `sampled`.
    pub(super) fn compare(
        &mut self,
        feet: &[Truth],
        contacts: &[Contact],
        sampled: bool,
        score: &mut Followed,
    ) {
        let down: SmallVec<[Truth; 4]> = feet.iter().copied().filter(Truth::is_down).collect();
        let found = pair(&down, contacts);
        if sampled {
            count(feet, &down, contacts, &found, score);
        }
        let now = down.iter().zip(&found).map(|(foot, found)| {
            let before = self.down.iter().find(|(old, _)| old.position.distance(foot.position) < SAME_FOOT_M);
            let name = found.map(|found| contacts[found].id);
            let named = before.and_then(|(_, name)| *name);
            score.steps += usize::from(before.is_none());
            score.swaps += usize::from(named.is_some() && name.is_some() && named != name);
            // A briefly lost foot keeps its last identity.
            (*foot, name.or(named))
        });
        self.down = now.collect();
    }
}

fn count(
    feet: &[Truth],
    down: &[Truth],
    contacts: &[Contact],
    found: &[Option<usize>],
    score: &mut Followed,
) {
    let heavy = contacts.iter().filter(|contact| contact.force.0 > DOWN_N).count();
    // A foot that is landing or lifting need not be found, but its contact does not count as extra.
    score.extra += heavy.saturating_sub(feet.len());
    score.feet += down.len();
    let mut all_near = true;
    for (foot, found) in down.iter().zip(found) {
        let error = found.map(|found| contacts[found].centroid.distance(foot.centre));
        score.missed += usize::from(error.is_none());
        let errors = if down.len() == 1 { &mut score.one_foot } else { &mut score.two_feet };
        error.into_iter().for_each(|error| errors.push(error));
        let is_inside = |&found: &usize| {
            let Contact { centroid, covariance, .. } = &contacts[found];
            covariance.mahalanobis_squared(foot.centre - *centroid) <= ELLIPSE_95
        };
        score.inside[usize::from(down.len() > 1)] += usize::from(found.as_ref().is_some_and(is_inside));
        let near = error.is_some_and(|error| error <= NEAR_M);
        all_near &= near;
        if down.len() > 1 {
            score.of_two += 1;
            score.of_two_within_5cm += usize::from(near);
        } else {
            score.one_foot_ambiguous += usize::from(found.is_some_and(|found| contacts[found].ambiguous));
        }
    }
    if down.len() > 1 {
        score.several += 1;
        score.several_within_5cm += usize::from(all_near);
    }
}

/// Maximum error of a correct position (m).
const NEAR_M: f32 = 0.05;

/// The 95 % quantile of chi-squared with two degrees of freedom.
pub(super) const ELLIPSE_95: f32 = 5.991;

/// Maximum number of contacts in the search, heaviest first: the time of the search grows exponentially.
const MOST_CONTACTS: usize = 6;

/// Maximum distance between a foot's centre of pressure and its contact (m): a shoe's length.
const FOUND_M: f32 = 0.33;

/// For each foot the index of its contact: as many pairs within [`FOUND_M`] as possible, with the least total
/// distance.
fn pair(feet: &[Truth], contacts: &[Contact]) -> SmallVec<[Option<usize>; 4]> {
    let mut places: SmallVec<[usize; 8]> = (0..contacts.len()).collect();
    places.sort_by(|&a, &b| contacts[b].force.0.total_cmp(&contacts[a].force.0));
    places.truncate(MOST_CONTACTS.max(feet.len()));
    let mut search = Search {
        feet,
        contacts,
        chosen: SmallVec::new(),
        best: smallvec::smallvec![None; feet.len()],
        least: f32::INFINITY,
    };
    search.go_on(&mut places, 0.0);
    search.best
}

struct Search<'a> {
    feet: &'a [Truth],
    contacts: &'a [Contact],
    chosen: SmallVec<[Option<usize>; 4]>,
    best: SmallVec<[Option<usize>; 4]>,
    least: f32,
}

impl Search<'_> {
    fn go_on(&mut self, free: &mut SmallVec<[usize; 8]>, distance: f32) {
        let Some(foot) = self.feet.get(self.chosen.len()) else {
            (self.least, self.best) = (distance, self.chosen.clone());
            return;
        };
        for place in 0..free.len() {
            let contact = free[place];
            let away = self.contacts[contact].centroid.distance(foot.centre);
            let further = distance + away;
            if away < FOUND_M && further < self.least {
                free.swap_remove(place);
                self.chosen.push(Some(contact));
                self.go_on(free, further);
                self.chosen.pop();
                free.push(contact);
                let last = free.len() - 1;
                free.swap(place, last);
            }
        }
        // An unmatched foot costs more than the sum of all possible distances.
        let further = distance + FOUND_M * self.feet.len() as f32;
        if further < self.least {
            self.chosen.push(None);
            self.go_on(free, further);
            self.chosen.pop();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use underfoot::units::Newtons;

    fn foot(x: f32, force: f32) -> Truth {
        Truth { position: Vec2::new(x, 0.0), centre: Vec2::new(x, 0.0), force }
    }

    fn contact(id: u32, x: f32, force: f32) -> Contact {
        Contact {
            id: ContactId(id),
            centroid: Vec2::new(x, 0.0),
            force: Newtons(force),
            ..Contact::default()
        }
    }

    fn compared(frames: &[(&[Truth], &[Contact])]) -> Followed {
        let (mut follower, mut score) = (ContactMatcher::default(), Followed::default());
        for (feet, contacts) in frames {
            follower.compare(feet, contacts, true, &mut score);
        }
        score
    }

    #[test]
    fn feet_get_the_contacts_that_make_the_least_total_distance() {
        // The contact at 0.3 is the nearest one of both feet; the total distance decides.
        let feet = [foot(0.2, 300.0), foot(0.35, 300.0)];
        let contacts = [contact(7, 0.3, 300.0), contact(8, 0.5, 300.0), contact(9, 0.1, 300.0)];
        let found = pair(&feet, &contacts);
        assert_eq!(found[..], [Some(2), Some(0)]);
        assert_eq!(pair(&feet, &contacts[1..2])[..], [None, Some(0)], "one contact goes to the nearer foot");
        assert_eq!(pair(&feet, &[])[..], [None, None]);
        assert!(pair(&[], &contacts).is_empty());
        let other_tile = [contact(7, 0.6, 300.0), contact(8, 0.4, 300.0)];
        assert_eq!(pair(&feet[..1], &other_tile[..1])[..], [None], "40 cm away is not this foot");
        assert_eq!(pair(&feet, &other_tile)[..], [Some(1), Some(0)], "as many as can be");
    }

    #[test]
    fn one_contact_between_two_feet_is_one_found_and_one_missed() {
        let score = compared(&[(&[foot(0.0, 300.0), foot(0.2, 310.0)], &[contact(1, 0.1, 610.0)])]);
        assert_eq!((score.feet, score.missed, score.extra), (2, 1, 0));
        assert_eq!((score.of_two, score.of_two_within_5cm, score.two_feet.count()), (2, 0, 1));
        assert_eq!((score.several, score.several_within_5cm), (1, 0));
    }

    #[test]
    fn all_of_several_feet_count_and_one_alone_may_be_ambiguous() {
        let ambiguous = Contact { ambiguous: true, ..contact(1, 0.0, 300.0) };
        let score = compared(&[
            (&[foot(0.0, 300.0), foot(0.4, 310.0)], &[contact(1, 0.01, 300.0), contact(2, 0.41, 310.0)]),
            (&[foot(0.0, 300.0), foot(0.4, 310.0)], &[contact(1, 0.01, 300.0), contact(2, 0.48, 310.0)]),
            (&[foot(0.0, 300.0)], &[ambiguous]),
        ]);
        assert_eq!((score.several, score.several_within_5cm, score.of_two_within_5cm), (2, 1, 3));
        assert_eq!((score.share_ambiguous(), score.share_all_within_5cm()), (1.0, 0.5));
    }

    #[test]
    fn a_foot_that_just_lands_is_neither_missed_nor_extra() {
        let score = compared(&[
            (&[foot(0.0, 300.0), foot(0.4, 5.0)], &[contact(1, 0.0, 300.0), contact(2, 0.4, 11.0)]),
            (&[foot(0.0, 300.0), foot(0.4, 5.0)], &[contact(1, 0.0, 300.0)]),
        ]);
        assert_eq!((score.feet, score.missed, score.extra), (2, 0, 0));
        let ghost = compared(&[(&[foot(0.0, 300.0)], &[contact(1, 0.0, 300.0), contact(2, 0.4, 11.0)])]);
        assert_eq!(ghost.extra, 1);
    }

    #[test]
    fn changes_of_name_count_while_a_foot_is_down_and_not_between_steps() {
        let down = [foot(0.0, 300.0)];
        let score = compared(&[
            (&down, &[contact(1, 0.0, 300.0)]),
            (&down, &[]),
            (&down, &[contact(2, 0.0, 300.0)]),
            (&[], &[]),
            (&down, &[contact(3, 0.0, 300.0)]),
        ]);
        assert_eq!((score.steps, score.swaps, score.missed), (2, 1, 1));
        assert_eq!(score.swaps_per_1000_steps(), Some(500.0));
    }
}
