//! Appearance of the window and the projection: colours and text size from the user's choice, and the file that
//! stores it.

use std::path::PathBuf;

use eframe::egui;
use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{Key, Modifiers, PopupCloseBehavior, Ui};

use super::handheld::{fit_targets, menu_content};
use super::icons::{self, Icon};
use super::messages::WindowMessages;
use super::style;
use super::style::quiet;
use crate::platform;
use underfoot_scene::scene::Theme;

/// The file's first line.
const HEAD: &str = "underfoot window 1";

/// Maximum length of the file, in bytes.
const LONGEST: u64 = 4096;

/// Minimum and maximum size of the text, in tenths of the usual size.
const TENTHS: (u8, u8) = (7, 20);

/// The usual size of the text, in tenths.
const USUAL: u8 = 10;

/// The user's choice.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Choice {
    window: Theme,
    /// The theme from which that of the projection is derived.
    projected: Theme,
    /// Size of the text, in tenths of the usual size.
    text: u8,
    /// Whether the floor shows the first steps of a new user.
    has_steps: bool,
}

/// The appearance of the window and the projection.
pub(crate) struct Appearance {
    choice: Choice,
    /// The file that stores the choice; `None` to store nothing.
    file: Option<PathBuf>,
    /// Enlargement due to the size of the window.
    enlarged: f32,
    /// The zoom factor that egui received last.
    applied: Option<f32>,
    /// Whether buttons have the size of fingers.
    for_fingers: bool,
}

impl Appearance {
    /// Uses the colours of `theme` for the window unless `file` holds others; also returns a message for the user if
    /// the file cannot be used.
    pub(crate) fn new(theme: Theme, file: Option<PathBuf>) -> (Self, Option<String>) {
        let usual = Choice { window: theme, projected: Theme::DARK, text: USUAL, has_steps: true };
        let read = file.as_deref().map_or(Ok(None), |file| match platform::read(file, LONGEST) {
            Ok(text) => usual.read(&text).map(Some).map_err(str::to_owned),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error.to_string()),
        });
        let wrong = read.as_ref().err().map(|wrong| {
            let name = file.as_deref().map(|file| file.display().to_string()).unwrap_or_default();
            format!("{name} is not used: {wrong}")
        });
        let choice = read.ok().flatten().unwrap_or(usual);
        (Self { choice, file, enlarged: 1.0, applied: None, for_fingers: false }, wrong)
    }

    /// Whether the floor shows the first steps of a new user.
    pub(super) fn has_steps(&self) -> bool {
        self.choice.has_steps
    }

    /// Shows or hides the first steps, from now on.
    pub(super) fn show_steps(&mut self, ctx: &egui::Context, has_steps: bool, messages: &mut WindowMessages) {
        self.choose(ctx, Choice { has_steps, ..self.choice }, messages);
    }

    pub(crate) fn theme(&self) -> Theme {
        self.choice.window
    }

    /// The theme of the projection, which throws no light beyond the floor.
    pub(super) fn projected(&self) -> Theme {
        self.choice.projected.projected()
    }

    /// Enlarges letters and panels in large windows, because people see those from farther away. The user's text size
    /// multiplies the result.
    pub(crate) fn enlarge(&mut self, ctx: &egui::Context) {
        let points = ctx.content_rect().size() * ctx.zoom_factor();
        let wanted = (0.85 * (points.x / 1280.0).min(points.y / 800.0)).clamp(1.0, 2.0);
        // Round to tenths: otherwise each pixel of a resize would lay out the text again.
        self.enlarged = (10.0 * wanted).round() / 10.0;
        let all = self.enlarged * f32::from(self.choice.text) / f32::from(USUAL);
        if self.applied != Some(all) {
            self.applied = Some(all);
            ctx.set_zoom_factor(all);
        }
    }
}

impl Appearance {
    /// Gives buttons the size of fingers, or that of a mouse pointer again.
    pub(super) fn fit(&mut self, ctx: &egui::Context, for_fingers: bool) {
        if self.for_fingers != for_fingers {
            self.for_fingers = for_fingers;
            fit_targets(ctx, for_fingers);
        }
    }
}

impl Choice {
    fn text(&self) -> String {
        let name = |theme: &Theme| theme.name().unwrap_or(Theme::NAMED[0].0).to_lowercase();
        let (window, projected) = (name(&self.window), name(&self.projected));
        let steps = if self.has_steps { "on" } else { "off" };
        format!("{HEAD}\nwindow {window}\nprojected {projected}\ntext {}\nfirst_steps {steps}\n", self.text)
    }

    /// This choice with the settings in `text`.
    fn read(mut self, text: &str) -> Result<Self, &'static str> {
        let mut lines = text.lines();
        if lines.next() != Some(HEAD) {
            return Err("it is not a file of how the window looks");
        }
        let named = |name: &str| {
            let is_it = |(known, _): &&(&str, Theme)| known.eq_ignore_ascii_case(name);
            Theme::NAMED
                .iter()
                .find(is_it)
                .map(|(_, theme)| *theme)
                .ok_or("it names colours that do not exist")
        };
        for line in lines {
            match line.split_once(' ') {
                Some(("window", name)) => self.window = named(name)?,
                Some(("projected", name)) => self.projected = named(name)?,
                Some(("text", tenths)) => {
                    let tenths: u8 = tenths.parse().map_err(|_| "the size of the text is no number")?;
                    self.text = tenths.clamp(TENTHS.0, TENTHS.1);
                }
                Some(("first_steps", on)) => self.has_steps = on != "off",
                // Settings of a later version.
                _ => {}
            }
        }
        Ok(self)
    }
}

impl Appearance {
    /// A menu of colours and sizes; it stays open after a click. A compact one has a button with an icon alone.
    pub(super) fn menu(&mut self, ui: &mut Ui, is_compact: bool, messages: &mut WindowMessages) {
        let mut choice = self.choice;
        let window = self.theme();
        let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
        let button = MenuButton::new(icons::short(Icon::SunMoon, "Appearance", is_compact)).config(config);
        let (button, _) = button.ui(ui, |ui| {
            ui.set_width(190.0);
            menu_content(ui, |ui| {
                for (part, theme) in [("Window", &mut choice.window), ("Projected", &mut choice.projected)] {
                    ui.label(quiet(&window, part));
                    for (name, one) in Theme::NAMED {
                        let radio = ui.radio_value(theme, one, name);
                        radio.widget_info(|| {
                            let spoken = format!("{part}: {name}");
                            egui::WidgetInfo::selected(
                                egui::accesskit::Role::RadioButton,
                                true,
                                *theme == one,
                                spoken,
                            )
                        });
                    }
                    ui.separator();
                }
                ui.label(quiet(
                    &window,
                    format!("Text {} %: Ctrl +, Ctrl -, Ctrl 0", 10 * u32::from(choice.text)),
                ));
                ui.horizontal(|ui| {
                    for (name, text) in
                        [("Smaller", choice.text - 1), ("Usual", USUAL), ("Larger", choice.text + 1)]
                    {
                        let can = (TENTHS.0..=TENTHS.1).contains(&text) && text != choice.text;
                        if ui.add_enabled(can, egui::Button::new(name)).clicked() {
                            choice.text = text;
                        }
                    }
                });
            });
        });
        icons::named(button, "Appearance");
        self.choose(ui.ctx(), choice, messages);
    }

    /// Ctrl with plus, minus and zero sizes the text, during typing too.
    pub(super) fn handle_keys(&mut self, ui: &Ui, messages: &mut WindowMessages) {
        let mut choice = self.choice;
        let count = |key: Key| {
            let plain = ui.input_mut(|i| i.count_and_consume_key(Modifiers::COMMAND, key));
            u8::try_from(plain).unwrap_or(u8::MAX)
        };
        let larger = count(Key::Plus).saturating_add(count(Key::Equals));
        let smaller = count(Key::Minus);
        choice.text = choice.text.saturating_add(larger).saturating_sub(smaller).clamp(TENTHS.0, TENTHS.1);
        if count(Key::Num0) > 0 {
            choice.text = USUAL;
        }
        self.choose(ui.ctx(), choice, messages);
    }

    fn choose(&mut self, ctx: &egui::Context, choice: Choice, messages: &mut WindowMessages) {
        if choice == self.choice {
            return;
        }
        self.choice = choice;
        style::apply(ctx, &choice.window);
        if self.for_fingers {
            fit_targets(ctx, true);
        }
        ctx.request_repaint();
        let kept = self.file.as_deref().map(|file| {
            file.parent().map_or(Ok(()), platform::make_folder).map_err(|error| error.to_string())?;
            platform::save(&choice.text(), file).map(drop).map_err(|error| error.to_string())
        });
        if let Some(Err(wrong)) = kept {
            messages.note(format!("How the window looks is not remembered: {wrong}"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_chosen_is_read_again_and_nonsense_is_told() {
        let usual = Choice { window: Theme::LIGHT, projected: Theme::DARK, text: USUAL, has_steps: true };
        let chosen = Choice { window: Theme::CONTRAST, projected: Theme::LIGHT, text: 14, has_steps: false };
        assert_eq!(usual.read(&chosen.text()), Ok(chosen));
        assert_eq!(
            usual.read(&format!("{HEAD}\ntext 250\nsound 3\n")),
            Ok(Choice { text: TENTHS.1, ..usual })
        );
        assert!(usual.read("").is_err() && usual.read(&format!("{HEAD}\nwindow green\n")).is_err());
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("window");
        let (appearance, wrong) = Appearance::new(Theme::LIGHT, Some(file.clone()));
        assert_eq!((appearance.choice, wrong), (usual, None), "there is no file yet");
        std::fs::write(&file, "something else").unwrap();
        let (appearance, wrong) = Appearance::new(Theme::DARK, Some(file));
        assert_eq!(appearance.theme(), Theme::DARK);
        assert!(wrong.is_some_and(|wrong| wrong.contains("is not used")));
    }
}
