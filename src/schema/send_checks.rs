//! Rules between the messages of controls, their targets and their kinds.

use std::collections::HashMap;

use super::control::WrittenControl;
use super::page::WrittenPage;
use super::pages;
use super::problem::Problem;
use super::reader::Reader;
use super::suggest::did_you_mean;
use super::version::{self, WITH_MESSAGES, version_with};
use crate::messages::{ContactPayload, Payload, Sending, TargetSort, When};
use crate::widget::{Behaviour, Guard};
use underfoot_format::codec::Written;

/// Reports messages without a target, messages that never go out or that nothing would end, and messages of two
/// controls.
pub(super) fn check(reader: &Reader<'_>, page: &WrittenPage) {
    let mut told: Vec<(usize, &'static str)> = Vec::new();
    let mut report = |at: &std::ops::Range<usize>, rule: &'static str, problem: Problem| {
        // All controls of a grid have the message of one place.
        if !told.contains(&(at.start, rule)) {
            told.push((at.start, rule));
            reader.report(problem);
        }
    };
    let of_controls = page.controls.iter().flat_map(|control| &control.send).next().map(|first| &first.at);
    let of_feet = page.regions.iter().flat_map(|region| &region.send).next().map(|first| &first.at);
    let written = of_controls.or(of_feet);
    if let Some(at) = page.targets.first().map(|target| &target.name.at).or(written) {
        version::require(reader, at.clone(), ("messages", WITH_MESSAGES), ("layout", page.version));
    }
    for target in &page.targets {
        let first = version_with(target.to().sort());
        if first > WITH_MESSAGES {
            let things = "targets of DMX or MQTT and programs";
            version::require(reader, target.name.at.clone(), (things, first), ("layout", page.version));
        }
    }
    for control in &page.controls {
        let Some(kind) = &control.kind else { continue };
        for Written { value: sending, at } in &control.send {
            let faults = [
                ("target", of_target(page, &sending.target, sending.payload.name(), sending.payload.sort())),
                ("event", of_event(sending, &kind.behaviour)),
                ("guard", of_guard(sending, &kind.behaviour)),
            ];
            for (rule, fault) in faults {
                let Some((message, expected, help)) = fault else { continue };
                let problem = Problem::error(at.clone(), message).expected(expected);
                report(at, rule, problem.help_if(help));
            }
        }
    }
    for Written { value: sending, at } in page.regions.iter().flat_map(|region| &region.send) {
        let fault = of_target(page, &sending.target, sending.payload.name(), sending.payload.sort());
        let Some((message, expected, help)) = fault else { continue };
        report(at, "target", Problem::error(at.clone(), message).expected(expected).help_if(help));
    }
    twice(reader, page);
    twice_by_feet(reader, page);
}

/// A problem: the message, the expected form, and advice.
type SendFault = Option<(String, String, Option<String>)>;

/// A problem of the target called `name`, which must be of the `sort` that receives the message `payload`.
fn of_target(page: &WrittenPage, name: &str, payload: &str, sort: TargetSort) -> SendFault {
    if !page.targets_known {
        return None;
    }
    let Some(target) = page.targets.iter().find(|target| target.name.value == *name) else {
        let names: Vec<&str> = page.targets.iter().map(|target| target.name.value.as_str()).collect();
        let to = sort.example();
        let add = || format!("add targets: [(name: \"{name}\", to: {to})]");
        let help = if names.is_empty() { add() } else { did_you_mean(name, &names, '"').unwrap_or_else(add) };
        return Some((format!("there is no target \"{name}\""), "no target is called so".into(), Some(help)));
    };
    let there = target.to().sort();
    (there != sort).then(|| {
        let message = format!("\"{name}\" can't receive {payload}");
        (message, format!("that target is {}", there.noun()), None)
    })
}

fn of_event(sending: &Sending, behaviour: &Behaviour) -> SendFault {
    match sending.when {
        When::On(trigger) if !trigger.is_given_by(behaviour) => Some((
            format!("this {} never gives `{}`", behaviour.name(), trigger.name()),
            "the message would never go out".into(),
            Some("`underfoot addresses` lists the events of a layout's controls".into()),
        )),
        When::Value if behaviour.initial().is_none() => Some((
            format!("this {} has no value", behaviour.name()),
            "the message would never go out".into(),
            Some("write On(clicked, ...)".into()),
        )),
        _ => None,
    }
}

fn of_guard(sending: &Sending, behaviour: &Behaviour) -> SendFault {
    let runs = matches!(behaviour.thresholds().guard, Guard::HoldToRun(_));
    (sending.when == When::While && !runs).then(|| {
        let message = "what is held down needs the guard HoldToRun".to_owned();
        let expected = "this control may be held on a floor in doubt".to_owned();
        (message, expected, Some("use the kind \"dead_man\", or write guard: HoldToRun(max_s: 60)".into()))
    })
}

/// Warns of two controls that send the same message and can be pressed at the same time.
fn twice(reader: &Reader<'_>, page: &WrittenPage) {
    let mut first: HashMap<String, Vec<(&WrittenControl, usize)>> = HashMap::new();
    for control in &page.controls {
        for Written { value: sending, at } in &control.send {
            // A wheel and a pointer may well be moved from several places.
            if matches!(sending.payload, Payload::Wheel(_) | Payload::Pointer(_)) {
                continue;
            }
            let message = format!("{:?} {}", sending.target, subject(&sending.payload));
            let others = first.entry(message).or_default();
            let other = others
                .iter()
                .find(|(other, _)| other.id != control.id && pages::can_both_show(other, control));
            if let Some((other, line)) = other {
                let problem = Problem::warning(at.clone(), "two controls send one message");
                let id = other.id.as_deref().unwrap_or_default();
                reader.report(problem.expected(format!("\"{id}\" on line {line} sends it too")));
                return;
            }
            others.push((control, reader.line(at)));
        }
    }
}

/// The thing that a message acts on: two controls that act on one are in each other's way.
fn subject(payload: &Payload) -> String {
    match payload {
        Payload::Key(_)
        | Payload::Button(_)
        | Payload::Wheel(_)
        | Payload::Pointer(_)
        | Payload::Osc(..)
        | Payload::Mqtt(..)
        | Payload::Run(_) => format!("{payload:?}"),
        // Several controls may well set one channel to levels of their own.
        Payload::Dmx(settings) => format!("{payload} to {}", settings.top()),
        // Settings of a note, or the ends of a range, make no other message of it.
        Payload::Note(..)
        | Payload::Controller(_)
        | Payload::Program(..)
        | Payload::Bend(_)
        | Payload::Pressure(_) => payload.to_string(),
    }
}

/// Warns of feet of two regions in one zone of MPE.
fn twice_by_feet(reader: &Reader<'_>, page: &WrittenPage) {
    let mut zones: HashMap<&str, std::ops::Range<usize>> = HashMap::new();
    for Written { value: sending, at } in page.regions.iter().flat_map(|region| &region.send) {
        if !matches!(sending.payload, ContactPayload::Mpe(_)) {
            continue;
        }
        if let Some(first) = zones.get(sending.target.as_str()) {
            let problem =
                Problem::warning(at.clone(), "two groups of feet share the channels of one MPE zone");
            let expected = format!("the first is on line {}", reader.line(first));
            reader.report(problem.expected(expected).help("give each a port of its own"));
        }
        zones.entry(&sending.target).or_insert_with(|| at.clone());
    }
}
