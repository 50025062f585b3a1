//! The inputs from which the mutator starts.

use std::path::Path;

use underfoot::floor::Floor;
use underfoot::schema;
use underfoot_sim::{self as sim, SimConfig, SimFloor};
use underfoot::units::Instant;
use underfoot::wire::{SensorEncoder, SensorFormat, SensorPacket};

/// The corpus of a target.
pub fn of(target: &str) -> Vec<Vec<u8>> {
    let mut inputs = Vec::new();
    match target {
        "datagrams" => inputs.extend(datagrams()),
        "layouts" => {
            files("../layouts", &mut inputs);
            files("../widgets", &mut inputs);
            files("../tests/broken_layouts", &mut inputs);
        }
        "effects" => files("../effects", &mut inputs),
        "floors" => inputs.extend(floors()),
        "scenarios" => files("../src/sim/scenarios", &mut inputs),
        "csv" => inputs.extend(tables()),
        _ => {}
    }
    files(&format!("corpus/{target}"), &mut inputs);
    // The input of a seed must not depend on the order in which a folder lists its files.
    inputs.sort();
    inputs
}

/// The files of a folder of this repository, if it is there, without the messages beside broken layouts.
fn files(folder: &str, inputs: &mut Vec<Vec<u8>>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    for entry in folder.read_dir().into_iter().flatten().flatten() {
        let path = entry.path();
        if path.extension().is_none_or(|extension| extension != "stderr") {
            inputs.extend(std::fs::read(path));
        }
    }
}

/// The packets of boards in each format, as messages and bundled, and the requests of apps.
fn datagrams() -> Vec<Vec<u8>> {
    let floor = Floor::default();
    let sim = SimFloor::new(&floor, SimConfig::default(), 1);
    let mut datagrams = Vec::new();
    for format in [SensorFormat::Counts, SensorFormat::Newtons, SensorFormat::Blob] {
        let mut encoder = SensorEncoder::new(&floor, format);
        for (board, readings) in (0..).zip(sim.readings()) {
            let packet =
                SensorPacket { board, sequence: 7, received: Instant::START, readings: readings.clone() };
            datagrams.extend(encoder.encode(&packet).map(<[u8]>::to_vec));
        }
    }
    let bundled: Vec<u8> =
        datagrams.iter().take(6).fold(b"#bundle\0\0\0\0\0\0\0\0\x01".to_vec(), |mut all, one| {
            all.extend((one.len() as u32).to_be_bytes());
            all.extend(one);
            all
        });
    datagrams.push(bundled);
    for (address, tags, arguments) in [
        ("/underfoot/widget/zoom/set", ",f", &[0x3f, 0, 0, 0][..]),
        ("/underfoot/widget/*/enable", ",i", &[0, 0, 0, 1]),
        ("/underfoot/widget/home/label", ",s", b"hi\0\0"),
        ("/underfoot/widget/[a-z]?{oom,ome}/get", ",", &[]),
        ("/underfoot/page", ",s", b"map\0"),
        ("/underfoot/mute/set", ",T", &[]),
        ("/underfoot/get", ",", &[]),
    ] {
        let mut message = Vec::new();
        for text in [address, tags] {
            message.extend(text.bytes());
            message.resize(message.len() + 4 - text.len() % 4, 0);
        }
        message.extend(arguments);
        datagrams.push(message);
    }
    datagrams
}

/// Floor files, plain and calibrated.
fn floors() -> Vec<Vec<u8>> {
    let wired =
        Floor::of(underfoot::floor::Geometry::of_paper_tiles(3, 2).unwrap_or(Floor::default().geometry));
    let sim = SimFloor::new(&wired, SimConfig::default(), 1);
    let calibrated = sim::calibrated(&wired, &sim, 1).ok();
    [Some(Floor::default()), Some(wired), calibrated]
        .into_iter()
        .flatten()
        .map(|floor| schema::write_floor(&floor).into_bytes())
        .collect()
}

/// Tables of a laboratory, shortened, and of forces.
fn tables() -> Vec<Vec<u8>> {
    let floor = Floor::default();
    let sim = SimFloor::new(&floor, SimConfig::default(), 1);
    let cut =
        |text: String| text.lines().take(60).fold(String::new(), |all, line| all + line + "\n").into_bytes();
    vec![cut(sim::load_table(&sim, 1)), cut(sim::press_table(&floor, &sim, 1))]
}
