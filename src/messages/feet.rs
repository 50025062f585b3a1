//! The feet in one region as messages: OSC, voices of MPE, the pointer.
//!
//! ```text
//! foot on free floor, heavy enough   -> arrives: its number, its note
//! it moves, or its force changes     -> the latest state, at a bounded rate
//! it lifts, steps on a control, or leaves the region; no frames for 70 ms; the floor is lost -> leaves
//! ```

use std::time::Duration;

use glam::Vec2;

use super::feet_settings::ContactPayload;
use super::midi::{MidiMessage, MidiNote};
use super::order::{Act, Holdable, MessageOrder, OscValue};
use super::outbox::Outbox;
use super::pace::STROKE;
use super::plan::AreaLine;
use super::sending::{OscArgument, OscSettings};
use crate::sense::{Contact, ContactId};
use crate::units::Instant;

/// Shortest time between two messages of one foot: 50 a second, so that fifteen feet stay within the rate of a target.
const EVERY: Duration = Duration::from_millis(20);

/// The arguments of a foot where none are written.
const USUAL: [OscArgument; 4] = [OscArgument::Foot, OscArgument::X, OscArgument::Y, OscArgument::Force];

/// The feet of one message of a region.
#[derive(Debug, Default)]
pub(super) struct AreaFeet {
    feet: Vec<NumberedFoot>,
    /// Contacts that found no number free; each is counted once.
    crowded: Vec<ContactId>,
    /// The time of the last frame.
    seen: Option<Instant>,
}

/// A foot that has arrived.
#[derive(Debug)]
struct NumberedFoot {
    contact: ContactId,
    number: u8,
    note: Option<MidiNote>,
    /// Its place in shares of the region, and its force in newtons.
    place: Vec2,
    force: f32,
    /// The messages that were sent last.
    told: Vec<Act>,
    told_at: Option<Instant>,
}

impl AreaFeet {
    /// Processes the contacts of one frame.
    pub(super) fn frame(
        &mut self,
        line: &AreaLine,
        at: Instant,
        contacts: &[Contact],
        outbox: &mut Outbox,
        orders: &mut Vec<MessageOrder>,
    ) {
        self.seen = Some(at);
        let is_on =
            |contact: &Contact, least: f32| contact.force.0 >= least && line.is_free(contact.centroid);
        self.feet.retain(|foot| {
            let stays = |contact: &Contact| contact.id == foot.contact && is_on(contact, 0.5 * line.press_n);
            let remains = contacts.iter().any(stays);
            if !remains {
                foot.leave(line, outbox, orders);
            }
            remains
        });
        self.crowded.retain(|id| contacts.iter().any(|contact| contact.id == *id));
        for contact in contacts.iter().filter(|contact| line.is_free(contact.centroid)) {
            if let Some(foot) = self.feet.iter_mut().find(|foot| foot.contact == contact.id) {
                (foot.place, foot.force) = (line.share(contact.centroid), contact.force.0);
                foot.tell(line, at, outbox, orders);
            } else if contact.force.0 >= line.press_n {
                self.arrive(line, at, contact, outbox, orders);
            }
        }
    }

    fn arrive(
        &mut self,
        line: &AreaLine,
        at: Instant,
        contact: &Contact,
        outbox: &mut Outbox,
        orders: &mut Vec<MessageOrder>,
    ) {
        let is_free = |number: &u8| self.feet.iter().all(|foot| foot.number != *number);
        let Some(number) = (0..line.payload.most_feet()).find(is_free) else {
            // One pointer has one foot; others stand beside it.
            if line.payload != ContactPayload::Pointer && !self.crowded.contains(&contact.id) {
                self.crowded.push(contact.id);
                outbox.unsent.crowded += 1;
            }
            return;
        };
        // A foot that the rate holds back arrives with the next frame that has room.
        if !outbox.allows(line.target, at, STROKE) {
            return;
        }
        let (place, force) = (line.share(contact.centroid), contact.force.0);
        let (contact, told, told_at) = (contact.id, Vec::new(), None);
        let mut foot = NumberedFoot { contact, number, note: None, place, force, told, told_at };
        if let ContactPayload::Mpe(mpe) = &line.payload {
            let note = mpe.note(number, place);
            foot.note = Some(note);
            if self.feet.is_empty() {
                orders.push(line.order(Act::Midi(MidiMessage::LowerZone(mpe.feet))));
            }
            // The receiver needs the expression before the note.
            foot.tell(line, at, outbox, orders);
            let held = (line.target, Holdable::Note(note));
            outbox.press(held, &line.region, mpe.velocity(force), orders);
        } else {
            foot.tell(line, at, outbox, orders);
        }
        self.feet.push(foot);
    }

    /// Lets all feet leave if no frame has come for `patience`.
    pub(super) fn advance(
        &mut self,
        line: &AreaLine,
        (now, patience): (Instant, Duration),
        outbox: &mut Outbox,
        orders: &mut Vec<MessageOrder>,
    ) {
        if self.seen.is_some_and(|seen| now.since(seen) > patience) {
            self.leave(line, outbox, orders);
        }
    }

    /// Lets all feet leave.
    pub(super) fn leave(&mut self, line: &AreaLine, outbox: &mut Outbox, orders: &mut Vec<MessageOrder>) {
        self.feet.drain(..).for_each(|foot| foot.leave(line, outbox, orders));
        self.seen = None;
    }
}

impl NumberedFoot {
    /// Sends the messages that have changed, if it is time.
    fn tell(&mut self, line: &AreaLine, now: Instant, outbox: &mut Outbox, orders: &mut Vec<MessageOrder>) {
        if self.told_at.is_some_and(|told| now.since(told) < EVERY) {
            return;
        }
        let acts = self.acts(line, self.force);
        if acts == self.told || !outbox.allows(line.target, now, 1) {
            return;
        }
        let news = acts.iter().enumerate().filter(|(index, act)| self.told.get(*index) != Some(*act));
        orders.extend(news.map(|(_, act)| line.order(act.clone())));
        (self.told, self.told_at) = (acts, Some(now));
    }

    /// The messages of the foot now, if it pressed with `force` newtons.
    fn acts(&self, line: &AreaLine, force: f32) -> Vec<Act> {
        match (&line.payload, self.note) {
            (ContactPayload::Osc(address, settings), _) => {
                vec![Act::Osc(address.clone(), self.arguments(line, settings, force))]
            }
            (ContactPayload::Mpe(mpe), Some(note)) => {
                mpe.expression(note, self.place, force).map(Act::Midi).to_vec()
            }
            (ContactPayload::Mpe(_), None) => Vec::new(),
            // The top of the screen is north.
            (ContactPayload::Pointer, _) => vec![Act::Place([self.place.x, 1.0 - self.place.y])],
        }
    }

    fn arguments(&self, line: &AreaLine, settings: &OscSettings, force: f32) -> Vec<OscValue> {
        let floor = line.area.min + self.place * line.area.size();
        let [x, y] = match settings.range {
            Some([from, to]) => (Vec2::splat(from) + self.place * (to - from)).to_array(),
            None => floor.to_array(),
        };
        let value = |argument: &OscArgument| match argument {
            OscArgument::Int(number) => Some(OscValue::Int(*number)),
            OscArgument::Float(number) => Some(OscValue::Float(*number)),
            OscArgument::Text(text) => Some(OscValue::Text(text.clone())),
            OscArgument::Foot => Some(OscValue::Int(self.number.into())),
            OscArgument::Force => Some(OscValue::Float(force)),
            OscArgument::X => Some(OscValue::Float(x)),
            OscArgument::Y => Some(OscValue::Float(y)),
            // The reader of layouts allows it in controls only.
            OscArgument::Value => None,
        };
        settings.arguments.as_deref().unwrap_or(&USUAL).iter().filter_map(value).collect()
    }

    fn leave(&self, line: &AreaLine, outbox: &mut Outbox, orders: &mut Vec<MessageOrder>) {
        match (&line.payload, self.note) {
            (ContactPayload::Mpe(_), Some(note)) => {
                outbox.lift((line.target, Holdable::Note(note)), &line.region, orders);
            }
            // Each arrival has paid for it.
            (ContactPayload::Osc(..), _) => {
                orders.extend(self.acts(line, 0.0).into_iter().map(|act| line.order(act)));
            }
            _ => {}
        }
    }
}
