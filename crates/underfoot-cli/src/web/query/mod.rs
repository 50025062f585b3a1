//! OSCQuery: the floor's OSC addresses as JSON over HTTP, their messages over WebSocket, announced by mDNS.
//!
//! | file | content |
//! |---|---|
//! | `tree.rs` | the addresses of a layout as a tree of nodes |
//! | `values.rs` | the values of nodes, from the state of the floor |
//! | `answer.rs` | requests and answers over HTTP |
//! | `listen.rs` | clients that listen to addresses over WebSocket |
//! | `announce.rs` | the announcement in the network |

mod announce;
mod answer;
mod listen;
mod tree;
mod values;

use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::time::Duration;

use tracing::warn;
use underfoot::floor::{Floor, read_address};
use underfoot::runtime::Session;
use underfoot::sink::{Fanout, OscSink};
use underfoot::wire::Prefix;

use super::accept::{self, Accepting};
use super::http::{head, wait_for};
use crate::failure::Failure;
use announce::Announcement;
use listen::Listeners;

/// Maximum time for the head of a client's request.
const PATIENCE: Duration = Duration::from_secs(2);

/// Options of OSCQuery.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct QueryArgs {
    /// Let programs find this floor: describe its OSC addresses by OSCQuery at this address, 127.0.0.1:9012 if none is
    /// given, and announce it by mDNS on the networks of that address.
    #[arg(
        long,
        value_name = "ADDR",
        value_parser = read_address,
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "127.0.0.1:9012"
    )]
    discover: Option<SocketAddr>,
}

/// The server before the floor exists: its port is open, but it accepts no clients yet.
pub(crate) struct QueryListener {
    listener: TcpListener,
    listeners: Arc<Listeners>,
}

/// Data of all connections.
struct QueryShared {
    session: Session,
    floor: Floor,
    prefix: Prefix,
    /// The address of the server, and that of the floor's port for requests.
    own: SocketAddr,
    requests: SocketAddr,
    listeners: Arc<Listeners>,
}

/// The running server; ends when dropped.
pub(crate) struct QueryServer {
    _announcement: Option<Announcement>,
    _accepting: Accepting,
}

impl QueryArgs {
    /// Opens the port, if the floor may be found.
    pub(crate) fn open(&self) -> Result<Option<QueryListener>, Failure> {
        let Some(address) = self.discover else { return Ok(None) };
        let listener = accept::open(address, "OSCQuery")?;
        Ok(Some(QueryListener { listener, listeners: Arc::default() }))
    }
}

impl QueryListener {
    /// Adds the sink that sends messages to the clients that listen.
    pub(crate) fn listen(&self, prefix: &Prefix, outputs: &mut Fanout) -> Result<(), Failure> {
        let sender = listen::ListenerSender::new(Arc::clone(&self.listeners));
        outputs.push(OscSink::through(prefix.clone(), move |datagram| sender.send(datagram))?);
        Ok(())
    }

    /// Starts to accept clients, and announces the server; `requests` is the port for requests of apps.
    pub(crate) fn serve(
        self,
        session: Session,
        floor: Floor,
        prefix: Prefix,
        requests: SocketAddr,
    ) -> Result<QueryServer, Failure> {
        let Self { listener, listeners } = self;
        let failed = |error| Failure::Other(format!("OSCQuery can't be served: {error}"));
        let own = listener.local_addr().map_err(failed)?;
        errln!("The floor by OSCQuery: http://{own}/");
        let name = answer::name(&session.snapshot().layout);
        let shared = QueryShared { session, floor, prefix, own, requests, listeners };
        let serve = move |stream, peer| receive(stream, peer, &shared);
        let accepting = Accepting::start(listener, serve).map_err(failed)?;
        let announced = Announcement::start(&name, own);
        let announcement =
            announced.inspect_err(|error| warn!("the floor is not announced by mDNS: {error}")).ok();
        Ok(QueryServer { _announcement: announcement, _accepting: accepting })
    }
}

/// Answers one connection: with JSON, or with messages for as long as it lasts.
fn receive(stream: TcpStream, peer: SocketAddr, shared: &QueryShared) {
    // A client that has left meanwhile is not an error.
    let Some(head) = wait_for(&stream, PATIENCE).ok().and_then(|()| head(&stream, PATIENCE)) else { return };
    if head.is_upgrade() {
        listen::serve(stream, peer, shared);
    } else {
        answer::serve(stream, &head, shared);
    }
}
