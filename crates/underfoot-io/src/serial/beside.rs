//! Packets of serial ports beside those of another input.

use std::net::SocketAddr;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use underfoot::source::{FloorInput, Port, SensorSource, SourceError};
use underfoot::units::{HostClock, Instant};
use underfoot::wire::{LinkCause, LinkCounters, Request, SensorPacket};

use super::{News, SerialPorts};

/// Interval between two looks at the other input while no serial port gives a packet. Sockets stamp their packets by
/// themselves, so that it delays decisions and no time.
const LOOK_EVERY: Duration = Duration::from_millis(1);

/// Time for which the fault of a serial port takes precedence over refusals of the network.
const KEPT_FAULT: Duration = Duration::from_secs(2);

/// The last fault of a serial port, which the source writes and the port shows; both are on one thread.
type LastFault = Arc<Mutex<Option<(LinkCause, Instant)>>>;

pub(super) fn beside(ports: SerialPorts, input: FloorInput) -> FloorInput {
    let fault = LastFault::default();
    let port = BesidePort { network: input.port, fault: Arc::clone(&fault), clock: ports.clock.0.clone() };
    let source = BesideSource {
        network: input.source,
        ports,
        fault,
        counters: LinkCounters::default(),
        is_networks_turn: false,
    };
    FloorInput { source: Box::new(source), port: Some(Box::new(port)), ..input }
}

/// The packets of both.
struct BesideSource {
    network: Box<dyn SensorSource>,
    ports: SerialPorts,
    fault: LastFault,
    /// Counts of the serial ports.
    counters: LinkCounters,
    /// Whether the network comes first: both take turns, so that neither keeps the other waiting.
    is_networks_turn: bool,
}

impl BesideSource {
    /// Takes the next packet of a serial port; waits for news at most `patience`.
    fn serial(&mut self, patience: Duration) -> Option<SensorPacket> {
        let mut news = self.ports.news.try_recv().ok();
        if news.is_none() && !patience.is_zero() {
            news = self.ports.news.recv_timeout(patience).ok();
        }
        while let Some(one) = news {
            match one {
                News::Packet(packet) => return Some(packet),
                News::Counts(counts) => self.counters += counts,
                News::Refused(cause) => {
                    let mut fault = self.fault.lock().unwrap_or_else(PoisonError::into_inner);
                    *fault = Some((cause, (self.ports.clock.0)()));
                }
            }
            news = self.ports.news.try_recv().ok();
        }
        None
    }

    fn either(&mut self) -> Result<Option<SensorPacket>, SourceError> {
        self.is_networks_turn = !self.is_networks_turn;
        if self.is_networks_turn {
            let packet = self.network.next(Duration::ZERO)?;
            return Ok(packet.or_else(|| self.serial(Duration::ZERO)));
        }
        match self.serial(Duration::ZERO) {
            None => self.network.next(Duration::ZERO),
            packet => Ok(packet),
        }
    }
}

impl SensorSource for BesideSource {
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        match self.either()? {
            // The caller also notices by the time that passes here that a board is silent.
            None => Ok(self.serial(patience.min(LOOK_EVERY))),
            packet => Ok(packet),
        }
    }

    fn now(&self) -> Instant {
        self.network.now()
    }

    fn counters(&self) -> LinkCounters {
        self.network.counters() + self.counters
    }
}

/// The network's port, with the faults of the serial ports.
struct BesidePort {
    /// `None` if the other input has no network.
    network: Option<Box<dyn Port>>,
    fault: LastFault,
    clock: HostClock,
}

impl Port for BesidePort {
    fn take_request(&mut self) -> Option<Request> {
        self.network.as_mut()?.take_request()
    }

    fn answer(&mut self, to: SocketAddr, datagram: &[u8]) {
        if let Some(network) = &mut self.network {
            network.answer(to, datagram);
        }
    }

    fn local_addr(&self) -> Option<SocketAddr> {
        self.network.as_ref()?.local_addr()
    }

    fn last_refused(&self) -> Option<LinkCause> {
        let fault = self.fault.lock().unwrap_or_else(PoisonError::into_inner);
        let now = (self.clock)();
        let is_recent = |(_, at): &&(LinkCause, Instant)| now.since(*at) < KEPT_FAULT;
        let of_network = || self.network.as_ref().and_then(|network| network.last_refused());
        fault.as_ref().filter(is_recent).map(|(cause, _)| cause.clone()).or_else(of_network)
    }
}
