//! The signal path from the mix to the amplifiers, channel by channel.
//!
//! ```text
//! banks, voices -> non-finite samples become silence -> filters (band, inverse equaliser) -> peak limiter
//!               -> power limiter -> direct-current block -> clamp -> mutes and ramps -> samples
//! ```
//!
//! Sixteen channels are processed side by side. No stage looks ahead, so that the only latency is that of the
//! filters; a silent group of channels costs nothing.

// Loops over lanes stay plain indexed loops: those are the ones that become vector instructions.
#![allow(clippy::needless_range_loop)]

mod fit;
mod gate;
mod heat;
mod section;

use multiversion::multiversion;
use multiversion::target::target_cfg_f;

use super::active_modes::ActiveModes;
use super::limiter::Limiter;
use super::mix::{LANES, MixBlock, settled};
use super::modal::SPAN;
use crate::floor::{Drive, Response};
use gate::Gate;
use heat::Heat;
use section::{Filter, FilterSection};

/// Samples beyond this many full scales are a fault, not a loud cue.
const OVERLOAD: f32 = 8.0;

/// Below this (-140 dB of full scale) the rest of a sound is dropped.
const SILENCE: f32 = 1e-7;

/// Counts of faulty samples and of the measures against them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct SampleFaults {
    /// Samples that were not numbers or infinite: silence now.
    pub(super) not_finite: u32,
    /// Samples beyond [`OVERLOAD`]: cut off there.
    pub(super) overloaded: u32,
    /// Channels silenced because of either.
    pub(super) silenced: u32,
    /// Channels newly attenuated because of heat.
    pub(super) heated: u32,
}

/// The output stage of all channels.
#[derive(Clone, Debug)]
pub(super) struct Rack {
    channels: usize,
    sample_rate: f32,
    groups: Vec<Group>,
    /// The present samples of each group.
    columns: Vec<[[f32; LANES]; SPAN]>,
    /// The last response for which filters were fitted.
    fitted: Option<(Response, Vec<Filter>)>,
}

/// Sixteen channels.
#[derive(Clone, Debug)]
struct Group {
    sections: Vec<FilterSection>,
    heat: Heat,
    limiter: Limiter,
    gate: Gate,
    /// Whether silent input gives silent output.
    idle: bool,
}

impl Rack {
    /// A rack that only limits.
    pub(super) fn new(sample_rate: u32, channels: usize) -> Self {
        let sample_rate = sample_rate as f32;
        let group = Group {
            sections: Vec::new(),
            heat: Heat::new(sample_rate),
            limiter: Limiter::new(sample_rate),
            gate: Gate::new(sample_rate),
            idle: true,
        };
        Self {
            channels,
            sample_rate,
            groups: vec![group; channels.div_ceil(LANES)],
            columns: vec![[[0.0; LANES]; SPAN]; channels.div_ceil(LANES)],
            fitted: None,
        }
    }

    /// Sets the drive of the coil on `channel`.
    ///
    /// A measured `response` is made flat within 50 to 750 Hz, and frequencies outside are removed; without one,
    /// samples keep their shape, except for direct current.
    ///
    /// Takes memory and time, so it belongs before the start. A channel beyond those of the rack is ignored.
    pub(super) fn add_actuator(&mut self, channel: usize, drive: &Drive, response: Option<&Response>) {
        let shapes = match response {
            Some(response) => self.filters_for(response),
            None => Vec::new(),
        };
        let Some(group) = self.groups.get_mut(channel / LANES) else { return };
        let lane = channel % LANES;
        while group.sections.len() < shapes.len() {
            group.sections.push(FilterSection::straight());
        }
        for (section, shape) in group.sections.iter_mut().zip(&shapes) {
            section.set(lane, shape);
        }
        group.heat.set(lane, drive);
    }

    /// The filters for a response; keeps those of the last one, since most floors have one response for all.
    fn filters_for(&mut self, response: &Response) -> Vec<Filter> {
        if let Some((known, shapes)) = &self.fitted
            && known == response
        {
            return shapes.clone();
        }
        let shapes = fit::filters(response, f64::from(self.sample_rate));
        self.fitted = Some((response.clone(), shapes.clone()));
        shapes
    }

    /// Mutes or unmutes a channel within 5 ms.
    pub(super) fn mute(&mut self, channel: usize, muted: bool) {
        if let Some(group) = self.groups.get_mut(channel / LANES) {
            group.gate.mute(channel % LANES, muted);
        }
    }

    /// Drops all sounds at once; coils keep their temperature.
    pub(super) fn clear(&mut self) {
        self.groups.iter_mut().for_each(Group::clear);
    }

    /// Writes the next samples to `out`, interleaved; `gains` holds a factor for each of its frames.
    ///
    /// # Real-time
    /// No allocation.
    pub(super) fn process(
        &mut self,
        modes: &mut ActiveModes,
        mix: &MixBlock,
        gains: &[f32],
        out: &mut [f32],
    ) -> SampleFaults {
        let is_fed = |group: usize, modes: &ActiveModes| mix.is_open(group) || modes.has_more(group);
        if self.groups.iter().enumerate().all(|(number, group)| group.idle && !is_fed(number, modes)) {
            out.fill(0.0);
            self.groups.iter_mut().for_each(|group| group.rest(gains.len()));
            return SampleFaults::default();
        }
        let mut faults = SampleFaults::default();
        for (span, (gains, out)) in gains.chunks(SPAN).zip(out.chunks_mut(SPAN * self.channels)).enumerate() {
            for (number, (group, columns)) in self.groups.iter_mut().zip(&mut self.columns).enumerate() {
                let fed = is_fed(number, modes);
                if !modes.draw(number, gains.len(), columns) {
                    *columns = [[0.0; LANES]; SPAN];
                }
                if group.idle && !fed {
                    group.rest(gains.len());
                    continue;
                }
                let rows = mix.is_open(number).then_some(Rows { mix, group: number, from: span * SPAN });
                faults += run(group, rows, columns, gains, fed);
            }
            write(&self.columns, out, self.channels);
        }
        for (number, group) in self.groups.iter_mut().enumerate().filter(|(_, group)| group.gate.is_tripped())
        {
            for (channel, spent) in (number * LANES..).zip(group.gate.reset()) {
                if spent {
                    modes.clear_channel(channel);
                }
            }
        }
        faults
    }
}

/// The place of a stretch of a group's samples in the mix.
#[derive(Clone, Copy)]
struct Rows<'a> {
    mix: &'a MixBlock,
    group: usize,
    from: usize,
}

/// Processes a stretch of a group's samples, with the widest registers of this processor.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx2+fma", "x86_64+avx2+fma", "aarch64+neon"))]
fn run<'a>(
    group: &mut Group,
    rows: Option<Rows<'a>>,
    columns: &mut [[f32; LANES]; SPAN],
    gains: &[f32],
    fed: bool,
) -> SampleFaults {
    if target_cfg_f!(any(target_feature = "fma", target_arch = "aarch64")) {
        group.run::<true>(rows, columns, gains, fed)
    } else {
        group.run::<false>(rows, columns, gains, fed)
    }
}

impl Group {
    fn clear(&mut self) {
        for section in &mut self.sections {
            section.states().fill([0.0; LANES]);
        }
        self.limiter.clear();
        self.gate.settle();
        self.idle = true;
    }

    /// Advances by so many silent samples.
    fn rest(&mut self, samples: usize) {
        self.heat.rest(samples);
        self.gate.settle();
    }

    #[inline(always)]
    fn run<const FUSED: bool>(
        &mut self,
        rows: Option<Rows<'_>>,
        columns: &mut [[f32; LANES]; SPAN],
        gains: &[f32],
        fed: bool,
    ) -> SampleFaults {
        let mut faults = SampleFaults::default();
        if let Some(Rows { mix, group, from }) = rows {
            mix.add_to(group, from, gains.len(), columns);
            // Checked early: a filter never recovers from NaN. Banks don't produce any.
            let columns = &mut columns[..gains.len()];
            if !survey(columns).is_calm() {
                faults = self.mend(columns);
            }
        }
        let columns = &mut columns[..gains.len()];
        FilterSection::run_all::<FUSED>(&mut self.sections, columns);
        let mut found = survey(columns);
        if !found.is_calm() {
            faults += self.mend(columns);
        }
        if self.limiter.hold_down(columns, found.loudest()) {
            found = survey(columns);
        }
        faults.heated = self.heat.run::<FUSED>(columns, &found.energy);
        let (fours, rest) = columns.as_chunks_mut::<4>();
        let (gains, gains_of_rest) = gains.as_chunks::<4>();
        for (four, gains) in fours.iter_mut().zip(gains) {
            self.limiter.finish::<FUSED>(four, gains);
        }
        self.limiter.finish::<FUSED>(rest, gains_of_rest);
        if !self.gate.is_open() {
            self.gate.run(columns);
        }
        self.settle(fed);
        faults
    }

    /// Silences samples that are not finite, cuts off those that are too large, counts both, and closes their
    /// channels.
    fn mend(&mut self, columns: &mut [[f32; LANES]]) -> SampleFaults {
        let mut faults = SampleFaults::default();
        for column in columns {
            for (lane, sample) in column.iter_mut().enumerate() {
                if !sample.is_finite() {
                    faults.not_finite += 1;
                    *sample = 0.0;
                } else if sample.abs() > OVERLOAD {
                    faults.overloaded += 1;
                    *sample = OVERLOAD.copysign(*sample);
                } else {
                    continue;
                }
                faults.silenced += u32::from(self.gate.trip(lane));
            }
        }
        faults
    }

    /// Sets tiny states to zero, long before they would become denormal numbers.
    #[inline(always)]
    fn settle(&mut self, fed: bool) {
        let mut left = self.limiter.settle();
        for section in &mut self.sections {
            left = left.max(settled(section.states()));
        }
        self.idle = !fed && left < SILENCE;
        if self.idle {
            self.clear();
        }
    }
}

/// Figures of a stretch of samples, channel by channel.
struct Survey {
    /// The largest absolute sample, as bits: without a sign, the bits of numbers are in the order of the numbers, and
    /// the bits of infinity and NaN come last.
    most: [u32; LANES],
    /// The sum of the squares.
    energy: [f32; LANES],
}

#[inline(always)]
fn survey(columns: &[[f32; LANES]]) -> Survey {
    /// Numbers that are processed together: as many as sums of them fit into registers.
    const TOGETHER: usize = 4 * LANES;
    let (mut most, mut energy) = ([0_u32; TOGETHER], [0.0_f32; TOGETHER]);
    let (whole, rest) = columns.as_flattened().as_chunks::<TOGETHER>();
    for numbers in whole {
        for n in 0..TOGETHER {
            most[n] = (numbers[n].to_bits() & 0x7fff_ffff).max(most[n]);
            energy[n] += numbers[n] * numbers[n];
        }
    }
    for ((number, most), energy) in rest.iter().zip(&mut most).zip(&mut energy) {
        *most = (number.to_bits() & 0x7fff_ffff).max(*most);
        *energy += number * number;
    }
    let mut survey = Survey { most: [0; LANES], energy: [0.0; LANES] };
    for (most, energy) in most.as_chunks::<LANES>().0.iter().zip(energy.as_chunks::<LANES>().0) {
        for lane in 0..LANES {
            survey.energy[lane] += energy[lane];
            survey.most[lane] = survey.most[lane].max(most[lane]);
        }
    }
    survey
}

impl Survey {
    /// Whether all samples are numbers no larger than [`OVERLOAD`].
    #[inline(always)]
    fn is_calm(&self) -> bool {
        self.loudest() <= OVERLOAD
    }

    /// The largest absolute sample; infinity or NaN if any sample is.
    #[inline(always)]
    fn loudest(&self) -> f32 {
        let mut all = 0;
        for most in self.most {
            all = most.max(all);
        }
        f32::from_bits(all)
    }
}

/// Writes the columns of all groups into frames.
///
/// Frame by frame rather than group by group: a group's part of a frame mostly spans two cache lines, and writing in
/// order writes each line once.
#[multiversion(targets("x86_64+avx512f+avx512vl+avx512dq+avx2+fma", "x86_64+avx2+fma", "aarch64+neon"))]
fn write(groups: &[[[f32; LANES]; SPAN]], out: &mut [f32], channels: usize) {
    for (n, frame) in out.chunks_exact_mut(channels).enumerate() {
        let (parts, last) = frame.as_chunks_mut::<LANES>();
        for (part, columns) in parts.iter_mut().zip(groups) {
            *part = columns[n];
        }
        // The last group is seldom full. By fours, since a copy of any length is a call for each frame.
        let Some(columns) = groups.get(parts.len()) else { continue };
        let (fours, rest) = last.as_chunks_mut::<4>();
        for (samples, from) in fours.iter_mut().zip(columns[n].as_chunks::<4>().0) {
            *samples = *from;
        }
        for (sample, from) in rest.iter_mut().zip(&columns[n][4 * fours.len()..]) {
            *sample = *from;
        }
    }
}

impl std::ops::AddAssign for SampleFaults {
    fn add_assign(&mut self, other: Self) {
        self.not_finite += other.not_finite;
        self.overloaded += other.overloaded;
        self.silenced += other.silenced;
        self.heated += other.heated;
    }
}
