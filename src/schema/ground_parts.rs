//! The parts that grounds are described by, each over a base that says what is not written.

use std::ops::RangeInclusive;

use super::behaviour::{optional, single};
use super::fields::Fields;
use super::node::Node;
use super::number::plain;
use super::problem::Problem;
use crate::feel::MAX_MODES;
use crate::ground::{Body, CrackRules, EnergyLaw, Ring, Sheet};
use crate::units::Newtons;

/// What the floor's actuators move and a foot can feel, in hertz.
const HERTZ: RangeInclusive<f64> = 20.0..=1000.0;

pub(super) fn body(node: Node<'_>, base: Body) -> Option<Body> {
    let mut fields = node.fields("Body")?;
    let mass = fields.read("mass_kg", Some(base.mass_kg), |node| single(node, 0.01..=10_000.0));
    let damping =
        fields.read("damping_n_s_m", Some(base.damping_n_s_m), |node| single(node, 0.0..=10_000_000.0));
    let stiffness =
        fields.read("stiffness_n_m", Some(base.stiffness_n_m), |node| single(node, 100.0..=1_000_000_000.0));
    fields.finish();
    Some(Body { mass_kg: mass?, damping_n_s_m: damping?, stiffness_n_m: stiffness? })
}

pub(super) fn energy(node: Node<'_>, base: EnergyLaw) -> Option<EnergyLaw> {
    let mut fields = node.fields("Energy")?;
    let gamma = fields.read("gamma", Some(base.gamma), |node| single(node, -5.0..=5.0));
    let least = fields.read("least_j", Some(base.least_j), |node| single(node, 0.0001..=1000.0));
    let most = fields.read("most_j", Some(base.most_j), |node| single(node, 0.0001..=1000.0));
    in_order(&fields, "least_j", least, "most_j", most);
    fields.finish();
    Some(EnergyLaw { gamma: gamma?, least_j: least?, most_j: most? })
}

pub(super) fn ring(node: Node<'_>, base: Ring) -> Option<Ring> {
    let mut fields = node.fields("Ring")?;
    let level = fields.read("level_n", Some(base.level.0), |node| single(node, 0.0..=200.0));
    let modes = fields.read("modes", Some(base.modes.into()), |node| node.whole(1..=MAX_MODES as u32));
    let low = fields.read("low_hz", Some(base.low_hz), |node| single(node, HERTZ));
    let high = fields.read("high_hz", Some(base.high_hz), |node| single(node, HERTZ));
    in_order(&fields, "low_hz", low, "high_hz", high);
    let millis = |node| single(node, 1.0..=2000.0);
    let shortest = fields.read("shortest_ms", Some(base.shortest_s * 1000.0), millis);
    let longest = fields.read("longest_ms", Some(base.longest_s * 1000.0), millis);
    in_order(&fields, "shortest_ms", shortest, "longest_ms", longest);
    fields.finish();
    Some(Ring {
        level: Newtons(level?),
        modes: modes? as u8,
        low_hz: low?,
        high_hz: high?,
        shortest_s: shortest? / 1000.0,
        longest_s: longest? / 1000.0,
    })
}

pub(super) fn cracks(node: Node<'_>, base: CrackRules) -> Option<CrackRules> {
    let mut fields = node.fields("Cracks")?;
    let apart = fields.read("apart_m", Some(base.apart_m), |node| single(node, 0.01..=10.0));
    let growth = fields.read("growth_m_per_j", Some(base.per_j_m), |node| single(node, 0.0001..=10.0));
    let turn = fields.read("turn", Some(base.turn), |node| single(node, 0.0..=3.0));
    let branch = fields.read("branch", Some(base.branch), |node| single(node, 0.0..=1.0));
    let degrees =
        fields.read("branch_deg", Some(base.branch_rad.to_degrees()), |node| single(node, 1.0..=120.0));
    let pieces = fields.read("pieces", Some(base.most as u32), |node| node.whole(16..=20_000));
    fields.finish();
    Some(CrackRules {
        apart_m: apart?,
        per_j_m: growth?,
        turn: turn?,
        branch: branch?,
        branch_rad: degrees?.to_radians(),
        most: pieces? as usize,
        refreeze_s: base.refreeze_s,
    })
}

pub(super) fn sheet(node: Node<'_>, base: Sheet) -> Option<Sheet> {
    let mut fields = node.fields("Sheet")?;
    let depth = fields.read("depth_per_j", Some(base.depth_per_j), |node| single(node, 0.0..=100.0));
    let reach = fields.read("reach_m", Some(base.reach_m), |node| single(node, 0.01..=2.0));
    let weakening = fields.read("weakening", Some(base.weakening), |node| single(node, 0.0..=100.0));
    let refreeze =
        optional(&mut fields, "refreeze_s", base.refreeze_s, |node| single(node, 1.0..=1_000_000.0));
    fields.finish();
    Some(Sheet { depth_per_j: depth?, reach_m: reach?, weakening: weakening?, refreeze_s: refreeze? })
}

/// Says so if what should be the larger of two numbers is not.
fn in_order(
    fields: &Fields<'_>,
    low_name: &'static str,
    low: Option<f32>,
    high_name: &'static str,
    high: Option<f32>,
) {
    if let (Some(low), Some(high)) = (low, high)
        && low > high
    {
        let span = fields.written_span(high_name).unwrap_or_else(|| fields.span(low_name));
        let found = format!("{low_name} is {}, {high_name} is {}", plain(low.into()), plain(high.into()));
        let message = format!("`{high_name}` must not be below `{low_name}`");
        fields.report(Problem::error(span, message).expected(found));
    }
}
