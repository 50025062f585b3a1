//! Data sheet of an effect: waveform, spectrum, band and figures.

use std::fmt::Write;
use std::sync::Arc;

use glam::Vec2;

use super::Figure;
use super::chart::{ChartAxis, ChartPage, LINE_M, LegendSymbol, MARGIN_M, Plot, THEME, Type};
use underfoot::feel::{Analysis, Band, Effect, Gesture, analyse, audition};
use underfoot::floor::Rect;
use underfoot::layout::Colour;
use underfoot_scene::scene::{Ink, Paint, Scene, Stroke};

/// One rendered effect: its waveform, its spectrum and its figures.
#[derive(Clone, Debug)]
pub struct EffectSheet {
    /// Name of the effect.
    pub name: String,
    /// Purpose of the effect.
    pub about: String,
    /// The rendered effect.
    pub effect: Arc<Effect>,
    /// The foot's gesture.
    pub gesture: Gesture,
    /// Sample rate (Hz).
    pub sample_rate: u32,
    /// Force on the plate (N), sample by sample.
    pub samples: Vec<f32>,
    /// Result of the analysis; `None` for silence.
    pub analysis: Option<Analysis>,
    /// Time in which an effect that plays once decays to a tenth (s); for a click, the decay of the press.
    pub decay_s: Option<f32>,
}

/// Maximum number of points in a waveform drawn from samples, and the largest distance of samples that loses no
/// detail.
const MOST_POINTS: usize = 6000;
const SMOOTH: usize = 8;

/// Number of columns in a longer waveform.
const COLUMNS: usize = 1400;

impl EffectSheet {
    /// Renders `effect` under `gesture`.
    #[must_use]
    pub fn new(name: &str, about: &str, effect: Arc<Effect>, gesture: Gesture, sample_rate: u32) -> Self {
        let samples = audition(&effect, &gesture, sample_rate);
        let analysis = analyse(&samples, sample_rate as f32, effect.manner.band);
        let pressed =
            gesture.release_s.map_or(samples.len(), |release| (release * sample_rate as f32) as usize);
        let press = analysis_of(samples.get(..pressed.min(samples.len())), sample_rate, effect.manner.band);
        let decay_s = press.filter(|_| gesture.press_s.is_some()).map(|press| press.decay_s);
        let (name, about) = (name.to_owned(), about.to_owned());
        Self { name, about, effect, gesture, sample_rate, samples, analysis, decay_s }
    }

    /// Returns the results of the analysis, by name.
    #[must_use]
    pub fn figures(&self) -> Vec<(&'static str, String)> {
        let band = self.effect.manner.band;
        let mut figures = vec![("kind", self.effect.kind.name().to_owned())];
        if let Some(analysis) = &self.analysis {
            figures.extend([
                ("peak", format!("{:.1} N", analysis.peak)),
                ("root mean square", format!("{:.2} N", analysis.rms)),
                ("within its band", format!("{:.1} %", 100.0 * analysis.within)),
                ("loudest at", format!("{:.0} Hz", analysis.loudest_hz)),
                ("mean frequency", format!("{:.0} Hz", analysis.centroid_hz)),
            ]);
            if let Some(decay_s) = self.decay_s {
                figures.push(("falls to a tenth in", format!("{:.0} ms", 1000.0 * decay_s)));
            }
        } else {
            figures.push(("peak", "silence".to_owned()));
        }
        figures.extend([
            ("band", format!("{:.0} to {:.0} Hz", band.low_hz, band.high_hz)),
            ("ducks others by", format!("{:.0} dB", self.effect.manner.duck_db)),
            ("priority", format!("{} of 9", self.effect.manner.priority)),
        ]);
        figures
    }

    /// True if the foot moves in the gesture; only then its motion is drawn.
    fn moves(&self) -> bool {
        self.gesture.moments.iter().any(|moment| moment.speed_m_s > 0.0)
    }

    fn waveform(&self, page: &mut ChartPage, area: Rect) {
        let ms = 1000.0 * self.samples.len() as f32 / self.sample_rate as f32;
        let most = even(1.04 * self.analysis.as_ref().map_or(1.0, |analysis| analysis.peak));
        let x =
            ChartAxis { from: 0.0, to: ms.max(1.0), tick: tick(ms.max(1.0), 12.0), label: "milliseconds" };
        let y = ChartAxis { from: -most, to: most, tick: 0.5 * most, label: "newtons" };
        let plot = Plot::draw(page, area, "At the plate", x, y);
        let zero = Stroke::new(0.0002, Ink::solid(THEME.stance));
        plot.curve(page, [Vec2::new(0.0, 0.0), Vec2::new(ms, 0.0)], zero);
        let at = |number: usize| 1000.0 * number as f32 / self.sample_rate as f32;
        let points: Vec<Vec2> = if self.samples.len() <= MOST_POINTS * SMOOTH {
            // The actuators' frequency range is so low that the waveform is smooth between these samples.
            let every = self.samples.len().div_ceil(MOST_POINTS).max(1);
            self.samples.iter().enumerate().step_by(every).map(|(n, x)| Vec2::new(at(n), *x)).collect()
        } else {
            // For many samples, the minimum and the maximum of each column.
            let per_column = self.samples.len().div_ceil(COLUMNS).max(1);
            let column = |(number, part): (usize, &[f32])| {
                let (low, high) =
                    part.iter().fold((f32::MAX, f32::MIN), |(low, high), x| (low.min(*x), high.max(*x)));
                // Alternately up and down, so that the line does not cross itself at every column.
                let pair = if number % 2 == 0 { [low, high] } else { [high, low] };
                pair.map(|value| Vec2::new(at(number * per_column), value))
            };
            self.samples.chunks(per_column).enumerate().flat_map(column).collect()
        };
        plot.curve(page, points, Stroke::new(0.00028, Ink::solid(THEME.haptic)));
    }

    fn spectrum(&self, page: &mut ChartPage, area: Rect) {
        const LOWEST_DB: f32 = -60.0;
        let x = ChartAxis { from: 0.0, to: 1000.0, tick: 100.0, label: "hertz" };
        let y = ChartAxis { from: LOWEST_DB, to: 0.0, tick: 20.0, label: "decibels" };
        let plot = Plot::draw(page, area, "Spectrum and band", x, y);
        let band = self.effect.manner.band;
        let (low, high) = (plot.at(Vec2::new(band.low_hz, LOWEST_DB)), plot.at(Vec2::new(band.high_hz, 0.0)));
        page.scene.add_box(Rect::new(low, high), 0.0, Paint::fill(Ink::faint(THEME.good, 0.09)));
        for edge in [low.x, high.x] {
            let dashes = Stroke::new(0.0004, Ink::solid(THEME.good)).dashed(0.0014, 0.001);
            page.line(Vec2::new(edge, area.min.y), Vec2::new(edge, area.max.y), dashes);
        }
        let Some(analysis) = &self.analysis else { return };
        // Power per five hertz, with the maximum at 0 dB.
        let width = (5.0 / analysis.bin_hz).ceil().max(1.0) as usize;
        let power: Vec<f32> = analysis.spectrum.chunks(width).map(|bins| bins.iter().sum()).collect();
        let greatest = power.iter().copied().fold(f32::MIN_POSITIVE, f32::max);
        let at = |number: usize| (number as f32 + 0.5) * width as f32 * analysis.bin_hz;
        let points: Vec<Vec2> = power
            .iter()
            .enumerate()
            .map(|(number, power)| Vec2::new(at(number), (10.0 * (power / greatest).log10()).max(LOWEST_DB)))
            .take_while(|point| point.x <= 1000.0)
            .collect();
        let (Some(first), Some(last)) = (points.first(), points.last()) else { return };
        let foot = [Vec2::new(last.x, LOWEST_DB), Vec2::new(first.x, LOWEST_DB)];
        let outline: Vec<Vec2> = points.iter().copied().chain(foot).map(|point| plot.at(point)).collect();
        page.scene.add_path(outline, true, Paint::fill(Ink::faint(THEME.haptic, 0.22)));
        plot.curve(page, points, Stroke::new(0.00035, Ink::solid(THEME.haptic)));
    }

    /// Motion of the foot, each quantity relative to its maximum.
    fn foot(&self, page: &mut ChartPage, area: Rect) {
        page.scene.add_box(area, 0.0, Paint::fill(Ink::solid(THEME.plate)));
        let length = self.samples.len() as f32 / self.sample_rate as f32;
        let course = |of: &dyn Fn(f32) -> f32, greatest: f32| -> Vec<Vec2> {
            (0..=300_u16)
                .map(|step| {
                    let share = f32::from(step) / 300.0;
                    let value = of(length * share) / greatest.max(1e-6);
                    area.min + area.size() * Vec2::new(share, 0.06 + 0.86 * value)
                })
                .collect()
        };
        let speed = |t: f32| self.gesture.at(t).speed_m_s;
        let force = |t: f32| self.gesture.at(t).force.0;
        let value = |t: f32| self.gesture.at(t).value;
        let most = |of: &dyn Fn(f32) -> f32| {
            (0..=300_u16).map(|n| of(length * f32::from(n) / 300.0)).fold(0.0, f32::max)
        };
        let (fastest, hardest) = (most(&speed), most(&force));
        let line = |colour: Colour| Stroke::new(LINE_M, Ink::solid(colour));
        let mut entries = vec![
            (LegendSymbol::Line, THEME.contact, format!("slip speed, up to {fastest:.2} m/s")),
            (LegendSymbol::Line, THEME.warning, format!("force, up to {hardest:.0} N")),
        ];
        page.scene.add_path(course(&speed, fastest), false, Paint::stroke(line(THEME.contact)));
        page.scene.add_path(course(&force, hardest), false, Paint::stroke(line(THEME.warning)));
        if most(&value) > 0.0 {
            entries.push((LegendSymbol::Dashes, THEME.cursor, "value, 0 to 1".to_owned()));
            let dashes = line(THEME.cursor).dashed(0.0011, 0.0011);
            page.scene.add_path(course(&value, 1.0), false, Paint::stroke(dashes));
        }
        let beyond = |t: f32| self.gesture.at(t).beyond_m;
        let farthest = most(&beyond);
        if farthest > 0.0 {
            entries.push((
                LegendSymbol::Line,
                THEME.haptic,
                format!("pushed on, up to {:.0} cm", 100.0 * farthest),
            ));
            page.scene.add_path(course(&beyond, farthest), false, Paint::stroke(line(THEME.haptic)));
        }
        page.scene.add_box(area, 0.0, Paint::stroke(Stroke::new(0.0003, Ink::solid(THEME.stance))));
        let title = Type { strong: true, ..Type::PLAIN };
        let at = Vec2::new(area.min.x, area.max.y + 0.0022);
        let width = page.text(at, title, format_args!("The foot"));
        let named: Vec<(LegendSymbol, Colour, &str)> =
            entries.iter().map(|(sample, colour, name)| (*sample, *colour, name.as_str())).collect();
        page.legend(at + Vec2::X * (width + 0.008), &named);
    }
}

fn analysis_of(samples: Option<&[f32]>, sample_rate: u32, band: Band) -> Option<Analysis> {
    analyse(samples?, sample_rate as f32, band)
}

impl Figure for EffectSheet {
    fn draw(&self) -> Scene {
        let size = Vec2::new(0.26, if self.moves() { 0.188 } else { 0.163 });
        let about = if self.about.is_empty() { "As the renderer makes it" } else { &self.about };
        let mut page = ChartPage::new(size, &self.name, about);
        let (west, east) = (MARGIN_M + 0.012, size.x - MARGIN_M);
        let top = size.y - 0.0275;
        self.waveform(&mut page, Rect::new(Vec2::new(west, top - 0.05), Vec2::new(east, top)));
        if self.moves() {
            let below = top - 0.0735;
            self.foot(&mut page, Rect::new(Vec2::new(west, below - 0.009), Vec2::new(east, below + 0.003)));
        }
        let base = 0.0195;
        self.spectrum(&mut page, Rect::new(Vec2::new(west, base), Vec2::new(0.165, base + 0.045)));
        for (row, (name, value)) in self.figures().into_iter().enumerate() {
            let y = base + 0.0425 - 0.0054 * row as f32;
            page.text(Vec2::new(0.177, y), Type::QUIET, format_args!("{name}"));
            page.text(Vec2::new(0.215, y), Type { strong: true, ..Type::PLAIN }, format_args!("{value}"));
        }
        page.scene
    }

    fn csv(&self) -> String {
        let mut text = String::from("t_s,force_n\n");
        for (number, sample) in self.samples.iter().enumerate() {
            // Writing to a string does not fail.
            let _ = writeln!(text, "{:.6},{sample:.5}", number as f64 / f64::from(self.sample_rate));
        }
        text
    }

    fn summary(&self) -> String {
        let mut text = String::new();
        let _ = writeln!(text, "{}", self.name);
        for (name, value) in self.figures() {
            let _ = writeln!(text, "  {name:<20}{value}");
        }
        text
    }
}

/// Rounds up to the next of 2, 4, 6, 8 or 10 times a power of ten, at least 2.
fn even(value: f32) -> f32 {
    let decade = 10.0_f32.powf(value.max(1.0).log10().floor());
    let share = value / decade;
    let steps = [2.0, 4.0, 6.0, 8.0, 10.0];
    decade * steps.into_iter().find(|step| share <= *step).unwrap_or(10.0)
}

/// Distance of ticks that gives at most `most` of them.
fn tick(range: f32, most: f32) -> f32 {
    let least = range / most;
    let decade = 10.0_f32.powf(least.log10().floor());
    decade * [1.0, 2.0, 5.0, 10.0].into_iter().find(|step| step * decade >= least).unwrap_or(10.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use underfoot::schema::Effects;

    #[test]
    fn a_sheet_says_and_shows_what_was_measured() {
        for name in ["crisp_click", "gravel", "end_stop"] {
            let effects = Effects::builtin();
            let Some(named) = effects.get(name) else { panic!("{name}") };
            let gesture = Gesture::usual(&named.effect);
            let sheet = EffectSheet::new(name, &named.about, Arc::clone(&named.effect), gesture, 8000);
            let summary = sheet.summary();
            for figure in ["peak", "within its band", "loudest at"] {
                assert!(summary.contains(figure), "{summary}");
            }
            assert_eq!(summary.contains("falls to a tenth"), name == "crisp_click", "{summary}");
            let scene = sheet.draw();
            let texts: Vec<&str> = scene.texts().map(|(text, _)| text).collect();
            assert!(texts.contains(&name) && texts.contains(&"newtons") && texts.contains(&"hertz"));
            assert_eq!(texts.contains(&"The foot"), name != "crisp_click");
            assert_eq!(sheet.csv().lines().count(), sheet.samples.len() + 1);
        }
    }

    #[test]
    fn ticks_and_ends_are_round() {
        assert_eq!((even(15.4), even(38.0), even(57.0), even(0.3)), (20.0, 40.0, 60.0, 2.0));
        assert_eq!((tick(300.0, 12.0), tick(2650.0, 12.0), tick(40.0, 6.0)), (50.0, 500.0, 10.0));
    }
}
