use super::super::fields::Fields;
use crate::widget::{SwitchSpec, Thresholds};

/// A switch's settings.
pub(super) fn read(
    fields: &mut Fields<'_>,
    at: Option<Thresholds>,
    base: Option<&SwitchSpec>,
) -> Option<SwitchSpec> {
    let before = base.is_some_and(|base| base.initial);
    let initial = fields.read("initial", Some(before), |node| node.flag());
    Some(SwitchSpec { thresholds: at?, initial: initial? })
}
