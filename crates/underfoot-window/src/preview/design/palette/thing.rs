//! The things that can be put down: their names, sizes and sections.

use glam::Vec2;

use underfoot::floor::Geometry;
use underfoot::schema::Kinds;

/// Size of a control of about one tile: 16 cm and more suit a shoe (rule U101).
const SMALL_M: Vec2 = Vec2::new(0.18, 0.16);

/// Size of a control that needs room to slide or lean.
const WIDE_M: Vec2 = Vec2::new(0.36, 0.18);

/// Something to put down.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::preview::design) enum PaletteThing {
    /// A control of this kind.
    Control(String),
    Region,
    Stance,
    /// A ground of this name.
    Ground(&'static str),
}

/// A part of the palette: what feet do there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PaletteSection {
    /// The user's own kinds.
    Own,
    Press,
    Slide,
    Choose,
    Hold,
    WalkOn,
}

impl PaletteSection {
    pub(super) const ALL: [Self; 6] =
        [Self::Own, Self::Press, Self::Slide, Self::Choose, Self::Hold, Self::WalkOn];

    pub(super) fn title(self) -> &'static str {
        match self {
            Self::Own => "Your own",
            Self::Press => "Press",
            Self::Slide => "Slide",
            Self::Choose => "Choose",
            Self::Hold => "Hold",
            Self::WalkOn => "Walk on",
        }
    }
}

impl PaletteThing {
    pub(super) fn name(&self) -> String {
        match self {
            Self::Control(kind) => kind.replace('_', " "),
            Self::Region => "region".into(),
            Self::Stance => "place to stand".into(),
            Self::Ground(name) => name.to_lowercase(),
        }
    }

    /// Its size when it is put down, in metres: a multiple of a twentieth of a tile.
    pub(in crate::preview::design) fn size(&self, geometry: &Geometry) -> Vec2 {
        let grid = 0.05 * geometry.pitch_m();
        let size = match self {
            Self::Control(kind) => {
                let wide = ["slider", "fader", "stepper", "selector", "lean", "pad"];
                if wide.iter().any(|name| kind.contains(name)) { WIDE_M } else { SMALL_M }
            }
            Self::Region | Self::Ground(_) => 2.0 * geometry.pitch_m(),
            Self::Stance => Vec2::new(2.0, 1.0) * geometry.pitch_m(),
        };
        (size / grid).round() * grid
    }

    /// Everything that can be put down, by section; `is_own` tells the user's own kinds from the shipped ones.
    pub(super) fn all(kinds: &Kinds, is_own: impl Fn(&str) -> bool) -> Vec<(PaletteSection, Self)> {
        let mut all: Vec<(PaletteSection, Self)> = kinds
            .iter()
            .map(|kind| {
                let section = match kind.behaviour.name() {
                    _ if is_own(&kind.name) => PaletteSection::Own,
                    "button" => PaletteSection::Press,
                    "switch" | "selector" | "stepper" => PaletteSection::Choose,
                    "hold" | "pedal" | "lean" => PaletteSection::Hold,
                    _ => PaletteSection::Slide,
                };
                (section, Self::Control(kind.name.clone()))
            })
            .collect();
        let places = [Self::Region, Self::Stance];
        let grounds = ["Ice", "Snow", "Gravel", "Sand", "Wood"].map(Self::Ground);
        all.extend(places.into_iter().chain(grounds).map(|thing| (PaletteSection::WalkOn, thing)));
        let order = |section| PaletteSection::ALL.iter().position(|one| *one == section);
        all.sort_by_key(|(section, _)| order(*section));
        all
    }

    /// How well the words of a search fit: 0 for its very name, more for less; `None` if they do not fit at all.
    pub(super) fn rank(&self, section: PaletteSection, words: &str) -> Option<u8> {
        let words = words.trim().to_lowercase();
        let name = self.name();
        let is_in_all = |text: &str| words.split_whitespace().all(|word| text.contains(word));
        match () {
            () if name == words => Some(0),
            () if name.starts_with(&words) => Some(1),
            () if is_in_all(&name) => Some(2),
            () if is_in_all(&section.title().to_lowercase()) => Some(3),
            () => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shipped_kind_stands_where_feet_would_look_for_it() {
        let all = PaletteThing::all(&Kinds::builtin(), |_| false);
        let of = |name: &str| all.iter().find(|(_, thing)| thing.name() == name).map(|(section, _)| *section);
        for (name, section) in [
            ("heavy button", PaletteSection::Press),
            ("arc slider", PaletteSection::Slide),
            ("dial", PaletteSection::Slide),
            ("stepper", PaletteSection::Choose),
            ("dead man", PaletteSection::Hold),
            ("gravel", PaletteSection::WalkOn),
        ] {
            assert_eq!(of(name), Some(section), "{name}");
        }
        assert!(!all.iter().any(|(section, _)| *section == PaletteSection::Own));
    }

    #[test]
    fn the_very_name_comes_before_names_that_only_contain_it() {
        let rank =
            |kind: &str, words: &str| PaletteThing::Control(kind.into()).rank(PaletteSection::Press, words);
        assert_eq!((rank("button", "Button"), rank("round_button", "button")), (Some(0), Some(2)));
        assert_eq!((rank("round_button", "but rou"), rank("switch", "press")), (Some(2), Some(3)));
        assert_eq!(rank("switch", "ice"), None);
    }
}
