//! Levels and waveforms of the actuators.

use super::feed::ScopeFeed;
use underfoot::engine::Snapshot;
use underfoot::floor::{Floor, TileId};

/// Number of scopes on display at once.
pub(super) const SLOTS: usize = 3;

/// Decay of the level shown on a tile, as the share left after one second: a click of 20 ms remains visible.
const FALL: f32 = 1e-3;

/// The signals of the actuators: a level for every tile, and waveforms for some.
pub(super) struct ActuatorScopes {
    feed: Option<Box<dyn ScopeFeed>>,
    levels: Vec<f32>,
    /// The tiles with a waveform on display, each with the number of frames since a foot was on it.
    slots: [Option<(TileId, u32)>; SLOTS],
}

impl ActuatorScopes {
    pub(super) fn new(feed: Option<Box<dyn ScopeFeed>>, floor: &Floor) -> Self {
        Self { feed, levels: vec![0.0; floor.geometry.tile_count()], slots: [None; SLOTS] }
    }

    /// Whether there is a signal source.
    pub(super) fn is_fed(&self) -> bool {
        self.feed.is_some()
    }

    /// Peak of each tile's actuator, in tile-index order, 0 to 1: it rises at once and decays exponentially.
    pub(super) fn levels(&self) -> &[f32] {
        &self.levels
    }

    /// Whether any actuator moves, or moved a moment ago.
    pub(super) fn are_moving(&self) -> bool {
        self.levels.iter().any(|level| *level > 0.0)
    }

    /// Takes in the signals since the last frame, which was `elapsed_s` ago.
    pub(super) fn update(&mut self, floor: &Floor, snapshot: &Snapshot, selected: TileId, elapsed_s: f32) {
        let Some(feed) = &mut self.feed else { return };
        feed.update();
        let fall = FALL.powf(elapsed_s.clamp(0.0, 1.0));
        for (level, actuator) in self.levels.iter_mut().zip(&floor.actuators) {
            let wave = actuator.map_or(&[][..], |actuator| feed.scope(usize::from(actuator.channel)));
            let peak = peak(wave);
            *level = (*level * fall).max(peak);
            if *level < 1e-4 {
                *level = 0.0;
            }
        }
        self.choose(snapshot, selected);
    }

    /// Assigns waveforms to slots: a tile that comes under a foot takes the slot unused for longest; the others stay.
    fn choose(&mut self, snapshot: &Snapshot, selected: TileId) {
        for (_, age) in self.slots.iter_mut().flatten() {
            *age = age.saturating_add(1);
        }
        let heaviest =
            snapshot.contacts.iter().filter_map(|contact| contact.tiles.first()).map(|load| load.tile);
        for tile in std::iter::once(selected).chain(heaviest).take(SLOTS) {
            if let Some((_, age)) = self.slots.iter_mut().flatten().find(|(shown, _)| *shown == tile) {
                *age = 0;
            } else if let Some(slot) =
                // The first of the slots unused for longest: empty slots fill from the top.
                self
                    .slots
                    .iter_mut()
                    .rev()
                    .max_by_key(|slot| slot.map_or(u32::MAX, |(_, age)| age))
            {
                *slot = Some((tile, 0));
            }
        }
    }

    /// Calls `show` for each slot, with its tile and waveform; the waveform is empty for a tile without an actuator.
    pub(super) fn for_each(&mut self, floor: &Floor, mut show: impl FnMut(Option<TileId>, &[(f32, f32)])) {
        for slot in self.slots {
            let tile = slot.map(|(tile, _)| tile);
            let actuator = tile
                .and_then(|tile| floor.geometry.index(tile))
                .and_then(|index| floor.actuators.get(index).copied().flatten());
            match (&mut self.feed, actuator) {
                (Some(feed), Some(actuator)) => show(tile, feed.scope(usize::from(actuator.channel))),
                _ => show(tile, &[]),
            }
        }
    }
}

/// The maximum absolute sample, at most 1; 0 for no samples; ignores NaN.
pub(super) fn peak(wave: &[(f32, f32)]) -> f32 {
    wave.iter().fold(0.0_f32, |peak, (low, high)| peak.max(-low).max(*high)).min(1.0)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::preview::sample::{at_rest, map, step_on};

    struct Wave(Vec<(f32, f32)>);

    impl ScopeFeed for Wave {
        fn scope(&mut self, channel: usize) -> &[(f32, f32)] {
            if channel == 7 { &self.0 } else { &[] }
        }
    }

    #[test]
    fn a_click_is_seen_on_its_tile_and_fades() {
        let floor = Floor::default();
        let snapshot = at_rest(&map());
        let wave = vec![(0.0, 0.0), (-0.4, 0.2), (f32::NAN, f32::NAN)];
        let mut scopes = ActuatorScopes::new(Some(Box::new(Wave(wave))), &floor);
        scopes.update(&floor, &snapshot, TileId::new(1, 1), 0.016);
        assert_eq!(scopes.levels()[7], 0.4);
        assert_eq!(scopes.levels()[8], 0.0);
        scopes.feed = Some(Box::new(Wave(vec![])));
        scopes.update(&floor, &snapshot, TileId::new(1, 1), 0.1);
        let faded = scopes.levels()[7];
        assert!((0.15..0.3).contains(&faded), "{faded}");
        for _ in 0..20 {
            scopes.update(&floor, &snapshot, TileId::new(1, 1), 0.1);
        }
        assert_eq!(scopes.levels()[7], 0.0);
    }

    #[test]
    fn waveforms_keep_their_places_while_feet_come_and_go() {
        let floor = Floor::default();
        let mut scopes = ActuatorScopes::new(Some(Box::new(Wave(vec![]))), &floor);
        let tiles =
            |scopes: &ActuatorScopes| scopes.slots.map(|slot| slot.map(|(tile, _)| (tile.column, tile.row)));
        let empty = at_rest(&map());
        let selected = TileId::new(0, 0);
        scopes.update(&floor, &empty, selected, 0.016);
        let mut one = empty.clone();
        step_on(&mut one, 1, Vec2::new(1.0, 1.0), 300.0, Vec2::ZERO);
        scopes.update(&floor, &one, selected, 0.016);
        let before = tiles(&scopes);
        assert!(before.contains(&Some((0, 0))) && before.contains(&Some((3, 3))));
        // After the foot is lifted, all waveforms stay in their slots.
        scopes.update(&floor, &empty, selected, 0.016);
        assert_eq!(tiles(&scopes), before);
    }
}
