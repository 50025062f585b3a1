//! How the areas of a floor that several computers serve are doing.

use std::time::Duration;

use rosc::OscType;

use super::osc::message;
use crate::units::Instant;
use crate::wire::{Prefix, write};

/// How one area of a floor stands with the gateway that joins them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AreaState {
    /// Nothing was heard of it yet.
    #[default]
    Waiting,
    /// What happens in it is told.
    Live,
    /// Nothing new comes from it: what feet held there is cancelled, its contacts have ended.
    Lost,
    /// Several computers say that they serve it: none is believed.
    Disputed,
}

impl AreaState {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Waiting, Self::Live, Self::Lost, Self::Disputed];

    /// The word for it in OSC and JSON.
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

/// How one area stands from now on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AreaNews {
    /// When that was found.
    pub at: Instant,
    /// Which area of the floor.
    pub area: String,
    /// How it stands.
    pub state: AreaState,
    /// Why, in words for a person; empty for one that lives.
    pub why: String,
    /// By how much the times of its events may be wrong against those of other areas; zero for one that does not live.
    pub uncertainty: Duration,
}

/// Writes how an area stands as the OSC message `/underfoot/area`: its name, state and why, three strings, and the
/// uncertainty of its times in seconds, a float.
pub fn write_area(prefix: &Prefix, news: &AreaNews, bytes: &mut Vec<u8>) {
    let texts = [news.area.as_str(), news.state.name(), news.why.as_str()];
    let mut args: Vec<OscType> = texts.map(|text| OscType::String(text.into())).into();
    args.push(OscType::Float(news.uncertainty.as_secs_f32()));
    write(&message(prefix.address("area"), args), bytes);
}

#[cfg(test)]
mod tests {
    use rosc::{OscPacket, decoder};

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
