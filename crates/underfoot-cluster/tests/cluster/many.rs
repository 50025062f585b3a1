//! The cost of a node does not depend on the number of nodes.

use std::fs;
use std::net::{SocketAddr, UdpSocket};
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use underfoot::floor::{Area, Board, Corner, Floor, Geometry, SensorId, TileBlock, TileId};
use underfoot::schema;
use underfoot::sink::{Rank, claim_priority};
use underfoot::source::{SensorSource, SourceError};
use underfoot::wire::{SensorEncoder, SensorFormat};
use underfoot_lab::plan::{AreaDemand, Crowd, Machine, measure};
use underfoot_sim::{Pace, SimConfig, SimFloor, SimulatedSource, calibrated};

use crate::hall::{Program, say, script};
use crate::ports::free_port;

/// Tiles along the side of an area.
const SIDE: u16 = 6;

/// People in each area.
const PEOPLE: u16 = 2;

/// Length of the measurement, in seconds of the floor.
const SECONDS: u64 = 10;

/// Seconds before it, in which the nodes settle.
const WARM_UP: u64 = 4;

/// A corridor of `count` areas, each with three boards of its own.
fn corridor(count: u16) -> Floor {
    let area = |number: u16| {
        let tiles = TileBlock { first: TileId::new(SIDE * number, 0), columns: SIDE, rows: SIDE };
        let listen = Some(([127, 0, 0, 1], free_port()).into());
        Area { listen, ..Area::new(&format!("a{number}"), tiles) }
    };
    let board = |number: u16| {
        let (west, south) = (number / 3 * SIDE, number % 3 * 2);
        let tiles = (0..2 * SIDE).map(|tile| TileId::new(west + tile % SIDE, south + tile / SIDE));
        let sensors = |tile| Corner::ALL.map(|corner| Some(SensorId { tile, corner }));
        Board::new(format!("/underfoot/board/{number}"), tiles.flat_map(sensors).collect())
    };
    let mut floor = Floor::of(Geometry::of_paper_tiles(SIDE * count, SIDE).unwrap())
        .with_areas((0..count).map(area).collect());
    floor.boards = (0..3 * count).map(board).collect();
    let sim = SimFloor::new(&floor, SimConfig::default(), 1);
    let mut floor = calibrated(&floor, &sim, 1).unwrap();
    floor.gateway = Some(([127, 0, 0, 1], free_port()).into());
    floor
}

/// People who walk to and fro in each area for the whole measurement.
fn crowd(count: u16) -> String {
    let person = |number: u16| {
        let (west, row) = (f32::from(number / PEOPLE * SIDE) + 1.0, 1.5 + 2.5 * f32::from(number % PEOPLE));
        let round = format!("WalkTo(at: ({}, {row})), WalkTo(at: ({west}, {row})),", west + 4.0);
        format!("steps: [Enter(from: South, at: ({west}, {row})), {}]", round.repeat(12))
    };
    let others: Vec<String> = (1..PEOPLE * count).map(|number| format!("({})", person(number))).collect();
    format!("Scenario(title: \"Corridor\", {}, others: [{}])", person(0), others.join(", "))
}

/// CPU time of a process in nanoseconds: of all its threads, and of the sensing thread.
fn ran_ns(process: u32) -> (u64, u64) {
    let (mut all, mut sensing) = (0, 0);
    for task in fs::read_dir(format!("/proc/{process}/task")).unwrap() {
        let task = task.unwrap().path();
        let text = |name: &str| fs::read_to_string(task.join(name)).unwrap_or_default();
        let ran = text("schedstat").split_whitespace().next().and_then(|ns| ns.parse().ok()).unwrap_or(0_u64);
        all += ran;
        if text("comm").trim() == "sensing" {
            sensing += ran;
        }
    }
    (all, sensing)
}

/// Sends the boards' packets for the seconds of the floor, each millisecond of which takes `slow` and goes out at
/// once; calls `at` at each second.
fn send(floor: &Floor, count: u16, slow: u32, mut at: impl FnMut(u64)) {
    let layout = underfoot::layout::Layout::default();
    let people = script(&crowd(count), floor, &layout);
    let sim = SimFloor::new(floor, SimConfig::default(), 1);
    let mut source = SimulatedSource::new(sim, Box::new(people), Pace::FreeRunning);
    let mut encoder = SensorEncoder::new(floor, SensorFormat::Blob);
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let homes: Vec<SocketAddr> =
        floor.boards.iter().map(|board| floor.home(board).unwrap().listen.unwrap()).collect();
    // Boards are punctual.
    claim_priority(Rank::Sensing);
    let (begun, mut second, mut behind) = (Instant::now(), 0, Duration::ZERO);
    let (mut now, mut datagrams) = (0, Vec::<(Vec<u8>, SocketAddr)>::new());
    loop {
        let packet = match source.next(Duration::from_millis(1)) {
            Ok(Some(packet)) => packet,
            Ok(None) => continue,
            Err(SourceError::Ended) => break,
            Err(error) => panic!("{error}"),
        };
        let time = packet.received.micros();
        if time > now {
            let due = Duration::from_micros(now) * slow;
            let elapsed = begun.elapsed();
            match due.checked_sub(elapsed) {
                Some(early) => thread::sleep(early),
                None => behind = behind.max(elapsed.saturating_sub(due)),
            }
            for (datagram, home) in datagrams.drain(..) {
                socket.send_to(&datagram, home).unwrap();
            }
            now = time;
        }
        datagrams.push((encoder.encode(&packet).unwrap().to_vec(), homes[usize::from(packet.board)]));
        if time / 1_000_000 > second {
            second = time / 1_000_000;
            at(second);
            if second > WARM_UP + SECONDS {
                break;
            }
        }
    }
    say(&format!("  boards at most {:.0} ms behind", behind.as_secs_f64() * 1e3));
}

/// The cost of a node for each millisecond of the floor, in microseconds of a core.
#[derive(Clone, Copy, Debug)]
struct Cost {
    /// All of its threads.
    all: f64,
    /// The thread that senses, decides and forwards.
    sensing: f64,
    /// The forecast of `underfoot plan` for that thread.
    forecast: f64,
}

/// The mean over nodes; `None` of none.
fn mean(costs: &[Cost]) -> Option<Cost> {
    let of = |one: fn(&Cost) -> f64| costs.iter().map(one).sum::<f64>() / costs.len() as f64;
    let mean = Cost {
        all: of(|cost| cost.all),
        sensing: of(|cost| cost.sensing),
        forecast: of(|cost| cost.forecast),
    };
    (!costs.is_empty()).then_some(mean)
}

/// The costs of the nodes at the ends of a corridor, and of those between two others.
#[derive(Clone, Copy, Debug)]
struct Costs {
    end: Cost,
    between: Option<Cost>,
}

/// Starts `count` nodes and their gateway, and measures their costs.
fn measure_nodes(folder: &Path, count: u16, slow: u32, machine: &Machine) -> Costs {
    let floor = corridor(count);
    fs::write(folder.join("corridor.ron"), schema::write_floor(&floor)).unwrap();
    let (slowness, notices) = (slow.to_string(), Arc::<Mutex<Vec<String>>>::default());
    let gateway =
        Program::start(folder, &["gateway", "--floor", "corridor.ron", "--slow", &slowness], &notices);
    let nodes: Vec<Program> = floor
        .areas
        .iter()
        .map(|area| {
            // Without a sound card with its own thread, the sensing thread would render too.
            let node = ["node", "--floor", "corridor.ron", "--area", &area.id, "--device", "paced"];
            let node = [&node[..], &["--slow", &slowness]].concat();
            Program::start(folder, &node, &notices)
        })
        .collect();
    let all = || -> Vec<(u64, u64)> {
        nodes.iter().chain([&gateway]).map(|program| ran_ns(program.0.id())).collect()
    };
    let (mut before, mut after) = (Vec::new(), Vec::new());
    send(&floor, count, slow, |second| match second {
        WARM_UP => before = all(),
        _ if second == WARM_UP + SECONDS => after = all(),
        _ => {}
    });
    let us = |ns: u64| ns as f64 / 1e6 / SECONDS as f64;
    let crowd = Crowd { crowding: 1.0, format: SensorFormat::Blob, ..Crowd::of(u32::from(PEOPLE * count)) };
    let mut costs: Vec<Cost> = before
        .iter()
        .zip(&after)
        .enumerate()
        .map(|(number, ((all, sensing), (all_after, sensing_after)))| {
            let demand = floor.areas.get(number).map(|area| AreaDemand::of(&floor, area, &crowd));
            let forecast = demand.map_or(0.0, |demand| 1e3 * demand.sensing_cores(machine));
            Cost { all: us(all_after - all), sensing: us(sensing_after - sensing), forecast }
        })
        .collect();
    let gateway = costs.pop().unwrap();
    let (first, rest) = costs.split_first().unwrap();
    let (last, inner) = rest.split_last().unwrap_or((first, &[]));
    let costs = Costs { end: mean(&[*first, *last]).unwrap(), between: mean(inner) };
    say(&format!("{count} nodes, {slow} times slower than real time; gateway {:.0} us", gateway.all));
    for (place, cost) in [("at an end", Some(costs.end)), ("between", costs.between)] {
        let Some(Cost { all, sensing, forecast }) = cost else { continue };
        let off = 100.0 * (forecast / sensing - 1.0);
        say(&format!(
            "  node {place}: {all:.1} us, of which sensing {sensing:.1}; forecast {forecast:.1}, {off:+.0} %"
        ));
    }
    let counted = |text: &str| notices.lock().unwrap().iter().filter(|line| line.contains(text)).count();
    // Lost or late packets on a busy machine do not raise a node's cost; the test prints them.
    let (live, lost) = (counted("is live"), counted("is lost"));
    say(&format!("  areas live {live} times, lost {lost} times"));
    assert!(live >= usize::from(count), "{:?}", notices.lock().unwrap());
    costs
}

/// The constants of a computer: those of the file in `UNDERFOOT_MACHINE`, as `underfoot plan --json` prints them, or
/// this computer's, measured with this build.
fn machine() -> Machine {
    let Ok(path) = std::env::var("UNDERFOOT_MACHINE") else {
        return measure(Duration::from_secs(1), || {}).unwrap();
    };
    let text = fs::read_to_string(path).unwrap();
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    serde_json::from_value(value.get("machine").unwrap_or(&value).clone()).unwrap()
}

/// In real time: a thread that sleeps for longer between packets costs more at each wake-up.
#[test]
#[ignore = "a minute, on a machine that does nothing else"]
fn a_node_costs_what_is_forecast() {
    let machine = machine();
    say(&format!("{machine:?}"));
    let folder = tempfile::tempdir().unwrap();
    let [one, four] = [1, 4].map(|count| measure_nodes(folder.path(), count, 1, &machine));
    for cost in [one.end, four.end, four.between.unwrap()] {
        let off = cost.forecast / cost.sensing - 1.0;
        assert!(off.abs() <= 0.25, "forecast {:+.0} % off: {cost:?}", 100.0 * off);
    }
}

/// `UNDERFOOT_SLOW` sets the factor by which the floors run slower than real time, so that sixteen fit on a machine.
#[test]
#[ignore = "two minutes, on a machine that does nothing else"]
fn a_node_of_sixteen_costs_what_one_of_four_costs() {
    let machine = machine();
    let slow = std::env::var("UNDERFOOT_SLOW").ok().and_then(|text| text.parse().ok()).unwrap_or(4);
    let folder = tempfile::tempdir().unwrap();
    let [four, sixteen] = [4, 16].map(|count| measure_nodes(folder.path(), count, slow, &machine));
    let grows = |few: Cost, many: Cost| many.all / few.all;
    let (few, many) = (four.between.unwrap(), sixteen.between.unwrap());
    let (ends, between) = (grows(four.end, sixteen.end), grows(few, many));
    say(&format!("16 nodes against 4: at the ends {ends:.2}, between {between:.2}"));
    assert!(ends < 1.25 && between < 1.25, "{four:?} {sixteen:?}");
}
