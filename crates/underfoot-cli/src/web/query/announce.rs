//! The announcement of the server by mDNS, as a service `_oscjson._tcp`.

use std::net::{IpAddr, SocketAddr};
use std::time::Duration;

use mdns_sd::{IfKind, ServiceDaemon, ServiceInfo};
use tracing::warn;

/// The type of the service, as the OSCQuery proposal names it.
const SERVICE: &str = "_oscjson._tcp.local.";

/// Maximum time for the farewell at the end.
const FAREWELL: Duration = Duration::from_secs(1);

/// A service that other programs can find; ends when dropped.
pub(super) struct Announcement {
    daemon: ServiceDaemon,
    name: String,
}

impl Announcement {
    /// Announces a server at `address` under this name: on the network of the address only, or on all networks for an
    /// unspecified one.
    ///
    /// # Errors
    /// The system gives no socket, or the name is not possible.
    pub(super) fn start(name: &str, address: SocketAddr) -> Result<Self, mdns_sd::Error> {
        let (ip, port) = (address.ip(), address.port());
        // Two floors of one network have two names of computers.
        let host = format!("underfoot-{}-{port}.local.", ip.to_string().replace(['.', ':'], "-"));
        let name = instance(name);
        let addresses = if ip.is_unspecified() { String::new() } else { ip.to_string() };
        let mut service =
            ServiceInfo::new(SERVICE, &name, &host, addresses.as_str(), port, &[("txtvers", "1")][..])?;
        if ip.is_unspecified() {
            service = service.enable_addr_auto();
        }
        let daemon = ServiceDaemon::new()?;
        if !ip.is_unspecified() {
            daemon.disable_interface(IfKind::All)?;
            daemon.enable_interface(interface(ip))?;
        }
        let name = service.get_fullname().to_owned();
        daemon.register(service)?;
        Ok(Self { daemon, name })
    }
}

/// The interface with this address.
fn interface(ip: IpAddr) -> IfKind {
    match ip {
        IpAddr::V4(ip) if ip.is_loopback() => IfKind::LoopbackV4,
        IpAddr::V6(ip) if ip.is_loopback() => IfKind::LoopbackV6,
        ip => IfKind::Addr(ip),
    }
}

/// The name without characters that separate the parts of names, of 63 bytes at most, as DNS has it.
fn instance(name: &str) -> String {
    let plain: String = name.chars().map(|c| if c == '.' || c.is_control() { ' ' } else { c }).collect();
    plain[..plain.floor_char_boundary(63)].trim().to_owned()
}

impl Drop for Announcement {
    /// Says that the service is gone.
    fn drop(&mut self) {
        let farewell = || -> Result<(), mdns_sd::Error> {
            // The time-outs only bound the end of the program.
            let _ = self.daemon.unregister(&self.name)?.recv_timeout(FAREWELL);
            let _ = self.daemon.shutdown()?.recv_timeout(FAREWELL);
            Ok(())
        };
        if let Err(error) = farewell() {
            warn!("the announcement by mDNS was not taken back: {error}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_has_one_part_and_63_bytes_at_most() {
        assert_eq!(instance("underfoot: Map v1.2\n"), "underfoot: Map v1 2");
        let long = instance(&"ö".repeat(60));
        assert_eq!((long.len(), long.chars().count()), (62, 31));
    }

    #[test]
    fn a_server_of_this_machine_is_announced_on_this_machine_only() {
        assert!(matches!(interface([127, 0, 0, 1].into()), IfKind::LoopbackV4));
        assert!(matches!(interface([192, 168, 1, 5].into()), IfKind::Addr(ip) if ip.is_ipv4()));
    }
}
