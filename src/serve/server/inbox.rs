//! Requests and layouts from outside the program.

use std::net::SocketAddr;

use crate::layout::Layout;
use crate::source::{Incoming, Journal, Port, Replay};
use crate::wire::{LinkCause, Request};

/// Requests and layouts that wait for the server; every journal notes each one.
pub(super) struct Inbox {
    pub(super) port: Option<Box<dyn Port>>,
    pub(super) replay: Option<Box<dyn Replay>>,
    pub(super) journals: Vec<Box<dyn Journal>>,
}

impl Inbox {
    /// The next request or layout, noted; those of the port first.
    pub(super) fn take(&mut self) -> Option<Incoming> {
        let request = self.port.as_mut().and_then(|port| port.take_request()).map(Incoming::Request);
        let mut taken = request.or_else(|| self.replay.as_mut()?.take())?;
        match &mut taken {
            Incoming::Request(request) => self.note_request(request),
            Incoming::Layout(layout) => self.note_layout(layout),
        }
        Some(taken)
    }

    /// Notes a request of the program's own app.
    pub(super) fn note_request(&mut self, request: &Request) {
        self.journals.iter_mut().for_each(|journal| journal.note_request(request));
    }

    /// Notes a layout of the program's own app; an exact journal replaces it by the form that it stores.
    pub(super) fn note_layout(&mut self, layout: &mut Layout) {
        self.journals.iter_mut().for_each(|journal| journal.note_layout(layout));
    }

    /// Answers the sender of a request.
    pub(super) fn answer(&mut self, to: SocketAddr, datagram: &[u8]) {
        if let Some(port) = &mut self.port {
            port.answer(to, datagram);
        }
    }

    /// The cause of the port's last refusal; see [`Port::last_refused`].
    pub(super) fn last_refused(&self) -> Option<LinkCause> {
        self.port.as_ref()?.last_refused()
    }
}
