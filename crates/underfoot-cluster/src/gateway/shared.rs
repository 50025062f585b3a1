//! The state that the whole floor shares: layout, page, and settings of apps. Nodes that join receive it.

use std::collections::BTreeMap;

use underfoot::feel::Muted;
use underfoot::floor::{Area, Floor, Geometry, NoSuchSensor, SensorChoice, TileId};
use underfoot::layout::Layout;
use underfoot::wire::ControlMessage;

/// The state that all nodes share.
#[derive(Clone, Debug)]
pub(super) struct SharedState {
    geometry: Geometry,
    areas: Vec<Area>,
    /// The tiles that an actuator moves, by tile index.
    moved: Vec<bool>,
    /// The area of each control.
    controls: BTreeMap<String, usize>,
    pages: Vec<String>,
    /// The proposed layout.
    proposed: Option<Layout>,
    /// The page on the floor, once a node has reported one.
    pub(super) page: Option<String>,
    pub(super) muted: Muted,
    /// The settings of apps, by control and property.
    kept: BTreeMap<String, ControlMessage>,
}

impl SharedState {
    pub(super) fn new(floor: &Floor) -> Self {
        Self {
            geometry: floor.geometry,
            areas: floor.areas.clone(),
            moved: floor.actuators.iter().map(Option::is_some).collect(),
            controls: BTreeMap::new(),
            pages: Vec::new(),
            proposed: None,
            page: None,
            muted: Muted::default(),
            kept: BTreeMap::new(),
        }
    }

    pub(super) fn propose(&mut self, layout: Layout) {
        self.proposed = Some(layout);
    }

    pub(super) fn drop_proposal(&mut self) {
        self.proposed = None;
    }

    /// Makes the proposed layout the current one.
    pub(super) fn take_proposal(&mut self) {
        let Some(layout) = self.proposed.take() else { return };
        let owner = |place| self.areas.iter().position(|area| area.holds(&self.geometry, place));
        let controls = layout.widgets.iter();
        self.controls = controls
            .filter_map(|widget| Some((widget.id.as_str().to_owned(), owner(widget.area.centre())?)))
            .collect();
        self.pages = layout.pages.iter().map(|page| page.id.as_str().to_owned()).collect();
        self.page = self.page.take().filter(|page| self.pages.contains(page));
    }

    /// The area of the control `id`.
    pub(super) fn owner(&self, id: &str) -> Option<usize> {
        self.controls.get(id).copied()
    }

    /// The ids of all controls.
    pub(super) fn ids(&self) -> impl Iterator<Item = &str> {
        self.controls.keys().map(String::as_str)
    }

    /// The page on the floor; empty without pages.
    pub(super) fn page(&self) -> &str {
        self.page.as_ref().or(self.pages.first()).map_or("", String::as_str)
    }

    /// The area whose computer moves `tile`, or the reason why none does.
    pub(super) fn mover(&self, tile: TileId) -> Result<usize, &'static str> {
        let index = self.geometry.index(tile).ok_or("the floor has no such tile")?;
        let area = self.areas.iter().position(|area| area.tiles.contains(tile));
        let is_moved = self.moved.get(index).copied().unwrap_or(false);
        area.filter(|_| is_moved).ok_or("nothing moves that tile")
    }

    /// The area whose computer uses these sensors, or the reason why none does. Boards have their numbers on the
    /// areas' own computers.
    pub(super) fn reader(&self, choice: SensorChoice) -> Result<usize, String> {
        let tile = match choice {
            SensorChoice::Tile(tile) => tile,
            SensorChoice::Sensor(sensor) => sensor.tile,
            SensorChoice::Channel { .. } => {
                return Err("on a floor of several computers, name a tile or a sensor".to_owned());
            }
        };
        let area = self.areas.iter().position(|area| area.tiles.contains(tile));
        area.filter(|_| self.geometry.has(tile)).ok_or_else(|| NoSuchSensor(choice).to_string())
    }

    /// Stores a setting of an app, for nodes that join later; returns whether the muted set has changed.
    pub(super) fn keep(&mut self, message: &ControlMessage) -> bool {
        let path = message.path();
        let stem = || path.rsplit_once('/').map_or("", |(stem, _)| stem).to_owned();
        match message {
            ControlMessage::Enable { .. } | ControlMessage::Disable { .. } => {
                self.kept.insert(format!("{}/enabled", stem()), message.clone());
            }
            ControlMessage::Lock { .. } | ControlMessage::Unlock { .. } => {
                self.kept.insert(format!("{}/locked", stem()), message.clone());
            }
            ControlMessage::Label { .. }
            | ControlMessage::Indicate { .. }
            | ControlMessage::SetRange { .. } => {
                self.kept.insert(path, message.clone());
            }
            ControlMessage::Mute { on } => return std::mem::replace(&mut self.muted.all, *on) != *on,
            ControlMessage::MuteTile { tile, on } => {
                let was = self.muted.tiles.contains(tile);
                self.muted.tiles.retain(|other| other != tile);
                if *on {
                    self.muted.tiles.push(*tile);
                    self.muted.tiles.sort_by_key(|tile| (tile.row, tile.column));
                }
                return was != *on;
            }
            _ => {}
        }
        false
    }

    /// The mute settings for the node of area number `number`.
    pub(super) fn mutes_of(&self, number: usize) -> Vec<ControlMessage> {
        let mut all = vec![ControlMessage::Mute { on: self.muted.all }];
        let own = self.areas.get(number).map(|area| area.tiles);
        let muted = self.muted.tiles.iter().filter(|tile| own.is_some_and(|own| own.contains(**tile)));
        all.extend(muted.map(|&tile| ControlMessage::MuteTile { tile, on: true }));
        all
    }

    /// The settings of apps for the controls of area number `number`.
    pub(super) fn settings_of(&self, number: usize) -> Vec<ControlMessage> {
        let kept = self.kept.values().filter(|message| {
            let id = (*message).clone().id_mut().map(|id| id.as_str().to_owned());
            id.is_some_and(|id| self.controls.get(&id) == Some(&number))
        });
        kept.cloned().collect()
    }
}
