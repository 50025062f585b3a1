//! The shipped floors, and plates of any shape: from a simulated foot to a pressed button.

use std::fs;
use std::path::Path;
use std::time::Duration;

use underfoot::engine::{Engine, Snapshot};
use underfoot::floor::{Floor, Geometry, OwnPlate, SensorPlaces, TileBlock, TileId};
use underfoot::glam::Vec2;
use underfoot::schema::{
    Kinds, builtin_floor, builtin_floors, load_floor, parse_floor, parse_layout, write_floor,
};
use underfoot::sense::{Assembler, ForceFrame, Method, Quality, Sensing};
use underfoot::units::{Instant, Newtons};
use underfoot::widget::EventKind;
use underfoot::wire::SensorPacket;
use underfoot_sim::{self as sim, Foot, Load, Print, SimConfig, SimFloor};

use super::layout::ron_files;

/// A floor of ideal sensors, and a page on it.
struct Stage {
    engine: Engine,
    assembler: Assembler,
    sim: SimFloor,
    now: Instant,
    events: Vec<(u64, String, EventKind)>,
}

impl Stage {
    fn new(floor: &Floor, config: SimConfig, page: &str) -> Self {
        Self::of_parts(floor, config, page, 3)
    }

    /// Like [`Stage::new`], with other random parts.
    fn of_parts(floor: &Floor, config: SimConfig, page: &str, seed: u64) -> Self {
        let sim = SimFloor::new(floor, config, seed);
        let floor = sim::calibrated(floor, &sim, seed).unwrap();
        let layout = parse_layout(page, "page", &Kinds::builtin(), &floor.geometry);
        let layout = layout.unwrap_or_else(|problems| panic!("{problems}")).layout;
        let mut stage = Self {
            engine: Engine::new(floor.geometry, layout, Method::default()),
            assembler: Assembler::new(&floor),
            sim,
            now: Instant::START,
            events: Vec::new(),
        };
        stage.run(200, |_| Vec::new());
        stage.events.clear();
        stage
    }

    /// Advances time under the loads that `loads` returns for each millisecond.
    fn run(&mut self, millis: u64, mut loads: impl FnMut(u64) -> Vec<Load>) {
        for ms in 0..millis {
            self.now = self.now + Duration::from_millis(1);
            let sequence = (self.now.micros() / 1000) as u32;
            for (board, readings) in (0..).zip(self.sim.step_under(loads(ms))) {
                let readings = readings.clone();
                self.assembler.take(&SensorPacket { board, sequence, received: self.now, readings });
            }
            while let Some(frame) = self.assembler.ready() {
                let at = frame.at.micros() / 1000;
                let step = self.engine.step(frame);
                let events = step.events.iter();
                self.events.extend(events.map(|event| (at, event.id.as_str().to_owned(), event.kind)));
            }
        }
    }

    fn snapshot(&self) -> Snapshot {
        let mut snapshot = Snapshot::default();
        self.engine.snapshot(&mut snapshot);
        snapshot
    }

    /// Times at which controls were pressed, with their ids.
    fn presses(&self) -> Vec<(u64, &str)> {
        let presses = self.events.iter().filter(|(_, _, kind)| matches!(kind, EventKind::Pressed));
        presses.map(|(at, id, _)| (*at, id.as_str())).collect()
    }

    /// Time and centroid of the whole load, in floor metres.
    fn centre(&self) -> Option<Vec2> {
        let contacts = self.snapshot().contacts;
        let force: f32 = contacts.iter().map(|contact| contact.force.0).sum();
        let moment: Vec2 = contacts.iter().map(|contact| contact.centroid * contact.force.0).sum();
        (force > 0.0).then(|| moment / force)
    }
}

fn shipped(name: &str) -> Floor {
    parse_floor(builtin_floor(name).unwrap(), name).unwrap_or_else(|problems| panic!("{problems}"))
}

fn disc(position: Vec2, force: f32) -> Load {
    Load { print: Print::Disc { radius_m: 0.04 }, position, heading: 0.0, force: Newtons(force) }
}

/// A button on each tile of `geometry`, called by its column and row.
fn a_button_on_each(geometry: &Geometry) -> String {
    let bounds = geometry.bounds().size();
    let buttons = geometry.tiles().filter(|tile| geometry.has(*tile)).map(|tile| {
        let (at, size) = (geometry.cell(tile).min + 0.02, geometry.pitch_m() - 0.04);
        let (column, row) = (tile.column, tile.row);
        format!(
            "(id: \"b_{column}_{row}\", kind: \"button\", label: \"B\", dwell_ms: 0, at: ({}, {}), size: ({}, {}))",
            at.x, at.y, size.x, size.y
        )
    });
    format!(
        "Layout(version: 1, title: \"all\", units: Metres, regions: [(id: \"all\", at: (0, 0), size: ({}, {}))],
            widgets: [{}])",
        bounds.x,
        bounds.y,
        buttons.collect::<Vec<_>>().join(",\n")
    )
}

#[test]
fn every_shipped_floor_is_read_here_and_by_any_other_reader_of_ron() {
    let files = ron_files("floors");
    assert_eq!(files.len(), builtin_floors().count());
    let options = ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
    for path in files {
        let name = path.file_stem().unwrap().to_str().unwrap();
        let floor = load_floor(&path).unwrap_or_else(|problems| panic!("{problems}"));
        assert_eq!(floor, shipped(name));
        assert_eq!(parse_floor(&write_floor(&floor), name), Ok(floor));
        let text = fs::read_to_string(&path).unwrap();
        assert!(options.from_str::<serde::de::IgnoredAny>(&text).is_ok(), "{name}");
    }
    assert_eq!(shipped("paper"), Floor::default());
    let board = shipped("balance_board").geometry;
    let span = board.sensor_places(board.first()).rectangle().unwrap() * 2.0;
    assert!(span.distance(Vec2::new(0.433, 0.238)) < 1e-6, "{span}");
    assert_eq!(shipped("load_cells").boards[0].channels.len(), 12);
    assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join("floors/paper.ron").exists());
}

#[test]
fn a_foot_presses_the_button_of_each_panel_of_each_floor_and_no_other() {
    for name in builtin_floors() {
        let floor = shipped(name);
        let page = a_button_on_each(&floor.geometry);
        let mut stage = Stage::new(&floor, SimConfig::default(), &page);
        for tile in floor.geometry.tiles() {
            stage.events.clear();
            let at = floor.geometry.centre(tile) + Vec2::new(0.02, -0.01);
            stage.run(300, |ms| vec![disc(at, (4.0 * ms as f32).min(250.0))]);
            stage.run(300, |ms| vec![disc(at, (250.0 - 4.0 * ms as f32).max(0.0))]);
            stage.run(400, |_| Vec::new());
            let pressed: Vec<_> = stage.presses().into_iter().map(|(_, id)| id.to_owned()).collect();
            assert_eq!(pressed, [format!("b_{}_{}", tile.column, tile.row)], "{name}");
        }
    }
}

#[test]
fn a_panel_of_a_dance_pad_is_pressed_within_a_millisecond_and_released_within_six() {
    let floor = shipped("dance_pad");
    let page = a_button_on_each(&floor.geometry);
    let mut stage = Stage::new(&floor, SimConfig::ideal(), &page);
    for tile in floor.geometry.tiles() {
        stage.events.clear();
        let (at, begun) = (floor.geometry.centre(tile), stage.now.micros() / 1000);
        // 2 N a millisecond: the button's 60 N after 30 ms; from 160 N, which is no step yet, down again: its 40 N
        // after 60 ms.
        stage.run(80, |ms| vec![disc(at, 2.0 * (ms + 1) as f32)]);
        let top = stage.now.micros() / 1000;
        stage.run(400, |ms| vec![disc(at, (160.0 - 2.0 * (ms + 1) as f32).max(0.0))]);
        let times = |wanted: fn(&EventKind) -> bool| {
            stage.events.iter().filter(|(_, _, kind)| wanted(kind)).map(|(at, ..)| *at).collect::<Vec<_>>()
        };
        let pressed = times(|kind| matches!(kind, EventKind::Pressed));
        let released = times(|kind| matches!(kind, EventKind::Released));
        assert_eq!((pressed.len(), released.len()), (1, 1), "{tile}: {:?}", stage.events);
        assert!(pressed[0].abs_diff(begun + 30) <= 1, "{tile}: pressed {} ms after", pressed[0] - begun);
        assert!(
            (top + 59..=top + 66).contains(&released[0]),
            "{tile}: released {} ms after",
            released[0] - top
        );
    }
}

/// A person of 70 kg who stands on a board of 51 cm, and sways: loads of both feet after `ms` milliseconds.
fn standing(ms: u64) -> [Load; 2] {
    let t = ms as f32 / 1000.0;
    // Quiet standing: about a centimetre, slowly, and weight that shifts from foot to foot.
    let sway = Vec2::new(
        0.004 * (0.9 * t).sin() + 0.003 * (2.3 * t + 1.0).sin(),
        0.008 * (0.7 * t + 2.0).sin() + 0.004 * (1.9 * t).sin(),
    );
    let middle = Vec2::new(0.2555, 0.158) + sway;
    let east = 0.5 + 0.06 * (0.4 * t).sin();
    let foot = |side: f32, share: f32| Foot {
        position: middle + Vec2::new(side, -0.01),
        heading: 0.0,
        length_m: 0.26,
        force: Newtons(687.0 * share),
        roll: 0.4,
        left: side < 0.0,
    };
    [foot(-0.09, 1.0 - east), foot(0.09, east)].map(|foot| foot.as_load())
}

#[test]
fn a_person_who_stands_on_a_balance_board_presses_nothing_beside_the_own_centre_of_pressure() {
    // Buttons at both ends, beyond any sway.
    let page = "Layout(version: 1, title: \"board\", units: Metres,
        regions: [(id: \"all\", at: (0, 0), size: (0.511, 0.316))],
        widgets: [
            (id: \"west\", kind: \"button\", at: (0, 0), size: (0.15, 0.316), label: \"W\", dwell_ms: 0),
            (id: \"east\", kind: \"button\", at: (0.361, 0), size: (0.15, 0.316), label: \"E\", dwell_ms: 0),
        ])";
    let floor = shipped("balance_board");
    let mut stage = Stage::new(&floor, SimConfig::ideal(), page);
    let mut worst = 0.0f32;
    for ms in 0..60_000 {
        // Stepping on, in a quarter of a second.
        let share = (ms as f32 / 250.0).min(1.0);
        let loads = standing(ms).map(|load| Load { force: load.force * share, ..load });
        stage.run(1, |_| loads.to_vec());
        if ms > 500 {
            let on_plate = loads.iter().flat_map(|load| stage.sim.carried(load));
            let (force, moment) = on_plate.fold((0.0, Vec2::ZERO), |(force, moment), part| {
                (force + part.force.0, moment + part.centroid * part.force.0)
            });
            worst = worst.max(stage.centre().unwrap().distance(moment / force));
        }
    }
    assert_eq!(stage.presses(), [] as [(u64, &str); 0]);
    assert!(worst < 1e-4, "sway off by {} mm", 1e3 * worst);
}

/// Median and 95th percentile of the distance between the place of a load and the contact on a plate of 50 cm (cm).
fn errors_cm(places: &[Vec2], force: f32) -> [f32; 2] {
    let places = SensorPlaces::at(places).unwrap();
    let geometry = Geometry::new(1, 1, 0.5, 0.5, 0.0).unwrap().with_sensors(places).unwrap();
    let page = "Layout(version: 1, title: \"empty\", units: Metres, regions: [(id: \"all\", at: (0, 0), size: (0.5, 0.5))], widgets: [])";
    let mut errors = Vec::new();
    for seed in 0..20_u16 {
        let floor = Floor::of(geometry);
        let mut stage = Stage::of_parts(&floor, SimConfig::default(), page, seed.into());
        for step in 0..12_u16 {
            let spread = |by: f32| (f32::from(step + 31 * seed) * by).fract() - 0.5;
            // Within all triangles and squares of sensors.
            let at = Vec2::splat(0.25) + Vec2::new(0.2 * spread(0.7549), 0.2 * spread(0.5698));
            stage.run(120, |_| vec![disc(at, force)]);
            errors.extend(stage.centre().map(|found| 100.0 * found.distance(at)));
            stage.run(120, |_| Vec::new());
        }
    }
    assert!(errors.len() >= 235, "{} of 240 found", errors.len());
    errors.sort_by(f32::total_cmp);
    [50, 95].map(|percent| errors[errors.len() * percent / 100])
}

#[test]
fn a_plate_on_three_legs_places_a_foot_within_two_and_a_half_times_the_error_of_four() {
    let three = [(-0.21, -0.19), (0.21, -0.19), (0.0, 0.21)].map(Vec2::from);
    let four = [(-0.21, -0.21), (0.21, -0.21), (-0.21, 0.21), (0.21, 0.21)].map(Vec2::from);
    for force in [100.0, 400.0] {
        let [[three, most_three], [four, most_four]] =
            [&three[..], &four[..]].map(|legs| errors_cm(legs, force));
        println!(
            "{force} N, median and 95 %: three legs {three:.2} and {most_three:.2} cm, four {four:.2} and {most_four:.2}"
        );
        assert!(
            three < 1.6 * four && most_three < 1.6 * most_four,
            "{three} and {most_three} cm at {force} N"
        );
        assert!(most_four < 4.0, "{most_four} cm");
    }
}

#[test]
fn a_plate_on_three_legs_stops_with_one_of_its_sensors_and_one_on_four_goes_on() {
    for (name, goes_on) in [("load_cells", false), ("dance_pad", true)] {
        let geometry = shipped(name).geometry;
        let mut frame = ForceFrame::empty(&geometry);
        frame.add_load(&geometry, geometry.centre(TileId::new(0, 0)), Newtons(200.0));
        frame.quality[0][1] = Quality::Faulty;
        let mut sensing = Sensing::new(geometry, Method::default());
        for ms in 1..200 {
            frame.at = Instant::from_millis(ms);
            sensing.update(&frame);
        }
        assert_eq!(!sensing.update(&frame).is_empty(), goes_on, "{name}");
    }
}

#[test]
fn a_foot_beside_a_hole_is_one_foot_on_its_tile_and_nobody_stands_in_the_hole() {
    let hole = TileBlock { first: TileId::new(1, 1), columns: 1, rows: 1 };
    let ring = Geometry::of_paper_tiles(3, 3).unwrap().with_uneven(&[hole], &[]).unwrap();
    let floor = Floor::of(ring);
    assert_eq!(floor.boards.iter().map(|board| board.channels.len()).sum::<usize>(), 32);
    assert_eq!(floor.channel_count(), 8);
    let mut stage = Stage::new(&floor, SimConfig::ideal(), &a_button_on_each(&ring));
    // Across the seam of the western tiles, its edge over the hole.
    let at = Vec2::new(0.26, 0.304);
    stage.run(400, |ms| vec![disc(at, (4.0 * ms as f32).min(300.0))]);
    let contacts = stage.snapshot().contacts;
    assert_eq!(contacts.len(), 1);
    assert!(contacts[0].centroid.distance(at) < 0.02, "{}", contacts[0].centroid);
    stage.run(300, |_| vec![disc(Vec2::splat(0.456), 300.0)]);
    stage.run(300, |_| vec![disc(Vec2::splat(0.456), 300.0)]);
    assert!(stage.snapshot().contacts.is_empty());
}

#[test]
fn plates_of_several_sizes_work_on_one_floor() {
    let three = [(-0.1, -0.09), (0.1, -0.09), (0.0, 0.1)].map(Vec2::from);
    let small = OwnPlate {
        tile: TileId::new(1, 0),
        size: Vec2::new(0.26, 0.24),
        sensors: SensorPlaces::at(&three).unwrap(),
    };
    let geometry = Geometry::of_plates(2, 1, Vec2::new(0.4, 0.3), Vec2::new(0.42, 0.32), 0.03);
    let geometry = geometry.unwrap().with_uneven(&[], &[small]).unwrap();
    let floor = Floor::of(geometry);
    assert_eq!(parse_floor(&write_floor(&floor), "floor.ron"), Ok(floor.clone()));
    let mut stage = Stage::new(&floor, SimConfig::ideal(), &a_button_on_each(&geometry));
    for tile in geometry.tiles() {
        let at = geometry.centre(tile) + Vec2::new(-0.01, 0.02);
        stage.run(300, |_| vec![disc(at, 200.0)]);
        assert!(stage.centre().unwrap().distance(at) < 1e-3, "{tile}");
        stage.run(300, |_| Vec::new());
    }
    let pressed: Vec<_> = stage.presses().into_iter().map(|(_, id)| id.to_owned()).collect();
    assert_eq!(pressed, ["b_0_0", "b_1_0"]);
}
