//! Copying to and pasting from the clipboard of the system.

use eframe::egui::OutputCommand;

use super::*;

impl Desk {
    /// The text that the window copies to the clipboard on `event`.
    fn copied(&mut self, event: Event) -> Option<String> {
        self.window.event(event);
        self.window.run_steps(1);
        let commands = &self.window.output().platform_output.commands;
        let text = commands.iter().find_map(|command| match command {
            OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        });
        self.window.run_steps(2);
        text
    }

    fn pick(&mut self, name: &str) {
        let place = self.place(name);
        self.drag(place, place);
    }

    fn paste(&mut self, text: &str) {
        self.window.event(Event::Paste(text.into()));
        self.window.run_steps(3);
    }
}

#[test]
fn a_control_is_copied_as_the_text_of_its_file() {
    let mut desk = Desk::map();
    desk.pick("home");
    let text = desk.copied(Event::Copy).unwrap();
    assert!(text.contains("(id: \"home\", kind: \"round_button\""), "{text}");
    assert!(
        desk.text().contains(text.lines().last().unwrap().trim_end_matches(',')),
        "as it is written: {text}"
    );
}

#[test]
fn a_control_that_was_copied_from_a_file_elsewhere_is_pasted() {
    let mut desk = Desk::map();
    let before = desk.designer().layout().widgets.len();
    desk.paste("  (id: \"other\", kind: \"button\", at: (4, 4), size: (0.6, 0.6), label: \"B\"), // from elsewhere\n");
    assert_eq!(desk.designer().layout().widgets.len(), before + 1);
    assert!(desk.text().contains("// from elsewhere"), "{}", desk.text());
    // The clipboard may hold a place to stand, which has no kind, and several records.
    desk.paste("(at: (4, 0.5), size: (1, 1), label: \"B\"),\n(id: \"third\", kind: \"button\", at: (1, 5), size: (0.5, 0.5), label: \"C\")");
    assert_eq!(desk.designer().layout().stances.len(), 2, "{}", desk.text());
    assert_eq!(desk.designer().layout().widgets.len(), before + 2);
}

#[test]
fn text_that_is_no_control_is_refused_and_nothing_is_changed() {
    let mut desk = Desk::map();
    let first = desk.text();
    let long = "(".repeat(100_000);
    for foreign in ["Dear all, see you at 5 (room B).", "", "{\"id\": 1}", "12, 13", "<svg/>", "(((((", &long]
    {
        desk.paste(foreign);
        assert_eq!(desk.text(), first, "{foreign:.40}");
        assert!(desk.says("Nothing is pasted"), "{foreign:.40}");
        // The message stays until the next action.
        desk.command(Modifiers::COMMAND, Key::S);
        desk.key(Key::Escape);
    }
    // A record of another type gets the same message as in a file.
    desk.paste("(name: \"x\", force: 3)");
    assert_eq!(desk.text(), first);
}

#[test]
fn copying_nothing_leaves_the_clipboard_as_it_is() {
    let mut desk = Desk::map();
    desk.key(Key::Escape);
    assert_eq!(desk.copied(Event::Copy), None);
    assert_eq!(desk.copied(Event::Cut), None);
}

#[test]
fn a_control_that_is_cut_out_goes_with_its_comments_and_comes_back_with_them() {
    let mut desk = Desk::map();
    let comment = "// Panning: four buttons";
    assert!(desk.text().contains(comment));
    desk.pick("pan_north");
    let cut = desk.copied(Event::Cut).unwrap();
    assert!(cut.contains(comment) && cut.contains("pan_north"), "{cut}");
    assert!(!desk.text().contains(comment) && !desk.text().contains("pan_north"), "{}", desk.text());
    desk.paste(&cut);
    assert_eq!(desk.text().matches(comment).count(), 1, "{}", desk.text());
}
