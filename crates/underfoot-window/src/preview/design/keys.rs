//! The keys of Design mode.

use eframe::egui::{self, Key, Modifiers, Ui};
use glam::Vec2;

use super::{Ask, Designer, Pane, gestures};
use crate::edit::{List, Template};

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
            let at = self.pane.and_then(|pane| panes.iter().position(|other| *other == pane));
            // Start before the first pane, or behind the last.
            let at = at.unwrap_or(if back > 0 { count } else { count - 1 });
            self.pane = panes.get((at + on + back * (count - 1)) % count).copied();
            self.focus = self.pane;
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
            self.saves_in = if is_typing { 3 } else { 1 };
        }
        if self.saves_in > 0 {
            self.saves_in -= 1;
            if self.saves_in == 0 { self.save() } else { ui.ctx().request_repaint() }
        }
    }

    /// Handles all keys.
    pub(super) fn keys(&mut self, ui: &Ui) {
        self.keys_anywhere(ui);
        // A text field with the focus takes all other keys.
        if ui.ctx().text_edit_focused() {
            return;
        }
        let command = |key: Key| ui.input_mut(|i| i.consume_key(Modifiers::COMMAND, key));
        if ui.input_mut(|i| i.consume_key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z)) || command(Key::Y) {
            self.redo();
        }
        if command(Key::Z) {
            self.undo();
        }
        if command(Key::O) {
            self.ask_for(Ask::Open);
        }
        if command(Key::N) {
            let text = Template::Empty.text(&self.document.floor().geometry);
            self.begin_untitled("untitled.ron", &text);
        }
        if command(Key::D) {
            self.duplicate();
        }
        if ui.input_mut(|i| i.consume_key(Modifiers::COMMAND | Modifiers::SHIFT, Key::G)) {
            self.ungroup();
        }
        if command(Key::G) {
            self.group();
        }
        let selected = self.selected.clone();
        if command(Key::L) {
            self.turn_lock(&selected);
        }
        if command(Key::H) {
            self.turn_hidden(&selected);
        }
        if command(Key::OpenBracket) {
            self.reorder(true);
        }
        if command(Key::CloseBracket) {
            self.reorder(false);
        }
        if command(Key::A) {
            let page = self.page;
            let all = self
                .items
                .iter()
                .filter(|item| item.record.list() == Some(List::Widgets) && item.is_on(page))
                .filter(|item| !self.is_locked(&item.record) && !self.is_hidden(&item.record));
            self.selected = all.map(|item| item.record.clone()).collect();
        }
        let pressed = |key: Key| ui.input(|i| i.key_pressed(key) && !i.modifiers.command);
        if pressed(Key::Delete) || pressed(Key::Backspace) {
            self.delete();
        }
        if pressed(Key::R) {
            self.turn();
        }
        if pressed(Key::Escape) {
            self.placing = None;
            self.gesture = gestures::Gesture::None;
            self.selected.clear();
        }
        let step = ui.input(|i| match (i.modifiers.shift, i.modifiers.alt) {
            (true, _) => NUDGE_M[1],
            (_, true) => NUDGE_M[2],
            _ => NUDGE_M[0],
        });
        // A list or field with the focus uses the arrows itself.
        let is_free = ui.ctx().memory(|memory| memory.focused().is_none());
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
                    self.stroke += 1;
                }
                self.nudge(way * step);
            }
        }
        for event in ui.input(|i| i.events.clone()) {
            match event {
                egui::Event::Copy => drop(self.copy(ui.ctx())),
                egui::Event::Cut => self.cut(ui.ctx()),
                egui::Event::Paste(text) => self.paste(&text),
                _ => {}
            }
        }
    }
}
