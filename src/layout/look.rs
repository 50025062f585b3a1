use super::Icon;
use std::fmt;
use std::str::FromStr;

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

    /// How well the two stand off from each other, 1 (not at all) to 21.
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

    /// The colour `share` (0 to 1) of the way from `self` to `other`.
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

    /// Reads `#rrggbb`; anything else is refused.
    fn from_str(text: &str) -> Result<Self, ()> {
        let digits =
            text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii()).ok_or(())?;
        let byte = |at: usize| u8::from_str_radix(&digits[at..at + 2], 16).map_err(drop);
        Ok(Self::rgb(byte(0)?, byte(2)?, byte(4)?))
    }
}

/// The outline of a control's face, which is also where it can be hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shape {
    /// The whole area.
    #[default]
    Box,
    /// The ellipse inside the area.
    Round,
}

/// What a control looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Outline of the face.
    pub shape: Shape,
    /// Face at rest.
    pub face: Colour,
    /// Face while pressed or on, and the filled part of a slider.
    pub lit: Colour,
    /// Label and icon.
    pub ink: Colour,
    /// Picture above the label, or instead of it.
    pub icon: Option<Icon>,
}
