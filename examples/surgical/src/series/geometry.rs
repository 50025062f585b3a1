//! The size of pixels, and the place of a picture in the body.

use dicom_dictionary_std::tags;

use super::attributes::Attributes;

/// The plane of one picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plane {
    /// Distance between pixels to the right and downwards, in millimetres; `None` if the file lacks it.
    pub spacing_mm: Option<[f64; 2]>,
    /// The sides of the body at its right and lower edges, in letters such as `L` and `P`.
    pub towards: Option<[String; 2]>,
    /// Its position along the line across it, in millimetres.
    pub place_mm: Option<f64>,
}

/// Share of a direction from which a second letter is written: sin 15 degrees.
const OBLIQUE: f64 = 0.259;

/// Sides of the body with their opposites: right and left, front and back, foot and head.
const SIDES: [[char; 2]; 3] = [['R', 'L'], ['A', 'P'], ['F', 'H']];

impl Plane {
    /// The plane of a frame, from 0.
    pub fn of_frame(file: Attributes, frame: usize) -> Self {
        let measures = |group, tag| {
            file.of_frame(frame, group).find_map(|place: Attributes| spacing(&place.numbers(tag)?))
        };
        let spacing_mm = measures(tags::PIXEL_MEASURES_SEQUENCE, tags::PIXEL_SPACING);
        // Of pictures without a plane: at the detector, and of scanned film.
        let others = [tags::IMAGER_PIXEL_SPACING, tags::NOMINAL_SCANNED_PIXEL_SPACING];
        let others = || others.into_iter().find_map(|tag| spacing(&file.numbers(tag)?));
        let axes = file
            .of_frame(frame, tags::PLANE_ORIENTATION_SEQUENCE)
            .find_map(|place| axes(&place.numbers(tags::IMAGE_ORIENTATION_PATIENT)?));
        let corner = file
            .of_frame(frame, tags::PLANE_POSITION_SEQUENCE)
            .find_map(|place| <[f64; 3]>::try_from(place.numbers(tags::IMAGE_POSITION_PATIENT)?).ok());
        let told = || file.text(tags::PATIENT_ORIENTATION).and_then(|text| sides(&text));
        Self {
            spacing_mm: spacing_mm.or_else(others),
            towards: axes.map(|axes| axes.map(letters)).or_else(told),
            place_mm: axes.zip(corner).map(|([right, down], corner)| dot(corner, cross(right, down))),
        }
    }
}

/// The letters of the opposite side.
pub fn opposite(letters: &str) -> String {
    let other = |letter: char| {
        let pair = SIDES.iter().find(|pair| pair.contains(&letter));
        pair.map_or(letter, |[one, other]| if *one == letter { *other } else { *one })
    };
    letters.chars().map(other).collect()
}

/// Files give the distance between rows, which is downwards, first.
fn spacing(numbers: &[f64]) -> Option<[f64; 2]> {
    match numbers {
        [down, right, ..] if *down > 0.0 && *right > 0.0 => Some([*right, *down]),
        _ => None,
    }
}

/// The directions of rows and columns, of length 1.
fn axes(numbers: &[f64]) -> Option<[[f64; 3]; 2]> {
    let &[a, b, c, d, e, f] = numbers else { return None };
    let unit = |axis: [f64; 3]| {
        let length = dot(axis, axis).sqrt();
        (length > 0.5).then(|| axis.map(|part| part / length))
    };
    Some([unit([a, b, c])?, unit([d, e, f])?])
}

/// The letters of a direction in the body, with axes to its left, its back and its head (PS3.3, C.7.6.2.1.1).
fn letters(direction: [f64; 3]) -> String {
    let mut parts: Vec<(f64, char)> = direction
        .iter()
        .zip(SIDES)
        .map(|(part, [less, more])| (part.abs(), if *part < 0.0 { less } else { more }))
        .collect();
    parts.sort_by(|one, other| other.0.total_cmp(&one.0));
    parts.iter().filter(|(share, _)| *share >= OBLIQUE).take(2).map(|(_, letter)| letter).collect()
}

/// The sides in the attribute of a picture without a plane, such as `L\F`.
fn sides(text: &str) -> Option<[String; 2]> {
    let is_side = |letter: char| SIDES.iter().flatten().any(|side| *side == letter);
    let side = |part: &str| {
        let part = part.trim();
        (!part.is_empty() && part.len() <= 3 && part.chars().all(is_side)).then(|| part.to_owned())
    };
    let (right, down) = text.split_once('\\')?;
    Some([side(right)?, side(down)?])
}

fn dot(one: [f64; 3], other: [f64; 3]) -> f64 {
    one.iter().zip(other).map(|(one, other)| one * other).sum()
}

fn cross([a, b, c]: [f64; 3], [d, e, f]: [f64; 3]) -> [f64; 3] {
    [b * f - c * e, c * d - a * f, a * e - b * d]
}
