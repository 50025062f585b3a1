//! One row of the inspector: mark of the origin, plain name, editor, button that resets it.

use std::collections::HashMap;

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{Button, Color32, Response, RichText, Sense, Stroke, Ui, WidgetInfo, vec2};

use super::super::edited::EditedLayout;
use super::words::{choice, label};
use crate::edit::{Address, Document, Edit, FieldOrigin, Property};
use crate::preview::handheld::side;
use crate::preview::icons::Icon;
use underfoot::layout::Widget;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Maximum width of a field's name, in points: that of the longest one. A row that has less room wraps it.
const NAME_PX: f32 = 118.0;

/// Minimum width of a field's name, in points: that of the longest word.
const WORD_PX: f32 = 72.0;

/// Distance between the parts of a row, in points.
pub(super) const GAP_PX: f32 = 6.0;

/// Width of the editor of a text or a choice, in points.
pub(in crate::preview::design) const EDITOR_PX: f32 = 126.0;

/// Width of the mark before it, in points.
const MARK_PX: f32 = 8.0;

/// Width of the button that resets a field, in points, for a mouse.
const RESET_PX: f32 = 22.0;

/// Height of a row, in points, for a mouse.
const ROW_PX: f32 = 24.0;

/// Width of the button that resets a field, in points.
pub(super) fn reset_px(ui: &Ui) -> f32 {
    side(ui, RESET_PX)
}

/// Height of a row, in points.
pub(super) fn row_px(ui: &Ui) -> f32 {
    side(ui, ROW_PX)
}

/// Fields that every record must keep.
const KEPT: [&str; 3] = ["id", "kind", "at"];

/// The texts of fields in which the user is typing, by field.
pub(super) type TypedTexts = HashMap<String, String>;

/// A field on display.
#[derive(Clone, Copy)]
pub(super) struct ShownField<'a> {
    pub(super) theme: &'a Theme,
    pub(super) edited: &'a EditedLayout,
    pub(super) record: &'a Address,
    pub(super) property: &'a Property,
    /// Whether it stands for the fields of several records.
    pub(super) is_shared: bool,
}

/// The edits for which an editor asks.
#[derive(Default)]
pub(super) struct FieldEdits {
    pub(super) edits: Vec<Edit>,
    /// The number of the drag to which they belong: the edits of a drag are one undo step.
    pub(super) stroke: Option<u64>,
}

/// The edits for which an editor asks in this frame, and its response.
pub(super) type FieldAnswer = (Option<FieldEdits>, Response);

impl From<Edit> for FieldEdits {
    fn from(edit: Edit) -> Self {
        Self { edits: vec![edit], stroke: None }
    }
}

impl FieldEdits {
    /// The same edits as part of the drag of `response`, if it is being dragged.
    pub(super) fn dragged_by(self, response: &Response) -> Self {
        let pressed_s = response.ctx.input(|i| i.pointer.press_start_time());
        let stroke = pressed_s.filter(|_| response.dragged()).map(f64::to_bits);
        Self { stroke, ..self }
    }
}

impl ShownField<'_> {
    /// The edit that writes `value`.
    pub(super) fn set(&self, value: impl Into<String>) -> Edit {
        Edit::set(self.record, &self.property.name, value)
    }

    /// The resolved control; `None` for another record.
    pub(super) fn widget(&self) -> Option<&Widget> {
        let item = self.edited.item(self.record).filter(|item| !item.is_group)?;
        self.edited.layout().widgets.get(item.widgets.start)
    }
}

/// The unit of places of this document, in words.
pub(in crate::preview::design) fn unit_name(document: &Document) -> &'static str {
    if document.unit_m() == glam::DVec2::ONE { "m" } else { "tiles" }
}

/// The beginning of a row: the mark of the origin and the name, with the name in files on hover.
pub(super) fn name(ui: &mut Ui, field: &ShownField<'_>) {
    let ShownField { theme, property, .. } = field;
    mark(ui, theme, &property.origin);
    let mut text = label(&property.name);
    if property.is_place() {
        text = format!("{text} ({})", unit_name(&field.edited.document));
    }
    let is_written = property.origin == FieldOrigin::Written;
    let ink = color(if is_written { theme.ink } else { theme.quiet });
    let text = if is_written { RichText::new(text).strong() } else { RichText::new(text) };
    name_cell(ui, text.color(ink)).on_hover_ui(|ui| {
        ui.label(RichText::new(&property.name).monospace());
        ui.label(&property.about);
        ui.label(RichText::new(format!("{}; {}", property.told, origin(&property.origin))).weak());
    });
}

/// A name in the column before the editors, with a line break where the row has no room for it.
pub(super) fn name_cell(ui: &mut Ui, text: RichText) -> Response {
    let rest = MARK_PX + EDITOR_PX + reset_px(ui) + 3.0 * ui.spacing().item_spacing.x;
    let width = (ui.max_rect().width() - rest).clamp(WORD_PX, NAME_PX);
    let size = vec2(width, row_px(ui));
    let cell = ui.allocate_ui_with_layout(size, egui::Layout::left_to_right(egui::Align::Center), |ui| {
        ui.set_min_width(width);
        ui.set_max_width(width);
        ui.add(egui::Label::new(text).wrap())
    });
    cell.inner
}

/// The beginning of a row without a mark; returns its name.
pub(in crate::preview::design) fn unmarked_name(ui: &mut Ui, text: &str) -> Response {
    ui.spacing_mut().item_spacing.x = GAP_PX;
    ui.allocate_exact_size(vec2(MARK_PX, row_px(ui)), Sense::hover());
    name_cell(ui, RichText::new(text))
}

/// The origin of a value, in words.
fn origin(origin: &FieldOrigin) -> String {
    match origin {
        FieldOrigin::Written => "written here".into(),
        FieldOrigin::Kind(kind) => format!("from {}", choice(kind)),
        FieldOrigin::Default => "the usual value".into(),
        FieldOrigin::Several => "not the same in all of them".into(),
    }
}

/// A full dot for a value that is written here, a ring for one of the kind, two dots for several values, none for a
/// default.
pub(super) fn mark(ui: &mut Ui, theme: &Theme, of: &FieldOrigin) {
    let (rect, response) = ui.allocate_exact_size(vec2(MARK_PX, 16.0), Sense::hover());
    let (painter, at) = (ui.painter(), rect.center());
    let (full, quiet) = (color(theme.accent), Stroke::new(1.2, color(theme.quiet)));
    match of {
        FieldOrigin::Written => drop(painter.circle_filled(at, 3.0, full)),
        FieldOrigin::Kind(_) => drop(painter.circle_stroke(at, 2.6, quiet)),
        FieldOrigin::Several => {
            for side in [-2.5, 2.5] {
                painter.circle_filled(at + vec2(side, 0.0), 1.8, full);
            }
        }
        FieldOrigin::Default => {}
    }
    response.on_hover_text(origin(of));
}

/// The ink of the values in a row: quiet unless they are written here.
pub(super) fn value_ink(field: &ShownField<'_>) -> Option<Color32> {
    (field.property.origin != FieldOrigin::Written).then(|| color(field.theme.quiet))
}

/// The end of a row: a button that resets a written field, or a sign for values that differ.
pub(super) fn reset(ui: &mut Ui, field: &ShownField<'_>) -> Option<Edit> {
    let property = field.property;
    if property.origin == FieldOrigin::Several {
        let differs = ui.label(RichText::new("≠").color(color(field.theme.quiet)));
        differs.widget_info(|| WidgetInfo::labeled(Role::Label, true, "differs"));
        differs.on_hover_text(origin(&property.origin));
        return None;
    }
    if property.origin != FieldOrigin::Written || KEPT.contains(&property.name.as_str()) {
        return None;
    }
    // It ends the row: no other button gets this padding.
    ui.spacing_mut().button_padding.x = 2.0;
    let size = vec2(reset_px(ui), side(ui, 0.0));
    let button = ui.add(Button::new(Icon::RotateCcw.unicode().to_string()).small().min_size(size));
    let name = label(&property.name);
    button.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Reset {name}")));
    let back = match property.inherited.as_str() {
        "" => "Leave it out".to_owned(),
        inherited => format!("Back to {}", choice(inherited)),
    };
    button.on_hover_text(back).clicked().then(|| Edit::unset(field.record, &property.name))
}
