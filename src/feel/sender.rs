//! The sending end of the renderer, and what both ends count.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use triple_buffer::Input;

use super::evicting_queue::Writer;
use super::{Cue, Spot, SustainedCues};
use crate::units::Instant;

/// What the renderer could not do, counted since it was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FeelCounters {
    /// Cues that the renderer had not taken when 256 newer ones were waiting: the oldest are evicted first.
    pub dropped: u64,
    /// Cues that came while everything was silenced, or a tile that they reach was muted.
    pub muted: u64,
    /// Cues that were played later than their time.
    pub late: u64,
    /// Spots of cues and of new sustained cues that no actuator can play.
    pub unfelt: u64,
    /// Modes of clicks that cannot be played: not finite, or outside the ranges of [`super::Mode`].
    pub refused: u64,
    /// Ringing modes and lasting voices that had to make room for others.
    pub stolen: u64,
    /// Samples that were not finite and became silence.
    pub not_finite: u64,
    /// Samples beyond eight full scales, cut off there.
    pub overloaded: u64,
    /// Channels whose voices were silenced because their samples were not finite or beyond eight full scales.
    pub silenced: u64,
    /// Times that an actuator began to be turned down because it was driven too long.
    pub heated: u64,
}

/// What both ends share.
#[derive(Debug, Default)]
pub(super) struct Shared {
    pub(super) muted: AtomicU64,
    pub(super) late: AtomicU64,
    pub(super) unfelt: AtomicU64,
    pub(super) refused: AtomicU64,
    pub(super) stolen: AtomicU64,
    pub(super) not_finite: AtomicU64,
    pub(super) overloaded: AtomicU64,
    pub(super) silenced: AtomicU64,
    pub(super) heated: AtomicU64,
    /// Which channel moves each tile.
    pub(super) channels: Box<[Option<usize>]>,
    /// Which channels are muted.
    mutes: Box<[AtomicBool]>,
    /// Changes of `mutes` so far.
    mute_changes: AtomicU64,
    /// Calls of `silence` and `resume` so far: odd means silence. A count, not
    /// a flag, so that the renderer can't miss a silence that was soon lifted.
    turns: AtomicU64,
}

impl Shared {
    /// For tiles that these channels move.
    pub(super) fn new(channels: Box<[Option<usize>]>) -> Self {
        let count = channels.iter().flatten().max().map_or(0, |most| most + 1);
        Self { channels, mutes: (0..count).map(|_| AtomicBool::new(false)).collect(), ..Self::default() }
    }

    /// How often mutes have changed.
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

/// Adds to a counter; in the usual case of zero, nothing is touched.
pub(super) fn count(counter: &AtomicU64, by: u32) {
    if by > 0 {
        counter.fetch_add(u64::from(by), Ordering::Relaxed);
    }
}

/// A cue on its way, and how often silence had been turned on and off when it left.
#[derive(Clone, Debug)]
pub(super) struct Message {
    pub(super) cue: Cue,
    pub(super) turns: u64,
    /// When it left, for measuring latency.
    pub(super) sent: Instant,
}

/// The sensing thread's end of the wire to the renderer; none of its calls waits or allocates.
#[derive(Debug)]
pub struct CueSender {
    pub(super) cues: Writer<Message>,
    pub(super) sustained: Input<SustainedCues>,
    pub(super) shared: Arc<Shared>,
    pub(super) turns: u64,
    /// The time as it was last told.
    pub(super) now: Instant,
}

impl CueSender {
    /// Sends a cue to be played; the answer is whether it is on its way.
    ///
    /// It isn't if everything is silenced; one that reaches a muted tile is, but counted too. If the renderer has
    /// not taken any of the last 256 cues, the oldest of them is evicted. All of it is counted.
    pub fn send(&mut self, cue: &Cue) -> bool {
        if self.is_silenced() {
            count(&self.shared.muted, 1);
            return false;
        }
        let is_muted = |spot: &Spot| spot.weight > 0.0 && self.mutes(spot.tile);
        count(&self.shared.muted, u32::from(cue.spots.iter().any(is_muted)));
        self.cues.push(Message { cue: cue.clone(), turns: self.turns, sent: self.now });
        true
    }

    /// Says what time it is when the next cues are sent, on the clock that stamps packets; only for measuring latency.
    pub(crate) fn note_time(&mut self, now: Instant) {
        self.now = now;
    }

    /// Says what lasts, and how, from now on.
    ///
    /// To be called with every frame, also with no sustained cues: what was said last
    /// holds for 50 ms and then fades out, in case whoever sends has died.
    pub fn sustain(&mut self, sustained: &SustainedCues) {
        self.cues.flush();
        self.sustained.input_buffer_mut().clone_from(sustained);
        self.sustained.publish();
    }

    /// Fades everything out within 5 ms and forgets all cues that were sent, because sensing is lost or somebody says
    /// stop.
    ///
    /// It cannot be overtaken or lost in a full ring. Lasts until [`CueSender::resume`].
    pub fn silence(&mut self) {
        if !self.is_silenced() {
            self.turn();
            count(&self.shared.muted, self.cues.take_back());
        }
    }

    /// Plays what is sent from now on.
    pub fn resume(&mut self) {
        if self.is_silenced() {
            self.turn();
        }
    }

    /// Mutes the actuator of tile number `tile` within 5 ms, or lets it be felt again; false if nothing moves that
    /// tile.
    ///
    /// What it would play goes on meanwhile, unfelt. Tiles that share a channel are muted together.
    pub fn mute(&mut self, tile: u16, muted: bool) -> bool {
        let channel = self.shared.channels.get(usize::from(tile)).copied().flatten();
        let Some(mute) = channel.and_then(|channel| self.shared.mutes.get(channel)) else { return false };
        mute.store(muted, Ordering::Relaxed);
        self.shared.mute_changes.fetch_add(1, Ordering::Release);
        true
    }

    /// Whether the actuator of tile number `tile` is muted; false if nothing moves that tile.
    #[must_use]
    pub fn mutes(&self, tile: u16) -> bool {
        let channel = self.shared.channels.get(usize::from(tile)).copied().flatten();
        let mute = channel.and_then(|channel| self.shared.mutes.get(channel));
        mute.is_some_and(|mute| mute.load(Ordering::Relaxed))
    }

    /// Whether [`CueSender::silence`] holds.
    #[must_use]
    pub(crate) fn is_silenced(&self) -> bool {
        self.turns % 2 == 1
    }

    /// What could not be done so far.
    #[must_use]
    pub fn counters(&self) -> FeelCounters {
        FeelCounters { dropped: self.cues.dropped(), ..self.shared.counters() }
    }

    fn turn(&mut self) {
        self.turns += 1;
        self.shared.turns.store(self.turns, Ordering::Release);
    }
}
