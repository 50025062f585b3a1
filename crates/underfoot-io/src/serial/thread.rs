//! The thread of one port: opens it, asks, reads, decodes, and opens it again.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{SyncSender, TrySendError};
use std::thread::{Builder, JoinHandle, sleep};
use std::time::Duration;

use tracing::{info, warn};
use underfoot::floor::{Floor, PortName, SerialWire};
use underfoot::rate_limit::RateLimit;
use underfoot::units::{HostClock, Instant};
use underfoot::wire::{LinkCause, LinkCounters};

use super::decode::{PortContent, PortDecoder};
use super::device::{self, Device, PortRead};
use super::{News, SerialError};

/// Minimum time between two notices of the same sort about one port.
const NOTICE_EVERY: Duration = Duration::from_secs(60);

/// Interval between attempts to open a port that is gone.
const AGAIN: Duration = Duration::from_millis(50);

/// Minimum time between two requests: the engine uses at most one sample a millisecond.
const REQUEST_EVERY: Duration = Duration::from_millis(1);

/// Time after which an unanswered request is repeated: half of that after which the link is lost.
const UNANSWERED: Duration = Duration::from_millis(50);

/// Maximum number of bytes read at once.
const BUFFER: usize = 4096;

/// The last request for a line.
struct LastRequest {
    at: Instant,
    is_answered: bool,
}

impl Default for LastRequest {
    /// No request has been sent.
    fn default() -> Self {
        Self { at: Instant::START, is_answered: true }
    }
}

/// The thread of one port.
pub(super) struct PortThread {
    name: PortName,
    baud: u32,
    decoder: PortDecoder,
    clock: HostClock,
    news: SyncSender<News>,
    /// Counts that did not reach the sensing thread yet.
    counted: LinkCounters,
    refusals: RateLimit,
    failures: RateLimit,
}

impl PortThread {
    pub(super) fn new(
        wire: &SerialWire,
        name: PortName,
        floor: &Floor,
        clock: HostClock,
        news: SyncSender<News>,
    ) -> Self {
        Self {
            name,
            baud: wire.baud,
            decoder: PortDecoder::new(wire, floor),
            clock,
            news,
            counted: LinkCounters::default(),
            refusals: RateLimit::new(1, NOTICE_EVERY),
            failures: RateLimit::new(1, NOTICE_EVERY),
        }
    }

    /// Starts with an open device, or waits for one.
    pub(super) fn start(
        mut self,
        device: Option<Device>,
        stop: Arc<AtomicBool>,
    ) -> io::Result<JoinHandle<()>> {
        Builder::new().name("serial port".to_owned()).spawn(move || {
            if device.is_none() {
                warn!("there is no serial port {} yet: waiting for it", self.name);
            }
            let mut device = device;
            while !stop.load(Ordering::Relaxed) {
                match device.take().or_else(|| self.open()) {
                    Some(open) => self.serve(open, &stop),
                    None => sleep(AGAIN),
                }
            }
        })
    }

    /// Opens the port again, if it is there.
    fn open(&mut self) -> Option<Device> {
        match device::open(&self.name, self.baud) {
            Ok(device) => {
                info!("the serial port {} is there", self.name);
                Some(device)
            }
            Err(SerialError::Absent { .. }) => None,
            // Rights may come a moment after the port.
            Err(error) => {
                if self.failures.take((self.clock)()).is_some() {
                    warn!("{error}; trying again");
                }
                None
            }
        }
    }

    /// Reads the port until it is gone or the program stops.
    fn serve(&mut self, mut device: Device, stop: &AtomicBool) {
        self.decoder.restart();
        let mut buffer = [0; BUFFER];
        let mut content = PortContent::default();
        let mut asked = LastRequest::default();
        while !stop.load(Ordering::Relaxed) {
            self.ask(&mut device, &mut asked);
            match device.read(&mut buffer) {
                PortRead::Bytes(count) => {
                    let now = (self.clock)();
                    let bytes = buffer.get(..count).unwrap_or_default();
                    asked.is_answered |= self.decoder.take(bytes, now, &mut content) > 0;
                    self.deliver(&mut content, now);
                }
                PortRead::Nothing => {}
                PortRead::Gone(error) => {
                    warn!(
                        "the serial port {} is gone ({error}): its boards are lost until it is back",
                        self.name
                    );
                    return;
                }
            }
        }
    }

    /// Asks for a line, if the board has to be asked and no answer is due.
    fn ask(&self, device: &mut Device, asked: &mut LastRequest) {
        let request = self.decoder.request();
        let waited = (self.clock)().since(asked.at);
        if request.is_empty() || !(asked.is_answered || waited >= UNANSWERED) {
            return;
        }
        sleep(REQUEST_EVERY.saturating_sub(waited));
        if device.send(request) {
            *asked = LastRequest { at: (self.clock)(), is_answered: false };
        }
    }

    /// Passes `content` to the sensing thread and empties it. Packets beyond the queue are counted and dropped.
    fn deliver(&mut self, content: &mut PortContent, now: Instant) {
        self.counted += std::mem::take(&mut content.counters);
        for packet in content.packets.drain(..) {
            if let Err(TrySendError::Full(_)) = self.news.try_send(News::Packet(packet)) {
                self.counted.overflowed += 1;
            }
        }
        if let Some(why) = content.fault.take() {
            if let Some(others) = self.refusals.take(now) {
                warn!(others_like_it = others, "the serial port {} is not understood: {why}", self.name);
            }
            // The sensing thread needs the latest fault only; without room, an earlier one waits there.
            let cause = LinkCause::PortGarbled { port: self.name.to_string(), why };
            drop(self.news.try_send(News::Refused(cause)));
        }
        if self.counted != LinkCounters::default() && self.news.try_send(News::Counts(self.counted)).is_ok() {
            self.counted = LinkCounters::default();
        }
    }
}
