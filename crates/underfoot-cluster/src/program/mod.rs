//! What the program's commands share.

pub(crate) mod gateway;
pub(crate) mod key;
mod layout;
mod neighbourhood;
pub(crate) mod node;
mod notices;
mod refused;
mod slowed;
mod sound;
mod stepped;
mod teller;
mod worker;

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
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
use underfoot_cluster::auth::KeyError;
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
    /// The floor's key is missing or not private.
    #[error(transparent)]
    Key(#[from] KeyError),
    /// The floor names no key, and is not on one computer.
    #[error(
        "{far} may be on another computer, and the computers of a floor identify each other by a key: \
         `underfoot-cluster key {}` makes one; copy it to all of them, and write `key: \"{}\"` into {}",
        floor.with_extension("key").display(),
        floor.with_extension("key").file_name().unwrap_or_default().display(),
        floor.display()
    )]
    NoKey {
        /// The address.
        far: String,
        /// The floor file.
        floor: PathBuf,
    },
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

/// The content of `mutex`, also after a panic of another thread.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
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
