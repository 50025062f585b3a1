//! The window's contents and their state from one frame to the next.

use std::time::Duration;

use eframe::egui::{self, CentralPanel, Frame, Margin, Panel, ScrollArea, Ui};

use super::parts::Wish;
use super::run::{SetupChannels, SetupOptions};
use super::shape_choice::ShapeChoice;
use crate::preview::appearance::Appearance;
use crate::preview::style::panel_frame;
use crate::setup::{SetupOrder, SetupStep, SetupView};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Time between two frames: the steps go on without the window.
const FRAME: Duration = Duration::from_millis(33);

/// Width of the steps at the left and of the page at the right, in points.
const STEPS: f32 = 216.0;
const PAGE: f32 = 372.0;

/// The window's contents.
pub(super) struct SetupApp {
    channels: SetupChannels,
    pub(super) options: SetupOptions,
    appearance: Appearance,
    /// The step on display.
    pub(super) step: SetupStep,
    pub(super) shape: ShapeChoice,
    /// Weight of the person as typed, in kilograms.
    pub(super) weight: String,
    /// Orders that the steps could not take yet.
    unsent: Vec<SetupOrder>,
}

impl SetupApp {
    pub(super) fn new(channels: SetupChannels, options: SetupOptions) -> Self {
        let (appearance, _) = Appearance::new(Theme::LIGHT, options.settings.clone());
        Self {
            channels,
            options,
            appearance,
            step: SetupStep::Boards,
            shape: ShapeChoice::default(),
            weight: String::new(),
            unsent: vec![SetupOrder::Go(SetupStep::Boards)],
        }
    }

    pub(super) fn theme(&self) -> Theme {
        self.appearance.theme()
    }

    /// Draws one frame.
    pub(super) fn show(&mut self, ui: &mut Ui) {
        self.send();
        self.appearance.enlarge(ui.ctx());
        let theme = self.theme();
        let view = self.channels.views.read().clone();
        self.shape.follow(&view);
        let mut wishes = Vec::new();
        let frame = panel_frame(&theme, Margin { left: 14, right: 14, top: 14, bottom: 12 });
        Panel::left("steps").frame(frame).resizable(false).exact_size(STEPS).show(ui, |ui| {
            self.steps_bar(ui, &theme, &view, &mut wishes);
        });
        let frame = panel_frame(&theme, Margin { left: 18, right: 14, top: 14, bottom: 12 });
        Panel::right("page").frame(frame).resizable(false).exact_size(PAGE).show(ui, |ui| {
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                self.page(ui, &theme, &view, &mut wishes);
            });
        });
        let frame = Frame::new().fill(color(theme.canvas)).inner_margin(Margin::same(16));
        CentralPanel::default().frame(frame).show(ui, |ui| self.stage(ui, &theme, &view));
        for wish in wishes {
            self.fulfil(wish, &view);
        }
        ui.ctx().request_repaint_after(FRAME);
    }

    /// The page of the present step.
    fn page(&mut self, ui: &mut Ui, theme: &Theme, view: &SetupView, wishes: &mut Vec<Wish>) {
        match self.step {
            SetupStep::Boards => self.boards_page(ui, theme, view, wishes),
            SetupStep::Shape => self.shape_page(ui, theme, view, wishes),
            SetupStep::Wiring => self.wiring_page(ui, theme, view, wishes),
            SetupStep::Readings => self.readings_page(ui, theme, view, wishes),
            SetupStep::Standing => self.standing_page(ui, theme, view, wishes),
            SetupStep::Layout => self.layout_page(ui, theme, view, wishes),
        }
    }

    /// Does what the user asks for.
    fn fulfil(&mut self, wish: Wish, view: &SetupView) {
        match wish {
            Wish::Order(order) => self.unsent.push(order),
            Wish::Step(step) => {
                self.step = step;
                self.unsent.push(SetupOrder::Go(step));
            }
            Wish::WriteShape => {
                let shape = self.shape.shape();
                self.unsent.push(SetupOrder::WriteFloor(shape));
            }
            Wish::Stand(tiles) => {
                // Some keyboards write a comma.
                let weight_kg = self.weight.trim().replace(',', ".").parse();
                let weight_kg = weight_kg.unwrap_or(f64::NAN);
                let tiles = tiles
                    .into_iter()
                    .filter(|tile| view.floor.as_ref().is_some_and(|floor| floor.geometry.has(*tile)));
                self.unsent.push(SetupOrder::Stand { weight_kg, tiles: tiles.collect() });
            }
        }
        self.send();
    }

    /// Sends orders in their order; those without room wait for the next frame.
    fn send(&mut self) {
        while let Some(order) = self.unsent.first() {
            if self.channels.orders.try_send(order.clone()).is_err() {
                break;
            }
            self.unsent.remove(0);
        }
    }
}

impl eframe::App for SetupApp {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        let ctx = ui.ctx();
        let ground = color(self.theme().canvas);
        ctx.layer_painter(egui::LayerId::background()).rect_filled(ctx.viewport_rect(), 0.0, ground);
        self.show(ui);
    }

    fn clear_color(&self, _visuals: &egui::Visuals) -> [f32; 4] {
        color(self.theme().canvas).to_normalized_gamma_f32()
    }

    fn persist_egui_memory(&self) -> bool {
        false
    }
}
