//! The floor's key: `underfoot-cluster key` makes it, nodes and gateways find it.

use std::net::{IpAddr, SocketAddr};
use std::path::{Path, PathBuf};

use underfoot::floor::Floor;
use underfoot_cluster::auth::{AuthSession, Key, KeyError, Role};

use super::ClusterFailure;

/// Options for making a key.
#[derive(clap::Args, Debug)]
pub(crate) struct Args {
    /// The file to write, which must not exist.
    #[arg(value_name = "FILE")]
    file: PathBuf,
}

/// Makes a key.
pub(crate) fn run(args: &Args) -> Result<(), ClusterFailure> {
    Key::make(&args.file)?;
    let file = args.file.display();
    println!(
        "{file} holds a new key. Copy it to every computer of the floor, and name it in the floor file: `key`."
    );
    Ok(())
}

/// The key of a node or gateway.
#[derive(clap::Args, Clone, Debug)]
pub(super) struct KeyArgs {
    /// The file with the floor's key, in place of the one that the floor file names. `underfoot-cluster key FILE`
    /// makes one.
    #[arg(long, value_name = "FILE")]
    key: Option<PathBuf>,
}

impl KeyArgs {
    /// The key of `floor`, whose file is at `path`, for a program that connects these `endpoints` and receives
    /// packets at `listens`; with a notice if it has just been made.
    ///
    /// A floor without a key that lies on this computer alone gets one beside its file at its first start, which
    /// excludes other users of the computer.
    pub(super) fn find(
        &self,
        (floor, path): (&Floor, &Path),
        endpoints: &[String],
        listens: impl IntoIterator<Item = SocketAddr>,
    ) -> Result<(Key, Option<String>), ClusterFailure> {
        let folder = path.parent().unwrap_or(Path::new(""));
        if let Some(named) = self.key.clone().or_else(|| floor.key.as_ref().map(|key| folder.join(key))) {
            return Ok((Key::read(&named)?, None));
        }
        let far = endpoints.iter().find(|endpoint| !is_here(endpoint)).cloned().or_else(|| {
            let mut listens = listens.into_iter().chain(floor.areas.iter().filter_map(|area| area.listen));
            listens.find(|listen| !listen.ip().is_loopback()).map(|listen| listen.to_string())
        });
        if let Some(far) = far {
            return Err(ClusterFailure::NoKey { far, floor: path.to_owned() });
        }
        let beside = path.with_extension("key");
        match Key::make(&beside) {
            Ok(key) => Ok((key, Some(format!("Made a key for this floor: {}.", beside.display())))),
            Err(KeyError::Exists { .. }) => Ok((Key::read(&beside)?, None)),
            Err(error) => Err(error.into()),
        }
    }
}

/// A session with a nonce of its own.
pub(super) fn session(role: Role, key: &Key, most_peers: usize) -> Result<AuthSession, ClusterFailure> {
    let nonce = getrandom::u64().map_err(KeyError::Random)?;
    Ok(AuthSession::new(role, key, nonce, most_peers))
}

/// Whether an endpoint of Zenoh is certainly on this computer.
fn is_here(endpoint: &str) -> bool {
    let address = endpoint.split_once('/').map_or("", |(_, address)| address);
    // Settings of the endpoint may follow.
    let address = address.split(['?', '#']).next().unwrap_or_default();
    let host = address.rsplit_once(':').map_or(address, |(host, _)| host);
    let ip: Option<IpAddr> = host.trim_matches(['[', ']']).parse().ok();
    host == "localhost" || ip.is_some_and(|ip| ip.is_loopback())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_endpoint_is_here_if_its_address_is() {
        for here in ["tcp/127.0.0.1:7447", "tcp/localhost:7447", "tcp/[::1]:7447", "tcp/127.0.0.9:1#iface=lo"]
        {
            assert!(is_here(here), "{here}");
        }
        for far in
            ["tcp/192.168.1.5:7447", "tcp/0.0.0.0:7447", "tcp/[::]:7447", "tcp/hall:7447", "somewhere", ""]
        {
            assert!(!is_here(far), "{far}");
        }
    }
}
