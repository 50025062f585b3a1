//! Continuous events as tones: their control curves are kept, simplified, or split among several tones.

use arrayvec::ArrayVec;

use super::CONTINUOUS_N;
use super::control::{ControlCurve, SAME_S};
use super::import::{Controls, Parameters, SHORTEST_S, pitch_hz};
use super::warnings::ImportNotes;
use crate::feel::{MAX_PARTS, MAX_POINTS, Part, PartKind, Tone, TonePoint};
use crate::units::Newtons;

/// Tolerances tried in this order, as shares of full intensity and full sharpness; the maximum is our choice.
const TOLERANCES: [f32; 4] = [0.005, 0.01, 0.02, 0.05];

/// Duration of the crossfade between two tones of a split event, in seconds: long enough that no click is felt.
const SEAM_S: f32 = 0.01;

/// Number of straight lines for an attack, a decay or a release under a curve.
const ENVELOPE_LINES: usize = 8;

/// The controls, and simplified ones that are computed when a curve first needs them.
pub(super) struct Course<'c> {
    exact: &'c Controls,
    thinned: [Option<Controls>; TOLERANCES.len()],
}

impl<'c> Course<'c> {
    pub(super) fn new(exact: &'c Controls) -> Self {
        Self { exact, thinned: Default::default() }
    }

    fn thinned(&mut self, level: usize) -> &Controls {
        let Some((place, tolerance)) = self.thinned.get_mut(level).zip(TOLERANCES.get(level)) else {
            return self.exact;
        };
        place.get_or_insert_with(|| Controls {
            intensity: self.exact.intensity.thinned(*tolerance),
            sharpness: self.exact.sharpness.thinned(*tolerance),
        })
    }
}

/// Makes the tones of a continuous event that begins at `at_s` and lasts `length_s`: one, or several if its control
/// curves have too many points for one.
pub(super) fn tones(
    at_s: f32,
    length_s: f32,
    parameters: &Parameters,
    course: &mut Course<'_>,
    warnings: &mut ImportNotes,
) -> Vec<Part> {
    let event = Span { at_s, length_s, parameters };
    let exact = event.times(course.exact);
    if exact.len() <= MAX_POINTS {
        return vec![Part { at_s, kind: PartKind::Tone(event.tone(course.exact, &exact)) }];
    }
    for level in 0..TOLERANCES.len() {
        let controls = course.thinned(level);
        let times = event.times(controls);
        if times.len() <= MAX_POINTS {
            let tolerance = controls.intensity.tolerance();
            warnings.note(format!(
                "a control curve with more than {MAX_POINTS} points: simplified, within {} % of it",
                100.0 * tolerance
            ));
            return vec![Part { at_s, kind: PartKind::Tone(event.tone(controls, &times)) }];
        }
    }
    let controls = course.thinned(TOLERANCES.len() - 1);
    let parts = event.split(controls);
    warnings.note(format!(
        "a control curve with more than {MAX_POINTS} points: split among {} tones, within {} % of it",
        parts.len(),
        100.0 * controls.intensity.tolerance()
    ));
    parts
}

/// One continuous event.
struct Span<'p> {
    at_s: f32,
    length_s: f32,
    parameters: &'p Parameters,
}

impl Span<'_> {
    /// Returns the time in the pattern at which the event ends, its release included.
    fn end_s(&self) -> f32 {
        self.at_s + self.length_s + self.parameters.release_s
    }

    /// Returns the times of the points of its curve; none if the controls are constant.
    fn times(&self, controls: &Controls) -> Vec<f32> {
        let (from, to) = (self.at_s, self.end_s());
        let mut times: Vec<f32> =
            controls.intensity.bends(from, to).chain(controls.sharpness.bends(from, to)).collect();
        let differs = |control: &ControlCurve| (control.at(from) - control.until(to)).abs() > 1e-4;
        if times.is_empty() && !differs(&controls.intensity) && !differs(&controls.sharpness) {
            return times;
        }
        times.extend([from, to]);
        times.sort_by(f32::total_cmp);
        times.dedup_by(|later, earlier| *later - *earlier < SAME_S);
        times
    }

    /// Returns intensity and pitch at `t`; at the end of the event, a control that begins there does not count.
    fn at(&self, controls: &Controls, t: f32) -> (f32, f32) {
        let is_end = t >= self.end_s() - SAME_S;
        let of = |control: &ControlCurve| if is_end { control.until(t) } else { control.at(t) };
        (of(&controls.intensity), pitch_hz(self.parameters.sharpness + of(&controls.sharpness)))
    }

    /// Makes one tone of the whole event, with the points `times` in its curve.
    fn tone(&self, controls: &Controls, times: &[f32]) -> Tone {
        let curve: ArrayVec<TonePoint, MAX_POINTS> = times
            .iter()
            .take(MAX_POINTS)
            .map(|&t| {
                let (level, hz) = self.at(controls, t);
                TonePoint { at_s: t - self.at_s, level, hz: Some(hz) }
            })
            .collect();
        // Without points, the controls are constant.
        let (steady, hz) = if curve.is_empty() {
            self.at(controls, self.at_s)
        } else {
            (1.0, pitch_hz(self.parameters.sharpness))
        };
        let Parameters { intensity, attack_s, release_s, sustained, .. } = *self.parameters;
        Tone {
            level: Newtons(CONTINUOUS_N * intensity * steady),
            hz,
            noise: 0.0,
            length_s: self.length_s,
            attack_s,
            decay_s: self.decay_s(),
            sustain: if sustained { 1.0 } else { 0.0 },
            release_s,
            curve,
        }
    }

    /// Returns the decay; a tone that is not sustained decays over its duration if no decay is given.
    fn decay_s(&self) -> f32 {
        let Parameters { decay_s, sustained, .. } = *self.parameters;
        if sustained || decay_s > 0.0 { decay_s } else { self.length_s }
    }

    /// Splits the event into several consecutive tones with its envelope in their curves.
    fn split(&self, controls: &Controls) -> Vec<Part> {
        let envelope = Tone { curve: ArrayVec::new(), ..self.tone(controls, &[]) };
        let mut times = self.times(controls);
        let phases = [
            (0.0, envelope.attack_s),
            (envelope.attack_s, envelope.decay_s),
            (envelope.length_s, envelope.release_s),
        ];
        for (begin, length) in phases {
            let line = |n: usize| self.at_s + begin + length * n as f32 / ENVELOPE_LINES as f32;
            times.extend((0..=ENVELOPE_LINES).map(line).filter(|_| length > 0.0));
        }
        let end = self.end_s();
        times.retain(|t| (self.at_s..=end).contains(t));
        times.sort_by(f32::total_cmp);
        times.dedup_by(|later, earlier| *later - *earlier < SAME_S);
        let point = |t: f32, from: f32| {
            let (level, hz) = self.at(controls, t);
            TonePoint { at_s: t - from, level: level * envelope.at(t - self.at_s).0, hz: Some(hz) }
        };
        let level = Newtons(CONTINUOUS_N * self.parameters.intensity);
        let (mut parts, mut rest) = (Vec::new(), times.as_slice());
        // One part beyond the maximum shows the caller that there are too many.
        while rest.len() > 1
            && parts.len() <= MAX_PARTS
            && let Some((&from, _)) = rest.split_first()
        {
            let (own, next) = rest.split_at(rest.len().min(MAX_POINTS));
            let to = own.last().copied().unwrap_or(from);
            let is_last = next.is_empty();
            let tone = Tone {
                level,
                hz: pitch_hz(self.parameters.sharpness),
                noise: 0.0,
                length_s: (to - from).max(SHORTEST_S),
                attack_s: if parts.is_empty() { 0.0 } else { SEAM_S },
                decay_s: 0.0,
                sustain: 1.0,
                release_s: if is_last { 0.0 } else { SEAM_S },
                curve: own.iter().map(|&t| point(t, from)).collect(),
            };
            parts.push(Part { at_s: from, kind: PartKind::Tone(tone) });
            // Both tones contain the point at the seam.
            rest = rest.get(own.len() - 1..).unwrap_or_default();
        }
        parts
    }
}
