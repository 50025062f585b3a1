//! The messages of one program to and from other computers of its floor.

use std::ops::Range;
use std::time::Duration;

use underfoot::units::Instant;

use super::envelope::{self, Echo, EnvelopeHead, MessageKind};
use super::key::Key;
use super::refusals::{AuthRefusal, AuthRefusals};
use super::window::{Novelty, ReplayWindow};

/// Greatest age of the message that another one answers: nodes wait 150 ms for a gateway, and a message that was on
/// its way for 100 ms is too late for a hold.
const FRESH: Duration = Duration::from_millis(250);

/// Time for which a silent sender is remembered; it must be longer than [`FRESH`].
const REMEMBERED: Duration = Duration::from_secs(1);

/// The kinds of messages that a program exchanges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A gateway, with nodes.
    Gateway,
    /// A node, with gateways.
    Node,
    /// A node, with its neighbours.
    Neighbour,
}

impl Role {
    const fn receives(self, kind: MessageKind) -> bool {
        match self {
            Self::Gateway => matches!(kind, MessageKind::Node),
            Self::Node => matches!(kind, MessageKind::Gateway),
            Self::Neighbour => matches!(kind, MessageKind::Note | MessageKind::Packet),
        }
    }
}

/// Proof of a message's age: its sender wrote it after it had received the message that it answers.
#[derive(Clone, Copy, Debug)]
struct Proof {
    /// Time at which this program sent the answered message.
    answered: Instant,
    /// Time at which the sender sent its answer, in microseconds of its clock.
    sent: u64,
}

impl Proof {
    /// Greatest age of another message of that sender, sent at `sent` on its clock.
    fn age(&self, sent: u64, now: Instant) -> Duration {
        now.since(self.answered) + Duration::from_micros(self.sent.saturating_sub(sent))
    }
}

/// An accepted message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Opened {
    /// Its purpose.
    pub kind: MessageKind,
    /// Its sender, number and time.
    pub head: EnvelopeHead,
    /// The message that it answers; `None` for a packet of a board.
    pub echo: Option<Echo>,
    /// The place of its body among its bytes.
    pub body: Range<usize>,
}

/// Another program.
#[derive(Clone, Debug)]
struct Peer {
    nonce: u64,
    window: ReplayWindow,
    /// Receipt of its newest message.
    echo: Echo,
    heard: Instant,
    /// From its last fresh answer.
    proof: Option<Proof>,
    /// Messages rejected before its first answer.
    unanswered: u64,
    /// Time at which its counter jumped. An answer to a later message begins a new window.
    jumped: Option<Instant>,
}

/// Writes the messages of one program, and accepts those of others.
#[derive(Clone, Debug)]
pub struct AuthSession {
    role: Role,
    /// The key of each kind, in the order of [`MessageKind::ALL`].
    keys: [[u8; 32]; MessageKind::ALL.len()],
    nonce: u64,
    counter: u64,
    peers: Vec<Peer>,
    most_peers: usize,
    refusals: AuthRefusals,
}

impl AuthSession {
    /// A session with the floor's `key`. `nonce` must be random and new for each session; `most_peers` is the number
    /// of other programs that are remembered, at least one.
    #[must_use]
    pub fn new(role: Role, key: &Key, nonce: u64, most_peers: usize) -> Self {
        Self {
            role,
            keys: MessageKind::ALL.map(|kind| key.derived(kind.context())),
            nonce,
            counter: 0,
            peers: Vec::new(),
            most_peers: most_peers.max(1),
            refusals: AuthRefusals::default(),
        }
    }

    /// Its nonce, which identifies it to others.
    #[must_use]
    pub const fn nonce(&self) -> u64 {
        self.nonce
    }

    /// Number of rejected messages so far.
    #[must_use]
    pub const fn refusals(&self) -> AuthRefusals {
        self.refusals
    }

    /// Writes a message with this `body`, sent at `now`, into `out`, replacing its content. Packets of boards carry
    /// no answers.
    pub fn seal(&mut self, kind: MessageKind, body: &[u8], now: Instant, out: &mut Vec<u8>) {
        self.counter += 1;
        let head = EnvelopeHead { from: self.nonce, counter: self.counter, sent: now.micros() };
        let heard =
            self.peers.iter().filter(|peer| kind != MessageKind::Packet && now.since(peer.heard) <= FRESH);
        let answers = heard.map(|peer| (peer.nonce, peer.echo));
        envelope::write((kind, &self.keys[kind as usize - 1]), &head, answers, body, out);
    }

    /// Reads a message that was received at `now`.
    ///
    /// # Errors
    /// The reason for rejecting it, which is also counted.
    pub fn open(&mut self, bytes: &[u8], now: Instant) -> Result<Opened, AuthRefusal> {
        let opened = self.look(bytes, now);
        if let Err(refusal) = opened {
            self.refusals.count(refusal);
        }
        opened
    }

    fn look(&mut self, bytes: &[u8], now: Instant) -> Result<Opened, AuthRefusal> {
        let kind =
            envelope::kind(bytes).filter(|kind| self.role.receives(*kind)).ok_or(AuthRefusal::Malformed)?;
        if !envelope::is_genuine(bytes, &self.keys[kind as usize - 1]) {
            return Err(AuthRefusal::Forged);
        }
        let parts = envelope::parts(bytes).ok_or(AuthRefusal::Malformed)?;
        let head = parts.head;
        // Its own message, reflected.
        if head.from == self.nonce {
            return Err(AuthRefusal::Repeated);
        }
        let echo = parts.answer_to(self.nonce);
        let proof = echo.map(|echo| Proof { answered: Instant::from_micros(echo.sent), sent: head.sent });
        let peer = self.peer(&head, now)?;
        peer.note(&head, proof, now)?;
        let Some(proof) = proof.or(peer.proof.filter(|_| kind == MessageKind::Packet)) else {
            peer.unanswered += 1;
            return Err(AuthRefusal::Unanswered);
        };
        if proof.answered > now || proof.age(head.sent, now) > FRESH {
            return Err(AuthRefusal::Stale);
        }
        peer.proof = Some(proof);
        self.refusals.unanswered -= std::mem::take(&mut peer.unanswered);
        Ok(Opened { kind, head, echo, body: parts.body.0..parts.body.1 })
    }

    /// The sender of a message with this `head`, which is added if it is new.
    fn peer(&mut self, head: &EnvelopeHead, now: Instant) -> Result<&mut Peer, AuthRefusal> {
        self.peers.retain(|peer| now.since(peer.heard) <= REMEMBERED);
        let known = self.peers.iter().position(|peer| peer.nonce == head.from);
        let index = match known {
            Some(index) => index,
            None => {
                let peer = Peer::met(head, now).ok_or(AuthRefusal::Jumped)?;
                self.make_room();
                self.peers.push(peer);
                self.peers.len() - 1
            }
        };
        self.peers.get_mut(index).ok_or(AuthRefusal::Malformed)
    }

    /// Forgets one sender if there is no room for another: the one that has been silent for longest, of those without
    /// an answer if there are any.
    fn make_room(&mut self) {
        if self.peers.len() < self.most_peers {
            return;
        }
        let all = self.peers.iter().enumerate();
        let first = all.min_by_key(|(_, peer)| (peer.proof.is_some(), peer.heard)).map(|(index, _)| index);
        first.map(|index| self.peers.swap_remove(index));
    }
}

impl Peer {
    /// The sender of a first message; `None` if its counter is beyond that of any sender.
    fn met(head: &EnvelopeHead, now: Instant) -> Option<Self> {
        Some(Self {
            nonce: head.from,
            // `note` adds the message itself.
            window: ReplayWindow::beginning(head.counter.saturating_sub(1))?,
            echo: Echo { sent: head.sent, received: now.micros() },
            heard: now,
            proof: None,
            unanswered: 0,
            jumped: None,
        })
    }

    /// Checks the counter of a message, and adds it; `proof` is from its answer, if it has one.
    fn note(&mut self, head: &EnvelopeHead, proof: Option<Proof>, now: Instant) -> Result<(), AuthRefusal> {
        let mut novelty = self.window.look(head.counter);
        if novelty == Novelty::Jumped {
            let is_new = self.jumped.zip(proof).is_some_and(|(jumped, proof)| proof.answered > jumped);
            let anew = ReplayWindow::beginning(head.counter.saturating_sub(1)).filter(|_| is_new);
            let Some(window) = anew else {
                self.jumped.get_or_insert(now);
                return Err(AuthRefusal::Jumped);
            };
            (self.window, self.jumped, novelty) = (window, None, Novelty::Newest);
        }
        if novelty == Novelty::Repeated {
            return Err(AuthRefusal::Repeated);
        }
        self.window.note(head.counter);
        if novelty == Novelty::Newest {
            (self.heard, self.echo) = (now, Echo { sent: head.sent, received: now.micros() });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
