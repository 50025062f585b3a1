//! Themes: the colours of everything but the controls' faces, and, for high contrast, of the faces too.

use underfoot::layout::Colour;

/// Colours of everything except the controls' own faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Theme {
    /// Background around the floor.
    pub canvas: Colour,
    /// Seams between the plates.
    pub seam: Colour,
    /// A plate without load.
    pub plate: Colour,
    /// Plates under load.
    pub load: Colour,
    /// Text on the canvas and on plates.
    pub ink: Colour,
    /// Secondary text: rulers, units, names of regions.
    pub quiet: Colour,
    /// Hairlines and the edges of panels.
    pub line: Colour,
    /// Outlines of regions, and the selection.
    pub accent: Colour,
    /// Stance zones.
    pub stance: Colour,
    /// Contacts and sensor forces.
    pub contact: Colour,
    /// The contact that is a region's cursor.
    pub cursor: Colour,
    /// Simulated shoes.
    pub shoe: Colour,
    /// Actuator levels.
    pub haptic: Colour,
    /// Warnings.
    pub warning: Colour,
    /// Faults.
    pub fault: Colour,
    /// Stale values.
    pub stale: Colour,
    /// Good state.
    pub good: Colour,
    /// Shadows.
    pub shadow: Colour,
    /// Common colours of all controls; `None` for the colours of the layout.
    pub faces: Option<Faces>,
}

/// Common colours of all controls, for themes in which contrast is more important than the layout's colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Faces {
    /// A face at rest.
    pub rest: Colour,
    /// A face while it is pressed or on.
    pub lit: Colour,
    /// The edge of a face, and its text if that is readable.
    pub ink: Colour,
}

impl Theme {
    /// The themes to choose from, by name.
    pub const NAMED: [(&'static str, Self); 3] =
        [("Light", Self::LIGHT), ("Dark", Self::DARK), ("High contrast", Self::CONTRAST)];

    /// Returns the theme's name in [`Theme::NAMED`]; `None` for any other theme.
    #[must_use]
    pub fn name(&self) -> Option<&'static str> {
        Self::NAMED.iter().find(|(_, theme)| theme == self).map(|(name, _)| *name)
    }

    /// Warm light grey, for daylight and for paper.
    pub const LIGHT: Self = Self {
        canvas: Colour::rgb(0xf1, 0xee, 0xe8),
        seam: Colour::rgb(0xdc, 0xd6, 0xcb),
        plate: Colour::rgb(0xfa, 0xf8, 0xf4),
        load: Colour::rgb(0xf2, 0xb8, 0x5c),
        ink: Colour::rgb(0x2a, 0x28, 0x25),
        quiet: Colour::rgb(0x6e, 0x68, 0x5e),
        line: Colour::rgb(0xd9, 0xd3, 0xc8),
        accent: Colour::rgb(0x2f, 0x6b, 0xd8),
        stance: Colour::rgb(0x7b, 0x71, 0x62),
        contact: Colour::rgb(0x0f, 0x76, 0x82),
        cursor: Colour::rgb(0xc2, 0x1c, 0x60),
        shoe: Colour::rgb(0x45, 0x40, 0x39),
        haptic: Colour::rgb(0x76, 0x45, 0xc9),
        warning: Colour::rgb(0xa1, 0x55, 0x00),
        fault: Colour::rgb(0xc6, 0x28, 0x28),
        stale: Colour::rgb(0x7d, 0x83, 0x8a),
        good: Colour::rgb(0x24, 0x76, 0x3f),
        shadow: Colour::rgb(0x4a, 0x40, 0x30),
        faces: None,
    };

    /// Dark grey, for a darkened room.
    pub const DARK: Self = Self {
        canvas: Colour::rgb(0x1d, 0x1e, 0x20),
        seam: Colour::rgb(0x15, 0x16, 0x17),
        plate: Colour::rgb(0x2b, 0x2c, 0x2f),
        load: Colour::rgb(0xa8, 0x71, 0x24),
        ink: Colour::rgb(0xee, 0xeb, 0xe5),
        quiet: Colour::rgb(0xa6, 0xa1, 0x98),
        line: Colour::rgb(0x3d, 0x3e, 0x42),
        accent: Colour::rgb(0x7a, 0xa8, 0xf5),
        stance: Colour::rgb(0xa3, 0x9a, 0x8b),
        contact: Colour::rgb(0x4f, 0xc3, 0xd0),
        cursor: Colour::rgb(0xff, 0x6b, 0xa5),
        shoe: Colour::rgb(0xc9, 0xc3, 0xb8),
        haptic: Colour::rgb(0xb3, 0x8c, 0xf7),
        warning: Colour::rgb(0xf0, 0xa3, 0x3c),
        fault: Colour::rgb(0xff, 0x7b, 0x72),
        stale: Colour::rgb(0x9a, 0xa0, 0xa8),
        good: Colour::rgb(0x6c, 0xc2, 0x85),
        shadow: Colour::rgb(0x00, 0x00, 0x00),
        faces: None,
    };

    /// Black with white edges and few, bright colours, at least 7 to 1: for low vision, bright rooms and weak
    /// projectors. On and off also differ in lightness.
    pub const CONTRAST: Self = Self {
        canvas: Colour::rgb(0x00, 0x00, 0x00),
        seam: Colour::rgb(0x5c, 0x5c, 0x5c),
        plate: Colour::rgb(0x00, 0x00, 0x00),
        load: Colour::rgb(0x6b, 0x4a, 0x00),
        ink: Colour::rgb(0xff, 0xff, 0xff),
        quiet: Colour::rgb(0xe4, 0xe4, 0xe4),
        line: Colour::rgb(0xa0, 0xa0, 0xa0),
        accent: Colour::rgb(0x6c, 0xd4, 0xff),
        stance: Colour::rgb(0xff, 0xff, 0xff),
        contact: Colour::rgb(0x20, 0xe8, 0xff),
        cursor: Colour::rgb(0xff, 0xe6, 0x00),
        shoe: Colour::rgb(0xd4, 0xd4, 0xd4),
        haptic: Colour::rgb(0xe2, 0xa8, 0xff),
        warning: Colour::rgb(0xff, 0xb4, 0x30),
        fault: Colour::rgb(0xff, 0x84, 0x84),
        stale: Colour::rgb(0xb8, 0xb8, 0xb8),
        good: Colour::rgb(0x74, 0xff, 0x98),
        shadow: Colour::rgb(0x00, 0x00, 0x00),
        faces: Some(Faces {
            rest: Colour::rgb(0x00, 0x00, 0x00),
            lit: Colour::rgb(0xff, 0xe6, 0x00),
            ink: Colour::rgb(0xff, 0xff, 0xff),
        }),
    };

    /// Returns true if text is lighter than the background.
    #[must_use]
    pub fn is_dark(&self) -> bool {
        self.canvas.luminance() < self.ink.luminance()
    }
}

impl Default for Theme {
    fn default() -> Self {
        Self::LIGHT
    }
}

/// Minimum contrast of readable text of any size.
///
/// # Source
/// Web Content Accessibility Guidelines 2.2, 1.4.3, level AA.
pub(super) const READABLE: f32 = 4.5;

const DARK_INK: Colour = Colour::rgb(0x1c, 0x1b, 0x19);
const LIGHT_INK: Colour = Colour::rgb(0xff, 0xff, 0xff);

/// `wish` if it is readable on `ground`, otherwise near-black or white, whichever has the higher contrast.
pub(super) fn readable(wish: Colour, ground: Colour) -> Colour {
    if contrast(wish, ground) >= READABLE {
        wish
    } else if contrast(DARK_INK, ground) >= contrast(LIGHT_INK, ground) {
        DARK_INK
    } else {
        LIGHT_INK
    }
}

/// Contrast ratio of two colours, 1 (equal) to 21.
pub(super) fn contrast(one: Colour, other: Colour) -> f32 {
    one.contrast(other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contrast_runs_from_1_to_21() {
        let (black, white) = (Colour::rgb(0, 0, 0), Colour::rgb(255, 255, 255));
        assert!((contrast(black, white) - 21.0).abs() < 1e-3);
        assert_eq!(contrast(white, white), 1.0);
    }

    #[test]
    fn words_of_both_themes_can_be_read() {
        for theme in [Theme::LIGHT, Theme::DARK] {
            for ground in [theme.canvas, theme.plate] {
                assert!(contrast(theme.ink, ground) > 7.0);
                for colour in
                    [theme.quiet, theme.contact, theme.cursor, theme.fault, theme.warning, theme.good]
                {
                    assert!(
                        contrast(colour, ground) >= 4.4,
                        "{colour} on {ground}: {}",
                        contrast(colour, ground)
                    );
                }
            }
        }
        assert!(Theme::DARK.is_dark() && !Theme::LIGHT.is_dark());
    }

    #[test]
    fn every_word_of_high_contrast_stands_off_by_seven() {
        let theme = Theme::CONTRAST;
        let Theme { ink, quiet, accent, contact, cursor, haptic, warning, fault, stale, good, .. } = theme;
        for colour in [ink, quiet, accent, contact, cursor, haptic, warning, fault, stale, good] {
            assert!(contrast(colour, theme.plate) >= 7.0, "{colour}: {}", contrast(colour, theme.plate));
        }
        let faces = theme.faces.unwrap();
        assert!(contrast(faces.ink, faces.rest) >= 7.0 && contrast(faces.lit, faces.rest) >= 7.0);
        assert!(theme.is_dark() && theme.name() == Some("High contrast"));
    }

    #[test]
    fn an_ink_that_cannot_be_read_is_replaced() {
        let yellow = Colour::rgb(0xff, 0xe0, 0x40);
        assert_eq!(readable(LIGHT_INK, yellow), DARK_INK);
        assert_eq!(readable(DARK_INK, yellow), DARK_INK);
        let navy = Colour::rgb(0x10, 0x20, 0x60);
        assert_eq!(readable(DARK_INK, navy), LIGHT_INK);
    }
}
