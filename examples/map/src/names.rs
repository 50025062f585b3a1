//! Names on the map: as large as people two metres away can read, with a halo, and never over each other.

use std::sync::Arc;

use eframe::egui::{
    Align2, Color32, FontId, Galley, Painter, Pos2, Rect, TextFormat, Vec2, text::LayoutJob, vec2,
};

use crate::mercator::Screen;
use crate::world::World;

const INK: Color32 = Color32::from_rgb(0x24, 0x22, 0x20);
const QUIET: Color32 = Color32::from_rgb(0x6b, 0x5d, 0x4c);
const WATER: Color32 = Color32::from_rgb(0x2f, 0x6c, 0x90);
const HALO: Color32 = Color32::from_rgba_premultiplied(0xe4, 0xe1, 0xd8, 0xe8);

/// Sizes of letters, in hundredths of the window's height. On a screen of 55 inches, which is 685 mm high, the
/// capitals of the smallest ones are 9.5 mm high: 16 minutes of arc from two metres.
const LAKE: f32 = 2.0;
const CITY: f32 = 2.15;
const CAPITAL: f32 = 2.5;
const COUNTRY: [f32; 2] = [2.2, 3.4];

/// Size of the smallest letters in any window, in points.
const SMALLEST: f32 = 13.0;

/// Greatest ratio of a name's width to its country's.
const WIDER: f32 = 1.25;

/// Space around a name that stays free of other names, in points.
const APART: f32 = 3.0;

/// Greatest number of names at once: a full window.
const MOST: usize = 150;

/// Zoom from which lakes have names.
const LAKES_FROM: f64 = 3.6;

/// Occupied rectangles of the screen.
#[derive(Debug, Default)]
pub struct Board {
    taken: Vec<Rect>,
}

impl Board {
    /// A board with these rectangles occupied.
    pub fn new(taken: Vec<Rect>) -> Self {
        Self { taken }
    }

    /// Occupies and returns the first of these places that is inside `room` and free.
    pub fn claim(&mut self, room: Rect, places: impl IntoIterator<Item = Rect>) -> Option<Rect> {
        let place = places.into_iter().find(|place| room.contains_rect(*place) && self.is_free(*place))?;
        self.taken.push(place);
        Some(place)
    }

    /// Whether no occupied rectangle is near this place.
    pub fn is_free(&self, place: Rect) -> bool {
        !self.taken.iter().any(|other| other.intersects(place.expand(APART)))
    }

    /// Occupies a place.
    pub fn take(&mut self, place: Rect) {
        self.taken.push(place);
    }
}

/// Places for a name of this size beside a mark at `at`: to the right, to the left, above, below.
pub fn beside(at: Pos2, size: Vec2, gap: f32) -> [Rect; 4] {
    let place = |anchor: Align2, by: Vec2| anchor.anchor_size(at + by, size);
    [
        place(Align2::LEFT_CENTER, vec2(gap, 0.0)),
        place(Align2::RIGHT_CENTER, vec2(-gap, 0.0)),
        place(Align2::CENTER_BOTTOM, vec2(0.0, -gap)),
        place(Align2::CENTER_TOP, vec2(0.0, gap)),
    ]
}

/// Draws the names of countries, cities and lakes that have room; `covered` are the covered areas of the map.
pub fn draw(painter: &Painter, rect: Rect, screen: &Screen, world: &World, zoom: f64, covered: &[Rect]) {
    // The name of the place in the middle stands beside the map and not below the mark.
    let mut taken = covered.to_vec();
    taken.push(Rect::from_center_size(rect.center(), vec2(26.0, 26.0)));
    let mut names = Names { painter, rect, screen, board: Board::new(taken), left: MOST };
    names.countries(world);
    names.cities(world, zoom);
    if zoom >= LAKES_FROM {
        names.lakes(world, zoom);
    }
}

struct Names<'a> {
    painter: &'a Painter,
    rect: Rect,
    screen: &'a Screen,
    board: Board,
    left: usize,
}

impl Names<'_> {
    /// Names of countries, large ones first, where they fit into them.
    fn countries(&mut self, world: &World) {
        let mut countries: Vec<_> = world.countries.iter().collect();
        countries.sort_by(|one, other| other.area.total_cmp(&one.area));
        for country in countries {
            let [x, y] = country.middle;
            for turn in self.screen.turns([x, x]) {
                let at = self.screen.point([x, y], turn);
                let room = self.screen.point([x + country.width, y], turn).x - at.x;
                let [least, most] = COUNTRY.map(|size| self.points(size));
                let size = (room / 9.0).clamp(least, most).round();
                let galley = self.layout(&country.name, size, QUIET, false);
                if galley.size().x <= room * WIDER {
                    let place = Align2::CENTER_CENTER.anchor_size(at, galley.size());
                    self.write(&galley, QUIET, [place]);
                }
            }
        }
    }

    /// Names of cities, great ones first, each beside its dot.
    fn cities(&mut self, world: &World, zoom: f64) {
        for city in world.cities.iter().take_while(|city| city.from <= zoom + 0.05) {
            let [x, y] = city.at;
            for turn in self.screen.turns([x, x]) {
                let at = self.screen.point([x, y], turn);
                if !self.rect.contains(at) {
                    continue;
                }
                let size = self.points(if city.is_capital { CAPITAL } else { CITY });
                let galley = self.layout(&city.name, size, INK, false);
                let dot = 0.17 * size;
                let places = beside(at, galley.size(), dot + 4.0);
                let mark = Rect::from_center_size(at, Vec2::splat(2.0 * dot));
                // A city is left out if a name would cover its dot.
                if self.board.is_free(mark) && self.write(&galley, INK, places) {
                    self.board.take(mark);
                    self.dot(at, dot, city.is_capital);
                }
            }
        }
    }

    fn lakes(&mut self, world: &World, zoom: f64) {
        for lake in world.lakes.iter().filter(|lake| lake.from + 1.0 <= zoom && !lake.name.is_empty()) {
            let [x, y] = lake.middle;
            for turn in self.screen.turns([x, x]) {
                let galley = self.layout(&lake.name, self.points(LAKE), WATER, true);
                let at = self.screen.point([x, y], turn);
                self.write(&galley, WATER, [Align2::CENTER_CENTER.anchor_size(at, galley.size())]);
            }
        }
    }

    fn points(&self, size: f32) -> f32 {
        (size * self.rect.height() / 100.0).max(SMALLEST)
    }

    fn layout(&self, name: &str, size: f32, color: Color32, italics: bool) -> Arc<Galley> {
        let format = TextFormat {
            font_id: FontId::proportional(size.round()),
            color,
            italics,
            ..TextFormat::default()
        };
        self.painter.layout_job(LayoutJob::single_section(name.to_owned(), format))
    }

    /// Writes a name at the first free of these places; returns whether there was one.
    fn write(
        &mut self,
        galley: &Arc<Galley>,
        color: Color32,
        places: impl IntoIterator<Item = Rect>,
    ) -> bool {
        if self.left == 0 {
            return false;
        }
        let Some(place) = self.board.claim(self.rect, places) else { return false };
        self.left -= 1;
        let wide = (galley.size().y / 12.0).clamp(1.0, 3.0);
        for turn in 0..8_u8 {
            let by = wide * Vec2::angled(std::f32::consts::TAU * f32::from(turn) / 8.0);
            self.painter.galley_with_override_text_color(place.min + by, Arc::clone(galley), HALO);
        }
        self.painter.galley(place.min, Arc::clone(galley), color);
        true
    }

    /// A city's mark: a disc, with a ring for a capital.
    fn dot(&self, at: Pos2, size: f32, is_capital: bool) {
        self.painter.circle_filled(at, size + 1.5, HALO);
        self.painter.circle_filled(at, size, INK);
        if is_capital {
            self.painter.circle_filled(at, 0.45 * size, Color32::WHITE);
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;

    use super::*;

    const ROOM: Rect = Rect { min: Pos2::ZERO, max: Pos2 { x: 400.0, y: 300.0 } };

    /// Places all over the room and beyond it, the same in each run.
    fn places(count: u32) -> impl Iterator<Item = Pos2> {
        let share = |number: u32| f64::from(number.wrapping_mul(2_654_435_761)) / f64::from(u32::MAX);
        (0..count).map(move |number| {
            pos2(440.0 * share(number) as f32 - 20.0, 340.0 * share(number + 7919) as f32 - 20.0)
        })
    }

    #[test]
    fn no_name_lies_over_another_or_beyond_the_window() {
        let mut board = Board::new(vec![Rect::from_min_size(pos2(300.0, 200.0), vec2(100.0, 100.0))]);
        let mut written: Vec<Rect> = Vec::new();
        for at in places(500) {
            let size = vec2(30.0 + at.x.rem_euclid(40.0), 16.0);
            written.extend(board.claim(ROOM, beside(at, size, 6.0)));
        }
        assert!(written.len() > 15, "{}", written.len());
        for (index, name) in written.iter().enumerate() {
            assert!(ROOM.contains_rect(*name), "{name:?}");
            assert!(
                !name.intersects(Rect::from_min_size(pos2(300.0, 200.0), vec2(100.0, 100.0))),
                "{name:?}"
            );
            assert!(written.iter().skip(index + 1).all(|other| !other.intersects(*name)), "{name:?}");
        }
    }

    #[test]
    fn a_name_goes_to_another_side_of_its_dot_before_it_is_left_out() {
        let (at, size) = (pos2(200.0, 150.0), vec2(60.0, 16.0));
        let mut board = Board::default();
        let sides: Vec<Rect> = std::iter::from_fn(|| board.claim(ROOM, beside(at, size, 12.0))).collect();
        assert_eq!(sides, beside(at, size, 12.0));
        // Another name that wants the first one does not get it.
        assert_eq!(board.claim(ROOM, [sides[0].translate(vec2(5.0, 5.0))]), None);
    }
}
