//! A page on the floor of a server, without a browser: feet there are seen and released here, designs go there.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;
use std::sync::atomic::AtomicUsize;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use serde_json::Value;
use underfoot::engine::Snapshot;
use underfoot::floor::Floor;
use underfoot::glam::Vec2;
use underfoot::layout::Layout;
use underfoot::mirror::{Greeting, MirrorFeed};
use underfoot::schema::{Kinds, builtin_layout, parse_layout};
use underfoot::sense::Method;
use underfoot::serve::Server;
use underfoot::units::Newtons;
use underfoot::widget::WidgetId;
use underfoot::wire::LinkState;
use underfoot_sim::{FloorBuild, FloorQuality, Host, Pace, SimulatedSource, feet_by_hand};
use underfoot_web::clock::PageClock;
use underfoot_web::joined::JoinedFloor;
use underfoot_window::preview::{
    EventNews, FootSink, LayoutCause, LayoutNews, Mouse, Notice, PreviewCommand, PreviewFoot, PreviewInput,
    ServerLink, Warnings,
};

fn ms(millis: u64) -> Duration {
    Duration::from_millis(millis)
}

/// A simulated floor that is served.
struct Served {
    server: Server,
    floor: Floor,
    clock: Arc<PageClock>,
    hand: Mouse,
    frames: Receiver<Vec<u8>>,
    takes_layouts: bool,
}

impl Served {
    fn new(takes_layouts: bool) -> Self {
        let (sim, floor) = FloorBuild::of(FloorQuality::default(), 1).in_use(&Floor::default()).unwrap();
        let (hand, driver) = feet_by_hand();
        let clock = Arc::<PageClock>::default();
        let host = Arc::clone(&clock);
        let source = SimulatedSource::on(sim, Box::new(driver), Pace::RealTime, host);
        let (tell, frames) = channel();
        let feed = MirrorFeed::start(Arc::new(AtomicUsize::new(1)), move |frame| drop(tell.send(frame)));
        let input = feed.unwrap().wrap(source, floor.geometry);
        let server = Server::new(&floor, layout("first_steps", &floor), Method::default(), input);
        Self { server, floor, clock, hand: Mouse(hand), frames, takes_layouts }
    }

    fn greeting(&self) -> String {
        let mut seen = Snapshot::default();
        self.server.snapshot(&mut seen);
        let layout = self.server.engine().layout();
        Greeting::line(&self.floor, layout, &seen, Method::default(), self.takes_layouts)
    }

    /// Runs for 16 ms with the ball of a foot pressing at `at`; returns the frames.
    fn run(&mut self, at: Vec2, force: f32) -> Vec<Vec<u8>> {
        let foot = |position| PreviewFoot {
            position,
            heading_rad: 0.0,
            length_m: 0.28,
            force: Newtons(force),
            roll: 0.75,
            left: false,
        };
        let acts_at = self.hand.centre_of_pressure(&foot(Vec2::ZERO));
        self.hand.lead(0.016, &[vec![foot(at - acts_at)]]);
        let until = self.clock.elapsed() + ms(16);
        while self.clock.elapsed() < until {
            self.server.turn().unwrap();
        }
        // The frames come from a thread.
        let first = self.frames.recv_timeout(Duration::from_secs(10));
        first.into_iter().chain(self.frames.try_iter()).collect()
    }
}

fn layout(name: &str, floor: &Floor) -> Layout {
    parse_layout(builtin_layout(name).unwrap(), name, &Kinds::builtin(), &floor.geometry).unwrap().layout
}

/// A page that has joined the floor.
struct Page {
    served: Served,
    floor: JoinedFloor,
    input: PreviewInput,
    now: Duration,
}

impl Page {
    fn new(takes_layouts: bool) -> Self {
        let served = Served::new(takes_layouts);
        let greeting = served.greeting();
        let (floor, input) = JoinedFloor::join(&greeting, "127.0.0.1:9002", None, ms(500)).unwrap();
        Self { served, floor, input, now: ms(500) }
    }

    /// Lets a foot press at `at` on the server's floor for a while.
    fn stand(&mut self, at: Vec2, force: f32, for_ms: u64) {
        let until = self.now + ms(for_ms);
        while self.now < until {
            self.now += ms(16);
            for frame in self.served.run(at, force) {
                self.floor.take(&frame, self.now).unwrap();
            }
            self.floor.run_until(self.now).unwrap();
        }
    }

    /// Lets the time of the page pass without a word of the server.
    fn wait(&mut self, length: Duration) {
        let until = self.now + length;
        while self.now < until {
            self.now += ms(8);
            self.floor.run_until(self.now).unwrap();
        }
    }

    fn snapshot(&mut self) -> &Snapshot {
        self.input.snapshots.read()
    }

    /// The events so far, as `light pressed`.
    fn events(&self) -> Vec<String> {
        let news = self.input.channels.events.try_iter();
        news.filter_map(|news| match news {
            EventNews::Event(event) => Some(format!("{} {}", event.id, event.kind.name())),
            EventNews::Restarted(_) => Some("again".into()),
            EventNews::Sent(_) => None,
        })
        .collect()
    }

    fn link(&mut self) -> ServerLink {
        self.input.server.as_mut().unwrap()().link
    }

    fn command(&self, command: PreviewCommand) {
        self.input.channels.commands.try_send(command).unwrap();
    }

    /// The requests of the page now: path and arguments.
    fn requests(&mut self) -> Vec<(String, Value)> {
        let lines = self.floor.run_until(self.now).unwrap();
        let read = |line: &String| {
            let mut asked: Value = serde_json::from_str(line).unwrap();
            (asked["request"].as_str().unwrap().to_owned(), asked["args"].take())
        };
        lines.iter().map(read).collect()
    }

    fn light(&self) -> Vec2 {
        let layout = self.served.server.engine().layout();
        layout.widgets[layout.widget_index("light").unwrap()].area.centre()
    }
}

#[test]
fn a_foot_on_the_floor_presses_here_and_every_control_is_released_with_the_connection() {
    let mut page = Page::new(false);
    let light = page.light();
    page.stand(light, 0.0, 600);
    assert_eq!((page.events(), page.link()), (Vec::new(), ServerLink::Joined));
    page.stand(light, 150.0, 500);
    assert!(page.events().contains(&"light pressed".into()));
    let seen = page.snapshot();
    assert!(seen.link == LinkState::Live && seen.contacts.len() == 1, "{:?} {:?}", seen.link, seen.contacts);
    let at = seen.contacts[0].centroid;
    assert!(at.distance(light) < 0.03, "{at} {light}");

    let now = page.now;
    page.floor.lose("the connection broke", now);
    assert_eq!(page.link(), ServerLink::Lost("the connection broke".into()));
    let seen = page.snapshot();
    assert!(seen.link == LinkState::Lost && seen.contacts.is_empty());
    assert!(seen.widgets.iter().all(|state| !state.pressed));
    assert!(page.events().contains(&"light cancelled".into()));
    page.wait(ms(1000));
    assert!(page.events().is_empty(), "nothing more happens");

    let greeting = page.served.greeting();
    page.floor.hear(&greeting, page.now).unwrap();
    assert_eq!((page.link(), page.events()), (ServerLink::Joined, vec!["again".to_owned()]));
    page.stand(light, 0.0, 600);
    page.stand(light, 150.0, 400);
    assert!(page.events().contains(&"light pressed".into()));
}

#[test]
fn a_server_that_says_nothing_has_no_feet_after_150_ms_and_is_given_up_after_two_seconds() {
    let mut page = Page::new(false);
    let light = page.light();
    page.stand(light, 0.0, 600);
    page.stand(light, 150.0, 500);
    assert_eq!(page.snapshot().contacts.len(), 1);
    page.events();
    page.wait(ms(80));
    assert_eq!(page.snapshot().contacts.len(), 1, "a network may be late");
    page.wait(ms(64));
    assert!(page.snapshot().contacts.is_empty() && page.snapshot().link == LinkState::Lost);
    assert!(page.events().contains(&"light cancelled".into()));
    page.now += ms(2000);
    page.floor.run_until(page.now).unwrap();
    let why = page.floor.run_until(page.now + ms(8)).unwrap_err();
    assert_eq!(why, "the server is silent");
}

#[test]
fn a_page_that_was_busy_for_half_a_second_has_lost_nothing() {
    let mut page = Page::new(false);
    let light = page.light();
    page.stand(light, 0.0, 600);
    page.stand(light, 150.0, 500);
    page.events();
    // Meanwhile the frames wait in the browser, and the look at the time comes first.
    let waiting: Vec<Vec<u8>> = (0..32).flat_map(|_| page.served.run(light, 150.0)).collect();
    page.now += ms(512);
    page.floor.run_until(page.now).unwrap();
    assert_eq!(page.snapshot().contacts.len(), 1);
    for frame in waiting {
        page.floor.take(&frame, page.now).unwrap();
    }
    page.wait(ms(16));
    assert!(page.snapshot().contacts.len() == 1 && page.snapshot().link == LinkState::Live);
    assert_eq!(page.events(), Vec::<String>::new(), "the foot still presses");
}

#[test]
fn frames_that_wait_for_seconds_in_a_slow_browser_are_not_shown_one_by_one() {
    let mut page = Page::new(false);
    page.stand(Vec2::new(0.5, 0.5), 0.0, 400);
    page.now += ms(3000);
    let late: Vec<_> = page.served.run(Vec2::new(0.5, 0.5), 0.0);
    let why = page.floor.take(&late[0], page.now).unwrap_err();
    assert!(why.contains("behind the floor"), "{why}");
}

#[test]
fn a_design_goes_to_a_server_that_takes_layouts_and_its_refusal_comes_back() {
    let other = |page: &Page| Arc::new(layout("map", &page.served.floor));
    let put = |layout: Arc<Layout>| PreviewCommand::Try {
        layout,
        name: "mine.ron".into(),
        warnings: Warnings::default(),
        cause: LayoutCause::Designed,
    };
    let mut keeps = Page::new(false);
    keeps.command(put(other(&keeps)));
    assert!(keeps.requests().is_empty());
    let Ok(Notice::Text(text)) = keeps.input.channels.notices.try_recv() else { panic!("it says so") };
    assert!(text.contains("--web-layouts"), "{text}");

    let mut page = Page::new(true);
    page.command(put(other(&page)));
    let asked = page.requests();
    assert_eq!((asked.len(), asked[0].0.as_str()), (1, "layout"));
    let sent = asked[0].1[0].as_str().unwrap();
    let read = parse_layout(sent, "sent", &Kinds::builtin(), &page.served.floor.geometry).unwrap().layout;
    assert_eq!(read.widgets.len(), other(&page).widgets.len());
    page.floor.hear(r#"{"event":"error","request":"layout","why":"no"}"#, page.now).unwrap();
    let Ok(LayoutNews::Refused { name, diagnostics }) = page.input.channels.layouts.try_recv() else {
        panic!("it is told why")
    };
    assert_eq!((name.as_str(), diagnostics.as_str()), ("mine.ron", "no"));
    // One a second.
    page.command(put(other(&page)));
    assert!(page.requests().is_empty());
    page.now += ms(1200);
    assert_eq!(page.requests().len(), 1);
}

#[test]
fn values_and_mutes_of_the_window_are_requests() {
    let mut page = Page::new(false);
    page.command(PreviewCommand::Enable { id: WidgetId::new("light"), enabled: false });
    page.command(PreviewCommand::Mute(true));
    page.command(PreviewCommand::TurnControlsOff(true));
    let asked = page.requests();
    let texts: Vec<String> = asked.iter().map(|(path, args)| format!("{path} {args}")).collect();
    assert_eq!(texts, ["widget/light/disable []", "mute/set [true]", "controls_off [true]"]);
}

#[test]
fn words_of_another_program_are_refused_with_the_reason() {
    for text in ["", "{}", r#"{"event":"floor"}"#, r#"{"event":"mirror","version":9}"#] {
        assert!(JoinedFloor::join(text, "127.0.0.1:9002", None, ms(0)).is_err(), "{text}");
    }
}
