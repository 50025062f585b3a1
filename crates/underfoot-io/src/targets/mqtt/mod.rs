//! MQTT: states and events to the topics of a broker.
//!
//! ```text
//! event           -> published now, or never
//! hold            -> retained as on now, or never; retained as off whenever the broker is there
//! value           -> retained; without a broker the latest one waits
//! floor there     -> `online` is retained; the broker itself retains `offline` (the last will) when the connection breaks
//! broker is lost  -> told once; another connection every half second, which gets all states again
//! ```

mod link;

use std::collections::{BTreeMap, BTreeSet};
use std::time::{Duration, Instant};

use underfoot::messages::{Act, Holdable, MqttMessage, MqttTarget};

use self::link::{BrokerLink, LinkState};
use super::outlet::{Outlet, OutletError};

/// Time between two attempts to connect.
const AGAIN: Duration = Duration::from_millis(500);

/// Time between two looks at a connection.
const LOOK: Duration = Duration::from_millis(50);

/// The texts of a floor that is there, and of one that is gone.
const ONLINE: &str = "online";
const OFFLINE: &str = "offline";

/// A broker as a target.
pub(super) struct MqttOutlet {
    target: MqttTarget,
    link: Option<BrokerLink>,
    /// The last attempt to connect.
    tried: Instant,
    /// The first problem since the broker was there.
    problem: Option<String>,
    states: RetainedStates,
}

/// The texts that topics retain.
#[derive(Default)]
struct RetainedStates {
    texts: BTreeMap<String, String>,
    /// The topics that the broker has not got yet.
    waiting: BTreeSet<String>,
}

impl RetainedStates {
    fn set(&mut self, message: &MqttMessage) {
        self.texts.insert(message.topic.clone(), message.payload.clone());
        self.waiting.insert(message.topic.clone());
    }

    /// All texts go out again.
    fn repeat(&mut self) {
        self.waiting.extend(self.texts.keys().cloned());
    }

    /// An empty text makes the broker forget a topic.
    fn clear(&mut self) {
        self.texts.values_mut().for_each(String::clear);
        self.repeat();
    }

    /// Passes waiting messages to `publish`, until it refuses one.
    fn pass_on(&mut self, mut publish: impl FnMut(MqttMessage) -> bool) {
        while let Some(topic) = self.waiting.pop_first() {
            let Some(payload) = self.texts.get(&topic).cloned() else { continue };
            if !publish(MqttMessage { topic: topic.clone(), payload: payload.clone(), retained: true }) {
                self.waiting.insert(topic);
                break;
            }
            if payload.is_empty() {
                self.texts.remove(&topic);
            }
        }
    }
}

impl MqttOutlet {
    /// Begins to connect to the broker of `target`.
    pub(super) fn open(target: &MqttTarget) -> Result<Self, OutletError> {
        let (target, tried) = (target.clone(), Instant::now());
        let link = BrokerLink::open(&target).map_err(OutletError::Gone)?;
        Ok(Self { target, link: Some(link), tried, problem: None, states: RetainedStates::default() })
    }

    /// The connection, if the broker is there.
    fn connected(&mut self) -> Result<&mut BrokerLink, OutletError> {
        self.look();
        match (&mut self.link, &self.problem) {
            (Some(link), None) if link.is_connected() => Ok(link),
            (_, Some(problem)) => Err(OutletError::Refused(problem.clone())),
            (_, None) => Err(OutletError::Refused(format!("{} is not connected yet", self.target.address))),
        }
    }

    /// Notices a broker that is there now, or is lost; connects again.
    fn look(&mut self) {
        let lost = match self.link.as_mut().map(BrokerLink::look) {
            Some(LinkState::Changed) => {
                self.problem = None;
                self.states.repeat();
                self.states.set(&availability(&self.target, ONLINE));
                return;
            }
            Some(LinkState::Same) => return,
            Some(LinkState::Lost(reason)) => Some(reason),
            None => None,
        };
        self.link = None;
        if let Some(reason) = lost {
            self.problem.get_or_insert_with(|| format!("{}: {reason}", self.target.address));
        }
        if self.tried.elapsed() >= AGAIN {
            self.tried = Instant::now();
            match BrokerLink::open(&self.target) {
                Ok(link) => self.link = Some(link),
                Err(reason) => drop(self.problem.get_or_insert(reason)),
            }
        }
    }

    fn publish(&mut self, message: &MqttMessage) -> Result<(), OutletError> {
        let full = || OutletError::Refused("the broker is too slow: too much waits for it".into());
        if self.connected()?.publish(message) { Ok(()) } else { Err(full()) }
    }
}

impl Outlet for MqttOutlet {
    fn carry_out(&mut self, act: &Act) -> Result<(), OutletError> {
        match act {
            Act::Mqtt(message) if message.retained => {
                // Without a broker it waits, and a later state replaces it.
                self.states.set(message);
                self.connected().map(drop)
            }
            Act::Mqtt(message) => self.publish(message),
            Act::Down(Holdable::Mqtt(switch), _) => {
                self.publish(&switch.turned(true))?;
                self.states.texts.insert(switch.topic.clone(), switch.on.clone());
                Ok(())
            }
            Act::Up(what @ Holdable::Mqtt(_)) => self.release(what),
            _ => Err(OutletError::Refused("a broker of MQTT has topics only".into())),
        }
    }

    fn release(&mut self, what: &Holdable) -> Result<(), OutletError> {
        let Holdable::Mqtt(switch) = what else { return Ok(()) };
        let off = switch.turned(false);
        self.states.set(&off);
        self.publish(&off)?;
        self.states.waiting.remove(&off.topic);
        Ok(())
    }

    fn is_opening(&mut self) -> bool {
        self.connected().is_err() && self.problem.is_none()
    }

    fn work(&mut self) -> Result<Option<Duration>, OutletError> {
        self.connected()?;
        let Self { link: Some(link), states, .. } = self else { return Ok(Some(LOOK)) };
        states.pass_on(|message| link.publish(&message));
        Ok(Some(LOOK))
    }

    fn forget(&mut self) {
        self.states.clear();
        self.states.set(&availability(&self.target, ONLINE));
    }

    fn end(&mut self) {
        let Some(link) = self.link.take().filter(BrokerLink::is_connected) else { return };
        link.publish(&availability(&self.target, OFFLINE));
        link.end();
    }
}

/// The message that says whether the floor of `target` is there.
fn availability(target: &MqttTarget, text: &str) -> MqttMessage {
    MqttMessage { topic: target.availability(), payload: text.to_owned(), retained: true }
}
