//! The time line under a recorded floor.

use std::sync::{Arc, Mutex};

use eframe::egui::{Event, Key, Modifiers, PointerButton, pos2};
use egui_kittest::kittest::Queryable;

use super::{EventNews, Room, event, map};
use crate::preview::sample::at_rest;
use crate::preview::{MarkWeight, Playback, PlaybackMark, PlaybackOrder, PlaybackState, PreviewInput};
use underfoot::engine::{Ignored, IgnoredPress, Snapshot};
use underfoot::sense::ContactId;
use underfoot::units::{Instant, Newtons};
use underfoot::widget::WidgetId;
use underfoot::wire::LinkState;

/// A recording of 20 s that records its commands and executes none.
#[derive(Clone, Default)]
struct Reel(Arc<Mutex<(PlaybackState, Vec<PlaybackOrder>)>>);

impl Reel {
    fn paused() -> Self {
        let reel = Self::default();
        let mark = |at_s, what: &str, weight| PlaybackMark { at_s, what: what.into(), weight };
        let marks =
            vec![mark(5.0, "zoom pressed", MarkWeight::Usual), mark(15.0, "link lost", MarkWeight::Fault)];
        let marks = Arc::new(marks);
        reel.0.lock().unwrap().0 =
            PlaybackState { at_s: 4.0, length_s: 20.0, is_paused: true, marks, ..PlaybackState::default() };
        reel
    }

    /// The commands since the last call.
    fn orders(&self) -> Vec<PlaybackOrder> {
        std::mem::take(&mut self.0.lock().unwrap().1)
    }
}

impl Playback for Reel {
    fn state(&mut self) -> PlaybackState {
        self.0.lock().unwrap().0.clone()
    }

    fn lead(&mut self, order: PlaybackOrder) {
        self.0.lock().unwrap().1.push(order);
    }
}

fn time_of(orders: &[PlaybackOrder]) -> f64 {
    match orders {
        [PlaybackOrder::GoTo(at_s)] => *at_s,
        other => unreachable!("{other:?}"),
    }
}

#[test]
fn a_recording_is_paused_and_stepped_by_mouse_and_keyboard() {
    let reel = Reel::paused();
    let mut room = Room::recorded(Box::new(reel.clone()));
    assert!(room.says("0:04.0") && room.says("/ 0:20.0"));
    room.window.get_by_label("Play").click();
    room.run(2);
    room.window.key_press(Key::Space);
    room.run(2);
    assert_eq!(reel.orders(), [PlaybackOrder::Pause(false), PlaybackOrder::Pause(false)]);
    room.window.key_press(Key::Period);
    room.run(2);
    assert_eq!(reel.orders(), [PlaybackOrder::Pause(true), PlaybackOrder::GoTo(4.05)]);
    room.window.get_by_label("Time line").focus();
    room.run(1);
    room.window.key_press(Key::ArrowLeft);
    room.run(2);
    assert_eq!(reel.orders(), [PlaybackOrder::GoTo(3.0)]);
    // Controls of a recording cannot be set by hand.
    assert!(!room.says("Controls, as an app sets them"));
}

#[test]
fn a_click_on_the_time_line_goes_there_and_a_drag_with_shift_repeats_a_part() {
    let reel = Reel::paused();
    let mut room = Room::recorded(Box::new(reel.clone()));
    let line = room.window.get_by_label("Time line").rect();
    let at = |share: f32| pos2(line.left() + share * line.width(), line.center().y);
    room.hover(at(0.75));
    room.button(at(0.75), PointerButton::Primary, true);
    room.button(at(0.75), PointerButton::Primary, false);
    let to = time_of(&reel.orders());
    assert!((to - 15.0).abs() < 0.3, "{to}");
    room.window.event(Event::ModifiersChanged(Modifiers::SHIFT));
    for (share, pressed) in [(0.25, true), (0.5, false)] {
        room.hover(at(share));
        let (pos, button, modifiers) = (at(share), PointerButton::Primary, Modifiers::SHIFT);
        room.window.event(Event::PointerButton { pos, button, pressed, modifiers });
        room.run(1);
    }
    let [PlaybackOrder::Repeat(Some((from, to)))] = reel.orders()[..] else { unreachable!() };
    assert!((from - 5.0).abs() < 0.3 && (to - 10.0).abs() < 0.3, "{from} {to}");
    room.run(2);
    assert!(room.says("0:04.0"), "the head goes on with the recording");
}

#[test]
fn events_of_the_way_before_are_gone_when_a_recording_begins_anew() {
    let mut room = Room::recorded(Box::new(Reel::paused()));
    room.happen(event(100, "home"));
    room.run(2);
    assert!(room.says("home pressed"));
    room.events.send(EventNews::Restarted(Arc::new(map()))).unwrap();
    room.happen(event(50, "zoom"));
    room.run(2);
    assert!(room.says("zoom pressed") && !room.says("home pressed") && room.says("1 so far"));
}

#[test]
fn a_recording_is_not_called_live() {
    let mut room = Room::recorded(Box::new(Reel::paused()));
    room.write(Snapshot { link: LinkState::Live, ..at_rest(&map()) });
    assert!(room.window.query_by_label("replay").is_some() && room.window.query_by_label("live").is_none());
    // A replay still reports the recorded state of the floor.
    room.write(Snapshot { link: LinkState::Partial, ..at_rest(&map()) });
    assert!(room.says("replay: partial"));
    let mut room = Room::simulated();
    room.write(Snapshot { link: LinkState::Live, ..at_rest(&map()) });
    assert!(room.window.query_by_label("live").is_some());
}

#[test]
fn a_press_is_counted_once_when_its_moment_is_shown_again() {
    let mut room = Room::recorded(Box::new(Reel::paused()));
    let press = |at_ms: u64| IgnoredPress {
        at: Instant::from_millis(at_ms),
        id: WidgetId::new("home"),
        contact: ContactId(1),
        force: Newtons(40.0),
        why: Ignored::TooLight,
    };
    let moment = |at_ms: u64, ignored: Vec<IgnoredPress>| Snapshot {
        at: Instant::from_millis(at_ms),
        ignored,
        ..at_rest(&map())
    };
    let counted = |room: &Room| room.window.state().presses.of(&WidgetId::new("home")).count();
    room.write(moment(6000, vec![press(5000)]));
    assert_eq!(counted(&room), 1);
    assert!(room.says("1 so far"), "what is listed is counted");
    // Back to an earlier time, and forward again.
    room.events.send(EventNews::Restarted(Arc::new(map()))).unwrap();
    room.write(moment(4000, vec![]));
    room.write(moment(6000, vec![press(5000)]));
    assert_eq!(counted(&room), 1);
    assert!(room.says("home ignored") && room.says("1 so far"));
}

/// A visit that another floor goes on from.
struct Visit(Option<PreviewInput>);

impl Playback for Visit {
    fn state(&mut self) -> PlaybackState {
        PlaybackState { length_s: 20.0, can_take_over: self.0.is_some(), ..PlaybackState::default() }
    }

    fn lead(&mut self, _order: PlaybackOrder) {}

    fn take_over(&mut self) -> Option<PreviewInput> {
        self.0.take()
    }
}

#[test]
fn the_window_goes_on_with_feet_of_its_own_once_a_visit_is_taken_over() {
    let layout = Arc::new(map());
    let (_snapshots, output) = triple_buffer::triple_buffer(&at_rest(&layout));
    let (window, _program) = crate::preview::channels();
    let feet = Arc::<Mutex<Vec<crate::preview::PreviewFoot>>>::default();
    let input = PreviewInput {
        feet: Some(Box::new(super::Feet(Arc::clone(&feet)))),
        ..PreviewInput::new(Arc::default(), layout, "simulated floor", output, window)
    };
    let mut room = Room::recorded(Box::new(Visit(Some(input))));
    assert!(!room.window.state().feet.are_led());
    room.window.get_by_label("Take over").click();
    room.run(4);
    assert!(room.window.query_by_label("Time line").is_none());
    assert!(room.window.state().feet.are_led() && room.window.state().time_line.is_none());
    room.press(room.place("Home"));
    assert!(!feet.lock().unwrap().is_empty(), "the mouse is a foot");
}
