//! A source that reports layouts among the packets to the window.

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::mpsc::{SyncSender, TrySendError};
use std::time::Duration;

use underfoot::layout::Layout;
use underfoot::source::{SensorSource, SourceError};
use underfoot::units::Instant;
use underfoot::wire::{LinkCause, LinkCounters, Request, SensorPacket};
use underfoot_window::preview::{LayoutCause, LayoutNews, Warnings};

/// A recording or a server's floor that reports later layouts to the window.
pub(super) struct AnnouncingSource<S> {
    source: S,
    layouts: SyncSender<LayoutNews>,
    cause: LayoutCause,
    given: u64,
    /// The latest layout that the window had no room for.
    late: Option<LayoutNews>,
}

impl<S> AnnouncingSource<S> {
    pub(super) const fn new(source: S, layouts: SyncSender<LayoutNews>, cause: LayoutCause) -> Self {
        Self { source, layouts, cause, given: 0, late: None }
    }

    /// Reports to the window, now or with the next packet: the sensing thread never waits for it.
    fn tell(&mut self, news: LayoutNews) {
        // A closed window needs no report.
        if let Err(TrySendError::Full(news)) = self.layouts.try_send(news) {
            self.late = Some(news);
        }
    }

    /// The name of a layout in reports.
    fn name(&self, layout: &Layout) -> String {
        match self.cause {
            LayoutCause::Recorded => "recorded change".into(),
            _ => layout.title.clone(),
        }
    }
}

impl<S: SensorSource> SensorSource for AnnouncingSource<S> {
    fn next(&mut self, patience: Duration) -> Result<Option<SensorPacket>, SourceError> {
        if let Some(news) = self.late.take() {
            self.tell(news);
        }
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
        self.tell(LayoutNews::Loaded {
            layout: Arc::new(layout.clone()),
            revision: self.given,
            name: self.name(&layout),
            cause: self.cause,
            warnings: Warnings::default(),
        });
        Some(layout)
    }

    fn local_addr(&self) -> Option<SocketAddr> {
        self.source.local_addr()
    }

    fn answer(&mut self, to: SocketAddr, datagram: &[u8]) {
        self.source.answer(to, datagram);
    }

    fn counters(&self) -> LinkCounters {
        self.source.counters()
    }

    fn last_refused(&self) -> Option<LinkCause> {
        self.source.last_refused()
    }
}
