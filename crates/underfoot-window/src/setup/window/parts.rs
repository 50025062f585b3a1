//! The parts that all pages share: headings, sentences, buttons.

use eframe::egui::accesskit::Role;
use eframe::egui::{Button, Key, Label, ProgressBar, RichText, Ui, WidgetInfo, vec2};

use crate::preview::style::quiet;
use crate::setup::{SetupOrder, SetupStep, StepState, StepView};
use underfoot::floor::TileId;
use underfoot::layout::Colour;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// A request of the user.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Wish {
    Order(SetupOrder),
    /// Show a step, and begin it.
    Step(SetupStep),
    /// Write the floor file for the shape on display.
    WriteShape,
    /// Begin the walk over the marks of these tiles, of all without any.
    Stand(Vec<TileId>),
}

/// The heading of a page: the number and the name of its step.
pub(super) fn heading(ui: &mut Ui, theme: &Theme, step: SetupStep) {
    ui.label(quiet(theme, format!("Step {} of {}", step.index() + 1, SetupStep::ALL.len())));
    ui.label(RichText::new(step.name()).size(22.0).strong().color(color(theme.ink)));
    ui.add_space(6.0);
}

/// A sentence over as many lines as it needs.
pub(super) fn say(ui: &mut Ui, words: &str, size: f32, colour: Colour) {
    ui.add(Label::new(RichText::new(words).size(size).color(color(colour))).wrap());
}

/// A paragraph of the page.
pub(super) fn tell(ui: &mut Ui, theme: &Theme, words: &str) {
    say(ui, words, 14.5, theme.ink);
    ui.add_space(2.0);
}

/// A remark of lower priority.
pub(super) fn remark(ui: &mut Ui, theme: &Theme, words: &str) {
    say(ui, words, 13.0, theme.quiet);
}

/// The results of a step, or its troubles with their reasons.
pub(super) fn results(ui: &mut Ui, theme: &Theme, step: &StepView) {
    if step.words.is_empty() {
        return;
    }
    ui.add_space(8.0);
    let colour = match step.state {
        StepState::Done => theme.good,
        StepState::Trouble => theme.fault,
        StepState::Open => theme.ink,
    };
    for (number, words) in step.words.iter().enumerate() {
        say(ui, words, 14.0, if number == 0 { colour } else { theme.ink });
    }
}

/// Troubles, one a line.
pub(super) fn troubles<'a>(ui: &mut Ui, theme: &Theme, troubles: impl IntoIterator<Item = &'a String>) {
    troubles.into_iter().for_each(|trouble| say(ui, trouble, 14.0, theme.fault));
}

/// The button that goes on; Enter presses it while no field has the keyboard.
pub(super) fn main_button(ui: &mut Ui, theme: &Theme, text: &str, is_on: bool) -> bool {
    ui.add_space(10.0);
    let ink = if is_on { theme.legible(theme.plate, theme.accent) } else { theme.quiet };
    let mut button = Button::new(RichText::new(text).size(16.0).strong().color(color(ink)));
    if is_on {
        button = button.fill(color(theme.accent));
    }
    let size = vec2(ui.available_width().min(330.0), 40.0);
    let is_clicked = ui.add_enabled_ui(is_on, |ui| ui.add_sized(size, button).clicked()).inner;
    let is_free = ui.memory(|memory| memory.focused().is_none());
    ui.add_space(4.0);
    is_clicked || (is_on && is_free && ui.input(|i| i.key_pressed(Key::Enter)))
}

/// A button of lower priority.
pub(super) fn side_button(ui: &mut Ui, text: &str, hint: &str) -> bool {
    ui.add(Button::new(RichText::new(text).size(14.0)).min_size(vec2(0.0, 30.0)))
        .on_hover_text(hint)
        .clicked()
}

/// A bar with its words, for screen readers too.
pub(super) fn progress(ui: &mut Ui, done: usize, all: usize, name: &str) {
    let words = format!("{done} of {all} {name}");
    let bar = ui.add(ProgressBar::new(done as f32 / all.max(1) as f32).text(words.clone()));
    bar.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, &words));
    ui.add_space(4.0);
}

/// The button to the step after `step`: the one that goes on if `step` is done, another one to leave it out.
pub(super) fn next_button(
    ui: &mut Ui,
    theme: &Theme,
    step: SetupStep,
    is_done: bool,
    wishes: &mut Vec<Wish>,
) {
    let Some(next) = step.next() else { return };
    let text = format!("Next: {}", lower(next.name()));
    let is_asked = if is_done {
        main_button(ui, theme, &text, true)
    } else {
        ui.add_space(6.0);
        side_button(
            ui,
            &format!("Skip to: {}", lower(next.name())),
            "Go on to the next step; this one can be done later",
        )
    };
    if is_asked {
        wishes.push(Wish::Step(next));
    }
}

/// `name` with a small letter at its beginning.
fn lower(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}
