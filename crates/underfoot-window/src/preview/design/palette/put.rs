//! Puts new records on the floor.

use glam::Vec2;

use super::super::edited::EditedLayout;
use super::in_hand::InHand;
use super::thing::PaletteThing;
use crate::edit::{Address, Edit, RecordList, free_row};
use underfoot::floor::Rect;
use underfoot_format::text::RonText;

impl EditedLayout {
    /// Puts `thing` on `area`, in floor metres, with this `label` in place of the usual one; returns whether the layout
    /// accepts it. Things of the same stroke are one step of undo.
    pub(in crate::preview::design) fn put(
        &mut self,
        thing: &PaletteThing,
        area: Rect,
        label: Option<&str>,
    ) -> bool {
        let on_page = |list| {
            let page = self.layout().pages.get(self.page).map(|_| Address::of(RecordList::Pages, self.page));
            page.unwrap_or(Address::LAYOUT).entry(list, usize::MAX)
        };
        let place = self.document.placed(area);
        let (at, text) = match thing {
            PaletteThing::Control(kind) => {
                (on_page(RecordList::Widgets), self.document.new_control(kind, area, label))
            }
            PaletteThing::Ground(name) => {
                (on_page(RecordList::Grounds), RonText::Variant(name, place.into()).inline())
            }
            PaletteThing::Stance => {
                let [at, size] = place;
                let fields = vec![at, size, ("label", RonText::quoted(label.unwrap_or("Stand here")))];
                (
                    Address::LAYOUT.entry(RecordList::Stances, usize::MAX),
                    RonText::Record("Stance", fields).inline(),
                )
            }
            PaletteThing::Region => {
                let [at, size] = place;
                let fields = vec![("id", RonText::quoted(self.document.free_id("region", &[]))), at, size];
                (
                    Address::LAYOUT.entry(RecordList::Regions, usize::MAX),
                    RonText::Record("Region", fields).inline(),
                )
            }
        };
        let done = self.edit_in(&[Edit::Insert { at: at.clone(), text }], Some(self.stroke));
        if done {
            self.refresh();
            let list = at.split().map(|(parent, list, _)| (parent, list));
            let is_in = |address: &Address| address.split().map(|(parent, list, _)| (parent, list)) == list;
            let last =
                self.items.iter().map(|item| &item.record).filter(|record| is_in(record)).max().cloned();
            self.selected = last.into_iter().collect();
        }
        done
    }

    /// Puts down all that the user asked for, where there is room, and selects it; stops at the first thing without
    /// room, which the message names.
    pub(super) fn put_all(&mut self, hands: Vec<InHand>) {
        self.stroke += 1;
        let mut selected = Vec::new();
        for hand in hands {
            let size = hand.thing.size(&self.document.floor().geometry);
            let row = match hand.thing {
                PaletteThing::Control(_) => free_row(&self.document, self.page, size, hand.left()),
                _ => None,
            };
            let mut places = row.unwrap_or_default().into_iter();
            let mut hand = Some(hand);
            while let Some(next) = hand {
                let is_put = match places.next() {
                    Some(area) => self.put(&next.thing, area, next.label()),
                    None => self.put_somewhere(&next.thing, next.label()),
                };
                if !is_put {
                    self.selected.append(&mut selected);
                    return;
                }
                selected.append(&mut self.selected);
                hand = next.next(false);
            }
        }
        self.selected = selected;
    }

    /// Puts `thing` at the first place of a grid of half tiles that the reader accepts; returns whether there is one.
    fn put_somewhere(&mut self, thing: &PaletteThing, label: Option<&str>) -> bool {
        let geometry = self.document.floor().geometry;
        let size = thing.size(&geometry);
        let step = 0.5 * geometry.pitch_m();
        let within = match thing {
            PaletteThing::Control(_) => {
                self.layout().regions.first().map_or(geometry.bounds(), |region| region.area)
            }
            _ => geometry.bounds(),
        };
        let steps = ((within.size() - size) / step).max(Vec2::ZERO).floor();
        for row in 0..=steps.y as u32 {
            for column in 0..=steps.x as u32 {
                let at = within.min + Vec2::new(column as f32, row as f32) * step + 0.2 * step;
                let area = Rect::from_min_size(at.min(within.max - size), size);
                // Half a shoe of room (rule U102), where possible.
                let wide = area.grown(0.06);
                let is_taken = |item: &crate::edit::Item| {
                    item.record.list() == Some(RecordList::Widgets)
                        && item.is_on(self.page)
                        && item.area.overlaps(wide)
                };
                if matches!(thing, PaletteThing::Control(_)) && self.items.iter().any(is_taken) {
                    continue;
                }
                if self.put(thing, area, label) {
                    return true;
                }
            }
        }
        if self.message.is_none() {
            self.complain("there is no room left");
        }
        false
    }

    pub(super) fn add_page(&mut self) {
        let id = RonText::quoted(self.document.free_id("page_1", &[]));
        let page = RonText::Record("Page", vec![("id", id), ("widgets", RonText::List(Vec::new()))]);
        let at = Address::of(RecordList::Pages, usize::MAX);
        if self.edit(&[Edit::Insert { at, text: page.inline() }]) {
            self.refresh();
            self.page = self.layout().pages.len().saturating_sub(1);
            self.selected = vec![Address::of(RecordList::Pages, self.page)];
        }
    }
}
