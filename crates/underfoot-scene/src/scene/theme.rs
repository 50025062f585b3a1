//! Themes: the colours of everything but the controls' faces, and the treatment of those.

use super::face_colours::Faces;
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
    /// Use of the layout's colours for controls and grounds.
    pub faces: Faces,
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
        accent: Colour::rgb(0x2b, 0x64, 0xcc),
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
        faces: Faces::OfLayout,
    };

    /// Dark grey, for a darkened room: the floor lies below the plates, the plates below the controls, and each is
    /// lighter than what it lies on.
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
        faces: Faces::Dark,
    };

    /// Black with few, bright colours, at least 7 to 1: for low vision, bright rooms and weak projectors. Controls
    /// have thick edges in their own hues; on and off also differ in lightness.
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
        faces: Faces::Outlined,
    };

    /// Returns true if text is lighter than the plates.
    #[must_use]
    pub fn is_dark(&self) -> bool {
        self.plate.luminance() < self.ink.luminance()
    }

    /// Returns the colours of a projection onto real plates: black around the floor, and with a dark theme on the
    /// plates too, because black throws no light. Controls keep the layout's own colours there, which throw most.
    #[must_use]
    pub fn projected(self) -> Self {
        let black = Colour::rgb(0, 0, 0);
        let faces = if self.faces == Faces::Dark { Faces::OfLayout } else { self.faces };
        if self.is_dark() {
            let quiet = Colour::rgb(0xd8, 0xd4, 0xcc);
            Self { canvas: black, seam: black, plate: black, quiet, faces, ..self }
        } else {
            Self { canvas: black, ..self }
        }
    }

    /// Returns the minimum contrast of text with its ground in this theme.
    ///
    /// # Source
    /// Web Content Accessibility Guidelines 2.2: 1.4.3 (level AA), and 1.4.6 (level AAA) for high contrast.
    #[must_use]
    pub const fn least_contrast(&self) -> f32 {
        match self.faces {
            Faces::Outlined => 7.0,
            Faces::OfLayout | Faces::Dark => 4.5,
        }
    }

    /// Returns `wish` if it is readable on `ground`, otherwise near-black, black or white: the first that is
    /// readable, or the one with the highest contrast.
    #[must_use]
    pub fn readable(&self, wish: Colour, ground: Colour) -> Colour {
        let most = [DARK_INK, BLACK, WHITE].into_iter().max_by(|one, other| {
            let contrast = |ink: &Colour| ink.contrast(ground);
            contrast(one).total_cmp(&contrast(other))
        });
        let inks = [wish, self.preferred(ground), BLACK, WHITE];
        let is_readable = |ink: &Colour| ink.contrast(ground) >= self.least_contrast();
        inks.into_iter().find(is_readable).or(most).unwrap_or(wish)
    }

    /// Near-black or white, whichever has the higher contrast.
    fn preferred(&self, ground: Colour) -> Colour {
        if DARK_INK.contrast(ground) >= WHITE.contrast(ground) { DARK_INK } else { WHITE }
    }

    /// Returns `wish` for text on `ground`, mixed with as much of the theme's ink as it needs to be readable there.
    #[must_use]
    pub fn legible(&self, wish: Colour, ground: Colour) -> Colour {
        let mixed = (0..=8_u8).map(|eighths| wish.mix(self.ink, f32::from(eighths) / 8.0));
        let mut readable = mixed.filter(|ink| ink.contrast(ground) >= self.least_contrast());
        readable.next().unwrap_or_else(|| self.readable(self.ink, ground))
    }
}

impl Default for Theme {
    fn default() -> Self {
        Self::LIGHT
    }
}

/// Text on light grounds.
const DARK_INK: Colour = Colour::rgb(0x1c, 0x1b, 0x19);

pub(super) const BLACK: Colour = Colour::rgb(0, 0, 0);

pub(super) const WHITE: Colour = Colour::rgb(0xff, 0xff, 0xff);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_every_theme_can_be_read_on_canvas_and_plates() {
        for (name, theme) in Theme::NAMED {
            let Theme { ink, quiet, accent, contact, cursor, haptic, warning, fault, stale, good, .. } =
                theme;
            for ground in [theme.canvas, theme.plate] {
                assert!(ink.contrast(ground) > 7.0);
                for colour in [quiet, contact, cursor, fault, warning, good, accent, haptic] {
                    let ratio = colour.contrast(ground);
                    assert!(ratio >= theme.least_contrast() - 0.1, "{name}: {colour} on {ground}: {ratio}");
                }
                // Marks without letters.
                assert!(stale.contrast(ground) >= 3.0);
            }
        }
        assert!(Theme::DARK.is_dark() && Theme::CONTRAST.is_dark() && !Theme::LIGHT.is_dark());
    }

    #[test]
    fn each_level_of_the_dark_theme_is_lighter_than_the_one_below() {
        let Theme { seam, canvas, plate, line, .. } = Theme::DARK;
        for pair in [seam, canvas, plate, line].windows(2) {
            assert!(pair[0].luminance() < pair[1].luminance(), "{} under {}", pair[0], pair[1]);
        }
    }

    #[test]
    fn dark_projections_throw_no_light_on_bare_plates_and_much_from_controls() {
        for (name, theme) in Theme::NAMED {
            let projected = theme.projected();
            assert_eq!(projected.canvas, BLACK, "{name}");
            assert_eq!(projected.plate == BLACK, theme.is_dark(), "{name}");
            assert_ne!(projected.faces, Faces::Dark, "{name}");
        }
    }

    #[test]
    fn an_ink_that_cannot_be_read_is_replaced_on_any_ground() {
        let theme = Theme::LIGHT;
        let yellow = Colour::rgb(0xff, 0xe0, 0x40);
        assert_eq!(theme.readable(WHITE, yellow), DARK_INK);
        assert_eq!(theme.readable(DARK_INK, yellow), DARK_INK);
        let navy = Colour::rgb(0x10, 0x20, 0x60);
        assert_eq!(theme.readable(DARK_INK, navy), WHITE);
        // Between the lightest ground for white and the darkest for near-black, only black is left.
        for level in 0..=255 {
            let ground = Colour::rgb(level, level, level);
            for (_, theme) in &Theme::NAMED[..2] {
                for ink in [theme.readable(theme.accent, ground), theme.legible(theme.accent, ground)] {
                    assert!(ink.contrast(ground) >= 4.5, "{ink} on {ground}");
                }
            }
        }
    }
}
