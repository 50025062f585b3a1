//! A key that goes down comes up, after any history of feet, floor and link.

use std::collections::BTreeSet;
use std::time::Duration;

use glam::Vec2;
use proptest::prelude::*;

use super::*;
use crate::floor::Rect;
use crate::sense::{Contact, ContactId};
use crate::units::{Instant, Newtons};
use crate::widget::{Behaviour, EventKind, HoldSpec, PadSpec, Scale, SliderSpec, Thresholds, Value};
use crate::widget::{WidgetEvent, WidgetId};

const AT: Thresholds = Thresholds::new(Newtons(60.0), Newtons(40.0));

fn key(name: &str) -> Payload {
    Payload::Key(name.parse().unwrap())
}

/// Two controls hold the same key, a third one another, and a note; all click it too, and strike a note; a slider sends
/// its value, bends a channel and turns a wheel, a pad moves the pointer; feet are voices and OSC.
fn plan() -> MessagePlan {
    let target = |name: &str, to| SendTarget { name: name.into(), to };
    let keyboard = Destination::Keyboard(KeyboardTarget { window: None, display: None });
    let osc =
        Destination::Osc(OscTarget { address: "127.0.0.1:53000".into(), over: OscTransport::default() });
    let synth = Destination::Midi(MidiTarget { port: "synth".into(), into: None });
    let lights = Destination::Sacn(SacnTarget::USUAL);
    let broker = Destination::Mqtt(MqttTarget {
        address: "127.0.0.1:1883".into(),
        base: None,
        discovery: true,
        user: None,
    });
    let mut plan = MessagePlan::new(vec![
        target("viewer", keyboard),
        target("desk", osc),
        target("synth", synth),
        target("lights", lights),
        target("home", broker),
    ]);
    let hold = Behaviour::Hold(HoldSpec { thresholds: AT });
    let slider = Behaviour::Slider(SliderSpec::new(AT, Scale::new(0.0, 10.0)));
    let pad = Behaviour::Pad(PadSpec {
        initial: Vec2::ZERO,
        ..PadSpec::new(AT, Scale::new(-1.0, 1.0), Scale::new(-1.0, 1.0))
    });
    let sending = |when, target: &str, payload| Sending { when, target: target.into(), payload };
    let osc = |range| Payload::Osc("/pan".into(), OscSettings { range, arguments: None });
    let both = [
        sending(When::While, "viewer", key("space")),
        sending(When::On(Trigger::PRESSED), "viewer", key("space")),
        sending(When::On(Trigger::CLICKED), "synth", note(60)),
    ];
    plan.add(&WidgetId::new("w0"), &hold, &both);
    plan.add(&WidgetId::new("w1"), &hold, &both);
    plan.add(
        &WidgetId::new("w2"),
        &hold,
        &[
            sending(When::While, "viewer", Payload::Button(MouseButton::Left)),
            sending(When::While, "desk", osc(None)),
            sending(When::While, "synth", note(48)),
            sending(When::While, "synth", Payload::Controller(controller(64, false))),
            sending(When::While, "lights", Payload::Dmx(DmxSettings::of(12))),
            sending(When::While, "home", Payload::Mqtt("lamp".into(), MqttSettings::PLAIN)),
        ],
    );
    let value = [
        sending(When::Value, "desk", osc(Some([0.0, 1.0]))),
        sending(When::Value, "viewer", Payload::Wheel(20)),
        sending(When::Value, "synth", Payload::Controller(controller(7, true))),
        sending(When::Value, "synth", Payload::Bend(BendSettings { channel: 1, from: -8192, to: 8191 })),
        sending(When::Value, "lights", Payload::Dmx(DmxSettings { fine: true, ..DmxSettings::of(1) })),
        sending(When::Value, "home", Payload::Mqtt("level".into(), MqttSettings::PLAIN)),
    ];
    plan.add(&WidgetId::new("w3"), &slider, &value);
    plan.add(&WidgetId::new("w4"), &pad, &[sending(When::Value, "viewer", Payload::Pointer(800.0))]);
    let feet = |target: &str, payload| ContactSending { target: target.into(), payload, press_n: 40.0 };
    let of_feet = [
        feet("synth", ContactPayload::Mpe(MpeSettings { from: 48, to: 72, feet: 15, force_n: 800.0 })),
        feet("desk", ContactPayload::Osc("/foot".into(), OscSettings::PLAIN)),
        feet("viewer", ContactPayload::Pointer),
    ];
    let button = Rect::from_min_size(Vec2::ZERO, Vec2::ONE);
    plan.add_region(&WidgetId::new("stage"), STAGE, &[button], &of_feet);
    plan
}

/// The region of feet, with a control in its corner.
const STAGE: Rect = Rect::new(Vec2::ZERO, Vec2::new(4.0, 4.0));

fn note(key: u8) -> Payload {
    Payload::Note(key, NoteSettings { length: Duration::from_millis(50), ..NoteSettings::USUAL })
}

fn controller(number: u8, fine: bool) -> ControllerSettings {
    ControllerSettings { channel: 1, number, fine, from: 0, to: None }
}

/// A foot of this force, `at` floor metres.
fn foot(id: u32, at: [f32; 2], force: f32) -> Contact {
    Contact { id: ContactId(id), centroid: at.into(), force: Newtons(force), ..Contact::default() }
}

fn event(id: &str, kind: EventKind, ms: u64) -> WidgetEvent {
    WidgetEvent {
        at: Instant::from_millis(ms),
        id: WidgetId::new(id),
        kind,
        contact: Some(ContactId(1)),
        force: Newtons(100.0),
        position: Vec2::new(1.0, 2.0),
    }
}

/// Carries out orders as a keyboard does: a second down, or a second up, is a fault.
#[derive(Default)]
struct PressedKeys {
    down: BTreeSet<(usize, Holdable)>,
}

impl PressedKeys {
    fn carry_out(&mut self, orders: &[MessageOrder]) {
        for MessageOrder { target, act, .. } in orders {
            match act {
                Act::Down(what, velocity) => assert!(
                    (1..=127).contains(velocity) && self.down.insert((*target, what.clone())),
                    "down twice: {what}"
                ),
                Act::Up(what) => assert!(self.down.remove(&(*target, what.clone())), "up twice: {what}"),
                Act::Stroke(what) => {
                    assert!(!self.down.contains(&(*target, what.clone())), "a stroke would release {what}");
                }
                Act::Osc(_, values) => assert!(values.iter().all(|value| match value {
                    OscValue::Float(number) => number.is_finite(),
                    _ => true,
                })),
                Act::Place(place) => assert!(place.iter().all(|share| (0.0..=1.0).contains(share))),
                Act::Wheel(_) | Act::Move(_) | Act::Midi(_) | Act::Dmx(_) | Act::Mqtt(_) | Act::Run(_) => {}
            }
        }
    }
}

/// One thing that happens.
#[derive(Clone, Debug)]
enum Happening {
    Event(usize, EventKind),
    Held(Vec<usize>),
    Feet(Vec<(u32, [f32; 2], f32)>),
    Lost,
    Wait(u64),
}

fn happening() -> impl Strategy<Value = Happening> {
    let kind = prop_oneof![
        Just(EventKind::Pressed),
        Just(EventKind::Released),
        Just(EventKind::Cancelled),
        Just(EventKind::Clicked),
        (-5.0_f32..15.0).prop_map(|number| EventKind::Changed(Value::Number(number))),
        (-1.0_f32..1.0).prop_map(|x| EventKind::Changed(Value::Pair(Vec2::new(x, -x)))),
    ];
    prop_oneof![
        5 => (0..5_usize, kind).prop_map(|(control, kind)| Happening::Event(control, kind)),
        3 => prop::collection::vec(0..5_usize, 0..4).prop_map(Happening::Held),
        3 => prop::collection::vec((0..20_u32, [-1.0_f32..5.0, -1.0_f32..5.0], 0.0_f32..900.0), 0..20)
            .prop_map(Happening::Feet),
        1 => Just(Happening::Lost),
        3 => (0..120_u64).prop_map(Happening::Wait),
    ]
}

/// Plays `history`; returns the machine, the board and the time after it.
fn play(history: &[Happening]) -> (Messenger, PressedKeys, u64) {
    let (mut messenger, mut board, mut ms) = (Messenger::new(plan()), PressedKeys::default(), 1000);
    let mut orders = Vec::new();
    for happening in history {
        match happening {
            Happening::Event(control, kind) => {
                messenger.event(&event(&format!("w{control}"), *kind, ms), &mut orders);
            }
            Happening::Held(held) => {
                let held: Vec<_> = held.iter().map(|it| WidgetId::new(&format!("w{it}"))).collect();
                messenger.held(Instant::from_millis(ms), &held, &mut orders);
            }
            Happening::Feet(feet) => {
                let mut contacts: Vec<_> =
                    feet.iter().map(|(id, at, force)| foot(*id, *at, *force)).collect();
                contacts.sort_by_key(|contact| contact.id);
                contacts.dedup_by_key(|contact| contact.id);
                messenger.contacts(Instant::from_millis(ms), &contacts, &mut orders);
            }
            Happening::Lost => messenger.lost(&mut orders),
            Happening::Wait(span) => {
                ms += span;
                messenger.advance(Instant::from_millis(ms), &mut orders);
            }
        }
        board.carry_out(&orders);
        orders.clear();
        assert!(messenger.is_down().eq(board.down.iter()), "{happening:?}");
    }
    (messenger, board, ms)
}

proptest! {
    #[test]
    fn after_any_history_that_ends_in_a_lost_floor_all_is_up(
        history in prop::collection::vec(happening(), 0..80),
    ) {
        let (mut messenger, mut board, _) = play(&history);
        let mut orders = Vec::new();
        messenger.lost(&mut orders);
        board.carry_out(&orders);
        prop_assert!(board.down.is_empty(), "{:?}", board.down);
    }

    #[test]
    fn after_any_history_silence_alone_lets_all_come_up(history in prop::collection::vec(happening(), 0..80)) {
        let (mut messenger, mut board, ms) = play(&history);
        let mut orders = Vec::new();
        messenger.advance(Instant::from_millis(ms + 71), &mut orders);
        board.carry_out(&orders);
        prop_assert!(board.down.is_empty(), "{:?}", board.down);
    }
}

fn acts(orders: &mut Vec<MessageOrder>) -> Vec<String> {
    orders.drain(..).map(|order| order.act.to_string()).collect()
}

#[test]
fn a_key_is_down_for_as_long_as_reports_say_that_a_foot_holds_the_control() {
    let mut messenger = Messenger::new(plan());
    let mut orders = Vec::new();
    messenger.event(&event("w2", EventKind::Pressed, 1000), &mut orders);
    let sound = ["note C3 on channel 1 down, velocity 32", "controller 64 on channel 1 down"];
    let [light, lamp] = ["DMX channel 12 down", "lamp down"];
    assert_eq!(acts(&mut orders), ["left button down", "/pan down", sound[0], sound[1], light, lamp]);
    for ms in (1020..2000).step_by(20) {
        messenger.held(Instant::from_millis(ms), &[WidgetId::new("w2")], &mut orders);
        messenger.advance(Instant::from_millis(ms + 10), &mut orders);
    }
    assert_eq!(acts(&mut orders), [""; 0]);
    messenger.held(Instant::from_millis(2000), &[], &mut orders);
    let quiet = ["note C3 on channel 1 up", "controller 64 on channel 1 up"];
    let [light, lamp] = ["DMX channel 12 up", "lamp up"];
    assert_eq!(acts(&mut orders), ["left button up", "/pan up", quiet[0], quiet[1], light, lamp]);
    messenger.held(Instant::from_millis(2020), &[WidgetId::new("w2")], &mut orders);
    assert_eq!(acts(&mut orders), [""; 0], "only a new press holds it again");
}

#[test]
fn a_key_that_two_controls_hold_comes_up_with_the_last() {
    let mut messenger = Messenger::new(plan());
    let mut orders = Vec::new();
    messenger.event(&event("w0", EventKind::Pressed, 1000), &mut orders);
    messenger.event(&event("w1", EventKind::Pressed, 1001), &mut orders);
    messenger.event(&event("w0", EventKind::Released, 1002), &mut orders);
    assert_eq!(acts(&mut orders), ["key space down"]);
    messenger.event(&event("w1", EventKind::Released, 1003), &mut orders);
    assert_eq!(acts(&mut orders), ["key space up"]);
    assert_eq!(messenger.unsent().held, 2, "strokes of a held key are counted");
}

#[test]
fn a_value_goes_out_scaled_at_most_100_times_a_second_and_its_last_state_always() {
    let mut messenger = Messenger::new(plan());
    let mut orders = Vec::new();
    for ms in 0..1000_u32 {
        let value = EventKind::Changed(Value::Number(ms as f32 / 100.0));
        messenger.event(&event("w3", value, ms.into()), &mut orders);
        messenger.advance(Instant::from_millis(ms.into()), &mut orders);
    }
    messenger.advance(Instant::from_millis(1020), &mut orders);
    let acts = acts(&mut orders);
    let sent: Vec<&String> = acts.iter().filter(|act| act.starts_with("/pan")).collect();
    assert!((95..=101).contains(&sent.len()), "{}", sent.len());
    let last: f32 = sent.last().unwrap().strip_prefix("/pan ").unwrap().parse().unwrap();
    assert!((last - 0.999).abs() < 1e-6, "{last}");
    let steps: i32 = acts.iter().filter_map(|act| act.strip_prefix("wheel ")?.parse::<i32>().ok()).sum();
    assert_eq!(steps, 20, "over the whole range");
}

#[test]
fn a_pad_moves_the_pointer_only_while_a_foot_is_on_it() {
    let mut messenger = Messenger::new(plan());
    let mut orders = Vec::new();
    let run = |messenger: &mut Messenger, from: u64, held: bool| {
        let mut orders = Vec::new();
        for ms in (from..from + 500).step_by(10) {
            if held {
                messenger.held(Instant::from_millis(ms), &[WidgetId::new("w4")], &mut orders);
            }
            messenger.advance(Instant::from_millis(ms), &mut orders);
        }
        let moves = orders.into_iter().filter_map(|order| match order.act {
            Act::Move(pixels) => Some(pixels),
            _ => None,
        });
        moves.fold([0, 0], |sum, pixels| [sum[0] + pixels[0], sum[1] + pixels[1]])
    };
    messenger.event(&event("w4", EventKind::Pressed, 1000), &mut orders);
    let north_east = EventKind::Changed(Value::Pair(Vec2::new(1.0, 0.5)));
    messenger.event(&event("w4", north_east, 1000), &mut orders);
    let [right, down] = run(&mut messenger, 1000, true);
    assert!((right - 392).abs() < 3 && (down + 196).abs() < 3, "{right}, {down}");
    messenger.event(&event("w4", EventKind::Released, 1500), &mut orders);
    assert_eq!(run(&mut messenger, 1500, false), [0, 0]);
}

#[test]
fn a_flood_of_events_is_bounded_and_counted() {
    let mut messenger = Messenger::new(plan());
    let mut orders = Vec::new();
    for n in 0..10_000_u64 {
        let at = WidgetEvent { at: Instant::from_micros(n * 100), ..event("w0", EventKind::Pressed, 0) };
        messenger.event(&at, &mut orders);
        messenger.event(&WidgetEvent { kind: EventKind::Released, ..at }, &mut orders);
    }
    let strokes = orders.iter().filter(|order| matches!(order.act, Act::Down(..) | Act::Stroke(_))).count();
    assert!(strokes <= 241, "{strokes} in a second");
    assert!(messenger.unsent().limited > 9000);
    assert!(messenger.is_down().next().is_none());
}

#[test]
fn a_tap_strikes_a_note_as_loud_as_the_foot_was_heavy_and_ends_it() {
    let mut messenger = Messenger::new(plan());
    let mut orders = Vec::new();
    messenger.event(&event("w0", EventKind::Pressed, 1000), &mut orders);
    for (ms, force) in [(1001, 200.0), (1002, 300.0), (1003, 90.0)] {
        messenger.contacts(Instant::from_millis(ms), &[foot(1, [-1.0, -1.0], force)], &mut orders);
    }
    orders.clear();
    messenger.event(&event("w0", EventKind::Released, 1010), &mut orders);
    messenger.event(&event("w0", EventKind::Clicked, 1010), &mut orders);
    // 300 of 400 newtons.
    assert_eq!(acts(&mut orders), ["key space up", "note C4 on channel 1 down, velocity 95"]);
    for ms in (1012..1060).step_by(4) {
        messenger.held(Instant::from_millis(ms), &[], &mut orders);
        messenger.advance(Instant::from_millis(ms), &mut orders);
    }
    assert_eq!(acts(&mut orders), [""; 0], "it sounds for 50 ms though no control is held");
    messenger.advance(Instant::from_millis(1060), &mut orders);
    assert_eq!(acts(&mut orders), ["note C4 on channel 1 up"]);
}

#[test]
fn a_slider_is_a_fine_controller_and_a_bend_and_repeats_neither() {
    let mut messenger = Messenger::new(plan());
    let mut orders = Vec::new();
    let midi = |orders: &mut Vec<MessageOrder>| -> Vec<MidiMessage> {
        let of = |order: MessageOrder| if let Act::Midi(message) = order.act { Some(message) } else { None };
        orders.drain(..).filter_map(of).collect()
    };
    for (ms, value, expected) in
        [(1000, 0.0, [0, -8192]), (1100, 5.0, [8192, 0]), (1200, 10.0, [16_383, 8191])]
    {
        messenger.event(&event("w3", EventKind::Changed(Value::Number(value)), ms), &mut orders);
        let [controller, bend] = expected;
        let all = [MidiMessage::FineController(1, 7, controller as u16), MidiMessage::Bend(1, bend as i16)];
        assert_eq!(midi(&mut orders), all, "{value}");
    }
    messenger.event(&event("w3", EventKind::Changed(Value::Number(10.0)), 1300), &mut orders);
    assert_eq!(midi(&mut orders), [], "only changes are sent");
}

#[test]
fn a_slide_dims_a_light_and_a_retained_topic_and_repeats_neither() {
    let mut messenger = Messenger::new(plan());
    let mut orders = Vec::new();
    let lasting = |orders: &mut Vec<MessageOrder>| -> Vec<String> {
        let lasts = |order: &MessageOrder| order.act.standing().is_some();
        orders.drain(..).filter(lasts).map(|order| order.act.to_string()).collect()
    };
    for (ms, value, level, text) in [(1000, 2.5, 16_384, "2.5"), (1100, 10.0, 65_535, "10")] {
        messenger.event(&event("w3", EventKind::Changed(Value::Number(value)), ms), &mut orders);
        assert_eq!(
            lasting(&mut orders),
            [format!("DMX channel 1: {level} of 65535"), format!("level {text:?}")]
        );
    }
    messenger.event(&event("w3", EventKind::Changed(Value::Number(10.0)), 1300), &mut orders);
    assert_eq!(lasting(&mut orders), [""; 0], "only changes are sent");
}

#[test]
fn each_foot_on_free_floor_is_a_voice_and_has_a_number() {
    let mut messenger = Messenger::new(plan());
    let mut orders = Vec::new();
    let mut step = |ms: u64, feet: &[Contact]| {
        messenger.contacts(Instant::from_millis(ms), feet, &mut orders);
        acts(&mut orders)
    };
    let [west, east] = [foot(1, [1.0, 2.0], 400.0), foot(2, [3.0, 4.0 - 1e-3], 800.0)];
    let one = [
        "MPE with 15 member channels",
        "bend +0 on channel 2",
        "controller 74 on channel 2: 64",
        "pressure 64 on channel 2",
        "note F#3 on channel 2 down, velocity 64",
        "/foot 0 1.0 2.0 400.0",
        "pointer at 0.250 0.500",
    ];
    assert_eq!(step(1000, std::slice::from_ref(&west)), one);
    let both = step(1001, &[west.clone(), east.clone()]);
    assert!(both.contains(&"note F#4 on channel 3 down, velocity 127".to_owned()), "{both:?}");
    assert!(both.iter().any(|act| act.starts_with("/foot 1 3.0 ")), "{both:?}");
    assert!(!both.iter().any(|act| act.starts_with("pointer")), "the first foot has the pointer: {both:?}");
    // It slides a twelfth of the region: two semitones of 48.
    let moved = foot(1, [1.0 + 4.0 / 12.0, 2.0], 400.0);
    assert_eq!(step(1002, &[moved.clone(), east.clone()]), [""; 0], "50 times a second at most");
    assert!(step(1030, &[moved, east.clone()]).contains(&"bend +341 on channel 2".to_owned()));
    // It steps on the control in the corner, the other one lifts.
    let left = step(1040, &[foot(1, [0.5, 0.5], 400.0)]);
    for up in ["note F#3 on channel 2 up", "note F#4 on channel 3 up"] {
        assert!(left.contains(&up.to_owned()), "{left:?}");
    }
    assert_eq!(
        left.iter().filter(|act| act.starts_with("/foot") && act.ends_with(" 0.0")).count(),
        2,
        "{left:?}"
    );
    assert_eq!(step(1050, &[foot(3, [2.0, 2.0], 30.0)]), [""; 0], "a foot that swings by is too light");
}

#[test]
fn a_sixteenth_foot_is_counted_and_gets_the_next_voice_that_is_free() {
    let mut messenger = Messenger::new(plan());
    let mut orders = Vec::new();
    let feet: Vec<Contact> = (0..16).map(|id| foot(id, [0.18 * id as f32 + 1.0, 2.0], 400.0)).collect();
    // All arrive within some frames, as the rate allows.
    for ms in 1000..1200 {
        messenger.contacts(Instant::from_millis(ms), &feet, &mut orders);
    }
    let channels = || messenger.is_down().filter(|(target, _)| *target == 2).count();
    assert_eq!(channels(), 15);
    assert_eq!(messenger.unsent().crowded, 1, "once, and OSC has room for sixteen");
    messenger.contacts(Instant::from_millis(1300), &feet[1..], &mut orders);
    messenger.contacts(Instant::from_millis(1301), &feet[1..], &mut orders);
    let on_two = orders.iter().rev().find_map(|order| match &order.act {
        Act::Down(Holdable::Note(note), _) => Some(note.channel),
        _ => None,
    });
    assert_eq!(on_two, Some(2), "the voice of the foot that left");
}
