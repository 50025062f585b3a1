//! The look of a control: shape and colours.

use super::Icon;
use std::fmt;
use std::str::FromStr;

use underfoot_format::codec::Spelled;
use underfoot_format::{Name, Named, Opt, record};

/// An opaque colour in sRGB, written `#rrggbb`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Colour {
    /// Red, 0 to 255.
    pub red: u8,
    /// Green, 0 to 255.
    pub green: u8,
    /// Blue, 0 to 255.
    pub blue: u8,
}

impl Colour {
    /// The colour of these components.
    #[must_use]
    pub const fn rgb(red: u8, green: u8, blue: u8) -> Self {
        Self { red, green, blue }
    }

    /// The contrast of two colours, 1 (none) to 21.
    ///
    /// # Source
    /// Web Content Accessibility Guidelines 2.2, "contrast ratio": `(L1 + 0.05) / (L2 + 0.05)` of the
    /// relative luminances.
    #[must_use]
    pub fn contrast(self, other: Self) -> f32 {
        let (one, other) = (self.luminance(), other.luminance());
        (one.max(other) + 0.05) / (one.min(other) + 0.05)
    }

    /// Relative luminance, 0 to 1.
    #[must_use]
    pub fn luminance(self) -> f32 {
        let linear = |byte: u8| {
            let share = f32::from(byte) / 255.0;
            if share <= 0.04045 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * linear(self.red) + 0.7152 * linear(self.green) + 0.0722 * linear(self.blue)
    }

    /// The colour at `share` (0 to 1) between `self` and `other`.
    #[must_use]
    pub fn mix(self, other: Self, share: f32) -> Self {
        let share = share.clamp(0.0, 1.0);
        let blend =
            |from: u8, to: u8| (f32::from(from) + (f32::from(to) - f32::from(from)) * share).round() as u8;
        Self::rgb(blend(self.red, other.red), blend(self.green, other.green), blend(self.blue, other.blue))
    }
}

impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.red, self.green, self.blue)
    }
}

impl FromStr for Colour {
    type Err = ();

    /// Reads `#rrggbb`; rejects anything else.
    fn from_str(text: &str) -> Result<Self, ()> {
        let digits =
            text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii()).ok_or(())?;
        let byte = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).map_err(drop);
        Ok(Self::rgb(byte(0)?, byte(2)?, byte(4)?))
    }
}

/// The outline of a control's face, which is also its active area.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shape {
    /// The whole area.
    #[default]
    Box,
    /// The ellipse inside the area.
    Round,
}

impl Named for Shape {
    const ALL: &'static [(&'static str, Self)] = &[("Box", Self::Box), ("Round", Self::Round)];
}

record! {
    /// The look of a control; a calm grey blue by default.
    pub struct Look = "Look", Copy;
    /// Outline of the face.
    pub shape: Shape = "shape", Name => Shape::Box;
    /// Face at rest.
    pub face: Colour = "face", HEX => Look::PLAIN.face;
    /// Face while pressed or on, and the filled part of a slider.
    pub lit: Colour = "lit", HEX => Look::PLAIN.lit;
    /// Label and icon.
    pub ink: Colour = "ink", HEX => Look::PLAIN.ink;
    /// Picture above the label, or instead of it.
    pub icon: Option<Icon> = "icon", Opt(Name) => None;
}

impl Look {
    /// The default look: a calm grey blue.
    pub const PLAIN: Self = Self {
        shape: Shape::Box,
        face: Colour::rgb(0xdd, 0xe4, 0xec),
        lit: Colour::rgb(0x8f, 0xb6, 0xe0),
        ink: Colour::rgb(0x1f, 0x2a, 0x36),
        icon: None,
    };
}

/// A colour in files: `"#rrggbb"`.
pub(crate) const HEX: Spelled<Colour> = Spelled {
    about: "a colour in quotes, \"#rrggbb\"",
    parse: |text| text.parse().ok(),
    wrong: |name, _| format!("`{name}` must be a colour"),
    expected: "expected \"#rrggbb\" with six hexadecimal digits",
    help: |text| {
        let is_hex = |digits: &str| digits.bytes().all(|byte| byte.is_ascii_hexdigit());
        let digits = text.trim().trim_start_matches('#');
        match digits.len() {
            3 if is_hex(digits) => {
                let doubled: String = digits.chars().flat_map(|digit| [digit, digit]).collect();
                Some(format!("write all six digits: \"#{doubled}\""))
            }
            6 if is_hex(digits) => Some(format!("write \"#{digits}\"")),
            8 if is_hex(digits) => Some("colours are opaque: leave out the last two digits".to_owned()),
            _ => None,
        }
    },
    stand_in: Colour::rgb(0, 0, 0),
};
