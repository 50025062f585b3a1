//! Addresses with ports, as in `192.168.1.10:9000`.

use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};

use thiserror::Error;

use underfoot_format::codec::Spelled;

/// An address and a port in files.
pub(crate) const ADDRESS: Spelled<SocketAddr> = Spelled {
    about: "an address and a port in quotes, \"192.168.1.10:9000\"",
    parse: |text| read_address(text).ok().filter(is_definite),
    wrong: |_, text| format!("{text:?} is not the address of one computer and a port"),
    expected: "expected an address and a port",
    help: |_| Some("write \"192.168.1.10:9000\"".to_owned()),
    stand_in: SocketAddr::V4(SocketAddrV4::new(Ipv4Addr::LOCALHOST, 9000)),
};

/// A text is not an address with a port.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("write an address and a port, like 127.0.0.1:9000 or [::1]:9000")]
pub struct NotAnAddress;

/// Reads the address in `text`, such as `127.0.0.1:9000`. An IPv4 address within IPv6, such as
/// `[::ffff:127.0.0.1]:9000`, becomes the IPv4 address.
///
/// # Errors
/// [`NotAnAddress`] for any other text, including host names.
pub fn read_address(text: &str) -> Result<SocketAddr, NotAnAddress> {
    text.parse().map(canonical).map_err(|_| NotAnAddress)
}

/// Converts an IPv4 address within IPv6 to IPv4 (RFC 4291, 2.5.5.2) and returns others unchanged: the system's
/// sockets treat both forms as the same address, so rules about addresses must do so too.
#[must_use]
pub fn canonical(address: SocketAddr) -> SocketAddr {
    match address.ip().to_canonical() {
        // An IPv6 address keeps its scope.
        ip if ip.is_ipv4() => SocketAddr::new(ip, address.port()),
        _ => address,
    }
}

/// Whether other computers can send there: `0.0.0.0` means each computer itself, and port 0 cannot receive.
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
