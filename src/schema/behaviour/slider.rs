use super::super::fields::Fields;
use super::super::node::Node;
use super::super::problem::Problem;
use super::{scale, single, variant};
use crate::widget::{Axis, Mapping, SliderSpec, Thresholds, Track};

/// A slider's settings.
pub(super) fn read(
    fields: &mut Fields<'_>,
    at: Option<Thresholds>,
    base: Option<&SliderSpec>,
) -> Option<SliderSpec> {
    let track = track(fields, base.map_or(Track::EAST, |base| base.track));
    let known = base.map(|base| base.mapping).unwrap_or_default();
    let mapping = fields.read("mapping", Some(known), |node| mapping(node, known));
    let scale = scale::read(fields, base.map(|base| base.scale));
    let initial = scale::initial(fields, scale, base.map(|base| base.initial));
    Some(SliderSpec { thresholds: at?, track: track?, mapping: mapping?, scale: scale?, initial: initial? })
}

/// The field `axis`.
pub(super) fn axis(fields: &mut Fields<'_>, base: Option<Axis>) -> Option<Axis> {
    fields.read("axis", Some(base.unwrap_or_default()), |node| {
        node.choice(&[("East", Axis::East), ("North", Axis::North)])
    })
}

/// A track is written in one of three ways.
fn track(fields: &mut Fields<'_>, base: Track) -> Option<Track> {
    let straight = fields
        .read("axis", Some(base), |node| node.choice(&[("East", Track::EAST), ("North", Track::NORTH)]));
    let turned = fields.read("angle_deg", Some(base), |node| {
        single(node, -360.0..=360.0).map(|degrees| Track::Line { degrees })
    });
    let round = fields.read("arc_deg", Some(base), arc);
    let written =
        ["axis", "angle_deg", "arc_deg"].map(|name| fields.written_span(name).map(|span| (name, span)));
    if let [Some((first, _)), Some((second, span)), ..] =
        written.iter().flatten().map(Some).chain([None; 2]).collect::<Vec<_>>()[..]
    {
        let problem = Problem::error(span.clone(), format!("`{second}` contradicts `{first}`"));
        fields.report(problem.expected("a slider has one track"));
    }
    let (straight, turned, round) = (straight?, turned?, round?);
    Some(match written {
        [_, _, Some(_)] => round,
        [_, Some(_), _] => turned,
        _ => straight,
    })
}

fn arc(node: Node<'_>) -> Option<Track> {
    let [from, to] = node.tuple("(from, to)")?;
    let (from, to) = (single(from, -360.0..=360.0), single(to, -360.0..=360.0));
    let (from_degrees, to_degrees) = (from?, to?);
    if !(20.0..=340.0).contains(&(to_degrees - from_degrees).abs()) {
        let problem = Problem::error(node.span(), "an arc is 20 to 340 degrees long");
        let help = "angles count from east, counter-clockwise: (180, 0) is a half circle from west over north to east";
        node.report(problem.expected("from where to where, in degrees").help(help));
        return None;
    }
    Some(Track::Arc { from_degrees, to_degrees })
}

fn mapping(node: Node<'_>, base: Mapping) -> Option<Mapping> {
    match variant::read(node, &["Absolute", "Relative", "Rate"])? {
        ("Relative", fields) => {
            let known = match base {
                Mapping::Relative { gain } => gain,
                _ => 1.0,
            };
            let Some(mut fields) = fields else { return Some(Mapping::Relative { gain: known }) };
            let gain = fields.read("gain", Some(known), |node| single(node, 0.01..=10.0));
            fields.finish();
            Some(Mapping::Relative { gain: gain? })
        }
        ("Rate", fields) => {
            let Some(mut fields) = fields else {
                let problem = Problem::error(node.span(), "Rate needs a speed");
                let help = "write Rate(full_per_s: 0.5), the change per second at full deflection";
                node.report(problem.expected("`full_per_s` is missing").help(help));
                return None;
            };
            let known = match base {
                Mapping::Rate { full_per_s } => Some(full_per_s),
                _ => None,
            };
            let full = fields.read("full_per_s", known, |node| single(node, 1e-6..=1e6));
            fields.finish();
            Some(Mapping::Rate { full_per_s: full? })
        }
        (_, fields) => {
            if let Some(fields) = fields {
                fields.finish();
            }
            Some(Mapping::Absolute)
        }
    }
}
