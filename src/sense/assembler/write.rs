//! What windows have read, into frames: tared forces and how far they can be trusted.

// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

use multiversion::multiversion;

use super::sample::Sample;
use super::window::{NARROW, Read, WIDE, Window};
use crate::sense::health::{End, Health, LOUD_N, Lanes};
use crate::sense::{ForceFrame, Quality};

/// More than any corner of a tile can carry, in newtons: 70 people of 70 kg on one corner. Chosen by us.
const MOST_N: f32 = 50_000.0;

/// How far a packet can be believed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trust {
    pub quality: Quality,
    /// Whether it may be another board's.
    pub is_swapped: bool,
    /// Whether the floor may be another one.
    pub is_foreign: bool,
}

/// What was found while it was written.
struct Found<const LANES: usize> {
    /// Number of readings that were no forces.
    bad: u32,
    /// Whether any sensor's newtons were used.
    is_used: bool,
    /// Whether any sensor asks for its tile to be examined, and which.
    is_any_loud: bool,
    loud: [bool; LANES],
}

impl<const LANES: usize> Found<LANES> {
    /// Readings of sensors on which nothing rests.
    const QUIET: Self = Self { bad: 0, is_used: true, is_any_loud: false, loud: [false; LANES] };
}

impl<const LANES: usize> Window<LANES> {
    /// Reads a sample and writes what it says.
    #[inline(always)]
    fn take(&self, sample: &Sample, trust: Trust, into: &mut Lanes<'_, LANES>) -> Found<LANES> {
        let read = self.read(sample);
        if self.write_quiet(&read, trust, into) { Found::QUIET } else { self.write(&read, trust, into) }
    }

    /// Writes what sensors read on which nothing rests, as on most of a floor: what holds for one then holds for all.
    /// False if they do not.
    #[inline(always)]
    fn write_quiet(&self, read: &Read<LANES>, trust: Trust, into: &mut Lanes<'_, LANES>) -> bool {
        let mut forces = [0.0; LANES];
        let mut is_quiet = self.is_uniform & !trust.is_swapped;
        for lane in 0..LANES {
            forces[lane] = read.forces[lane] - self.tares[lane] - into.offsets[lane];
            // NaN is at most nothing.
            is_quiet &= forces[lane].abs() <= LOUD_N;
        }
        for lane in 0..LANES {
            let end = read.ends[lane] as u8;
            is_quiet &= (end != End::Low as u8) & (end != End::High as u8);
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
        // All is read before anything is written: the compiler need not fear that it is the same.
        let (offsets, mut forces) = (*into.offsets, *into.forces);
        let (mut quality, mut ends, mut guessed, mut news) =
            (*into.quality, *into.ends, *into.guessed, *into.news);
        let (mut is_force, mut is_used) = ([false; LANES], [false; LANES]);
        let mut loud = [false; LANES];
        for lane in 0..LANES {
            let force = read.forces[lane] - self.tares[lane] - offsets[lane];
            // NaN is at most nothing.
            is_force[lane] = force.abs() <= MOST_N;
            is_used[lane] = is_force[lane] & self.is_wired(lane) & !trust.is_swapped;
            loud[lane] = is_used[lane] & (force.abs() > LOUD_N);
            forces[lane] = if is_used[lane] { force } else { forces[lane] };
        }
        // One loop for each list: what does much at once becomes no vector instructions.
        for lane in 0..LANES {
            ends[lane] = if is_used[lane] { read.ends[lane] } else { ends[lane] };
        }
        let mut raws = *into.raws;
        for lane in 0..LANES {
            raws[lane] = if is_used[lane] { read.raws[lane] } else { raws[lane] };
        }
        let mut is_high = [false; LANES];
        for lane in 0..LANES {
            is_high[lane] = read.ends[lane] as u8 == End::High as u8;
        }
        for lane in 0..LANES {
            let is_low = read.ends[lane] as u8 == End::Low as u8;
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

/// Puts what the sensors of a wide window have read into `frame`; the answer is how many readings were no forces.
pub(super) fn put_wide(
    window: &Window<WIDE>,
    sample: &Sample,
    trust: Trust,
    frame: &mut ForceFrame,
    health: &mut Health,
) -> u64 {
    let Some(mut lanes) = health.lanes(window.first, frame) else { return 0 };
    note(window.first, &write_wide(window, sample, trust, &mut lanes), sample, health)
}

/// The same for a narrow one.
pub(super) fn put_narrow(
    window: &Window<NARROW>,
    sample: &Sample,
    trust: Trust,
    frame: &mut ForceFrame,
    health: &mut Health,
) -> u64 {
    let Some(mut lanes) = health.lanes(window.first, frame) else { return 0 };
    note(window.first, &window.take(sample, trust, &mut lanes), sample, health)
}

fn note<const LANES: usize>(first: usize, found: &Found<LANES>, sample: &Sample, health: &mut Health) -> u64 {
    if found.is_used && matches!(sample, Sample::Newtons(_)) {
        health.note_newtons();
    }
    if found.is_any_loud {
        let loud = (first..).zip(&found.loud).filter(|(_, loud)| **loud);
        loud.for_each(|(sensor, _)| health.note_loud(sensor));
    }
    found.bad.into()
}

/// Over plain arrays, with one branch for all lanes: compiled for what the processor offers.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512bw+avx512dq", "x86_64+avx2", "aarch64+neon"))]
fn write_wide<'a>(
    window: &Window<WIDE>,
    sample: &Sample,
    trust: Trust,
    into: &mut Lanes<'a, WIDE>,
) -> Found<WIDE> {
    window.take(sample, trust, into)
}
