//! `underfoot setup --window`: the window, and the thread of its steps.

mod child;
mod worker;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::sync_channel;
use std::thread;

use triple_buffer::triple_buffer;
use underfoot_window::preview::{PreviewError, usual_state};
use underfoot_window::setup::{self, SetupBench, SetupChannels, SetupOptions, SetupView};

use self::worker::Worker;
use super::Args;
use crate::failure::Failure;
use crate::floor_args::load_floor;
use crate::preview::has_display;
use crate::stop::stop_flag;

/// Maximum number of orders that wait: more than a person gives while the tare is taken.
const ORDERS: usize = 64;

/// Opens the window, and runs its steps on a thread of their own until it is closed.
pub(super) fn run(args: &Args) -> Result<(), Failure> {
    if !has_display() {
        return Err(no_window("there is no display"));
    }
    let floor = if args.floor.exists() { Some(load_floor(&args.floor, &|_| None)?) } else { None };
    let (views, shown) = triple_buffer(&SetupView::default());
    let (orders, asked) = sync_channel(ORDERS);
    let (stop, is_over) = (stop_flag()?, Arc::<AtomicBool>::default());
    let options = SetupOptions {
        file: args.floor.display().to_string(),
        listen: args.listen.to_string(),
        is_local: args.listen.ip().is_loopback(),
        settings: Some(usual_state().join("window")),
    };
    let worker = Worker::new(args.clone(), SetupBench::new(floor), (views, asked), Arc::clone(&is_over));
    let steps = thread::Builder::new().name("set-up".into()).spawn(move || worker.run(&stop));
    let steps = steps.map_err(|error| Failure::Other(format!("no thread for the steps: {error}")))?;
    let shown = setup::run(SetupChannels { views: shown, orders }, &options);
    is_over.store(true, Ordering::Relaxed);
    if steps.join().is_err() {
        return Err(Failure::Other("the steps of the set-up failed; please report it".into()));
    }
    if args.floor.exists() {
        outln!("The floor is in {}.", args.floor.display());
    }
    shown.map_err(|PreviewError::NoWindow(reason)| no_window(&reason))
}

fn no_window(reason: &str) -> Failure {
    Failure::Other(format!(
        "no window can be opened: {reason}; leave out --window, and the terminal asks instead"
    ))
}
