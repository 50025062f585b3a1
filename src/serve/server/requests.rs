//! What a server does with requests: done, answered, and told to all.

use super::Server;
use crate::engine::PageShown;
use crate::outgoing::{write_control, write_error, write_mute, write_page};
use crate::serve::request;
use crate::widget::WidgetId;
use crate::wire::{ControlMessage, Request};

impl Server {
    /// Does what an app asks of one control, or of all that a pattern means.
    pub(super) fn process_request(&mut self, mut request: Request) {
        let meant = request.message.id_mut().map(|id| request::meant(&self.engine, id)).unwrap_or_default();
        if meant.is_empty() {
            self.handle_request(&request);
        }
        for id in meant {
            if let Some(place) = request.message.id_mut() {
                *place = id;
            }
            self.handle_request(&request);
        }
    }

    /// Does what an app asks; tells it what it wants to know or why it can't be done, and everybody what is new.
    fn handle_request(&mut self, request: &Request) {
        let done = match &request.message {
            ControlMessage::Mute { on } => self.mute(*on).map_err(|error| error.to_string()),
            ControlMessage::MuteTile { tile, on } => {
                self.mute_tile(*tile, *on).map_err(|error| error.to_string())
            }
            message => request::apply(&mut self.engine, message).map_err(|error| error.to_string()),
        };
        match done {
            Ok(()) => self.tell(request),
            Err(why) => {
                self.denied += 1;
                let address = self.prefix.address(&request.message.path());
                let now = self.source.now();
                self.notices.denied.warn(now, || format!("{} refused: {why}", address.escape_debug()));
                write_error(&self.prefix, &address, &why, &mut self.answer);
                self.send_answer(request);
            }
        }
    }

    /// Tells everybody how what was asked about or changed is now; and whoever asked, by an answer.
    fn tell(&mut self, request: &Request) {
        match &request.message {
            ControlMessage::Get { id } => self.tell_control(id, Some(request)),
            ControlMessage::Set { id, .. }
            | ControlMessage::Enable { id }
            | ControlMessage::Disable { id }
            | ControlMessage::Lock { id }
            | ControlMessage::Unlock { id }
            | ControlMessage::Label { id, .. }
            | ControlMessage::Indicate { id, .. } => self.tell_control(id, None),
            ControlMessage::GetPage => self.tell_page(request),
            ControlMessage::GetMute => self.answer_mute(request),
            ControlMessage::GetAll => {
                let widgets = &self.engine.layout().widgets;
                let ids: Vec<WidgetId> = widgets.iter().map(|widget| widget.id.clone()).collect();
                ids.iter().for_each(|id| self.tell_control(id, Some(request)));
                self.tell_page(request);
                self.answer_mute(request);
            }
            // Told when it happens.
            ControlMessage::ShowPage { .. }
            | ControlMessage::Mute { .. }
            | ControlMessage::MuteTile { .. } => {}
        }
    }

    fn tell_control(&mut self, id: &WidgetId, asked: Option<&Request>) {
        let Some(state) = self.engine.control_state(id.as_str()) else { return };
        if let Some(events) = &mut self.events {
            events.control(self.source.now(), &state);
        }
        if let Some(request) = asked {
            write_control(&self.prefix, &state, &mut self.answer);
            self.send_answer(request);
        }
    }

    fn tell_page(&mut self, request: &Request) {
        let page = self.engine.page().unwrap_or_default();
        if let Some(events) = &mut self.events {
            events.page(&PageShown { at: self.source.now(), page: WidgetId::new(page) });
        }
        write_page(&self.prefix, page, &mut self.answer);
        self.send_answer(request);
    }

    fn answer_mute(&mut self, request: &Request) {
        if let Some(events) = &mut self.events {
            events.muted(self.source.now(), &self.muted);
        }
        write_mute(&self.prefix, &self.muted, &mut self.answer);
        self.send_answer(request);
    }

    fn send_answer(&mut self, request: &Request) {
        if let Some(sender) = request.sender {
            self.source.answer(sender, &self.answer);
        }
    }
}
