//! The track of a slider.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::Vec2;

use underfoot_format::describe::{FieldDescription, FieldType};
use underfoot_format::fields::Fields;
use underfoot_format::node::Node;
use underfoot_format::problem::Problem;
use underfoot_format::text::{Entry, RonText};
use underfoot_format::{Codec, Num, Pair, num};

/// The track of a slider, through the middle of its area.
///
/// Angles count in degrees from east, counter-clockwise: 90 is north.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SliderTrack {
    /// Straight from edge to edge; the value grows in this direction.
    Line {
        /// Direction in which the value grows.
        degrees: f32,
    },
    /// Part of a circle, as large as fits the area with room for a foot around it.
    Arc {
        /// Angle of its start, from its centre.
        from_degrees: f32,
        /// Angle of its end; less than `from_degrees` if the value grows clockwise, at most 360 degrees away.
        to_degrees: f32,
    },
}

/// A track in files: `axis`, `angle_deg` or `arc_deg`.
pub(super) struct TrackFields;

/// Angles, in degrees from east, counter-clockwise.
const ANGLE: Num = num(-360.0..=360.0);

const ARC: Pair = Pair { each: ANGLE, pattern: "(from, to)", parts: ["from", "to"] };

const FIELDS: [(&str, &str); 3] = [
    ("axis", "Straight from edge to edge: the value grows eastwards or northwards."),
    (
        "angle_deg",
        "Straight, in any direction: the angle in which the value grows, counter-clockwise from east.",
    ),
    ("arc_deg", "Part of a circle: where it begins and ends, counter-clockwise from east."),
];

impl Codec<SliderTrack> for TrackFields {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&SliderTrack>, context: &()) -> Option<SliderTrack> {
        match node.name {
            "angle_deg" => ANGLE.read(node, None, context).map(|degrees| SliderTrack::Line { degrees }),
            "arc_deg" => {
                let [from_degrees, to_degrees]: [f32; 2] = ARC.read(node, None, context)?;
                if (20.0..=340.0).contains(&(to_degrees - from_degrees).abs()) {
                    return Some(SliderTrack::Arc { from_degrees, to_degrees });
                }
                let problem = Problem::error(node.span(), "an arc is 20 to 340 degrees long");
                let help = "angles count from east, counter-clockwise: \
                    (180, 0) is a half circle from west over north to east";
                node.report(problem.expected("from where to where, in degrees").help(help));
                None
            }
            _ => node.choice(&[("East", SliderTrack::EAST), ("North", SliderTrack::NORTH)]),
        }
    }

    fn write(&self, track: &SliderTrack) -> RonText {
        match track {
            SliderTrack::Line { degrees } => ANGLE.write(degrees),
            SliderTrack::Arc { from_degrees, to_degrees } => ARC.write(&[*from_degrees, *to_degrees]),
        }
    }

    fn shape(&self) -> FieldType {
        FieldType::Names(vec!["East", "North"])
    }

    fn stand_in(&self) -> SliderTrack {
        SliderTrack::EAST
    }

    fn read_field(
        &self,
        fields: &mut Fields<'_>,
        _: &'static str,
        base: Option<&SliderTrack>,
        default: Option<SliderTrack>,
        context: &(),
    ) -> SliderTrack {
        let mut written: Vec<(Node<'_>, Option<SliderTrack>)> = Vec::new();
        for (name, _) in FIELDS {
            let Some(node) = fields.take(name) else { continue };
            let track = self.read(node, None, context);
            if track.is_none() {
                fields.fail(name);
            }
            written.push((node, track));
        }
        if let [(first, _), (second, _), ..] = written.as_slice() {
            let message = format!("`{}` contradicts `{}`", second.name, first.name);
            fields.report(Problem::error(second.span(), message).expected("a slider has one track"));
        }
        let known = || base.copied().or(default).unwrap_or(SliderTrack::EAST);
        written.pop().and_then(|(_, track)| track).unwrap_or_else(known)
    }

    fn write_field(
        &self,
        track: &SliderTrack,
        _: &'static str,
        _: Option<SliderTrack>,
        entries: &mut Vec<Entry>,
    ) {
        let name = match track {
            SliderTrack::Line { .. } => "angle_deg",
            SliderTrack::Arc { .. } => "arc_deg",
        };
        entries.push((name, self.write(track)));
    }

    fn describe_field(
        &self,
        _: &'static str,
        _: &[&str],
        _: Option<SliderTrack>,
        fields: &mut Vec<FieldDescription>,
    ) {
        let shapes =
            [Codec::<SliderTrack>::shape(self), Codec::<f32>::shape(&ANGLE), Codec::<[f32; 2]>::shape(&ARC)];
        let defaults = ["East", "none", "none"].map(|default| Some(default.to_owned()));
        for (((name, about), shape), default) in FIELDS.into_iter().zip(shapes).zip(defaults) {
            fields.push(FieldDescription { name, about: about.to_owned(), shape, default });
        }
    }
}

/// Share of an arc's radius within which the angle of a place is undefined.
const HUB: f32 = 0.25;

/// Part of an area's smaller side that stays free around an arc.
const AROUND: f32 = 0.18;

impl SliderTrack {
    /// Eastwards.
    pub const EAST: Self = Self::Line { degrees: 0.0 };

    /// Northwards.
    pub const NORTH: Self = Self::Line { degrees: 90.0 };

    /// Position of a `place` along the track (0 to 1, on a line also beyond).
    ///
    /// `place` is 0 to 1 across a control of `size` metres. `None` for a place too near an arc's centre, or one that
    /// is not finite.
    #[must_use]
    pub fn share_at(&self, place: Vec2, size: Vec2) -> Option<f32> {
        let offset = (place - 0.5) * size;
        if !offset.is_finite() {
            return None;
        }
        match *self {
            Self::Line { degrees } => {
                let along = direction(degrees);
                Some(0.5 + offset.dot(along) / chord(along, size))
            }
            Self::Arc { from_degrees, to_degrees } => {
                let (centre, radius) = circle(from_degrees, to_degrees, size);
                let spoke = offset - centre;
                if spoke.length() < HUB * radius {
                    return None;
                }
                let sweep = (to_degrees - from_degrees).to_radians();
                // From the arc's middle, so that a place beyond either end is nearer to that end.
                let middle = from_degrees.to_radians() + 0.5 * sweep;
                let off = wrapped(spoke.to_angle() - middle);
                Some((0.5 + off / sweep).clamp(0.0, 1.0))
            }
        }
    }

    /// The place (0 to 1 across a control of `size` metres) at the position `share` along the track.
    #[must_use]
    pub fn place_at(&self, share: f32, size: Vec2) -> Vec2 {
        let offset = match *self {
            Self::Line { degrees } => {
                let along = direction(degrees);
                along * chord(along, size) * (share - 0.5)
            }
            Self::Arc { from_degrees, to_degrees } => {
                let (centre, radius) = circle(from_degrees, to_degrees, size);
                centre + radius * direction(from_degrees + (to_degrees - from_degrees) * share)
            }
        };
        0.5 + offset / size
    }

    /// Centre (from the area's middle) and radius of an arc in an area of `size`, in metres; `None` for a line.
    #[must_use]
    pub fn circle(&self, size: Vec2) -> Option<(Vec2, f32)> {
        match *self {
            Self::Line { .. } => None,
            Self::Arc { from_degrees, to_degrees } => Some(circle(from_degrees, to_degrees, size)),
        }
    }
}

fn direction(degrees: f32) -> Vec2 {
    // Exact along the axes, where nearly all sliders lie.
    match degrees.rem_euclid(360.0) {
        0.0 => Vec2::X,
        90.0 => Vec2::Y,
        180.0 => Vec2::NEG_X,
        270.0 => Vec2::NEG_Y,
        other => Vec2::from_angle(other.to_radians()),
    }
}

/// Length of the line through the middle of an area from edge to edge.
fn chord(along: Vec2, size: Vec2) -> f32 {
    (size / along.abs()).min_element()
}

/// The circle of an arc that just fits the area.
fn circle(from_degrees: f32, to_degrees: f32, size: Vec2) -> (Vec2, f32) {
    let (from, to) = (from_degrees.min(to_degrees).to_radians(), from_degrees.max(to_degrees).to_radians());
    let (mut low, mut high) = (Vec2::from_angle(from), Vec2::from_angle(from));
    let quarters = (from / FRAC_PI_2).ceil() as i32..=(to / FRAC_PI_2).floor() as i32;
    for angle in quarters.map(|quarter| quarter as f32 * FRAC_PI_2).chain([to]) {
        let point = Vec2::from_angle(angle);
        low = low.min(point);
        high = high.max(point);
    }
    let size = size - 2.0 * AROUND * size.min_element();
    let radius = (size / (high - low).max(Vec2::splat(1e-3))).min_element();
    (-0.5 * (low + high) * radius, radius)
}

/// `angle` wrapped to -pi to pi.
pub(super) fn wrapped(angle: f32) -> f32 {
    (angle + PI).rem_euclid(TAU) - PI
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_on_the_track_is_found_again() {
        let tracks = [
            SliderTrack::EAST,
            SliderTrack::NORTH,
            SliderTrack::Line { degrees: 30.0 },
            SliderTrack::Line { degrees: -135.0 },
            SliderTrack::Arc { from_degrees: 180.0, to_degrees: 0.0 },
            SliderTrack::Arc { from_degrees: -30.0, to_degrees: 120.0 },
            SliderTrack::Arc { from_degrees: 225.0, to_degrees: -45.0 },
        ];
        for track in tracks {
            for size in [Vec2::new(0.6, 0.2), Vec2::new(0.3, 0.3), Vec2::new(0.2, 0.9)] {
                for share in [0.0, 0.2, 0.5, 0.93, 1.0] {
                    let place = track.place_at(share, size);
                    let inside =
                        place.cmpge(Vec2::splat(-1e-4)).all() && place.cmple(Vec2::splat(1.0001)).all();
                    assert!(inside, "{track:?} at {share}: {place}");
                    let found = track.share_at(place, size).unwrap();
                    assert!((found - share).abs() < 1e-3, "{track:?} {size} at {share}: {found}");
                }
            }
        }
    }

    #[test]
    fn a_half_circle_fills_an_area_twice_as_wide_as_deep() {
        let arc = SliderTrack::Arc { from_degrees: 180.0, to_degrees: 0.0 };
        let (centre, radius) = arc.circle(Vec2::new(0.6, 0.3)).unwrap();
        // A margin of 18 % of 30 cm stays free on all sides.
        assert!((radius - 0.192).abs() < 1e-5);
        assert!(centre.distance(Vec2::new(0.0, -0.096)) < 1e-5);
        assert_eq!(arc.share_at(Vec2::new(0.5, 0.14), Vec2::new(0.6, 0.3)), None, "at the hub");
    }

    #[test]
    fn what_lies_beyond_an_arcs_end_is_at_that_end() {
        let arc = SliderTrack::Arc { from_degrees: 135.0, to_degrees: 45.0 };
        let size = Vec2::splat(0.4);
        let (centre, radius) = arc.circle(size).unwrap();
        let at = |degrees: f32| 0.5 + (centre + radius * direction(degrees)) / size;
        assert_eq!(arc.share_at(at(170.0), size), Some(0.0));
        assert_eq!(arc.share_at(at(10.0), size), Some(1.0));
        assert_eq!(arc.share_at(Vec2::NAN, size), None);
    }
}
