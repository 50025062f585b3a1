//! Messages from other threads to the window.

use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::mpsc::Receiver;
use std::time::Duration;

use super::channels::Notice;
use super::feed::{EventNews, LayoutCause, LayoutNews, Warnings};
use super::near_misses::NearMiss;
use underfoot::engine::{IgnoredPress, Snapshot};
use underfoot::layout::Layout;
use underfoot::messages::MessageNews;
use underfoot::units::Instant;
use underfoot::widget::{EventKind, Value, WidgetEvent};

/// Maximum number of lines in the list of events: some minutes with busy feet.
const KEPT: usize = 500;

/// Maximum number of notices; a program with more of them repeats itself.
const NOTICES: usize = 4;

/// Pause after which the next ground event starts a new line.
const SAME_WALK: Duration = Duration::from_secs(2);

/// One line of the list of events.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Happened {
    /// A control's event.
    Event(WidgetEvent),
    /// A control or a foot gave a message to another program.
    Sent(MessageNews),
    /// A control did not answer a press.
    Ignored(IgnoredPress),
    /// A press beside a control.
    NearMiss(NearMiss),
    /// A ground event: ice cracked, or other ground yielded.
    GroundEvent {
        /// Index of the ground in the layout.
        ground: usize,
        /// Its material.
        material: &'static str,
        /// Number of its events.
        count: u64,
        /// Time of the last event.
        at: Instant,
    },
}

impl Happened {
    fn at(&self) -> Instant {
        match self {
            Self::Event(event) => event.at,
            Self::Sent(news) => news.at,
            Self::Ignored(press) => press.at,
            Self::NearMiss(miss) => miss.at,
            Self::GroundEvent { at, .. } => *at,
        }
    }
}

/// The messages from other threads, sorted.
pub(super) struct WindowMessages {
    events: Receiver<EventNews>,
    layouts: Receiver<LayoutNews>,
    notices: Receiver<Notice>,
    /// The list of events, newest first.
    pub(super) recent: VecDeque<Happened>,
    /// The event counter of each ground in the last frame.
    counted: Vec<u64>,
    /// Events since the window opened: events of controls, ignored presses, and lines of ground events.
    pub(super) event_count: u64,
    /// The layout to which snapshots belong.
    pub(super) layout: Arc<Layout>,
    /// Layouts that the engine has received, before the first snapshot of each.
    coming: VecDeque<(Arc<Layout>, u64)>,
    /// The result of the last change to the layout file.
    pub(super) file: Option<FileNote>,
    /// Whether files of the layout have changed.
    pub(super) files_changed: bool,
    /// The problems of the layout that affect feet or eyes.
    pub(super) warnings: Warnings,
    /// Messages for the user, oldest first.
    pub(super) notes: VecDeque<String>,
    /// The message about the sound, until there is something to hear.
    silence: Option<String>,
}

/// The result of the last change to the layout file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FileNote {
    /// The file's name.
    pub(super) name: String,
    /// Time of the report, on the window's clock.
    pub(super) at_s: f64,
    /// All problems; `None` if it was loaded.
    pub(super) diagnostics: Option<String>,
    /// The reason for the new layout; `None` if it was refused.
    pub(super) cause: Option<LayoutCause>,
}

impl FileNote {
    /// Whether the layout changed by editing or by the recording, so that the user needs no message.
    pub(super) fn came_by_itself(&self) -> bool {
        matches!(self.cause, Some(LayoutCause::Designed | LayoutCause::Recorded))
    }
}

impl WindowMessages {
    pub(super) fn new(
        layout: Arc<Layout>,
        events: Receiver<EventNews>,
        layouts: Receiver<LayoutNews>,
        notices: Receiver<Notice>,
    ) -> Self {
        Self {
            events,
            layouts,
            notices,
            recent: VecDeque::with_capacity(KEPT),
            counted: Vec::new(),
            event_count: 0,
            layout,
            coming: VecDeque::new(),
            file: None,
            files_changed: false,
            warnings: Warnings::default(),
            notes: VecDeque::new(),
            silence: None,
        }
    }

    /// Applies the labels that apps have set to the controls; `labels` come from the latest snapshot.
    pub(super) fn relabel(&mut self, labels: &[(usize, Arc<str>)]) {
        for (index, label) in labels {
            if self.layout.widgets.get(*index).is_some_and(|widget| *widget.label != **label) {
                let layout = Arc::make_mut(&mut self.layout);
                layout.widgets[*index].label = label.as_ref().to_owned();
            }
        }
    }

    /// Takes in all waiting messages; `revision` is that of the latest snapshot.
    pub(super) fn receive(&mut self, now_s: f64, revision: u64) {
        for event in self.events.try_iter() {
            let event = match event {
                EventNews::Event(event) => event,
                EventNews::Sent(news) => {
                    self.event_count += 1;
                    note_sent(&mut self.recent, news);
                    continue;
                }
                EventNews::Restarted(layout) => {
                    self.recent.clear();
                    self.counted.clear();
                    self.coming.clear();
                    (self.layout, self.event_count) = (layout, 0);
                    continue;
                }
            };
            self.event_count += 1;
            // A moving slider updates one line; otherwise it would displace all other lines. Its message may follow it.
            let newest =
                self.recent.iter_mut().take(2).find(|happened| !matches!(happened, Happened::Sent(_)));
            match newest {
                Some(Happened::Event(newest)) if follows(newest, &event) => *newest = event,
                _ => {
                    self.recent.truncate(KEPT - 1);
                    self.recent.push_front(Happened::Event(event));
                }
            }
        }
        for news in self.layouts.try_iter() {
            self.file = Some(match news {
                LayoutNews::Changed => {
                    self.files_changed = true;
                    continue;
                }
                LayoutNews::Loaded { layout, revision, name, cause, warnings } => {
                    self.coming.push_back((layout, revision));
                    self.warnings = warnings;
                    FileNote { name, at_s: now_s, diagnostics: None, cause: Some(cause) }
                }
                LayoutNews::Refused { name, diagnostics } => {
                    FileNote { name, at_s: now_s, diagnostics: Some(diagnostics), cause: None }
                }
            });
        }
        while let Some((layout, _)) = self.coming.pop_front_if(|(_, from)| *from <= revision) {
            self.layout = layout;
        }
        while let Ok(notice) = self.notices.try_recv() {
            match notice {
                Notice::Text(text) => self.note(text),
                Notice::Sound(text) => self.silence = Some(text),
            }
        }
    }

    /// Lists the ground events since the last frame; the steps of one walk are one line for each ground.
    pub(super) fn note_grounds(&mut self, snapshot: &Snapshot) {
        let counts = snapshot.grounds.iter().map(|ground| ground.counters.events);
        let before = std::mem::replace(&mut self.counted, counts.collect());
        if before.len() != self.counted.len() {
            return;
        }
        for (index, (before, now)) in before.into_iter().zip(&self.counted).enumerate() {
            // The counter of a new layout's ground starts at zero.
            let count = now.saturating_sub(before);
            let Some(ground) = self.layout.grounds.get(index).filter(|_| count > 0) else { continue };
            match self.recent.front_mut() {
                Some(Happened::GroundEvent { ground: last, count: so_far, at, .. })
                    if *last == index && snapshot.at.since(*at) < SAME_WALK =>
                {
                    (*so_far, *at) = (*so_far + count, snapshot.at);
                }
                _ => {
                    let material = ground.spec.material.name();
                    self.event_count += 1;
                    self.recent.truncate(KEPT - 1);
                    self.recent.push_front(Happened::GroundEvent {
                        ground: index,
                        material,
                        count,
                        at: snapshot.at,
                    });
                }
            }
        }
    }

    /// Inserts presses without an answer in order of time: they may arrive after later events.
    pub(super) fn note_unanswered(&mut self, presses: impl IntoIterator<Item = Happened>) {
        for press in presses {
            self.event_count += 1;
            self.recent.truncate(KEPT - 1);
            let older = self.recent.iter().position(|happened| happened.at() <= press.at());
            self.recent.insert(older.unwrap_or(self.recent.len()), press);
        }
    }

    /// Shows the reason why there is no sound, now that there would have been something to hear.
    pub(super) fn tell_silence(&mut self) {
        if let Some(reason) = self.silence.take() {
            self.note(reason);
        }
    }

    /// Shows a message to the user, unless the same message is already on display.
    pub(super) fn note(&mut self, note: String) {
        if !self.notes.contains(&note) {
            self.notes.push_back(note);
        }
        while self.notes.len() > NOTICES {
            self.notes.pop_front();
        }
    }
}

/// Lists a message; those of a moving value or pointer are one line for each control.
fn note_sent(recent: &mut VecDeque<Happened>, news: MessageNews) {
    let is_same = |newest: &MessageNews| {
        newest.is_replaceable() && news.is_replaceable() && newest.order.control == news.order.control
    };
    // The change of the value stands between two of its messages.
    let newest = recent.iter_mut().take(2).find_map(|happened| match happened {
        Happened::Sent(newest) if is_same(newest) => Some(newest),
        _ => None,
    });
    match newest {
        Some(newest) => *newest = news,
        None => {
            recent.truncate(KEPT - 1);
            recent.push_front(Happened::Sent(news));
        }
    }
}

/// Whether `next` only updates the position of the slider in `last`.
fn follows(last: &WidgetEvent, next: &WidgetEvent) -> bool {
    let moves =
        |event: &WidgetEvent| matches!(event.kind, EventKind::Changed(Value::Number(_) | Value::Pair(_)));
    last.id == next.id && moves(last) && moves(next)
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;
    use crate::preview::sample::map;

    fn named(title: &str) -> Arc<Layout> {
        Arc::new(Layout { title: title.into(), ..map() })
    }

    fn event_of(happened: &Happened) -> &WidgetEvent {
        let Happened::Event(event) = happened else { panic!("{happened:?}") };
        event
    }

    #[test]
    fn what_gives_way_on_one_walk_is_one_line() {
        let text = underfoot::schema::builtin_layout("pond").unwrap();
        let (kinds, geometry) = (underfoot::schema::Kinds::builtin(), underfoot::floor::Geometry::default());
        let pond = underfoot::schema::parse_layout(text, "pond", &kinds, &geometry).unwrap().layout;
        let mut messages = WindowMessages::new(Arc::new(pond), channel().1, channel().1, channel().1);
        for (at_ms, events) in [(0, 0), (1000, 4), (1500, 6), (9000, 7)] {
            let mut snapshot = Snapshot { at: Instant::from_millis(at_ms), ..Snapshot::default() };
            snapshot.grounds = vec![Default::default()];
            snapshot.grounds[0].counters.events = events;
            messages.note_grounds(&snapshot);
        }
        let counts: Vec<_> = messages
            .recent
            .iter()
            .map(|line| match line {
                Happened::GroundEvent { count, material, .. } => (*count, *material),
                other => panic!("{other:?}"),
            })
            .collect();
        assert_eq!(counts, [(1, "Ice"), (6, "Ice")]);
    }

    fn loaded(title: &str, revision: u64) -> LayoutNews {
        let (name, warnings) = ("map.ron".into(), Warnings::default());
        LayoutNews::Loaded { layout: named(title), revision, name, cause: LayoutCause::Saved, warnings }
    }

    #[test]
    fn a_layout_is_shown_once_snapshots_belong_to_it() {
        let (news, layouts) = channel();
        let mut messages = WindowMessages::new(named("old"), channel().1, layouts, channel().1);
        for (title, revision) in [("newer", 2), ("newest", 3)] {
            news.send(loaded(title, revision)).unwrap();
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
        let mut messages = WindowMessages::new(named("good"), channel().1, layouts, channel().1);
        let diagnostics = "map.ron:3:9: unknown field".to_owned();
        news.send(LayoutNews::Refused { name: "map.ron".into(), diagnostics: diagnostics.clone() }).unwrap();
        messages.receive(1.0, 0);
        assert_eq!(messages.layout.title, "good");
        assert_eq!(messages.file.as_ref().unwrap().diagnostics, Some(diagnostics));
        news.send(loaded("mended", 1)).unwrap();
        messages.receive(2.0, 0);
        assert_eq!(messages.file.as_ref().unwrap().diagnostics, None);
    }

    #[test]
    fn the_list_of_events_stays_short_and_the_same_notice_is_said_once() {
        let (event, events) = channel();
        let (say, notices) = channel();
        let mut messages = WindowMessages::new(named("it"), events, channel().1, notices);
        for at in 0..2000 {
            event.send(EventNews::Event(crate::preview::tests::event(at, "home"))).unwrap();
            say.send("no sound card".into()).unwrap();
        }
        messages.receive(1.0, 0);
        assert_eq!(messages.recent.len(), KEPT);
        assert_eq!(messages.event_count, 2000);
        assert_eq!(event_of(&messages.recent[0]).at, Instant::from_millis(1999), "newest first");
        assert_eq!(messages.notes, ["no sound card"]);
    }

    #[test]
    fn every_line_of_the_list_is_counted_and_stands_in_the_order_of_time() {
        let (event, events) = channel();
        let mut messages = WindowMessages::new(named("it"), events, channel().1, channel().1);
        for at in [100, 300] {
            event.send(EventNews::Event(crate::preview::tests::event(at, "home"))).unwrap();
        }
        messages.receive(1.0, 0);
        let press = IgnoredPress {
            at: Instant::from_millis(200),
            id: underfoot::widget::WidgetId::new("zoom"),
            contact: underfoot::sense::ContactId(4),
            force: underfoot::units::Newtons(24.0),
            why: underfoot::engine::Ignored::TooLight,
        };
        messages.note_unanswered([Happened::Ignored(press)]);
        let at: Vec<_> = messages.recent.iter().map(|line| line.at().micros() / 1000).collect();
        assert_eq!((at, messages.event_count), (vec![300, 200, 100], 3));
    }

    #[test]
    fn a_slider_on_its_way_is_one_line() {
        let (event, events) = channel();
        let mut messages = WindowMessages::new(named("it"), events, channel().1, channel().1);
        let moved = |at: u64, id| WidgetEvent {
            kind: EventKind::Changed(Value::Number(at as f32)),
            ..crate::preview::tests::event(at, id)
        };
        let told = [moved(1, "zoom"), moved(2, "zoom"), moved(3, "volume"), moved(4, "zoom")];
        told.into_iter().for_each(|told| event.send(EventNews::Event(told)).unwrap());
        messages.receive(1.0, 0);
        let listed: Vec<_> = messages
            .recent
            .iter()
            .map(event_of)
            .map(|event| (event.at.micros() / 1000, event.id.as_str()))
            .collect();
        assert_eq!(listed, [(4, "zoom"), (3, "volume"), (2, "zoom")]);
        assert_eq!(messages.event_count, 4);
    }
}
