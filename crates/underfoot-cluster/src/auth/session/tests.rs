//! Messages that are authentic, forged or repeated.

use proptest::prelude::*;

use super::*;

fn at(ms: u64) -> Instant {
    Instant::from_millis(ms)
}

fn key() -> Key {
    Key::new([7; 32])
}

fn session(role: Role, nonce: u64) -> AuthSession {
    AuthSession::new(role, &key(), nonce, 4)
}

fn sealed(from: &mut AuthSession, kind: MessageKind, ms: u64) -> Vec<u8> {
    let mut out = Vec::new();
    from.seal(kind, b"body", at(ms), &mut out);
    out
}

fn opened(by: &mut AuthSession, bytes: &[u8], ms: u64) -> Result<EnvelopeHead, AuthRefusal> {
    by.open(bytes, at(ms)).map(|opened| {
        assert_eq!(&bytes[opened.body], b"body");
        opened.head
    })
}

/// A gateway and a node that have answered each other at 1000 ms.
fn pair() -> (AuthSession, AuthSession) {
    let (mut gateway, mut node) = (session(Role::Gateway, 1), session(Role::Node, 2));
    meet(&mut gateway, &mut node, 1000);
    (gateway, node)
}

fn meet(gateway: &mut AuthSession, node: &mut AuthSession, ms: u64) {
    let beat = sealed(gateway, MessageKind::Gateway, ms);
    assert_eq!(opened(node, &beat, ms), Err(AuthRefusal::Unanswered));
    let message = sealed(node, MessageKind::Node, ms);
    assert!(opened(gateway, &message, ms).is_ok());
    let beat = sealed(gateway, MessageKind::Gateway, ms);
    assert!(opened(node, &beat, ms).is_ok());
}

#[test]
fn programs_that_answer_each_other_are_accepted_within_a_round_trip() {
    let (gateway, node) = pair();
    assert_eq!(gateway.refusals(), AuthRefusals::default());
    assert_eq!(
        node.refusals(),
        AuthRefusals::default(),
        "messages before the first answer are no longer counted"
    );
}

#[test]
fn a_message_carries_the_receipt_of_the_one_that_it_answers() {
    let (mut gateway, mut node) = pair();
    let beat = sealed(&mut gateway, MessageKind::Gateway, 1040);
    opened(&mut node, &beat, 9_041).unwrap_err();
    let message = sealed(&mut node, MessageKind::Node, 9_045);
    let Opened { head, echo, .. } = gateway.open(&message, at(1046)).unwrap();
    assert_eq!((head.from, head.counter, head.sent), (2, 2, 9_045_000));
    assert_eq!(echo, Some(Echo { sent: 1_040_000, received: 9_041_000 }));
}

// C6
#[test]
fn a_message_counts_once() {
    let (mut gateway, mut node) = pair();
    let message = sealed(&mut node, MessageKind::Node, 1010);
    assert!(opened(&mut gateway, &message, 1011).is_ok());
    assert_eq!(opened(&mut gateway, &message, 1012), Err(AuthRefusal::Repeated));
    assert_eq!(gateway.refusals().repeated, 1);
}

// C5
#[test]
fn a_message_with_another_key_is_forged() {
    let (mut gateway, mut node) = pair();
    let mut other = AuthSession::new(Role::Node, &Key::new([8; 32]), 2, 4);
    let mut forged = sealed(&mut other, MessageKind::Node, 1010);
    assert_eq!(opened(&mut gateway, &forged, 1011), Err(AuthRefusal::Forged));
    forged = sealed(&mut node, MessageKind::Node, 1010);
    // The counter: the next one, and the greatest.
    for counter in [4_u64, u64::MAX] {
        forged[12..20].copy_from_slice(&counter.to_be_bytes());
        assert_eq!(opened(&mut gateway, &forged, 1011), Err(AuthRefusal::Forged));
    }
    let message = sealed(&mut node, MessageKind::Node, 1012);
    assert!(opened(&mut gateway, &message, 1013).is_ok(), "the forged counters have no effect");
    assert_eq!(gateway.refusals(), AuthRefusals { forged: 3, ..AuthRefusals::default() });
}

// C6
#[test]
fn a_recording_is_worthless_after_the_receiver_s_next_start() {
    let (_, mut node) = pair();
    let recorded = sealed(&mut node, MessageKind::Node, 1010);
    let mut gateway = session(Role::Gateway, 3);
    for ms in [1011, 1012] {
        assert!(opened(&mut gateway, &recorded, ms).is_err());
    }
    assert_eq!(gateway.refusals(), AuthRefusals { unanswered: 1, repeated: 1, ..AuthRefusals::default() });
    // The node itself is accepted once it has answered.
    let beat = sealed(&mut gateway, MessageKind::Gateway, 1020);
    opened(&mut node, &beat, 1021).unwrap();
    let message = sealed(&mut node, MessageKind::Node, 1022);
    assert!(opened(&mut gateway, &message, 1023).is_ok());
}

// C6
#[test]
fn a_recording_is_worthless_after_the_sender_s_next_start() {
    let (mut gateway, mut old) = pair();
    let recorded: Vec<_> = (0..3).map(|_| sealed(&mut old, MessageKind::Node, 1010)).collect();
    assert!(opened(&mut gateway, &recorded[1], 1011).is_ok());
    let mut node = session(Role::Node, 3);
    meet(&mut gateway, &mut node, 2000);
    for message in &recorded {
        assert_eq!(opened(&mut gateway, message, 2300), Err(AuthRefusal::Stale));
    }
    let message = sealed(&mut node, MessageKind::Node, 2010);
    assert!(opened(&mut gateway, &message, 2011).is_ok());
}

// C6
#[test]
fn a_message_that_is_held_back_is_stale() {
    let (mut gateway, mut node) = pair();
    let held_back: Vec<_> = (0..2).map(|_| sealed(&mut node, MessageKind::Node, 1010)).collect();
    assert!(opened(&mut gateway, &held_back[0], 1250).is_ok(), "250 ms after the beat that it answers");
    assert_eq!(opened(&mut gateway, &held_back[1], 1251), Err(AuthRefusal::Stale));
}

/// Two neighbours that have answered each other at 1000 ms; the clock of the second is 70 s ahead.
fn neighbours() -> (AuthSession, AuthSession) {
    let (mut west, mut east) = (session(Role::Neighbour, 1), session(Role::Neighbour, 2));
    let note = sealed(&mut west, MessageKind::Note, 1000);
    opened(&mut east, &note, 71_000).unwrap_err();
    let note = sealed(&mut east, MessageKind::Note, 71_000);
    opened(&mut west, &note, 1000).unwrap();
    let note = sealed(&mut west, MessageKind::Note, 1000);
    opened(&mut east, &note, 71_000).unwrap();
    (west, east)
}

#[test]
fn a_packet_is_as_new_as_its_sender_s_last_note() {
    let (mut west, mut east) = neighbours();
    let packets: Vec<_> = (0..4).map(|_| sealed(&mut west, MessageKind::Packet, 1010)).collect();
    assert!(opened(&mut east, &packets[0], 71_011).is_ok());
    assert_eq!(opened(&mut east, &packets[0], 71_012), Err(AuthRefusal::Repeated));
    assert!(opened(&mut east, &packets[1], 71_250).is_ok(), "250 ms after what the last note answers");
    assert_eq!(opened(&mut east, &packets[2], 71_251), Err(AuthRefusal::Stale));
    // An attacker holds the packet back and lets notes pass.
    for ms in [1100, 1200, 1300] {
        let note = sealed(&mut east, MessageKind::Note, 70_000 + ms);
        opened(&mut west, &note, ms).unwrap();
        let note = sealed(&mut west, MessageKind::Note, ms);
        opened(&mut east, &note, 70_000 + ms).unwrap();
    }
    assert_eq!(opened(&mut east, &packets[3], 71_300), Err(AuthRefusal::Stale), "290 ms old");
    let packet = sealed(&mut west, MessageKind::Packet, 1300);
    assert!(opened(&mut east, &packet, 71_301).is_ok());
}

// C5
#[test]
fn a_packet_without_a_note_before_it_is_rejected() {
    let (_, mut east) = neighbours();
    let mut stranger = session(Role::Neighbour, 3);
    let packet = sealed(&mut stranger, MessageKind::Packet, 1010);
    assert_eq!(opened(&mut east, &packet, 71_010), Err(AuthRefusal::Unanswered));
}

#[test]
fn a_message_for_others_or_from_itself_is_rejected() {
    let (mut gateway, mut node) = pair();
    let beat = sealed(&mut gateway, MessageKind::Gateway, 1010);
    assert_eq!(opened(&mut gateway, &beat, 1010), Err(AuthRefusal::Malformed), "gateways receive from nodes");
    let mut east = session(Role::Neighbour, 9);
    let note = sealed(&mut east, MessageKind::Note, 1010);
    assert_eq!(opened(&mut east, &note, 1010), Err(AuthRefusal::Repeated), "its own");
    assert_eq!(opened(&mut node, &note, 1010), Err(AuthRefusal::Malformed));
    assert_eq!(opened(&mut node, b"{}", 1010), Err(AuthRefusal::Malformed));
}

// C5
#[test]
fn a_counter_that_jumps_locks_nobody_out() {
    let (mut gateway, mut node) = pair();
    let honest = node.clone();
    for counter in [1 << 40, u64::MAX - 1] {
        node.counter = counter;
        let jump = sealed(&mut node, MessageKind::Node, 1010);
        assert_eq!(opened(&mut gateway, &jump, 1011), Err(AuthRefusal::Jumped));
    }
    node = honest;
    let message = sealed(&mut node, MessageKind::Node, 1012);
    assert!(opened(&mut gateway, &message, 1013).is_ok());
}

#[test]
fn a_counter_that_goes_on_beyond_a_jump_is_challenged_anew() {
    let (mut gateway, mut node) = pair();
    node.counter = 1 << 40;
    for _ in 0..2 {
        let jump = sealed(&mut node, MessageKind::Node, 1010);
        assert_eq!(opened(&mut gateway, &jump, 1011), Err(AuthRefusal::Jumped));
    }
    let beat = sealed(&mut gateway, MessageKind::Gateway, 1020);
    opened(&mut node, &beat, 1020).unwrap();
    let message = sealed(&mut node, MessageKind::Node, 1021);
    assert!(opened(&mut gateway, &message, 1021).is_ok());
    assert_eq!(opened(&mut gateway, &message, 1022), Err(AuthRefusal::Repeated));
}

#[test]
fn a_sender_is_accepted_with_any_counter_after_a_pause() {
    let (mut gateway, mut node) = pair();
    node.counter = 1 << 40;
    let beat = sealed(&mut gateway, MessageKind::Gateway, 60_000);
    opened(&mut node, &beat, 60_000).unwrap_err();
    let message = sealed(&mut node, MessageKind::Node, 60_001);
    assert!(opened(&mut gateway, &message, 60_001).is_ok());
}

#[test]
fn recordings_of_many_old_starts_displace_no_sender() {
    let (mut gateway, mut node) = pair();
    for nonce in 100..200 {
        let mut old = session(Role::Node, nonce);
        let recorded = sealed(&mut old, MessageKind::Node, 1);
        assert_eq!(opened(&mut gateway, &recorded, 1010), Err(AuthRefusal::Unanswered));
        assert!(gateway.peers.len() <= 4);
    }
    let message = sealed(&mut node, MessageKind::Node, 1011);
    assert!(opened(&mut gateway, &message, 1011).is_ok());
}

#[derive(Clone, Debug)]
enum Step {
    /// Time passes, in milliseconds.
    Wait(u64),
    /// The node or the gateway sends; the message arrives at once, or is held back.
    Tell { by_node: bool, arrives: bool },
    /// An attacker delivers a message, by its number, to the node or the gateway.
    Deliver { number: usize, to_node: bool },
    /// The node or the gateway starts again.
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
    /// An attacker on the way holds messages back, repeats and reorders them, over any restarts.
    #[test]
    fn each_message_counts_once_and_within_250_ms(steps in prop::collection::vec(step(), 1..200)) {
        let mut ends = [session(Role::Gateway, 1), session(Role::Node, 2)];
        let mut nonce = 2;
        let mut now = 1000;
        // Bytes and time of each message.
        let mut sent: Vec<(Vec<u8>, u64)> = Vec::new();
        let mut accepted: Vec<usize> = Vec::new();
        for step in steps {
            let delivery = match step {
                Step::Wait(ms) => {
                    now += ms;
                    None
                }
                Step::Tell { by_node, arrives } => {
                    let kind = if by_node { MessageKind::Node } else { MessageKind::Gateway };
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
                let (bytes, sent_at) = &sent[number];
                if opened(&mut ends[usize::from(to_node)], bytes, now).is_ok() {
                    prop_assert!(!accepted.contains(&number), "twice");
                    prop_assert!(now - sent_at <= 250, "{} ms old", now - sent_at);
                    accepted.push(number);
                }
            }
        }
    }
}
