//! The setups of one or two projectors: place of the floor, brightness and screen of each.

use super::brightness::Brightness;
use super::placement::Placement;

/// Maximum number of projectors: one on each side, so that each lights the floor where a person's shadow hides the
/// picture of the other.
pub(super) const MOST: usize = 2;

/// The setup of one projector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ProjectorSetup {
    /// The place of the floor; `None` until the user sets it, and then the floor fits the picture.
    pub(super) placement: Option<Placement>,
    pub(super) brightness: Brightness,
    /// The screen that it fills, numbered by the system from 0; `None` for the screen on which its window is.
    pub(super) screen: Option<usize>,
}

impl Default for ProjectorSetup {
    fn default() -> Self {
        Self { placement: None, brightness: Brightness::FULL, screen: None }
    }
}

/// The setups of both projectors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ProjectorPair {
    /// The second one stays as it was while it is not in use, so that it is found as it was left.
    pub(super) setups: [ProjectorSetup; MOST],
    /// Whether the second one is in use.
    pub(super) has_second: bool,
}

impl ProjectorPair {
    /// Number of projectors in use.
    pub(super) fn count(&self) -> usize {
        if self.has_second { 2 } else { 1 }
    }

    /// Light where all projectors in use shine, in per cent of the most that one gives.
    pub(super) fn light_percent(&self) -> u16 {
        self.setups.iter().take(self.count()).map(|setup| u16::from(setup.brightness.percent())).sum()
    }

    /// Takes the second projector into use; it gets half of the first one's light, so that the floor becomes no
    /// brighter.
    pub(super) fn add_second(&mut self) {
        if self.has_second {
            return;
        }
        self.has_second = true;
        let [first, second] = &mut self.setups;
        let light = i32::from(first.brightness.percent());
        second.brightness = first.brightness.changed(light / 2 - light);
        first.brightness = first.brightness.changed(-(light / 2));
    }

    /// Takes the second projector out of use; the first one gets its light too, up to all that it gives.
    pub(super) fn remove_second(&mut self) {
        if !self.has_second {
            return;
        }
        self.has_second = false;
        let [first, second] = &mut self.setups;
        first.brightness = first.brightness.changed(i32::from(second.brightness.percent()));
    }
}

/// A projector's name, for people and for tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ProjectorName {
    /// 0 for the first one, 1 for the second one.
    pub(super) index: usize,
}

impl ProjectorName {
    /// The name as the head of something.
    pub(super) const fn title(self) -> &'static str {
        if self.index == 0 { "First projector" } else { "Second projector" }
    }

    /// The name within a sentence.
    pub(super) const fn inline(self) -> &'static str {
        if self.index == 0 { "the first projector" } else { "the second projector" }
    }

    /// The spoken name of `part` on this projector's picture.
    pub(super) fn label(self, part: &str) -> String {
        if self.index == 0 { part.to_owned() } else { format!("{part} of {}", self.inline()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_projector_takes_half_of_the_light_and_gives_it_back() {
        let mut pair = ProjectorPair::default();
        pair.setups[0].brightness = Brightness::new(75).unwrap();
        pair.add_second();
        let percents = |pair: &ProjectorPair| pair.setups.map(|setup| setup.brightness.percent());
        assert_eq!((percents(&pair), pair.count()), ([38, 37], 2));
        pair.add_second();
        assert_eq!(pair.light_percent(), 75, "adding it once more changes nothing");
        pair.remove_second();
        assert_eq!((pair.count(), pair.light_percent()), (1, 75));
        pair.remove_second();
        assert_eq!(pair.light_percent(), 75);
    }

    #[test]
    fn the_second_projector_is_found_as_it_was_left() {
        let mut pair = ProjectorPair::default();
        pair.add_second();
        let placement = Placement::fit(1.0, 1.6);
        pair.setups[1] = ProjectorSetup { placement: Some(placement), screen: Some(2), ..pair.setups[1] };
        pair.remove_second();
        pair.add_second();
        assert_eq!(pair.setups[1].placement, Some(placement));
        assert_eq!(pair.setups[1].screen, Some(2));
        assert_eq!(pair.setups[0].placement, None, "each has corners of its own");
    }
}
