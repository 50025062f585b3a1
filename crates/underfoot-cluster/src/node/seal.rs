//! Datagrams between neighbours: packets of boards and notes, in envelopes of [`crate::auth`].

use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use underfoot::source::{Seal, Sealed};
use underfoot::units::HostClock;

use super::border::ReceivedNote;
use crate::auth::{AuthRefusals, AuthSession, MessageKind, Opened};

/// The session of a node with its neighbours, on the node's clock. Clones are the same session.
#[derive(Clone)]
pub struct NeighbourSession {
    session: Arc<Mutex<AuthSession>>,
    clock: HostClock,
}

impl fmt::Debug for NeighbourSession {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("NeighbourSession").finish_non_exhaustive()
    }
}

impl NeighbourSession {
    /// `session` on `clock`.
    #[must_use]
    pub fn new(session: AuthSession, clock: HostClock) -> Self {
        Self { session: Arc::new(Mutex::new(session)), clock }
    }

    fn locked(&self) -> MutexGuard<'_, AuthSession> {
        self.session.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes `note` in an envelope into `out`, replacing its content.
    pub fn seal_note(&self, note: &[u8], out: &mut Vec<u8>) {
        self.locked().seal(MessageKind::Note, note, (self.clock)(), out);
    }

    /// Number of rejected datagrams so far, by reason.
    #[must_use]
    pub fn refusals(&self) -> AuthRefusals {
        self.locked().refusals()
    }
}

/// Seals packets for neighbours, opens theirs, and forwards their notes.
#[derive(Debug)]
pub struct NeighbourSeal {
    session: NeighbourSession,
    notes: SyncSender<ReceivedNote>,
    sealed: Vec<u8>,
    dropped: Arc<AtomicU64>,
}

impl NeighbourSeal {
    /// A seal that sends notes to `notes`; if that is full, it drops and counts them.
    #[must_use]
    pub fn new(session: NeighbourSession, notes: SyncSender<ReceivedNote>) -> Self {
        Self { session, notes, sealed: Vec::new(), dropped: Arc::default() }
    }

    /// Number of dropped notes so far.
    #[must_use]
    pub fn dropped(&self) -> Arc<AtomicU64> {
        Arc::clone(&self.dropped)
    }
}

impl Seal for NeighbourSeal {
    fn seal(&mut self, message: &[u8]) -> &[u8] {
        let NeighbourSession { session, clock } = &self.session;
        let mut session = session.lock().unwrap_or_else(PoisonError::into_inner);
        session.seal(MessageKind::Packet, message, clock(), &mut self.sealed);
        &self.sealed
    }

    fn open(&mut self, datagram: &[u8]) -> Sealed {
        let now = (self.session.clock)();
        let opened = self.session.locked().open(datagram, now);
        match opened {
            Ok(Opened { kind: MessageKind::Packet, body, .. }) => Sealed::Forwarded(body),
            Ok(Opened { kind: MessageKind::Note, head, echo, body }) => {
                let body = datagram.get(body).unwrap_or_default().to_vec();
                if self.notes.try_send(ReceivedNote { head, echo, body }).is_err() {
                    self.dropped.fetch_add(1, Ordering::Relaxed);
                }
                Sealed::Taken
            }
            Ok(_) | Err(_) => Sealed::Refused,
        }
    }
}
