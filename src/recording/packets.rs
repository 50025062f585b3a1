//! Packets of a running floor, for checks of it.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::time::Duration;

use super::entry::Entry;
use super::tap::{Entries, EntrySink, tapped};
use crate::floor::Geometry;
use crate::source::FloorInput;
use crate::wire::SensorPacket;

/// Span of the floor's time in one batch, and maximum number of waiting batches: two seconds.
const BATCH: Duration = Duration::from_millis(8);
const WAITING: usize = 256;

/// The packets of a running floor, copied on demand.
#[derive(Debug)]
pub struct TappedPackets {
    wanted: Arc<AtomicBool>,
    batches: Receiver<Entries>,
    lost: Arc<AtomicU64>,
}

/// Copies packets of sources, one source after the other.
#[derive(Clone, Debug)]
pub struct PacketTap {
    wanted: Arc<AtomicBool>,
    batches: SyncSender<Entries>,
    lost: Arc<AtomicU64>,
}

impl TappedPackets {
    /// Returns the packets, and the tap that copies them; the tap copies nothing before [`Self::want`].
    #[must_use]
    pub fn new() -> (PacketTap, Self) {
        let (wanted, lost) = (Arc::<AtomicBool>::default(), Arc::<AtomicU64>::default());
        let (sender, batches) = sync_channel(WAITING);
        let tap = PacketTap { wanted: Arc::clone(&wanted), batches: sender, lost: Arc::clone(&lost) };
        (tap, Self { wanted, batches, lost })
    }

    /// Switches the copying of packets on or off.
    pub fn want(&self, wanted: bool) {
        self.wanted.store(wanted, Ordering::Relaxed);
    }

    /// Calls `packet` for all packets since the last call, in their order.
    pub fn take(&self, mut packet: impl FnMut(&SensorPacket)) {
        for (_, entry) in self.batches.try_iter().flatten() {
            if let Entry::Packet(one) = &entry {
                packet(one);
            }
        }
    }

    /// Number of packets lost because the reader did not take them in time.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost.load(Ordering::Relaxed)
    }
}

impl PacketTap {
    /// Wraps `input`, on a floor of this geometry, so that its packets are copied.
    #[must_use]
    pub fn wrap(&self, input: impl Into<FloorInput>, geometry: Geometry) -> FloorInput {
        tapped(input.into(), self.clone(), geometry)
    }
}

impl EntrySink for PacketTap {
    fn is_wanted(&self) -> bool {
        self.wanted.load(Ordering::Relaxed)
    }

    fn batch(&self) -> Duration {
        BATCH
    }

    fn is_exact(&self) -> bool {
        false
    }

    fn hand(&self, entries: Entries) -> Option<Entries> {
        match self.batches.try_send(entries) {
            Ok(()) | Err(TrySendError::Disconnected(_)) => None,
            Err(TrySendError::Full(entries)) => Some(entries),
        }
    }

    fn count_lost(&self, entries: u64) {
        self.lost.fetch_add(entries, Ordering::Relaxed);
    }
}
