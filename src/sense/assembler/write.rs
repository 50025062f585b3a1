//! Writes the readings of windows into frames: tared forces and their qualities.

// The loops over lanes stay plain indexed loops, which the compiler vectorises.
#![allow(clippy::needless_range_loop)]

use multiversion::multiversion;

use super::sample::BoardSample;
use super::window::{NARROW, Read, SensorWindow, WIDE};
use crate::sense::health::{Health, LOUD_N, Lanes, RangeEnd};
use crate::sense::{ForceFrame, Quality};

/// Above the load of any corner of a tile (N): 70 people of 70 kg on one corner (our choice).
const MOST_N: f32 = 50_000.0;

/// Reliability of a packet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trust {
    pub quality: Quality,
    /// Whether it may belong to another board.
    pub is_swapped: bool,
    /// Whether the floor may be a different one.
    pub is_foreign: bool,
}

/// Findings about the readings written.
struct Found<const LANES: usize> {
    /// Number of invalid readings.
    bad: u32,
    /// Whether the newtons of any sensor were used.
    is_used: bool,
    /// Whether any sensor requires an examination of its tile, and the sensors that do.
    is_any_loud: bool,
    loud: [bool; LANES],
}

impl<const LANES: usize> Found<LANES> {
    /// Readings of unloaded sensors.
    const QUIET: Self = Self { bad: 0, is_used: true, is_any_loud: false, loud: [false; LANES] };
}

impl<const LANES: usize> SensorWindow<LANES> {
    /// Converts a sample and writes the result.
    #[inline(always)]
    fn take(&self, sample: &BoardSample, trust: Trust, into: &mut Lanes<'_, LANES>) -> Found<LANES> {
        let read = self.read(sample);
        if self.write_quiet(&read, trust, into) { Found::QUIET } else { self.write(&read, trust, into) }
    }

    /// Writes the readings of unloaded sensors, as on most of a floor, where one result applies to all lanes. Returns
    /// false if the lanes differ.
    #[inline(always)]
    fn write_quiet(&self, read: &Read<LANES>, trust: Trust, into: &mut Lanes<'_, LANES>) -> bool {
        let mut forces = [0.0; LANES];
        let mut is_quiet = self.is_uniform & !trust.is_swapped;
        for lane in 0..LANES {
            forces[lane] = read.forces[lane] - self.tares[lane] - into.offsets[lane];
            // The comparison is false for NaN.
            is_quiet &= forces[lane].abs() <= LOUD_N;
        }
        for lane in 0..LANES {
            let end = read.ends[lane] as u8;
            is_quiet &= (end != RangeEnd::Low as u8) & (end != RangeEnd::High as u8);
        }
        if !is_quiet {
            return false;
        }
        let is_nominal = self.is_nominal(0) & !read.by_board;
        let own = if is_nominal | trust.is_foreign { Quality::Degraded } else { Quality::Live };
        (*into.forces, *into.ends, *into.raws) = (forces, read.ends, read.raws);
        *into.quality = [own.max(trust.quality); LANES];
        *into.news = [true; LANES];
        if is_nominal {
            *into.guessed = [true; LANES];
        }
        true
    }

    /// Writes tared forces and their qualities.
    #[inline(always)]
    fn write(&self, read: &Read<LANES>, trust: Trust, into: &mut Lanes<'_, LANES>) -> Found<LANES> {
        // All lists are read before any is written, so that the compiler need not assume aliasing.
        let (offsets, mut forces) = (*into.offsets, *into.forces);
        let (mut quality, mut ends, mut guessed, mut news) =
            (*into.quality, *into.ends, *into.guessed, *into.news);
        let (mut is_force, mut is_used) = ([false; LANES], [false; LANES]);
        let mut loud = [false; LANES];
        for lane in 0..LANES {
            let force = read.forces[lane] - self.tares[lane] - offsets[lane];
            // The comparison is false for NaN.
            is_force[lane] = force.abs() <= MOST_N;
            is_used[lane] = is_force[lane] & self.is_wired(lane) & !trust.is_swapped;
            loud[lane] = is_used[lane] & (force.abs() > LOUD_N);
            forces[lane] = if is_used[lane] { force } else { forces[lane] };
        }
        // One loop for each list: a loop that does more is not vectorised.
        for lane in 0..LANES {
            ends[lane] = if is_used[lane] { read.ends[lane] } else { ends[lane] };
        }
        let mut raws = *into.raws;
        for lane in 0..LANES {
            raws[lane] = if is_used[lane] { read.raws[lane] } else { raws[lane] };
        }
        let mut is_high = [false; LANES];
        for lane in 0..LANES {
            is_high[lane] = read.ends[lane] as u8 == RangeEnd::High as u8;
        }
        for lane in 0..LANES {
            let is_low = read.ends[lane] as u8 == RangeEnd::Low as u8;
            loud[lane] |= is_used[lane] & (is_low | is_high[lane]);
        }
        let mut is_nominal = [false; LANES];
        for lane in 0..LANES {
            is_nominal[lane] = self.is_nominal(lane) & !read.by_board;
        }
        for lane in 0..LANES {
            guessed[lane] |= is_used[lane] & is_nominal[lane];
        }
        for lane in 0..LANES {
            news[lane] |= is_used[lane];
        }
        let [degraded, live] = [Quality::Degraded, Quality::Live].map(|own| own.max(trust.quality));
        let faulty = Quality::Faulty.max(trust.quality);
        for lane in 0..LANES {
            let is_uncertain = is_high[lane] | is_nominal[lane] | trust.is_foreign;
            let own = if is_uncertain { degraded } else { live };
            let own = if is_used[lane] { own } else { faulty };
            quality[lane] = if self.is_wired(lane) { own } else { quality[lane] };
        }
        let mut found = Found { bad: 0, is_used: false, is_any_loud: false, loud };
        for lane in 0..LANES {
            found.bad += u32::from(self.is_wired(lane) & !is_force[lane]);
            found.is_used |= is_used[lane];
            found.is_any_loud |= loud[lane];
        }
        (*into.forces, *into.quality, *into.ends, *into.raws) = (forces, quality, ends, raws);
        (*into.guessed, *into.news) = (guessed, news);
        found
    }
}

/// Writes the readings of a wide window into `frame`; returns the number of invalid readings.
pub(super) fn put_wide(
    window: &SensorWindow<WIDE>,
    sample: &BoardSample,
    trust: Trust,
    frame: &mut ForceFrame,
    health: &mut Health,
) -> u64 {
    let Some(mut lanes) = health.lanes(window.first, frame) else { return 0 };
    note(window.first, &write_wide(window, sample, trust, &mut lanes), sample, health)
}

/// The same for a narrow window.
pub(super) fn put_narrow(
    window: &SensorWindow<NARROW>,
    sample: &BoardSample,
    trust: Trust,
    frame: &mut ForceFrame,
    health: &mut Health,
) -> u64 {
    let Some(mut lanes) = health.lanes(window.first, frame) else { return 0 };
    note(window.first, &window.take(sample, trust, &mut lanes), sample, health)
}

fn note<const LANES: usize>(
    first: usize,
    found: &Found<LANES>,
    sample: &BoardSample,
    health: &mut Health,
) -> u64 {
    if found.is_used && matches!(sample, BoardSample::Newtons(_)) {
        health.note_newtons();
    }
    if found.is_any_loud {
        let loud = (first..).zip(&found.loud).filter(|(_, loud)| **loud);
        loud.for_each(|(sensor, _)| health.note_loud(sensor));
    }
    found.bad.into()
}

/// Plain arrays and one branch for all lanes, compiled for each vector instruction set.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512bw+avx512dq", "x86_64+avx2", "aarch64+neon"))]
fn write_wide<'a>(
    window: &SensorWindow<WIDE>,
    sample: &BoardSample,
    trust: Trust,
    into: &mut Lanes<'a, WIDE>,
) -> Found<WIDE> {
    window.take(sample, trust, into)
}
