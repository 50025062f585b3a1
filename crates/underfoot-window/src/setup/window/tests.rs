//! The window by the names of its widgets, with a simulated floor whose person follows it.

use std::sync::mpsc::{Receiver, sync_channel};

use eframe::egui::accesskit::Role;
use eframe::egui::vec2;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use triple_buffer::{Input, triple_buffer};
use underfoot::floor::{Floor, Geometry, TileId};
use underfoot_sim::{Person, Script, StandingHabit, standing_on};

use super::app::SetupApp;
use super::{SetupChannels, SetupOptions};
use crate::preview::style;
use crate::setup::site::Site;
use crate::setup::{SetupOrder, SetupStep, SetupView, WorkView};

/// A window on a site.
struct Room {
    window: Harness<'static, SetupApp>,
    site: Site,
    views: Input<SetupView>,
    orders: Receiver<SetupOrder>,
}

impl Room {
    fn new(wired: Floor, width: f32, height: f32) -> Self {
        let (views, shown) = triple_buffer(&SetupView::default());
        let (sender, orders) = sync_channel(64);
        let options = SetupOptions {
            file: "floor.ron".into(),
            listen: "127.0.0.1:9000".into(),
            is_local: true,
            settings: None,
        };
        let app = SetupApp::new(SetupChannels { views: shown, orders: sender }, options);
        let window = Harness::builder()
            .with_size(vec2(width, height))
            .with_step_dt(1.0 / 30.0)
            .with_context_setup(|ctx| ctx.set_fonts(style::fonts()))
            .build_ui_state(|ui, app: &mut SetupApp| app.show(ui), app);
        let mut room = Self { window, site: Site::new(wired), views, orders };
        room.show();
        room
    }

    /// Draws two frames with the present state; the second one sends the orders of the first.
    fn show(&mut self) {
        for _ in 0..2 {
            self.orders.try_iter().for_each(|order| self.site.order(&order));
            self.views.write(self.site.bench.view());
            self.window.run_steps(1);
        }
    }

    /// Advances with a person in the middle of a tile.
    fn hold(&mut self, ms: u32, tile: Option<TileId>) {
        self.site.hold(ms, tile.map(|tile| self.site.middle(tile)));
        self.show();
    }

    fn click(&mut self, name: &str) {
        self.window.get_by_label(name).click_accesskit();
        self.show();
        self.show();
    }

    fn says(&self, words: &str) -> bool {
        self.window.query_all_by_label_contains(words).next().is_some()
    }

    /// The tile that is lit.
    fn lit(&self) -> Option<TileId> {
        let tiles = self.site.wired.geometry.tiles();
        tiles.into_iter().find(|tile| self.says(&format!("Tile {tile}: step here")))
    }

    fn type_weight(&mut self, text: &str) {
        let field = self.window.get_by_role_and_label(Role::TextInput, "Weight in kilograms");
        field.focus();
        self.window.run_steps(1);
        self.window.get_by_role_and_label(Role::TextInput, "Weight in kilograms").type_text(text);
        self.show();
    }

    /// A person walks over the marks that the window shows.
    fn stand(&mut self) {
        let WorkView::Standing(walk) = self.site.bench.view().work else { panic!("no walk") };
        let person = Person { mass_kg: 72.0, stand_width_m: 0.12, ..Person::default() };
        let performance = standing_on(&walk.marks, person, StandingHabit::default(), 4).unwrap();
        let script = Script::new(vec![performance], self.site.wired.geometry.bounds());
        let (begun, end) = (self.site.ms, script.duration().as_millis() as u32);
        let mut loads = Vec::new();
        while self.site.ms < begun + end {
            loads.clear();
            let now = underfoot::units::Instant::from_millis((self.site.ms - begun).into());
            script.loads_at(now, &mut loads);
            self.site.step(loads.drain(..));
            if (self.site.ms - begun).is_multiple_of(2000) {
                self.show();
            }
        }
        self.show();
    }
}

/// Two rows of two tiles, whose boards are swapped.
fn swapped() -> Floor {
    let mut floor = Floor::of(Geometry::of_paper_tiles(2, 2).unwrap());
    let [south, north] = &mut floor.boards[..] else { panic!("two boards") };
    std::mem::swap(&mut south.address, &mut north.address);
    floor
}

#[test]
fn a_person_gets_from_boards_that_send_to_a_calibrated_floor() {
    let wired = swapped();
    let mut room = Room::new(wired.clone(), 1280.0, 800.0);
    assert!(room.says("Switch on your boards") && room.says("packets of this machine only"));
    room.hold(1500, None);
    assert!(room.says("2 boards send") && room.says("8 channels of counts"));
    room.click("Next: choose the shape");
    assert!(room.says("16 sensors, and 16 channels: they fit"));
    room.click("Write floor.ron");
    assert!(room.says("Written to floor.ron"));

    room.click("Next: check the wiring");
    assert!(room.says("Keep off the floor"));
    room.hold(500, None);
    for number in 0..2 {
        let tile = room.lit().unwrap_or_else(|| panic!("no tile is lit, {number}"));
        room.hold(300, Some(tile));
        assert!(room.says("Good. Step off again"));
        room.hold(100, None);
    }
    assert!(room.says("/underfoot/board/1 is where /underfoot/board/0 should be"));
    let addresses =
        |floor: &Floor| -> Vec<String> { floor.boards.iter().map(|board| board.address.clone()).collect() };
    assert_eq!(addresses(room.site.saved.last().unwrap()), addresses(&wired));

    room.click("Next: look at the readings");
    room.hold(1500, None);
    assert!(room.says("Noise when empty") && room.says("0 of 16 sensors have answered"));
    let tile = TileId::new(1, 1);
    room.hold(400, Some(tile));
    assert!(room.says("4 of 16 sensors have answered"));
    assert!(room.says(&format!("Sensor {tile} sw: ")));
    room.hold(400, None);
    room.click("Take the tare");
    assert!(room.says("The tare is taken"));

    room.click("Next: calibrate by standing");
    room.type_weight("72");
    room.click("Start");
    room.stand();
    assert!(room.says("stands and"), "{:?}", room.site.bench.view().steps);
    let first = room.site.force_error();
    assert!(first < 0.12, "{first}");
    // A round of stands is not enough for every sensor; further ones are added to it.
    for _ in 0..3 {
        let needy = room.site.bench.view().needy.len();
        if needy > 0 {
            room.click(&if needy == 1 {
                "Repeat the tile".to_owned()
            } else {
                format!("Repeat {needy} tiles")
            });
            room.stand();
        }
    }
    assert!(room.says("The floor is calibrated"), "{:?}", room.site.bench.view().steps);
    let error = room.site.force_error();
    assert!(error < 0.1, "{first} {error}");
    room.click("Next: press a button");
    room.click("Open the first layout");
    assert!(room.site.opened == 1 && room.says("is open on the floor"));
}

#[test]
fn the_person_reads_from_the_floor_which_tile_feels_them() {
    let mut room = Room::new(Floor::of(Geometry::of_paper_tiles(2, 1).unwrap()), 1280.0, 800.0);
    room.hold(200, None);
    room.click("Next: choose the shape");
    room.click("Write floor.ron");
    room.click("5. Calibrate by standing");
    room.type_weight("72,5");
    room.click("Start");
    room.hold(1800, None);
    assert!(room.says("Stand on the shoes, facing north"));
    assert!(room.says("Stand here: tile (0, 0), in the middle, facing north"));
    room.hold(4000, Some(TileId::new(1, 0)));
    assert!(room.says("Tile (1, 0) feels you, not (0, 0)"));
    room.click("Leave out this mark");
    assert!(room.says("Mark 2 of 10"));
    room.click("Stop");
    assert!(room.says("How heavy are you?"));
}

#[test]
fn a_shape_that_cannot_be_is_not_written_and_says_why() {
    let mut room = Room::new(Floor::of(Geometry::of_paper_tiles(1, 1).unwrap()), 1280.0, 800.0);
    room.click("2. Choose the shape");
    room.window.state_mut().shape.is_chosen = true;
    room.window.state_mut().shape.grid.pitch_m = 0.1;
    room.show();
    assert!(room.says("pitch_m must be at least tile_m"));
    room.click("Write floor.ron");
    assert!(room.site.saved.is_empty());
    room.click("a dance pad, 3 x 3 panels with sensors at the middles of their edges");
    assert!(room.says("36 sensors"));
}

#[test]
fn every_step_fits_and_everything_that_can_be_worked_has_a_name() {
    for (width, height) in [(1000.0, 640.0), (1600.0, 1000.0)] {
        let mut room = Room::new(Floor::of(Geometry::of_paper_tiles(3, 2).unwrap()), width, height);
        room.hold(1200, None);
        room.click("2. Choose the shape");
        room.click("Write floor.ron");
        for step in SetupStep::ALL {
            room.click(&format!("{}. {}", step.index() + 1, step.name()));
            room.hold(600, None);
            assert_eq!(room.window.unnamed_widgets(), Vec::<String>::new(), "{}", step.name());
            assert!(room.says(step.name()));
        }
    }
}
