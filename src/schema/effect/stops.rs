//! Detents and ends.

use arrayvec::ArrayVec;

use super::super::behaviour::single;
use super::super::fields::Fields;
use super::super::node::Node;
use super::{LEVEL_N, once, share, within};
use crate::feel::{Band, Detents, EndStop, Hum, MAX_MARKS, Push};
use crate::units::Newtons;

pub(super) fn detents(fields: &mut Fields<'_>, base: Option<&Detents>, band: Band) -> Option<Detents> {
    let click = once::click(fields, base.map(|base| &base.click), band);
    let every =
        fields.read("every", Some(base.map_or(0.0, |base| base.every)), |node| single(node, 0.0..=1.0));
    let falling =
        fields.read("falling", Some(base.map_or(1.0, |base| base.falling)), |node| single(node, 0.0..=4.0));
    let pitch = fields.read("pitch", Some(base.map_or([1.0; 2], |base| base.pitch)), pitch);
    let base_marks = base.map(|base| base.marks.clone()).unwrap_or_default();
    let marks = fields.read("marks", Some(base_marks), |node| {
        let marks: Vec<Option<f32>> =
            node.list("mark", MAX_MARKS)?.into_iter().map(|node| single(node, 0.0..=1.0)).collect();
        marks.into_iter().collect::<Option<ArrayVec<f32, MAX_MARKS>>>()
    });
    let mark = fields.read("mark", Some(base.map_or(1.6, |base| base.mark)), |node| single(node, 0.0..=4.0));
    Some(Detents {
        click: click?,
        every: every?,
        falling: falling?,
        pitch: pitch?,
        marks: marks?,
        mark: mark?,
    })
}

pub(super) fn end_stop(fields: &mut Fields<'_>, base: Option<&EndStop>, band: Band) -> Option<EndStop> {
    let click = once::click(fields, base.map(|base| &base.click), band);
    let pitch = fields.read("pitch", Some(base.map_or([1.0; 2], |base| base.pitch)), pitch);
    let base_push = base.and_then(|base| base.push);
    let push = fields.read("push", Some(base_push), |node| {
        if node.is_none() { Some(None) } else { push(node, base_push, band).map(Some) }
    });
    Some(EndStop { click: click?, pitch: pitch?, push: push? })
}

fn push(node: Node<'_>, base: Option<Push>, band: Band) -> Option<Push> {
    let mut fields = node.fields("Push")?;
    let level = fields.read("level_n", base.map(|base| base.hum.level.0), |node| single(node, LEVEL_N));
    let hz = fields.read("hz", base.map(|base| base.hum.hz), |node| within(node, band));
    let noise = share(&mut fields, "noise", Some(base.map_or(0.0, |base| base.hum.noise)));
    let full =
        fields.read("full_m", Some(base.map_or(0.03, |base| base.full_m)), |node| single(node, 0.001..=0.5));
    fields.finish();
    Some(Push { hum: Hum { level: Newtons(level?), hz: hz?, noise: noise? }, full_m: full? })
}

/// Factors of the frequencies at the low and the high end.
fn pitch(node: Node<'_>) -> Option<[f32; 2]> {
    let [low, high] = node.tuple("(low end, high end)")?;
    let (low, high) = (single(low, 0.1..=10.0), single(high, 0.1..=10.0));
    Some([low?, high?])
}
