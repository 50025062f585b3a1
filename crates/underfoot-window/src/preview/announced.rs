//! A replay that reports its layouts to the window.

use std::sync::Arc;
use std::sync::mpsc::{SyncSender, TrySendError};

use super::feed::{LayoutCause, LayoutNews, Warnings};
use underfoot::layout::Layout;
use underfoot::source::{FloorInput, Incoming, Replay};

/// The requests and layouts of a recording or of a server; reports the layouts to the window.
struct AnnouncingReplay {
    replay: Box<dyn Replay>,
    layouts: SyncSender<LayoutNews>,
    cause: LayoutCause,
    given: u64,
    /// The latest layout that the window had no room for.
    late: Option<LayoutNews>,
}

/// Returns the input of a recording or of a server's floor, with later layouts reported to the window.
#[must_use]
pub fn announced(
    input: impl Into<FloorInput>,
    layouts: SyncSender<LayoutNews>,
    cause: LayoutCause,
) -> FloorInput {
    let mut input = input.into();
    input.replay = input.replay.map(|replay| -> Box<dyn Replay> {
        Box::new(AnnouncingReplay { replay, layouts, cause, given: 0, late: None })
    });
    input
}

impl AnnouncingReplay {
    /// Reports to the window, now or before the next packet: the sensing thread never waits for it.
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

impl Replay for AnnouncingReplay {
    fn take(&mut self) -> Option<Incoming> {
        if let Some(news) = self.late.take() {
            self.tell(news);
        }
        let taken = self.replay.take()?;
        if let Incoming::Layout(layout) = &taken {
            self.given += 1;
            self.tell(LayoutNews::Loaded {
                layout: Arc::new(Layout::clone(layout)),
                revision: self.given,
                name: self.name(layout),
                cause: self.cause,
                warnings: Warnings::default(),
            });
        }
        Some(taken)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::sync_channel;

    use underfoot::floor::Floor;
    use underfoot::source::UdpSource;
    use underfoot::wire::{ControlMessage, Request};

    use super::*;

    /// A request, then a layout.
    struct Two(Vec<Incoming>);

    impl Replay for Two {
        fn take(&mut self) -> Option<Incoming> {
            self.0.pop()
        }
    }

    #[test]
    fn requests_and_layouts_get_through_and_the_window_gets_the_layouts() {
        let source = UdpSource::bind(([127, 0, 0, 1], 0).into(), &Floor::default()).unwrap();
        let two = Two(vec![
            Incoming::Layout(Box::new(Layout { title: "second".into(), ..Layout::default() })),
            Incoming::Request(Request::from(ControlMessage::GetMute)),
        ]);
        let input = FloorInput { replay: Some(Box::new(two)), ..source.into() };
        let (layouts, told) = sync_channel(4);
        let input = announced(input, layouts, LayoutCause::Served);
        assert!(input.port.is_some());
        let mut replay = input.replay.unwrap();
        assert!(matches!(replay.take(), Some(Incoming::Request(_))));
        assert!(told.try_recv().is_err(), "a request is no layout");
        let Some(Incoming::Layout(layout)) = replay.take() else { panic!("a layout") };
        assert!(replay.take().is_none());
        let Ok(LayoutNews::Loaded { name, revision, .. }) = told.try_recv() else { panic!("a report") };
        assert_eq!((layout.title, name, revision), ("second".into(), "second".into(), 1));
    }
}
