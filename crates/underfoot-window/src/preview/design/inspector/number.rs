//! Numbers: a slider over the range that feet use, and the number, which can be typed and dragged.

use eframe::egui::accesskit::Role;
use eframe::egui::{DragValue, Response, Slider, SliderClamping, Ui, WidgetInfo};

use super::field::{EDITOR_PX, FieldAnswer, FieldEdits, ShownField, reset_px};
use super::words::{label, start, usual_range};
use crate::edit::{Edit, pressing};
use underfoot::units::Newtons;
use underfoot_format::describe::FieldType;
use underfoot_format::text::RonText;
use underfoot_format::words::unit;

/// Width of the number beside a slider, in points.
const NUMBER_PX: f32 = 64.0;

/// A number of a record.
#[derive(Clone, Copy)]
pub(super) struct NumberField<'a> {
    /// Its name in files, which may be dotted.
    pub(super) name: &'a str,
    /// Minimum and maximum of a valid value.
    pub(super) range: (f64, f64),
    /// Whether only whole numbers are valid.
    pub(super) whole: bool,
}

impl<'a> NumberField<'a> {
    /// The number that `shape` describes; `None` for another form.
    pub(super) fn of(name: &'a str, shape: &FieldType) -> Option<Self> {
        match shape {
            FieldType::Number { range, whole } => Some(Self { name, range: *range, whole: *whole }),
            _ => None,
        }
    }

    fn unit(&self) -> &'static str {
        if self.whole { "" } else { unit(self.name) }
    }
}

/// A number as files write it.
pub(super) fn written(number: f64) -> String {
    RonText::rounded(number).inline()
}

/// Shows `value` as a slider and a number; returns the new value, if any, and the part that was moved.
pub(super) fn number(ui: &mut Ui, field: NumberField<'_>, value: f64) -> (Option<f64>, Response) {
    let NumberField { range: (low, high), whole, .. } = field;
    let name = label(field.name);
    let mut now = value;
    let slid = usual_range(field.name).map(|(from, to)| {
        let gaps = 2.0 * ui.spacing().item_spacing.x;
        ui.spacing_mut().slider_width = (ui.available_width() - NUMBER_PX - reset_px(ui) - gaps).max(30.0);
        let slider = Slider::new(&mut now, from..=to).show_value(false).trailing_fill(true);
        let slider = ui.add(slider.clamping(SliderClamping::Never).step_by(step(from, to, whole)));
        slider.widget_info(|| WidgetInfo::slider(true, value, format!("{name}: slider")));
        slider
    });
    let drag = DragValue::new(&mut now)
        .speed(if whole { 0.1 } else { ((high - low) * 2e-3).min(1.0) })
        .max_decimals(if whole { 0 } else { 4 })
        .suffix(field.unit())
        .update_while_editing(false);
    let drag = ui.add_sized([NUMBER_PX, ui.spacing().interact_size.y], drag);
    drag.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, &name));
    // The reader refuses a typed value beyond the range and gives the reason; a drag stops at the end.
    if drag.dragged() {
        now = now.clamp(low, high);
    }
    let moved = slid.filter(|slider| slider.changed() || slider.dragged());
    ((now != value).then_some(now), moved.unwrap_or(drag))
}

/// Distance between the values of a slider: some 100 of them, in round steps.
fn step(from: f64, to: f64, whole: bool) -> f64 {
    if whole {
        return 1.0;
    }
    let fine = (to - from) / 100.0;
    let decade = 10_f64.powf(fine.log10().floor());
    let steps = [1.0, 2.0, 5.0].map(|step| step * decade);
    steps.into_iter().find(|step| *step >= fine * 0.75).unwrap_or(10.0 * decade)
}

/// A number that the record must have.
pub(super) fn required(ui: &mut Ui, field: &ShownField<'_>, of: NumberField<'_>, value: f64) -> FieldAnswer {
    let (changed, moved) = number(ui, of, value);
    let edits = changed.map(|now| FieldEdits { edits: setting(field, now), stroke: None }.dragged_by(&moved));
    (edits, moved)
}

/// The edits that set the field to `now`. A press threshold that comes too near to the release threshold moves that
/// one along.
fn setting(field: &ShownField<'_>, now: f64) -> Vec<Edit> {
    let press = Newtons(now as f32);
    let thresholds = field.widget().map(|widget| widget.behaviour.thresholds());
    let too_near = |release: Newtons| release.0 > 0.8 * press.0;
    match thresholds.filter(|now| field.property.name == "press_n" && too_near(now.release)) {
        Some(before) => pressing(field.record, before, press),
        None => vec![field.set(written(now))],
    }
}

/// A number that may be absent: a tick, and the number behind it.
pub(super) fn optional(ui: &mut Ui, field: &ShownField<'_>, of: NumberField<'_>) -> FieldAnswer {
    let value = field.property.value.parse::<f64>().ok();
    let name = label(of.name);
    let mut on = value.is_some();
    let tick = ui.checkbox(&mut on, "");
    tick.widget_info(|| WidgetInfo::selected(Role::CheckBox, true, on, format!("{name}: on")));
    if tick.changed() {
        let start = start(of.name).map_or_else(|| written(of.range.0), str::to_owned);
        let edit = match on {
            true => field.set(start),
            false if is_absent(&field.property.inherited) => Edit::unset(field.record, &field.property.name),
            false => field.set("None"),
        };
        return (Some(edit.into()), tick);
    }
    match value {
        Some(value) => required(ui, field, of, value),
        None => {
            ui.label("off");
            (None, tick)
        }
    }
}

/// A number that is absent and would follow from another field, which is absent too.
pub(super) fn following(ui: &mut Ui, field: &ShownField<'_>) -> FieldAnswer {
    (None, ui.label("off").on_hover_text(plain_names(&field.property.value)))
}

/// `text` with the plain names of the fields that stand in it by their names in files, between backquotes.
fn plain_names(text: &str) -> String {
    let parts = text.split('`').enumerate();
    parts.map(|(at, part)| if at % 2 == 1 { format!("“{}”", label(part)) } else { part.to_owned() }).collect()
}

fn is_absent(value: &str) -> bool {
    value.is_empty() || value == "None"
}

/// Two numbers in round brackets, such as a range or a pair of angles.
pub(super) fn pair(
    ui: &mut Ui,
    field: &ShownField<'_>,
    of: NumberField<'_>,
    before: [f64; 2],
) -> FieldAnswer {
    let mut now = before;
    let name = label(of.name);
    let drags = [0, 1].map(|side| {
        let drag = DragValue::new(&mut now[side])
            .speed(((of.range.1 - of.range.0) * 2e-3).min(0.1))
            .max_decimals(4)
            .update_while_editing(false);
        let width = 0.5 * (EDITOR_PX - ui.spacing().item_spacing.x);
        let drag = ui.add_sized([width, ui.spacing().interact_size.y], drag);
        let spoken = format!("{name}: {}", ["first", "second"][side]);
        drag.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, &spoken));
        drag
    });
    let [first, second] = drags;
    let moved = if second.dragged() { &second } else { &first };
    let value = RonText::Tuple(now.map(RonText::rounded).into()).inline();
    let edits = (now != before).then(|| FieldEdits::from(field.set(value)).dragged_by(moved));
    (edits, first)
}

/// The two numbers of a text such as `(1, 2.5)`.
pub(super) fn two_numbers(text: &str) -> Option<[f64; 2]> {
    let (one, other) = text.trim().trim_matches(['(', ')']).split_once(',')?;
    let number = |text: &str| text.trim().trim_end_matches(',').trim().parse::<f64>().ok();
    Some([number(one)?, number(other)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sliders_move_in_round_steps() {
        assert_eq!(step(20.0, 250.0, false), 2.0);
        assert_eq!(step(0.0, 400.0, false), 5.0);
        assert!((step(0.0, 1.0, false) - 0.01).abs() < 1e-9);
        assert_eq!(step(0.0, 9.0, true), 1.0);
    }

    #[test]
    fn fields_in_a_default_are_called_by_their_plain_names() {
        assert_eq!(plain_names("0.67 of `press_share`"), "0.67 of “Takes of weight”");
        assert_eq!(plain_names("3"), "3");
    }

    #[test]
    fn a_pair_is_read_with_and_without_a_last_comma() {
        assert_eq!(two_numbers("(1, 2.5)"), Some([1.0, 2.5]));
        assert_eq!(two_numbers("(1, -2,)"), Some([1.0, -2.0]));
        assert_eq!(two_numbers("(1)"), None);
    }
}
