//! The floor from above, with the input of each sensor; and the same as a table.

use std::fmt::Write as _;

use underfoot::floor::{Floor, Rect, SensorId};
use underfoot::glam::Vec2;
use underfoot::layout::Colour;
use underfoot_scene::scene::{Anchor, Scene};

use super::pins::Pins;
use super::sheet::{COLOURS, Sheet, THEME};

/// Maximum number of boards that the head of the plan lists.
const LISTED: usize = 12;

/// Height of letters, as a share of the smallest plate.
const LETTERS: f32 = 0.05;

/// A sensor at an input of a board.
#[derive(Clone, Debug)]
struct Wire {
    sensor: SensorId,
    board: usize,
    input: String,
}

/// The wires of a floor.
#[derive(Clone, Debug)]
pub(super) struct Plan<'f> {
    floor: &'f Floor,
    pins: Vec<Pins>,
    wires: Vec<Wire>,
}

impl<'f> Plan<'f> {
    /// The wires of `floor`, whose boards have these pins.
    pub(super) fn new(floor: &'f Floor, pins: Vec<Pins>) -> Self {
        let mut wires = Vec::new();
        for (number, (board, pins)) in floor.boards.iter().zip(&pins).enumerate() {
            for (channel, sensor) in board.channels.iter().enumerate() {
                if let Some(sensor) = *sensor {
                    wires.push(Wire { sensor, board: number, input: pins.input(floor, number, channel) });
                }
            }
        }
        Self { floor, pins, wires }
    }

    /// One line a sensor, board by board in the order of the channels; places in metres from the south-west corner.
    pub(super) fn table(&self) -> String {
        let mut text = "board,address,input,col,row,sensor,x_m,y_m\n".to_owned();
        for Wire { sensor, board, input } in &self.wires {
            let address = self.floor.boards.get(*board).map_or("", |board| &board.address);
            let at = self.floor.geometry.sensor(sensor.tile, sensor.corner);
            let name = self.floor.geometry.sensor_name(sensor.corner);
            // Writing to a `String` cannot fail.
            let _ = writeln!(
                text,
                "{board},{address},{input},{},{},{name},{:.4},{:.4}",
                sensor.tile.column, sensor.tile.row, at.x, at.y
            );
        }
        text
    }

    /// Sensors at no board.
    fn loose(&self) -> Vec<SensorId> {
        let geometry = &self.floor.geometry;
        let tiles = geometry.tiles().filter(|tile| geometry.has(*tile));
        let all = tiles
            .flat_map(|tile| geometry.sensors(tile).iter().map(move |&corner| SensorId { tile, corner }));
        all.filter(|sensor| self.wires.iter().all(|wire| wire.sensor != *sensor)).collect()
    }

    /// Draws the plan, north up, in metres of the floor.
    pub(super) fn draw(&self, title: &str) -> Scene {
        let geometry = &self.floor.geometry;
        let plates = geometry.tiles().filter(|tile| geometry.has(*tile));
        let least = plates.map(|tile| geometry.plate_size(tile).min_element()).fold(f32::INFINITY, f32::min);
        let em_m = LETTERS * if least.is_finite() { least } else { 0.3 };
        let head = self.head(title);
        let bounds = geometry.bounds();
        // A narrow floor still has room for its title.
        let width = bounds.size().x.max(34.0 * em_m);
        let high = bounds.size().y + (1.8 * head.len() as f32 + 1.0) * em_m;
        let page = Rect::from_min_size(bounds.min, Vec2::new(width, high)).grown(2.0 * em_m);
        let mut sheet = Sheet::new(page, em_m);
        let mut at = Vec2::new(bounds.min.x, page.max.y - 3.0 * em_m);
        for (line, board) in head {
            if let Some(board) = board {
                sheet.dot(at + Vec2::new(0.5 * em_m, 0.0), colour(board));
                sheet.text(at + Vec2::new(1.5 * em_m, 0.0), Anchor::Start, THEME.ink, &line);
            } else {
                sheet.sized(at, Anchor::Start, THEME.ink, 1.25, &line);
            }
            at.y -= 1.8 * em_m;
        }
        for tile in geometry.tiles().filter(|tile| geometry.has(*tile)) {
            sheet.boxed(geometry.plate(tile), THEME.plate);
            let centre = geometry.centre(tile);
            sheet.text(centre, Anchor::Middle, THEME.quiet, &format!("tile {tile}"));
        }
        for wire in &self.wires {
            let ink = colour(wire.board);
            let at = geometry.sensor(wire.sensor.tile, wire.sensor.corner);
            sheet.dot(at, ink);
            self.label(&mut sheet, wire.sensor, em_m, |sheet, at, anchor| {
                let name = geometry.sensor_name(wire.sensor.corner);
                sheet.text(at, anchor, ink, &wire.input);
                sheet.sized(at - Vec2::new(0.0, 1.2 * em_m), anchor, THEME.quiet, 0.8, name);
            });
        }
        for sensor in self.loose() {
            sheet.ring(geometry.sensor(sensor.tile, sensor.corner), THEME.fault);
            self.label(&mut sheet, sensor, em_m, |sheet, at, anchor| {
                sheet.text(at, anchor, THEME.fault, "not wired");
            });
        }
        sheet.scene
    }

    /// Draws a label beside a sensor, towards the middle of its plate.
    fn label(
        &self,
        sheet: &mut Sheet,
        SensorId { tile, corner }: SensorId,
        em_m: f32,
        draw: impl FnOnce(&mut Sheet, Vec2, Anchor),
    ) {
        let geometry = &self.floor.geometry;
        let at = geometry.sensor(tile, corner);
        let inwards = geometry.centre(tile) - at;
        let beside = 0.8 * em_m;
        if inwards.x.abs() < em_m {
            let down = if inwards.y < 0.0 { -1.2 * em_m } else { 2.4 * em_m };
            return draw(sheet, at + Vec2::new(0.0, down), Anchor::Middle);
        }
        let anchor = if inwards.x > 0.0 { Anchor::Start } else { Anchor::End };
        draw(sheet, at + Vec2::new(beside.copysign(inwards.x), 0.0), anchor);
    }

    /// The lines above the floor, and the boards that they are about.
    fn head(&self, title: &str) -> Vec<(String, Option<usize>)> {
        let mut lines = vec![(format!("Wiring of {title}, seen from above, north up"), None)];
        let boards = self.floor.boards.iter().zip(&self.pins).enumerate();
        for (number, (board, pins)) in boards.take(LISTED) {
            let sensors = board.channels.iter().flatten().count();
            lines.push((format!("{}: {}, {sensors} sensors", board.address, pins.name()), Some(number)));
        }
        let more = self.floor.boards.len().saturating_sub(LISTED);
        if more > 0 {
            lines.push((format!("and {more} more boards: the table has all"), None));
        }
        lines
    }
}

/// The colour of this board; neighbours differ.
fn colour(board: usize) -> Colour {
    COLOURS[board % COLOURS.len()]
}

#[cfg(test)]
mod tests {
    use underfoot::floor::Corner;

    use super::*;

    #[test]
    fn every_sensor_has_a_line_and_a_loose_one_is_named() {
        let mut floor = Floor::default();
        let plan = |floor: &Floor| {
            let pins = vec![Pins::Channels; floor.boards.len()];
            let plan = Plan::new(floor, pins);
            (plan.table(), plan.loose())
        };
        let (table, loose) = plan(&floor);
        assert_eq!((table.lines().count(), loose.len()), (1 + 144, 0));
        assert!(table.contains("\n1,/underfoot/board/1,channel 4,1,1,sw,"), "{table}");
        let left = floor.boards[2].channels[5].take();
        assert_eq!(plan(&floor).1, [left.unwrap()]);
        assert_eq!(left.unwrap().corner, Corner::SouthEast);
    }
}
