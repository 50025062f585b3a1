//! Data between the window and its floor: events, feet, signals of the actuators.

use std::sync::mpsc::{SyncSender, TrySendError};
use std::thread;
use std::time::Duration;

use underfoot::feel::ScopeReader;
use underfoot::glam::Vec2;
use underfoot::messages::MessageNews;
use underfoot::runtime::Session;
use underfoot::sink::{EventSink, Report};
use underfoot::widget::WidgetEvent;
use underfoot_sim::{Foot, FootHandle};
use underfoot_window::preview::{EventNews, FootSink, PreviewFoot, ScopeFeed};

/// Passes events on to the window.
pub(super) struct ToWindow {
    pub(super) events: SyncSender<EventNews>,
    pub(super) missed: u64,
}

impl EventSink for ToWindow {
    fn report(&mut self, report: &Report<'_>) {
        let news = match report {
            Report::Event(event) => EventNews::Event(WidgetEvent::clone(event)),
            Report::Message(news) => EventNews::Sent(MessageNews::clone(news)),
            _ => return,
        };
        if let Err(TrySendError::Full(_)) = self.events.try_send(news) {
            self.missed += 1;
        }
    }

    fn dropped(&self) -> u64 {
        self.missed
    }
}

/// Stops a floor and waits until it has ended, so that no more reports come from it.
pub(super) fn stop_and_wait(session: &Session) {
    session.stop();
    while !session.has_ended() {
        thread::sleep(Duration::from_millis(1));
    }
}

/// The mouse's feet on the simulated floor.
pub(super) struct Mouse(pub(super) FootHandle);

impl FootSink for Mouse {
    fn lead(&mut self, over_s: f32, paths: &[Vec<PreviewFoot>]) {
        self.0.lead(over_s, paths.iter().map(|path| path.iter().map(foot).collect()).collect());
    }

    fn centre_of_pressure(&self, shoe: &PreviewFoot) -> Vec2 {
        foot(shoe).centre_of_pressure()
    }
}

/// Margin of the shoe around the foot's length: a centimetre.
const SHOE_M: f32 = 0.01;

fn foot(shoe: &PreviewFoot) -> Foot {
    Foot {
        position: shoe.position,
        heading: shoe.heading_rad,
        length_m: shoe.length_m - SHOE_M,
        force: shoe.force,
        roll: shoe.roll,
        left: shoe.left,
    }
}

/// The shoe around a foot.
pub(super) fn shoe(foot: &Foot) -> PreviewFoot {
    PreviewFoot { length_m: foot.length_m + SHOE_M, ..PreviewFoot::from(foot) }
}

/// Signals of the actuators, as the window draws them.
pub(super) struct SignalScopes {
    reader: ScopeReader,
    points: Vec<(f32, f32)>,
}

impl SignalScopes {
    pub(super) fn new(reader: ScopeReader) -> Self {
        Self { reader, points: Vec::new() }
    }
}

impl ScopeFeed for SignalScopes {
    fn update(&mut self) {
        self.reader.update();
    }

    fn scope(&mut self, channel: usize) -> &[(f32, f32)] {
        self.points.clear();
        self.points.extend(self.reader.channel(channel).iter().map(|point| (point.min, point.max)));
        &self.points
    }
}
