//! The floor of the page without a browser: feet of the window press controls, and layouts come and go.
#![allow(clippy::unwrap_used)]

use std::cell::RefCell;
use std::rc::Rc;
use std::time::Duration;

use underfoot::engine::Snapshot;
use underfoot::glam::Vec2;
use underfoot::layout::Layout;
use underfoot::units::Newtons;
use underfoot_web::floor::{PageFloor, RATE};
use underfoot_web::plan::shipped;
use underfoot_web::sound::FrameSound;
use underfoot_window::link::SharedLayout;
use underfoot_window::preview::{
    EventNews, LayoutCause, LayoutNews, PreviewCommand, PreviewFoot, PreviewInput, Warnings,
};

/// A page; the test calls its frames.
struct Page {
    floor: PageFloor,
    input: PreviewInput,
    now: Duration,
}

/// Time from one frame of a page to the next.
const FRAME: Duration = Duration::from_micros(16_667);

impl Page {
    fn new(shared: &SharedLayout) -> Self {
        let (floor, input) = PageFloor::new(shared, |_| {}).unwrap();
        Self { floor, input, now: Duration::ZERO }
    }

    /// Runs for `ms` milliseconds with the ball of one foot at `at`, pressing with `force` newtons.
    fn stand(&mut self, at: Vec2, force: f32, ms: u64) {
        let foot = |position| PreviewFoot {
            position,
            heading_rad: 0.0,
            length_m: 0.28,
            force: Newtons(force),
            roll: 0.75,
            left: false,
        };
        let until = self.now + Duration::from_millis(ms);
        while self.now < until {
            let feet = self.input.feet.as_mut().unwrap();
            let acts_at = feet.centre_of_pressure(&foot(Vec2::ZERO));
            feet.lead(FRAME.as_secs_f32(), &[vec![foot(at - acts_at)]]);
            self.frame(FRAME);
        }
    }

    fn frame(&mut self, length: Duration) {
        self.now += length;
        self.floor.run_until(self.now);
    }

    /// The events so far, as `light pressed`.
    fn events(&self) -> Vec<String> {
        let news = self.input.channels.events.try_iter();
        news.filter_map(|news| match news {
            EventNews::Event(event) => Some(format!("{} {}", event.id, event.kind.name())),
            _ => None,
        })
        .collect()
    }

    fn snapshot(&mut self) -> &Snapshot {
        self.input.snapshots.read()
    }
}

fn middle_of(layout: &Layout, id: &str) -> Vec2 {
    layout.widgets.iter().find(|widget| widget.id.as_str() == id).unwrap().area.centre()
}

#[test]
fn a_foot_of_the_page_presses_a_control_and_lets_go() {
    let mut page = Page::new(&shipped("first_steps"));
    let light = middle_of(&page.input.layout, "light");
    page.stand(light, 0.0, 500);
    assert_eq!(page.events(), Vec::<String>::new(), "nobody is on the floor");
    page.stand(light, 150.0, 500);
    let heard = page.events();
    assert!(heard.iter().any(|event| event == "light pressed"), "{heard:?}");
    assert!(page.snapshot().contacts.len() == 1);
    page.stand(light, 0.0, 500);
    let heard = page.events();
    assert!(heard.iter().any(|event| event == "light released"), "{heard:?}");
    assert!(page.snapshot().contacts.is_empty());
}

#[test]
fn a_press_is_heard_on_its_side_and_felt_and_silence_is_silent() {
    let heard = Rc::<RefCell<Vec<f32>>>::default();
    let into = Rc::clone(&heard);
    let (floor, input) =
        PageFloor::new(&shipped("first_steps"), move |samples| into.borrow_mut().extend(samples)).unwrap();
    let mut page = Page { floor, input, now: Duration::ZERO };
    let light = middle_of(&page.input.layout, "light");
    page.stand(light, 0.0, 400);
    let taken = || std::mem::take(&mut *heard.borrow_mut());
    let before = taken();
    let expected = 2.0 * f64::from(RATE) * 0.4;
    assert!((before.len() as f64 - expected).abs() < 0.15 * expected, "{} samples", before.len());
    assert!(before.iter().all(|sample| *sample == 0.0) && !page.floor.has_clicked());
    page.stand(light, 150.0, 400);
    let click = taken();
    let [left, right] =
        [0, 1].map(|side| click.iter().skip(side).step_by(2).fold(0.0_f32, |most, it| most.max(it.abs())));
    assert!(left.max(right) > 0.01, "{left} {right}");
    assert!(click.iter().all(|sample| sample.abs() <= 1.0));
    assert!(page.floor.has_clicked() && !page.floor.has_clicked());
}

#[test]
fn the_floor_keeps_the_time_of_the_page_and_stands_still_while_that_is_hidden() {
    let mut page = Page::new(&shipped("first_steps"));
    page.stand(Vec2::new(0.2, 0.2), 0.0, 2000);
    let at = page.snapshot().at;
    assert!((1.95..2.05).contains(&at.secs()), "{at:?}");
    let light = middle_of(&page.input.layout, "light");
    page.stand(light, 150.0, 500);
    let (before, pressed) = (page.snapshot().at, page.events());
    assert!(pressed.iter().any(|event| event == "light pressed"));
    page.frame(Duration::from_secs(3600));
    let passed = page.snapshot().at.since(before);
    assert!(passed < Duration::from_millis(150), "{passed:?} passed for the feet");
    assert_eq!(page.events(), Vec::<String>::new(), "the foot stands as it stood");
}

#[test]
fn a_layout_of_the_window_comes_onto_the_floor_with_its_number() {
    let mut page = Page::new(&shipped("first_steps"));
    let index = page.input.choices.iter().position(|name| name == "map").unwrap();
    page.input.channels.commands.send(PreviewCommand::Open(index)).unwrap();
    page.stand(Vec2::new(0.2, 0.2), 0.0, 200);
    let news = page.input.channels.layouts.try_recv().unwrap();
    let LayoutNews::Loaded { layout, revision, name, cause, .. } = news else { panic!("{news:?}") };
    assert_eq!((name.as_str(), cause, revision), ("map", LayoutCause::Opened, 1));
    assert_eq!(page.snapshot().layout_revision, 1);
    let home = middle_of(&layout, "home");
    page.stand(home, 150.0, 300);
    assert!(page.events().iter().any(|event| event == "home pressed"));

    let edited = PreviewCommand::Try {
        layout,
        name: "mine.ron".into(),
        warnings: Warnings::default(),
        cause: LayoutCause::Designed,
    };
    page.input.channels.commands.send(edited).unwrap();
    page.stand(home, 0.0, 400);
    assert_eq!(page.snapshot().layout_revision, 2);
}

#[test]
fn kinds_and_effects_of_a_link_work_and_a_kept_effect_goes_into_the_next_link() {
    let shared = SharedLayout {
        name: "own.ron".into(),
        text: r#"Layout(version: 1, title: "own", regions: [(id: "all", at: (0, 0), size: (6, 6))],
            widgets: [(id: "big", kind: "huge", at: (1, 1), size: (2, 2))])"#
            .into(),
        // Each is made of the next: the order of the files does not matter.
        kinds: [
            ("a.ron".to_owned(), r#"Kind(name: "huge", from: "large")"#.to_owned()),
            ("b.ron".to_owned(), r#"Kind(name: "large", from: "button")"#.to_owned()),
        ]
        .into(),
        ..SharedLayout::default()
    };
    let mut page = Page::new(&shared);
    let big = middle_of(&page.input.layout, "big");
    page.stand(big, 0.0, 400);
    page.stand(big, 150.0, 400);
    assert!(page.events().iter().any(|event| event == "big pressed"));

    let effect = page.input.effects.first().unwrap().clone();
    let text = underfoot::schema::write_named_effect(&effect);
    let name = effect.name.clone();
    page.input.channels.commands.send(PreviewCommand::SaveEffect { name: name.clone(), text }).unwrap();
    page.stand(big, 0.0, 50);
    let own = page.floor.own_texts();
    let texts = own.of_layout(None);
    assert_eq!(
        (texts.kinds.len(), texts.effects.keys().collect::<Vec<_>>()),
        (2, vec![&format!("{name}.ron")])
    );
    assert!(own.read(None).effects().get(&name).is_some());
}

#[test]
fn a_layout_with_errors_is_no_floor_and_says_where_they_are() {
    let shared = SharedLayout {
        name: "bad.ron".into(),
        text: "Layout(widgets: [(id: 1)])".into(),
        ..Default::default()
    };
    let Err(error) = PageFloor::new(&shared, |_| {}) else { panic!("it has errors") };
    assert!(error.to_string().contains("bad.ron:1:"), "{error}");
}

#[test]
fn a_layout_is_made_of_the_kinds_and_effects_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    write("widgets/huge.ron", r#"Kind(name: "huge", from: "button", feel: (press: "thud"))"#);
    write(
        "effects/thud.ron",
        r#"Effect(name: "thud", about: "A low one", plays: Click(level_n: 9, modes: [(hz: 90, decay_ms: 30)]))"#,
    );
    let path = folder.path().join("layouts/mine.ron");
    let page = Page::new(&shipped("first_steps"));
    let own = page.floor.own_texts();
    assert!(own.read(None).get("huge").is_none(), "only beside the layout");
    let kinds = own.read(Some(&path));
    assert!(kinds.get("huge").is_some() && kinds.effects().get("thud").is_some());
    assert_eq!(own.of_layout(Some(&path)).kinds.len(), 1, "they go into its link");
    // A broken file among them costs no layout its kinds, nor its link.
    write("widgets/worse.ron", "Kind(name: \"worse\", from: \"huge\", look: (");
    let kinds = own.read(Some(&path));
    assert!(kinds.get("huge").is_some() && kinds.get("worse").is_none());
    assert_eq!(own.of_layout(Some(&path)).kinds.len(), 1);
}

#[test]
fn a_pause_within_a_sound_keeps_its_length_and_a_lasting_silence_wakes_nobody() {
    let (sound, mut played) = (FrameSound::default(), Vec::new());
    let mut frame = |samples: &[f32]| {
        sound.add(samples);
        sound.play(|samples| played.push(samples.len()));
    };
    frame(&[0.0; 1600]);
    frame(&[0.0, 0.5]);
    frame(&[0.0; 1600]);
    frame(&[0.25, 0.0]);
    (0..100).for_each(|_| frame(&[0.0; 1600]));
    frame(&[]);
    assert_eq!(played[..3], [2, 1600, 2]);
    let pause: usize = played[3..].iter().sum();
    assert!((RATE as usize..RATE as usize + 1600).contains(&pause), "{pause}");
}
