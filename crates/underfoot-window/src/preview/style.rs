//! The style of egui, derived from the scene's theme, and the few widgets that all panels share.

use eframe::egui;
use eframe::egui::epaint::FontColorTransferFunction;
use eframe::egui::text::{CCursor, LayoutJob, TextWrapping};
use eframe::egui::text_selection::CCursorRange;
use eframe::egui::{
    Color32, CornerRadius, FontFamily, FontId, Margin, RichText, Stroke, TextStyle, Ui, vec2,
};

use super::handheld::is_for_fingers;
use super::icons::{self, Icon};
use underfoot::layout::Colour;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::{Faces, Theme};

/// The fonts of the window: those of pictures, and icons.
pub(crate) fn fonts() -> egui::FontDefinitions {
    let mut fonts = underfoot_scene::letters::definitions();
    icons::add_to(&mut fonts);
    fonts
}

/// Room around the text of a button, in points.
pub(super) const BUTTON_PADDING: egui::Vec2 = vec2(9.0, 4.0);

/// Gives every widget of `ctx` the colours of `theme`.
pub(crate) fn apply(ctx: &egui::Context, theme: &Theme) {
    let base = if theme.is_dark() { egui::Theme::Dark } else { egui::Theme::Light };
    ctx.set_theme(base);
    ctx.style_mut_of(base, |style| {
        let sizes = [
            (TextStyle::Small, 11.5),
            (TextStyle::Body, 13.5),
            (TextStyle::Button, 13.5),
            (TextStyle::Heading, 18.0),
        ];
        for (text, size) in sizes {
            style.text_styles.insert(text, FontId::new(size, FontFamily::Proportional));
        }
        style.text_styles.insert(TextStyle::Monospace, FontId::new(12.5, FontFamily::Monospace));
        style.spacing.item_spacing = vec2(8.0, 5.0);
        style.spacing.button_padding = BUTTON_PADDING;
        style.spacing.scroll = egui::style::ScrollStyle::thin();
        style.interaction.selectable_labels = false;
        visuals(&mut style.visuals, theme);
    });
}

fn visuals(visuals: &mut egui::Visuals, theme: &Theme) {
    let (ink, line) = (color(theme.ink), color(theme.line));
    let panel = panel_colour(theme);
    if !theme.is_dark() {
        // The font is light: on a light background it needs a little more ink.
        visuals.text_options.color_transfer_function = FontColorTransferFunction::Gamma(0.72);
    }
    visuals.panel_fill = color(panel);
    visuals.window_fill = color(panel);
    visuals.window_stroke = Stroke::new(1.0, line);
    visuals.extreme_bg_color = color(theme.plate);
    visuals.faint_bg_color = color(panel.mix(theme.ink, 0.03));
    visuals.code_bg_color = color(theme.plate);
    visuals.hyperlink_color = color(theme.accent);
    visuals.warn_fg_color = color(theme.warning);
    visuals.error_fg_color = color(theme.fault);
    visuals.weak_text_color = Some(color(theme.quiet));
    visuals.selection.bg_fill = color(selected_ground(theme));
    visuals.selection.stroke = Stroke::new(1.0, color(theme.legible(theme.accent, selected_ground(theme))));
    visuals.striped = false;
    visuals.collapsing_header_frame = false;
    // The largest radius for which a corner takes four steps instead of eight: without a graphics card, buttons cost
    // as much as the floor's controls.
    let radius = CornerRadius::same(5);
    // With high contrast, edges tell states apart, and not only shades.
    let (width, touched) = if theme.faces == Faces::Outlined { (1.5, 2.5) } else { (1.0, 1.0) };
    let states = &mut visuals.widgets;
    let faces = [
        (&mut states.noninteractive, 0.0, 0.0),
        (&mut states.inactive, 0.035, 1.0),
        (&mut states.hovered, 0.07, 1.0),
        (&mut states.active, 0.13, 1.0),
        (&mut states.open, 0.07, 1.0),
    ];
    for (face, shade, edge) in faces {
        let fill = color(panel.mix(theme.ink, shade));
        (face.bg_fill, face.weak_bg_fill) = (fill, fill);
        face.bg_stroke =
            Stroke::new(width, if edge > 0.0 { color(theme.line.mix(theme.ink, shade)) } else { line });
        face.fg_stroke = Stroke::new(1.0, ink);
        face.corner_radius = radius;
        face.expansion = 0.0;
    }
    visuals.widgets.hovered.bg_stroke = Stroke::new(touched, color(theme.accent));
    if theme.faces == Faces::Outlined {
        visuals.widgets.active.bg_stroke = Stroke::new(touched, ink);
    }
    // Check boxes must be visible on the panel.
    visuals.widgets.inactive.bg_fill = color(panel.mix(theme.ink, 0.10));
}

/// The background of a button that is on, and of selected text.
pub(super) fn selected_ground(theme: &Theme) -> Colour {
    theme.accent.mix(panel_colour(theme), 0.7)
}

/// The background of panels: between canvas and plate.
pub(crate) fn panel_colour(theme: &Theme) -> Colour {
    theme.plate.mix(theme.canvas, 0.35)
}

/// The frame of a panel at the window's edge.
pub(crate) fn panel_frame(theme: &Theme, margin: Margin) -> egui::Frame {
    egui::Frame::new().fill(color(panel_colour(theme))).inner_margin(margin)
}

/// A heading over a part of the side panel, with a short item at its right end; returns the area of its line.
pub(crate) fn section(ui: &mut Ui, theme: &Theme, title: &str, aside: impl FnOnce(&mut Ui)) -> egui::Rect {
    ui.add_space(10.0);
    let heading = ui.horizontal(|ui| {
        ui.label(RichText::new(title).size(14.5).color(color(theme.ink)).strong());
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), aside);
    });
    let width = ui.available_width();
    let (line, _) = ui.allocate_exact_size(vec2(width, 1.0), egui::Sense::hover());
    ui.painter().hline(line.x_range(), line.center().y, Stroke::new(1.0, color(theme.line)));
    ui.add_space(2.0);
    heading.response.rect
}

/// A button of the height of a line of text, unless fingers use it.
pub(super) fn small_button(ui: &mut Ui, text: &str) -> egui::Response {
    if is_for_fingers(ui) { ui.button(text) } else { ui.small_button(text) }
}

/// A button that plots the value beside it, called `name`; returns whether it was clicked.
pub(super) fn plot_button(ui: &mut Ui, name: &str) -> bool {
    let button = small_button(ui, "Plot");
    button.widget_info(|| {
        egui::WidgetInfo::labeled(egui::accesskit::Role::Button, true, format!("Plot {name}"))
    });
    button.on_hover_text("Plot it over time").clicked()
}

/// A button that stays down while `is_on`; returns whether it was clicked.
pub(crate) fn selectable<'a>(ui: &mut Ui, is_on: bool, text: impl egui::IntoAtoms<'a>, hint: &str) -> bool {
    let button = egui::Button::selectable(is_on, text).frame_when_inactive(true);
    ui.add(button).on_hover_text(hint).clicked()
}

/// A button with an icon that stays down while `is_on`, without its name if it is compact; returns whether it was
/// clicked.
pub(super) fn switch_button(
    ui: &mut Ui,
    is_on: bool,
    icon: Icon,
    name: &str,
    is_compact: bool,
    hint: &str,
) -> bool {
    let text = icons::short(icon, name, is_compact);
    let button = egui::Button::selectable(is_on, text).frame_when_inactive(true);
    let button = ui.add(button);
    button.widget_info(|| {
        egui::WidgetInfo::selected(egui::accesskit::Role::Button, button.enabled(), is_on, name)
    });
    button.on_hover_text(hint).clicked()
}

/// A button that switches something on and off.
pub(super) fn toggle<'a>(ui: &mut Ui, is_on: &mut bool, text: impl egui::IntoAtoms<'a>, hint: &str) {
    *is_on ^= selectable(ui, *is_on, text, hint);
}

/// Text of low priority.
pub(crate) fn quiet(theme: &Theme, text: impl Into<String>) -> RichText {
    RichText::new(text).color(color(theme.quiet))
}

/// `text` on a small rounded background of `colour`.
pub(crate) fn pill(ui: &mut Ui, colour: Colour, theme: &Theme, text: &str) -> egui::Response {
    let ground = panel_colour(theme).mix(colour, 0.16);
    let frame = egui::Frame::new().fill(color(ground)).corner_radius(9).inner_margin(Margin::symmetric(8, 2));
    let ink = color(theme.legible(colour, ground));
    frame.show(ui, |ui| ui.label(RichText::new(text).color(ink))).inner
}

/// Whether Enter has just ended the typing in `field`, so that the dialog acts. Call it before the field regains the
/// focus.
pub(super) fn is_entered(ui: &Ui, field: &egui::Response) -> bool {
    field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter))
}

/// Selects all of `text` when its field gets the keyboard: as in a table, typing replaces it.
pub(super) fn replace_by_typing(ui: &Ui, field: &egui::Response, text: &str) {
    if field.gained_focus()
        && let Some(mut state) = egui::TextEdit::load_state(ui.ctx(), field.id)
    {
        let all = CCursorRange::two(CCursor::new(0), CCursor::new(text.chars().count()));
        state.cursor.set_char_range(Some(all));
        state.store(ui.ctx(), field.id);
    }
}

/// Writes one line that begins at `at`, centred vertically there; text wider than `width` points ends with dots.
pub(crate) fn write_within(
    painter: &egui::Painter,
    at: egui::Pos2,
    width: f32,
    text: &str,
    font: FontId,
    color: Color32,
) {
    let mut job = LayoutJob::simple_singleline(text.to_owned(), font, color);
    job.wrap = TextWrapping::truncate_at_width(width.max(0.0));
    let galley = painter.layout_job(job);
    painter.galley(at - vec2(0.0, 0.5 * galley.size().y), galley, color);
}

/// One line of a table: texts at the given places (shares of the width), numbers right-aligned there.
pub(super) struct TextRow<'a> {
    pub(super) ui: &'a Ui,
    pub(super) rect: egui::Rect,
    pub(super) size: f32,
}

impl TextRow<'_> {
    /// Draws from `share` of the width to the right; text that would go beyond `end` of it ends with dots.
    pub(super) fn left(&self, share: f32, end: f32, text: &str, color: Color32) {
        let x = self.rect.left() + share * self.rect.width();
        let at = egui::pos2(x, self.rect.center().y);
        let width = (end - share) * self.rect.width();
        write_within(self.ui.painter(), at, width, text, FontId::proportional(self.size), color);
    }

    /// Draws so that the text ends at `share` of the width.
    pub(super) fn right(&self, share: f32, text: &str, color: Color32) {
        let at = egui::pos2(self.rect.left() + share * self.rect.width(), self.rect.center().y);
        let font = FontId::proportional(self.size);
        self.ui.painter().text(at, egui::Align2::RIGHT_CENTER, text, font, color);
    }
}

/// Allocates one line of a table over the full width, with `spoken` for screen readers.
pub(super) fn row<'a>(ui: &'a mut Ui, height: f32, size: f32, spoken: &str) -> TextRow<'a> {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::Label, true, spoken));
    TextRow { ui, rect, size }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The colours of every theme that stand on panels, as text or as the edge of something.
    #[test]
    fn words_on_buttons_pills_and_panels_can_be_read_in_every_theme() {
        for (name, theme) in Theme::NAMED {
            let mut style = egui::Visuals::default();
            visuals(&mut style, &theme);
            let least = theme.least_contrast();
            let ratio = |ink: Color32, ground: Color32| {
                let of = |it: Color32| Colour::rgb(it.r(), it.g(), it.b());
                of(ink).contrast(of(ground))
            };
            let states = &style.widgets;
            for (state, face) in [
                ("inactive", &states.inactive),
                ("hovered", &states.hovered),
                ("active", &states.active),
                ("open", &states.open),
            ] {
                assert!(ratio(face.fg_stroke.color, face.weak_bg_fill) >= least, "{name}: {state}");
            }
            let panel = style.panel_fill;
            for ink in [
                style.text_color(),
                style.weak_text_color(),
                style.hyperlink_color,
                style.warn_fg_color,
                style.error_fg_color,
            ] {
                for ground in [panel, style.extreme_bg_color, style.faint_bg_color] {
                    assert!(ratio(ink, ground) >= least - 0.1, "{name}: {ink:?} on {ground:?}");
                }
            }
            let Stroke { color: ink, .. } = style.selection.stroke;
            assert!(ratio(ink, style.selection.bg_fill) >= least, "{name}: selected");
            for colour in [theme.good, theme.warning, theme.fault, theme.accent, theme.quiet] {
                let ground = panel_colour(&theme).mix(colour, 0.16);
                assert!(theme.legible(colour, ground).contrast(ground) >= least, "{name}: {colour}");
            }
        }
    }
}
