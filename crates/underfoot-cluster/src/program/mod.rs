//! What the program's commands share.

pub(crate) mod gateway;
pub(crate) mod node;
mod notices;
mod sound;
mod stepped;

use std::hash::{BuildHasher, Hasher, RandomState};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;
use thiserror::Error;
use underfoot::runtime::StartError;
use underfoot::schema::Diagnostics;
use underfoot::sink::SinkError;
use underfoot::source::SourceError;
use underfoot_cluster::gateway::NoGateway;
use underfoot_cluster::transport::TransportError;

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
