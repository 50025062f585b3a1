//! The files of `widgets/`, `effects/`, `layouts/` and `floors/`, compiled in.

/// The shipped kinds: file name and text.
pub(super) const KINDS: [(&str, &str); 21] = [
    ("widgets/arc_slider.ron", include_str!("../../widgets/arc_slider.ron")),
    ("widgets/button.ron", include_str!("../../widgets/button.ron")),
    ("widgets/confirm_button.ron", include_str!("../../widgets/confirm_button.ron")),
    ("widgets/dead_man.ron", include_str!("../../widgets/dead_man.ron")),
    ("widgets/dial.ron", include_str!("../../widgets/dial.ron")),
    ("widgets/fader.ron", include_str!("../../widgets/fader.ron")),
    ("widgets/gesture_button.ron", include_str!("../../widgets/gesture_button.ron")),
    ("widgets/heavy_button.ron", include_str!("../../widgets/heavy_button.ron")),
    ("widgets/hold.ron", include_str!("../../widgets/hold.ron")),
    ("widgets/instant_button.ron", include_str!("../../widgets/instant_button.ron")),
    ("widgets/lean.ron", include_str!("../../widgets/lean.ron")),
    ("widgets/pad.ron", include_str!("../../widgets/pad.ron")),
    ("widgets/pedal.ron", include_str!("../../widgets/pedal.ron")),
    ("widgets/rate_slider.ron", include_str!("../../widgets/rate_slider.ron")),
    ("widgets/round_button.ron", include_str!("../../widgets/round_button.ron")),
    ("widgets/selector.ron", include_str!("../../widgets/selector.ron")),
    ("widgets/slider.ron", include_str!("../../widgets/slider.ron")),
    ("widgets/soft_button.ron", include_str!("../../widgets/soft_button.ron")),
    ("widgets/stepper.ron", include_str!("../../widgets/stepper.ron")),
    ("widgets/switch.ron", include_str!("../../widgets/switch.ron")),
    ("widgets/two_stage_button.ron", include_str!("../../widgets/two_stage_button.ron")),
];

/// The shipped effects: file name and text. An effect made of another one comes after it.
pub(super) const EFFECTS: [(&str, &str); 22] = [
    ("effects/confirm_arm.ron", include_str!("../../effects/confirm_arm.ron")),
    ("effects/crisp_click.ron", include_str!("../../effects/crisp_click.ron")),
    ("effects/detent.ron", include_str!("../../effects/detent.ron")),
    ("effects/done.ron", include_str!("../../effects/done.ron")),
    ("effects/double_click.ron", include_str!("../../effects/double_click.ron")),
    ("effects/end_stop.ron", include_str!("../../effects/end_stop.ron")),
    ("effects/engine_hum.ron", include_str!("../../effects/engine_hum.ron")),
    ("effects/glass.ron", include_str!("../../effects/glass.ron")),
    ("effects/grating.ron", include_str!("../../effects/grating.ron")),
    ("effects/gravel.ron", include_str!("../../effects/gravel.ron")),
    ("effects/heavy_click.ron", include_str!("../../effects/heavy_click.ron")),
    ("effects/leather.ron", include_str!("../../effects/leather.ron")),
    ("effects/long_press_rise.ron", include_str!("../../effects/long_press_rise.ron")),
    ("effects/refused.ron", include_str!("../../effects/refused.ron")),
    ("effects/rubber.ron", include_str!("../../effects/rubber.ron")),
    ("effects/sand.ron", include_str!("../../effects/sand.ron")),
    ("effects/smooth.ron", include_str!("../../effects/smooth.ron")),
    ("effects/soft_click.ron", include_str!("../../effects/soft_click.ron")),
    ("effects/switch_off.ron", include_str!("../../effects/switch_off.ron")),
    ("effects/switch_on.ron", include_str!("../../effects/switch_on.ron")),
    ("effects/warning.ron", include_str!("../../effects/warning.ron")),
    ("effects/wood.ron", include_str!("../../effects/wood.ron")),
];

/// The shipped layouts in the order of the gallery: name and text.
const LAYOUTS: [(&str, &str); 14] = [
    ("map", include_str!("../../layouts/map.ron")),
    ("museum_room", include_str!("../../layouts/museum_room.ron")),
    ("radiology_reading", include_str!("../../layouts/radiology_reading.ron")),
    ("fluoroscopy", include_str!("../../layouts/fluoroscopy.ron")),
    ("stage_cues", include_str!("../../layouts/stage_cues.ron")),
    ("rehab_steps", include_str!("../../layouts/rehab_steps.ron")),
    ("ice_piano", include_str!("../../layouts/ice_piano.ron")),
    ("surgical", include_str!("../../layouts/surgical.ron")),
    ("pond", include_str!("../../layouts/pond.ron")),
    ("winter_walk", include_str!("../../layouts/winter_walk.ron")),
    ("first_steps", include_str!("../../layouts/first_steps.ron")),
    ("all_controls", include_str!("../../layouts/all_controls.ron")),
    ("dicom_viewer", include_str!("../../layouts/dicom_viewer.ron")),
    ("globe", include_str!("../../layouts/globe.ron")),
];

/// The shipped floors: name and text.
const FLOORS: [(&str, &str); 4] = [
    ("balance_board", include_str!("../../floors/balance_board.ron")),
    ("dance_pad", include_str!("../../floors/dance_pad.ron")),
    ("load_cells", include_str!("../../floors/load_cells.ron")),
    ("paper", include_str!("../../floors/paper.ron")),
];

/// Returns the names of the floors that come with underfoot, for [`builtin_floor`].
pub fn builtin_floors() -> impl Iterator<Item = &'static str> {
    FLOORS.iter().map(|(name, _)| *name)
}

/// Returns the text of the floor of this name that comes with underfoot; `None` if there is none.
///
/// It is the text of the file of that name in `floors/`, with comments. It can be read by [`super::parse_floor`] or
/// written to a file as the start of another floor.
#[must_use]
pub fn builtin_floor(name: &str) -> Option<&'static str> {
    FLOORS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// Returns the names of the layouts that come with underfoot, for [`builtin_layout`]; those to start from come first.
pub fn builtin_layouts() -> impl Iterator<Item = &'static str> {
    LAYOUTS.iter().map(|(name, _)| *name)
}

/// Returns the text of the layout of this name that comes with underfoot; `None` if there is none.
///
/// It is the text of the file of that name in `layouts/`, with comments. It can be read by [`super::parse_layout`] or
/// written to a file as the start of another layout.
#[must_use]
pub fn builtin_layout(name: &str) -> Option<&'static str> {
    LAYOUTS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// Returns the sentence at the head of a file: its first paragraph of comments, in one line; empty without one.
///
/// ```
/// let map = underfoot::schema::builtin_layout("map").unwrap_or_default();
/// assert_eq!(underfoot::schema::head_comment(map), "Map navigation on the 6 x 6 floor.");
/// ```
#[must_use]
pub fn head_comment(text: &str) -> String {
    let lines = text.trim_start_matches('\u{feff}').lines().map(str::trim);
    let comments = lines.skip_while(|line| line.is_empty()).map_while(|line| line.strip_prefix("//"));
    let paragraph: Vec<&str> = comments.map(str::trim).take_while(|line| !line.is_empty()).collect();
    paragraph.join(" ")
}
