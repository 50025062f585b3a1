//! Addresses with ports, as in `192.168.1.10:9000`.

use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};

use thiserror::Error;

use crate::format::codec::Spelled;

/// An address and a port as files write them.
pub(crate) const ADDRESS: Spelled<SocketAddr> = Spelled {
    about: "an address and a port in quotes, \"192.168.1.10:9000\"",
    parse: |text| read_address(text).ok().filter(is_definite),
    wrong: |_, text| format!("{text:?} is not the address of one computer and a port"),
    expected: "expected an address and a port",
    help: |_| Some("write \"192.168.1.10:9000\"".to_owned()),
    stand_in: SocketAddr::V4(SocketAddrV4::new(Ipv4Addr::LOCALHOST, 9000)),
};

/// Why a text is not an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("write an address and a port, like 127.0.0.1:9000 or [::1]:9000")]
pub struct NotAnAddress;

/// The address in `text`, such as `127.0.0.1:9000`. An IPv4 address within IPv6, such as `[::ffff:127.0.0.1]:9000`, is
/// the IPv4 address.
///
/// # Errors
/// [`NotAnAddress`] for everything else, also for names.
pub fn read_address(text: &str) -> Result<SocketAddr, NotAnAddress> {
    text.parse().map(canonical).map_err(|_| NotAnAddress)
}

/// `address`, as IPv4 if it is an IPv4 address within IPv6 (RFC 4291, 2.5.5.2): the system's sockets take both for the
/// same, and rules about addresses must as well.
#[must_use]
pub fn canonical(address: SocketAddr) -> SocketAddr {
    match address.ip().to_canonical() {
        // An address that stays IPv6 keeps its scope.
        ip if ip.is_ipv4() => SocketAddr::new(ip, address.port()),
        _ => address,
    }
}

/// Whether others can send there: `0.0.0.0` is each computer to itself, and nothing can be sent to port 0.
fn is_definite(address: &SocketAddr) -> bool {
    !address.ip().is_unspecified() && address.port() != 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ipv4_address_within_ipv6_is_the_ipv4_address() {
        let read = |text: &str| read_address(text).map(|address| address.to_string());
        assert_eq!(read("[::ffff:127.0.0.1]:9000"), Ok("127.0.0.1:9000".into()));
        assert_eq!(read("[::ffff:c0a8:1402]:1"), Ok("192.168.20.2:1".into()));
        for other in ["127.0.0.1:9000", "[::1]:9000", "[fe80::1%3]:9000", "[::]:9002", "0.0.0.0:1"] {
            assert_eq!(read(other), Ok(other.into()));
        }
        for bad in ["", "localhost:9000", "127.0.0.1", "::1:9000", "127.0.0.1:70000", "[::ffff:1.2.3]:1"] {
            assert_eq!(read(bad), Err(NotAnAddress), "{bad}");
        }
    }
}
