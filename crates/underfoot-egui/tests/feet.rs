//! Feet on a floor press, drag and cancel the widgets of an egui app.

use std::time::Duration;

use egui::accesskit::Role;
use egui::{Rect, Slider, SliderOrientation, Ui, Vec2, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use underfoot::engine::{FootRole, FootState, Snapshot};
use underfoot::floor;
use underfoot::glam;
use underfoot::layout::Layout;
use underfoot::schema::{self, Kinds};
use underfoot::sense::{Contact, ContactId};
use underfoot::units::{Instant, Newtons};
use underfoot::wire::LinkState;
use underfoot_egui::{FloorView, FootInput, FootSlider};
use underfoot_scene::scene::{Show, Theme};

const WINDOW: Vec2 = vec2(600.0, 600.0);

/// Time between two frames, in seconds.
const PICTURE_S: f32 = 0.05;

#[derive(Default)]
struct App {
    clicks: u32,
    /// A horizontal slider, a vertical one, and two for feet.
    values: [f32; 4],
}

impl App {
    fn ui(&mut self, ui: &mut Ui) {
        if ui.button("Press me").clicked() {
            self.clicks += 1;
        }
        let [lying, standing, left, right] = &mut self.values;
        ui.add(Slider::new(lying, 0.0..=100.0).text("lying"));
        ui.add(Slider::new(standing, 0.0..=100.0).orientation(SliderOrientation::Vertical).text("standing"));
        ui.add(FootSlider::new(left, 0.0..=100.0).text("left"));
        ui.add(FootSlider::new(right, 0.0..=100.0).text("right"));
    }
}

/// An app, and the floor below it: six metres of floor under 600 points of window, so that a point is a centimetre.
struct Stage {
    app: Harness<'static, App>,
    feet: FootInput,
    layout: Layout,
    floor: Snapshot,
}

impl Stage {
    fn new() -> Self {
        let app = Harness::builder()
            .with_size(WINDOW)
            .with_step_dt(PICTURE_S)
            .build_ui_state(|ui, app: &mut App| app.ui(ui), App { values: [50.0; 4], ..App::default() });
        FootInput::tune(&app.ctx);
        let part = floor::Rect::from_min_size(glam::Vec2::ZERO, glam::Vec2::splat(6.0));
        let floor = Snapshot { link: LinkState::Live, ..Snapshot::default() };
        let layout = Layout {
            title: "Bare".into(),
            regions: vec![],
            stances: vec![],
            pages: vec![],
            targets: vec![],
            grounds: vec![],
            widgets: vec![],
        };
        let mut stage = Self { app, feet: FootInput::new(part), layout, floor };
        stage.pictures(3);
        stage
    }

    /// Advances by `count` frames of app and floor.
    fn pictures(&mut self, count: usize) {
        for _ in 0..count {
            self.floor.at = self.floor.at + Duration::from_secs_f32(PICTURE_S);
            self.picture();
        }
    }

    fn picture(&mut self) {
        let context = self.app.ctx.clone();
        self.feet.feed(&context, &self.layout, &self.floor, self.app.input_mut());
        self.app.step();
    }

    /// Puts or moves the foot `id` to the window's point `x`, `y`.
    fn put(&mut self, id: u32, (x, y): (f32, f32)) {
        self.lift(id);
        let id = ContactId(id);
        let centroid = glam::Vec2::new(x, WINDOW.y - y) / 100.0;
        self.floor.contacts.push(Contact { id, centroid, force: Newtons(120.0), ..Contact::default() });
        self.floor.feet.push(FootState { contact: id, role: FootRole::Free, person: 0, weight: None });
    }

    fn lift(&mut self, id: u32) {
        self.floor.contacts.retain(|contact| contact.id != ContactId(id));
        self.floor.feet.retain(|foot| foot.contact != ContactId(id));
    }

    fn middle(&self, role: Role, label: &str) -> (f32, f32) {
        let rect = self.app.get_by_role_and_label(role, label).rect();
        (rect.center().x, rect.center().y)
    }

    fn is_down(&self) -> bool {
        self.app.ctx.input(|input| input.pointer.any_down() || input.any_touches())
    }
}

#[test]
fn a_long_press_that_rolls_clicks_once() {
    let mut stage = Stage::new();
    let (x, y) = stage.middle(Role::Button, "Press me");
    // 1.2 s, in which the foot rolls by 12 points.
    for picture in 0..24 {
        stage.put(1, (x - 6.0 + 12.0 * picture as f32 / 23.0, y));
        stage.pictures(1);
    }
    assert_eq!(stage.app.state().clicks, 0, "only the release counts");
    stage.lift(1);
    stage.pictures(4);
    assert_eq!(stage.app.state().clicks, 1);
    assert!(!stage.is_down());
}

/// A cause that ends a press without a click.
type Cancel = (&'static str, fn(&mut Stage));

const CANCELS: [Cancel; 6] = [
    ("a step", |stage| stage.floor.feet[0].role = FootRole::Step),
    ("an object", |stage| stage.floor.feet[0].role = FootRole::Object),
    ("beside the part", |stage| stage.floor.contacts[0].centroid.x = -0.1),
    ("a lost floor", |stage| stage.floor.link = LinkState::Lost),
    ("a floor that stands still", |stage| {
        for _ in 0..5 {
            stage.picture();
        }
    }),
    ("the app", |stage| {
        let context = stage.app.ctx.clone();
        stage.feet.cancel(&context, stage.app.input_mut());
    }),
];

#[test]
fn a_cancelled_press_neither_clicks_nor_changes_nor_stays_down() {
    for (name, cancel) in CANCELS {
        for (role, label) in [
            (Role::Button, "Press me"),
            (Role::Slider, "lying"),
            (Role::Slider, "standing"),
            (Role::Slider, "left"),
        ] {
            let mut stage = Stage::new();
            let at = stage.middle(role, label);
            stage.put(1, at);
            stage.pictures(4);
            assert!(stage.is_down(), "{name}, {label}");
            let followed = stage.app.state().values;
            cancel(&mut stage);
            stage.pictures(4);
            let App { clicks, values, .. } = stage.app.state();
            assert_eq!(*clicks, 0, "{name}, {label}");
            assert!(!stage.is_down(), "{name}, {label}");
            // egui's own sliders keep their last value; those for feet restore the old one.
            let expected = if label == "left" { [50.0; 4] } else { followed };
            assert_eq!(*values, expected, "{name}, {label}");
            // The remaining foot has to lift first.
            stage.floor.link = LinkState::Live;
            stage.put(1, at);
            stage.pictures(4);
            assert!(!stage.is_down(), "{name}, {label}");
        }
    }
}

#[test]
fn a_slider_for_feet_takes_back_what_a_cancelled_foot_did() {
    let mut stage = Stage::new();
    let (x, y) = stage.middle(Role::Slider, "left");
    stage.put(1, (x, y));
    stage.pictures(3);
    stage.put(1, (x + 60.0, y));
    stage.pictures(2);
    assert!(stage.app.state().values[2] > 60.0);
    stage.floor.feet[0].role = FootRole::Step;
    stage.pictures(2);
    assert_eq!(stage.app.state().values, [50.0; 4]);
}

#[test]
fn two_feet_drag_two_sliders_at_once() {
    let mut stage = Stage::new();
    let ((x, left), (_, right)) = (stage.middle(Role::Slider, "left"), stage.middle(Role::Slider, "right"));
    for picture in 0..20 {
        let way = 4.0 * picture as f32;
        stage.put(1, (x - way, left));
        stage.put(2, (x + way, right));
        stage.pictures(1);
        assert_eq!(stage.feet.touches(), if picture < 2 { 0 } else { 2 });
    }
    let [lying, standing, less, more] = stage.app.state().values;
    assert!(less < 25.0 && more > 75.0, "{less} and {more}");
    assert_eq!((lying, standing), (50.0, 50.0));
    // The first one lifts; the other one keeps dragging.
    stage.lift(1);
    stage.put(2, (x, right));
    stage.pictures(2);
    assert_eq!(stage.app.state().values[2], less);
    assert!((stage.app.state().values[3] - 50.0).abs() < 1.0);
    stage.lift(2);
    stage.pictures(2);
    assert!(!stage.is_down());
}

#[test]
fn feet_that_were_put_down_elsewhere_or_on_a_control_do_not_touch() {
    let geometry = floor::Floor::default().geometry;
    let page = "Layout(version: 1, title: \"One\", regions: [(id: \"all\", at: (0, 0), size: (6, 6))], \
                widgets: [(id: \"erase\", kind: \"confirm_button\", at: (2, 2), size: (0.7, 0.6))])";
    let mut stage = Stage::new();
    stage.layout = schema::parse_layout(page, "one.ron", &Kinds::builtin(), &geometry).unwrap().layout;
    let on_control = stage.layout.widgets[0].area.centre() * 100.0;
    stage.put(1, (on_control.x, WINDOW.y - on_control.y));
    stage.put(2, (-20.0, 100.0));
    stage.pictures(3);
    // Both slide to places where a press would touch.
    stage.put(1, (300.0, 100.0));
    stage.put(2, (200.0, 100.0));
    stage.pictures(3);
    assert_eq!(stage.feet.touches(), 0);
    // A foot beside them is not affected.
    stage.put(3, (400.0, 100.0));
    stage.pictures(3);
    assert_eq!(stage.feet.touches(), 1);
}

#[test]
fn numbers_that_are_none_and_parts_without_area_touch_nothing() {
    let mut stage = Stage::new();
    stage.put(1, (f32::NAN, 100.0));
    stage.pictures(3);
    assert_eq!(stage.feet.touches(), 0);
    stage.feet = FootInput::new(floor::Rect::default());
    stage.put(2, (0.0, WINDOW.y));
    stage.pictures(3);
    assert_eq!(stage.feet.touches(), 0);
}

#[test]
fn the_part_is_stretched_over_the_target() {
    let mut stage = Stage::new();
    let (x, y) = stage.middle(Role::Button, "Press me");
    // The whole floor maps to the button.
    stage.feet.set_target(Rect::from_center_size(pos2(x, y), vec2(20.0, 10.0)));
    stage.put(1, (10.0, 590.0));
    stage.pictures(4);
    stage.lift(1);
    stage.pictures(2);
    assert_eq!(stage.app.state().clicks, 1);
}

#[test]
fn the_floor_is_drawn_and_named() {
    let geometry = floor::Floor::default().geometry;
    let text = schema::builtin_layout("map").unwrap();
    let layout = schema::parse_layout(text, "map.ron", &Kinds::builtin(), &geometry).unwrap().layout;
    let snapshot = Snapshot { at: Instant::from_millis(1), ..Snapshot::default() };
    let mut harness = Harness::builder().with_size(WINDOW).build_ui_state(
        move |ui, floor: &mut FloorView| {
            let (response, map) = floor.ui(ui, &geometry, &layout, &snapshot);
            let bounds = geometry.bounds();
            assert!(response.rect.contains_rect(map.rect(bounds)));
        },
        FloorView::new(Theme::LIGHT, Show::WINDOW),
    );
    harness.run();
    assert!(harness.query_by_label("Floor").is_some());
    assert!(harness.output().shapes.len() > 100, "{}", harness.output().shapes.len());
}
