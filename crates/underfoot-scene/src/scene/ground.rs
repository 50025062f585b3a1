//! The floor itself: plates and their loads, sensors, actuators, regions and stance zones.

use glam::Vec2;

use super::layers::LEAST_N;
use super::mark::{Anchor, Ink, Lettering, Paint, Stroke};
use super::widths::CAP_HEIGHT;
use super::{Scene, View, names, outline, terrain};
use underfoot::engine::TileState;
use underfoot::floor::{Rect, TileId};
use underfoot::sense::Quality;
use underfoot::wire::LinkState;

/// Draws the plates with their load, as one slab.
pub(super) fn plates(scene: &mut Scene, view: &View<'_>) {
    let theme = view.theme;
    let slab = view.geometry.bounds();
    // On a floor of a few tiles, the whole shadow must stay within the margin.
    let by = super::magnification(view.geometry).min(1.0);
    // A soft shadow, shifted a little to the south, as from a lamp at the floor's far end; one that has another outline
    // has none.
    let south = Vec2::new(0.0, 0.006);
    let shade = Rect::new(slab.min - south, slab.max - south);
    if view.geometry.missing().is_empty() {
        scene.add_halo(shade.grown(-0.006), 0.010, 0.036 * by, Ink::faint(theme.shadow, 0.11));
    }
    seams(scene, view, gap_around(view, view.geometry.tile_m()));
    for (index, tile) in view.geometry.tiles().enumerate() {
        let load_n = view.snapshot.tiles.get(index).map_or(0.0, |state| state.force.0);
        let share = if view.show.loads { load_share(load_n) } else { 0.0 };
        let cell = view.geometry.cell(tile);
        if view.geometry.is_missing(tile) || terrain::hides(view, cell) {
            continue;
        }
        let is_active = view.layout.regions.iter().any(|region| tints_plates(view, region.area, cell));
        let plate = if is_active { theme.plate.mix(theme.accent, TINT) } else { theme.plate };
        let colour = plate.mix(theme.load, share);
        let gap = gap_around(view, view.geometry.plate_size(tile));
        let plate = Rect::new(cell.min + gap, cell.max - gap);
        scene.add_box(plate, 0.008, Paint::fill(Ink::solid(colour)));
    }
    // On a large floor plates are drawn to whole pixels, which would close every other seam.
    if super::magnification(view.geometry) > 1.5 {
        seams(scene, view, Vec2::ZERO);
    }
}

/// Width of the gap on each side of a plate of this size; if plates touch, a seam of 2 mm on each side separates them
/// visibly.
fn gap_around(view: &View<'_>, plate: Vec2) -> Vec2 {
    (0.5 * (view.geometry.pitch_m() - plate)).max(Vec2::splat(0.0022 * seen_from(view)))
}

/// Covers the holes of the floor, on which grounds may lie.
pub(super) fn holes(scene: &mut Scene, view: &View<'_>) {
    let missing = view.geometry.missing().iter().filter(|tile| view.geometry.index(**tile).is_some());
    let cells = missing.map(|tile| view.geometry.cell(*tile));
    let is_covered = |cell: &Rect| view.layout.grounds.iter().any(|ground| ground.spec.area.overlaps(*cell));
    for cell in cells.filter(is_covered) {
        scene.add_box(cell, 0.0, Paint::fill(Ink::solid(view.theme.canvas)));
    }
}

/// Maximum share of the colour of loads in a plate.
pub(super) const MOST_LOAD: f32 = 0.55;

/// Load of full colour (N): one person on one foot.
const FULL_N: f32 = 700.0;

/// Number of colours between those of no load and of full load: the eye sees no step.
const LOAD_COLOURS: f32 = 32.0;

/// Share of the colour of loads in a plate under `load_n`; the square root makes light steps visible too.
///
/// Noise and NaN give no colour, and colours have steps: the picture of plates that only tremble stays the same.
fn load_share(load_n: f32) -> f32 {
    let share = ((load_n - LEAST_N).max(0.0) / (FULL_N - LEAST_N)).min(1.0).sqrt();
    MOST_LOAD * (share * LOAD_COLOURS).round() / LOAD_COLOURS
}

/// Share of the accent colour in an active area.
pub(super) const TINT: f32 = 0.045;

/// True if the plate of `cell` is tinted to show that it is active: a region of whole plates needs no extra rectangle
/// over them, which would be painted pixel by pixel once more.
fn tints_plates(view: &View<'_>, region: Rect, cell: Rect) -> bool {
    let pitch_m = view.geometry.pitch_m();
    let is_whole = |edge: Vec2| {
        let off = (edge - view.geometry.bounds().min) / pitch_m;
        (off - off.round()).abs().max_element() < 1e-3
    };
    is_whole(region.min)
        && is_whole(region.max)
        && super::holds(region, cell)
        && view.layout.grounds.is_empty()
}

/// Factor for the width of seams on a floor larger than the paper's, which is seen from further away: without it,
/// half of the seams would fall between a screen's pixels. Limited to 4 % of the tile pitch.
fn seen_from(view: &View<'_>) -> f32 {
    let most = 0.04 * view.geometry.pitch_m().min_element() / 0.0022;
    super::magnification(view.geometry).clamp(1.0, most.max(1.0))
}

/// Draws a frame around all plates and lines between them.
///
/// Lines rather than one large background: painting without a graphics card takes time in proportion to the area.
///
/// A floor with holes has a frame around each tile.
fn seams(scene: &mut Scene, view: &View<'_>, gap: Vec2) {
    let slab = view.geometry.bounds();
    let colour = Ink::solid(view.theme.seam);
    let width_m = 0.014 * super::magnification(view.geometry).clamp(0.4, 1.0);
    // A little wider than the seam, because of the plates' round corners.
    let stroke = |gap: f32| Paint::stroke(Stroke::new(2.0 * gap + 0.006 * seen_from(view), colour));
    if !view.geometry.missing().is_empty() {
        let frame = stroke(0.5 * gap.min_element());
        for tile in view.geometry.tiles().filter(|tile| view.geometry.has(*tile)) {
            scene.add_box(view.geometry.cell(tile), 0.010, frame);
        }
        return;
    }
    scene.add_box(slab, 0.010, Paint::stroke(Stroke::new(width_m, colour)));
    let (size, pitch_m) = (slab.size(), view.geometry.pitch_m());
    for column in 1..view.geometry.columns() {
        let south = slab.min + Vec2::new(f32::from(column) * pitch_m.x, 0.0);
        scene.add_line(south, south + Vec2::new(0.0, size.y), stroke(gap.x));
    }
    for row in 1..view.geometry.rows() {
        let west = slab.min + Vec2::new(0.0, f32::from(row) * pitch_m.y);
        scene.add_line(west, west + Vec2::new(size.x, 0.0), stroke(gap.y));
    }
}

/// Column and row numbers along the south and west sides, at the tiles' centres.
pub(super) fn ruler(scene: &mut Scene, view: &View<'_>) {
    let by = super::magnification(view.geometry);
    let size_m = 0.030 * by;
    let mut lettering = Lettering::new(Vec2::ZERO, Anchor::Middle, size_m, Ink::solid(view.theme.quiet));
    // If tiles are smaller than their numbers, only every n-th tile has one.
    let every = (2.0 * size_m / view.geometry.pitch_m()).ceil().max(Vec2::ONE).as_usizevec2();
    let (block, corner) = (view.geometry.block(), view.geometry.bounds().min);
    for column in block.column_range().step_by(every.x) {
        let middle = Vec2::new(view.geometry.centre(TileId::new(column, 0)).x, corner.y);
        lettering.at = middle - Vec2::new(0.0, 0.058 * by);
        scene.add_text(lettering, format_args!("{column}"));
    }
    for row in block.row_range().step_by(every.y) {
        let middle = Vec2::new(corner.x, view.geometry.centre(TileId::new(0, row)).y);
        lettering.at = middle - Vec2::new(0.048 * by, 0.5 * CAP_HEIGHT * size_m);
        scene.add_text(lettering, format_args!("{row}"));
    }
}

/// Outlines of the regions, with their names.
pub(super) fn regions(scene: &mut Scene, view: &View<'_>) {
    let theme = view.theme;
    for region in &view.layout.regions {
        let mut tiles = view.geometry.tiles().filter(|tile| view.geometry.has(*tile));
        let is_tinted = tiles.all(|tile| {
            let cell = view.geometry.cell(tile);
            !region.area.overlaps(cell.grown(-1e-4)) || tints_plates(view, region.area, cell)
        });
        let area = region.area.grown(-0.004);
        let stroke = Paint::stroke(Stroke::new(0.003, Ink::faint(theme.accent, 0.45)));
        let paint =
            if is_tinted { stroke } else { Paint { fill: Some(Ink::faint(theme.accent, TINT)), ..stroke } };
        scene.add_box(area, 0.012, paint);
        let size_m = 0.024;
        let lettering = Lettering::new(
            Vec2::new(area.min.x + 0.018, area.max.y - 0.012 - CAP_HEIGHT * size_m),
            Anchor::Start,
            size_m,
            names::ink(theme, theme.accent),
        );
        names::write(scene, view, lettering, &region.id, (area.size().x - 0.04, size_m));
    }
}

/// Stance zones: dashed outlines with the soles of one or two shoes.
pub(super) fn stances(scene: &mut Scene, view: &View<'_>) {
    let theme = view.theme;
    for stance in &view.layout.stances {
        let area = stance.area.grown(-0.006);
        let dashes = Stroke::new(0.003, Ink::faint(theme.stance, 0.75)).dashed(0.016, 0.012);
        scene.add_box(area, 0.04, Paint::fill(Ink::faint(theme.stance, 0.06)).with_stroke(dashes));
        let size = area.size();
        let label_m = if stance.label.is_empty() { 0.0 } else { 0.055 };
        let length_m = (size.y - label_m - 0.04).min(0.28).min(2.4 * size.x);
        if length_m >= 0.08 {
            let middle = area.centre() + Vec2::new(0.0, 0.5 * label_m);
            let paint = Paint::fill(Ink::faint(theme.stance, 0.10))
                .with_stroke(Stroke::new(0.0025, Ink::faint(theme.stance, 0.6)));
            // Two soles need a little more than twice a sole's breadth, which is 0.36 of its length.
            let apart = 0.24 * length_m;
            if size.x >= 0.95 * length_m {
                for (side, left) in [(-apart, true), (apart, false)] {
                    let turn = if left { 0.09 } else { -0.09 };
                    let sole = outline::sole(middle + Vec2::new(side, 0.0), turn, length_m, left);
                    scene.add_path(sole, true, paint);
                }
            } else {
                scene.add_path(outline::sole(middle, 0.0, length_m, true), true, paint);
            }
        }
        let lettering = Lettering::new(
            Vec2::new(area.centre().x, area.min.y + 0.022),
            Anchor::Middle,
            0.032,
            names::ink(theme, theme.quiet),
        );
        names::write(scene, view, lettering, &stance.label, (size.x - 0.03, 0.02));
    }
}

/// Area of a sensor's dot per newton, in square metres: a dot of 300 N is 3 cm wide.
const DOT_M2_PER_N: f32 = 0.015 * 0.015 / 300.0;

/// Hatches the tiles without current data.
pub(super) fn unknown(scene: &mut Scene, view: &View<'_>) {
    if view.snapshot.link == LinkState::Waiting {
        return;
    }
    for (index, state) in view.snapshot.tiles.iter().enumerate().take(view.geometry.tile_count()) {
        if state.quality.iter().all(|quality| *quality >= Quality::Stale) {
            hatch(scene, view, view.geometry.tile_at_index(index), state);
        }
    }
}

/// Number of tiles above which sensors without force are not drawn: their dots would be smaller than a pixel.
const MANY_TILES: usize = 400;

/// Draws dots with an area proportional to the sensors' forces; broken and silent sensors have their own shapes.
pub(super) fn sensors(scene: &mut Scene, view: &View<'_>) {
    // Before the first packet there are no data, and 144 marks would add nothing.
    if view.snapshot.link == LinkState::Waiting {
        return;
    }
    // If no sensor is live, as on an uncalibrated floor, a mark on each would carry no information.
    let none_live = none_live(view);
    for (index, state) in view.snapshot.tiles.iter().enumerate().take(view.geometry.tile_count()) {
        let tile = view.geometry.tile_at_index(index);
        // The hatching already shows a tile without data.
        if state.quality == [Quality::Stale; 4] {
            continue;
        }
        for &corner in view.geometry.sensors(tile) {
            let at = view.geometry.sensor(tile, corner);
            let force = state.forces[corner.index()];
            let quality = state.quality[corner.index()];
            let told = if none_live && quality == Quality::Degraded { Quality::Live } else { quality };
            sensor(scene, view, at, force, told);
        }
    }
}

fn sensor(scene: &mut Scene, view: &View<'_>, at: Vec2, force: f32, quality: Quality) {
    let theme = view.theme;
    let radius = (force.clamp(0.0, 2000.0) * DOT_M2_PER_N).sqrt();
    if view.show.sensors && quality <= Quality::Degraded {
        // Below 1 N a dot would only show noise; a faint dot of constant size marks the place, unless there are too
        // many sensors.
        if force < 1.0 && view.geometry.tile_count() > MANY_TILES {
            return mark_quality(scene, view, at, quality);
        }
        let (radius, opacity) = if force >= 1.0 { (radius, 0.62) } else { (0.0032, 0.20) };
        scene.add_circle(at, radius, Paint::fill(Ink::faint(theme.contact, opacity)));
    }
    mark_quality(scene, view, at, quality);
}

/// Draws the shape for a sensor's quality: none if live, a triangle if degraded, a diamond if stale, a cross if
/// faulty.
pub(super) fn mark_quality(scene: &mut Scene, view: &View<'_>, at: Vec2, quality: Quality) {
    let theme = view.theme;
    match quality {
        Quality::Live => {}
        Quality::Degraded => {
            let corners = [Vec2::new(0.0, 0.012), Vec2::new(-0.0105, -0.007), Vec2::new(0.0105, -0.007)];
            let paint = Paint::fill(Ink::faint(theme.plate, 0.6))
                .with_stroke(Stroke::new(0.0028, Ink::solid(theme.warning)));
            scene.add_path(corners.map(|corner| at + corner), true, paint);
        }
        Quality::Stale => {
            let corners = [Vec2::Y, Vec2::X, Vec2::NEG_Y, Vec2::NEG_X];
            let paint = Paint::fill(Ink::solid(theme.plate))
                .with_stroke(Stroke::new(0.0028, Ink::solid(theme.stale)));
            scene.add_path(corners.map(|corner| at + corner * 0.0105), true, paint);
        }
        Quality::Faulty => {
            let disc = Paint::fill(Ink::solid(theme.plate))
                .with_stroke(Stroke::new(0.0022, Ink::solid(theme.fault)));
            scene.add_circle(at, 0.0125, disc);
            let stroke = Paint::stroke(Stroke::new(0.004, Ink::solid(theme.fault)));
            let arm = Vec2::splat(0.006);
            scene.add_line(at - arm, at + arm, stroke);
            scene.add_line(at - arm.perp(), at + arm.perp(), stroke);
        }
    }
}

fn hatch(scene: &mut Scene, view: &View<'_>, tile: TileId, state: &TileState) {
    let faulty = state.quality.iter().all(|quality| *quality == Quality::Faulty);
    let colour = if faulty { view.theme.fault } else { view.theme.stale };
    let plate = view.geometry.plate(tile).grown(-0.006);
    let side = plate.size().x;
    let stroke = Stroke::new(0.0025, Ink::faint(colour, 0.35));
    const LINES: usize = 9;
    for line in 1..2 * LINES {
        let along = side * line as f32 / LINES as f32;
        let from = Vec2::new((along - side).max(0.0), along.min(side));
        let to = Vec2::new(along.min(side), (along - side).max(0.0));
        scene.add_line(plate.min + from, plate.min + to, Paint::stroke(stroke));
    }
}

/// Draws a level bar on each tile with an active actuator.
pub(super) fn actuators(scene: &mut Scene, view: &View<'_>) {
    let theme = view.theme;
    for (index, level) in view.levels.iter().enumerate().take(view.geometry.tile_count()) {
        // A thousandth of full scale is 40 mN, too little to feel.
        if level.is_nan() || *level < 1e-3 {
            continue;
        }
        let plate = view.geometry.plate(view.geometry.tile_at_index(index));
        // The bar covers 60 dB, because the perception of force is about logarithmic.
        let share = (1.0 + level.min(1.0).log10() / 3.0).clamp(0.0, 1.0);
        let half = 0.28 * plate.size().x;
        let west = Vec2::new(plate.centre().x - half, plate.min.y + 0.020);
        let bar = Rect::new(west - Vec2::new(0.0, 0.004), west + Vec2::new(2.0 * half, 0.004));
        scene.add_box(bar.grown(0.003), 0.007, Paint::fill(Ink::faint(theme.plate, 0.85)));
        scene.add_box(bar, 0.004, Paint::fill(Ink::faint(theme.haptic, 0.22)));
        let filled =
            Rect::new(bar.min, Vec2::new(bar.min.x + 0.008 + share * (2.0 * half - 0.008), bar.max.y));
        scene.add_box(filled, 0.004, Paint::fill(Ink::solid(theme.haptic)));
    }
}

/// Draws the outline of the selected tile.
pub(super) fn chosen(scene: &mut Scene, view: &View<'_>) {
    if let Some(tile) = view.chosen.filter(|tile| view.geometry.index(*tile).is_some()) {
        let stroke = Stroke::new(0.005, Ink::solid(view.theme.accent));
        scene.add_box(view.geometry.plate(tile).grown(-0.003), 0.010, Paint::stroke(stroke));
    }
}

/// True if there are sensors and all are degraded or worse, as on an uncalibrated floor.
pub(super) fn none_live(view: &View<'_>) -> bool {
    let tiles = &view.snapshot.tiles;
    let mut known = view.geometry.tiles().zip(tiles).filter(|(tile, _)| view.geometry.has(*tile));
    !tiles.is_empty() && !known.any(|(_, tile)| tile.quality.contains(&Quality::Live))
}
