//! `/metrics`: the state of a floor in the text format of OpenMetrics, which Prometheus reads.

use std::fmt;

use prometheus_client::collector::Collector;
use prometheus_client::encoding::text::encode;
use prometheus_client::encoding::{DescriptorEncoder, EncodeLabelSet, EncodeMetric};
use prometheus_client::metrics::MetricType;
use prometheus_client::metrics::counter::ConstCounter;
use prometheus_client::metrics::gauge::ConstGauge;
use prometheus_client::registry::{Registry, Unit};
use underfoot::feel::FeelCounters;
use underfoot::sense::Quality;
use underfoot::wire::{LinkCounters, LinkState};

use super::health::quality;
use super::observed::{HealthState, ObservedFloor};

/// The type of the text.
pub(super) const TYPE: &str = "application/openmetrics-text; version=1.0.0; charset=utf-8";

/// The metrics of a floor.
pub(super) fn text(seen: ObservedFloor) -> String {
    let mut registry = Registry::with_prefix("underfoot");
    registry.register_collector(Box::new(seen));
    let mut text = String::new();
    // Writing into a text does not fail.
    let _ = encode(&mut text, &registry);
    text
}

impl Collector for ObservedFloor {
    fn encode(&self, mut encoder: DescriptorEncoder<'_>) -> fmt::Result {
        let to = &mut MetricWriter(&mut encoder);
        self.write_program(to)?;
        self.write_link(to)?;
        self.write_boards(to)?;
        self.write_sensors(to)?;
        self.write_controls(to)?;
        self.write_outputs(to)
    }
}

impl ObservedFloor {
    fn write_program(&self, to: &mut MetricWriter<'_, '_>) -> fmt::Result {
        to.gauges("build_info", "The program", None, [([("version", env!("CARGO_PKG_VERSION"))], 1.0)])?;
        to.gauge("uptime", "Time since the start", Some(&Unit::Seconds), self.uptime.as_secs_f64())?;
        let (state, _) = self.health();
        let states = HealthState::ALL.map(|other| ([("state", other.name())], flag(other == state)));
        to.gauges("health", "1 for the state of the floor: /health has the reasons", None, states)
    }

    fn write_link(&self, to: &mut MetricWriter<'_, '_>) -> fmt::Result {
        let floor = &self.snapshot.floor;
        let states = [LinkState::Waiting, LinkState::Live, LinkState::Partial, LinkState::Lost];
        let states = states.map(|state| ([("state", state.name())], flag(state == floor.link)));
        to.gauges("link", "1 for the state of the link to the boards", None, states)?;
        to.counter("floor_losses", "Times that the whole floor was lost", self.losses)?;
        let counters = &floor.counters;
        to.counter("datagrams", "Datagrams received, valid or not", counters.datagrams)?;
        to.counter("packets", "Packets of boards that were accepted", counters.packets)?;
        to.counter("frames", "Frames completed", counters.frames)?;
        to.counter(
            "priority_given_up",
            "Times that sensing gave up its real-time priority, since it did not keep up",
            counters.overruns,
        )?;
        let by_kind = |(kind, count)| ([("kind", kind)], count);
        to.counters("packet_faults", "Packets that were not used as they came, by the kind of fault", {
            faults(counters).map(by_kind)
        })?;
        to.counters("refused_datagrams", "Datagrams and messages that were refused, by reason", {
            refusals(counters).map(|(reason, count)| ([("reason", reason)], count))
        })?;
        to.counter("requests_denied", "Valid requests of apps that were refused", counters.denied)
    }

    fn write_boards(&self, to: &mut MetricWriter<'_, '_>) -> fmt::Result {
        let floor = &self.snapshot.floor;
        to.gauge("boards", "Boards in the floor file", None, floor.boards.into())?;
        to.gauge("boards_live", "Boards that send usable packets", None, floor.boards_live.into())?;
        let boards = || {
            let numbered = self.boards.iter().flatten().enumerate();
            numbered.map(|(number, (address, board))| {
                ([("board", number.to_string()), ("address", address.clone())], board)
            })
        };
        let counts = boards().map(|(labels, board)| (labels, board.counts.packets));
        to.counters("board_packets", "Packets of a board that were accepted", counts)?;
        let counts = boards().map(|(labels, board)| (labels, board.counts.lost));
        to.counters("board_lost_packets", "Packets of a board that did not arrive", counts)?;
        let counts = boards().map(|(labels, board)| (labels, board.counts.duplicate));
        to.counters("board_duplicate_packets", "Packets of a board that came twice", counts)?;
        let shares = boards().map(|(labels, board)| (labels, f64::from(board.loss)));
        to.gauges(
            "board_loss",
            "Share of the last second that was lost or too late",
            Some(&Unit::Ratios),
            shares,
        )?;
        let ages = boards().filter_map(|(labels, board)| Some((labels, board.age?.as_secs_f64())));
        to.gauges("board_age", "Time since the last usable packet of a board", Some(&Unit::Seconds), ages)
    }

    fn write_sensors(&self, to: &mut MetricWriter<'_, '_>) -> fmt::Result {
        let health = &self.snapshot.floor.health;
        let qualities = [Quality::Live, Quality::Degraded, Quality::Stale, Quality::Faulty];
        let counts = qualities.map(|of| ([("quality", quality(of))], f64::from(health.count(of))));
        to.gauges("sensors", "Sensors by quality", None, counts)?;
        to.gauge("sensors_uncalibrated", "Sensors without a calibration", None, health.uncalibrated.into())?;
        let troubles = health.troubles.iter().map(|(sensor, trouble)| {
            let labels = [
                ("column", sensor.tile.column.to_string()),
                ("row", sensor.tile.row.to_string()),
                ("corner", sensor.corner.name().to_owned()),
                ("trouble", trouble.name().to_owned()),
            ];
            (labels, 1.0)
        });
        to.gauges("sensor_trouble", "1 for each sensor in trouble", None, troubles)
    }

    fn write_controls(&self, to: &mut MetricWriter<'_, '_>) -> fmt::Result {
        let floor = &self.snapshot.floor;
        to.gauge("feet", "Contacts on the floor", None, count(floor.contacts.len()))?;
        to.gauge("controls", "Controls of the layout", None, count(floor.widgets.len()))?;
        to.gauge("controls_held", "Controls that feet hold", None, count(floor.held.len()))?;
        let off = self.off().into_iter().map(|(reason, count)| ([("reason", reason)], count as f64));
        to.gauges("controls_off", "Controls that no foot can press, by reason", None, off)?;
        let events = self.events.iter().map(|(kind, count)| ([("kind", *kind)], *count));
        to.counters("events", "Events of controls, by kind", events)?;
        let ignored = self.ignored.iter().map(|(reason, count)| ([("reason", *reason)], *count));
        to.counters("presses_ignored", "Presses that controls ignored, by reason", ignored)
    }

    fn write_outputs(&self, to: &mut MetricWriter<'_, '_>) -> fmt::Result {
        let floor = &self.snapshot.floor;
        to.gauge("web_clients", "Web clients that are connected", None, count(self.clients.connected))?;
        to.counter("web_clients_served", "Web clients since the start", self.clients.served)?;
        to.counter("web_clients_dropped", "Web clients that did not read", self.clients.dropped)?;
        to.counter("web_pages_refused", "Web pages of other origins", self.clients.refused)?;
        to.counter("unsent_reports", "Reports that no queue had room for", floor.unsent_events)?;
        to.counter("target_messages", "Messages of controls to other programs", self.targets.sent)?;
        to.counter(
            "target_messages_unsent",
            "Messages that did not reach their target",
            self.targets.unsent,
        )?;
        let cues = cue_faults(&floor.feel).map(|(kind, count)| ([("kind", kind)], count));
        to.counters("cue_faults", "Feedback that was not played as it should be, by kind", cues)?;
        if let Some(device) = &floor.device {
            to.gauge("device_playing", "1 while the actuators play", None, flag(device.why.is_empty()))?;
            to.counter("device_underruns", "Blocks that came too late for the device", device.underruns)?;
            to.counter("device_reopened", "Times that the device was opened again", device.reopened)?;
        }
        Ok(())
    }
}

fn faults(counters: &LinkCounters) -> [(&'static str, u64); 10] {
    let LinkCounters { lost, late, duplicate, out_of_order, restarts, frozen, .. } = *counters;
    let LinkCounters { repeats, jumps, slips, bad_readings, .. } = *counters;
    [
        ("lost", lost),
        ("late", late),
        ("duplicate", duplicate),
        ("out_of_order", out_of_order),
        ("restarts", restarts),
        ("frozen", frozen),
        ("repeats", repeats),
        ("jumps", jumps),
        ("slips", slips),
        ("bad_readings", bad_readings),
    ]
}

fn refusals(counters: &LinkCounters) -> [(&'static str, u64); 6] {
    let LinkCounters { malformed, unknown_address, wrong_shape, foreign, limited, overflowed, .. } =
        *counters;
    [
        ("malformed", malformed),
        ("unknown_address", unknown_address),
        ("wrong_shape", wrong_shape),
        ("may_not_send", foreign),
        ("sent_too_much", limited),
        ("overflowed", overflowed),
    ]
}

fn cue_faults(felt: &FeelCounters) -> [(&'static str, u64); 10] {
    let FeelCounters { dropped, muted, late, unfelt, refused, stolen, .. } = *felt;
    let FeelCounters { not_finite, overloaded, silenced, heated, .. } = *felt;
    [
        ("dropped", dropped),
        ("muted", muted),
        ("late", late),
        ("unfelt", unfelt),
        ("refused", refused),
        ("stolen", stolen),
        ("not_finite", not_finite),
        ("overloaded", overloaded),
        ("silenced", silenced),
        ("heated", heated),
    ]
}

fn flag(is_so: bool) -> f64 {
    f64::from(u8::from(is_so))
}

fn count(number: usize) -> f64 {
    number as f64
}

/// Writes metrics one after the other.
struct MetricWriter<'a, 'b>(&'a mut DescriptorEncoder<'b>);

impl MetricWriter<'_, '_> {
    fn counter(&mut self, name: &str, help: &str, value: u64) -> fmt::Result {
        ConstCounter::new(value).encode(self.0.encode_descriptor(name, help, None, MetricType::Counter)?)
    }

    fn gauge(&mut self, name: &str, help: &str, unit: Option<&Unit>, value: f64) -> fmt::Result {
        ConstGauge::new(value).encode(self.0.encode_descriptor(name, help, unit, MetricType::Gauge)?)
    }

    fn counters<L: EncodeLabelSet>(
        &mut self,
        name: &str,
        help: &str,
        values: impl IntoIterator<Item = (L, u64)>,
    ) -> fmt::Result {
        let mut metric = self.0.encode_descriptor(name, help, None, MetricType::Counter)?;
        for (labels, value) in values {
            ConstCounter::new(value).encode(metric.encode_family(&labels)?)?;
        }
        Ok(())
    }

    fn gauges<L: EncodeLabelSet>(
        &mut self,
        name: &str,
        help: &str,
        unit: Option<&Unit>,
        values: impl IntoIterator<Item = (L, f64)>,
    ) -> fmt::Result {
        let mut metric = self.0.encode_descriptor(name, help, unit, MetricType::Gauge)?;
        for (labels, value) in values {
            ConstGauge::new(value).encode(metric.encode_family(&labels)?)?;
        }
        Ok(())
    }
}
