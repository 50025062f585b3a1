//! A simulated person on all marks in turn.

use std::time::Duration;

use underfoot::floor::Floor;
use underfoot::sense::{StandData, StandingMark};
use underfoot::serve::{StandTask, StandWalk};
use underfoot::units::Instant;
use underfoot::wire::SensorPacket;
use underfoot_sim::{Person, Script, SimFloor, StandingHabit, standing_on};

use super::MASS_KG;
use crate::experiment::ExperimentError;

/// Number of marks on each tile in one round.
const ROUND: usize = 5;

/// The stands on the first `marks` marks of each tile, with the ways between stands that follow each other.
pub(super) fn first_marks(data: &StandData, marks: usize) -> StandData {
    let mut kept = StandData { empty: data.empty.clone(), ..StandData::default() };
    for (number, stand) in data.stands.iter().enumerate() {
        let earlier = data.stands[..number].iter().filter(|other| other.mark.tile == stand.mark.tile);
        if earlier.count() < marks {
            kept.stands.push(stand.clone());
        }
    }
    if marks >= ROUND {
        let share = kept.stands.len() * data.crossings.len() / data.stands.len().max(1);
        kept.crossings.extend(data.crossings.iter().take(share).cloned());
    }
    kept
}

/// The measurements of a person on all marks, twice, and the time that it takes.
pub(super) fn stood(
    wired: &Floor,
    sim: &mut SimFloor,
    seed: u64,
) -> Result<(StandData, Duration), ExperimentError> {
    let tiles = StandingMark::walk(&wired.geometry);
    let marks = StandingMark::of_tiles(&wired.geometry, &tiles, 2);
    let person = Person { mass_kg: MASS_KG, stand_width_m: 0.12, ..Person::default() };
    let performance = standing_on(&marks, person, StandingHabit::default(), seed)?;
    let script = Script::new(vec![performance], wired.geometry.bounds());
    let mut walk = StandWalk::new(wired, marks);
    let (mut sequence, mut loads) = (0_u32, Vec::new());
    let end = script.duration();
    while walk.task() != StandTask::Nothing && Duration::from_millis(sequence.into()) < end {
        let received = Instant::from_millis(sequence.into());
        loads.clear();
        script.loads_at(received, &mut loads);
        for (board, readings) in (0..).zip(sim.step_under(loads.iter().copied())) {
            walk.take(&SensorPacket { board, sequence, received, readings: readings.clone() });
        }
        sequence += 1;
    }
    Ok((walk.data().clone(), Duration::from_millis(sequence.into())))
}
