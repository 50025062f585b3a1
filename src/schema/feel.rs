use std::sync::Arc;

use super::behaviour::single;
use super::effect;
use super::node::Node;
use crate::feel::{Effect, Feel, Use};

/// `base` with what is written; `None` in place of a part silences it.
pub(super) fn read_over(node: Node<'_>, base: &Feel) -> Option<Feel> {
    let mut fields = node.fields("Feel")?;
    let mut part = |name, base: &Option<Arc<Effect>>, used| {
        fields.read(name, Some(base.clone()), |node| effect::read(node, base.as_ref(), used))
    };
    let press = part("press", &base.press, Use::Once);
    let release = part("release", &base.release, Use::Once);
    let step = part("step", &base.step, Use::Step);
    let end = part("end", &base.end, Use::End);
    let stage = part("stage", &base.stage, Use::Once);
    let arm = part("arm", &base.arm, Use::Once);
    let warn = part("warn", &base.warn, Use::Once);
    let on = part("on", &base.on, Use::Once);
    let off = part("off", &base.off, Use::Once);
    let hold = part("hold", &base.hold, Use::Hold);
    let drag = part("drag", &base.drag, Use::Drag);
    let sound = fields.read("sound", Some(base.sound), |node| single(node, 0.0..=1.0));
    fields.finish();
    Some(Feel {
        press: press?,
        release: release?,
        step: step?,
        end: end?,
        stage: stage?,
        arm: arm?,
        warn: warn?,
        on: on?,
        off: off?,
        hold: hold?,
        drag: drag?,
        sound: sound?,
    })
}
