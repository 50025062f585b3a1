//! Parameters of an AHAP pattern that change over time.

use super::file::{DynamicParameter, ParameterCurve};

/// What controls one quality of all events over time.
#[derive(Debug)]
pub(super) struct Control {
    /// In order of their beginning: each holds until the next one begins.
    pieces: Vec<Piece>,
    neutral: f32,
}

/// A curve, or a value from a moment on (a curve of one point).
#[derive(Debug)]
struct Piece {
    begin: f32,
    /// Times from the pattern's start, and values.
    points: Vec<(f32, f32)>,
}

impl Control {
    /// All curves and parameters of this `id`, their values brought to `range`.
    pub(super) fn of(
        id: &str,
        neutral: f32,
        range: (f32, f32),
        curves: &[ParameterCurve],
        parameters: &[DynamicParameter],
    ) -> Self {
        let tame = |value: f64| (value as f32).clamp(range.0, range.1);
        let curves = curves.iter().filter(|curve| curve.id == id && !curve.points.is_empty()).map(|curve| {
            let mut points: Vec<(f32, f32)> = curve
                .points
                .iter()
                .map(|point| ((curve.time + point.time) as f32, tame(point.parameter_value)))
                .collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            Piece { begin: points[0].0, points }
        });
        let parameters = parameters.iter().filter(|parameter| parameter.id == id).map(|parameter| {
            let time = parameter.time as f32;
            Piece { begin: time, points: vec![(time, tame(parameter.value))] }
        });
        let mut pieces: Vec<Piece> = curves.chain(parameters).collect();
        pieces.sort_by(|a, b| a.begin.total_cmp(&b.begin));
        Self { pieces, neutral }
    }

    /// The value at `t`; at a jump the later one.
    pub(super) fn at(&self, t: f32) -> f32 {
        self.of_piece(self.pieces.iter().rev().find(|piece| piece.begin <= t), t)
    }

    /// The value at `t`; at a jump the earlier one.
    pub(super) fn until(&self, t: f32) -> f32 {
        self.of_piece(self.pieces.iter().rev().find(|piece| piece.begin < t - SAME_S), t)
    }

    fn of_piece(&self, piece: Option<&Piece>, t: f32) -> f32 {
        let Some(piece) = piece else { return self.neutral };
        let after = piece.points.iter().position(|point| point.0 > t).unwrap_or(piece.points.len());
        let before = after.saturating_sub(1);
        match (piece.points.get(before), piece.points.get(after)) {
            (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (t - a.0) / (b.0 - a.0),
            (Some(point), None) | (None, Some(point)) => point.1,
            (None, None) => self.neutral,
        }
    }

    /// The moments between `from` and `to` at which it bends or jumps; of a jump also the moment just before.
    pub(super) fn bends(&self, from: f32, to: f32) -> impl Iterator<Item = f32> + '_ {
        self.pieces
            .iter()
            .filter(move |piece| piece.begin < to - SAME_S)
            .flat_map(|piece| {
                let jump = (self.at(piece.begin) - self.at(piece.begin - JUMP_S)).abs() > 1e-4;
                let before = jump.then_some(piece.begin - JUMP_S);
                before.into_iter().chain(piece.points.iter().map(|point| point.0))
            })
            .filter(move |t| *t > from + SAME_S && *t < to - SAME_S)
    }
}

/// Moments closer together than this are the same one, in seconds.
pub(super) const SAME_S: f32 = 1e-4;

/// How steep a jump is that a curve stands for, in seconds.
pub(super) const JUMP_S: f32 = 0.001;
