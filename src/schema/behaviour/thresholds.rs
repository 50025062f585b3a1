use std::time::Duration;

use super::super::fields::Fields;
use super::super::number::plain;
use super::super::problem::Problem;
use super::{Form, guard, millis, optional, single};
use crate::units::Newtons;
use crate::widget::{Thresholds, WeightShare};

/// A press below 10 N cannot be told from a foot resting beside the control; one above 1000 N is a jump.
const PRESS_N: std::ops::RangeInclusive<f64> = 10.0..=1000.0;

/// Parts of a person's weight; twice the weight is a jump.
const SHARE: std::ops::RangeInclusive<f64> = 0.01..=2.0;

/// Share of the press force from which on a release follows a press by mere swaying.
const RELEASE_SHARE: f32 = 0.8;

/// Release threshold of those who give only the other one, as a part of that.
const TWO_THIRDS: f32 = 0.67;

/// Longest dwell or lockout, in milliseconds.
const LONGEST_MS: f64 = 2000.0;

/// When a control of this form engages.
pub(super) fn read(fields: &mut Fields<'_>, form: Form, base: Option<Thresholds>) -> Option<Thresholds> {
    let press = fields.read("press_n", base.map(|base| base.press.0), |node| single(node, PRESS_N));
    let release =
        fields.read("release_n", base.map(|base| base.release.0), |node| single(node, 1.0..=1000.0));
    let share = share(fields, base.and_then(|base| base.share));
    let brief = Duration::from_millis(20);
    let dwell = millis(fields, "dwell_ms", base.map_or(brief, |base| base.dwell), LONGEST_MS);
    let lockout = millis(fields, "lockout_ms", base.map_or(brief, |base| base.lockout), LONGEST_MS);
    let guard = guard::read(fields, form, base.map(|base| base.guard), dwell);
    let (press, release) = (press?, release?);
    check_hysteresis(fields, ["press_n", "release_n"], [press, release], " N");
    Some(Thresholds {
        press: Newtons(press),
        release: Newtons(release),
        dwell: dwell?,
        lockout: lockout?,
        share: share?,
        guard: guard?,
    })
}

fn share(fields: &mut Fields<'_>, base: Option<WeightShare>) -> Option<Option<WeightShare>> {
    let press = optional(fields, "press_share", base.map(|base| base.press), |node| single(node, SHARE));
    let release = fields.read("release_share", Some(None), |node| single(node, 0.005..=2.0).map(Some));
    let Some(press) = press? else {
        if let Some(span) = fields.written_span("release_share") {
            let problem = Problem::error(span, "`release_share` needs `press_share`");
            fields.report(problem.expected("parts of the person's weight come in pairs"));
        }
        return Some(None);
    };
    // A base's release follows a new press threshold.
    let follow = base.map_or(TWO_THIRDS, |base| base.release / base.press);
    let release = release?.unwrap_or(press * follow);
    check_hysteresis(fields, ["press_share", "release_share"], [press, release], "");
    Some(Some(WeightShare { press, release }))
}

fn check_hysteresis(fields: &Fields<'_>, names: [&str; 2], [press, release]: [f32; 2], unit: &str) {
    let [press_name, release_name] = names;
    // What is wrong in the kind has been said there.
    let Some(span) = fields.written_span(release_name).or_else(|| fields.written_span(press_name)) else {
        return;
    };
    let shown = |force: f32| plain(force.into());
    let expected =
        format!("{press_name} is {}{unit}, {release_name} is {}{unit}", shown(press), shown(release));
    let good = if unit.is_empty() {
        shown((TWO_THIRDS * press * 1000.0).round() / 1000.0)
    } else {
        shown((TWO_THIRDS * press).round())
    };
    let help = format!("two thirds of {press_name} are a good start: {release_name}: {good}");
    if release >= press {
        let problem = Problem::error(span, format!("`{release_name}` must be below `{press_name}`"));
        fields.report(problem.expected(expected).help(help));
    } else if release > RELEASE_SHARE * press {
        let message = format!("`{release_name}` is so close to `{press_name}` that a swaying foot chatters");
        fields.report(Problem::warning(span, message).expected(expected).help(help));
    }
}
