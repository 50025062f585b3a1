//! Putting things down: in their usual size on a click, in a size of one's own by drawing it.

use glam::Vec2;

use super::canvas::Canvas;
use super::edited::EditedLayout;
use super::gestures::{PointerGesture, Pressing, SLACK};
use super::palette::InHand;
use super::trial::{GestureResult, SnappedArea, Snapping, rect_between};
use crate::edit::Edges;
use underfoot::floor::Rect;

impl Canvas {
    /// Follows the pointer with the thing to put down; returns the result that a release would have now.
    pub(super) fn put_down(
        &mut self,
        edited: &mut EditedLayout,
        hand: InHand,
        pressing: &Pressing,
        snapping: Snapping,
    ) -> GestureResult {
        if pressing.pressed && pressing.inside {
            self.gesture = PointerGesture::Drawing { from: pressing.at };
        }
        let from = match self.gesture {
            PointerGesture::Drawing { from } => Some(from),
            _ => None,
        };
        if from.is_none() && !pressing.inside {
            return GestureResult::default();
        }
        let far = SLACK / snapping.map.scale();
        let snapped = match from.filter(|from| from.distance(pressing.at) > far) {
            Some(from) => drawn(edited, from, pressing.at, snapping),
            None => {
                let size = hand.thing.size(&edited.document.floor().geometry);
                let area = Rect::from_centre_size(from.unwrap_or(pressing.at), size);
                snapping.snap(edited, area, Edges::ALL, |_| true)
            }
        };
        if (from.is_some() && pressing.released) || pressing.dropped {
            self.gesture = PointerGesture::None;
            edited.stroke += 1;
            if edited.put(&hand.thing, snapped.area, hand.label()) {
                self.placing = hand.next(pressing.stays);
                let label = self.placing.as_ref().and_then(|next| next.label());
                if let Some(label) = label.map(str::to_owned) {
                    edited.say(format!("next: {label}"));
                }
            } else if pressing.dropped {
                // After a drag from the palette, the user must choose the thing again.
                self.placing = None;
            }
            return GestureResult::default();
        }
        let area = snapped.area;
        snapped.result(vec![area])
    }
}

/// The area from the press at `from` to the pointer at `to`.
fn drawn(edited: &EditedLayout, from: Vec2, to: Vec2, snapping: Snapping) -> SnappedArea {
    let corner = Edges { west: true, south: true, ..Edges::default() };
    // Any size does: only this corner snaps.
    let from = snapping.snap(edited, Rect::from_min_size(from, Vec2::ONE), corner, |_| true).area.min;
    let (east, north) = (to.x >= from.x, to.y >= from.y);
    let edges = Edges { east, west: !east, north, south: !north };
    snapping.snap(edited, rect_between(from, to), edges, |_| true)
}
