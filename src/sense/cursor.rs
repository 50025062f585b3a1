use glam::Vec2;

use super::ContactId;
use crate::units::Newtons;

/// The contact that operates the controls of one region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cursor {
    /// Which contact.
    pub contact: ContactId,
    /// Its centroid, in floor metres.
    pub position: Vec2,
    /// Its force.
    pub force: Newtons,
}
