//! Visual rules: contrast and labels.

use std::collections::HashSet;

use super::{Part, Subject};
use crate::scene::{self, Mark, Scene, Show, Theme, View};
use underfoot::engine::Snapshot;
use underfoot::floor::Floor;
use underfoot::layout::{Icon, Layout};

/// Minimum contrast of text.
const TEXT: f32 = 4.5;
/// Minimum contrast of large text.
const LARGE_TEXT: f32 = 3.0;

pub(super) fn review(subject: &mut Subject<'_>, is_cut: bool) {
    let widget = subject.widget;
    let look = widget.look;
    let icon = look.icon.filter(|_| Icon::is_shown_on(&widget.behaviour));
    if widget.label.trim().is_empty() && icon.is_none() {
        let message = format!("nothing tells what {} is for", subject.name());
        subject.warning("U303", Part::Id, message, "it has neither label nor icon".into());
        return;
    }
    let faces = [("at rest", look.face), ("lit", look.lit)];
    let contrasts = faces.map(|(when, face)| (look.ink.contrast(face), when));
    let least = contrasts.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((contrast, when)) = least.filter(|(contrast, _)| *contrast < TEXT) {
        let message = format!("{} is hard to read {when}", subject.name());
        let expected = format!("ink and face have a contrast of {contrast:.1}, 4.5 is wanted");
        if contrast < LARGE_TEXT {
            subject.error("U301", Part::Look, message, expected);
        } else {
            subject.warning("U301", Part::Look, message, expected);
        }
    }
    if is_cut {
        let message = format!("the label of {} does not fit on it", subject.name());
        subject.warning("U302", Part::Label, message, "its end is left out".into());
    }
}

/// Finds the controls with a label that is cut off when drawn.
pub(super) fn cut_labels(layout: &Layout, floor: &Floor) -> HashSet<usize> {
    let mut cut = HashSet::new();
    let mut scene = Scene::new();
    for page in 0..layout.pages.len().max(1) {
        let mut snapshot = Snapshot { page, ..Snapshot::default() };
        snapshot.widgets = layout
            .widgets
            .iter()
            .map(|widget| underfoot::engine::WidgetState {
                hidden: !widget.is_on(page),
                ..Default::default()
            })
            .collect();
        let view =
            View { show: Show::PROJECTOR, ..View::new(&floor.geometry, layout, &snapshot, &Theme::LIGHT) };
        scene::draw(&mut scene, &view);
        for mark in scene.marks() {
            let Mark::Text { letters, lettering } = mark else { continue };
            if !scene.letters(*letters).ends_with('…') {
                continue;
            }
            let on = |widget: &underfoot::layout::Widget| {
                widget.is_on(page) && widget.area.contains(lettering.at) && !widget.label.ends_with('…')
            };
            cut.extend(layout.widgets.iter().rposition(on));
        }
    }
    cut
}
