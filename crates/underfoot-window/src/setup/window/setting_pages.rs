//! The pages about boards, shape and layout.

use eframe::egui::{DragValue, Grid, Ui};

use super::app::SetupApp;
use super::parts::{Wish, heading, main_button, next_button, remark, results, side_button, tell, troubles};
use super::stage::sensor_count;
use crate::preview::style::section;
use crate::setup::{GridShape, SHIPPED_SHAPES, SetupOrder, SetupStep, SetupView, StepState, WorkView};
use underfoot::floor::Geometry;
use underfoot_scene::scene::Theme;

impl SetupApp {
    /// The boards that send.
    pub(super) fn boards_page(&self, ui: &mut Ui, theme: &Theme, view: &SetupView, wishes: &mut Vec<Wish>) {
        let step = SetupStep::Boards;
        heading(ui, theme, step);
        tell(ui, theme, "Switch on the boards, or plug them in. Each appears here as soon as it sends.");
        remark(ui, theme, &format!("Listening on {} and at the USB serial ports.", self.options.listen));
        troubles(ui, theme, &view.troubles);
        if view.boards.is_empty() {
            section(ui, theme, "None yet?", |_| {});
            if self.options.is_local {
                let words = format!(
                    "{} gets packets of this machine only. For boards on the network, start the set-up with --listen \
                     0.0.0.0:9000.",
                    self.options.listen
                );
                remark(ui, theme, &words);
            }
            for words in [
                "Do the boards send to the address and port of this machine? No firewall may be between.",
                "A serial port that is not on USB needs --serial PORT.",
                "A board that answers requests only cannot be found: its `request` stands in the floor file, under \
                 `serial`.",
            ] {
                remark(ui, theme, words);
            }
        } else {
            let words = "Press on the plates: the bars of their sensors rise. How many bits the counts have shows only \
                         under a heavy load on every sensor.";
            tell(ui, theme, words);
        }
        if view.unread > 0 {
            let words = format!("{} datagrams, frames and lines are none of a board.", view.unread);
            remark(ui, theme, &words);
        }
        let is_found = !view.boards.is_empty();
        next_button(ui, theme, step, is_found, wishes);
        if side_button(ui, "Look again", "Forget these boards, and look for those that send now") {
            wishes.push(Wish::Step(step));
        }
    }

    /// The shape of the floor.
    pub(super) fn shape_page(
        &mut self,
        ui: &mut Ui,
        theme: &Theme,
        view: &SetupView,
        wishes: &mut Vec<Wish>,
    ) {
        let step = SetupStep::Shape;
        heading(ui, theme, step);
        tell(ui, theme, "Which plates does the floor have?");
        let mut shipped = self.shape.shipped;
        ui.radio_value(&mut shipped, None, "square tiles in a grid, sensors near their corners");
        for (number, (_, words)) in SHIPPED_SHAPES.iter().enumerate() {
            ui.radio_value(&mut shipped, Some(number), *words);
        }
        let before = (self.shape.shipped, self.shape.grid);
        self.shape.shipped = shipped;
        if shipped.is_none() {
            ui.add_space(6.0);
            measures(ui, &mut self.shape.grid);
        }
        self.shape.is_chosen |= before != (self.shape.shipped, self.shape.grid);
        ui.add_space(8.0);
        let floor = self.shape.floor();
        match &floor {
            Ok(floor) => {
                let (sensors, channels) =
                    (sensor_count(floor), view.boards.iter().map(|board| board.channels).sum::<usize>());
                let words = match channels {
                    0 => format!(
                        "{sensors} sensors. No board has been found, so the file gets the usual ones."
                    ),
                    channels if channels < sensors => format!(
                        "{sensors} sensors, and {channels} channels: {} sensors stay without one.",
                        sensors - channels
                    ),
                    channels if channels > sensors => {
                        format!("{sensors} sensors, and {channels} channels: the last ones are left over.")
                    }
                    channels => format!("{sensors} sensors, and {channels} channels: they fit."),
                };
                tell(ui, theme, &words);
            }
            Err(reason) => troubles(ui, theme, [reason]),
        }
        if view.floor.is_some() {
            let words = format!("{} is there: its content is kept as a backup.", self.options.file);
            remark(ui, theme, &words);
        }
        let state = view.step(step).state;
        results(ui, theme, view.step(step));
        // A file from before this set-up has an answer already, and a changed shape asks anew.
        let is_written = state != StepState::Open
            && floor
                .is_ok_and(|floor| view.floor.as_ref().is_some_and(|file| file.geometry == floor.geometry));
        let write = format!("Write {}", self.options.file);
        if is_written {
            next_button(ui, theme, step, true, wishes);
            if side_button(ui, &write, "Write it again, with the boards that send now") {
                wishes.push(Wish::WriteShape);
            }
        } else if main_button(ui, theme, &write, self.shape.floor().is_ok()) {
            wishes.push(Wish::WriteShape);
        }
        remark(
            ui,
            theme,
            "Holes, plates of several sizes and sensors anywhere: write them into the file by hand.",
        );
    }

    /// The first layout.
    pub(super) fn layout_page(&self, ui: &mut Ui, theme: &Theme, view: &SetupView, wishes: &mut Vec<Wish>) {
        let step = SetupStep::Layout;
        heading(ui, theme, step);
        tell(
            ui,
            theme,
            "A first layout has a button on each tile. It opens in a window of its own: step on one.",
        );
        let is_open = matches!(view.work, WorkView::Open);
        results(ui, theme, view.step(step));
        if is_open {
            remark(ui, theme, "The layout listens to the boards now. Close its window to go on here.");
        }
        if main_button(ui, theme, "Open the first layout", !is_open) {
            wishes.push(Wish::Order(SetupOrder::OpenLayout));
        }
        if view.fit.is_none() {
            let words = "Without a calibration, forces are those of nominal sensors: places and thresholds are off by \
                         a third and more.";
            remark(ui, theme, words);
        }
    }
}

/// Fields for the measures of a grid.
fn measures(ui: &mut Ui, grid: &mut GridShape) {
    Grid::new("measures").num_columns(2).spacing([16.0, 6.0]).show(ui, |ui| {
        for (name, count) in
            [("Columns, west to east", &mut grid.columns), ("Rows, south to north", &mut grid.rows)]
        {
            let label = ui.label(name);
            ui.add(DragValue::new(count).range(1..=Geometry::MAX_SIDE).speed(0.1)).labelled_by(label.id);
            ui.end_row();
        }
        let was_closed = grid.pitch_m == grid.tile_m;
        for (name, metres, range) in [
            ("Side of a plate", &mut grid.tile_m, 5.0..=500.0),
            ("From middle to middle", &mut grid.pitch_m, 5.0..=1000.0),
            ("Sensors from the edges", &mut grid.inset_m, 0.0..=250.0),
        ] {
            let label = ui.label(name);
            let mut cm = 100.0 * f64::from(*metres);
            let field = DragValue::new(&mut cm).range(range).suffix(" cm").max_decimals(1).speed(0.1);
            if ui.add(field).labelled_by(label.id).changed() {
                *metres = (0.01 * cm) as f32;
            }
            ui.end_row();
        }
        // Plates that touch stay together.
        if was_closed && grid.pitch_m < grid.tile_m {
            grid.pitch_m = grid.tile_m;
        }
    });
}
