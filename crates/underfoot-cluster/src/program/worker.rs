//! The thread that executes a gateway's requests, so that the receiving thread never waits for them.

use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{Arc, Mutex};
use std::thread;

use underfoot::floor::{Area, Geometry};
use underfoot::layout::Layout;
use underfoot::runtime::Session;
use underfoot::serve::FloorCommand;
use underfoot::units::Instant;
use underfoot::wire::ControlMessage;
use underfoot_cluster::message::{
    GatewayMessage, LayoutMessage, LayoutName, LayoutStanding, NodeAnswer, NodeRequest, NodeState, VERSION,
};
use underfoot_cluster::node::{AskedRequests, NodeLayouts};

use super::notices::Notices;
use super::{layout, locked};

/// Greatest number of waiting requests and layouts; the gateway repeats dropped ones.
const WAITING: usize = 1024;

enum Work {
    Request(u64, NodeRequest),
    Check(LayoutMessage),
}

/// The state shared with the worker thread.
struct State {
    asked: Mutex<AskedRequests>,
    layouts: Mutex<NodeLayouts<Layout>>,
}

/// A handle to the worker and its results.
#[derive(Clone)]
pub(super) struct NodeWorker {
    state: Arc<State>,
    work: SyncSender<Work>,
    session: Session,
    area: Area,
    geometry: Geometry,
    notices: Notices,
}

impl NodeWorker {
    /// A worker for the node of `area`, whose own file has the layout `own`.
    pub(super) fn start(
        session: Session,
        area: Area,
        geometry: Geometry,
        own: Option<LayoutName>,
        notices: Notices,
    ) -> Self {
        let state = Arc::new(State { asked: Mutex::default(), layouts: Mutex::new(NodeLayouts::new(own)) });
        let (work, to_do) = sync_channel(WAITING);
        let worker = Self { state, work, session, area, geometry, notices };
        let own = worker.state();
        let session = worker.session.clone();
        thread::spawn(move || run(&to_do, &own, &session, geometry));
        worker
    }

    fn state(&self) -> Arc<State> {
        Arc::clone(&self.state)
    }

    /// Queues the requests in a gateway's beat, which arrived at `now`.
    pub(super) fn hear(&self, message: &GatewayMessage, now: Instant) {
        if message.version != VERSION {
            return;
        }
        for request in message.requests.iter().filter(|request| request.area == self.area.id) {
            let is_new = locked(&self.state.asked).is_new(message.gateway, request);
            if is_new && !self.give(Work::Request(message.gateway, request.clone())) {
                locked(&self.state.asked).forget(message.gateway, request.number);
            }
        }
        let mut layouts = locked(&self.state.layouts);
        if message.layout.current.is_some() && layouts.follows(message.gateway, now) {
            layouts.order(&message.layout, &self.area.id);
        }
    }

    /// Queues a gateway's layout, which arrived at `now`, for checking.
    pub(super) fn check(&self, message: LayoutMessage, now: Instant) {
        let mut layouts = locked(&self.state.layouts);
        let is_ours = message.version == VERSION && layouts.follows(message.gateway, now);
        if is_ours && layouts.lacks(&message.name) {
            drop(layouts);
            // The gateway repeats a layout that does not fit in the queue.
            self.give(Work::Check(message));
        }
    }

    fn give(&self, work: Work) -> bool {
        !matches!(self.work.try_send(work), Err(TrySendError::Full(_)))
    }

    /// Activates the layout that is due at `now`.
    pub(super) fn change(&self, now: Instant) {
        let due = locked(&self.state.layouts).take_due(now);
        if let Some((name, layout)) = due {
            self.session.set_layout(layout.part(&self.area, &self.geometry));
            self.notices.say(format!(
                "Layout {} is on the floor, as soon as no foot holds a control.",
                name.revision
            ));
        }
    }

    /// The state of the node's layouts, and the answers to send.
    pub(super) fn report(&self) -> (LayoutStanding, Vec<NodeAnswer>) {
        (locked(&self.state.layouts).standing().clone(), locked(&self.state.asked).take_answers())
    }
}

fn run(to_do: &Receiver<Work>, state: &State, session: &Session, geometry: Geometry) {
    for work in to_do {
        match work {
            Work::Request(gateway, request) => {
                let number = request.number;
                let done = request.message().and_then(|message| apply(session, message));
                let (states, refused) = match done {
                    Ok(states) => (states, None),
                    Err(why) => (Vec::new(), Some(why)),
                };
                locked(&state.asked).answer(NodeAnswer { gateway, number, refused, states });
            }
            Work::Check(LayoutMessage { name, text, .. }) => {
                // Several copies of the same layout may be in the queue.
                if locked(&state.layouts).lacks(&name) {
                    let checked = if LayoutName::of(name.revision, &text) == name {
                        layout::parse(&text, &geometry).map_err(|error| error.to_string())
                    } else {
                        Err("it did not arrive whole".to_owned())
                    };
                    locked(&state.layouts).note(name, checked);
                }
            }
        }
    }
}

/// Executes an app's request; returns the states of the controls that it concerns, or the reason for a refusal.
fn apply(session: &Session, message: ControlMessage) -> Result<Vec<NodeState>, String> {
    let mut message = message;
    let id = message.id_mut().map(|id| id.as_str().to_owned());
    match &message {
        // The answer to these is empty; the gateway has checked that they are possible.
        ControlMessage::Mute { .. } | ControlMessage::MuteTile { .. } => {
            return match session.send(FloorCommand::Control(message)) {
                true => Ok(Vec::new()),
                false => Err("the floor has ended".to_owned()),
            };
        }
        _ => session.ask(message.clone()).map_err(|refusal| refusal.to_string())?,
    }
    let snapshot = session.snapshot();
    let ids: Vec<&str> = match (&id, &message) {
        (Some(id), _) => vec![id],
        (None, ControlMessage::GetAll) => {
            snapshot.layout.widgets.iter().map(|widget| widget.id.as_str()).collect()
        }
        _ => Vec::new(),
    };
    Ok(ids.into_iter().filter_map(|id| Some(NodeState::from(&snapshot.control(id)?))).collect())
}
