//! The keys of Design mode.

use eframe::egui::{self, Key, Modifiers, Ui};
use glam::Vec2;

use super::in_place::InPlace;
use super::menu::begin;
use super::{Ask, Designer, Pane, gestures};
use crate::edit::{Facet, RecordList, Template};

/// Distance that an arrow key moves, in metres; with Shift, and with Alt.
const NUDGE_M: [f32; 3] = [0.01, 0.05, 0.001];

impl Designer {
    /// Handles the keys that work during typing too.
    pub(super) fn keys_anywhere(&mut self, ui: &Ui) {
        // Count each press: a slow machine may get several within one frame.
        let count = |modifiers| ui.input_mut(|i| i.count_and_consume_key(modifiers, Key::F6));
        let (back, on) = (count(Modifiers::SHIFT), count(Modifiers::NONE));
        if back + on > 0 {
            let mut panes = vec![Pane::Things, Pane::Floor, Pane::Fields];
            panes.extend(self.text.is_open.then_some(Pane::Text));
            let count = panes.len();
            let at = self.panes.pane.and_then(|pane| panes.iter().position(|other| *other == pane));
            // Start before the first pane, or behind the last.
            let at = at.unwrap_or(if back > 0 { count } else { count - 1 });
            self.panes.pane = panes.get((at + on + back * (count - 1)) % count).copied();
            self.panes.focus = self.panes.pane;
            self.panes.is_led = true;
        }
        self.keys_to_save(ui);
    }

    /// Handles the keys that save, in Design and in Try.
    pub(in crate::preview) fn keys_to_save(&mut self, ui: &Ui) {
        let is_typing = ui.ctx().text_edit_focused();
        if ui.input_mut(|i| i.consume_key(Modifiers::COMMAND | Modifiers::SHIFT, Key::S)) {
            self.ask_for(Ask::SaveAs);
        }
        if ui.input_mut(|i| i.consume_key(Modifiers::COMMAND, Key::S)) {
            if let Some(id) = ui.memory(|memory| memory.focused()).filter(|_| is_typing && !self.text.is_open)
            {
                ui.memory_mut(|memory| memory.surrender_focus(id));
            }
            self.delays.saves_in = if is_typing { 3 } else { 1 };
        }
        if self.delays.saves_in > 0 {
            self.delays.saves_in -= 1;
            if self.delays.saves_in == 0 { self.save() } else { ui.ctx().request_repaint() }
        }
    }

    /// Handles all keys.
    pub(super) fn keys(&mut self, ui: &Ui) {
        self.keys_anywhere(ui);
        // A text field with the focus takes all other keys.
        if ui.ctx().text_edit_focused() || self.canvas.in_place.is_some() {
            return;
        }
        let command = |key: Key| ui.input_mut(|i| i.consume_key(Modifiers::COMMAND, key));
        if ui.input_mut(|i| i.consume_key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z)) || command(Key::Y) {
            self.edited.redo();
        }
        if command(Key::Z) {
            self.edited.undo();
        }
        if command(Key::O) {
            self.ask_to_open(ui.ctx());
        }
        if command(Key::N) {
            let text = Template::Empty.text(&self.edited.document.floor().geometry);
            self.begin_untitled("untitled.ron", &text);
        }
        if command(Key::D) {
            self.edited.duplicate();
        }
        if command(Key::E) {
            self.edited.make_alike();
        }
        if ui.input_mut(|i| i.consume_key(Modifiers::COMMAND | Modifiers::SHIFT, Key::G)) {
            self.edited.ungroup();
        }
        if command(Key::G) {
            self.edited.group();
        }
        let selected = self.edited.selected.clone();
        if command(Key::L) {
            self.edited.turn_lock(&selected);
        }
        if command(Key::H) {
            self.edited.turn_hidden(&selected);
        }
        if command(Key::OpenBracket) {
            self.edited.reorder(true);
        }
        if command(Key::CloseBracket) {
            self.edited.reorder(false);
        }
        if command(Key::A) {
            let page = self.edited.page;
            let all = self
                .edited
                .items
                .iter()
                .filter(|item| item.record.list() == Some(RecordList::Widgets) && item.is_on(page))
                .filter(|item| !self.edited.is_locked(&item.record) && !self.edited.is_hidden(&item.record));
            self.edited.selected = all.map(|item| item.record.clone()).collect();
        }
        let pressed = |key: Key| ui.input(|i| i.key_pressed(key) && !i.modifiers.command);
        if pressed(Key::Delete) || pressed(Key::Backspace) {
            self.edited.delete();
        }
        if pressed(Key::R) {
            self.edited.turn();
        }
        if pressed(Key::Escape) {
            self.canvas.placing = None;
            self.canvas.gesture = gestures::PointerGesture::None;
            self.edited.selected.clear();
        }
        // A list or field with the focus uses these keys itself.
        let is_free = ui.ctx().memory(|memory| memory.focused().is_none());
        if is_free && pressed(Key::Enter) {
            let first = self.edited.selected.first().cloned();
            let found = first.map(|record| InPlace::text_of(&self.edited, &record));
            begin(&mut self.edited, &mut self.canvas.in_place, found);
        }
        let step = ui.input(|i| match (i.modifiers.shift, i.modifiers.alt) {
            (true, _) => NUDGE_M[1],
            (_, true) => NUDGE_M[2],
            _ => NUDGE_M[0],
        });
        for (key, way) in [
            (Key::ArrowLeft, Vec2::NEG_X),
            (Key::ArrowRight, Vec2::X),
            (Key::ArrowDown, Vec2::NEG_Y),
            (Key::ArrowUp, Vec2::Y),
        ] {
            if (is_free || ui.input(|i| i.modifiers.command)) && ui.input(|i| i.key_pressed(key)) {
                if !ui.input(|i| {
                    i.events.iter().any(|event| matches!(event, egui::Event::Key { repeat: true, .. }))
                }) {
                    self.edited.stroke += 1;
                }
                self.edited.nudge(way * step);
            }
        }
        for event in ui.input(|i| i.events.clone()) {
            match event {
                egui::Event::Copy => drop(self.edited.copy(ui.ctx())),
                egui::Event::Cut => self.edited.cut(ui.ctx()),
                egui::Event::Paste(text) => self.paste(ui, &text),
                _ => {}
            }
        }
    }

    /// Pastes the text of the clipboard, or the appearance or the feel of the control in it: as the menu asked, or as
    /// the keys tell.
    fn paste(&mut self, ui: &Ui, text: &str) {
        /// Frames in which the text may come that the menu asked for.
        const SOON: u64 = 20;
        let now = ui.ctx().cumulative_pass_nr();
        let asked = self.edited.pasting.take().filter(|(_, since)| now <= since + SOON);
        let by_keys = ui.input(|i| match i.modifiers {
            Modifiers { alt: true, .. } => Some(Facet::Appearance),
            Modifiers { shift: true, .. } => Some(Facet::Feel),
            _ => None,
        });
        match asked.map_or(by_keys, |(facet, _)| facet) {
            Some(facet) => self.edited.paste_facet(facet, text),
            None => self.edited.paste(text),
        }
    }
}
