//! Appearance of the simulated grounds: one file per material.

mod ice;
mod loose;
mod noise;
mod wood;

use glam::Vec2;

use super::mark::Ink;
use super::theme::{BLACK, WHITE};
use super::{Faces, Scene, Theme, View};
use noise::TerrainNoise;
use underfoot::engine::Snapshot;
use underfoot::floor::Rect;
use underfoot::ground::{GroundMaterial, GroundState, Relief};
use underfoot::layout::{Colour, Ground};
use underfoot::units::Instant;

/// The colours of one ground in a theme.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LandColours {
    surface: Colour,
    deep: Colour,
    white: Colour,
    line: Colour,
}

impl LandColours {
    /// Returns the colours of `ground`. On a dark floor a ground is as dark as at night and its light stays bright, so
    /// that ice still looks like ice; with high contrast, only its bright lines stay.
    fn of(ground: &Ground, theme: &Theme) -> Self {
        let Ground { surface, deep, .. } = *ground;
        let dark = |colour: Colour, share: f32| colour.mix(BLACK, share);
        match theme.faces {
            Faces::OfLayout if !theme.is_dark() => Self { surface, deep, white: WHITE, line: deep },
            // Projected onto bare plates: black throws no light.
            Faces::OfLayout => {
                let [surface, deep, white] = [surface, deep, WHITE].map(|colour| dark(colour, 0.32));
                Self { surface, deep, white, line: deep }
            }
            Faces::Dark => Self {
                surface: dark(surface, 0.56),
                deep: dark(deep, 0.58),
                white: surface.mix(WHITE, 0.55).mix(BLACK, 0.14),
                line: dark(deep, 0.75),
            },
            Faces::Outlined => {
                let white = surface.mix(WHITE, 0.5);
                Self { surface: dark(surface, 0.74), deep: dark(deep, 0.92), white, line: white }
            }
        }
    }
}

/// True if a visible ground hides all of `cell`.
pub(super) fn hides(view: &View<'_>, cell: Rect) -> bool {
    view.layout
        .grounds
        .iter()
        .any(|ground| ground.spec.is_on(view.snapshot.page) && super::holds(ground.spec.area, cell))
}

/// True if a part of a visible ground lies in `area`.
pub(super) fn is_under(view: &View<'_>, area: Rect) -> bool {
    let mut grounds = view.layout.grounds.iter();
    grounds.any(|ground| ground.spec.is_on(view.snapshot.page) && ground.spec.area.overlaps(area))
}

/// Draws the grounds of the current page.
pub(super) fn draw(scene: &mut Scene, view: &View<'_>) {
    for (index, ground) in view.layout.grounds.iter().enumerate() {
        if !ground.spec.is_on(view.snapshot.page) {
            continue;
        }
        let land = Land::new(view, ground, view.snapshot.grounds.get(index), view.snapshot);
        match &ground.spec.material {
            GroundMaterial::Ice(spec) => ice::draw(scene, &land, spec),
            GroundMaterial::Grain(spec) => loose::draw(scene, &land, spec.grain),
            GroundMaterial::Wood(spec) => wood::draw(scene, &land, spec),
        }
        land.seams(scene, view);
    }
}

/// The current state of one ground.
struct Land<'a> {
    ground: &'a Ground,
    /// `None` before the first state.
    state: Option<&'a GroundState>,
    now: Instant,
    /// Deterministic noise for the constant features: the same ground always looks the same.
    noise: TerrainNoise,
    surface: Colour,
    deep: Colour,
    /// Light on the surface: crystals, edges of cracks, crests.
    white: Colour,
    /// Lines on the surface, such as the grain of wood.
    line: Colour,
    /// Number of grid points, eastwards and northwards.
    columns: u32,
    rows: u32,
}

impl<'a> Land<'a> {
    fn new(view: &View<'_>, ground: &'a Ground, state: Option<&'a GroundState>, snapshot: &Snapshot) -> Self {
        // Ignore the state of another layout's ground.
        let state =
            state.filter(|state| state.relief.size() == (0, 0) || state.relief.area() == ground.spec.area);
        let LandColours { surface, deep, white, line } = LandColours::of(ground, view.theme);
        let known = state.map(|state| state.relief.size()).filter(|size| *size != (0, 0));
        let plain = (ground.spec.area.size() / 0.04).ceil().as_uvec2() + 1;
        let (columns, rows) = known.unwrap_or((plain.x.clamp(2, 257), plain.y.clamp(2, 257)));
        Self {
            ground,
            state,
            now: snapshot.at,
            noise: TerrainNoise(ground.spec.seed),
            surface,
            deep,
            white,
            line,
            columns,
            rows,
        }
    }

    fn area(&self) -> Rect {
        self.ground.spec.area
    }

    /// Position of a grid point.
    fn point(&self, column: u32, row: u32) -> Vec2 {
        let share = Vec2::new(column as f32 / (self.columns - 1) as f32, row as f32 / (self.rows - 1) as f32);
        self.area().min + self.area().size() * share
    }

    /// Wear of a grid point, 0 to 1; points beyond the grid have the value of its edge.
    fn depth(&self, column: i64, row: i64) -> f32 {
        let relief: Option<&Relief> = self.state.map(|state| &state.relief);
        let column = column.clamp(0, i64::from(self.columns) - 1) as u32;
        let row = row.clamp(0, i64::from(self.rows) - 1) as u32;
        relief.map_or(0.0, |relief| relief.depth(column, row, self.now))
    }

    /// Shading of a point from the hollows around it, with the light in the north-west: difference of depth between
    /// the north-western and the south-eastern neighbour.
    fn slope(&self, column: u32, row: u32) -> f32 {
        let (column, row) = (i64::from(column), i64::from(row));
        self.depth(column - 1, row + 1) - self.depth(column + 1, row - 1)
    }

    /// Paints the whole area; `colour` gives the colour of each grid point.
    fn paint(&self, scene: &mut Scene, colour: impl Fn(u32, u32) -> Colour) {
        let points = (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (column, row)));
        let inks = points.map(|(column, row)| Ink::solid(colour(column, row)));
        scene.add_field(self.area(), self.columns, inks);
    }

    /// Draws the tile borders faintly: forces are still shown tile by tile.
    fn seams(&self, scene: &mut Scene, view: &View<'_>) {
        let (area, pitch_m) = (self.area(), view.geometry.pitch_m());
        let paint = super::Paint::stroke(super::Stroke::new(0.0012, Ink::faint(self.line, 0.16)));
        let lines = |low: f32, high: f32, pitch_m: f32| {
            let (first, last) =
                ((low / pitch_m).floor() as u32 + 1, (high / pitch_m - 1e-3).floor().max(0.0) as u32);
            (first..=last).map(move |line| line as f32 * pitch_m)
        };
        for x in lines(area.min.x, area.max.x, pitch_m.x) {
            scene.add_line(Vec2::new(x, area.min.y), Vec2::new(x, area.max.y), paint);
        }
        for y in lines(area.min.y, area.max.y, pitch_m.y) {
            scene.add_line(Vec2::new(area.min.x, y), Vec2::new(area.max.x, y), paint);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Mark;
    use super::*;
    use underfoot::floor::Geometry;
    use underfoot::ground::Crack;
    use underfoot::layout::Layout;
    use underfoot::schema::{Kinds, builtin_layout, parse_layout};

    fn shipped(name: &str) -> Layout {
        let text = builtin_layout(name).unwrap();
        parse_layout(text, name, &Kinds::builtin(), &Geometry::default()).unwrap().layout
    }

    fn drawn(layout: &Layout, snapshot: &Snapshot) -> Scene {
        let (geometry, mut scene) = (Geometry::default(), Scene::new());
        super::super::draw(&mut scene, &View::new(&geometry, layout, snapshot, &Theme::LIGHT));
        scene
    }

    fn bands(scene: &Scene) -> usize {
        scene.marks().iter().filter(|mark| matches!(mark, Mark::Band { .. })).count()
    }

    /// Two joined pieces that opened one second after the start.
    fn cracked() -> Snapshot {
        let piece = |from: [f32; 2], to: [f32; 2], number| Crack {
            from: from.into(),
            to: to.into(),
            energy_j: 1.0,
            born: Instant::from_millis(1000),
            number,
            line: 4,
            ..Crack::default()
        };
        let cracks = vec![piece([0.5, 0.5], [0.6, 0.5], 0), piece([0.6, 0.5], [0.65, 0.55], 1)];
        let grounds = vec![GroundState { cracks, ..GroundState::default() }];
        Snapshot { at: Instant::from_millis(1500), grounds, ..Snapshot::default() }
    }

    #[test]
    fn every_ground_is_drawn_within_its_area() {
        let layout = shipped("winter_walk");
        let scene = drawn(&layout, &Snapshot::default());
        let fields: Vec<Rect> = scene
            .marks()
            .iter()
            .filter_map(|mark| if let Mark::Field { area, .. } = mark { Some(*area) } else { None })
            .collect();
        // Wood is drawn with boxes.
        let wanted: Vec<Rect> = layout.grounds[1..].iter().map(|ground| ground.spec.area).collect();
        assert_eq!(fields, wanted);
        assert!(scene == drawn(&layout, &Snapshot::default()), "the same each time");
    }

    #[test]
    fn cracks_are_drawn_until_they_have_frozen_shut() {
        let layout = shipped("pond");
        let mut snapshot = cracked();
        assert!(bands(&drawn(&layout, &snapshot)) > 0);
        snapshot.at = Instant::from_millis(1000 + 90_000);
        assert_eq!(bands(&drawn(&layout, &snapshot)), 0);
    }

    #[test]
    fn a_ground_of_another_page_is_not_drawn() {
        let text = "Layout(version: 1, pages: [(id: \"a\", grounds: [Ice]), (id: \"b\")])";
        let loaded = parse_layout(text, "pages", &Kinds::builtin(), &Geometry::default()).unwrap();
        let mut snapshot = cracked();
        assert!(bands(&drawn(&loaded.layout, &snapshot)) > 0);
        snapshot.page = 1;
        let scene = drawn(&loaded.layout, &snapshot);
        assert!(!scene.marks().iter().any(|mark| matches!(mark, Mark::Field { .. } | Mark::Band { .. })));
    }
}
