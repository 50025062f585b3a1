//! What the program's commands share.

pub(crate) mod gateway;
mod layout;
pub(crate) mod node;
mod notices;
mod slowed;
mod sound;
mod stepped;
mod worker;

use std::hash::{BuildHasher, Hasher, RandomState};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;
use thiserror::Error;
use underfoot::floor::Floor;
use underfoot::runtime::StartError;
use underfoot::schema::Diagnostics;
use underfoot::sink::SinkError;
use underfoot::source::SourceError;
use underfoot_cluster::gateway::NoGateway;
use underfoot_cluster::transport::{ENDPOINT, TransportError};

/// Why a command failed, in words for the person who gave it.
#[derive(Debug, Error)]
pub(crate) enum Failure {
    /// A file of ours has problems.
    #[error("{0}")]
    Diagnostics(#[from] Diagnostics),
    /// The packets' source failed.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// Events can't be put out.
    #[error(transparent)]
    Sink(#[from] SinkError),
    /// The node can't start.
    #[error(transparent)]
    Start(#[from] StartError),
    /// There is no way to the other end.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// The floor has no areas.
    #[error(transparent)]
    NoGateway(#[from] NoGateway),
    /// Anything else, said in full.
    #[error("{0}")]
    Other(String),
}

/// Where the gateway listens: as was `asked`, else as the floor file says, else where it usually does.
fn endpoints(asked: Vec<String>, floor: &Floor) -> Vec<String> {
    if !asked.is_empty() {
        return asked;
    }
    vec![floor.gateway.map_or_else(|| ENDPOINT.to_owned(), |gateway| format!("tcp/{gateway}"))]
}

/// A flag that Ctrl-C, a polite kill, a terminal that is closed, and the end of `span` set.
fn stop_flag(span: Option<f64>) -> Result<Arc<AtomicBool>, Failure> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM, SIGHUP] {
        flag::register(signal, Arc::clone(&stop))
            .map_err(|error| Failure::Other(format!("signals can't be handled: {error}")))?;
    }
    if let Some(span) = span {
        let span = Duration::try_from_secs_f64(span)
            .map_err(|error| Failure::Other(format!("--seconds {span}: {error}")))?;
        let stop = Arc::clone(&stop);
        thread::spawn(move || {
            thread::sleep(span);
            stop.store(true, Ordering::Relaxed);
        });
    }
    Ok(stop)
}

/// A number that no other program has drawn, in all likelihood: the standard library's hash keys are random.
fn drawn() -> u64 {
    let mut hasher = RandomState::new().build_hasher();
    hasher.write_u32(std::process::id());
    hasher.finish()
}
