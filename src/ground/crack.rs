//! One straight piece of a crack.

use glam::Vec2;

use crate::units::Instant;

/// One straight piece of a crack.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Crack {
    /// Its start, in floor metres: at a seed or at the end of another piece.
    pub from: Vec2,
    /// Its end.
    pub to: Vec2,
    /// Its energy, in joules: the more, the wider it gapes.
    pub energy_j: f32,
    /// Time of its opening.
    pub born: Instant,
    /// Its number, in the order of opening.
    pub number: u64,
    /// The line of which it is part: pieces of one line join end to end, in order of their numbers.
    pub line: u32,
    /// Number of branchings between it and its seed.
    pub rank: u8,
    /// The number of its seed.
    pub seed: u32,
}

impl Crack {
    /// Its length, in metres.
    #[must_use]
    pub fn length_m(&self) -> f32 {
        self.from.distance(self.to)
    }

    /// Its openness at `now`: 1 when it opens, 0 when it has frozen shut after `refreeze_s` seconds (`None`: it never
    /// does); `1 - sqrt(age / refreeze_s)` in between.
    ///
    /// # Source
    /// Stefan's law: the thickness of new ice grows with the square root of time.
    #[must_use]
    pub fn openness(&self, now: Instant, refreeze_s: Option<f32>) -> f32 {
        let age_s = now.since(self.born).as_secs_f32();
        refreeze_s.map_or(1.0, |whole_s| 1.0 - (age_s / whole_s).clamp(0.0, 1.0).sqrt())
    }

    /// Position of the first contact with this crack on the way from `start` to `end`, 0 to 1; `None` if there is
    /// none.
    ///
    /// A crack that ends or begins in `start` itself is the origin of the way, and does not count.
    pub(super) fn met_by(&self, start: Vec2, end: Vec2) -> Option<f32> {
        if self.from == start || self.to == start {
            return None;
        }
        let (way, own) = (end - start, self.to - self.from);
        let across = way.perp_dot(own);
        if across.abs() < 1e-12 {
            return None;
        }
        let apart = self.from - start;
        let (along, here) = (apart.perp_dot(own) / across, apart.perp_dot(way) / across);
        ((1e-4..=1.0).contains(&along) && (0.0..=1.0).contains(&here)).then_some(along)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crack(from: [f32; 2], to: [f32; 2]) -> Crack {
        Crack { from: from.into(), to: to.into(), ..Crack::default() }
    }

    #[test]
    fn ways_meet_what_they_cross_and_not_where_they_come_from() {
        let wall = crack([1.0, -1.0], [1.0, 1.0]);
        assert_eq!(wall.met_by(Vec2::ZERO, Vec2::new(4.0, 0.0)), Some(0.25));
        assert_eq!(wall.met_by(Vec2::ZERO, Vec2::new(0.9, 0.0)), None, "stops short of it");
        assert_eq!(wall.met_by(Vec2::new(0.0, 2.0), Vec2::new(4.0, 2.0)), None, "passes its end");
        assert_eq!(wall.met_by(Vec2::new(1.0, 1.0), Vec2::new(1.0, -3.0)), None, "goes back along it");
        assert_eq!(wall.met_by(Vec2::ZERO, Vec2::new(0.0, 9.0)), None, "parallel");
    }

    #[test]
    fn ice_grows_fast_at_first() {
        let fresh = crack([0.0, 0.0], [1.0, 0.0]);
        let open = |seconds: u64| fresh.openness(Instant::from_millis(seconds * 1000), Some(100.0));
        assert_eq!([open(0), open(25), open(100), open(999)], [1.0, 0.5, 0.0, 0.0]);
        assert_eq!(fresh.openness(Instant::from_millis(1_000_000), None), 1.0);
    }
}
