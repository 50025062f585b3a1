//! Path of a dragging foot: along the geometry of a control, or over free floor.

use glam::Vec2;

use super::{Stage, Written};
use crate::definition::{Drag, DragEnd};
use crate::slide::Slide;
use underfoot::floor::Rect;
use underfoot::widget::Behaviour;

impl Stage<'_> {
    /// Returns the path of a drag, in floor metres; `None` after reporting why the drag is impossible.
    pub(super) fn way(&self, step: &Drag, written: Written<'_>) -> Option<Slide> {
        let Some(id) = &step.widget else {
            let ends =
                self.ends(step, written, places, "is a place in tiles, as Drag has no `widget`", "(2.5, 3)");
            let [from, to] =
                ends?.map(|(field, tiles)| self.place(tiles, written.step.peek(written.name, field)?));
            return Some(Slide::Line { from: from?, to: to? });
        };
        let widget = self.widget(id, written)?;
        let (id, area) = (&widget.id, widget.area);
        match &widget.behaviour {
            Behaviour::Slider(spec) => {
                let what = format!("is a share of \"{id}\", which is a slider");
                let [from, to] = self.ends(step, written, shares, &what, "0.5")?.map(|(_, share)| share);
                Some(Slide::along(spec.track, area, from, to))
            }
            Behaviour::Dial(spec) => {
                let what = format!("is a share of \"{id}\", which is a dial");
                let [from, to] = self.ends(step, written, shares, &what, "0.5")?.map(|(_, share)| share);
                Some(Slide::round(spec, area, from, to))
            }
            Behaviour::Pad(_) => {
                let what = format!("is a place on \"{id}\", which is a pad");
                let pad = Rect::new(Vec2::ZERO, Vec2::ONE);
                let on_pad = |end| places(end).filter(|at| pad.contains(*at));
                let ends = self.ends(step, written, on_pad, &what, "(0.5, 0.5), each 0 to 1")?;
                let [from, to] = ends.map(|(_, shares)| area.min + shares * area.size());
                Some(Slide::Line { from, to })
            }
            _ => {
                let kind = &widget.kind;
                let message = format!("Drag needs a slider, a dial or a pad, and \"{id}\" is a {kind}");
                written.wrong("widget", message, None);
                None
            }
        }
    }

    /// Returns both ends, converted by `read`, with the names of their fields; `None` after reporting the ends that
    /// `read` rejects.
    fn ends<T>(
        &self,
        step: &Drag,
        written: Written<'_>,
        read: impl Fn(DragEnd) -> Option<T>,
        what: &str,
        example: &str,
    ) -> Option<[(&'static str, T); 2]> {
        let [from, to] = [("from", step.from), ("to", step.to)].map(|(field, end)| {
            let end = read(end);
            if end.is_none() {
                written.wrong(field, format!("`{field}` {what}: write {example}"), None);
            }
            Some((field, end?))
        });
        Some([from?, to?])
    }
}

fn shares(end: DragEnd) -> Option<f32> {
    if let DragEnd::Share(share) = end { Some(share) } else { None }
}

fn places(end: DragEnd) -> Option<Vec2> {
    if let DragEnd::Place(place) = end { Some(place) } else { None }
}
