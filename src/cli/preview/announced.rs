//! A source that tells the window of layouts that come with the packets.

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::Duration;

use underfoot::layout::Layout;
use underfoot::preview::{LayoutCause, LayoutNews, Warnings};
use underfoot::source::{SensorSource, SourceError};
use underfoot::units::Instant;
use underfoot::wire::{LinkCause, LinkCounters, Request, SensorPacket};

/// A recording or a server's floor, that tells the window of layouts that came later.
pub(super) struct AnnouncingSource<S> {
    source: S,
    layouts: Sender<LayoutNews>,
    cause: LayoutCause,
    given: u64,
}

impl<S> AnnouncingSource<S> {
    pub(super) const fn new(source: S, layouts: Sender<LayoutNews>, cause: LayoutCause) -> Self {
        Self { source, layouts, cause, given: 0 }
    }

    /// What to say about a layout.
    fn name(&self, layout: &Layout) -> String {
        match self.cause {
            LayoutCause::Recorded => "recorded change".into(),
            _ => layout.title.clone(),
        }
    }
}

impl<S: SensorSource> SensorSource for AnnouncingSource<S> {
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        self.source.next(patience)
    }

    fn now(&self) -> Instant {
        self.source.now()
    }

    fn take_request(&mut self) -> Option<Request> {
        self.source.take_request()
    }

    fn take_layout(&mut self) -> Option<Layout> {
        let layout = self.source.take_layout()?;
        self.given += 1;
        // A window that is closed need not know.
        let _ = self.layouts.send(LayoutNews::Loaded {
            layout: Arc::new(layout.clone()),
            revision: self.given,
            name: self.name(&layout),
            cause: self.cause,
            warnings: Warnings::default(),
        });
        Some(layout)
    }

    fn answer(&mut self, to: SocketAddr, datagram: &[u8]) {
        self.source.answer(to, datagram);
    }

    fn counters(&self) -> LinkCounters {
        self.source.counters()
    }
}

    fn last_refused(&self) -> Option<LinkCause> {
        self.source.last_refused()
    }
