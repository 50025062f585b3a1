//! The window's contents, from one picture to the next.

use eframe::egui;
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use eframe::egui::Ui;

use super::PreviewOptions;
use super::feed::{FootSink, PreviewCommand, PreviewInput};
use super::feet::MouseFeet;
use super::floor_view::Grip;
use super::messages::Messages;
use super::panel::Tuner;
use super::rate::Rate;
use super::scopes::Scopes;
use super::selection::Selection;
use super::style;
use super::watch::Watch;
use crate::egui_painter::Palette;
use crate::engine::Snapshot;
use crate::floor::Floor;
use crate::scene::{Scene, Theme};

/// Time between frames: 60 a second.
const PICTURE: Duration = Duration::from_nanos(16_666_667);

/// The window's contents and what they remember from one frame to the next.
pub(super) struct App {
    pub(super) floor: Arc<Floor>,
    pub(super) source: String,
    pub(super) snapshots: triple_buffer::Output<Snapshot>,
    pub(super) messages: Messages,
    pub(super) scopes: Scopes,
    pub(super) feet: Option<(MouseFeet, Box<dyn FootSink>)>,
    pub(super) grip: Grip,
    pub(super) selection: Selection,
    pub(super) watch: Watch,
    pub(super) scene: Scene,
    pub(super) palette: Palette,
    pub(super) theme: Theme,
    /// Whether sensor forces are drawn on the floor.
    pub(super) marks: bool,
    pub(super) choices: Vec<String>,
    /// `None` where there are no effects to tune.
    pub(super) tuner: Option<Tuner>,
    commands: Sender<PreviewCommand>,
    /// The window's clock, in seconds.
    pub(super) now_s: f64,
    pub(super) window_frames: Rate,
    pub(super) frames: Rate,
    frame_count: u64,
    /// When the next frame is due.
    due: Instant,
    /// Height of the side panel's other parts at the last frame, in points.
    pub(super) other_parts: f32,
}

impl App {
    pub(super) fn new(input: PreviewInput, options: &PreviewOptions) -> Self {
        Self {
            selection: Selection::new(&input.floor.geometry),
            scopes: Scopes::new(input.scopes, &input.floor),
            messages: Messages::new(input.layout, input.events, input.layouts, input.notices),
            feet: input.feet.map(|sink| (MouseFeet::new(), sink)),
            floor: input.floor,
            source: input.source,
            snapshots: input.snapshots,
            choices: input.choices,
            tuner: Tuner::new(input.effects),
            commands: input.commands,
            grip: Grip::default(),
            watch: Watch::default(),
            scene: Scene::new(),
            palette: Palette::default(),
            theme: options.theme,
            marks: true,
            now_s: 0.0,
            window_frames: Rate::default(),
            frames: Rate::default(),
            frame_count: 0,
            due: Instant::now(),
            other_parts: 0.0,
        }
    }

    /// One frame.
    pub(super) fn show(&mut self, ui: &mut Ui) {
        self.receive(ui);
        self.handle_mute_key(ui);
        self.top_bar(ui);
        self.help_bar(ui);
        self.notices(ui);
        self.side_panel(ui);
        self.tuner_panel(ui);
        self.problems(ui);
        let frame = egui::Frame::new();
        egui::CentralPanel::default().frame(frame).show(ui, |ui| self.floor_view(ui));
        self.request_next_frame(ui);
    }

    fn receive(&mut self, ui: &Ui) {
        let (now_s, elapsed_s) = ui.input(|i| (i.time, i.stable_dt));
        self.now_s = now_s;
        let fresh = self.snapshots.update();
        let snapshot = self.snapshots.output_buffer();
        self.messages.receive(now_s, snapshot.layout_revision);
        self.messages.relabel(&snapshot.labels);
        self.watch.observe(now_s, snapshot, fresh);
        self.selection.follow(snapshot);
        self.scopes.update(&self.floor, snapshot, self.selection.tile(), elapsed_s);
        self.frame_count += 1;
        self.window_frames.observe(now_s, self.frame_count);
        self.frames.observe(now_s, snapshot.counters.frames);
    }

    /// Pictures come 60 times a second, also where the display does not pace them.
    fn request_next_frame(&mut self, ui: &Ui) {
        let now = Instant::now();
        self.due = (self.due + PICTURE).max(now);
        // Never zero: that would ask for two frames.
        ui.ctx().request_repaint_after((self.due - now).max(Duration::from_micros(100)));
    }

    /// Tells the program; one that hung up does not want to know.
    pub(super) fn command(&self, command: PreviewCommand) {
        if self.commands.send(command).is_err() {
            tracing::debug!("nobody takes the window's commands any more");
        }
    }

    pub(super) fn turn_theme(&mut self, ctx: &egui::Context) {
        self.theme = if self.theme.is_dark() { Theme::LIGHT } else { Theme::DARK };
        style::apply(ctx, &self.theme);
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }

    fn clear_color(&self, _visuals: &egui::Visuals) -> [f32; 4] {
        crate::egui_painter::color(self.theme.canvas).to_normalized_gamma_f32()
    }

    fn persist_egui_memory(&self) -> bool {
        false
    }
}
