//! How far the forces of a contact are to be believed.

use crate::sense::{Contact, ForceFrame, HoldDoubt, Quality, TileLoad};
use crate::units::Newtons;
use crate::widget::{Guard, Thresholds};

/// Whether a control with this `guard` takes `contact` for something else than a foot, whatever its sensors say.
fn is_doubtful_foot(contact: &Contact, guard: Guard) -> bool {
    contact.split && guard != Guard::Free
}

/// How much of the force of `contact` would be left if a sensor erred that is suspected to.
///
/// `Degraded` tiles count: one with a dead sensor, whose force the other three tell, and one that loses packets. A tile
/// with a saturated sensor, or one that reads what its plate does not bear, is suspected; see
/// [`ForceFrame::may_start`]. Of what runs while it is held, so is one whose readings may not hold it; see
/// [`ForceFrame::hold_doubts`]. A shoe that laps over onto a tile, or a foot over the meeting of tiles, presses there at
/// one sensor alone, as an erring sensor reads: one of these tiles is taken for wrong, and all of them where what runs
/// while it is held depends on it.
fn certain_force(contact: &Contact, guard: Guard, frame: &ForceFrame) -> Newtons {
    let forces = suspected(contact, guard, frame).map(|load| load.force.0);
    let wrong: f32 = match guard {
        Guard::HoldToRun { .. } => forces.sum(),
        Guard::Free | Guard::Confirm { .. } => forces.fold(0.0, f32::max),
    };
    contact.force - Newtons(wrong)
}

/// The tiles under `contact` at which a sensor is suspected.
fn suspected<'a>(
    contact: &'a Contact,
    guard: Guard,
    frame: &'a ForceFrame,
) -> impl Iterator<Item = &'a TileLoad> {
    let runs = matches!(guard, Guard::HoldToRun { .. });
    let may_hold = move |index: usize| !runs || frame.hold_doubts.get(index).is_none_or(Option::is_none);
    let may_start = |index: usize| frame.may_start.get(index) == Some(&true);
    contact.tiles.iter().filter(move |load| !may_start(load.index) || !may_hold(load.index))
}

/// Whether `contact` is a foot, and no sensor under it is suspected.
pub(super) fn is_certain(contact: &Contact, guard: Guard, frame: &ForceFrame) -> bool {
    !is_doubtful_foot(contact, guard) && suspected(contact, guard, frame).next().is_none()
}

/// Whether the noise of the sensors under `contact` is all that is not known of them: it soon will be.
pub(super) fn is_unlearned(contact: &Contact, frame: &ForceFrame) -> bool {
    contact.tiles.iter().any(|load| frame.hold_doubts.get(load.index) == Some(&Some(HoldDoubt::Unlearned)))
}

/// Whether `contact` is a foot whatever a suspected sensor reads: most of its force would be left without it.
pub(super) fn is_believed(contact: &Contact, guard: Guard, frame: &ForceFrame) -> bool {
    !is_doubtful_foot(contact, guard) && certain_force(contact, guard, frame) * 2.0 >= contact.force
}

/// Whether a foot of this force may press: without a suspected sensor it would still keep the control pressed, and
/// press one that runs while it is held.
pub(super) fn certainly_presses(contact: &Contact, at: &Thresholds, frame: &ForceFrame) -> bool {
    let least = if matches!(at.guard, Guard::HoldToRun { .. }) { at.press } else { at.release };
    certain_force(contact, at.guard, frame) >= least
}

/// A tile goes on with three sensors.
pub(super) fn is_sensed(tile: &[Quality; 4]) -> bool {
    tile.iter().filter(|quality| **quality < Quality::Stale).count() >= 3
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::floor::Geometry;
    use crate::widget::HoldToRun;

    /// A contact that presses with so much on the first tiles of a floor of which those `suspected` may not start.
    fn pressed(loads: &[f32], suspected: &[usize]) -> (Contact, ForceFrame) {
        let mut frame = ForceFrame::empty(&Geometry::default());
        suspected.iter().for_each(|&tile| frame.may_start[tile] = false);
        let mut contact = Contact { force: Newtons(loads.iter().sum()), ..Contact::default() };
        let tile = |(index, &force)| TileLoad { index, force: Newtons(force), ..TileLoad::default() };
        contact.tiles.extend(loads.iter().enumerate().map(tile));
        (contact, frame)
    }

    #[test]
    fn a_shoe_that_laps_over_onto_a_tile_is_believed_as_far_as_the_other_carries_it() {
        let run = Guard::HoldToRun(HoldToRun { max: Duration::from_secs(9), warn: None });
        for guard in [Guard::Free, run] {
            let (contact, frame) = pressed(&[130.0, 12.0], &[1]);
            assert_eq!(certain_force(&contact, guard, &frame), Newtons(130.0));
            assert!(is_believed(&contact, guard, &frame));
            let (contact, frame) = pressed(&[12.0, 130.0], &[1]);
            assert!(!is_believed(&contact, guard, &frame), "a sensor that reads what is not there");
            let (contact, frame) = pressed(&[130.0], &[0]);
            assert_eq!(certain_force(&contact, guard, &frame), Newtons::ZERO);
        }
    }

    #[test]
    fn what_is_left_without_a_suspected_sensor_keeps_a_button_and_presses_what_runs() {
        let run = Guard::HoldToRun(HoldToRun { max: Duration::from_secs(9), warn: None });
        for (guard, [some, enough]) in [(Guard::Free, [35.0, 45.0]), (run, [55.0, 65.0])] {
            let at = Thresholds { guard, ..Thresholds::new(Newtons(60.0), Newtons(40.0)) };
            for (loads, presses) in [([some, 30.0], false), ([enough, 30.0], true)] {
                let (contact, frame) = pressed(&loads, &[1]);
                assert_eq!(certainly_presses(&contact, &at, &frame), presses, "{guard:?} {loads:?}");
            }
        }
    }

    #[test]
    fn sensors_of_several_tiles_do_not_err_at_once_unless_something_runs_by_them() {
        let (contact, frame) = pressed(&[40.0, 35.0, 30.0, 35.0], &[0, 1, 2, 3]);
        assert_eq!(certain_force(&contact, Guard::Free, &frame), Newtons(100.0));
        let run = Guard::HoldToRun(HoldToRun { max: Duration::from_secs(9), warn: None });
        assert!(!is_believed(&contact, run, &frame));
    }
}
