//! Place and size: two lengths, in the layout's unit or in metres.

use eframe::egui::accesskit::Role;
use eframe::egui::{DragValue, Ui, WidgetInfo};
use glam::Vec2;

use super::field::{EDITOR_PX, FieldAnswer, FieldEdits, ShownField, row_px, unit_name};
use super::number::two_numbers;
use super::words::label;
use crate::edit::{Edit, FieldOrigin};
use underfoot::floor::Rect;
use underfoot_format::text::RonText;

/// Shows a place or a size that is `before`, in the layout's unit.
pub(super) fn place(ui: &mut Ui, field: &ShownField<'_>, before: [f64; 2]) -> FieldAnswer {
    let is_at = field.property.name == "at";
    let names = if is_at { ["east", "north"] } else { ["width", "depth"] };
    let unit = field.edited.document.unit_m();
    let mut now = before;
    let spoken = label(&field.property.name);
    let drags = [0, 1].map(|side| {
        let drag = DragValue::new(&mut now[side])
            .speed(0.01)
            .max_decimals(4)
            .custom_parser(move |text| length(text, unit[side]))
            .update_while_editing(false);
        // Both numbers are as wide as one text.
        let width = 0.5 * (EDITOR_PX - ui.spacing().item_spacing.x);
        let drag = ui.add_sized([width, row_px(ui)], drag);
        let name = format!("{spoken}: {}", names[side]);
        drag.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, &name));
        let unit = unit_name(&field.edited.document);
        drag.on_hover_text(format!("{}: in {unit}, or with cm or m behind it", names[side]))
    });
    let [first, second] = drags;
    let moved = if second.dragged() { &second } else { &first };
    let edits = (now != before)
        .then(|| FieldEdits { edits: placing(field, now, is_at), stroke: None }.dragged_by(moved));
    (edits, first)
}

/// The edits that set place or size to `now`. A control that stood beside a neighbour gets a place of its own.
fn placing(field: &ShownField<'_>, now: [f64; 2], is_at: bool) -> Vec<Edit> {
    let written = || vec![field.set(RonText::Tuple(now.map(RonText::rounded).into()).inline())];
    let item = field.edited.item(field.record);
    let Some(item) = item.filter(|_| field.property.origin != FieldOrigin::Written) else { return written() };
    let unit = field.edited.document.unit_m();
    let metres = Vec2::new((now[0] * unit.x) as f32, (now[1] * unit.y) as f32);
    let area = match is_at {
        true => Rect::from_min_size(metres, item.area.size()),
        false => Rect::from_min_size(item.area.min, metres),
    };
    // The reader gives the reason why the plain value can't be.
    field.edited.document.placing(&[(item, area)]).unwrap_or_else(|_| written())
}

/// The two numbers of a place or a size, in the layout's unit; the resolved area if the place depends on a
/// neighbour.
pub(super) fn place_of(field: &ShownField<'_>) -> Option<[f64; 2]> {
    if field.property.origin == FieldOrigin::Written {
        return two_numbers(&field.property.value);
    }
    let area = field.edited.item(field.record).filter(|item| !item.is_group)?.area;
    let metres = if field.property.name == "at" { area.min } else { area.size() };
    let units = metres.as_dvec2() / field.edited.document.unit_m();
    Some(units.to_array().map(|length| (length * 1e4).round() / 1e4))
}

/// Parses a length in units of `unit_m` metres; also accepts `57 cm`, `570 mm` or `0.57 m`.
fn length(text: &str, unit_m: f64) -> Option<f64> {
    let text = text.trim().replace(',', ".");
    let scales =
        [("cm", 0.01 / unit_m), ("mm", 1e-3 / unit_m), ("tiles", 1.0), ("m", 1.0 / unit_m), ("", 1.0)];
    let (number, scale) =
        scales.iter().find_map(|(end, scale)| Some((text.strip_suffix(end)?.trim(), scale)))?;
    let value = number.parse::<f64>().ok().filter(|value| value.is_finite())? * scale;
    Some((value * 1e4).round() / 1e4)
}

#[cfg(test)]
mod tests {
    use super::length;

    #[test]
    fn lengths_are_typed_in_tiles_or_metres() {
        let tiles = |text| length(text, 0.304);
        assert_eq!(tiles(" 1.35"), Some(1.35));
        assert_eq!(tiles("2 tiles"), Some(2.0));
        assert_eq!((tiles("30.4 cm"), tiles("304mm"), tiles("0,304 m")), (Some(1.0), Some(1.0), Some(1.0)));
        assert_eq!(length("57 cm", 1.0), Some(0.57));
        assert_eq!((tiles("wide"), tiles("inf"), tiles("")), (None, None, None));
    }
}
