//! The files of `widgets/` and `layouts/`, compiled in.

/// The shipped kinds: file name and text.
pub(super) const KINDS: [(&str, &str); 7] = [
    ("widgets/button.ron", include_str!("../../widgets/button.ron")),
    ("widgets/fader.ron", include_str!("../../widgets/fader.ron")),
    ("widgets/heavy_button.ron", include_str!("../../widgets/heavy_button.ron")),
    ("widgets/round_button.ron", include_str!("../../widgets/round_button.ron")),
    ("widgets/slider.ron", include_str!("../../widgets/slider.ron")),
    ("widgets/soft_button.ron", include_str!("../../widgets/soft_button.ron")),
    ("widgets/switch.ron", include_str!("../../widgets/switch.ron")),
];

/// The shipped layouts: name and text.
const LAYOUTS: [(&str, &str); 3] = [
    ("first_steps", include_str!("../../layouts/first_steps.ron")),
    ("map", include_str!("../../layouts/map.ron")),
    ("surgical", include_str!("../../layouts/surgical.ron")),
];

/// The names of the layouts that come with underfoot, for [`builtin_layout`].
pub fn builtin_layouts() -> impl Iterator<Item = &'static str> {
    LAYOUTS.iter().map(|(name, _)| *name)
}

/// The text of the layout of this name that comes with underfoot; `None` if there is none.
///
/// It is the text of the file of that name in `layouts/`, comments included,
/// to be read by [`super::parse_layout`] or written out as a start for one's own.
#[must_use]
pub fn builtin_layout(name: &str) -> Option<&'static str> {
    LAYOUTS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
