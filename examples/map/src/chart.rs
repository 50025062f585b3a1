//! Drawing of the map.

use eframe::egui::{Align2, Color32, FontId, Mesh, Painter, Pos2, Rect, Shape, Stroke, pos2, vec2};

use crate::mercator::{Screen, project};
use crate::names;
use crate::state::State;
use crate::world::{Bounds, HUES, World};

const SEA: Color32 = Color32::from_rgb(0xd3, 0xe3, 0xea);
const COAST: Stroke = Stroke { width: 1.1, color: Color32::from_rgb(0x6f, 0x8b, 0x99) };
const SHORE: Stroke = Stroke { width: 0.8, color: Color32::from_rgb(0x86, 0xa9, 0xbb) };
const RIVER: Color32 = Color32::from_rgb(0x93, 0xbb, 0xd0);
const BORDER: Stroke = Stroke { width: 0.9, color: Color32::from_rgb(0xb5, 0xa4, 0x8c) };
const GRID: Stroke = Stroke { width: 1.0, color: Color32::from_rgb(0xa9, 0xc3, 0xcf) };
const INK: Color32 = Color32::from_rgb(0x2a, 0x28, 0x25);
const HALO: Color32 = Color32::from_rgba_premultiplied(0xb4, 0xb2, 0xac, 0xb8);
const LAND: [Color32; HUES] = [
    Color32::from_rgb(0xf4, 0xec, 0xdb),
    Color32::from_rgb(0xe8, 0xe9, 0xd2),
    Color32::from_rgb(0xf3, 0xdf, 0xcd),
    Color32::from_rgb(0xea, 0xe1, 0xe6),
    Color32::from_rgb(0xf0, 0xe4, 0xb9),
];

/// Smallest distance between two points of a line that are both drawn, in points.
const FINE: f32 = 1.5;

/// Draws sea, land, lakes and rivers into `rect`.
pub fn shapes(painter: &Painter, rect: Rect, world: &World, state: &State) {
    let screen = Screen::new(rect, &state.camera);
    let zoom = state.camera.zoom;
    painter.rect_filled(rect, 0.0, SEA);
    let mut land = Mesh::default();
    for country in &world.countries {
        let color = LAND.get(country.hue % HUES).copied().unwrap_or(SEA);
        for area in &country.areas {
            for turn in screen.turns(area.bounds.span).filter(|_| screen.reaches(area.bounds.reach)) {
                area.fill(&mut land, color, |at| screen.point(at, turn));
            }
        }
    }
    painter.add(Shape::mesh(land));
    for river in world.rivers.iter().filter(|river| river.from <= zoom + 0.3) {
        // Wider at a higher zoom: a great river is three points wide at the highest.
        let width = (0.7 + river.width) * (1.0 + 0.15 * (zoom as f32 - 2.0));
        line(painter, &screen, &river.points, &river.bounds, Stroke::new(width.min(3.0), RIVER));
    }
    lakes(painter, &screen, world, zoom);
    for stretch in &world.lines {
        let stroke = if stretch.is_border { BORDER } else { COAST };
        line(painter, &screen, &stretch.points, &stretch.bounds, stroke);
    }
}

fn lakes(painter: &Painter, screen: &Screen, world: &World, zoom: f64) {
    let mut water = Mesh::default();
    let seen = || world.lakes.iter().filter(|lake| lake.from <= zoom + 0.3).flat_map(|lake| &lake.areas);
    for area in seen() {
        for turn in screen.turns(area.bounds.span).filter(|_| screen.reaches(area.bounds.reach)) {
            area.fill(&mut water, SEA, |at| screen.point(at, turn));
        }
    }
    painter.add(Shape::mesh(water));
    for area in seen() {
        for ring in area.rings() {
            line(painter, screen, ring, &area.bounds, SHORE);
        }
    }
}

/// A line at each place where it is visible.
fn line(painter: &Painter, screen: &Screen, points: &[[f64; 2]], bounds: &Bounds, stroke: Stroke) {
    for turn in screen.turns(bounds.span).filter(|_| screen.reaches(bounds.reach)) {
        let points = fine(points.iter().map(|at| screen.point(*at, turn)));
        if points.len() > 1 {
            painter.add(Shape::line(points, stroke));
        }
    }
}

/// Draws the layers over land and sea that are switched on, and the mark in the middle; `covered` are the areas that
/// other parts of the window will cover.
pub fn layers(painter: &Painter, rect: Rect, world: &World, state: &State, covered: &[Rect]) {
    let screen = Screen::new(rect, &state.camera);
    if state.grid {
        grid(painter, rect, &screen, state.camera.zoom);
    }
    if state.names {
        names::draw(painter, rect, &screen, world, state.camera.zoom, covered);
    }
    crosshair(painter, rect.center());
}

/// Drops points that are indistinguishable from the one before; the last one stays.
fn fine(points: impl Iterator<Item = Pos2>) -> Vec<Pos2> {
    let mut kept: Vec<Pos2> = Vec::new();
    let mut last = None;
    for point in points {
        if kept.last().is_none_or(|before| before.distance(point) > FINE) {
            kept.push(point);
            last = None;
        } else {
            last = Some(point);
        }
    }
    kept.extend(last);
    kept
}

fn grid(painter: &Painter, rect: Rect, screen: &Screen, zoom: f64) {
    let step = if zoom < 3.0 {
        30
    } else if zoom < 4.5 {
        10
    } else {
        5
    };
    for lon in (-180..180).step_by(step) {
        let [x, y] = project(f64::from(lon), 0.0);
        for turn in screen.turns([x, x]) {
            painter.vline(screen.point([x, y], turn).x, rect.y_range(), GRID);
        }
    }
    for lat in (-90 + step as i32..90).step_by(step) {
        painter.hline(rect.x_range(), screen.point(project(0.0, f64::from(lat)), 0.0).y, GRID);
    }
}

/// Marks the map's middle: the named place is there.
fn crosshair(painter: &Painter, at: Pos2) {
    painter.circle_stroke(at, 9.0, Stroke::new(4.0, HALO));
    painter.circle_stroke(at, 9.0, Stroke::new(1.6, INK));
    painter.circle_filled(at, 2.0, INK);
}

/// A bar labelled with its length in kilometres, from `corner` to the right.
pub fn scale_bar(painter: &Painter, rect: Rect, state: &State, corner: Pos2) {
    let screen = Screen::new(rect, &state.camera);
    let each = screen.kilometres(1.0);
    let lengths = [5000.0, 2000.0, 1000.0, 500.0, 200.0, 100.0, 50.0];
    let km = lengths.into_iter().find(|km| km / each < 170.0).unwrap_or(20.0);
    let width = (km / each) as f32;
    let (left, right) = (corner, corner + vec2(width, 0.0));
    let stroke = Stroke::new(2.0, INK);
    painter.line_segment([left, right], stroke);
    for end in [left, right] {
        painter.line_segment([end, pos2(end.x, end.y - 6.0)], stroke);
    }
    let font = FontId::proportional(13.0);
    painter.text(left - vec2(0.0, 8.0), Align2::LEFT_BOTTOM, format!("{km:.0} km"), font, INK);
}
