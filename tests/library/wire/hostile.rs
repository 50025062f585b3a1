//! Invalid datagrams: none may crash the program, and none may change the events of feet.

use crate::corrupt::{Corruptor, bundle_bomb, hostile_address, tag_bomb};
use proptest::prelude::*;
use rosc::{OscPacket, encoder};
use underfoot::floor::{Floor, Geometry};
use underfoot::sense::{Assembler, ForceFrame, Quality};
use underfoot::units::Instant;
use underfoot::wire::{
    Batch, DatagramLimits, Decoder, LinkCounters, Malformed, Readings, SensorEncoder, SensorFormat,
    SensorPacket, WireError, check,
};

fn floor() -> Floor {
    Floor::of(Geometry::of_paper_tiles(6, 6).unwrap())
}

fn packet(board: u16, ms: u32) -> SensorPacket {
    // A slow wave, so that frames and boards differ from each other.
    let wave = |channel: u32| 20_000 + (ms % 1000) as u16 * 20 + board * 50 + channel as u16;
    let readings = Readings::Counts((0..24).map(|channel| Some(wave(channel))).collect());
    SensorPacket { board, sequence: ms, received: Instant::from_millis(ms.into()), readings }
}

/// A receiving end: all code behind the socket.
struct Receiver {
    decoder: Decoder,
    batch: Batch,
    assembler: Assembler,
    refused: LinkCounters,
    frames: Vec<ForceFrame>,
}

impl Receiver {
    fn new() -> Self {
        Self {
            decoder: Decoder::new(&floor()),
            batch: Batch::default(),
            assembler: Assembler::new(&floor()),
            refused: LinkCounters::default(),
            frames: Vec::new(),
        }
    }

    fn receive(&mut self, datagram: &[u8], ms: u32) {
        match self.decoder.decode(datagram, Instant::from_millis(ms.into()), &mut self.batch) {
            Ok(()) => self.batch.packets.iter().for_each(|packet| self.assembler.take(packet)),
            Err(error) => error.count(&mut self.refused),
        }
        while let Some(frame) = self.assembler.ready() {
            self.frames.push(frame.clone());
        }
    }
}

fn verdict(datagram: &[u8]) -> Result<(), WireError> {
    Decoder::new(&floor()).decode(datagram, Instant::START, &mut Batch::default())
}

// P1, P2, P5, P11
#[test]
fn bombs_are_refused_for_what_they_are() {
    let roomy = DatagramLimits { bytes: 65_507, tags: 65_507, address: 65_507, ..DatagramLimits::SENSORS };
    for bomb in [bundle_bomb(3000), tag_bomb(22_000), tag_bomb(60_000)] {
        assert!(matches!(check(&bomb, &roomy), Err(Malformed::TooDeep { .. })));
        assert!(matches!(verdict(&bomb), Err(WireError::Malformed(Malformed::TooLarge { .. }))));
    }
    for small in [bundle_bomb(400), tag_bomb(8000), tag_bomb(200)] {
        assert!(small.len() <= DatagramLimits::SENSORS.bytes);
        assert!(matches!(verdict(&small), Err(WireError::Malformed(_))));
    }
    assert!(matches!(verdict(&hostile_address(100)), Err(WireError::UnknownAddress { .. })));
    assert!(matches!(verdict(&hostile_address(60_000)), Err(WireError::Malformed(_))));
}

// P3
#[test]
fn ten_seconds_of_garbage_beside_the_packets_changes_next_to_nothing() {
    let mut corruptor = Corruptor::new(17);
    let (mut clean, mut noisy) = (Receiver::new(), Receiver::new());
    let mut encoder = SensorEncoder::new(&floor(), SensorFormat::Counts);
    let mut sent: Vec<Vec<u8>> = Vec::new();
    for ms in 0..10_000 {
        let before = std::mem::take(&mut sent);
        for board in 0..6 {
            if ms > 0 {
                let garbage = corruptor.corrupt(&before[usize::from(board)]);
                noisy.receive(&garbage, ms);
            }
            let datagram = encoder.encode(&packet(board, ms)).unwrap();
            clean.receive(datagram, ms);
            noisy.receive(datagram, ms);
            sent.push(datagram.to_vec());
        }
        // Compared and dropped each second.
        if ms % 1000 == 999 {
            assert_eq!(clean.frames.len(), noisy.frames.len(), "before {ms}");
            let frames = clean.frames.drain(..).zip(noisy.frames.drain(..));
            // A copy of the last packet with only the number's lowest bit damaged passes for this millisecond's
            // packet: the frame then holds a value 1 ms old, perhaps with a wrong bit. That happens about once in two
            // seconds.
            let changed = frames
                .inspect(|(_, noisy)| {
                    assert!(noisy.forces.iter().flatten().all(|force| force.is_finite()));
                    assert!(noisy.quality.iter().flatten().all(|quality| *quality != Quality::Stale));
                })
                .filter(|(clean, noisy)| clean != noisy);
            assert!(changed.count() <= 10, "before {ms}");
        }
    }
    assert!(noisy.refused.malformed > 20_000, "{:?}", noisy.refused);
    assert!(noisy.refused.unknown_address > 500 && noisy.refused.wrong_shape > 20, "{:?}", noisy.refused);
    let counters = noisy.assembler.counters();
    assert!(counters.duplicate > 5000 && counters.restarts == 0, "{counters:?}");
}

fn as_osc(datagram: &[u8]) -> Option<OscPacket> {
    let (rest, packet) = rosc::decoder::decode_udp(datagram).ok()?;
    rest.is_empty().then_some(packet)
}

/// rosc must read datagrams that the guard passes completely: encoded again they have the same length.
fn guard_and_rosc_agree(datagram: &[u8]) -> Result<(), TestCaseError> {
    if check(datagram, &DatagramLimits::SENSORS).is_ok() {
        let packet = as_osc(datagram);
        prop_assert!(packet.is_some(), "the guard passes what rosc refuses: {:?}", datagram);
        let again = encoder::encode(&packet.unwrap()).unwrap();
        prop_assert_eq!(again.len(), datagram.len());
    }
    Ok(())
}

/// Fragments of OSC, so that some random datagrams pass the first check.
fn fragments() -> impl Strategy<Value = Vec<u8>> {
    let fragment = prop_oneof![
        Just(b"#bundle\0\0\0\0\0\0\0\0\x01".to_vec()),
        Just(b"/a\0\0".to_vec()),
        Just(b"/underfoot/board/0\0\0".to_vec()),
        Just(b"/underfoot/widget/a/set\0".to_vec()),
        Just(b",\0\0\0".to_vec()),
        Just(b",ifb\0\0\0\0".to_vec()),
        Just(b",[i][\0\0\0".to_vec()),
        Just(b",sTc\0\0\0\0".to_vec()),
        (0u32..80).prop_map(|length| (length & !3).to_be_bytes().to_vec()),
        prop::collection::vec(any::<u8>(), 4..=4),
    ];
    prop::collection::vec(fragment, 0..16).prop_map(|fragments| fragments.concat())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    // P3
    #[test]
    fn random_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = verdict(&bytes);
        guard_and_rosc_agree(&bytes)?;
    }

    // P3, P11
    #[test]
    fn pieces_of_osc_in_any_order_never_panic(bytes in fragments()) {
        let _ = verdict(&bytes);
        guard_and_rosc_agree(&bytes)?;
    }

    // P3
    #[test]
    fn damaged_packets_never_panic(seed: u64, blob: bool) {
        let format = if blob { SensorFormat::Blob } else { SensorFormat::Counts };
        let mut encoder = SensorEncoder::new(&floor(), format);
        let mut corruptor = Corruptor::new(seed);
        let datagram = encoder.encode(&packet(1, 77)).unwrap();
        for _ in 0..4 {
            let damaged = corruptor.flip(datagram);
            let _ = verdict(&damaged);
            guard_and_rosc_agree(&damaged)?;
        }
    }
}

#[test]
fn the_fragments_above_do_reach_the_decoder() {
    // Otherwise the property would say little about datagrams that pass the guard.
    use proptest::strategy::ValueTree;
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let passed = (0..4000).filter(|_| {
        let bytes = fragments().new_tree(&mut runner).unwrap().current();
        check(&bytes, &DatagramLimits::SENSORS).is_ok()
    });
    assert!(passed.count() > 20);
}

/// Limits that let a bomb of any size through to the depth checks.
const ROOMY: DatagramLimits =
    DatagramLimits { bytes: 65_507, tags: 65_507, address: 65_507, ..DatagramLimits::SENSORS };

#[test]
fn bombs_are_well_formed_but_for_their_depth() {
    assert_eq!(check(&bundle_bomb(4), &ROOMY), Ok(()));
    assert!(matches!(check(&bundle_bomb(5), &ROOMY), Err(Malformed::TooDeep { .. })));
    assert!(matches!(check(&bundle_bomb(3000), &ROOMY), Err(Malformed::TooDeep { .. })));
    assert!(matches!(check(&tag_bomb(20_000), &ROOMY), Err(Malformed::TooDeep { .. })));
    assert_eq!(check(&hostile_address(50_000), &ROOMY), Ok(()));
}

#[test]
fn bombs_fit_their_datagram_and_are_refused_by_size_too() {
    for bomb in [bundle_bomb(3000), tag_bomb(60_000), hostile_address(60_000)] {
        assert!(bomb.len() <= 65_507);
        assert!(matches!(check(&bomb, &DatagramLimits::SENSORS), Err(Malformed::TooLarge { .. })));
    }
}

#[test]
fn the_same_seed_makes_the_same_garbage() {
    let make = |seed| {
        let mut corruptor = Corruptor::new(seed);
        (0..100).map(|_| corruptor.corrupt(&[7; 60])).collect::<Vec<_>>()
    };
    assert_eq!(make(5), make(5));
    assert_ne!(make(5), make(6));
    // An empty model must work too.
    let mut corruptor = Corruptor::new(1);
    (0..100).for_each(|_| drop(corruptor.corrupt(&[])));
}
