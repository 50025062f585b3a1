//! The top bar: the switch of the modes, the tools of the present mode, appearance, help, and the state of the link.

use eframe::egui;
use eframe::egui::{Align, Layout, Margin, Panel, RichText, Ui, vec2};

use super::hand::hand_bar;
use super::help::help_menu;
use super::pills::{link_state, mutes};
use crate::preview::app::App;
use crate::preview::closing::file_name;
use crate::preview::feed::PreviewCommand;
use crate::preview::gallery::LayoutGallery;
use crate::preview::style::{panel_frame, quiet};
use crate::preview::visit::VisitBar;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::{Theme, in_drawn_order};

/// Width of the window below which the tools of the mode get a line of their own, in points.
const TWO_LINES: f32 = 1200.0;

/// Width of the window below which the right end of the bar has icons without words, in points.
const COMPACT: f32 = 760.0;

/// Height of one line of the bar, in points: constant, so that the floor keeps its place.
const LINE: f32 = 27.0;

/// Width of the title or the name of the file, in points: constant, so that the tools keep their places.
const TITLE: f32 = 150.0;

/// Width of the name of the file beside the title, in points.
const FILE: f32 = 88.0;

/// The gallery of layouts, whether the warnings are listed, and the width of the bar's right end.
#[derive(Default)]
pub(in crate::preview) struct TopBar {
    pub(in crate::preview) gallery: LayoutGallery,
    /// Whether the warnings about the layout are listed over the floor.
    pub(in crate::preview) lists_warnings: bool,
    /// Width of the part at the right in the last frame, in points.
    pub(super) end_width: f32,
    tools: ToolsWidth,
}

/// The width of the tools of Try with their words, which decides whether they keep them.
#[derive(Default)]
struct ToolsWidth {
    /// The width when they were last written out, in points; 0 before that.
    full: f32,
    /// The states that add a button or lengthen a text.
    of: [bool; 3],
}

impl ToolsWidth {
    /// Whether the tools lose their words in a bar with this room, in points.
    fn is_compact(&mut self, room: f32, of: [bool; 3]) -> bool {
        if self.of != of {
            *self = Self { full: 0.0, of };
        }
        self.full > room
    }
}

impl TopBar {
    /// A bar with these names of layouts to open; `begins_with_gallery` opens the gallery at once.
    pub(in crate::preview) fn new(choices: Vec<String>, begins_with_gallery: bool) -> Self {
        let mut gallery = LayoutGallery::new(choices);
        if begins_with_gallery {
            gallery.open();
        }
        Self { gallery, ..Self::default() }
    }

    /// Shows the layout's title, as a button of this width that opens the gallery if there is a choice.
    pub(super) fn title(&mut self, ui: &mut Ui, theme: &Theme, title: &str, width: f32) {
        let title = in_drawn_order(title);
        if self.gallery.is_empty() {
            let text = RichText::new(title).size(15.0).strong().color(color(theme.ink));
            ui.add(egui::Label::new(text).truncate());
        } else {
            self.gallery.button(ui, &title, width);
        }
    }
}

impl App {
    /// Shows the gallery while it is open, and opens the layout that the user chooses there.
    pub(in crate::preview) fn show_gallery(&mut self, ui: &Ui) {
        let (theme, geometry) = (self.appearance.theme(), &self.shown.floor.geometry);
        let gallery = &mut self.top_bar.gallery;
        let Some(index) = gallery.show(ui, &theme, geometry) else { return };
        // In Design mode the floor follows the drawing board.
        if !self.is_designing() {
            self.shown.command(PreviewCommand::Open(index));
        }
        if let (Some(designer), Some(name)) = (&mut self.designer, self.top_bar.gallery.name(index)) {
            designer.open_choice(name);
        }
    }

    /// Shows the bar; widgets come from left to right, which is the order of the keyboard too.
    pub(in crate::preview) fn show_top_bar(&mut self, ui: &mut Ui) {
        let theme = self.appearance.theme();
        if self.window.hold.is_in_hand() {
            return hand_bar(self, ui, &theme);
        }
        let frame = panel_frame(&theme, Margin::symmetric(14, 6));
        Panel::top("top bar").frame(frame).resizable(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.x = 6.0;
            let has_two_lines = ui.available_width() < TWO_LINES;
            let is_compact = ui.available_width() < COMPACT;
            line(ui, |ui| {
                self.mode_switch(ui, false);
                ui.add_space(4.0);
                self.heading(ui, &theme, is_compact);
                if !has_two_lines {
                    ui.add_space(4.0);
                    let room = ui.available_width() - self.top_bar.end_width - ui.spacing().item_spacing.x;
                    self.tools(ui, &theme, room);
                }
                self.end(ui, &theme, is_compact);
            });
            if has_two_lines {
                line(ui, |ui| {
                    let room = ui.available_width();
                    self.tools(ui, &theme, room);
                });
            }
        });
    }

    /// The tools of the present mode, in a part of the bar that is `room` points wide.
    fn tools(&mut self, ui: &mut Ui, theme: &Theme, room: f32) {
        match &mut self.designer {
            Some(designer) if designer.is_open => {
                designer.tools(ui, theme, &mut self.top_bar.gallery);
                designer.put_button(ui, &self.shown);
                self.share_button(ui, true);
                self.panel.button(ui, true, true);
            }
            _ => {
                let [records, kept] = self.visit.as_ref().map_or([false; 2], VisitBar::shows);
                let warns = self.shown.messages.warnings.count > 0;
                let is_compact = self.top_bar.tools.is_compact(room, [records, kept, warns]);
                let left = ui.cursor().left();
                self.try_tools(ui, theme, is_compact);
                let full = ui.min_rect().right() - left;
                if !is_compact && (full - self.top_bar.tools.full).abs() > 0.5 {
                    self.top_bar.tools.full = full;
                    ui.ctx().request_repaint();
                }
            }
        }
    }

    /// The title of the layout and its file, or in Design mode the file alone; a compact bar has no room for both.
    fn heading(&mut self, ui: &mut Ui, theme: &Theme, is_compact: bool) {
        ui.allocate_ui_with_layout(vec2(TITLE, LINE), Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_size(vec2(TITLE, LINE));
            ui.set_max_width(TITLE);
            if let Some(designer) = self.designer.as_ref().filter(|designer| designer.is_open) {
                return file_name(ui, theme, designer);
            }
            self.top_bar.title(ui, theme, &self.shown.layout().title, TITLE);
        });
        if self.is_designing() || is_compact {
            return;
        }
        ui.allocate_ui_with_layout(vec2(FILE, LINE), Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_size(vec2(FILE, LINE));
            ui.set_max_width(FILE);
            if let Some(designer) = &self.designer {
                file_name(ui, theme, designer);
            } else if let Some(file) = &self.shown.messages.file {
                ui.add(egui::Label::new(quiet(theme, &file.name)).truncate());
            }
        });
    }

    /// The part at the right: the states of the floor, appearance and help.
    fn end(&mut self, ui: &mut Ui, theme: &Theme, is_compact: bool) {
        // The widgets come from left to right, so their place follows from their width in the last frame.
        let room = ui.available_width() - self.top_bar.end_width - ui.spacing().item_spacing.x;
        if room > 0.0 {
            ui.add_space(room);
        }
        let left = ui.cursor().left();
        mutes(ui, theme, &self.shown, self.rehearsal.as_ref());
        self.appearance.menu(ui, is_compact, &mut self.shown.messages);
        let activity = self.activity();
        let set_up = self.window.options.set_up;
        help_menu(ui, theme, activity, is_compact, &mut self.appearance, set_up, &mut self.shown.messages);
        link_state(ui, theme, &self.shown, self.time_line.is_some());
        let width = ui.min_rect().right() - left;
        if (width - self.top_bar.end_width).abs() > 0.5 {
            self.top_bar.end_width = width;
            ui.ctx().request_repaint();
        }
    }
}

/// One line of the bar, of constant height.
fn line(ui: &mut Ui, add: impl FnOnce(&mut Ui)) {
    let size = vec2(ui.available_width(), LINE);
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_height(LINE);
        ui.set_max_height(LINE);
        add(ui);
    });
}
