//! `underfoot guardian`: the process that releases what a server holds down.

use std::io::{self, BufReader};

use underfoot_io::targets;

use super::failure::Failure;

/// Guards the server at the other ends of standard input and output until it ends.
pub(crate) fn run() -> Result<(), Failure> {
    let failed = |error: io::Error| Failure::Other(format!("nothing can be guarded: {error}"));
    outlive_the_server().map_err(failed)?;
    targets::guard(BufReader::new(io::stdin()), io::stdout()).map_err(failed)
}

/// A service manager ends all processes of a service at once; the guardian ends after its server.
#[cfg(unix)]
fn outlive_the_server() -> io::Result<()> {
    use std::sync::Arc;
    use std::sync::atomic::AtomicBool;

    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};

    let noticed = Arc::<AtomicBool>::default();
    for signal in [SIGINT, SIGTERM, SIGHUP] {
        signal_hook::flag::register(signal, Arc::clone(&noticed))?;
    }
    Ok(())
}

#[cfg(not(unix))]
fn outlive_the_server() -> io::Result<()> {
    Ok(())
}
