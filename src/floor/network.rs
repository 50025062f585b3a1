//! Networks by their addresses, as in `192.168.1.0/24`.

use std::fmt;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr};
use std::str::FromStr;

use thiserror::Error;

use underfoot_format::codec::Spelled;

/// One address or a range of them, in CIDR notation (RFC 4632).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Network {
    ip: IpAddr,
    /// Number of significant leading bits: at most 32, or 128 for IPv6.
    bits: u8,
}

/// A network in files.
pub(crate) const NETWORK: Spelled<Network> = Spelled {
    about: "an address or a range of them in quotes, \"192.168.1.0/24\"",
    parse: |text| text.parse().ok(),
    wrong: |_, text| format!("{text:?} is not a network"),
    expected: "expected an address or a range of them",
    help: |_| Some("write \"192.168.1.20\" or \"192.168.1.0/24\"".to_owned()),
    stand_in: Network::LOOPBACK[0],
};

/// Reason for which a text is not a network.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum NotANetwork {
    /// It is not an address, or its range has more bits than the address.
    #[error("write an address or a range of them, like 192.168.1.20 or 192.168.1.0/24")]
    Malformed,
    /// It is an IPv4 address within IPv6 with a range that reaches beyond IPv4.
    #[error(
        "write IPv4 addresses as IPv4, like 192.168.1.0/24: `::ffff:...` with less than 96 bits is neither"
    )]
    BeyondIpv4,
}

impl Network {
    /// The addresses of this machine itself: 127.0.0.0/8 and ::1.
    pub const LOOPBACK: [Self; 2] = [
        Self { ip: IpAddr::V4(Ipv4Addr::new(127, 0, 0, 0)), bits: 8 },
        Self { ip: IpAddr::V6(Ipv6Addr::LOCALHOST), bits: 128 },
    ];

    /// Whether `ip` belongs to the network; an IPv4 address written as IPv6 counts as IPv4.
    #[must_use]
    pub fn contains(&self, ip: IpAddr) -> bool {
        match (self.ip, ip.to_canonical()) {
            (IpAddr::V4(own), IpAddr::V4(other)) => {
                let differs = (own.to_bits() ^ other.to_bits()).leading_zeros();
                differs >= u32::from(self.bits)
            }
            (IpAddr::V6(own), IpAddr::V6(other)) => {
                let differs = (own.to_bits() ^ other.to_bits()).leading_zeros();
                differs >= u32::from(self.bits)
            }
            _ => false,
        }
    }
}

impl From<IpAddr> for Network {
    /// The network of this single address.
    fn from(ip: IpAddr) -> Self {
        let ip = ip.to_canonical();
        Self { ip, bits: if ip.is_ipv4() { 32 } else { 128 } }
    }
}

/// Bits of an IPv6 address before the IPv4 address within it (RFC 4291, 2.5.5.2).
const BITS_BEFORE_IPV4: u8 = 96;

impl FromStr for Network {
    type Err = NotANetwork;

    /// Reads `192.168.1.20`, `192.168.1.0/24`, `::1` or `fd00::/8`; address bits behind the range are ignored. IPv4
    /// addresses within IPv6 are IPv4: `::ffff:192.168.1.0/120` is `192.168.1.0/24`.
    fn from_str(text: &str) -> Result<Self, NotANetwork> {
        let (ip, bits) = match text.split_once('/') {
            Some((ip, bits)) => (ip, Some(bits.parse::<u8>().map_err(|_| NotANetwork::Malformed)?)),
            None => (text, None),
        };
        let written: IpAddr = ip.parse().map_err(|_| NotANetwork::Malformed)?;
        let Some(bits) = bits else { return Ok(written.into()) };
        let ip = written.to_canonical();
        let most = if written.is_ipv4() { 32 } else { 128 };
        match (bits, ip == written) {
            (bits, _) if bits > most => Err(NotANetwork::Malformed),
            (bits, true) => Ok(Self { ip, bits }),
            (bits, false) => {
                let bits = bits.checked_sub(BITS_BEFORE_IPV4).ok_or(NotANetwork::BeyondIpv4)?;
                Ok(Self { ip, bits })
            }
        }
    }
}

impl fmt::Display for Network {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let is_one = self.bits == if self.ip.is_ipv4() { 32 } else { 128 };
        if is_one { write!(f, "{}", self.ip) } else { write!(f, "{}/{}", self.ip, self.bits) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contains(network: &str, ip: &str) -> bool {
        network.parse::<Network>().unwrap().contains(ip.parse().unwrap())
    }

    #[test]
    fn a_network_holds_what_begins_with_its_bits() {
        assert!(contains("192.168.1.0/24", "192.168.1.255") && !contains("192.168.1.0/24", "192.168.2.0"));
        assert!(contains("192.168.1.77/24", "192.168.1.3"), "bits behind the range don't count");
        assert!(contains("10.1.2.3", "10.1.2.3") && !contains("10.1.2.3", "10.1.2.2"));
        assert!(contains("0.0.0.0/0", "203.0.113.9") && !contains("0.0.0.0/0", "2001:db8::1"));
        assert!(contains("fd00::/8", "fdff::1") && !contains("fd00::/8", "fe80::1"));
        assert!(contains("127.0.0.0/8", "::ffff:127.0.0.1"), "IPv4 within IPv6 is IPv4");
    }

    #[test]
    fn texts_are_read_and_written() {
        for text in ["192.168.1.0/24", "10.0.0.1", "::1", "fd00::/8", "0.0.0.0/0"] {
            assert_eq!(text.parse::<Network>().unwrap().to_string(), text);
        }
        for bad in ["", "10.0.0.0/33", "::/129", "10.0.0/8", "10.0.0.0/", "10.0.0.0/-1", "lab", "1.2.3.4/8/8"]
        {
            assert_eq!(bad.parse::<Network>(), Err(NotANetwork::Malformed), "{bad}");
        }
    }

    #[test]
    fn ipv4_addresses_within_ipv6_are_ipv4() {
        for (within, plain) in [
            ("::ffff:127.0.0.1", "127.0.0.1"),
            ("::ffff:127.0.0.1/128", "127.0.0.1"),
            ("::ffff:192.168.1.0/120", "192.168.1.0/24"),
            ("::ffff:c0a8:100/120", "192.168.1.0/24"),
            ("::ffff:0:0/96", "0.0.0.0/0"),
        ] {
            assert_eq!(within.parse::<Network>(), plain.parse::<Network>(), "{within}");
        }
        assert!(
            contains("::ffff:10.0.0.0/104", "10.200.0.1") && !contains("::ffff:10.0.0.0/104", "11.0.0.1")
        );
        for beyond in ["::ffff:10.0.0.0/8", "::ffff:10.0.0.0/95", "::ffff:0:0/0"] {
            assert_eq!(beyond.parse::<Network>(), Err(NotANetwork::BeyondIpv4), "{beyond}");
        }
        assert_eq!("::ffff:10.0.0.1/129".parse::<Network>(), Err(NotANetwork::Malformed));
        // Adjacent, and another kind of address.
        assert!(contains("::fffe:0:0/96", "::fffe:0:1"));
    }
}
