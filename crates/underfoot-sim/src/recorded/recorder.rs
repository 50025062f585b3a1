//! Feet of each millisecond to points: each line goes on while one straight piece keeps to all feet of it.

use super::{
    END_MS, FORCE, FootLine, FootPoint, METRES, MILLIMETRES, MOST_FEET, MOST_LINES, MOST_MS, MOST_POINTS,
    NEWTONS, RADIANS, ROLL, RecordedFeet, VALUES,
};
use crate::foot::Foot;
use crate::track::turn_between;
use underfoot::units::Instant;

/// Deviation of a piece from a foot on the floor, in the units of a point: a third of a millimetre moves a slider by
/// less than a thousandth.
const ON_FLOOR: [f32; VALUES] = [3.0, 3.0, 4.0, 5.0, 4.0];

/// Deviation from a foot in the air, which touches nothing.
const IN_AIR: [f32; VALUES] = [100.0, 100.0, 100.0, 5.0, 100.0];

/// Deviation of the force as a share of it, in addition.
const FORCE_SHARE: f32 = 0.005;

/// Maximum distance of a foot from a millisecond to the next on the floor (0.1 mm): a farther one is another foot.
const FAR: f32 = 500.0;

/// Records feet, millisecond by millisecond.
#[derive(Clone, Debug, Default)]
pub struct FeetRecorder {
    /// The moment of the first call of [`FeetRecorder::note`].
    since: Option<Instant>,
    length_ms: u32,
    points: usize,
    /// The lines that have ended.
    done: Vec<FootLine>,
    open: Vec<OpenLine>,
    is_full: bool,
}

impl FeetRecorder {
    /// Records the feet at the moment `at`; the first call is the beginning. Call it once a millisecond. Returns false
    /// once the recorder is full: after ten minutes, 60,000 points, 4,000 lines or with more than 64 feet.
    pub fn note(&mut self, at: Instant, feet: &[Foot]) -> bool {
        let since = *self.since.get_or_insert(at);
        let ms = u32::try_from(at.since(since).as_millis()).unwrap_or(u32::MAX);
        let lines = self.done.len() + self.open.len();
        self.is_full |= ms >= MOST_MS - END_MS
            || self.points + 2 * feet.len() > MOST_POINTS
            || lines + feet.len() > MOST_LINES
            || feet.len() > MOST_FEET;
        if self.is_full {
            return false;
        }
        self.length_ms = ms;
        let mut before = std::mem::take(&mut self.open);
        for foot in feet.iter().filter(|foot| is_finite(foot)) {
            let line = match before.iter().position(|line| line.is_of(foot)) {
                Some(index) => {
                    let mut line = before.swap_remove(index);
                    self.points += line.add(ms, foot);
                    line
                }
                None => OpenLine::new(ms, foot),
            };
            self.open.push(line);
        }
        // The foot of a line that is left has gone.
        for line in before {
            self.end(line);
        }
        true
    }

    /// Whether nothing more is recorded.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.is_full
    }

    /// Number of milliseconds so far.
    #[must_use]
    pub fn length_ms(&self) -> u32 {
        self.length_ms
    }

    /// Number of points so far; one takes about four bytes of a link.
    #[must_use]
    pub fn points(&self) -> usize {
        self.points
    }

    /// The feet so far, and a second of empty floor after them.
    #[must_use]
    pub fn finish(mut self) -> RecordedFeet {
        for line in std::mem::take(&mut self.open) {
            self.end(line);
        }
        let mut lines = self.done;
        lines.sort_by_key(FootLine::first_ms);
        RecordedFeet { length_ms: self.length_ms + END_MS, lines }
    }

    fn end(&mut self, line: OpenLine) {
        self.points += 2;
        self.done.push(line.closed());
    }
}

fn is_finite(foot: &Foot) -> bool {
    foot.position.is_finite()
        && [foot.heading, foot.length_m, foot.force.0, foot.roll].iter().all(|number| number.is_finite())
}

/// A line whose foot is still there.
#[derive(Clone, Debug)]
struct OpenLine {
    line: FootLine,
    /// The last point of the line, from which the present piece begins.
    from: FootPoint,
    /// The foot of the last millisecond.
    last: FootPoint,
    /// Lowest and highest slope of each value that keep to all feet of the piece, per millisecond.
    slopes: [(f32, f32); VALUES],
}

impl OpenLine {
    fn new(ms: u32, foot: &Foot) -> Self {
        let point = FootPoint { ms, values: whole(measured(foot, 0)) };
        let line = FootLine { left: foot.left, length_mm: length_mm(foot), points: vec![point] };
        Self { line, from: point, last: point, slopes: [(f32::MIN, f32::MAX); VALUES] }
    }

    /// Whether `foot` may be the foot of this line one millisecond later.
    fn is_of(&self, foot: &Foot) -> bool {
        let here = measured(foot, 0);
        let is_near = self.last.values.iter().zip(here).take(2).all(|(old, new)| {
            let old = *old as f32;
            (old - new).abs() < FAR
        });
        self.line.left == foot.left && self.line.length_mm == length_mm(foot) && is_near
    }

    /// Adds the foot at the millisecond after the last one; returns the number of new points.
    fn add(&mut self, ms: u32, foot: &Foot) -> usize {
        let values = measured(foot, self.last.values[2]);
        let to = FootPoint { ms, values: whole(values) };
        let mut added = 0;
        if !self.keeps(to) {
            self.line.points.push(self.last);
            (self.from, self.slopes) = (self.last, [(f32::MIN, f32::MAX); VALUES]);
            added = 1;
        }
        let elapsed = (ms - self.from.ms).max(1) as f32;
        let is_down = values[FORCE] > 0.0;
        for (index, slope) in self.slopes.iter_mut().enumerate() {
            let mut allowed = if is_down { ON_FLOOR[index] } else { IN_AIR[index] };
            if index == FORCE {
                allowed += FORCE_SHARE * values[FORCE].abs();
            }
            let way = values[index] - self.from.values[index] as f32;
            slope.0 = slope.0.max((way - allowed) / elapsed);
            slope.1 = slope.1.min((way + allowed) / elapsed);
        }
        self.last = to;
        added
    }

    /// Whether a straight piece to `to` keeps to all feet so far.
    fn keeps(&self, to: FootPoint) -> bool {
        let elapsed = (to.ms - self.from.ms).max(1) as f32;
        (0..VALUES).all(|index| {
            let slope = (to.values[index] - self.from.values[index]) as f32 / elapsed;
            let (low, high) = self.slopes[index];
            (low..=high).contains(&slope)
        })
    }

    fn closed(mut self) -> FootLine {
        if self.last.ms > self.from.ms {
            self.line.points.push(self.last);
        }
        self.line
    }
}

/// The foot in the units of a point; its heading is the one that is nearest to `heading` (mrad) and the same direction.
fn measured(foot: &Foot, heading: i32) -> [f32; VALUES] {
    let before = heading as f32 * RADIANS as f32;
    let heading = before + turn_between(before, foot.heading);
    let unit = |value: f32, unit: f64| (f64::from(value) / unit) as f32;
    [
        unit(foot.position.x, METRES),
        unit(foot.position.y, METRES),
        unit(heading, RADIANS),
        unit(foot.force.0.max(0.0), NEWTONS),
        unit(foot.roll.clamp(0.0, 1.0), ROLL),
    ]
}

/// The nearest whole units; the casts saturate.
fn whole(values: [f32; VALUES]) -> [i32; VALUES] {
    values.map(|value| value.round() as i32)
}

fn length_mm(foot: &Foot) -> u16 {
    (f64::from(foot.length_m) / MILLIMETRES).round() as u16
}
