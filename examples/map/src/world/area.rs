//! Areas as triangles.

use earcut::Earcut;
use eframe::egui::{Color32, Mesh, Pos2};

/// The extent of a shape in the world: west, east, north and south.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub span: [f64; 2],
    pub reach: [f64; 2],
}

impl Bounds {
    pub fn of(points: &[[f64; 2]]) -> Self {
        let along = |axis: usize| {
            points
                .iter()
                .fold([f64::MAX, f64::MIN], |[least, most], at| [least.min(at[axis]), most.max(at[axis])])
        };
        Self { span: along(0), reach: along(1) }
    }

    fn contains(&self, [x, y]: [f64; 2]) -> bool {
        (self.span[0]..=self.span[1]).contains(&x) && (self.reach[0]..=self.reach[1]).contains(&y)
    }
}

/// A polygon with holes.
#[derive(Debug)]
pub struct Area {
    /// Places in the world; three indices each form a triangle.
    corners: Vec<[f64; 2]>,
    triangles: Vec<u32>,
    /// Index of each ring's first corner.
    starts: Vec<usize>,
    pub bounds: Bounds,
}

impl Area {
    /// The area inside the first ring and outside the others.
    pub fn of(rings: &[Vec<[f64; 2]>], earcut: &mut Earcut<f64>) -> Self {
        let mut starts = Vec::new();
        let mut corners: Vec<[f64; 2]> = Vec::new();
        for ring in rings {
            starts.push(corners.len());
            corners.extend(ring);
        }
        let holes: Vec<u32> = starts.iter().skip(1).map(|start| *start as u32).collect();
        let mut triangles = Vec::new();
        earcut.earcut(corners.iter().copied(), &holes, &mut triangles);
        let bounds = Bounds::of(&corners);
        Self { corners, triangles, starts, bounds }
    }

    /// Its outline and those of its holes.
    pub fn rings(&self) -> impl Iterator<Item = &[[f64; 2]]> {
        let ends = self.starts.iter().skip(1).copied().chain([self.corners.len()]);
        self.starts.iter().zip(ends).filter_map(|(start, end)| self.corners.get(*start..end))
    }

    /// Whether a place is in it; coordinates may lie beyond the edge of the world.
    pub fn contains(&self, at: [f64; 2]) -> bool {
        self.bounds.contains(at) && self.covers(at)
    }

    fn covers(&self, [x, y]: [f64; 2]) -> bool {
        self.triangles.as_chunks::<3>().0.iter().any(|triangle| {
            let [a, b, c] = triangle.map(|at| self.corners.get(at as usize).copied().unwrap_or_default());
            let side = |a: [f64; 2], b: [f64; 2]| (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
            let sides = [side(a, b), side(b, c), side(c, a)];
            sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
        })
    }

    /// Adds it to `mesh` in one colour; `place` maps its corners.
    pub fn fill(&self, mesh: &mut Mesh, color: Color32, place: impl Fn([f64; 2]) -> Pos2) {
        let first = mesh.vertices.len() as u32;
        for corner in &self.corners {
            mesh.colored_vertex(place(*corner), color);
        }
        mesh.indices.extend(self.triangles.iter().map(|index| index + first));
    }
}

/// Size and middle of a ring, both with the same sign: twice the sum over its triangles.
pub fn middle(ring: &[[f64; 2]]) -> (f64, [f64; 2]) {
    let pairs = ring.iter().zip(ring.iter().skip(1).chain(ring.first()));
    let (mut area, mut x, mut y) = (0.0, 0.0, 0.0);
    for (a, b) in pairs {
        let cross = a[0] * b[1] - b[0] * a[1];
        area += cross / 2.0;
        x += (a[0] + b[0]) * cross / 6.0;
        y += (a[1] + b[1]) * cross / 6.0;
    }
    (area, [x / area, y / area])
}
