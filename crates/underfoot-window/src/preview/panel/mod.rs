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
pub(in crate::preview) use presses::handle_undo_key;
pub(in crate::preview) use tuner::Tuner;

use eframe::egui::{Margin, Panel, ScrollArea, Ui};

use super::app::App;
use super::handheld::{PanelSheet, panel_at};
use super::icons::Icon;
use super::stage::BESIDE;
use super::style::{panel_frame, switch_button};

/// Minimum height of the list of events, in points.
const EVENTS: f32 = 190.0;

/// The state of the side panel.
#[derive(Default)]
pub(super) struct SidePanel {
    /// Whether the user has opened or closed it; `None` while the window's width decides.
    pub(super) wanted: Option<bool>,
    /// Whether it stays closed unless the user opens it, as in a window in a hand.
    pub(super) is_folded: bool,
    /// The text that lines of the list of events must contain; empty for all.
    search: String,
    /// Height of its parts other than the list of events at the last frame, in points.
    other_parts: f32,
}

impl SidePanel {
    /// Whether a window of this width, in points, shows the panel at the right: in Try, a window too narrow for panel
    /// and floor shows it only on request.
    pub(super) fn is_shown(&self, width: f32, designs: bool) -> bool {
        self.wanted.unwrap_or(!self.is_folded && (designs || width >= BESIDE))
    }

    /// A button that opens or closes the panel at the right; a compact one has an icon alone.
    pub(super) fn button(&mut self, ui: &mut Ui, designs: bool, is_compact: bool) {
        let shown = self.is_shown(ui.ctx().content_rect().width(), designs);
        let hint = if designs {
            "The fields of what is selected, at the side"
        } else {
            "Figures, events and actuators at the side"
        };
        if switch_button(ui, shown, Icon::PanelRight, "Panel", is_compact, hint) {
            self.wanted = Some(!shown);
        }
    }
}

impl App {
    /// Shows the side panel, unless it is closed.
    pub(super) fn show_side_panel(&mut self, ui: &mut Ui, sheet: Option<PanelSheet>) {
        if !self.panel.is_shown(ui.ctx().content_rect().width(), false) {
            return;
        }
        let theme = self.appearance.theme();
        let frame = panel_frame(&theme, Margin { left: 14, right: 6, top: 0, bottom: 6 });
        let half = 0.5 * ui.available_width();
        let panel = panel_at(sheet, || {
            let panel = Panel::right("side panel").resizable(true).default_size(304.0);
            panel.size_range(264.0_f32.min(half)..=440.0_f32.min(half))
        });
        panel.frame(frame).show(ui, |ui| {
            let height = ui.available_height().max(0.0);
            // The list gets the height that the other parts left free in the last frame, and stays in view.
            let events = match sheet {
                // A low panel scrolls as a whole.
                Some(_) => 0.0,
                None => (height - self.panel.other_parts).clamp(EVENTS.min(0.5 * height), 0.6 * height),
            };
            let area = ScrollArea::vertical().max_height(height - events);
            area.auto_shrink(false).show(ui, |ui| {
                // The scroll bar needs space beside the figures.
                ui.set_width(ui.available_width() - 8.0);
                let top = ui.cursor().top();
                // Lines carry neither forces nor sensors, and accept no requests.
                let is_told = self.shown.is_told_by_lines();
                let server = self.shown.server.as_ref();
                areas::areas_part(ui, &theme, server.map_or(&[], |server| &server.areas));
                if !is_told {
                    self.show_foot_parts(ui);
                }
                contacts::contacts_part(ui, &theme, self.shown.snapshot());
                scopes::scopes_part(ui, &theme, &mut self.shown);
                if !is_told {
                    self.show_floor_parts(ui);
                }
                self.panel.other_parts = ui.cursor().top() - top;
                if sheet.is_some() {
                    events::events_part(ui, &theme, &self.shown.messages, &mut self.panel.search, EVENTS);
                }
            });
            if sheet.is_some() {
                return;
            }
            let left = ui.available_height();
            ui.set_width(ui.available_width() - 8.0);
            events::events_part(ui, &theme, &self.shown.messages, &mut self.panel.search, left);
        });
    }

    /// The parts about the tile, the presses of the control, and the walks.
    fn show_foot_parts(&mut self, ui: &mut Ui) {
        let (theme, shown, selection) = (self.appearance.theme(), &self.shown, &mut self.selection);
        tile::tile_part(ui, &theme, shown, selection, &mut self.plots);
        let designer = self.designer.as_mut();
        presses::presses_part(ui, &theme, shown, selection, &mut self.presses, &mut self.plots, designer);
        if let Some(walks) = &mut self.walks {
            people::people_part(ui, &theme, walks, &shown.layout().title);
        }
    }

    /// The parts about controls, faults, grounds, sensors, sound card and link.
    fn show_floor_parts(&mut self, ui: &mut Ui) {
        let (theme, shown) = (self.appearance.theme(), &self.shown);
        // A recording cannot change.
        if self.time_line.is_none() {
            controls::controls_part(ui, &theme, shown);
        }
        if let Some(rehearsal) = &mut self.rehearsal {
            let geometry = &self.shown.floor.geometry;
            faults::faults_part(ui, &theme, rehearsal, geometry, self.selection.tile());
        }
        let snapshot = shown.snapshot();
        grounds::grounds_part(ui, &theme, shown.layout(), snapshot);
        link::health_part(ui, &theme, snapshot);
        if let Some(check) = &mut self.floor_check {
            check.button(ui, shown);
        }
        link::device_part(ui, &theme, snapshot);
        link::link_part(ui, &theme, snapshot);
    }
}
