//! Pictures of a map from a folder, named `level/x/y.png` as servers of tiles and the tools that make tiles name them.

use std::collections::HashMap;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::{Path, PathBuf};

use eframe::egui::{Color32, ColorImage, Context, Painter, Rect, TextureHandle, TextureOptions, pos2};
use image::{ImageReader, Limits};

use crate::mercator::{Camera, Screen};

/// Pictures that are kept: some screens full.
const KEPT: usize = 256;

/// Pictures that are read for one frame, so that the map goes on moving meanwhile.
const READ_AT_ONCE: usize = 3;

/// The longest side of a picture, in pixels.
const LONGEST: u32 = 2048;

/// A level of the map, and how far east and south of its north-west corner a tile is.
type Key = [u32; 3];

/// The tiles of a folder. Where one is missing, the map's own shapes are seen.
pub struct Tiles {
    folder: PathBuf,
    /// Levels that the folder has, lowest first.
    levels: Vec<u32>,
    /// `None` for what is missing or can't be read, which is not tried again.
    read: HashMap<Key, Option<TextureHandle>>,
}

impl Tiles {
    /// # Errors
    /// What is wrong with the folder, for people.
    pub fn open(folder: &Path) -> Result<Self, String> {
        let wrong = |why: &str| format!("{}: {why}", folder.display());
        let entries = fs::read_dir(folder).map_err(|error| wrong(&error.to_string()))?;
        let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        // Beyond level 22 a tile is less than a metre.
        let mut levels: Vec<u32> =
            names.filter_map(|name| name.parse().ok()).filter(|level| *level <= 22).collect();
        levels.sort_unstable();
        if levels.is_empty() {
            return Err(wrong("no folder of a level in it, such as `3`; tiles are `level/x/y.png`"));
        }
        Ok(Self { folder: folder.into(), levels, read: HashMap::new() })
    }

    /// Draws the tiles that are seen in `rect`, and reads some of those that are not there yet.
    pub fn paint(&mut self, context: &Context, painter: &Painter, rect: Rect, camera: &Camera) {
        let Some(level) = self.level(camera.zoom) else { return };
        let screen = Screen::new(rect, camera);
        let seen = seen(rect, camera, level);
        if self.read.len() + seen.len() > KEPT {
            self.read.retain(|key, _| seen.iter().any(|(wanted, _)| wanted == key));
        }
        let (side, mut reads) = (f64::from(1_u32 << level).recip(), 0);
        for (key, [column, row]) in seen {
            if !self.read.contains_key(&key) {
                reads += 1;
                if reads > READ_AT_ONCE {
                    context.request_repaint();
                    continue;
                }
                let tile = self.load(context, key);
                self.read.insert(key, tile);
            }
            let Some(Some(tile)) = self.read.get(&key) else { continue };
            let corner = |column: i64, row: i64| screen.point([column as f64 * side, row as f64 * side], 0.0);
            let place = Rect::from_min_max(corner(column, row), corner(column + 1, row + 1));
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            painter.image(tile.id(), place, whole, Color32::WHITE);
        }
    }

    /// The level whose pictures are nearest to their own size.
    fn level(&self, zoom: f64) -> Option<u32> {
        let far = |level: &u32| (f64::from(*level) - zoom).abs();
        self.levels.iter().copied().min_by(|one, other| far(one).total_cmp(&far(other)))
    }

    /// Reads a tile; one that is there and can't be read is told on standard error.
    fn load(&self, context: &Context, [level, x, y]: Key) -> Option<TextureHandle> {
        let path = self.folder.join(format!("{level}/{x}/{y}.png"));
        let file = File::open(&path).ok()?;
        let picture = read(file);
        let picture = picture.inspect_err(|error| eprintln!("{}: {error}", path.display())).ok()?;
        Some(context.load_texture(format!("{level}/{x}/{y}"), picture, TextureOptions::LINEAR))
    }
}

fn read(file: File) -> Result<ColorImage, Box<dyn std::error::Error>> {
    let mut reader = ImageReader::new(BufReader::new(file)).with_guessed_format()?;
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(LONGEST), Some(LONGEST));
    reader.limits(limits);
    let picture = reader.decode()?.into_rgba8();
    let size = [picture.width() as usize, picture.height() as usize];
    Ok(ColorImage::from_rgba_unmultiplied(size, &picture))
}

/// The tiles of `level` that are seen in `rect`, each with the column and row of its place, which goes on beyond the
/// date line.
fn seen(rect: Rect, camera: &Camera, level: u32) -> Vec<(Key, [i64; 2])> {
    let count = i64::from(1_u32 << level);
    let [x, y] = crate::mercator::project(camera.lon, camera.lat);
    let half = [rect.width(), rect.height()].map(|side| f64::from(side) / 2.0 / camera.scale());
    let range = |middle: f64, half: f64| {
        let at = |place: f64| (place * count as f64).floor() as i64;
        at(middle - half)..=at(middle + half)
    };
    let rows = range(y, half[1]).filter(|row| (0..count).contains(row));
    rows.flat_map(|row| {
        // A screen that is wider than the world shows tiles twice.
        range(x, half[0])
            .map(move |column| ([level, column.rem_euclid(count) as u32, row as u32], [column, row]))
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use eframe::egui::vec2;

    use super::*;

    fn camera(lon: f64, zoom: f64) -> Camera {
        Camera { lon, lat: 0.0, zoom }
    }

    #[test]
    fn the_tiles_of_a_screen_go_on_beyond_the_date_line() {
        let rect = Rect::from_min_size(pos2(0.0, 0.0), vec2(512.0, 300.0));
        let found = seen(rect, &camera(179.0, 3.0), 3);
        let columns: Vec<u32> =
            found.iter().filter(|(_, [_, row])| *row == 3).map(|(key, _)| key[1]).collect();
        assert_eq!(columns, [6, 7, 0], "{found:?}");
        assert!(found.iter().all(|([level, x, y], _)| *level == 3 && *x < 8 && *y < 8));
    }

    #[test]
    fn a_folder_of_tiles_is_drawn_and_what_it_lacks_is_tried_once() {
        let folder = tempfile::tempdir().unwrap();
        assert!(Tiles::open(folder.path()).is_err(), "no level");
        for (level, x, y) in [(2, 1, 1), (2, 1, 2)] {
            let place = folder.path().join(format!("{level}/{x}"));
            fs::create_dir_all(&place).unwrap();
            image::RgbaImage::from_pixel(4, 4, image::Rgba([200, 10, 10, 255]))
                .save(place.join(format!("{y}.png")))
                .unwrap();
        }
        fs::create_dir(folder.path().join("2/2")).unwrap();
        fs::write(folder.path().join("2/2/1.png"), "no picture").unwrap();
        let mut tiles = Tiles::open(folder.path()).unwrap();
        // Of a level that the folder hasn't got, the nearest one is shown.
        assert_eq!(tiles.level(5.8), Some(2));
        let (context, rect) = (Context::default(), Rect::from_min_size(pos2(0.0, 0.0), vec2(512.0, 512.0)));
        let mut shown = 0;
        for _ in 0..4 {
            let output = context.run_ui(Default::default(), |ui| {
                tiles.paint(ui.ctx(), ui.painter(), rect, &camera(0.0, 2.0));
            });
            shown = output.shapes.len();
            output.drop_without_applying_deltas();
        }
        assert_eq!(shown, 2, "two of the four tiles around the middle");
        assert_eq!(tiles.read.values().filter(|tile| tile.is_none()).count(), tiles.read.len() - 2);
    }
}
