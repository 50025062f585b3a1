//! Design mode without a display: finds parts by name, uses mouse and keyboard, and checks the resulting text.

mod arrivals;
mod badges;
mod clipboard;
mod files;
mod groups;
mod habits;
mod inspector;
mod keyboard;
mod palette;
mod saving;
mod served;

use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender};

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use tempfile::TempDir;

use super::*;
use crate::edit::Template;
use crate::preview::app::App;
use crate::preview::{
    LayoutNews, PreviewCommand, PreviewInput, PreviewOptions, ProgramChannels, ServerFeed, channels,
};
use underfoot::engine::Snapshot;
use underfoot::floor::Rect;
use underfoot::schema::{builtin_layout, parse_layout};

struct Desk {
    window: Harness<'static, App>,
    commands: Receiver<PreviewCommand>,
    news: SyncSender<LayoutNews>,
    state: TempDir,
}

impl Desk {
    fn on(text: &str, path: Option<PathBuf>) -> Self {
        Self::with(text, path, tempfile::tempdir().unwrap())
    }

    /// For a file that does not exist yet.
    fn begun(shown: &str, path: &Path) -> Self {
        Self::of(shown, "", Some(path.into()), tempfile::tempdir().unwrap())
    }

    fn with(text: &str, path: Option<PathBuf>, state: TempDir) -> Self {
        Self::of(text, text, path, state)
    }

    /// The layout of `text` on the floor, and the text `designed` in Design mode.
    fn of(text: &str, designed: &str, path: Option<PathBuf>, state: TempDir) -> Self {
        Self::served(text, designed, path, state, None)
    }

    /// As [`Self::of`], on the floor of this server, if any.
    fn served(
        text: &str,
        designed: &str,
        path: Option<PathBuf>,
        state: TempDir,
        server: Option<ServerFeed>,
    ) -> Self {
        let floor = Arc::new(Floor::default());
        let kinds = Arc::new(Kinds::builtin());
        let layout = Arc::new(parse_layout(text, "it", &kinds, &floor.geometry).unwrap().layout);
        let (_, snapshots) = triple_buffer::triple_buffer(&Snapshot::default());
        let (channels, ProgramChannels { layouts: news, commands, .. }) = channels();
        let input = PreviewInput {
            choices: vec!["map".into()],
            server,
            design: Some(DesignInput {
                name: "it.ron".into(),
                text: designed.into(),
                path,
                kinds_of: Box::new(move |_| Ok(Arc::clone(&kinds))),
                state: state.path().into(),
            }),
            ..PreviewInput::new(floor, layout, "simulated floor", snapshots, channels)
        };
        let app = App::new(input, &PreviewOptions::default());
        let mut builder = Harness::builder().with_size(vec2(1400.0, 860.0)).with_step_dt(1.0 / 60.0);
        builder = builder.with_context_setup(|ctx| ctx.set_fonts(crate::preview::style::fonts()));
        // Chinese letters, which the program's own fonts lack.
        if text.chars().any(|letter| letter >= '\u{4e00}') {
            builder = builder.allow_missing_glyphs();
        }
        let window = builder.build_ui_state(
            |ui, app: &mut App| {
                app.handle_close(ui.ctx());
                app.show(ui);
            },
            app,
        );
        let mut desk = Self { window, commands, news, state };
        desk.key(Key::F2);
        desk
    }

    fn map() -> Self {
        Self::on(builtin_layout("map").unwrap(), None)
    }

    fn designer(&self) -> &Designer {
        self.window.state().designer.as_ref().unwrap()
    }

    fn designer_mut(&mut self) -> &mut Designer {
        self.window.state_mut().designer.as_mut().unwrap()
    }

    fn text(&self) -> String {
        self.designer().edited.document.text().to_owned()
    }

    fn key(&mut self, key: Key) {
        self.window.key_press(key);
        self.window.run_steps(3);
    }

    /// Whether the window shows this text.
    fn says(&self, text: &str) -> bool {
        self.window.query_all_by_label_contains(text).next().is_some()
    }

    fn command(&mut self, modifiers: Modifiers, key: Key) {
        self.window.key_press_modifiers(modifiers, key);
        self.window.run_steps(3);
    }

    fn click(&mut self, label: &str) {
        self.window.get_by_label(label).click();
        self.window.run_steps(3);
    }

    /// The input field of the field with this name in files; a part of a place stands behind a space.
    fn field(&self, name: &str) -> egui_kittest::Node<'_> {
        let spoken = match name.split_once(' ') {
            Some((field, part)) => format!("{}: {part}", super::inspector::label(field)),
            None => super::inspector::label(name),
        };
        let name: &'static str = spoken.leak();
        match self.window.query_by_role_and_label(Role::TextInput, name) {
            Some(text) => text,
            None => self.window.get_by_role_and_label(Role::SpinButton, name),
        }
    }

    fn place(&self, name: &str) -> Pos2 {
        self.window.get_by_label(&format!("On the floor: {name}")).rect().center()
    }

    fn button(&mut self, pos: Pos2, pressed: bool) {
        let modifiers = Modifiers::NONE;
        self.window.event(Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers });
        self.window.run_steps(1);
    }

    fn drag(&mut self, from: Pos2, to: Pos2) {
        self.window.event(Event::PointerMoved(from));
        self.window.run_steps(1);
        self.button(from, true);
        for step in 1..=8_u8 {
            self.window.event(Event::PointerMoved(from + (to - from) * (f32::from(step) / 8.0)));
            self.window.run_steps(1);
        }
        self.button(to, false);
        self.window.run_steps(2);
    }

    fn area(&self, name: &str) -> Rect {
        let layout = self.designer().layout();
        layout.widgets[layout.widget_index(name).unwrap()].area
    }
}

#[test]
fn a_drag_moves_a_control_as_one_step_and_the_floor_gets_the_layout() {
    let mut desk = Desk::map();
    let first = desk.text();
    let (home, before) = (desk.place("home"), desk.area("home"));
    desk.drag(home, home + vec2(0.0, -90.0));
    assert!(desk.area("home").min.y > before.min.y + 0.1, "{:?}", desk.area("home"));
    assert_eq!(desk.area("home").size(), before.size());
    let changed: Vec<_> = first
        .lines()
        .zip(desk.text().lines().map(str::to_owned))
        .filter(|(a, b)| a != b)
        .map(|(a, _)| a.trim().to_owned())
        .collect();
    assert!(matches!(&changed[..], [line] if line.starts_with("(id: \"home\"")), "{changed:?}");
    let layout = desk.designer().layout().clone();
    let told = desk.commands.try_iter().last();
    assert!(matches!(told, Some(PreviewCommand::Try { layout: shown, .. }) if *shown == layout));
    desk.command(Modifiers::COMMAND, Key::Z);
    assert_eq!(desk.text(), first);
    desk.command(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(desk.designer().layout(), &layout);
}

#[test]
fn what_cannot_be_is_refused_where_it_is_dropped() {
    let mut desk = Desk::map();
    let first = desk.text();
    let (home, west) = (desk.place("home"), desk.place("pan_west"));
    desk.drag(home, west);
    assert_eq!(desk.text(), first);
    assert!(desk.window.query_all_by_label_contains("overlaps").next().is_some());
}

#[test]
fn the_lasso_selects_and_delete_takes_out() {
    let mut desk = Desk::map();
    let (north, south) = (desk.place("pan_north"), desk.place("pan_south"));
    desk.drag(north + vec2(-130.0, -60.0), south + vec2(130.0, 40.0));
    assert_eq!(desk.designer().edited.selected.len(), 4, "{:?}", desk.designer().edited.selected);
    desk.key(Key::Delete);
    assert_eq!(desk.designer().layout().widgets.len(), 3);
    assert!(desk.text().contains("// Panning: four buttons"));
}

#[test]
fn the_text_beside_the_floor_is_read_as_it_is_typed() {
    let mut desk = Desk::map();
    desk.click("Text");
    let home = desk.place("home");
    desk.drag(home, home);
    assert_eq!(desk.designer().edited.selected.len(), 1);
    let text = desk.window.get_by_label("Text of the layout");
    text.focus();
    desk.window.run_steps(2);
    desk.window.event(Event::Text("oops".into()));
    desk.window.run_steps(2);
    assert!(desk.window.query_all_by_label_contains("The floor keeps the last text").next().is_some());
    assert_eq!(desk.designer().layout().widgets.len(), 7);
}

#[test]
fn the_inspector_says_where_a_value_comes_from_and_warnings_can_be_mended() {
    let text = builtin_layout("map")
        .unwrap()
        .replace("at: (0.2, 2.2), size: (0.6, 0.6)", "at: (0.2, 2.2), size: (0.25, 0.6)");
    let mut desk = Desk::on(&text, None);
    desk.window.get_by_label_contains(" warning").click();
    desk.window.run_steps(3);
    assert!(desk.window.query_all_by_label_contains("U101").next().is_some());
    desk.click("Make it 12 cm: do it");
    assert!((desk.area("home").size().x - 0.12).abs() < 1e-4, "{:?}", desk.area("home"));
    assert!(desk.window.query_all_by_label_contains("U101").next().is_none());
    let sections = desk.designer().edited.document.properties(
        &desk.designer().edited.selected[0],
        desk.designer().edited.selected_items().first().copied(),
    );
    let press = sections.iter().flat_map(|part| &part.properties).find(|one| one.name == "press_n").unwrap();
    assert_eq!(
        (press.value.as_str(), &press.origin),
        ("60", &crate::edit::FieldOrigin::Kind("round_button".into()))
    );
}

#[test]
fn letters_that_no_font_has_are_a_warning_at_their_control() {
    // Tests use the program's own fonts only, not those of the computer.
    let text = builtin_layout("map").unwrap().replace("\"Home\"", "\"首页\"");
    let mut desk = Desk::on(&text, None);
    desk.click("1 warning");
    assert_eq!(desk.designer().edited.document.id_of(&desk.designer().edited.selected[0]), Some("home"));
    assert!(desk.says("no font has 首 (U+9996) and 页 (U+9875)"));
    let home = builtin_layout("map").unwrap().replace("\"Home\"", "\"Дом\"");
    assert!(Desk::on(&home, None).says("no warnings"));
}

#[test]
fn a_group_is_taken_as_one_and_what_is_locked_or_hidden_is_let_be() {
    let mut desk = Desk::map();
    let (north, south) = (desk.place("pan_north"), desk.place("pan_south"));
    desk.drag(north + vec2(-130.0, -60.0), south + vec2(130.0, 40.0));
    desk.command(Modifiers::COMMAND, Key::G);
    assert!(desk.text().contains("Group(id: \"group_1\""), "{}", desk.text());
    desk.key(Key::Escape);
    let (west, before) = (desk.place("pan_west"), desk.area("pan_east"));
    desk.drag(west, west + vec2(0.0, -60.0));
    assert!(desk.area("pan_east").min.y > before.min.y + 0.05, "all of it moves");
    desk.command(Modifiers::COMMAND, Key::L);
    let text = desk.text();
    let west = desk.place("pan_west");
    desk.drag(west, west + vec2(0.0, -60.0));
    desk.key(Key::Delete);
    assert_eq!(desk.text(), text, "locked");
    desk.click("Hide: home");
    assert!(desk.window.query_by_label("On the floor: home").is_none());
}

#[test]
fn what_is_selected_is_arranged_from_the_menu_and_each_step_is_undone() {
    let mut desk = Desk::map();
    let first = desk.text();
    let (north, south) = (desk.place("pan_north"), desk.place("pan_south"));
    desk.drag(north + vec2(-130.0, -60.0), south + vec2(130.0, 40.0));
    desk.click("Turn");
    assert!(desk.area("pan_north").size().y > desk.area("pan_north").size().x, "a quarter turn");
    desk.click("Undo");
    desk.key(Key::Escape);
    let (home, north) = (desk.place("home"), desk.place("pan_north"));
    desk.drag(home, home);
    desk.window.event(Event::ModifiersChanged(Modifiers::SHIFT));
    desk.drag(north, north);
    desk.window.event(Event::ModifiersChanged(Modifiers::NONE));
    assert_eq!(desk.designer().edited.selected.len(), 2);
    desk.click("Arrange");
    desk.click("Align north edges");
    assert!((desk.area("home").max.y - desk.area("pan_north").max.y).abs() < 1e-4);
    desk.click("Undo");
    assert_eq!(desk.text(), first);
    desk.click("Redo");
    assert_ne!(desk.text(), first);
}

#[test]
fn regions_grounds_places_to_stand_and_pages_are_put_down_too() {
    let empty = Template::Empty.text(&Floor::default().geometry);
    let mut desk = Desk::on(&empty, None);
    // The thing to put down follows the pointer until the next click.
    desk.click("Put down: button");
    let board = desk.window.get_by_label("Drawing board").rect().center();
    desk.drag(board, board);
    assert_eq!(desk.designer().layout().widgets.len(), 1, "{}", desk.text());
    for name in ["place to stand", "ice", "region"] {
        desk.window.get_by_label(&format!("Put down: {name}")).focus();
        desk.window.run_steps(1);
        desk.key(Key::Enter);
    }
    let layout = desk.designer().layout();
    let counts = (layout.stances.len(), layout.grounds.len());
    assert_eq!(counts, (2, 1), "{}", desk.text());
    let refused = desk.window.query_all_by_label_contains("overlaps region").next();
    assert!(refused.is_some(), "two regions at one place");
    let mut desk = Desk::on(&empty, None);
    desk.window.get_by_label("Add a page").scroll_to_me();
    desk.window.run_steps(20);
    desk.click("Add a page");
    assert_eq!(desk.designer().layout().pages.len(), 1, "{}", desk.text());
}

#[test]
fn shoes_and_reach_are_seen_to_scale_on_request() {
    let mut desk = Desk::map();
    assert!(!desk.designer().canvas.scale.shoes && !desk.designer().canvas.scale.reach);
    for name in ["Shoes in true size", "How far feet reach"] {
        desk.click("Show");
        desk.click(name);
        desk.key(Key::Escape);
    }
    assert!(desk.designer().canvas.scale.shoes && desk.designer().canvas.scale.reach);
    assert_eq!(
        desk.designer().canvas.scale.shoes(desk.designer().layout(), None).len(),
        2,
        "a pair on the place to stand"
    );
}
