//! Countries: their areas, the places of their names, and colours that differ from those of neighbours.

use earcut::Earcut;

use super::area::{Area, Bounds, middle};
use super::atlas::CountryShape;
use super::unroll;

/// Number of hues.
pub const HUES: usize = 5;

pub struct Country {
    pub name: String,
    pub areas: Vec<Area>,
    /// The place of its name, and the width and size of its largest part, in worlds.
    pub middle: [f64; 2],
    pub width: f64,
    pub area: f64,
    /// Differs from the hue of each neighbour.
    pub hue: usize,
}

impl CountryShape {
    fn arcs(&self) -> impl Iterator<Item = usize> {
        self.polygons.iter().flatten().flatten().map(|arc| arc_index(*arc))
    }
}

fn arc_index(arc: i64) -> usize {
    (if arc < 0 { !arc } else { arc }) as usize
}

/// The countries that use each of the first `arcs` arcs.
pub fn users(shapes: &[CountryShape], arcs: usize) -> Vec<Vec<usize>> {
    let mut users: Vec<Vec<usize>> = vec![Vec::new(); arcs];
    for (country, shape) in shapes.iter().enumerate() {
        for arc in shape.arcs() {
            if let Some(users) = users.get_mut(arc).filter(|users| !users.contains(&country)) {
                users.push(country);
            }
        }
    }
    users
}

/// All countries with their hues.
pub fn all(shapes: &[CountryShape], arcs: &[Vec<[f64; 2]>], earcut: &mut Earcut<f64>) -> Vec<Country> {
    let hues = hues(shapes, &users(shapes, arcs.len()));
    let country = |(shape, hue)| Country { hue, ..Country::of(shape, arcs, earcut) };
    shapes.iter().zip(hues).map(country).collect()
}

/// A hue for each country, beginning with those with the most neighbours.
fn hues(shapes: &[CountryShape], users: &[Vec<usize>]) -> Vec<usize> {
    let neighbours: Vec<Vec<usize>> = shapes
        .iter()
        .enumerate()
        .map(|(index, shape)| {
            let mut beside: Vec<usize> =
                shape.arcs().filter_map(|arc| users.get(arc)).flatten().copied().collect();
            beside.retain(|other| *other != index);
            beside.sort_unstable();
            beside.dedup();
            beside
        })
        .collect();
    let mut order: Vec<usize> = (0..shapes.len()).collect();
    order.sort_by_key(|index| std::cmp::Reverse(neighbours.get(*index).map_or(0, Vec::len)));
    let mut hues: Vec<Option<usize>> = vec![None; shapes.len()];
    for index in order {
        let beside = neighbours.get(index).map_or(&[][..], Vec::as_slice);
        let is_taken = |hue: &usize| beside.iter().any(|other| hues.get(*other) == Some(&Some(*hue)));
        // The search begins at another hue for each; otherwise the first hue would cover most of the world.
        let own = (0..HUES).map(|hue| (hue + index) % HUES).find(|hue| !is_taken(hue));
        if let Some(hue) = hues.get_mut(index) {
            *hue = Some(own.unwrap_or(index % HUES));
        }
    }
    hues.into_iter().map(Option::unwrap_or_default).collect()
}

impl Country {
    fn of(shape: &CountryShape, arcs: &[Vec<[f64; 2]>], earcut: &mut Earcut<f64>) -> Self {
        let mut country = Self {
            name: shape.name.clone(),
            areas: Vec::new(),
            middle: [0.5; 2],
            width: 0.0,
            area: 0.0,
            hue: 0,
        };
        for polygon in &shape.polygons {
            let rings: Vec<Vec<[f64; 2]>> = polygon.iter().map(|ring| join(ring, arcs)).collect();
            if let Some(outer) = rings.first() {
                country.see_part(outer);
            }
            country.areas.push(Area::of(&rings, earcut));
        }
        country
    }

    /// Its name goes to the middle of its largest part.
    fn see_part(&mut self, ring: &[[f64; 2]]) {
        let (area, middle) = middle(ring);
        if area.abs() > self.area {
            let [west, east] = Bounds::of(ring).span;
            (self.area, self.middle, self.width) = (area.abs(), middle, east - west);
        }
    }

    pub fn contains(&self, [x, y]: [f64; 2]) -> bool {
        // A country that extends over the edge of the world is also beyond it.
        [x - 1.0, x, x + 1.0].iter().any(|x| self.areas.iter().any(|area| area.contains([*x, y])))
    }
}

/// One ring of several arcs, without their shared points; a ring around a pole goes along the world's edge.
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
