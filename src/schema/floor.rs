//! Floor files: geometry and boards.

use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;

use super::behaviour::single;
use super::day;
use super::diagnostic::Diagnostics;
use super::fields::Fields;
use super::floor_maps::maps;
use super::floor_sensors::sensors;
use super::floor_sound::sound;
use super::node::Node;
use super::pairs::Limits;
use super::problem::Problem;
use super::reader::Reader;
use super::source::{Source, read_text};
use super::version;
use crate::floor::{Board, Corner, Floor, Geometry, GeometryError, Network, SensorId, TileId};
use crate::wire::MAX_CHANNELS;

/// Most networks that boards may send from.
const MAX_NETWORKS: usize = 256;

/// Most boards of one floor.
const MAX_BOARDS: usize = 16_384;

/// The floor that the file at `path` describes.
///
/// # Errors
/// Everything wrong with the file, or that it cannot be read.
pub fn load_floor(path: &Path) -> Result<Floor, Diagnostics> {
    let text = read_text(path)?;
    parse_floor(&text, &path.display().to_string())
}

/// The floor that `text` describes; what it doesn't mention is as on [`Floor::of`] its geometry.
///
/// `name` is what diagnostics call the text, usually a path.
///
/// # Errors
/// Everything wrong with the text.
pub fn parse_floor(text: &str, name: &str) -> Result<Floor, Diagnostics> {
    let source = Source::new(name, text)?;
    let reader = Reader::new(&source, "Floor", Limits::FLOOR);
    if let Some(newer) = version::newer(&reader, "Floor") {
        return Err(newer);
    }
    let floor = reader.root("floor").and_then(floor);
    reader.conclude(floor).map(|(floor, _)| floor)
}

fn floor(node: Node<'_>) -> Option<Floor> {
    let mut fields = node.fields("Floor")?;
    fields.read("version", Some(1), version::read);
    let geometry = geometry(&mut fields);
    // A floor whose measures are wrong is read on as the paper's, but its tiles are not judged by that.
    let mut floor = Floor::of(geometry.unwrap_or_default());
    let grid = Grid { known: geometry };
    let allow = fields.read("allow", Some(Vec::new()), allow);
    let boards = fields.read("boards", Some(None), |node| boards(node, grid).map(Some));
    let sensors = fields.read("sensors", Some(()), |node| sensors(node, grid, &mut floor));
    let tared = fields.read("tared", Some(None), |node| day::read(node).map(Some));
    let maps = fields.read("maps", Some(()), |node| maps(node, grid, &mut floor));
    let sound = sound(&mut fields, grid, &mut floor);
    fields.finish();
    geometry?;
    sensors?;
    maps?;
    floor.tared = tared?;
    floor.allow = allow?;
    if let Some(boards) = boards? {
        floor.boards = boards;
    }
    sound?;
    Some(floor)
}

fn geometry(fields: &mut Fields<'_>) -> Option<Geometry> {
    let paper = Geometry::default();
    let side = 1..=u32::from(Geometry::MAX_SIDE);
    let columns = fields.read("columns", Some(paper.columns().into()), |node| node.whole(side.clone()));
    let rows = fields.read("rows", Some(paper.rows().into()), |node| node.whole(side));
    let tile = fields.read("tile_m", Some(paper.tile_m()), |node| single(node, 0.05..=5.0));
    // Tiles of another size lie edge to edge unless told otherwise.
    let pitch =
        fields.read("pitch_m", Some(tile.unwrap_or(paper.pitch_m())), |node| single(node, 0.05..=10.0));
    let inset = fields.read("sensor_inset_m", Some(paper.sensor_inset_m()), |node| single(node, 0.0..=2.5));
    let built = Geometry::new(columns? as u16, rows? as u16, tile?, pitch?, inset?);
    built
        .map_err(|error| {
            let field = match error {
                GeometryError::Grid { .. } => "columns",
                GeometryError::Tile(_) => "tile_m",
                GeometryError::Pitch(_) => "pitch_m",
                GeometryError::Inset(_) => "sensor_inset_m",
            };
            let problem = Problem::error(fields.span(field), error.to_string());
            fields.report(problem.expected("no such floor can be built"));
        })
        .ok()
}

/// The tiles that a file may speak of; any if its geometry could not be read.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    pub(super) known: Option<Geometry>,
}

impl Grid {
    /// The tile written as `(column, row)`.
    pub(super) fn tile(self, node: Node<'_>) -> Option<TileId> {
        let [column, row] = node.tuple("(column, row)")?;
        self.tile_of(column, row)
    }

    fn tile_of(self, column: Node<'_>, row: Node<'_>) -> Option<TileId> {
        let most = u32::from(Geometry::MAX_SIDE);
        let (columns, rows) =
            self.known.map_or((most, most), |known| (known.columns().into(), known.rows().into()));
        let column = Node { name: "column", ..column }.whole(0..=columns - 1);
        let row = Node { name: "row", ..row }.whole(0..=rows - 1);
        Some(TileId::new(column? as u16, row? as u16))
    }
}

/// Where each of some things is first written.
pub(super) struct Seen<T> {
    first: HashMap<T, Range<usize>>,
}

impl<T: std::hash::Hash + Eq> Seen<T> {
    pub(super) fn new() -> Self {
        Self { first: HashMap::new() }
    }

    /// Reports that `thing`, which messages call `name`, has been written before.
    pub(super) fn check(
        &mut self,
        reader: &Reader<'_>,
        thing: T,
        name: impl FnOnce() -> String,
        span: Range<usize>,
    ) {
        match self.first.get(&thing) {
            Some(first) => {
                let problem = Problem::error(span, format!("{} comes twice", name()));
                reader.report(problem.expected(format!("the first is on line {}", reader.line(first))));
            }
            None => {
                self.first.insert(thing, span);
            }
        }
    }
}

/// Every element is read before the first that failed ends it, so that each is reported.
fn all<T>(read: impl Iterator<Item = Option<T>>) -> Option<Vec<T>> {
    let read: Vec<Option<T>> = read.collect();
    read.into_iter().collect()
}

fn boards(node: Node<'_>, grid: Grid) -> Option<Vec<Board>> {
    let nodes = node.list("board", MAX_BOARDS)?;
    let mut addresses = Seen::new();
    let mut wired = Seen::new();
    all(nodes.into_iter().enumerate().map(|(number, node)| {
        let mut fields = node.fields("Board")?;
        let usual = usual_address(number);
        let address = fields.read("address", Some(usual), address);
        if let Some(address) = &address {
            addresses.check(
                node.reader,
                address.clone(),
                || format!("the address {address}"),
                fields.span("address"),
            );
        }
        let channels = match (fields.take("tiles"), fields.take("channels")) {
            (Some(tiles), None) => tiles_of_board(tiles, grid),
            (None, Some(channels)) => channels_of_board(channels, grid),
            (None, None) => {
                let problem = Problem::error(fields.start(), "this board has neither `tiles` nor `channels`");
                let help = "add tiles: [(0, 0), (1, 0)]: four channels each, sw se nw ne";
                fields.report(problem.expected("what does it measure?").help(help));
                None
            }
            (Some(_), Some(_)) => {
                let problem =
                    Problem::error(fields.span("channels"), "a board has `tiles` or `channels`, not both");
                fields.report(problem.expected("one too many"));
                None
            }
        };
        fields.finish();
        let channels = channels?;
        for (sensor, span) in channels.iter().flatten() {
            wired.check(node.reader, *sensor, || format!("the sensor of {sensor}"), span.clone());
        }
        let channels = channels.into_iter().map(|channel| channel.map(|(sensor, _)| sensor)).collect();
        Some(Board { address: address?, channels })
    }))
}

/// The address of the board of this number, unless told otherwise.
pub(super) fn usual_address(number: usize) -> String {
    format!("/underfoot/board/{number}")
}

/// What each channel of a board measures, and where that is written.
type Channels = Vec<Option<(SensorId, Range<usize>)>>;

/// Tiles as `(column, row)`, each with its four sensors in the usual order.
fn tiles_of_board(node: Node<'_>, grid: Grid) -> Option<Channels> {
    let tiles = node.list("tile", MAX_CHANNELS / Corner::ALL.len())?;
    let sensors = all(tiles.into_iter().map(|node| {
        let tile = grid.tile(node)?;
        Some(Corner::ALL.map(|corner| Some((SensorId { tile, corner }, node.span()))))
    }))?;
    Some(sensors.into_iter().flatten().collect())
}

/// Sensors as `(column, row, Sw)`, or `None` for a channel without one.
fn channels_of_board(node: Node<'_>, grid: Grid) -> Option<Channels> {
    all(node.list("channel", MAX_CHANNELS)?.into_iter().map(|node| {
        if node.is_none() {
            return Some(None);
        }
        let [column, row, name] = node.tuple("(column, row, corner)")?;
        let tile = grid.tile_of(column, row);
        let corner = corner(Node { name: "corner", ..name });
        Some(Some((SensorId { tile: tile?, corner: corner? }, node.span())))
    }))
}

pub(super) fn corner(node: Node<'_>) -> Option<Corner> {
    let [sw, se, nw, ne] = Corner::ALL;
    node.choice(&[("Sw", sw), ("Se", se), ("Nw", nw), ("Ne", ne)])
}

/// Networks, such as `["192.168.1.0/24"]`.
fn allow(node: Node<'_>) -> Option<Vec<Network>> {
    all(node.list("network", MAX_NETWORKS)?.into_iter().map(|node| {
        let text = node.text(64)?;
        let read = text.parse();
        if read.is_err() {
            let problem = Problem::error(node.span(), format!("{text:?} is not a network"));
            let expected = "expected an address or a range of them";
            node.report(problem.expected(expected).help("write \"192.168.1.20\" or \"192.168.1.0/24\""));
        }
        read.ok()
    }))
}

/// An OSC address that stands for itself: no pattern characters.
fn address(node: Node<'_>) -> Option<String> {
    let text = node.text(255)?;
    let legal = |c: char| c.is_ascii_alphanumeric() || matches!(c, '/' | '_' | '-' | '.');
    if text.len() > 1 && text.starts_with('/') && !text.ends_with('/') && text.chars().all(legal) {
        return Some(text.to_owned());
    }
    let problem = Problem::error(node.span(), "`address` is no OSC address");
    let expected = "expected parts of a-z, A-Z, 0-9, `_`, `-` and `.`, each after a `/`";
    node.report(problem.expected(expected).help("write \"/underfoot/board/0\""));
    None
}

#[cfg(test)]
mod tests {
    use super::super::write_floor;
    use super::*;
    use crate::floor::{Actuator, Calibration};
    use crate::units::Newtons;

    fn read(text: &str) -> Floor {
        parse_floor(text, "floor.ron").unwrap_or_else(|problems| panic!("{problems}"))
    }

    #[test]
    fn an_empty_description_is_the_papers_floor() {
        assert_eq!(read("Floor()"), Floor::default());
        assert_eq!(read("()"), Floor::default());
        assert_eq!(read(&write_floor(&Floor::default())), Floor::default());
    }

    #[test]
    fn a_grid_of_another_size_is_wired_row_by_row() {
        let floor = read("Floor(columns: 10, rows: 2, tile_m: 0.5)");
        assert_eq!(floor, Floor::of(Geometry::new(10, 2, 0.5, 0.5, 0.02).unwrap()));
    }

    #[test]
    fn what_is_listed_replaces_what_would_be_assumed() {
        let floor = read(
            "Floor(columns: 2, rows: 1,
                allow: [\"10.0.0.5\", \"192.168.1.0/24\"],
                boards: [
                    (tiles: [(1, 0)]),
                    (address: \"/lab/west\", channels: [(0, 0, Ne), None, (0, 0, Sw)]),
                ],
                sensors: [(tile: (0, 0), corner: Ne, a_n: 0.7, tare_n: 12.5)],
                actuators: [(tile: (1, 0), channel: 7, full_scale_n: 55)],
            )",
        );
        let sensor = |column, corner| Some(SensorId { tile: TileId::new(column, 0), corner });
        assert_eq!(floor.boards[0].address, "/underfoot/board/0");
        assert_eq!(floor.boards[0].channels, Corner::ALL.map(|corner| sensor(1, corner)));
        assert_eq!(floor.boards[1].address, "/lab/west");
        assert_eq!(
            floor.boards[1].channels,
            [sensor(0, Corner::NorthEast), None, sensor(0, Corner::SouthWest)]
        );
        let part = Calibration::exponential(0.7, 1.34);
        assert_eq!(floor.calibration[0][Corner::NorthEast.index()], part);
        assert_eq!(floor.calibration[0][0], Calibration::NOMINAL);
        assert_eq!(floor.tare[0][Corner::NorthEast.index()], Newtons(12.5));
        assert_eq!(floor.actuators, [None, Some(Actuator { channel: 7, full_scale: Newtons(55.0) })]);
        assert_eq!(floor.allow, ["10.0.0.5", "192.168.1.0/24"].map(|text| text.parse().unwrap()));
        assert_eq!(read(&write_floor(&floor)), floor);
    }

    #[test]
    fn a_written_floor_can_be_edited_by_people() {
        let mut floor = Floor::of(Geometry::of_paper_tiles(2, 1).unwrap());
        floor.boards[0].channels.truncate(4);
        floor.calibration[1][2] = Calibration::exponential(0.52, 1.34);
        floor.actuators[0] = None;
        insta::assert_snapshot!(write_floor(&floor), @r#"
        // A floor: where its tiles are and what is wired to them.
        // Tiles are (column, row) from the south-west, lengths in metres, forces in newtons.
        Floor(
            version: 1,
            columns: 2,
            rows: 1,
            tile_m: 0.304,
            pitch_m: 0.304,
            sensor_inset_m: 0.02,

            // Which tiles, or which sensors, are on the channels of each board.
            boards: [
                (tiles: [(0, 0)]),
            ],
            // f = a exp(b v) with v in volts, then the tare is taken off. Sensors that are not listed are nominal.
            sensors: [
                (tile: (1, 0), corner: Nw, a_n: 0.52, b_per_volt: 1.34, tare_n: 0.0),
            ],
            // Output channels; tiles that are not listed have no actuator.
            actuators: [
                (tile: (1, 0), channel: 1, full_scale_n: 40.0),
            ],
        )
        "#);
    }
}
