//! The countries, lakes, rivers and cities of the world.

mod area;
mod atlas;
mod country;

use earcut::Earcut;

use crate::mercator::project;
pub use area::{Area, Bounds};
use atlas::Atlas;
pub use atlas::NoWorld;
pub use country::{Country, HUES};

/// The whole world.
pub struct World {
    pub countries: Vec<Country>,
    /// Coasts and borders.
    pub lines: Vec<Line>,
    pub lakes: Vec<Lake>,
    pub rivers: Vec<River>,
    /// The most important ones first.
    pub cities: Vec<City>,
}

/// A stretch of a coast or a border.
pub struct Line {
    pub points: Vec<[f64; 2]>,
    pub bounds: Bounds,
    /// Whether there is land on both sides.
    pub is_border: bool,
}

pub struct Lake {
    /// Empty for some.
    pub name: String,
    /// The zoom from which it is drawn.
    pub from: f64,
    pub areas: Vec<Area>,
    /// The place of its name.
    pub middle: [f64; 2],
}

pub struct River {
    pub points: Vec<[f64; 2]>,
    pub bounds: Bounds,
    /// The zoom from which it is drawn.
    pub from: f64,
    /// From 0.15 to 1.2.
    pub width: f32,
}

pub struct City {
    pub name: String,
    pub at: [f64; 2],
    /// The zoom from which its name is written.
    pub from: f64,
    pub is_capital: bool,
}

impl World {
    /// The world that comes with this program.
    ///
    /// # Errors
    /// Its file is damaged.
    pub fn shipped() -> Result<Self, NoWorld> {
        let atlas = Atlas::shipped()?;
        let mut earcut = Earcut::new();
        let arcs = atlas.arcs();
        let countries = country::all(&atlas.countries, &arcs, &mut earcut);
        let users = country::users(&atlas.countries, arcs.len());
        let line = |(mut points, users): (Vec<_>, &Vec<usize>)| {
            unroll(&mut points);
            Line { bounds: Bounds::of(&points), points, is_border: users.len() > 1 }
        };
        // Arcs without a country are the edge of the world.
        let used = arcs.into_iter().zip(&users).filter(|(_, users)| !users.is_empty());
        let lines = used.map(line).collect();
        let lakes = atlas.lakes.iter().map(|shape| {
            let polygons = shape.polygons.iter();
            let rings = |polygon: &Vec<Vec<[i64; 2]>>| -> Vec<Vec<[f64; 2]>> {
                polygon.iter().map(|ring| atlas.line(ring)).collect()
            };
            let outer = shape.polygons.first().and_then(|polygon| polygon.first());
            Lake {
                name: shape.name.clone(),
                from: lake_from(shape.rank),
                middle: outer.map_or([0.5; 2], |ring| area::middle(&atlas.line(ring)).1),
                areas: polygons.map(|polygon| Area::of(&rings(polygon), &mut earcut)).collect(),
            }
        });
        let lakes = lakes.collect();
        let rivers = atlas.rivers.iter().map(|river| {
            let points = atlas.line(&river.line);
            River { bounds: Bounds::of(&points), points, from: river.from, width: river.width }
        });
        let rivers = rivers.collect();
        let cities = atlas.cities.iter().map(|city| City {
            name: city.name.clone(),
            at: atlas.place(city.at),
            from: city.from,
            is_capital: city.is_capital,
        });
        let cities = cities.collect();
        Ok(Self { countries, lines, lakes, rivers, cities })
    }

    /// The country at a place given in degrees.
    pub fn country_at(&self, lon: f64, lat: f64) -> Option<&Country> {
        let place = project(lon, lat);
        self.countries.iter().find(|country| country.contains(place))
    }
}

/// The zoom from which a lake of this rank is drawn.
fn lake_from(rank: u8) -> f64 {
    match rank {
        0 => 2.0,
        1 | 2 => 2.5,
        3 => 3.0,
        4 => 3.5,
        _ => 4.0,
    }
}

/// Continues a line that crosses the edge of the world beyond it.
fn unroll(line: &mut [[f64; 2]]) {
    let mut last = line.first().map_or(0.5, |at| at[0]);
    for at in line {
        at[0] -= (at[0] - last).round();
        last = at[0];
    }
}

#[cfg(test)]
mod tests;
