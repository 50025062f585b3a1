//! The light of a projector, as a share of the most that it gives.

use eframe::egui::Color32;

/// Exponent from a colour's component to its light, as projectors have it.
///
/// # Source
/// IEC 61966-2-1 (sRGB): the mean over the whole range is 2.2.
const GAMMA: f32 = 2.2;

/// Light of a projector, as a share of the most that it gives: 0 to 100 %.
///
/// The share is one of light, so the light of two projectors adds up: two that have 50 % each give as much, where both
/// shine, as one with 100 %.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Brightness(u8);

impl Brightness {
    /// All the light that a projector gives.
    pub(super) const FULL: Self = Self(100);

    /// The brightness of `percent`; `None` above 100.
    pub(super) fn new(percent: u8) -> Option<Self> {
        (percent <= 100).then_some(Self(percent))
    }

    /// The share in per cent, 0 to 100.
    pub(super) const fn percent(self) -> u8 {
        self.0
    }

    /// The brightness `by` per cent brighter, darker if negative; it ends at 0 and at 100.
    pub(super) fn changed(self, by: i32) -> Self {
        let percent = i32::from(self.0).saturating_add(by).clamp(0, 100);
        Self(u8::try_from(percent).unwrap_or(100))
    }

    /// `color` with this share of its light; its opacity stays.
    pub(super) fn dim(self, color: Color32) -> Color32 {
        self.dimmer()(color)
    }

    /// [`Brightness::dim`] for many colours.
    pub(super) fn dimmer(self) -> impl Fn(Color32) -> Color32 {
        let factor = (f32::from(self.0) / 100.0).powf(1.0 / GAMMA);
        move |color: Color32| {
            let [red, green, blue, alpha] = color.to_array();
            let [red, green, blue] = [red, green, blue].map(|part| (f32::from(part) * factor).round() as u8);
            Color32::from_rgba_premultiplied(red, green, blue, alpha)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The light of a component, 0 to 1.
    fn light(component: u8) -> f32 {
        (f32::from(component) / 255.0).powf(GAMMA)
    }

    #[test]
    fn two_projectors_that_share_the_light_give_the_light_of_one() {
        let color = Color32::from_rgb(255, 180, 60);
        for first in [0, 10, 35, 50, 80, 100] {
            let pair = [first, 100 - first].map(|percent| Brightness::new(percent).unwrap().dim(color));
            for part in 0..3 {
                let sum: f32 = pair.iter().map(|color| light(color.to_array()[part])).sum();
                let one = light(color.to_array()[part]);
                assert!((sum - one).abs() < 0.01, "{first} %: {sum} instead of {one}");
            }
        }
    }

    #[test]
    fn the_opacity_stays_and_nothing_shines_at_zero() {
        let half = Color32::from_rgba_premultiplied(100, 100, 100, 128);
        assert_eq!(Brightness::FULL.dim(half), half);
        assert_eq!(Brightness(0).dim(half), Color32::from_rgba_premultiplied(0, 0, 0, 128));
        assert_eq!(Brightness(50).dim(half).a(), 128);
    }

    #[test]
    fn it_ends_at_0_and_at_100() {
        assert_eq!(Brightness::new(101), None);
        assert_eq!(Brightness::FULL.changed(5), Brightness::FULL);
        assert_eq!(Brightness(3).changed(-5), Brightness(0));
        assert_eq!(Brightness(50).changed(5).percent(), 55);
    }
}
