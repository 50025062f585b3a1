//! Parsing and playing scenarios.

use super::*;
use crate::{Foot, FootDriver};
use underfoot::feel::Feel;
use underfoot::layout::{Colour, CursorRule, Look, Region, Shape};
use underfoot::units::Instant;
use underfoot::widget::{
    Behaviour, ButtonSpec, DialSpec, PadSpec, Scale, SliderSpec, SliderTrack, Thresholds, WidgetId,
};

fn layout() -> Layout {
    let thresholds = Thresholds::new(Newtons(40.0), Newtons(30.0));
    let slider = SliderSpec::new(thresholds, Scale::UNIT);
    let widget = |id, kind: &str, area, behaviour| Widget {
        id: WidgetId::new(id),
        kind: kind.into(),
        region: 0,
        page: None,
        goto: None,
        area,
        label: String::new(),
        behaviour,
        feel: Feel::default(),
        send: Vec::new(),
        look: Look {
            shape: Shape::Box,
            face: Colour::default(),
            lit: Colour::default(),
            ink: Colour::default(),
            icon: None,
        },
    };
    let tiles = |x: f32, y: f32, w: f32, h: f32| {
        Rect::from_min_size(Vec2::new(x, y) * 0.304, Vec2::new(w, h) * 0.304)
    };
    let button = Behaviour::Button(ButtonSpec::new(thresholds));
    Layout {
        title: "Test".into(),
        regions: vec![Region {
            id: "all".into(),
            area: Geometry::default().bounds(),
            cursor: CursorRule::Largest,
            send: Vec::new(),
        }],
        stances: Vec::new(),
        pages: Vec::new(),
        targets: Vec::new(),
        grounds: Vec::new(),
        widgets: vec![
            widget("zoom_in", "button", tiles(2.6, 1.6, 0.6, 0.6), button.clone()),
            widget("layers", "button", tiles(3.4, 1.6, 0.6, 0.6), button),
            widget("zoom", "slider", tiles(2.2, 2.4, 1.8, 0.5), Behaviour::Slider(slider)),
        ],
    }
}

fn parse(steps: &str) -> Result<Scenario, Diagnostics> {
    Scenario::parse("test.ron", &format!("Scenario(title: \"Test\", steps: [\n{steps}\n])"))
}

fn play(script: &mut Script) -> Vec<Vec<Foot>> {
    let mut feet = Vec::new();
    (0..).map_while(|ms| script.feet(Instant::from_millis(ms), &mut feet).then(|| feet.clone())).collect()
}

/// The code block in the documentation.
fn documented() -> String {
    let lines = include_str!("mod.rs").lines();
    let block = lines.skip_while(|line| *line != "/// ```ron").skip(1).take_while(|line| *line != "/// ```");
    block.map(|line| format!("{}\n", line.trim_start_matches("///"))).collect()
}

#[test]
fn every_scenario_is_the_same_by_ron() {
    let texts = [Scenario::CROSSING, Scenario::SESSION, Scenario::STROLL, &documented()];
    for text in texts {
        let read: Scenario = ron::from_str(text).unwrap_or_else(|error| panic!("{error}"));
        let parsed = Scenario::parse("scenario.ron", text).unwrap();
        assert_eq!(read.written, parsed.written);
        for written in [
            ron::to_string(&read).unwrap(),
            ron::ser::to_string_pretty(&read, ron::ser::PrettyConfig::new().struct_names(true)).unwrap(),
        ] {
            assert_eq!(ron::from_str::<Scenario>(&written).unwrap().written, parsed.written, "{written}");
            assert_eq!(Scenario::parse("written.ron", &written).unwrap().written, parsed.written);
        }
    }
}

#[test]
fn the_documented_scenario_plays() {
    let scenario = Scenario::parse("documentation", &documented()).unwrap();
    assert_eq!(scenario.title(), "Zoom in, then wander off");
    let mut script = scenario.resolve(&layout(), &Geometry::default()).unwrap();
    let seconds = script.duration().as_secs_f32();
    assert!((20.0..40.0).contains(&seconds), "{seconds}");
    let frames = play(&mut script);
    assert_eq!(frames[0].len(), 2, "only the one who stands there from the start");
    assert!(frames.iter().any(|feet| feet.len() == 4));
}

#[test]
fn somebody_crosses_the_floor() {
    let scenario = Scenario::parse("crossing.ron", Scenario::CROSSING).unwrap();
    let mut script = scenario.resolve(&layout(), &Geometry::default()).unwrap();
    let frames = play(&mut script);
    assert!(frames[0].is_empty() && frames.last().unwrap().is_empty());
    let columns: std::collections::BTreeSet<u16> = frames
        .iter()
        .flatten()
        .flat_map(|foot| foot.on_tiles(&Geometry::default()))
        .map(|load| load.tile.column)
        .collect();
    assert_eq!(columns.len(), 6, "{columns:?}");
}

#[test]
fn a_person_stands_with_the_feet_as_far_apart_as_written() {
    for apart_m in [0.1, 0.3] {
        let text = format!(
            "Scenario(title: \"Test\", person: (stand_m: {apart_m}), steps: [Stand(at: (3.0, 3.0)), Wait(ms: 100)])"
        );
        let scenario = Scenario::parse("test.ron", &text).unwrap();
        let frames = play(&mut scenario.resolve(&layout(), &Geometry::default()).unwrap());
        let [left, right] = &frames[0][..] else { panic!("{frames:?}") };
        let found_m = left.position.distance(right.position);
        assert!((found_m - apart_m).abs() < 0.04, "{found_m}");
    }
}

#[test]
fn presses_and_drags_meet_their_controls() {
    let layout = layout();
    let scenario = parse(
        "Stand(at: (3.0, 0.6)), Press(widget: \"zoom_in\", force_n: 120, hold_ms: 300),\
         Tap(widget: \"layers\", force_n: 90), Drag(widget: \"zoom\", from: 0.2, to: 0.8, force_n: 80),\
         Point(at: (2.0, 2.0), force_n: 70, hold_ms: 100)",
    );
    let mut script = scenario.unwrap().resolve(&layout, &Geometry::default()).unwrap();
    let frames = play(&mut script);
    let held = |force: f32| -> Vec<Foot> {
        // A foot is held if its force stays constant between two frames.
        let steady = |pair: &[Vec<Foot>]| {
            pair[0]
                .iter()
                .zip(&pair[1])
                .find(|(a, b)| a.force == b.force && (a.force.0 - force).abs() < 0.01)
                .map(|(a, _)| *a)
        };
        frames.windows(2).filter_map(steady).collect()
    };
    let on = |id: &str| layout.widgets[layout.widget_index(id).unwrap()].area;
    for (id, force, millis) in [("zoom_in", 120.0, 300), ("layers", 90.0, 60)] {
        let feet = held(force);
        assert!((millis - 2..millis + 4).contains(&feet.len()), "{id} is held for {} ms", feet.len());
        assert!(feet.iter().all(|foot| foot.centre_of_pressure().distance(on(id).centre()) < 1e-4), "{id}");
    }
    let drag = held(80.0);
    let share = |foot: &Foot| (foot.centre_of_pressure().x - on("zoom").min.x) / on("zoom").size().x;
    assert!((share(&drag[0]) - 0.2).abs() < 1e-3 && (share(drag.last().unwrap()) - 0.8).abs() < 1e-3);
    assert!(drag.iter().all(|foot| on("zoom").contains(foot.centre_of_pressure())));
    assert!(held(70.0)[0].centre_of_pressure().distance(Vec2::splat(2.0 * 0.304)) < 1e-4);
}

#[test]
fn drags_follow_the_geometry_of_what_they_drag() {
    let thresholds = Thresholds::new(Newtons(40.0), Newtons(30.0));
    let mut layout = layout();
    let ways = |layout: &Layout, steps: &str| -> Vec<Vec2> {
        let steps = format!("Stand(at: (3.0, 0.8)), {steps}");
        let mut script = parse(&steps).unwrap().resolve(layout, &Geometry::default()).unwrap();
        let frames = play(&mut script);
        let working = |feet: &Vec<Foot>| feet.iter().find(|foot| (foot.force.0 - 80.0).abs() < 0.01).copied();
        frames.iter().filter_map(working).map(|foot| foot.centre_of_pressure()).collect()
    };
    let ends = |way: &[Vec2]| [*way.first().unwrap(), *way.last().unwrap()];
    let [from, to] = ends(&ways(&layout, "Drag(from: (2.0, 2.0), to: (2.4, 2.2))"));
    assert!(from.distance(Vec2::splat(2.0 * 0.304)) < 1e-4, "{from}");
    assert!(to.distance(Vec2::new(2.4, 2.2) * 0.304) < 1e-4, "{to}");

    let at = layout.widget_index("zoom").unwrap();
    layout.widgets[at].area = Rect::from_min_size(Vec2::new(0.7, 0.6), Vec2::splat(0.4));
    let area = layout.widgets[at].area;
    layout.widgets[at].behaviour = Behaviour::Pad(PadSpec::new(thresholds, Scale::UNIT, Scale::UNIT));
    let [from, to] = ends(&ways(&layout, "Drag(widget: \"zoom\", from: (0.5, 0.5), to: (0.2, 0.8))"));
    assert!(from.distance(area.centre()) < 1e-4, "{from}");
    assert!(to.distance(area.min + Vec2::new(0.2, 0.8) * 0.4) < 1e-4, "{to}");

    let (scale, initial) = (Scale::UNIT, 0.0);
    layout.widgets[at].behaviour =
        Behaviour::Dial(DialSpec { thresholds, scale, turn_degrees: 360.0, initial });
    let way = ways(&layout, "Drag(widget: \"zoom\", from: 0.25, to: 1.0)");
    let spokes: Vec<Vec2> = way.iter().map(|at| *at - area.centre()).collect();
    assert!(spokes.iter().all(|spoke| (spoke.length() - 0.12).abs() < 1e-4));
    assert!(spokes[0].distance(Vec2::new(-0.12, 0.0)) < 1e-4, "a quarter of the turn from the south is west");
    let turned: f32 = spokes.windows(2).map(|pair| pair[0].angle_to(pair[1])).sum();
    assert!((turned + 1.5 * std::f32::consts::PI).abs() < 0.02, "clockwise: {turned}");

    let track = SliderTrack::Arc { from_degrees: 180.0, to_degrees: 0.0 };
    layout.widgets[at].behaviour =
        Behaviour::Slider(SliderSpec { track, ..SliderSpec::new(thresholds, scale) });
    let way = ways(&layout, "Drag(widget: \"zoom\", from: 0.0, to: 1.0)");
    let share = |at: Vec2| track.share_at((at - area.min) / area.size(), area.size()).unwrap();
    assert!(share(way[0]) < 1e-3 && share(way[way.len() - 1]) > 0.999);
    let highest = way.iter().map(|at| at.y).fold(f32::MIN, f32::max);
    assert!(highest > way[0].y + 0.1, "over the top of the arc, not across");
}

#[test]
fn ends_of_drags_that_do_not_fit_are_told_with_what_would() {
    let told = |drag: &str| messages(&format!("Stand(at: (3.0, 0.6)),\nDrag({drag})"));
    let slider = told("widget: \"zoom\", from: (0.2, 0.2), to: 0.2");
    assert!(slider.contains("`from` is a share of \"zoom\", which is a slider: write 0.5"), "{slider}");
    assert!(slider.contains("test.ron:3:28"), "{slider}");
    let floor = told("from: 0.2, to: (9, 1)");
    assert!(floor.contains("`from` is a place in tiles, as Drag has no `widget`: write (2.5, 3)"), "{floor}");
    let floor = told("from: (2, 2), to: (9, 1)");
    assert!(floor.contains("(9, 1) is not on this floor of 6 x 6 tiles"), "{floor}");
    let share = told("widget: \"zoom\", from: 0.2, to: 1.2");
    assert!(share.contains("expected 0 to 1, found 1.2"), "{share}");
}

fn messages(steps: &str) -> String {
    match parse(steps).and_then(|scenario| scenario.resolve(&layout(), &Geometry::default())) {
        Err(error) => error.to_string(),
        Ok(_) => "no error".into(),
    }
}

#[test]
fn mistakes_are_told_with_their_places_and_all_at_once() {
    let told = messages(
        "Stand(at: (3.0, 0.6)),\n  Press(widget: \"zom_in\"),\nDrag(widget: \"layers\", from: 0.1, to: 0.9),\n\
         WalkTo(at: (7, 2)),\nWalkTo(at: (1, 2), via: [(1, 1), (1, 9)]),",
    );
    insta::assert_snapshot!(told, @r#"
    error: the layout has no control "zom_in"
     --> test.ron:3:17
      |
    3 |   Press(widget: "zom_in"),
      |                 ^^^^^^^^
      = help: did you mean "zoom_in"?

    error: Drag needs a slider, a dial or a pad, and "layers" is a button
     --> test.ron:4:14
      |
    4 | Drag(widget: "layers", from: 0.1, to: 0.9),
      |              ^^^^^^^^

    error: (7, 2) is not on this floor of 6 x 6 tiles
     --> test.ron:5:12
      |
    5 | WalkTo(at: (7, 2)),
      |            ^^^^^^

    error: (1, 9) is not on this floor of 6 x 6 tiles
     --> test.ron:6:34
      |
    6 | WalkTo(at: (1, 2), via: [(1, 1), (1, 9)]),
      |                                  ^^^^^^

    test.ron: 4 errors
    "#);
}

#[test]
fn typing_errors_speak_of_what_is_written() {
    let told = [
        messages("Pres(widget: \"zoom_in\")"),
        messages("Press(wiget: \"zoom_in\")"),
        messages("Press(widget: \"zoom_in\", force_n: -5)"),
        messages("Press(widget: \"zoom_in\", force_n: NaN)"),
        messages("Wait(ms: 700000)"),
        messages("Wait(ms: 5"),
        messages("Stand(at: (3, 1)), Stand(at: (3, 1))"),
        Scenario::parse("test.ron", "Scenario(title: \"Two\", person: (mass_kg: 900), steps: [])")
            .unwrap_err()
            .to_string(),
    ];
    insta::assert_snapshot!(told.join("\n"), @r#"
    error: there is no `step` called Pres
     --> test.ron:2:1
      |
    2 | Pres(widget: "zoom_in")
      | ^^^^^^^^^^^^^^^^^^^^^^^ expected Wait, Stand, Enter, WalkTo, Sidestep, Turn, Press, Tap, Drag, Point or Leave
      = help: did you mean Press?

    test.ron: 1 error
    error: unknown field `wiget`
     --> test.ron:2:7
      |
    2 | Press(wiget: "zoom_in")
      |       ^^^^^ a press has no such field
      = help: did you mean `widget`?

    test.ron: 1 error
    error: `force_n` is out of range
     --> test.ron:2:35
      |
    2 | Press(widget: "zoom_in", force_n: -5)
      |                                   ^^ expected 0 to 3000 N, found -5 N

    test.ron: 1 error
    error: `force_n` must be an ordinary number
     --> test.ron:2:35
      |
    2 | Press(widget: "zoom_in", force_n: NaN)
      |                                   ^^^ expected 0 to 3000 N, found NaN

    test.ron: 1 error
    error: `ms` is out of range
     --> test.ron:2:10
      |
    2 | Wait(ms: 700000)
      |          ^^^^^^ expected 0 to 600000, found 700000

    test.ron: 1 error
    error: this `(` is never closed
     --> test.ron:2:5
      |
    2 | Wait(ms: 5
      |     ^ expected a `)` further down
      = help: line 3 closes the `[` around it with `]`

    test.ron: 1 error
    error: Stand must be the first step; later on, Enter
     --> test.ron:2:20
      |
    2 | Stand(at: (3, 1)), Stand(at: (3, 1))
      |                    ^^^^^^^^^^^^^^^^^

    test.ron: 1 error
    error: `mass_kg` is out of range
     --> test.ron:1:42
      |
    1 | Scenario(title: "Two", person: (mass_kg: 900), steps: [])
      |                                          ^^^ expected 10 to 300 kg, found 900 kg

    test.ron: 1 error
    "#);
}

#[test]
fn impossible_moves_are_told_at_their_step() {
    let told = [
        messages("Press(widget: \"zoom_in\")"),
        messages("Stand(at: (1.0, 5.0)),\nPress(widget: \"zoom_in\")"),
        messages("Stand(at: (3.0, 1.5)),\nPoint(at: (3.02, 1.5))"),
        messages("Stand(at: (3.0, 0.6)),\nPress(widget: \"zoom_in\", force_n: 1000)"),
    ];
    insta::assert_snapshot!(told.join("\n"), @r#"
    error: the person is not on the floor: let it Enter first
     --> test.ron:2:1
      |
    2 | Press(widget: "zoom_in")
      | ^^^^^^^^^^^^^^^^^^^^^^^^

    test.ron: 1 error
    error: the foot would have to reach 1.18 m from the one that stands, further than 0.85 m: WalkTo somewhere nearer first
     --> test.ron:3:1
      |
    3 | Press(widget: "zoom_in")
      | ^^^^^^^^^^^^^^^^^^^^^^^^

    test.ron: 1 error
    error: the other foot stands there, 0.09 m away: WalkTo beside the place first
     --> test.ron:3:1
      |
    3 | Point(at: (3.02, 1.5))
      | ^^^^^^^^^^^^^^^^^^^^^^

    test.ron: 1 error
    error: a person of 687 N cannot press with 1000 N
     --> test.ron:3:1
      |
    3 | Press(widget: "zoom_in", force_n: 1000)
      | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^

    test.ron: 1 error
    "#);
}

#[test]
fn every_beginning_of_a_scenario_is_an_error_and_never_a_panic() {
    let text = documented();
    for end in (0..text.trim_end().len()).filter(|&end| text.is_char_boundary(end)) {
        assert!(Scenario::parse("cut", &text[..end]).is_err(), "{end}");
    }
}

proptest::proptest! {
    #[test]
    fn a_slip_of_the_pen_never_panics(at in 0usize..1500, slip in "[(){}\\[\\],:.\"0-9a-z/*-]{0,3}") {
        let mut text: Vec<char> = documented().chars().collect();
        let at = at.min(text.len() - 1);
        text.splice(at..=at, slip.chars());
        let text: String = text.into_iter().collect();
        if let Ok(scenario) = Scenario::parse("slip", &text) {
            let _ = scenario.resolve(&layout(), &Geometry::default());
        }
    }
}

#[test]
fn deep_nesting_and_huge_files_are_refused() {
    let deep = "(".repeat(100_000);
    assert!(parse(&deep).is_err());
    let huge = format!("{}\n{}", Scenario::CROSSING, " ".repeat(4 << 20));
    assert!(Scenario::parse("huge", &huge).is_err());
}

#[test]
fn files_with_a_byte_order_mark_are_read() {
    assert!(Scenario::parse("bom", &format!("\u{feff}{}", Scenario::CROSSING)).is_ok());
}
