//! The drawing of an effect in the window: rendered, analysed and decimated.

use std::sync::Arc;

use eframe::egui::epaint::PathShape;
use eframe::egui::{Align2, CornerRadius, FontId, Painter, Pos2, Rect, Shape, Stroke, pos2};

use underfoot::feel::{Analysis, Effect, Gesture, analyse, audition};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Sample rate that covers the band of the actuators.
const RATE: u32 = 12_000;

/// Columns of the waveform.
const COLUMNS: usize = 280;

/// The spectrum's upper limit, in hertz, and its lower limit, in decibels.
const HERTZ: f32 = 1000.0;
const FLOOR_DB: f32 = -50.0;

/// The data for drawing one effect.
#[derive(Clone, Debug)]
pub(super) struct Trace {
    /// Minimum and maximum of each column, in newtons.
    wave: Vec<(f32, f32)>,
    length_s: f32,
    /// Level at every ten hertz, in decibels.
    spectrum: Vec<f32>,
    pub(super) analysis: Option<Analysis>,
    band: (f32, f32),
}

impl Trace {
    pub(super) fn of(effect: &Arc<Effect>, gesture: &Gesture) -> Self {
        let samples = audition(effect, gesture, RATE);
        let analysis = analyse(&samples, RATE as f32, effect.manner.band);
        let per_column = samples.len().div_ceil(COLUMNS).max(1);
        let wave = samples
            .chunks(per_column)
            .map(|part| part.iter().fold((f32::MAX, f32::MIN), |(low, high), x| (low.min(*x), high.max(*x))))
            .collect();
        let spectrum = analysis.as_ref().map(decibels).unwrap_or_default();
        let band = (effect.manner.band.low_hz, effect.manner.band.high_hz);
        Self { wave, length_s: samples.len() as f32 / RATE as f32, spectrum, analysis, band }
    }

    /// Draws the waveform over time; `played` is the duration played so far, in seconds.
    pub(super) fn wave(&self, painter: &Painter, theme: &Theme, rect: Rect, played: Option<f32>) {
        ground(painter, theme, rect);
        let inner = rect.shrink2(eframe::egui::vec2(8.0, 8.0));
        self.line(painter, theme, inner);
        if let Some(played) = played.filter(|played| *played < self.length_s) {
            let x = inner.left() + played / self.length_s.max(1e-3) * inner.width();
            painter.vline(x, rect.y_range(), Stroke::new(1.5, color(theme.cursor)));
        }
        let corner = |text: String, at: Pos2, anchor: Align2| {
            painter.text(at, anchor, text, FontId::proportional(11.5), color(theme.quiet));
        };
        corner(
            format!("± {:.1} N", self.peak_n()),
            rect.left_bottom() + eframe::egui::vec2(7.0, -5.0),
            Align2::LEFT_BOTTOM,
        );
        let length = format!("{:.0} ms", 1000.0 * self.length_s);
        corner(length, rect.right_bottom() + eframe::egui::vec2(-7.0, -5.0), Align2::RIGHT_BOTTOM);
    }

    /// Draws the waveform alone, for a small picture.
    pub(super) fn thumbnail(&self, painter: &Painter, theme: &Theme, rect: Rect) {
        ground(painter, theme, rect);
        self.line(painter, theme, rect.shrink(3.0));
    }

    /// Its peak and its length, in words.
    pub(super) fn figures(&self) -> String {
        match &self.analysis {
            Some(analysis) => format!("{:.1} N peak, {:.0} ms", analysis.peak, 1000.0 * self.length_s),
            None => "silence".to_owned(),
        }
    }

    /// The upper end of the waveform's scale, in newtons.
    fn peak_n(&self) -> f32 {
        self.analysis.as_ref().map_or(1.0, |analysis| analysis.peak).max(0.5)
    }

    fn line(&self, painter: &Painter, theme: &Theme, inner: Rect) {
        let most = self.peak_n();
        painter.hline(inner.x_range(), inner.center().y, Stroke::new(1.0, color(theme.line)));
        let at = |column: usize, newtons: f32| {
            let share = column as f32 / self.wave.len().max(2) as f32;
            pos2(
                inner.left() + share * inner.width(),
                inner.center().y - 0.5 * newtons / most * inner.height(),
            )
        };
        let points: Vec<Pos2> = self
            .wave
            .iter()
            .enumerate()
            .flat_map(|(column, &(low, high))| {
                let (first, second) = if column % 2 == 0 { (low, high) } else { (high, low) };
                [at(column, first), at(column, second)]
            })
            .collect();
        painter.add(PathShape::line(points, Stroke::new(1.1, color(theme.haptic))));
    }

    /// Draws the spectrum with its permitted band.
    pub(super) fn spectrum(&self, painter: &Painter, theme: &Theme, rect: Rect) {
        ground(painter, theme, rect);
        let inner = Rect::from_min_max(
            rect.min + eframe::egui::vec2(8.0, 8.0),
            rect.max - eframe::egui::vec2(8.0, 17.0),
        );
        let x = |hz: f32| inner.left() + (hz / HERTZ).clamp(0.0, 1.0) * inner.width();
        let y = |db: f32| inner.top() + (db / FLOOR_DB).clamp(0.0, 1.0) * inner.height();
        let band = Rect::from_x_y_ranges(x(self.band.0)..=x(self.band.1), inner.y_range());
        painter.rect_filled(band, CornerRadius::ZERO, color(theme.good).gamma_multiply(0.12));
        for edge in [band.left(), band.right()] {
            let ends = [pos2(edge, inner.top()), pos2(edge, inner.bottom())];
            painter.extend(Shape::dashed_line(&ends, Stroke::new(1.0, color(theme.good)), 4.0, 3.0));
        }
        painter.hline(inner.x_range(), inner.bottom(), Stroke::new(1.0, color(theme.line)));
        for hundreds in [0.0, 250.0, 500.0, 750.0, 1000.0] {
            let anchor = match hundreds {
                0.0 => Align2::LEFT_TOP,
                1000.0 => Align2::RIGHT_TOP,
                _ => Align2::CENTER_TOP,
            };
            let text = if hundreds == 1000.0 { "1000 Hz".to_owned() } else { format!("{hundreds:.0}") };
            let at = pos2(x(hundreds), inner.bottom() + 3.0);
            painter.text(at, anchor, text, FontId::proportional(10.5), color(theme.quiet));
        }
        let points: Vec<Pos2> =
            self.spectrum.iter().enumerate().map(|(n, db)| pos2(x(10.0 * n as f32), y(*db))).collect();
        // Filled column by column: the outline is not a convex shape.
        let fill = color(theme.haptic).gamma_multiply(0.25);
        for pair in points.windows(2) {
            let corners =
                vec![pair[0], pair[1], pos2(pair[1].x, inner.bottom()), pos2(pair[0].x, inner.bottom())];
            painter.add(Shape::convex_polygon(corners, fill, Stroke::NONE));
        }
        painter.add(PathShape::line(points, Stroke::new(1.3, color(theme.haptic))));
    }
}

fn ground(painter: &Painter, theme: &Theme, rect: Rect) {
    painter.rect_filled(rect, CornerRadius::same(6), color(theme.plate));
}

/// Power per ten hertz, with the maximum at 0 dB.
fn decibels(analysis: &Analysis) -> Vec<f32> {
    let per_bin = (10.0 / analysis.bin_hz).max(1.0);
    let power: Vec<f32> = (0..=(HERTZ / 10.0) as usize)
        .map(|n| {
            let from = ((n as f32 - 0.5).max(0.0) * per_bin) as usize;
            let to = (((n as f32 + 0.5) * per_bin) as usize).max(from + 1);
            analysis.spectrum.get(from..to.min(analysis.spectrum.len())).map_or(0.0, |bins| bins.iter().sum())
        })
        .collect();
    let greatest = power.iter().copied().fold(f32::MIN_POSITIVE, f32::max);
    power.into_iter().map(|power| (10.0 * (power / greatest).log10()).max(FLOOR_DB)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use underfoot::schema::Effects;

    #[test]
    fn the_spectrum_peaks_where_the_effect_is_loudest() {
        let effects = Effects::builtin();
        let effect = &effects.get("engine_hum").unwrap().effect;
        let trace = Trace::of(effect, &Gesture::usual(effect));
        let loudest =
            (0..trace.spectrum.len()).max_by(|a, b| trace.spectrum[*a].total_cmp(&trace.spectrum[*b]));
        assert!((7..=8).contains(&loudest.unwrap()), "75 Hz");
        assert_eq!(trace.spectrum[loudest.unwrap()], 0.0);
        assert!(trace.wave.len() <= COLUMNS && trace.length_s > 1.5);
    }
}
