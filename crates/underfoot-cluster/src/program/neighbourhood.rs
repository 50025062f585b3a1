//! The exchange of a node with its neighbours, by UDP.

use std::net::{IpAddr, SocketAddr, UdpSocket};
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::sync::mpsc::sync_channel;

use underfoot::floor::{Area, Floor};
use underfoot::units::HostClock;
use underfoot_cluster::auth::{Key, Role};
use underfoot_cluster::node::{Border, NeighbourSeal, NeighbourSession, SendNote};

use super::ClusterFailure;
use super::key::session;

/// Greatest number of neighbours' notes that wait for the next frame.
const NOTES: usize = 1024;

/// Number of remembered senders besides two nodes for each neighbour: recordings of earlier starts.
const SPARE: usize = 8;

/// The exchange of a node with its neighbours.
pub(super) struct Neighbourhood {
    /// Authenticates datagrams from and to these addresses.
    pub(super) seal: NeighbourSeal,
    pub(super) computers: Vec<IpAddr>,
    pub(super) border: Border,
    pub(super) session: NeighbourSession,
    /// Number of notes that were dropped.
    pub(super) unheard: Arc<AtomicU64>,
}

impl Neighbourhood {
    /// The exchange of the node of `area`, which receives packets at `listen`.
    pub(super) fn of(
        (floor, area): (&Floor, &Area),
        listen: SocketAddr,
        key: &Key,
        clock: &HostClock,
    ) -> Result<Self, ClusterFailure> {
        let neighbours = Border::neighbours(floor, area);
        let addresses: Vec<SocketAddr> = neighbours.iter().filter_map(|other| other.listen).collect();
        let computers = addresses.iter().map(SocketAddr::ip).collect();
        let session = session(Role::Neighbour, key, 2 * addresses.len() + SPARE)?;
        let session = NeighbourSession::new(session, Arc::clone(clock));
        let (notes, noted) = sync_channel(NOTES);
        let seal = NeighbourSeal::new(session.clone(), notes);
        let border = Border::new(floor, area, sender(addresses, listen, session.clone())?, noted);
        Ok(Self { unheard: seal.dropped(), seal, computers, border, session })
    }
}

/// Sends notes to the neighbours at `to`, from a port of its own beside `listen`.
fn sender(
    to: Vec<SocketAddr>,
    listen: SocketAddr,
    session: NeighbourSession,
) -> Result<SendNote, ClusterFailure> {
    let socket = UdpSocket::bind(SocketAddr::new(listen.ip(), 0))
        .and_then(|socket| socket.set_nonblocking(true).map(|()| socket))
        .map_err(|error| ClusterFailure::Other(format!("cues can't be handed to neighbours: {error}")))?;
    let mut sealed = Vec::new();
    Ok(Box::new(move |number, note| {
        let Some(to) = to.get(number) else { return false };
        session.seal_note(note, &mut sealed);
        // The error may belong to an earlier note, to an absent neighbour.
        socket.send_to(&sealed, to).or_else(|_| socket.send_to(&sealed, to)).is_ok()
    }))
}
