//! Machine-made files: shipped ones with random damage, and random floors.

use std::fs;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use underfoot::feel::{Clicks, EffectKind};
use underfoot::floor::{
    Actuator, Board, Calibration, CalibrationRecord, Corner, Day, Floor, Geometry, LawKind, MapRecord,
    PositionMap, SensorId,
};
use underfoot::layout::Layout;
use underfoot::schema::{
    Diagnostics, Kinds, Severity, builtin_layout, builtin_layouts, load_floor, load_layout, parse_floor,
    write_floor,
};
use underfoot::units::Newtons;
use underfoot::widget::Behaviour;
use underfoot_scene::ergonomics;

/// One change of a file.
#[derive(Clone, Debug)]
enum Edit {
    /// One bit is inverted.
    Flip(Index, u8),
    /// A range is lost.
    Delete(Index, Index),
    /// A range is doubled.
    Repeat(Index, Index),
    /// A text is inserted.
    Insert(Index, &'static str),
}

/// Texts that users type into files.
const TYPED: &[&str] = &[
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ",",
    ":",
    "\"",
    "'",
    "“",
    "//",
    "/*",
    "*/",
    "#",
    "r#\"",
    "\\",
    "=",
    ";",
    ".",
    "-",
    "NaN",
    "1e400",
    "None",
    "Some(",
    "id",
    "\u{feff}",
    "\u{a0}",
    "ß",
    "\r\n",
    "\n",
    "\0",
    "\"\"",
    "()",
    "version: 2,",
    "at: (9, 9),",
    "press_n: 20,",
    "#![enable(implicit_some)]",
];

fn edit() -> impl Strategy<Value = Edit> {
    prop_oneof![
        (any::<Index>(), 0..8_u8).prop_map(|(at, bit)| Edit::Flip(at, bit)),
        (any::<Index>(), any::<Index>()).prop_map(|(from, to)| Edit::Delete(from, to)),
        (any::<Index>(), any::<Index>()).prop_map(|(from, to)| Edit::Repeat(from, to)),
        (any::<Index>(), select(TYPED)).prop_map(|(at, text)| Edit::Insert(at, text)),
        // Typing is the most frequent change.
        (any::<Index>(), select(TYPED)).prop_map(|(at, text)| Edit::Insert(at, text)),
    ]
}

fn edited(bytes: &[u8], edits: Vec<Edit>) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for edit in edits {
        let length = bytes.len().max(1);
        // Long ranges would leave little of the file.
        let stretch = |from: Index, to: Index| {
            let from = from.index(length);
            from..(from + to.index(60)).min(bytes.len())
        };
        match edit {
            Edit::Flip(at, bit) => {
                if let Some(byte) = bytes.get_mut(at.index(length)) {
                    *byte ^= 1 << bit;
                }
            }
            Edit::Delete(from, to) => drop(bytes.drain(stretch(from, to))),
            Edit::Repeat(from, to) => {
                let stretch = stretch(from, to);
                let copy = bytes[stretch.clone()].to_vec();
                bytes.splice(stretch.start..stretch.start, copy);
            }
            Edit::Insert(at, text) => {
                let at = at.index(bytes.len() + 1);
                bytes.splice(at..at, text.bytes());
            }
        }
    }
    bytes
}

/// The invariants on which the engine relies, for any file.
fn check_layout(layout: &Layout) {
    let floor = Geometry::default().bounds().grown(1e-4);
    for (index, widget) in layout.widgets.iter().enumerate() {
        let id = &widget.id;
        assert_eq!(layout.widget_index(id.as_str()), Some(index), "two are named {id}");
        assert!(widget.area.size().min_element() > 0.0, "{id}");
        assert!(floor.contains(widget.area.min) && floor.contains(widget.area.max), "{id}");
        assert!(layout.regions[widget.region].area.grown(1e-4).contains(widget.area.centre()), "{id}");
        let thresholds = widget.behaviour.thresholds();
        assert!(thresholds.release < thresholds.press && thresholds.press.0 <= 1000.0, "{id}");
        if let Behaviour::Slider(slider) = widget.behaviour {
            let scale = slider.scale;
            assert!(scale.min < scale.max && scale.step >= 0.0, "{id}");
            assert!((scale.min..=scale.max).contains(&slider.initial), "{id}");
        }
        for effect in [&widget.feel.press, &widget.feel.release].into_iter().flatten() {
            let EffectKind::Click(Clicks { press: click, .. }) = &effect.kind else { continue };
            assert!(click.level.is_finite() && !click.modes.is_empty(), "{id}");
            assert!(click.modes.iter().all(|mode| (20.0..=1000.0).contains(&mode.frequency_hz)), "{id}");
        }
    }
}

/// Errors have a text, and places within the file.
fn check_problems(bytes: &[u8], problems: &Diagnostics) {
    assert!(problems.errors() > 0);
    assert!(!problems.to_string().is_empty());
    for problem in problems {
        assert!(problem.span.start <= problem.span.end && problem.span.end <= bytes.len(), "{problem:?}");
        assert!(!problem.message.is_empty());
        if problem.line > 0 {
            let lines = bytes[..problem.span.start].iter().filter(|byte| **byte == b'\n').count();
            assert_eq!(problem.line, lines + 1, "{problem:?}");
        }
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn damaged_layouts_never_panic_and_what_is_read_is_sound(
        text in select(layouts()),
        edits in vec(edit(), 1..6),
    ) {
        let bytes = edited(text.as_bytes(), edits);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("layout.ron");
        fs::write(&path, &bytes).unwrap();
        match load_layout(&path, &Kinds::builtin(), &Geometry::default()) {
            Ok(loaded) => {
                check_layout(&loaded.layout);
                // Places are in the text, for any finding.
                let found = ergonomics::review(&loaded.layout, &Floor::default());
                for problem in &ergonomics::locate(&loaded.places, &found) {
                    let text = std::str::from_utf8(&bytes).unwrap();
                    prop_assert!(text.get(problem.span.clone()).is_some(), "{:?}", problem);
                }
                prop_assert!(loaded.warnings.iter().all(|problem| problem.severity == Severity::Warning));
            }
            Err(problems) => check_problems(&bytes, &problems),
        }
    }

    #[test]
    fn damaged_floors_never_panic(floor in floors(), edits in vec(edit(), 1..6)) {
        let bytes = edited(write_floor(&floor).as_bytes(), edits);
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("floor.ron");
        fs::write(&path, &bytes).unwrap();
        match load_floor(&path) {
            Ok(floor) => {
                prop_assert_eq!(floor.calibration.len(), floor.geometry.tile_count());
                prop_assert_eq!(floor.tare.len(), floor.geometry.tile_count());
                prop_assert_eq!(floor.actuators.len(), floor.geometry.tile_count());
                prop_assert_eq!(floor.position_maps.len(), floor.geometry.tile_count());
            }
            Err(problems) => check_problems(&bytes, &problems),
        }
    }

    #[test]
    fn a_written_floor_is_read_as_the_same_floor(floor in floors()) {
        let text = write_floor(&floor);
        match parse_floor(&text, "floor.ron") {
            Ok(read) => prop_assert_eq!(read, floor),
            Err(problems) => prop_assert!(false, "{}\n{}", problems, text),
        }
    }
}

/// Shipped layouts, and one that uses all of the language.
fn layouts() -> Vec<&'static str> {
    const LANGUAGE: &str = r#"Layout(
    version: 1,
    units: Metres,
    kinds: [
        (name: "key", from: "big", look: (icon: Home)),
        Kind(name: "big", from: "button", press_n: 80, release_n: 50),
    ],
    regions: [(id: "all", at: (0, 0), size: (1.8, 1.8), cursor: Each)],
    widgets: [
        Group(id: "pad", at: (0.2, 0.7), widgets: [
            (id: "key_{label}", kind: "key", at: (0, 0), size: (0.15, 0.14),
                repeat: (columns: 3, rows: 2, gap: (0.06, 0.07), labels: ["1", "2", None, "4", "5", "OK"])),
            Group(right_of: "key_2", gap: 0.3, widgets: [(id: "deep", kind: "switch", at: (9, 9), size: (0.2, 0.2))]),
        ]),
        (id: "last", kind: "slider", below: "first", gap: 0.1, align: End, max: 9),
        (id: "first", kind: "button", right_of: "pad", gap: 0.1, size: (0.3, 0.2), label: "Über"),
    ],
)"#;
    builtin_layouts().filter_map(builtin_layout).chain([LANGUAGE, LANGUAGE]).collect()
}

/// 400 cases of each, or as many as `PROPTEST_CASES` sets.
fn config() -> ProptestConfig {
    let default = ProptestConfig::default();
    let cases = if std::env::var_os("PROPTEST_CASES").is_some() { default.cases } else { 400 };
    ProptestConfig { cases, ..default }
}

/// Floors as in laboratories: measured parts, rewired boards, missing actuators.
fn floors() -> impl Strategy<Value = Floor> {
    (1..9_u16, 1..9_u16, 0.05..5.0_f32, 1.0..2.0_f32, 0.0..0.49_f32).prop_flat_map(
        |(columns, rows, tile, gap, inset)| {
            let geometry =
                Geometry::new(columns, rows, tile, (tile * gap).clamp(tile, 2.0 * tile), tile * inset)
                    .unwrap();
            let tiles = geometry.tile_count();
            let part = prop_oneof![Just((Calibration::NOMINAL, 0.0)), (law(), -50.0..500.0_f32),];
            let sensors = vec(part, tiles * 4);
            let actuators = prop_oneof![
                Just(None),
                vec(proptest::option::of((0..4096_u16, 0.1..1000.0_f32)), tiles).prop_map(Some)
            ];
            (Just(geometry), sensors, actuators, any::<bool>(), any::<u64>()).prop_map(build)
        },
    )
}

/// Any law with numbers that a part can have.
fn law() -> impl Strategy<Value = Calibration> {
    prop_oneof![
        (1e-20..100.0_f32, 0.1..5.0_f32).prop_map(|(a, b)| Calibration::of(LawKind::Exponential, [a, b])),
        (1e-20..100.0_f32, 0.1..30.0_f32).prop_map(|(a, b)| Calibration::of(LawKind::Power, [a, b])),
        (0.1..1000.0_f32, 1.0..20.0_f32).prop_map(|(a, b)| Calibration::of(LawKind::Divider, [a, b])),
        (0.1..1000.0_f32, -5.0..5.0_f32).prop_map(|(a, b)| Calibration::of(LawKind::Linear, [a, b])),
    ]
}

/// Adds calibrations and maps with dates, on tiles chosen by `seed`.
fn record(floor: &mut Floor, seed: u64) {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let day = |rng: &mut Pcg64Mcg| Day::of_unix_seconds(rng.random_range(0..200_000_000_000));
    floor.tared = rng.random_bool(0.5).then(|| day(&mut rng));
    for tile in 0..floor.geometry.tile_count() {
        for record in &mut floor.calibration_records[tile] {
            *record = rng
                .random_bool(0.5)
                .then(|| CalibrationRecord { day: day(&mut rng), residual: rng.random_range(0.0..0.3) });
        }
        if rng.random_bool(0.3) {
            let trims = [(); 4].map(|()| std::array::from_fn(|_| rng.random_range(-0.6f32..0.6)));
            let bends = [(); 2].map(|()| std::array::from_fn(|_| rng.random_range(-2.0f32..2.0)));
            let record = rng
                .random_bool(0.8)
                .then(|| MapRecord { day: day(&mut rng), residual_m: rng.random_range(0.0..0.05) });
            let residual_m = record.map_or(PositionMap::SOME_RESIDUAL_M, |record| record.residual_m);
            floor.position_maps[tile] = Some(PositionMap { trims, bends, residual_m });
            floor.map_records[tile] = record;
        }
    }
}

type Parts = (Geometry, Vec<(Calibration, f32)>, Option<Vec<Option<(u16, f32)>>>, bool, u64);

fn build((geometry, sensors, actuators, rewired, seed): Parts) -> Floor {
    let mut floor = Floor::of(geometry);
    for (index, (calibration, tare)) in sensors.into_iter().enumerate() {
        floor.calibration[index / 4][index % 4] = calibration;
        floor.tare[index / 4][index % 4] = Newtons(tare);
    }
    if let Some(actuators) = actuators {
        let actuator = |(channel, full_scale)| Actuator { channel, full_scale: Newtons(full_scale) };
        floor.actuators = actuators.into_iter().map(|parts| parts.map(actuator)).collect();
    }
    record(&mut floor, seed);
    if rewired {
        // Every sensor on some channel, in another order, with unused channels between.
        let mut sensors: Vec<SensorId> =
            geometry.tiles().flat_map(|tile| Corner::ALL.map(|corner| SensorId { tile, corner })).collect();
        let turn = (seed % sensors.len() as u64) as usize;
        sensors.rotate_left(turn);
        let channels = |chunk: &[SensorId]| {
            let mut channels: Vec<Option<SensorId>> = chunk.iter().copied().map(Some).collect();
            channels.insert(chunk.len() / 2, None);
            channels
        };
        let address = |number: usize| format!("/lab/board-{number}.{seed}");
        floor.boards = sensors
            .chunks(31)
            .enumerate()
            .map(|(number, chunk)| Board::new(address(number), channels(chunk)))
            .collect();
    }
    floor
}
