//! How far the forces of a contact are reliable.

use crate::sense::{Contact, ForceFrame, HoldDoubt, Quality, TileLoad};
use crate::units::Newtons;
use crate::widget::{Guard, Thresholds};

/// Whether `contact` may not be a foot for a control with this `guard`, whatever its sensors read.
fn is_doubtful_foot(contact: &Contact, guard: Guard) -> bool {
    contact.split && guard != Guard::Free
}

/// Force of `contact` that remains if a suspected sensor is wrong.
///
/// `Degraded` tiles count in full: a tile with a dead sensor, its force estimated from the other three, and a tile
/// that loses packets. A tile is suspected if it has a saturated sensor, or reads a load that its plate does not
/// carry; see [`ForceFrame::may_start`]. For controls that run while they are held, a tile with unsuitable readings
/// is suspected too; see [`ForceFrame::hold_doubts`]. A shoe that overlaps a tile, or a foot across the joint of
/// tiles, loads a single sensor there, as a faulty sensor reads: for most controls the heaviest suspected tile counts
/// as wrong, for those that run while they are held all of them.
fn certain_force(contact: &Contact, guard: Guard, frame: &ForceFrame) -> Newtons {
    let forces = suspected(contact, guard, frame).map(|load| load.force.0);
    let wrong: f32 = match guard {
        Guard::HoldToRun { .. } => forces.sum(),
        Guard::Free | Guard::Confirm { .. } => forces.fold(0.0, f32::max),
    };
    contact.force - Newtons(wrong)
}

/// The tiles under `contact` with a suspected sensor.
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

/// Whether `contact` is a foot, without a suspected sensor under it.
pub(super) fn is_certain(contact: &Contact, guard: Guard, frame: &ForceFrame) -> bool {
    !is_doubtful_foot(contact, guard) && suspected(contact, guard, frame).next().is_none()
}

/// Whether the noise of a sensor under `contact` is not yet estimated; the estimate comes soon.
pub(super) fn is_unlearned(contact: &Contact, frame: &ForceFrame) -> bool {
    contact.tiles.iter().any(|load| frame.hold_doubts.get(load.index) == Some(&Some(HoldDoubt::Unlearned)))
}

/// Whether `contact` is a foot even if a suspected sensor is wrong: at least half of its force remains.
pub(super) fn is_believed(contact: &Contact, guard: Guard, frame: &ForceFrame) -> bool {
    !is_doubtful_foot(contact, guard) && certain_force(contact, guard, frame) * 2.0 >= contact.force
}

/// Whether a foot of this force may press: without the suspected sensors its force reaches the release threshold, or
/// the press threshold of a control that runs while it is held.
pub(super) fn certainly_presses(contact: &Contact, at: &Thresholds, frame: &ForceFrame) -> bool {
    let least = if matches!(at.guard, Guard::HoldToRun { .. }) { at.press } else { at.release };
    certain_force(contact, at.guard, frame) >= least
}

/// Whether a tile is sensed: three sensors are enough.
pub(super) fn is_sensed(tile: &[Quality; 4]) -> bool {
    tile.iter().filter(|quality| **quality < Quality::Stale).count() >= 3
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::floor::Geometry;
    use crate::widget::HoldToRun;

    /// A contact with these loads on the first tiles of a floor; the tiles `suspected` may not start a press.
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
    fn a_contact_that_was_split_off_another_presses_no_guarded_control() {
        let run = Guard::HoldToRun(HoldToRun { max: Duration::from_secs(9), warn: None });
        for (guard, is_pressed) in [(Guard::Free, true), (run, false)] {
            let (contact, frame) = pressed(&[130.0], &[]);
            assert!(is_believed(&contact, guard, &frame) && is_certain(&contact, guard, &frame));
            let contact = Contact { split: true, ambiguous: true, ..contact };
            assert_eq!(is_believed(&contact, guard, &frame), is_pressed, "{guard:?}");
            assert_eq!(is_certain(&contact, guard, &frame), is_pressed, "{guard:?}");
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
