//! The probability that each sensor repeats its reading by chance, due to its noise.
//!
//! Each sensor is sampled every 8 ms while its tile is nearly empty. The share of looks at which its reading equals,
//! to the bit, that of the look before is the probability q of a repetition by chance. For white noise of standard
//! deviation s counts q is 1 / (2 s sqrt pi), 0.28 for one count; for a converter that is read more often than it
//! samples, q is the share of looks without a sample in between.
//!
//! Mains hum hides the coarseness of a converter at looks 8 ms apart. Readings a whole number of its periods apart,
//! 200 ms at 50 and at 60 Hz, show it: that share applies to readings that repeat in the same order.

use std::ops::Range;

use multiversion::multiversion;

use crate::sense::health::RangeEnd;

/// Maximum number of looks in the average: two seconds.
const MOST_LOOKS: f32 = 256.0;

/// Number of repeated looks assumed before the first one: a sensor must show its noise before it counts as fine.
const PRIOR_LOOKS: f32 = 3.0;

/// Minimum number of looks before a sensor counts as fine: the number without a repetition at which the share falls
/// below [`FINE`].
const FEWEST_LOOKS: f32 = 8.0;

/// Minimum number of looks before a sensor counts as coarse: half a second.
const ENOUGH_LOOKS: f32 = 64.0;

/// Share of repeated readings above which a sensor becomes coarse, and below which it becomes fine. Noise of one
/// count has 0.28; the statistical error of 256 looks is 0.03.
const COARSE: f32 = 0.33;
const FINE: f32 = 0.28;

/// Number of looks between comparisons of readings 200 ms apart.
const FAR: u32 = 25;

/// Maximum relative difference of readings 8 ms apart under a still foot: then the difference is noise, or a count.
const STILL_SHARE: f32 = 0.02;

/// Classification of one sensor's noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NoiseClass {
    /// Too few looks.
    Unknown,
    /// It repeats too often by chance.
    Coarse,
    /// A repetition is improbable.
    Fine,
}

/// The noise of all sensors, four to a tile.
#[derive(Clone, Debug)]
pub(super) struct SensorNoise {
    near: Likeness,
    far: Likeness,
    /// Whether each reads zero while its tile is empty, so that only a load shows its noise.
    is_bare: Vec<[bool; 4]>,
    is_coarse: Vec<[bool; 4]>,
}

/// The frequency of equal readings some time apart.
#[derive(Clone, Debug)]
struct Likeness {
    /// Share of looks at which the reading of each equalled that of the look before.
    same: Vec<[f32; 4]>,
    /// Number of looks, up to [`MOST_LOOKS`].
    looks: Vec<[f32; 4]>,
    /// Reading of each at the last look, and whether that look counts.
    last: Vec<[u16; 4]>,
    has_last: Vec<[bool; 4]>,
}

/// The readings to look at, of all sensors.
#[derive(Clone, Copy)]
pub(super) struct ExaminedReadings<'a> {
    pub raws: &'a [[u16; 4]],
    pub ends: &'a [[RangeEnd; 4]],
    pub news: &'a [[bool; 4]],
    /// Whether each tile is nearly empty.
    pub idle: &'a [[bool; 4]],
    /// Whether a sensor may have no reading between two looks, so that the next one is compared with the last.
    pub has_pauses: bool,
}

impl SensorNoise {
    pub(super) fn new(tiles: usize) -> Self {
        let is_bare = vec![[false; 4]; tiles];
        Self {
            near: Likeness::new(tiles),
            far: Likeness::new(tiles),
            is_bare,
            is_coarse: vec![[true; 4]; tiles],
        }
    }

    /// Looks at `tiles` for the time numbered `visit`.
    pub(super) fn look(&mut self, tiles: Range<usize>, seen: ExaminedReadings<'_>, visit: u32) {
        self.near.look(tiles.clone(), seen);
        if visit.is_multiple_of(FAR) {
            self.far.look(tiles.clone(), seen);
        }
        let idle =
            seen.idle[tiles.clone()].as_flattened().iter().zip(seen.news[tiles.clone()].as_flattened());
        let within =
            seen.ends[tiles.clone()].as_flattened().iter().zip(seen.raws[tiles.clone()].as_flattened());
        let bare = self.is_bare[tiles].as_flattened_mut().iter_mut();
        for ((bare, (idle, news)), (end, raw)) in bare.zip(idle).zip(within) {
            *bare = if idle & news { !is_within(*end, *raw) } else { *bare };
        }
    }

    /// Looks at the sensor of this tile and corner under a load, if its noise is unknown without one: its readings
    /// are `raws` and `newtons`, now and 8 ms before.
    pub(super) fn look_under_load(
        &mut self,
        (tile, corner): (usize, usize),
        raws: [u16; 2],
        newtons: [f32; 2],
    ) {
        let is_still = (newtons[0] - newtons[1]).abs() < STILL_SHARE * newtons[0].abs();
        let is_unknown = self.is_bare[tile][corner] || self.near.looks[tile][corner] < ENOUGH_LOOKS;
        if is_unknown && is_still {
            for likeness in [&mut self.near, &mut self.far] {
                likeness.note((tile, corner), raws[0] == raws[1]);
            }
        }
    }

    /// Classifies the sensor's noise: how strongly a repetition of its readings indicates a frozen converter.
    pub(super) fn grain(&mut self, tile: usize, corner: usize) -> NoiseClass {
        let (looks, is_coarse) = (self.near.looks[tile][corner], &mut self.is_coarse[tile][corner]);
        if looks < FEWEST_LOOKS {
            return NoiseClass::Unknown;
        }
        *is_coarse = self.near.same[tile][corner] > if *is_coarse { FINE } else { COARSE };
        match *is_coarse {
            false => NoiseClass::Fine,
            true if looks < ENOUGH_LOOKS => NoiseClass::Unknown,
            true => NoiseClass::Coarse,
        }
    }

    /// Whether a repetition of this sensor's readings is improbable, as of the last look.
    pub(super) fn is_fine(&self, tile: usize, corner: usize) -> bool {
        self.near.looks[tile][corner] >= FEWEST_LOOKS && !self.is_coarse[tile][corner]
    }

    /// Probabilities that this sensor reads the same value 8 ms later, and one period of hum later.
    pub(super) fn same(&self, tile: usize, corner: usize) -> [f32; 2] {
        let near = self.near.same[tile][corner];
        [near, self.far.same[tile][corner].max(near)]
    }
}

impl Likeness {
    fn new(tiles: usize) -> Self {
        Self {
            same: vec![[1.0; 4]; tiles],
            looks: vec![[0.0; 4]; tiles],
            last: vec![[0; 4]; tiles],
            has_last: vec![[false; 4]; tiles],
        }
    }

    fn look(&mut self, tiles: Range<usize>, seen: ExaminedReadings<'_>) {
        look(
            [&mut self.same, &mut self.looks].map(|all| all[tiles.clone()].as_flattened_mut()),
            self.last[tiles.clone()].as_flattened_mut(),
            self.has_last[tiles.clone()].as_flattened_mut(),
            seen.raws[tiles.clone()].as_flattened(),
            seen.ends[tiles.clone()].as_flattened(),
            [seen.news, seen.idle].map(|all| all[tiles.clone()].as_flattened()),
            seen.has_pauses,
        );
    }

    /// Notes whether a sensor's reading equals that of the look before.
    fn note(&mut self, (tile, corner): (usize, usize), is_same: bool) {
        let (same, looks) = (&mut self.same[tile][corner], &mut self.looks[tile][corner]);
        *same += (f32::from(u8::from(is_same)) - *same) / (*looks + PRIOR_LOOKS + 1.0);
        *looks = (*looks + 1.0).min(MOST_LOOKS);
    }
}

/// Whether a reading is above zero and below the end of its range.
#[inline(always)]
pub(super) fn is_within(end: RangeEnd, raw: u16) -> bool {
    (end as u8 == RangeEnd::Within as u8) & (raw != 0)
}

/// Without branches, over plain numbers, compiled for each vector instruction set.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512bw+avx512dq", "x86_64+avx2", "aarch64+neon"))]
fn look(
    [same, looks]: [&mut [f32]; 2],
    last: &mut [u16],
    has_last: &mut [bool],
    raws: &[u16],
    ends: &[RangeEnd],
    [news, idle]: [&[bool]; 2],
    has_pauses: bool,
) {
    let sensors = raws.len();
    let (same, looks, last) = (&mut same[..sensors], &mut looks[..sensors], &mut last[..sensors]);
    let (has_last, ends) = (&mut has_last[..sensors], &ends[..sensors]);
    let (news, idle) = (&news[..sensors], &idle[..sensors]);
    for at in 0..sensors {
        let counts_now = news[at] & is_within(ends[at], raws[at]);
        let counts = f32::from(u8::from(has_last[at] & counts_now & idle[at]));
        let now = f32::from(u8::from(raws[at] == last[at]));
        same[at] += counts * (now - same[at]) / (looks[at] + (PRIOR_LOOKS + 1.0));
        looks[at] = (looks[at] + counts).min(MOST_LOOKS);
        has_last[at] = counts_now | (has_pauses & has_last[at] & !news[at]);
        last[at] = if news[at] { raws[at] } else { last[at] };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The noise of a sensor after `looks` looks at these readings.
    fn known(looks: u32, reading: impl Fn(u32) -> u16) -> (SensorNoise, NoiseClass) {
        let mut noise = SensorNoise::new(1);
        let mut grain = NoiseClass::Unknown;
        for visit in 0..looks {
            let raws = [[reading(visit); 4]];
            let seen = ExaminedReadings {
                raws: &raws,
                ends: &[[RangeEnd::Within; 4]],
                news: &[[true; 4]],
                idle: &[[true; 4]],
                has_pauses: false,
            };
            noise.look(0..1, seen, visit);
            grain = noise.grain(0, 2);
        }
        (noise, grain)
    }

    /// A pseudorandom number from 0 to 1.
    fn chance(at: u32) -> f32 {
        let mixed = at.wrapping_add(1).wrapping_mul(2_654_435_761);
        ((mixed ^ mixed >> 13).wrapping_mul(2_246_822_519) >> 8) as f32 / 16_777_216.0
    }

    #[test]
    fn a_noisy_sensor_is_trusted_after_a_tenth_of_a_second() {
        let noisy = |at| (chance(at) * 60.0) as u16 + 9000;
        assert_eq!(known(8, noisy).1, NoiseClass::Unknown);
        assert_eq!(known(12, noisy).1, NoiseClass::Fine);
        assert!(known(600, noisy).0.same(0, 2)[0] < 0.05);
    }

    #[test]
    fn a_sensor_that_mostly_reads_one_value_is_coarse_after_half_a_second() {
        let quiet = |at| if chance(at) < 0.2 { 181 } else { 180 };
        assert_eq!(known(60, quiet).1, NoiseClass::Unknown);
        assert_eq!(known(80, quiet).1, NoiseClass::Coarse);
    }

    #[test]
    fn a_slow_board_s_readings_are_compared_over_the_looks_between_them() {
        let mut noise = SensorNoise::new(1);
        for visit in 0..100 {
            let seen = ExaminedReadings {
                raws: &[[chance(visit / 3) as u16 + 9000 + (visit / 3 % 50) as u16; 4]],
                ends: &[[RangeEnd::Within; 4]],
                news: &[[visit % 3 == 0; 4]],
                idle: &[[true; 4]],
                has_pauses: true,
            };
            noise.look(0..1, seen, visit);
        }
        assert_eq!(noise.grain(0, 2), NoiseClass::Fine);
    }

    #[test]
    fn hum_hides_coarse_steps_from_looks_that_are_near() {
        // 50 Hz, five counts, one look every 8 ms.
        let hum = |at: u32| (180.4 + 2.5 * (at as f32 * 0.008 * 50.0 * std::f32::consts::TAU).sin()) as u16;
        let (noise, _) = known(2000, hum);
        let [near, far] = noise.same(0, 2);
        assert!(near < 0.3 && far > 0.8, "{near}, {far}");
    }

    #[test]
    fn a_sensor_that_reads_nothing_without_a_load_shows_its_noise_under_one() {
        let (mut noise, grain) = known(400, |_| 0);
        assert_eq!(grain, NoiseClass::Unknown);
        for at in 0..20 {
            noise.look_under_load((0, 2), [at, at + 1], [100.0, 140.0]);
        }
        assert_eq!(noise.grain(0, 2), NoiseClass::Unknown, "a foot that lands says nothing");
        for at in 0..20 {
            noise.look_under_load((0, 2), [at, at + 1], [100.0, 100.3]);
        }
        assert_eq!(noise.grain(0, 2), NoiseClass::Fine);
    }
}
