//! The window's contents, frame by frame.

use eframe::egui::{self, Ui};

use super::PreviewOptions;
use super::appearance::Appearance;
use super::bars::{HelpTopic, MessageStack, TELL_S, TopBar, handle_mute_key};
use super::channels::NextFloor;
use super::closing::{Closing, Title, handle_quit_key};
use super::design::Designer;
use super::feed::PreviewInput;
use super::floor_check::FloorCheck;
use super::floor_view::{FloorFeet, FloorPane, OnFloor};
use super::focus::FocusRing;
use super::fold::{UnfoldedPanels, fit_hand, show_lower_bars};
use super::handheld::{HoldWatch, WindowHold};
use super::lookout;
use super::messages::{Happened, WindowMessages};
use super::mode::WindowMode;
use super::pace::{FramePace, WindowMotion};
use super::panel::{SidePanel, Tuner, handle_undo_key};
use super::plots::Plots;
use super::presses::PressLog;
use super::projection::Projection;
use super::rehearsal::Rehearsal;
use super::scopes::ActuatorScopes;
use super::selection::Selection;
use super::share::Share;
use super::shown::ShownFloor;
use super::stage::{PanelWidths, StageOfWindow};
use super::status::StatusBar;
use super::time_line::TimeLine;
use super::turns::Turns;
use super::visit::{VisitAction, VisitBar};
use super::walks::Walks;
use super::watch::LinkNotices;
use underfoot_scene::scene::{self, Theme};

/// The window's contents and their state from one frame to the next.
pub(super) struct App {
    pub(super) shown: ShownFloor,
    pub(super) view: FloorPane,
    pub(super) feet: FloorFeet,
    pub(super) selection: Selection,
    pub(super) presses: PressLog,
    pub(super) plots: Plots,
    pub(super) panel: SidePanel,
    pub(super) top_bar: TopBar,
    pub(super) status: StatusBar,
    /// `None` unless a recording is on display.
    pub(super) time_line: Option<TimeLine>,
    /// `None` where nothing can be recorded or exported.
    pub(super) visit: Option<VisitBar>,
    /// `None` unless the floor is simulated.
    pub(super) rehearsal: Option<Rehearsal>,
    /// `None` where people cannot be sent onto the floor.
    pub(super) walks: Option<Walks>,
    /// `None` without effects to tune.
    pub(super) tuner: Option<Tuner>,
    /// `None` where the floor cannot be checked.
    pub(super) floor_check: Option<FloorCheck>,
    /// `None` where the layout cannot be edited.
    pub(super) designer: Option<Designer>,
    /// `None` where the layout cannot be shared.
    pub(super) share: Option<Share>,
    pub(super) projection: Projection,
    pub(super) appearance: Appearance,
    pub(super) window: WindowState,
}

/// The state of the window itself.
pub(super) struct WindowState {
    closing: Closing,
    pub(super) title: Title,
    pub(super) turns: Turns,
    pace: FramePace,
    focus: FocusRing,
    widths: PanelWidths,
    /// Whether the last frame showed Design mode.
    was_designing: bool,
    pub(super) hold_watch: HoldWatch,
    /// How the window is held in this frame.
    pub(super) hold: WindowHold,
    /// The mode and the open panels of the last frame, in a window in a hand.
    pub(super) unfolded: UnfoldedPanels,
    /// The options with which the window began.
    pub(super) options: PreviewOptions,
    next_floor: Option<NextFloor>,
}

impl App {
    pub(super) fn new(input: PreviewInput, options: &PreviewOptions) -> Self {
        let (projection, wrong) = Projection::new(&options.projection);
        let channels = input.channels;
        let mut messages =
            WindowMessages::new(input.layout, channels.events, channels.layouts, channels.notices);
        messages.warnings = input.warnings;
        let (appearance, unread) = Appearance::new(options.theme, options.settings.clone());
        wrong.into_iter().chain(unread).for_each(|wrong| messages.note(wrong));
        let floor = input.floor;
        Self {
            view: FloorPane::new(options.layers),
            feet: FloorFeet::new(input.feet, input.shoes),
            selection: Selection::new(&floor.geometry),
            presses: if input.playback.is_some() { PressLog::recorded() } else { PressLog::default() },
            plots: Plots::default(),
            panel: SidePanel::default(),
            top_bar: TopBar::new(input.choices, options.begins_with_gallery),
            status: StatusBar::new(input.latency),
            time_line: input.playback.map(TimeLine::new),
            visit: input.visit.map(VisitBar::new),
            rehearsal: input.faults.map(|switch| Rehearsal::new(switch, &floor)),
            walks: input.people.map(Walks::new),
            tuner: Tuner::new(input.effects),
            floor_check: input.packets.map(FloorCheck::new),
            designer: input.design.and_then(|design| Designer::new(design, &floor)),
            share: input.share.map(Share::new),
            projection,
            appearance,
            window: WindowState {
                closing: Closing::default(),
                title: Title::new(&options.title),
                turns: Turns::default(),
                pace: FramePace::default(),
                focus: FocusRing::default(),
                widths: PanelWidths::default(),
                was_designing: false,
                hold_watch: HoldWatch::default(),
                hold: WindowHold::Desk,
                unfolded: UnfoldedPanels::default(),
                options: options.clone(),
                next_floor: channels.next_floor,
            },
            shown: ShownFloor {
                scopes: ActuatorScopes::new(input.scopes, &floor),
                floor,
                source: input.source,
                server_feed: input.server,
                server: None,
                snapshots: input.snapshots,
                messages,
                watch: LinkNotices::default(),
                commands: channels.commands,
                now_s: 0.0,
            },
        }
    }

    /// Whether Design mode is open.
    pub(super) fn is_designing(&self) -> bool {
        self.designer.as_ref().is_some_and(|designer| designer.is_open)
    }

    /// Whether the floor shows the first steps: only feet of mouse and keys can take them.
    fn has_steps(&self) -> bool {
        self.appearance.has_steps() && self.feet.are_led() && !self.is_checking()
    }

    /// Follows the first steps until they are done.
    fn follow_steps(&mut self, ui: &Ui) {
        if !self.has_steps() {
            return self.view.steps.restart();
        }
        let (shown, standing) = (&self.shown, self.feet.standing_at());
        let (snapshot, layout) = (shown.snapshot(), shown.layout());
        let recent = shown.messages.recent.iter();
        if self.view.steps.follow(shown.now_s, snapshot, layout, recent, standing) {
            self.appearance.show_steps(ui.ctx(), false, &mut self.shown.messages);
        }
    }

    /// Whether a check of the floor is running.
    pub(super) fn is_checking(&self) -> bool {
        self.floor_check.as_ref().is_some_and(FloorCheck::is_running)
    }

    /// Shows another floor in the place of this one, once there is one: the user has taken over from a visit, or opened
    /// a recording.
    fn go_on(&mut self, ctx: &egui::Context) {
        let taken = self.time_line.as_mut().and_then(TimeLine::taken_over);
        let next = taken.or_else(|| self.window.next_floor.as_ref()?.take());
        let Some(input) = next else { return };
        if let Some(designer) = &mut self.designer {
            designer.keep_now();
        }
        let options = PreviewOptions { begins_with_gallery: false, ..self.window.options.clone() };
        let mut next = Self::new(lookout::start(*input, ctx), &options);
        // The window looks as it did.
        std::mem::swap(&mut next.appearance, &mut self.appearance);
        next.view.zoom = self.view.zoom;
        next.window.hold_watch = self.window.hold_watch;
        *self = next;
        ctx.request_repaint();
    }

    /// Draws one frame.
    pub(super) fn show(&mut self, ui: &mut Ui) {
        self.go_on(ui.ctx());
        fit_hand(self, ui.ctx());
        self.receive(ui);
        self.handle_keys(ui);
        self.follow_steps(ui);
        self.share_zoom();
        let begun = self.designer.as_mut().filter(|designer| designer.is_open).map(|it| it.begin_frame(ui));
        let first: &[egui::Id] = if begun.is_none() { self.view.controls() } else { &[] };
        self.window.focus.begin(ui, first);
        self.show_top_bar(ui);
        self.show_gallery(ui);
        let theme = self.appearance.theme();
        show_lower_bars(self, ui, &theme);
        if let Some(line) = &mut self.time_line {
            line.show(ui, &theme);
        }
        let (room, widths) = (ui.available_rect_before_wrap(), self.window.widths);
        let has_side = self.panel.is_shown(room.width(), self.is_designing());
        let stage = StageOfWindow::new(room, widths, self.designer.is_some(), has_side);
        let mut stage = stage.held(self.window.hold);
        match (&mut self.designer, begun) {
            (Some(designer), Some(before)) => {
                // A click on the switch of the modes leaves Design mode some frames later.
                designer.show(ui, &theme, &self.shown, &mut self.view.palette, &mut stage, before);
            }
            _ => self.show_floor(ui, &mut stage),
        }
        self.window.widths = stage.widths;
        self.show_messages(ui, &theme, stage.canvas);
        if let Some(share) = &mut self.share {
            share.show(ui, &theme);
        }
        self.window.focus.show(ui, &theme);
        self.request_next_frame(ui);
    }

    /// Shows the messages over the floor.
    fn show_messages(&mut self, ui: &Ui, theme: &Theme, canvas: egui::Rect) {
        let stack = MessageStack { theme, canvas };
        let lists_warnings = self.top_bar.lists_warnings && !self.is_designing();
        stack.lower(ui, &self.shown.messages, lists_warnings);
        let designs = self.is_designing();
        let (designer, view) = (&mut self.designer, &mut self.view);
        stack.upper(ui, &mut self.shown, |ui| {
            if let Some(designer) = designer {
                designer.messages(ui, &stack);
            }
            // Below the messages, so that none covers it.
            if !designs {
                view.fit_button(ui);
            }
        });
    }

    /// Keeps the visible part of the floor when the mode changes; Design mode begins with the control in use.
    fn share_zoom(&mut self) {
        let designs = self.is_designing();
        if let Some(designer) = self.designer.as_mut().filter(|_| designs != self.window.was_designing) {
            if designs {
                *designer.zoom_mut() = self.view.zoom;
                designer.select_used(self.selection.control());
            } else {
                self.view.zoom = *designer.zoom_mut();
            }
        }
        self.window.was_designing = designs;
    }

    /// Draws the floor with the panels around it.
    fn show_floor(&mut self, ui: &mut Ui, stage: &mut StageOfWindow) {
        let theme = self.appearance.theme();
        let tunes = self.tuner.as_ref().is_some_and(|tuner| tuner.is_open);
        match self.floor_check.as_mut().filter(|check| check.is_running()) {
            Some(check) => check.panel(ui, &theme, &self.shown, self.feet.are_led(), stage.sheet()),
            // A narrow window has room for one panel.
            None if tunes && !stage.is_wide() => {}
            None => {
                self.show_side_panel(ui, stage.sheet());
                stage.note_right(ui.available_rect_before_wrap());
            }
        }
        if let Some(tuner) = &mut self.tuner {
            tuner.panel(ui, &theme, &self.shown, self.selection.tile(), stage);
        }
        self.show_visit_bar(ui, &theme);
        let designer = self.designer.as_mut();
        self.plots.show(ui, &theme, &self.shown, &self.selection, designer, stage.sheet());
        // An open panel leaves a window in a hand no room for them.
        let has_steps = self.has_steps() && !self.window.unfolded.is_any();
        let frame = egui::Frame::new();
        egui::CentralPanel::default().frame(frame).show(ui, |ui| {
            stage.canvas = ui.available_rect_before_wrap();
            let on_floor = OnFloor {
                feet: &mut self.feet,
                selection: &mut self.selection,
                walks: self.walks.as_mut(),
                check: self.floor_check.as_ref(),
                has_steps,
            };
            self.view.show(ui, &theme, &self.shown, on_floor, stage.view_room());
        });
        self.projection.show(ui, &mut self.shown, &self.appearance);
    }

    /// Takes in the news of the floor.
    fn receive(&mut self, ui: &Ui) {
        let (now_s, elapsed_s) = ui.input(|i| (i.time, i.stable_dt));
        self.shown.receive(now_s);
        let ignored = self.presses.update(self.shown.snapshot());
        self.shown.messages.note_unanswered(ignored.into_iter().map(Happened::Ignored));
        let missed =
            self.view.misses.update(self.shown.snapshots.output_buffer(), &self.shown.messages.layout);
        self.shown.messages.note_unanswered(missed.into_iter().map(Happened::NearMiss));
        self.feet.receive();
        let snapshot = self.shown.snapshot();
        self.view.trails.update(now_s, snapshot);
        self.plots.note(now_s, snapshot, self.shown.layout());
        self.selection.follow(snapshot);
        self.selection.follow_use(&snapshot.held, self.presses.latest());
        self.status.observe(now_s, snapshot);
        self.shown.receive_signals(self.selection.tile(), elapsed_s);
        if self.shown.scopes.are_moving() {
            self.shown.messages.tell_silence();
        }
    }

    /// Handles the keys that work anywhere in the window, and what the parts do once a frame before they are drawn.
    fn handle_keys(&mut self, ui: &Ui) {
        if let Some(check) = &mut self.floor_check {
            check.follow(ui, &self.shown);
        }
        self.handle_mode_key(ui);
        self.appearance.handle_keys(ui, &mut self.shown.messages);
        self.appearance.enlarge(ui.ctx());
        handle_quit_key(ui);
        if let Some(visit) = &mut self.visit {
            let designer = self.designer.as_ref();
            visit.follow(ui, self.shown.snapshot(), &|| designer.map(Designer::to_share));
        }
        // In Design mode, `Designer::keys_anywhere` saves, after the text fields.
        if let Some(designer) = self.designer.as_mut().filter(|designer| !designer.is_open) {
            designer.keys_to_save(ui);
        }
        let is_adjusting = self.projection.takes_keys(ui.ctx());
        if !is_adjusting {
            handle_mute_key(ui, &self.shown);
        }
        // A check of the floor excludes editing.
        let is_checking = self.is_checking();
        if let Some(designer) = self.designer.as_mut().filter(|_| !is_checking) {
            designer.follow(ui, &mut self.shown, &mut self.feet, self.window.closing.is_granted());
        }
        self.show_title(ui.ctx());
        if let Some(designer) = &mut self.designer {
            self.window.closing.ask(ui.ctx(), designer);
        }
        if !is_adjusting {
            handle_undo_key(ui, &self.shown, &mut self.presses, self.designer.as_mut());
        }
        let is_designing = self.is_designing();
        if !is_designing {
            self.plots.handle_key(ui);
        }
        if let Some(walks) = &mut self.walks {
            walks.handle_key(ui, is_designing);
        }
    }

    /// Sets the window's title: the layout's file, with a dot while it is unsaved, or the recording.
    fn show_title(&mut self, ctx: &egui::Context) {
        let subject = match (&self.designer, &self.time_line) {
            (Some(designer), _) => Some(designer.title()),
            (None, Some(_)) => Some(self.shown.source.clone()),
            (None, None) => None,
        };
        self.window.title.show(ctx, subject.as_deref());
    }

    /// Shows the button that shares the layout, if it can be shared.
    pub(super) fn share_button(&mut self, ui: &mut Ui, is_compact: bool) {
        if let (Some(share), Some(designer)) = (&mut self.share, &self.designer) {
            share.button(ui, is_compact, || designer.to_share());
        }
    }

    /// Shows the button that records, if anything can be recorded.
    pub(super) fn show_visit_button(&mut self, ui: &mut Ui, is_compact: bool) {
        let theme = self.appearance.theme();
        if let Some(visit) = &mut self.visit {
            let designer = self.designer.as_ref();
            let layout = || designer.map(Designer::to_share);
            visit.button(ui, &theme, self.shown.snapshot(), &layout, is_compact);
        }
    }

    /// Shows the bar for the last recording, and gives it away as a link.
    fn show_visit_bar(&mut self, ui: &mut Ui, theme: &Theme) {
        let part = self.time_line.as_ref().and_then(TimeLine::part);
        let action = self.visit.as_mut().and_then(|visit| visit.show(ui, theme, part, self.share.is_some()));
        match (action, &mut self.share) {
            (Some(VisitAction::Share(layout)), Some(share)) => share.open(&layout),
            (Some(VisitAction::Play(layout)), Some(share)) => share.play(ui.ctx(), &layout),
            _ => {}
        }
    }

    /// Keeps the window open while edits would be lost, once it has a request to close.
    pub(super) fn handle_close(&mut self, ctx: &egui::Context) {
        if let Some(designer) = &self.designer {
            self.window.closing.handle_request(ctx, designer);
        }
    }

    /// The use of the window now.
    pub(super) fn activity(&self) -> HelpTopic {
        let draws_walks = self.walks.as_ref().is_some_and(|walks| walks.are_drawn);
        match () {
            () if self.is_designing() => HelpTopic::Designing,
            () if self.is_checking() => HelpTopic::Checking,
            () if draws_walks => HelpTopic::DrawingWalks,
            () if self.mode() == WindowMode::Project => HelpTopic::Projecting,
            () if self.feet.are_led() => HelpTopic::Stepping,
            () if self.time_line.is_some() => HelpTopic::Replaying,
            () => HelpTopic::Watching { is_rendered: self.shown.scopes.is_fed() },
        }
    }

    /// Requests the frames that nothing else requests.
    fn request_next_frame(&mut self, ui: &Ui) {
        let shown = &self.shown;
        let selected = self.selection.control_of(shown.layout()).map(|widget| &widget.id);
        let is_held = ui.input(|i| i.pointer.any_down() || !i.keys_down.is_empty());
        let fades = self.view.show.trails && !self.view.trails.all().is_empty();
        let moves = WindowMotion {
            tells: self.shows_for_a_while(),
            plots: self.plots.are_moving(shown.now_s, &shown.floor.geometry, selected),
            floor: is_held || fades || shown.scopes.are_moving(),
        };
        self.window.pace.request(ui.ctx(), moves);
    }

    /// Whether the screen shows a message that disappears after a while.
    fn shows_for_a_while(&self) -> bool {
        let snapshot = self.shown.snapshot();
        let ignored = snapshot.ignored.last();
        let missed = self.view.misses.latest();
        ignored.is_some_and(|press| snapshot.at.since(press.at) < 2 * scene::TOLD)
            || missed.is_some_and(|miss| snapshot.at.since(miss.at) < 2 * scene::TOLD)
            || (self.has_steps() && self.view.steps.ends_soon())
            || self
                .shown
                .messages
                .file
                .as_ref()
                .is_some_and(|file| self.shown.now_s - file.at_s < 2.0 * TELL_S)
    }
}
