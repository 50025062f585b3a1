//! The sections of a record: fields with the origin of each value, their problems, and the faces of a control.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{RichText, Sense, Ui, WidgetInfo, vec2};

use super::super::edited::EditedLayout;
use super::super::palette::draw_widget;
use super::field::{self, FieldEdits, GAP_PX, ShownField};
use super::problems::FieldProblem;
use super::words::{self, capital};
use super::{FrameEdits, Inspector, choice, colour, effect, value};
use crate::edit::{Address, FieldOrigin, FieldSection};
use crate::preview::style::quiet;
use underfoot_scene::egui_painter::{Palette, color};
use underfoot_scene::scene::Theme;

impl Inspector {
    /// Shows sections of fields; returns the edits of one, if any.
    pub(super) fn sections(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        palette: &mut Palette,
        edited: &EditedLayout,
        record: &Address,
        shown: &[FieldSection],
    ) -> FrameEdits {
        let is_shared = !self.shared.is_empty();
        let problems = self.problems(theme, edited, record);
        let has = |part: &FieldSection, problem: &FieldProblem| {
            part.properties.iter().any(|one| problem.is_of(one))
        };
        let mut wanted: FrameEdits = None;
        for problem in problems.iter().filter(|problem| !shown.iter().any(|part| has(part, problem))) {
            let mend =
                problem.show(ui, theme).map(|edits| (String::new(), FieldEdits { edits, stroke: None }));
            wanted = mend.or(wanted);
        }
        for (number, part) in shown.iter().enumerate() {
            let own: Vec<&FieldProblem> = problems.iter().filter(|problem| has(part, problem)).collect();
            let mut ink = theme.ink;
            let mut title = capital(&part.title);
            if let Some(first) = own.first() {
                ink = first.colour;
                title = format!("{title} ({})", own.len());
            }
            let heading = RichText::new(title).strong().color(color(ink));
            let id = ("part", number, is_shared);
            let part_of = egui::CollapsingHeader::new(heading).id_salt(id).default_open(number < 2);
            part_of.show_unindented(ui, |ui| {
                ui.spacing_mut().item_spacing.x = GAP_PX;
                self.source(ui, theme, edited, part);
                for property in &part.properties {
                    let is_led = std::mem::take(&mut self.is_led);
                    // The row with the keyboard focus keeps it when a warning appears or disappears above.
                    let id = egui::Id::unique(("field", record.to_string(), &property.name, is_shared));
                    let field = ShownField { theme, edited, record, property, is_shared };
                    let row = ui.scope_builder(egui::UiBuilder::new().scope_id(id), |ui| {
                        self.property(ui, &field, &own, is_led)
                    });
                    let edits = row.inner.map(|edits| (property.name.clone(), edits));
                    wanted = edits.or(wanted.take());
                    if property.name == "look.ink" && !is_shared {
                        faces(ui, &field, palette);
                    }
                }
            });
        }
        wanted
    }

    /// The line that explains the marks of a section, with a link to the kind from which values come.
    fn source(&mut self, ui: &mut Ui, theme: &Theme, edited: &EditedLayout, part: &FieldSection) {
        let kinds = part.properties.iter().filter_map(|property| match &property.origin {
            FieldOrigin::Kind(kind) => Some(kind),
            _ => None,
        });
        let Some(kind) = kinds.into_iter().next() else { return };
        ui.horizontal(|ui| {
            ui.set_height(16.0);
            let origin = FieldOrigin::Kind(kind.clone());
            field::mark(ui, theme, &origin);
            ui.label(quiet(theme, "from").size(11.5));
            let name = words::choice(kind);
            let link = ui.link(RichText::new(&name).size(11.5));
            let title = &part.title;
            link.widget_info(|| WidgetInfo::labeled(Role::Link, true, format!("Kind of {title}: {name}")));
            if link.on_hover_text("Show this kind").clicked() {
                self.kind = Some((kind.clone(), edited.selected.clone()));
            }
            ui.add_space(6.0);
            field::mark(ui, theme, &FieldOrigin::Written);
            ui.label(quiet(theme, "set here").size(11.5));
        });
    }

    /// Shows one field with its problems; returns its edits, if any.
    fn property(
        &mut self,
        ui: &mut Ui,
        field: &ShownField<'_>,
        problems: &[&FieldProblem],
        is_led: bool,
    ) -> Option<FieldEdits> {
        let mut wanted = None;
        ui.horizontal(|ui| {
            field::name(ui, field);
            let (edits, editor) = ui
                .scope(|ui| {
                    ui.visuals_mut().override_text_color = field::value_ink(field);
                    value::value(ui, field, &mut self.typed)
                })
                .inner;
            wanted = edits;
            if is_led {
                editor.request_focus();
            }
            if editor.gained_focus() {
                editor.scroll_to_me(None);
            }
            wanted = field::reset(ui, field).map(FieldEdits::from).or(wanted.take());
        });
        wanted = choice::variant_fields(ui, field).or(wanted);
        if !field.is_shared {
            self.wish = effect::picture(ui, field, &mut self.waves).or(self.wish.take());
        }
        for problem in problems.iter().filter(|problem| problem.is_of(field.property)) {
            let mend = problem.show(ui, field.theme).map(|edits| FieldEdits { edits, stroke: None });
            wanted = mend.or(wanted);
        }
        wanted
    }
}

/// The control at rest and while it is pressed, with the contrast of its text.
fn faces(ui: &mut Ui, field: &ShownField<'_>, palette: &mut Palette) {
    let Some(widget) = field.widget() else { return };
    ui.horizontal(|ui| {
        let width = 0.5 * (ui.available_width() - ui.spacing().item_spacing.x);
        for (is_pressed, moment) in [(false, "at rest"), (true, "while pressed")] {
            let (rect, shown) = ui.allocate_exact_size(vec2(width, 56.0), Sense::hover());
            shown.widget_info(|| WidgetInfo::labeled(Role::Image, true, format!("Look {moment}")));
            shown.on_hover_text(capital(moment));
            draw_widget(ui, field.theme, palette, &field.edited.document, widget, is_pressed, rect);
        }
    });
    colour::contrast(ui, field);
}
