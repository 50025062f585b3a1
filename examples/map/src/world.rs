//! The countries of the world, from Natural Earth's shapes.

use earcut::Earcut;
use eframe::egui::{Mesh, Pos2};
use serde::Deserialize;

use crate::mercator::project;

/// Admin 0 countries at 1:110 million, as TopoJSON; see the notice beside it.
const SHAPES: &str = include_str!("../data/countries-110m.json");

/// The whole world.
pub struct World {
    pub countries: Vec<Country>,
    pub lines: Vec<Line>,
}

/// A stretch of a coast or a border.
pub struct Line {
    pub points: Vec<[f64; 2]>,
    pub span: [f64; 2],
    /// Whether land is on both sides.
    pub is_border: bool,
}

pub struct Country {
    pub name: String,
    /// Triangles: places in the world, three of which each belong together by index.
    pub corners: Vec<[f64; 2]>,
    pub triangles: Vec<u32>,
    pub span: [f64; 2],
    /// Where its name stands, how wide its largest part is and how large that is, in worlds.
    pub middle: [f64; 2],
    pub width: f64,
    pub area: f64,
    /// No neighbour has the same.
    pub hue: usize,
}

#[derive(Deserialize)]
struct Topology {
    transform: Transform,
    arcs: Vec<Vec<[i64; 2]>>,
    objects: Objects,
}

#[derive(Deserialize)]
struct Transform {
    scale: [f64; 2],
    translate: [f64; 2],
}

#[derive(Deserialize)]
struct Objects {
    countries: Collection,
}

#[derive(Deserialize)]
struct Collection {
    geometries: Vec<Geometry>,
}

#[derive(Deserialize)]
struct Geometry {
    properties: Properties,
    #[serde(flatten)]
    shape: Shape,
}

#[derive(Deserialize)]
struct Properties {
    name: String,
}

/// Polygons of rings of arcs; an arc that is run through backwards is written as its complement.
#[derive(Deserialize)]
#[serde(tag = "type", content = "arcs")]
enum Shape {
    Polygon(Vec<Vec<i64>>),
    MultiPolygon(Vec<Vec<Vec<i64>>>),
}

impl Geometry {
    fn polygons(&self) -> &[Vec<Vec<i64>>] {
        match &self.shape {
            Shape::Polygon(polygon) => std::slice::from_ref(polygon),
            Shape::MultiPolygon(polygons) => polygons,
        }
    }

    fn arcs(&self) -> impl Iterator<Item = usize> {
        self.polygons().iter().flatten().flatten().map(|arc| arc_index(*arc))
    }
}

fn arc_index(arc: i64) -> usize {
    (if arc < 0 { !arc } else { arc }) as usize
}

impl World {
    /// The world that comes with this program.
    ///
    /// # Errors
    /// If the shapes are not TopoJSON.
    pub fn shipped() -> Result<Self, serde_json::Error> {
        let topology: Topology = serde_json::from_str(SHAPES)?;
        let arcs: Vec<Vec<[f64; 2]>> = topology.arcs.iter().map(|arc| topology.transform.undo(arc)).collect();
        let shapes = &topology.objects.countries.geometries;
        let mut users: Vec<Vec<usize>> = vec![Vec::new(); arcs.len()];
        for (country, shape) in shapes.iter().enumerate() {
            for arc in shape.arcs() {
                if let Some(users) = users.get_mut(arc).filter(|users| !users.contains(&country)) {
                    users.push(country);
                }
            }
        }
        let mut earcut = Earcut::new();
        let mut countries: Vec<Country> = Vec::new();
        for (index, shape) in shapes.iter().enumerate() {
            let mut country = Country::of(shape, &arcs, &mut earcut);
            let beside =
                |other: &usize| shape.arcs().any(|arc| users.get(arc).is_some_and(|all| all.contains(other)));
            let taken: Vec<usize> =
                (0..index).filter(beside).filter_map(|other| countries.get(other)).map(|it| it.hue).collect();
            // Begins elsewhere for each, or the first hue would have most of the world.
            let hues = (0..8).map(|hue| (hue + index) % HUES).take(HUES);
            country.hue = hues.chain(0..).find(|hue| !taken.contains(hue)).unwrap_or_default();
            countries.push(country);
        }
        let line = |(mut points, users): (Vec<_>, &Vec<usize>)| {
            unroll(&mut points);
            Line { span: span(&points), points, is_border: users.len() > 1 }
        };
        let lines = arcs.into_iter().zip(&users).map(line).collect();
        Ok(Self { countries, lines })
    }

    /// The country at a place given in degrees.
    pub fn country_at(&self, lon: f64, lat: f64) -> Option<&Country> {
        let place = project(lon, lat);
        self.countries.iter().find(|country| country.contains(place))
    }
}

/// Hues that countries have by turns.
pub const HUES: usize = 5;

impl Transform {
    /// The places of an arc, whose points are written as ways from the one before.
    fn undo(&self, arc: &[[i64; 2]]) -> Vec<[f64; 2]> {
        let mut at = [0, 0];
        let degrees = |at: [i64; 2], axis: usize| at[axis] as f64 * self.scale[axis] + self.translate[axis];
        arc.iter()
            .map(|step| {
                at = [at[0] + step[0], at[1] + step[1]];
                project(degrees(at, 0), degrees(at, 1))
            })
            .collect()
    }
}

impl Country {
    fn of(shape: &Geometry, arcs: &[Vec<[f64; 2]>], earcut: &mut Earcut<f64>) -> Self {
        let mut country = Self {
            name: shape.properties.name.clone(),
            corners: Vec::new(),
            triangles: Vec::new(),
            span: [0.0; 2],
            middle: [0.5; 2],
            width: 0.0,
            area: 0.0,
            hue: 0,
        };
        let mut found = Vec::new();
        for polygon in shape.polygons() {
            let mut points: Vec<[f64; 2]> = Vec::new();
            let mut holes: Vec<u32> = Vec::new();
            for (index, ring) in polygon.iter().enumerate() {
                let ring = join(ring, arcs);
                if index == 0 {
                    country.see_part(&ring);
                } else {
                    holes.push(points.len() as u32);
                }
                points.extend(ring);
            }
            earcut.earcut(points.iter().copied(), &holes, &mut found);
            let first = country.corners.len() as u32;
            country.triangles.extend(found.iter().map(|index| index + first));
            country.corners.extend(points);
        }
        country.span = span(&country.corners);
        country
    }

    /// Its name goes to the centroid of its largest part.
    fn see_part(&mut self, ring: &[[f64; 2]]) {
        let pairs = ring.iter().zip(ring.iter().skip(1).chain(ring.first()));
        let (mut area, mut x, mut y) = (0.0, 0.0, 0.0);
        for (a, b) in pairs {
            let cross = a[0] * b[1] - b[0] * a[1];
            area += cross / 2.0;
            x += (a[0] + b[0]) * cross / 6.0;
            y += (a[1] + b[1]) * cross / 6.0;
        }
        if area.abs() > self.area {
            let [west, east] = span(ring);
            (self.area, self.middle, self.width) = (area.abs(), [x / area, y / area], east - west);
        }
    }

    fn contains(&self, [x, y]: [f64; 2]) -> bool {
        // A country that reaches over the edge of the world is also beyond it.
        [x - 1.0, x, x + 1.0].iter().any(|x| self.covers([*x, y]))
    }

    fn covers(&self, [x, y]: [f64; 2]) -> bool {
        self.triangles.chunks_exact(3).any(|triangle| {
            let corner = |index: usize| {
                triangle.get(index).and_then(|at| self.corners.get(*at as usize)).copied().unwrap_or_default()
            };
            let side = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
            let [a, b, c] = [corner(0), corner(1), corner(2)];
            let sides = [side(a, b), side(b, c), side(c, a)];
            sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
        })
    }

    /// Adds it to `mesh` in one colour, its corners where `place` says.
    pub fn fill(&self, mesh: &mut Mesh, color: eframe::egui::Color32, place: impl Fn([f64; 2]) -> Pos2) {
        let first = mesh.vertices.len() as u32;
        for corner in &self.corners {
            mesh.colored_vertex(place(*corner), color);
        }
        mesh.indices.extend(self.triangles.iter().map(|index| index + first));
    }
}

/// One ring of several arcs, without the points that two of them share; one around a pole goes along its edge.
fn join(ring: &[i64], arcs: &[Vec<[f64; 2]>]) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for arc in ring {
        let Some(found) = arcs.get(arc_index(*arc)) else { continue };
        points.pop();
        if *arc < 0 { points.extend(found.iter().rev()) } else { points.extend(found) }
    }
    unroll(&mut points);
    match (points.first().copied(), points.pop()) {
        (Some(first), Some(last)) if (last[0] - first[0]).abs() > 0.5 => {
            points.extend([last, [last[0], 1.0], [first[0], 1.0]]);
        }
        _ => {}
    }
    points
}

/// Lets a line that crosses the edge of the world go on beyond it.
fn unroll(line: &mut [[f64; 2]]) {
    let mut last = line.first().map_or(0.5, |at| at[0]);
    for at in line {
        at[0] -= (at[0] - last).round();
        last = at[0];
    }
}

/// From where to where something lies, west and east.
fn span(points: &[[f64; 2]]) -> [f64; 2] {
    points.iter().fold([f64::MAX, f64::MIN], |[west, east], at| [west.min(at[0]), east.max(at[0])])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mercator::unproject;

    #[test]
    fn places_are_in_their_countries_and_neighbours_differ() {
        let world = World::shipped().unwrap();
        let at = |lon, lat| world.country_at(lon, lat).map(|country| country.name.as_str());
        assert_eq!(at(2.35, 48.85), Some("France"));
        assert_eq!(at(139.0, 36.0), Some("Japan"));
        assert_eq!(at(28.2, -29.6), Some("Lesotho"), "a hole of South Africa");
        assert_eq!(at(-30.0, 40.0), None);
        assert_eq!(
            (at(-175.0, 66.0), at(175.0, 67.0)),
            (Some("Russia"), Some("Russia")),
            "over the date line"
        );
        assert_eq!(
            (at(-90.0, 60.5), at(-105.0, 60.0), at(100.0, -80.0)),
            (None, Some("Canada"), Some("Antarctica"))
        );
        let hue = |name: &str| world.countries.iter().find(|country| country.name == name).unwrap().hue;
        for (one, other) in
            [("France", "Germany"), ("Spain", "Portugal"), ("Canada", "United States of America")]
        {
            assert_ne!(hue(one), hue(other), "{one} and {other}");
        }
        assert!(world.countries.iter().all(|country| country.hue < 8 && country.area > 0.0));
        let (lon, lat) =
            unproject(world.countries.iter().find(|country| country.name == "Brazil").unwrap().middle);
        assert_eq!(at(lon, lat), Some("Brazil"));
    }
}
