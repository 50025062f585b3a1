//! Neighbours of a place or a foot, found without a search over all feet.

use super::params::tracker::{SEEN_S, STRIDE_M};
use glam::DVec2;

use super::state::Track;
use super::{Cells, UNASSIGNED, first_of_least};

/// The feet by their places, in squares of one stride.
///
/// All feet within a stride of a place are in its square or in the eight around it. Only squares with feet are
/// accessed: the cost grows with the number of feet and not with the size of the floor.
#[derive(Clone, Debug)]
pub(super) struct Near {
    /// South-west corner of the floor.
    corner: DVec2,
    /// Place of the north-easternmost square, in squares.
    last_square: DVec2,
    /// Squares per row, including the empty ones around the floor: each square of the floor has eight neighbours.
    row: usize,
    /// For each square, the foot added last.
    last: Vec<u32>,
    tracks: Vec<Neighbour>,
}

/// The place of a foot, apart from the rest of its state, so that a search accesses little memory.
#[derive(Clone, Copy, Debug)]
struct Neighbour {
    place: DVec2,
    square: u32,
    /// The foot added to that square before this one.
    before: u32,
    /// Whether it has been down long enough to be another foot's partner.
    is_seen: bool,
    /// Force above which feet of the same person carry the person (N).
    body_n: f64,
}

impl Neighbour {
    /// Whether it can be the partner of a foot at this squared distance.
    #[inline]
    fn is_partner_at(&self, square: f64) -> bool {
        self.is_seen & (square < STRIDE_M * STRIDE_M)
    }
}

impl Near {
    pub(super) fn new(cells: &Cells, room: usize) -> Self {
        let (corner, end) = cells.bounds();
        let count = ((end - corner) / STRIDE_M).ceil().max(DVec2::ONE);
        let (columns, rows) = (count.x as usize, count.y as usize);
        Self {
            corner,
            last_square: count - 1.0,
            row: columns + 2,
            last: vec![UNASSIGNED; (columns + 2) * (rows + 2)],
            tracks: Vec::with_capacity(room),
        }
    }

    /// Records the places of all feet, in their order.
    pub(super) fn renew(&mut self, tracks: &[Box<Track>]) {
        for foot in &self.tracks {
            self.last[foot.square as usize] = UNASSIGNED;
        }
        self.tracks.clear();
        tracks.iter().for_each(|foot| self.add(foot));
    }

    /// Adds the next foot.
    pub(super) fn add(&mut self, foot: &Track) {
        let place = foot.centre();
        let square = self.square(place);
        let before = std::mem::replace(&mut self.last[square], self.tracks.len() as u32);
        self.tracks.push(Neighbour {
            place,
            square: square as u32,
            before,
            is_seen: foot.age > SEEN_S,
            body_n: foot.body_of_owner(),
        });
    }

    /// Removes the feet for which `stays` is false and renumbers the others in the same order.
    pub(super) fn retain(&mut self, stays: impl Fn(usize) -> bool) {
        for foot in &self.tracks {
            self.last[foot.square as usize] = UNASSIGNED;
        }
        let feet = self.tracks.len();
        let mut kept = 0;
        for which in 0..feet {
            if stays(which) {
                let foot = self.tracks[which];
                let before = std::mem::replace(&mut self.last[foot.square as usize], kept as u32);
                self.tracks[kept] = Neighbour { before, ..foot };
                kept += 1;
            }
        }
        self.tracks.truncate(kept);
    }

    /// Moves foot `which` to `place`.
    pub(super) fn moved(&mut self, which: usize, place: DVec2) {
        let (new, Neighbour { square: old, before, .. }) = (self.square(place), self.tracks[which]);
        self.tracks[which].place = place;
        if new == old as usize {
            return;
        }
        let mut after = self.last[old as usize];
        if after == which as u32 {
            self.last[old as usize] = before;
        } else {
            while self.tracks[after as usize].before != which as u32 {
                after = self.tracks[after as usize].before;
            }
            self.tracks[after as usize].before = before;
        }
        let before = std::mem::replace(&mut self.last[new], which as u32);
        let foot = &mut self.tracks[which];
        (foot.square, foot.before) = (new as u32, before);
    }

    /// All feet within a stride of `place`, and some that are farther away, in no particular order.
    pub(super) fn around(&self, place: DVec2) -> Around<'_> {
        self.around_square(self.square(place))
    }

    #[inline]
    fn around_square(&self, square: usize) -> Around<'_> {
        let first = square - self.row - 1;
        Around { near: self, square: first, column: 0, rows: 2, next: self.last[first] }
    }

    /// The same, each with its distance from `place` (m).
    pub(super) fn distances(&self, place: DVec2) -> impl Iterator<Item = (f64, usize)> {
        self.around(place).map(move |which| (self.tracks[which].place.distance(place), which))
    }

    /// All feet within a stride of foot `which` except that one, and some that are farther away, in no particular
    /// order.
    pub(super) fn others(&self, which: usize) -> impl Iterator<Item = usize> {
        self.around_square(self.tracks[which].square as usize).filter(move |&other| other != which)
    }

    /// Whether another foot is within a stride of foot `which`.
    pub(super) fn is_beside_any(&self, which: usize) -> bool {
        let place = self.tracks[which].place;
        self.is_any_other(which, |other| other.place.distance_squared(place) <= STRIDE_M * STRIDE_M)
    }

    /// Whether foot `which` has a partner: another foot within a stride that has been down long enough.
    pub(super) fn has_partner(&self, which: usize) -> bool {
        let place = self.tracks[which].place;
        self.is_any_other(which, |other| other.is_partner_at(other.place.distance_squared(place)))
    }

    /// Force above which the nearest partner of foot `which` carries the person (N); `None` without a partner.
    pub(super) fn body_n_of_partner(&self, which: usize) -> Option<f64> {
        let place = self.tracks[which].place;
        let all = self.others(which).map(|other| (self.tracks[other].place.distance_squared(place), other));
        let partners = all.filter(|&(square, other)| self.tracks[other].is_partner_at(square));
        let distances = partners.map(|(square, other)| (square.sqrt(), other));
        distances.min_by(first_of_least).map(|(_, nearest)| self.tracks[nearest].body_n)
    }

    /// Whether `is_it` holds for another foot in the squares around foot `which`.
    #[inline]
    fn is_any_other(&self, which: usize, is_it: impl Fn(&Neighbour) -> bool) -> bool {
        let first = self.tracks[which].square as usize - self.row - 1;
        for squares in [first, first + self.row, first + 2 * self.row] {
            for &last in &self.last[squares..squares + 3] {
                let mut next = last;
                while let Some(other) = self.tracks.get(next as usize) {
                    if (next != which as u32) & is_it(other) {
                        return true;
                    }
                    next = other.before;
                }
            }
        }
        false
    }

    /// The square of a place; places beyond the floor belong to the outermost squares.
    fn square(&self, place: DVec2) -> usize {
        let at = ((place - self.corner) / STRIDE_M).clamp(DVec2::ZERO, self.last_square);
        (at.y as i32 as usize + 1) * self.row + at.x as i32 as usize + 1
    }
}

/// The feet in nine squares, square by square.
pub(super) struct Around<'a> {
    near: &'a Near,
    square: usize,
    column: usize,
    /// Number of rows of squares that follow.
    rows: usize,
    next: u32,
}

impl Iterator for Around<'_> {
    type Item = usize;

    #[inline]
    fn next(&mut self) -> Option<usize> {
        while self.next == UNASSIGNED {
            if self.column < 2 {
                (self.square, self.column) = (self.square + 1, self.column + 1);
            } else if self.rows > 0 {
                (self.square, self.column) = (self.square + self.near.row - 2, 0);
                self.rows -= 1;
            } else {
                return None;
            }
            self.next = self.near.last[self.square];
        }
        let which = self.next as usize;
        self.next = self.near.tracks[which].before;
        Some(which)
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;
    use crate::floor::Geometry;
    use crate::sense::ContactId;

    #[test]
    fn nobody_within_a_stride_is_overlooked() {
        let cells = Cells::new(&Geometry::of_paper_tiles(20, 9).unwrap());
        let mut rng = Pcg64Mcg::seed_from_u64(1);
        // Some lie beside the floor: the estimated place of a touchdown may be there.
        let mut place = || DVec2::new(rng.random_range(-0.5..6.5), rng.random_range(-0.5..3.2));
        let mut near = Near::new(&cells, 8);
        for _ in 0..20 {
            let mut tracks: Vec<DVec2> = (0..40).map(|_| place()).collect();
            let at = |&place: &DVec2| Track::new(ContactId(1), 700.0, place, 0.01);
            let boxed = |place: &DVec2| Box::new(at(place));
            near.renew(&tracks[..30].iter().map(boxed).collect::<Vec<_>>());
            tracks[30..].iter().for_each(|foot| near.add(&at(foot)));
            for which in [0, 7, 7, 39, 22] {
                tracks[which] = place();
                near.moved(which, tracks[which]);
            }
            // Every third track has ended.
            near.retain(|which| which % 3 != 1);
            let mut number = 0..;
            tracks.retain(|_| number.next().is_none_or(|which: usize| which % 3 != 1));
            for here in (0..50).map(|_| place()) {
                let mut found: Vec<usize> = near.around(here).collect();
                found.sort_unstable();
                assert!(found.windows(2).all(|pair| pair[0] != pair[1]), "each once: {found:?}");
                let within = (0..tracks.len()).filter(|&which| tracks[which].distance(here) <= STRIDE_M);
                within.for_each(|which| assert!(found.contains(&which), "{which} near {here}"));
            }
        }
    }
}
