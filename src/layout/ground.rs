//! A part of the floor with the appearance of a material.

use super::Colour;
use crate::ground::GroundSpec;

/// A part of the floor with the appearance of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    /// Its area and material.
    pub spec: GroundSpec,
    /// Its colour where it is whole.
    pub surface: Colour,
    /// Its colour in the depth: water under ice, the ground under snow, the gap between planks.
    pub deep: Colour,
}
