//! Joins the contacts of several areas into contacts of one floor.
//!
//! Nodes report contacts beyond their area too, so that two nodes report a foot near a border. Both reports form one
//! **joint** contact as soon as both nodes see the foot, long before it crosses. Its number never changes; the node
//! of its **owner** area provides its position.

use std::collections::{HashMap, VecDeque};
use std::time::Duration;

use glam::Vec2;
use underfoot::floor::{Area, Floor, Geometry};
use underfoot::sense::Contact;
use underfoot::units::Instant;

use crate::message::NodeContact;

/// Greatest distance (m) at which two nodes' contacts join: both sense the same forces, but at different times, and
/// a landing foot moves by some millimetres in each.
const SAME_M: f32 = 0.05;

/// Distance (m) beyond which members of a joint contact are split into two.
const APART_M: f32 = 0.15;

/// Time for which a joint contact without members can still be matched in another area.
const LATE: Duration = Duration::from_millis(20);

/// Time for which the old owner keeps a foot that has left its area while the next area does not see it.
const LEAVING: Duration = Duration::from_millis(50);

/// Time for which the number of an ended contact stays known, for later events.
const REMEMBERED: Duration = Duration::from_secs(2);

/// Number of stored frames of an area, between which positions of contacts are interpolated.
const FRAMES: usize = 8;

/// The last reports of one area.
#[derive(Clone, Debug, Default)]
struct View {
    frames: VecDeque<(Instant, Vec<NodeContact>)>,
    /// The joint contact of each of its contacts, by the node's number.
    joints: HashMap<u32, u32>,
    /// Joint contacts of its ended contacts, with the time of the end.
    past: HashMap<u32, (u32, Instant)>,
    /// Whether its node is live.
    live: bool,
}

impl View {
    fn latest(&self, id: u32) -> Option<&NodeContact> {
        self.frames.back()?.1.iter().find(|contact| contact.id == id)
    }

    /// The contact `id` at `at`, interpolated between two frames.
    fn between(&self, id: u32, at: Instant) -> Option<NodeContact> {
        let of =
            |(_, contacts): &(Instant, Vec<NodeContact>)| contacts.iter().find(|one| one.id == id).copied();
        let later = self.frames.iter().position(|(time, _)| *time >= at);
        let Some(later) = later else { return self.frames.back().and_then(of) };
        let (end, before) =
            (self.frames.get(later)?, later.checked_sub(1).and_then(|at| self.frames.get(at)));
        match (before.and_then(of).zip(before), of(end)) {
            (Some((from, (start, _))), Some(to)) => {
                let (span, past) = (end.0.since(*start).as_secs_f32(), at.since(*start).as_secs_f32());
                Some(if span > 0.0 { from.towards(&to, past / span) } else { to })
            }
            (_, to) => to.or_else(|| self.latest(id).copied()),
        }
    }
}

/// One foot, in the views of all areas that see it.
#[derive(Clone, Debug)]
struct Joint {
    id: u32,
    /// The areas that see it, with their nodes' numbers for it.
    members: Vec<(usize, u32)>,
    /// The area that provides its position.
    owner: Option<usize>,
    /// Time since which it has been outside its owner's area while no other area sees it inside its own.
    leaving: Option<Instant>,
    /// Its last position and time.
    last: (Vec2, Instant),
    /// The owner that ended it: a contact that appears there later is another foot.
    ended_by: Option<usize>,
}

impl Joint {
    fn name_in(&self, area: usize) -> Option<u32> {
        self.members.iter().find(|(other, _)| *other == area).map(|(_, id)| *id)
    }
}

/// The contacts of a floor of several areas.
#[derive(Clone, Debug)]
pub(super) struct Joiner {
    geometry: Geometry,
    areas: Vec<Area>,
    views: Vec<View>,
    joints: Vec<Joint>,
    last_id: u32,
}

impl Joiner {
    pub(super) fn new(floor: &Floor) -> Self {
        let views = vec![View::default(); floor.areas.len()];
        let (geometry, areas) = (floor.geometry, floor.areas.clone());
        Self { geometry, areas, views, joints: Vec::new(), last_id: 0 }
    }

    /// Takes the contacts that the node of `area` saw at `at`, a time at or after that of its last frame.
    pub(super) fn frame(&mut self, area: usize, at: Instant, contacts: &[NodeContact]) {
        let Some(view) = self.views.get_mut(area) else { return };
        view.live = true;
        let ended: Vec<u32> =
            view.joints.keys().copied().filter(|id| !contacts.iter().any(|one| one.id == *id)).collect();
        if view.frames.len() == FRAMES {
            view.frames.pop_front();
        }
        view.frames.push_back((at, contacts.to_vec()));
        ended.into_iter().for_each(|id| self.end(area, id, at));
        for contact in contacts {
            self.check(area, contact, at);
        }
        let of_view = |joints: &HashMap<u32, u32>| -> Vec<(u32, Vec2)> {
            let is_new = |one: &&NodeContact| !joints.contains_key(&one.id);
            contacts.iter().filter(is_new).map(|one| (one.id, one.place())).collect()
        };
        let new = self.views.get(area).map(|view| of_view(&view.joints)).unwrap_or_default();
        self.find(area, new, at);
        self.forget(at);
        self.own(at);
    }

    /// The joint number of the contact that the node of `area` numbers `id` and saw at `place` at `at`.
    pub(super) fn name(&mut self, area: usize, id: u32, place: Vec2, at: Instant) -> Option<u32> {
        let view = self.views.get(area)?;
        let known = view.joints.get(&id).copied().or_else(|| view.past.get(&id).map(|(joint, _)| *joint));
        if known.is_some() {
            return known;
        }
        self.find(area, vec![(id, place)], at);
        self.views.get(area)?.joints.get(&id).copied()
    }

    /// Drops all contacts of `area`, which is not live any more, from `at` on.
    pub(super) fn lose(&mut self, area: usize, at: Instant) {
        let Some(view) = self.views.get_mut(area) else { return };
        *view = View::default();
        for joint in &mut self.joints {
            joint.members.retain(|(other, _)| *other != area);
            // A contact lost in this way is never matched again, since its further path is unknown.
            if joint.members.is_empty() {
                joint.last.1 = Instant::START;
            }
        }
        self.forget(at);
        self.own(at);
    }

    /// The contacts on the whole floor at `at`, in the order of their numbers.
    pub(super) fn contacts(&self, at: Instant) -> Vec<Contact> {
        let told = self.joints.iter().filter_map(|joint| {
            let owner = joint.owner?;
            let contact = self.views.get(owner)?.between(joint.name_in(owner)?, at)?;
            Some(contact.contact(joint.id))
        });
        told.collect()
    }

    /// Ends the contact `id` of the node of `area`. If that node owns the joint contact and no other node has it in
    /// its own area, the joint contact ends too.
    fn end(&mut self, area: usize, id: u32, at: Instant) {
        let Some(view) = self.views.get_mut(area) else { return };
        let Some(joint) = view.joints.remove(&id) else { return };
        view.past.insert(id, (joint, at));
        let Some(joint) = self.joints.iter_mut().find(|one| one.id == joint) else { return };
        joint.members.retain(|member| *member != (area, id));
        if joint.owner != Some(area) {
            return;
        }
        let is_own = |&(other, id): &(usize, u32)| {
            let seen = self.views.get(other).and_then(|view| view.latest(id));
            let own = self.areas.get(other);
            seen.zip(own).is_some_and(|(seen, own)| own.holds(&self.geometry, seen.place()))
        };
        if joint.members.iter().any(is_own) {
            return;
        }
        (joint.owner, joint.ended_by) = (None, Some(area));
        for (other, id) in std::mem::take(&mut joint.members) {
            if let Some(view) = self.views.get_mut(other) {
                view.joints.remove(&id);
            }
        }
    }

    /// Updates the position of a joint contact and removes members that belong to another foot: those further than
    /// [`APART_M`] from the owner's position and, without an owner, those nearer to another joint contact.
    fn check(&mut self, area: usize, contact: &NodeContact, at: Instant) {
        let Some(view) = self.views.get(area) else { return };
        let Some(id) = view.joints.get(&contact.id).copied() else { return };
        let Some(joint) = self.joints.iter().find(|joint| joint.id == id) else { return };
        let is_elsewhere = |&(other, id): &(usize, u32)| {
            let seen = self.views.get(other).and_then(|view| view.latest(id));
            seen.is_some_and(|seen| seen.place().distance(contact.place()) > APART_M)
        };
        let others = || joint.members.iter().filter(|(other, _)| *other != area);
        let own = (area, contact.id);
        let strays: Vec<(usize, u32)> = if joint.owner == Some(area) {
            others().filter(|other| is_elsewhere(other)).copied().collect()
        } else {
            let owner = others().find(|(other, _)| joint.owner == Some(*other));
            let is_away = owner.map_or_else(|| others().any(is_elsewhere), is_elsewhere);
            // Without an owner, the foot may since have become another joint contact.
            let is_other = joint.owner.is_none()
                && self.nearest(area, contact.place(), Some(id), at).is_some_and(|(_, nearest)| {
                    joint.members.len() == 1
                        || self.joints.iter().any(|one| one.id == nearest && one.owner.is_some())
                });
            if is_away || is_other { vec![own] } else { Vec::new() }
        };
        let stays = !strays.contains(&own);
        for &(other, id) in &strays {
            if let Some(view) = self.views.get_mut(other) {
                view.joints.remove(&id);
            }
        }
        let Some(joint) = self.joints.iter_mut().find(|joint| joint.id == id) else { return };
        joint.members.retain(|member| !strays.contains(member));
        if stays {
            joint.last = (contact.place(), at);
        } else if joint.members.is_empty() && joint.owner.is_none() {
            // No other area may match it again.
            joint.last.1 = Instant::START;
        }
    }

    /// The nearest joint contact to `place` in which `area` is not a member yet, with its distance.
    fn nearest(&self, area: usize, place: Vec2, but: Option<u32>, at: Instant) -> Option<(f32, u32)> {
        let candidates = self.joints.iter().filter(|joint| {
            let is_late = joint.members.is_empty() && at.since(joint.last.1) > LATE;
            let is_over = joint.ended_by == Some(area) && joint.owner.is_none();
            joint.name_in(area).is_none() && Some(joint.id) != but && !is_late && !is_over
        });
        let seen = |(other, id): &(usize, u32)| Some(self.views.get(*other)?.latest(*id)?.place());
        let distances = candidates.map(|joint| {
            let places = joint.members.iter().filter_map(seen).map(|other| other.distance(place));
            (places.reduce(f32::min).unwrap_or_else(|| joint.last.0.distance(place)), joint.id)
        });
        let near = distances.filter(|(distance, _)| *distance < SAME_M);
        near.min_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)))
    }

    /// Matches the contacts `new` of `area` with joint contacts, the nearest pairs first; the rest become new ones.
    fn find(&mut self, area: usize, mut new: Vec<(u32, Vec2)>, at: Instant) {
        while !new.is_empty() {
            let pairs = new.iter().enumerate().filter_map(|(place, (_, point))| {
                self.nearest(area, *point, None, at).map(|(distance, joint)| (distance, place, joint))
            });
            let pair = pairs.min_by(|one, other| one.0.total_cmp(&other.0));
            let (place, joint) = pair.map_or((0, None), |(_, place, joint)| (place, Some(joint)));
            let (id, point) = new.remove(place);
            let joint = joint.unwrap_or_else(|| self.begin(point, at));
            if let Some(found) = self.joints.iter_mut().find(|one| one.id == joint) {
                found.members.push((area, id));
                found.last = (point, at);
            }
            if let Some(view) = self.views.get_mut(area) {
                view.joints.insert(id, joint);
            }
        }
    }

    fn begin(&mut self, place: Vec2, at: Instant) -> u32 {
        self.last_id = self.last_id.wrapping_add(1);
        let (id, members) = (self.last_id, Vec::new());
        self.joints.push(Joint {
            id,
            members,
            owner: None,
            leaving: None,
            last: (place, at),
            ended_by: None,
        });
        id
    }

    /// Assigns the owner of each joint contact.
    fn own(&mut self, at: Instant) {
        let Self { geometry, areas, views, joints, .. } = self;
        for joint in joints {
            let seen = |area: usize| {
                let view = views.get(area).filter(|view| view.live)?;
                view.latest(joint.name_in(area)?).map(NodeContact::place)
            };
            let holds =
                |area: usize, place: Vec2| areas.get(area).is_some_and(|one| one.holds(geometry, place));
            let is_own = |area: &usize| seen(*area).is_some_and(|place| holds(*area, place));
            if joint.owner.as_ref().is_some_and(is_own) {
                joint.leaving = None;
                continue;
            }
            let places: Vec<Vec2> = joint.members.iter().filter_map(|(area, _)| seen(*area)).collect();
            let members = || joint.members.iter().map(|(area, _)| *area);
            // Each of two nodes may see it just on the other's side.
            let held =
                |area: &usize| seen(*area).is_some() && places.iter().any(|place| holds(*area, *place));
            let old = joint.owner.filter(|owner| seen(*owner).is_some());
            let next = members().find(is_own).or(old.filter(held)).or_else(|| members().find(held));
            (joint.owner, joint.leaving) = match (next, old) {
                (Some(next), _) => (Some(next), None),
                (None, Some(old)) => {
                    let since = joint.leaving.unwrap_or(at);
                    // A lost area reports no contacts.
                    let is_dark = seen(old).is_some_and(|place| {
                        areas
                            .iter()
                            .zip(views.iter())
                            .any(|(one, view)| !view.live && one.holds(geometry, place))
                    });
                    let stays = !is_dark && at.since(since) < LEAVING;
                    (stays.then_some(old), Some(since))
                }
                (None, None) => (None, joint.leaving),
            };
        }
    }

    /// Deletes joint contacts and old numbers past their time-outs.
    fn forget(&mut self, at: Instant) {
        self.joints.retain(|joint| !joint.members.is_empty() || at.since(joint.last.1) <= LATE);
        for view in &mut self.views {
            view.past.retain(|_, (_, ended)| at.since(*ended) < REMEMBERED);
        }
    }
}
