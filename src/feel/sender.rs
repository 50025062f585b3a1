//! The sending end of the renderer, and the counters of both ends.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use triple_buffer::Input;

use super::evicting_queue::Writer;
use super::{Cue, Spot, SustainedCues};
use crate::units::Instant;

/// Counts of the renderer's faults since it was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FeelCounters {
    /// Cues evicted because 256 newer ones were waiting for the renderer; the oldest go first.
    pub dropped: u64,
    /// Cues sent during silence, or with a muted tile among their spots.
    pub muted: u64,
    /// Cues that were played later than their time.
    pub late: u64,
    /// Spots of cues and of new sustained cues that no actuator can play.
    pub unfelt: u64,
    /// Modes of clicks that cannot be played: not finite, or outside the ranges of [`super::Mode`].
    pub refused: u64,
    /// Ringing modes and lasting voices stolen for others.
    pub stolen: u64,
    /// Samples that were not finite and became silence.
    pub not_finite: u64,
    /// Samples beyond eight full scales, cut off there.
    pub overloaded: u64,
    /// Channels silenced because their samples were not finite or beyond eight full scales.
    pub silenced: u64,
    /// Number of times that an actuator was attenuated because of heat.
    pub heated: u64,
}

/// The state shared by both ends.
#[derive(Debug, Default)]
pub(super) struct SenderState {
    pub(super) muted: AtomicU64,
    pub(super) late: AtomicU64,
    pub(super) unfelt: AtomicU64,
    pub(super) refused: AtomicU64,
    pub(super) stolen: AtomicU64,
    pub(super) not_finite: AtomicU64,
    pub(super) overloaded: AtomicU64,
    pub(super) silenced: AtomicU64,
    pub(super) heated: AtomicU64,
    /// The channel of each tile.
    pub(super) channels: Box<[Option<usize>]>,
    /// The muted channels.
    mutes: Box<[AtomicBool]>,
    /// Changes of `mutes` so far.
    mute_changes: AtomicU64,
    /// Calls of `silence` and `resume` so far: odd means silence. A count rather than a flag, so that the renderer
    /// cannot miss a short silence.
    turns: AtomicU64,
}

impl SenderState {
    /// For tiles with these channels.
    pub(super) fn new(channels: Box<[Option<usize>]>) -> Self {
        let count = channels.iter().flatten().max().map_or(0, |most| most + 1);
        Self { channels, mutes: (0..count).map(|_| AtomicBool::new(false)).collect(), ..Self::default() }
    }

    /// Number of changes of the mutes.
    pub(super) fn mute_changes(&self) -> u64 {
        self.mute_changes.load(Ordering::Acquire)
    }

    /// Whether each of the channels that move tiles is muted.
    pub(super) fn mutes(&self) -> impl Iterator<Item = bool> + '_ {
        self.mutes.iter().map(|muted| muted.load(Ordering::Relaxed))
    }

    pub(super) fn turns(&self) -> u64 {
        self.turns.load(Ordering::Acquire)
    }

    pub(super) fn counters(&self) -> FeelCounters {
        let read = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        FeelCounters {
            dropped: 0,
            muted: read(&self.muted),
            late: read(&self.late),
            unfelt: read(&self.unfelt),
            refused: read(&self.refused),
            stolen: read(&self.stolen),
            not_finite: read(&self.not_finite),
            overloaded: read(&self.overloaded),
            silenced: read(&self.silenced),
            heated: read(&self.heated),
        }
    }
}

/// Adds to a counter; zero, the usual case, costs no memory access.
pub(super) fn count(counter: &AtomicU64, by: u32) {
    if by > 0 {
        counter.fetch_add(u64::from(by), Ordering::Relaxed);
    }
}

/// A cue with the number of changes of silence at its sending.
#[derive(Clone, Debug)]
pub(super) struct NumberedCue {
    pub(super) cue: Cue,
    pub(super) turns: u64,
    /// Time of sending, for measuring latency.
    pub(super) sent: Instant,
}

/// The sensing thread's end of the queue to the renderer; none of its calls blocks or allocates.
#[derive(Debug)]
pub struct CueSender {
    pub(super) cues: Writer<NumberedCue>,
    pub(super) sustained: Input<SustainedCues>,
    pub(super) shared: Arc<SenderState>,
    pub(super) turns: u64,
    /// The time of the last call of `note_time`.
    pub(super) now: Instant,
}

impl CueSender {
    /// Sends a cue to be played; returns whether it is on its way.
    ///
    /// A cue is dropped during silence; a cue that reaches a muted tile is sent, but counted too. If the renderer has
    /// taken none of the last 256 cues, the oldest of them is evicted. All of these are counted.
    pub fn send(&mut self, cue: &Cue) -> bool {
        if self.is_silenced() {
            count(&self.shared.muted, 1);
            return false;
        }
        let is_muted = |spot: &Spot| spot.weight > 0.0 && self.mutes(spot.tile);
        count(&self.shared.muted, u32::from(cue.spots.iter().any(is_muted)));
        self.cues.push(NumberedCue { cue: cue.clone(), turns: self.turns, sent: self.now });
        true
    }

    /// Sets the send time of the next cues, on the clock that stamps packets; only for measuring latency.
    pub(crate) fn note_time(&mut self, now: Instant) {
        self.now = now;
    }

    /// Sets the sustained cues from now on.
    ///
    /// To be called with every frame, also with no sustained cues: the last set stays for 50 ms and then fades out,
    /// in case the sender has stopped.
    pub fn sustain(&mut self, sustained: &SustainedCues) {
        self.cues.flush();
        self.sustained.input_buffer_mut().clone_from(sustained);
        self.sustained.publish();
    }

    /// Fades everything out within 5 ms and drops all cues sent, because sensing is lost or a person stops it.
    ///
    /// No cue can overtake it, and a full ring cannot lose it. Lasts until [`CueSender::resume`].
    pub fn silence(&mut self) {
        if !self.is_silenced() {
            self.turn();
            count(&self.shared.muted, self.cues.take_back());
        }
    }

    /// Ends the silence: plays the cues sent from now on.
    pub fn resume(&mut self) {
        if self.is_silenced() {
            self.turn();
        }
    }

    /// Mutes or unmutes the actuator of tile number `tile` within 5 ms; returns false if the tile has none.
    ///
    /// Its cues go on meanwhile, unfelt. Tiles that share a channel are muted together.
    pub fn mute(&mut self, tile: u16, muted: bool) -> bool {
        let channel = self.shared.channels.get(usize::from(tile)).copied().flatten();
        let Some(mute) = channel.and_then(|channel| self.shared.mutes.get(channel)) else { return false };
        mute.store(muted, Ordering::Relaxed);
        self.shared.mute_changes.fetch_add(1, Ordering::Release);
        true
    }

    /// Whether the actuator of tile number `tile` is muted; false if the tile has none.
    #[must_use]
    pub fn mutes(&self, tile: u16) -> bool {
        let channel = self.shared.channels.get(usize::from(tile)).copied().flatten();
        let mute = channel.and_then(|channel| self.shared.mutes.get(channel));
        mute.is_some_and(|mute| mute.load(Ordering::Relaxed))
    }

    /// Whether [`CueSender::silence`] is in force.
    #[must_use]
    pub(crate) fn is_silenced(&self) -> bool {
        self.turns % 2 == 1
    }

    /// Counts of faults so far.
    #[must_use]
    pub fn counters(&self) -> FeelCounters {
        FeelCounters { dropped: self.cues.dropped(), ..self.shared.counters() }
    }

    fn turn(&mut self) {
        self.turns += 1;
        self.shared.turns.store(self.turns, Ordering::Release);
    }
}
