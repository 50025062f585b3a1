//! A picture of load-cell measurements and fitted curves, a panel per tile.

use underfoot::floor::{Corner, LawKind, Rect, TileId};
use underfoot::glam::Vec2;
use underfoot::layout::Colour;
use underfoot::sense::{Judgement, SensorLoads, Verdict};
use underfoot_scene::scene::{Anchor, Ink, Lettering, Paint, Scene, Stroke, Theme};

/// Size of a panel's plotting area and of the space around it, in metres of the drawing.
const PANEL: Vec2 = Vec2::new(0.20, 0.15);
const GAP: Vec2 = Vec2::new(0.05, 0.055);
const EDGE_M: f32 = 0.045;
const HEADER_M: f32 = 0.05;
const LEGEND_M: f32 = 0.36;
/// Space for each formula after the first.
const LAW_M: f32 = 0.08;

/// Maximum number of points drawn per sensor; more would only overlap.
const MOST_POINTS: usize = 160;

/// One colour per corner, distinguishable in print and with colour blindness.
const COLOURS: [Colour; 4] = [
    Colour::rgb(0x1f, 0x5f, 0xa8),
    Colour::rgb(0xc7, 0x5b, 0x12),
    Colour::rgb(0x1d, 0x82, 0x5b),
    Colour::rgb(0x9b, 0x3f, 0x9b),
];

const THEME: Theme = Theme::LIGHT;

/// The axes of all panels.
struct Axes {
    most_n: f32,
    step_n: f32,
}

/// Draws the measurements of each tile's sensors and the laws fitted to them.
pub(super) fn draw(judged: &[(&SensorLoads, Judgement)]) -> Scene {
    let mut tiles: Vec<TileId> = judged.iter().map(|(loads, _)| loads.sensor.tile).collect();
    tiles.sort_by_key(|tile| (std::cmp::Reverse(tile.row), tile.column));
    tiles.dedup();
    // As on the floor if whole rows were measured, otherwise about as wide as high.
    let mut columns: Vec<u16> = tiles.iter().map(|tile| tile.column).collect();
    columns.sort_unstable();
    columns.dedup();
    let is_grid = tiles.len().is_multiple_of(columns.len().max(1));
    let wide = if is_grid { columns.len() } else { (tiles.len() as f32).sqrt().ceil() as usize }.clamp(1, 12);
    let high = tiles.len().div_ceil(wide);
    let axes = Axes::of(judged);
    let pitch = PANEL + GAP;
    let formulas = formulas(judged);
    let legend = LEGEND_M + LAW_M * (formulas.len() - 1) as f32;
    let width = (1.5 * EDGE_M + wide as f32 * pitch.x).max(2.0 * EDGE_M + legend);
    let size = Vec2::new(width, 1.2 * EDGE_M + HEADER_M + high as f32 * pitch.y);
    let mut scene = Scene::new();
    scene.clear(Rect::from_min_size(Vec2::ZERO, size), THEME.canvas);
    header(&mut scene, size, &formulas);
    for (number, tile) in tiles.into_iter().enumerate() {
        let (column, row) = ((number % wide) as f32, (number / wide) as f32);
        let top = size.y - EDGE_M - HEADER_M - row * pitch.y;
        let corner = Vec2::new(EDGE_M + 0.5 * GAP.x + column * pitch.x, top - PANEL.y - 0.012);
        let area = Rect::from_min_size(corner, PANEL);
        axes.draw(&mut scene, area, tile);
        for (loads, judgement) in judged.iter().filter(|(loads, _)| loads.sensor.tile == tile) {
            axes.sensor(&mut scene, area, loads, judgement);
        }
        complaints(&mut scene, area, judged, tile);
    }
    scene
}

fn text(scene: &mut Scene, at: Vec2, anchor: Anchor, size_m: f32, colour: Colour, text: &str) -> f32 {
    let lettering = Lettering::new(at, anchor, size_m, Ink::solid(colour));
    scene.add_text(lettering, format_args!("{text}"))
}

/// Formulas of the sensors' laws; the paper's if no law was found.
fn formulas(judged: &[(&SensorLoads, Judgement)]) -> Vec<&'static str> {
    let is_followed =
        |kind: &LawKind| judged.iter().any(|(_, judgement)| judgement.laws.chosen == Some(*kind));
    let followed: Vec<_> = LawKind::ALL.into_iter().filter(is_followed).map(LawKind::formula).collect();
    if followed.is_empty() { vec![LawKind::Exponential.formula()] } else { followed }
}

fn header(scene: &mut Scene, size: Vec2, formulas: &[&str]) {
    let mut at = Vec2::new(EDGE_M + 0.5 * GAP.x, size.y - EDGE_M - 0.008);
    let size_m = if formulas.len() > 1 { 0.011 } else { 0.017 };
    at.x += text(scene, at, Anchor::Start, size_m, THEME.ink, &formulas.join(",   ")) + 0.022;
    for (corner, colour) in Corner::ALL.into_iter().zip(COLOURS) {
        scene.add_circle(at + Vec2::new(0.004, 0.0045), 0.004, Paint::fill(Ink::solid(colour)));
        at.x += 0.012;
        at.x += text(scene, at, Anchor::Start, 0.013, THEME.ink, corner.name()) + 0.016;
    }
}

impl Axes {
    fn of(judged: &[(&SensorLoads, Judgement)]) -> Self {
        let forces = judged.iter().flat_map(|(loads, _)| loads.points.iter().map(|point| point.force.0));
        let most = forces.fold(10.0, f32::max);
        // 1, 2 or 5 times a power of ten, four to eight steps.
        let rough = most / 5.0;
        let power = 10.0f32.powf(rough.log10().floor());
        let step_n = power * [1.0, 2.0, 5.0, 10.0].into_iter().find(|s| s * power >= rough).unwrap_or(10.0);
        Self { most_n: step_n * (most / step_n).ceil(), step_n }
    }

    fn place(&self, area: Rect, volts: f32, force: f32) -> Vec2 {
        let share = Vec2::new(volts / 5.0, force / self.most_n).clamp(Vec2::ZERO, Vec2::ONE);
        area.min + area.size() * share
    }

    fn draw(&self, scene: &mut Scene, area: Rect, tile: TileId) {
        let hairline = Stroke::new(0.0006, Ink::solid(THEME.line));
        scene.add_box(area, 0.003, Paint::fill(Ink::solid(THEME.plate)).with_stroke(hairline));
        let title = format!("tile {tile}");
        text(scene, Vec2::new(area.min.x, area.max.y + 0.006), Anchor::Start, 0.012, THEME.ink, &title);
        for volts in 0_u8..=5 {
            let foot = self.place(area, f32::from(volts), 0.0);
            scene.add_line(foot, Vec2::new(foot.x, area.max.y), Paint::stroke(hairline));
            let label = if volts == 5 { "5 V".into() } else { volts.to_string() };
            text(scene, foot - Vec2::new(0.0, 0.0115), Anchor::Middle, 0.009, THEME.quiet, &label);
        }
        let steps = (self.most_n / self.step_n).round() as u16;
        for step in 0..=steps {
            let force = self.step_n * f32::from(step);
            let left = self.place(area, 0.0, force);
            scene.add_line(left, Vec2::new(area.max.x, left.y), Paint::stroke(hairline));
            let label = if step == steps { format!("{force} N") } else { force.to_string() };
            text(scene, left - Vec2::new(0.004, 0.003), Anchor::End, 0.009, THEME.quiet, &label);
        }
    }

    fn sensor(&self, scene: &mut Scene, area: Rect, loads: &SensorLoads, judgement: &Judgement) {
        let colour = COLOURS[loads.sensor.corner.index()];
        let stride = loads.points.len().div_ceil(MOST_POINTS).max(1);
        for point in loads.points.iter().step_by(stride) {
            let at = self.place(area, point.volts, point.force.0);
            scene.add_circle(at, 0.0013, Paint::fill(Ink::faint(colour, 0.45)));
        }
        if let Ok(fit) = judgement.fit {
            let law = fit.calibration;
            let curve = (0_u8..=100).map(|step| {
                let volts = 0.05 * f32::from(step);
                (volts, law.force_at(volts).0)
            });
            let inside = curve.take_while(|(_, force)| *force <= self.most_n);
            let stroke = Stroke::new(0.0011, Ink::solid(colour));
            let stroke =
                if judgement.verdict == Verdict::Good { stroke } else { stroke.dashed(0.005, 0.003) };
            scene.add_path(inside.map(|(v, f)| self.place(area, v, f)), false, Paint::stroke(stroke));
        }
    }
}

/// Writes the sensors of a tile that are not good, with their verdicts.
fn complaints(scene: &mut Scene, area: Rect, judged: &[(&SensorLoads, Judgement)], tile: TileId) {
    let mut at = area.min + Vec2::new(0.007, PANEL.y - 0.015);
    let of_tile = judged.iter().filter(|(loads, _)| loads.sensor.tile == tile);
    for (loads, judgement) in of_tile.filter(|(_, judgement)| judgement.verdict != Verdict::Good) {
        let colour = if judgement.verdict == Verdict::Poor { THEME.warning } else { THEME.fault };
        let residual = judgement.fit.map_or(String::new(), |fit| format!(", {:.0} %", 100.0 * fit.residual));
        let words = format!("{}: {}{residual}", loads.name, judgement.verdict.name());
        text(scene, at, Anchor::Start, 0.011, colour, &words);
        at.y -= 0.014;
    }
}
