//! Keys and pointer of macOS and Windows, through `enigo`. Under Linux only the tests use it, on an X server of their own.

mod keys;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use enigo::{Axis, Button, Coordinate, Direction, Enigo, InputError, Keyboard as _, Mouse as _, Settings};
use underfoot::messages::{Act, Holdable, KeyStroke, KeySymbol, KeyboardTarget, MouseButton};

use super::outlet::{Outlet, OutletError};

/// Maximum number of steps of the wheel in one order; the rest is left out.
const MOST_STEPS: i32 = 200;

/// Keyboard and pointer of the user's desktop.
pub(super) struct SystemOutlet {
    enigo: Enigo,
    /// The number of holds of each key; keys share modifiers.
    down: BTreeMap<KeySymbol, u32>,
}

impl SystemOutlet {
    /// Takes hold of keyboard and pointer.
    ///
    /// # Errors
    /// [`OutletError::Refused`] for a target with a window, since the name of the window that has the keyboard is unknown
    /// here; [`OutletError::Gone`] if the system does not let programs press keys (macOS: privacy settings, accessibility).
    pub(super) fn open(target: &KeyboardTarget) -> Result<Self, OutletError> {
        if let Some(window) = &target.window {
            return Err(OutletError::Refused(format!(
                "keys only for the window {window:?} work under X11; without `window` they go to whichever has the keyboard"
            )));
        }
        let settings = Settings { x11_display: target.display.clone(), ..Settings::default() };
        let enigo = Enigo::new(&settings).map_err(|error| {
            OutletError::Gone(format!("this system does not let the program press keys: {error}"))
        })?;
        Ok(Self { enigo, down: BTreeMap::new() })
    }

    fn turn(&mut self, symbol: KeySymbol, direction: Direction) -> Result<(), OutletError> {
        let key = keys::key(symbol)
            .ok_or_else(|| OutletError::Refused(format!("this system's keyboards have no key {symbol}")))?;
        self.enigo.key(key, direction).map_err(|error| failed(&error))
    }

    fn press(&mut self, stroke: &KeyStroke) -> Result<(), OutletError> {
        for symbol in stroke.keys() {
            if self.down.get(&symbol).is_none_or(|holds| *holds == 0) {
                self.turn(symbol, Direction::Press)?;
            }
            *self.down.entry(symbol).or_default() += 1;
        }
        Ok(())
    }

    /// Lets a key come up that [`SystemOutlet::press`] pressed; with `force` also one that another program pressed.
    fn lift(&mut self, stroke: &KeyStroke, force: bool) -> Result<(), OutletError> {
        for symbol in stroke.keys().rev() {
            let holds = self.down.get(&symbol).copied().unwrap_or_default();
            let left = if force { 0 } else { holds.saturating_sub(1) };
            if left > 0 {
                self.down.insert(symbol, left);
            } else {
                self.down.remove(&symbol);
                self.turn(symbol, Direction::Release)?;
            }
        }
        Ok(())
    }

    fn down(&mut self, what: &Holdable) -> Result<(), OutletError> {
        match what {
            Holdable::Key(stroke) => self.press(stroke),
            Holdable::Button(button) => self.click(*button, Direction::Press),
            _ => Err(no_key()),
        }
    }

    fn up(&mut self, what: &Holdable, force: bool) -> Result<(), OutletError> {
        match what {
            Holdable::Key(stroke) => self.lift(stroke, force),
            Holdable::Button(button) => self.click(*button, Direction::Release),
            _ => Ok(()),
        }
    }

    fn click(&mut self, button: MouseButton, direction: Direction) -> Result<(), OutletError> {
        let button = match button {
            MouseButton::Left => Button::Left,
            MouseButton::Middle => Button::Middle,
            MouseButton::Right => Button::Right,
        };
        self.enigo.button(button, direction).map_err(|error| failed(&error))
    }

    fn place(&mut self, shares: [f32; 2]) -> Result<(), OutletError> {
        let (width, height) = self.enigo.main_display().map_err(|error| failed(&error))?;
        let pixel = |share: f32, pixels: i32| (share.clamp(0.0, 1.0) * (pixels - 1).max(0) as f32) as i32;
        self.go([pixel(shares[0], width), pixel(shares[1], height)], Coordinate::Abs)
    }

    fn go(&mut self, [x, y]: [i32; 2], coordinate: Coordinate) -> Result<(), OutletError> {
        self.enigo.move_mouse(x, y, coordinate).map_err(|error| failed(&error))
    }
}

impl Outlet for SystemOutlet {
    fn carry_out(&mut self, act: &Act) -> Result<(), OutletError> {
        match act {
            Act::Down(what, _) => self.down(what),
            Act::Up(what) => self.up(what, false),
            Act::Stroke(what) => {
                self.down(what)?;
                self.up(what, false)
            }
            // `enigo` scrolls towards the user by positive numbers.
            Act::Wheel(steps) => {
                let steps = -(*steps).clamp(-MOST_STEPS, MOST_STEPS);
                self.enigo.scroll(steps, Axis::Vertical).map_err(|error| failed(&error))
            }
            Act::Move(pixels) => self.go(*pixels, Coordinate::Rel),
            Act::Place(shares) => self.place(*shares),
            _ => Err(no_key()),
        }
    }

    fn release(&mut self, what: &Holdable) -> Result<(), OutletError> {
        match self.up(what, true) {
            // A key that the system's keyboards lack is not down.
            Err(OutletError::Refused(_)) => Ok(()),
            done => done,
        }
    }
}

fn failed(error: &InputError) -> OutletError {
    match error {
        InputError::Simulate(_) => OutletError::Gone(format!("the system takes no keys: {error}")),
        _ => OutletError::Refused(error.to_string()),
    }
}

fn no_key() -> OutletError {
    OutletError::Refused("a keyboard receives keys, clicks and motion only".into())
}
