//! Clear ice over dark water: thick and thin places, bubbles, and cracks with their planes in the ice.

use glam::Vec2;

use super::super::Scene;
use super::super::mark::{Ink, Paint, Stroke};
use super::Land;
use underfoot::ground::{Crack, IceSpec};
use underfoot::layout::Colour;

pub(super) fn draw(scene: &mut Scene, land: &Land<'_>, spec: &IceSpec) {
    body(scene, land, spec);
    old_lines(scene, land);
    bubbles(scene, land);
    let Some(state) = land.state else { return };
    let detail = Detail::of(state.cracks.len());
    for pass in [Pass::Plane, Pass::Gap, Pass::Edge] {
        for line in state.cracks.chunk_by(|one, next| one.line == next.line) {
            self::line(scene, land, spec, line, (pass, detail));
        }
    }
    for seed in &state.seeds {
        let fresh = freshness(land, spec, seed.latest);
        star(scene, land, (seed.number, seed.at, seed.energy_j), fresh, detail);
    }
}

/// Visibility of an event at the time `then`, 0 to 1.
fn freshness(land: &Land<'_>, spec: &IceSpec, then: underfoot::units::Instant) -> f32 {
    Crack { born: then, ..Crack::default() }.openness(land.now, spec.sheet.refreeze_s)
}

/// The sheet: lighter where it is thick, dark where it is broken, white where it is crushed.
fn body(scene: &mut Scene, land: &Land<'_>, spec: &IceSpec) {
    let area = land.area();
    // Crushed ice around each seed, computed first: seeds are few and each affects only some points.
    let count = (land.columns * land.rows) as usize;
    let mut crushed = vec![0.0_f32; count];
    let cell = area.size() / Vec2::new((land.columns - 1) as f32, (land.rows - 1) as f32);
    for seed in land.state.map_or(&[][..], |state| state.seeds.as_slice()) {
        let fresh = freshness(land, spec, seed.latest);
        let radius = 0.035 + 0.014 * seed.energy_j.max(0.0).sqrt().min(4.0);
        let most = (0.30 + 0.10 * seed.energy_j.max(0.0).sqrt()).min(0.85) * fresh;
        let middle = (seed.at - area.min) / cell;
        let reach = 2.2 * radius / cell;
        let low = (middle - reach).ceil().max(Vec2::ZERO).as_uvec2();
        let high = (middle + reach).floor().max(Vec2::ZERO).as_uvec2();
        for row in low.y..=high.y.min(land.rows - 1) {
            for column in low.x..=high.x.min(land.columns - 1) {
                let away = (Vec2::new(column as f32, row as f32) - middle) * cell / radius;
                let own = most * (-away.length_squared()).exp();
                if let Some(point) = crushed.get_mut((row * land.columns + column) as usize) {
                    *point = 1.0 - (1.0 - *point) * (1.0 - own);
                }
            }
        }
    }
    land.paint(scene, |column, row| {
        let at = land.point(column, row);
        let hills = 0.62 * land.noise.hills(1, at, 0.58)
            + 0.30 * land.noise.hills(2, at, 0.21)
            + 0.14 * land.noise.hills(3, at, 0.085);
        // Light from beyond the north-west corner.
        let light = (at - area.centre()).dot(Vec2::new(-0.7, 0.7)) / area.size().length();
        let thick = (0.53 + 0.30 * hills + 0.20 * light).clamp(0.12, 0.96);
        let broken = land.depth(i64::from(column), i64::from(row));
        let ice = land.deep.mix(land.surface, thick * (1.0 - 0.80 * broken));
        let white = crushed.get((row * land.columns + column) as usize).copied().unwrap_or(0.0);
        // Frost at the edges.
        let bank = (at - area.min).min(area.max - at).min_element();
        let frost = 0.42 * (-bank / 0.035).exp() * (1.0 + 0.5 * hills);
        ice.mix(land.white, (0.72 * white + frost * (1.0 - white)).clamp(0.0, 0.9))
    });
}

/// Frozen bubbles, in columns of a few.
fn bubbles(scene: &mut Scene, land: &Land<'_>) {
    let (area, noise) = (land.area(), land.noise);
    let size = area.size();
    let clusters = ((size.x * size.y * 9.0) as u32).clamp(2, 60);
    for cluster in 0..clusters {
        let middle = area.min + size * noise.place(10, cluster);
        for bubble in 0..(2 + (noise.at(11, cluster) * 5.0) as u32) {
            let n = cluster * 16 + bubble;
            let at = middle + Vec2::new(noise.signed(12, n), noise.signed(13, n)) * 0.028;
            let radius = 0.0012 + 0.0045 * noise.at(14, n).powi(3);
            if at == at.clamp(area.min + radius, area.max - radius) {
                let opacity = 0.12 + 0.22 * noise.at(15, n);
                scene.add_circle(at, radius, Paint::fill(Ink::faint(land.white, opacity)));
            }
        }
    }
}

/// Old, healed cracks.
fn old_lines(scene: &mut Scene, land: &Land<'_>) {
    let (area, noise) = (land.area(), land.noise);
    let length = area.size().length();
    let paint = Paint::stroke(Stroke::new(0.0014, Ink::faint(land.white, 0.13)));
    for line in 0..5 {
        let start = area.min + area.size() * noise.place(20, line);
        for (way, turn) in [(1.0, 21), (-1.0, 22)] {
            let mut at = start;
            let mut heading = std::f32::consts::TAU * noise.at(23, line);
            let points = (0..48).map_while(|step| {
                let here = at;
                heading += 0.16 * noise.signed(turn, line * 64 + step);
                at += Vec2::from_angle(heading) * (way * length / 46.0);
                (here == here.clamp(area.min, area.max)).then_some(here)
            });
            scene.add_path(points, false, paint);
        }
    }
}

/// Layer of the cracks' drawing: each layer is complete before the next begins.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pass {
    /// The plane of a crack, which extends into the ice at a slant and reflects the light.
    Plane,
    /// The dark gap.
    Gap,
    /// The bright edge.
    Edge,
}

/// Level of detail of the cracks: details of a few cracks are invisible among thousands, and a window without a
/// graphics card spends its time on the triangles of lines.
#[derive(Clone, Copy)]
struct Detail {
    /// Distance between the points of a ragged line, in metres.
    ragged_m: f32,
    /// Minimum width of cracks with a dark gap, as a share of the widest.
    gap: f32,
    /// Drawn share of a star's splinters.
    splinters: f32,
    /// True if splinters are bent; a straight one has one point less.
    bends: bool,
}

impl Detail {
    /// The level of detail for this number of pieces.
    fn of(pieces: usize) -> Self {
        let many = ((pieces as f32 - 300.0) / 1200.0).clamp(0.0, 1.0);
        Self {
            ragged_m: 0.011 + 0.025 * many,
            gap: 0.75 * many,
            splinters: 1.0 - 0.45 * many,
            bends: many < 0.5,
        }
    }
}

/// Number of steps of width and age: adjacent pieces in the same step are drawn as one.
const STEPS: f32 = 4.0;

/// Draws one line of joined pieces.
fn line(
    scene: &mut Scene,
    land: &Land<'_>,
    spec: &IceSpec,
    pieces: &[Crack],
    (pass, detail): (Pass, Detail),
) {
    let Some(first) = pieces.first() else { return };
    let count = pieces.len();
    // A line has the width of its strongest piece, and is thinner at higher branches and at its end: a separate width
    // for each piece would look like beads.
    let strongest = pieces.iter().map(|piece| piece.energy_j).fold(0.0, f32::max);
    let share = (strongest / spec.energy.most_j).clamp(0.0, 2.0).sqrt();
    let widest = (0.35 + 0.65 * share) * 0.78_f32.powi(i32::from(first.rank.min(4)));
    let grade = |index: usize, piece: &Crack| {
        let open = (piece.openness(land.now, spec.sheet.refreeze_s) * 1.5 * STEPS).ceil() / (1.5 * STEPS);
        let is_end = index + 2 >= count && count > 2;
        let width = widest * if is_end { 0.6 } else { 1.0 };
        (open, (width * STEPS).ceil() / STEPS)
    };
    let mut from = 0;
    while let Some(piece) = pieces.get(from) {
        let look = grade(from, piece);
        let mut to = from + 1;
        while pieces.get(to).is_some_and(|next| grade(to, next) == look && next.from == pieces[to - 1].to) {
            to += 1;
        }
        let run = &pieces[from..to];
        let (open, width) = look;
        let points =
            || run.iter().enumerate().flat_map(move |(at, piece)| rough(piece, at == 0, detail.ragged_m));
        match pass {
            Pass::Plane if open > 0.0 => {
                // Each line has its own slant, to one side of its direction.
                let way = (run[run.len() - 1].to - run[0].from).normalize_or(Vec2::X);
                let side = if land.noise.at(30, first.line) < 0.5 { 1.0 } else { -1.0 };
                let slant = 0.010 + 0.012 * land.noise.at(31, first.line);
                let reach = (way.perp() * side + way * 0.35).normalize() * slant * (0.5 + width);
                let near = Ink::faint(land.white, 0.40 * open);
                // Along the pieces' ends only: the line is ragged on the surface and smooth in the depth.
                let ends = run.iter().map(|piece| piece.to);
                scene.add_band(
                    run.first().map(|piece| piece.from).into_iter().chain(ends),
                    reach,
                    near,
                    Ink::faint(land.white, 0.0),
                );
            }
            Pass::Gap if open > 0.0 && width > detail.gap => {
                let ink = Ink::faint(land.deep.mix(super::BLACK, 0.3), 0.55 * open);
                let aside = Vec2::new(0.0009, -0.0011);
                let stroke = Stroke::new(0.0012 + 0.0048 * width * open, ink);
                scene.add_path(points().map(|point| point + aside), false, Paint::stroke(stroke));
            }
            Pass::Edge if open > 0.0 => {
                let ink = Ink::faint(land.white, 0.25 + 0.70 * open);
                let stroke = Stroke::new(0.0009 + 0.0030 * width * (0.4 + 0.6 * open), ink);
                scene.add_path(points(), false, Paint::stroke(stroke));
            }
            Pass::Plane | Pass::Gap | Pass::Edge => {}
        }
        from = to;
    }
}

/// Points of a crack piece with a ragged course; both ends stay in place.
fn rough(piece: &Crack, with_start: bool, spacing_m: f32) -> impl Iterator<Item = Vec2> + use<> {
    let Crack { from, to, number, .. } = *piece;
    let steps = (from.distance(to) / spacing_m).round().clamp(1.0, 12.0) as u32;
    let noise = super::TerrainNoise(number as u32);
    let across = (to - from).perp() * (0.22 / steps as f32);
    (u32::from(!with_start)..=steps).map(move |step| {
        let inside = step > 0 && step < steps;
        let aside = if inside { across * noise.signed(40, step) } else { Vec2::ZERO };
        from.lerp(to, step as f32 / steps as f32) + aside
    })
}

/// Short splinters around a seed, the place of the foot's impact.
fn star(
    scene: &mut Scene,
    land: &Land<'_>,
    (number, at, energy_j): (u32, Vec2, f32),
    fresh: f32,
    detail: Detail,
) {
    if fresh <= 0.02 {
        return;
    }
    let (area, noise) = (land.area(), land.noise);
    let long = 0.010 + 0.007 * energy_j.max(0.0).sqrt().min(5.0);
    let count = ((7.0 + noise.at(50, number) * 7.0) * detail.splinters) as u32;
    let ink: Colour = land.white;
    for splinter in 0..count {
        let n = number.wrapping_mul(32).wrapping_add(splinter);
        let way = Vec2::from_angle(
            std::f32::consts::TAU * (splinter as f32 + 0.7 * noise.at(51, n)) / count as f32,
        );
        let (near, far) = (long * 0.25 * noise.at(52, n), long * (0.45 + 0.9 * noise.at(53, n)));
        let bend = way.perp() * far * 0.18 * noise.signed(54, n);
        let middle = detail.bends.then_some(at + way * (0.5 * (near + far)) + bend);
        let points = std::iter::once(at + way * near).chain(middle).chain([at + way * far]);
        let points = points.map(|point| point.clamp(area.min, area.max));
        let stroke = Stroke::new(0.0011 + 0.0010 * noise.at(55, n), Ink::faint(ink, 0.75 * fresh));
        scene.add_path(points, false, Paint::stroke(stroke));
    }
}
