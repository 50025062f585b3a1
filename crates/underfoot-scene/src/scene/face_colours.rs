//! Colours of a control's face in each theme, made from those of the layout, so that a control keeps its meaning.

use super::theme::{BLACK, Theme, WHITE};
use underfoot::layout::{Colour, Look};

/// Use of the layout's colours by a theme.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Faces {
    /// Faces and grounds have the colours of the layout.
    #[default]
    OfLayout,
    /// Dark faces and grounds in the hues of the layout.
    Dark,
    /// Black faces with thick edges and icons in the hues of the layout; a face that is pressed or on is filled with
    /// its hue. Grounds are black with the bright lines of their texture.
    Outlined,
}

/// Share of the layout's hue in a face of the dark theme.
const DARK_SHARE: f32 = 0.32;

/// Spread of the channels to which a pale hue is raised for an outline, of 255.
const VIVID: f32 = 150.0;

/// Maximum factor by which a hue is raised: greys stay grey.
const MOST_VIVID: f32 = 2.5;

/// Share of the hue in a face of high contrast just before it counts as lit: text stays readable up to there.
const HALF_LIT: f32 = 0.6;

/// The colours of one control's face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FaceColours {
    /// Face at rest.
    pub(super) rest: Colour,
    /// Face while pressed or on, and the filled part of a slider.
    pub(super) lit: Colour,
    /// Label.
    pub(super) ink: Colour,
    /// Icon, guard and edge; `None` to derive them from face and label.
    pub(super) mark: Option<Colour>,
}

impl FaceColours {
    /// Returns the colours of a control with this look in `theme`.
    pub(super) fn of(look: &Look, theme: &Theme) -> Self {
        match theme.faces {
            Faces::OfLayout => Self { rest: look.face, lit: look.lit, ink: look.ink, mark: None },
            Faces::Dark => {
                let hue = hue(look);
                // A little grey: full colours glare on a dark screen.
                let lit = look.lit.mix(theme.plate, 0.06);
                let rest = theme.plate.mix(hue, DARK_SHARE);
                Self { rest, lit, ink: hue.mix(WHITE, 0.78), mark: None }
            }
            Faces::Outlined => {
                let mark = bright(vivid(hue(look)), theme.least_contrast());
                Self { rest: BLACK, lit: mark, ink: WHITE, mark: Some(mark) }
            }
        }
    }

    /// Returns the face at `share` (0 to 1) between rest and lit.
    pub(super) fn face(&self, share: f32) -> Colour {
        if self.mark.is_none() {
            return self.rest.mix(self.lit, share);
        }
        // No text is readable at high contrast on the colours in between.
        if share > 0.5 { self.lit } else { self.rest.mix(self.lit, HALF_LIT * share) }
    }
}

/// The colour that tells a control from others: the more colourful one of face and lit face.
fn hue(look: &Look) -> Colour {
    if spread(look.face) > spread(look.lit) { look.face } else { look.lit }
}

/// Difference between the strongest and the weakest channel, 0 (grey) to 255.
fn spread(colour: Colour) -> u8 {
    let [red, green, blue] = [colour.red, colour.green, colour.blue];
    red.max(green).max(blue) - red.min(green).min(blue)
}

/// The same hue, farther from grey.
fn vivid(colour: Colour) -> Colour {
    let channels = [colour.red, colour.green, colour.blue].map(f32::from);
    let grey = channels.iter().sum::<f32>() / 3.0;
    let by = (VIVID / f32::from(spread(colour)).max(1.0)).clamp(1.0, MOST_VIVID);
    // The cast from float saturates at the range of a channel.
    let [red, green, blue] = channels.map(|channel| (grey + by * (channel - grey)).round() as u8);
    Colour::rgb(red, green, blue)
}

/// The colour with as much white as a contrast of `least` with black needs.
fn bright(colour: Colour, least: f32) -> Colour {
    let mixed = (0..=32_u8).map(|part| colour.mix(WHITE, f32::from(part) / 32.0));
    mixed.into_iter().find(|mixed| mixed.contrast(BLACK) >= least).unwrap_or(WHITE)
}

#[cfg(test)]
mod tests {
    use color::{Oklab, OpaqueColor, Srgb};

    use super::*;
    use underfoot::floor::Geometry;
    use underfoot::schema::{Kinds, builtin_layout, builtin_layouts, parse_layout};

    /// Difference of two colours as seen: about 0.02 is the smallest that people notice side by side, 1 is black to
    /// white.
    fn difference(one: Colour, other: Colour) -> f32 {
        let lab = |it: Colour| OpaqueColor::<Srgb>::from_rgb8(it.red, it.green, it.blue).convert::<Oklab>();
        lab(one).difference(lab(other))
    }

    /// The looks of all kinds that ship, and of all controls of each shipped layout.
    fn shipped() -> Vec<(String, Look)> {
        let kinds = Kinds::builtin();
        let mut all: Vec<(String, Look)> =
            kinds.iter().map(|kind| (kind.name.to_string(), kind.look)).collect();
        for name in builtin_layouts() {
            let text = builtin_layout(name).unwrap();
            let layout = parse_layout(text, name, &kinds, &Geometry::default()).unwrap().layout;
            all.extend(layout.widgets.iter().map(|widget| (format!("{name}: {}", widget.id), widget.look)));
        }
        all
    }

    #[test]
    fn labels_can_be_read_on_every_face_of_every_theme() {
        for (theme_name, theme) in Theme::NAMED {
            for theme in [theme, theme.projected()] {
                for (name, look) in shipped() {
                    let colours = FaceColours::of(&look, &theme);
                    for share in [0.0, 0.12, 0.25, 0.3, 0.7, 1.0] {
                        let face = colours.face(share);
                        let ratio = theme.readable(colours.ink, face).contrast(face);
                        assert!(
                            ratio >= theme.least_contrast(),
                            "{theme_name}, {name} at {share}: {ratio} on {face}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn faces_and_edges_stand_off_from_the_plate_and_lit_ones_from_those_at_rest() {
        for (theme_name, theme) in &Theme::NAMED[1..] {
            for (name, look) in shipped() {
                let FaceColours { rest, lit, mark, .. } = FaceColours::of(&look, theme);
                match mark {
                    Some(mark) => assert!(mark.contrast(theme.plate) >= 7.0, "{name}: {mark}"),
                    None => assert!(difference(rest, theme.plate) >= 0.1, "{theme_name}, {name}: {rest}"),
                }
                assert!(difference(rest, lit) >= 0.2, "{theme_name}, {name}: {rest} and {lit}");
            }
        }
    }

    #[test]
    fn controls_of_different_colours_stay_different_in_every_theme() {
        let all = shipped();
        for (theme_name, theme) in &Theme::NAMED[1..] {
            for (index, (name, look)) in all.iter().enumerate() {
                for (other_name, other) in &all[..index] {
                    let of_layout = difference(look.lit, other.lit);
                    if of_layout < 0.1 {
                        continue;
                    }
                    let [one, other] = [look, other].map(|look| FaceColours::of(look, theme).lit);
                    let left = difference(one, other);
                    assert!(
                        left >= 0.04,
                        "{theme_name}: {name} {one}, {other_name} {other}: {left} of {of_layout}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_pale_hue_becomes_a_bright_one_and_a_grey_stays_grey() {
        let bright_of = |red, green, blue| bright(vivid(Colour::rgb(red, green, blue)), 7.0);
        let red = bright_of(0xe0, 0x60, 0x4a);
        assert!(red.red > red.green + 60 && red.contrast(BLACK) >= 7.0, "{red}");
        let navy = bright_of(0x10, 0x18, 0x40);
        assert!(navy.blue > navy.red && navy.contrast(BLACK) >= 7.0, "{navy}");
        assert!(spread(bright_of(0x80, 0x80, 0x84)) < 16);
    }
}
