use std::time::Duration;

use super::super::fields::Fields;
use super::super::number::plain;
use super::super::problem::Problem;
use super::{millis, single};
use crate::widget::{LeanSpec, Thresholds};

/// A direction pad's settings.
pub(super) fn read(
    fields: &mut Fields<'_>,
    at: Option<Thresholds>,
    base: Option<&LeanSpec>,
) -> Option<LeanSpec> {
    // A foot's pressure wanders by half a centimetre while it stands, and by about four when it leans.
    let settle = base.map_or(Duration::from_millis(250), |base| base.settle);
    let settle = millis(fields, "settle_ms", settle, 2000.0);
    let metres = 0.001..=0.5;
    let deadband = fields
        .read("deadband_m", Some(base.map_or(0.008, |base| base.deadband_m)), |node| single(node, 0.0..=0.5));
    let full =
        fields.read("full_m", Some(base.map_or(0.03, |base| base.full_m)), |node| single(node, metres));
    let (deadband_m, full_m) = (deadband?, full?);
    if deadband_m >= full_m {
        let span = fields.written_span("full_m").or_else(|| fields.written_span("deadband_m"));
        let problem =
            Problem::error(span.unwrap_or_else(|| fields.start()), "`full_m` must be above `deadband_m`");
        let shown = |metres: f32| plain(metres.into());
        fields.report(problem.expected(format!(
            "deadband_m is {} m, full_m is {} m",
            shown(deadband_m),
            shown(full_m)
        )));
    }
    Some(LeanSpec { thresholds: at?, settle: settle?, deadband_m, full_m })
}
