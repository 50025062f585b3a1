//! Pictures of a map, named `level/x/y.png` as servers and makers of tiles name them.

mod readers;
mod source;

use std::collections::HashMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::{Color32, Context, Painter, Rect, TextureHandle, TextureOptions, pos2};

use crate::mercator::{Camera, Screen};
use readers::Readers;
use source::{Key, NoPicture, Source};

/// Number of pictures that are kept: some full screens.
const KEPT: usize = 256;

/// Time after which an unreachable source is tried again.
const AGAIN: Duration = Duration::from_secs(10);

/// The tiles of a folder or a server. Where one is missing, the map's own shapes are visible.
pub struct Tiles {
    source: Arc<Source>,
    readers: Readers,
    tiles: HashMap<Key, Tile>,
    /// The time of the next attempt at an unreachable source, and the reason.
    unreachable: Option<(Instant, String)>,
}

/// The state of a tile.
enum Tile {
    Here(TextureHandle),
    /// It is missing or unreadable, and is not tried again.
    Missing,
}

impl Tiles {
    /// The tiles of a server (`http://127.0.0.1:8080/{z}/{x}/{y}.png`) or a folder.
    ///
    /// # Errors
    /// A message for the user.
    pub fn open(place: &str) -> Result<Self, String> {
        let source = Arc::new(Source::open(place)?);
        let readers = Readers::new(Arc::clone(&source));
        Ok(Self { source, readers, tiles: HashMap::new(), unreachable: None })
    }

    /// The reason why no tiles come at present, if any.
    pub fn trouble(&self) -> Option<&str> {
        self.unreachable.as_ref().map(|(_, why)| why.as_str())
    }

    /// Draws the visible tiles in `rect` that have arrived by `now`, and requests the others.
    pub fn paint(&mut self, context: &Context, painter: &Painter, rect: Rect, camera: &Camera, now: Instant) {
        self.take_answers(context, now);
        let Some(level) = self.source.level(camera.zoom) else { return };
        let screen = Screen::new(rect, camera);
        let seen = seen(rect, camera, level);
        if self.tiles.len() + seen.len() > KEPT {
            self.tiles.retain(|key, _| seen.iter().any(|(wanted, _)| wanted == key));
        }
        if self.unreachable.as_ref().is_none_or(|(until, _)| *until <= now) {
            let absent = seen.iter().map(|(key, _)| *key).filter(|key| !self.tiles.contains_key(key));
            self.readers.want(context, absent);
        }
        let side = f64::from(1_u32 << level).recip();
        for (key, [column, row]) in seen {
            let Some(Tile::Here(tile)) = self.tiles.get(&key) else { continue };
            let corner = |column: i64, row: i64| screen.point([column as f64 * side, row as f64 * side], 0.0);
            let place = Rect::from_min_max(corner(column, row), corner(column + 1, row + 1));
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            painter.image(tile.id(), place, whole, Color32::WHITE);
        }
    }

    /// Stores the tiles that have arrived; reports an unreadable picture on standard error.
    fn take_answers(&mut self, context: &Context, now: Instant) {
        for (key, answer) in self.readers.answers() {
            let [level, x, y] = key;
            let tile = match answer {
                Ok(picture) => {
                    self.unreachable = None;
                    let name = format!("{level}/{x}/{y}");
                    Tile::Here(context.load_texture(name, picture, TextureOptions::LINEAR))
                }
                Err(NoPicture::Missing) => Tile::Missing,
                Err(NoPicture::Broken(why)) => {
                    eprintln!("tile {level}/{x}/{y}: {why}");
                    Tile::Missing
                }
                Err(NoPicture::Unreachable(why)) => {
                    if self.unreachable.is_none() {
                        eprintln!("tile {level}/{x}/{y}: {why}; tried again every {} s", AGAIN.as_secs());
                    }
                    self.unreachable = Some((now + AGAIN, why));
                    continue;
                }
            };
            self.tiles.insert(key, tile);
        }
    }
}

/// The visible tiles of `level` in `rect`, each with the column and row of its place; columns continue beyond the
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
    use std::io::{BufRead, BufReader, Write};
    use std::net::TcpListener;
    use std::{fs, thread};

    use eframe::egui::vec2;

    use super::*;

    fn camera(lon: f64, zoom: f64) -> Camera {
        Camera { lon, lat: 0.0, zoom }
    }

    /// The number of tiles drawn around the middle of the world at zoom 2, once all have been answered, in a window
    /// of this width with `seen` different visible tiles.
    fn shown(tiles: &mut Tiles, (width, seen): (f32, usize), now: Instant) -> usize {
        let (context, rect) = (Context::default(), Rect::from_min_size(pos2(0.0, 0.0), vec2(width, 500.0)));
        let mut shown = 0;
        // A reader answers within some milliseconds; five seconds are enough for a busy machine.
        for _ in 0..500 {
            let output = context.run_ui(Default::default(), |ui| {
                tiles.paint(ui.ctx(), ui.painter(), rect, &camera(0.0, 2.0), now);
            });
            shown = output.shapes.len();
            output.drop_without_applying_deltas();
            if tiles.tiles.len() == seen || tiles.trouble().is_some() {
                break;
            }
            thread::sleep(Duration::from_millis(10));
        }
        shown
    }

    const FOUR: (f32, usize) = (500.0, 4);

    fn png() -> Vec<u8> {
        let mut bytes = std::io::Cursor::new(Vec::new());
        let picture = image::RgbaImage::from_pixel(4, 4, image::Rgba([200, 10, 10, 255]));
        picture.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
        bytes.into_inner()
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
        let path = folder.path().to_str().unwrap();
        assert!(Tiles::open(path).is_err(), "no level");
        for (x, y) in [(1, 1), (1, 2)] {
            let place = folder.path().join(format!("2/{x}"));
            fs::create_dir_all(&place).unwrap();
            fs::write(place.join(format!("{y}.png")), png()).unwrap();
        }
        fs::create_dir(folder.path().join("2/2")).unwrap();
        fs::write(folder.path().join("2/2/1.png"), "no picture").unwrap();
        let mut tiles = Tiles::open(path).unwrap();
        // For a level that the folder lacks, the nearest one is shown.
        assert_eq!(tiles.source.level(5.8), Some(2));
        assert_eq!(shown(&mut tiles, FOUR, Instant::now()), 2, "two of the four tiles around the middle");
        assert_eq!(tiles.tiles.values().filter(|tile| matches!(tile, Tile::Missing)).count(), 2);
    }

    /// A server with the tile 2/1/1 only, for `answers` requests.
    fn server(answers: usize) -> String {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap();
        thread::spawn(move || {
            for stream in listener.incoming().take(answers) {
                let mut stream = stream.unwrap();
                let head: Vec<String> = BufReader::new(&stream)
                    .lines()
                    .map_while(Result::ok)
                    .take_while(|line| !line.is_empty())
                    .collect();
                let body = png();
                let (status, body) = if head[0].starts_with("GET /2/1/1.png ") {
                    ("200 OK", body.as_slice())
                } else {
                    ("404 Not Found", &[][..])
                };
                let length = body.len();
                let head =
                    format!("HTTP/1.1 {status}\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n");
                stream.write_all(&[head.as_bytes(), body].concat()).unwrap();
            }
        });
        format!("http://{address}/{{z}}/{{x}}/{{y}}.png")
    }

    #[test]
    fn a_server_is_asked_for_what_is_seen_and_left_alone_for_a_while_when_it_is_gone() {
        let mut tiles = Tiles::open(&server(4)).unwrap();
        assert_eq!(shown(&mut tiles, FOUR, Instant::now()), 1, "it has one of the four");
        assert!(tiles.trouble().is_none());

        // A window wider than the world shows a part of it twice, and requests each of the eight tiles once.
        let mut tiles = Tiles::open(&server(8)).unwrap();
        assert_eq!(shown(&mut tiles, (1500.0, 8), Instant::now()), 1);
        assert!(tiles.trouble().is_none());

        let gone = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
        let mut tiles = Tiles::open(&format!("http://{gone}/{{z}}/{{x}}/{{y}}.png")).unwrap();
        let now = Instant::now();
        assert_eq!(shown(&mut tiles, FOUR, now), 0);
        assert!(tiles.trouble().is_some() && tiles.tiles.is_empty(), "none of them is given up");
        assert!(Tiles::open("http://127.0.0.1/tiles").is_err(), "an address of every tile");
    }
}
