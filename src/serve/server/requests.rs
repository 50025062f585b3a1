//! Processing of requests: carry out, answer, report.

use std::borrow::Cow;
use std::sync::mpsc::SyncSender;
use std::time::Duration;

use super::Server;
use super::haptics::MuteError;
use super::limited::Limited;
use crate::engine::PageShown;
use crate::outgoing::{write_control, write_error, write_mute, write_page};
use crate::rate_limit::RateLimit;
use crate::serve::{Refusal, request};
use crate::sink::Report;
use crate::widget::{SetError, WidgetId};
use crate::wire::{ControlMessage, Prefix, Request};
use underfoot_format::label::{self, MAX_LABEL};

/// Limit on reports of all controls on request: a burst of `MOST_TOLD` controls, then one per `TOLD_EVERY`; about 5
/// us each, so that endless requests use a twentieth of the sensing thread's time.
const MOST_TOLD: u32 = 20_000;
const TOLD_EVERY: Duration = Duration::from_micros(100);

/// State of the answers to requests.
#[derive(Debug)]
pub(super) struct Answers {
    /// The prefix of addresses in answers.
    pub(super) prefix: Prefix,
    /// The answer being written.
    bytes: Vec<u8>,
    /// Number of rejected requests.
    pub(super) denied: u64,
    /// Rate limit on reports of all controls.
    everything: RateLimit,
    /// Whether a report of all controls is due as soon as there is time.
    pub(super) is_everything_due: bool,
    /// Number of labels from which characters were removed.
    pub(super) cleaned: u64,
    notices: Limited,
}

impl Default for Answers {
    fn default() -> Self {
        let notices = Limited::new(5, Duration::from_secs(10));
        let everything = RateLimit::new(MOST_TOLD, TOLD_EVERY);
        Self {
            prefix: Prefix::default(),
            bytes: Vec::new(),
            denied: 0,
            cleaned: 0,
            everything,
            is_everything_due: false,
            notices,
        }
    }
}

impl Server {
    /// Carries out a request of the program's own app and answers it.
    pub(super) fn answer(&mut self, message: ControlMessage, to: &SyncSender<Result<(), Refusal>>) {
        if message == ControlMessage::GetAll && !self.may_tell_everything() {
            // The report goes to all listeners, so that one report answers all requests in the meantime.
            self.answers.is_everything_due = true;
            let _ = to.try_send(Ok(()));
            return;
        }
        let done = self.apply(&message);
        if done.is_ok() {
            self.tell(&message.into());
            // A read after this write sees its effect.
            self.show_now();
        }
        // A caller that has stopped waiting needs no answer.
        let _ = to.try_send(done);
    }

    /// Carries out a request on one control, or on all controls that match a pattern.
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

    /// Reports every control to all listeners, if that is due and there is time.
    pub(super) fn tell_everything(&mut self) {
        if self.answers.is_everything_due && self.may_tell_everything() {
            self.answers.is_everything_due = false;
            self.tell(&ControlMessage::GetAll.into());
        }
    }

    /// Whether there is time to report every control.
    fn may_tell_everything(&mut self) -> bool {
        let (now, controls) = (self.source.now(), self.engine.layout().widgets.len());
        self.answers.everything.take_many(now, u32::try_from(controls).unwrap_or(u32::MAX)).is_some()
    }

    fn apply(&mut self, message: &ControlMessage) -> Result<(), Refusal> {
        match message {
            ControlMessage::CancelAll => self.cancel_all(),
            ControlMessage::UseSensors { choice, on } => self.assembler.switch(*choice, *on)?,
            ControlMessage::Label { id, text } => {
                return self
                    .apply_label(id, text)
                    .map_err(|why| request::refusal(&self.engine, message, why));
            }
            _ => {}
        }
        request::apply(&mut self.engine, message)
    }

    /// Sets the label of a control, without the characters that labels may not contain.
    fn apply_label(&mut self, id: &WidgetId, text: &str) -> Result<(), SetError> {
        let label = label::cleaned(text, MAX_LABEL);
        self.answers.cleaned += u64::from(label != text);
        self.engine.set_label(id.as_str(), &label)
    }

    /// Carries out a request; answers the sender or reports the reason of a rejection, and reports changes to all
    /// listeners.
    fn handle_request(&mut self, request: &Request) {
        let done = match &request.message {
            ControlMessage::Mute { on } => {
                let muted = self.haptics.mute(*on, self.link.is_lost());
                self.tell_mute(muted).map_err(|error| error.to_string())
            }
            ControlMessage::MuteTile { tile, on } => {
                let muted = self.haptics.mute_tile(*tile, *on, self.engine.geometry());
                self.tell_mute(muted).map_err(|error| error.to_string())
            }
            ControlMessage::GetAll if !self.may_tell_everything() => {
                Err("everything was asked for too often: ask again in a second".into())
            }
            message => self.apply(message).map_err(|refusal| refusal.reason()),
        };
        match done {
            Ok(()) => self.tell(request),
            Err(why) => {
                let Answers { prefix, bytes, denied, notices, .. } = &mut self.answers;
                *denied += 1;
                let address = prefix.address(&request.message.path());
                notices.warn(self.source.now(), || format!("{} refused: {why}", address.escape_debug()));
                write_error(prefix, &address, &why, bytes);
                self.send_answer(request);
            }
        }
    }

    /// Reports to all listeners the state that was requested or changed, and answers the sender.
    fn tell(&mut self, request: &Request) {
        match &request.message {
            ControlMessage::Get { id } => self.tell_control(id, Some(request)),
            ControlMessage::Set { id, .. }
            | ControlMessage::Enable { id }
            | ControlMessage::Disable { id }
            | ControlMessage::Lock { id }
            | ControlMessage::Unlock { id }
            | ControlMessage::Label { id, .. }
            | ControlMessage::Indicate { id, .. }
            | ControlMessage::SetRange { id, .. } => self.tell_control(id, None),
            ControlMessage::GetPage => self.tell_page(request),
            ControlMessage::GetMute => self.answer_mute(request),
            ControlMessage::GetAll => {
                let widgets = &self.engine.layout().widgets;
                let ids: Vec<WidgetId> = widgets.iter().map(|widget| widget.id.clone()).collect();
                ids.iter().for_each(|id| self.tell_control(id, Some(request)));
                self.tell_page(request);
                self.answer_mute(request);
            }
            // These are reported when they happen.
            ControlMessage::ShowPage { .. }
            | ControlMessage::CancelAll
            | ControlMessage::Mute { .. }
            | ControlMessage::MuteTile { .. }
            | ControlMessage::UseSensors { .. } => {}
        }
    }

    fn tell_control(&mut self, id: &WidgetId, asked: Option<&Request>) {
        let Some(state) = self.engine.control_state(id.as_str()) else { return };
        self.is_stale = true;
        self.outputs.report(&Report::Control(self.source.now(), Cow::Borrowed(&state)));
        if let Some(request) = asked {
            write_control(&self.answers.prefix, &state, &mut self.answers.bytes);
            self.send_answer(request);
        }
    }

    fn tell_page(&mut self, request: &Request) {
        let page = self.engine.page().unwrap_or_default();
        let shown = PageShown { at: self.source.now(), page: WidgetId::new(page) };
        self.outputs.report(&Report::Page(Cow::Owned(shown)));
        write_page(&self.answers.prefix, page, &mut self.answers.bytes);
        self.send_answer(request);
    }

    fn answer_mute(&mut self, request: &Request) {
        self.outputs.report(&Report::Muted(self.source.now(), Cow::Borrowed(self.haptics.muted())));
        write_mute(&self.answers.prefix, self.haptics.muted(), &mut self.answers.bytes);
        self.send_answer(request);
    }

    /// Reports a change of the mute state and shows it with this turn, also while no frames come.
    fn tell_mute(&mut self, is_news: Result<bool, MuteError>) -> Result<(), MuteError> {
        if is_news? {
            self.is_stale = true;
            self.outputs.report(&Report::Muted(self.source.now(), Cow::Borrowed(self.haptics.muted())));
        }
        Ok(())
    }

    fn send_answer(&mut self, request: &Request) {
        if let Some(sender) = request.sender {
            self.inbox.answer(sender, &self.answers.bytes);
        }
    }
}
