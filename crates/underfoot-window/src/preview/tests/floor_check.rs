//! Checks of the floor during a walk, with the boards of a simulated floor behind the window.

use std::time::Duration;

use egui_kittest::kittest::Queryable;

use super::*;
use crate::preview::floor_check::FloorCheck;
use underfoot::source::{FloorInput, SensorSource, SourceError, TappedPackets};
use underfoot::wire::{LinkCounters, SensorPacket};
use underfoot_sim::{SensorFault, SimConfig, SimFloor};

/// A floor with boards that the test reads; two of them may be interchanged.
struct Boards {
    sim: SimFloor,
    feet: Arc<Mutex<Vec<underfoot_sim::Foot>>>,
    swapped: bool,
    waiting: std::collections::VecDeque<SensorPacket>,
    ms: u32,
}

impl SensorSource for Boards {
    fn next(&mut self, _: Duration) -> Result<Option<SensorPacket>, SourceError> {
        if self.waiting.is_empty() {
            let feet = self.feet.lock().unwrap().clone();
            let received = Instant::from_millis(self.ms.into());
            for (board, readings) in (0..).zip(self.sim.step(&feet)) {
                let board = match board {
                    3 | 5 if self.swapped => 8 - board,
                    board => board,
                };
                let packet = SensorPacket { board, sequence: self.ms, received, readings: readings.clone() };
                self.waiting.push_back(packet);
            }
            self.ms += 1;
        }
        Ok(self.waiting.pop_front())
    }

    fn now(&self) -> Instant {
        Instant::from_millis(self.ms.into())
    }

    fn counters(&self) -> LinkCounters {
        LinkCounters::default()
    }
}

/// A window on that floor, and its input.
struct Site {
    room: Room,
    input: FloorInput,
    feet: Arc<Mutex<Vec<underfoot_sim::Foot>>>,
}

impl Site {
    fn new(swapped: bool, broken: Option<SensorId>) -> Self {
        let floor = Floor::default();
        let mut sim = SimFloor::new(&floor, SimConfig::default(), 1);
        if let Some(sensor) = broken {
            sim.set_fault(sensor, Some(SensorFault::Open));
        }
        let (tap, packets) = TappedPackets::new();
        let feet = Arc::<Mutex<Vec<underfoot_sim::Foot>>>::default();
        let (waiting, ms) = (std::collections::VecDeque::new(), 0);
        let boards = Boards { sim, feet: Arc::clone(&feet), swapped, waiting, ms };
        let input = tap.wrap(boards);
        let mut room = Room::of(false, 1280.0, 800.0);
        room.window.state_mut().floor_check = Some(FloorCheck::new(packets));
        room.run(2);
        Self { room, input, feet }
    }

    /// Advances the time with a person at `at`.
    fn stand(&mut self, at: Option<Vec2>, ms: u32) {
        *self.feet.lock().unwrap() = at.iter().map(|at| foot(*at)).collect();
        for _ in 0..ms {
            (0..6).for_each(|_| drop(self.input.source.next(Duration::ZERO).unwrap()));
        }
        self.room.run(1);
    }

    fn begin(&mut self, walk: &str) {
        if self.room.window.query_by_label("Check the floor…").is_some() {
            self.room.window.get_by_label("Check the floor…").click_accesskit();
            self.room.run(2);
        }
        self.room.window.get_by_label(walk).click_accesskit();
        self.room.run(2);
        self.stand(None, 400);
    }

    fn commands(&self) -> Vec<PreviewCommand> {
        self.room.commands.try_iter().collect()
    }
}

fn foot(at: Vec2) -> underfoot_sim::Foot {
    let force = Newtons(500.0);
    let mut foot =
        underfoot_sim::Foot { position: at, heading: 0.0, length_m: 0.2, force, roll: 0.5, left: false };
    foot.position += at - foot.centre_of_pressure();
    foot
}

fn middle(column: u16, row: u16) -> Vec2 {
    Floor::default().geometry.plate(TileId::new(column, row)).centre()
}

#[test]
fn boards_that_have_changed_places_are_found_step_by_step_and_the_floor_is_saved() {
    let mut site = Site::new(true, None);
    site.begin("Wiring");
    assert_eq!(
        site.commands(),
        [PreviewCommand::TurnControlsOff(true)],
        "no control acts meanwhile, asked once"
    );
    for row in 0..6 {
        assert!(site.room.says(&format!("Step on tile {}", TileId::new(0, row))), "row {row}");
        assert!(site.room.says(&format!("Tile {}: step here", TileId::new(0, row))), "row {row}");
        site.stand(Some(middle(0, row)), 300);
        assert!(site.room.says("Good. Step off again."));
        site.stand(None, 100);
    }
    assert!(site.room.says("6 of 6 boards"));
    assert!(site.room.says("Boards 3 and 5 have changed places"));
    assert!(site.room.says("felt by board 5, not 3"));
    site.room.window.get_by_label("Save").click_accesskit();
    site.room.run(2);
    let commands = site.commands();
    let [PreviewCommand::SaveFloor { floor, path }] = &commands[..] else { panic!("{commands:?}") };
    assert_eq!(path.to_str(), Some("checked_floor.ron"));
    assert_eq!(floor.boards[3].address, Floor::default().boards[5].address);
    site.room.window.key_press(Key::Escape);
    site.room.run(2);
    assert_eq!(site.commands(), [PreviewCommand::TurnControlsOff(false)]);
    assert!(site.room.says("Check the floor…"));
}

#[test]
fn tiles_turn_green_as_they_are_walked_over_and_a_dead_sensor_is_named() {
    let broken = SensorId { tile: TileId::new(2, 3), corner: Corner::SouthEast };
    let mut site = Site::new(false, Some(broken));
    site.begin("Walk test");
    assert!(site.room.says("0 of 36 tiles") && site.room.says("Walk over every tile"));
    for row in 0..6 {
        for column in 0..6 {
            for off in [(0.0, 0.0), (0.05, -0.05)] {
                site.stand(Some(middle(column, row) + Vec2::new(off.0, off.1)), 200);
                site.stand(None, 30);
            }
        }
        assert!(site.room.says(&format!("Tile {}: good", TileId::new(0, row))));
    }
    let left: Vec<_> = (0..36)
        .map(|index| TileId::new(index % 6, index / 6))
        .filter(|tile| !site.room.says(&format!("Tile {tile}: good")))
        .collect();
    assert_eq!(left, [broken.tile]);
    assert!(site.room.says("35 of 36 tiles are good"));
    assert!(site.room.says(&format!("{broken} does not react")));
    assert!(site.room.says(&format!("Tile {}: something is wrong", broken.tile)));
    assert_eq!(site.room.window.unnamed_widgets(), Vec::<String>::new());
}

#[test]
fn nothing_is_designed_while_the_floor_is_checked_and_feet_are_shown() {
    let mut site = Site::new(false, None);
    site.begin("Wiring");
    site.room.window.key_press(Key::F2);
    site.room.run(3);
    assert!(!site.room.window.state().is_designing());
    // This is too short for a step.
    site.stand(Some(middle(4, 4)), 120);
    assert!(
        site.room.says("Board 4 feels") && site.room.says("Tile (4, 4): feels somebody"),
        "not the one that was asked for"
    );
    assert!(site.room.says("Step on tile (0, 0)"));
    site.room.window.get_by_label("End").click_accesskit();
    site.room.run(2);
    site.room.window.key_press(Key::F2);
    site.room.run(3);
    assert!(site.room.window.state().is_designing());
}

#[test]
fn a_recording_can_t_be_checked() {
    let room = Room::of(false, 1280.0, 800.0);
    assert!(room.window.query_by_label("Check the floor…").is_none());
}
