//! Tiles, channels and tables in floor files.

use std::ops::Range;

use super::fields::Fields;
use super::node::Node;
use super::problem::Problem;
use crate::floor::{Corner, Geometry, GeometryError, Response, SensorId, TileId};
use underfoot_format::codec::By;
use underfoot_format::describe::{FieldDescription, FieldType};
use underfoot_format::text::{Entry, Text};
use underfoot_format::{Codec, Follow, Includes, Name, Num, Opt, Record, num, record};

record! {
    /// Places of tiles and sensors.
    struct MeasuresRecord = "Measures";
    /// The tile in the south-west corner, if this is a part of a larger floor.
    first: TileId = "first", FIRST => TileId::default();
    /// Columns and rows of that larger floor.
    whole: Option<[u16; 2]> = "whole", Opt(WHOLE) => None;
    /// Tiles from west to east.
    columns: u16 = "columns", SIDE => Geometry::default().columns();
    /// Tiles from south to north.
    rows: u16 = "rows", SIDE => Geometry::default().rows();
    /// Side of a tile.
    tile_m: f32 = "tile_m", num(0.05..=5.0).explicit() => Geometry::default().tile_m();
    /// Distance between the centres of neighbouring tiles.
    pitch_m: Option<f32> = "pitch_m", Follow { explicit: Opt(num(0.05..=10.0)), otherwise: "as `tile_m`" };
    /// Distance from a tile's edges to its sensors.
    inset_m: f32 = "sensor_inset_m", num(0.0..=2.5).explicit() => Geometry::default().sensor_inset_m();
}

/// The south-west corner of a part of a larger floor.
const FIRST: By<TileId> = By {
    shape: || FieldType::Words("(column, row), each a whole number from 0 to 4095"),
    read: |node, ()| {
        node.tuple("(column, row)").and_then(|[column, row]| tile(column, row, [0..FIRST_END, 0..FIRST_END]))
    },
    write: TILE.write,
    stand_in: TILE.stand_in,
};

/// Columns and rows of the larger floor.
const WHOLE: By<[u16; 2]> = By {
    shape: || FieldType::Words("(columns, rows), each a whole number from 1 to 4351"),
    read: |node, ()| {
        let sides = node.tuple::<2>("(columns, rows)")?;
        let [columns, rows] = sides.map(|side| side.whole(1..=WHOLE_MOST.into()));
        Some([columns? as u16, rows? as u16])
    },
    ..TILES
};

const WHOLE_MOST: u16 = Geometry::FARTHEST + Geometry::MAX_SIDE;

const FIRST_END: u16 = Geometry::FARTHEST + 1;

const SIDE: Num = num(1.0..=Geometry::MAX_SIDE as f64).explicit();

/// The measures of a floor among its fields.
pub(super) struct Measures;

impl Codec<Geometry> for Measures {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&Geometry>, context: &()) -> Option<Geometry> {
        node.record(None, context).map(|record: MeasuresRecord| record.built().unwrap_or_default())
    }

    fn write(&self, geometry: &Geometry) -> Text {
        let mut entries = Vec::new();
        self.write_field(geometry, "", None, &mut entries);
        Text::Record(MeasuresRecord::NAME, entries)
    }

    fn shape(&self) -> FieldType {
        FieldType::Record(MeasuresRecord::describe)
    }

    fn stand_in(&self) -> Geometry {
        Geometry::default()
    }

    fn read_field(
        &self,
        fields: &mut Fields<'_>,
        name: &'static str,
        _: Option<&Geometry>,
        _: Option<Geometry>,
        context: &(),
    ) -> Geometry {
        let record = MeasuresRecord::read_fields(fields, None, context);
        let built = fields.are_read().then(|| record.built()).and_then(|built| {
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
                    fields.fail(name);
                })
                .ok()
        });
        // After invalid measures, reading continues with those of the paper.
        built.unwrap_or_default()
    }

    fn write_field(
        &self,
        geometry: &Geometry,
        _: &'static str,
        _: Option<Geometry>,
        entries: &mut Vec<Entry>,
    ) {
        let record = MeasuresRecord {
            first: geometry.first(),
            whole: Some(geometry.whole()).filter(|whole| *whole != geometry.least_whole()).map(Into::into),
            columns: geometry.columns(),
            rows: geometry.rows(),
            tile_m: geometry.tile_m(),
            pitch_m: Some(geometry.pitch_m()),
            inset_m: geometry.sensor_inset_m(),
        };
        record.write_fields(entries);
    }

    fn describe_field(
        &self,
        _: &'static str,
        _: &[&str],
        _: Option<Geometry>,
        fields: &mut Vec<FieldDescription>,
    ) {
        fields.extend(MeasuresRecord::describe().fields);
    }
}

impl MeasuresRecord {
    fn built(&self) -> Result<Geometry, GeometryError> {
        let Self { first, whole, columns, rows, tile_m, pitch_m, inset_m } = *self;
        let built = Geometry::new(columns, rows, tile_m, pitch_m.unwrap_or(tile_m), inset_m);
        built.map(|geometry| geometry.beginning_at(first).within(whole.unwrap_or_default().into()))
    }
}

/// The tiles that are valid in a file: those on the floor, or all if its geometry could not be read.
#[derive(Clone, Copy)]
pub(super) struct ValidTiles(pub(super) Option<Geometry>);

impl Includes<Self> for ValidTiles {
    fn included(&self) -> &Self {
        self
    }
}

impl ValidTiles {
    fn tile(self, column: Node<'_>, row: Node<'_>) -> Option<TileId> {
        let block = self.0.map(|geometry| geometry.block());
        let any = 0..FIRST_END + Geometry::MAX_SIDE;
        tile(column, row, block.map_or([any.clone(), any], |block| [block.column_range(), block.row_range()]))
    }
}

/// Reads a tile within these columns and rows.
fn tile(column: Node<'_>, row: Node<'_>, [columns, rows]: [Range<u16>; 2]) -> Option<TileId> {
    let number = |name, node: Node<'_>, range: Range<u16>| {
        Node { name, ..node }.whole(range.start.into()..=u32::from(range.end) - 1)
    };
    let (column, row) = (number("column", column, columns), number("row", row, rows));
    Some(TileId::new(column? as u16, row? as u16))
}

/// A tile, as `(column, row)`.
pub(super) const TILE: By<TileId, ValidTiles> = By {
    shape: || FieldType::Words("(column, row), each a whole number from 0"),
    read: |node, valid| {
        let [column, row] = node.tuple("(column, row)")?;
        valid.tile(column, row)
    },
    write: |tile| Text::Tuple(whole([tile.column, tile.row])),
    stand_in: TileId::default,
};

fn whole(numbers: [u16; 2]) -> Vec<Text> {
    numbers.into_iter().map(|number| Text::Whole(number.into())).collect()
}

/// Width and depth in tiles, as `(columns, rows)`.
pub(super) const TILES: By<[u16; 2]> = By {
    shape: || FieldType::Words("(columns, rows), each a whole number from 1"),
    read: |node, ()| {
        let sides = node.tuple::<2>("(columns, rows)")?;
        let [columns, rows] = sides.map(|side| side.whole(1..=Geometry::MAX_SIDE.into()));
        Some([columns? as u16, rows? as u16])
    },
    write: |sides| Text::Tuple(whole(*sides)),
    stand_in: || [1, 1],
};

/// The sensor on a channel, as `(column, row, corner)`, or `None`.
pub(super) const CHANNEL: By<Option<SensorId>, ValidTiles> = By {
    shape: || FieldType::Words("(column, row, Sw), or None for a channel without a sensor"),
    read: |node, valid| {
        if node.is_none() {
            return Some(None);
        }
        let [column, row, name] = node.tuple("(column, row, corner)")?;
        let tile = valid.tile(column, row);
        let corner: Option<Corner> = Name.read(Node { name: "corner", ..name }, None, &());
        Some(Some(SensorId { tile: tile?, corner: corner? }))
    },
    write: |sensor| {
        sensor.map_or(Text::Nothing, |SensorId { tile, corner }| {
            let mut values = whole([tile.column, tile.row]);
            values.push(Name.write(&corner));
            Text::Tuple(values)
        })
    },
    stand_in: || None,
};

/// Lists of numbers, each from minus this value to this value.
pub(super) struct Table(pub(super) f32);

impl<const ROWS: usize, const COLUMNS: usize> Codec<[[f32; COLUMNS]; ROWS]> for Table {
    type Context = ();

    fn read(
        &self,
        node: Node<'_>,
        _: Option<&[[f32; COLUMNS]; ROWS]>,
        (): &(),
    ) -> Option<[[f32; COLUMNS]; ROWS]> {
        let most = f64::from(self.0);
        let number = |node: Node<'_>| node.number(-most..=most).map(|number| number.single);
        exactly(node, |row| exactly(row, number))
    }

    fn write(&self, table: &[[f32; COLUMNS]; ROWS]) -> Text {
        let row = |row: &[f32; COLUMNS]| Text::List(row.iter().copied().map(Text::Single).collect());
        Text::List(table.iter().map(row).collect())
    }

    fn shape(&self) -> FieldType {
        FieldType::Words("lists of numbers that were measured")
    }

    fn stand_in(&self) -> [[f32; COLUMNS]; ROWS] {
        [[0.0; COLUMNS]; ROWS]
    }
}

/// Reads all entries with `read`; `None` if their number is wrong or one of them could not be read.
fn exactly<'r, T, const COUNT: usize>(
    node: Node<'r>,
    read: impl Fn(Node<'r>) -> Option<T>,
) -> Option<[T; COUNT]> {
    let entries: Vec<Option<T>> = node.list(node.name, usize::MAX)?.into_iter().map(read).collect();
    if entries.len() != COUNT {
        let problem = Problem::error(node.span(), format!("`{}` has {} entries", node.name, entries.len()));
        node.report(problem.expected(format!("expected {COUNT}")));
        return None;
    }
    let entries: Option<Vec<T>> = entries.into_iter().collect();
    entries?.try_into().ok()
}

/// Pairs of a rising frequency in hertz and a gain within these two limits.
pub(super) struct Points(pub(super) f64, pub(super) f64);

impl Codec<Vec<(f32, f32)>> for Points {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&Vec<(f32, f32)>>, (): &()) -> Option<Vec<(f32, f32)>> {
        let nodes = node.list("point", Response::MOST_POINTS)?;
        if nodes.len() < 2 {
            let problem = Problem::error(node.span(), format!("`{}` has too few points", node.name));
            node.report(
                problem.expected("expected 2 or more").help("write [(50, -3.5), (100, 0), (750, -6)]"),
            );
            return None;
        }
        let single = |node: Node<'_>, range| node.number(range).map(|number| number.single);
        let mut last = 0.0;
        let mut point = |node: Node<'_>| {
            let [hz, gain] = node.tuple("(hertz, gain)")?;
            let hz = single(Node { name: "hertz", ..hz }, 1.0..=20_000.0);
            let gain = single(Node { name: "gain", ..gain }, self.0..=self.1);
            let (hz, gain) = (hz?, gain?);
            if hz <= last {
                let problem = Problem::error(node.span(), "the hertz of a response must rise");
                node.report(problem.expected(format!("expected more than {last}")));
                return None;
            }
            last = hz;
            Some((hz, gain))
        };
        let points: Vec<Option<(f32, f32)>> = nodes.into_iter().map(&mut point).collect();
        points.into_iter().collect()
    }

    fn write(&self, points: &Vec<(f32, f32)>) -> Text {
        let point = |&(hz, gain): &(f32, f32)| Text::Tuple(vec![Text::Single(hz), Text::Single(gain)]);
        Text::List(points.iter().map(point).collect())
    }

    fn shape(&self) -> FieldType {
        FieldType::Words("a list of 2 to 1024 pairs (hertz, gain), by frequency")
    }

    fn stand_in(&self) -> Vec<(f32, f32)> {
        Vec::new()
    }
}
