//! Keys and pointer of an X server, through its extension XTEST.

mod keymap;
mod window;

use std::collections::BTreeMap;

use underfoot::messages::{Act, Holdable, KeyStroke, KeyboardTarget, MouseButton};
use x11rb::connection::Connection;
use x11rb::errors::{ConnectionError, ReplyError};
use x11rb::protocol::Event;
use x11rb::protocol::xproto::{
    BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT, KEY_PRESS_EVENT, KEY_RELEASE_EVENT, MOTION_NOTIFY_EVENT, Window,
};
use x11rb::protocol::xtest::ConnectionExt as _;
use x11rb::rust_connection::RustConnection;
use x11rb::wrapper::ConnectionExt as _;

use self::keymap::Keymap;
use super::outlet::{Outlet, OutletError};

/// The buttons of the X protocol that are steps of the wheel, away from the user and towards.
const WHEEL: [u8; 2] = [4, 5];

/// Maximum number of steps of the wheel in one order; the rest is left out.
const MOST_STEPS: u32 = 200;

/// Keyboard and pointer of one X server.
pub(super) struct X11Outlet {
    connection: RustConnection,
    root: Window,
    /// Width and height of the screen, in pixels.
    size: [u16; 2],
    keymap: Keymap,
    /// Part of the title or class of the window that may receive.
    window: Option<String>,
    /// The number of holds of each key; keys share modifiers.
    down: BTreeMap<u8, u32>,
}

impl X11Outlet {
    /// Connects to the display of `target`.
    pub(super) fn open(target: &KeyboardTarget) -> Result<Self, OutletError> {
        let display = target.display.as_deref();
        let named = display.map_or_else(|| std::env::var("DISPLAY").unwrap_or_default(), str::to_owned);
        let gone = |error: &dyn std::fmt::Display| {
            OutletError::Gone(format!("the X display {named:?} can't be used: {error}"))
        };
        let (connection, screen) = RustConnection::connect(display).map_err(|error| gone(&error))?;
        let screen = connection.setup().roots.get(screen).ok_or_else(|| gone(&"it has no such screen"))?;
        let (root, size) = (screen.root, [screen.width_in_pixels, screen.height_in_pixels]);
        connection
            .xtest_get_version(2, 2)
            .map_err(ReplyError::from)
            .and_then(x11rb::cookie::Cookie::reply)
            .map_err(|error| gone(&format!("it lacks the extension XTEST: {error}")))?;
        let keymap = Keymap::read(&connection).map_err(|error| gone(&error))?;
        Ok(Self { connection, root, size, keymap, window: target.window.clone(), down: BTreeMap::new() })
    }

    fn fake(&self, kind: u8, detail: u8, [x, y]: [i16; 2]) -> Result<(), ConnectionError> {
        self.connection.xtest_fake_input(kind, detail, x11rb::CURRENT_TIME, self.root, x, y, 0)?;
        Ok(())
    }

    /// Reads the keyboard's layout again after it has changed.
    fn follow_keymap(&mut self) -> Result<(), OutletError> {
        let mut changed = false;
        while let Some(event) = self.connection.poll_for_event().map_err(|error| lost(&error))? {
            changed |= matches!(event, Event::MappingNotify(_));
        }
        if changed {
            self.keymap = Keymap::read(&self.connection).map_err(|error| lost(&error))?;
        }
        Ok(())
    }

    fn codes(&self, key: &KeyStroke) -> Result<Vec<u8>, OutletError> {
        self.keymap.codes(key).map_err(|missing| {
            OutletError::Refused(format!("the keyboard of this X display has no key {missing}"))
        })
    }

    fn press(&mut self, key: &KeyStroke) -> Result<(), OutletError> {
        for code in self.codes(key)? {
            let holds = self.down.entry(code).or_default();
            *holds += 1;
            if *holds == 1 {
                self.fake(KEY_PRESS_EVENT, code, [0; 2]).map_err(|error| lost(&error))?;
            }
        }
        Ok(())
    }

    /// Lets a key come up that [`X11Outlet::press`] pressed; with `force` also one that another program pressed.
    fn lift(&mut self, key: &KeyStroke, force: bool) -> Result<(), OutletError> {
        for code in self.codes(key)?.into_iter().rev() {
            let holds = self.down.entry(code).or_default();
            *holds = if force { 0 } else { holds.saturating_sub(1) };
            if *holds == 0 {
                self.down.remove(&code);
                self.fake(KEY_RELEASE_EVENT, code, [0; 2]).map_err(|error| lost(&error))?;
            }
        }
        Ok(())
    }

    fn down(&mut self, what: &Holdable) -> Result<(), OutletError> {
        match what {
            Holdable::Key(key) => self.press(key),
            Holdable::Button(button) => {
                self.fake(BUTTON_PRESS_EVENT, number(*button), [0; 2]).map_err(|error| lost(&error))
            }
            _ => Err(no_key()),
        }
    }

    fn up(&mut self, what: &Holdable, force: bool) -> Result<(), OutletError> {
        match what {
            Holdable::Key(key) => self.lift(key, force),
            Holdable::Button(button) => {
                self.fake(BUTTON_RELEASE_EVENT, number(*button), [0; 2]).map_err(|error| lost(&error))
            }
            _ => Ok(()),
        }
    }

    /// Whether the window that has the focus may receive.
    fn check_window(&self) -> Result<(), OutletError> {
        let Some(wanted) = &self.window else { return Ok(()) };
        let found = window::focused(&self.connection).map_err(|error| lost(&error))?;
        if found.iter().any(|name| name.contains(wanted.as_str())) {
            return Ok(());
        }
        let there = found.first().map_or("no window".to_owned(), |name| format!("{name:?}"));
        Err(OutletError::Refused(format!("the keyboard is in {there}, not in {wanted:?}")))
    }

    /// Waits until the X server has carried everything out: it drops the requests of a client that closes its connection
    /// before they were read.
    fn settle(&self) -> Result<(), OutletError> {
        self.connection.sync().map_err(|error| lost(&error))
    }
}

impl Outlet for X11Outlet {
    fn carry_out(&mut self, act: &Act) -> Result<(), OutletError> {
        self.follow_keymap()?;
        if !matches!(act, Act::Up(_)) {
            self.check_window()?;
        }
        match act {
            Act::Down(what, _) => self.down(what)?,
            Act::Up(what) => self.up(what, false)?,
            Act::Stroke(what) => {
                self.down(what)?;
                self.up(what, false)?;
            }
            Act::Wheel(steps) => {
                let button = if *steps > 0 { WHEEL[0] } else { WHEEL[1] };
                for _ in 0..steps.unsigned_abs().min(MOST_STEPS) {
                    for kind in [BUTTON_PRESS_EVENT, BUTTON_RELEASE_EVENT] {
                        self.fake(kind, button, [0; 2]).map_err(|error| lost(&error))?;
                    }
                }
            }
            Act::Move(pixels) => {
                let bounded =
                    pixels.map(|part| i16::try_from(part.clamp(-32_767, 32_767)).unwrap_or_default());
                // Detail 1: relative to the present place.
                self.fake(MOTION_NOTIFY_EVENT, 1, bounded).map_err(|error| lost(&error))?;
            }
            Act::Place(place) => {
                let [width, height] = self.size.map(|pixels| f32::from(pixels.saturating_sub(1)));
                let [x, y] = [place[0] * width, place[1] * height].map(|at| at.clamp(0.0, 32_767.0) as i16);
                // Detail 0: a place of the screen.
                self.fake(MOTION_NOTIFY_EVENT, 0, [x, y]).map_err(|error| lost(&error))?;
            }
            _ => return Err(no_key()),
        }
        self.settle()
    }

    fn release(&mut self, what: &Holdable) -> Result<(), OutletError> {
        match self.up(what, true) {
            // A key that the keyboard lacks is not down.
            Err(OutletError::Refused(_)) => Ok(()),
            done => done.and_then(|()| self.settle()),
        }
    }
}

fn lost(error: &dyn std::fmt::Display) -> OutletError {
    OutletError::Gone(format!("the X server has failed: {error}"))
}

fn no_key() -> OutletError {
    OutletError::Refused("a keyboard receives keys, clicks and motion only".into())
}

const fn number(button: MouseButton) -> u8 {
    match button {
        MouseButton::Left => 1,
        MouseButton::Middle => 2,
        MouseButton::Right => 3,
    }
}
