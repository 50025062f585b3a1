//! Commands that change the selection.

use eframe::egui;
use glam::Vec2;

use super::edited::EditedLayout;
use crate::edit::{
    Address, Document, Edit, EditRefusal, Facet, Item, alike_edits, facet_edits, grouping, ungrouping,
};
use underfoot::floor::Rect;
use underfoot::schema::Diagnostics;

impl EditedLayout {
    /// Moves and sizes the selection to new areas.
    pub(super) fn move_to(&mut self, areas: &[Rect]) {
        if self.holds_locked() {
            return;
        }
        let items = self.selected_items();
        let moved: Vec<(&Item, Rect)> = items.into_iter().zip(areas.iter().copied()).collect();
        match self.document.placing(&moved) {
            Ok(edits) => drop(self.edit(&edits)),
            Err(refusal) => self.complain(refusal.short()),
        }
    }

    pub(super) fn nudge(&mut self, by: Vec2) {
        if self.holds_locked() {
            return;
        }
        let items = self.selected_items();
        let moved: Vec<(&Item, Rect)> =
            items.iter().map(|item| (*item, Rect::new(item.area.min + by, item.area.max + by))).collect();
        let edits = self.document.placing(&moved);
        match edits {
            // The steps of a held key are one undo step.
            Ok(edits) => drop(self.edit_in(&edits, Some(self.stroke))),
            Err(refusal) => self.complain(refusal.short()),
        }
    }

    pub(super) fn delete(&mut self) {
        if self.holds_locked() {
            return;
        }
        let edits = self.document.deleting(&self.selected);
        if self.edit(&edits) {
            self.selected.clear();
        }
    }

    pub(super) fn turn(&mut self) {
        if self.holds_locked() {
            return;
        }
        let edits = self.document.turning(&self.selected_items());
        match edits {
            Ok(edits) => drop(self.edit(&edits)),
            Err(refusal) => self.complain(refusal.short()),
        }
    }

    /// Puts copies beside the selection, on the first side with enough room.
    pub(super) fn duplicate(&mut self) {
        let Some(bounds) = self.document.bounds_of(&self.items, &self.selected) else { return };
        let text = |edited: &Self, by: Vec2| edited.document.duplicating(&edited.selected, by);
        self.put_beside(bounds.size(), text);
    }

    /// Puts copies of the selection at a distance of `by` metres and selects them.
    pub(super) fn copy_by(&mut self, by: Vec2) {
        match self.document.duplicating(&self.selected, by) {
            Ok((edits, places)) => {
                if self.edit(&edits) {
                    self.selected = places;
                }
            }
            Err(refusal) => self.complain(refusal.short()),
        }
    }

    /// Gives the selected controls, those in groups included, the appearance or feel of the copied one.
    pub(super) fn paste_facet(&mut self, facet: Facet, pasted: &str) {
        if self.holds_locked() {
            return;
        }
        let targets: Vec<&Item> =
            self.selected.iter().flat_map(|record| self.document.controls_in(&self.items, record)).collect();
        match facet_edits(&self.document, facet, pasted, &targets) {
            Ok(edits) => drop(self.edit(&edits)),
            Err(refusal) => self.complain(format!("No {} is pasted: {}", facet.name(), refusal.short())),
        }
    }

    /// Makes the other selected controls as the one that was selected first.
    pub(super) fn make_alike(&mut self) {
        if self.holds_locked() {
            return;
        }
        let items = self.selected_items();
        let Some((model, others)) = items.split_first() else { return };
        match alike_edits(&self.document, model, others) {
            Ok(edits) => {
                let said = format!("made like {}: size, thresholds, appearance, feel", model.name);
                if self.edit(&edits) {
                    self.say(said);
                }
            }
            Err(refusal) => self.complain(refusal.short()),
        }
    }

    /// Inserts the text of the clipboard, or shows why a layout cannot hold it.
    pub(super) fn paste(&mut self, pasted: &str) {
        let page = self.page;
        if let Err(refusal) = self.document.pasting_on(pasted, page, Vec2::ZERO) {
            return self.complain(format!("Nothing is pasted: {}", refusal.short()));
        }
        self.put_beside(Vec2::splat(0.16), |edited, by| edited.document.pasting_on(pasted, page, by));
    }

    /// Copies the selection; with an empty selection, the clipboard stays unchanged.
    pub(super) fn copy(&self, ctx: &egui::Context) -> bool {
        let text = self.document.copy(&self.selected);
        let is_any = !text.is_empty();
        if is_any {
            ctx.copy_text(text);
        }
        is_any
    }

    /// Copies the selection and removes it with its comments.
    pub(super) fn cut(&mut self, ctx: &egui::Context) {
        if self.holds_locked() || !self.copy(ctx) {
            return;
        }
        let edits = self.document.taking(&self.selected);
        if self.edit(&edits) {
            self.selected.clear();
        }
    }

    /// Tries places at one `size` plus 6 cm and at multiples of that, until the layout accepts one.
    pub(super) fn put_beside(
        &mut self,
        size: Vec2,
        edits: impl Fn(&Self, Vec2) -> Result<(Vec<Edit>, Vec<Address>), EditRefusal>,
    ) {
        /// Half a shoe, so that a foot on one control does not reach the other (rule U102).
        const GAP_M: f32 = 0.06;
        let step = size + Vec2::splat(GAP_M);
        let ways = [Vec2::ZERO, Vec2::X, Vec2::NEG_Y, Vec2::NEG_X, Vec2::Y, Vec2::ONE, Vec2::NEG_ONE];
        let mut last = None;
        for far in 1..=6_u8 {
            for way in ways {
                match edits(self, way * step * f32::from(far)) {
                    Ok((edits, places)) => match self.document.edit(&edits) {
                        Ok(()) => {
                            self.message = None;
                            self.selected = places;
                            return;
                        }
                        Err(refusal) => last = Some(refusal),
                    },
                    Err(refusal) => return self.complain(refusal.short()),
                }
            }
        }
        self.complain(last.map_or_else(String::new, |refusal| refusal.short()));
    }

    /// Undoes a step and selects what was selected before it.
    pub(super) fn undo(&mut self) {
        self.step_with(Document::undo);
    }

    /// Redoes a step and selects what was selected after it.
    pub(super) fn redo(&mut self) {
        self.step_with(Document::redo);
    }

    fn step_with(&mut self, step: fn(&mut Document) -> Result<bool, Diagnostics>) {
        self.steps.note(self.document.step(), &self.selected);
        match step(&mut self.document) {
            Ok(false) => {}
            Ok(true) => {
                self.selected = self.steps.at(self.document.step());
                if let Some(page) = self.selected.first().and_then(Address::page) {
                    self.page = page;
                }
            }
            Err(problems) => self.complain(problems.to_string()),
        }
    }

    pub(super) fn group(&mut self) {
        match grouping(&self.document, &self.selected_items()) {
            Ok((edits, at)) => {
                if self.edit(&edits) {
                    self.selected = vec![at];
                }
            }
            Err(refusal) => self.complain(refusal.short()),
        }
    }

    pub(super) fn ungroup(&mut self) {
        let Some(group) = self.selected_items().first().copied().cloned() else { return };
        match ungrouping(&self.document, &self.items, &group) {
            Ok((edits, places)) => {
                if self.edit(&edits) {
                    self.selected = places;
                }
            }
            Err(refusal) => self.complain(refusal.short()),
        }
    }

    /// Puts the selected record behind (`first`) or in front of all others in its list: later records are drawn on
    /// top.
    pub(super) fn reorder(&mut self, first: bool) {
        let [record] = &self.selected[..] else { return };
        let Some((parent, list, _)) = record.split() else { return };
        let count = self.document.count(&parent, list);
        let to = if first { 0 } else { count.saturating_sub(1) };
        if self.edit(&[Edit::Reorder { record: record.clone(), to }]) {
            self.selected = vec![parent.entry(list, to)];
        }
    }

    /// Adds the record to the selection, or removes it from there.
    pub(super) fn toggle(&mut self, record: Address) {
        match self.selected.iter().position(|other| *other == record) {
            Some(at) => drop(self.selected.remove(at)),
            None => self.selected.push(record),
        }
    }
}
