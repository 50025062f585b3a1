//! The content of a line of JSON.

use serde::Serialize;

use super::Job;
use crate::engine::{ControlState, ValueRange};
use crate::feel::DeviceStatus;
use crate::floor::SensorId;
use crate::sense::{Contact, ContactId, SensorHealth, Trouble};
use crate::sink::backlog::Gap;
use crate::sink::crack_rate::CrackNews;
use crate::sink::{AreaNews, Report};
use crate::widget::{Detail, Scale, Value, WidgetEvent, WidgetId};
use crate::wire::LinkCause;

#[derive(Serialize)]
pub(super) struct Line<'a> {
    t_s: f64,
    #[serde(flatten)]
    body: Body<'a>,
}

#[derive(Serialize)]
#[serde(tag = "event", rename_all = "lowercase")]
enum Body<'a> {
    Page {
        page: &'a str,
    },
    Crack {
        seed: u32,
        energy_j: f32,
        x_m: f32,
        y_m: f32,
        skipped: u32,
    },
    Link {
        state: &'static str,
    },
    #[serde(rename = "link_cause")]
    LinkCause {
        cause: Option<&'static str>,
        board: Option<u16>,
        why: String,
    },
    Mute {
        all: bool,
        tiles: Vec<[u16; 2]>,
    },
    Health {
        live: u32,
        degraded: u32,
        stale: u32,
        faulty: u32,
        uncalibrated: u32,
        foreign: bool,
        troubles: Vec<TroubleEntry>,
    },
    Device {
        device: &'a str,
        state: &'static str,
        why: &'a str,
        channels: u16,
        sample_rate: u32,
        block: u32,
        underruns: u64,
        reopened: u64,
        priority: &'static str,
    },
    Area {
        area: &'a str,
        state: &'static str,
        why: &'a str,
        uncertainty_s: f64,
    },
    Gap {
        dropped: u64,
    },
    Contacts {
        contacts: Vec<ContactEntry>,
    },
    State {
        id: &'a str,
        value: Option<Value>,
        range: Option<JsonRange>,
        step: Option<f32>,
        options: Option<&'a [String]>,
        enabled: bool,
        off: Option<&'static str>,
        off_text: Option<&'a str>,
        locked: bool,
        pressed: bool,
        armed: bool,
        indicator: &'static str,
        label: &'a str,
        page: Option<&'a str>,
    },
    /// A state, not an event.
    #[serde(untagged)]
    Held {
        held: Vec<&'a str>,
        sequence: u32,
    },
    /// The event's name is the name of its kind.
    #[serde(untagged)]
    Control {
        event: &'static str,
        id: &'a str,
        value: Option<Detail>,
        force_n: f32,
        x_m: f32,
        y_m: f32,
        contact: Option<ContactId>,
    },
}

#[derive(Serialize)]
struct ContactEntry {
    id: ContactId,
    x_m: f32,
    y_m: f32,
    force_n: f32,
    x_velocity_m_s: f32,
    y_velocity_m_s: f32,
}

/// Minimum and maximum of a number, or of both numbers of a pair.
#[derive(Serialize)]
#[serde(untagged)]
enum JsonRange {
    Number([f32; 2]),
    Pair([[f32; 2]; 2]),
}

#[derive(Serialize)]
struct TroubleEntry {
    col: u16,
    row: u16,
    corner: &'static str,
    trouble: Trouble,
}

impl<'a> Line<'a> {
    /// Returns the line for `job`; `None` for a job without a line.
    pub(super) fn of(job: &'a Job) -> Option<Self> {
        let (at, body) = match job {
            Job::Gap(Gap { at, dropped }) => (*at, Body::Gap { dropped: *dropped }),
            Job::Report(report) => (report.at(), Body::of(report)?),
        };
        // A division, not a multiplication: it gives the number nearest to the decimal fraction, with six places at
        // most.
        Some(Self { t_s: at.micros() as f64 / 1e6, body })
    }
}

impl<'a> Body<'a> {
    fn of(report: &'a Report<'_>) -> Option<Self> {
        Some(match report {
            Report::Event(event) => Self::control(event),
            Report::Contacts(_, contacts) => {
                Self::Contacts { contacts: contacts.iter().map(ContactEntry::of).collect() }
            }
            Report::Page(shown) => Self::Page { page: shown.page.as_str() },
            &Report::Crack(CrackNews { seed, energy_j, x_m, y_m, skipped, .. }) => {
                Self::Crack { seed, energy_j, x_m, y_m, skipped }
            }
            Report::Link(_, state) => Self::Link { state: state.name() },
            Report::LinkCause(_, cause) => Self::LinkCause {
                cause: cause.as_deref().map(LinkCause::name),
                board: cause.as_deref().and_then(LinkCause::board),
                why: cause.as_ref().map(ToString::to_string).unwrap_or_default(),
            },
            Report::Health(_, health) => Self::health(health),
            Report::Device(_, status) => Self::device(status),
            Report::Held(report) => {
                let held = report.held.iter().map(WidgetId::as_str).collect();
                Self::Held { held, sequence: report.sequence }
            }
            Report::Ground(_) | Report::Alive(..) => return None,
            Report::Muted(_, muted) => {
                let tiles = muted.tiles.iter().map(|tile| [tile.column, tile.row]).collect();
                Self::Mute { all: muted.all, tiles }
            }
            Report::Control(_, state) => Self::state(state),
            Report::Area(news) => {
                let AreaNews { area, state, why, uncertainty, .. } = news.as_ref();
                Self::Area { area, state: state.name(), why, uncertainty_s: uncertainty.as_secs_f64() }
            }
        })
    }

    fn health(health: &SensorHealth) -> Self {
        let SensorHealth { counts: [live, degraded, stale, faulty], uncalibrated, foreign, ref troubles } =
            *health;
        let entry = |&(SensorId { tile, corner }, trouble): &(SensorId, Trouble)| TroubleEntry {
            col: tile.column,
            row: tile.row,
            corner: corner.name(),
            trouble,
        };
        let troubles = troubles.iter().map(entry).collect();
        Self::Health { live, degraded, stale, faulty, uncalibrated, foreign, troubles }
    }

    fn device(status: &'a DeviceStatus) -> Self {
        Self::Device {
            device: &status.name,
            state: status.state.name(),
            why: &status.why,
            channels: status.channels,
            sample_rate: status.sample_rate,
            block: status.block,
            underruns: status.underruns,
            reopened: status.reopened,
            priority: status.priority.name(),
        }
    }

    fn state(state: &'a ControlState) -> Self {
        let ControlState { id, value, range, enabled, off, locked, pressed, armed, indicator, label, page } =
            state;
        let ends = |scale: &Scale| [scale.min, scale.max];
        let (range, step, options) = match range {
            Some(ValueRange::Number(scale)) => {
                (Some(JsonRange::Number(ends(scale))), (scale.step > 0.0).then_some(scale.step), None)
            }
            Some(ValueRange::Pair(x, y)) => (Some(JsonRange::Pair([ends(x), ends(y)])), None, None),
            Some(ValueRange::Choices(choices)) => (None, None, Some(choices.as_slice())),
            None => (None, None, None),
        };
        Self::State {
            id: id.as_str(),
            value: *value,
            range,
            step,
            options,
            enabled: *enabled,
            off: off.as_ref().map(|off| off.reason.name()),
            off_text: off.as_ref().map(|off| off.text.as_str()),
            locked: *locked,
            pressed: *pressed,
            armed: *armed,
            indicator: indicator.name(),
            label,
            page: page.as_ref().map(WidgetId::as_str),
        }
    }

    fn control(event: &'a WidgetEvent) -> Self {
        Self::Control {
            event: event.kind.name(),
            id: event.id.as_str(),
            value: event.kind.detail(),
            force_n: event.force.0,
            x_m: event.position.x,
            y_m: event.position.y,
            contact: event.contact,
        }
    }
}

impl ContactEntry {
    fn of(contact: &Contact) -> Self {
        let ([x_m, y_m], [x_velocity_m_s, y_velocity_m_s]) =
            (contact.centroid.to_array(), contact.velocity.to_array());
        Self { id: contact.id, x_m, y_m, force_n: contact.force.0, x_velocity_m_s, y_velocity_m_s }
    }
}
