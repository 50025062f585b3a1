//! The socket as the input of a floor: its packets and its port.

use std::net::SocketAddr;
use std::time::Duration;

use super::UdpSource;
use crate::source::{FloorInput, Port, SensorSource, Shared, SourceError};
use crate::units::Instant;
use crate::wire::{LinkCause, LinkCounters, Request, SensorPacket};

impl From<UdpSource> for FloorInput {
    fn from(source: UdpSource) -> Self {
        let source = Shared::new(source);
        Self { port: Some(Box::new(source.clone())), ..Self::from(source) }
    }
}

impl SensorSource for Shared<UdpSource> {
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        self.lock().next(patience)
    }

    fn now(&self) -> Instant {
        self.lock().now()
    }

    fn counters(&self) -> LinkCounters {
        self.lock().counters()
    }
}

impl Port for UdpSource {
    fn take_request(&mut self) -> Option<Request> {
        self.requests.pop_front().or_else(|| self.timed.take(self.now()))
    }

    /// Logs an answer that does not reach its receiver.
    fn answer(&mut self, to: SocketAddr, datagram: &[u8]) {
        // From the port that received the request.
        let socket = self.commands.as_ref().map_or(&self.socket, |(socket, _)| socket);
        if let Err(error) = socket.send_to(datagram, to) {
            let now = Instant::START + self.started.elapsed();
            self.log.unanswered(now, to, &error);
        }
    }

    fn local_addr(&self) -> Option<SocketAddr> {
        self.socket.local_addr().ok()
    }

    fn last_refused(&self) -> Option<LinkCause> {
        self.last_refused.as_ref().map(|(cause, _)| cause.clone())
    }
}
