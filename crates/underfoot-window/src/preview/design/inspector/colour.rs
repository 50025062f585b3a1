//! Colours: a swatch with a picker and the colours of the layout, and the contrast of text and face in words.

use std::collections::BTreeMap;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::color_picker::{Alpha, color_picker_color32};
use eframe::egui::{Popup, PopupCloseBehavior, RichText, Sense, Stroke, StrokeKind, Ui, WidgetInfo, vec2};

use super::field::{EDITOR_PX, FieldAnswer, FieldEdits, ShownField, TypedTexts};
use super::text::typed;
use super::words::label;
use crate::edit::quoted;
use underfoot::layout::{Colour, Layout};
use underfoot_format::describe::FieldType;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Size of the swatch before the text of a colour, in points.
const SWATCH: egui::Vec2 = vec2(30.0, 20.0);

/// Maximum number of the layout's colours on offer: four rows of eight.
const MOST: usize = 32;

/// The colour of the field; `None` for a field of another form.
pub(super) fn colour_of(field: &ShownField<'_>) -> Option<Colour> {
    let is_colour = matches!(&field.property.shape, FieldType::Text(told) if told.contains("#rrggbb"));
    field.property.value.trim_matches('"').parse().ok().filter(|_| is_colour)
}

/// A swatch that opens the picker, and the colour as text.
pub(super) fn colour(
    ui: &mut Ui,
    field: &ShownField<'_>,
    texts: &mut TypedTexts,
    now: Colour,
) -> FieldAnswer {
    let name = label(&field.property.name);
    let (rect, swatch) = ui.allocate_exact_size(SWATCH, Sense::click());
    swatch.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Pick {name}")));
    let edge = if swatch.has_focus() || swatch.hovered() { field.theme.accent } else { field.theme.line };
    ui.painter().rect(rect, 4, color(now), Stroke::new(1.5, color(edge)), StrokeKind::Inside);
    let set = |colour: Colour| FieldEdits::from(field.set(quoted(&colour.to_string())));
    let popup = Popup::menu(&swatch).close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let picked = popup.show(|ui| {
        let used = colours_of(field.edited.layout());
        let offered = swatches(ui, field.theme, &used).map(set);
        let mut mixed = color(now);
        let is_mixed = color_picker_color32(ui, &mut mixed, Alpha::Opaque);
        let [red, green, blue, _] = mixed.to_array();
        let mixed = Colour::rgb(red, green, blue);
        // The changes of one pull at the picker are one undo step.
        let stroke = ui.input(|i| i.pointer.press_start_time()).map(f64::to_bits);
        let mixed = (is_mixed && mixed != now).then(|| FieldEdits { stroke, ..set(mixed) });
        offered.or(mixed)
    });
    let picked = picked.and_then(|picked| picked.inner);
    let width = EDITOR_PX - SWATCH.x - ui.spacing().item_spacing.x;
    let (entered, text) = typed(ui, field, texts, true, width);
    (picked.or(entered), text)
}

/// The colours of a layout, the most frequent first.
fn colours_of(layout: &Layout) -> Vec<Colour> {
    let mut counts: BTreeMap<String, (usize, Colour)> = BTreeMap::new();
    let looks = layout.widgets.iter().flat_map(|widget| [widget.look.face, widget.look.lit, widget.look.ink]);
    let grounds = layout.grounds.iter().flat_map(|ground| [ground.surface, ground.deep]);
    for colour in looks.chain(grounds) {
        counts.entry(colour.to_string()).or_insert((0, colour)).0 += 1;
    }
    let mut all: Vec<(usize, Colour)> = counts.into_values().collect();
    all.sort_by_key(|(count, _)| std::cmp::Reverse(*count));
    all.into_iter().map(|(_, colour)| colour).collect()
}

/// Shows `colours` to choose from; returns the one that the user chose.
fn swatches(ui: &mut Ui, theme: &Theme, colours: &[Colour]) -> Option<Colour> {
    let mut chosen = None;
    let more = colours.len().saturating_sub(MOST);
    ui.label(RichText::new("Colours of this layout").size(11.5).weak());
    egui::Grid::new("colours").spacing(vec2(4.0, 4.0)).show(ui, |ui| {
        for (number, colour) in colours.iter().take(MOST).enumerate() {
            let (rect, one) = ui.allocate_exact_size(vec2(22.0, 18.0), Sense::click());
            one.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Use {colour}")));
            let edge = if one.has_focus() || one.hovered() { theme.accent } else { theme.line };
            ui.painter().rect(rect, 3, color(*colour), Stroke::new(1.5, color(edge)), StrokeKind::Inside);
            if one.on_hover_text(colour.to_string()).clicked() {
                chosen = Some(*colour);
            }
            if number % 8 == 7 {
                ui.end_row();
            }
        }
    });
    if more > 0 {
        ui.label(RichText::new(format!("and {more} more")).size(11.5).weak());
    }
    chosen
}

/// Contrast ratio in words.
///
/// # Source
/// Web Content Accessibility Guidelines 2.2, 1.4.3 and 1.4.6: 4.5 for text, 3 for large text, 7 for the level AAA.
fn legibility(ratio: f32) -> &'static str {
    match ratio {
        easy if easy >= 7.0 => "easy to read",
        enough if enough >= 4.5 => "readable",
        large if large >= 3.0 => "only large letters are readable; drawn black or white instead",
        _ => "hard to read; drawn black or white instead",
    }
}

/// Says how well the text stands out from the faces of the control: below the field of its ink.
pub(super) fn contrast(ui: &mut Ui, field: &ShownField<'_>) {
    if field.property.name != "look.ink" || field.is_shared {
        return;
    }
    let Some(look) = field.widget().map(|widget| widget.look) else { return };
    for (face, moment) in [(look.face, "at rest"), (look.lit, "while pressed")] {
        let ratio = look.ink.contrast(face);
        let ink = if ratio < 4.5 { field.theme.warning } else { field.theme.quiet };
        let text = format!("Text {moment}: {ratio:.1} to 1, {}", legibility(ratio));
        ui.horizontal(|ui| {
            ui.add_space(16.0);
            let text = RichText::new(text).size(11.5).color(color(ink));
            ui.add(egui::Label::new(text).wrap());
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_thresholds_of_the_guidelines_are_said_in_words() {
        let grey = |level| Colour::rgb(level, level, level).contrast(Colour::rgb(255, 255, 255));
        // #767676 is the lightest grey that is readable on white, #949494 that for large letters.
        assert_eq!(legibility(grey(0x76)), "readable");
        assert!(legibility(grey(0x77)).starts_with("only large letters"));
        assert!(legibility(grey(0x94)).starts_with("only large letters"));
        assert!(legibility(grey(0x95)).starts_with("hard to read"));
        assert_eq!(legibility(grey(0)), "easy to read");
    }
}
