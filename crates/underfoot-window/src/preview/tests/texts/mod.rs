//! Both modes and their menus in every theme and at every width: no text covers another, none is cut, all can be read.

mod screen;

use super::*;
use crate::preview::sample::step_on;
use crate::preview::{DesignInput, VisitDesk, VisitOrder, VisitSize, VisitState};
use screen::{ScreenShapes, ScreenText, faults};
use underfoot::engine::{Ignored, IgnoredPress};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Width and height of the windows, in points.
const SIZES: [(f32, f32); 4] = [(640.0, 800.0), (1280.0, 800.0), (1920.0, 1080.0), (2560.0, 1440.0)];

/// The shipped layouts on display: every kind of control, grounds, and two apps.
const LAYOUTS: [&str; 4] = ["map", "all_controls", "winter_walk", "surgical"];

/// A desk that records and has a recording that is not saved: the bar has its most buttons then.
struct BusyDesk;

impl VisitDesk for BusyDesk {
    fn state(&mut self) -> VisitState {
        let size = Some(VisitSize { length_s: 72.0, bytes: 3_100_000 });
        VisitState { recording: size, kept: size, is_unsaved: true, ..VisitState::default() }
    }

    fn lead(&mut self, _order: VisitOrder) {}
}

/// A window whose shapes are kept.
struct SeenWindow {
    app: App,
    texts: Vec<ScreenText>,
}

/// A window on one layout in one theme.
struct Gallery {
    window: Harness<'static, SeenWindow>,
    snapshots: triple_buffer::Input<Snapshot>,
    snapshot: Snapshot,
    layout: Arc<Layout>,
    theme: Theme,
    /// Whether all panels of Design have room beside the floor.
    is_wide: bool,
    /// Layout, theme and width, for messages.
    name: String,
    found: Vec<String>,
    _notices: SyncSender<Notice>,
}

impl Gallery {
    fn of(layout_name: &str, text: &'static str, theme: Theme, (width, height): (f32, f32)) -> Self {
        let floor = Arc::new(Floor::default());
        let kinds = Arc::new(Kinds::builtin());
        let layout = Arc::new(parse_layout(text, layout_name, &kinds, &floor.geometry).unwrap().layout);
        let (snapshots, output) = triple_buffer::triple_buffer(&at_rest(&layout));
        let (channels, ProgramChannels { notices, .. }) = channels();
        let sink: Box<dyn FootSink> = Box::new(Feet(Arc::default()));
        let input = PreviewInput {
            scopes: Some(Box::new(Silence)),
            feet: Some(sink),
            visit: Some(Box::new(BusyDesk)),
            choices: LAYOUTS.map(str::to_owned).into(),
            effects: underfoot::schema::Effects::builtin().iter().cloned().collect(),
            design: Some(DesignInput {
                name: layout_name.into(),
                text: text.into(),
                path: None,
                kinds_of: Box::new(move |_| Ok(Arc::clone(&kinds))),
                state: "/dev/null/underfoot".into(),
            }),
            ..PreviewInput::new(floor, Arc::clone(&layout), "simulated floor", output, channels)
        };
        let options = PreviewOptions { theme, ..PreviewOptions::default() };
        let seen = SeenWindow { app: App::new(input, &options), texts: Vec::new() };
        let window = Harness::builder()
            .with_size(vec2(width, height))
            .with_step_dt(1.0 / 60.0)
            .with_theme(if theme.is_dark() { egui::Theme::Dark } else { egui::Theme::Light })
            .with_context_setup(move |ctx| {
                ctx.set_fonts(crate::preview::style::fonts());
                crate::preview::style::apply(ctx, &theme);
            })
            .build_ui_state(
                move |ui, seen: &mut SeenWindow| {
                    seen.app.show(ui);
                    seen.texts = ScreenShapes::of(ui.ctx()).texts(color(theme.canvas));
                },
                seen,
            );
        let name = format!("{layout_name}, {}, {width} wide", theme.name().unwrap());
        let snapshot = at_rest(&layout);
        let (is_wide, found) = (width > 1000.0, Vec::new());
        Self { window, snapshots, snapshot, layout, theme, is_wide, name, found, _notices: notices }
    }

    fn run(&mut self) {
        // A floor without news for a while is a fault of its own.
        self.snapshots.write(self.snapshot.clone());
        self.window.run_steps(6);
    }

    /// Notes what is wrong with the texts on the screen.
    fn look(&mut self, at: &str) {
        self.look_under(at, false);
    }

    /// The same; `panels` tells whether panels cover a part of the floor.
    fn look_under(&mut self, at: &str, panels: bool) {
        self.run();
        let screen = self.window.ctx.content_rect();
        let floor = ["Floor", "Drawing board"].into_iter().find_map(|name| self.window.query_by_label(name));
        let covered = floor.map(|floor| floor.rect()).filter(|_| panels);
        let found = faults(&self.window.state().texts, screen, covered, &self.theme);
        self.found.extend(found.into_iter().map(|fault| format!("{}, {at}: {fault}", self.name)));
    }

    fn click(&mut self, label: &str) {
        let found = self.window.query_all_by_label(label).next();
        found.unwrap_or_else(|| panic!("{}: no {label}", self.name)).click();
        self.run();
    }

    fn pointer(&mut self, at: Pos2, pressed: bool) {
        self.window.event(Event::PointerMoved(at));
        let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
        self.window.event(Event::PointerButton { pos: at, button, pressed, modifiers });
        self.run();
    }

    fn key(&mut self, modifiers: Modifiers, key: Key) {
        self.window.key_press_modifiers(modifiers, key);
        self.run();
    }

    /// Feet on the floor, one of them on a control, and presses that did nothing.
    fn step(&mut self) {
        let mut snapshot = at_rest(&self.layout);
        let layout = Arc::clone(&self.layout);
        let widgets: Vec<_> = layout.widgets.iter().filter(|widget| widget.is_on(0)).collect();
        if let Some(widget) = widgets.last() {
            // A press beside a control, which ends at once.
            let mut before = Snapshot { at: Instant::from_millis(19_700), ..at_rest(&self.layout) };
            step_on(&mut before, 20, widget.area.max + Vec2::splat(0.02), 60.0, Vec2::ZERO);
            self.snapshot = before;
            self.run();
        }
        snapshot.at = Instant::from_millis(20_000);
        for (id, widget) in (1_u8..).zip(widgets.iter().take(2)) {
            let force = 120.0 * f32::from(id);
            step_on(&mut snapshot, id.into(), widget.area.centre(), force, Vec2::new(0.2, 0.1));
        }
        if let Some(state) = snapshot.widgets.first_mut() {
            state.pressed = true;
        }
        for (contact, widget) in (10..).zip(widgets.iter().skip(2).take(2)) {
            snapshot.ignored.push(IgnoredPress {
                at: snapshot.at,
                id: widget.id.clone(),
                contact: ContactId(contact),
                force: Newtons(19.0),
                why: Ignored::TooLight,
            });
        }
        self.snapshot = snapshot;
        self.run();
    }

    /// Try: the first steps, feet, menus, plots and effects.
    fn try_mode(&mut self) {
        self.look("Try with the first steps");
        self.step();
        self.look("Try with feet");
        for menu in ["Layers", "Appearance", "Help"] {
            self.click(menu);
            self.look(&format!("Try, {menu}"));
            self.key(Modifiers::NONE, Key::Escape);
            self.run();
        }
        for bar in ["Plots", "Effects", "Visit"] {
            self.click(bar);
            self.look_under(&format!("Try, {bar}"), true);
            self.click(bar);
        }
    }

    fn design(&mut self, at: &str) {
        self.look_under(at, !self.is_wide);
    }

    /// Selects a control by a click on it; returns the place of the click.
    fn select(&mut self, id: &str) -> Pos2 {
        let at = self.window.get_by_label(&format!("On the floor: {id}")).rect().center();
        self.pointer(at, true);
        self.pointer(at, false);
        at
    }

    /// Design: nothing, one and all selected, menus and text.
    fn design_mode(&mut self) {
        self.key(Modifiers::NONE, Key::F2);
        self.design("Design");
        for menu in ["File", "Show"] {
            self.click(menu);
            self.design(&format!("Design, {menu}"));
            self.key(Modifiers::NONE, Key::Escape);
        }
        self.key(Modifiers::COMMAND, Key::A);
        self.design("Design, all selected");
        self.click("Arrange");
        self.design("Design, Arrange");
        self.key(Modifiers::NONE, Key::Escape);
        let first =
            self.layout.widgets.iter().find(|widget| widget.is_on(0)).map(|widget| widget.id.to_string());
        if let Some(first) = first {
            let at = self.select(&first);
            self.design("Design, one selected");
            self.pointer(at, true);
            self.window.event(Event::PointerMoved(at + vec2(0.0, -30.0)));
            self.design("Design, one moving");
            self.window.event(Event::PointerMoved(at));
            self.pointer(at, false);
        }
        self.click("Text");
        self.look_under("Design, Text", true);
    }
}

/// The faults of all windows in a theme.
fn look_at(theme: Theme) {
    let mut found = Vec::new();
    for size in SIZES {
        for layout in LAYOUTS {
            let mut gallery = Gallery::of(layout, builtin_layout(layout).unwrap(), theme, size);
            gallery.try_mode();
            gallery.design_mode();
            found.append(&mut gallery.found);
        }
    }
    assert!(found.is_empty(), "{} faults:\n{}", found.len(), found.join("\n"));
}

/// Screens of a phone in a hand, in points.
const PHONES: [(f32, f32); 2] = [(390.0, 844.0), (844.0, 390.0)];

#[test]
fn texts_on_a_phone_are_whole_readable_and_clear_of_each_other() {
    let mut found = Vec::new();
    for size in PHONES {
        for layout in ["map", "surgical"] {
            let mut gallery = Gallery::of(layout, builtin_layout(layout).unwrap(), Theme::LIGHT, size);
            gallery.look("Try");
            gallery.step();
            gallery.look("Try with feet");
            for menu in ["Layers", "Appearance", "Help"] {
                gallery.click(menu);
                gallery.look_under(&format!("Try, {menu}"), true);
                gallery.key(Modifiers::NONE, Key::Escape);
            }
            for panel in ["Panel", "Effects", "Plots"] {
                gallery.click(panel);
                gallery.look_under(&format!("Try, {panel}"), true);
            }
            gallery.key(Modifiers::NONE, Key::F2);
            gallery.look_under("Design", true);
            for panel in ["Add", "Panel", "Text"] {
                gallery.click(panel);
                gallery.look_under(&format!("Design, {panel}"), true);
            }
            for menu in ["File", "Show"] {
                gallery.click(menu);
                gallery.look_under(&format!("Design, {menu}"), true);
                gallery.key(Modifiers::NONE, Key::Escape);
            }
            found.append(&mut gallery.found);
        }
    }
    // Lists scroll in the panels, which are as wide as the window; a long title ends with dots.
    found.retain(|fault| !fault.contains("is cut above or below") && !fault.contains("is shortened"));
    assert!(found.is_empty(), "{} faults:\n{}", found.len(), found.join("\n"));
}

/// Controls with every sort of message, in the half of the floor that a narrow window shows beside its panel.
const MESSAGES: &str = r#"Layout(
    version: 4,
    targets: [
        (name: "keys", to: Keyboard), (name: "desk", to: Osc("127.0.0.1:53000")), (name: "synth", to: Midi("underfoot")),
        (name: "stage", to: ArtNet("10.0.0.20", (universe: 0))), (name: "home", to: Mqtt("127.0.0.1:1883")),
        (name: "program", to: Run("notify-send")),
    ],
    regions: [(id: "all", at: (0, 2), size: (6, 4))],
    widgets: [
        (id: "event", kind: "button", at: (0.2, 2.2), size: (0.8, 0.8), label: "Event", send: [
            On(clicked, Key("keys", "Control+Shift+z")), On(pressed, Osc("desk", "/cue/1/start")),
            On(pressed, Note("synth", "C4")), On(pressed, Dmx("stage", (channel: 12))),
            On(clicked, Mqtt("home", "zigbee2mqtt/lamp/set", (payload: "TOGGLE"))), On(clicked, Run("program")),
            On(clicked, Program("synth", 5)), On(clicked, Wheel("keys", (steps: 1))),
        ]),
        (id: "hold", kind: "dead_man", at: (1.4, 2.2), size: (0.9, 0.9), label: "Hold", send: [
            While(pressed, Dmx("stage", (channel: 40, from: 0, to: 180))), While(pressed, Mqtt("home", "floor/blind")),
            While(pressed, Cc("synth", (number: 64))),
        ]),
        (id: "value", kind: "slider", at: (0.2, 3.6), size: (2.2, 0.8), label: "Value", send: [
            Value(Cc("synth", (number: 7, fine: true))), Value(Dmx("stage", (channel: 1, fine: true))),
            Value(Mqtt("home", "floor/dimmer", (from: 0, to: 254))), Value(Bend("synth")), Value(Osc("desk", "/x")),
        ]),
    ],
)"#;

#[test]
fn the_fields_of_controls_with_messages_are_whole() {
    let mut found = Vec::new();
    // High enough for all fields of a control.
    for size in [(640.0, 2600.0), (1280.0, 2600.0)] {
        let mut gallery = Gallery::of("messages", MESSAGES, Theme::LIGHT, size);
        gallery.key(Modifiers::NONE, Key::F2);
        for (id, messages) in [("event", 8), ("hold", 3), ("value", 5)] {
            gallery.select(id);
            gallery.design(&format!("Design, {id} selected"));
            for number in 1..=messages {
                gallery.window.get_by_label(&format!("Content of message {number}"));
            }
        }
        found.append(&mut gallery.found);
    }
    assert!(found.is_empty(), "{} faults:\n{}", found.len(), found.join("\n"));
}

#[test]
fn texts_of_the_light_theme_are_whole_readable_and_clear_of_each_other() {
    look_at(Theme::LIGHT);
}

#[test]
fn texts_of_the_dark_theme_are_whole_readable_and_clear_of_each_other() {
    look_at(Theme::DARK);
}

#[test]
fn texts_of_high_contrast_are_whole_readable_and_clear_of_each_other() {
    look_at(Theme::CONTRAST);
}
