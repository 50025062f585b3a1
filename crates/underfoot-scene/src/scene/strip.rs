//! The strips above and below the floor: title, time, link state, and a legend of the marks.

use glam::Vec2;

use super::mark::{Anchor, Ink, Lettering, Paint, Stroke};
use super::widths::CAP_HEIGHT;
use super::{Scene, View, feet, ground};
use underfoot::floor::Rect;
use underfoot::sense::Quality;
use underfoot::wire::LinkState;

/// Height of the strip above the floor, in metres.
pub(super) const HEADER_M: f32 = 0.195;

/// Height of the strip below the floor, in metres.
pub(super) const LEGEND_M: f32 = 0.085;

/// Draws title and measures on the left, time and link on the right.
pub(super) fn header(scene: &mut Scene, view: &View<'_>, strip: Rect) {
    let theme = view.theme;
    let time_m = if view.show.contacts { 0.42 } else { 0.0 };
    let top = strip.max.y - 0.095;
    let mut lettering =
        Lettering::new(Vec2::new(strip.min.x, top), Anchor::Start, 0.066, Ink::solid(theme.ink)).strong();
    scene.add_line_of(lettering, &view.layout.title, strip.size().x - time_m, 0.036);
    let size = view.geometry.bounds().size();
    let (columns, rows) = (view.geometry.columns(), view.geometry.rows());
    lettering = Lettering {
        at: Vec2::new(strip.min.x, top - 0.052),
        size_m: 0.030,
        strong: false,
        ink: Ink::solid(theme.quiet),
        ..lettering
    };
    scene.add_text(lettering, format_args!("{columns} × {rows} tiles · {:.2} × {:.2} m", size.x, size.y));
    if view.show.contacts {
        let cause = view.snapshot.link_cause.as_ref();
        let cause =
            cause.map(|cause| format!("{}: {}", view.snapshot.link.name(), cause.name().replace('_', " ")));
        let (state, colour) = match view.snapshot.link {
            LinkState::Waiting => ("no packets yet", theme.warning),
            // Every new floor has nominal parts; that is not a fault.
            LinkState::Live if view.snapshot.health.uncalibrated > 0 && ground::none_live(view) => {
                ("live, not calibrated", theme.quiet)
            }
            LinkState::Live if ground::none_live(view) => ("live, all sensors degraded", theme.warning),
            LinkState::Live => ("live", theme.good),
            LinkState::Partial => ("some boards are silent", theme.warning),
            LinkState::Lost => ("no sensor packets", theme.fault),
        };
        let (state, colour) = cause.as_deref().map_or((state, colour), |cause| (cause, theme.fault));
        lettering = Lettering {
            at: Vec2::new(strip.max.x, top - 0.052),
            anchor: Anchor::End,
            ink: Ink::solid(colour),
            ..lettering
        };
        scene.add_text(lettering, format_args!("{state}"));
        lettering = Lettering {
            at: Vec2::new(strip.max.x, top),
            size_m: 0.042,
            ink: Ink::solid(theme.ink),
            ..lettering
        };
        scene.add_text(lettering, format_args!("{:.3} s", view.snapshot.at.secs()));
    }
}

/// Draws one line of samples of the marks on this drawing, with their names.
pub(super) fn legend(scene: &mut Scene, view: &View<'_>, strip: Rect) {
    let theme = view.theme;
    let has = |wanted: Quality| {
        let is_marked = wanted != Quality::Degraded || !ground::none_live(view);
        view.snapshot.link != LinkState::Waiting
            && is_marked
            && view.snapshot.tiles.iter().any(|tile| tile.quality.contains(&wanted))
    };
    let middle = strip.centre().y - 0.004;
    let mut pen = Pen { x: strip.min.x, y: middle, end: strip.max.x, view };
    if view.show.contacts {
        pen.entry(scene, "cursor", 0.022, |scene, at| {
            let paint = Paint::fill(Ink::faint(theme.cursor, 0.22));
            scene.add_circle(at, 0.007, paint);
            feet::cursor_ring(scene, view, at, 0.002);
        });
        pen.entry(scene, "contact, area = force", 0.016, |scene, at| {
            let edge = Stroke::new(0.003, Ink::faint(theme.contact, 0.9));
            scene.add_circle(at, 0.014, Paint::fill(Ink::faint(theme.contact, 0.22)).with_stroke(edge));
        });
    }
    if view.show.sensors {
        pen.entry(scene, "sensor force", 0.010, |scene, at| {
            scene.add_circle(at, 0.009, Paint::fill(Ink::faint(theme.contact, 0.62)));
        });
    }
    if view.levels.iter().any(|level| *level >= 1e-3) {
        pen.entry(scene, "actuator", 0.024, |scene, at| {
            let bar = Rect::from_centre_size(at, Vec2::new(0.044, 0.009));
            scene.add_box(bar, 0.004, Paint::fill(Ink::solid(theme.haptic)));
        });
    }
    let cracks: usize = view.snapshot.grounds.iter().map(|ground| ground.cracks.len()).sum();
    if cracks > 0 {
        let evicted: u64 = view.snapshot.grounds.iter().map(|ground| ground.counters.evicted).sum();
        let early = if evicted > 0 { format!(", {evicted} healed early") } else { String::new() };
        pen.entry(scene, &format!("{cracks} pieces of crack{early}"), 0.012, |scene, at| {
            let stroke = Paint::stroke(Stroke::new(0.003, Ink::solid(theme.quiet)));
            let zigzag = [(-0.012, -0.006), (-0.003, 0.006), (0.003, -0.004), (0.012, 0.007)];
            scene.add_path(zigzag.map(|(x, y)| at + Vec2::new(x, y)), false, stroke);
        });
    }
    for (quality, name) in
        [(Quality::Degraded, "degraded"), (Quality::Stale, "silent"), (Quality::Faulty, "faulty")]
    {
        if has(quality) {
            pen.entry(scene, name, 0.013, |scene, at| ground::mark_quality(scene, view, at, quality));
        }
    }
}

/// Draws the legend's entries one after the other, while there is room.
struct Pen<'a> {
    x: f32,
    y: f32,
    end: f32,
    view: &'a View<'a>,
}

impl Pen<'_> {
    fn entry(&mut self, scene: &mut Scene, name: &str, radius: f32, sample: impl FnOnce(&mut Scene, Vec2)) {
        let size_m = 0.026;
        let width = super::widths::width(name) * size_m;
        let text_x = self.x + 2.0 * radius + 0.014;
        if text_x + width > self.end {
            return;
        }
        sample(scene, Vec2::new(self.x + radius, self.y));
        let lettering = Lettering::new(
            Vec2::new(text_x, self.y - 0.5 * CAP_HEIGHT * size_m),
            Anchor::Start,
            size_m,
            Ink::solid(self.view.theme.quiet),
        );
        self.x = text_x + scene.add_text(lettering, format_args!("{name}")) + 0.045;
    }
}
