use std::time::Duration;

use super::fields::Fields;
use super::node::Node;
use super::number::plain;
use super::problem::Problem;
use crate::units::Newtons;
use crate::widget::{Axis, Behaviour, ButtonSpec, SliderSpec, SwitchSpec, Thresholds};

/// A press below 10 N cannot be told from a foot resting beside the control; one above 1000 N is a jump.
const PRESS_N: std::ops::RangeInclusive<f64> = 10.0..=1000.0;

/// Share of the press force from which on a release follows a press by mere swaying.
const RELEASE_SHARE: f32 = 0.8;

/// Values of sliders: as far as `f32` still resolves a tenth.
const VALUES: std::ops::RangeInclusive<f64> = -1e6..=1e6;

/// The behaviours by the names they have in kind files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Button,
    Switch,
    Slider,
}

impl Form {
    const ALL: [(&'static str, Self); 3] =
        [("Button", Self::Button), ("Switch", Self::Switch), ("Slider", Self::Slider)];

    /// The behaviour named by `node`.
    pub(super) fn read(node: Node<'_>) -> Option<Self> {
        node.choice(&Self::ALL)
    }

    fn of(behaviour: &Behaviour) -> Self {
        match behaviour {
            Behaviour::Button(_) => Self::Button,
            Behaviour::Switch(_) => Self::Switch,
            Behaviour::Slider(_) => Self::Slider,
        }
    }
}

/// A behaviour of this form; its settings must all be written.
pub(super) fn read(fields: &mut Fields<'_>, form: Form) -> Option<Behaviour> {
    merge(fields, form, None)
}

/// `base` with the settings that are written.
pub(super) fn read_over(fields: &mut Fields<'_>, base: &Behaviour) -> Option<Behaviour> {
    merge(fields, Form::of(base), Some(base))
}

fn merge(fields: &mut Fields<'_>, form: Form, base: Option<&Behaviour>) -> Option<Behaviour> {
    let thresholds = thresholds(fields, base.map(thresholds_of));
    match form {
        Form::Button => Some(Behaviour::Button(ButtonSpec { thresholds: thresholds? })),
        Form::Switch => {
            let before = matches!(base, Some(Behaviour::Switch(switch)) if switch.initial);
            let initial = fields.read("initial", Some(before), |node| node.flag());
            Some(Behaviour::Switch(SwitchSpec { thresholds: thresholds?, initial: initial? }))
        }
        Form::Slider => {
            let base = match base {
                Some(Behaviour::Slider(slider)) => Some(slider),
                _ => None,
            };
            slider(fields, thresholds, base).map(Behaviour::Slider)
        }
    }
}

fn thresholds_of(behaviour: &Behaviour) -> Thresholds {
    match behaviour {
        Behaviour::Button(ButtonSpec { thresholds })
        | Behaviour::Switch(SwitchSpec { thresholds, .. })
        | Behaviour::Slider(SliderSpec { thresholds, .. }) => *thresholds,
    }
}

fn thresholds(fields: &mut Fields<'_>, base: Option<Thresholds>) -> Option<Thresholds> {
    let press = fields.read("press_n", base.map(|base| base.press.0), |node| single(node, PRESS_N));
    let release =
        fields.read("release_n", base.map(|base| base.release.0), |node| single(node, 1.0..=1000.0));
    let dwell = fields.read("dwell_ms", Some(base.map_or(20.0, |base| millis(base.dwell))), |node| {
        single(node, 0.0..=2000.0)
    });
    let lockout = fields.read("lockout_ms", Some(base.map_or(20.0, |base| millis(base.lockout))), |node| {
        single(node, 0.0..=2000.0)
    });
    let (press, release) = (press?, release?);
    check_hysteresis(fields, press, release);
    Some(Thresholds {
        press: Newtons(press),
        release: Newtons(release),
        dwell: duration(dwell?),
        lockout: duration(lockout?),
        ..Thresholds::new(Newtons(press), Newtons(release))
    })
}

fn check_hysteresis(fields: &Fields<'_>, press: f32, release: f32) {
    // What is wrong in the kind has been said there.
    let Some(span) = fields.written_span("release_n").or_else(|| fields.written_span("press_n")) else {
        return;
    };
    let expected = format!("press_n is {} N, release_n is {} N", plain(press.into()), plain(release.into()));
    let help = format!("two thirds of press_n are a good start: release_n: {}", (press * 0.67).round());
    if release >= press {
        let problem = Problem::error(span, "`release_n` must be below `press_n`");
        fields.report(problem.expected(expected).help(help));
    } else if release > RELEASE_SHARE * press {
        let problem =
            Problem::warning(span, "`release_n` is so close to `press_n` that a swaying foot chatters");
        fields.report(problem.expected(expected).help(help));
    }
}

fn slider(
    fields: &mut Fields<'_>,
    thresholds: Option<Thresholds>,
    base: Option<&SliderSpec>,
) -> Option<SliderSpec> {
    let value = |node: Node<'_>| single(node, VALUES);
    let axis = fields.read("axis", Some(base.map_or(Axis::East, |base| base.axis)), |node| {
        node.choice(&[("East", Axis::East), ("North", Axis::North)])
    });
    let min = fields.read("min", base.map(|base| base.min), value);
    let max = fields.read("max", base.map(|base| base.max), value);
    let step = fields.read("step", Some(base.map_or(0.0, |base| base.step)), |node| single(node, 0.0..=1e6));
    let written = fields.read("initial", Some(None), |node| value(node).map(Some));
    let (min, max, step, written) = (min?, max?, step?, written?);

    if min >= max {
        let span = fields.written_span("max").unwrap_or_else(|| fields.span("min"));
        let found = format!("min is {}, max is {}", plain(min.into()), plain(max.into()));
        fields.report(Problem::error(span, "`max` must be greater than `min`").expected(found));
        return None;
    }
    let steps = (max - min) / step;
    if step > max - min {
        let found = format!("the range is only {} wide", plain((max - min).into()));
        fields.report(Problem::error(fields.span("step"), "`step` is wider than the range").expected(found));
    } else if step > 0.0 && (steps - steps.round()).abs() > 1e-3 {
        let found =
            format!("{} to {} is {} steps", plain(min.into()), plain(max.into()), plain(steps.into()));
        let problem = Problem::warning(fields.span("step"), "`max` is no whole number of steps from `min`");
        fields.report(problem.expected(found));
    }
    // A kind's initial value follows a widget that narrows the range.
    let initial = written.unwrap_or_else(|| base.map_or(min, |base| base.initial).clamp(min, max));
    if !(min..=max).contains(&initial) {
        let range = format!("expected {} to {}", plain(min.into()), plain(max.into()));
        fields.report(
            Problem::error(fields.span("initial"), "`initial` lies outside of the range").expected(range),
        );
    }
    Some(SliderSpec { thresholds: thresholds?, axis: axis?, min, max, step, initial })
}

/// A number of single precision within `range`.
pub(super) fn single(node: Node<'_>, range: std::ops::RangeInclusive<f64>) -> Option<f32> {
    node.number(range).map(|number| number.single)
}

fn millis(duration: Duration) -> f32 {
    duration.as_secs_f32() * 1000.0
}

fn duration(millis: f32) -> Duration {
    Duration::from_micros((f64::from(millis) * 1000.0).round() as u64)
}
