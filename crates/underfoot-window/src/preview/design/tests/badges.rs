//! Warnings on the canvas: one badge for each control, and the text beside it on hover and selection.

use super::*;

/// The map with two controls that are too small for a shoe.
fn crowded() -> Desk {
    let text = builtin_layout("map").unwrap();
    let mut desk = Desk::on(text, None);
    let doc = desk.designer_mut();
    let corner = doc.layout().regions[0].area.max;
    let small = Rect::from_min_size(corner - glam::Vec2::splat(0.12), glam::Vec2::splat(0.05));
    let control = super::super::palette::PaletteThing::Control("button".into());
    assert!(doc.edited.put(&control, small, None), "{:?}", doc.edited.message.as_ref().map(|it| &it.text));
    doc.edited.selected.clear();
    desk.window.run_steps(3);
    desk
}

#[test]
fn a_control_with_warnings_has_one_badge_and_its_text_covers_no_control() {
    let mut desk = crowded();
    let badges: Vec<String> = desk
        .window
        .query_all_by_label_contains("Warnings of ")
        .filter_map(|node| egui_kittest::kittest::NodeT::accesskit_node(&node).label())
        .collect();
    assert!(!badges.is_empty());
    let mut controls: Vec<&str> = badges.iter().filter_map(|it| it.split(':').next()).collect();
    controls.sort_unstable();
    let count = controls.len();
    controls.dedup();
    assert_eq!(controls.len(), count, "one for each control: {badges:?}");
    assert_eq!(desk.window.query_all_by_role(Role::Tooltip).count(), 0, "calm until it is asked for");
    let at = desk.window.get_by_label(&badges[0]).rect().center();
    desk.window.event(Event::PointerMoved(at));
    desk.window.run_steps(3);
    let text = desk.window.get_by_role(Role::Tooltip).rect();
    for node in desk.window.query_all_by_label_contains("On the floor: ") {
        let name = egui_kittest::kittest::NodeT::accesskit_node(&node).label().unwrap_or_default();
        let is_control = desk.designer().layout().widgets.iter().any(|it| name.ends_with(&it.label));
        assert!(!is_control || !node.rect().intersects(text), "the text covers {name}");
    }
}
