use super::Colour;
use crate::floor::Rect;
use crate::ground::Material;

/// A material that a part of the floor seems to be made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    /// Where it is.
    pub area: Rect,
    /// Which of the layout's pages it is on; `None` if it is on all of them.
    pub page: Option<usize>,
    /// What chance begins with: the same seed and the same feet give the same ground.
    pub seed: u32,
    /// What it is.
    pub material: Material,
    /// Its colour where it is whole.
    pub surface: Colour,
    /// Its colour in the depth: water under ice, the ground under snow, the gap between planks.
    pub deep: Colour,
}

impl Ground {
    /// Whether it is on the page numbered `page` (0 without pages).
    #[must_use]
    pub fn is_on(&self, page: usize) -> bool {
        self.page.is_none_or(|own| own == page)
    }
}
