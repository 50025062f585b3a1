//! One program's messages to and from the other computers of its floor.

use std::ops::Range;
use std::time::Duration;

use underfoot::units::Instant;

use super::envelope::{self, Echo, Head, Kind};
use super::key::Key;
use super::refusals::{Refusal, Refusals};
use super::window::{Novelty, Window};

/// How long ago that may have been sent which a message answers. A gateway that has been silent for 150 ms is no longer
/// believed, and neither is what was 100 ms on its way.
const FRESH: Duration = Duration::from_millis(250);

/// How long a sender that is silent is remembered: longer than anything that it sent is fresh.
const REMEMBERED: Duration = Duration::from_secs(1);

/// Which messages a program sends and takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A gateway's: to all nodes.
    Gateway,
    /// A node's: to all gateways.
    Node,
    /// A node's: to its neighbours.
    Neighbour,
}

impl Role {
    const fn takes(self, kind: Kind) -> bool {
        match self {
            Self::Gateway => matches!(kind, Kind::Node),
            Self::Node => matches!(kind, Kind::Gateway),
            Self::Neighbour => matches!(kind, Kind::Note | Kind::Packet),
        }
    }
}

/// A message of the sender's cannot have been sent before what it answers.
#[derive(Clone, Copy, Debug)]
struct Proof {
    /// When this program sent that.
    answered: Instant,
    /// When the message was sent, in microseconds of the sender's clock.
    sent: u64,
}

impl Proof {
    /// How old a message of the sender's is at most that it says it sent at `sent`.
    fn age(&self, sent: u64, now: Instant) -> Duration {
        now.since(self.answered) + Duration::from_micros(self.sent.saturating_sub(sent))
    }
}

/// A message that was taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Opened {
    /// What it is for.
    pub kind: Kind,
    /// Who sends it, and when.
    pub head: Head,
    /// What it answers; `None` for a packet of a board, which is as new as its sender's last note shows.
    pub echo: Option<Echo>,
    /// Where its body is among its bytes.
    pub body: Range<usize>,
}

/// Another program, since it was met.
#[derive(Clone, Debug)]
struct Peer {
    nonce: u64,
    window: Window,
    /// The newest of its messages.
    echo: Echo,
    heard: Instant,
    /// What its last answer that was new says of its age.
    proof: Option<Proof>,
    /// Messages that were refused before its first answer.
    unanswered: u64,
    /// When its counter jumped: what answers something that was sent later begins anew.
    jumped: Option<Instant>,
}

/// Writes the messages of one program, and takes those of others that are theirs and new.
#[derive(Clone, Debug)]
pub struct Session {
    role: Role,
    /// The key of each kind, in the order of [`Kind::ALL`].
    keys: [[u8; 32]; Kind::ALL.len()],
    nonce: u64,
    counter: u64,
    peers: Vec<Peer>,
    most_peers: usize,
    refusals: Refusals,
}

impl Session {
    /// A session under the floor's `key`; `nonce` is a random number that no session before had, and `most_peers` how
    /// many other programs there can be, at least one.
    #[must_use]
    pub fn new(role: Role, key: &Key, nonce: u64, most_peers: usize) -> Self {
        Self {
            role,
            keys: Kind::ALL.map(|kind| key.derived(kind.context())),
            nonce,
            counter: 0,
            peers: Vec::new(),
            most_peers: most_peers.max(1),
            refusals: Refusals::default(),
        }
    }

    /// The nonce, by which others know it.
    #[must_use]
    pub const fn nonce(&self) -> u64 {
        self.nonce
    }

    /// How many messages were not taken so far, by why.
    #[must_use]
    pub const fn refusals(&self) -> Refusals {
        self.refusals
    }

    /// Writes a message with this `body`, sent at `now`, into `out` in place of what is in it.
    ///
    /// Packets of boards, which come by the thousand, carry no answers: notes between them do.
    pub fn seal(&mut self, kind: Kind, body: &[u8], now: Instant, out: &mut Vec<u8>) {
        self.counter += 1;
        let head = Head { from: self.nonce, counter: self.counter, sent: now.micros() };
        let heard = self.peers.iter().filter(|peer| kind != Kind::Packet && now.since(peer.heard) <= FRESH);
        let answers = heard.map(|peer| (peer.nonce, peer.echo));
        envelope::write((kind, &self.keys[kind as usize - 1]), &head, answers, body, out);
    }

    /// The message that `bytes` are, received at `now`.
    ///
    /// # Errors
    /// Why it is not taken, which is also counted.
    pub fn open(&mut self, bytes: &[u8], now: Instant) -> Result<Opened, Refusal> {
        let opened = self.look(bytes, now);
        if let Err(refusal) = opened {
            self.refusals.count(refusal);
        }
        opened
    }

    fn look(&mut self, bytes: &[u8], now: Instant) -> Result<Opened, Refusal> {
        let kind = envelope::kind(bytes).filter(|kind| self.role.takes(*kind)).ok_or(Refusal::Malformed)?;
        if !envelope::is_genuine(bytes, &self.keys[kind as usize - 1]) {
            return Err(Refusal::Forged);
        }
        let parts = envelope::parts(bytes).ok_or(Refusal::Malformed)?;
        let head = parts.head;
        // What this program has sent itself comes back.
        if head.from == self.nonce {
            return Err(Refusal::Repeated);
        }
        let echo = parts.answer_to(self.nonce);
        let proof = echo.map(|echo| Proof { answered: Instant::from_micros(echo.sent), sent: head.sent });
        let peer = self.peer(&head, now)?;
        peer.note(&head, proof, now)?;
        let Some(proof) = proof.or(peer.proof.filter(|_| kind == Kind::Packet)) else {
            peer.unanswered += 1;
            return Err(Refusal::Unanswered);
        };
        if proof.answered > now || proof.age(head.sent, now) > FRESH {
            return Err(Refusal::Stale);
        }
        peer.proof = Some(proof);
        self.refusals.unanswered -= std::mem::take(&mut peer.unanswered);
        Ok(Opened { kind, head, echo, body: parts.body.0..parts.body.1 })
    }

    /// The sender of a message with this `head`, met now if it is not known.
    fn peer(&mut self, head: &Head, now: Instant) -> Result<&mut Peer, Refusal> {
        self.peers.retain(|peer| now.since(peer.heard) <= REMEMBERED);
        let known = self.peers.iter().position(|peer| peer.nonce == head.from);
        let index = match known {
            Some(index) => index,
            None => {
                let peer = Peer::met(head, now).ok_or(Refusal::Jumped)?;
                self.make_room();
                self.peers.push(peer);
                self.peers.len() - 1
            }
        };
        self.peers.get_mut(index).ok_or(Refusal::Malformed)
    }

    /// Forgets somebody if there is no room for one more: of those that have not answered, if there are any, the one
    /// that has been silent for longest.
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
    /// The sender of a first message; `None` if its counter is one that no sender reaches.
    fn met(head: &Head, now: Instant) -> Option<Self> {
        Some(Self {
            nonce: head.from,
            // The message itself is still to be noted.
            window: Window::beginning(head.counter.saturating_sub(1))?,
            echo: Echo { sent: head.sent, received: now.micros() },
            heard: now,
            proof: None,
            unanswered: 0,
            jumped: None,
        })
    }

    /// Takes note of a message, and of what its answer proves if it has one.
    fn note(&mut self, head: &Head, proof: Option<Proof>, now: Instant) -> Result<(), Refusal> {
        let mut novelty = self.window.look(head.counter);
        if novelty == Novelty::Jumped {
            let is_new = self.jumped.zip(proof).is_some_and(|(jumped, proof)| proof.answered > jumped);
            let anew = Window::beginning(head.counter.saturating_sub(1)).filter(|_| is_new);
            let Some(window) = anew else {
                self.jumped.get_or_insert(now);
                return Err(Refusal::Jumped);
            };
            (self.window, self.jumped, novelty) = (window, None, Novelty::Newest);
        }
        if novelty == Novelty::Repeated {
            return Err(Refusal::Repeated);
        }
        self.window.note(head.counter);
        if novelty == Novelty::Newest {
            (self.heard, self.echo) = (now, Echo { sent: head.sent, received: now.micros() });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn at(ms: u64) -> Instant {
        Instant::from_millis(ms)
    }

    fn key() -> Key {
        Key::new([7; 32])
    }

    fn session(role: Role, nonce: u64) -> Session {
        Session::new(role, &key(), nonce, 4)
    }

    fn sealed(from: &mut Session, kind: Kind, ms: u64) -> Vec<u8> {
        let mut out = Vec::new();
        from.seal(kind, b"body", at(ms), &mut out);
        out
    }

    fn opened(by: &mut Session, bytes: &[u8], ms: u64) -> Result<Head, Refusal> {
        by.open(bytes, at(ms)).map(|opened| {
            assert_eq!(&bytes[opened.body], b"body");
            opened.head
        })
    }

    /// A gateway and a node that have heard each other at 1000 ms.
    fn pair() -> (Session, Session) {
        let (mut gateway, mut node) = (session(Role::Gateway, 1), session(Role::Node, 2));
        meet(&mut gateway, &mut node, 1000);
        (gateway, node)
    }

    fn meet(gateway: &mut Session, node: &mut Session, ms: u64) {
        let beat = sealed(gateway, Kind::Gateway, ms);
        assert_eq!(opened(node, &beat, ms), Err(Refusal::Unanswered));
        let told = sealed(node, Kind::Node, ms);
        assert!(opened(gateway, &told, ms).is_ok());
        let beat = sealed(gateway, Kind::Gateway, ms);
        assert!(opened(node, &beat, ms).is_ok());
    }

    #[test]
    fn programs_that_answer_each_other_are_heard_within_a_round_trip() {
        let (gateway, node) = pair();
        assert_eq!(gateway.refusals(), Refusals::default());
        assert_eq!(node.refusals(), Refusals::default(), "what came before the answer is no longer counted");
    }

    #[test]
    fn a_message_says_when_that_was_sent_which_it_answers() {
        let (mut gateway, mut node) = pair();
        let beat = sealed(&mut gateway, Kind::Gateway, 1040);
        opened(&mut node, &beat, 9_041).unwrap_err();
        let told = sealed(&mut node, Kind::Node, 9_045);
        let Opened { head, echo, .. } = gateway.open(&told, at(1046)).unwrap();
        assert_eq!((head.from, head.counter, head.sent), (2, 2, 9_045_000));
        assert_eq!(echo, Some(Echo { sent: 1_040_000, received: 9_041_000 }));
    }

    // C6
    #[test]
    fn a_message_counts_once() {
        let (mut gateway, mut node) = pair();
        let told = sealed(&mut node, Kind::Node, 1010);
        assert!(opened(&mut gateway, &told, 1011).is_ok());
        assert_eq!(opened(&mut gateway, &told, 1012), Err(Refusal::Repeated));
        assert_eq!(gateway.refusals().repeated, 1);
    }

    // C5
    #[test]
    fn a_message_that_another_key_wrote_is_forged() {
        let (mut gateway, mut node) = pair();
        let mut other = Session::new(Role::Node, &Key::new([8; 32]), 2, 4);
        let mut forged = sealed(&mut other, Kind::Node, 1010);
        assert_eq!(opened(&mut gateway, &forged, 1011), Err(Refusal::Forged));
        forged = sealed(&mut node, Kind::Node, 1010);
        // The counter: the next one, and the greatest.
        for counter in [4_u64, u64::MAX] {
            forged[12..20].copy_from_slice(&counter.to_be_bytes());
            assert_eq!(opened(&mut gateway, &forged, 1011), Err(Refusal::Forged));
        }
        let told = sealed(&mut node, Kind::Node, 1012);
        assert!(opened(&mut gateway, &told, 1013).is_ok(), "nothing of it has remained");
        assert_eq!(gateway.refusals(), Refusals { forged: 3, ..Refusals::default() });
    }

    // C6
    #[test]
    fn what_was_recorded_before_a_receiver_s_start_is_worthless_after_it() {
        let (_, mut node) = pair();
        let recorded = sealed(&mut node, Kind::Node, 1010);
        let mut gateway = session(Role::Gateway, 3);
        for ms in [1011, 1012] {
            assert!(opened(&mut gateway, &recorded, ms).is_err());
        }
        assert_eq!(gateway.refusals(), Refusals { unanswered: 1, repeated: 1, ..Refusals::default() });
        // The node itself is heard once it has answered.
        let beat = sealed(&mut gateway, Kind::Gateway, 1020);
        opened(&mut node, &beat, 1021).unwrap();
        let told = sealed(&mut node, Kind::Node, 1022);
        assert!(opened(&mut gateway, &told, 1023).is_ok());
    }

    // C6
    #[test]
    fn what_was_recorded_before_a_sender_s_start_is_worthless_after_it() {
        let (mut gateway, mut old) = pair();
        let recorded: Vec<_> = (0..3).map(|_| sealed(&mut old, Kind::Node, 1010)).collect();
        assert!(opened(&mut gateway, &recorded[1], 1011).is_ok());
        let mut node = session(Role::Node, 3);
        meet(&mut gateway, &mut node, 2000);
        for message in &recorded {
            assert_eq!(opened(&mut gateway, message, 2300), Err(Refusal::Stale));
        }
        let told = sealed(&mut node, Kind::Node, 2010);
        assert!(opened(&mut gateway, &told, 2011).is_ok());
    }

    // C6
    #[test]
    fn a_message_that_is_held_back_is_stale() {
        let (mut gateway, mut node) = pair();
        let held_back: Vec<_> = (0..2).map(|_| sealed(&mut node, Kind::Node, 1010)).collect();
        assert!(opened(&mut gateway, &held_back[0], 1250).is_ok(), "250 ms after the beat that it answers");
        assert_eq!(opened(&mut gateway, &held_back[1], 1251), Err(Refusal::Stale));
    }

    /// Two neighbours that have heard each other at 1000 ms; the clock of the second is 70 s ahead.
    fn neighbours() -> (Session, Session) {
        let (mut west, mut east) = (session(Role::Neighbour, 1), session(Role::Neighbour, 2));
        let note = sealed(&mut west, Kind::Note, 1000);
        opened(&mut east, &note, 71_000).unwrap_err();
        let note = sealed(&mut east, Kind::Note, 71_000);
        opened(&mut west, &note, 1000).unwrap();
        let note = sealed(&mut west, Kind::Note, 1000);
        opened(&mut east, &note, 71_000).unwrap();
        (west, east)
    }

    #[test]
    fn a_packet_is_as_new_as_the_notes_around_it_show() {
        let (mut west, mut east) = neighbours();
        let packets: Vec<_> = (0..4).map(|_| sealed(&mut west, Kind::Packet, 1010)).collect();
        assert!(opened(&mut east, &packets[0], 71_011).is_ok());
        assert_eq!(opened(&mut east, &packets[0], 71_012), Err(Refusal::Repeated));
        assert!(opened(&mut east, &packets[1], 71_250).is_ok(), "250 ms after what the last note answers");
        assert_eq!(opened(&mut east, &packets[2], 71_251), Err(Refusal::Stale));
        // Notes go on while somebody holds a packet back.
        for ms in [1100, 1200, 1300] {
            let note = sealed(&mut east, Kind::Note, 70_000 + ms);
            opened(&mut west, &note, ms).unwrap();
            let note = sealed(&mut west, Kind::Note, ms);
            opened(&mut east, &note, 70_000 + ms).unwrap();
        }
        assert_eq!(opened(&mut east, &packets[3], 71_300), Err(Refusal::Stale), "290 ms old");
        let packet = sealed(&mut west, Kind::Packet, 1300);
        assert!(opened(&mut east, &packet, 71_301).is_ok());
    }

    // C5
    #[test]
    fn a_packet_of_a_stranger_is_not_taken() {
        let (_, mut east) = neighbours();
        let mut stranger = session(Role::Neighbour, 3);
        let packet = sealed(&mut stranger, Kind::Packet, 1010);
        assert_eq!(opened(&mut east, &packet, 71_010), Err(Refusal::Unanswered));
    }

    #[test]
    fn a_message_for_others_or_from_itself_is_not_taken() {
        let (mut gateway, mut node) = pair();
        let beat = sealed(&mut gateway, Kind::Gateway, 1010);
        assert_eq!(opened(&mut gateway, &beat, 1010), Err(Refusal::Malformed), "gateways hear nodes");
        let mut east = session(Role::Neighbour, 9);
        let note = sealed(&mut east, Kind::Note, 1010);
        assert_eq!(opened(&mut east, &note, 1010), Err(Refusal::Repeated), "its own");
        assert_eq!(opened(&mut node, &note, 1010), Err(Refusal::Malformed));
        assert_eq!(opened(&mut node, b"{}", 1010), Err(Refusal::Malformed));
    }

    // C5
    #[test]
    fn a_counter_that_jumps_locks_nobody_out() {
        let (mut gateway, mut node) = pair();
        let honest = node.clone();
        for counter in [1 << 40, u64::MAX - 1] {
            node.counter = counter;
            let jump = sealed(&mut node, Kind::Node, 1010);
            assert_eq!(opened(&mut gateway, &jump, 1011), Err(Refusal::Jumped));
        }
        node = honest;
        let told = sealed(&mut node, Kind::Node, 1012);
        assert!(opened(&mut gateway, &told, 1013).is_ok());
    }

    #[test]
    fn a_counter_that_goes_on_beyond_a_jump_is_challenged_anew() {
        let (mut gateway, mut node) = pair();
        node.counter = 1 << 40;
        for _ in 0..2 {
            let jump = sealed(&mut node, Kind::Node, 1010);
            assert_eq!(opened(&mut gateway, &jump, 1011), Err(Refusal::Jumped));
        }
        let beat = sealed(&mut gateway, Kind::Gateway, 1020);
        opened(&mut node, &beat, 1020).unwrap();
        let told = sealed(&mut node, Kind::Node, 1021);
        assert!(opened(&mut gateway, &told, 1021).is_ok());
        assert_eq!(opened(&mut gateway, &told, 1022), Err(Refusal::Repeated));
    }

    #[test]
    fn a_sender_that_is_back_after_a_pause_is_heard_with_any_counter() {
        let (mut gateway, mut node) = pair();
        node.counter = 1 << 40;
        let beat = sealed(&mut gateway, Kind::Gateway, 60_000);
        opened(&mut node, &beat, 60_000).unwrap_err();
        let told = sealed(&mut node, Kind::Node, 60_001);
        assert!(opened(&mut gateway, &told, 60_001).is_ok());
    }

    #[test]
    fn recordings_of_many_old_starts_drive_nobody_out() {
        let (mut gateway, mut node) = pair();
        for nonce in 100..200 {
            let mut old = session(Role::Node, nonce);
            let recorded = sealed(&mut old, Kind::Node, 1);
            assert_eq!(opened(&mut gateway, &recorded, 1010), Err(Refusal::Unanswered));
            assert!(gateway.peers.len() <= 4);
        }
        let told = sealed(&mut node, Kind::Node, 1011);
        assert!(opened(&mut gateway, &told, 1011).is_ok());
    }

    #[derive(Clone, Debug)]
    enum Step {
        /// So many milliseconds pass.
        Wait(u64),
        /// The node, or the gateway, sends; the first copy arrives, or somebody keeps it back.
        Tell { by_node: bool, arrives: bool },
        /// Somebody delivers what was sent, by number, to the node or the gateway.
        Deliver { number: usize, to_node: bool },
        /// The node, or the gateway, starts again.
        Restart { node: bool },
    }

    fn step() -> impl Strategy<Value = Step> {
        prop_oneof![
            (0_u64..120).prop_map(Step::Wait),
            (any::<bool>(), any::<bool>()).prop_map(|(by_node, arrives)| Step::Tell { by_node, arrives }),
            (any::<usize>(), any::<bool>()).prop_map(|(number, to_node)| Step::Deliver { number, to_node }),
            any::<bool>().prop_map(|node| Step::Restart { node }),
        ]
    }

    proptest! {
        /// Whoever carries the messages keeps them back, repeats them and mixes them up as it likes, over any restarts.
        #[test]
        fn each_message_counts_once_and_within_250_ms(steps in prop::collection::vec(step(), 1..200)) {
            let mut ends = [session(Role::Gateway, 1), session(Role::Node, 2)];
            let mut nonce = 2;
            let mut now = 1000;
            // Bytes, and when they were sent.
            let mut sent: Vec<(Vec<u8>, u64)> = Vec::new();
            let mut taken: Vec<usize> = Vec::new();
            for step in steps {
                let delivery = match step {
                    Step::Wait(ms) => {
                        now += ms;
                        None
                    }
                    Step::Tell { by_node, arrives } => {
                        let kind = if by_node { Kind::Node } else { Kind::Gateway };
                        sent.push((sealed(&mut ends[usize::from(by_node)], kind, now), now));
                        arrives.then_some((sent.len() - 1, !by_node))
                    }
                    Step::Deliver { number, to_node } => {
                        (!sent.is_empty()).then(|| (number % sent.len(), to_node))
                    }
                    Step::Restart { node } => {
                        nonce += 1;
                        let role = if node { Role::Node } else { Role::Gateway };
                        ends[usize::from(node)] = session(role, nonce);
                        None
                    }
                };
                if let Some((number, to_node)) = delivery {
                    let (bytes, told) = &sent[number];
                    if opened(&mut ends[usize::from(to_node)], bytes, now).is_ok() {
                        prop_assert!(!taken.contains(&number), "twice");
                        prop_assert!(now - told <= 250, "{} ms old", now - told);
                        taken.push(number);
                    }
                }
            }
        }
    }
}
