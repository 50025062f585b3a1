//! DMX: universes of lights as targets, and levels of their channels.

use std::fmt;
use std::net::{Ipv4Addr, SocketAddrV4};

use serde::{Deserialize, Serialize};
use underfoot_format::{Flag, Num, Opt, Text, num, record};

/// Number of channels of a universe.
pub const DMX_CHANNELS: u16 = 512;

/// Greatest level of one channel.
pub const DMX_MAX: u16 = 255;

/// The UDP port of Art-Net.
const ART_NET_PORT: u16 = 6454;

/// The UDP port of sACN.
const SACN_PORT: u16 = 5568;

const LEVELS: Num = num(0.0..=65_535.0);

/// A universe that a node of Art-Net puts out.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct ArtNetTarget {
    /// The IPv4 address of the node, or one of a whole network for a broadcast; with a port if it is not 6454.
    pub address: String,
    /// The number of the universe, 0 to 32767 (*port address* in Art-Net).
    pub universe: u16,
}

record! {
    /// A universe of sACN (E1.31).
    pub struct SacnTarget = "Sacn", Eq, Deserialize, Serialize => |it, faults| {
        if it.to.as_deref().is_some_and(|to| ipv4(to, SACN_PORT).is_none()) {
            faults.error(&["to"], "this is no IPv4 address", "expected an address such as \"10.0.0.20\"");
        }
        if it.via.as_deref().is_some_and(|via| via.parse::<Ipv4Addr>().is_err()) {
            faults.error(&["via"], "this is no IPv4 address", "expected that of a network card, such as \"10.0.0.5\"");
        }
    };
    /// The number of the universe.
    pub universe: u16 = "universe", num(1.0..=63_999.0) => 1;
    /// The IPv4 address of the only receiver; without it all receivers of the universe, by multicast.
    pub to: Option<String> = "to", Opt(Text(40)) => None;
    /// The address of the network card that sends the multicast; the system chooses one without it.
    pub via: Option<String> = "via", Opt(Text(40)) => None;
    /// The priority: receivers follow the source with the highest one.
    pub priority: u8 = "priority", num(0.0..=200.0) => 100;
}

record! {
    /// The level of a channel: at an event, during a hold, or over the range of a value.
    pub struct DmxSettings = "Dmx", Copy, Eq, Hash, PartialOrd, Ord, Deserialize, Serialize => |it, faults| {
        if it.fine && it.channel == DMX_CHANNELS {
            let expected = "the lower half of the level has the next channel, and 512 is the last one";
            faults.error(&["channel", "fine"], "this channel has 8 bits only", expected);
        }
        if !it.fine && it.from.max(it.top()) > DMX_MAX {
            faults.error(&["from", "to"], "this level has more than 8 bits", "write up to 255, or fine: true");
        }
    };
    /// The channel, from 1.
    pub channel: u16 = "channel", num(1.0..=DMX_CHANNELS as f64);
    /// Whether the level has 16 bits, in this channel and the next one.
    pub fine: bool = "fine", Flag => false;
    /// The level for the least value of the control, and at rest: before and after a hold.
    pub from: u16 = "from", LEVELS => 0;
    /// The level for the greatest value of the control, at an event and during a hold: 255, or 65535 with 16 bits,
    /// where none is written.
    pub to: Option<u16> = "to", Opt(LEVELS) => None;
}

/// The level of one channel, or of a pair of channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub struct DmxLevel {
    /// The channel, 1 to 512.
    pub channel: u16,
    /// Whether the level has 16 bits, in this channel and the next one.
    pub fine: bool,
    /// The level, up to 255 or 65535.
    pub level: u16,
}

impl ArtNetTarget {
    /// Whether `text` is an IPv4 address, with or without a port.
    #[must_use]
    pub fn is_address(text: &str) -> bool {
        ipv4(text, ART_NET_PORT).is_some()
    }

    /// The address of its node; `None` for a text that is none.
    #[must_use]
    pub fn node(&self) -> Option<SocketAddrV4> {
        ipv4(&self.address, ART_NET_PORT)
    }
}

impl SacnTarget {
    /// Universe 1 for all receivers, with the usual priority.
    pub const USUAL: Self = Self { universe: 1, to: None, via: None, priority: 100 };

    /// Whether `text` is an IPv4 address, with or without a port.
    #[must_use]
    pub fn is_address(text: &str) -> bool {
        ipv4(text, SACN_PORT).is_some()
    }

    /// The address that its packets go to: that of its receiver, or the multicast group of its universe; `None` for a
    /// receiver that is no address.
    #[must_use]
    pub fn receiver(&self) -> Option<SocketAddrV4> {
        let [high, low] = self.universe.to_be_bytes();
        match &self.to {
            Some(to) => ipv4(to, SACN_PORT),
            None => Some(SocketAddrV4::new(Ipv4Addr::new(239, 255, high, low), SACN_PORT)),
        }
    }
}

fn ipv4(text: &str, port: u16) -> Option<SocketAddrV4> {
    let alone = || text.parse().ok().map(|address| SocketAddrV4::new(address, port));
    text.parse().ok().filter(|address: &SocketAddrV4| address.port() > 0).or_else(alone)
}

impl DmxSettings {
    /// An 8-bit channel from 0 to 255.
    #[must_use]
    pub const fn of(channel: u16) -> Self {
        Self { channel, fine: false, from: 0, to: None }
    }

    /// The level at the upper end.
    #[must_use]
    pub fn top(&self) -> u16 {
        self.to.unwrap_or(if self.fine { u16::MAX } else { DMX_MAX })
    }

    /// The level at `share` of the range, 0 to 1.
    pub(super) fn at(&self, share: f32) -> DmxLevel {
        let [from, top] = [self.from, self.top()].map(f64::from);
        self.with((from + (top - from) * f64::from(share.clamp(0.0, 1.0))).round() as u16)
    }

    /// The channel at `level`.
    #[must_use]
    pub const fn with(&self, level: u16) -> DmxLevel {
        DmxLevel { channel: self.channel, fine: self.fine, level }
    }
}

impl fmt::Display for DmxSettings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "DMX channel {}", self.channel)
    }
}

impl fmt::Display for DmxLevel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let of = if self.fine { " of 65535" } else { "" };
        write!(f, "DMX channel {}: {}{of}", self.channel, self.level)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_follows_the_share_of_its_range_and_its_number_of_bits() {
        let dimmer = DmxSettings::of(12);
        let of = |settings: DmxSettings| [0.0, 0.5, 1.0, 7.0, f32::NAN].map(|share| settings.at(share).level);
        assert_eq!(of(dimmer), [0, 128, 255, 255, 0]);
        assert_eq!(of(DmxSettings { fine: true, ..dimmer }), [0, 32_768, 65_535, 65_535, 0]);
        assert_eq!(of(DmxSettings { from: 200, to: Some(100), ..dimmer })[..3], [200, 150, 100]);
    }

    #[test]
    fn addresses_have_the_ports_and_groups_of_their_standards() {
        let node = |address: &str| ArtNetTarget { address: address.into(), universe: 0 }.node();
        assert_eq!(node("10.0.0.20"), Some("10.0.0.20:6454".parse().unwrap()));
        assert_eq!(node("2.255.255.255:7000"), Some("2.255.255.255:7000".parse().unwrap()));
        assert_eq!([node("lamp"), node("10.0.0.20:0"), node("")], [None; 3]);
        let universe = |universe, to: Option<&str>| {
            SacnTarget { universe, to: to.map(str::to_owned), via: None, priority: 100 }.receiver()
        };
        assert_eq!(universe(258, None), Some("239.255.1.2:5568".parse().unwrap()));
        assert_eq!(universe(1, Some("10.0.0.20")), Some("10.0.0.20:5568".parse().unwrap()));
    }
}
