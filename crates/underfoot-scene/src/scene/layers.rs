//! Optional layers over the floor that show its sensing: tile loads, uncertainty, trails, ignored presses, health.

use std::f32::consts::TAU;
use std::time::Duration;

use glam::Vec2;

use super::mark::{Ink, Paint, Stroke};
use super::{Scene, View};
use underfoot::engine::{Ignored, IgnoredPress};
use underfoot::floor::Rect;
use underfoot::layout::Widget;
use underfoot::sense::{Covariance, Quality};
use underfoot::wire::LinkState;

/// Minimum load shown on a tile (N): noise alone would make smaller ones flicker.
pub(super) const LEAST_N: f32 = 5.0;

/// Time for which the reason of an ignored press stays on its control.
pub const TOLD: Duration = Duration::from_secs(5);

/// Under the controls: the quality of each sensor, as a quarter of its plate.
pub(super) fn health(scene: &mut Scene, view: &View<'_>) {
    if !view.show.health || view.snapshot.link == LinkState::Waiting {
        return;
    }
    let theme = view.theme;
    for (index, state) in view.snapshot.tiles.iter().enumerate().take(view.geometry.tile_count()) {
        let tile = view.geometry.tile_at_index(index);
        if view.geometry.is_missing(tile) {
            continue;
        }
        let plate = view.geometry.plate(tile).grown(-0.004);
        // A tile with live sensors gets only a frame, which needs no area without a graphics card.
        if state.quality == [Quality::Live; 4] {
            let frame = Paint::stroke(Stroke::new(0.005, Ink::faint(theme.good, 0.4)));
            scene.add_box(plate.grown(-0.004), 0.006, frame);
            continue;
        }
        let half = 0.5 * plate.size();
        for &corner in view.geometry.sensors(tile) {
            let quality = state.quality[corner.index()];
            // Worse qualities are more opaque, so that the map is readable without its colours.
            let ink = match quality {
                Quality::Live => Ink::faint(theme.good, 0.14),
                Quality::Degraded => Ink::faint(theme.warning, 0.34),
                Quality::Stale => Ink::faint(theme.stale, 0.5),
                Quality::Faulty => Ink::faint(theme.fault, 0.66),
            };
            let quarter = match view.geometry.has_corners() {
                true => {
                    let side = 0.5 + 0.5 * corner.direction();
                    Rect::from_min_size(plate.min + side * half, half).grown(-0.002)
                }
                // Sensors at other places have a square around each.
                false => {
                    let at = plate.min + plate.size() * view.geometry.share_of_plate(tile, corner);
                    Rect::from_centre_size(at, Vec2::splat(0.5 * half.min_element()))
                }
            };
            scene.add_box(quarter, 0.004, Paint::fill(ink));
        }
    }
}

/// Draws the force on each tile, at its centroid.
pub(super) fn tiles(scene: &mut Scene, view: &View<'_>) {
    let theme = view.theme;
    let by = super::magnification(view.geometry).clamp(0.3, 4.0);
    for (index, state) in view.snapshot.tiles.iter().enumerate().take(view.geometry.tile_count()) {
        if !state.force.0.is_finite() || state.force.0 < LEAST_N {
            continue;
        }
        if let Some(at) = state.centroid.filter(|at| view.show.centroids && at.is_finite()) {
            let ink = Ink::solid(theme.contact);
            let arm = 0.012 * by;
            let corners = [Vec2::Y, Vec2::X, Vec2::NEG_Y, Vec2::NEG_X].map(|way| at + arm * way);
            let paint = Paint::fill(Ink::faint(theme.plate, 0.9)).with_stroke(Stroke::new(0.003 * by, ink));
            scene.add_path(corners, true, paint);
        }
        if view.show.loads {
            let plate = view.geometry.plate(view.geometry.tile_at_index(index));
            let middle = Vec2::new(plate.max.x - 0.040 * by, plate.min.y + 0.020 * by);
            let ground = Paint::fill(Ink::faint(theme.plate, 0.88));
            let ink = Ink::solid(theme.ink);
            scene.add_badge(middle, 0.020 * by, ink, ground, format_args!("{:.0} N", state.force.0));
        }
    }
}

/// Draws the recent path of each contact, fading behind it.
pub(super) fn trails(scene: &mut Scene, view: &View<'_>) {
    if !view.show.trails {
        return;
    }
    for trail in view.trails {
        let colour = if trail.leads { view.theme.cursor } else { view.theme.contact };
        // Three parts, the oldest faintest.
        let third = trail.points.len().div_ceil(3).max(1);
        for (part, opacity) in (0..3).zip([0.25, 0.45, 0.75]) {
            let from = (part * third).saturating_sub(1);
            let stretch = trail.points.iter().take((part + 1) * third).skip(from).copied();
            let stretch = stretch.filter(|point| point.is_finite());
            scene.add_path(stretch, false, Paint::stroke(Stroke::new(0.004, Ink::faint(colour, opacity))));
        }
    }
}

/// Draws the 95 % confidence ellipse of each contact.
pub(super) fn uncertainty(scene: &mut Scene, view: &View<'_>) {
    if !view.show.uncertainty {
        return;
    }
    for contact in view.snapshot.contacts.iter().filter(|contact| contact.centroid.is_finite()) {
        let (long, short) = contact.covariance.ellipse_95_m();
        if !(long.is_finite() && short.is_finite()) {
            continue;
        }
        // Ellipses larger than the floor are limited to its size.
        let most = view.geometry.bounds().size().max_element();
        let radii = Vec2::new(long, short).clamp(Vec2::splat(0.002), Vec2::splat(most));
        let turn = Vec2::from_angle(direction(contact.covariance));
        let rim = (0..40).map(|step| {
            let round = Vec2::from_angle(TAU * step as f32 / 40.0);
            contact.centroid + turn.rotate(radii * round)
        });
        let stroke = Stroke::new(0.003, Ink::faint(view.theme.ink, 0.8));
        scene.add_path(rim, true, Paint::fill(Ink::faint(view.theme.ink, 0.07)).with_stroke(stroke));
    }
}

/// Angle from east to the longer axis of a covariance, in radians.
fn direction(Covariance { xx, xy, yy }: Covariance) -> f32 {
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    if angle.is_finite() { angle } else { 0.0 }
}

/// Writes the reasons of ignored presses at their controls, clear of the texts in `taken`.
pub(super) fn ignored(scene: &mut Scene, view: &View<'_>, mut taken: Vec<Rect>) {
    if !view.show.ignored {
        return;
    }
    let (theme, now) = (view.theme, view.snapshot.at);
    let by = super::magnification(view.geometry).clamp(0.3, 4.0);
    let size_m = 0.028 * by;
    near_misses(scene, view, size_m, &mut taken);
    let mut told = Vec::new();
    for press in view.snapshot.ignored.iter().rev().filter(|press| now.since(press.at) < TOLD) {
        // For a foot that slides over several controls, only the last one shows a reason.
        if told.contains(&press.contact) {
            continue;
        }
        told.push(press.contact);
        let Some(widget) = view.layout.widgets.iter().find(|widget| widget.id == press.id) else { continue };
        let mut text = format!("{:.0} N: {}", press.force.0, press.why);
        // A threshold that depends on a person's weight has no fixed force to show.
        let wanted = widget.behaviour.thresholds();
        if press.why == Ignored::TooLight && wanted.share.is_none() {
            text.push_str(&format!(", takes {:.0} N", wanted.press.0));
        }
        let half = Vec2::new(0.5 * (super::widths::width(&text) * size_m + size_m), 0.8 * size_m);
        let middle = beside(widget.area, half, view, &taken);
        taken.push(Rect::new(middle - half, middle + half));
        let plate = Paint::fill(Ink::solid(theme.plate))
            .with_stroke(Stroke::new(0.0025 * by, Ink::solid(theme.warning)));
        scene.add_badge(middle, size_m, Ink::solid(theme.warning), plate, format_args!("{text}"));
    }
}

/// The force of the last light press of `widget`, as a share of its threshold, while its reason is shown: its ring
/// stays filled that far after the foot has left. 0 without such a press.
pub(super) fn light_share(view: &View<'_>, widget: &Widget) -> f32 {
    let wanted = widget.behaviour.thresholds();
    let is_it = |press: &&IgnoredPress| {
        press.id == widget.id
            && press.why == Ignored::TooLight
            && view.snapshot.at.since(press.at) < TOLD
            && wanted.share.is_none()
    };
    let share = view.snapshot.ignored.iter().rev().find(is_it).map(|press| press.force.0 / wanted.press.0);
    share.filter(|share| share.is_finite()).map_or(0.0, |share| share.clamp(0.0, 1.0))
}

/// Draws each recent press beside a control: a cross at its place, a line to the control, and the distance.
fn near_misses(scene: &mut Scene, view: &View<'_>, size_m: f32, taken: &mut Vec<Rect>) {
    let (theme, now) = (view.theme, view.snapshot.at);
    let line = Paint::stroke(Stroke::new(0.09 * size_m, Ink::solid(theme.warning)));
    for miss in view.near_misses.iter().filter(|miss| now.since(miss.at) < TOLD && miss.place.is_finite()) {
        let arm = 0.45 * size_m;
        for way in [Vec2::new(arm, arm), Vec2::new(arm, -arm)] {
            scene.add_line(miss.place - way, miss.place + way, line);
        }
        if let Some(control) = miss.control {
            scene.add_line(miss.place, miss.place.clamp(control.min, control.max.max(control.min)), line);
        }
        let half = Vec2::new(0.5 * (super::widths::width(&miss.text) * size_m + size_m), 0.8 * size_m);
        let press = Rect::new(miss.place, miss.place).grown(arm);
        let middle = beside(press, half, view, taken);
        taken.push(Rect::new(middle - half, middle + half));
        let plate = Paint::fill(Ink::solid(theme.plate))
            .with_stroke(Stroke::new(0.09 * size_m, Ink::solid(theme.warning)));
        scene.add_badge(middle, size_m, Ink::solid(theme.warning), plate, format_args!("{}", miss.text));
    }
}

/// Place for a text that extends `half` to each side, at a control or a press: along its south edge, or else further
/// south, in the north, or aside. It is clear of the texts in `taken`, if possible also of all controls, and always
/// within the floor.
fn beside(at: Rect, half: Vec2, view: &View<'_>, taken: &[Rect]) -> Vec2 {
    let floor = view.geometry.bounds();
    let low = (floor.min + half).min(floor.centre());
    let high = (floor.max - half).max(low);
    let lines = (0..6_u8).flat_map(|line| {
        let away = half.y * (1.05 + 2.2 * f32::from(line));
        [at.min.y - away, at.max.y + away]
    });
    let far = 2.0 * half.x;
    let aside = [
        at.centre().x,
        at.max.x + half.x,
        at.min.x - half.x,
        at.max.x + half.x + far,
        at.min.x - half.x - far,
    ];
    let places = lines.flat_map(|y| aside.map(|x| Vec2::new(x, y)));
    let level = [at.max.x + 1.1 * half.x, at.min.x - 1.1 * half.x].map(|x| Vec2::new(x, at.centre().y));
    let places: Vec<Vec2> = places.chain(level).map(|place| place.clamp(low, high)).collect();
    let covers = |areas: &[Rect], place: Vec2| {
        let words = Rect::new(place - half, place + half);
        areas.iter().any(|other| other.overlaps(words))
    };
    let controls: Vec<Rect> = view.controls().map(|widget| widget.area).collect();
    let is_free = |place: &&Vec2| !covers(taken, **place);
    let best = places.iter().filter(is_free).find(|place| !covers(&controls, **place));
    let first = Vec2::new(at.centre().x, at.min.y - half.y).clamp(low, high);
    best.or(places.iter().find(is_free)).copied().unwrap_or(first)
}

#[cfg(test)]
mod tests {
    use super::super::sample::{at_rest, map, pressing};
    use super::super::{Mark, Show, Theme, Trail};
    use super::*;
    use underfoot::engine::Snapshot;
    use underfoot::floor::Geometry;
    use underfoot::layout::Layout;
    use underfoot::sense::ContactId;
    use underfoot::units::{Instant, Newtons};

    const BARE: Show = Show { sensors: false, contacts: false, ..Show::PROJECTOR };

    fn marks(snapshot: &Snapshot, show: Show, trails: &[Trail]) -> Scene {
        let (layout, geometry) = (map(), Geometry::default());
        let mut scene = Scene::new();
        let view = View { show, trails, ..View::new(&geometry, &layout, snapshot, &Theme::LIGHT) };
        super::super::draw(&mut scene, &view);
        scene
    }

    #[test]
    fn each_layer_adds_marks_of_its_own_and_none_while_it_is_off() {
        let mut snapshot = Snapshot { link: LinkState::Live, ..pressing(&map()) };
        let press = IgnoredPress {
            at: snapshot.at,
            id: map().widgets[3].id.clone(),
            contact: ContactId(7),
            force: Newtons(12.0),
            why: Ignored::TooLight,
        };
        snapshot.ignored.push(press);
        let trails = [Trail { points: (0..9).map(|at| Vec2::splat(0.1 * at as f32)).collect(), leads: true }];
        let count = |show: Show| marks(&snapshot, show, &trails).marks().len();
        let bare = count(BARE);
        for (name, layer) in Show::LAYERS {
            let mut show = Show { engagement: false, actuators: false, ..BARE };
            let without = count(show);
            *layer(&mut show) = true;
            let with = count(show);
            // Rings are on contacts, and no actuator moves here.
            let is_alone = !matches!(name, "Cursors" | "Actuators");
            assert_eq!(with > without, is_alone, "{name}: {without} and {with} of {bare}");
        }
    }

    #[test]
    fn an_ellipse_lies_along_its_longer_axis() {
        let along = Covariance { xx: 4e-4, xy: 3e-4, yy: 4e-4 };
        assert!((direction(along) - TAU / 8.0).abs() < 1e-5);
        assert!((direction(Covariance { xx: 1e-4, xy: 0.0, yy: 9e-4 }).abs() - TAU / 4.0).abs() < 1e-5);
        let nothing = Covariance { xx: f32::NAN, xy: f32::NAN, yy: f32::NAN };
        assert_eq!(direction(nothing), 0.0);
    }

    #[test]
    fn the_reason_of_an_ignored_press_goes_away_and_stays_on_the_floor() {
        let mut snapshot = at_rest(&map());
        snapshot.at = Instant::from_millis(60_000);
        let told = |snapshot: &Snapshot| {
            let scene = marks(snapshot, Show { ignored: true, ..BARE }, &[]);
            scene.texts().filter(|(text, _)| text.ends_with("too light, takes 60 N")).count()
        };
        for (age_ms, expected) in [(0, 1), (4000, 1), (6000, 0)] {
            snapshot.ignored = vec![IgnoredPress {
                at: Instant::from_millis(60_000 - age_ms),
                id: map().widgets[0].id.clone(),
                contact: ContactId(7),
                force: Newtons(12.0),
                why: Ignored::TooLight,
            }];
            assert_eq!(told(&snapshot), expected, "{age_ms} ms");
        }
        let scene = marks(&snapshot, Show { ignored: true, ..BARE }, &[]);
        assert!(!scene.marks().iter().any(|mark| matches!(mark, Mark::Field { .. })));
    }

    #[test]
    fn a_press_beside_a_control_shows_its_distance_for_some_seconds() {
        let (layout, geometry) = (map(), Geometry::default());
        let area = layout.widgets[0].area;
        let near_misses = [super::super::PressBeside {
            at: Instant::from_millis(10_000),
            place: Vec2::new(area.max.x + 0.03, area.centre().y),
            control: Some(area),
            text: "3 cm beside it".into(),
        }];
        let told = |at_ms: u64, ignored: bool| {
            let snapshot = Snapshot { at: Instant::from_millis(at_ms), ..at_rest(&layout) };
            let mut scene = Scene::new();
            let show = Show { ignored, ..BARE };
            let near_misses = &near_misses;
            let view = View { show, near_misses, ..View::new(&geometry, &layout, &snapshot, &Theme::LIGHT) };
            super::super::draw(&mut scene, &view);
            scene.texts().filter(|(text, _)| *text == "3 cm beside it").count()
        };
        assert_eq!(
            [told(10_100, true), told(14_000, true), told(16_000, true), told(10_100, false)],
            [1, 1, 0, 0]
        );
    }

    #[test]
    fn the_ring_of_a_light_press_stays_as_long_as_its_reason() {
        let layout = map();
        let widget = &layout.widgets[0];
        let share = |at_ms: u64, why: Ignored| {
            let mut snapshot = Snapshot { at: Instant::from_millis(at_ms), ..at_rest(&layout) };
            let (at, id, contact) = (Instant::from_millis(10_000), widget.id.clone(), ContactId(7));
            snapshot.ignored = vec![IgnoredPress { at, id, contact, force: Newtons(30.0), why }];
            light_share(&View::new(&Geometry::default(), &layout, &snapshot, &Theme::LIGHT), widget)
        };
        assert!((share(11_000, Ignored::TooLight) - 30.0 / 60.0).abs() < 1e-3);
        assert_eq!([share(16_000, Ignored::TooLight), share(11_000, Ignored::Step)], [0.0, 0.0]);
    }

    #[test]
    fn reasons_stand_clear_of_what_is_written_already() {
        let (layout, geometry, snapshot) = (Layout::default(), Geometry::default(), Snapshot::default());
        let view = View::new(&geometry, &layout, &snapshot, &Theme::LIGHT);
        let floor = geometry.bounds();
        let half = Vec2::new(0.1, 0.02);
        for control in [floor.centre(), floor.min, floor.max] {
            let control = Rect::from_centre_size(control, Vec2::splat(0.15));
            let mut taken: Vec<Rect> = Vec::new();
            for _ in 0..4 {
                let middle = beside(control, half, &view, &taken);
                let words = Rect::new(middle - half, middle + half);
                assert!(!taken.iter().any(|other| other.overlaps(words)), "{words:?} on {taken:?}");
                assert!(floor.grown(1e-4).contains(words.min) && floor.grown(1e-4).contains(words.max));
                taken.push(words);
            }
        }
    }

    #[test]
    fn reasons_cover_no_control_where_there_is_room() {
        let (mut layout, geometry) = (map(), Geometry::default());
        let mut number = 0;
        layout.widgets.retain(|_| {
            number += 1;
            number % 2 == 0
        });
        let snapshot = at_rest(&layout);
        let view = View::new(&geometry, &layout, &snapshot, &Theme::LIGHT);
        for widget in &layout.widgets {
            let middle = beside(widget.area, Vec2::new(0.06, 0.02), &view, &[]);
            let words = Rect::from_centre_size(middle, Vec2::new(0.12, 0.04));
            for other in &layout.widgets {
                assert!(!other.area.overlaps(words), "the reason of {} covers {}", widget.id, other.id);
            }
        }
    }
}
