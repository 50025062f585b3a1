//! Label and icon of a control's face.

use glam::Vec2;

use super::face::{Face, SMALL_M};
use super::fit::{Fitted, fit};
use super::mark::{Anchor, Ink, Lettering};
use super::widths::{CAP_HEIGHT, LINE_HEIGHT};
use super::{Scene, TextDirection, icon};
use underfoot::floor::Rect;
use underfoot::layout::{Colour, Shape};

/// Maximum letter size of a label, in metres: easy to read from standing height.
const LABEL_M: f32 = 0.046;

/// Maximum side of an icon, in metres.
const ICON_M: f32 = 0.11;

/// Minimum side of a recognisable icon, in metres; below it the face has only the label.
const ICON_LEAST_M: f32 = 0.02;

impl Face<'_> {
    /// Writes the label in the centre of the face, under the icon if there is one.
    pub(super) fn write_label(&self, scene: &mut Scene) {
        let room = self.draw_icon(scene, self.room());
        let label = &self.widget.label;
        if self.widget.look.icon.is_some() {
            self.write(scene, label, room, Anchor::Middle);
            return;
        }
        let fitted = fit(label, room.size(), LABEL_M, SMALL_M);
        if self.shape == Shape::Round && self.badge().is_none() {
            // In a circle, one line may be longer than the width of the inscribed square.
            let middle = Rect::from_centre_size(self.area.centre(), self.area.size() * Vec2::new(0.88, 0.42));
            let flat = fit(label, middle.size(), LABEL_M, SMALL_M);
            if (fitted.shortened && !flat.shortened) || flat.size_m > fitted.size_m {
                set(scene, label, middle, Anchor::Middle, self.ink, &flat);
                return;
            }
        }
        set(scene, label, room, Anchor::Middle, self.ink, &fitted);
    }

    /// Writes `text` into `room`, as large as it fits, with its lines centred vertically.
    pub(super) fn write(&self, scene: &mut Scene, text: &str, room: Rect, anchor: Anchor) {
        self.write_in(scene, text, room, anchor, self.ink);
    }

    /// Draws the icon, if there is one, and returns the remaining room: beside it if the room is wide, otherwise
    /// below.
    pub(super) fn draw_icon(&self, scene: &mut Scene, room: Rect) -> Rect {
        let Some(icon) = self.widget.look.icon else { return room };
        let size = room.size();
        let labelled = !self.widget.label.is_empty();
        let beside = labelled && size.x > 1.8 * size.y;
        // The label keeps at least one line of small letters.
        let strip = if labelled && !beside { (0.36 * size.y).max(LINE_HEIGHT * SMALL_M) } else { 0.0 };
        let side = (0.92 * (size.y - strip)).min(0.8 * size.x).min(ICON_M);
        if side < ICON_LEAST_M {
            return room;
        }
        if beside {
            let middle = Vec2::new(room.min.x + 0.5 * side, room.centre().y);
            icon::draw(scene, icon, middle, side, self.mark());
            return Rect::new(Vec2::new(room.min.x + 1.15 * side, room.min.y), room.max);
        }
        let top = room.centre().y + 0.5 * (side + strip);
        icon::draw(scene, icon, Vec2::new(room.centre().x, top - 0.5 * side), side, self.mark());
        let label = Rect::new(Vec2::new(room.min.x, top - side - strip), Vec2::new(room.max.x, top - side));
        Rect::new(label.min.max(room.min), label.max)
    }

    /// The same in another colour.
    pub(super) fn write_in(&self, scene: &mut Scene, text: &str, room: Rect, anchor: Anchor, ink: Colour) {
        set(scene, text, room, anchor, ink, &fit(text, room.size(), LABEL_M, SMALL_M));
    }
}

fn set(scene: &mut Scene, text: &str, room: Rect, anchor: Anchor, ink: Colour, fitted: &Fitted) {
    let x = match anchor {
        Anchor::Start => room.min.x,
        Anchor::Middle => room.centre().x,
        Anchor::End => room.max.x,
    };
    let top = room.centre().y + 0.5 * fitted.height_m();
    let direction = TextDirection::of(text);
    for (line, bytes) in fitted.lines.iter().enumerate() {
        let middle = top - (line as f32 + 0.5) * LINE_HEIGHT * fitted.size_m;
        let lettering = Lettering::new(
            Vec2::new(x, middle - 0.5 * CAP_HEIGHT * fitted.size_m),
            anchor,
            fitted.size_m,
            Ink::solid(ink),
        )
        .strong()
        .reading(direction);
        let last = line + 1 == fitted.lines.len();
        let end = if fitted.shortened && last { "…" } else { "" };
        scene.add_text(lettering, format_args!("{}{end}", &text[bytes.clone()]));
    }
}
