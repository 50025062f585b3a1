//! The choices for a message of a control: its times, and its contents for each sort of target.

use underfoot::messages::{
    BendSettings, ControllerSettings, DmxSettings, KeyStroke, MouseButton, MqttSettings, NoteSettings,
    OscSettings, Payload, PressureSettings, ProgramSettings, Sending, TargetSort, Trigger, When,
};
use underfoot::widget::{Behaviour, Guard};
use underfoot_format::Named;

/// The times at which a control of this `behaviour` can send: its events, while it is held, with its value.
pub(super) fn times(behaviour: &Behaviour) -> Vec<When> {
    let events = Trigger::ALL.iter().map(|(_, trigger)| *trigger);
    let mut all: Vec<When> = events.filter(|trigger| trigger.is_given_by(behaviour)).map(When::On).collect();
    if matches!(behaviour.thresholds().guard, Guard::HoldToRun(_)) {
        all.push(When::While);
    }
    if behaviour.initial().is_some() {
        all.push(When::Value);
    }
    all
}

/// The name of a time in a list.
pub(super) fn time_name(when: When) -> String {
    match when {
        When::On(trigger) => format!("on {}", trigger.name().replace('_', " ")),
        When::While => "while held".into(),
        When::Value => "with its value".into(),
    }
}

/// The contents that a target of this `sort` receives at the time `when`, with usual settings.
pub(super) fn contents(sort: TargetSort, when: When) -> Vec<Payload> {
    let space: Option<KeyStroke> = "space".parse().ok();
    let steps = if when == When::Value { 10 } else { 1 };
    let controller = ControllerSettings { channel: 1, number: 7, fine: false, from: 0, to: None };
    let all = [
        space.map(Payload::Key),
        Some(Payload::Button(MouseButton::Left)),
        Some(Payload::Wheel(steps)),
        Some(Payload::Pointer(800.0)),
        Some(Payload::Osc("/control".into(), OscSettings::PLAIN)),
        Some(Payload::Note(60, NoteSettings::USUAL)),
        Some(Payload::Controller(controller)),
        Some(Payload::Program(0, ProgramSettings { channel: 1 })),
        Some(Payload::Bend(BendSettings { channel: 1, from: -8192, to: 8191 })),
        Some(Payload::Pressure(PressureSettings { channel: 1, key: None, from: 0, to: 127 })),
        Some(Payload::Dmx(DmxSettings::of(1))),
        Some(Payload::Mqtt("floor/control".into(), MqttSettings::PLAIN)),
        Some(Payload::Run(Vec::new())),
    ];
    all.into_iter().flatten().filter(|payload| payload.sort() == sort && payload.suits(when)).collect()
}

/// The name of a content in a list.
pub(super) const fn content_name(payload: &Payload) -> &'static str {
    match payload {
        Payload::Key(_) => "key",
        Payload::Button(_) => "mouse button",
        Payload::Wheel(_) => "wheel",
        Payload::Pointer(_) => "pointer",
        Payload::Osc(..) => "OSC message",
        Payload::Note(..) => "note",
        Payload::Controller(_) => "controller",
        Payload::Program(..) => "program",
        Payload::Bend(_) => "pitch bend",
        Payload::Pressure(_) => "pressure",
        Payload::Dmx(_) => "DMX channel",
        Payload::Mqtt(..) => "MQTT message",
        Payload::Run(_) => "start",
    }
}

/// `sending` with another time or target of this `sort`; a content that no longer fits becomes a usual one.
pub(super) fn refitted(sending: &Sending, sort: TargetSort) -> Option<Sending> {
    let fits = sending.payload.sort() == sort && sending.payload.suits(sending.when);
    if fits {
        return Some(sending.clone());
    }
    let payload = contents(sort, sending.when).into_iter().next()?;
    Some(Sending { payload, ..sending.clone() })
}

/// A first message to the target of this name and `sort`, for a control of this `behaviour`.
pub(super) fn first(behaviour: &Behaviour, target: &str, sort: TargetSort) -> Option<Sending> {
    let times = times(behaviour);
    // A click is most of what people send.
    let usual = When::On(Trigger::CLICKED);
    let mut times = times.iter().filter(|when| **when == usual).chain(&times);
    times.find_map(|when| {
        let payload = contents(sort, *when).into_iter().next()?;
        Some(Sending { when: *when, target: target.to_owned(), payload })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use underfoot::schema::Kinds;

    #[test]
    fn every_kind_of_control_can_send_something_to_every_sort_of_target() {
        for kind in Kinds::builtin().iter() {
            for sort in TargetSort::ALL {
                let sending = first(&kind.behaviour, "there", sort);
                assert!(sending.is_some(), "{} to {}", kind.name, sort.noun());
                // A program starts at events only.
                let suits = |when: &When| !contents(sort, *when).is_empty();
                for when in times(&kind.behaviour).into_iter().filter(suits) {
                    let moved = refitted(&Sending { when, ..sending.clone().unwrap() }, sort);
                    assert!(moved.is_some_and(|it| it.payload.suits(when)), "{} {when}", kind.name);
                }
            }
        }
    }
}
