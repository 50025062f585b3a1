//! Joins the contacts and events of many areas into one floor's.
//!
//! [`Gateway`] is pure: the caller passes messages and the time, and receives reports. They depend on the content of
//! the nodes' messages and not on the order of arrival, as long as none is more than [`WINDOW`] late.
//!
//! ```text
//! NodeMessage -claim-> one node an area -clock-> times here -> queue, in time order -> join: contacts' names
//!                                                                                    -> presses: what apps know
//! silence of 100 ms, by the frames' own age -> presses cancelled, contacts ended
//! ```

mod area;
mod ask;
mod claim;
mod clock;
mod held;
mod join;
mod layouts;
mod output;
mod presses;
mod requests;
mod shared;
#[cfg(test)]
mod tests;

use std::borrow::Cow;
use std::collections::{BTreeMap, HashSet};
use std::time::Duration;

use glam::Vec2;
use thiserror::Error;
use underfoot::floor::Floor;
use underfoot::layout::Layout;
use underfoot::schema::write_layout;
use underfoot::sink::{AreaNews, Report};
use underfoot::units::Instant;
use underfoot::widget::WidgetEvent;
use underfoot::wire::LinkState;

use self::area::{JoinedArea, MessageUse};
use self::held::HeldReports;
use self::join::Joiner;
use self::layouts::{GatewayLayouts, ProposalOutcome};
use self::requests::Requests;
use self::shared::SharedState;
use crate::message::{
    AreaStanding, GatewayMessage, LayoutMessage, LayoutOrder, LayoutStanding, NodeContact, NodeEvent,
    NodeFrame, NodeMessage, NodeValue, VERSION, fingerprint, shown,
};

pub use area::LOST_AFTER;
pub use ask::RequestAnswer;
pub use clock::NodeClock;
pub use output::{Counters, Output};

/// Time for which the reports of one area wait for those of other areas about earlier times.
pub const WINDOW: Duration = Duration::from_millis(25);

/// Interval between two alive reports.
const ALIVE_EVERY: Duration = Duration::from_millis(100);

/// Interval between two reports of contacts: a frame.
const CONTACTS_EVERY: Duration = Duration::from_millis(1);

/// Greatest number of items of any kind in one message; the gateway refuses longer ones, as no area has so many.
const MOST: usize = 4096;

/// Greatest length of the name of an unknown area, in characters.
const LONGEST_AREA: usize = 64;

/// Number of refused nodes that are remembered, so that each causes one notice.
const COMPLAINTS: usize = 64;

/// The reason why a floor can have no gateway.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum NoGateway {
    /// The floor file names no areas.
    #[error("the floor file has no `areas`: one computer serves such a floor, with `underfoot run`")]
    NoAreas,
}

/// One report of an area in the queue.
#[derive(Clone, Debug)]
enum Item {
    Event(NodeEvent),
    Frame { contacts: Vec<NodeContact> },
    Held { held: Vec<String>, values: Option<Vec<(String, NodeValue)>> },
}

/// The areas of a floor, joined.
#[derive(Clone, Debug)]
pub struct Gateway {
    id: u64,
    floor: u64,
    names: Vec<String>,
    areas: Vec<JoinedArea>,
    joiner: Joiner,
    /// By ordering time, area and number, with the reported time, which may be before the ordering time.
    queue: BTreeMap<(Instant, usize, u64), (Instant, Item)>,
    number: u64,
    /// Time up to which all reports have been sent.
    told_until: Instant,
    contacts_told: Option<Instant>,
    is_anybody_there: bool,
    held: HeldReports,
    link: LinkState,
    alive: (u32, Instant),
    complained: HashSet<u64>,
    shared: SharedState,
    requests: Requests,
    layouts: GatewayLayouts,
    /// Whether nodes need a message before the next beat is due.
    has_news: bool,
    counters: Counters,
    out: Vec<Output>,
}

impl Gateway {
    /// A gateway of the areas of `floor`; `id` is its nonce.
    ///
    /// # Errors
    /// [`NoGateway`] for a floor without areas.
    pub fn new(floor: &Floor, id: u64) -> Result<Self, NoGateway> {
        if floor.areas.is_empty() {
            return Err(NoGateway::NoAreas);
        }
        Ok(Self {
            id,
            floor: fingerprint(floor),
            names: floor.areas.iter().map(|area| area.id.clone()).collect(),
            areas: vec![JoinedArea::default(); floor.areas.len()],
            joiner: Joiner::new(floor),
            queue: BTreeMap::new(),
            number: 0,
            told_until: Instant::START,
            contacts_told: None,
            is_anybody_there: false,
            held: HeldReports::default(),
            link: LinkState::Waiting,
            alive: (0, Instant::START),
            complained: HashSet::new(),
            shared: SharedState::new(floor),
            requests: Requests::default(),
            layouts: GatewayLayouts::default(),
            has_news: false,
            counters: Counters::default(),
            out: Vec::new(),
        })
    }

    /// The counts of received and withheld messages so far.
    #[must_use]
    pub const fn counters(&self) -> Counters {
        self.counters
    }

    /// The standing of the area `id`; `None` for an unknown one.
    #[must_use]
    pub fn standing(&self, id: &str) -> Option<AreaStanding> {
        let area = self.names.iter().position(|name| name == id)?;
        self.areas.get(area).map(|area| area.standing)
    }

    /// The message for all nodes at `now`: the standings of their areas, and a time against which they compare their
    /// clocks.
    #[must_use]
    pub fn message(&self, now: Instant) -> GatewayMessage {
        let standings = self.areas.iter().map(|area| area.standing);
        let current = self.layouts.current();
        let from = |(name, area): (&String, &JoinedArea)| {
            let (_, from) = current?;
            Some((name.clone(), area.clock.there(from)?))
        };
        GatewayMessage {
            version: VERSION,
            gateway: self.id,
            sent: now.micros(),
            areas: self.names.iter().cloned().zip(standings).collect(),
            requests: self.requests.unanswered().cloned().collect(),
            layout: LayoutOrder {
                current: current.map(|(name, _)| name),
                from: self.names.iter().zip(&self.areas).filter_map(from).collect(),
            },
        }
    }

    /// Proposes a layout, checked for the whole floor, at `now`: all nodes run it afterwards, or none.
    pub fn propose(&mut self, layout: Layout, now: Instant) {
        let text = write_layout(&layout);
        if self.layouts.is_known(&text) {
            return;
        }
        self.layouts.propose(text, now);
        self.shared.propose(layout);
    }

    /// The layout that nodes need at `now`, if any.
    pub fn layout_message(&mut self, now: Instant) -> Option<LayoutMessage> {
        let (name, text) = self.layouts.send(live(&self.names, &self.areas), now)?;
        Some(LayoutMessage { version: VERSION, gateway: self.id, name, text: text.to_owned() })
    }

    /// Whether nodes need a message before the next beat is due.
    pub fn take_news(&mut self) -> bool {
        std::mem::take(&mut self.has_news) | self.requests.take_news()
    }

    /// Takes a message of a node, received at `now`, a time at or after that of all earlier calls.
    pub fn take(&mut self, mut message: NodeMessage, now: Instant) {
        self.counters.messages += 1;
        message.tidy();
        let Some(number) = self.suited(&message) else {
            self.counters.refused += 1;
            return;
        };
        let Some(area) = self.areas.get_mut(number) else { return };
        let before = area.holder;
        let worth = area.note(&message, now);
        if area.holder != before {
            area.page = None;
        }
        if area.holder == Some(message.node) {
            area.layout.clone_from(&message.layout);
            for answer in message.answers.iter().filter(|answer| answer.gateway == self.id) {
                self.requests.note(number, answer.clone());
            }
        }
        if area.holder != before && area.standing == AreaStanding::Live {
            self.fall(number, AreaStanding::Lost, "its node was started again", now);
        }
        match worth {
            MessageUse::Nothing => {}
            MessageUse::Stale => self.counters.stale += 1,
            MessageUse::ClockSet => {
                if self.areas.get(number).is_some_and(|area| area.standing == AreaStanding::Live) {
                    self.fall(number, AreaStanding::Lost, "its node's clock was set", now);
                }
            }
            MessageUse::Fresh { lost } => {
                self.counters.lost += lost;
                self.join(number, message, lost > 0, now);
            }
        }
    }

    /// The reports that are due at `now`, a time at or after that of all earlier calls.
    pub fn advance(&mut self, now: Instant) -> Vec<Output> {
        for number in 0..self.areas.len() {
            let Some(area) = self.areas.get_mut(number) else { continue };
            let Some(standing) = area.fallen(now) else { continue };
            let why = match standing {
                AreaStanding::Disputed => {
                    format!(
                        "{} both serve it: neither is believed until one of them has stopped",
                        area.claims.names()
                    )
                }
                _ if area.silent => "nothing usable from its boards".to_owned(),
                _ => "nothing new from its node for 100 ms".to_owned(),
            };
            self.fall(number, standing, &why, now);
        }
        let told = self.areas.iter().filter(|area| area.standing == AreaStanding::Live).map(|area| area.told);
        // Areas later than the window do not delay the others.
        let until = told.min().unwrap_or(now).max(now.before(WINDOW));
        while let Some(entry) = self.queue.first_entry().filter(|entry| entry.key().0 <= until) {
            let ((at, area, _), (happened, item)) = entry.remove_entry();
            self.tell(area, at, happened, item);
        }
        self.told_until = self.told_until.max(until);
        self.tell_answers(now);
        self.decide(now);
        self.bring_up(now);
        self.tell_contacts(until, now);
        self.tell_state(now);
        std::mem::take(&mut self.out)
    }

    /// The final reports of a gateway that stops at `now`: it cancels all holds, which are unknown from then on.
    pub fn end(&mut self, now: Instant) -> Vec<Output> {
        for number in 0..self.areas.len() {
            if self.areas.get(number).is_some_and(|area| area.standing == AreaStanding::Live) {
                self.fall(number, AreaStanding::Lost, "the gateway has stopped", now);
            }
        }
        self.tell_contacts(now, now);
        self.tell_state(now);
        std::mem::take(&mut self.out)
    }

    /// The number of the area of a message, if the message fits this floor.
    fn suited(&mut self, message: &NodeMessage) -> Option<usize> {
        let area = self.names.iter().position(|name| *name == message.area);
        let NodeMessage { contacts, earlier, events, held, answers, .. } = message;
        let sizes = [contacts.len(), earlier.len(), events.len(), held.len(), answers.len()];
        let mut all = contacts.iter().chain(earlier.iter().flat_map(|frame| &frame.contacts));
        let why = if message.version != VERSION {
            format!("speaks version {} of the messages, this gateway {VERSION}", message.version)
        } else if message.floor != self.floor {
            "has a floor file with other tiles or areas".to_owned()
        } else if area.is_none() {
            "serves an area that the floor file does not name".to_owned()
        } else if sizes.iter().any(|size| *size > MOST)
            || !all.all(NodeContact::is_sound)
            || !message.has_good_ids()
        {
            "tells what no node tells".to_owned()
        } else {
            return area;
        };
        if self.complained.len() < COMPLAINTS && self.complained.insert(message.node) {
            let (name, area) = (&message.name, shown(&message.area, LONGEST_AREA));
            self.out.push(Output::Notice(format!(
                "the node at {name} for area \"{area}\" is not heard: it {why}"
            )));
        }
        None
    }

    /// Queues the reports of a live node.
    fn join(&mut self, number: usize, message: NodeMessage, is_torn: bool, now: Instant) {
        let Some(area) = self.areas.get_mut(number) else { return };
        let Some(frame) = area.newest else { return };
        if area.standing != AreaStanding::Live {
            area.begin(frame);
            area.presses.shut(&message.held);
            let (at, name) = (now, self.names.get(number).cloned().unwrap_or_default());
            let uncertainty = area.clock.uncertainty(now).unwrap_or_default();
            let news = AreaNews {
                at,
                area: name,
                state: AreaStanding::Live.into(),
                why: String::new(),
                uncertainty,
            };
            self.out.push(Output::Report(Report::Area(Cow::Owned(news))));
            area.page.clone_from(&message.page);
            self.tell_mutes(number, now);
        } else if is_torn {
            self.tear(number, &message.held, now);
        }
        let Some(area) = self.areas.get_mut(number) else { return };
        let NodeMessage { events, contacts, earlier, held, values, page, .. } = message;
        let page = page.filter(|page| area.page.as_ref() != Some(page));
        if page.is_some() {
            area.page.clone_from(&page);
        }
        let mut items = Vec::with_capacity(events.len() + earlier.len() + 1);
        let mut events = events.into_iter().peekable();
        for NodeFrame { at, contacts } in earlier {
            while let Some(event) = events.next_if(|event| event.at <= at) {
                items.push((area.here(event.at), Item::Event(event)));
            }
            items.push((area.here(at), Item::Frame { contacts }));
        }
        items.extend(events.map(|event| (area.here(event.at), Item::Event(event))));
        let past = items.extract_if(.., |(at, _)| !area.is_of_interest(*at));
        self.counters.withheld += past.filter(|(_, item)| matches!(item, Item::Event(_))).count() as u64;
        items.push((frame, Item::Frame { contacts }));
        items.push((frame, Item::Held { held, values }));
        for (at, item) in items {
            self.number += 1;
            self.queue.insert((area.in_order(at), number, self.number), (at, item));
        }
        if let Some(page) = page {
            self.note_page(number, page, now);
        }
    }

    /// Cancels all holds of an area after a gap in its events, in which a control may have been released and pressed
    /// again. Events from before the gap come first.
    fn tear(&mut self, number: usize, held: &[String], now: Instant) {
        let before = self.queue.extract_if(.., |(_, area, _), _| *area == number);
        for ((at, ..), (happened, item)) in before.collect::<Vec<_>>() {
            self.tell(number, at, happened, item);
        }
        let Some(area) = self.areas.get_mut(number) else { return };
        let cancelled = area.presses.cancel(now);
        area.presses.shut(held);
        self.out.extend(cancelled.into_iter().map(Output::from));
    }

    /// Takes an area off the floor: cancels its holds and ends its contacts.
    fn fall(&mut self, number: usize, standing: AreaStanding, why: &str, now: Instant) {
        let Some(area) = self.areas.get_mut(number) else { return };
        area.fall(standing);
        let cancelled = area.presses.cancel(now);
        self.queue.retain(|(_, area, _), _| *area != number);
        self.joiner.lose(number, now);
        let name = self.names.get(number).cloned().unwrap_or_default();
        self.requests.lose(number, &name);
        self.out.extend(cancelled.into_iter().map(Output::from));
        let (why, uncertainty) = (why.to_owned(), Duration::ZERO);
        let news = AreaNews { at: now, area: name, state: standing.into(), why, uncertainty };
        self.tell_all(Report::Area(Cow::Owned(news)));
    }

    /// Reports to all outputs.
    fn tell_all(&mut self, report: Report<'static>) {
        self.out.push(Output::Report(report));
    }

    fn tell(&mut self, number: usize, at: Instant, happened: Instant, item: Item) {
        let Some(area) = self.areas.get_mut(number) else { return };
        match item {
            Item::Event(event) => {
                let place = Vec2::from(event.position);
                let contact = event.contact.and_then(|id| self.joiner.name(number, id, place, at));
                let Some(told) = event.event(happened, contact) else {
                    self.counters.refused += 1;
                    return;
                };
                if !area.presses.takes(&told) {
                    self.counters.withheld += 1;
                    return;
                }
                self.counters.late += u64::from(at < self.told_until);
                self.out.push(told.into());
            }
            Item::Frame { contacts } => self.joiner.frame(number, at, &contacts),
            Item::Held { held, values } => {
                self.counters.unpressed += area.presses.hold(&held);
                let changed = values.map(|values| area.presses.compare(&values, at)).unwrap_or_default();
                self.out.extend(changed.into_iter().map(Output::from));
            }
        }
    }

    /// Decides on the proposed layout.
    fn decide(&mut self, now: Instant) {
        let Some(outcome) = self.layouts.decide(live(&self.names, &self.areas), now) else { return };
        let notice = match outcome {
            ProposalOutcome::Current(name, _) => {
                self.shared.take_proposal();
                self.has_news = true;
                format!("Layout {} goes to all areas.", name.revision)
            }
            ProposalOutcome::Dropped(name, why) => {
                self.shared.drop_proposal();
                format!("Layout {} goes to no area: {why}.", name.revision)
            }
            ProposalOutcome::Unfit(area, why) => {
                format!("the node of area \"{area}\" does not take the layout of the others: {why}")
            }
        };
        self.out.push(Output::Notice(notice));
    }

    fn tell_contacts(&mut self, until: Instant, now: Instant) {
        let is_live = self.areas.iter().any(|area| area.standing == AreaStanding::Live);
        if !is_live {
            if std::mem::take(&mut self.is_anybody_there) {
                self.tell_all(Report::Contacts(now, Cow::Borrowed(&[])));
            }
            return;
        }
        if self.contacts_told.is_some_and(|told| until < told + CONTACTS_EVERY) {
            return;
        }
        self.contacts_told = Some(until);
        let contacts = self.joiner.contacts(until);
        self.is_anybody_there = !contacts.is_empty();
        self.tell_all(Report::Contacts(until, Cow::Owned(contacts)));
    }

    fn tell_state(&mut self, now: Instant) {
        let live = || self.areas.iter().filter(|area| area.standing == AreaStanding::Live);
        let link = match live().count() {
            0 if self.link == LinkState::Waiting => LinkState::Waiting,
            0 => LinkState::Lost,
            count if count == self.areas.len() => LinkState::Live,
            _ => LinkState::Partial,
        };
        if link != self.link {
            self.link = link;
            self.out.push(Output::Report(Report::Link(now, link)));
        }
        let held: Vec<&str> = live().flat_map(|area| area.presses.held()).collect();
        let holding = live().filter(|area| area.presses.held().next().is_some());
        let age = holding.filter_map(|area| area.age(now)).max().unwrap_or_default();
        if let Some(report) = self.held.report(&held, age, now) {
            self.out.push(Output::Report(Report::Held(Cow::Owned(report.clone()))));
        }
        let (number, due) = &mut self.alive;
        if now >= *due {
            (*number, *due) = (number.wrapping_add(1), now + ALIVE_EVERY);
            self.out.push(Output::Report(Report::Alive(now, *number)));
        }
    }
}

/// The live nodes and the states of their layouts.
fn live<'a>(
    names: &'a [String],
    areas: &'a [JoinedArea],
) -> impl Iterator<Item = (&'a str, &'a LayoutStanding)> + Clone {
    let all = names.iter().zip(areas).filter(|(_, area)| area.standing == AreaStanding::Live);
    all.map(|(name, area)| (name.as_str(), &area.layout))
}

/// The events among the reports.
pub fn events(told: &[Output]) -> impl Iterator<Item = &WidgetEvent> {
    told.iter().filter_map(|told| match told.report()? {
        Report::Event(event) => Some(event.as_ref()),
        _ => None,
    })
}
