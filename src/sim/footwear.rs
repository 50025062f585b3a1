//! What people wear on their feet, and what it makes of a print.

use glam::Vec2;

use super::footprint::Print;

/// What a person wears.
///
/// The recorded steps are barefoot. What a shoe changes is our assumption: a sole spreads the pressure a
/// little and is longer than the foot; a high heel stands on a tip; a boot is large and stiff.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Footwear {
    /// Nothing, or socks.
    Barefoot,
    /// Flat shoes: pressure spread by 8 % more, 1 cm longer.
    #[default]
    Shoes,
    /// High heels: a tip of 16 mm, the forefoot narrow.
    Heels,
    /// Boots: pressure spread by 15 % more, 2 cm longer.
    Boots,
}

impl Footwear {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Barefoot, Self::Shoes, Self::Heels, Self::Boots];

    /// The print of a foot `length_m` long whose bare sole would press with this centre and these radii.
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
