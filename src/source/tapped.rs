//! Packets of a running floor, for checks of it.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::time::Duration;

use super::{FloorInput, SensorSource, SourceError};
use crate::units::Instant;
use crate::wire::{LinkCounters, SensorPacket};

/// Span of the floor's time in one batch, and maximum number of waiting batches: two seconds.
const BATCH: Duration = Duration::from_millis(8);
const WAITING: usize = 256;

/// The packets of a running floor, copied on demand.
#[derive(Debug)]
pub struct TappedPackets {
    wanted: Arc<AtomicBool>,
    batches: Receiver<Vec<SensorPacket>>,
    lost: Arc<AtomicU64>,
}

/// Copies packets of sources, one source after the other.
#[derive(Clone, Debug)]
pub struct PacketTap {
    wanted: Arc<AtomicBool>,
    batches: SyncSender<Vec<SensorPacket>>,
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
    pub fn take(&self, packet: impl FnMut(&SensorPacket)) {
        let batches: Vec<Vec<SensorPacket>> = self.batches.try_iter().collect();
        batches.iter().flatten().for_each(packet);
    }

    /// Number of packets lost because the reader did not take them in time.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost.load(Ordering::Relaxed)
    }
}

impl PacketTap {
    /// Wraps `input` so that its packets are copied.
    #[must_use]
    pub fn wrap(&self, input: impl Into<FloorInput>) -> FloorInput {
        let input = input.into();
        let source = CopiedSource { inner: input.source, tap: self.clone(), batch: Vec::new() };
        FloorInput { source: Box::new(source), ..input }
    }
}

/// A source whose packets are also copied into batches.
struct CopiedSource {
    inner: Box<dyn SensorSource>,
    tap: PacketTap,
    batch: Vec<SensorPacket>,
}

impl CopiedSource {
    fn copy(&mut self, packet: &SensorPacket) {
        if !self.tap.wanted.load(Ordering::Relaxed) {
            return self.batch.clear();
        }
        self.batch.push(packet.clone());
        let since = |first: &SensorPacket| packet.received.since(first.received);
        if self.batch.first().is_some_and(|first| since(first) >= BATCH) {
            self.hand_on();
        }
    }

    fn hand_on(&mut self) {
        let room = self.batch.len();
        let batch = std::mem::replace(&mut self.batch, Vec::with_capacity(room));
        if let Err(TrySendError::Full(batch)) = self.tap.batches.try_send(batch) {
            self.tap.lost.fetch_add(batch.len() as u64, Ordering::Relaxed);
        }
    }
}

impl SensorSource for CopiedSource {
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        let given = self.inner.next(patience);
        match &given {
            Ok(Some(packet)) => self.copy(packet),
            // A silent floor completes no batch.
            Ok(None) | Err(_) if !self.batch.is_empty() => self.hand_on(),
            Ok(None) | Err(_) => {}
        }
        given
    }

    fn now(&self) -> Instant {
        self.inner.now()
    }

    fn counters(&self) -> LinkCounters {
        self.inner.counters()
    }
}
