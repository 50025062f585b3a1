//! Curves: levels and pitches over time.

use arrayvec::ArrayVec;

use super::super::behaviour::single;
use super::super::node::Node;
use super::super::problem::Problem;
use super::{millis, within};
use crate::feel::{Band, CurvePoint, MAX_POINTS, TonePoint};

/// Most that a curve may strengthen.
const MOST: f64 = 4.0;

/// Level and pitch of a tone that is of `hz` where a point says nothing.
pub(super) fn tone(node: Node<'_>, hz: Option<f32>, band: Band) -> Option<ArrayVec<TonePoint, MAX_POINTS>> {
    let points: Vec<Option<TonePoint>> = node
        .list("point", MAX_POINTS)?
        .into_iter()
        .map(|node| {
            let mut fields = node.fields("Point")?;
            let at = millis(&mut fields, "at_ms", None, 0.0..=60_000.0);
            let level = fields.read("level", Some(1.0), |node| single(node, 0.0..=MOST));
            // A tone without a pitch is reported there, not here.
            let hz = fields.read("hz", Some(hz.unwrap_or(band.low_hz)), |node| within(node, band));
            fields.finish();
            Some(TonePoint { at_s: at?, level: level?, hz: hz? })
        })
        .collect();
    let points: ArrayVec<TonePoint, MAX_POINTS> = points.into_iter().collect::<Option<_>>()?;
    in_order(node, points.iter().map(|point| point.at_s)).then_some(points)
}

/// Shares of a level.
pub(super) fn level(node: Node<'_>) -> Option<ArrayVec<CurvePoint, MAX_POINTS>> {
    let points: Vec<Option<CurvePoint>> = node
        .list("point", MAX_POINTS)?
        .into_iter()
        .map(|node| {
            let mut fields = node.fields("Point")?;
            let at = millis(&mut fields, "at_ms", None, 0.0..=60_000.0);
            let level = fields.read("level", None, |node| single(node, 0.0..=MOST));
            fields.finish();
            Some(CurvePoint { at_s: at?, level: level? })
        })
        .collect();
    let points: ArrayVec<CurvePoint, MAX_POINTS> = points.into_iter().collect::<Option<_>>()?;
    in_order(node, points.iter().map(|point| point.at_s)).then_some(points)
}

fn in_order(node: Node<'_>, times: impl Iterator<Item = f32> + Clone) -> bool {
    let rises = times.clone().zip(times.skip(1)).all(|(a, b)| a < b);
    if !rises {
        let problem = Problem::error(node.span(), "a curve's points go forwards in time");
        node.report(problem.expected("each `at_ms` must be later than the one before"));
    }
    rises
}
