//! Tests of scenes, mark by mark.

use std::collections::HashSet;

use glam::Vec2;

use super::sample::{self, at_rest, button, map, pressing, widget};
use super::widths::{CAP_HEIGHT, width};
use super::{Anchor, Lettering, Mark, Scene, Shoe, Show, Theme, View, draw};
use underfoot::engine::Snapshot;
use underfoot::floor::{Corner, Geometry, Rect, TileId};
use underfoot::layout::{Layout, Shape, Widget};
use underfoot::sense::Quality;
use underfoot::units::Newtons;
use underfoot::widget::{Indicator, Scale, SliderTrack, Value};
use underfoot::wire::LinkState;

fn drawn(layout: &Layout, snapshot: &Snapshot) -> Scene {
    shown(layout, snapshot, Show::WINDOW)
}

fn shown(layout: &Layout, snapshot: &Snapshot, show: Show) -> Scene {
    let mut scene = Scene::new();
    let geometry = Geometry::default();
    draw(&mut scene, &View { show, ..View::new(&geometry, layout, snapshot, &Theme::LIGHT) });
    scene
}

#[test]
fn labels_and_ranges_that_apps_set_are_drawn() {
    let layout = map();
    let time = layout.widget_index("time").unwrap();
    let mut snapshot = at_rest(&layout);
    let says = |snapshot: &Snapshot, text: &str| {
        let scene = drawn(&layout, snapshot);
        scene.marks().iter().any(|mark| match mark {
            Mark::Text { letters, .. } => scene.letters(*letters).contains(text),
            _ => false,
        })
    };
    assert!(!says(&snapshot, "Slice"));
    snapshot.labels.push((time, "Slice".into()));
    assert!(says(&snapshot, "Slice"));
    let before = drawn(&layout, &snapshot);
    let scale = *layout.widgets[time].behaviour.scale().unwrap();
    snapshot.ranges.push((time, Scale { max: 2.0 * scale.max, ..scale }));
    assert!(drawn(&layout, &snapshot) != before, "the handle stands elsewhere");
}

/// A layout with this control only.
fn only(widget: Widget) -> Layout {
    Layout { widgets: vec![widget], stances: vec![], ..map() }
}

/// Bounds of the letters of a line without a turn.
fn extent(text: &str, lettering: &Lettering) -> Rect {
    let size = Vec2::new(width(text), CAP_HEIGHT) * lettering.size_m;
    let west = match lettering.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -0.5 * size.x,
        Anchor::End => -size.x,
    };
    let from = lettering.at + Vec2::new(west, 0.0);
    let turned = |at: Vec2| lettering.at + Vec2::from_angle(lettering.turn_rad).rotate(at - lettering.at);
    let (one, other) = (turned(from), turned(from + size));
    Rect::new(one.min(other), one.max(other))
}

#[test]
fn words_stay_on_their_controls_and_off_each_other() {
    let labels = [
        "",
        "Go",
        "Zoom in",
        "Next patient record",
        "Donaudampfschifffahrtsgesellschaft",
        "一二三四五六七八九十",
    ];
    // From the smallest target that a foot can hit (10 cm) to a whole row of tiles, in both directions.
    let sizes = [[0.34, 0.34], [1.0, 0.4], [0.45, 1.6], [1.0, 1.0], [3.0, 0.6], [0.6, 3.0]];
    let mut behaviours = vec![
        button(),
        sample::switch(true),
        sample::slider(SliderTrack::EAST, 0.0, 24.0, 0.0, 23.9),
        sample::slider(SliderTrack::NORTH, -100.0, 100.0, 0.25, -99.75),
    ];
    behaviours.extend(sample::others());
    for label in labels {
        for size in sizes {
            for behaviour in &behaviours {
                for shape in [Shape::Box, Shape::Round] {
                    let layout =
                        only(widget("it", label, [1.0, 1.0], size, behaviour.clone(), sample::blue(shape)));
                    for (disabled, needs_lift, armed) in [
                        (false, false, false),
                        (true, false, false),
                        (false, true, false),
                        (false, false, true),
                    ] {
                        let mut snapshot = at_rest(&layout);
                        snapshot.widgets[0].disabled = disabled;
                        snapshot.widgets[0].needs_lift = needs_lift;
                        snapshot.widgets[0].armed = armed;
                        let scene = shown(&layout, &snapshot, Show::PROJECTOR);
                        let words: Vec<_> = scene
                            .texts()
                            .filter(|(text, _)| *text != "map")
                            .map(|(text, lettering)| (text.to_owned(), extent(text, lettering)))
                            .collect();
                        let area = layout.widgets[0].area.grown(0.002);
                        for (text, place) in &words {
                            assert!(
                                area.contains(place.min) && area.contains(place.max),
                                "“{text}” at {place:?} leaves {area:?} ({size:?}, {behaviour:?}, {shape:?})"
                            );
                        }
                        for (at, (text, place)) in words.iter().enumerate() {
                            for (other, elsewhere) in &words[..at] {
                                assert!(
                                    !place.overlaps(*elsewhere),
                                    "“{text}” covers “{other}” ({size:?}, {behaviour:?}, {shape:?}, {needs_lift})"
                                );
                            }
                        }
                    }
                }
            }
        }
    }
}

fn differs(one: &Scene, other: &Scene) -> bool {
    one != other
}

#[test]
fn each_state_of_a_control_looks_its_own_way() {
    let layout = map();
    let rest = at_rest(&layout);
    let states = [
        rest.clone(),
        with(&rest, |it| it.widgets[0].press_share = 0.5),
        with(&rest, |it| it.widgets[0].press_share = 0.8),
        with(&rest, |it| (it.widgets[0].pressed, it.widgets[0].press_share) = (true, 1.5)),
        with(&rest, |it| it.widgets[0].disabled = true),
        with(&rest, |it| it.widgets[0].needs_lift = true),
        with(&rest, |it| it.widgets[0].locked = true),
        with(&rest, |it| it.widgets[0].armed = true),
        with(&rest, |it| it.widgets[0].warned = true),
        with(&rest, |it| it.widgets[0].indicator = Indicator::On),
        with(&rest, |it| it.widgets[0].indicator = Indicator::Busy),
        with(&rest, |it| it.widgets[0].indicator = Indicator::Attention),
        with(&rest, |it| it.widgets[7].value = Some(Value::Switch(true))),
        with(&rest, |it| it.widgets[9].value = Some(Value::Number(3.0))),
        with(&rest, |it| it.widgets[10].value = Some(Value::Number(90.0))),
    ];
    let scenes: Vec<_> = states.iter().map(|state| shown(&layout, state, Show::PROJECTOR)).collect();
    for (at, scene) in scenes.iter().enumerate() {
        for (earlier, other) in scenes[..at].iter().enumerate() {
            assert!(differs(scene, other), "states {earlier} and {at} look alike");
        }
    }
}

#[test]
fn each_value_of_each_behaviour_looks_its_own_way() {
    let changed = |value: Value| match value {
        Value::Switch(on) => Value::Switch(!on),
        Value::Number(number) => Value::Number(number + 0.5),
        Value::Choice(choice) => Value::Choice(choice + 1),
        Value::Pair(pair) => Value::Pair(pair + Vec2::new(0.3, -0.4)),
    };
    for behaviour in sample::others() {
        let layout = only(widget("it", "Label", [1.0, 1.0], [1.0, 0.8], behaviour, sample::sand()));
        let rest = at_rest(&layout);
        let other = with(&rest, |it| it.widgets[0].value = it.widgets[0].value.map(changed));
        let scenes = [&rest, &other].map(|state| shown(&layout, state, Show::PROJECTOR));
        let name = layout.widgets[0].behaviour.name();
        assert!(differs(&scenes[0], &scenes[1]), "{name}");
        let pressed = with(&rest, |it| it.widgets[0].pressed = true);
        assert!(differs(&scenes[0], &shown(&layout, &pressed, Show::PROJECTOR)), "{name}");
    }
    // A selector outlines the option under the foot before the foot chooses it.
    let selector = sample::others().swap_remove(1);
    let layout = only(widget("it", "Label", [1.0, 1.0], [1.0, 0.8], selector, sample::sand()));
    let rest = at_rest(&layout);
    let pending = with(&rest, |it| it.widgets[0].pending = Some(Value::Choice(2)));
    assert!(differs(&shown(&layout, &rest, Show::WINDOW), &shown(&layout, &pending, Show::WINDOW)));
}

fn with(snapshot: &Snapshot, change: impl FnOnce(&mut Snapshot)) -> Snapshot {
    let mut changed = snapshot.clone();
    change(&mut changed);
    changed
}

#[test]
fn a_pressed_button_sinks_and_turns_to_its_lit_colour() {
    let layout = map();
    let lit = layout.widgets[0].look.lit;
    let face = |snapshot: &Snapshot| {
        shown(&layout, snapshot, Show::PROJECTOR)
            .marks()
            .iter()
            .filter_map(|mark| match mark {
                Mark::Box { area, paint, .. } if area.contains(layout.widgets[0].area.centre()) => {
                    paint.fill.filter(|ink| ink.opacity == 1.0).map(|ink| (*area, ink.colour))
                }
                _ => None,
            })
            .next_back()
            .unwrap()
    };
    let (up, at_rest_colour) = face(&at_rest(&layout));
    let (down, pressed_colour) = face(&pressing(&layout));
    assert_eq!(pressed_colour, lit);
    assert_ne!(at_rest_colour, lit);
    assert!(down.size().x < up.size().x);
}

#[test]
fn the_handle_of_a_slider_is_where_the_value_is() {
    let layout = map();
    for (value, share) in [(0.0, 0.0), (6.0, 0.25), (24.0, 1.0), (99.0, 1.0), (f32::NAN, 0.0)] {
        let mut snapshot = at_rest(&layout);
        snapshot.widgets[9].value = Some(Value::Number(value));
        let scene = shown(&layout, &snapshot, Show::PROJECTOR);
        let area = layout.widgets[9].area;
        let lit = layout.widgets[9].look.lit;
        let filled = scene.marks().iter().find_map(|mark| match mark {
            Mark::Box { area: part, paint, .. } if paint.fill.is_some_and(|ink| ink.colour == lit) => {
                Some(*part)
            }
            _ => None,
        });
        let east = filled.unwrap().max.x;
        let wanted = area.min.x + share * area.size().x;
        // The track ends a centimetre inside the control.
        assert!((east - wanted).abs() <= 0.0101, "{value}: filled to {east}, not {wanted}");
    }
}

/// Numbers of points of the paths with their mean within a centimetre of `at`.
fn paths_near(scene: &Scene, at: Vec2) -> Vec<usize> {
    let near = |mark: &Mark| match mark {
        Mark::Path { points, .. } => {
            let points = scene.points(*points);
            let mean = points.iter().copied().sum::<Vec2>() / points.len() as f32;
            (mean.distance(at) < 0.01).then_some(points.len())
        }
        _ => None,
    };
    scene.marks().iter().filter_map(near).collect()
}

#[test]
fn sensors_that_cannot_be_trusted_have_shapes_of_their_own() {
    let layout = Layout { widgets: vec![], stances: vec![], ..map() };
    let geometry = Geometry::default();
    let at = geometry.sensor(TileId::new(2, 1), Corner::NorthWest);
    let index = geometry.index(TileId::new(2, 1)).unwrap();
    let lines = |quality| {
        let mut snapshot = at_rest(&layout);
        snapshot.tiles[index].quality[Corner::NorthWest.index()] = quality;
        // Visible even without the layer of sensor forces.
        paths_near(&shown(&layout, &snapshot, Show::LAYOUT), at)
    };
    assert_eq!(lines(Quality::Live), [0; 0]);
    assert_eq!(lines(Quality::Degraded), [3], "a triangle");
    assert_eq!(lines(Quality::Stale), [4], "a diamond");
    assert_eq!(lines(Quality::Faulty), [2, 2], "a cross");
}

#[test]
fn a_tile_of_which_nothing_is_known_is_hatched() {
    let layout = Layout { widgets: vec![], stances: vec![], ..map() };
    let mut snapshot = at_rest(&layout);
    let before = drawn(&layout, &snapshot).marks().len();
    snapshot.tiles[8].quality = [Quality::Stale; 4];
    // The marks of four live sensors disappear, and the hatching appears.
    assert!(drawn(&layout, &snapshot).marks().len() > before + 10);
    // Before the first packet every tile is in that state, and the window shows a message instead.
    snapshot.link = LinkState::Waiting;
    assert!(drawn(&layout, &snapshot).marks().len() < before);
}

#[test]
fn dots_and_circles_grow_in_area_with_the_force() {
    let layout = Layout { widgets: vec![], stances: vec![], ..map() };
    let at = Vec2::new(0.6, 0.7);
    let radius = |force: f32| {
        let mut snapshot = at_rest(&layout);
        sample::step_on(&mut snapshot, 1, at, force, Vec2::ZERO);
        let scene = drawn(&layout, &snapshot);
        let circle = scene.marks().iter().find_map(|mark| match mark {
            Mark::Ellipse { centre, radii, .. } if *centre == at => Some(radii.x),
            _ => None,
        });
        circle.unwrap()
    };
    assert!((radius(400.0) / radius(100.0) - 2.0).abs() < 1e-3);
}

#[test]
fn a_plate_shows_who_stands_on_it_and_no_noise() {
    let layout = map();
    // The plates, without the force written on them.
    let under = |force_n: f32| -> Vec<Mark> {
        let snapshot = with(&at_rest(&layout), |snapshot| snapshot.tiles[7].force = Newtons(force_n));
        let scene = shown(&layout, &snapshot, Show { loads: true, ..Show::WINDOW });
        scene
            .marks()
            .iter()
            .filter(|mark| matches!(mark, Mark::Box { radius_m: 0.008, .. }))
            .copied()
            .collect()
    };
    assert_eq!(under(0.0).len(), 36);
    // Noise of two sensors of the paper's floor, and a reading that is lost.
    for noise_n in [0.8, -0.8, f32::NAN] {
        assert_eq!(under(0.0), under(noise_n), "{noise_n} N");
    }
    // A person on one foot sways by a newton or two; a step of somebody else is heavier.
    assert_eq!(under(700.0), under(701.5));
    assert!(under(0.0) != under(30.0) && under(30.0) != under(700.0));
}

#[test]
fn the_cursor_stands_out_from_other_contacts() {
    let layout = map();
    let cursor = Theme::LIGHT.cursor;
    let rings = |snapshot: &Snapshot| {
        drawn(&layout, snapshot)
            .marks()
            .iter()
            .filter(|mark| match mark {
                Mark::Ellipse { paint, .. } => paint.stroke.is_some_and(|stroke| stroke.ink.colour == cursor),
                _ => false,
            })
            .count()
    };
    let pressed = pressing(&layout);
    assert_eq!(rings(&pressed), 2, "its circle and its ring");
    assert_eq!(rings(&with(&pressed, |it| it.cursors[0] = None)), 0);
}

#[test]
fn nonsense_in_a_snapshot_draws_nothing_that_is_not_finite() {
    let layout = map();
    let mut snapshot = pressing(&layout);
    snapshot.contacts[0].centroid = Vec2::new(f32::NAN, 0.0);
    snapshot.contacts[1].velocity = Vec2::splat(f32::INFINITY);
    snapshot.widgets[0].press_share = f32::NAN;
    snapshot.widgets[9].value = Some(Value::Number(f32::INFINITY));
    snapshot.tiles[0].forces = [f32::NAN, f32::INFINITY, -1e30, 1e30];
    // Fewer controls and tiles than in the layout and the floor, as just after a reload.
    snapshot.tiles.truncate(20);
    snapshot.widgets.truncate(10);
    snapshot.widgets[3].value = Some(Value::Switch(true));
    let geometry = Geometry::default();
    let shoes = [Shoe {
        position: Vec2::NAN,
        heading_rad: 0.0,
        length_m: 0.28,
        force: Newtons(f32::NAN),
        roll: f32::NAN,
        left: false,
    }];
    let levels = [f32::NAN, f32::INFINITY, 0.5, -1.0];
    let mut scene = Scene::new();
    let view = View {
        shoes: &shoes,
        levels: &levels,
        chosen: Some(TileId::new(99, 99)),
        show: Show::PICTURE,
        ..View::new(&geometry, &layout, &snapshot, &Theme::DARK)
    };
    draw(&mut scene, &view);
    for mark in scene.marks() {
        let finite = match mark {
            Mark::Box { area, radius_m, .. } | Mark::Halo { area, radius_m, .. } => {
                area.min.is_finite() && area.max.is_finite() && radius_m.is_finite()
            }
            Mark::Ellipse { centre, radii, .. } => centre.is_finite() && radii.is_finite(),
            Mark::Path { points, .. } => scene.points(*points).iter().all(|point| point.is_finite()),
            Mark::Field { area, .. } => area.min.is_finite() && area.max.is_finite(),
            Mark::Band { points, reach, .. } => {
                reach.is_finite() && scene.points(*points).iter().all(|point| point.is_finite())
            }
            Mark::Text { lettering, .. } => lettering.at.is_finite() && lettering.size_m.is_finite(),
        };
        assert!(finite, "{mark:?}");
    }
}

#[test]
fn drawing_again_into_the_same_scene_gives_the_same_drawing() {
    let layout = map();
    let geometry = Geometry::default();
    let snapshot = pressing(&layout);
    let view = View::new(&geometry, &layout, &snapshot, &Theme::LIGHT);
    let mut scene = Scene::new();
    draw(&mut scene, &view);
    let first = scene.clone();
    draw(&mut scene, &view);
    assert_eq!(first, scene);
}

#[test]
fn a_projector_sees_the_floor_and_nothing_around_it() {
    let layout = map();
    let scene = shown(&layout, &pressing(&layout), Show::PROJECTOR);
    assert_eq!(scene.bounds(), Geometry::default().bounds());
    let words: HashSet<_> = scene.texts().map(|(text, _)| text).collect();
    assert!(words.contains("Zoom in"));
    assert!(!words.iter().any(|text| text.contains(" N")), "forces are for windows: {words:?}");
}

#[test]
fn words_around_a_floor_grow_with_it() {
    let layout = Layout { widgets: vec![], stances: vec![], regions: vec![], ..map() };
    let snapshot = Snapshot::default();
    for (columns, rows) in [(1, 1), (6, 6), (24, 2), (96, 96)] {
        let geometry = Geometry::of_paper_tiles(columns, rows).unwrap();
        let mut scene = Scene::new();
        let show = Show::PICTURE;
        draw(&mut scene, &View { show, ..View::new(&geometry, &layout, &snapshot, &Theme::LIGHT) });
        let wide = geometry.bounds().size().x;
        for (text, lettering) in scene.texts() {
            let place = extent(text, lettering);
            assert!(scene.bounds().contains(place.min) && scene.bounds().contains(place.max), "“{text}”");
            assert!((0.012..0.04).contains(&(lettering.size_m / wide)), "“{text}” on {columns} x {rows}");
        }
        let words: Vec<_> = scene.texts().map(|(text, lettering)| extent(text, lettering)).collect();
        for (at, place) in words.iter().enumerate() {
            assert!(!words[..at].iter().any(|other| other.overlaps(*place)), "{columns} x {rows}");
        }
    }
}
