use super::super::fields::Fields;
use super::super::number::plain;
use super::super::problem::Problem;
use super::{scale, single};
use crate::units::Newtons;
use crate::widget::{PedalSpec, Thresholds};

/// A pedal's settings.
pub(super) fn read(
    fields: &mut Fields<'_>,
    at: Option<Thresholds>,
    base: Option<&PedalSpec>,
) -> Option<PedalSpec> {
    let scale = scale::read(fields, base.map(|base| base.scale));
    let press = at.map(|at| at.press);
    // Unless it says otherwise, a pedal begins to give where it engages.
    let known =
        base.filter(|base| base.deadband != base.thresholds.press).map(|base| base.deadband).or(press);
    let deadband =
        fields.read("deadband_n", Some(known), |node| single(node, 0.0..=1000.0).map(|n| Some(Newtons(n))));
    let full =
        fields.read("full_n", base.map(|base| base.full), |node| single(node, 10.0..=2000.0).map(Newtons));
    let curve =
        fields.read("curve", Some(base.map_or(1.0, |base| base.curve)), |node| single(node, 0.2..=5.0));
    let (deadband, full) = (deadband??, full?);
    if deadband >= full {
        let span = fields.written_span("full_n").or_else(|| fields.written_span("deadband_n"));
        let problem =
            Problem::error(span.unwrap_or_else(|| fields.start()), "`full_n` must be above `deadband_n`");
        let shown = |force: Newtons| plain(force.0.into());
        fields.report(problem.expected(format!(
            "deadband_n is {} N, full_n is {} N",
            shown(deadband),
            shown(full)
        )));
    }
    Some(PedalSpec { thresholds: at?, scale: scale?, deadband, full, curve: curve? })
}
