use arrayvec::ArrayVec;

use super::behaviour::single;
use super::node::Node;
use super::number::plain;
use super::problem::Problem;
use crate::feel::{Click, Feel, Friction, MAX_MODES, Mode};
use crate::units::Newtons;

/// What the floor's actuators move and a foot can feel, in hertz.
const HERTZ: std::ops::RangeInclusive<f64> = 20.0..=1000.0;

/// Force at the plate; actuators give 40 N and more.
const LEVEL_N: std::ops::RangeInclusive<f64> = 0.0..=200.0;

/// `base` with what is written; `None` in place of a part silences it.
pub(super) fn read_over(node: Node<'_>, base: &Feel) -> Option<Feel> {
    let mut fields = node.fields("Feel")?;
    let mut clicked =
        |name, base: &Option<Click>| fields.read(name, Some(base.clone()), |node| click(node, base.as_ref()));
    let press = clicked("press", &base.press);
    let release = clicked("release", &base.release);
    let step = clicked("step", &base.step);
    let stage = clicked("stage", &base.stage);
    let arm = clicked("arm", &base.arm);
    let warn = clicked("warn", &base.warn);
    let drag = fields.read("drag", Some(base.drag), |node| friction(node, base.drag.as_ref()));
    let sound = fields.read("sound", Some(base.sound), |node| single(node, 0.0..=1.0));
    fields.finish();
    Some(Feel {
        press: press?,
        release: release?,
        step: step?,
        stage: stage?,
        arm: arm?,
        warn: warn?,
        drag: drag?,
        sound: sound?,
    })
}

fn click(node: Node<'_>, base: Option<&Click>) -> Option<Option<Click>> {
    if node.is_none() {
        return Some(None);
    }
    let mut fields = node.fields("Click")?;
    let level = fields.read("level_n", base.map(|base| base.level.0), |node| single(node, LEVEL_N));
    let modes = fields.read("modes", base.map(|base| base.modes.clone()), modes);
    fields.finish();
    Some(Some(Click { level: Newtons(level?), modes: modes? }))
}

fn modes(node: Node<'_>) -> Option<ArrayVec<Mode, MAX_MODES>> {
    let nodes = node.list("mode", MAX_MODES)?;
    if nodes.is_empty() {
        let problem = Problem::error(node.span(), "a click needs a mode").expected("expected 1 to 8 modes");
        node.report(problem.help("for no click at all write None instead of Click(...)"));
        return None;
    }
    // All are read before the first that failed ends it, so that each is reported.
    let modes: Vec<Option<Mode>> = nodes.into_iter().map(mode).collect();
    modes.into_iter().collect()
}

fn mode(node: Node<'_>) -> Option<Mode> {
    let mut fields = node.fields("Mode")?;
    let frequency = fields.read("hz", None, |node| single(node, HERTZ));
    let decay = fields.read("decay_ms", None, |node| single(node, 1.0..=2000.0));
    let amplitude = fields.read("amplitude", Some(1.0), |node| single(node, -1.0..=1.0));
    fields.finish();
    Some(Mode { frequency_hz: frequency?, decay_s: decay? / 1000.0, amplitude: amplitude? })
}

fn friction(node: Node<'_>, base: Option<&Friction>) -> Option<Option<Friction>> {
    if node.is_none() {
        return Some(None);
    }
    let mut fields = node.fields("Friction")?;
    let level = fields.read("level_n", base.map(|base| base.level.0), |node| single(node, LEVEL_N));
    let low = fields.read("low_hz", base.map(|base| base.low_hz), |node| single(node, HERTZ));
    let high = fields.read("high_hz", base.map(|base| base.high_hz), |node| single(node, HERTZ));
    let speed = fields.read("full_speed_m_s", Some(base.map_or(0.6, |base| base.full_speed_m_s)), |node| {
        single(node, 0.01..=5.0)
    });
    let force = fields.read("full_force_n", Some(base.map_or(200.0, |base| base.full_force.0)), |node| {
        single(node, 1.0..=2000.0)
    });
    if let (Some(low), Some(high)) = (low, high)
        && low > high
    {
        let span = fields.written_span("high_hz").unwrap_or_else(|| fields.span("low_hz"));
        let found = format!("low_hz is {}, high_hz is {}", plain(low.into()), plain(high.into()));
        fields.report(Problem::error(span, "`high_hz` must not be below `low_hz`").expected(found));
    }
    fields.finish();
    Some(Some(Friction {
        level: Newtons(level?),
        low_hz: low?,
        high_hz: high?,
        full_speed_m_s: speed?,
        full_force: Newtons(force?),
    }))
}
