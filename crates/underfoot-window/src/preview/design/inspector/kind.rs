//! A kind in the place of the fields: its picture, its values, and the controls that are made of it.

use eframe::egui::accesskit::Role;
use eframe::egui::{CollapsingHeader, RichText, Sense, Ui, WidgetInfo, vec2};

use super::super::edited::EditedLayout;
use super::super::palette::{PaletteThing, draw_thing, is_shipped};
use super::field::name_cell;
use super::words::{capital, choice, label};
use crate::edit::{Address, Document, FieldOrigin, Property};
use crate::preview::style::{quiet, section};
use underfoot::schema::Kind;
use underfoot_format::describe::FieldType;
use underfoot_format::words::unit;
use underfoot_scene::egui_painter::{Palette, color};
use underfoot_scene::scene::Theme;

/// The wish of the user about the kind on display.
pub(super) enum KindWish {
    /// The fields again.
    Back,
    /// Another record.
    Select(Address),
}

/// Shows `kind`; returns the wish of the user, if any.
pub(super) fn show(
    ui: &mut Ui,
    theme: &Theme,
    palette: &mut Palette,
    edited: &EditedLayout,
    kind: &Kind,
) -> Option<KindWish> {
    let mut wish = None;
    section(ui, theme, &format!("Kind {}", choice(&kind.name)), |ui| {
        if ui.small_button("Back").on_hover_text("The fields of the selection").clicked() {
            wish = Some(KindWish::Back);
        }
    });
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 64.0), Sense::hover());
    let thing = PaletteThing::Control(kind.name.clone());
    draw_thing(ui, theme, palette, &edited.document, &thing, rect);
    let home = match edited.document.kinds().get(&kind.name) {
        Some(known) if known == kind && is_shipped(kind) => "It comes with underfoot.",
        Some(known) if known == kind => "It stands in the folder widgets beside the layout.",
        _ => "The layout itself defines it, in kinds.",
    };
    ui.label(quiet(theme, home));
    for part in Document::fields_of_kind(kind) {
        let title = RichText::new(capital(&part.title)).strong().color(color(theme.ink));
        CollapsingHeader::new(title).id_salt(("kind", &part.title)).default_open(true).show_unindented(
            ui,
            |ui| {
                for property in part.properties.iter().filter(|property| !property.value.is_empty()) {
                    value(ui, theme, property);
                }
            },
        );
    }
    let made = edited.items.iter().filter(|item| {
        let widget = edited.layout().widgets.get(item.widgets.start);
        !item.is_group && widget.is_some_and(|widget| widget.kind == kind.name)
    });
    section(ui, theme, "Made of it", |_| {});
    for item in made {
        let name = format!("Control {}", item.name);
        let row = ui.link(&item.name);
        row.widget_info(|| WidgetInfo::labeled(Role::Link, true, format!("Made of it: {name}")));
        if row.clicked() {
            wish = Some(KindWish::Select(item.record.clone()));
        }
    }
    wish
}

/// One value in plain words; those that the kind itself sets are strong.
fn value(ui: &mut Ui, theme: &Theme, property: &Property) {
    let is_set = property.origin == FieldOrigin::Written;
    let ink = if is_set { theme.ink } else { theme.quiet };
    ui.horizontal(|ui| {
        name_cell(ui, RichText::new(label(&property.name)).color(color(theme.quiet)))
            .on_hover_text(format!("{}\n{}", property.name, property.about));
        let text = RichText::new(told(property)).color(color(ink));
        ui.add(eframe::egui::Label::new(text).wrap());
    });
}

/// A value in plain words, with its unit.
fn told(property: &Property) -> String {
    let shape = match &property.shape {
        FieldType::Optional(each) => each,
        other => other,
    };
    match shape {
        FieldType::Number { whole: false, .. } if property.value.parse::<f64>().is_ok() => {
            format!("{}{}", property.value, unit(&property.name))
        }
        FieldType::Variants(_) if property.name.starts_with("feel.") => {
            property.value.split('(').next().map(choice).unwrap_or_default()
        }
        _ => choice(&property.value),
    }
}
