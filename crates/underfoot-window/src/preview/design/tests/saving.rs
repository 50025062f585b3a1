//! The saved state is the same in the title, in the bar, by keys, and when the window closes.

use eframe::egui::{ViewportCommand, ViewportEvent, ViewportId};

use super::*;

const MOVE: eframe::egui::Vec2 = vec2(0.0, -90.0);

impl Desk {
    fn in_file() -> (Self, PathBuf, TempDir) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mine.ron");
        let text = builtin_layout("map").unwrap();
        std::fs::write(&path, text).unwrap();
        (Self::on(text, Some(path.clone())), path, folder)
    }

    fn change(&mut self) {
        let home = self.place("home");
        self.drag(home, home + MOVE);
    }

    fn title(&self) -> &str {
        self.window.state().window.title.shown.as_deref().unwrap_or_default()
    }

    /// Requests a close, as the cross, Alt+F4 and Ctrl+Q do; returns whether the window closes.
    fn close(&mut self) -> bool {
        let window = self.window.input_mut().viewports.entry(ViewportId::ROOT).or_default();
        window.events.push(ViewportEvent::Close);
        self.window.run_steps(1);
        let is_kept = self.told(&ViewportCommand::CancelClose);
        self.window.run_steps(5);
        !is_kept
    }

    fn told(&self, command: &ViewportCommand) -> bool {
        let output = self.window.output().viewport_output.get(&ViewportId::ROOT);
        output.is_some_and(|window| window.commands.contains(command))
    }

    fn asks(&self) -> bool {
        self.window.query_by_label("Discard changes").is_some()
    }
}

#[test]
fn the_file_and_whether_it_is_saved_are_in_title_and_bar_of_both_modes() {
    let (mut desk, _, _folder) = Desk::in_file();
    assert_eq!(desk.title(), "mine.ron - underfoot");
    desk.change();
    for mode in ["Design", "Try"] {
        assert_eq!(desk.title(), "• mine.ron - underfoot", "{mode}");
        assert!(desk.window.query_by_label("• mine.ron").is_some(), "{mode}");
        desk.key(Key::F2);
    }
    desk.command(Modifiers::COMMAND, Key::Z);
    assert_eq!(desk.title(), "mine.ron - underfoot", "what was taken back is as in the file");
    assert!(desk.window.query_by_label("mine.ron").is_some());
}

#[test]
fn ctrl_s_saves_while_the_layout_is_tried() {
    let (mut desk, path, _folder) = Desk::in_file();
    desk.change();
    desk.key(Key::F2);
    assert!(!desk.window.state().is_designing());
    desk.command(Modifiers::COMMAND, Key::S);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), desk.text());
    assert_eq!(desk.title(), "mine.ron - underfoot");
    assert!(desk.says("Saved in"));
    // Without a file, saving asks for a path in this mode as well.
    let mut desk = Desk::map();
    desk.change();
    desk.key(Key::F2);
    desk.command(Modifiers::COMMAND, Key::S);
    assert!(desk.window.query_by_label("Path").is_some());
}

#[test]
fn saved_is_said_no_longer_than_it_is_so() {
    let (mut desk, _, _folder) = Desk::in_file();
    desk.change();
    desk.command(Modifiers::COMMAND, Key::S);
    assert!(desk.says("Saved in"));
    desk.change();
    assert!(!desk.says("Saved in"));
    desk.command(Modifiers::COMMAND, Key::S);
    desk.command(Modifiers::COMMAND, Key::Z);
    assert!(!desk.says("Saved in"), "also after a step back");
}

#[test]
fn a_window_without_changes_closes_unasked() {
    let (mut desk, _, _folder) = Desk::in_file();
    assert!(desk.close() && !desk.asks());
    assert!(Desk::map().close());
}

#[test]
fn a_window_with_changes_asks_and_saves_before_it_closes() {
    let (mut desk, path, _folder) = Desk::in_file();
    desk.change();
    assert!(!desk.close() && desk.asks());
    assert!(desk.says("Save mine.ron before closing?"));
    desk.window.get_by_label("Save and close").click();
    desk.window.run_steps(2);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), desk.text());
    assert!(desk.told(&ViewportCommand::Close) && desk.close());
}

#[test]
fn enter_saves_and_escape_stays() {
    let (mut desk, path, _folder) = Desk::in_file();
    desk.change();
    desk.key(Key::F2);
    assert!(!desk.close() && desk.asks(), "also while the layout is tried");
    desk.key(Key::Escape);
    assert!(!desk.asks() && !desk.told(&ViewportCommand::Close));
    assert!(!desk.close() && desk.asks(), "asked again");
    desk.key(Key::Enter);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), desk.text());
    assert!(desk.close());
}

#[test]
fn what_is_discarded_is_not_offered_again() {
    let (mut desk, path, folder) = Desk::in_file();
    let before = std::fs::read_to_string(&path).unwrap();
    desk.change();
    desk.window.run_steps(130);
    let draft = folder.path().join(".mine.ron.draft");
    assert!(draft.exists());
    desk.close();
    desk.click("Discard changes");
    assert!(desk.close());
    desk.window.run_steps(130);
    assert_eq!((std::fs::read_to_string(&path).unwrap(), draft.exists()), (before, false));
}

#[test]
fn a_layout_without_a_file_is_asked_for_one_before_the_window_closes() {
    let mut desk = Desk::map();
    let path = desk.state.path().join("new.ron");
    desk.change();
    desk.close();
    desk.click("Save and close");
    desk.window.get_by_label("Path").focus();
    desk.window.run_steps(2);
    desk.command(Modifiers::COMMAND, Key::A);
    desk.window.event(Event::Text(path.display().to_string()));
    desk.window.run_steps(2);
    desk.key(Key::Enter);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), desk.text());
    assert!(desk.close());
    // Without a path, the window stays open.
    let mut desk = Desk::map();
    desk.change();
    desk.close();
    desk.click("Save and close");
    desk.key(Key::Escape);
    desk.window.run_steps(3);
    assert!(!desk.close() && desk.asks());
}

#[test]
fn what_is_being_typed_when_the_window_is_closed_is_not_lost() {
    let (mut desk, _, _folder) = Desk::in_file();
    let home = desk.place("home");
    desk.drag(home, home);
    desk.field("label").focus();
    desk.window.run_steps(2);
    desk.command(Modifiers::COMMAND, Key::A);
    desk.window.event(Event::Text("Start".into()));
    desk.window.run_steps(1);
    assert!(!desk.close() && desk.asks());
    assert!(desk.text().contains("\"Start\""));
}

#[test]
fn ctrl_q_asks_as_the_frame_of_the_window_does() {
    let (mut desk, _, _folder) = Desk::in_file();
    let (key, modifiers) = (Key::Q, Modifiers::COMMAND);
    let event = Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers };
    let input = desk.window.input_mut();
    input.events.push(event);
    desk.window.run_steps(1);
    assert!(desk.told(&ViewportCommand::Close));
}

#[test]
fn a_file_that_is_not_there_yet_is_begun() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("new.ron");
    let empty = Template::Empty.text(&Floor::default().geometry);
    let mut desk = Desk::begun(&empty, &path);
    assert_eq!(desk.title(), "new.ron - underfoot");
    assert!(desk.says("new.ron is new"));
    assert!(desk.close(), "nothing would be lost");
    assert!(!path.exists());
    desk.window.get_by_label("Put down: button").focus();
    desk.window.run_steps(1);
    desk.key(Key::Enter);
    assert!(!desk.says("new.ron is new"));
    desk.command(Modifiers::COMMAND, Key::S);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), desk.text());
}
