//! The gateway with feet that cross borders and nodes that fail.

use proptest::prelude::*;
use underfoot::floor::{Area, Geometry, TileBlock, TileId};
use underfoot::sink::AreaState;
use underfoot::widget::{EventKind, WidgetId};
use underfoot::wire::{ControlMessage, Request};

use super::*;
use crate::auth::Echo;
use crate::message::NodeAnswer;

/// Two areas side by side, of 6 x 6 tiles each; the border is at 6 x 0.304 m.
fn hall() -> Floor {
    let area =
        |id: &str, column| Area::new(id, TileBlock { first: TileId::new(column, 0), columns: 6, rows: 6 });
    Floor::of(Geometry::of_paper_tiles(12, 6).unwrap()).with_areas(vec![area("west", 0), area("east", 6)])
}

const BORDER_M: f32 = 6.0 * 0.304;

/// A node with a clock far from the gateway's.
#[derive(Clone, Debug)]
struct Node {
    area: &'static str,
    id: u64,
    ahead: u64,
    sequence: u64,
    events: u64,
    held: Vec<String>,
    layout: LayoutStanding,
}

impl Node {
    fn new(area: &'static str, id: u64) -> Self {
        let layout = LayoutStanding::default();
        Self { area, id, ahead: 1_000_000_000 * id, sequence: 0, events: 0, held: Vec::new(), layout }
    }

    /// Its message about the floor at `at` microseconds of the gateway's clock, 200 us before it arrives.
    fn message(&mut self, at: u64, feet: &[(u32, f32, f32)], events: Vec<NodeEvent>) -> NodeMessage {
        self.sequence += 1;
        let first_event = self.events;
        self.events += events.len() as u64;
        let contact = |&(id, x, y): &(u32, f32, f32)| NodeContact {
            id,
            at: [x, y],
            force: 400.0,
            ..NodeContact::default()
        };
        let there = at + self.ahead;
        NodeMessage {
            version: VERSION,
            floor: fingerprint(&hall()),
            area: self.area.into(),
            node: self.id,
            name: format!("node {}", self.id),
            sequence: self.sequence,
            sent: there,
            frame: Some(there),
            contacts: feet.iter().map(contact).collect(),
            first_event,
            events,
            held: self.held.clone(),
            layout: self.layout.clone(),
            // The probe took 200 us as well.
            echo: Some(Echo { sent: at - 200, received: there }),
            ..NodeMessage::default()
        }
    }

    fn event(
        &self,
        at: u64,
        kind: EventKind,
        id: &str,
        contact: Option<u32>,
        place: (f32, f32),
    ) -> NodeEvent {
        let value = match kind {
            EventKind::Changed(value) => Some(value.into()),
            _ => None,
        };
        let (kind, position) = (kind.name().to_owned(), place.into());
        NodeEvent { at: at + self.ahead, id: id.into(), kind, value, contact, force: 400.0, position }
    }
}

/// A gateway and all its reports.
struct Stage {
    gateway: Gateway,
    told: Vec<Output>,
}

impl Stage {
    fn new() -> Self {
        Self { gateway: Gateway::new(&hall(), 9).unwrap(), told: Vec::new() }
    }

    /// Passes the gateway a message about the floor at `at` when it arrives, 200 us later.
    fn take(&mut self, message: NodeMessage, at: u64) {
        self.gateway.take(message, Instant::from_micros(at + 200));
    }

    fn advance(&mut self, at: u64) {
        let told = self.gateway.advance(Instant::from_micros(at));
        self.told.extend(told);
    }

    fn kinds(&self) -> Vec<EventKind> {
        events(&self.told).map(|event| event.kind).collect()
    }

    /// The numbers of contacts, each once, in the order of their reports, and the greatest number at one time.
    fn names(&self) -> (Vec<u32>, usize) {
        let (mut names, mut most) = (Vec::new(), 0);
        for told in &self.told {
            if let Output::Report(Report::Contacts(_, contacts)) = told {
                most = most.max(contacts.len());
                for contact in
                    contacts.iter().filter(|contact| !names.contains(&contact.id.0)).collect::<Vec<_>>()
                {
                    names.push(contact.id.0);
                }
            }
        }
        (names, most)
    }

    fn contacts(&self) -> Vec<(u32, f32)> {
        let last = self.told.iter().rev().find_map(|told| match told {
            Output::Report(Report::Contacts(_, contacts)) => {
                Some(contacts.iter().map(|one| (one.id.0, one.centroid.x)).collect())
            }
            _ => None,
        });
        last.unwrap_or_default()
    }

    fn last_area(&self) -> Option<&AreaNews> {
        self.told.iter().rev().find_map(|told| match told {
            Output::Report(Report::Area(news)) => Some(news.as_ref()),
            _ => None,
        })
    }
}

/// Tests begin at one minute of the gateway's clock.
const START: u64 = 60_000_000;

#[test]
fn a_foot_that_slides_over_the_border_is_one_contact_with_one_name() {
    // The nodes see it up to 4 mm apart, each on the other's side for a while, and give it their own numbers.
    for apart in [0.0, 0.004, -0.004] {
        let mut stage = Stage::new();
        let (mut west, mut east) = (Node::new("west", 1), Node::new("east", 2));
        for step in 0..400_u64 {
            let at = START + step * 2000;
            // 0.5 m/s, from 20 cm before the border to 20 cm behind it.
            let x = BORDER_M - 0.2 + step as f32 * 0.001;
            stage.take(west.message(at, &[(7, x, 1.0)], vec![]), at);
            stage.take(east.message(at, &[(31, x + apart, 1.0)], vec![]), at);
            stage.advance(at + 300);
            let contacts = stage.contacts();
            assert_eq!(contacts.len(), 1, "at {x}: {contacts:?}");
            assert!((contacts[0].1 - x).abs() < 0.0051, "at {x}: {contacts:?}");
        }
        assert_eq!(stage.names(), (vec![1], 1));
    }
}

#[test]
fn a_foot_that_one_area_loses_before_the_next_one_gains_it_keeps_its_name() {
    let mut stage = Stage::new();
    let (mut west, mut east) = (Node::new("west", 1), Node::new("east", 2));
    for step in 0..100_u64 {
        let at = START + step * 2000;
        let x = BORDER_M - 0.05 + step as f32 * 0.001;
        let in_west: &[_] = if step < 49 { &[(7, x, 1.0)] } else { &[] };
        let in_east: &[_] = if step > 53 { &[(31, x, 1.0)] } else { &[] };
        stage.take(west.message(at, in_west, vec![]), at);
        stage.take(east.message(at, in_east, vec![]), at);
        stage.advance(at + 300);
    }
    assert_eq!(stage.names(), (vec![1], 1));
}

#[test]
fn two_feet_on_the_border_are_two_and_one_that_lands_later_elsewhere_is_another() {
    let mut stage = Stage::new();
    let (mut west, mut east) = (Node::new("west", 1), Node::new("east", 2));
    for step in 0..60_u64 {
        let at = START + step * 2000;
        let sway = step as f32 * 0.0004 - 0.012;
        let mut feet = vec![(7, BORDER_M + sway, 1.0), (8, BORDER_M + sway, 1.12)];
        if step > 30 {
            feet.push((9, 0.5, 1.0));
        }
        let seen_in_east: Vec<_> = feet.iter().take(2).map(|(id, x, y)| (id + 20, *x, *y)).rev().collect();
        stage.take(west.message(at, &feet, vec![]), at);
        stage.take(east.message(at, &seen_in_east, vec![]), at);
        stage.advance(at + 300);
    }
    assert_eq!(stage.names(), (vec![1, 2, 3], 3));
}

#[test]
fn a_foot_that_its_owner_has_elsewhere_keeps_its_name_and_who_is_not_believed_sees_another_one() {
    let mut stage = Stage::new();
    let (mut west, mut east) = (Node::new("west", 1), Node::new("east", 2));
    // From the tenth step on, east reports two feet; west senses only one of them beyond its area.
    let (foot, one, other) = (BORDER_M + 0.1, BORDER_M + 0.18, BORDER_M + 0.02);
    for step in 0..20_u64 {
        let at = START + step * 2000;
        let is_one = step < 10;
        let there = if is_one { vec![(31, foot, 1.0)] } else { vec![(31, one, 1.0), (32, other, 1.0)] };
        stage.take(west.message(at, &[(7, if is_one { foot } else { other }, 1.0)], vec![]), at);
        stage.take(east.message(at, &there, vec![]), at);
        stage.advance(at + 300);
    }
    let contacts = stage.contacts();
    assert_eq!((contacts[0], contacts[1].1, contacts.len()), ((1, one), other, 2));
}

#[test]
fn what_the_owner_ends_is_over_and_what_it_sees_there_next_is_another_foot() {
    let mut stage = Stage::new();
    let (mut west, mut east) = (Node::new("west", 1), Node::new("east", 2));
    for step in 0..20_u64 {
        let at = START + step * 2000;
        let feet = match step {
            0..10 => vec![(31, 3.0, 1.0)],
            10 | 11 => vec![],
            _ => vec![(32, 3.03, 1.0)],
        };
        stage.take(west.message(at, &[], vec![]), at);
        stage.take(east.message(at, &feet, vec![]), at);
        stage.advance(at + 300);
    }
    assert_eq!(stage.names(), (vec![1, 2], 1));
}

#[test]
fn events_of_all_areas_come_in_time_order_with_joint_names() {
    let mut stage = Stage::new();
    let (mut west, mut east) = (Node::new("west", 1), Node::new("east", 2));
    // A control on the border that east decides, under a foot with its centre in west.
    let foot = (BORDER_M - 0.03, 1.0);
    for step in 0..20_u64 {
        let at = START + step * 4000;
        let in_east = east.event(at - 3000, EventKind::Pressed, "bridge", Some(31), foot);
        let in_west = west.event(at - 1000, EventKind::Pressed, "light", Some(7), foot);
        let is_tenth = step == 10;
        let of = |event: NodeEvent| if is_tenth { vec![event] } else { vec![] };
        let (told_west, told_east) = (of(in_west), of(in_east));
        stage.take(west.message(at, &[(7, foot.0, foot.1)], told_west), at);
        stage.advance(at + 250);
        stage.take(east.message(at, &[(31, foot.0, foot.1)], told_east), at);
        stage.advance(at + 300);
    }
    let told: Vec<_> =
        events(&stage.told).map(|event| (event.id.to_string(), event.at.micros(), event.contact)).collect();
    let at = START + 40_000;
    let contact = Some(underfoot::sense::ContactId(1));
    assert_eq!(told, [("bridge".into(), at - 3000, contact), ("light".into(), at - 1000, contact)]);
    assert_eq!(stage.gateway.counters().late, 0);
}

/// A floor on which a foot holds `drive` in west since `START`; both nodes report it every 2 ms until `until`.
fn holding(until: u64) -> (Stage, Node, Node) {
    let mut stage = Stage::new();
    let (mut west, mut east) = (Node::new("west", 1), Node::new("east", 2));
    for step in 0..until / 2000 {
        let at = START + step * 2000;
        // The areas join before the press.
        let pressed = west.event(at, EventKind::Pressed, "drive", Some(7), (1.0, 1.0));
        let events = if step == 5 { vec![pressed] } else { vec![] };
        west.held = if step >= 5 { vec!["drive".into()] } else { vec![] };
        stage.take(west.message(at, &[(7, 1.0, 1.0)], events), at);
        stage.take(east.message(at, &[(31, 3.0, 1.0)], vec![]), at);
        stage.advance(at + 300);
    }
    assert_eq!(stage.kinds(), [EventKind::Pressed]);
    (stage, west, east)
}

// C3
#[test]
fn an_area_that_falls_silent_is_cancelled_after_100_ms_and_the_rest_goes_on() {
    let (mut stage, _, mut east) = holding(50_000);
    let last = START + 48_000;
    let mut cancelled = None;
    for step in 1..100_u64 {
        let at = last + step * 2000;
        stage.take(east.message(at, &[(31, 3.0, 1.0)], vec![]), at);
        stage.advance(at + 300);
        if stage.kinds().len() > 1 {
            cancelled.get_or_insert(at + 300 - last);
        }
    }
    assert_eq!(stage.kinds(), [EventKind::Pressed, EventKind::Cancelled]);
    assert!((100_000..103_000).contains(&cancelled.unwrap()), "{cancelled:?}");
    assert_eq!(stage.contacts(), [(2, 3.0)], "east's foot is still there, west's is not");
    let news = stage.last_area().unwrap();
    assert_eq!((news.area.as_str(), news.state), ("west", AreaState::Lost));
    assert!(stage.told.contains(&Output::Report(Report::Link(news.at, LinkState::Partial))));
    let held = stage.told.iter().rev().find_map(|told| match told {
        Output::Report(Report::Held(report)) => Some(report),
        _ => None,
    });
    assert!(held.is_some_and(|report| report.held.is_empty() && report.ended.len() == 1), "{held:?}");
}

// C2
#[test]
fn what_a_frozen_node_tells_late_is_not_acted_on_and_it_comes_back_without_ghosts() {
    let (mut stage, mut west, mut east) = holding(50_000);
    let frozen = START + 50_000;
    // Sent before the freeze; it arrives after it, together with the whole backlog.
    let late: Vec<NodeMessage> =
        (0..10_u64).map(|step| west.message(frozen + step * 2000, &[(7, 1.0, 1.0)], vec![])).collect();
    for step in 0..150_u64 {
        let at = frozen + step * 2000;
        stage.take(east.message(at, &[(31, 3.0, 1.0)], vec![]), at);
        stage.advance(at + 300);
    }
    let thawed = frozen + 300_000;
    late.into_iter().for_each(|message| stage.take(message, thawed));
    stage.advance(thawed + 300);
    assert_eq!(stage.gateway.standing("west"), Some(AreaStanding::Lost));
    assert_eq!(stage.gateway.counters().stale, 10);
    for step in 0..50_u64 {
        let at = thawed + step * 2000;
        let released = west.event(at, EventKind::Released, "drive", Some(7), (1.0, 1.0));
        let clicked = west.event(at, EventKind::Clicked, "drive", Some(7), (1.0, 1.0));
        let events = if step == 20 { vec![released, clicked] } else { vec![] };
        west.held = if step < 20 { vec!["drive".into()] } else { vec![] };
        stage.take(west.message(at, &[(7, 1.0, 1.0)], events), at);
        stage.take(east.message(at, &[(31, 3.0, 1.0)], vec![]), at);
        stage.advance(at + 300);
        // The foot has another number now: it may or may not be the same foot.
        assert_eq!(stage.contacts(), [(2, 3.0), (3, 1.0)], "{step}");
    }
    assert_eq!(stage.kinds(), [EventKind::Pressed, EventKind::Cancelled], "a cancelled press never commits");
    let pressed = west.event(thawed + 102_000, EventKind::Pressed, "drive", Some(8), (1.0, 1.0));
    stage.take(west.message(thawed + 102_000, &[(8, 1.0, 1.0)], vec![pressed]), thawed + 102_000);
    stage.take(east.message(thawed + 102_000, &[(31, 3.0, 1.0)], vec![]), thawed + 102_000);
    stage.advance(thawed + 102_300);
    assert_eq!(stage.kinds().len(), 3, "the next press is told again");
}

/// The reports when the clock of west, in which a foot holds `drive`, is set by `step_us` and echoes reveal it 40 ms
/// later: the kinds of events, and the times from the step to the cancellation and to the report of the next press.
fn step_of_the_clock(step_us: i64) -> (Vec<EventKind>, u64, u64) {
    let (mut stage, mut west, mut east) = holding(50_000);
    let begun = START + 50_000;
    west.ahead = west.ahead.checked_add_signed(step_us).unwrap();
    let (mut cancelled, mut pressed) = (None, None);
    for step in 0..200_u64 {
        let at = begun + step * 2000;
        let press = west.event(at, EventKind::Pressed, "horn", Some(8), (1.4, 1.0));
        let release = west.event(at, EventKind::Released, "drive", Some(7), (1.0, 1.0));
        let events = match step {
            80 => vec![release],
            100 => vec![press],
            _ => vec![],
        };
        if step == 80 {
            west.held.clear();
        }
        let mut message = west.message(at, &[(7, 1.0, 1.0), (8, 1.4, 1.0)], events);
        if step < 20 {
            message.echo = None;
        }
        stage.take(message, at);
        stage.take(east.message(at, &[(31, 3.0, 1.0)], vec![]), at);
        stage.advance(at + 300);
        let count = stage.kinds().len();
        if count > 1 {
            cancelled.get_or_insert(at + 300 - begun);
        }
        if count > 2 {
            pressed.get_or_insert(at + 300 - (begun + 200_000));
        }
    }
    assert_eq!(stage.gateway.standing("west"), Some(AreaStanding::Live));
    (stage.kinds(), cancelled.unwrap(), pressed.unwrap())
}

// C4
#[test]
fn a_node_whose_clock_is_set_is_cancelled_soon_and_what_it_tells_later_is_not_held_up() {
    let expected = [EventKind::Pressed, EventKind::Cancelled, EventKind::Pressed];
    for step_us in [1_000_000, -1_000_000, 30_000] {
        let (kinds, cancelled, pressed) = step_of_the_clock(step_us);
        assert_eq!(kinds, expected, "{step_us}");
        assert!(cancelled <= 100_000, "{step_us}: {cancelled}");
        assert!(pressed < 5000, "{step_us}: {pressed}");
    }
}

// C1
#[test]
fn a_node_that_starts_again_at_once_has_cancelled_what_was_held() {
    let (mut stage, _, mut east) = holding(50_000);
    let mut west = Node::new("west", 3);
    for step in 0..20_u64 {
        let at = START + 50_000 + step * 2000;
        stage.take(west.message(at, &[], vec![]), at);
        stage.take(east.message(at, &[(31, 3.0, 1.0)], vec![]), at);
        stage.advance(at + 300);
    }
    assert_eq!(stage.kinds(), [EventKind::Pressed, EventKind::Cancelled]);
    assert_eq!(stage.contacts(), [(2, 3.0)]);
    assert_eq!(stage.gateway.standing("west"), Some(AreaStanding::Live));
}

// C10
#[test]
fn of_two_nodes_that_claim_an_area_neither_acts() {
    let (mut stage, mut west, mut east) = holding(50_000);
    let mut other = Node::new("west", 3);
    for step in 0..60_u64 {
        let at = START + 50_000 + step * 2000;
        let event = other.event(at, EventKind::Pressed, "other", None, (1.0, 1.0));
        stage.take(other.message(at, &[(5, 0.5, 0.5)], vec![event]), at);
        stage.take(west.message(at, &[(7, 1.0, 1.0)], vec![]), at);
        stage.take(east.message(at, &[(31, 3.0, 1.0)], vec![]), at);
        stage.advance(at + 300);
        if step > 2 {
            assert_eq!(stage.contacts(), [(2, 3.0)], "{step}");
        }
    }
    assert_eq!(stage.kinds(), [EventKind::Pressed, EventKind::Cancelled]);
    let news = stage.last_area().unwrap();
    assert_eq!(news.state, AreaState::Disputed);
    assert!(news.why.contains("node 1 and node 3"), "{}", news.why);
    // One of the two stops: after a second the other one is live again.
    for step in 0..600_u64 {
        let at = START + 170_000 + step * 2000;
        stage.take(west.message(at, &[(7, 1.0, 1.0)], vec![]), at);
        stage.take(east.message(at, &[(31, 3.0, 1.0)], vec![]), at);
        stage.advance(at + 300);
    }
    assert_eq!(stage.gateway.standing("west"), Some(AreaStanding::Live));
    assert_eq!(stage.contacts().len(), 2);
}

#[test]
fn events_that_never_came_end_what_was_pressed() {
    let (mut stage, mut west, mut east) = holding(50_000);
    west.events += 2;
    let at = START + 50_000;
    stage.take(west.message(at, &[(7, 1.0, 1.0)], vec![]), at);
    stage.take(east.message(at, &[(31, 3.0, 1.0)], vec![]), at);
    stage.advance(at + 300);
    assert_eq!(stage.kinds(), [EventKind::Pressed, EventKind::Cancelled]);
    assert_eq!(stage.gateway.counters().lost, 2);
}

#[test]
fn events_from_before_a_gap_end_with_it() {
    // Until 1 ms: both areas are live, and there is no press.
    let (mut stage, mut west, mut east) = (Stage::new(), Node::new("west", 1), Node::new("east", 2));
    stage.take(west.message(START, &[], vec![]), START);
    stage.take(east.message(START, &[], vec![]), START);
    stage.advance(START + 300);
    // The press waits for the east, and events are missing after it.
    let at = START + 2000;
    let pressed = west.event(at, EventKind::Pressed, "drive", Some(7), (1.0, 1.0));
    west.held = vec!["drive".into()];
    stage.take(west.message(at, &[(7, 1.0, 1.0)], vec![pressed]), at);
    stage.advance(at + 300);
    assert_eq!(stage.kinds(), []);
    (west.events, west.held) = (west.events + 2, Vec::new());
    stage.take(west.message(at + 2000, &[], vec![]), at + 2000);
    for ms in 3..60 {
        stage.advance(START + ms * 1000);
    }
    assert_eq!(stage.kinds(), [EventKind::Pressed, EventKind::Cancelled]);
}

#[test]
fn the_uncertainty_of_a_node_s_clock_adds_to_the_age_of_its_frames() {
    for (one_way_ms, standing) in [(40, AreaStanding::Live), (60, AreaStanding::Waiting)] {
        let (mut stage, mut west) = (Stage::new(), Node::new("west", 1));
        let way = one_way_ms * 1000;
        // A round trip of twice that bounds the frame's age only to between 0 and two ways.
        let echo = Some(Echo { sent: START - way, received: START + west.ahead });
        let message = NodeMessage { echo, ..west.message(START, &[], vec![]) };
        stage.gateway.take(message, Instant::from_micros(START + way));
        assert_eq!(stage.gateway.standing("west"), Some(standing), "{one_way_ms} ms");
    }
}

#[test]
fn a_message_with_a_name_that_is_no_id_is_refused() {
    let mut stage = Stage::new();
    let mut west = Node::new("west", 1);
    stage.take(west.message(START, &[], vec![]), START);
    let bad = "drive\u{1b}[2J".to_owned();
    let good = west.message(START + 2000, &[], vec![]);
    let event = west.event(START + 2000, EventKind::Pressed, &bad, None, (1.0, 1.0));
    let others = [
        NodeMessage { held: vec![bad.clone()], ..good.clone() },
        NodeMessage { events: vec![event], ..good.clone() },
        NodeMessage { values: Some(vec![(bad.clone(), NodeValue::Switch(true))]), ..good.clone() },
        NodeMessage { page: Some(bad), ..good },
    ];
    for other in others {
        stage.take(other, START + 2000);
    }
    assert_eq!((stage.gateway.counters().refused, stage.gateway.counters().messages), (4, 5));
}

#[test]
fn a_notice_shows_the_name_of_a_node_without_control_characters() {
    let mut stage = Stage::new();
    let message = Node::new("west", 1).message(START, &[], vec![]);
    let message = NodeMessage { floor: 1, name: "here\u{1b}[2J".into(), ..message };
    stage.take(NodeMessage { area: "no\u{7}where".into(), ..message }, START);
    stage.advance(START + 300);
    let notice = stage.told.iter().find_map(|told| match told {
        Output::Notice(notice) => Some(notice.as_str()),
        _ => None,
    });
    assert!(
        notice.unwrap().starts_with("the node at here[2J for area \"nowhere\" is not heard"),
        "{notice:?}"
    );
}

// C7
#[test]
fn a_node_with_another_floor_file_is_told_about_once_and_not_heard() {
    let mut stage = Stage::new();
    let mut west = Node::new("west", 1);
    for step in 0..5_u64 {
        let at = START + step * 2000;
        let message = NodeMessage { floor: 1, ..west.message(at, &[(7, 1.0, 1.0)], vec![]) };
        stage.take(message, at);
        stage.advance(at + 300);
    }
    let notices = stage.told.iter().filter(|told| matches!(told, Output::Notice(_))).count();
    assert_eq!((notices, stage.gateway.counters().refused), (1, 5));
    assert_eq!(stage.gateway.standing("west"), Some(AreaStanding::Waiting));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Walkers in both areas; each node's messages come in order, but up to 20 ms late, with any interleaving.
    #[test]
    fn any_interleaving_gives_the_same_events(
        delays in prop::collection::vec((0..20_000_u64, 0..20_000_u64), 60),
        presses in prop::collection::vec((0..60_usize, 0..2_usize, 0..2000_u64), 1..20),
    ) {
        let messages = || {
            let (mut west, mut east) = (Node::new("west", 1), Node::new("east", 2));
            let mut all = Vec::new();
            for step in 0..60_u64 {
                let at = START + step * 2000;
                let x = BORDER_M - 0.06 + step as f32 * 0.002;
                for (number, node) in [&mut west, &mut east].into_iter().enumerate() {
                    let foot = [7, 31][number];
                    let mut before: Vec<u64> = presses
                        .iter()
                        .filter(|(when, area, _)| *when == step as usize && *area == number)
                        .map(|(_, _, before)| *before)
                        .collect();
                    before.sort_unstable();
                    let events = before.iter().rev().map(|before| {
                        node.event(at - before, EventKind::Ticked, ["a", "b"][number], Some(foot), (x, 1.0))
                    });
                    let events = events.collect();
                    all.push((at, number, node.message(at, &[(foot, x, 1.0)], events)));
                }
            }
            all
        };
        let run = |delay: &dyn Fn(usize, usize) -> u64| {
            let mut stage = Stage::new();
            let mut arrivals = Vec::new();
            let mut last = [0_u64; 2];
            for (place, (at, area, message)) in messages().into_iter().enumerate() {
                let due = (at + delay(place / 2, area)).max(last[area]);
                last[area] = due;
                arrivals.push((due, place, message));
            }
            arrivals.sort_by_key(|(due, place, _)| (*due, *place));
            // Both nodes join before the first event; otherwise the order of joining would affect the result.
            for (area, node) in [("west", 1), ("east", 2)] {
                let mut node = Node::new(area, node);
                stage.take(node.message(START - 2000, &[], vec![]), START - 2000);
            }
            for (due, _, mut message) in arrivals {
                // Clocks are known from the start, so that the reported times are equal.
                message.echo = None;
                message.sequence += 1;
                stage.take(message, due);
                stage.advance(due + 300);
            }
            for step in 0..20 {
                stage.advance(START + 150_000 + step * 2000);
            }
            let told: Vec<WidgetEvent> = events(&stage.told).cloned().collect();
            (told, stage.gateway.counters().late)
        };
        let (straight, _) = run(&|_, _| 0);
        let (mixed, late) = run(&|step, area| if area == 0 { delays[step].0 } else { delays[step].1 });
        prop_assert_eq!(late, 0);
        prop_assert!(straight.is_sorted_by_key(|event| event.at));
        prop_assert_eq!(straight, mixed);
    }
}

/// A layout of one control in the west and one in the east, with two pages.
fn controls() -> Layout {
    let text = r#"Layout(version: 1, title: "Both",
        regions: [(id: "west", at: (1, 1), size: (2, 2)), (id: "east", at: (8, 1), size: (2, 2))],
        widgets: [
            (id: "left", kind: "button", at: (1, 1), size: (1, 1)),
            (id: "right", kind: "slider", at: (8, 1), size: (2, 1)),
        ],
        pages: [(id: "one", widgets: []), (id: "two", widgets: [])])"#;
    let kinds = underfoot::schema::Kinds::builtin();
    underfoot::schema::parse_layout(text, "both", &kinds, &hall().geometry).unwrap().layout
}

/// A stage with both areas live and a layout, at START.
fn asked_stage() -> (Stage, Node, Node) {
    let (mut stage, mut west, mut east) = (Stage::new(), Node::new("west", 1), Node::new("east", 2));
    stage.gateway.propose(controls(), Instant::from_micros(START - 200_000));
    stage.advance(START - 200_000);
    let current = stage.gateway.message(Instant::from_micros(START)).layout.current;
    (west.layout.running, east.layout.running) = (current, current);
    stage.take(west.message(START, &[], vec![]), START);
    stage.take(east.message(START, &[], vec![]), START);
    stage.advance(START + 300);
    // Both have received their initial messages.
    answer_all(&mut stage, &mut west, &mut east, START + 1000);
    stage.told.clear();
    (stage, west, east)
}

/// Makes both nodes answer all their requests; returns the area and path of each.
fn answer_all(stage: &mut Stage, west: &mut Node, east: &mut Node, at: u64) -> Vec<(String, String)> {
    let beat = stage.gateway.message(Instant::from_micros(at));
    for node in [west, east] {
        let mut message = node.message(at, &[], vec![]);
        let own = beat.requests.iter().filter(|request| request.area == node.area);
        message.answers = own
            .map(|request| NodeAnswer { gateway: 9, number: request.number, ..NodeAnswer::default() })
            .collect();
        stage.take(message, at);
    }
    stage.advance(at + 300);
    beat.requests.into_iter().map(|request| (request.area, request.path)).collect()
}

fn ask(stage: &mut Stage, message: ControlMessage, at: u64) {
    let sender = Some(([127, 0, 0, 1], 5000).into());
    stage.gateway.ask(Request { message, sender }, Instant::from_micros(at));
}

fn refusals(stage: &Stage) -> Vec<&str> {
    let refused = stage.told.iter().filter_map(|told| match told {
        Output::Answer(_, RequestAnswer::Refused(_, why)) => Some(why.as_str()),
        _ => None,
    });
    refused.collect()
}

#[test]
fn a_request_goes_to_the_area_of_its_control_or_to_all() {
    let (mut stage, mut west, mut east) = asked_stage();
    let at = START + 2000;
    for id in ["left", "right", "*"] {
        ask(&mut stage, ControlMessage::Disable { id: WidgetId::new(id) }, at);
    }
    ask(&mut stage, ControlMessage::CancelAll, at);
    ask(&mut stage, ControlMessage::MuteTile { tile: TileId::new(7, 0), on: true }, at);
    let asked = answer_all(&mut stage, &mut west, &mut east, at);
    let asked: Vec<_> = asked.iter().map(|(area, path)| (area.as_str(), path.as_str())).collect();
    let [left, right] = [("west", "widget/left/disable"), ("east", "widget/right/disable")];
    assert_eq!(
        asked,
        [left, right, left, right, ("west", "cancel"), ("east", "cancel"), ("east", "mute/tile")]
    );
    assert!(
        answer_all(&mut stage, &mut west, &mut east, at + 1000).is_empty(),
        "each is asked once answered"
    );
    ask(&mut stage, ControlMessage::Get { id: WidgetId::new("middle") }, at);
    ask(&mut stage, ControlMessage::MuteTile { tile: TileId::new(12, 0), on: true }, at);
    stage.advance(at + 2000);
    assert_eq!(refusals(&stage).len(), 2, "{:?}", refusals(&stage));
    assert_eq!(stage.gateway.counters().denied, 2);
}

#[test]
fn a_node_that_comes_back_is_told_what_apps_have_set_and_one_that_is_lost_is_why_it_is_not_done() {
    let (mut stage, mut west, mut east) = asked_stage();
    let at = START + 2000;
    ask(&mut stage, ControlMessage::Lock { id: WidgetId::new("left") }, at);
    ask(&mut stage, ControlMessage::Mute { on: true }, at);
    answer_all(&mut stage, &mut west, &mut east, at);
    // Only the east continues.
    let lost = at + 150_000;
    stage.take(east.message(lost, &[], vec![]), lost);
    stage.advance(lost + 300);
    ask(&mut stage, ControlMessage::Unlock { id: WidgetId::new("left") }, lost);
    stage.advance(lost + 400);
    assert_eq!(refusals(&stage), ["its area \"west\" is lost"]);
    let layout = west.layout;
    let mut west = Node::new("west", 3);
    let back = lost + 10_000;
    stage.take(west.message(back, &[], vec![]), back);
    stage.advance(back + 300);
    let asked = answer_all(&mut stage, &mut west, &mut east, back + 1000);
    assert_eq!(asked, [("west".to_owned(), "mute/set".to_owned())], "it has no controls yet");
    west.layout = layout;
    let back = back + 2000;
    stage.take(west.message(back, &[], vec![]), back);
    stage.advance(back + 300);
    let asked = answer_all(&mut stage, &mut west, &mut east, back + 1000);
    let asked: Vec<_> = asked.iter().map(|(area, path)| (area.as_str(), path.as_str())).collect();
    assert_eq!(asked, [("west", "widget/left/lock")]);
}

#[test]
fn a_page_that_one_node_shows_is_that_of_all() {
    let (mut stage, mut west, mut east) = asked_stage();
    let at = START + 2000;
    let mut message = west.message(at, &[], vec![]);
    message.page = Some("two".into());
    stage.take(message, at);
    stage.advance(at + 300);
    let shown = stage
        .told
        .iter()
        .any(|told| matches!(told, Output::Report(Report::Page(shown)) if shown.page == "two"));
    assert!(shown, "{:?}", stage.told);
    let asked = answer_all(&mut stage, &mut west, &mut east, at + 1000);
    assert_eq!(asked, [("east".to_owned(), "page/set".to_owned())]);
}

#[test]
fn a_layout_is_ordered_on_each_node_s_own_clock() {
    let (mut stage, west, _) = asked_stage();
    let at = Instant::from_micros(START + 3000);
    let order = stage.gateway.message(at).layout;
    let (current, from) = (order.current.unwrap(), &order.from[0]);
    assert_eq!((current.revision, from.0.as_str()), (1, "west"));
    // No node was there when it became current, 200 ms before.
    let here = i128::from(from.1) - i128::from(west.ahead) - i128::from(START);
    assert_eq!(here, -100_000);
    // Another layout waits for both.
    let mut other = controls();
    other.title = "Other".into();
    stage.gateway.propose(other, at);
    assert!(stage.gateway.layout_message(at).is_some());
    stage.advance(START + 4000);
    assert_eq!(stage.gateway.message(at).layout.current.unwrap().revision, 1);
}
