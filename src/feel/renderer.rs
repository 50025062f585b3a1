//! The renderer: cues in, blocks of samples out. It runs in the audio callback.

use std::sync::Arc;
use std::time::Duration;

use glam::Vec2;
use triple_buffer::{Output as Latest, TripleBuffer};

use super::active_modes::ActiveModes;
use super::click;
use super::evicting_queue::evicting_queue;
use super::loudspeakers::Loudspeakers;
use super::mix::{CueOutput, MixBlock, TileChannels};
use super::rack::{Rack, SampleFaults};
use super::schedule::{Due, SampleClock, Schedule, WAITING};
use super::scope::ScopeWriter;
use super::scope::{ScopeReader, scope};
use super::sender::{CueSender, SenderState, count};
use super::silence::Silence;
use super::voice::{Started, Voices};
use super::{FeelCounters, SustainedCues};
use crate::floor::{Actuator, Drive, Floor, Loudspeaker, Response};
use crate::units::Instant;

/// Maximum number of different modes that ring at once on one channel; a further one steals the weakest.
const MODES_PER_CHANNEL: usize = 64;

/// The configuration of a renderer.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RendererConfig {
    /// Samples per second, 8,000 to 768,000; values outside are clamped.
    pub sample_rate: u32,
    /// Channels in a frame.
    pub channels: usize,
    /// The actuator of each tile, in tile-index order.
    pub actuators: Vec<Option<Actuator>>,
    /// The amplifier and coil of the actuators.
    pub drive: Drive,
    /// The measured response of each tile's actuator, in tile-index order; may be shorter than `actuators`.
    pub responses: Vec<Option<Response>>,
    /// The loudspeakers for cues and sustained cues with an `audio_gain`.
    pub loudspeakers: Vec<Loudspeaker>,
    /// The centre of each tile, in floor metres and tile-index order: the place of the sounds of a tile.
    pub centres: Vec<Vec2>,
    /// Maximum number of frames rendered at once; longer blocks are rendered in parts.
    pub max_block: usize,
    /// Delay between the cause of a cue and its playback, the same for all cues.
    pub delay: Duration,
}

impl RendererConfig {
    /// A renderer for every actuator and loudspeaker of `floor`, in blocks of up to 256 frames and without delay.
    #[must_use]
    pub fn of(floor: &Floor, sample_rate: u32) -> Self {
        Self {
            sample_rate,
            channels: floor.channel_count(),
            actuators: floor.actuators.clone(),
            drive: floor.drive,
            responses: floor.responses.clone(),
            loudspeakers: floor.loudspeakers.clone(),
            centres: floor.geometry.tiles().map(|tile| floor.geometry.centre(tile)).collect(),
            max_block: 256,
            delay: Duration::ZERO,
        }
    }

    /// Sets the delay between the cause of a cue and its playback.
    #[must_use]
    pub fn with_delay(self, delay: Duration) -> Self {
        Self { delay, ..self }
    }
}

/// The two ends of one queue: the sensing thread keeps the [`CueSender`], the audio side the [`Renderer`].
///
/// Allocates all memory.
#[must_use]
pub fn renderer(config: RendererConfig) -> (CueSender, Renderer) {
    let (cues, ring) = evicting_queue(WAITING);
    let (input, sustained) = TripleBuffer::new(&SustainedCues::new()).split();
    let sample_rate = config.sample_rate.clamp(8_000, 768_000);
    let max_block = config.max_block.clamp(1, 8192);
    let wiring = TileChannels::new(config.actuators, config.channels);
    let shared = Arc::new(SenderState::new(wiring.channels().collect()));
    let sender =
        CueSender { cues, sustained: input, shared: Arc::clone(&shared), turns: 0, now: Instant::START };

    let mut rack = Rack::new(sample_rate, config.channels);
    for (tile, channel) in wiring.channels().enumerate() {
        if let Some(channel) = channel {
            let response = config.responses.get(tile).and_then(Option::as_ref);
            rack.add_actuator(channel, &config.drive, response);
        }
    }
    let renderer = Renderer {
        sample_rate,
        channels: config.channels,
        max_block,
        delay: config.delay,
        wiring,
        loudspeakers: Loudspeakers::new(&config.loudspeakers, config.centres, config.channels),
        shared,
        silence: Silence::new(sample_rate),
        schedule: Schedule::new(ring),
        clock: SampleClock::new(sample_rate),
        sustained,
        modes: ActiveModes::new(sample_rate, config.channels, MODES_PER_CHANNEL),
        voices: Voices::new(sample_rate as f32, config.channels),
        voiced: 0,
        mix: MixBlock::new(config.channels, max_block),
        rack,
        gains: vec![0.0; max_block],
        onsets: Vec::with_capacity(WAITING),
        scope: None,
    };
    (sender, renderer)
}

/// The first sample of a cue that moves a plate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Onset {
    /// Its frame in the last block.
    pub frame: usize,
    /// Arrival time of the packet that caused it.
    pub received: Instant,
    /// Time at which its cue was sent, as set by `CueSender::note_time`.
    pub sent: Instant,
}

/// Turns cues into actuator samples.
///
/// There are two ways to drive it. In lockstep, for files and tests, [`Renderer::render`] gets the start of each
/// block on the clock of the cues, and each cue begins at its own sample. A device with a clock of its own calls
/// [`Renderer::render_now`], and each cue begins with the next block; or it estimates each block's start on the cues'
/// clock and calls [`Renderer::render`] with a delay long enough that no cue comes late: then all cues have the same
/// latency.
///
/// # Real-time
/// Rendering does not allocate, lock, log, block or enter the system.
#[derive(Debug)]
pub struct Renderer {
    sample_rate: u32,
    channels: usize,
    max_block: usize,
    delay: Duration,
    wiring: TileChannels,
    loudspeakers: Loudspeakers,
    shared: Arc<SenderState>,
    silence: Silence,
    schedule: Schedule,
    clock: SampleClock,
    sustained: Latest<SustainedCues>,
    modes: ActiveModes,
    voices: Voices,
    /// Frames of the block at hand that the voices have rendered.
    voiced: usize,
    mix: MixBlock,
    rack: Rack,
    gains: Vec<f32>,
    onsets: Vec<Onset>,
    scope: Option<ScopeWriter>,
}

impl Renderer {
    /// Samples per second.
    #[must_use]
    pub fn sample_rate(&self) -> u32 {
        self.sample_rate
    }

    /// Channels in a frame.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Maximum number of frames rendered at once.
    #[must_use]
    pub(crate) fn max_block(&self) -> usize {
        self.max_block
    }

    /// Delay between the cause of a cue and its playback.
    #[must_use]
    pub fn delay(&self) -> Duration {
        self.delay
    }

    /// Counts of faults so far.
    #[must_use]
    pub fn counters(&self) -> FeelCounters {
        FeelCounters { dropped: self.schedule.dropped(), ..self.shared.counters() }
    }

    /// A view of the played samples, for another thread; `None` without channels. A second call disconnects the first
    /// view.
    ///
    /// Takes memory, so it belongs before the start.
    pub fn scope(&mut self) -> Option<ScopeReader> {
        if self.channels == 0 {
            return None;
        }
        let (writer, reader) = scope(self.channels, self.sample_rate as f32);
        self.scope = Some(writer);
        Some(reader)
    }

    /// The cues with their first moving sample in the last block, in order.
    #[must_use]
    pub fn onsets(&self) -> &[Onset] {
        &self.onsets
    }

    /// Drops all cues sent so far and all sounds; later cues start from silence.
    ///
    /// For a device that was away: the cues of the meanwhile must not be felt all at once. Dropped cues count as
    /// muted.
    pub fn restart(&mut self) {
        count(&self.shared.muted, self.schedule.forget_all());
        self.modes.clear();
        self.rack.clear();
        self.voices.clear();
        self.clock.forget();
        self.onsets.clear();
        self.silence.restart(self.sample_rate, &self.shared);
    }

    /// Fills `out` with the frames from `block_start` on, each cue at its own sample.
    ///
    /// `out` is interleaved, [`Renderer::channels`] wide; samples that make no whole frame are zero. A cue is due at
    /// its time plus the delay, on the nearest sample. A cue with a past time starts with the block and counts as
    /// late; a cue for a later block waits. Blocks may leave gaps.
    ///
    /// # Real-time
    /// No allocation, lock, log or system call.
    pub fn render(&mut self, out: &mut [f32], block_start: Instant) {
        self.update_silence();
        self.clock.begin(block_start);
        let (clock, delay) = (&self.clock, self.delay);
        self.schedule.arrange(|cue| clock.frame_of(cue.at + delay));
        let frames = self.render_block(out);
        self.clock.advance(frames);
    }

    /// Fills `out` with the next frames; every cue that has arrived starts with the first of them.
    ///
    /// As [`Renderer::render`], but the cues' times and the delay are not used, and no cue is late.
    ///
    /// # Real-time
    /// No allocation, lock, log or system call.
    pub fn render_now(&mut self, out: &mut [f32]) {
        self.update_silence();
        self.clock.forget();
        self.schedule.arrange(|_| 0);
        self.render_block(out);
    }

    fn render_block(&mut self, out: &mut [f32]) -> usize {
        self.onsets.clear();
        if self.channels == 0 {
            out.fill(0.0);
            return 0;
        }
        if self.sustained.update() {
            let started =
                self.voices.follow(self.sustained.output_buffer(), &self.wiring, &self.loudspeakers);
            note(&self.shared, started);
        }
        let whole = out.len() - out.len() % self.channels;
        let (out, rest) = out.split_at_mut(whole);
        rest.fill(0.0);
        for (part, out) in out.chunks_mut(self.max_block * self.channels).enumerate() {
            self.render_part(out, part * self.max_block);
        }
        whole / self.channels
    }

    /// Sets the ramp and the mutes as the sender requests.
    fn update_silence(&mut self) {
        self.silence.update(&self.shared, &mut self.schedule, &mut self.rack);
    }

    /// Renders up to `max_block` frames; the first is number `first` of the block.
    fn render_part(&mut self, out: &mut [f32], first: usize) {
        let frames = out.len() / self.channels;
        if self.silence.ramp().is_down() {
            out.fill(0.0);
        } else {
            self.mix.begin(frames);
            if !self.silence.ramp().is_falling() {
                self.strike_cues(first, frames);
            }
            let stolen = self.modes.finish_rows(frames, &mut self.mix);
            count(&self.shared.stolen, stolen);
            self.voices.render(&mut self.mix, self.voiced, frames);
            self.voiced = 0;
            self.silence.fill(&mut self.gains[..frames]);
            let faults = self.rack.process(&mut self.modes, &self.mix, &self.gains[..frames], out);
            self.count(faults);
            if self.silence.ramp().is_down() {
                self.modes.clear();
                self.rack.clear();
                self.voices.clear();
            }
        }
        if let Some(scope) = &mut self.scope {
            scope.observe(out);
        }
    }

    /// Strikes every cue that is due in this part, rendering each bank up to the cue's sample first.
    fn strike_cues(&mut self, first: usize, frames: usize) {
        for Due { frame, cue, sent, .. } in self.schedule.take_before(first + frames) {
            // An estimated clock varies by a sample; that is not late.
            count(&self.shared.late, u32::from(frame < -1));
            let frame = usize::try_from(frame).unwrap_or(0).clamp(first, first + frames - 1);
            let mut felt = false;
            if let Some(tone) = &cue.tone {
                // Voices go on up to the tone's own sample.
                self.voices.render(&mut self.mix, self.voiced, frame - first);
                self.voiced = frame - first;
                let started = self.voices.start(&cue, tone, &self.wiring, &self.loudspeakers);
                felt = (started.unfelt as usize) < cue.spots.len();
                note(&self.shared, started);
            }
            let mut strike = |weight: f32, output: CueOutput| {
                let bell = self.modes.strikable(output.channel, frame - first, &mut self.mix);
                let gain = cue.click.level.0 * weight * output.per_newton;
                let struck = click::strike(bell, &cue.click, gain);
                count(&self.shared.refused, struck.refused);
                count(&self.shared.stolen, struck.stolen);
                struck.modes > 0
            };
            let struck_spots = cue.spots.iter().filter(|_| !cue.click.modes.is_empty());
            for spot in struck_spots {
                let Some(output) = self.wiring.output(spot.tile) else {
                    count(&self.shared.unfelt, 1);
                    continue;
                };
                felt |= strike(spot.weight, output);
                if cue.manner.duck_db > 0.0 {
                    self.voices.duck(output.channel, &cue.manner, 0.5 * cue.click.length_s());
                }
            }
            if !cue.click.modes.is_empty() {
                for output in self.loudspeakers.pan(&cue.spots, cue.audio_gain, cue.heard_at) {
                    strike(1.0, output);
                    if cue.manner.duck_db > 0.0 {
                        self.voices.duck(output.channel, &cue.manner, 0.5 * cue.click.length_s());
                    }
                }
            }
            if felt && self.onsets.len() < WAITING {
                self.onsets.push(Onset { frame, received: cue.received, sent });
            }
        }
    }

    fn count(&self, faults: SampleFaults) {
        count(&self.shared.not_finite, faults.not_finite);
        count(&self.shared.overloaded, faults.overloaded);
        count(&self.shared.silenced, faults.silenced);
        count(&self.shared.heated, faults.heated);
    }
}

fn note(shared: &SenderState, started: Started) {
    count(&shared.unfelt, started.unfelt);
    count(&shared.stolen, started.stolen);
}
