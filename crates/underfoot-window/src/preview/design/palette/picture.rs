//! Pictures of things, drawn as the floor draws them.

use std::collections::HashMap;
use std::sync::{Arc, LazyLock};

use eframe::egui;
use eframe::egui::Ui;
use glam::Vec2;

use super::thing::PaletteThing;
use crate::edit::Document;
use underfoot::engine::{Snapshot, WidgetState};
use underfoot::floor::{Geometry, Rect};
use underfoot::layout::{Layout, Widget};
use underfoot::schema::{ControlKind, Kinds, parse_layout};
use underfoot::widget::{Value, WidgetId};
use underfoot_scene::egui_painter::{self, Palette, ScreenFromFloor};
use underfoot_scene::scene::{self, Scene, Show, Theme, View};

/// The kinds that come with underfoot.
static SHIPPED: LazyLock<Kinds> = LazyLock::new(Kinds::builtin);

/// Whether `kind` comes with underfoot, unchanged.
pub(in crate::preview::design) fn is_shipped(kind: &ControlKind) -> bool {
    SHIPPED.get(&kind.name) == Some(kind)
}

/// A part of a floor with one thing on it.
struct Sample {
    geometry: Geometry,
    layout: Layout,
}

/// The samples of regions, places to stand and grounds, by name.
static SAMPLES: LazyLock<HashMap<String, Arc<Sample>>> = LazyLock::new(|| {
    let grounds = ["Ice", "Snow", "Gravel", "Sand", "Wood"].map(PaletteThing::Ground);
    let things = [PaletteThing::Region, PaletteThing::Stance].into_iter().chain(grounds);
    things.filter_map(|thing| Some((thing.name(), Arc::new(sample(&thing)?)))).collect()
});

/// A sample of `thing` on three tiles by two; `None` for a control.
fn sample(thing: &PaletteThing) -> Option<Sample> {
    let geometry = Geometry::of_paper_tiles(3, 2).ok()?;
    let part = match thing {
        PaletteThing::Control(_) => return None,
        PaletteThing::Region => "regions: [(id: \"r\", at: (0.3, 0.3), size: (2.4, 1.4))]".to_owned(),
        PaletteThing::Stance => "stances: [(at: (0.4, 0.4), size: (2.2, 1.2))]".to_owned(),
        PaletteThing::Ground(name) => format!("grounds: [{name}(at: (0, 0), size: (3, 2))]"),
    };
    let layout = parse_layout(&format!("Layout(version: 1, {part})"), "sample", &SHIPPED, &geometry);
    Some(Sample { geometry, layout: layout.ok()?.layout })
}

/// Draws `thing` in `rect` as it looks on the floor.
pub(in crate::preview::design) fn draw_thing(
    ui: &Ui,
    theme: &Theme,
    palette: &mut Palette,
    document: &Document,
    thing: &PaletteThing,
    rect: egui::Rect,
) {
    let PaletteThing::Control(kind) = thing else {
        let Some(sample) = SAMPLES.get(&thing.name()) else { return };
        let snapshot = Snapshot::default();
        let view =
            View { show: Show::PROJECTOR, ..View::new(&sample.geometry, &sample.layout, &snapshot, theme) };
        return draw(ui, palette, &view, sample.geometry.bounds(), rect);
    };
    let Some(kind) = document.all_kinds().get(kind) else { return };
    let area = Rect::from_min_size(Vec2::ZERO, thing.size(&document.floor().geometry));
    let widget = Widget {
        id: WidgetId::new("it"),
        kind: kind.name.clone(),
        region: 0,
        page: None,
        goto: None,
        area,
        label: String::new(),
        behaviour: kind.behaviour.clone(),
        feel: kind.feel.clone(),
        look: kind.look,
        send: Vec::new(),
    };
    draw_widget(ui, theme, palette, document, &widget, false, rect);
}

/// Draws one control alone in `rect`, at rest or pressed.
pub(in crate::preview::design) fn draw_widget(
    ui: &Ui,
    theme: &Theme,
    palette: &mut Palette,
    document: &Document,
    widget: &Widget,
    is_pressed: bool,
    rect: egui::Rect,
) {
    let value = match widget.behaviour.initial() {
        Some(Value::Switch(_)) => Some(Value::Switch(is_pressed)),
        other => other,
    };
    let press_share = if is_pressed { 1.0 } else { 0.0 };
    let state = WidgetState { pressed: is_pressed, press_share, value, ..WidgetState::default() };
    let snapshot = Snapshot { widgets: vec![state], ..Snapshot::default() };
    let widget = Widget { page: None, ..widget.clone() };
    let layout = Layout { widgets: vec![widget], ..Layout::default() };
    let geometry = &document.floor().geometry;
    let view = View { show: Show::PROJECTOR, ..View::new(geometry, &layout, &snapshot, theme) };
    let Some(area) = layout.widgets.first().map(|widget| widget.area) else { return };
    draw(ui, palette, &view, area, rect);
}

/// Draws the part `area` of a floor in `rect`; the floor around it is cut off.
fn draw(ui: &Ui, palette: &mut Palette, view: &View<'_>, area: Rect, rect: egui::Rect) {
    if !ui.is_rect_visible(rect) {
        return;
    }
    let mut drawn = Scene::new();
    scene::draw(&mut drawn, view);
    let map = ScreenFromFloor::fit(area.grown(0.01), rect);
    let clip = map.rect(area.grown(0.004)).intersect(ui.clip_rect());
    egui_painter::paint(&ui.painter().with_clip_rect(clip), palette, &drawn, map);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_that_is_no_control_has_a_picture_of_its_own() {
        let names = ["region", "place to stand", "ice", "snow", "gravel", "sand", "wood"];
        let drawn = names.map(|name| {
            let sample = SAMPLES.get(name).unwrap_or_else(|| panic!("no sample of {name}"));
            let (theme, snapshot) = (Theme::default(), Snapshot::default());
            let view = View {
                show: Show::PROJECTOR,
                ..View::new(&sample.geometry, &sample.layout, &snapshot, &theme)
            };
            let mut drawn = Scene::new();
            scene::draw(&mut drawn, &view);
            format!("{drawn:?}")
        });
        for (index, one) in drawn.iter().enumerate() {
            assert!(!drawn[..index].contains(one), "{} looks like another", names[index]);
        }
    }
}
