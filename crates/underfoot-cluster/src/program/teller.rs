//! The thread of a node that sends its messages and executes the guard's actions.

use std::sync::mpsc::RecvTimeoutError;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant as HostInstant};

use underfoot::runtime::Session;
use underfoot::serve::FloorCommand;
use underfoot::sink::WaitFreeReceiver;
use underfoot::units::{HostClock, Instant};
use underfoot::wire::ControlMessage;
use underfoot_cluster::auth::{AuthSession, MessageKind};
use underfoot_cluster::message::{NodeMessage, NodeValue, encode};
use underfoot_cluster::node::{Action, CancelReason, Draft, GatewayGuard, NeighbourSession};
use underfoot_cluster::transport::TransportEnd;

use super::locked;
use super::notices::Notices;
use super::refused::RefusalNotices;
use super::worker::NodeWorker;

/// Nouns of reports about rejected messages.
pub(super) const MESSAGES: &str = "messages of gateways";
pub(super) const DATAGRAMS: &str = "datagrams of neighbours";

/// Interval between two reports of all values, which a gateway compares with its own.
const VALUES_EVERY: Duration = Duration::from_millis(500);

/// Interval between two checks for silent gateways.
const PATIENCE: Duration = Duration::from_millis(20);

/// Executes the guard's actions.
pub(super) struct Commander {
    pub(super) session: Session,
    pub(super) notices: Notices,
}

impl Commander {
    pub(super) fn apply(&self, action: Action) {
        let (commands, notice): (&[ControlMessage], &str) = match action {
            Action::Heard => (&[], "The gateway hears this node."),
            Action::Cancel(CancelReason::Late) => (
                &[ControlMessage::CancelAll],
                "The gateway got nothing new for 100 ms: what was held is cancelled.",
            ),
            Action::Cancel(CancelReason::Silent) => {
                (&[ControlMessage::CancelAll], "The gateway is silent: what was held is cancelled.")
            }
            Action::Mute => (
                &[ControlMessage::CancelAll, ControlMessage::Mute { on: true }],
                "Another node serves this area too: neither is believed, and nothing is felt. Stop one of them.",
            ),
            Action::Unmute => {
                (&[ControlMessage::Mute { on: false }], "The other node has stopped: this one works again.")
            }
            _ => return,
        };
        self.notices.say(notice);
        // A floor whose session has ended holds nothing.
        commands.iter().for_each(|command| _ = self.session.send(FloorCommand::Control(command.clone())));
    }
}

/// Sends the reports of the floor until its session ends.
pub(super) struct Teller {
    /// The fields that all messages have in common.
    pub(super) head: NodeMessage,
    pub(super) transport: TransportEnd,
    pub(super) session: Arc<Mutex<AuthSession>>,
    pub(super) neighbours: NeighbourSession,
    /// For messages of gateways and datagrams of neighbours.
    pub(super) refused: [RefusalNotices; 2],
    pub(super) guard: Arc<Mutex<GatewayGuard>>,
    pub(super) clock: HostClock,
    pub(super) commander: Commander,
    pub(super) worker: NodeWorker,
    pub(super) unsent: u64,
}

impl Teller {
    /// Runs until the floor's session has ended; returns the number of messages that could not be sent.
    pub(super) fn run(mut self, mut drafts: WaitFreeReceiver<Draft>) -> u64 {
        let mut values_told: Option<HostInstant> = None;
        loop {
            match drafts.recv_timeout(PATIENCE) {
                Ok(draft) => {
                    let is_due = values_told.is_none_or(|told| told.elapsed() >= VALUES_EVERY);
                    let values = is_due.then(|| self.values());
                    if is_due {
                        values_told = Some(HostInstant::now());
                    }
                    self.send(draft, values);
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return self.unsent,
            }
            let now = (self.clock)();
            self.worker.change(now);
            let actions = locked(&self.guard).tick(now);
            actions.into_iter().for_each(|action| self.commander.apply(action));
            self.report_refusals(now);
        }
    }

    fn report_refusals(&mut self, now: Instant) {
        let refusals =
            [(locked(&self.session).refusals(), MESSAGES), (self.neighbours.refusals(), DATAGRAMS)];
        for (notices, (refusals, noun)) in self.refused.iter_mut().zip(refusals) {
            let due = notices.look(refusals, noun, now);
            due.into_iter().for_each(|notice| self.commander.notices.say(notice));
        }
    }

    fn send(&mut self, draft: Draft, values: Option<Vec<(String, NodeValue)>>) {
        let (layout, answers) = self.worker.report();
        let message = draft.message(NodeMessage { values, answers, layout, ..self.head.clone() });
        let (body, mut sealed) = (encode(&message), Vec::new());
        // Sealed last, so that only the message's transmission follows the time in it.
        locked(&self.session).seal(MessageKind::Node, &body, (self.clock)(), &mut sealed);
        if !self.transport.send(sealed) {
            self.unsent += 1;
        }
    }

    /// The values of the controls that no foot holds.
    fn values(&self) -> Vec<(String, NodeValue)> {
        let snapshot = self.commander.session.snapshot();
        let all = snapshot.layout.widgets.iter().zip(&snapshot.floor.widgets);
        let free = all.filter(|(widget, _)| !snapshot.floor.held.contains(&widget.id));
        free.filter_map(|(widget, state)| Some((widget.id.as_str().to_owned(), state.value?.into())))
            .collect()
    }
}
