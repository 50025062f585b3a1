//! Distinguishes an object from a foot: an object keeps still.

use std::time::Duration;

use glam::Vec2;

use crate::units::Instant;

/// Time without motion after which a contact is an object (fault S10).
const OBJECT_AFTER: Duration = Duration::from_secs(60);

/// Maximum change of an object's force, in newtons and as a share of it: sensor noise, and the creep of a
/// force-sensing resistor over a decade of time (Interlink, FSR integration guide). A standing foot exceeds this
/// within seconds.
const FORCE_N: f32 = 3.0;
const FORCE_SHARE: f32 = 0.05;

/// Maximum change of an object's place, in metres (our choice: less than the sway of quiet standing in a minute).
const PLACE_M: f32 = 0.005;

/// Change of an object's force, as a share, and of its place, in metres, after which it may be a foot again.
const MOVED_SHARE: f32 = 0.2;
const MOVED_M: f32 = 0.03;

/// Time constant τ of the smoothing against sensor noise, in seconds: `y += dt / τ * (x - y)`, the factor at most 1.
const SMOOTH_S: f32 = 0.2;

/// Detects a contact that does not move for a minute.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stillness {
    last: Instant,
    force: f32,
    place: Vec2,
    /// Force and place at the last motion, and its time.
    anchor: (f32, Vec2),
    since: Instant,
    object: bool,
}

impl Stillness {
    pub(super) fn new(force: f32, place: Vec2, now: Instant) -> Self {
        Self { last: now, force, place, anchor: (force, place), since: now, object: false }
    }

    /// Updates the state with the present contact.
    pub(super) fn update(&mut self, force: f32, place: Vec2, now: Instant) {
        let weight = (now.since(self.last).as_secs_f32() / SMOOTH_S).min(1.0);
        self.last = now;
        self.force += weight * (force - self.force);
        self.place += weight * (place - self.place);
        let (anchor_force, anchor_place) = self.anchor;
        let off = (self.force - anchor_force).abs();
        let moved = self.place.distance(anchor_place);
        if self.object {
            self.object = off <= FORCE_N.max(MOVED_SHARE * anchor_force) && moved <= MOVED_M;
        } else if off > FORCE_N.max(FORCE_SHARE * anchor_force) || moved > PLACE_M {
            self.anchor = (self.force, self.place);
            self.since = now;
        } else if now.since(self.since) >= OBJECT_AFTER {
            self.object = true;
        }
    }

    /// Whether it is an object left on the floor.
    pub(super) fn is_object(&self) -> bool {
        self.object
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The second in which a contact becomes an object; `force` gives its force at a time in seconds.
    fn object_after(force: impl Fn(f32) -> f32) -> Option<u32> {
        let mut still = Stillness::new(force(0.0), Vec2::ONE, Instant::START);
        (0..18_000).find_map(|step: u32| {
            let time = step as f32 * 0.01;
            still.update(force(time), Vec2::ONE, Instant::from_millis(u64::from(step) * 10));
            still.is_object().then_some(step / 100)
        })
    }

    #[test]
    fn a_chair_leg_is_an_object_after_a_minute_also_while_its_sensors_creep() {
        assert_eq!(object_after(|_| 150.0), Some(60));
        let creeping = object_after(|s| 150.0 * (1.0 + 0.05 * s.max(0.1).log10()));
        assert!(creeping.is_some_and(|seconds| seconds < 90), "{creeping:?}");
    }

    #[test]
    fn somebody_who_stands_never_is() {
        // The slow waves of quiet standing, a few hundredths of the load on a foot.
        let wave = |s: f32, hertz: f32| (std::f32::consts::TAU * hertz * s).sin();
        let sway = |s: f32| 0.04 * (wave(s, 0.13) + 0.6 * wave(s, 0.31) + 0.3 * wave(s, 0.71));
        assert_eq!(object_after(|s| 350.0 * (1.0 + sway(s))), None);
    }

    #[test]
    fn an_object_that_is_stepped_on_may_be_a_foot_again() {
        let mut still = Stillness::new(100.0, Vec2::ONE, Instant::START);
        let mut now = Instant::START;
        for (force, seconds, object) in [(100.0, 61, true), (103.0, 5, true), (300.0, 2, false)] {
            for _ in 0..seconds * 100 {
                now = now + Duration::from_millis(10);
                still.update(force, Vec2::ONE, now);
            }
            assert_eq!(still.is_object(), object, "{force} N");
        }
    }
}
