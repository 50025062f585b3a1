//! The place of the floor on a projector's picture, as set by the user, and the file that stores it.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use glam::{DVec2, Vec2};

use super::homography::{Homography, is_convex};
use underfoot::floor::Rect;
use underfoot::schema::save_text;
use underfoot_format::file::read_bounded;

/// The place of the floor on a projector's picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::preview) struct Placement {
    /// The corners of the floor on the picture, as shares of its width and height from its upper left corner: first
    /// the upper left one of a picture that is neither turned nor mirrored, then clockwise. They may lie beyond the
    /// picture.
    pub(super) corners: [Vec2; 4],
    /// Whether the picture is projected from behind or over a mirror: east is left.
    pub(super) mirrored: bool,
    /// Number of quarter turns of the picture, clockwise, 0 to 3.
    pub(super) quarter_turns: u8,
}

/// The file's first line.
const HEAD: &str = "underfoot projection 1";

/// Maximum distance of a corner beyond the picture, in picture sizes.
const BEYOND: f32 = 2.0;

/// Maximum length of the file, in bytes.
const LONGEST: u64 = 4096;

impl Placement {
    /// The largest upright floor with the aspect ratio `floor` (width over height) on a picture with the aspect ratio
    /// `picture`, with a margin for the handles of the corners.
    pub(super) fn fit(floor: f32, picture: f32) -> Self {
        let share = 0.46 * Vec2::new((floor / picture).min(1.0), (picture / floor).min(1.0));
        let corners = [Vec2::new(-1.0, -1.0), Vec2::new(1.0, -1.0), Vec2::ONE, Vec2::new(-1.0, 1.0)];
        let corners = corners.map(|corner| Vec2::splat(0.5) + corner * share);
        Self { corners, mirrored: false, quarter_turns: 0 }
    }

    /// The map from floor metres to points of a picture of `size` points.
    ///
    /// `None` for corners that do not form a picture; [`Placement::moved`] prevents them.
    pub(super) fn floor_to_picture(&self, floor: Rect, size: Vec2) -> Option<Homography> {
        let (min, max) = (floor.min.as_dvec2(), floor.max.as_dvec2());
        // North-west, then clockwise, as the corners on the picture.
        let mut from = [DVec2::new(min.x, max.y), max, DVec2::new(max.x, min.y), min];
        if self.mirrored {
            from.swap(0, 1);
            from.swap(2, 3);
        }
        from.rotate_right(usize::from(self.quarter_turns % 4));
        Homography::between(from, self.corners.map(|corner| (corner * size).as_dvec2()))
    }

    /// The placement with the corner numbered `index` at `to`; unchanged if that would fold the picture.
    #[must_use]
    pub(super) fn moved(mut self, index: usize, to: Vec2) -> Self {
        let before = self;
        if let Some(corner) = self.corners.get_mut(index) {
            *corner = to.clamp(Vec2::splat(-BEYOND), Vec2::splat(1.0 + BEYOND));
        }
        if to.is_finite() && is_convex(self.corners.map(|corner| corner.as_dvec2())) { self } else { before }
    }

    /// The text of the file.
    fn write(&self) -> String {
        let mut text = format!("{HEAD}\n");
        for corner in self.corners {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "corner {} {}", corner.x, corner.y);
        }
        let _ = writeln!(text, "mirrored {}\nquarter_turns {}", self.mirrored, self.quarter_turns);
        text
    }

    /// Parses the text of a file; the error describes the problem.
    fn read(text: &str) -> Result<Self, String> {
        let mut lines = text.lines();
        if lines.next().map(str::trim) != Some(HEAD) {
            return Err(format!("the first line is not `{HEAD}`"));
        }
        let mut corners = Vec::new();
        let (mut mirrored, mut quarter_turns) = (false, 0);
        for line in lines.map(str::trim).filter(|line| !line.is_empty()) {
            let words: Vec<&str> = line.split_whitespace().collect();
            let wrong = || format!("`{line}` is none of `corner X Y`, `mirrored true`, `quarter_turns 1`");
            match words[..] {
                ["corner", x, y] => {
                    let number = |word: &str| word.parse::<f32>().map_err(|_| wrong());
                    corners.push(Vec2::new(number(x)?, number(y)?));
                }
                ["mirrored", word] => mirrored = word.parse().map_err(|_| wrong())?,
                ["quarter_turns", word] => quarter_turns = word.parse::<u8>().map_err(|_| wrong())? % 4,
                _ => return Err(wrong()),
            }
        }
        let corners: [Vec2; 4] =
            corners.try_into().map_err(|all: Vec<_>| format!("{} corners instead of 4", all.len()))?;
        let within =
            |corner: &Vec2| (corner.min_element() >= -BEYOND) && (corner.max_element() <= 1.0 + BEYOND);
        if !corners.iter().all(within) || !is_convex(corners.map(|corner| corner.as_dvec2())) {
            return Err(
                "its corners make no picture: they must be in order around, in shares of the picture".into(),
            );
        }
        Ok(Self { corners, mirrored, quarter_turns })
    }

    /// The placement in the file at `path`; `None` if there is no such file.
    ///
    /// # Errors
    /// Returns a sentence that describes the problem.
    pub(super) fn load(path: &Path) -> Result<Option<Self>, String> {
        match read_bounded(path, LONGEST) {
            Ok(text) => Self::read(&text).map(Some).map_err(|wrong| format!("{}: {wrong}", path.display())),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(format!("{}: {error}", path.display())),
        }
    }

    /// Saves the placement to the file at `path`.
    ///
    /// # Errors
    /// Returns a sentence that describes the problem.
    pub(super) fn save(&self, path: &Path) -> Result<(), String> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        }
        save_text(&self.write(), path).map(drop).map_err(|error| error.to_string())
    }
}

/// The default file of the placement: in the folder in which egui stores the data of apps; `None` if the system names
/// no such folder.
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

    fn floor() -> Rect {
        Rect::new(Vec2::ZERO, Vec2::new(1.824, 1.216))
    }

    #[test]
    fn mirrored_and_turned_floors_have_their_corners_where_they_belong() {
        let size = Vec2::new(1920.0, 1080.0);
        let upright = Placement::fit(1.5, 1920.0 / 1080.0);
        let at = |placement: Placement, x: f64, y: f64| {
            placement.floor_to_picture(floor(), size).unwrap().map(DVec2::new(x, y))
        };
        let corner = |index: usize| (upright.corners[index] * size).as_dvec2();
        let (north_west, south_west) = ((0.0, 1.216), (0.0, 0.0));
        let is = |one: DVec2, other: DVec2| assert!(one.distance(other) < 1e-3, "{one} {other}");
        is(at(upright, north_west.0, north_west.1), corner(0));
        is(at(upright, south_west.0, south_west.1), corner(3));
        let mirrored = Placement { mirrored: true, ..upright };
        is(at(mirrored, north_west.0, north_west.1), corner(1));
        for turns in 0..4 {
            let turned = Placement { quarter_turns: turns, ..upright };
            is(at(turned, north_west.0, north_west.1), corner(usize::from(turns)));
        }
    }

    #[test]
    fn a_corner_is_not_dragged_over_the_others() {
        let placement = Placement::fit(1.0, 1.6);
        let moved = placement.moved(0, Vec2::new(0.1, 0.2));
        assert_eq!(moved.corners[0], Vec2::new(0.1, 0.2));
        assert_eq!(moved.moved(0, Vec2::new(0.9, 0.9)), moved, "folded");
        assert_eq!(moved.moved(0, Vec2::NAN), moved);
        assert_eq!(moved.moved(7, Vec2::ZERO), moved);
    }

    #[test]
    fn what_is_saved_is_read_again_and_nonsense_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/projection.txt");
        assert_eq!(Placement::load(&path), Ok(None));
        let placement = Placement {
            mirrored: true,
            quarter_turns: 3,
            ..Placement::fit(1.5, 1.6).moved(2, Vec2::new(0.81, 0.93))
        };
        placement.save(&path).unwrap();
        assert_eq!(Placement::load(&path), Ok(Some(placement)));
        for bad in ["", "underfoot projection 1\ncorner 0 0", "underfoot projection 1\ncorner 0 x"] {
            std::fs::write(&path, bad).unwrap();
            assert!(Placement::load(&path).unwrap_err().contains("projection.txt"), "{bad}");
        }
        let folded = placement.write().replace("0.81 0.93", "-1 -1");
        assert!(Placement::read(&folded).unwrap_err().contains("make no picture"));
    }
}
