//! A part of the floor that seems to be made of a material.

use super::Colour;
use crate::ground::GroundSpec;

/// A material that a part of the floor seems to be made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    /// Where it is and what it is made of.
    pub spec: GroundSpec,
    /// Its colour where it is whole.
    pub surface: Colour,
    /// Its colour in the depth: water under ice, the ground under snow, the gap between planks.
    pub deep: Colour,
}
