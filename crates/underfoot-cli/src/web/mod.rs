//! The server for web pages: events as JSON lines over WebSocket, requests the other way, and pages of ours. Windows
//! that show the same floor, and the web edition, join here, at `/mirror`; `watch` answers those who watch the floor for
//! months. `query` is a
//! server of its own, for programs that ask for the floor's OSC addresses.

mod accept;
mod broadcast;
mod budget;
mod checks;
mod client;
mod edition;
mod file;
mod greeting;
mod http;
mod layout;
mod leftover;
mod off;
mod origin;
mod pages;
mod plain;
mod query;
mod request;
mod rooms;
mod socket;
mod watch;

use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::time::Duration;

use underfoot::floor::{Floor, Geometry, Network, read_address};
use underfoot::mirror::MirrorFeed;
use underfoot::runtime::Session;
use underfoot::sense::Method;
use underfoot::sink::{Fanout, JsonSink};
use underfoot::source::FloorInput;
use underfoot_io::targets::LoadedPlan;

use super::failure::Failure;
use accept::Accepting;
use broadcast::{Broadcast, ClientCounts, Clients};
use checks::Checks;
use http::{head, wait_for};
use origin::PageOrigin;
pub(crate) use query::QueryArgs;
use watch::{CountingSink, EventCounts, FloorWatch};

/// Options of the server for web pages.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct WebArgs {
    /// Show the floor as a web page at this address, such as 127.0.0.1:9002, and send its events over WebSocket.
    #[arg(long, value_name = "ADDR", value_parser = read_address)]
    web: Option<SocketAddr>,
    /// Also let pages of this origin connect, such as https://app.example.org; several may be given. Without it,
    /// pages of this machine only.
    #[arg(long, value_name = "ORIGIN", requires = "web")]
    web_origin: Vec<PageOrigin>,
    /// Let joined windows put other layouts on the floor, from the addresses that may send requests.
    #[arg(long, requires = "web")]
    web_layouts: bool,
}

/// Maximum number of connections; each has a thread.
const MOST: usize = 16;

/// Maximum size of a request without a layout, in bytes.
const MOST_BYTES: usize = 4096;

/// Maximum time for the head of a client's request.
const PATIENCE: Duration = Duration::from_secs(2);

/// The server before the floor exists: its port is open, but it accepts no clients yet.
pub(crate) struct WebListener {
    listener: TcpListener,
    origins: Vec<PageOrigin>,
    takes_layouts: bool,
    clients: Arc<Clients>,
    events: Arc<EventCounts>,
    feed: MirrorFeed,
}

/// Data of all connections.
struct Shared {
    session: Session,
    floor: Floor,
    method: Method,
    /// The checks of clients' layouts, if the server accepts layouts.
    checks: Option<Checks>,
    origins: Vec<PageOrigin>,
    /// Networks from which requests are accepted.
    apps: Vec<Network>,
    clients: Arc<Clients>,
    watch: FloorWatch,
}

/// The running server; ends when dropped.
pub(crate) struct WebServer {
    shared: Arc<Shared>,
    feed: MirrorFeed,
    /// Present until the server ends.
    accepting: Option<Accepting>,
}

impl WebArgs {
    /// Opens the port, if an address is given.
    pub(crate) fn open(&self) -> Result<Option<WebListener>, Failure> {
        let Some(address) = self.web else { return Ok(None) };
        let listener = accept::open(address, "web pages")?;
        let clients = Arc::<Clients>::default();
        let told = Arc::clone(&clients);
        let feed = MirrorFeed::start(clients.windows(), move |frame| told.tell_frame(frame))?;
        let (origins, takes_layouts) = (self.web_origin.clone(), self.web_layouts);
        let events = Arc::<EventCounts>::default();
        Ok(Some(WebListener { listener, origins, takes_layouts, clients, events, feed }))
    }
}

impl WebListener {
    /// Adds the sinks that send events to the clients, and count them.
    pub(crate) fn listen(&self, outputs: &mut Fanout) -> Result<(), Failure> {
        outputs.push(JsonSink::new(Broadcast::new(Arc::clone(&self.clients)))?.with_contacts());
        outputs.push(CountingSink::new(Arc::clone(&self.events)));
        Ok(())
    }

    /// Wraps `input`, so that joined windows get its results.
    pub(crate) fn wrap(&self, input: FloorInput, geometry: Geometry) -> FloorInput {
        self.feed.wrap(input, geometry)
    }

    /// Starts to accept clients.
    pub(crate) fn serve(
        self,
        session: Session,
        floor: Floor,
        method: Method,
        apps: Vec<Network>,
        messages: LoadedPlan,
    ) -> Result<WebServer, Failure> {
        let Self { listener, origins, takes_layouts, clients, events, feed } = self;
        let failed = |error| Failure::Other(format!("web pages can't be served: {error}"));
        let address = listener.local_addr().map_err(failed)?;
        if pages::has_edition() {
            errln!("The floor as a web page: http://{address}/, and plainer at http://{address}/plain");
        } else {
            errln!("The floor as a web page: http://{address}/ (`./dev web` makes the whole window of it)");
        }
        let start = || Checks::start(session.clone(), floor.geometry, messages.clone());
        let checks = takes_layouts.then(start).transpose();
        let shared = Arc::new(Shared {
            session,
            floor,
            method,
            checks: checks.map_err(failed)?,
            origins,
            apps,
            clients,
            watch: FloorWatch::new(events, messages),
        });
        let own = Arc::clone(&shared);
        let serve = move |stream, peer| receive(stream, peer, &own);
        let accepting = Some(Accepting::start(listener, serve).map_err(failed)?);
        Ok(WebServer { shared, feed, accepting })
    }
}

impl Drop for WebServer {
    fn drop(&mut self) {
        // Waits for the clients, so that the numbers are the last ones.
        self.accepting = None;
        let ClientCounts { served, dropped, .. } = self.shared.clients.counts();
        errln!("Web: clients served {served}, dropped because they did not read {dropped}.");
        if self.feed.lost() > 0 {
            errln!("Web: {} packets could not be shown to windows.", self.feed.lost());
        }
    }
}

/// Answers one connection: with a page or a number, or with events for as long as it lasts.
fn receive(stream: TcpStream, peer: SocketAddr, shared: &Shared) {
    // A client that has left meanwhile is not an error.
    let Some(head) = wait_for(&stream, PATIENCE).ok().and_then(|()| head(&stream, PATIENCE)) else { return };
    if head.is_upgrade() {
        client::serve(stream, peer, shared, head.path == "/mirror");
    } else {
        pages::answer(stream, &head, shared);
    }
}
