//! Web pages that may connect: browsers report the origin of a page, which the page can't change.

use std::convert::Infallible;
use std::net::{IpAddr, SocketAddr};
use std::str::FromStr;

use underfoot::floor::{canonical, read_address};

/// The origin of a page, as browsers report it: scheme, host and port.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct PageOrigin(String);

impl FromStr for PageOrigin {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(Self(text.trim_end_matches('/').to_ascii_lowercase()))
    }
}

/// Whether a page from `origin` may connect to `own`: if it is allowed, comes from this machine, or comes from the
/// very numeric address to which it connects. A host name counts only if it is allowed, since any name may resolve to
/// this machine (DNS rebinding). A client without an origin is not a web page.
pub(super) fn may_connect(origin: Option<&str>, own: SocketAddr, allowed: &[PageOrigin]) -> bool {
    let Some(origin) = origin else { return true };
    let origin = origin.to_ascii_lowercase();
    if allowed.iter().any(|other| other.0 == origin) {
        return true;
    }
    let Some((_, authority)) = origin.split_once("://") else { return false };
    if host(authority).is_some_and(|host| host == "localhost") {
        return true;
    }
    let ip = host(authority).and_then(|host| host.parse::<IpAddr>().ok()).map(|ip| ip.to_canonical());
    ip.is_some_and(|ip| ip.is_loopback() || read_address(authority) == Ok(canonical(own)))
}

/// Whether a request that names `host` as its receiver may be answered: a number, this machine, or the host of an
/// allowed origin. Any other name may belong to a page that made it lead here (DNS rebinding). A client without a host
/// is not a browser.
pub(super) fn may_be_named(receiver: Option<&str>, allowed: &[PageOrigin]) -> bool {
    let Some(receiver) = receiver else { return true };
    let receiver = receiver.to_ascii_lowercase();
    let Some(name) = host(&receiver) else { return false };
    let is_allowed = |origin: &PageOrigin| {
        origin
            .0
            .split_once("://")
            .and_then(|(_, authority)| host(authority))
            .is_some_and(|other| other == name)
    };
    name == "localhost" || name.parse::<IpAddr>().is_ok() || allowed.iter().any(is_allowed)
}

/// The host of `host:port` or `[host]:port`.
fn host(authority: &str) -> Option<&str> {
    match authority.strip_prefix('[') {
        Some(rest) => rest.split_once(']').map(|(host, _)| host),
        None => authority.split(':').next(),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn pages_of_this_machine_and_those_allowed_may_connect() {
        let own: SocketAddr = "192.168.1.5:9002".parse().unwrap();
        let allowed: Vec<PageOrigin> = vec!["https://app.example.org/".parse().unwrap()];
        let may = |origin| may_connect(Some(origin), own, &allowed);
        for good in [
            "http://localhost:3000",
            "http://127.0.0.1",
            "http://[::1]:9002",
            "http://192.168.1.5:9002",
            "https://APP.example.org",
        ] {
            assert!(may(good), "{good}");
        }
        for bad in [
            "null",
            "",
            "http://evil.example",
            "http://localhost.evil.example",
            "http://127.0.0.1.evil.example",
            "http://192.168.1.5:80",
            "http://192.168.1.6:9002",
            "http://app.example.org",
            "http://localhost@evil.example",
        ] {
            assert!(!may(bad), "{bad}");
        }
        assert!(may_connect(None, own, &[]));
    }

    #[test]
    fn names_that_may_lead_here_by_a_trick_are_no_receivers() {
        let allowed: Vec<PageOrigin> = vec!["http://floor.lan:9002".parse().unwrap()];
        for good in
            ["127.0.0.1:9002", "[::1]:9002", "192.168.1.5", "LocalHost:80", "floor.lan:9002", "floor.lan"]
        {
            assert!(may_be_named(Some(good), &allowed), "{good}");
        }
        for bad in [
            "evil.example:9002",
            "",
            "localhost.evil.example",
            "floor.lan.evil.example",
            "127.0.0.1.evil.example",
        ] {
            assert!(!may_be_named(Some(bad), &allowed), "{bad}");
        }
        assert!(may_be_named(None, &[]));
    }

    #[test]
    fn the_floor_s_own_page_may_connect_where_one_socket_serves_both_kinds_of_addresses() {
        let own: SocketAddr = "[::ffff:192.168.1.5]:9002".parse().unwrap();
        assert!(may_connect(Some("http://192.168.1.5:9002"), own, &[]));
        assert!(!may_connect(Some("http://192.168.1.6:9002"), own, &[]));
    }
}
