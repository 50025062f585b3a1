//! Web Mercator: degrees to a world of 1 x 1, with 0 in the west and in the north.

use std::f64::consts::{PI, TAU};

use eframe::egui::{Pos2, Rect, Vec2, vec2};

/// Size of a whole world at zoom 0, in points: a tile of the usual maps.
const TILE: f64 = 256.0;

/// The latitude at which this world ends, in degrees.
pub const LIMIT: f64 = 85.051_128_78;

/// The place in the world of a longitude and a latitude in degrees.
pub fn project(lon: f64, lat: f64) -> [f64; 2] {
    let lat = lat.clamp(-LIMIT, LIMIT).to_radians();
    [lon / 360.0 + 0.5, 0.5 - (lat.tan() + 1.0 / lat.cos()).ln() / TAU]
}

/// The longitude and the latitude in degrees of a place in the world.
pub fn unproject([x, y]: [f64; 2]) -> (f64, f64) {
    ((x - 0.5) * 360.0, ((0.5 - y) * TAU).sinh().atan().to_degrees())
}

/// The visible part of the world: its middle in degrees, and a zoom level; each level doubles the scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub lon: f64,
    pub lat: f64,
    pub zoom: f64,
}

impl Camera {
    pub const LEAST: f64 = 2.0;
    pub const GREATEST: f64 = 6.0;

    /// Width of the whole world, in points.
    pub fn scale(&self) -> f64 {
        TILE * self.zoom.exp2()
    }

    /// Moves the visible part by these points, east and south.
    pub fn pan(&mut self, by: Vec2) {
        let [x, y] = project(self.lon, self.lat);
        let (lon, lat) = unproject([x + f64::from(by.x) / self.scale(), y + f64::from(by.y) / self.scale()]);
        self.lon = (lon + 180.0).rem_euclid(360.0) - 180.0;
        self.lat = lat.clamp(-75.0, 80.0);
    }

    pub fn zoom_by(&mut self, levels: f64) {
        self.zoom = (self.zoom + levels).clamp(Self::LEAST, Self::GREATEST);
    }

    /// Moves by a share of the way to `to`, by the shorter way around the world.
    pub fn approach(&mut self, to: &Self, share: f64) {
        let east = (to.lon - self.lon + 180.0).rem_euclid(360.0) - 180.0;
        self.lon = (self.lon + east * share + 180.0).rem_euclid(360.0) - 180.0;
        self.lat += (to.lat - self.lat) * share;
        self.zoom += (to.zoom - self.zoom) * share;
    }

    /// Whether it is so near to `other` that the difference is invisible.
    pub fn is_at(&self, other: &Self) -> bool {
        let near = |one: f64, other: f64, by: f64| (one - other).abs() < by;
        near(self.lon, other.lon, 0.05)
            && near(self.lat, other.lat, 0.05)
            && near(self.zoom, other.zoom, 0.005)
    }
}

/// From the world to points of the screen and back.
#[derive(Clone, Copy, Debug)]
pub struct Screen {
    rect: Rect,
    middle: [f64; 2],
    scale: f64,
}

impl Screen {
    pub fn new(rect: Rect, camera: &Camera) -> Self {
        Self { rect, middle: project(camera.lon, camera.lat), scale: camera.scale() }
    }

    /// The point of a place in the world, moved by `turn` worlds to the east.
    pub fn point(&self, [x, y]: [f64; 2], turn: f64) -> Pos2 {
        let [dx, dy] = [x + turn - self.middle[0], y - self.middle[1]].map(|way| (way * self.scale) as f32);
        self.rect.center() + vec2(dx, dy)
    }

    /// The numbers of the worlds side by side in which a range from west to east is visible.
    pub fn turns(&self, [west, east]: [f64; 2]) -> impl Iterator<Item = f64> + use<> {
        let half = f64::from(self.rect.width()) / 2.0 / self.scale;
        let first = (self.middle[0] - half - east).ceil() as i32;
        let last = (self.middle[0] + half - west).floor() as i32;
        (first..=last).map(f64::from)
    }

    /// Whether a range from north to south is visible.
    pub fn reaches(&self, [north, south]: [f64; 2]) -> bool {
        let half = f64::from(self.rect.height()) / 2.0 / self.scale;
        self.middle[1] - half <= south && north <= self.middle[1] + half
    }

    /// The length of `points` at the middle of the screen, in kilometres.
    pub fn kilometres(&self, points: f64) -> f64 {
        /// Length of the equator.
        const EQUATOR_KM: f64 = 40_075.0;
        let (_, lat) = unproject(self.middle);
        points / self.scale * EQUATOR_KM * (lat / 180.0 * PI).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_go_there_and_back_and_north_is_up() {
        for (lon, lat) in [(0.0, 0.0), (-120.5, 60.0), (179.0, -75.0)] {
            let (east, north) = unproject(project(lon, lat));
            assert!((east - lon).abs() < 1e-9 && (north - lat).abs() < 1e-9);
        }
        assert!(project(0.0, 10.0)[1] < 0.5);
        assert!(project(0.0, LIMIT)[1].abs() < 1e-9, "the world is square");
    }

    #[test]
    fn a_camera_pans_by_points_over_the_date_line_and_flies_the_short_way() {
        let mut camera = Camera { lon: 170.0, lat: 0.0, zoom: 2.0 };
        camera.pan(vec2(1024.0 * 20.0 / 360.0, 0.0));
        assert!((camera.lon + 170.0).abs() < 1e-4, "{camera:?}");
        camera.approach(&Camera { lon: 170.0, lat: 0.0, zoom: 4.0 }, 0.5);
        assert!((camera.lon.abs() - 180.0).abs() < 1e-4 && camera.zoom == 3.0, "{camera:?}");
    }
}
