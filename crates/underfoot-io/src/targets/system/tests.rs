//! The outlet on an X server of its own, observed by another client. Skipped without Xvfb.
#![cfg(all(unix, not(target_os = "macos")))]

use std::thread;
use std::time::{Duration, Instant};

use underfoot::messages::{Act, Holdable, KeyStroke, KeySymbol, KeyboardTarget, MouseButton};
use x11rb::connection::Connection;
use x11rb::protocol::xproto::{ConnectionExt as _, KeyButMask, QueryPointerReply};
use x11rb::rust_connection::RustConnection;

use super::{SystemOutlet, keys};
use crate::targets::outlet::{Outlet, OutletError};
use xvfb::Xvfb;

#[path = "../../../../../tests/support/xvfb.rs"]
mod xvfb;

/// Time-out for what must happen, on a busy machine.
const AT_LAST: Duration = Duration::from_secs(20);

/// An X server, a client that observes it, and the outlet.
struct Desk {
    _server: Xvfb,
    observer: RustConnection,
    outlet: SystemOutlet,
}

impl Desk {
    fn open() -> Option<Self> {
        let server = Xvfb::open("640x480x24")?;
        let (observer, _) = RustConnection::connect(Some(&server.display)).unwrap();
        let target = KeyboardTarget { window: None, display: Some(server.display.clone()) };
        Some(Self { _server: server, observer, outlet: SystemOutlet::open(&target).unwrap() })
    }

    fn pointer(&self) -> QueryPointerReply {
        self.observer.query_pointer(self.observer.setup().roots[0].root).unwrap().reply().unwrap()
    }

    fn keys_down(&self) -> u32 {
        self.observer.query_keymap().unwrap().reply().unwrap().keys.iter().map(|byte| byte.count_ones()).sum()
    }

    fn wait(&self, what: &str, is_so: impl Fn(&Self) -> bool) {
        let begun = Instant::now();
        while !is_so(self) {
            assert!(begun.elapsed() < AT_LAST, "{what}: {} keys are down", self.keys_down());
            thread::sleep(Duration::from_millis(2));
        }
    }

    fn act(&mut self, act: &Act) {
        self.outlet.carry_out(act).unwrap();
    }
}

fn key(text: &str) -> Holdable {
    Holdable::Key(text.parse().unwrap())
}

#[test]
fn a_held_key_is_down_until_its_foot_leaves_and_shared_modifiers_until_the_last() {
    let Some(mut desk) = Desk::open() else { return };
    desk.act(&Act::Down(key("Control+a"), 0));
    desk.wait("Control and a", |desk| desk.keys_down() == 2);
    desk.act(&Act::Down(key("Control+Right"), 0));
    desk.wait("and Right", |desk| desk.keys_down() == 3);
    desk.act(&Act::Up(key("Control+a")));
    desk.wait("Control stays for Right", |desk| desk.keys_down() == 2);
    desk.act(&Act::Up(key("Control+Right")));
    desk.wait("none", |desk| desk.keys_down() == 0);
}

#[test]
fn a_key_that_an_earlier_guardian_left_down_is_released() {
    let Some(mut desk) = Desk::open() else { return };
    desk.act(&Act::Down(key("F5"), 0));
    desk.wait("F5", |desk| desk.keys_down() == 1);
    let display = desk.outlet.down.keys().copied().collect::<Vec<_>>();
    assert_eq!(display, [KeySymbol::Named("F5")]);
    // The next guardian knows of nothing that is down.
    desk.outlet.down.clear();
    desk.outlet.release(&key("F5")).unwrap();
    desk.wait("none", |desk| desk.keys_down() == 0);
}

#[test]
fn buttons_motion_and_places_reach_the_pointer() {
    let Some(mut desk) = Desk::open() else { return };
    desk.act(&Act::Place([0.5, 0.25]));
    desk.wait("the place", |desk| (desk.pointer().root_x, desk.pointer().root_y) == (319, 119));
    desk.act(&Act::Move([30, -9]));
    desk.wait("the motion", |desk| (desk.pointer().root_x, desk.pointer().root_y) == (349, 110));
    let is_left_down = |desk: &Desk| desk.pointer().mask.contains(KeyButMask::BUTTON1);
    desk.act(&Act::Down(Holdable::Button(MouseButton::Left), 0));
    desk.wait("the left button", is_left_down);
    desk.act(&Act::Up(Holdable::Button(MouseButton::Left)));
    desk.wait("no button", |desk| !is_left_down(desk));
}

#[test]
fn a_target_for_one_window_is_refused_with_the_way_out() {
    let target = KeyboardTarget { window: Some("viewer".into()), display: None };
    let Err(OutletError::Refused(why)) = SystemOutlet::open(&target) else { panic!("opened") };
    assert!(why.contains("\"viewer\"") && why.contains("without `window`"), "{why}");
}

#[test]
fn every_key_that_messages_name_is_there_but_those_that_linux_names_alone() {
    let missing: Vec<&str> = KeyStroke::names()
        .filter(|name| keys::key(name.parse::<KeyStroke>().unwrap().keys().last().unwrap()).is_none())
        .collect();
    assert_eq!(missing, ["Menu", "Print", "KP_Enter"], "Windows has these three too");
}
