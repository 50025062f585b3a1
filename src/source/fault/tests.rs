//! Tests of the packets that the injected faults let through.

use super::*;

/// Two boards that each send one packet per millisecond, for a second.
struct Boards(std::vec::IntoIter<SensorPacket>, Instant);

fn boards() -> Boards {
    let packets: Vec<_> = (0..1000).flat_map(|ms| (0..2).map(move |board| packet(board, ms))).collect();
    Boards(packets.into_iter(), Instant::START)
}

fn packet(board: u16, ms: u32) -> SensorPacket {
    let readings = Readings::Counts([Some(7); 4].into_iter().collect());
    SensorPacket { board, sequence: ms, received: Instant::from_millis(ms.into()), readings }
}

impl SensorSource for Boards {
    fn next(&mut self, _: Duration) -> Result<Option<SensorPacket>, SourceError> {
        let packet = self.0.next().ok_or(SourceError::Ended)?;
        self.1 = packet.received;
        Ok(Some(packet))
    }

    fn now(&self) -> Instant {
        self.1
    }

    fn counters(&self) -> LinkCounters {
        LinkCounters::default()
    }
}

/// All packets that get through, and the number of calls that found none within 10 ms.
fn through(faults: LinkFaults, seed: u64) -> (Vec<SensorPacket>, usize) {
    let mut source = FaultInjector::new(boards(), faults, seed);
    let (mut packets, mut silences) = (Vec::new(), 0);
    loop {
        match source.next(Duration::from_millis(10)) {
            Ok(Some(packet)) => packets.push(packet),
            Ok(None) => silences += 1,
            Err(SourceError::Ended) => return (packets, silences),
            Err(error) => panic!("{error}"),
        }
    }
}

#[test]
fn without_faults_nothing_changes() {
    let (packets, silences) = through(LinkFaults::default(), 1);
    assert_eq!(packets, boards().0.collect::<Vec<_>>());
    assert_eq!(silences, 0);
}

#[test]
fn a_fifth_is_lost_and_another_seed_loses_others() {
    let lossy = LinkFaults { loss: 0.2, ..LinkFaults::default() };
    let (packets, _) = through(lossy.clone(), 1);
    assert!((1520..1680).contains(&packets.len()), "{}", packets.len());
    assert_eq!(packets, through(lossy.clone(), 1).0);
    assert_ne!(packets, through(lossy, 2).0);
}

#[test]
fn delayed_packets_are_overtaken_and_stamped_when_they_arrive() {
    let slow = LinkFaults { delay: 0.3, delay_up_to: Duration::from_millis(5), ..LinkFaults::default() };
    let (packets, _) = through(slow, 1);
    assert_eq!(packets.len(), 2000);
    assert!(packets.is_sorted_by_key(|packet| packet.received));
    assert!(!packets.is_sorted_by_key(|packet| packet.sequence));
    let longest = packets.iter().map(|p| p.received.micros() - u64::from(p.sequence) * 1000).max();
    assert!((4000..=5000).contains(&longest.unwrap()));
}

#[test]
fn an_unplugged_board_leaves_the_other_and_an_unplugged_floor_silence() {
    let during = |board| LinkFaults {
        outages: vec![Outage { board, from: Instant::from_millis(100), until: Instant::from_millis(300) }],
        ..LinkFaults::default()
    };
    let (packets, silences) = through(during(Some(1)), 1);
    assert_eq!((packets.len(), silences), (1800, 0));
    let (packets, silences) = through(during(None), 1);
    assert_eq!(packets.len(), 1600);
    assert!((19..=21).contains(&silences), "{silences} times 10 ms");
}

#[test]
fn a_stall_holds_everything_back_and_lets_it_go_at_once() {
    let until = Instant::from_millis(300);
    let faults = LinkFaults {
        stalls: vec![Stall { from: Instant::from_millis(100), until }],
        ..LinkFaults::default()
    };
    let (packets, _) = through(faults, 1);
    assert_eq!(packets.len(), 2000);
    assert_eq!(packets.iter().filter(|packet| packet.received == until).count(), 402);
}

#[test]
fn bursts_doubles_and_damage_do_what_they_say() {
    let bursts = Some(Bursts { every: Duration::from_millis(100), length: Duration::from_millis(20) });
    assert_eq!(through(LinkFaults { bursts, ..LinkFaults::default() }, 1).0.len(), 2000 - 9 * 2 * 20);
    assert_eq!(through(LinkFaults { duplicate: 1.0, ..LinkFaults::default() }, 1).0.len(), 4000);
    let (damaged, _) = through(LinkFaults { damage: 1.0, ..LinkFaults::default() }, 1);
    let whole: Vec<_> = boards().0.collect();
    assert!(damaged.iter().zip(&whole).all(|(damaged, whole)| damaged != whole));
}

#[test]
fn a_frozen_board_repeats_what_it_read_and_goes_on_as_it_is() {
    let (from, until) = (Instant::from_millis(100), Instant::from_millis(300));
    let frozen = vec![Outage { board: Some(1), from, until }];
    let mut source = FaultInjector::new(counting(), LinkFaults { frozen, ..LinkFaults::default() }, 1);
    let mut seen = Vec::new();
    while let Ok(packet) = source.next(Duration::from_millis(10)) {
        seen.extend(packet);
    }
    for packet in seen {
        let Readings::Counts(counts) = &packet.readings else { panic!("counts") };
        let stands = packet.board == 1 && (100..300).contains(&packet.sequence);
        assert_eq!(counts[0], Some(if stands { 100 } else { packet.sequence as u16 }), "{packet:?}");
    }
}

/// As [`boards`], with the sequence number as reading.
fn counting() -> Boards {
    let Boards(packets, now) = boards();
    let counted = packets.map(|mut packet| {
        packet.readings = Readings::Counts([Some(packet.sequence as u16); 4].into_iter().collect());
        packet
    });
    Boards(counted.collect::<Vec<_>>().into_iter(), now)
}

#[test]
fn swapped_boards_have_each_others_address() {
    let (packets, _) = through(LinkFaults { swapped: vec![(0, 1)], ..LinkFaults::default() }, 1);
    let boards: Vec<u16> = packets.iter().take(4).map(|packet| packet.board).collect();
    assert_eq!(boards, [1, 0, 1, 0]);
}
