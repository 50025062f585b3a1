//! Where the other foot of the same person may be coming down.
//!
//! Weight that goes over to a partner draws the common centre of pressure along.
//! So does a foot that rolls, only elsewhere: ahead, not towards the partner that
//! it was lifted from, and not out over the side of its own sole.

use glam::DVec2;

use super::foot::Foot;

/// Cosine of how far a way may be from the one it is compared with.
const TOWARDS: f64 = 0.7;

/// Sine of how far from its own direction a way at least leads out over a foot's side: a foot that pushes off turns
/// over its big toe, as far to the side as to the front.
const ACROSS: f64 = 0.87;

/// Sine of how far to its side a partner must have been lifted for that side to be known.
const BEHIND: f64 = 0.15;

/// How long after landing a foot without a partner may still roll on the way it has rolled, in seconds.
const ROLLED_S: f64 = 0.5;

/// How long a partner must not have been seen to be lifted, in seconds.
const LIFTED_S: f64 = 0.005;

/// How far its centre of pressure must have gone while it came down for a foot to be known to point there, in metres.
const ROLLED_M: f64 = 0.03;

/// Largest distance between the feet of somebody who stands with one beside the other, in metres.
const STANDS_BESIDE_M: f64 = 0.25;

impl Foot {
    /// Whether the last of the weight of a companion that stood beside it may still be going over: what that moves is no
    /// roll of its own.
    pub(super) fn is_being_left(&self) -> bool {
        self.calm > 0.0
            && self.partner.is_some_and(|(place, _)| place.distance(self.centre()) < STANDS_BESIDE_M)
    }

    /// Whether the other foot of its person may be landing on the side that `way` points to: not while
    /// that foot is elsewhere, and not ahead of a foot that rolls: after that one has left, or when none was down before.
    pub(super) fn may_have_partner_towards(&self, way: DVec2) -> bool {
        match self.partner {
            Some((place, ago)) => {
                let side = place - self.home;
                ago > LIFTED_S && way.dot(side) > 0.5 * way.length() * side.length()
            }
            None => {
                way.dot(self.rolled) <= TOWARDS * way.length() * self.rolled.length() || self.age > ROLLED_S
            }
        }
    }

    /// Whether its centre of pressure cannot have gone along `way` from its home by itself: towards where its partner
    /// was lifted, or `least` metres and more out over the side of its sole that the partner is on.
    pub(super) fn is_drawn(&self, way: DVec2, least: f64) -> bool {
        let Some((partner, ago)) = self.partner else { return false };
        let (side, axis) = (partner - self.home, self.rolled);
        let towards = way.dot(side) > TOWARDS * way.length() * side.length();
        let across = axis.perp_dot(side);
        // One that is straight behind may have been lifted from either side.
        let told = across.abs() > BEHIND * axis.length() * side.length();
        let aside = if told { axis.perp_dot(way) * across.signum() } else { axis.perp_dot(way).abs() };
        let over = aside > axis.length() * least.max(ACROSS * way.length());
        ago > LIFTED_S && (towards || over && axis.length() > ROLLED_M)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sense::contact::ContactId;

    /// A foot that came down rolling north, its partner lifted from `partner` a moment ago.
    fn foot(partner: DVec2) -> Foot {
        let mut foot = Foot::new(ContactId(1), 700.0, DVec2::ZERO, 0.01);
        foot.rolled = DVec2::new(0.01, 0.1);
        foot.partner = Some((partner, 0.4));
        foot
    }

    #[test]
    fn a_foot_is_drawn_to_its_partner_and_rolls_elsewhere() {
        let beside = foot(DVec2::new(0.18, 0.02));
        assert!(beside.is_drawn(DVec2::new(0.04, 0.0), 0.035), "the partner comes down where it was");
        assert!(!beside.is_drawn(DVec2::new(0.0, 0.06), 0.035), "it pushes off");
        assert!(!beside.is_drawn(DVec2::new(-0.04, 0.0), 0.035), "nobody is over there");
    }

    #[test]
    fn a_partner_straight_behind_may_come_down_on_either_side() {
        let walker = foot(DVec2::new(-0.08, -0.7));
        assert!(
            walker.is_drawn(DVec2::new(0.04, 0.0), 0.035) && walker.is_drawn(DVec2::new(-0.04, 0.0), 0.035)
        );
        assert!(!walker.is_drawn(DVec2::new(0.0, 0.06), 0.035), "it pushes off");
    }

    #[test]
    fn the_first_foot_on_the_floor_rolls_on_for_a_moment() {
        let first = Foot { partner: None, age: 0.35, ..foot(DVec2::ZERO) };
        assert!(!first.may_have_partner_towards(DVec2::new(0.0, 0.04)), "it rolls on the way it has rolled");
        assert!(first.may_have_partner_towards(DVec2::new(0.04, 0.0)), "not to the side");
        let later = Foot { age: 1.0, ..first };
        assert!(later.may_have_partner_towards(DVec2::new(0.0, 0.04)), "it has come down flat long ago");
    }

    #[test]
    fn a_partner_left_behind_comes_down_beside() {
        let behind = foot(DVec2::new(0.12, -0.6));
        assert!(behind.is_drawn(DVec2::new(0.04, 0.0), 0.035), "no foot presses beside its sole");
        assert!(!behind.is_drawn(DVec2::new(0.03, 0.03), 0.035), "it turns over its big toe");
        assert!(!behind.is_drawn(DVec2::new(-0.04, 0.0), 0.035), "the partner is on the other side");
        let here = Foot { partner: Some((DVec2::new(0.12, -0.6), 0.0)), ..behind };
        assert!(!here.is_drawn(DVec2::new(0.04, 0.0), 0.035), "the partner is still down");
    }
}
