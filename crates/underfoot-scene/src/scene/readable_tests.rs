//! Every text of every drawing can be read on what lies under it, in every theme.

use glam::Vec2;

use super::widths::{CAP_HEIGHT, width};
use super::{Anchor, Ink, Lettering, Mark, Paint, Scene, Show, Theme, View, draw};
use underfoot::engine::{Ignored, IgnoredPress, Snapshot, TileState, WidgetState};
use underfoot::floor::{Geometry, Rect};
use underfoot::layout::{Colour, Layout};
use underfoot::schema::{Kinds, builtin_layout, builtin_layouts, parse_layout};
use underfoot::sense::ContactId;
use underfoot::units::{Instant, Newtons};
use underfoot::widget::Value;

fn shipped() -> impl Iterator<Item = Layout> {
    let kinds = Kinds::builtin();
    builtin_layouts().map(move |name| {
        let text = builtin_layout(name).unwrap();
        parse_layout(text, name, &kinds, &Geometry::default()).unwrap().layout
    })
}

/// `over` on `under`.
fn blend(under: Colour, over: Ink) -> Colour {
    under.mix(over.colour, over.opacity)
}

/// Distance from a point to a line between two others.
fn distance(point: Vec2, from: Vec2, to: Vec2) -> f32 {
    let along = ((point - from).dot(to - from) / (to - from).length_squared().max(1e-12)).clamp(0.0, 1.0);
    point.distance(from.lerp(to, along))
}

/// The colour of `mark` at `point` over `under`.
fn painted(scene: &Scene, mark: &Mark, point: Vec2, under: Colour) -> Colour {
    let filled = |paint: &Paint| paint.fill.map_or(under, |ink| blend(under, ink));
    match mark {
        Mark::Box { area, paint, .. } if area.contains(point) => filled(paint),
        Mark::Ellipse { centre, radii, paint } if ((point - *centre) / *radii).length() < 1.0 => {
            filled(paint)
        }
        Mark::Path { points, paint, .. } => {
            let broad = paint.stroke.filter(|stroke| stroke.width_m > 0.009 && stroke.dash.is_none());
            let points = scene.points(*points);
            let is_on = |stroke: &super::Stroke| {
                points.windows(2).any(|ends| distance(point, ends[0], ends[1]) < 0.5 * stroke.width_m)
            };
            broad.filter(is_on).map_or(under, |stroke| blend(under, stroke.ink))
        }
        Mark::Field { area, columns, inks } if area.contains(point) => {
            let inks = scene.inks(*inks);
            let rows = inks.len() as u32 / columns;
            let share = (point - area.min) / area.size() * Vec2::new((columns - 1) as f32, (rows - 1) as f32);
            let at = share.round().as_uvec2();
            blend(under, inks[(at.y * columns + at.x) as usize])
        }
        _ => under,
    }
}

/// Points along the letters of a text: their ground may change on the way.
fn along(text: &str, lettering: &Lettering) -> [Vec2; 3] {
    let size = Vec2::new(width(text), CAP_HEIGHT) * lettering.size_m;
    let west = match lettering.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -0.5,
        Anchor::End => -1.0,
    };
    [0.15, 0.5, 0.85].map(|share: f32| {
        let off = Vec2::new((west + share) * size.x, 0.5 * size.y);
        lettering.at + Vec2::from_angle(lettering.turn_rad).rotate(off)
    })
}

/// The texts of a drawing that cannot be read, each with its contrast.
fn unreadable(scene: &Scene, theme: &Theme) -> Vec<String> {
    let mut found = Vec::new();
    for (index, mark) in scene.marks().iter().enumerate() {
        let Mark::Text { letters, lettering } = mark else { continue };
        let text = scene.letters(*letters);
        for point in along(text, lettering) {
            let below = &scene.marks()[..index];
            let ground =
                below.iter().fold(scene.background(), |under, mark| painted(scene, mark, point, under));
            let ratio = blend(ground, lettering.ink).contrast(ground);
            if ratio < theme.least_contrast() {
                found.push(format!("“{text}”: {ratio:.2}, {} on {ground}", lettering.ink.colour));
            }
        }
    }
    found
}

/// The states of a control that change its colours.
fn states() -> Vec<(&'static str, WidgetState)> {
    let rest = WidgetState::default();
    vec![
        ("at rest", rest),
        ("pressed", WidgetState { pressed: true, press_share: 1.0, ..rest }),
        ("pressed lightly", WidgetState { press_share: 0.9, ..rest }),
        ("off", WidgetState { disabled: true, ..rest }),
        ("waiting", WidgetState { needs_lift: true, ..rest }),
        ("locked", WidgetState { locked: true, ..rest }),
        ("armed", WidgetState { armed: true, ..rest }),
        ("warned", WidgetState { warned: true, pressed: true, ..rest }),
    ]
}

fn snapshots(layout: &Layout, page: usize) -> Vec<(String, Snapshot)> {
    let at = Instant::from_millis(60_000);
    let mut all = Vec::new();
    for (name, state) in states() {
        for on in [false, true] {
            let widgets = layout.widgets.iter().map(|widget| {
                let value = widget.behaviour.initial();
                let value =
                    value.map(|it| if matches!(it, Value::Switch(_)) { Value::Switch(on) } else { it });
                WidgetState { value, ..state }
            });
            let ignored = layout.widgets.iter().take(1).map(|widget| IgnoredPress {
                at,
                id: widget.id.clone(),
                contact: ContactId(3),
                force: Newtons(20.0),
                why: Ignored::TooLight,
            });
            // Somebody stands on every second tile.
            let tiles = (0..Geometry::default().tile_count()).map(|tile| TileState {
                force: Newtons(if tile % 2 == 0 { 700.0 } else { 0.0 }),
                ..TileState::default()
            });
            let snapshot = Snapshot {
                at,
                page,
                widgets: widgets.collect(),
                ignored: ignored.collect(),
                tiles: tiles.collect(),
                ..Snapshot::default()
            };
            all.push((format!("{name}, on: {on}"), snapshot));
        }
    }
    all
}

#[test]
fn every_text_on_the_floor_can_be_read_in_every_theme() {
    let geometry = Geometry::default();
    for layout in shipped() {
        for page in 0..layout.pages.len().max(1) {
            for (state, snapshot) in snapshots(&layout, page) {
                for (name, theme) in Theme::NAMED {
                    for (theme, show) in
                        [(theme, Show::WINDOW), (theme, Show::PICTURE), (theme.projected(), Show::PROJECTOR)]
                    {
                        let mut scene = Scene::new();
                        draw(&mut scene, &View { show, ..View::new(&geometry, &layout, &snapshot, &theme) });
                        let found = unreadable(&scene, &theme);
                        assert!(found.is_empty(), "{name}, {}, {state}: {}", layout.title, found.join("; "));
                    }
                }
            }
        }
    }
}

#[test]
fn the_check_finds_a_text_that_cannot_be_read() {
    let mut scene = Scene::new();
    let theme = Theme::LIGHT;
    scene.clear(Rect::from_min_size(Vec2::ZERO, Vec2::ONE), theme.canvas);
    let letters = |ink| Lettering::new(Vec2::splat(0.5), Anchor::Middle, 0.1, Ink::solid(ink));
    scene.add_text(letters(theme.ink), format_args!("dark"));
    assert_eq!(unreadable(&scene, &theme), Vec::<String>::new());
    let dark = Paint::fill(Ink::solid(theme.ink));
    scene.add_box(Rect::from_centre_size(Vec2::splat(0.5), Vec2::splat(0.6)), 0.0, dark);
    scene.add_text(letters(theme.ink), format_args!("dark on dark"));
    assert!(unreadable(&scene, &theme).iter().all(|it| it.contains("dark on dark")));
    assert!(!unreadable(&scene, &theme).is_empty());
}

/// Mean colour and mean lightness of the texture of the only ground on a floor.
fn look_of(ground: &str, theme: &Theme) -> (Colour, usize, f32) {
    let text = format!("Layout(version: 1, grounds: [{ground}(at: (0, 0), size: (6, 6))])");
    let geometry = Geometry::default();
    let layout = parse_layout(&text, ground, &Kinds::builtin(), &geometry).unwrap().layout;
    let mut scene = Scene::new();
    draw(
        &mut scene,
        &View { show: Show::PROJECTOR, ..View::new(&geometry, &layout, &Snapshot::default(), theme) },
    );
    let points = (0..40).flat_map(|x| (0..40).map(move |y| Vec2::new(x as f32, y as f32) * 0.045 + 0.02));
    let colours: Vec<Colour> = points
        .map(|point| {
            scene.marks().iter().fold(theme.canvas, |under, mark| painted(&scene, mark, point, under))
        })
        .collect();
    let mean = |channel: fn(&Colour) -> u8| {
        (colours.iter().map(|it| f32::from(channel(it))).sum::<f32>() / colours.len() as f32) as u8
    };
    let mean = Colour::rgb(mean(|it| it.red), mean(|it| it.green), mean(|it| it.blue));
    // The brightest light on the ground: fields, crystals, lines.
    let lights = scene.marks().iter().filter_map(|mark| match mark {
        Mark::Path { paint, .. } => paint.stroke.map(|stroke| blend(mean, stroke.ink)),
        Mark::Ellipse { paint, .. } => paint.fill.map(|ink| blend(mean, ink)),
        _ => None,
    });
    let brightest = lights.chain(colours).map(|it| it.contrast(mean)).fold(1.0, f32::max);
    (mean, scene.marks().len(), brightest)
}

#[test]
fn grounds_are_dark_in_dark_themes_and_keep_their_own_colours_and_light() {
    let grounds = ["Ice", "Snow", "Gravel", "Sand", "Wood"];
    for (name, theme) in &Theme::NAMED[1..] {
        let looks = grounds.map(|ground| look_of(ground, theme));
        for (ground, (mean, _, brightest)) in grounds.iter().zip(looks) {
            assert!(mean.luminance() < 0.2, "{name}: {ground} shines: {mean}");
            assert!(brightest >= 1.8, "{name}: {ground} has no texture: {brightest}");
        }
        for (index, (ground, (mean, marks, _))) in grounds.iter().zip(looks).enumerate() {
            for (other, (elsewhere, count, _)) in grounds.iter().zip(looks).take(index) {
                let apart = [mean.red.abs_diff(elsewhere.red), mean.blue.abs_diff(elsewhere.blue)];
                let counts = marks.max(count) as f32 / marks.min(count) as f32;
                assert!(
                    apart.into_iter().max() >= Some(12) || counts > 1.3,
                    "{name}: {ground} {mean} looks like {other} {elsewhere}"
                );
            }
        }
    }
}

#[test]
fn guards_have_lines_of_their_own_that_can_be_seen_in_every_theme() {
    let text = "Layout(version: 1, regions: [(id: \"r\", at: (0, 0), size: (6, 6))], widgets: [
        (id: \"free\", kind: \"button\", at: (0, 0), size: (1, 1)),
        (id: \"confirm\", kind: \"confirm_button\", at: (2, 0), size: (1, 1)),
        (id: \"hold\", kind: \"dead_man\", at: (4, 0), size: (1, 1)),
    ])";
    let geometry = Geometry::default();
    let layout = parse_layout(text, "guards", &Kinds::builtin(), &geometry).unwrap().layout;
    for (name, theme) in Theme::NAMED {
        let mut scene = Scene::new();
        let show = Show::PROJECTOR;
        draw(&mut scene, &View { show, ..View::new(&geometry, &layout, &Snapshot::default(), &theme) });
        // Solid and dashed lines inside each face, with their contrast.
        let lines = |index: usize| -> Vec<(bool, f32)> {
            let face = layout.widgets[index].area.grown(-0.01);
            let inside = scene.marks().iter().filter_map(|mark| match mark {
                Mark::Box { area, paint, .. } if face.contains(area.min) && face.contains(area.max) => {
                    paint.stroke
                }
                _ => None,
            });
            let middle = layout.widgets[index].area.centre();
            let ground =
                scene.marks().iter().fold(theme.canvas, |under, mark| painted(&scene, mark, middle, under));
            inside.map(|it| (it.dash.is_some(), blend(ground, it.ink).contrast(ground))).collect()
        };
        let least = if theme.least_contrast() > 5.0 { 5.0 } else { 2.0 };
        let [free, confirm, hold] = [lines(0), lines(1), lines(2)];
        assert!(free.is_empty(), "{name}");
        assert!(matches!(confirm[..], [(false, ratio)] if ratio >= least), "{name}: {confirm:?}");
        assert!(matches!(hold[..], [(true, ratio)] if ratio >= least), "{name}: {hold:?}");
    }
}
