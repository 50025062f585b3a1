use super::super::fields::Fields;
use super::{scale, single};
use crate::widget::{DialSpec, Thresholds};

/// A dial's settings.
pub(super) fn read(
    fields: &mut Fields<'_>,
    at: Option<Thresholds>,
    base: Option<&DialSpec>,
) -> Option<DialSpec> {
    let scale = scale::read(fields, base.map(|base| base.scale));
    let turn = fields.read("turn_deg", Some(base.map_or(270.0, |base| base.turn_degrees)), |node| {
        single(node, 45.0..=3600.0)
    });
    let initial = scale::initial(fields, scale, base.map(|base| base.initial));
    Some(DialSpec { thresholds: at?, scale: scale?, turn_degrees: turn?, initial: initial? })
}
