//! The side panel's list of grounds.

use eframe::egui;
use eframe::egui::{CollapsingHeader, Ui};

use super::link::{figure, grouped};
use underfoot::engine::Snapshot;
use underfoot::ground::{GroundMaterial, GroundState};
use underfoot::layout::Layout;
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Shows the events of each ground on the page: one line, until the user opens it.
pub(super) fn grounds_part(ui: &mut Ui, theme: &Theme, layout: &Layout, snapshot: &Snapshot) {
    for (number, (ground, state)) in layout.grounds.iter().zip(&snapshot.grounds).enumerate() {
        if !ground.spec.is_on(snapshot.page) {
            continue;
        }
        ui.add_space(2.0);
        let title = egui::RichText::new(headline(&ground.spec.material, state)).color(color(theme.ink));
        CollapsingHeader::new(title).id_salt(("ground", number)).show_unindented(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 1.0;
            for (name, count) in lines(&ground.spec.material, state) {
                figure(ui, theme, name, count, false);
            }
            ui.spacing_mut().item_spacing.y = 5.0;
        });
    }
}

/// A summary in one line.
fn headline(material: &GroundMaterial, state: &GroundState) -> String {
    let (count, what) = match material {
        GroundMaterial::Ice(_) => (state.cracks.len() as u64, "pieces"),
        GroundMaterial::Grain(_) => (state.counters.events, "grains"),
        GroundMaterial::Wood(_) => (state.counters.events, "creaks"),
    };
    format!("{}: {} {what}", material.name(), grouped(count))
}

/// Names and counts.
fn lines(material: &GroundMaterial, state: &GroundState) -> Vec<(&'static str, u64)> {
    let counters = &state.counters;
    let mut lines = match material {
        GroundMaterial::Ice(spec) => vec![
            ("pieces of crack", state.cracks.len() as u64),
            ("at most", spec.cracks.most as u64),
            ("seeds", state.seeds.len() as u64),
            ("evicted by new pieces", counters.evicted),
            ("events", counters.events),
        ],
        GroundMaterial::Grain(_) => vec![("grain events", counters.events)],
        GroundMaterial::Wood(_) => vec![("creaks", counters.events)],
    };
    lines.push(("too thick to be felt one by one", counters.unfelt));
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use underfoot::floor::Geometry;
    use underfoot::ground::{Crack, GroundCounters};
    use underfoot::schema::{Kinds, builtin_layout, parse_layout};

    fn materials(layout: &str) -> Vec<GroundMaterial> {
        let text = builtin_layout(layout).unwrap();
        let loaded = parse_layout(text, layout, &Kinds::builtin(), &Geometry::default()).unwrap();
        loaded.layout.grounds.iter().map(|ground| ground.spec.material).collect()
    }

    #[test]
    fn ice_tells_its_pieces_and_loose_ground_its_grains() {
        let crack = Crack { ..Crack::default() };
        let counters = GroundCounters { events: 1500, unfelt: 7, evicted: 296 };
        let state = GroundState { cracks: vec![crack; 1204], counters, ..GroundState::default() };
        let ice = materials("pond")[0];
        assert_eq!(headline(&ice, &state), "Ice: 1\u{a0}204 pieces");
        let lines = lines(&ice, &state);
        assert!(lines.contains(&("evicted by new pieces", 296)) && lines.contains(&("events", 1500)));
        let loose = materials("winter_walk");
        let loose = loose.iter().find(|material| matches!(material, GroundMaterial::Grain(_))).unwrap();
        assert!(headline(loose, &state).ends_with(": 1\u{a0}500 grains"));
    }
}
