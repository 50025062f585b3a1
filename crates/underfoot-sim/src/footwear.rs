//! Footwear and its effect on a print.

use glam::Vec2;

use super::footprint::Print;

/// Footwear of a person.
///
/// The recorded steps are barefoot. The effect of a shoe is our assumption: a sole spreads the pressure a little and
/// is longer than the foot; a high heel stands on a tip; a boot is large and stiff.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Footwear {
    /// Bare feet, or socks.
    Barefoot,
    /// Flat shoes: 8 % larger spread of pressure, 1 cm longer.
    #[default]
    Shoes,
    /// High heels: a tip of 16 mm, and a narrow forefoot.
    Heels,
    /// Boots: 15 % larger spread of pressure, 2 cm longer.
    Boots,
}

impl Footwear {
    /// All kinds of footwear.
    pub const ALL: [Self; 4] = [Self::Barefoot, Self::Shoes, Self::Heels, Self::Boots];

    /// Returns the print of a foot of `length_m`, from the centre and radii of pressure of the bare sole.
    pub(super) fn print(self, centre: Vec2, radii: Vec2, length_m: f32) -> Print {
        let (spread, longer_m, heel_m) = match self {
            Self::Barefoot => (Vec2::ONE, 0.0, f32::INFINITY),
            Self::Shoes => (Vec2::splat(1.08), 0.01, f32::INFINITY),
            Self::Heels => (Vec2::new(0.85, 1.0), 0.0, 0.008),
            Self::Boots => (Vec2::splat(1.15), 0.02, f32::INFINITY),
        };
        Print::Sole { centre, radii: radii * spread, length_m: length_m + longer_m, heel_m }
    }
}
