//! The file that stores the setups of the projectors.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use glam::Vec2;

use super::brightness::Brightness;
use super::pair::{ProjectorPair, ProjectorSetup};
use super::placement::Placement;
use crate::platform;

/// The file's first line.
const HEAD: &str = "underfoot projection 2";

/// The first line of the files of one projector, with its corners alone.
const HEAD_OF_ONE: &str = "underfoot projection 1";

/// Maximum length of the file, in bytes.
const LONGEST: u64 = 4096;

/// The lines of one projector, as far as they are read.
#[derive(Default)]
struct Lines {
    corners: Vec<Vec2>,
    mirrored: bool,
    quarter_turns: u8,
    setup: ProjectorSetup,
}

impl Lines {
    /// Reads one line; the error describes the problem.
    fn read(&mut self, line: &str) -> Result<(), String> {
        let words: Vec<&str> = line.split_whitespace().collect();
        let wrong = || {
            format!(
                "`{line}` is none of `corner X Y`, `mirrored true`, `quarter_turns 1`, `brightness 50`, `screen 1`, \
                 `second on`"
            )
        };
        match words[..] {
            ["corner", x, y] => {
                let number = |word: &str| word.parse::<f32>().map_err(|_| wrong());
                self.corners.push(Vec2::new(number(x)?, number(y)?));
            }
            ["mirrored", word] => self.mirrored = word.parse().map_err(|_| wrong())?,
            ["quarter_turns", word] => {
                self.quarter_turns = word.parse::<u8>().map_err(|_| wrong())? % 4;
            }
            ["brightness", word] => {
                let percent = word.parse().ok().and_then(Brightness::new);
                self.setup.brightness =
                    percent.ok_or_else(|| format!("`{line}`: a brightness is 0 to 100"))?;
            }
            ["screen", word] => self.setup.screen = Some(word.parse().map_err(|_| wrong())?),
            _ => return Err(wrong()),
        }
        Ok(())
    }

    /// The setup of all lines; the error describes the problem. Without a corner, the floor fits the picture.
    fn finish(self) -> Result<ProjectorSetup, String> {
        if self.corners.is_empty() {
            return Ok(self.setup);
        }
        let corners: [Vec2; 4] =
            self.corners.try_into().map_err(|all: Vec<_>| format!("{} corners instead of 4", all.len()))?;
        let placement = Placement { corners, mirrored: self.mirrored, quarter_turns: self.quarter_turns };
        Ok(ProjectorSetup { placement: Some(placement.checked()?), ..self.setup })
    }
}

/// Appends the lines of one projector; writing to a string cannot fail.
fn write_setup(text: &mut String, setup: &ProjectorSetup) {
    if let Some(placement) = setup.placement {
        for corner in placement.corners {
            let _ = writeln!(text, "corner {} {}", corner.x, corner.y);
        }
        let (mirrored, turns) = (placement.mirrored, placement.quarter_turns);
        let _ = writeln!(text, "mirrored {mirrored}\nquarter_turns {turns}");
    }
    let _ = writeln!(text, "brightness {}", setup.brightness.percent());
    if let Some(screen) = setup.screen {
        let _ = writeln!(text, "screen {screen}");
    }
}

/// The text of the file: the first projector, then the second one, whether it is in use or not.
fn write(pair: &ProjectorPair) -> String {
    let mut text = format!("{HEAD}\n");
    let [first, second] = &pair.setups;
    write_setup(&mut text, first);
    text.push_str(if pair.has_second { "second on\n" } else { "second off\n" });
    write_setup(&mut text, second);
    text
}

/// Parses the text of a file; the error describes the problem.
fn read(text: &str) -> Result<ProjectorPair, String> {
    let mut lines = text.lines().map(str::trim);
    match lines.next() {
        Some(HEAD | HEAD_OF_ONE) => {}
        _ => return Err(format!("the first line is not `{HEAD}`")),
    }
    let (mut first, mut second, mut has_second) = (Lines::default(), None, false);
    for line in lines.filter(|line| !line.is_empty()) {
        match line {
            "second on" | "second off" if second.is_none() => {
                second = Some(Lines::default());
                has_second = line == "second on";
            }
            _ => second.as_mut().unwrap_or(&mut first).read(line)?,
        }
    }
    let setups = [first.finish()?, second.unwrap_or_default().finish()?];
    Ok(ProjectorPair { setups, has_second })
}

/// The setups in the file at `path`; `None` if there is no such file.
///
/// # Errors
/// Returns a sentence that describes the problem.
pub(super) fn load(path: &Path) -> Result<Option<ProjectorPair>, String> {
    match platform::read(path, LONGEST) {
        Ok(text) => read(&text).map(Some).map_err(|wrong| format!("{}: {wrong}", path.display())),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(format!("{}: {error}", path.display())),
    }
}

/// Saves the setups to the file at `path`.
///
/// # Errors
/// Returns a sentence that describes the problem.
pub(super) fn save(pair: &ProjectorPair, path: &Path) -> Result<(), String> {
    if let Some(folder) = path.parent() {
        platform::make_folder(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    platform::save(&write(pair), path).map(drop).map_err(|error| error.to_string())
}

/// The default file of the setups: in the folder in which egui stores the data of apps; `None` if the system names no
/// such folder.
pub(super) fn usual_file() -> Option<PathBuf> {
    let of = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let folder = if cfg!(target_os = "windows") {
        of("APPDATA")?
    } else if cfg!(target_os = "macos") {
        of("HOME")?.join("Library/Application Support")
    } else {
        of("XDG_DATA_HOME").or_else(|| Some(of("HOME")?.join(".local/share")))?
    };
    Some(folder.join("underfoot").join("projection.txt"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair() -> ProjectorPair {
        let first = Placement::fit(1.5, 1.6).moved(2, Vec2::new(0.81, 0.93));
        let second = Placement { mirrored: true, quarter_turns: 3, ..Placement::fit(1.5, 1.9) };
        let setup = |placement, percent, screen| ProjectorSetup {
            placement: Some(placement),
            brightness: Brightness::new(percent).unwrap(),
            screen,
        };
        ProjectorPair { setups: [setup(first, 40, None), setup(second, 60, Some(2))], has_second: true }
    }

    #[test]
    fn both_projectors_are_read_as_they_were_saved_and_damage_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/projection.txt");
        assert_eq!(load(&path), Ok(None));
        for pair in [pair(), ProjectorPair { has_second: false, ..pair() }, ProjectorPair::default()] {
            save(&pair, &path).unwrap();
            assert_eq!(load(&path), Ok(Some(pair)));
        }
        let whole = write(&pair());
        let damaged = [
            String::new(),
            format!("{HEAD}\ncorner 0 0"),
            format!("{HEAD}\ncorner 0 x"),
            whole.replace("brightness 60", "brightness 101"),
            whole.replace("screen 2", "screen second"),
            whole.replace("second on", "second on\nsecond on"),
            whole.replace("0.81 0.93", "-1 -1"),
            whole.replace("0.81 0.93", "9 9"),
        ];
        for bad in damaged {
            std::fs::write(&path, &bad).unwrap();
            assert!(load(&path).unwrap_err().contains("projection.txt"), "{bad}");
        }
    }

    #[test]
    fn a_file_of_one_projector_is_read_with_all_of_its_light() {
        let text = "underfoot projection 1\ncorner 0.1 0.2\ncorner 0.9 0.1\ncorner 0.8 0.9\ncorner 0.2 0.8\n\
                    mirrored true\nquarter_turns 1\n";
        let pair = read(text).unwrap();
        let placement = pair.setups[0].placement.unwrap();
        assert_eq!(placement.corners[2], Vec2::new(0.8, 0.9));
        assert_eq!((placement.mirrored, placement.quarter_turns), (true, 1));
        assert_eq!((pair.setups[0].brightness, pair.has_second), (Brightness::FULL, false));
        assert_eq!(pair.setups[1], ProjectorSetup::default());
    }
}
