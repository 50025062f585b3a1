//! The context in which the controls of a layout are read.

use std::sync::Arc;

use super::inherit::Choice;
use super::units::Units;
use underfoot_format::Includes;

/// The values of a layout that its controls, grounds and pages refer to.
#[derive(Clone)]
pub(super) struct LayoutContext {
    /// The unit of places, sizes and gaps.
    pub(super) units: Units,
    /// The kinds that controls may name, with the effects that feels may name.
    pub(super) kinds: Arc<Choice>,
    /// Number of controls that the layout may still have.
    pub(super) room: usize,
}

impl LayoutContext {
    /// Returns the context after `count` more controls.
    pub(super) fn after(&self, count: usize) -> Self {
        Self { room: self.room.saturating_sub(count), ..self.clone() }
    }
}

impl Includes<Self> for LayoutContext {
    fn included(&self) -> &Self {
        self
    }
}

impl Includes<Units> for LayoutContext {
    fn included(&self) -> &Units {
        &self.units
    }
}
