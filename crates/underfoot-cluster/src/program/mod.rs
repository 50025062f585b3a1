//! Code that the program's commands share.

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

use signal_hook::consts::{SIGINT, SIGTERM};
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

/// The reason why a command failed, in words for the operator.
#[derive(Debug, Error)]
pub(crate) enum ClusterFailure {
    /// A project file has errors.
    #[error("{0}")]
    Diagnostics(#[from] Diagnostics),
    /// The source of packets failed.
    #[error(transparent)]
    Source(#[from] SourceError),
    /// An output failed.
    #[error(transparent)]
    Sink(#[from] SinkError),
    /// The node can't start.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The transport to the other end failed.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// The floor has no areas.
    #[error(transparent)]
    NoGateway(#[from] NoGateway),
    /// The floor's key is missing or not private.
    #[error(transparent)]
    Key(#[from] KeyError),
    /// The floor file names no key, and the floor is not on one computer.
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
    /// Any other reason, as a full sentence.
    #[error("{0}")]
    Other(String),
}

/// The endpoints on which the gateway listens: `asked`, else that of the floor file, else the default.
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

/// Signals that end a command: those of a terminal and of a service manager, and of a closed terminal where there is one.
const ENDS: &[i32] = &[
    SIGINT,
    SIGTERM,
    #[cfg(unix)]
    signal_hook::consts::SIGHUP,
];

/// A flag set by each of [`ENDS`], or the end of `span`.
fn stop_flag(span: Option<f64>) -> Result<Arc<AtomicBool>, ClusterFailure> {
    let stop = Arc::new(AtomicBool::new(false));
    for &signal in ENDS {
        flag::register(signal, Arc::clone(&stop))
            .map_err(|error| ClusterFailure::Other(format!("signals can't be handled: {error}")))?;
    }
    if let Some(span) = span {
        let span = Duration::try_from_secs_f64(span)
            .map_err(|error| ClusterFailure::Other(format!("--seconds {span}: {error}")))?;
        let stop = Arc::clone(&stop);
        thread::spawn(move || {
            thread::sleep(span);
            stop.store(true, Ordering::Relaxed);
        });
    }
    Ok(stop)
}
