//! Groups of feet that share tiles.

use super::{Tracker, UNASSIGNED};

/// The members of each group of feet, in their order.
#[derive(Clone, Debug)]
pub(super) struct Groups {
    /// For each group, its first and its last foot.
    ends: Vec<(u32, u32)>,
    /// For each foot, the next one of its group.
    next: Vec<u32>,
}

impl Groups {
    pub(super) fn new(room: usize) -> Self {
        Self { ends: Vec::with_capacity(room), next: Vec::with_capacity(room) }
    }

    /// Resets to `tracks` feet, each in a group of its own.
    pub(super) fn part(&mut self, tracks: usize) {
        self.ends.clear();
        self.ends.extend((0..tracks as u32).map(|which| (which, which)));
        self.next.clear();
        self.next.resize(tracks, UNASSIGNED);
    }

    /// Records the group of each foot, in their order; group numbers are below `groups`.
    pub(super) fn renew(&mut self, of_feet: impl Iterator<Item = u32>, groups: usize) {
        self.ends.clear();
        self.ends.resize(groups, (UNASSIGNED, UNASSIGNED));
        self.next.clear();
        for (which, group) in (0..).zip(of_feet) {
            self.next.push(UNASSIGNED);
            self.append(which, group);
        }
    }

    /// Sorts united groups into the order of their `members`, each given with its group.
    pub(super) fn order(&mut self, members: impl Iterator<Item = (u32, u32)> + Clone) {
        for (which, group) in members.clone() {
            self.ends[group as usize] = (UNASSIGNED, UNASSIGNED);
            self.next[which as usize] = UNASSIGNED;
        }
        members.for_each(|(which, group)| self.append(which, group));
    }

    /// Appends foot `which` to a group.
    fn append(&mut self, which: u32, group: u32) {
        let (first, last) = &mut self.ends[group as usize];
        match self.next.get_mut(*last as usize) {
            Some(next) => *next = which,
            None => *first = which,
        }
        *last = which;
    }

    /// Appends the members of the group `drop` to those of the group `keep`, unsorted until the next `order`.
    pub(super) fn unite(&mut self, keep: u32, drop: u32) {
        let (first, last) = std::mem::replace(&mut self.ends[drop as usize], (UNASSIGNED, UNASSIGNED));
        let end = &mut self.ends[keep as usize].1;
        if let Some(next) = self.next.get_mut(*end as usize) {
            *next = first;
            *end = last;
        }
    }

    /// The feet of a group.
    pub(super) fn of(&self, group: u32) -> impl Iterator<Item = usize> {
        let known = |which: u32| (which != UNASSIGNED).then_some(which as usize);
        let first = self.ends.get(group as usize).map_or(UNASSIGNED, |ends| ends.0);
        std::iter::successors(known(first), move |&which| known(self.next[which]))
    }
}

impl Tracker {
    /// Numbers the groups of feet that share tiles: the number of a group is that of its first member.
    pub(super) fn group(&mut self, tiles: usize) {
        self.owner.clear();
        self.owner.resize(tiles, UNASSIGNED);
        self.sharing.clear();
        for (which, foot) in (0..).zip(self.tracks.iter_mut()) {
            foot.company.group = which;
            foot.company.crowded = false;
            for &position in &foot.tiles {
                let owner = &mut self.owner[position as usize];
                if *owner == UNASSIGNED {
                    *owner = which;
                } else {
                    self.sharing.push((which, *owner));
                }
            }
        }
        self.mates.part(self.tracks.len());
        self.members.clear();
        for &(foot, owner) in &self.sharing {
            self.members.extend([foot, owner]);
            let (mine, theirs) =
                (self.tracks[foot as usize].company.group, self.tracks[owner as usize].company.group);
            if mine != theirs {
                let (keep, drop) = (mine.min(theirs), mine.max(theirs));
                for mate in self.mates.of(drop) {
                    self.tracks[mate].company.group = keep;
                }
                self.mates.unite(keep, drop);
            }
        }
        self.members.sort_unstable();
        self.members.dedup();
        for &which in &self.members {
            self.tracks[which as usize].company.crowded = true;
        }
        self.mates
            .order(self.members.iter().map(|&which| (which, self.tracks[which as usize].company.group)));
    }

    /// Records the group of each foot; group numbers are below `groups`.
    pub(super) fn renew_groups(&mut self, groups: usize) {
        self.mates.renew(self.tracks.iter().map(|foot| foot.company.group), groups);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_that_become_one_have_all_members() {
        let mut mates = Groups::new(4);
        mates.part(6);
        mates.unite(0, 3);
        mates.unite(1, 2);
        mates.unite(0, 1);
        let mut all: Vec<usize> = mates.of(0).collect();
        all.sort_unstable();
        assert_eq!(all, [0, 1, 2, 3]);
        assert_eq!((mates.of(1).count(), mates.of(4).count(), mates.of(99).count()), (0, 1, 0));
        mates.order((0..4).map(|which| (which, 0)));
        assert_eq!(mates.of(0).collect::<Vec<_>>(), [0, 1, 2, 3]);
        // Two feet have ended since.
        mates.renew([0, 0, 4, 0].into_iter(), 6);
        assert_eq!(mates.of(0).collect::<Vec<_>>(), [0, 1, 3]);
        assert_eq!(mates.of(4).collect::<Vec<_>>(), [2]);
    }
}
