//! The side panel: one file for each of its parts.

mod areas;
mod contacts;
mod controls;
mod events;
mod faults;
mod grounds;
mod link;
mod people;
mod presses;
mod scopes;
mod tile;
mod tuner;

pub(in crate::preview) use link::grouped;
pub(in crate::preview) use tuner::Tuner;

use eframe::egui::{Margin, Panel, ScrollArea, Ui};

use super::app::App;
use super::feed::ServerState;
use super::style::panel_frame;

/// Minimum height of the list of events, in points.
const EVENTS: f32 = 150.0;

impl App {
    /// Whether a window of this width, in points, shows the panel: a window too narrow for panel and floor shows it
    /// only on request.
    pub(in crate::preview) fn shows_panel(&self, width: f32) -> bool {
        self.panel_wanted.unwrap_or(width >= 2.2 * 304.0)
    }

    pub(super) fn side_panel(&mut self, ui: &mut Ui) {
        if !self.shows_panel(ui.ctx().content_rect().width()) {
            return;
        }
        let frame = panel_frame(&self.theme, Margin { left: 14, right: 6, top: 0, bottom: 6 });
        let panel = Panel::right("side panel").frame(frame).resizable(true);
        panel.default_size(304.0).size_range(264.0..=440.0).show(ui, |ui| {
            let height = ui.available_height();
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                // The scroll bar needs space beside the figures.
                ui.set_width(ui.available_width() - 8.0);
                let top = ui.cursor().top();
                // Lines carry neither forces nor sensors, and accept no requests.
                let is_told = self.server.as_ref().is_some_and(ServerState::tells_by_lines);
                self.areas_part(ui);
                if !is_told {
                    self.tile_part(ui);
                    self.presses_part(ui);
                    self.people_part(ui);
                }
                self.contacts_part(ui);
                // The list gets the height that the other parts left free in the last frame.
                let events = (height - self.other_parts).max(EVENTS);
                self.events_part(ui, events);
                self.scopes_part(ui);
                if !is_told {
                    self.controls_part(ui);
                    self.faults_part(ui);
                    self.grounds_part(ui);
                    self.health_part(ui);
                    self.check_button(ui);
                    self.device_part(ui);
                    self.link_part(ui);
                }
                self.other_parts = ui.cursor().top() - top - events;
            });
        });
    }
}
