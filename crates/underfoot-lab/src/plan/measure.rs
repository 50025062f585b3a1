//! Measures a computer's constants on this computer.

use std::thread;
use std::time::{Duration, Instant};

use super::Machine;
use super::round::{Floors, Round};
use super::work_time::busy;
use crate::capacity::{AssemblyLoad, RenderLoad, RenderWork};
use underfoot::source::SourceError;

/// Number of loads that [`measure`] runs, one after the other.
pub const LOADS: u64 = 6 * ROUNDS as u64 + 3;

/// Number of repetitions of the real-time loads: the cost of a wake-up depends on the core that the system chooses
/// for the thread. With repetitions of a tenth of a second, three runs agreed within 10 %; with a single one, within
/// 40 %.
const ROUNDS: u32 = 10;

/// Maximum number of channels that ALSA opens on a card.
const CHANNELS: u32 = 64;

/// Bandwidth of an ordinary network card (Mb/s).
const LINK_MBIT: f64 = 1000.0;

/// Side of the floor whose tiles are assembled: as large as the sensed part of an area.
const SIDE: u16 = 24;

/// Number of channels in the rendering loads.
const RENDERED: f64 = 36.0;

/// Measures this computer, each of its loads for `length`; calls `advance` [`LOADS`] times, once after each load.
///
/// # Errors
/// [`SourceError`] if this machine can't send packets to itself.
pub fn measure(length: Duration, advance: impl Fn()) -> Result<Machine, SourceError> {
    let (mut floors, mut rounds) = (Floors::new()?, Vec::new());
    for _ in 0..ROUNDS {
        rounds.push(Round::measure(&mut floors, length / ROUNDS, &advance)?);
    }
    let of = |load: fn(&Round) -> f64| median(rounds.iter().map(load).collect());
    let paced = Round {
        received: of(|round| round.received),
        forwarded: of(|round| round.forwarded),
        small: of(|round| round.small),
        twice: of(|round| round.twice),
        empty: of(|round| round.empty),
        crowd: of(|round| round.crowd),
    };
    let millisecond = |load: &mut dyn FnMut()| {
        let us = millisecond_us(length, load);
        advance();
        us
    };
    let mut assembly = AssemblyLoad::new(SIDE);
    let assemble_us = millisecond(&mut || _ = assembly.second());
    let [silent_us, active_us] =
        [RenderWork::of_modes(0), RenderWork::with_friction_and_limiter()].map(|work| {
            let mut load = RenderLoad::new(work);
            millisecond(&mut || load.second())
        });
    let assemble_tile_us = assemble_us / f64::from(SIDE).powi(2);
    // On a machine that is busy with other work, a difference may be negative.
    Ok(Machine {
        cores: thread::available_parallelism().map_or(1, |cores| cores.get().min(1024) as u32),
        base_us: paced.base_us().max(0.0),
        packet_us: paced.packet_us().max(0.0),
        forward_us: paced.forward_us().max(0.0),
        wake_us: paced.wake_us().max(0.0),
        assemble_tile_us,
        sense_tile_us: (paced.tile_us() - assemble_tile_us).max(0.0),
        person_us: paced.person_us().max(0.0),
        channel_us: silent_us / RENDERED,
        active_channel_us: ((active_us - silent_us) / RENDERED).max(0.0),
        channels: CHANNELS,
        link_mbit: LINK_MBIT,
    })
}

/// Microseconds of work per millisecond of a floor; one call of `second` runs one second of it. Returns the median of
/// the calls that fit into `length`, at least three.
fn millisecond_us(length: Duration, second: &mut dyn FnMut()) -> f64 {
    // The first call warms up tables, caches and the processor's clock.
    second();
    let mut all = Vec::new();
    let begun = Instant::now();
    while all.len() < 3 || begun.elapsed() < length {
        let start = busy();
        second();
        all.push(1e3 * (busy() - start).as_secs_f64());
    }
    median(all)
}

fn median(mut all: Vec<f64>) -> f64 {
    all.sort_unstable_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn this_computer_can_be_measured() {
        let done = std::cell::Cell::new(0);
        let machine = measure(Duration::from_millis(1), || done.set(done.get() + 1)).unwrap();
        machine.check().unwrap();
        assert_eq!(done.get(), LOADS);
        assert!(machine.packet_us > 0.0 && machine.assemble_tile_us > 0.0 && machine.channel_us > 0.0);
    }
}
