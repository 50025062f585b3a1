//! Each line reads back as it was written, and nothing that a reader keeps is long.

use proptest::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::json;

use super::text::MOST_OF_A_SENTENCE;
use super::*;
use crate::sense::{ContactId, Covariance, Quality};
use crate::units::Instant;
use crate::widget::{Direction, EventKind, Value};
use underfoot_format::label::MAX_LABEL;

/// Random content of messages.
#[derive(Clone, Debug)]
struct Content {
    words: [Word; 4],
    flags: [bool; 4],
    numbers: [f32; 6],
    wholes: [u16; 4],
    large: [u32; 2],
}

fn content() -> impl Strategy<Value = Content> {
    let words = ["zoom", "say \"hi\"", "Größe", "a/b\\c", "零", ""];
    let words = prop::array::uniform4(prop::sample::select(words.map(Word::from).to_vec()));
    let (flags, wholes) = (prop::array::uniform4(any::<bool>()), prop::array::uniform4(any::<u16>()));
    let numbers = prop::array::uniform6(prop_oneof![-1000.0_f32..1000.0, -1.0_f32..1.0, Just(3.0)]);
    (words, flags, numbers, wholes, prop::array::uniform2(any::<u32>()))
        .prop_map(|(words, flags, numbers, wholes, large)| Content { words, flags, numbers, wholes, large })
}

impl Content {
    fn sentence(&self) -> Sentence {
        let [first, second, ..] = &self.words;
        Sentence(format!("{} why\n{} because", first.0, second.0))
    }

    fn values(&self) -> Vec<JsonValue> {
        let [a, b, c, d, ..] = self.numbers;
        let word = JsonValue::Text(self.words[0].clone());
        let numbers = [JsonValue::Number(a), JsonValue::Numbers([a, b]), JsonValue::Ranges([[a, b], [c, d]])];
        let others =
            [JsonValue::Nothing, JsonValue::Flag(self.flags[0]), JsonValue::Whole(self.wholes[0].into())];
        numbers.into_iter().chain(others).chain([word]).collect()
    }

    fn contact(&self) -> ContactRecord {
        let [x_m, y_m, force_n, x_velocity_m_s, y_velocity_m_s, _] = self.numbers;
        let id = ContactId(self.large[0]);
        ContactRecord { id, x_m, y_m, force_n, x_velocity_m_s, y_velocity_m_s, ..ContactRecord::default() }
    }

    fn full_contact(&self, difference: Option<[f32; 2]>) -> ContactRecord {
        let [xx, xy, yy, ..] = self.numbers;
        ContactRecord {
            tiles: Some(vec![[self.wholes[0], self.wholes[1]], [self.wholes[2], self.wholes[3]]]),
            covariance_m2: Some(Covariance { xx, xy, yy }),
            ambiguous: Some(self.flags[0]),
            quality: Some(Quality::Degraded),
            difference_m: Some(difference),
            ..self.contact()
        }
    }

    fn controls(&self) -> Vec<Message> {
        let [id, off, label, page] = self.words.clone();
        let [enabled, locked, pressed, armed] = self.flags.map(Some);
        let [force_n, x_m, y_m, ..] = self.numbers;
        let events = EventKind::PLAIN.into_iter().chain([
            EventKind::Changed(Value::Switch(true)),
            EventKind::Changed(Value::Choice(3)),
            EventKind::Swiped(Direction::West),
        ]);
        let event = |kind: EventKind| EventRecord {
            event: kind.name().into(),
            id: id.clone(),
            value: kind.detail().map(JsonValue::from).unwrap_or_default(),
            force_n,
            x_m,
            y_m,
            contact: self.flags[0].then_some(ContactId(self.large[1])),
        };
        let state = |value: JsonValue| StateRecord {
            id: id.clone(),
            range: value.clone(),
            value,
            step: self.flags[0].then_some(force_n),
            options: self.flags[1].then(|| self.words.iter().cloned().collect()),
            enabled,
            off: self.flags[2].then(|| off.clone()),
            off_text: self.flags[2].then(|| self.sentence()),
            locked,
            pressed,
            armed,
            indicator: Some("busy".into()),
            label: Some(label.clone()),
            page: self.flags[3].then(|| page.clone()),
        };
        let held = HeldRecord { held: self.words.iter().cloned().collect(), sequence: self.large[0] };
        let events = events.map(|kind| Message::Control(event(kind)));
        let states = self.values().into_iter().map(|value| Message::State(state(value)));
        events.chain(states).chain([Message::Held(held)]).collect()
    }

    fn others(&self) -> Vec<Message> {
        let [one, two, three, _] = self.words.clone();
        let [col, row, channels, board] = self.wholes;
        let [sample_rate, block] = self.large;
        let [energy_j, x_m, y_m, ..] = self.numbers;
        let trouble = TroubleRecord { col, row, corner: "sw".into(), trouble: "stuck".into() };
        let contacts = [self.contact(), self.full_contact(None), self.full_contact(Some([x_m, y_m]))];
        vec![
            Message::Page(PageRecord { page: self.flags[0].then(|| one.clone()) }),
            Message::Sent(SentRecord { id: one.clone(), target: two.clone(), message: self.sentence() }),
            Message::Crack(CrackRecord { seed: sample_rate, energy_j, x_m, y_m, skipped: block }),
            Message::Link(LinkRecord { state: "lost".into() }),
            Message::LinkCause(LinkCauseRecord {
                cause: self.flags[0].then(|| one.clone()),
                board: self.flags[1].then_some(board),
                why: self.sentence(),
            }),
            Message::Mute(MuteRecord {
                all: self.flags[0],
                tiles: [[col, row], [row, col]].into_iter().collect(),
            }),
            Message::Health(HealthRecord {
                live: sample_rate,
                foreign: self.flags[0],
                troubles: [trouble].into_iter().collect(),
                ..HealthRecord::default()
            }),
            Message::Device(DeviceRecord {
                device: self.sentence(),
                state: two.clone(),
                channels,
                sample_rate,
                block,
                underruns: sample_rate.into(),
                priority: three,
                ..DeviceRecord::default()
            }),
            Message::Area(AreaRecord {
                area: one.clone(),
                state: two,
                why: self.sentence(),
                uncertainty_s: 0.25,
            }),
            Message::Ignored(IgnoredRecord {
                id: one.clone(),
                reason: "too_light".into(),
                why: self.sentence(),
                force_n: energy_j,
                contact: ContactId(block),
            }),
            Message::Gap(GapRecord { dropped: block.into() }),
            Message::Contacts(ContactsRecord { contacts: contacts.into_iter().collect() }),
            Message::Error(RefusalRecord { request: one, why: self.sentence() }),
            Message::Clients(ClientsRecord { connected: col.into(), dropped: block.into() }),
            Message::Other { event: "newer".into() },
        ]
    }
}

fn read_back<T: Serialize + DeserializeOwned>(record: &T) -> T {
    serde_json::from_str(&serde_json::to_string(record).unwrap()).unwrap()
}

proptest! {
    #[test]
    fn each_line_reads_back_as_it_was_written(content in content(), micros in 0_u64..1 << 50) {
        for message in content.controls().into_iter().chain(content.others()) {
            for line in [Line::new(Instant::from_micros(micros), message.clone()), Line::timeless(message)] {
                let text = line.text();
                prop_assert_eq!(&Line::read(text.as_bytes()).unwrap(), &line, "{}", text);
            }
        }
    }

    #[test]
    fn records_of_other_shapes_read_back_too(content in content()) {
        let [x_m, y_m, force_n, ..] = content.numbers;
        let cursor = CursorRecord { id: ContactId(content.large[0]), x_m, y_m, force_n };
        let contacts = vec![content.full_contact(None), content.full_contact(Some([x_m, y_m]))];
        let sensed = SensedRecord { t_s: 1.25, contacts, cursor: content.flags[0].then_some(cursor) };
        prop_assert_eq!(read_back(&sensed), sensed);
        let [first, second, ..] = content.words.clone();
        let request = RequestRecord { args: vec![json!(0.5), json!("on"), json!(3)], request: first.0.clone() };
        prop_assert_eq!(read_back(&request), request);
        let state = json!({"id": "zoom", "value": 0.5}).as_object().cloned().unwrap();
        let placed = PlacedControl { kind: "dial".into(), x_m: 0.25, state, ..PlacedControl::default() };
        prop_assert_eq!(read_back(&placed), placed.clone());
        let floor = FloorRecord {
            controls: vec![json_value(&placed)],
            depth_m: 1.5,
            event: "floor".into(),
            link_cause: content.flags[0].then(|| second.clone()),
            page: content.flags[1].then(|| first.clone()),
            title: first.0,
            why: content.flags[0].then(|| content.sentence()),
            ..FloorRecord::default()
        };
        prop_assert_eq!(read_back(&floor), floor);
        let greeting = GreetingRecord {
            event: "mirror".into(),
            version: 1,
            method: "tracker".into(),
            t_s: 1.25,
            page: Some(second),
            takes_layouts: content.flags[0],
            floor: "Floor()".into(),
            layout: "Layout()".into(),
            controls: vec![StateRecord { id: "zoom".into(), ..StateRecord::default() }],
        };
        prop_assert_eq!(read_back(&greeting), greeting);
    }
}

#[test]
fn a_contact_of_an_earlier_version_is_read() {
    let text = r#"{"id":3,"x_m":0.5,"y_m":1.0,"force_n":350.0,"vx_m_s":0.25,"vy_m_s":-0.5}"#;
    let contact: ContactRecord = serde_json::from_str(text).unwrap();
    assert_eq!((contact.x_velocity_m_s, contact.y_velocity_m_s), (0.25, -0.5));
}

fn state(text: &str) -> StateRecord {
    match Line::read(text.as_bytes()).unwrap().message {
        Message::State(state) => state,
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_is_said_of_a_control_is_kept() {
    let said = state(
        r#"{"t_s":9.9,"event":"state","id":"zoom","value":0.5,"range":[0.0,1.0],"enabled":true,"locked":false,
        "pressed":false,"indicator":"off","label":"Zoom","page":null,"more":[1,{"a":[]}]}"#,
    );
    assert_eq!(said.id, "zoom");
    assert_eq!((said.value, said.range), (JsonValue::Number(0.5), JsonValue::Numbers([0.0, 1.0])));
    assert_eq!((said.enabled, said.locked, said.armed), (Some(true), Some(false), None));
    assert_eq!((said.label, said.page), (Some("Zoom".into()), None));
}

#[test]
fn nothing_that_is_kept_is_long() {
    let long = "x".repeat(100_000);
    let deep = format!("{}{}", "[".repeat(100), "]".repeat(100));
    let said = state(&format!(
        r#"{{"event":"state","id":"{long}","page":"{long}","value":"{long}","range":{deep},"off_text":"{long}",
        "label":[{long_list}],"indicator":{{"a":"{long}"}},"enabled":[1,2,3]}}"#,
        long_list = vec!["1"; 50_000].join(",")
    ));
    assert_eq!([said.id.0.len(), said.page.unwrap().0.len()], [MAX_LABEL; 2]);
    assert_eq!(said.off_text.unwrap().0.len(), MOST_OF_A_SENTENCE);
    assert_eq!(said.value, JsonValue::Text("x".repeat(MAX_LABEL).as_str().into()));
    assert_eq!(
        (said.range, said.label, said.indicator, said.enabled),
        (JsonValue::Nothing, None, None, None)
    );
    let head = Head::read(format!(r#"{{"event":"{long}"}}"#).as_bytes()).unwrap();
    assert_eq!(head.event().len(), MAX_LABEL);
}

#[test]
fn words_and_sentences_hold_only_what_can_be_seen() {
    let text = r#"{"event":"error","request":"a\u202eb\u001b[31m","why":"one\u0007\ntwo\u202e"}"#;
    let refusal = RefusalRecord { request: "ab[31m".into(), why: "one\ntwo".into() };
    assert_eq!(Line::read(text.as_bytes()).unwrap().message, Message::Error(refusal));
}

#[test]
fn of_a_long_list_the_first_are_kept() {
    let few: Few<u32, 3> = serde_json::from_str("[1,2,3,4,5]").unwrap();
    assert_eq!((few.kept, few.left_out), (vec![1, 2, 3], 2));
}
