//! One board: its waiting packets, and its sensors' calibration and tare.

use smallvec::SmallVec;

use super::buffers::{BUFFERS, Buffers};
use super::numbering::TimeBase;
use super::own_rate::OwnRate;
use super::pace::PacketPace;
use super::sample::BoardSample;
use super::stream::BoardStream;
use super::tare::{Tare, TareMeter, TareOutcome, TareResult};
use super::timed::TimedStream;
use super::window::{NARROW, SensorWindow, WIDE, count_misses_wide, misses_wide, windows};
use super::write::{Trust, put_narrow, put_wide};
use crate::floor::{Calibration, Corner, Floor, Geometry, SensorId};
use crate::sense::health::{Health, LOUD_N};
use crate::sense::{ForceFrame, Quality};
use crate::units::Newtons;
use crate::wire::{LinkCounters, Readings};

/// Force above the zero-count reading from which a sensor of the empty floor counts as loaded (N).
const RESTS_N: f32 = 1.0;

/// Difference of a written rate from 1000 packets a second below which it is that rate: twice that of crystals.
const NEARLY_HZ: f32 = 1.0;

/// One board: its stream, its wiring, and its samples in the waiting slots.
#[derive(Clone, Debug)]
pub(super) struct BoardTrack {
    pub(super) stream: BoardStream,
    /// Its own rate, if it does not send once a millisecond.
    pub(super) own_rate: Option<Box<OwnRate>>,
    /// Its number on the floor.
    number: usize,
    geometry: Geometry,
    channels: Vec<Option<Channel>>,
    /// The same channels as windows for vector operations. Most boards have one wide window, which is stored inline:
    /// frames are made board by board, and the next board's memory is prefetched.
    wide: SmallVec<[SensorWindow<WIDE>; 1]>,
    narrow: Vec<SensorWindow<NARROW>>,
    /// Buffers in which a packet of this board waits.
    waits: [bool; BUFFERS],
    /// Buffer of its last packet, and whether that packet repeated the one before under a load.
    last: Option<usize>,
    repeats: bool,
    /// Whether any of its packets had counts, which only the floor's calibration converts to newtons. Later packets
    /// with newtons do not reset it: a board that has sent counts once needs calibration.
    has_sent_counts: bool,
    /// Whether some of its sensors are uncalibrated.
    has_nominal: bool,
    /// Whether it sends under another board's address.
    is_swapped: bool,
    tare: TareState,
}

/// The sensor of one channel. Small, since a large floor has many.
#[derive(Clone, Copy, Debug)]
pub(super) struct Channel {
    pub(super) tile: u32,
    pub(super) corner: Corner,
    /// Whether it uses the nominal part's law, without a calibration of its own.
    pub(super) is_nominal: bool,
    /// Counts at and above which the reading is a lower bound.
    pub(super) saturated: u16,
    pub(super) calibration: Calibration,
    pub(super) tare: f32,
    /// Whether the plate's weight on it is so large that it never reads zero.
    pub(super) bears: bool,
    /// Whether its converter has a sign.
    pub(super) is_bipolar: bool,
}

impl Channel {
    fn new(tile: u32, corner: Corner, calibration: Calibration, tare: f32, is_bipolar: bool) -> Self {
        let is_nominal = calibration == Calibration::NOMINAL;
        let saturated = calibration.saturated();
        let mut channel =
            Self { tile, corner, is_nominal, saturated, calibration, tare, bears: false, is_bipolar };
        channel.set_tare(tare);
        channel
    }

    fn set_tare(&mut self, tare: f32) {
        self.tare = tare;
        self.bears = tare > self.calibration.force(0).0 + RESTS_N;
    }
}

#[derive(Clone, Debug)]
enum TareState {
    FromFloor,
    Measuring(TareMeter),
    Taken,
    Refused(TareOutcome),
}

impl BoardTrack {
    pub(super) fn new(floor: &Floor, number: usize, tare: Tare) -> Self {
        let board = floor.boards.get(number);
        let wiring = board.map(|board| board.channels.as_slice()).unwrap_or_default();
        let is_bipolar = board.is_some_and(|board| board.range.is_bipolar());
        let channel = |sensor: SensorId| {
            let (tile, corner) = (floor.geometry.index(sensor.tile)?, sensor.corner);
            let tare = floor.tare.get(tile).map_or(0.0, |all| all[corner.index()].0);
            Some(Channel::new(u32::try_from(tile).ok()?, corner, floor.law(sensor), tare, is_bipolar))
        };
        let channels: Vec<_> = wiring.iter().map(|sensor| sensor.and_then(channel)).collect();
        let written_hz = board.and_then(|board| board.rate_hz).filter(|hz| (hz - 1000.0).abs() > NEARLY_HZ);
        let has_nominal = channels.iter().flatten().any(|channel| channel.is_nominal);
        let tare = match tare {
            Tare::FromFloor => TareState::FromFloor,
            Tare::AtStart(rules) => TareState::Measuring(TareMeter::new(channels.len(), rules)),
        };
        let (wide, narrow) = windows(&channels, 4 * floor.geometry.tile_count());
        let mut board = Self {
            stream: BoardStream::default(),
            own_rate: None,
            number,
            geometry: floor.geometry,
            channels,
            wide,
            narrow,
            waits: [false; BUFFERS],
            last: None,
            repeats: false,
            has_sent_counts: false,
            has_nominal,
            is_swapped: false,
            tare,
        };
        let stream = if floor.asks(number) {
            Some(TimedStream::asked(written_hz.map(PacketPace::of_rate).unwrap_or_default()))
        } else {
            // Until its numbers are known, their arrival is the packets' time.
            written_hz.map(|hz| TimedStream::new(TimeBase::Arrival, PacketPace::of_rate(hz)))
        };
        if let Some(stream) = stream {
            board.set_own_rate(stream, &mut LinkCounters::default());
        }
        board
    }

    /// Indices of its tiles, in the order of its channels.
    pub(super) fn tiles(&self) -> Vec<u32> {
        self.channels.iter().flatten().map(|channel| channel.tile).collect()
    }

    /// Whether the start of frames waits for its tare: frames wait for it, or it sends at its own rate.
    pub(super) fn awaits_tare(&self) -> bool {
        let is_awaited = match self.own_rate {
            Some(_) => self.stream.presence.has_reported(),
            None => self.stream.awaited,
        };
        is_awaited && self.is_taring()
    }

    /// The sensor on a channel.
    pub(super) fn sensor(&self, channel: usize) -> Option<SensorId> {
        let Channel { tile, corner, .. } = *self.channels.get(channel)?.as_ref()?;
        Some(SensorId { tile: self.geometry.tile_at_index(tile as usize), corner })
    }

    pub(super) fn channel_count(&self) -> usize {
        self.channels.len()
    }

    /// Number of lanes of all its windows, with or without a channel.
    pub(super) fn lane_count(&self) -> usize {
        WIDE * self.wide.len() + NARROW * self.narrow.len()
    }

    pub(super) const fn has(&self, buffer: usize) -> bool {
        self.waits[buffer]
    }

    /// Keeps `readings` until the frame of `buffer`'s slot is made; returns true if they are new.
    ///
    /// They are not new if they equal, bit for bit, those of the packet before while the board carries a load: a
    /// working converter is noisy, and a foot never keeps still to a count.
    ///
    /// This requires a sensor under load with noise that makes a repetition improbable. An empty board may repeat its
    /// readings.
    pub(super) fn store(
        &mut self,
        buffer: usize,
        readings: &Readings,
        buffers: &mut Buffers,
        health: &Health,
    ) -> bool {
        self.has_sent_counts |= !matches!(readings, Readings::Newtons(_));
        self.waits[buffer] = true;
        let was_here = buffers.sample_mut(buffer, self.number).replace(readings);
        let sample = |buffer: usize| buffers.sample(buffer, self.number);
        let is_same = match self.last.replace(buffer) {
            Some(last) if last == buffer => was_here,
            Some(last) => sample(last) == sample(buffer),
            None => false,
        };
        self.repeats = is_same && !self.is_taring() && self.bears_load(sample(buffer), health);
        !self.repeats
    }

    /// Whether `readings` equal those of its last packet, bit for bit.
    pub(super) fn holds(&self, readings: &Readings, buffers: &Buffers) -> bool {
        self.last.is_some_and(|last| buffers.sample(last, self.number).holds(readings))
    }

    /// Discards all packets that wait.
    pub(super) fn forget_waiting(&mut self) {
        (self.waits, self.last) = ([false; BUFFERS], None);
    }

    /// Notes the kind of readings that it sends.
    pub(super) const fn note_kind(&mut self, sample: &BoardSample) {
        self.has_sent_counts |= !matches!(sample, BoardSample::Newtons(_));
    }

    /// Notes whether its last packet repeated the one before under a load.
    pub(super) const fn set_repeats(&mut self, repeats: bool) {
        self.repeats = repeats;
    }

    /// Whether its last packet repeated the one before under a load.
    pub(super) const fn repeats(&self) -> bool {
        self.repeats
    }

    /// Whether a sensor with known noise carries a load.
    pub(super) fn bears_load(&self, sample: &BoardSample, health: &Health) -> bool {
        let zero = |tile, corner| health.tells(tile, corner).then(|| health.zero(tile, corner));
        let wide = self.wide.iter().flat_map(|window| window.net(sample, zero));
        let mut all = wide.chain(self.narrow.iter().flat_map(|window| window.net(sample, zero)));
        all.any(|force| force > LOUD_N)
    }

    /// Discards the packet in `buffer`; returns true if there was one.
    pub(super) fn clear(&mut self, buffer: usize) -> bool {
        std::mem::take(&mut self.waits[buffer])
    }

    /// Number of its sensors that have sent counts and have no law in the floor file.
    pub(super) fn uncalibrated(&self) -> usize {
        let nominal = |channel: &&Channel| channel.is_nominal;
        if self.has_sent_counts { self.channels.iter().flatten().filter(nominal).count() } else { 0 }
    }

    /// Whether it has sent counts of sensors that have no law in the floor file.
    pub(super) const fn lacks_laws(&self) -> bool {
        self.has_sent_counts && self.has_nominal
    }

    /// Whether it has changed places with another board.
    pub(super) const fn is_swapped(&self) -> bool {
        self.is_swapped
    }

    pub(super) const fn set_swapped(&mut self, swapped: bool) {
        self.is_swapped = swapped;
    }

    /// Whether the floor file holds the readings of its sensors on the empty floor.
    pub(super) const fn has_known_tare(&self) -> bool {
        matches!(self.tare, TareState::FromFloor)
    }

    /// Median distance of this board's sensors from their tares for the readings `mean` (N); `None` if `mean` does
    /// not fit its channels, or if the median is `below` or more. `misses` is space for sorting.
    pub(super) fn misfit(
        &self,
        mean: &BoardSample,
        below: Option<f32>,
        misses: &mut Vec<f32>,
    ) -> Option<f32> {
        if mean.len() != self.channels.len() {
            return None;
        }
        // Counting is far cheaper than sorting, and most places fit worse than the best so far.
        if below.is_some_and(|below| !self.misses_by_less(mean, below)) {
            return None;
        }
        misses.clear();
        self.wide.iter().for_each(|window| misses.extend_from_slice(&misses_wide(window, mean)));
        self.narrow.iter().for_each(|window| misses.extend_from_slice(&window.misses(mean)));
        misses.retain(|miss| miss.is_finite());
        let middle = misses.len() / 2;
        if misses.is_empty() {
            return None;
        }
        Some(*misses.select_nth_unstable_by(middle, f32::total_cmp).1)
    }

    /// Whether the median distance of this board's sensors from their tares for the readings `mean` is less than
    /// `below`.
    fn misses_by_less(&self, mean: &BoardSample, below: f32) -> bool {
        let wide = self.wide.iter().map(|window| count_misses_wide(window, mean, below));
        let counts = wide.chain(self.narrow.iter().map(|window| window.count_misses(mean, below)));
        let (known, less) = counts.fold((0, 0), |sum, count| (sum.0 + count.0, sum.1 + count.1));
        less > known / 2
    }

    /// Quality of all of its values.
    pub(super) fn quality(&self) -> Quality {
        if !self.stream.presence.is_live() || self.is_taring() {
            Quality::Stale
        } else if self.stream.loss.is_degraded() || self.own_rate.as_ref().is_some_and(|own| own.is_odd()) {
            Quality::Degraded
        } else {
            Quality::Live
        }
    }

    pub(super) const fn is_taring(&self) -> bool {
        matches!(self.tare, TareState::Measuring(_))
    }

    /// Restarts the average of a tare that is being measured.
    pub(super) fn interrupt_tare(&mut self) {
        if let TareState::Measuring(meter) = &mut self.tare {
            meter.interrupt();
        }
    }

    pub(super) fn tare_outcome(&self) -> TareOutcome {
        match self.tare {
            TareState::FromFloor => TareOutcome::FromFloor,
            TareState::Measuring(_) => TareOutcome::Measuring,
            TareState::Taken => TareOutcome::Taken,
            TareState::Refused(outcome) => outcome,
        }
    }

    /// The tare in use, sensor by sensor.
    pub(super) fn tares(&self) -> impl Iterator<Item = (usize, Corner, Newtons)> + '_ {
        self.channels
            .iter()
            .flatten()
            .map(|channel| (channel.tile as usize, channel.corner, Newtons(channel.tare)))
    }

    /// Writes its sample in `buffer` into `frame` and frees the buffer; without a sample there, the last values stay.
    pub(super) fn apply(
        &mut self,
        buffer: Option<usize>,
        sampled_ns: i64,
        buffers: &Buffers,
        frame: &mut ForceFrame,
        health: &mut Health,
        counters: &mut LinkCounters,
    ) {
        let waits = buffer.filter(|&buffer| self.clear(buffer));
        let sample = waits.map(|buffer| buffers.sample(buffer, self.number));
        self.put(sample, sampled_ns, frame, health, counters);
    }

    /// Writes `sample` into `frame`; without one, the last values stay.
    #[inline]
    pub(super) fn put(
        &mut self,
        sample: Option<&BoardSample>,
        sampled_ns: i64,
        frame: &mut ForceFrame,
        health: &mut Health,
        counters: &mut LinkCounters,
    ) {
        if let Some(sample) = sample {
            self.measure_tare(sample, sampled_ns);
        }
        let quality = self.quality();
        match sample {
            Some(sample) if !self.is_taring() => {
                counters.bad_readings += self.write(sample, quality, frame, health);
            }
            _ if quality == Quality::Stale => self.mark_stale(frame),
            _ => {}
        }
    }

    /// Writes calibrated and tared forces; returns the number of bad readings.
    fn write(
        &self,
        sample: &BoardSample,
        quality: Quality,
        frame: &mut ForceFrame,
        health: &mut Health,
    ) -> u64 {
        let trust = Trust { quality, is_swapped: self.is_swapped, is_foreign: health.is_foreign() };
        let mut bad = 0;
        for window in &self.wide {
            bad += put_wide(window, sample, trust, frame, health);
        }
        for window in &self.narrow {
            bad += put_narrow(window, sample, trust, frame, health);
        }
        bad
    }

    fn mark_stale(&self, frame: &mut ForceFrame) {
        for channel in self.channels.iter().flatten() {
            let quality = &mut frame.quality[channel.tile as usize][channel.corner.index()];
            *quality = (*quality).max(Quality::Stale);
        }
    }

    fn measure_tare(&mut self, sample: &BoardSample, sampled_ns: i64) {
        let TareState::Measuring(meter) = &mut self.tare else { return };
        let force = |(number, channel): (usize, &Option<Channel>)| {
            channel.map_or(f32::NAN, |channel| sample.force(number, &channel.calibration))
        };
        let forces = self.channels.iter().enumerate().map(force);
        match meter.add(sampled_ns, forces) {
            None => {}
            Some(TareResult::Quiet(means)) => {
                for (channel, mean) in self.channels.iter_mut().zip(means) {
                    if let (Some(channel), Some(mean)) = (channel, mean) {
                        channel.set_tare(mean);
                    }
                }
                (self.wide, self.narrow) = windows(&self.channels, 4 * self.geometry.tile_count());
                self.tare = TareState::Taken;
            }
            Some(TareResult::Noisy { channel, mean, deviation }) => {
                let sensor = self.channels.get(channel).copied().flatten().map(|channel| SensorId {
                    tile: self.geometry.tile_at_index(channel.tile as usize),
                    corner: channel.corner,
                });
                self.tare = sensor.map_or(TareState::FromFloor, |sensor| {
                    TareState::Refused(TareOutcome::Refused { sensor, mean, deviation })
                });
            }
        }
    }
}
