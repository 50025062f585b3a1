//! The status bar at the window's lower edge: source, rates and losses.

use eframe::egui;
use eframe::egui::accesskit::Role;
use eframe::egui::{Align, Label, Layout, Margin, Panel, RichText, Ui, WidgetInfo, vec2};

use super::feed::{ServerLink, ServerState};
use super::panel::grouped;
use super::rate::RateMeter;
use super::shown::ShownFloor;
use super::style::panel_frame;
use underfoot::engine::Snapshot;
use underfoot::layout::Colour;
use underfoot::sink::{LatencyMeter, LatencyStages};
use underfoot_scene::egui_painter::color;
use underfoot_scene::scene::Theme;

/// Interval at which latencies are summarised, in seconds: slow enough to read.
const EVERY_S: f64 = 0.5;

/// Size of the letters, in points.
const LETTERS: f32 = 12.0;

/// Minimum width of the source, in points.
const SOURCE: f32 = 90.0;

/// One figure of the bar: a fixed width, so that nothing moves when its text gets longer.
struct Figure {
    /// Width, in points.
    width: f32,
    text: String,
    colour: Colour,
    meaning: String,
}

/// Latency from the foot to the result, as far as it is known.
#[derive(Default)]
struct Latency {
    stages: Option<LatencyStages>,
    summed_s: Option<f64>,
    /// Latency of the event, of the samples for the device, and of the sound as the device reports it; medians in
    /// milliseconds.
    event_ms: Option<f64>,
    felt_ms: Option<f64>,
    sounding_ms: Option<f64>,
}

impl Latency {
    fn new(stages: Option<LatencyStages>) -> Self {
        Self { stages, ..Self::default() }
    }

    /// Summarises the measurements at the interval of `EVERY_S`.
    fn update(&mut self, now_s: f64) {
        let Some(stages) = &self.stages else { return };
        if self.summed_s.is_some_and(|at| (0.0..EVERY_S).contains(&(now_s - at))) {
            return;
        }
        self.summed_s = Some(now_s);
        let median = |meter: &LatencyMeter| meter.summary().map(|it| it.median.as_secs_f64() * 1e3);
        self.event_ms = median(&stages.link).zip(median(&stages.engine)).map(|(link, engine)| link + engine);
        self.felt_ms = median(&stages.whole);
        self.sounding_ms = median(&stages.sounding);
    }

    /// A short text; `plays` if a device plays the output.
    fn text(&self, plays: bool) -> String {
        let ms = |ms: Option<f64>| ms.map_or_else(|| "–".to_owned(), |ms| format!("{ms:.1} ms"));
        let felt = self.sounding_ms.or(self.felt_ms).filter(|_| plays);
        format!("event {}, felt {}", ms(self.event_ms), ms(felt))
    }

    fn meaning(&self, plays: bool) -> String {
        let known = match (self.event_ms, self.felt_ms.filter(|_| plays), self.sounding_ms.filter(|_| plays))
        {
            (None, ..) => "nothing was felt yet, or nothing is rendered",
            (_, _, Some(_)) => "felt: until it sounds, by the device’s own account",
            (_, Some(_), None) => {
                "felt: until its first sample goes to the device, which does not say when it sounds"
            }
            (Some(_), None, None) => "no device plays it",
        };
        format!("From the packet’s arrival; medians since the window opened. {known}")
    }
}

/// The rates and latencies of the status bar.
pub(super) struct StatusBar {
    /// The number of frames of this window so far.
    drawn: u64,
    window_frames: RateMeter,
    frames: RateMeter,
    packets: RateMeter,
    latency: Latency,
}

impl StatusBar {
    pub(super) fn new(latency: Option<LatencyStages>) -> Self {
        Self {
            drawn: 0,
            window_frames: RateMeter::default(),
            frames: RateMeter::default(),
            packets: RateMeter::default(),
            latency: Latency::new(latency),
        }
    }

    /// Counts one frame of the window, which shows `snapshot`.
    pub(super) fn observe(&mut self, now_s: f64, snapshot: &Snapshot) {
        self.drawn += 1;
        self.window_frames.observe(now_s, self.drawn);
        self.frames.observe(now_s, snapshot.counters.frames);
        self.packets.observe(now_s, snapshot.counters.packets);
    }

    /// Shows the bar; figures that do not fit are left out, from the right.
    pub(super) fn show(&mut self, ui: &mut Ui, theme: &Theme, shown: &ShownFloor) {
        self.latency.update(shown.now_s);
        let frame = panel_frame(theme, Margin::symmetric(14, 3));
        let frame = frame.stroke(egui::Stroke::NONE);
        Panel::bottom("status bar").frame(frame).resizable(false).show(ui, |ui| {
            let figures = self.figures(theme, shown);
            ui.horizontal(|ui| {
                ui.set_height(18.0);
                ui.spacing_mut().item_spacing.x = 14.0;
                let room = ui.available_width();
                // Show as many figures as fit, at the right; the source gets the remaining width.
                let gap = ui.spacing().item_spacing.x;
                let mut left = room - SOURCE - gap;
                let fits = |one: &Figure| {
                    left -= one.width + gap;
                    left >= 0.0
                };
                let figures: Vec<Figure> = figures.into_iter().take_while(fits).collect();
                let taken: f32 = figures.iter().map(|one| one.width + gap).sum();
                let source = vec2(room - taken, 18.0);
                ui.allocate_ui_with_layout(source, Layout::left_to_right(Align::Center), |ui| {
                    ui.set_min_size(source);
                    let (said, colour) = said_source(theme, shown);
                    let text = RichText::new(&said).size(LETTERS).color(color(colour));
                    ui.add(Label::new(text).truncate()).on_hover_text(&said);
                });
                figures.iter().for_each(|one| figure(ui, one));
            });
        });
    }

    fn figures(&self, theme: &Theme, shown: &ShownFloor) -> Vec<Figure> {
        let snapshot = shown.snapshot();
        let (counters, plays) = (&snapshot.counters, snapshot.device.is_some());
        let rate =
            |rate: Option<f32>| rate.map_or_else(|| "–".to_owned(), |rate| grouped(rate.round() as u64));
        let (lost, refused) = (counters.lost, counters.refused());
        let seen = |bad: bool| if bad { theme.warning } else { theme.quiet };
        let drawn = match self.window_frames.per_second() {
            // A window without news does not draw.
            Some(rate) if rate < 2.0 => "at rest".to_owned(),
            drawn => format!("{} fps", rate(drawn)),
        };
        let figure =
            |width, text, colour, meaning: &str| Figure { width, text, colour, meaning: meaning.into() };
        let of_window = figure(
            54.0,
            drawn,
            theme.quiet,
            "Frames a second in this window, which draws when something changes",
        );
        if shown.is_told_by_lines() {
            let (missed, malformed) = (snapshot.unsent_events, counters.malformed);
            let refused = format!("{} missed, {} refused", grouped(missed), grouped(malformed));
            return vec![
                figure(
                    150.0,
                    refused,
                    seen(missed + malformed > 0),
                    "Events that were lost on the way, and lines that tell nothing of a floor",
                ),
                of_window,
            ];
        }
        vec![
            figure(
                106.0,
                format!("{} packets/s", rate(self.packets.per_second())),
                theme.quiet,
                "Sensor packets a second",
            ),
            figure(
                96.0,
                format!("{} frames/s", rate(self.frames.per_second())),
                theme.quiet,
                "Sensor frames a second",
            ),
            figure(
                150.0,
                format!("{} lost, {} refused", grouped(lost), grouped(refused)),
                seen(lost + refused > 0),
                "Packets that never came, and datagrams that were refused; the panel says why",
            ),
            Figure {
                width: 176.0,
                text: self.latency.text(plays),
                colour: theme.quiet,
                meaning: self.latency.meaning(plays),
            },
            of_window,
        ]
    }
}

/// The source of the floor, with any problem of it.
fn said_source(theme: &Theme, shown: &ShownFloor) -> (String, Colour) {
    let Some(ServerState { address, link, left_out, .. }) = &shown.server else {
        return (shown.source.clone(), theme.quiet);
    };
    match link {
        ServerLink::Lost(why) => (format!("lost {address}: {why}; trying again"), theme.fault),
        ServerLink::Joined if *left_out > 0 => {
            let left_out = grouped(*left_out);
            (format!("joined {address}; {left_out} packets left out on the way"), theme.warning)
        }
        ServerLink::Joined => (format!("joined {address}"), theme.quiet),
        ServerLink::Followed => (format!("follows {address}"), theme.quiet),
        ServerLink::Ended(why) => (format!("{address} has ended: {why}"), theme.fault),
    }
}

fn figure(ui: &mut Ui, one: &Figure) {
    let size = vec2(one.width, 18.0);
    ui.allocate_ui_with_layout(size, Layout::left_to_right(Align::Center), |ui| {
        ui.set_min_size(size);
        ui.set_max_width(one.width);
        let text = RichText::new(&one.text).size(LETTERS).color(color(one.colour));
        let label = ui.add(Label::new(text).truncate());
        label.widget_info(|| WidgetInfo::labeled(Role::Status, true, &one.text));
        label.on_hover_text(&one.meaning);
    });
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn latency_is_told_as_far_as_it_is_known() {
        assert_eq!(Latency::default().text(true), "event –, felt –");
        let stages = LatencyStages::default();
        let mut latency = Latency::new(Some(stages.clone()));
        latency.update(0.0);
        assert!(latency.meaning(true).contains("nothing was felt"));
        stages.link.record(Duration::from_micros(200));
        stages.engine.record(Duration::from_micros(1000));
        latency.update(0.1);
        assert_eq!(latency.text(true), "event –, felt –", "twice a second");
        latency.update(0.6);
        assert_eq!(latency.text(true), "event 1.2 ms, felt –");
        stages.whole.record(Duration::from_millis(6));
        latency.update(1.2);
        assert!(
            latency.text(true).ends_with("felt 6.0 ms")
                && latency.meaning(true).contains("goes to the device")
        );
        stages.sounding.record(Duration::from_millis(11));
        latency.update(1.8);
        assert!(
            latency.text(true).ends_with("felt 11.0 ms") && latency.meaning(true).contains("own account")
        );
        // Output that only goes to a file, or nowhere, is not felt.
        assert_eq!(latency.text(false), "event 1.2 ms, felt –");
        assert!(latency.meaning(false).contains("no device"));
    }
}
