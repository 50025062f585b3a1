//! Addresses with ports, as in `192.168.1.10:9000`.

use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4};

use crate::format::codec::Spelled;

/// An address and a port as files write them.
pub(crate) const ADDRESS: Spelled<SocketAddr> = Spelled {
    about: "an address and a port in quotes, \"192.168.1.10:9000\"",
    parse: |text| text.parse().ok().filter(is_definite),
    wrong: |_, text| format!("{text:?} is not the address of one computer and a port"),
    expected: "expected an address and a port",
    help: |_| Some("write \"192.168.1.10:9000\"".to_owned()),
    stand_in: SocketAddr::V4(SocketAddrV4::new(Ipv4Addr::LOCALHOST, 9000)),
};

/// Whether others can send there: `0.0.0.0` is each computer to itself, and nothing can be sent to port 0.
fn is_definite(address: &SocketAddr) -> bool {
    !address.ip().is_unspecified() && address.port() != 0
}
