//! Frictions and textures.

use super::super::behaviour::single;
use super::super::fields::Fields;
use super::super::node::Node;
use super::super::number::plain;
use super::super::problem::Problem;
use super::{HERTZ, LEVEL_N, millis, share, within};
use crate::feel::{Band, Friction, Grains, Lasting, Material, Resonance, StickSlip, Texture};
use crate::units::Newtons;

/// What a foot does at its fastest and heaviest, where an effect doesn't say.
const FULL_SPEED_M_S: f32 = 0.6;
const FULL_FORCE_N: f32 = 200.0;

/// Slip speeds, in metres per second; forces, in newtons; distances, in metres.
const SPEEDS: std::ops::RangeInclusive<f64> = 0.01..=5.0;
const FORCES: std::ops::RangeInclusive<f64> = 1.0..=2000.0;
const SPACINGS: std::ops::RangeInclusive<f64> = 0.0003..=0.2;

pub(super) fn friction(fields: &mut Fields<'_>, base: Option<&Friction>) -> Option<Friction> {
    let level = fields.read("level_n", base.map(|base| base.level.0), |node| single(node, LEVEL_N));
    let low = fields.read("low_hz", base.map(|base| base.low_hz), |node| single(node, HERTZ));
    let high = fields.read("high_hz", base.map(|base| base.high_hz), |node| single(node, HERTZ));
    let (speed, force) = full(fields, base.map(|base| (base.full_speed_m_s, base.full_force)));
    if let (Some(low), Some(high)) = (low, high)
        && low > high
    {
        let span = fields.written_span("high_hz").unwrap_or_else(|| fields.span("low_hz"));
        let found = format!("low_hz is {}, high_hz is {}", plain(low.into()), plain(high.into()));
        fields.report(Problem::error(span, "`high_hz` must not be below `low_hz`").expected(found));
    }
    Some(Friction {
        level: Newtons(level?),
        low_hz: low?,
        high_hz: high?,
        full_speed_m_s: speed?,
        full_force: Newtons(force?),
    })
}

fn full(fields: &mut Fields<'_>, base: Option<(f32, Newtons)>) -> (Option<f32>, Option<f32>) {
    let (speed, force) = base.unwrap_or((FULL_SPEED_M_S, Newtons(FULL_FORCE_N)));
    let speed = fields.read("full_speed_m_s", Some(speed), |node| single(node, SPEEDS));
    let force = fields.read("full_force_n", Some(force.0), |node| single(node, FORCES));
    (speed, force)
}

fn material(fields: &mut Fields<'_>, base: Option<&Material>, band: Band) -> Option<Material> {
    let level = fields.read("level_n", base.map(|base| base.level.0), |node| single(node, LEVEL_N));
    let base_resonances = base.map(|base| base.resonances);
    let resonances = fields.read("resonances", base_resonances, |node| resonances(node, band));
    let bare = share(fields, "bare", Some(base.map_or(0.0, |base| base.bare)));
    let (speed, force) = full(fields, base.map(|base| (base.full_speed_m_s, base.full_force)));
    Some(Material {
        level: Newtons(level?),
        resonances: resonances?,
        bare: bare?,
        full_speed_m_s: speed?,
        full_force: Newtons(force?),
        trim: 1.0,
    })
}

fn resonances(node: Node<'_>, band: Band) -> Option<[Resonance; 2]> {
    let nodes = node.list("resonance", 2)?;
    if nodes.is_empty() {
        let problem = Problem::error(node.span(), "a material needs a resonance");
        node.report(problem.expected("expected 1 or 2 resonances"));
        return None;
    }
    let read: Vec<Option<Resonance>> = nodes
        .into_iter()
        .map(|node| {
            let mut fields = node.fields("Resonance")?;
            let hz = fields.read("hz", None, |node| within(node, band));
            let decay = millis(&mut fields, "decay_ms", None, 1.0..=200.0);
            let amplitude = share(&mut fields, "amplitude", Some(1.0));
            fields.finish();
            Some(Resonance { hz: hz?, decay_s: decay?, amplitude: amplitude? })
        })
        .collect();
    let read: Vec<Resonance> = read.into_iter().collect::<Option<_>>()?;
    let mut both = [Resonance::NONE; 2];
    for (resonance, read) in both.iter_mut().zip(read) {
        *resonance = read;
    }
    Some(both)
}

/// The same at its level, within `band`.
macro_rules! balanced {
    ($variant:ident, $effect:expr, $band:expr) => {
        match Lasting::$variant($effect).balanced($band) {
            Lasting::$variant(balanced) => Some(balanced),
            _ => None,
        }
    };
}

pub(super) fn texture(fields: &mut Fields<'_>, base: Option<&Texture>, band: Band) -> Option<Texture> {
    let material = material(fields, base.map(|base| &base.material), band);
    let spacing = fields.read("spacing_m", base.map(|base| base.spacing_m), |node| single(node, SPACINGS));
    let width = millis(fields, "width_ms", Some(base.map_or(0.0015, |base| base.width_s)), 0.3..=10.0);
    let uneven = share(fields, "uneven", Some(base.map_or(0.0, |base| base.uneven)));
    let texture = Texture { material: material?, spacing_m: spacing?, width_s: width?, uneven: uneven? };
    balanced!(Texture, texture, band)
}

pub(super) fn grains(fields: &mut Fields<'_>, base: Option<&Grains>, band: Band) -> Option<Grains> {
    let material = material(fields, base.map(|base| &base.material), band);
    let spacing = fields.read("spacing_m", base.map(|base| base.spacing_m), |node| single(node, SPACINGS));
    let width = millis(fields, "width_ms", Some(base.map_or(0.001, |base| base.width_s)), 0.3..=10.0);
    let spread = share(fields, "spread", Some(base.map_or(0.5, |base| base.spread)));
    let grains = Grains { material: material?, spacing_m: spacing?, width_s: width?, spread: spread? };
    balanced!(Grains, grains, band)
}

pub(super) fn stick_slip(fields: &mut Fields<'_>, base: Option<&StickSlip>, band: Band) -> Option<StickSlip> {
    let material = material(fields, base.map(|base| &base.material), band);
    let grip = fields.read("grip", base.map(|base| base.grip), |node| single(node, 0.1..=2.0));
    let glide = fields.read("glide", base.map(|base| base.glide), |node| single(node, 0.05..=2.0));
    let let_go = fields.read("let_go_m_s", Some(base.map_or(0.05, |base| base.let_go_m_s)), |node| {
        single(node, 0.001..=1.0)
    });
    let stretch =
        fields.read("stretch_m", base.map(|base| base.stretch_m), |node| single(node, 0.0002..=0.05));
    let sole = fields
        .read("sole_hz", Some(base.map_or(150.0, |base| base.sole_hz)), |node| single(node, 20.0..=600.0));
    let rough = share(fields, "rough", Some(base.map_or(0.1, |base| base.rough)));
    if let (Some(grip), Some(glide)) = (grip, glide)
        && glide > grip
    {
        let span = fields.written_span("glide").unwrap_or_else(|| fields.span("grip"));
        let found = format!("grip is {}, glide is {}", plain(grip.into()), plain(glide.into()));
        fields.report(Problem::error(span, "`glide` must not be above `grip`").expected(found));
    }
    let stick = StickSlip {
        material: material?,
        grip: grip?,
        glide: glide?,
        let_go_m_s: let_go?,
        stretch_m: stretch?,
        sole_hz: sole?,
        rough: rough?,
    };
    balanced!(StickSlip, stick, band)
}
