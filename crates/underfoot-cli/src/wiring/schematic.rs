//! The circuit around a board.

use underfoot::floor::Rect;
use underfoot::glam::Vec2;
use underfoot::layout::Colour;
use underfoot_scene::scene::{Anchor, Scene};

use super::pins::{CHANNELS, CONVERTERS, Converter, PicoPin, Pins};
use super::sheet::{COLOURS, Sheet, THEME};

/// Size of the sheet, in metres: A4.
const SIZE: Vec2 = Vec2::new(0.297, 0.21);

/// Height of letters, in metres.
const LETTERS_M: f32 = 0.0035;

/// Pins of an Arduino and a Pico with the supply of the sensors, and with its other side.
const ARDUINO_SUPPLY: &str = "5V";
const PICO_SUPPLY: &str = "3V3 (pin 36)";
const GROUND: &str = "GND";
const PICO_GROUND: &str = "GND (pin 38)";

const SUPPLY_INK: Colour = Colour::rgb(0xb0, 0x20, 0x20);
const GROUND_INK: Colour = Colour::rgb(0x20, 0x20, 0x20);

/// Draws the circuit around a board with these pins and these inputs in use; `None` if its circuit is unknown.
pub(super) fn draw(pins: Pins, inputs: &[String]) -> Option<Scene> {
    let mut sheet = Sheet::new(Rect::from_min_size(Vec2::ZERO, SIZE), LETTERS_M);
    let title = match pins {
        Pins::Channels => return None,
        Pins::Pico => {
            "Pico with four MCP3208 converters: each of their inputs has a sensor and a resistor as on the left"
        }
        Pins::Arduino => "Arduino: one force-sensing resistor and one resistor of 1 kilohm for each input",
        Pins::Amplifiers => "Arduino: one load cell and one HX711 module for each input",
    };
    sheet.sized(Vec2::new(0.012, SIZE.y - 0.012), Anchor::Start, THEME.ink, 1.25, title);
    match pins {
        Pins::Pico => pico(&mut sheet),
        Pins::Arduino => dividers(&mut sheet, inputs),
        Pins::Amplifiers => amplifiers(&mut sheet, inputs),
        Pins::Channels => {}
    }
    Some(sheet.scene)
}

/// A sensor from the rail at `top` to a resistor, which goes to the rail at `bottom`; returns the point between them.
fn divider(sheet: &mut Sheet, x: f32, top: f32, bottom: f32) -> Vec2 {
    let half = 0.0045;
    let at = |y: f32| Vec2::new(x, y);
    let sensor = Rect::from_centre_size(at(top - 0.022), Vec2::new(2.0 * half, 0.02));
    let resistor = Rect::from_centre_size(at(bottom + 0.018), Vec2::new(0.006, 0.018));
    sheet.line(at(top), at(sensor.max.y), THEME.ink);
    sheet.boxed(sensor, Colour::rgb(0xd7, 0xe6, 0xf3));
    sheet.line(sensor.min + 0.002, sensor.max - 0.002, THEME.ink);
    sheet.line(at(sensor.min.y), at(resistor.max.y), THEME.ink);
    sheet.boxed(resistor, Colour::rgb(0xf6, 0xee, 0xda));
    sheet.line(at(resistor.min.y), at(bottom), THEME.ink);
    let middle = at(0.5 * (sensor.min.y + resistor.max.y));
    sheet.dot(middle, THEME.ink);
    sheet.text(at(resistor.centre().y) + Vec2::new(-0.0045, 0.0), Anchor::End, THEME.ink, "1 k");
    middle
}

/// A horizontal rail with its name at the left.
fn rail(sheet: &mut Sheet, from: f32, to: f32, y: f32, ink: Colour, name: &str) {
    sheet.line(Vec2::new(from, y), Vec2::new(to, y), ink);
    sheet.text(Vec2::new(from, y + 0.0035), Anchor::Start, ink, name);
}

/// A divider for each input, side by side.
fn dividers(sheet: &mut Sheet, inputs: &[String]) {
    let (left, right, top, bottom) = (0.02, SIZE.x - 0.02, 0.165, 0.05);
    rail(sheet, left, right, top, SUPPLY_INK, ARDUINO_SUPPLY);
    rail(sheet, left, right, bottom, GROUND_INK, GROUND);
    let step = (right - left - 0.01) / inputs.len().max(1) as f32;
    for (number, input) in inputs.iter().enumerate() {
        let ink = COLOURS[number % COLOURS.len()];
        let x = left + 0.012 + step * (number as f32 + 0.3);
        let middle = divider(sheet, x, top, bottom);
        let end = middle + Vec2::new(0.35 * step, 0.0);
        sheet.line(middle, end, ink);
        sheet.text(end + Vec2::new(0.0015, 0.0), Anchor::Start, ink, input);
    }
    let about = "With no load an input has no voltage, and more with more force. Either side of a sensor may be at 5V.";
    sheet.text(Vec2::new(left, 0.025), Anchor::Start, THEME.quiet, about);
}

/// A module for each input, side by side.
fn amplifiers(sheet: &mut Sheet, inputs: &[String]) {
    let (left, right) = (0.02, SIZE.x - 0.02);
    let step = (right - left) / inputs.len().clamp(4, 16) as f32;
    let width = 0.8 * step;
    for (number, input) in inputs.iter().enumerate() {
        let x = left + step * number as f32;
        let cell = Rect::from_min_size(Vec2::new(x, 0.15), Vec2::new(width, 0.018));
        let module = Rect::from_min_size(Vec2::new(x, 0.085), Vec2::new(width, 0.04));
        sheet.boxed(cell, Colour::rgb(0xd7, 0xe6, 0xf3));
        sheet.text(cell.centre(), Anchor::Middle, THEME.ink, "load cell");
        for (place, name) in ["E+", "E-", "A+", "A-"].into_iter().enumerate() {
            let x = x + width * (place as f32 + 0.5) / 4.0;
            sheet.line(Vec2::new(x, cell.min.y), Vec2::new(x, module.max.y), THEME.ink);
            sheet.sized(Vec2::new(x, module.max.y - 0.003), Anchor::Middle, THEME.ink, 0.7, name);
        }
        sheet.boxed(Rect::new(module.min, module.max - Vec2::new(0.0, 0.006)), THEME.plate);
        sheet.text(module.centre(), Anchor::Middle, THEME.ink, "HX711");
        let ends = [
            ("VCC", ARDUINO_SUPPLY, SUPPLY_INK),
            ("RATE", "VCC", SUPPLY_INK),
            ("DT", input.as_str(), COLOURS[0]),
        ];
        let ends = ends.into_iter().chain([("SCK", "4", COLOURS[2]), (GROUND, GROUND, GROUND_INK)]);
        for (place, (name, to, ink)) in ends.enumerate() {
            let y = module.min.y - 0.007 * (place as f32 + 1.0);
            let from = Vec2::new(x + 0.3 * width, y);
            sheet.text(from - Vec2::new(0.001, 0.0), Anchor::End, THEME.ink, name);
            let end = from + Vec2::new(0.25 * width, 0.0);
            sheet.line(from, end, ink);
            sheet.text(end + Vec2::new(0.001, 0.0), Anchor::Start, ink, to);
        }
    }
    let about = "RATE at VCC gives 80 samples a second. Cells with three wires are half a bridge: two resistors of 1 kilohm, 0.1 %, complete each.";
    sheet.text(Vec2::new(left, 0.025), Anchor::Start, THEME.quiet, about);
}

impl PicoPin {
    fn label(self) -> String {
        format!("GP{} (pin {})", self.gp, self.place)
    }
}

fn pico(sheet: &mut Sheet) {
    let (top, bottom) = (0.165, 0.055);
    rail(sheet, 0.012, 0.07, top, SUPPLY_INK, PICO_SUPPLY);
    rail(sheet, 0.012, 0.07, bottom, GROUND_INK, PICO_GROUND);
    let middle = divider(sheet, 0.035, top, bottom);
    let end = middle + Vec2::new(0.016, 0.0);
    sheet.line(middle, end, THEME.ink);
    sheet.text(end + Vec2::new(0.001, 0.0), Anchor::Start, THEME.ink, "CH0 to CH7");
    for (number, converter) in CONVERTERS.iter().enumerate() {
        let corner = Vec2::new(0.098 + 0.1 * (number % 2) as f32, 0.112 - 0.086 * (number / 2) as f32);
        chip(sheet, corner, converter);
    }
    let about = "A capacitor of 100 nF between VDD and AGND of each converter, close to it. Sensors get 3.3 V, never 5 V.";
    sheet.text(Vec2::new(0.012, 0.014), Anchor::Start, THEME.quiet, about);
}

/// A converter with the numbers of its pins, and the Pico's pins that they go to.
fn chip(sheet: &mut Sheet, corner: Vec2, converter: &Converter) {
    let pitch = 0.0085;
    let body = Rect::from_min_size(corner, Vec2::new(0.034, pitch * CHANNELS as f32));
    sheet.boxed(body, THEME.plate);
    sheet.sized(body.centre() + Vec2::new(0.0, 0.036), Anchor::Middle, THEME.ink, 1.15, converter.name);
    let bus = if converter.clock == CONVERTERS[0].clock { 0 } else { 3 };
    let right = [
        ("VDD", PICO_SUPPLY.to_owned(), SUPPLY_INK),
        ("VREF", PICO_SUPPLY.to_owned(), SUPPLY_INK),
        ("AGND", PICO_GROUND.to_owned(), GROUND_INK),
        ("CLK", converter.clock.label(), COLOURS[bus]),
        ("DOUT", converter.to_pico.label(), COLOURS[bus]),
        ("DIN", converter.from_pico.label(), COLOURS[bus]),
        ("CS", converter.select.label(), COLOURS[1]),
        ("DGND", PICO_GROUND.to_owned(), GROUND_INK),
    ];
    for (place, (name, to, ink)) in right.into_iter().enumerate() {
        let y = body.max.y - pitch * (place as f32 + 0.5);
        let (left, right) = (Vec2::new(body.min.x, y), Vec2::new(body.max.x, y));
        let (own, other) = (format!("{} CH{place}", place + 1), format!("{name} {}", 2 * CHANNELS - place));
        sheet.line(left, left - Vec2::new(0.006, 0.0), THEME.ink);
        sheet.sized(left + Vec2::new(0.0015, 0.0), Anchor::Start, THEME.ink, 0.8, &own);
        sheet.sized(right - Vec2::new(0.0015, 0.0), Anchor::End, THEME.ink, 0.8, &other);
        let end = right + Vec2::new(0.006, 0.0);
        sheet.line(right, end, ink);
        sheet.sized(end + Vec2::new(0.001, 0.0), Anchor::Start, ink, 0.9, &to);
    }
}
