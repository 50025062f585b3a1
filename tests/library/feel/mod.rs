//! The haptics of the floor, measured from rendered samples.

mod ahap;
mod answers;
mod click;
mod effects;
mod friction;
mod loudspeakers;
mod rack;
mod safety;
mod wav;

use underfoot::feel::{Click, Cue, Spot};
use underfoot::units::Instant;

/// One click on one tile.
fn strike(at: Instant, tile: u16, click: Click) -> Cue {
    let spots = [Spot { tile, weight: 1.0 }].into_iter().collect();
    Cue { at, received: at, spots, click, ..Cue::default() }
}
