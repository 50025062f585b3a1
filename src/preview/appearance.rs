//! How the window and the projection look: colours and size of the text, as people have chosen, and the file that
//! remembers it.

use std::path::PathBuf;

use eframe::egui;
use eframe::egui::containers::menu::{MenuButton, MenuConfig};
use eframe::egui::{Key, Modifiers, PopupCloseBehavior, Ui};

use super::app::App;
use super::style;
use super::style::quiet;
use crate::format::file::read_bounded;
use crate::layout::Colour;
use crate::scene::Theme;
use crate::schema::save_text;

/// The file's first line.
const HEAD: &str = "underfoot window 1";

/// Longest file that is read, in bytes.
const LONGEST: u64 = 4096;

/// Least and greatest size of the text, in tenths of the usual one.
const TENTHS: (u8, u8) = (7, 20);

/// The usual size of the text, in tenths.
const USUAL: u8 = 10;

const BLACK: Colour = Colour::rgb(0, 0, 0);

/// What people choose.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Choice {
    window: Theme,
    /// The theme whose like is thrown onto the floor.
    projected: Theme,
    /// Size of the text, in tenths of the usual one.
    text: u8,
}

/// How everything looks.
pub(super) struct Appearance {
    choice: Choice,
    /// Where it is remembered; `None` to forget it.
    file: Option<PathBuf>,
    /// By how much the window's own size has enlarged everything.
    enlarged: f32,
    /// What egui was told last, in all.
    applied: Option<f32>,
}

impl Appearance {
    /// With the window in the colours of `theme` unless `file` says otherwise; a sentence for the person at the window
    /// if the file can't be used.
    pub(super) fn new(theme: Theme, file: Option<PathBuf>) -> (Self, Option<String>) {
        let usual = Choice { window: theme, projected: Theme::DARK, text: USUAL };
        let read = file.as_deref().map_or(Ok(None), |file| match read_bounded(file, LONGEST) {
            Ok(text) => usual.read(&text).map(Some).map_err(str::to_owned),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error.to_string()),
        });
        let wrong = read.as_ref().err().map(|wrong| {
            let name = file.as_deref().map(|file| file.display().to_string()).unwrap_or_default();
            format!("{name} is not used: {wrong}")
        });
        let choice = read.ok().flatten().unwrap_or(usual);
        (Self { choice, file, enlarged: 1.0, applied: None }, wrong)
    }

    pub(super) fn theme(&self) -> Theme {
        self.choice.window
    }

    /// What is thrown onto the floor. Beyond the floor no light falls, and in a dark theme none on its plates, which
    /// are there already.
    pub(super) fn projected(&self) -> Theme {
        let theme = self.choice.projected;
        if theme.is_dark() {
            Theme { canvas: BLACK, seam: BLACK, plate: BLACK, quiet: Colour::rgb(0xd8, 0xd4, 0xcc), ..theme }
        } else {
            Theme { canvas: BLACK, ..theme }
        }
    }

    /// Large windows get larger letters and panels: what is seen of them is farther away. On top of that comes the size
    /// that people have chosen.
    pub(super) fn enlarge(&mut self, ctx: &egui::Context) {
        let points = ctx.content_rect().size() * ctx.zoom_factor();
        let wanted = (0.85 * (points.x / 1280.0).min(points.y / 800.0)).clamp(1.0, 2.0);
        // By tenths, or text would be laid out anew with each pixel.
        self.enlarged = (10.0 * wanted).round() / 10.0;
        let all = self.enlarged * f32::from(self.choice.text) / f32::from(USUAL);
        if self.applied != Some(all) {
            self.applied = Some(all);
            ctx.set_zoom_factor(all);
        }
    }
}

impl Choice {
    fn text(&self) -> String {
        let name = |theme: &Theme| theme.name().unwrap_or(Theme::NAMED[0].0).to_lowercase();
        let (window, projected) = (name(&self.window), name(&self.projected));
        format!("{HEAD}\nwindow {window}\nprojected {projected}\ntext {}\n", self.text)
    }

    /// Itself with what `text` says.
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
                // What a later version may have to say.
                _ => {}
            }
        }
        Ok(self)
    }
}

impl App {
    /// A menu of colours and sizes; it stays open while they are tried.
    pub(super) fn appearance_menu(&mut self, ui: &mut Ui) {
        let before = self.appearance.choice;
        let mut choice = before;
        let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
        MenuButton::new("Look").config(config).ui(ui, |ui| {
            ui.set_width(190.0);
            for (part, theme) in [("Window", &mut choice.window), ("Projected", &mut choice.projected)] {
                ui.label(quiet(&self.theme, part));
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
                &self.theme,
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
        self.choose(ui.ctx(), choice);
    }

    /// Ctrl with plus, minus and zero sizes the text, also while something is typed.
    pub(super) fn handle_text_keys(&mut self, ui: &Ui) {
        let mut choice = self.appearance.choice;
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
        self.choose(ui.ctx(), choice);
    }

    fn choose(&mut self, ctx: &egui::Context, choice: Choice) {
        if choice == self.appearance.choice {
            return;
        }
        self.appearance.choice = choice;
        self.theme = choice.window;
        style::apply(ctx, &self.theme);
        ctx.request_repaint();
        let kept = self.appearance.file.as_deref().map(|file| {
            file.parent().map_or(Ok(()), std::fs::create_dir_all).map_err(|error| error.to_string())?;
            save_text(&choice.text(), file).map(drop).map_err(|error| error.to_string())
        });
        if let Some(Err(wrong)) = kept {
            self.messages.note(format!("How the window looks is not remembered: {wrong}"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_chosen_is_read_again_and_nonsense_is_told() {
        let usual = Choice { window: Theme::LIGHT, projected: Theme::DARK, text: USUAL };
        let chosen = Choice { window: Theme::CONTRAST, projected: Theme::LIGHT, text: 14 };
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

    #[test]
    fn dark_themes_throw_no_light_on_bare_plates() {
        let (mut appearance, _) = Appearance::new(Theme::LIGHT, None);
        for (name, theme) in Theme::NAMED {
            appearance.choice.projected = theme;
            let projected = appearance.projected();
            assert_eq!(projected.canvas, BLACK, "{name}");
            assert_eq!(projected.plate == BLACK, theme.is_dark(), "{name}");
        }
    }
}
