//! The window's contents, frame by frame.

use eframe::egui;
use std::sync::Arc;
use std::sync::mpsc::SyncSender;
use std::time::{Duration, Instant};

use eframe::egui::Ui;

use super::PreviewOptions;
use super::appearance::Appearance;
use super::bars::TELL_S;
use super::closing::Closing;
use super::design::Designer;
use super::feed::{FootSink, PreviewCommand, PreviewInput, ServerFeed, ServerState, ShoeFeed};
use super::feet::MouseFeet;
use super::floor_check::FloorCheck;
use super::floor_view::Grip;
use super::keyboard::Keyboard;
use super::messages::Messages;
use super::panel::Tuner;
use super::plots::Plots;
use super::presses::Presses;
use super::projection::Projection;
use super::rate::Rate;
use super::rehearsal::Rehearsal;
use super::scopes::Scopes;
use super::selection::Selection;
use super::status::Latency;
use super::time_line::TimeLine;
use super::trails::Trails;
use super::turns::Turns;
use super::walks::Walks;
use super::watch::Watch;
use super::zoom::Zoom;
use underfoot::engine::Snapshot;
use underfoot::floor::Floor;
use underfoot_scene::egui_painter::Palette;
use underfoot_scene::scene::{self, Scene, Shoe, Show, Theme};

/// Time between frames: 60 a second.
const PICTURE: Duration = Duration::from_nanos(16_666_667);

/// Time between frames while only the lines of plots move.
const PLOT: Duration = Duration::from_millis(50);

/// The window's contents and their state from one frame to the next.
pub(super) struct App {
    pub(super) floor: Arc<Floor>,
    pub(super) source: String,
    /// `None` unless the floor belongs to a server.
    pub(super) server_feed: Option<ServerFeed>,
    /// The state of the server in this frame.
    pub(super) server: Option<ServerState>,
    pub(super) snapshots: triple_buffer::Output<Snapshot>,
    pub(super) messages: Messages,
    pub(super) scopes: Scopes,
    pub(super) feet: Option<(MouseFeet, Box<dyn FootSink>)>,
    /// The feet on the floor, as the floor reports them.
    pub(super) shoe_feed: Option<ShoeFeed>,
    pub(super) shoes: Vec<Shoe>,
    pub(super) grip: Grip,
    pub(super) zoom: Zoom,
    /// `None` unless a recording is on display.
    pub(super) time_line: Option<TimeLine>,
    pub(super) keyboard: Keyboard,
    pub(super) selection: Selection,
    pub(super) presses: Presses,
    pub(super) plots: Plots,
    pub(super) watch: Watch,
    pub(super) scene: Scene,
    pub(super) palette: Palette,
    pub(super) theme: Theme,
    /// The layers over the floor.
    pub(super) show: Show,
    pub(super) trails: Trails,
    /// `None` unless the floor is simulated.
    pub(super) rehearsal: Option<Rehearsal>,
    /// `None` where people cannot be sent onto the floor.
    pub(super) walks: Option<Walks>,
    pub(super) choices: Vec<String>,
    /// `None` without effects to tune.
    pub(super) tuner: Option<Tuner>,
    pub(super) projection: Projection,
    /// Whether the user has opened or closed the side panel; `None` while the window's width decides.
    pub(super) panel_wanted: Option<bool>,
    pub(super) lists_warnings: bool,
    /// The text that lines of the list of events must contain; empty for all.
    pub(super) wanted_events: String,
    pub(super) appearance: Appearance,
    /// `None` where the floor cannot be checked.
    pub(super) floor_check: Option<FloorCheck>,
    /// `None` where the layout cannot be edited.
    pub(super) designer: Option<Designer>,
    pub(super) closing: Closing,
    /// The program's name in the window's title, and the title that the window has.
    pub(super) name: String,
    pub(super) titled: Option<String>,
    commands: SyncSender<PreviewCommand>,
    /// The window's clock, in seconds.
    pub(super) now_s: f64,
    pub(super) window_frames: Rate,
    pub(super) frames: Rate,
    pub(super) packets: Rate,
    pub(super) latency: Latency,
    frame_count: u64,
    /// Time of the next frame.
    due: Instant,
    /// Height of the side panel's other parts at the last frame, in points.
    pub(super) other_parts: f32,
    turns: Turns,
}

impl App {
    pub(super) fn new(input: PreviewInput, options: &PreviewOptions) -> Self {
        let (projection, wrong) = Projection::new(&options.projection);
        let mut messages = Messages::new(input.layout, input.events, input.layouts, input.notices);
        messages.warnings = input.warnings;
        let (appearance, unread) = Appearance::new(options.theme, options.settings.clone());
        wrong.into_iter().chain(unread).for_each(|wrong| messages.note(wrong));
        Self {
            projection,
            panel_wanted: None,
            lists_warnings: false,
            wanted_events: String::new(),
            theme: appearance.theme(),
            appearance,
            selection: Selection::new(&input.floor.geometry),
            presses: if input.playback.is_some() { Presses::recorded() } else { Presses::default() },
            plots: Plots::default(),
            scopes: Scopes::new(input.scopes, &input.floor),
            messages,
            designer: input.design.and_then(|design| Designer::new(design, &input.floor)),
            feet: input.feet.map(|sink| (MouseFeet::new(), sink)),
            shoe_feed: input.shoes,
            shoes: Vec::new(),
            rehearsal: input.faults.map(|switch| Rehearsal::new(switch, &input.floor)),
            walks: input.people.map(Walks::new),
            floor: input.floor,
            source: input.source,
            server_feed: input.server,
            server: None,
            snapshots: input.snapshots,
            choices: input.choices,
            floor_check: input.packets.map(FloorCheck::new),
            tuner: Tuner::new(input.effects),
            closing: Closing::default(),
            name: options.title.clone(),
            titled: None,
            commands: input.commands,
            grip: Grip::default(),
            zoom: Zoom::default(),
            time_line: input.playback.map(TimeLine::new),
            keyboard: Keyboard::default(),
            watch: Watch::default(),
            scene: Scene::new(),
            palette: Palette::default(),
            show: Show::WINDOW,
            trails: Trails::default(),
            now_s: 0.0,
            window_frames: Rate::default(),
            frames: Rate::default(),
            packets: Rate::default(),
            latency: Latency::new(input.latency),
            frame_count: 0,
            due: Instant::now(),
            other_parts: 0.0,
            turns: Turns::default(),
        }
    }

    /// Whether Design mode is open.
    pub(super) fn is_designing(&self) -> bool {
        self.designer.as_ref().is_some_and(|designer| designer.is_open)
    }

    /// Draws one frame.
    pub(super) fn show(&mut self, ui: &mut Ui) {
        self.receive(ui);
        self.follow_check(ui);
        self.handle_text_keys(ui);
        self.appearance.enlarge(ui.ctx());
        self.handle_file_keys(ui);
        self.handle_mute_key(ui);
        self.handle_mode_key(ui);
        self.show_title(ui.ctx());
        self.ask_before_closing(ui.ctx());
        self.handle_undo_key(ui);
        self.handle_plots_key(ui);
        self.handle_walk_key(ui);
        self.top_bar(ui);
        self.status_bar(ui);
        self.help_bar(ui);
        self.time_line(ui);
        self.notices(ui);
        if self.is_designing() {
            self.design(ui);
            return self.request_next_frame(ui);
        }
        self.ask_for_path(ui);
        if self.is_checking() {
            self.check_panel(ui);
        } else {
            self.side_panel(ui);
        }
        self.tuner_panel(ui);
        self.problems(ui);
        self.warnings(ui);
        self.plots_panel(ui);
        let frame = egui::Frame::new();
        egui::CentralPanel::default().frame(frame).show(ui, |ui| self.floor_view(ui));
        self.projection_window(ui);
        self.request_next_frame(ui);
    }

    fn receive(&mut self, ui: &Ui) {
        let (now_s, elapsed_s) = ui.input(|i| (i.time, i.stable_dt));
        self.now_s = now_s;
        self.server = self.server_feed.as_mut().map(|feed| feed());
        let fresh = self.snapshots.update();
        let snapshot = self.snapshots.output_buffer();
        self.messages.receive(now_s, snapshot.layout_revision);
        self.messages.relabel(&snapshot.labels);
        self.messages.note_grounds(snapshot);
        self.messages.note_ignored(self.presses.update(snapshot));
        if let Some(feed) = &mut self.shoe_feed {
            feed(&mut self.shoes);
        }
        self.watch.observe(now_s, snapshot, fresh);
        self.trails.update(now_s, snapshot);
        self.plots.note(now_s, snapshot, &self.messages.layout);
        self.selection.follow(snapshot);
        self.selection.follow_press(self.presses.latest());
        self.scopes.update(&self.floor, snapshot, self.selection.tile(), elapsed_s);
        self.frame_count += 1;
        self.window_frames.observe(now_s, self.frame_count);
        self.frames.observe(now_s, snapshot.counters.frames);
        self.packets.observe(now_s, snapshot.counters.packets);
    }

    /// Draws 60 times a second while something moves without messages about it, also where the display does not pace
    /// frames; otherwise the next frame comes with news from the floor ([`super::lookout`]) or with input.
    fn request_next_frame(&mut self, ui: &Ui) {
        let now = Instant::now();
        self.due = (self.due + PICTURE).max(now);
        if self.shows_for_a_while() {
            ui.ctx().request_repaint_after(Duration::from_millis(500));
        }
        let selected = self.selection.control_of(&self.messages.layout).map(|widget| &widget.id);
        if self.plots.are_moving(self.now_s, &self.floor.geometry, selected) {
            ui.ctx().request_repaint_after(PLOT);
        }
        let is_held = ui.input(|i| i.pointer.any_down() || !i.keys_down.is_empty());
        let fades = self.show.trails && !self.trails.all().is_empty();
        if is_held || fades || self.scopes.are_moving() {
            // A delay of zero would request two frames.
            ui.ctx().request_repaint_after((self.due - now).max(Duration::from_micros(100)));
        }
    }

    /// Whether the screen shows a message that disappears after a while.
    fn shows_for_a_while(&self) -> bool {
        let snapshot = self.snapshots.output_buffer();
        let ignored = snapshot.ignored.last();
        ignored.is_some_and(|press| snapshot.at.since(press.at) < 2 * scene::TOLD)
            || self.messages.file.as_ref().is_some_and(|file| self.now_s - file.at_s < 2.0 * TELL_S)
    }

    /// Sends a command to the program; drops it if the program has hung up.
    pub(super) fn command(&self, command: PreviewCommand) {
        if let Err(error) = self.commands.try_send(command) {
            tracing::debug!("the program takes no command of the window: {error}");
        }
    }
}

impl eframe::App for App {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.handle_close(ctx);
    }

    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }

    fn raw_input_hook(&mut self, ctx: &egui::Context, input: &mut egui::RawInput) {
        if input.viewport_id == egui::ViewportId::ROOT
            && self.turns.take(&mut input.events, self.is_designing())
        {
            ctx.request_repaint();
        }
    }

    fn clear_color(&self, _visuals: &egui::Visuals) -> [f32; 4] {
        underfoot_scene::egui_painter::color(self.theme.canvas).to_normalized_gamma_f32()
    }

    fn persist_egui_memory(&self) -> bool {
        false
    }
}
