//! A script in a loop.

use std::time::Duration;

use super::{Foot, FootDriver, Script};
use underfoot::units::Instant;

/// A script in a loop, with an empty floor between repetitions.
///
/// Meant for a window, which stays open after the last step.
#[derive(Debug)]
pub struct LoopingScript {
    script: Script,
    pause: Duration,
}

impl LoopingScript {
    /// Plays `script` repeatedly; the floor stays empty for `pause` before each repetition.
    #[must_use]
    pub fn new(script: Script, pause: Duration) -> Self {
        Self { script, pause }
    }
}

impl FootDriver for LoopingScript {
    fn feet(&mut self, at: Instant, feet: &mut Vec<Foot>) -> bool {
        feet.clear();
        let round = (self.script.duration() + self.pause).as_micros() as u64;
        let within = at.since(Instant::START).as_micros() as u64 % round.max(1);
        // During the pause the script is over and leaves `feet` empty.
        self.script.feet(Instant::from_micros(within), feet);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scenario;
    use underfoot::floor::Geometry;
    use underfoot::schema::{Kinds, builtin_layout, parse_layout};

    #[test]
    fn the_same_feet_come_back_after_an_empty_floor() {
        let (geometry, pond) = (Geometry::default(), builtin_layout("pond").unwrap());
        let pond = parse_layout(pond, "pond", &Kinds::builtin(), &geometry).unwrap().layout;
        let stroll = Scenario::parse("stroll", Scenario::STROLL).unwrap();
        let script = stroll.resolve(&pond, &geometry).unwrap();
        let (length, pause) = (script.duration(), Duration::from_secs(2));
        let middle = Duration::from_secs(length.as_secs() / 2);
        let mut looping = LoopingScript::new(script, pause);
        let mut feet_at = |at: Duration| {
            let mut feet = Vec::new();
            assert!(looping.feet(Instant::START + at, &mut feet), "it never ends");
            feet
        };
        let once = feet_at(middle);
        assert!(!once.is_empty());
        assert!(feet_at(length + pause / 2).is_empty());
        let again = feet_at(length + pause + middle);
        // Repetitions are whole microseconds long, so a foot's position repeats within a hundredth of a millimetre.
        assert_eq!(again.len(), once.len());
        let near = |(one, two): (&Foot, &Foot)| one.position.distance(two.position) < 1e-5;
        assert!(once.iter().zip(&again).all(near), "{once:?} {again:?}");
    }
}
