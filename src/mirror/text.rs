//! A floor reconstructed from its JSON lines, for windows without its packets.

use std::time::Duration;

use glam::Vec2;
use serde::de;
use thiserror::Error;

use crate::engine::{Engine, FootRole, FootState, Snapshot};
use crate::floor::{Area, Floor, Geometry};
use crate::layout::Layout;
use crate::outgoing::json::{
    AreaRecord, ContactsRecord, EventRecord, JsonValue, Line, Message, StateRecord, Word,
};
use crate::outgoing::{AreaNews, AreaState};
use crate::sense::{Contact, ContactId, Method, Quality};
use crate::units::{Instant, Newtons};
use crate::widget::{Detail, Direction, EventKind, OffReason, Value, WidgetEvent, WidgetId};
use crate::wire::LinkState;

/// The error for a line that is not an event of a floor.
#[derive(Debug, Error)]
#[error("this is no line of a floor's events: {0}")]
pub struct BadLine(#[from] serde_json::Error);

/// A floor known from JSON lines only: its contacts, the events of its controls, and the states of its areas.
///
/// Its tiles have no forces, and a tile is silent while its area is not live. Values are those of the layout until a
/// line reports them.
#[derive(Clone, Debug)]
pub struct TextMirror {
    geometry: Geometry,
    layout: Layout,
    areas: Vec<(Area, AreaNews)>,
    /// For each control, the contact that presses it.
    pressed_by: Vec<Option<ContactId>>,
    snapshot: Snapshot,
}

impl TextMirror {
    /// The state before the first line: an empty floor with all tiles silent, and the controls of `layout`.
    #[must_use]
    pub fn new(floor: &Floor, layout: Layout) -> Self {
        let waiting = |area: &Area| AreaNews {
            at: Instant::START,
            area: area.id.clone(),
            state: AreaState::Waiting,
            why: String::new(),
            uncertainty: Duration::ZERO,
        };
        let areas = floor.areas.iter().map(|area| (area.clone(), waiting(area))).collect();
        let snapshot = Snapshot { floor_file: floor.file.clone(), ..Snapshot::default() };
        let (geometry, pressed_by) = (floor.geometry, Vec::new());
        let mut mirror = Self { geometry, layout: layout.clone(), areas, pressed_by, snapshot };
        mirror.begin(layout);
        mirror.show_areas();
        mirror
    }

    /// Replaces the layout; returns its [`Snapshot::layout_revision`].
    pub fn set_layout(&mut self, layout: Layout) -> u64 {
        let Snapshot { at, link, layout_revision, .. } = self.snapshot;
        let tiles = std::mem::take(&mut self.snapshot.tiles);
        self.begin(layout);
        (self.snapshot.at, self.snapshot.link, self.snapshot.tiles) = (at, link, tiles);
        self.snapshot.layout_revision = layout_revision + 1;
        self.snapshot.layout_revision
    }

    fn begin(&mut self, layout: Layout) {
        Engine::new(self.geometry, layout.clone(), Method::default())
            .with_floor_file(self.snapshot.floor_file.clone())
            .snapshot(&mut self.snapshot);
        // Only the floor's own computers know its calibration and the feet on a control.
        for widget in &mut self.snapshot.widgets {
            (widget.off, widget.needs_lift) = (None, false);
        }
        self.pressed_by = vec![None; layout.widgets.len()];
        self.layout = layout;
    }

    /// The current state of the floor, according to the lines so far.
    #[must_use]
    pub const fn snapshot(&self) -> &Snapshot {
        &self.snapshot
    }

    /// The state of each area, in the floor file's order; empty for a floor of one computer.
    pub fn areas(&self) -> impl Iterator<Item = &AreaNews> {
        self.areas.iter().map(|(_, news)| news)
    }

    /// Processes one line; returns the event if it is one of a control of this layout.
    ///
    /// Ignores controls and areas that do not exist, and unknown events.
    ///
    /// # Errors
    /// [`BadLine`] if it is not JSON, has no time, or has other types in the place of numbers; it is counted as
    /// malformed, and nothing else changes.
    pub fn take(&mut self, line: &str) -> Result<Option<WidgetEvent>, BadLine> {
        self.snapshot.counters.datagrams += 1;
        let (at, message) = read(line).inspect_err(|_| self.snapshot.counters.malformed += 1)?;
        self.snapshot.at = self.snapshot.at.max(at);
        match message {
            Message::Held(report) => {
                let ids = report.held.kept.iter().map(Word::as_str);
                let known = ids.filter(|id| self.layout.widget_index(id).is_some()).map(WidgetId::new);
                // At most the number of controls, however often a line names them.
                self.snapshot.held = known.take(self.layout.widgets.len()).collect();
            }
            Message::Contacts(record) => self.take_contacts(record),
            Message::Area(record) => self.take_area(at, record),
            Message::Link(record) => self.take_link(record.state.as_str()),
            Message::Page(record) => self.take_page(record.page.as_ref().map(Word::as_str)),
            Message::Gap(record) => self.snapshot.unsent_events += record.dropped,
            Message::State(record) => self.take_state(&record),
            Message::Control(record) => return Ok(self.take_event(at, &record)),
            _ => {}
        }
        Ok(None)
    }

    /// Ends the lines: clears the contacts and the controls that they held.
    pub fn end(&mut self) {
        self.take_contacts(ContactsRecord::default());
        self.show_link(LinkState::Lost);
        self.areas.iter_mut().for_each(|(_, news)| news.state = AreaState::Lost);
        self.snapshot.held.clear();
        self.pressed_by.fill(None);
        self.snapshot.widgets.iter_mut().for_each(|widget| {
            (widget.pressed, widget.armed, widget.warned, widget.press_share) = (false, false, false, 0.0);
        });
    }

    fn take_contacts(&mut self, ContactsRecord { contacts }: ContactsRecord) {
        self.snapshot.counters.frames += 1;
        self.snapshot.unsent_events += contacts.left_out;
        self.snapshot.contacts.clear();
        self.snapshot.contacts.extend(contacts.kept.into_iter().map(|contact| Contact {
            id: contact.id,
            centroid: Vec2::new(contact.x_m, contact.y_m),
            force: Newtons(contact.force_n),
            velocity: Vec2::new(contact.x_velocity_m_s, contact.y_velocity_m_s),
            ..Contact::default()
        }));
        // The lines do not contain persons or roles.
        let foot = |contact: &Contact| FootState {
            contact: contact.id,
            role: FootRole::Free,
            person: contact.id.0,
            weight: None,
        };
        self.snapshot.feet = self.snapshot.contacts.iter().map(foot).collect();
        for index in 0..self.pressed_by.len() {
            self.show_press(index);
        }
        if self.areas.is_empty() && self.snapshot.link == LinkState::Waiting {
            self.show_link(LinkState::Live);
        }
    }

    /// Shows the force of the foot that presses this control.
    fn show_press(&mut self, index: usize) {
        let by = self.pressed_by.get(index).copied().flatten();
        let contact = self.snapshot.contacts.iter().find(|contact| Some(contact.id) == by);
        let (Some(widget), Some(state)) =
            (self.layout.widgets.get(index), self.snapshot.widgets.get_mut(index))
        else {
            return;
        };
        let least = widget.behaviour.thresholds().press.0;
        state.press_share = contact.map_or(0.0, |contact| contact.force.0 / least.max(1.0));
    }

    fn take_area(&mut self, at: Instant, record: AreaRecord) {
        let named = |(area, _): &&mut (Area, AreaNews)| record.area == area.id.as_str();
        let Some((_, news)) = self.areas.iter_mut().find(named) else { return };
        let Some(state) = AreaState::ALL.into_iter().find(|state| record.state == state.name()) else {
            return;
        };
        let uncertainty = Duration::try_from_secs_f64(record.uncertainty_s).unwrap_or_default();
        *news = AreaNews { at, area: news.area.clone(), state, why: record.why.0, uncertainty };
        self.show_areas();
    }

    /// Marks the tiles of areas that are not live as silent.
    fn show_areas(&mut self) {
        if self.areas.is_empty() {
            return self.show_link(self.snapshot.link);
        }
        for (area, news) in &self.areas {
            let quality = if news.state == AreaState::Live { Quality::Live } else { Quality::Stale };
            for index in area.tiles.tiles().filter_map(|tile| self.geometry.index(tile)) {
                if let Some(tile) = self.snapshot.tiles.get_mut(index) {
                    tile.quality = [quality; 4];
                }
            }
        }
        let count = |state| self.areas.iter().filter(|(_, news)| news.state == state).count();
        self.snapshot.link = match (count(AreaState::Live), count(AreaState::Waiting)) {
            (live, _) if live == self.areas.len() => LinkState::Live,
            (0, waiting) if waiting == self.areas.len() => LinkState::Waiting,
            (0, _) => LinkState::Lost,
            _ => LinkState::Partial,
        };
    }

    fn take_link(&mut self, state: &str) {
        let known = [LinkState::Waiting, LinkState::Live, LinkState::Partial, LinkState::Lost];
        if let Some(link) = known.into_iter().find(|link| link.name() == state)
            && self.areas.is_empty()
        {
            self.show_link(link);
        }
    }

    /// Sets the link of a floor of one computer; the lines do not name silent boards.
    fn show_link(&mut self, link: LinkState) {
        self.snapshot.link = link;
        let is_sensed = matches!(link, LinkState::Live | LinkState::Partial);
        let quality = if is_sensed { Quality::Live } else { Quality::Stale };
        self.snapshot.tiles.iter_mut().for_each(|tile| tile.quality = [quality; 4]);
    }

    fn take_page(&mut self, name: Option<&str>) {
        let Some(page) = self.layout.pages.iter().position(|page| Some(page.id.as_str()) == name) else {
            return;
        };
        self.snapshot.page = page;
        for (state, widget) in self.snapshot.widgets.iter_mut().zip(&self.layout.widgets) {
            state.hidden = !widget.is_on(page);
        }
    }

    fn take_state(&mut self, line: &StateRecord) {
        let Some(index) = self.layout.widget_index(line.id.as_str()) else { return };
        let Some(state) = self.snapshot.widgets.get_mut(index) else { return };
        state.value = state.value.map(|known| like(known, &line.value).unwrap_or(known));
        if let Some(enabled) = line.enabled {
            // A reason that this version does not know also keeps the control off.
            let named = line.off.as_ref().and_then(|off| OffReason::from_name(off.as_str()));
            state.off = named.or((!enabled).then_some(OffReason::Disabled));
            state.disabled = state.off == Some(OffReason::Disabled);
        }
        state.locked = line.locked.unwrap_or(state.locked);
        state.armed = line.armed.unwrap_or(state.armed);
        state.pressed = line.pressed.unwrap_or(state.pressed);
    }

    fn take_event(&mut self, at: Instant, line: &EventRecord) -> Option<WidgetEvent> {
        let id = line.id.as_str();
        let index = self.layout.widget_index(id)?;
        let state = self.snapshot.widgets.get_mut(index)?;
        let kind = EventKind::of(line.event.as_str(), detail(state.value, &line.value))?;
        let contact = line.contact;
        match kind {
            EventKind::Pressed => state.pressed = true,
            EventKind::Released | EventKind::Cancelled => (state.pressed, state.warned) = (false, false),
            EventKind::Changed(value) => state.value = Some(value),
            EventKind::Armed => state.armed = true,
            EventKind::Disarmed => state.armed = false,
            EventKind::Warned => state.warned = true,
            EventKind::Clicked
            | EventKind::DoubleTapped
            | EventKind::LongPressed
            | EventKind::Swiped(_)
            | EventKind::HardPressed
            | EventKind::HardReleased
            | EventKind::Ticked
            | EventKind::Refused => {}
        }
        self.pressed_by[index] = if state.pressed { contact.or(self.pressed_by[index]) } else { None };
        self.show_press(index);
        let position = Vec2::new(line.x_m, line.y_m);
        Some(WidgetEvent { at, id: WidgetId::new(id), kind, contact, force: Newtons(line.force_n), position })
    }
}

/// Returns time and message of a line.
fn read(text: &str) -> Result<(Instant, Message), serde_json::Error> {
    let line = Line::read(text.as_bytes())?;
    let at = line.at.ok_or_else(|| de::Error::missing_field("t_s"))?;
    Ok((at, line.message))
}

/// The detail of an event besides its name, for a control with a value like `known`.
fn detail(known: Option<Value>, said: &JsonValue) -> Option<Detail> {
    let is_said = |direction: &Direction| matches!(said, JsonValue::Text(name) if *name == direction.name());
    let direction = || Direction::ALL.into_iter().find(is_said);
    let value = known.and_then(|known| like(known, said));
    value.map(Detail::Value).or_else(|| direction().map(Detail::Direction))
}

/// A value of the same kind as `known`; `None` if the kind differs or the number is not finite.
fn like(known: Value, said: &JsonValue) -> Option<Value> {
    match (known, said) {
        (Value::Switch(_), JsonValue::Flag(on)) => Some(Value::Switch(*on)),
        (Value::Number(_), said) => said.number().filter(|number| number.is_finite()).map(Value::Number),
        (Value::Choice(_), said) => said.number().and_then(choice).map(Value::Choice),
        (Value::Pair(_), JsonValue::Numbers(pair)) => {
            Some(Vec2::from(*pair)).filter(|pair| pair.is_finite()).map(Value::Pair)
        }
        _ => None,
    }
}

/// The index that a number stands for, if any.
fn choice(number: f32) -> Option<u16> {
    let is_choice = number.fract() == 0.0 && (0.0..=f32::from(u16::MAX)).contains(&number);
    is_choice.then_some(number as u16)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::floor::TileBlock;
    use crate::floor::TileId;
    use crate::schema::{Kinds, builtin_layout, parse_layout};

    fn layout(name: &str, floor: &Floor) -> Layout {
        parse_layout(builtin_layout(name).unwrap(), name, &Kinds::builtin(), &floor.geometry).unwrap().layout
    }

    /// A floor of two areas, three columns each, and the map's controls on it.
    fn hall() -> TextMirror {
        let area =
            |id, column| Area::new(id, TileBlock { first: TileId::new(column, 0), columns: 3, rows: 6 });
        let floor = Floor::default().with_areas(vec![area("west", 0), area("east", 3)]);
        TextMirror::new(&floor, layout("map", &floor))
    }

    fn take(mirror: &mut TextMirror, lines: &[&str]) -> Vec<WidgetEvent> {
        lines.iter().filter_map(|line| mirror.take(line).unwrap()).collect()
    }

    const WEST: &str =
        r#"{"t_s":1.0,"event":"area","area":"west","state":"live","why":"","uncertainty_s":0.0002}"#;
    const EAST: &str =
        r#"{"t_s":1.1,"event":"area","area":"east","state":"live","why":"","uncertainty_s":0.0003}"#;
    const LOST: &str = r#"{"t_s":2.0,"event":"area","area":"east","state":"lost","why":"nothing new from its node for 100 ms","uncertainty_s":0.0}"#;

    #[test]
    fn the_tiles_of_a_lost_area_are_silent_and_those_of_others_are_not() {
        let mut hall = hall();
        let silent = |hall: &TextMirror| -> Vec<usize> {
            let is_silent = |tile: &usize| hall.snapshot().tiles[*tile].quality == [Quality::Stale; 4];
            (0..36).filter(is_silent).collect()
        };
        assert_eq!((silent(&hall).len(), hall.snapshot().link), (36, LinkState::Waiting));
        take(&mut hall, &[WEST]);
        assert_eq!(hall.snapshot().link, LinkState::Partial);
        take(&mut hall, &[EAST]);
        assert_eq!((silent(&hall), hall.snapshot().link), (vec![], LinkState::Live));
        take(&mut hall, &[LOST]);
        let east: Vec<usize> = (0..36).filter(|tile| tile % 6 >= 3).collect();
        assert_eq!((silent(&hall), hall.snapshot().link), (east, LinkState::Partial));
        let named: Vec<&str> = hall.areas().map(|news| news.why.as_str()).collect();
        assert_eq!(named, ["", "nothing new from its node for 100 ms"]);
        assert_eq!(hall.snapshot().at, Instant::from_millis(2000));
        hall.end();
        assert_eq!((silent(&hall).len(), hall.snapshot().link), (36, LinkState::Lost));
        assert!(hall.areas().all(|news| news.state == AreaState::Lost));
    }

    #[test]
    fn a_press_shows_its_force_until_the_foot_lets_go_or_the_lines_end() {
        let mut hall = hall();
        let press = r#"{"t_s":3.0,"event":"pressed","id":"home","value":null,"force_n":62.0,"x_m":0.4,"y_m":1.3,"contact":7}"#;
        let foot = r#"{"t_s":3.01,"event":"contacts","contacts":[{"id":7,"x_m":0.41,"y_m":1.3,"force_n":90.0,"x_velocity_m_s":0.1,"y_velocity_m_s":0.0}]}"#;
        let told = take(&mut hall, &[WEST, press, foot]);
        assert_eq!((told.len(), told[0].kind, told[0].contact), (1, EventKind::Pressed, Some(ContactId(7))));
        let index = hall.layout.widget_index("home").unwrap();
        let least = hall.layout.widgets[index].behaviour.thresholds().press.0;
        let state = hall.snapshot().widgets[index];
        assert!(state.pressed && (state.press_share - 90.0 / least).abs() < 1e-6);
        assert_eq!(hall.snapshot().contacts[0].centroid, Vec2::new(0.41, 1.3));
        let mut ended = hall.clone();
        ended.end();
        assert!(!ended.snapshot().widgets[index].pressed && ended.snapshot().contacts.is_empty());
        let release = press.replace("pressed", "released");
        assert_eq!(take(&mut hall, &[&release])[0].kind, EventKind::Released);
        assert_eq!((hall.snapshot().widgets[index].pressed, hall.pressed_by[index]), (false, None));
    }

    #[test]
    fn values_are_of_the_kind_that_the_control_holds() {
        let mut hall = hall();
        let floor = Floor::default();
        hall.set_layout(layout("all_controls", &floor));
        assert_eq!(hall.snapshot().layout_revision, 1);
        for index in 0..hall.layout.widgets.len() {
            let id = hall.layout.widgets[index].id.clone();
            let Some(value) = hall.snapshot().widgets[index].value else { continue };
            let (said, value) = match value {
                Value::Switch(_) => ("true".to_owned(), Value::Switch(true)),
                Value::Number(_) => ("0.25".to_owned(), Value::Number(0.25)),
                Value::Choice(_) => ("1".to_owned(), Value::Choice(1)),
                Value::Pair(_) => ("[0.25,-0.5]".to_owned(), Value::Pair(Vec2::new(0.25, -0.5))),
            };
            let line = format!(r#"{{"t_s":4.0,"event":"changed","id":"{id}","value":{said}}}"#);
            assert_eq!(take(&mut hall, &[&line])[0].kind, EventKind::Changed(value), "{id}");
            assert_eq!(hall.snapshot().widgets[index].value, Some(value), "{id}");
            let odd = format!(r#"{{"t_s":4.0,"event":"changed","id":"{id}","value":"wide"}}"#);
            assert!(take(&mut hall, &[&odd]).is_empty(), "{id} holds no words");
        }
    }

    #[test]
    fn a_page_hides_what_is_on_another() {
        let text = r#"Layout(
            version: 1,
            regions: [(id: "desk", at: (0, 2), size: (6, 4))],
            pages: [
                (id: "maps", widgets: [(id: "home", kind: "button", at: (0.2, 2.2), size: (0.8, 0.8))]),
                (id: "notes", widgets: [(id: "write", kind: "button", at: (2.2, 2.2), size: (0.8, 0.8))]),
            ],
        )"#;
        let floor = Floor::default();
        let layout = parse_layout(text, "pages", &Kinds::builtin(), &floor.geometry).unwrap().layout;
        let mut mirror = TextMirror::new(&floor, layout);
        let hidden = |mirror: &TextMirror| [0, 1].map(|index| mirror.snapshot().widgets[index].hidden);
        assert_eq!(hidden(&mirror), [false, true]);
        take(&mut mirror, &[r#"{"t_s":5.0,"event":"page","page":"notes"}"#]);
        assert_eq!((mirror.snapshot().page, hidden(&mirror)), (1, [true, false]));
        take(&mut mirror, &[r#"{"t_s":5.0,"event":"page","page":"atlas"}"#]);
        assert_eq!(mirror.snapshot().page, 1, "there is no such page");
    }

    #[test]
    fn what_is_no_line_of_a_floor_is_counted_and_changes_nothing() {
        let mut hall = hall();
        take(&mut hall, &[WEST]);
        for odd in [
            "",
            "null",
            "{}",
            "[1]",
            r#"{"t_s":"soon"}"#,
            r#"{"t_s":1,"event":"contacts","contacts":[{"id":-1}]}"#,
        ] {
            assert!(hall.take(odd).is_err(), "{odd}");
        }
        assert_eq!(hall.snapshot().counters.malformed, 6);
        // The time stays finite for any number, and a control of this layout is not pressed.
        take(
            &mut hall,
            &[r#"{"t_s":1e300,"event":"pressed","id":"nobody's"}"#, r#"{"t_s":-1,"event":"jumped"}"#],
        );
        assert_eq!(hall.snapshot().at, Instant::from_millis(1000));
    }
}
