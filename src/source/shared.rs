//! One object behind several parts of an input.

use std::net::SocketAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::{Incoming, Journal, Port, Replay};
use crate::layout::Layout;
use crate::wire::{LinkCause, Request};

/// An object that several parts of one [`super::FloorInput`] use; all on one thread, so that none of them waits.
#[derive(Debug)]
pub(crate) struct Shared<T>(Arc<Mutex<T>>);

impl<T> Shared<T> {
    pub(crate) fn new(object: T) -> Self {
        Self(Arc::new(Mutex::new(object)))
    }

    pub(crate) fn lock(&self) -> MutexGuard<'_, T> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<T> Clone for Shared<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<P: Port> Port for Shared<P> {
    fn take_request(&mut self) -> Option<Request> {
        self.lock().take_request()
    }

    fn answer(&mut self, to: SocketAddr, datagram: &[u8]) {
        self.lock().answer(to, datagram);
    }

    fn local_addr(&self) -> Option<SocketAddr> {
        self.lock().local_addr()
    }

    fn last_refused(&self) -> Option<LinkCause> {
        self.lock().last_refused()
    }
}

impl<R: Replay> Replay for Shared<R> {
    fn take(&mut self) -> Option<Incoming> {
        self.lock().take()
    }
}

impl<J: Journal> Journal for Shared<J> {
    fn note_request(&mut self, request: &Request) {
        self.lock().note_request(request);
    }

    fn note_layout(&mut self, layout: &mut Layout) {
        self.lock().note_layout(layout);
    }
}
