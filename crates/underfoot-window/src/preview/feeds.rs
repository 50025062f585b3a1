//! Data between the window and its floor: events, feet, signals of the actuators.

use std::sync::mpsc::{SyncSender, TrySendError};

use glam::Vec2;
use triple_buffer::Output;

use super::feed::{EventNews, FootSink, PreviewFoot, ScopeFeed, ShoeFeed};
use underfoot::feel::ScopeReader;
use underfoot::messages::MessageNews;
use underfoot::sink::{EventSink, Report};
use underfoot::widget::WidgetEvent;
use underfoot_sim::{Foot, FootHandle};

/// Passes events on to the window.
#[derive(Debug)]
pub struct ToWindow {
    events: SyncSender<EventNews>,
    missed: u64,
}

impl ToWindow {
    /// Passes events on to the window with the other end of this channel.
    #[must_use]
    pub fn new(events: SyncSender<EventNews>) -> Self {
        Self { events, missed: 0 }
    }
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

/// The mouse's feet on a simulated floor.
#[derive(Debug)]
pub struct Mouse(pub FootHandle);

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
fn shoe(foot: &Foot) -> PreviewFoot {
    PreviewFoot {
        position: foot.position,
        heading_rad: foot.heading,
        length_m: foot.length_m + SHOE_M,
        force: foot.force,
        roll: foot.roll,
        left: foot.left,
    }
}

/// The shoes around all feet of a simulated floor.
#[must_use]
pub fn shoes(mut seen: Output<Vec<Foot>>) -> ShoeFeed {
    Box::new(move |shoes| {
        shoes.clear();
        shoes.extend(seen.read().iter().map(shoe));
    })
}

/// Signals of the actuators, as the window draws them.
pub struct SignalScopes {
    reader: ScopeReader,
    points: Vec<(f32, f32)>,
}

impl SignalScopes {
    /// The signals that `reader` reads.
    #[must_use]
    pub fn new(reader: ScopeReader) -> Self {
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
