//! A control on a border plays its cues on the tiles of both computers.

use std::net::{SocketAddr, UdpSocket};
use std::sync::mpsc::sync_channel;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use underfoot::feel::{RendererConfig, renderer};
use underfoot::floor::{Board, Corner, Floor, SensorId, TileId};
use underfoot::layout::Layout;
use underfoot::runtime::{Actuators, Session};
use underfoot::sink::{ActuatorSink, ManualSink, SinkError};
use underfoot::source::UdpSource;
use underfoot::units::Instant;
use underfoot_cluster::auth::{AuthRefusals, AuthSession, Key, Role};
use underfoot_cluster::node::{Border, BorderCounters, NeighbourSeal, NeighbourSession};

use crate::hall::{Boards, STANDS_STILL_MS, layout, listening, script};
use crate::steady::while_time_is_kept;

const RATE: u32 = 48_000;

/// Actuators with samples that a test can read.
#[derive(Clone)]
struct Seen(Arc<Mutex<Option<ManualSink>>>);

impl ActuatorSink for Seen {
    fn advance(&mut self, now: Instant) -> Result<(), SinkError> {
        self.0.lock().unwrap().as_mut().unwrap().advance(now)
    }
}

/// One computer of the hall, in this process.
struct Computer {
    session: Session,
    seen: Seen,
    counters: Arc<BorderCounters>,
    neighbours: NeighbourSession,
    part: Floor,
}

impl Computer {
    fn serve(floor: &Floor, layout: &Layout, id: &str, nonce: u64) -> Self {
        let area = floor.area(id).unwrap();
        let part = floor.part(area).unwrap();
        let (notes, noted) = sync_channel(1024);
        let source = UdpSource::bind(area.listen.unwrap(), &part).unwrap();
        let clock = source.clock();
        let key = Key::new([7; 32]);
        let neighbours =
            NeighbourSession::new(AuthSession::new(Role::Neighbour, &key, nonce, 8), Arc::clone(&clock));
        let seal = NeighbourSeal::new(neighbours.clone(), notes);
        let source = source.sealed_by(Box::new(seal), floor.forwarding_addresses(area));
        let (source, _) = source.forwarding(&floor.forwardings(area)).unwrap();
        let beside = Border::neighbours(floor, area);
        let to: Vec<SocketAddr> = beside.iter().filter_map(|area| area.listen).collect();
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        let (sealing, mut sealed) = (neighbours.clone(), Vec::new());
        let send = move |number: usize, note: &[u8]| {
            sealing.seal_note(note, &mut sealed);
            socket.send_to(&sealed, to[number]).is_ok()
        };
        let border = Border::new(floor, area, Box::new(send), noted);
        let counters = border.counters();
        let seen = Seen(Arc::default());
        let sink = seen.clone();
        let session = Session::source(source, clock)
            .floor(part.clone())
            .layout(layout.clone().part(area, &floor.geometry))
            .neighbours(border)
            .actuators(move |floor, start, _| {
                let (feel, renderer) = renderer(RendererConfig::of(floor, RATE));
                *sink.0.lock().unwrap() = Some(ManualSink::new(renderer, start));
                Ok(Actuators { feel, sink: Box::new(sink) })
            })
            .realtime()
            .start()
            .unwrap();
        Self { session, seen, counters, neighbours, part }
    }

    /// The largest sample that the actuator of a tile has played.
    fn peak(&self, tile: TileId) -> f32 {
        let index = self.part.geometry.index(tile).unwrap();
        let channel = self.part.actuators[index].unwrap().channel;
        let seen = self.seen.0.lock().unwrap();
        seen.as_ref().unwrap().channel(channel.into()).iter().fold(0.0, |peak, sample| peak.max(sample.abs()))
    }
}

#[test]
fn what_belongs_to_one_computer_is_felt_on_the_tiles_of_both() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let floor = listening();
        let layout = layout(&floor);
        let [west, east] =
            [("sw", 1), ("se", 2)].map(|(id, nonce)| Computer::serve(&floor, &layout, id, nonce));
        let homes = |board| vec![floor.home(board).unwrap().listen.unwrap()];
        let targets: Vec<_> = floor.boards.iter().map(homes).collect();
        let press = r#"Press(widget: "drive", force_n: 110, hold_ms: 300),"#;
        let steps = format!(
            r#"Wait(ms: 1500), Enter(from: South, at: (6.1, 2.2)), {press} {press} Leave(to: South)"#
        );
        let people = format!("Scenario(title: \"Drive\", steps: [{steps}])");
        Boards::start(&floor, script(&people, &floor, &layout), targets).finish();
        thread::sleep(Duration::from_millis(200));
        let given = east.counters.given();
        let west_tile = TileId::new(5, 3);
        let (felt, late) = (west.counters.felt(), west.counters.late());
        let other =
            (west.counters.lost(), west.counters.untimed(), west.counters.refused(), east.counters.unsent());
        assert!(given > 0 && felt > 0, "{given} given, {felt} felt, {late} late, {other:?}");
        // Cues later than 50 ms, on a busy machine, are counted.
        assert_eq!((felt + late, other), (given, (0, 0, 0, 0)));
        assert_eq!(west.counters.given(), 0, "the west's own controls have rested");
        // Datagrams become stale if the machine stalls for 250 ms.
        let stale =
            |of: &Computer| AuthRefusals { stale: of.neighbours.refusals().stale, ..AuthRefusals::default() };
        assert_eq!(west.neighbours.refusals(), stale(&west), "neighbours refuse nothing else of each other");
        assert_eq!(east.neighbours.refusals(), stale(&east));
        let peaks = [west.peak(west_tile), east.peak(TileId::new(6, 3)), west.peak(TileId::new(0, 0))];
        assert!(peaks[0] > 0.0 && peaks[1] > 0.0 && peaks[2] == 0.0, "{peaks:?}");
        west.session.stop();
        east.session.stop();
    });
}

/// The hall with a board for each row of tiles, which sends to the computer of the western area.
fn wide_boards() -> Floor {
    let mut floor = listening();
    let sensors = |tile| Corner::ALL.map(|corner| Some(SensorId { tile, corner }));
    let board = |row: u16| {
        let channels = (0..12).flat_map(|column| sensors(TileId::new(column, row))).collect();
        Board::new(format!("/underfoot/board/{row}"), channels)
    };
    floor.boards = (0..12).map(board).collect();
    floor
}

#[test]
fn an_area_is_sensed_by_boards_of_its_neighbour_alone() {
    while_time_is_kept(STANDS_STILL_MS, || {
        let floor = wide_boards();
        let layout = layout(&floor);
        let [west, east] =
            [("sw", 1), ("se", 2)].map(|(id, nonce)| Computer::serve(&floor, &layout, id, nonce));
        let homes = |board| vec![floor.home(board).unwrap().listen.unwrap()];
        let targets: Vec<_> = floor.boards.iter().map(homes).collect();
        assert!(targets.iter().flatten().all(|to| *to != floor.area("se").unwrap().listen.unwrap()));
        let empty = "Scenario(title: \"Empty\", steps: [Wait(ms: 20000)])";
        let _boards = Boards::start(&floor, script(empty, &floor, &layout), targets);
        let end = std::time::Instant::now() + Duration::from_secs(10);
        while east.session.snapshot().floor.counters.frames < 200 {
            let refused = east.neighbours.refusals();
            assert!(
                std::time::Instant::now() < end,
                "{:?}, {refused:?}",
                east.session.snapshot().floor.counters
            );
            thread::sleep(Duration::from_millis(20));
        }
        west.session.stop();
        east.session.stop();
    });
}
