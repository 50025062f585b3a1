//! A report of what the window shows, for scripts that work it with real mouse and keys.
//!
//! Off unless the variable `UNDERFOOT_SCREEN_REPORT` names a folder, or the address of a page ends in `?screen_report`.
//! After each frame, each window of the program then puts a report there: the names, roles, states and places of its widgets, as screen readers get them, and how much input it has
//! taken in. A script thus finds widgets by name and waits for what it has sent, however slow the machine is.

use std::collections::HashMap;
use std::path::PathBuf;

use eframe::egui::accesskit::{Node, Toggled};
use eframe::egui::{self, Event, Key, Rect, ViewportCommand, ViewportId};
use serde_json::{Value, json};

use crate::platform;

/// Begins the reports if the user asks for them.
pub(crate) fn report_screen(ctx: &egui::Context) {
    if let Some(place) = platform::report_place() {
        ctx.add_plugin(ScreenReport::into_place(place));
    }
}

/// Writes the reports.
struct ScreenReport {
    place: PathBuf,
    /// The windows whose frames have begun and not yet ended, the innermost last.
    drawn: Vec<ViewportId>,
    taken: HashMap<ViewportId, TakenInput>,
    /// The titles of the windows; the system does not report them everywhere.
    titles: HashMap<ViewportId, String>,
    /// Whether the last report could not be written.
    has_failed: bool,
}

/// The input that a window has taken in so far.
#[derive(Clone, Debug, Default, PartialEq)]
struct TakenInput {
    frames: u64,
    /// Keys that went up; no modifiers.
    keys: u64,
    /// Typed letters.
    letters: u64,
    /// Presses and releases of mouse buttons.
    buttons: u64,
    /// Turns of the wheel.
    wheel: u64,
    pointer: Option<egui::Pos2>,
}

impl TakenInput {
    fn add(&mut self, event: &Event) {
        match event {
            Event::Key { key, pressed: false, .. } if !is_modifier(*key) => self.keys += 1,
            Event::Text(text) => self.letters += text.chars().count() as u64,
            Event::PointerButton { pos, .. } => {
                self.buttons += 1;
                self.pointer = Some(*pos);
            }
            Event::PointerMoved(at) => self.pointer = Some(*at),
            Event::MouseWheel { .. } => self.wheel += 1,
            _ => {}
        }
    }
}

const fn is_modifier(key: Key) -> bool {
    matches!(
        key,
        Key::ShiftLeft
            | Key::ShiftRight
            | Key::ControlLeft
            | Key::ControlRight
            | Key::AltLeft
            | Key::AltRight
            | Key::SuperLeft
            | Key::SuperRight
    )
}

impl ScreenReport {
    fn into_place(place: PathBuf) -> Self {
        Self { place, drawn: Vec::new(), taken: HashMap::new(), titles: HashMap::new(), has_failed: false }
    }

    /// Notes the title that the program gives a window.
    fn note_title(&mut self, of: ViewportId, output: &egui::ViewportOutput) {
        let given = output.commands.iter().rev().find_map(|command| match command {
            ViewportCommand::Title(title) => Some(title),
            _ => None,
        });
        if let Some(title) = given.or(output.builder.title.as_ref()) {
            self.titles.insert(of, title.clone());
        }
    }

    /// The report of a frame of the window `of`.
    fn report(&self, ctx: &egui::Context, of: ViewportId, output: &egui::FullOutput) -> Option<Value> {
        let tree = output.platform_output.accesskit_update.as_ref()?;
        let taken = self.taken.get(&of)?;
        let (scale, held, size) =
            ctx.input_for(of, |i| (i.pixels_per_point(), i.keys_down.len(), i.content_rect().size()));
        // The parts of widgets that scrolling and other clipping leave.
        let seen: HashMap<u64, Rect> = ctx.viewport_for(of, |state| {
            let all = state.prev_pass.widgets.layers().flat_map(|(_, widgets)| widgets.iter());
            all.map(|widget| (widget.id.value(), widget.interact_rect)).collect()
        });
        let widgets: Vec<Value> = tree
            .nodes
            .iter()
            .filter_map(|(id, node)| widget(node, seen.get(&id.0).copied(), scale, *id == tree.focus))
            .collect();
        let next_s = output.viewport_output.get(&of).map(|output| output.repaint_delay.as_secs_f64());
        // Longer than an hour is never.
        let next_s = next_s.filter(|seconds| *seconds < 3600.0);
        let pointer = taken.pointer.map(|at| [at.x * scale, at.y * scale]);
        let size = [size.x * scale, size.y * scale];
        Some(json!({
            "frame": taken.frames,
            "next_s": next_s,
            "title": self.titles.get(&of),
            "size": size,
            "keys": taken.keys,
            "keys_down": held,
            "letters": taken.letters,
            "buttons": taken.buttons,
            "wheel": taken.wheel,
            "pointer": pointer,
            "widgets": widgets,
        }))
    }
}

/// One widget: its places in pixels of the window, as a whole and the part that is seen.
fn widget(node: &Node, seen: Option<Rect>, scale: f32, has_focus: bool) -> Option<Value> {
    let name = node.label().or_else(|| node.value()).filter(|name| !name.is_empty())?;
    let bounds = node.bounds()?;
    let scale = f64::from(scale);
    let seen = seen.filter(|seen| seen.is_positive());
    let seen = seen.map(|it| [it.min.x, it.min.y, it.max.x, it.max.y].map(|at| f64::from(at) * scale));
    let place = [bounds.x0, bounds.y0, bounds.x1, bounds.y1].map(|at| at * scale);
    let (role, is_on) = (format!("{:?}", node.role()), node.toggled().map(|it| it == Toggled::True));
    Some(json!({
        "name": name,
        "role": role,
        "text": node.value(),
        "value": node.numeric_value(),
        "is_on": is_on,
        "is_off": node.is_disabled(),
        "has_focus": has_focus,
        "place": place,
        "seen": seen,
    }))
}

impl egui::Plugin for ScreenReport {
    fn debug_name(&self) -> &'static str {
        "screen report"
    }

    fn input_hook(&mut self, ctx: &egui::Context, input: &mut egui::RawInput) {
        ctx.enable_accesskit();
        self.drawn.push(input.viewport_id);
        let taken = self.taken.entry(input.viewport_id).or_default();
        taken.frames += 1;
        input.events.iter().for_each(|event| taken.add(event));
    }

    fn output_hook(&mut self, ctx: &egui::Context, output: &mut egui::FullOutput) {
        let Some(of) = self.drawn.pop() else { return };
        output.viewport_output.iter().for_each(|(of, shown)| self.note_title(*of, shown));
        let Some(report) = self.report(ctx, of, output) else { return };
        let window = (of != ViewportId::ROOT).then(|| of.0.value());
        let written = platform::put_report(&report.to_string(), &self.place, window);
        // Once: the next frame fails alike.
        if let (Err(error), false) = (&written, self.has_failed) {
            tracing::warn!("no report of the screen in {}: {error}", self.place.display());
        }
        self.has_failed = written.is_err();
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Modifiers, PointerButton, pos2, vec2};

    use super::*;

    fn key(key: Key, pressed: bool) -> Event {
        Event::Key { key, physical_key: None, pressed, repeat: false, modifiers: Modifiers::NONE }
    }

    #[test]
    fn a_script_reads_where_the_controls_are_and_that_its_input_has_come() {
        let folder = tempfile::tempdir().unwrap();
        let ctx = egui::Context::default();
        ctx.add_plugin(ScreenReport::into_place(folder.path().into()));
        let mut text = String::new();
        let read = || -> Value {
            let file = folder.path().join(format!("{}.json", std::process::id()));
            serde_json::from_str(&std::fs::read_to_string(file).unwrap()).unwrap()
        };
        let mut frame = |events: Vec<Event>| {
            let screen = Rect::from_min_size(pos2(0.0, 0.0), vec2(400.0, 300.0));
            let input = egui::RawInput { screen_rect: Some(screen), events, ..Default::default() };
            let mut drawn = ctx.run_ui(input, |ui| {
                ui.ctx().send_viewport_cmd(ViewportCommand::Title("A floor".into()));
                let _ = ui.button("Stand here");
                ui.text_edit_singleline(&mut text).request_focus();
                egui::ScrollArea::vertical().max_height(50.0).show(ui, |ui| {
                    ui.add_space(400.0);
                    let _ = ui.button("Far below");
                });
            });
            drawn.textures_delta.clear();
        };
        frame(Vec::new());
        let before = read();
        let find = |name: &str| {
            let all = before["widgets"].as_array().unwrap();
            all.iter().find(|widget| widget["name"] == name).cloned().unwrap_or_default()
        };
        let (seen, hidden) = (find("Stand here"), find("Far below"));
        assert_eq!((&seen["role"], &seen["is_off"]), (&json!("Button"), &json!(false)), "{before}");
        assert!(seen["place"][2].as_f64() > Some(20.0) && seen["seen"] == seen["place"], "{seen}");
        assert!(hidden.is_null() || hidden["seen"].is_null(), "{hidden}");
        let pos = pos2(5.0, 6.0);
        let button = |pressed| Event::PointerButton {
            pos,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        frame(vec![key(Key::A, true), Event::Text("a\u{e4}".into()), key(Key::A, false), button(true)]);
        frame(vec![button(false), key(Key::Tab, true)]);
        let after = read();
        let counts = ["keys", "letters", "buttons", "keys_down"].map(|name| after[name].as_u64());
        assert_eq!(counts, [1, 2, 2, 1].map(Some), "{after}");
        assert!(after["frame"].as_u64() >= before["frame"].as_u64().map(|frame| frame + 2), "{after}");
        assert_eq!((&after["pointer"], &after["title"]), (&json!([5.0, 6.0]), &json!("A floor")));
    }
}
