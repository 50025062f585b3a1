//! The panel beside the floor during a check: the task, the load, the result.

use eframe::egui::accesskit::Role;
use eframe::egui::{
    Button, Label, Margin, Panel, ProgressBar, RichText, ScrollArea, TextEdit, Ui, WidgetInfo,
};

use super::super::handheld::{PanelSheet, panel_at};
use super::super::shown::ShownFloor;
use super::super::style::{is_entered, panel_frame, quiet, section, selectable};
use super::{FloorCheck, Walk, felt_words};
use underfoot::floor::Floor;
use underfoot::layout::Colour;
use underfoot::serve::{FeltTwice, STEP_N, SensorVerdict, WalkTest, WiringTask, WiringWalk};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// A request of the user in this panel.
#[derive(Clone, Copy)]
enum Wish {
    Wiring,
    Test,
    End,
    Save,
}

impl FloorCheck {
    /// The button that begins a check, among the figures of the sensors.
    pub(in crate::preview) fn button(&mut self, ui: &mut Ui, shown: &ShownFloor) {
        ui.add_space(4.0);
        let hint =
            "Walk over the floor: find boards that have changed places, and sensors that do not answer";
        if ui.button("Check the floor…").on_hover_text(hint).clicked() {
            self.apply(Wish::Wiring, shown);
        }
    }

    /// The panel in place of the side panel, during a check; `led` if the mouse is a foot.
    pub(in crate::preview) fn panel(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        shown: &ShownFloor,
        led: bool,
        sheet: Option<PanelSheet>,
    ) {
        let mut wish = None;
        let frame = panel_frame(theme, Margin { left: 14, right: 10, top: 8, bottom: 8 });
        let half = 0.5 * ui.available_width();
        let panel = panel_at(sheet, || {
            Panel::right("check panel").resizable(true).default_size(330.0).max_size(half)
        });
        panel.frame(frame).show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.label(RichText::new("Check the floor").size(17.0).strong().color(color(theme.ink)));
            });
            ui.add(Label::new(quiet(theme, controls_words(shown))).wrap());
            ui.add_space(4.0);
            let is_wiring = matches!(self.walk, Some(Walk::Wiring(_)));
            ui.horizontal(|ui| {
                for (name, shown, hint, does) in [
                    ("Wiring", is_wiring, "One step for each board: which is where", Wish::Wiring),
                    ("Walk test", !is_wiring, "Every tile, in any order: which sensors answer", Wish::Test),
                ] {
                    if selectable(ui, shown, name, hint) {
                        wish = Some(does);
                    }
                }
                if ui.button("End").on_hover_text("Escape does the same").clicked() {
                    wish = Some(Wish::End);
                }
            });
            ui.add_space(6.0);
            ScrollArea::vertical().auto_shrink(false).show(ui, |ui| match &self.walk {
                Some(Walk::Wiring(walk)) => {
                    wiring_words(ui, theme, walk, &shown.floor, led);
                    if self.found.is_some() {
                        save_words(ui, &mut self.path, &mut wish);
                    }
                }
                Some(Walk::Test(walk)) => test_words(ui, theme, walk, &shown.floor),
                None => {}
            });
        });
        if let Some(wish) = wish {
            self.apply(wish, shown);
        }
    }

    fn apply(&mut self, wish: Wish, shown: &ShownFloor) {
        match wish {
            Wish::Wiring => {
                self.begin(Some(Walk::Wiring(Box::new(WiringWalk::new(&shown.floor)))), shown);
            }
            Wish::Test => self.begin(Some(Walk::Test(Box::new(WalkTest::new(&shown.floor)))), shown),
            Wish::End => self.begin(None, shown),
            Wish::Save => self.save(shown),
        }
    }
}

/// The state of the controls during a check.
fn controls_words(shown: &ShownFloor) -> &'static str {
    match &shown.server {
        Some(_) => "Controls are off meanwhile, also for the server’s apps. They go on at the end.",
        None => "Controls are off meanwhile. They go on at the end.",
    }
}

/// Shows the walk from board to board.
fn wiring_words(ui: &mut Ui, theme: &Theme, walk: &WiringWalk, floor: &Floor, led: bool) {
    progress(ui, walk.steps().len(), walk.length(), "boards");
    let task = match walk.task() {
        WiringTask::KeepOff => match walk.unheard().map(|board| board.to_string()).collect::<Vec<_>>() {
            silent if silent.is_empty() => "Keep off the floor for a moment.".to_owned(),
            silent => format!("Keep off the floor. Nothing has come from boards {}.", silent.join(", ")),
        },
        WiringTask::Step(tile) => format!("Step on tile {tile}."),
        WiringTask::StepOff => "Good. Step off again.".into(),
        WiringTask::Nothing => String::new(),
    };
    if !task.is_empty() {
        say(ui, &task, 19.0, theme.ink);
        let felt = walk.felt().map_or_else(|| "Nothing is felt.".to_owned(), felt_words);
        ui.add(Label::new(quiet(theme, felt)).wrap());
        if led {
            let hint = format!("A step is {STEP_N:.0} N and more: the wheel makes the mouse’s foot heavier.");
            ui.add(Label::new(quiet(theme, hint)).wrap());
        }
    }
    outcome_words(ui, theme, walk, floor);
    section(ui, theme, "Boards", |_| {});
    for step in walk.steps() {
        let (words, colour) = if step.board != step.found {
            (format!("Tile {}: felt by board {}, not {}", step.tile, step.found, step.board), theme.fault)
        } else if step.tile != step.felt {
            let words = format!(
                "Tile {}: board {} felt it on its tile {}. If that was not the tile, its channels are in another order",
                step.tile, step.board, step.felt
            );
            (words, theme.fault)
        } else {
            (format!("Tile {}: board {}", step.tile, step.board), theme.good)
        };
        say(ui, &words, 13.0, colour);
    }
}

/// Shows the result of the walk from board to board, at its end.
fn outcome_words(ui: &mut Ui, theme: &Theme, walk: &WiringWalk, floor: &Floor) {
    let (words, colour) = match walk.outcome(floor) {
        None => return,
        Some(Err(twice @ FeltTwice)) => (format!("{}.", capital(&twice.to_string())), theme.fault),
        Some(Ok(found)) if found.moved.is_empty() => {
            (format!("All {} boards are where the floor file has them.", walk.length()), theme.good)
        }
        Some(Ok(found)) => (moved_words(&found.moved), theme.warning),
    };
    say(ui, &words, 17.0, colour);
    if matches!(walk.outcome(floor), Some(Ok(found)) if found.moved.is_empty()) {
        ui.add(Label::new(quiet(theme, "Next: the walk test, over every tile.")).wrap());
    }
}

/// Shows the walk over every tile.
fn test_words(ui: &mut Ui, theme: &Theme, walk: &WalkTest, floor: &Floor) {
    let count = walk.length();
    progress(ui, walk.passed(), count, "tiles");
    let faults: Vec<_> = walk.faults().collect();
    if !walk.is_rested() {
        say(ui, "Keep off the floor for a moment.", 19.0, theme.ink);
    } else if !walk.is_done() {
        say(ui, "Walk over every tile, in any order, until each is green.", 19.0, theme.ink);
    } else if faults.is_empty() {
        say(ui, &format!("{count} of {count} tiles: every sensor answers."), 17.0, theme.good);
    } else {
        let words = format!("{} of {count} tiles are good; look at the sensors below.", walk.passed());
        say(ui, &words, 17.0, theme.warning);
    }
    if !faults.is_empty() {
        section(ui, theme, "Sensors", |_| {});
    }
    for (sensor, verdict) in faults {
        say(ui, &format!("{sensor} {}", verdict.words()), 13.0, theme.fault);
    }
    let cells = 0..floor.geometry.tile_count();
    let begun = cells.filter_map(|index| Some((index, walk.tile(index)?))).filter(|(_, sensors)| {
        let is = |wanted| sensors.contains(&wanted);
        is(SensorVerdict::Answers) && is(SensorVerdict::Untried)
    });
    let begun: Vec<_> = begun.collect();
    if !begun.is_empty() {
        section(ui, theme, "Step nearer to", |_| {});
    }
    for (index, sensors) in begun {
        let tile = floor.geometry.tile_at_index(index);
        let corners = underfoot::floor::Corner::ALL.into_iter().zip(sensors);
        let untried: Vec<&str> = corners
            .filter(|(_, verdict)| *verdict == SensorVerdict::Untried)
            .map(|(corner, _)| floor.geometry.sensor_name(corner))
            .collect();
        say(ui, &format!("{tile} {}", untried.join(", ")), 13.0, theme.quiet);
    }
}

/// Shows the path for the floor with the result of the walk.
fn save_words(ui: &mut Ui, path: &mut String, wish: &mut Option<Wish>) {
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        let label = ui.label("Floor file");
        let edit = ui.add(TextEdit::singleline(path).desired_width(170.0));
        let is_entered = is_entered(ui, &edit);
        edit.labelled_by(label.id);
        let can = !path.trim().is_empty();
        let hint =
            "Keep the floor with the boards where they were found; what the file held before is kept too";
        if ui.add_enabled(can, Button::new("Save")).on_hover_text(hint).clicked() || (can && is_entered) {
            *wish = Some(Wish::Save);
        }
    });
}

/// The boards that are interchanged, and the remedy.
fn moved_words(moved: &[(usize, usize)]) -> String {
    if let &[(one, other), (back, again)] = moved
        && (one, other) == (again, back)
    {
        return format!(
            "Boards {one} and {other} have changed places: exchange their cables, or save the floor with their \
             addresses exchanged."
        );
    }
    let moves: Vec<String> =
        moved.iter().map(|(place, found)| format!("board {found} is where {place} should be")).collect();
    format!(
        "{}: mend the cables, or save the floor with the addresses as they are.",
        capital(&moves.join(", "))
    )
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn say(ui: &mut Ui, words: &str, size: f32, colour: Colour) {
    ui.add(Label::new(RichText::new(words).size(size).color(color(colour))).wrap());
}

fn progress(ui: &mut Ui, done: usize, all: usize, what: &str) {
    let share = done as f32 / all.max(1) as f32;
    let words = format!("{done} of {all} {what}");
    let bar = ui.add(ProgressBar::new(share).text(words.clone()));
    bar.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, &words));
    ui.add_space(4.0);
}
