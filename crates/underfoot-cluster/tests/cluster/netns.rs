//! Network namespaces: each node has its own interfaces, addresses and routes, as on its own computer.

use std::io::Write;
use std::net::Ipv4Addr;
use std::process::{Command, Stdio};

use crate::hall::AREAS;

/// A namespace for each area, all on one bridge; dropping this deletes them.
#[derive(Debug)]
pub(crate) struct Namespaces {
    tag: String,
    net: u8,
}

/// Runs `ip` with these words.
fn ip(words: &str) -> Result<(), String> {
    let done =
        Command::new("ip").args(words.split_whitespace()).output().map_err(|error| error.to_string())?;
    let why = || format!("ip {words}: {}", String::from_utf8_lossy(&done.stderr));
    done.status.success().then_some(()).ok_or_else(why)
}

/// Drops `per_cent` of the packets that arrive at `device`, by a rule in a table of the device's name; `nft` is the
/// command that runs nftables in the device's namespace.
fn lose(nft: &[&str], device: &str, table: &str, per_cent: u8) {
    let rules = format!(
        "add table netdev {table}\n\
         add chain netdev {table} arriving {{ type filter hook ingress device \"{device}\" priority 0; }}\n\
         add rule netdev {table} arriving numgen random mod 100 < {per_cent} drop\n"
    );
    let mut nft =
        Command::new(nft[0]).args(&nft[1..]).args(["-f", "-"]).stdin(Stdio::piped()).spawn().unwrap();
    nft.stdin.take().unwrap().write_all(rules.as_bytes()).unwrap();
    assert!(nft.wait().unwrap().success(), "nft refuses {rules}");
}

impl Namespaces {
    /// Namespaces, if `UNDERFOOT_NETNS` is set; they need root and Linux's `ip`.
    pub(crate) fn asked_for() -> Option<Self> {
        std::env::var_os("UNDERFOOT_NETNS").map(|_| Self::open())
    }

    fn open() -> Self {
        let number = std::process::id();
        let all = Self { tag: format!("uf{number}"), net: (number % 250) as u8 };
        let (bridge, here) = (format!("{}b", all.tag), all.here());
        ip(&format!("link add {bridge} type bridge")).unwrap();
        ip(&format!("addr add {here}/24 dev {bridge}")).unwrap();
        ip(&format!("link set {bridge} up")).unwrap();
        for area in AREAS {
            let (name, outside, address) = (all.name(area), all.name(area), all.address(area));
            ip(&format!("netns add {name}")).unwrap();
            ip(&format!("link add {outside} type veth peer name eth0 netns {name}")).unwrap();
            ip(&format!("link set {outside} master {bridge} up")).unwrap();
            ip(&format!("-n {name} addr add {address}/24 dev eth0")).unwrap();
            ip(&format!("-n {name} link set eth0 up")).unwrap();
            ip(&format!("-n {name} link set lo up")).unwrap();
        }
        all
    }

    /// The namespace of an area's node, which is also the name of its interface on this side.
    pub(crate) fn name(&self, area: &str) -> String {
        format!("{}{area}", self.tag)
    }

    /// Drops `per_cent` of the packets on the cable of each area's node, both ways, by nftables.
    pub(crate) fn lose(&self, per_cent: u8) {
        for area in AREAS {
            let name = self.name(area);
            lose(&["nft"], &name, &name, per_cent);
            lose(&["ip", "netns", "exec", &name, "nft"], "eth0", &name, per_cent);
        }
    }

    /// Makes TCP resend lost packets after 5 ms, both ways, as `docs/large-floors.md` describes.
    pub(crate) fn resend_soon(&self) {
        let net = format!("10.213.{}.0/24", self.net);
        let soon = "rto_min 5ms";
        ip(&format!("route change {net} dev {}b src {} {soon}", self.tag, self.here())).unwrap();
        for area in AREAS {
            let (name, address) = (self.name(area), self.address(area));
            ip(&format!("-n {name} route change {net} dev eth0 src {address} {soon}")).unwrap();
        }
    }

    /// Stops the packet loss.
    pub(crate) fn mend(&self) {
        for area in AREAS {
            let name = self.name(area);
            // The table exists only after a loss.
            let _ = Command::new("nft").args(["delete", "table", "netdev", &name]).output();
            let _ = ip(&format!("netns exec {name} nft delete table netdev {name}"));
        }
    }

    /// The address of the gateway and the boards.
    pub(crate) fn here(&self) -> Ipv4Addr {
        Ipv4Addr::new(10, 213, self.net, 1)
    }

    /// The address of an area's node.
    pub(crate) fn address(&self, area: &str) -> Ipv4Addr {
        let number = AREAS.iter().position(|one| *one == area).unwrap();
        Ipv4Addr::new(10, 213, self.net, 10 + number as u8)
    }
}

impl Drop for Namespaces {
    fn drop(&mut self) {
        self.mend();
        for area in AREAS {
            // Its interfaces, on both sides, are deleted with it.
            let _ = ip(&format!("netns del {}", self.name(area)));
        }
        let _ = ip(&format!("link del {}b", self.tag));
    }
}
