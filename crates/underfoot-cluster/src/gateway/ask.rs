//! Requests of apps: the gateway sends each to the node that it concerns, or to all.

use std::borrow::Cow;
use std::net::SocketAddr;

use underfoot::engine::{ControlState, PageShown};
use underfoot::feel::Muted;
use underfoot::sink::Report;
use underfoot::units::Instant;
use underfoot::widget::{SetError, WidgetId};
use underfoot::wire::{ControlMessage, Request, is_pattern, matches};

use super::Gateway;
use super::output::Output;
use super::requests::{Answered, Asker};
use crate::message::{AreaStanding, NodeState};

/// The answer to an app's request.
#[derive(Clone, Debug, PartialEq)]
pub enum RequestAnswer {
    /// The state of a control.
    Control(Box<ControlState>),
    /// The page on the floor; empty without pages.
    Page(String),
    /// The muted tiles.
    Muted(Muted),
    /// The address of the refused request, without its prefix, and the reason.
    Refused(String, String),
}

impl Gateway {
    /// Takes a request of an app, which arrived at `now`. The next beat carries it to the nodes; the app receives the
    /// answer as soon as they have answered, or after half a second.
    pub fn ask(&mut self, mut request: Request, now: Instant) {
        let pattern = request.message.id_mut().map(|id| id.as_str().to_owned()).unwrap_or_default();
        let ids: Vec<String> = match is_pattern(&pattern) && self.shared.owner(&pattern).is_none() {
            true => self.shared.ids().filter(|id| matches(&pattern, id)).map(str::to_owned).collect(),
            false => Vec::new(),
        };
        if ids.is_empty() {
            return self.ask_one(request.sender, request.message, now);
        }
        for id in ids {
            let mut message = request.message.clone();
            if let Some(place) = message.id_mut() {
                *place = WidgetId::new(&id);
            }
            self.ask_one(request.sender, message, now);
        }
    }

    fn ask_one(&mut self, sender: Option<SocketAddr>, mut message: ControlMessage, now: Instant) {
        let id = message.id_mut().map(|id| id.as_str().to_owned());
        let area = match (&message, id) {
            (_, Some(id)) => self.shared.owner(&id).ok_or_else(|| SetError::Unknown.to_string()).map(Some),
            (ControlMessage::MuteTile { tile, .. }, _) => {
                self.shared.mover(*tile).map(Some).map_err(str::to_owned)
            }
            (ControlMessage::UseSensors { choice, .. }, _) => self.shared.reader(*choice).map(Some),
            (ControlMessage::GetPage | ControlMessage::GetMute, _) => {
                self.tell_of_all(&message, sender, now);
                return;
            }
            _ => Ok(None),
        };
        // No node can refuse this request; a lost one receives it when it is back.
        if area.is_ok() && matches!(message, ControlMessage::Mute { .. } | ControlMessage::MuteTile { .. }) {
            self.keep(&message, now);
        }
        let asked = match area {
            Ok(Some(area)) if self.is_live(area) => self.ask_nodes(sender, message.clone(), &[area], now),
            Ok(Some(area)) => {
                Err(format!("its area \"{}\" is lost", self.names.get(area).map_or("", String::as_str)))
            }
            Ok(None) => self.ask_nodes(sender, message.clone(), &self.live_areas(), now),
            Err(why) => Err(why),
        };
        if let Err(why) = asked {
            self.refuse(sender, &message, why);
        }
    }

    fn ask_nodes(
        &mut self,
        sender: Option<SocketAddr>,
        message: ControlMessage,
        areas: &[usize],
        now: Instant,
    ) -> Result<(), String> {
        let areas = self.named(areas);
        let asked = self.requests.ask(Asker::App(sender), message, &areas, now);
        asked.then_some(()).ok_or_else(|| "too many requests wait for their answers".to_owned())
    }

    /// Sends the mute settings to the node of area number `number`, which has just become live.
    pub(super) fn tell_mutes(&mut self, number: usize, now: Instant) {
        let areas = self.named(&[number]);
        for message in self.shared.mutes_of(number) {
            self.requests.ask(Asker::Gateway, message, &areas, now);
        }
    }

    /// Sends the settings of apps to nodes that have become live, once they run the layout that the settings concern.
    pub(super) fn bring_up(&mut self, now: Instant) {
        let current = self.layouts.current().map(|(name, _)| name);
        for number in 0..self.areas.len() {
            let Some(area) = self.areas.get_mut(number) else { continue };
            let lacks = current.is_some() && area.layout.running != current;
            if area.standing != AreaStanding::Live || area.is_brought_up || lacks {
                continue;
            }
            area.is_brought_up = true;
            let areas = self.named(&[number]);
            let page = self.shared.page.as_deref().map(WidgetId::new);
            let page = page.map(|page| ControlMessage::ShowPage { page });
            for message in self.shared.settings_of(number).into_iter().chain(page) {
                self.requests.ask(Asker::Gateway, message, &areas, now);
            }
        }
    }

    /// Notes the page that the node of area number `number` shows, and requests it from all others.
    pub(super) fn note_page(&mut self, number: usize, page: String, now: Instant) {
        if self.shared.page() == page {
            return;
        }
        let id = WidgetId::new(&page);
        self.shared.page = Some(page);
        self.tell_all(Report::Page(Cow::Owned(PageShown { at: now, page: id.clone() })));
        let mut others = self.live_areas();
        others.retain(|area| *area != number);
        let others = self.named(&others);
        self.requests.ask(Asker::Gateway, ControlMessage::ShowPage { page: id }, &others, now);
    }

    /// Sends the answers to requests that are complete at `now`.
    pub(super) fn tell_answers(&mut self, now: Instant) {
        for Answered { asker, message, done } in self.requests.answered(now) {
            let Asker::App(sender) = asker else { continue };
            let states = match done {
                Ok(states) => states,
                Err(why) => {
                    self.refuse(sender, &message, why);
                    continue;
                }
            };
            self.keep(&message, now);
            let is_asked = matches!(message, ControlMessage::Get { .. } | ControlMessage::GetAll);
            for state in states.iter().map(NodeState::state) {
                self.tell_all(Report::Control(now, Cow::Owned(state.clone())));
                if let Some(to) = sender.filter(|_| is_asked) {
                    self.out.push(Output::Answer(to, RequestAnswer::Control(Box::new(state))));
                }
            }
            if message == ControlMessage::GetAll {
                self.tell_of_all(&ControlMessage::GetPage, sender, now);
                self.tell_of_all(&ControlMessage::GetMute, sender, now);
            }
        }
    }

    /// Answers a request about the state of the whole floor.
    fn tell_of_all(&mut self, message: &ControlMessage, sender: Option<SocketAddr>, now: Instant) {
        let answer = if *message == ControlMessage::GetMute {
            self.tell_all(Report::Muted(now, Cow::Owned(self.shared.muted.clone())));
            RequestAnswer::Muted(self.shared.muted.clone())
        } else {
            let page = self.shared.page().to_owned();
            self.tell_all(Report::Page(Cow::Owned(PageShown { at: now, page: WidgetId::new(&page) })));
            RequestAnswer::Page(page)
        };
        self.out.extend(sender.map(|to| Output::Answer(to, answer)));
    }

    fn keep(&mut self, message: &ControlMessage, now: Instant) {
        if self.shared.keep(message) {
            self.tell_all(Report::Muted(now, Cow::Owned(self.shared.muted.clone())));
        }
    }

    fn refuse(&mut self, sender: Option<SocketAddr>, message: &ControlMessage, why: String) {
        self.counters.denied += 1;
        self.out.extend(sender.map(|to| Output::Answer(to, RequestAnswer::Refused(message.path(), why))));
    }

    fn is_live(&self, number: usize) -> bool {
        self.areas.get(number).is_some_and(|area| area.standing == AreaStanding::Live)
    }

    fn live_areas(&self) -> Vec<usize> {
        (0..self.areas.len()).filter(|number| self.is_live(*number)).collect()
    }

    fn named(&self, areas: &[usize]) -> Vec<(usize, String)> {
        areas.iter().filter_map(|area| Some((*area, self.names.get(*area)?.clone()))).collect()
    }
}
