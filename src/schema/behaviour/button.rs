use std::time::Duration;

use super::super::fields::Fields;
use super::super::number::plain;
use super::super::problem::Problem;
use super::{optional, single};
use crate::units::Newtons;
use crate::widget::{ActsOn, ButtonSpec, Gestures, Guard, HardStage, Thresholds};

/// A push button's settings.
pub(super) fn read(
    fields: &mut Fields<'_>,
    at: Option<Thresholds>,
    base: Option<&ButtonSpec>,
) -> Option<ButtonSpec> {
    let known = base.map(|base| base.gestures).unwrap_or_default();
    let acts_on = fields.read("acts_on", Some(base.map_or(ActsOn::Release, |base| base.acts_on)), |node| {
        node.choice(&[("Press", ActsOn::Press), ("Release", ActsOn::Release)])
    });
    let double_tap = wait(fields, "double_tap_ms", known.double_tap, 100.0..=1000.0);
    let long_press = wait(fields, "long_press_ms", known.long_press, 200.0..=5000.0);
    let swipe_m = optional(fields, "swipe_m", known.swipe_m, |node| single(node, 0.02..=1.0));
    let hard = hard(fields, at, known.hard);
    let gestures =
        Gestures { double_tap: double_tap?, long_press: long_press?, swipe_m: swipe_m?, hard: hard? };
    let spec = ButtonSpec { thresholds: at?, acts_on: acts_on?, gestures };
    check(fields, &spec);
    Some(spec)
}

fn wait(
    fields: &mut Fields<'_>,
    name: &'static str,
    base: Option<Duration>,
    range: std::ops::RangeInclusive<f64>,
) -> Option<Option<Duration>> {
    optional(fields, name, base, |node| {
        node.number(range).map(|number| Duration::from_micros((number.value * 1e3).round() as u64))
    })
}

fn hard(
    fields: &mut Fields<'_>,
    at: Option<Thresholds>,
    base: Option<HardStage>,
) -> Option<Option<HardStage>> {
    let press = optional(fields, "hard_n", base.map(|base| base.press.0), |node| single(node, 10.0..=2000.0));
    let release = fields.read("hard_release_n", Some(None), |node| single(node, 1.0..=2000.0).map(Some));
    let Some(press) = press? else {
        if let Some(span) = fields.written_span("hard_release_n") {
            let problem = Problem::error(span, "`hard_release_n` needs `hard_n`");
            fields.report(problem.expected("a second stage needs both"));
        }
        return Some(None);
    };
    let follow = base.map_or(0.75, |base| base.release / base.press);
    let release = release?.unwrap_or(press * follow);
    let light = at.map_or(0.0, |at| at.press.0);
    let shown = |force: f32| plain(force.into());
    if release >= press || release <= light {
        // What is wrong in the kind has been said there.
        let names = ["hard_release_n", "hard_n", "press_n"];
        if let Some(span) = names.iter().find_map(|name| fields.written_span(name)) {
            let problem =
                Problem::error(span, "the second stage must end between `press_n` and its own beginning");
            let found = format!(
                "press_n is {} N, hard_release_n {} N, hard_n {} N",
                shown(light),
                shown(release),
                shown(press)
            );
            fields.report(problem.expected(found));
        }
    }
    Some(Some(HardStage { press: Newtons(press), release: Newtons(release) }))
}

/// Settings that contradict each other.
fn check(fields: &Fields<'_>, spec: &ButtonSpec) {
    let Gestures { double_tap, long_press, swipe_m, .. } = spec.gestures;
    let waits = [
        ("double_tap_ms", double_tap.is_some()),
        ("long_press_ms", long_press.is_some()),
        ("swipe_m", swipe_m.is_some()),
    ];
    let span = |name: &str| fields.written_span(name).unwrap_or_else(|| fields.start());
    for (name, _) in waits.iter().filter(|(_, given)| *given) {
        if spec.acts_on == ActsOn::Press {
            let message = format!("a button that acts on press cannot wait for `{name}`");
            let problem = Problem::error(span(name), message).expected("what it is shows later");
            fields.report(problem.help("write acts_on: Release, or leave the gesture out"));
        }
    }
    if double_tap.is_some() && matches!(spec.thresholds.guard, Guard::Confirm { .. }) {
        let problem =
            Problem::error(span("double_tap_ms"), "a guard that confirms takes two presses already");
        fields.report(problem.expected("a double tap can't be told from them"));
    }
}
