//! Web Mercator: degrees to a world of 1 x 1, whose west is 0 and whose north is 0.

use std::f64::consts::{PI, TAU};

use eframe::egui::{Pos2, Rect, Vec2, vec2};

/// Points of a whole world at zoom 0: a tile of the usual maps.
const TILE: f64 = 256.0;

/// The latitude at which this world ends, in degrees.
pub const LIMIT: f64 = 85.051_128_78;

/// Where degrees of longitude and latitude are in the world.
pub fn project(lon: f64, lat: f64) -> [f64; 2] {
    let lat = lat.clamp(-LIMIT, LIMIT).to_radians();
    [lon / 360.0 + 0.5, 0.5 - (lat.tan() + 1.0 / lat.cos()).ln() / TAU]
}

/// Degrees of longitude and latitude of a place in the world.
pub fn unproject([x, y]: [f64; 2]) -> (f64, f64) {
    ((x - 0.5) * 360.0, ((0.5 - y) * TAU).sinh().atan().to_degrees())
}

/// What part of the world is seen: its middle in degrees, and each level doubles the scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub lon: f64,
    pub lat: f64,
    pub zoom: f64,
}

impl Camera {
    pub const LEAST: f64 = 2.0;
    pub const GREATEST: f64 = 6.0;

    /// Points that the whole world is wide.
    pub fn scale(&self) -> f64 {
        TILE * self.zoom.exp2()
    }

    /// Moves what is seen by so many points: east, and south.
    pub fn pan(&mut self, by: Vec2) {
        let [x, y] = project(self.lon, self.lat);
        let (lon, lat) = unproject([x + f64::from(by.x) / self.scale(), y + f64::from(by.y) / self.scale()]);
        self.lon = (lon + 180.0).rem_euclid(360.0) - 180.0;
        self.lat = lat.clamp(-75.0, 80.0);
    }

    pub fn zoom_by(&mut self, levels: f64) {
        self.zoom = (self.zoom + levels).clamp(Self::LEAST, Self::GREATEST);
    }

    /// Goes a share of the way to `to`, by the shorter way around the world.
    pub fn approach(&mut self, to: &Self, share: f64) {
        let east = (to.lon - self.lon + 180.0).rem_euclid(360.0) - 180.0;
        self.lon = (self.lon + east * share + 180.0).rem_euclid(360.0) - 180.0;
        self.lat += (to.lat - self.lat) * share;
        self.zoom += (to.zoom - self.zoom) * share;
    }

    /// Whether it is as good as at `other`: nobody sees the difference.
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

    /// A place in the world, of which `turn` further worlds lie in the west.
    pub fn point(&self, [x, y]: [f64; 2], turn: f64) -> Pos2 {
        let [dx, dy] = [x + turn - self.middle[0], y - self.middle[1]].map(|way| (way * self.scale) as f32);
        self.rect.center() + vec2(dx, dy)
    }

    /// In which of the worlds side by side something is seen that lies between these two, west and east.
    pub fn turns(&self, [west, east]: [f64; 2]) -> impl Iterator<Item = f64> + use<> {
        let half = f64::from(self.rect.width()) / 2.0 / self.scale;
        let first = (self.middle[0] - half - east).ceil() as i32;
        let last = (self.middle[0] + half - west).floor() as i32;
        (first..=last).map(f64::from)
    }

    /// Whether something is seen that lies between these two, north and south.
    pub fn reaches(&self, [north, south]: [f64; 2]) -> bool {
        let half = f64::from(self.rect.height()) / 2.0 / self.scale;
        self.middle[1] - half <= south && north <= self.middle[1] + half
    }

    /// Kilometres that `points` are in the middle of the screen.
    pub fn kilometres(&self, points: f64) -> f64 {
        /// Around the equator.
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
