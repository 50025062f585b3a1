use glam::Vec2;

use super::{Shape, Widget};

/// Whether `point` lies on the visible face of `widget`.
pub(super) fn hits(widget: &Widget, point: Vec2) -> bool {
    match widget.look.shape {
        Shape::Box => widget.area.contains(point),
        Shape::Round => {
            let radii = widget.area.size() * 0.5;
            ((point - widget.area.centre()) / radii).length_squared() < 1.0
        }
    }
}
