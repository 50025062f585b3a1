//! The side panel's control: the forces of its presses, and a threshold derived from them.

use eframe::egui::accesskit::Role;
use eframe::egui::{
    Align2, Button, CollapsingHeader, CornerRadius, FontId, Key, Label, Modifiers, Rect, RichText, Sense,
    Stroke, Ui, WidgetInfo, pos2, vec2,
};

use super::super::design::{Designer, Threshold, set_threshold, undo_design};
use super::super::handheld::is_for_fingers;
use super::super::plots::Plots;
use super::super::presses::{ControlPress, PressLog};
use super::super::selection::Selection;
use super::super::shown::ShownFloor;
use super::super::style::{panel_colour, plot_button, quiet, row, section};
use underfoot::units::Newtons;
use underfoot::widget::{Thresholds, WidgetId};
use underfoot_scene::egui_painter::color;
use underfoot_scene::ergonomics::{PressSpread, propose_press};
use underfoot_scene::scene::{Theme, in_drawn_order};

/// Height of the strip of presses, in points.
const STRIP: f32 = 40.0;

/// Maximum number of presses in the list.
const LISTED: usize = 12;

/// Height of the message below, in points: constant for all messages.
const WORDS: f32 = 34.0;

/// Explains how people are counted.
const PEOPLE: &str =
    "Presses that count. People as the floor tells them apart: who leaves the floor counts anew.";

/// Explains the strip.
const SHOWN: &str = "Each press a dot: green was answered, orange too light or too short, hollow does not count. \
                     Grey box: from quartile to quartile, with the median. Lines: where it lets go, and what it takes.";

/// A request of the user in this part.
#[derive(Clone, Copy)]
enum Wish {
    /// Set the threshold, and save the layout if `saves`.
    Use {
        press: Newtons,
        saves: bool,
    },
    Save,
    Forget,
    Count(usize, bool),
    Undo,
}

/// The presses of the selected control; `designer` sets its threshold.
pub(super) fn presses_part(
    ui: &mut Ui,
    theme: &Theme,
    shown: &ShownFloor,
    selection: &Selection,
    presses: &mut PressLog,
    plots: &mut Plots,
    designer: Option<&mut Designer>,
) {
    let layout = shown.layout();
    let Some(widget) = selection.control_of(layout) else { return };
    let (id, thresholds) = (widget.id.clone(), widget.behaviour.thresholds());
    let title = if widget.label.is_empty() { id.to_string() } else { in_drawn_order(&widget.label).into() };
    let mut is_plotted = false;
    let mut wish = None;
    let has_presses = presses.of(&id).next().is_some();
    section(ui, theme, &format!("Control {title}"), |ui| {
        is_plotted = plot_button(ui, id.as_str());
        let forget = Button::new("Forget");
        let forget = if is_for_fingers(ui) { forget } else { forget.small() };
        let forget = ui.add_enabled(has_presses, forget);
        forget.widget_info(|| WidgetInfo::labeled(Role::Button, has_presses, "Forget presses"));
        if forget.on_hover_text("Forget the presses of this control").clicked() {
            wish = Some(Wish::Forget);
        }
    });
    if is_plotted {
        plots.add_control(layout, &id);
    }
    let (forces, people) = presses.counted(&id);
    let spread = PressSpread::of(&forces);
    let all: Vec<&ControlPress> = presses.of(&id).collect();
    strip(ui, theme, &all, spread.as_ref(), thresholds);
    for line in lines(spread.as_ref(), people) {
        ui.add(Label::new(quiet(theme, line).size(12.5)).truncate()).on_hover_text(PEOPLE);
    }
    let proposal = propose_press(&forces);
    let told = presses.told.as_ref().filter(|(told, _)| *told == id);
    let force = proposal.map(|proposal| proposal.press);
    let chosen = ui.horizontal(|ui| threshold_buttons(ui, force, told.is_some(), designer.as_deref()));
    wish = chosen.inner.or(wish);
    let words = match (told, proposal) {
        (Some((_, told)), _) => told.clone(),
        (None, None) => {
            "shown is the control pressed last, or pinned by Shift-click; press it as people will".into()
        }
        (None, Some(proposal)) if proposal.missed > 0 => {
            format!("{} of these no heavier than a foot at rest", proposal.missed)
        }
        (None, Some(proposal)) if proposal.is_resting_force => "what a foot at rest bears, 35 N".into(),
        (None, Some(_)) => "half of the lightest".into(),
    };
    ui.allocate_ui(vec2(ui.available_width(), WORDS), |ui| {
        ui.set_min_height(WORDS);
        let ink = if told.is_some() { theme.ink } else { theme.quiet };
        ui.add(Label::new(RichText::new(words).size(12.5).color(color(ink))).wrap());
    });
    CollapsingHeader::new("Press by press").id_salt("presses").show_unindented(ui, |ui| {
        if all.is_empty() {
            ui.label(quiet(theme, "none yet"));
        }
        for (number, press) in all.iter().take(LISTED).enumerate() {
            if let Some(counts) = listed(ui, theme, press) {
                wish = Some(Wish::Count(number, counts));
            }
        }
    });
    if let Some(wish) = wish {
        grant(&id, wish, shown, presses, designer);
    }
}

/// The buttons that set the threshold to `force`, and once it is set, take it back or save it.
fn threshold_buttons(
    ui: &mut Ui,
    force: Option<Newtons>,
    is_set: bool,
    designer: Option<&Designer>,
) -> Option<Wish> {
    let mut wish = None;
    let can_set = designer.is_some() && force.is_some();
    let text = force.map_or("Use this press".into(), |force| format!("Use this press: {:.0} N", force.0));
    let button = ui.add_enabled(can_set, Button::new(text));
    button.widget_info(|| WidgetInfo::labeled(Role::Button, can_set, "Use this press"));
    let hint = "Half of the lightest press that counts, no less than the 35 N of a foot at rest";
    if button.on_hover_text(hint).clicked() {
        wish = force.map(|press| Wish::Use { press, saves: false });
    }
    if !is_set {
        let hint = "The same, and saves the layout, as Ctrl+S does";
        let button = ui.add_enabled(can_set, Button::new("Use and save")).on_hover_text(hint);
        return if button.clicked() { force.map(|press| Wish::Use { press, saves: true }) } else { wish };
    }
    if ui.button("Undo").on_hover_text("Take the threshold back; Ctrl+Z does the same").clicked() {
        wish = Some(Wish::Undo);
    }
    let is_unsaved = designer.is_some_and(|designer| !designer.is_saved());
    if is_unsaved && ui.button("Save").on_hover_text("Ctrl+S does the same").clicked() {
        wish = Some(Wish::Save);
    }
    wish
}

fn grant(
    id: &WidgetId,
    wish: Wish,
    shown: &ShownFloor,
    presses: &mut PressLog,
    mut designer: Option<&mut Designer>,
) {
    match wish {
        Wish::Use { press, saves } => {
            let told = set_threshold(designer.as_deref_mut(), shown, id, Threshold::Press, press);
            presses.told = Some((id.clone(), told));
            if let Some(designer) = designer.filter(|_| saves) {
                designer.save();
            }
        }
        Wish::Save => {
            if let Some(designer) = designer {
                designer.save();
            }
        }
        Wish::Forget => presses.forget(id),
        Wish::Count(number, counts) => presses.let_count(id, number, counts),
        Wish::Undo => undo_here(shown, presses, designer),
    }
}

fn undo_here(shown: &ShownFloor, presses: &mut PressLog, designer: Option<&mut Designer>) {
    if designer.is_some_and(|designer| undo_design(designer, shown)) {
        presses.told = None;
    }
}

/// Ctrl+Z undoes the last threshold that was set here, in Try mode and outside text fields.
pub(in crate::preview) fn handle_undo_key(
    ui: &Ui,
    shown: &ShownFloor,
    presses: &mut PressLog,
    designer: Option<&mut Designer>,
) {
    let is_free = designer.as_ref().is_none_or(|designer| !designer.is_open) && !ui.ctx().text_edit_focused();
    if is_free && ui.input_mut(|i| i.consume_key(Modifiers::COMMAND, Key::Z)) {
        undo_here(shown, presses, designer);
    }
}

/// Describes the forces of the presses in two lines.
fn lines(spread: Option<&PressSpread>, people: usize) -> [String; 2] {
    let Some(spread) = spread else { return ["no presses yet".into(), String::new()] };
    let presses = if spread.count == 1 { "1 press".into() } else { format!("{} presses", spread.count) };
    let of = match people {
        0 => String::new(),
        1 => " by 1 person".into(),
        people => format!(" by {people} people"),
    };
    let [lowest, lower, median, upper, highest] =
        [spread.lowest, spread.lower_quartile, spread.median, spread.upper_quartile, spread.highest]
            .map(|force| format!("{:.0}", force.0));
    [
        format!("{presses}{of}: median {median} N"),
        format!("{lowest} to {highest} N, quartiles {lower} and {upper} N"),
    ]
}

/// Draws presses along an axis in newtons, with the thresholds.
fn strip(
    ui: &mut Ui,
    theme: &Theme,
    all: &[&ControlPress],
    spread: Option<&PressSpread>,
    thresholds: Thresholds,
) {
    let Thresholds { press, release, .. } = thresholds;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), STRIP), Sense::hover());
    let spoken = format!("takes {:.0} newtons, lets go below {:.0}", press.0, release.0);
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &spoken));
    response.on_hover_text(SHOWN);
    let painter = ui.painter_at(rect);
    let ground = Rect::from_min_max(rect.min, pos2(rect.right(), rect.bottom() - 14.0));
    painter.rect_filled(ground, CornerRadius::same(4), color(theme.plate));
    let heaviest =
        all.iter().map(|press| press.force.0).filter(|force| force.is_finite()).fold(0.0, f32::max);
    // In steps, so that the axis stays the same from press to press.
    let most = [100.0, 200.0, 400.0, 800.0].into_iter().find(|most| *most >= heaviest.max(1.25 * press.0));
    let most = most.unwrap_or(1600.0);
    let inner = ground.x_range().shrink(8.0);
    let x = |force: Newtons| inner.min + inner.span() * (force.0 / most).clamp(0.0, 1.0);
    let middle = ground.center().y;
    painter.hline(inner, middle, Stroke::new(1.0, color(theme.line)));
    if let Some(spread) = spread.filter(|spread| spread.count > 1) {
        let quartiles = Rect::from_min_max(
            pos2(x(spread.lower_quartile), middle - 6.0),
            pos2(x(spread.upper_quartile), middle + 6.0),
        );
        painter.rect_filled(quartiles, 3, color(panel_colour(theme).mix(theme.ink, 0.12)));
        let median = Stroke::new(2.0, color(theme.quiet));
        painter.vline(x(spread.median), (middle - 7.0)..=(middle + 7.0), median);
    }
    for (force, colour) in [(release, theme.quiet), (press, theme.accent)] {
        painter.vline(x(force), ground.y_range(), Stroke::new(1.5, color(colour)));
    }
    for one in all.iter().rev() {
        let at = pos2(x(one.force), middle);
        let ink = color(if one.why.is_some() { theme.warning } else { theme.good });
        if one.counts {
            painter.circle(at, 3.5, ink, Stroke::new(1.0, color(theme.plate)));
        } else {
            painter.circle_stroke(at, 3.0, Stroke::new(1.2, ink));
        }
    }
    let font = FontId::proportional(11.5);
    let write = |at: f32, anchor: Align2, text: String, colour| {
        painter.text(pos2(at, rect.bottom()), anchor, text, font.clone(), color(colour));
    };
    // The labels avoid the ends of the axis and each other.
    let at = x(press).clamp(rect.left() + 66.0, rect.right() - 76.0);
    write(at - 4.0, Align2::RIGHT_BOTTOM, format!("lets go {:.0}", release.0), theme.quiet);
    write(at + 4.0, Align2::LEFT_BOTTOM, format!("takes {:.0} N", press.0), theme.accent);
    write(rect.right(), Align2::RIGHT_BOTTOM, format!("{most:.0}"), theme.quiet);
}

/// Shows one press with a check box; returns whether it counts, after a change.
fn listed(ui: &mut Ui, theme: &Theme, press: &ControlPress) -> Option<bool> {
    let why = press.why.map_or("pressed".to_owned(), |why| why.to_string());
    let person = press.person.map_or(String::new(), |person| format!("person {person}"));
    let mut counts = press.counts;
    let spoken = format!("{:.0} newtons, {why}, {person} counts", press.force.0);
    let tick = ui
        .horizontal(|ui| {
            let tick = ui.checkbox(&mut counts, "");
            tick.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, counts, &spoken));
            let line = row(ui, 18.0, 12.5, "");
            line.right(0.13, &format!("{:.0} N", press.force.0), color(theme.ink));
            let ink = if press.why.is_some() { theme.warning } else { theme.good };
            line.left(0.18, 0.74, &why, color(ink));
            line.right(1.0, &person, color(theme.quiet));
            tick
        })
        .inner;
    tick.on_hover_text(why).changed().then_some(counts)
}
