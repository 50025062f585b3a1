//! Design mode: the layout on the screen is edited, by mouse, keyboard and as text.
//!
//! What edits mean and which bytes they change is [`crate::edit`]'s; here is only what is seen and touched.

mod bar;
mod canvas;
mod inspector;
mod palette;
#[cfg(test)]
mod tests;
mod text;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::{self, Key, Modifiers, Ui};
use glam::Vec2;

use super::app::App;
use super::feed::{PreviewCommand, Warnings};
use crate::edit::{Address, Document, Edit, Item, LayoutFile, List, Refusal, Saving};
use crate::ergonomics::Finding;
use crate::floor::{Floor, Rect};
use crate::layout::Layout;
use crate::scene::Scene;
use crate::schema::{self, Kinds};

/// How long a draft may be behind, in seconds.
const DRAFT_S: f64 = 2.0;

/// How often the file is looked at for what other programs write, in seconds.
const LOOK_S: f64 = 0.5;

/// How far an arrow key moves, in metres; with Shift, and with Alt.
const NUDGE_M: [f32; 3] = [0.01, 0.05, 0.001];

/// What Design mode begins with.
pub struct DesignInput {
    /// What messages call the layout.
    pub name: String,
    /// Its text.
    pub text: String,
    /// Its file; `None` for a layout that has none, such as a shipped one.
    pub path: Option<PathBuf>,
    /// The kinds that controls can be made of.
    pub kinds: Arc<Kinds>,
}

/// The layout that is edited, and what is selected and under way.
pub(super) struct Designer {
    pub(super) is_open: bool,
    document: Document,
    file: LayoutFile,
    /// The revision that `items`, `findings` and `text` belong to.
    seen: Option<u64>,
    items: Vec<Item>,
    findings: Vec<Finding>,
    selected: Vec<Address>,
    /// The number of the page that is shown.
    page: usize,
    gesture: canvas::Gesture,
    /// What is put down with the next click.
    placing: Option<palette::Thing>,
    view: canvas::Zoom,
    scene: Scene,
    stroke: u64,
    /// What could not be done, or was.
    message: Option<Message>,
    text: text::Editor,
    /// The path that is asked for, while it is.
    asking: Option<Asking>,
    /// What is left of an earlier window, until it is taken up or put away.
    left_over: Option<String>,
    /// What another program has written where this one has as well.
    conflict: Option<(String, Vec<String>)>,
    drafted_s: f64,
    looked_s: f64,
    inspector: inspector::Inspector,
}

/// A sentence about what was done.
struct Message {
    text: String,
    is_bad: bool,
}

/// A path that is being typed.
struct Asking {
    to: Ask,
    path: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ask {
    Open,
    SaveAs,
}

impl Designer {
    /// `None` for a layout that can't be read: there is nothing to edit then.
    pub(super) fn new(input: &DesignInput, floor: &Arc<Floor>) -> Option<Self> {
        let document = Document::read(&input.name, &input.text, &input.kinds, floor).ok()?;
        let file = match &input.path {
            Some(path) => LayoutFile::open(path).map(|(file, _)| file).ok()?,
            None => LayoutFile::untitled(Path::new(""), &input.text),
        };
        let left_over = file.left_over().ok().flatten();
        Some(Self {
            is_open: false,
            document,
            file,
            seen: None,
            items: Vec::new(),
            findings: Vec::new(),
            selected: Vec::new(),
            page: 0,
            gesture: canvas::Gesture::None,
            placing: None,
            view: canvas::Zoom::default(),
            scene: Scene::new(),
            stroke: 0,
            message: None,
            text: text::Editor::default(),
            asking: None,
            left_over,
            conflict: None,
            drafted_s: 0.0,
            looked_s: 0.0,
            inspector: inspector::Inspector::default(),
        })
    }

    pub(super) fn layout(&self) -> &Layout {
        self.document.layout()
    }

    /// Whether everything is in the file.
    fn is_saved(&self) -> bool {
        self.file.holds(&self.document.file_text())
    }

    fn say(&mut self, text: impl Into<String>) {
        self.message = Some(Message { text: text.into(), is_bad: false });
    }

    fn complain(&mut self, text: impl Into<String>) {
        self.message = Some(Message { text: text.into(), is_bad: true });
    }

    /// Does `edits`, or says why not; whether they were done.
    fn edit(&mut self, edits: &[Edit]) -> bool {
        self.edit_in(edits, None)
    }

    fn edit_in(&mut self, edits: &[Edit], stroke: Option<u64>) -> bool {
        let done = self.document.edit_in(edits, stroke);
        self.tell(done)
    }

    fn tell(&mut self, done: Result<(), Refusal>) -> bool {
        match done {
            Ok(()) => self.message = None,
            Err(refusal) => self.complain(refusal.short()),
        }
        self.message.is_none()
    }

    /// What belongs to the present text.
    fn refresh(&mut self) {
        if self.seen == Some(self.document.revision()) {
            return;
        }
        self.seen = Some(self.document.revision());
        self.items = self.document.items();
        self.findings = self.document.findings();
        self.selected.retain(|address| self.document.span(address).is_some());
        self.page = self.page.min(self.layout().pages.len().saturating_sub(1));
    }

    fn item(&self, record: &Address) -> Option<&Item> {
        self.items.iter().find(|item| item.record == *record)
    }

    fn selected_items(&self) -> Vec<&Item> {
        let inner = |one: &&Address| !self.selected.iter().any(|other| other != *one && one.is_within(other));
        self.selected.iter().filter(inner).filter_map(|record| self.item(record)).collect()
    }

    fn select_only(&mut self, record: Address) {
        if let Some(page) = record.page() {
            self.page = page;
        }
        self.selected = vec![record];
    }

    /// Gives what is selected new areas.
    fn move_to(&mut self, areas: &[Rect]) {
        let items = self.selected_items();
        let moved: Vec<(&Item, Rect)> = items.into_iter().zip(areas.iter().copied()).collect();
        match self.document.placing(&moved) {
            Ok(edits) => drop(self.edit(&edits)),
            Err(refusal) => self.complain(refusal.short()),
        }
    }

    fn nudge(&mut self, by: Vec2) {
        let items = self.selected_items();
        let moved: Vec<(&Item, Rect)> =
            items.iter().map(|item| (*item, Rect::new(item.area.min + by, item.area.max + by))).collect();
        let edits = self.document.placing(&moved);
        match edits {
            // Steps of a key that is held are one.
            Ok(edits) => drop(self.edit_in(&edits, Some(self.stroke))),
            Err(refusal) => self.complain(refusal.short()),
        }
    }

    fn delete(&mut self) {
        let edits = self.document.deleting(&self.selected);
        if self.edit(&edits) {
            self.selected.clear();
        }
    }

    fn turn(&mut self) {
        let edits = self.document.turning(&self.selected_items());
        match edits {
            Ok(edits) => drop(self.edit(&edits)),
            Err(refusal) => self.complain(refusal.short()),
        }
    }

    /// Copies beside what is selected: on the first side where there is room.
    fn duplicate(&mut self) {
        let Some(bounds) = self.document.bounds_of(&self.items, &self.selected) else { return };
        let text = |designer: &Self, by: Vec2| designer.document.duplicating(&designer.selected, by);
        self.put_beside(bounds.size(), text);
    }

    fn paste(&mut self, pasted: &str) {
        let parent = self.layout().pages.get(self.page).map(|_| Address::of(List::Pages, self.page));
        let parent = parent.unwrap_or(Address::LAYOUT);
        let list = if pasted.contains("kind") { List::Widgets } else { List::Stances };
        self.put_beside(Vec2::splat(0.16), |designer, by| {
            designer.document.pasting(pasted, &parent, list, by)
        });
    }

    /// Tries places one `size` and 6 cm away, and further, until one will do.
    fn put_beside(
        &mut self,
        size: Vec2,
        edits: impl Fn(&Self, Vec2) -> Result<(Vec<Edit>, Vec<Address>), Refusal>,
    ) {
        /// Half a shoe, so that a foot on one does not reach the other (rule U102).
        const GAP_M: f32 = 0.06;
        let step = size + Vec2::splat(GAP_M);
        let ways = [Vec2::ZERO, Vec2::X, Vec2::NEG_Y, Vec2::NEG_X, Vec2::Y, Vec2::ONE, Vec2::NEG_ONE];
        let mut last = None;
        for far in 1..=6_u8 {
            for way in ways {
                match edits(self, way * step * f32::from(far)) {
                    Ok((edits, places)) => match self.document.edit(&edits) {
                        Ok(()) => {
                            self.message = None;
                            self.selected = places;
                            return;
                        }
                        Err(refusal) => last = Some(refusal),
                    },
                    Err(refusal) => return self.complain(refusal.short()),
                }
            }
        }
        self.complain(last.map_or_else(String::new, |refusal| refusal.short()));
    }

    fn undo(&mut self) {
        if let Err(problems) = self.document.undo() {
            self.complain(problems.to_string());
        }
    }

    fn redo(&mut self) {
        if let Err(problems) = self.document.redo() {
            self.complain(problems.to_string());
        }
    }

    fn save(&mut self) {
        let Some(path) = self.file.path().map(Path::to_path_buf) else {
            self.asking = Some(Asking { to: Ask::SaveAs, path: self.file.name() });
            return;
        };
        let text = self.document.file_text();
        match self.file.save(&text) {
            Ok(Saving::Saved) => self.say(format!("Saved in {}", path.display())),
            Ok(other) => {
                if self.take_in(other) {
                    self.save();
                }
            }
            Err(error) => self.complain(error.to_string()),
        }
    }

    /// Takes in what another program has written; whether that was merged.
    fn take_in(&mut self, saving: Saving) -> bool {
        match saving {
            Saving::Saved => false,
            Saving::Merged(text) => match self.document.write(&text, None) {
                Ok(()) => {
                    self.say(format!("{} was changed outside: both changes are here", self.file.name()));
                    true
                }
                Err(_) => {
                    let theirs = self.file.outside().ok().flatten().unwrap_or(text);
                    self.conflict = Some((theirs, Vec::new()));
                    false
                }
            },
            Saving::Conflict { theirs, records } => {
                self.conflict = Some((theirs, records));
                false
            }
        }
    }

    /// Looks after the draft and the file.
    fn keep(&mut self, now_s: f64) {
        if now_s - self.looked_s >= LOOK_S && self.conflict.is_none() {
            self.looked_s = now_s;
            if let Ok(Some(theirs)) = self.file.outside() {
                let mine = self.document.file_text();
                let saving = self.file.take_in(&mine, theirs);
                self.take_in(saving);
            }
        }
        if now_s - self.drafted_s >= DRAFT_S && self.left_over.is_none() {
            self.drafted_s = now_s;
            let text = self.document.file_text();
            if let Err(error) = self.file.keep_draft(&text) {
                self.complain(format!("no draft is kept: {error}"));
            }
        }
    }

    /// Begins with another text: a template, a file.
    fn begin(&mut self, name: &str, text: &str, file: LayoutFile) {
        let (kinds, floor) = (Arc::clone(self.document.kinds()), Arc::clone(self.document.floor()));
        match Document::read(name, text, &kinds, &floor) {
            Ok(document) => {
                let revision = self.document.revision() + 1;
                self.document = document;
                self.document.begin_at(revision);
                self.left_over = file.left_over().ok().flatten();
                (self.file, self.seen, self.conflict, self.message) = (file, None, None, None);
                self.selected.clear();
            }
            Err(problems) => self.complain(problems.to_string()),
        }
    }

    fn keys(&mut self, ui: &Ui) {
        // What is typed into a field is meant for that.
        if ui.ctx().text_edit_focused() {
            return;
        }
        let command = |key: Key| ui.input_mut(|i| i.consume_key(Modifiers::COMMAND, key));
        if ui.input_mut(|i| i.consume_key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z)) || command(Key::Y) {
            self.redo();
        }
        if command(Key::Z) {
            self.undo();
        }
        if command(Key::S) {
            self.save();
        }
        if command(Key::D) {
            self.duplicate();
        }
        if command(Key::A) {
            let page = self.page;
            let all = self
                .items
                .iter()
                .filter(|item| item.record.list() == Some(List::Widgets) && item.is_on(page));
            self.selected = all.map(|item| item.record.clone()).collect();
        }
        let pressed = |key: Key| ui.input(|i| i.key_pressed(key) && !i.modifiers.command);
        if pressed(Key::Delete) || pressed(Key::Backspace) {
            self.delete();
        }
        if pressed(Key::R) {
            self.turn();
        }
        if pressed(Key::Escape) {
            self.placing = None;
            self.gesture = canvas::Gesture::None;
            self.selected.clear();
        }
        let step = ui.input(|i| match (i.modifiers.shift, i.modifiers.alt) {
            (true, _) => NUDGE_M[1],
            (_, true) => NUDGE_M[2],
            _ => NUDGE_M[0],
        });
        // A focused list or field moves by arrows itself.
        let is_free = ui.ctx().memory(|memory| memory.focused().is_none());
        for (key, way) in [
            (Key::ArrowLeft, Vec2::NEG_X),
            (Key::ArrowRight, Vec2::X),
            (Key::ArrowDown, Vec2::NEG_Y),
            (Key::ArrowUp, Vec2::Y),
        ] {
            if (is_free || ui.input(|i| i.modifiers.command)) && ui.input(|i| i.key_pressed(key)) {
                if !ui.input(|i| {
                    i.events.iter().any(|event| matches!(event, egui::Event::Key { repeat: true, .. }))
                }) {
                    self.stroke += 1;
                }
                self.nudge(way * step);
            }
        }
        for event in ui.input(|i| i.events.clone()) {
            match event {
                egui::Event::Copy => ui.ctx().copy_text(self.document.copy(&self.selected)),
                egui::Event::Cut => {
                    ui.ctx().copy_text(self.document.copy(&self.selected));
                    self.delete();
                }
                egui::Event::Paste(text) => self.paste(&text),
                _ => {}
            }
        }
    }
}

impl App {
    /// Changes between Design and Try; what was designed is on the floor then.
    pub(super) fn turn_mode(&mut self) {
        let Some(designer) = &mut self.designer else { return };
        designer.is_open = !designer.is_open;
        if designer.is_open {
            // Nobody stands on a drawing board.
            if let Some((feet, sink)) = &mut self.feet {
                feet.lift_working();
                feet.lift_standing();
                sink.lead(0.0, &[]);
            }
        } else {
            self.try_layout();
        }
    }

    /// F2 changes the mode.
    pub(super) fn handle_mode_key(&mut self, ui: &Ui) {
        if ui.input(|i| i.key_pressed(Key::F2)) {
            self.turn_mode();
        }
    }

    /// The button that does the same.
    pub(super) fn mode_button(&mut self, ui: &mut Ui) {
        let Some(designer) = &self.designer else { return };
        let button = egui::Button::selectable(designer.is_open, "Design").frame_when_inactive(true);
        if ui.add(button).on_hover_text("Design the layout, or try it with feet; F2 does the same").clicked()
        {
            self.turn_mode();
        }
    }

    /// Goes along when another layout is put on the floor by name.
    pub(super) fn design_choice(&mut self, choice: usize) {
        let (Some(designer), Some(name)) = (&mut self.designer, self.choices.get(choice)) else { return };
        match (schema::builtin_layout(name), LayoutFile::open(Path::new(name))) {
            (_, Ok((file, text))) => designer.begin(name, &text, file),
            (Some(text), _) => designer.begin(name, text, LayoutFile::untitled(Path::new(""), text)),
            (None, Err(error)) => designer.complain(error.to_string()),
        }
    }

    /// Gives the floor the layout that is on the screen.
    fn try_layout(&mut self) {
        let Some(designer) = &self.designer else { return };
        let layout = Arc::new(designer.layout().clone());
        let name = designer.file.name();
        let warnings = Warnings::from(&designer.document.review());
        self.command(PreviewCommand::Try { layout, name, warnings });
    }

    /// The window in Design mode.
    pub(super) fn design(&mut self, ui: &mut Ui) {
        let now_s = self.now_s;
        let Some(mut designer) = self.designer.take() else { return };
        designer.refresh();
        let before = designer.document.revision();
        let theme = self.theme;
        designer.keys(ui);
        designer.bar(ui, &theme, &self.choices);
        designer.questions(ui, &theme);
        designer.palette_panel(ui, &theme, &mut self.palette);
        designer.side_panel(ui, &theme);
        designer.text_panel(ui, &theme);
        let frame = egui::Frame::new();
        egui::CentralPanel::default().frame(frame).show(ui, |ui| {
            designer.canvas(ui, &theme, &mut self.palette);
        });
        designer.keep(now_s);
        let is_changed = designer.document.revision() != before;
        self.designer = Some(designer);
        if is_changed {
            self.try_layout();
        }
    }
}
