//! What other threads tell the window.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::mpsc::Receiver;

use super::feed::LayoutNews;
use crate::layout::Layout;
use crate::widget::{EventKind, Value, WidgetEvent};

/// Events that are kept for the list: some minutes of busy feet.
const KEPT: usize = 500;

/// Notices that are kept; a program that says more says the same again.
const NOTICES: usize = 4;

/// What other threads said, sorted.
pub(super) struct Messages {
    events: Receiver<WidgetEvent>,
    layouts: Receiver<LayoutNews>,
    notices: Receiver<String>,
    /// Events, newest first.
    pub(super) recent: VecDeque<WidgetEvent>,
    /// Events since the window opened.
    pub(super) event_count: u64,
    /// The layout that snapshots belong to.
    pub(super) layout: Arc<Layout>,
    /// Layouts that the engine was given and no snapshot shows yet.
    coming: VecDeque<(Arc<Layout>, u64)>,
    /// What became of the layout file last.
    pub(super) file: Option<FileNote>,
    /// Sentences for the person at the window, oldest first.
    pub(super) notes: VecDeque<String>,
}

/// What became of the layout file last.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FileNote {
    /// The file's name.
    pub(super) name: String,
    /// When it was reported, on the window's clock.
    pub(super) at_s: f64,
    /// All problems; `None` if it was loaded.
    pub(super) diagnostics: Option<String>,
}

impl Messages {
    pub(super) fn new(
        layout: Arc<Layout>,
        events: Receiver<WidgetEvent>,
        layouts: Receiver<LayoutNews>,
        notices: Receiver<String>,
    ) -> Self {
        Self {
            events,
            layouts,
            notices,
            recent: VecDeque::with_capacity(KEPT),
            event_count: 0,
            layout,
            coming: VecDeque::new(),
            file: None,
            notes: VecDeque::new(),
        }
    }

    /// Writes on controls what apps have written on them; `labels` are the latest snapshot's.
    pub(super) fn relabel(&mut self, labels: &[(usize, Arc<str>)]) {
        for (index, label) in labels {
            if self.layout.widgets.get(*index).is_some_and(|widget| *widget.label != **label) {
                let layout = Arc::make_mut(&mut self.layout);
                layout.widgets[*index].label = label.as_ref().to_owned();
            }
        }
    }

    /// Takes in everything that waits; `revision` is the latest snapshot's.
    pub(super) fn receive(&mut self, now_s: f64, revision: u64) {
        for event in self.events.try_iter() {
            self.event_count += 1;
            match self.recent.front_mut() {
                // A slider on its way is one line that follows it, or it would push out everything else.
                Some(newest) if follows(newest, &event) => *newest = event,
                _ => {
                    self.recent.truncate(KEPT - 1);
                    self.recent.push_front(event);
                }
            }
        }
        for news in self.layouts.try_iter() {
            self.file = Some(match news {
                LayoutNews::Loaded { layout, revision, name } => {
                    self.coming.push_back((layout, revision));
                    FileNote { name, at_s: now_s, diagnostics: None }
                }
                LayoutNews::Refused { name, diagnostics } => {
                    FileNote { name, at_s: now_s, diagnostics: Some(diagnostics) }
                }
            });
        }
        while let Some((layout, _)) = self.coming.pop_front_if(|(_, from)| *from <= revision) {
            self.layout = layout;
        }
        for note in self.notices.try_iter() {
            if !self.notes.contains(&note) {
                self.notes.push_back(note);
            }
        }
        while self.notes.len() > NOTICES {
            self.notes.pop_front();
        }
    }
}

/// Whether `next` only says how far a slider has moved on since `last`.
fn follows(last: &WidgetEvent, next: &WidgetEvent) -> bool {
    let moves =
        |event: &WidgetEvent| matches!(event.kind, EventKind::Changed(Value::Number(_) | Value::Pair(_)));
    last.id == next.id && moves(last) && moves(next)
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;
    use crate::scene::sample::map;

    fn named(title: &str) -> Arc<Layout> {
        Arc::new(Layout { title: title.into(), ..map() })
    }

    #[test]
    fn a_layout_is_shown_once_snapshots_belong_to_it() {
        let (news, layouts) = channel();
        let mut messages = Messages::new(named("old"), channel().1, layouts, channel().1);
        for (title, revision) in [("newer", 2), ("newest", 3)] {
            let name = "map.ron".into();
            news.send(LayoutNews::Loaded { layout: named(title), revision, name }).unwrap();
        }
        messages.receive(1.0, 1);
        assert_eq!(messages.layout.title, "old", "a foot was still on it");
        messages.receive(1.1, 2);
        assert_eq!(messages.layout.title, "newer");
        messages.receive(1.2, 9);
        assert_eq!(messages.layout.title, "newest");
    }

    #[test]
    fn a_bad_layout_leaves_the_good_one_until_a_good_one_comes() {
        let (news, layouts) = channel();
        let mut messages = Messages::new(named("good"), channel().1, layouts, channel().1);
        let diagnostics = "map.ron:3:9: unknown field".to_owned();
        news.send(LayoutNews::Refused { name: "map.ron".into(), diagnostics: diagnostics.clone() }).unwrap();
        messages.receive(1.0, 0);
        assert_eq!(messages.layout.title, "good");
        assert_eq!(messages.file.as_ref().unwrap().diagnostics, Some(diagnostics));
        news.send(LayoutNews::Loaded { layout: named("mended"), revision: 1, name: "map.ron".into() })
            .unwrap();
        messages.receive(2.0, 0);
        assert_eq!(messages.file.as_ref().unwrap().diagnostics, None);
    }

    #[test]
    fn the_list_of_events_stays_short_and_the_same_notice_is_said_once() {
        let (event, events) = channel();
        let (say, notices) = channel();
        let mut messages = Messages::new(named("it"), events, channel().1, notices);
        for at in 0..2000 {
            event.send(crate::preview::tests::event(at, "home")).unwrap();
            say.send("no sound card".into()).unwrap();
        }
        messages.receive(1.0, 0);
        assert_eq!(messages.recent.len(), KEPT);
        assert_eq!(messages.event_count, 2000);
        assert_eq!(messages.recent[0].at, crate::units::Instant::from_millis(1999), "newest first");
        assert_eq!(messages.notes, ["no sound card"]);
    }

    #[test]
    fn a_slider_on_its_way_is_one_line() {
        let (event, events) = channel();
        let mut messages = Messages::new(named("it"), events, channel().1, channel().1);
        let moved = |at: u64, id| WidgetEvent {
            kind: EventKind::Changed(Value::Number(at as f32)),
            ..crate::preview::tests::event(at, id)
        };
        let told = [moved(1, "zoom"), moved(2, "zoom"), moved(3, "volume"), moved(4, "zoom")];
        told.into_iter().for_each(|told| event.send(told).unwrap());
        messages.receive(1.0, 0);
        let listed: Vec<_> =
            messages.recent.iter().map(|event| (event.at.micros() / 1000, event.id.as_str())).collect();
        assert_eq!(listed, [(4, "zoom"), (3, "volume"), (2, "zoom")]);
        assert_eq!(messages.event_count, 4);
    }
}
