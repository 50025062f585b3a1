//! State of the areas of a floor that several computers serve.

use std::time::Duration;

use crate::units::Instant;
use crate::wire::sent::{self, Sent};
use crate::wire::{Prefix, write};

/// State of one area of a floor at the gateway that joins the areas.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AreaState {
    /// No data from the area so far.
    #[default]
    Waiting,
    /// The gateway reports events of the area.
    Live,
    /// No new data from the area: holds there are cancelled, its contacts have ended.
    Lost,
    /// Several computers claim to serve the area: the gateway ignores all of them.
    Disputed,
}

impl AreaState {
    /// All states.
    pub const ALL: [Self; 4] = [Self::Waiting, Self::Live, Self::Lost, Self::Disputed];

    /// Returns its name in OSC and JSON.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::Live => "live",
            Self::Lost => "lost",
            Self::Disputed => "disputed",
        }
    }
}

/// A change in the state of one area.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AreaNews {
    /// Time of the change.
    pub at: Instant,
    /// The area.
    pub area: String,
    /// Its new state.
    pub state: AreaState,
    /// The reason, in words for a person; empty for a live area.
    pub why: String,
    /// Maximum error of the area's event times relative to those of other areas; zero unless the area is live.
    pub uncertainty: Duration,
}

/// Writes the state of an area as the OSC message `/underfoot/area`: its name, state and reason, three strings, and
/// the uncertainty of its times in seconds, a float.
pub fn write_area(prefix: &Prefix, news: &AreaNews, bytes: &mut Vec<u8>) {
    let message = sent::Area {
        area: news.area.clone(),
        state: news.state.name().into(),
        why: news.why.clone(),
        uncertainty: news.uncertainty.as_secs_f32(),
    };
    write(&message.packet(prefix), bytes);
}

#[cfg(test)]
mod tests {
    use rosc::{OscPacket, OscType, decoder};

    use super::*;

    #[test]
    fn an_area_is_three_strings_and_the_uncertainty_of_its_times() {
        let news = AreaNews {
            at: Instant::START,
            area: "west".into(),
            state: AreaState::Lost,
            why: "nothing new".into(),
            uncertainty: Duration::from_micros(250),
        };
        let mut bytes = vec![7];
        write_area(&Prefix::default(), &news, &mut bytes);
        let Ok((_, OscPacket::Message(told))) = decoder::decode_udp(&bytes) else { panic!("not a message") };
        assert_eq!(told.addr, "/underfoot/area");
        let text = |text: &str| OscType::String(text.into());
        assert_eq!(told.args, [text("west"), text("lost"), text("nothing new"), OscType::Float(0.000_25)]);
    }
}
