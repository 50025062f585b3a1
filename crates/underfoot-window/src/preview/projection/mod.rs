//! The floor for projectors: for each of one or two projectors a separate window that holds only the controls, fitted
//! to the real floor by its corners.
//!
//! These windows are outputs only. Feet use the controls on the floor itself; the corners move by mouse and keys of
//! this computer, and only in adjustment mode.
//!
//! This file has windows, file and thread; `view` and the modules that it uses have none of them.

mod awake;
mod brightness;
mod check_page;
mod corners;
mod homography;
mod marks;
mod menu;
mod pair;
mod picture;
mod placement;
mod screens;
mod store;
mod view;

use std::path::PathBuf;

use eframe::egui;
use eframe::egui::{Event, Key, Pos2, Ui, ViewportBuilder, ViewportClass, ViewportCommand, ViewportId};

use self::awake::Awake;
use self::pair::{MOST, ProjectorName, ProjectorPair};
pub(super) use self::screens::ConnectedScreens;
use self::screens::next_screen;
use self::view::{ProjectedFloor, ProjectorView, WindowKey};
use super::appearance::Appearance;
use super::messages::WindowMessages;
use super::shown::ShownFloor;
use underfoot_scene::scene::{self, Scene, Show, View};

/// The initial state of the projection.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ProjectionOptions {
    /// Whether its windows open at once, as full screen.
    pub open: bool,
    /// Whether the screens stay on while the windows are open.
    pub keeps_awake: bool,
    /// The screens of the first and the second projector for full screen, numbered by the system from 0; `None` for
    /// the stored one. A screen for the second projector takes it into use.
    pub monitors: [Option<usize>; 2],
    /// The file that stores the corners, in place of the usual one.
    pub corners: Option<PathBuf>,
}

/// The window of one projector.
struct ProjectorWindow {
    /// Whether it fills a screen.
    is_full: bool,
    view: ProjectorView,
}

/// The projectors' windows and their settings.
pub(super) struct Projection {
    is_open: bool,
    pair: ProjectorPair,
    /// The setups in the file.
    saved: ProjectorPair,
    file: Option<PathBuf>,
    windows: [ProjectorWindow; MOST],
    /// The projector that the keys of this window address where its picture is not a window of the system.
    addressed: usize,
    /// The connected screens, if they are known.
    screens: Option<ConnectedScreens>,
    /// Whether nothing is stored yet, so that the windows open at the first step: another screen, and the corners.
    is_new: bool,
    /// The controls, for all projectors.
    controls: Scene,
    keeps_awake: bool,
    /// Present while the windows are open and the screens must stay on.
    awake: Option<Awake>,
}

impl Projection {
    /// Uses `options`; also returns a message for the user if the file of corners cannot be used.
    pub(super) fn new(options: &ProjectionOptions) -> (Self, Option<String>) {
        let file = options.corners.clone().or_else(store::usual_file);
        let read = file.as_deref().map_or(Ok(None), store::load);
        let (stored, wrong) = read.map_or_else(|wrong| (None, Some(wrong)), |pair| (pair, None));
        let is_new = stored.is_none() && wrong.is_none();
        let mut pair = stored.unwrap_or_default();
        for (setup, monitor) in pair.setups.iter_mut().zip(options.monitors) {
            setup.screen = monitor.or(setup.screen);
        }
        if options.monitors[1].is_some() {
            pair.add_second();
        }
        let mut windows = pair
            .setups
            .map(|setup| ProjectorWindow { is_full: setup.screen.is_some(), view: ProjectorView::default() });
        windows[0].is_full |= options.open;
        let projection = Self {
            is_open: options.open,
            saved: pair,
            pair,
            file,
            windows,
            addressed: 0,
            screens: None,
            is_new,
            controls: Scene::new(),
            keeps_awake: options.keeps_awake,
            awake: None,
        };
        (projection, wrong)
    }

    pub(super) fn is_open(&self) -> bool {
        self.is_open
    }

    /// Opens or closes the windows.
    pub(super) fn toggle(&mut self) {
        self.is_open = !self.is_open;
        self.windows.iter_mut().for_each(|window| window.view.close());
    }

    /// Takes the second projector into use; its window fills the screen that it had.
    fn add_second(&mut self) {
        self.pair.add_second();
        self.addressed = 1;
        self.windows[1].is_full = self.pair.setups[1].screen.is_some();
    }

    /// Takes the second projector out of use.
    fn remove_second(&mut self) {
        self.pair.remove_second();
        self.addressed = 0;
        self.windows[1].view.close();
    }

    /// Notes the connected screens; `None` if they are unknown.
    pub(super) fn note_screens(&mut self, screens: Option<ConnectedScreens>) {
        self.screens = screens.filter(|screens| screens.count > 0);
    }

    /// The first use: the picture fills the screen beside that of the main window, if there is one, and its corners
    /// are adjusted.
    fn begin(&mut self) {
        self.is_new = false;
        self.windows[0].view.corners.toggle();
        let (setup, window) = (&mut self.pair.setups[0], &mut self.windows[0]);
        if let Some(ConnectedScreens { count: count @ 2.., own: Some(own) }) = self.screens
            && setup.screen.is_none()
        {
            (window.is_full, setup.screen) = (true, next_screen(Some(own), Some(own), count));
        }
    }

    /// Whether the keys of the main window adjust corners: on systems without several windows.
    pub(super) fn takes_keys(&self, ctx: &egui::Context) -> bool {
        let is_adjusting = |window: &ProjectorWindow| window.view.corners.selected().is_some();
        self.is_open && ctx.embed_viewports() && self.windows.iter().any(is_adjusting)
    }

    /// Shows the windows while they are open; F11 opens and closes them.
    pub(super) fn show(&mut self, ui: &Ui, shown: &mut ShownFloor, appearance: &Appearance) {
        if ui.input(|i| i.key_pressed(Key::F11)) {
            self.toggle();
            ui.ctx().request_repaint();
            // On systems without several windows, the same key event would close it again.
            return;
        }
        self.stay_awake(&mut shown.messages);
        if self.is_open {
            self.project(ui, shown, appearance);
        }
        let is_held = ui.input(|i| i.pointer.any_down())
            || self.windows.iter().any(|window| window.view.corners.is_holding());
        if self.pair != self.saved && !is_held {
            self.save(&mut shown.messages);
        }
    }

    /// Draws the floor once, and shows it in the window of each projector.
    fn project(&mut self, ui: &Ui, shown: &ShownFloor, appearance: &Appearance) {
        if self.is_new {
            self.begin();
        }
        let theme = appearance.projected();
        let view = View {
            show: Show::PROJECTOR,
            ..View::new(&shown.floor.geometry, shown.layout(), shown.snapshot(), &theme)
        };
        scene::draw(&mut self.controls, &view);
        let ctx = ui.ctx();
        let mut keys = Vec::new();
        let pointer = ui.input(|i| i.events.iter().rev().find_map(moved_to));
        for index in 0..self.pair.count().min(MOST) {
            let name = ProjectorName { index };
            let builder = self.builder(name);
            let is_addressed = self.addressed == index;
            let Self { pair, windows, controls, addressed, .. } = self;
            let (Some(setup), Some(window)) = (pair.setups.get_mut(index), windows.get_mut(index)) else {
                continue;
            };
            let floor = ProjectedFloor { shown, controls, theme: &theme, is_pair: pair.has_second };
            let id = ViewportId::from_hash_of(("projection", index));
            ctx.show_viewport_immediate(id, builder, |ui, class| {
                let is_embedded = class == ViewportClass::EmbeddedWindow;
                if ui.input(|i| i.viewport().close_requested()) {
                    keys.push((index, WindowKey::Close));
                    return;
                }
                if is_embedded && is_pressed(ui) {
                    *addressed = index;
                }
                let has_keys = !is_embedded || is_addressed;
                let key = window.view.show(ui, setup, &floor, (name, has_keys));
                // With two projectors, the lines of both are compared.
                let is_away = pointer.is_some_and(|to| !is_embedded || !ui.max_rect().contains(to));
                if is_away && !floor.is_pair {
                    window.view.corners.end_if_complete();
                }
                keys.extend(key.map(|key| (index, key)));
            });
        }
        for (index, key) in keys {
            self.handle_key(index, key);
        }
        // On a computer with one screen, the projection covers the window that draws it.
        ctx.send_viewport_cmd_to(ViewportId::ROOT, ViewportCommand::RequestPaintWhileHidden);
    }

    /// The window of the system for one projector.
    fn builder(&self, name: ProjectorName) -> ViewportBuilder {
        let title = if self.pair.has_second { name.title() } else { "the floor" };
        let (is_full, screen) = (self.windows[name.index].is_full, self.pair.setups[name.index].screen);
        // Without that screen, the projection would cover the main window.
        let is_connected = screen.is_none_or(|screen| screens::has(self.screens, screen));
        let window = ViewportBuilder::default()
            .with_title(format!("underfoot: {title}"))
            .with_app_id("underfoot")
            .with_inner_size([960.0, 720.0])
            .with_fullscreen(is_full && is_connected);
        match screen.filter(|_| is_full && is_connected) {
            Some(screen) => window.with_monitor(screen),
            None => window,
        }
    }

    /// Acts on the window of the projector numbered `index`.
    fn handle_key(&mut self, index: usize, key: WindowKey) {
        let screens = screens::count(self.screens);
        let other = self.pair.setups.get(1 - index.min(1)).filter(|_| self.pair.has_second);
        let taken = other.and_then(|setup| setup.screen);
        let (Some(setup), Some(window)) = (self.pair.setups.get_mut(index), self.windows.get_mut(index))
        else {
            return;
        };
        match key {
            WindowKey::Close if self.is_open => self.toggle(),
            WindowKey::Close => {}
            WindowKey::FullScreen => (window.is_full, setup.screen) = (!window.is_full, None),
            WindowKey::NextScreen => {
                (window.is_full, setup.screen) = (true, next_screen(setup.screen, taken, screens));
            }
        }
    }

    /// While feet use a projected floor, keys and mouse are idle, so the screen would go dark.
    fn stay_awake(&mut self, messages: &mut WindowMessages) {
        let wanted = self.is_open && self.keeps_awake;
        let awake = &mut self.awake;
        match awake {
            None if wanted => *awake = Some(Awake::begin()),
            Some(_) if !wanted => *awake = None,
            _ => {}
        }
        if let Some(why) = awake.as_ref().and_then(Awake::failure) {
            messages.note(format!("The screen may go dark while the floor is projected: {why}"));
        }
    }

    /// Saves the setups; a failure is reported once for each change.
    fn save(&mut self, messages: &mut WindowMessages) {
        self.saved = self.pair;
        let Some(file) = &self.file else { return };
        if let Err(wrong) = store::save(&self.pair, file) {
            messages.note(format!("The corners are not remembered: {wrong}"));
        }
    }
}

/// The place to which an event moves the pointer.
fn moved_to(event: &Event) -> Option<Pos2> {
    match event {
        Event::PointerMoved(to) => Some(*to),
        _ => None,
    }
}

/// Whether the pointer was pressed in this picture.
fn is_pressed(ui: &Ui) -> bool {
    let pressed = ui.input(|i| i.pointer.primary_pressed().then(|| i.pointer.interact_pos()).flatten());
    pressed.is_some_and(|at| ui.ctx().layer_id_at(at) == Some(ui.layer_id()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn screens_of_options_count_before_stored_ones_and_bring_the_second_projector() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("projection.txt");
        let mut stored = ProjectorPair::default();
        stored.setups[0].screen = Some(3);
        store::save(&stored, &file).unwrap();
        let of = |monitors| {
            let options =
                ProjectionOptions { monitors, corners: Some(file.clone()), ..ProjectionOptions::default() };
            let (projection, wrong) = Projection::new(&options);
            assert_eq!(wrong, None);
            (projection.pair.setups.map(|setup| setup.screen), projection.pair.has_second)
        };
        assert_eq!(of([None, None]), ([Some(3), None], false));
        assert_eq!(of([Some(1), None]), ([Some(1), None], false));
        assert_eq!(of([Some(1), Some(2)]), ([Some(1), Some(2)], true));
    }

    #[test]
    fn the_first_use_takes_the_screen_beside_the_main_window_and_later_ones_take_the_stored_one() {
        let folder = tempfile::tempdir().unwrap();
        let options = ProjectionOptions {
            corners: Some(folder.path().join("projection.txt")),
            ..ProjectionOptions::default()
        };
        for (own, count, expected) in [(0, 2, Some(1)), (1, 2, Some(0)), (0, 1, None), (1, 3, Some(2))] {
            let (mut projection, _) = Projection::new(&options);
            projection.note_screens(Some(ConnectedScreens { count, own: Some(own) }));
            assert!(projection.is_new);
            projection.begin();
            assert_eq!(projection.pair.setups[0].screen, expected, "screen {own} of {count}");
            assert_eq!(projection.windows[0].is_full, expected.is_some());
            assert_eq!(projection.windows[0].view.corners.selected(), Some(0));
            // A screen that is no longer connected leaves a window, which does not cover the main one.
            projection.note_screens(Some(ConnectedScreens { count: 1, own: Some(0) }));
            let window = projection.builder(ProjectorName { index: 0 });
            let is_kept = expected.is_some_and(|screen| screen == 0);
            assert_eq!(window.fullscreen, Some(is_kept), "screen {own} of {count}");
        }
        store::save(&ProjectorPair::default(), options.corners.as_deref().unwrap()).unwrap();
        assert!(!Projection::new(&options).0.is_new);
    }
}
