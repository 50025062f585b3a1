//! The side panel's link, sensors and sound card.

use eframe::egui;
use eframe::egui::{CollapsingHeader, Ui};

use super::super::style::{quiet, row};
use underfoot::engine::Snapshot;
use underfoot::feel::DeviceState;
use underfoot::sense::Quality;
use underfoot::wire::{LinkCounters, LinkState};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Shows the state of the sensors, and lists those with faults.
pub(super) fn health_part(ui: &mut Ui, theme: &Theme, snapshot: &Snapshot) {
    if snapshot.link == LinkState::Waiting {
        return;
    }
    let health = &snapshot.health;
    if snapshot.link == LinkState::Lost {
        ui.add_space(2.0);
        let text = "Sensors: none heard, the link is lost";
        ui.label(egui::RichText::new(text).color(color(theme.fault)));
        return;
    }
    let colour = match health {
        health if health.count(Quality::Faulty) > 0 => theme.fault,
        health if health.is_well() => theme.ink,
        _ => theme.warning,
    };
    ui.add_space(2.0);
    let title = egui::RichText::new(format!("Sensors: {health}")).color(color(colour));
    CollapsingHeader::new(title).id_salt("health").show_unindented(ui, |ui| {
        for (sensor, trouble) in &health.troubles {
            let line = row(ui, 17.0, 12.5, &format!("{sensor}: {trouble}"));
            line.left(0.04, 0.3, &sensor.to_string(), color(theme.ink));
            line.right(1.0, &trouble.to_string(), color(theme.warning));
        }
        if health.uncalibrated > 0 {
            ui.label(quiet(theme, format!("{} never calibrated: nominal parts", health.uncalibrated)));
        }
        if health.foreign {
            ui.label(quiet(theme, "the floor file seems to be another floor's"));
        }
        if health.is_well() {
            ui.label(quiet(theme, "every one answers as its plate demands"));
        }
    });
}

/// Shows the state of the device that drives the actuators, if there is one.
pub(super) fn device_part(ui: &mut Ui, theme: &Theme, snapshot: &Snapshot) {
    let Some(status) = &snapshot.device else { return };
    let colour = match status.state {
        DeviceState::Playing if status.is_well() => theme.ink,
        DeviceState::Playing => theme.warning,
        DeviceState::Lost | DeviceState::Faulty | DeviceState::Unfit => theme.fault,
    };
    ui.add_space(2.0);
    let muted = if snapshot.muted.all { ", muted" } else { "" };
    ui.label(egui::RichText::new(format!("Actuators: {status}{muted}")).color(color(colour)));
}

/// Shows the numbers of received packets, and of refused ones by reason.
pub(super) fn link_part(ui: &mut Ui, theme: &Theme, snapshot: &Snapshot) {
    let counters = snapshot.counters;
    ui.add_space(2.0);
    if let Some(cause) = &snapshot.link_cause {
        ui.label(egui::RichText::new(cause.to_string()).color(color(theme.fault)));
    }
    let headline = headline(&counters);
    let bad = counters.refused() + counters.lost + counters.overflowed + counters.bad_readings > 0;
    let colour = color(if bad { theme.warning } else { theme.ink });
    let title = egui::RichText::new(headline).color(colour);
    CollapsingHeader::new(title).id_salt("link").show_unindented(ui, |ui| details(ui, theme, &counters));
}

/// A summary in one line of nearly constant length.
fn headline(counters: &LinkCounters) -> String {
    format!("Link: {} lost, {} refused", grouped(counters.lost), grouped(counters.refused()))
}

/// Shows a name and a count on a line of its own, highlighted if the count is a `fault` and not zero.
pub(super) fn figure(ui: &mut Ui, theme: &Theme, name: &str, count: u64, fault: bool) {
    let figure = grouped(count);
    let line = row(ui, 17.0, 12.5, &format!("{name}: {figure}"));
    let seen = fault && count > 0;
    line.left(0.04, 0.75, name, color(if seen { theme.warning } else { theme.quiet }));
    line.right(1.0, &figure, color(if seen { theme.warning } else { theme.ink }));
}

fn details(ui: &mut Ui, theme: &Theme, counters: &LinkCounters) {
    ui.spacing_mut().item_spacing.y = 1.0;
    for (name, count, fault) in lines(counters) {
        figure(ui, theme, name, count, fault);
    }
    ui.spacing_mut().item_spacing.y = 5.0;
}

/// Name, count, and whether a non-zero count is a fault.
fn lines(counters: &LinkCounters) -> [(&'static str, u64, bool); 23] {
    [
        ("datagrams", counters.datagrams, false),
        ("sensor packets", counters.packets, false),
        ("frames", counters.frames, false),
        ("frames held back for the tare", counters.held_back, false),
        ("lost packets", counters.lost, true),
        ("late packets", counters.late, true),
        ("repeated packets", counters.duplicate, true),
        ("packets out of line", counters.out_of_order, true),
        ("boards restarted", counters.restarts, true),
        ("clock slips", counters.slips, false),
        ("refused: malformed", counters.malformed, true),
        ("refused: unknown address", counters.unknown_address, true),
        ("skipped: for other receivers", counters.skipped, false),
        ("refused: wrong shape", counters.wrong_shape, true),
        ("refused: foreign sender", counters.foreign, true),
        ("refused: too many of one sender", counters.limited, true),
        ("bad readings", counters.bad_readings, true),
        ("dropped by the system", counters.overflowed, true),
        ("sensors found in trouble", counters.sensor_troubles, true),
        ("boards that stood still", counters.frozen, true),
        ("tiles that repeated readings", counters.repeats, true),
        ("loads that jumped", counters.jumps, true),
        ("times too slow for real time", counters.overruns, true),
    ]
}

/// Digits in groups of three, so that millions are legible.
pub(in crate::preview) fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            text.push('\u{a0}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_counts_can_be_read() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(1_234_567), "1\u{a0}234\u{a0}567");
    }

    #[test]
    fn the_headline_counts_every_reason_to_refuse() {
        let counters = LinkCounters { lost: 1200, malformed: 1, wrong_shape: 2, ..LinkCounters::default() };
        assert_eq!(headline(&counters), "Link: 1\u{a0}200 lost, 3 refused");
    }
}
