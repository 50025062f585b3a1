//! The effects of a control: their waveforms, and a button that plays them on the floor.

use std::collections::HashMap;
use std::sync::Arc;

use eframe::egui::accesskit::Role;
use eframe::egui::{Sense, Ui, WidgetInfo, vec2};

use super::field::ShownField;
use super::words::{choice, label};
use crate::preview::PreviewCommand;
use crate::preview::trace::Trace;
use underfoot::feel::{Effect, Feel, Gesture};
use underfoot_scene::scene::Theme;

/// Height of a waveform, in points.
const WAVE_PX: f32 = 30.0;

/// The rendered effects on display, by field.
#[derive(Default)]
pub(super) struct Waveforms {
    traces: HashMap<String, (Arc<Effect>, Trace)>,
    /// Whether one was rendered in this frame: each takes some milliseconds.
    is_busy: bool,
}

impl Waveforms {
    /// Begins a frame, in which one effect may be rendered.
    pub(super) fn begin(&mut self) {
        self.is_busy = false;
    }

    /// The waveform of `effect`, the value of the field called `name`; `None` until it is rendered.
    fn of(&mut self, ui: &Ui, name: &str, effect: &Arc<Effect>) -> Option<&Trace> {
        let is_known = self.traces.get(name).is_some_and(|(known, _)| **known == **effect);
        if !is_known && self.is_busy {
            ui.ctx().request_repaint();
            return None;
        }
        if !is_known {
            self.is_busy = true;
            let trace = Trace::of(effect, &Gesture::usual(effect));
            self.traces.insert(name.to_owned(), (Arc::clone(effect), trace));
        }
        self.traces.get(name).map(|(_, trace)| trace)
    }
}

/// The effect of the field, from its record or from its kind.
fn effect_of(field: &ShownField<'_>) -> Option<Arc<Effect>> {
    let part = field.property.name.strip_prefix("feel.")?;
    let Feel { press, release, step, end, stage, arm, warn, on, off, hold, drag, sound: _ } =
        &field.widget()?.feel;
    let parts = [
        ("press", press),
        ("release", release),
        ("step", step),
        ("end", end),
        ("stage", stage),
        ("arm", arm),
        ("warn", warn),
        ("on", on),
        ("off", off),
        ("hold", hold),
        ("drag", drag),
    ];
    parts.into_iter().find(|(name, _)| *name == part)?.1.clone()
}

/// The name of the field's effect in plain words; `None` for a field without an effect.
pub(super) fn effect_name(field: &ShownField<'_>) -> Option<String> {
    let effect = effect_of(field)?;
    let mut all = field.edited.document.all_kinds().effects().iter();
    let named = all.find(|named| *named.effect == *effect);
    Some(named.map_or_else(
        || format!("its own {}", effect.kind.name().to_lowercase()),
        |named| choice(&named.name),
    ))
}

/// The waveform of the field's effect with a button that plays it on the tile under the control; returns the command
/// for the floor.
pub(super) fn picture(ui: &mut Ui, field: &ShownField<'_>, waves: &mut Waveforms) -> Option<PreviewCommand> {
    let effect = effect_of(field)?;
    let name = label(&field.property.name).to_lowercase();
    let mut is_wanted = false;
    ui.horizontal(|ui| {
        ui.add_space(16.0);
        let width = (ui.available_width() - 56.0).max(60.0);
        let (rect, shown) = ui.allocate_exact_size(vec2(width, WAVE_PX), Sense::hover());
        let figures = waves.of(ui, &field.property.name, &effect).map(|trace| {
            draw(ui, field.theme, trace, rect);
            trace.figures()
        });
        let figures = figures.unwrap_or_else(|| "being drawn".to_owned());
        shown.widget_info(|| WidgetInfo::labeled(Role::Image, true, format!("Waveform {name}: {figures}")));
        shown.on_hover_text(figures);
        let button = ui.small_button("Hear");
        button.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("Hear {name}")));
        is_wanted = button.on_hover_text("Play it on the tile under the control").clicked();
    });
    is_wanted.then(|| {
        let geometry = &field.edited.document.floor().geometry;
        let item = field.edited.item(field.record);
        let centre = item.map_or(geometry.bounds().centre(), |item| item.area.centre());
        let tile = geometry.tile_under(centre).and_then(|tile| geometry.index(tile)).unwrap_or_default();
        let gesture = Gesture::usual(&effect);
        PreviewCommand::Feel { effect, gesture, tile }
    })
}

fn draw(ui: &Ui, theme: &Theme, trace: &Trace, rect: eframe::egui::Rect) {
    if ui.is_rect_visible(rect) {
        trace.thumbnail(&ui.painter_at(rect), theme, rect);
    }
}
