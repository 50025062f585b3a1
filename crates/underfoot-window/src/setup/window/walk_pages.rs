//! The pages about wiring, readings and calibration, on which a person walks.

use eframe::egui::accesskit::Role;
use eframe::egui::{TextEdit, Ui, WidgetInfo};

use super::app::SetupApp;
use super::parts::{
    Wish, heading, main_button, next_button, progress, remark, results, say, side_button, tell, troubles,
};
use crate::preview::style::section;
use crate::setup::{
    SensorState, SensorView, SetupOrder, SetupStep, SetupView, StandingView, StepState, WorkView, mark_words,
};
use underfoot::floor::Floor;
use underfoot::sense::StandFit;
use underfoot::serve::{StandNews, StandTask, WiringTask};
use underfoot_scene::scene::Theme;

/// Maximum number of sensors or tiles that a list names.
const LISTED: usize = 8;

impl SetupApp {
    /// Which board reads which tiles.
    pub(super) fn wiring_page(&self, ui: &mut Ui, theme: &Theme, view: &SetupView, wishes: &mut Vec<Wish>) {
        let step = SetupStep::Wiring;
        heading(ui, theme, step);
        tell(
            ui,
            theme,
            "Step on the tile that is lit, and off again: the board that feels the step is the one there.",
        );
        troubles(ui, theme, &view.troubles);
        if let WorkView::Wiring(walk) = &view.work {
            progress(ui, walk.steps.len(), walk.length, "boards");
            if walk.task == WiringTask::KeepOff && !walk.unheard.is_empty() {
                let words = format!("Nothing has come from {}.", walk.unheard.join(", "));
                troubles(ui, theme, [&words]);
            }
            if let (WiringTask::Step(tile), Some(felt)) = (walk.task, walk.felt)
                && felt.tile != tile
            {
                let words = format!(
                    "Board {} feels {:.0} N, by the floor file on tile {}.",
                    felt.board, felt.force_n, felt.tile
                );
                say(ui, &words, 14.0, theme.warning);
            }
            if let Some(last) = walk.steps.last().filter(|last| last.board != last.found) {
                let words = format!(
                    "The step on {} was felt by board {}, not {}.",
                    last.tile, last.found, last.board
                );
                say(ui, &words, 14.0, theme.warning);
            }
        }
        let state = view.step(step).state;
        results(ui, theme, view.step(step));
        next_button(ui, theme, step, state != StepState::Open, wishes);
        if side_button(ui, "Walk again", "Begin the walk from board to board anew") {
            wishes.push(Wish::Step(step));
        }
        ui.add_space(6.0);
        let words = "Steps tell boards apart. The order of the sensors under one tile shows at the readings: press on \
                     each corner.";
        remark(ui, theme, words);
    }

    /// Readings, noise and range.
    pub(super) fn readings_page(&self, ui: &mut Ui, theme: &Theme, view: &SetupView, wishes: &mut Vec<Wish>) {
        let step = SetupStep::Readings;
        heading(ui, theme, step);
        tell(
            ui,
            theme,
            "Keep off the floor for a second: its noise is measured. Then press on each corner: the number \
                         must rise where you press.",
        );
        troubles(ui, theme, &view.troubles);
        let is_loaded =
            |view: &&SensorView| matches!(view.state, SensorState::Answers | SensorState::Saturated);
        let answers = view.sensors.iter().filter(is_loaded).count();
        progress(ui, answers, view.sensors.len(), "sensors have answered");
        if view.is_rested {
            noise_words(ui, theme, view);
        } else if !view.sensors.is_empty() {
            remark(ui, theme, "The empty floor is not measured yet: it must be quiet for a second.");
        }
        let bad: Vec<&SensorView> = view.sensors.iter().filter(|sensor| sensor.state.is_trouble()).collect();
        if !bad.is_empty() {
            section(ui, theme, "Sensors", |_| {});
        }
        for sensor in bad.iter().take(LISTED) {
            say(ui, &format!("{}: {}.", sensor_name(view, sensor), sensor.state.words()), 13.0, theme.fault);
        }
        if bad.len() > LISTED {
            remark(ui, theme, &format!("and {} more", bad.len() - LISTED));
        }
        range_words(ui, theme, view);
        results(ui, theme, view.step(step));
        next_button(ui, theme, step, true, wishes);
        ui.horizontal_wrapped(|ui| {
            if side_button(ui, "Measure again", "Measure the empty floor anew: keep off it") {
                wishes.push(Wish::Step(step));
            }
            if side_button(ui, "Take the tare", "What the empty floor reads becomes zero: keep off it") {
                wishes.push(Wish::Order(SetupOrder::TakeTare));
            }
        });
        remark(
            ui,
            theme,
            "Calibration by standing takes the tare too. Until then, forces are those of nominal sensors.",
        );
    }

    /// Calibration by standing.
    pub(super) fn standing_page(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        view: &SetupView,
        wishes: &mut Vec<Wish>,
    ) {
        let step = SetupStep::Standing;
        heading(ui, theme, step);
        if let (WorkView::Standing(walk), Some(floor)) = (&view.work, &view.floor) {
            return walking(ui, theme, walk, floor, wishes);
        }
        tell(
            ui,
            theme,
            "A person stands still on each mark for three seconds, feet together, and walks from mark to \
                         mark. The floor finds the law of each sensor from the weight and the marks.",
        );
        troubles(ui, theme, &view.troubles);
        if matches!(view.work, WorkView::Fitting) {
            return say(ui, "The laws of the sensors are being calculated.", 16.0, theme.ink);
        }
        results(ui, theme, view.step(step));
        let is_done = view.fit.is_some();
        if let (Some(fit), Some(floor)) = (&view.fit, &view.floor) {
            needy(ui, theme, fit, floor);
        }
        if view.step(step).state == StepState::Done {
            next_button(ui, theme, step, true, wishes);
        }
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            ui.label("Weight, with clothes and shoes");
            let field = ui.add(TextEdit::singleline(&mut self.weight).desired_width(56.0).hint_text("72"));
            field.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, "Weight in kilograms"));
            ui.label("kg");
        });
        let has_weight = !self.weight.trim().is_empty();
        if !view.needy.is_empty() {
            let count = view.needy.len();
            let text =
                if count == 1 { "Repeat the tile".to_owned() } else { format!("Repeat {count} tiles") };
            if main_button(ui, theme, &text, has_weight) {
                wishes.push(Wish::Stand(view.needy.clone()));
            }
            ui.horizontal_wrapped(|ui| {
                for tile in view.needy.iter().take(LISTED) {
                    if side_button(ui, &format!("Repeat {tile}"), "Stand on the marks of this tile alone") {
                        wishes.push(Wish::Stand(vec![*tile]));
                    }
                }
            });
        }
        let all = if is_done { "Stand on all marks again" } else { "Start" };
        let is_asked = if is_done {
            side_button(ui, all, "Walk over all marks once more; earlier stands count as well")
        } else {
            main_button(ui, theme, all, has_weight)
        };
        if is_asked {
            wishes.push(Wish::Stand(Vec::new()));
        }
        if view.step(step).state != StepState::Done {
            next_button(ui, theme, step, false, wishes);
        }
        remark(
            ui,
            theme,
            "Boards that send newtons calibrate themselves and need no stands. With a load cell, \
                           `underfoot calibrate curves` reads a table instead.",
        );
    }
}

/// The walk from mark to mark.
fn walking(ui: &mut Ui, theme: &Theme, walk: &StandingView, floor: &Floor, wishes: &mut Vec<Wish>) {
    progress(ui, walk.done, walk.marks.len(), "marks");
    if let Some(trouble) = &walk.trouble {
        troubles(ui, theme, [trouble]);
    }
    match walk.task {
        StandTask::KeepOff => tell(ui, theme, "Keep off the floor for two seconds: it is measured empty."),
        StandTask::Go(mark) | StandTask::Stay(mark) => {
            let words = mark_words(&mark, floor);
            let words = format!("Mark {} of {}: {words}", walk.done + 1, walk.marks.len());
            tell(ui, theme, &words);
            remark(ui, theme, "Both feet together, the cross between them.");
        }
        StandTask::Nothing => {}
    }
    match walk.news {
        Some(StandNews::Kept(_)) => say(ui, "The last stand is measured.", 15.0, theme.good),
        Some(StandNews::Saturated(_)) => {
            let words =
                "The last stand is measured, but a sensor was at the end of its range: it tells less.";
            say(ui, words, 15.0, theme.warning);
        }
        Some(StandNews::Moved(_)) => {
            say(ui, "You moved before the end: stand still for three seconds.", 15.0, theme.warning);
        }
        Some(StandNews::Elsewhere { mark, felt }) => {
            let words = format!(
                "Tile {felt} feels you, not {}: stand on the mark. If you do, check the wiring.",
                mark.tile
            );
            say(ui, &words, 15.0, theme.warning);
        }
        None => {}
    }
    ui.add_space(8.0);
    ui.horizontal_wrapped(|ui| {
        if side_button(ui, "Leave out this mark", "Go on to the next mark") {
            wishes.push(Wish::Order(SetupOrder::SkipMark));
        }
        if side_button(ui, "Use the stands so far", "End the walk here, and calculate the laws") {
            wishes.push(Wish::Order(SetupOrder::EndStanding));
        }
        if side_button(ui, "Stop", "End the walk without a result") {
            wishes.push(Wish::Step(SetupStep::Standing));
        }
    });
}

/// The sensors that need more stands.
fn needy(ui: &mut Ui, theme: &Theme, fit: &StandFit, floor: &Floor) {
    let all: Vec<_> = fit.needy().collect();
    for found in all.iter().take(LISTED) {
        let name = floor.geometry.sensor_name(found.sensor.corner);
        let uncertain = match found.determined {
            0 => "no law was found".to_owned(),
            _ => format!("its force is uncertain by {:.0} %", 100.0 * found.uncertainty),
        };
        let words = format!(
            "Sensor {} {name}: {uncertain}; at most {:.0} N were on it.",
            found.sensor.tile, found.most.0
        );
        remark(ui, theme, &words);
    }
    if all.len() > LISTED {
        remark(ui, theme, &format!("and {} more sensors", all.len() - LISTED));
    }
}

/// The name of a sensor.
fn sensor_name(view: &SetupView, sensor: &SensorView) -> String {
    let name = view.floor.as_ref().map_or("?", |floor| floor.geometry.sensor_name(sensor.sensor.corner));
    format!("Tile {} {name}", sensor.sensor.tile)
}

/// The noise of the empty floor.
fn noise_words(ui: &mut Ui, theme: &Theme, view: &SetupView) {
    let noises = view.sensors.iter().filter_map(|sensor| Some((sensor, sensor.noise_n?)));
    if let Some((sensor, noise)) = noises.max_by(|one, other| one.1.total_cmp(&other.1)) {
        let words =
            format!("Noise when empty: at most {noise:.2} N, at {}.", lower(&sensor_name(view, sensor)));
        tell(ui, theme, &words);
    }
}

fn lower(name: &str) -> String {
    name.replacen('T', "t", 1)
}

/// How much of the range of the boards the loads have used.
fn range_words(ui: &mut Ui, theme: &Theme, view: &SetupView) {
    let greatest = view.sensors.iter().filter_map(|sensor| sensor.greatest).fold(f32::MIN, f32::max);
    if greatest <= 0.0 {
        return;
    }
    let words = format!("Range: the loads so far have used {:.0} % of the full scale.", 100.0 * greatest);
    tell(ui, theme, &words);
    let is_loaded = view.sensors.iter().any(|sensor| sensor.state == SensorState::Answers);
    if is_loaded && greatest < 0.06 {
        let words = "That is little under a person: is the `full_scale` of the floor file right? Look for boards again \
                     while somebody stands on the floor, and write the file again.";
        say(ui, words, 13.5, theme.warning);
    }
}
