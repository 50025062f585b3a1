//! Parameters of an AHAP pattern that change over time.

use super::file::{DynamicParameter, ParameterCurve};

/// Course of one control over time, for all events: straight lines between points in order of time.
#[derive(Clone, Debug)]
pub(super) struct ControlCurve {
    points: Vec<Point>,
    /// Value before the first point.
    neutral: f32,
    /// Maximum difference from the pattern's own course.
    tolerance: f32,
    /// Number of values that were clamped to the range.
    limited: usize,
}

/// Value at one moment.
#[derive(Clone, Copy, Debug)]
struct Point {
    t: f32,
    value: f32,
    /// Whether the value jumps here from the value of the previous point.
    jumps: bool,
}

/// A curve, or a constant from some time on (a curve of one point); it applies until the next piece begins.
struct Piece {
    begin: f32,
    points: Vec<(f32, f32)>,
}

/// Times closer together than this are equal, in seconds.
pub(super) const SAME_S: f32 = 1e-4;

/// Duration of a jump in a curve, in seconds.
pub(super) const JUMP_S: f32 = 0.001;

/// Maximum number of points that one straight line replaces. It limits the computing time; a thinned course keeps its
/// tolerance with any limit.
const LONGEST_LINE: usize = 256;

impl ControlCurve {
    /// Reads all curves and parameters of this `id`, with values clamped to `range`.
    pub(super) fn of(
        id: &str,
        neutral: f32,
        range: (f32, f32),
        curves: &[ParameterCurve],
        parameters: &[DynamicParameter],
    ) -> Self {
        let mut limited = 0;
        let mut in_range = |value: f64| {
            let value = value as f32;
            let within = if value.is_nan() { neutral } else { value.clamp(range.0, range.1) };
            limited += usize::from(within != value);
            within
        };
        let mut pieces = Vec::new();
        for curve in curves.iter().filter(|curve| curve.id == id) {
            let point = |point: &super::file::ControlPoint| {
                ((curve.time + point.time) as f32, in_range(point.parameter_value))
            };
            let mut points: Vec<(f32, f32)> = curve.points.iter().map(point).collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            pieces.extend(points.first().copied().map(|first| Piece { begin: first.0, points }));
        }
        for parameter in parameters.iter().filter(|parameter| parameter.id == id) {
            let begin = parameter.time as f32;
            pieces.push(Piece { begin, points: vec![(begin, in_range(parameter.value))] });
        }
        pieces.sort_by(|a, b| a.begin.total_cmp(&b.begin));
        Self { points: joined(&pieces, neutral), neutral, tolerance: 0.0, limited }
    }

    /// Returns the number of values that were clamped to the range.
    pub(super) const fn limited(&self) -> usize {
        self.limited
    }

    /// Returns the maximum difference from the pattern's own course, in the control's own unit.
    pub(super) const fn tolerance(&self) -> f32 {
        self.tolerance
    }

    /// Returns the value at `t`; at a jump the later one.
    pub(super) fn at(&self, t: f32) -> f32 {
        value_at(&self.points, self.points.partition_point(|point| point.t <= t), t, self.neutral)
    }

    /// Returns the value at `t`; at a jump the earlier one, the end of the line before the jump.
    pub(super) fn until(&self, t: f32) -> f32 {
        let first = self.points.partition_point(|point| point.t < t - SAME_S);
        let mut near =
            self.points.iter().enumerate().skip(first).take_while(|(_, point)| point.t <= t + SAME_S);
        let Some((jump, _)) = near.find(|(_, point)| point.jumps) else { return self.at(t) };
        let before = |back: usize| jump.checked_sub(back).and_then(|before| self.points.get(before));
        match (before(2), before(1)) {
            (Some(a), Some(b)) if !b.jumps => {
                b.value + (b.value - a.value) * (t - b.t) / (b.t - a.t).max(JUMP_S)
            }
            (_, Some(b)) => b.value,
            (_, None) => self.neutral,
        }
    }

    /// Returns the times between `from` and the last millisecond before `to` at which the course bends or jumps; for a
    /// jump also the time just before.
    pub(super) fn bends(&self, from: f32, to: f32) -> impl Iterator<Item = f32> + '_ {
        let begin = self.points.partition_point(|point| point.t <= from + SAME_S);
        let rest = self.points.get(begin..).unwrap_or_default();
        // A bend in the last millisecond is part of a jump at the end.
        rest.iter().map(|point| point.t).take_while(move |t| *t < to - JUMP_S - SAME_S)
    }

    /// Returns the course with as few points as keep it within `tolerance`.
    pub(super) fn thinned(&self, tolerance: f32) -> Self {
        let mut points = Vec::new();
        let mut anchor = self.points.first().copied();
        points.extend(anchor);
        let mut index = 0;
        while let Some(from) = anchor {
            let next = index + reach(from, self.points.get(index + 1..).unwrap_or_default(), tolerance);
            anchor = self.points.get(next).copied().filter(|_| next > index);
            points.extend(anchor.map(|point| Point { jumps: point.jumps && next == index + 1, ..point }));
            index = next;
        }
        Self { points, tolerance, ..*self }
    }
}

/// Returns the number of points in `rest` that one straight line from `from` to the last of them replaces.
fn reach(from: Point, rest: &[Point], tolerance: f32) -> usize {
    // Slopes for which the line stays within the tolerance of all points so far.
    let (mut least, mut most, mut reached) =
        (f32::NEG_INFINITY, f32::INFINITY, usize::from(!rest.is_empty()));
    for (index, point) in rest.iter().take(LONGEST_LINE).enumerate() {
        let (dt, rise) = ((point.t - from.t).max(1e-6), point.value - from.value);
        if (least..=most).contains(&(rise / dt)) {
            reached = index + 1;
        }
        least = least.max((rise - tolerance) / dt);
        most = most.min((rise + tolerance) / dt);
        if least > most {
            break;
        }
    }
    reached
}

/// Joins all pieces into one course.
fn joined(pieces: &[Piece], neutral: f32) -> Vec<Point> {
    let mut points: Vec<Point> = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        let end = pieces.get(index + 1).map_or(f32::INFINITY, |next| next.begin);
        let Some(&(_, first)) = piece.points.first().filter(|_| end > piece.begin) else { continue };
        let before = value_at(&points, points.len(), piece.begin, neutral);
        let jumps = (first - before).abs() > SAME_S;
        let last = points.last().map_or(f32::NEG_INFINITY, |point| point.t);
        if jumps && piece.begin - JUMP_S > last {
            points.push(Point { t: piece.begin - JUMP_S, value: before, jumps: false });
        }
        points.push(Point { t: piece.begin, value: first, jumps });
        for (pair, &(t, value)) in piece.points.windows(2).zip(piece.points.iter().skip(1)) {
            if t < end {
                points.push(Point { t, value, jumps: false });
                continue;
            }
            // The next piece begins before the end of this line.
            if let [a, b] = pair {
                let t = end - JUMP_S;
                let value = a.1 + (b.1 - a.1) * (t - a.0) / (b.0 - a.0).max(1e-6);
                points.extend((t > a.0).then_some(Point { t, value, jumps: false }));
            }
            break;
        }
    }
    points
}

/// Returns the value at `t`, where the points from index `after` on lie later.
fn value_at(points: &[Point], after: usize, t: f32, neutral: f32) -> f32 {
    let before = after.checked_sub(1).and_then(|before| points.get(before));
    match (before, points.get(after)) {
        (Some(a), Some(b)) => a.value + (b.value - a.value) * (t - a.t) / (b.t - a.t).max(1e-9),
        (Some(point), None) => point.value,
        (None, _) => neutral,
    }
}
