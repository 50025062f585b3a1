//! The places of tiles and sensors in floor files.

use std::ops::Range;

use glam::Vec2;

use super::fields::Fields;
use super::floor_codecs::{TILES, tile, whole};
use super::floor_plates::{HOLES, HoleRecord, PLATES, PlateRecord, SENSOR_PLACES, blocks};
use super::node::Node;
use super::problem::Problem;
use crate::floor::{Geometry, GeometryError, SensorPlaces, SensorPlacesError, TileId};
use underfoot_format::codec::By;
use underfoot_format::describe::{FieldDescription, FieldType};
use underfoot_format::text::{Entry, RonText};
use underfoot_format::{Codec, Follow, Num, Opt, Record, num, record};

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
    /// Side of a tile, or its width and depth.
    tile: Vec2 = "tile_m", TILE_SIDES => Geometry::default().tile_m();
    /// Distance between the centres of neighbouring tiles, or the distances east and north.
    pitch: Option<Vec2> = "pitch_m", Follow { explicit: Opt(PITCHES), otherwise: "as `tile_m`" };
    /// Distance from a tile's edges to the sensors near its corners.
    inset_m: Option<f32> = "sensor_inset_m", Inset(num(0.0..=2.5));
    /// Places of the three or four sensors under each plate, from its centre, instead of corners; of four, the first
    /// lies opposite the last.
    sensors: Option<Vec<Vec2>> = "sensors_m", Opt(SENSOR_PLACES) => None;
    /// Cells of the grid without a tile.
    missing: Vec<HoleRecord> = "missing", HOLES => Vec::new();
    /// Plates that differ from the others.
    plates: Vec<PlateRecord> = "plates", PLATES => Vec::new();
}

/// The south-west corner of a part of a larger floor.
const FIRST: By<TileId> = By {
    shape: || FieldType::Words("(column, row), each a whole number from 0 to 4095"),
    read: |node, ()| {
        node.tuple("(column, row)").and_then(|[column, row]| tile(column, row, [0..FIRST_END, 0..FIRST_END]))
    },
    write: |tile| RonText::Tuple(whole([tile.column, tile.row])),
    stand_in: TileId::default,
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

/// Distance of the sensors from the edges where nothing else is written (m): the paper's.
const INSET_M: f32 = 0.02;

/// One number for both sides of squares, or `(width, depth)`; always written.
struct Sides {
    each: Num,
    about: &'static str,
}

const TILE_SIDES: Sides = Sides {
    each: num(0.05..=5.0),
    about: "a number from 0.05 to 5 m, or (width, depth), each such a number",
};

const PITCHES: Sides = Sides {
    each: num(0.05..=10.0),
    about: "a number from 0.05 to 10 m, or (east, north), each such a number",
};

impl Codec<Vec2> for Sides {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&Vec2>, context: &()) -> Option<Vec2> {
        let single = |node: Node<'_>| Codec::<f32>::read(&self.each, node, None, context);
        if !node.is_tuple() {
            return single(node).map(Vec2::splat);
        }
        let [width, depth] = node.tuple("(width, depth)")?.map(single);
        Some(Vec2::new(width?, depth?))
    }

    fn write(&self, sides: &Vec2) -> RonText {
        let [width, depth] = sides.to_array().map(|side| self.each.write(&side));
        if sides.x == sides.y { width } else { RonText::Tuple(vec![width, depth]) }
    }

    fn shape(&self) -> FieldType {
        FieldType::Words(self.about)
    }

    fn stand_in(&self) -> Vec2 {
        Vec2::splat(Codec::<f32>::stand_in(&self.each))
    }

    fn write_field(&self, value: &Vec2, name: &'static str, _: Option<Vec2>, entries: &mut Vec<Entry>) {
        entries.push((name, self.write(value)));
    }
}

/// The distance of sensors from edges: not written where their places are.
struct Inset(Num);

impl Codec<Option<f32>> for Inset {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&Option<f32>>, context: &()) -> Option<Option<f32>> {
        Codec::<f32>::read(&self.0, node, None, context).map(Some)
    }

    fn write(&self, value: &Option<f32>) -> RonText {
        value.map_or(RonText::Nothing, |value| self.0.write(&value))
    }

    fn shape(&self) -> FieldType {
        Codec::<f32>::shape(&self.0)
    }

    fn stand_in(&self) -> Option<f32> {
        None
    }

    fn read_field(
        &self,
        fields: &mut Fields<'_>,
        name: &'static str,
        _: Option<&Option<f32>>,
        _: Option<Option<f32>>,
        context: &(),
    ) -> Option<f32> {
        let node = fields.take(name)?;
        let read = self.read(node, None, context);
        if read.is_none() {
            fields.fail(name);
        }
        read.flatten()
    }

    fn write_field(
        &self,
        value: &Option<f32>,
        name: &'static str,
        _: Option<Option<f32>>,
        entries: &mut Vec<Entry>,
    ) {
        entries.extend(value.map(|value| (name, self.0.write(&value))));
    }

    fn describe_field(
        &self,
        name: &'static str,
        about: &[&str],
        _: Option<Option<f32>>,
        fields: &mut Vec<FieldDescription>,
    ) {
        self.0.describe_field(name, about, Some(INSET_M), fields);
    }
}

/// The measures of a floor among its fields.
pub(super) struct Measures;

impl Codec<Geometry> for Measures {
    type Context = ();

    fn read(&self, node: Node<'_>, _: Option<&Geometry>, context: &()) -> Option<Geometry> {
        let record: MeasuresRecord = node.record(None, context)?;
        Some(record.built().unwrap_or_default())
    }

    fn write(&self, geometry: &Geometry) -> RonText {
        let mut entries = Vec::new();
        self.write_field(geometry, "", None, &mut entries);
        RonText::Record(MeasuresRecord::NAME, entries)
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
        if fields.are_read() {
            match record.built() {
                Ok(geometry) => return geometry,
                Err(misfit) => {
                    let at = misfit.at.unwrap_or_else(|| fields.span(misfit.field));
                    let problem = Problem::error(at, misfit.message).expected("no such floor can be built");
                    fields.report(problem.help_if(misfit.help.map(str::to_owned)));
                    fields.fail(name);
                }
            }
        }
        // After invalid measures, reading continues with those of the paper.
        Geometry::default()
    }

    fn write_field(
        &self,
        geometry: &Geometry,
        _: &'static str,
        _: Option<Geometry>,
        entries: &mut Vec<Entry>,
    ) {
        let inset_m = geometry.sensor_inset_m();
        let usual = geometry.sensor_places(NO_TILE).as_slice();
        let record = MeasuresRecord {
            first: geometry.first(),
            whole: Some(geometry.whole()).filter(|whole| *whole != geometry.least_whole()).map(Into::into),
            columns: geometry.columns(),
            rows: geometry.rows(),
            tile: geometry.tile_m(),
            pitch: Some(geometry.pitch_m()),
            inset_m,
            sensors: inset_m.is_none().then(|| usual.to_vec()),
            missing: blocks(geometry).into_iter().map(HoleRecord::of).collect(),
            plates: geometry.own_plates().iter().map(|plate| PlateRecord::of(plate, geometry)).collect(),
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

/// A tile that no floor has: its plate is like all that have no measures of their own.
const NO_TILE: TileId = TileId::new(u16::MAX, u16::MAX);

/// A measure that no floor can have, and its place in the text.
#[derive(Debug)]
pub(super) struct Misfit {
    field: &'static str,
    /// The entry of a list that it stands in.
    pub(super) at: Option<Range<usize>>,
    message: String,
    help: Option<&'static str>,
}

impl From<GeometryError> for Misfit {
    fn from(error: GeometryError) -> Self {
        let (field, help) = match error {
            GeometryError::Grid { .. } => ("columns", None),
            GeometryError::Tile(_) => ("tile_m", None),
            GeometryError::Pitch(_) => ("pitch_m", None),
            GeometryError::Inset(_) => ("sensor_inset_m", None),
            GeometryError::SensorOff { .. } => {
                ("sensors_m", Some("places count from the plate's centre, in metres east and north"))
            }
            GeometryError::OwnSize { .. } => {
                ("plates", Some("plates lie in the middle of their cells, which are one `pitch_m` large"))
            }
            GeometryError::NoTile => ("missing", Some("leave at least one tile")),
        };
        Self { field, at: None, message: error.to_string(), help }
    }
}

impl From<SensorPlacesError> for Misfit {
    fn from(error: SensorPlacesError) -> Self {
        Self { field: "sensors_m", at: None, message: error.to_string(), help: Some(error.help()) }
    }
}

impl MeasuresRecord {
    fn built(&self) -> Result<Geometry, Misfit> {
        let Self { first, whole, columns, rows, tile, pitch, inset_m, .. } = *self;
        if let (Some(_), Some(_)) = (&self.sensors, inset_m) {
            let message = "there is `sensor_inset_m` or `sensors_m`, not both".to_owned();
            return Err(Misfit { field: "sensor_inset_m", at: None, message, help: None });
        }
        // Without a distance from the edges, that of small plates is not the paper's.
        let inset_m = inset_m.unwrap_or(if self.sensors.is_some() { 0.0 } else { INSET_M });
        let even = Geometry::of_plates(columns, rows, tile, pitch.unwrap_or(tile), inset_m)?;
        let even = match &self.sensors {
            Some(places) => even.with_sensors(SensorPlaces::at(places)?)?,
            None => even,
        };
        let even = even.beginning_at(first).within(whole.unwrap_or_default().into());
        let holes = self.missing.iter().map(|hole| hole.block(&even)).collect::<Result<Vec<_>, _>>()?;
        let plates = self.plates.iter().map(|plate| plate.plate(&even)).collect::<Result<Vec<_>, _>>()?;
        for (plate, record) in plates.iter().zip(&self.plates) {
            even.check_plate(plate).map_err(|error| record.misfit(error))?;
        }
        Ok(even.with_uneven(&holes, &plates)?)
    }
}

impl Misfit {
    /// The same at the entry `at` of a list.
    pub(super) fn in_entry(self, at: Range<usize>) -> Self {
        Self { at: Some(at), ..self }
    }

    /// A measure in the entry `at` of the list `field`.
    pub(super) const fn of(
        field: &'static str,
        at: Range<usize>,
        message: String,
        help: &'static str,
    ) -> Self {
        Self { field, at: Some(at), message, help: Some(help) }
    }
}
