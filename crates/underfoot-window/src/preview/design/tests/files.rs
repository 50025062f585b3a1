//! Files, drafts, and concurrent changes by other programs.

use super::*;

#[test]
fn a_draft_is_offered_and_a_change_outside_is_merged() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.ron");
    let text = builtin_layout("map").unwrap();
    std::fs::write(&path, text).unwrap();
    std::fs::write(folder.path().join(".mine.ron.draft"), text.replace("\"Home\"", "\"Start\"")).unwrap();
    let mut desk = Desk::on(text, Some(path.clone()));
    desk.click("Recover the draft");
    assert!(desk.text().contains("\"Start\""));
    std::fs::write(&path, text.replace("\"Zoom\"", "\"Scale\"")).unwrap();
    desk.news.send(LayoutNews::Changed).unwrap();
    desk.window.run_steps(2);
    assert!(desk.text().contains("\"Start\"") && desk.text().contains("\"Scale\""));
    desk.command(Modifiers::COMMAND, Key::S);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), desk.text());
}

#[test]
fn what_was_never_saved_is_offered_at_the_next_start() {
    let state = tempfile::tempdir().unwrap();
    let folder = state.path().to_path_buf();
    let mut desk = Desk::with(builtin_layout("map").unwrap(), None, state);
    let home = desk.place("home");
    desk.drag(home, home + vec2(0.0, -90.0));
    desk.window.run_steps(130);
    let text = desk.text();
    // The window closes, but its folder stays.
    let Desk { window, state, .. } = desk;
    drop(window);
    let mut desk = Desk::with(builtin_layout("map").unwrap(), None, state);
    assert!(folder.join("untitled-1/.untitled.ron.draft").exists());
    desk.click("Recover the draft");
    assert_eq!(desk.text(), text);
}

#[test]
fn a_file_that_is_saved_outside_is_taken_in_while_feet_try_the_layout() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.ron");
    let text = builtin_layout("map").unwrap();
    std::fs::write(&path, text).unwrap();
    let mut desk = Desk::on(text, Some(path.clone()));
    let home = desk.place("home");
    desk.drag(home, home + vec2(0.0, -90.0));
    let moved = desk.area("home");
    desk.key(Key::F2);
    std::fs::write(&path, text.replace("\"Zoom\"", "\"Scale\"")).unwrap();
    desk.news.send(LayoutNews::Changed).unwrap();
    desk.window.run_steps(2);
    let Some(PreviewCommand::Try { layout, cause, .. }) = desk.commands.try_iter().last() else { panic!() };
    assert_eq!(cause, crate::preview::LayoutCause::Saved);
    let area = |id| layout.widgets[layout.widget_index(id).unwrap()].area;
    assert!(area("home") == moved && layout.widgets.iter().any(|widget| widget.label == "Scale"));
    // A file that cannot be read is reported and changes nothing.
    std::fs::write(&path, "Layout(").unwrap();
    desk.news.send(LayoutNews::Changed).unwrap();
    desk.window.run_steps(2);
    assert!(desk.window.query_all_by_label_contains("mine.ron has problems").next().is_some());
    assert_eq!(desk.area("home"), moved);
}

#[test]
fn a_template_is_begun_with_and_saved_under_a_path_that_is_typed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("new.ron");
    let mut desk = Desk::map();
    for entry in ["File", "New", Template::Empty.name()] {
        desk.click(entry);
    }
    assert!(desk.designer().layout().widgets.is_empty());
    desk.command(Modifiers::COMMAND, Key::S);
    desk.window.get_by_label("Path").focus();
    desk.window.run_steps(2);
    desk.command(Modifiers::COMMAND, Key::A);
    desk.window.event(Event::Text(path.display().to_string()));
    desk.window.run_steps(2);
    desk.click("Save as it");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), desk.text());
    assert!(desk.window.query_all_by_label_contains("Saved in").next().is_some());
    assert!(desk.window.query_by_label("Path").is_none());
}

#[test]
fn enter_in_a_path_does_what_it_was_asked_for_and_escape_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("new.ron");
    let mut desk = Desk::map();
    let type_path = |desk: &mut Desk, modifiers, key| {
        desk.command(modifiers, key);
        // The field has the keyboard focus at once.
        desk.command(Modifiers::COMMAND, Key::A);
        desk.window.event(Event::Text(path.display().to_string()));
        desk.window.run_steps(2);
    };
    type_path(&mut desk, Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    desk.key(Key::Escape);
    assert!(!path.exists() && desk.window.query_by_label("Path").is_none());
    type_path(&mut desk, Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    desk.key(Key::Enter);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), desk.text());
    assert!(desk.window.query_by_label("Path").is_none());
    let text = desk.text().replace("\"Home\"", "\"Start\"");
    std::fs::write(&path, &text).unwrap();
    let mut desk = Desk::map();
    type_path(&mut desk, Modifiers::COMMAND, Key::O);
    desk.key(Key::Enter);
    assert_eq!(desk.text(), text);
    // A failure to open is reported, and the path can be typed again.
    desk.command(Modifiers::COMMAND, Key::O);
    desk.command(Modifiers::COMMAND, Key::A);
    desk.window.event(Event::Text("/nonexistent/it.ron".into()));
    desk.window.run_steps(2);
    desk.key(Key::Enter);
    assert!(desk.says("can't be opened") && desk.window.query_by_label("Path").is_some());
    assert_eq!(desk.text(), text);
}

#[test]
fn of_two_changes_to_the_same_lines_a_person_chooses() {
    let text = builtin_layout("map").unwrap();
    for (answer, kept) in [("Keep mine", "\"Mine\""), ("Take theirs", "\"Theirs\"")] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("mine.ron");
        std::fs::write(&path, text).unwrap();
        let mut desk = Desk::on(text, Some(path.clone()));
        let home = desk.place("home");
        desk.drag(home, home);
        desk.field("label").focus();
        desk.window.run_steps(2);
        keyboard::fill(&mut desk, "Mine");
        std::fs::write(&path, text.replace("\"Home\"", "\"Theirs\"")).unwrap();
        desk.news.send(LayoutNews::Changed).unwrap();
        desk.window.run_steps(3);
        assert!(desk.window.query_all_by_label_contains("as well, and saved it").next().is_some());
        desk.click(answer);
        assert!(desk.text().contains(kept), "{answer}: {}", desk.text());
        assert!(desk.window.query_by_label("Keep mine").is_none());
    }
}

/// A file of the desktop that is dropped on the window.
#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

#[test]
fn a_file_that_is_dropped_on_the_window_is_opened_and_one_that_is_no_layout_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("dropped.ron");
    let text = builtin_layout("map").unwrap().replace("\"Home\"", "\"Start\"");
    std::fs::write(&path, &text).unwrap();
    let mut desk = Desk::map();
    let drop = |desk: &mut Desk, path: PathBuf| {
        let file = Arc::new(Dropped(path));
        desk.window.input_mut().dropped_files.push(file);
        desk.window.run_steps(2);
    };
    drop(&mut desk, path.clone());
    assert_eq!(desk.text(), text);
    let tried = desk.commands.try_iter().find_map(|command| match command {
        PreviewCommand::Try { layout, .. } => Some(layout),
        _ => None,
    });
    let layout = tried.expect("feet try it at once");
    assert!(layout.widgets.iter().any(|widget| widget.label == "Start"));
    drop(&mut desk, folder.path().join("gone.ron"));
    assert_eq!(desk.text(), text, "nothing is lost");
    assert!(desk.window.query_all_by_label_contains("gone.ron").next().is_some());
}
