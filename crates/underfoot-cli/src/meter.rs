//! Speed measurements of standard loads.

use std::num::NonZeroUsize;
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use underfoot_lab::capacity::SocketLoad;

use super::failure::Failure;
use super::progress::ProgressLine;

/// The measured speed of one load.
pub(super) struct Measured {
    pub(super) id: &'static str,
    pub(super) name: String,
    /// Seconds of floor per second of work.
    pub(super) times_real_time: f64,
}

/// The way in which loads are measured.
pub(super) struct Meter {
    length: Duration,
    threads: NonZeroUsize,
    progress: ProgressLine,
}

impl Meter {
    /// Measures each of `loads` loads for `length`, on this many threads at once.
    pub(super) fn new(length: Duration, threads: NonZeroUsize, loads: u64) -> Self {
        Self { length, threads, progress: ProgressLine::of("load", loads) }
    }

    /// Seconds of floor per second of work, summed over all threads, each with a load of its own.
    pub(super) fn measure<Load: FnMut()>(
        &self,
        id: &'static str,
        name: String,
        load: impl Fn() -> Load + Sync,
    ) -> Measured {
        let times_real_time = self.together(|| factor(self.length, load()));
        self.progress.advance();
        Measured { id, name, times_real_time }
    }

    /// The same for the packets of 96 x 96 tiles over this machine's own network, from the socket to their readings.
    ///
    /// # Errors
    /// [`Failure`] if there is no port, or no packet arrives.
    pub(super) fn measure_sockets(&self, id: &'static str, name: String) -> Result<Measured, Failure> {
        let loads: Result<Vec<_>, _> = (0..self.threads.get()).map(|_| SocketLoad::new()).collect();
        let loads = Mutex::new(loads?);
        let times_real_time = self.together(|| {
            let load = loads.lock().unwrap_or_else(PoisonError::into_inner).pop();
            load.and_then(|load| socket_factor(self.length, load)).unwrap_or(0.0)
        });
        self.progress.advance();
        if times_real_time > 0.0 {
            return Ok(Measured { id, name, times_real_time });
        }
        Err(Failure::Other("packets to this machine itself are lost, so nothing can be measured".into()))
    }

    /// Runs `work` on all threads at the same time, and adds up the results.
    fn together(&self, work: impl Fn() -> f64 + Sync) -> f64 {
        thread::scope(|scope| {
            let others: Vec<_> = (1..self.threads.get()).map(|_| scope.spawn(&work)).collect();
            let own = work();
            // A thread that panicked counts as zero.
            own + others.into_iter().map(|other| other.join().unwrap_or(0.0)).sum::<f64>()
        })
    }
}

/// Seconds of floor per second of work: the median of as many runs as fit into `length`, at least three.
fn factor(length: Duration, mut second: impl FnMut()) -> f64 {
    // Tables, caches and the processor's clock warm up first.
    second();
    let mut factors = Vec::new();
    let begun = Instant::now();
    while factors.len() < 3 || begun.elapsed() < length {
        let start = Instant::now();
        second();
        factors.push(start.elapsed().as_secs_f64().recip());
    }
    factors.sort_unstable_by(f64::total_cmp);
    factors[factors.len() / 2]
}

/// The same for packets through a socket, as the median of many batches; `None` if it fails or loses nearly all.
fn socket_factor(length: Duration, mut load: SocketLoad) -> Option<f64> {
    let mut factors = Vec::new();
    let begun = Instant::now();
    while factors.len() < 3 || begun.elapsed() < length {
        load.send();
        let start = Instant::now();
        let packets = load.take().ok()?;
        // A batch with losses does not count, since its time includes a time-out.
        if packets == SocketLoad::BATCH {
            factors.push(packets as f64 / SocketLoad::PACKETS_PER_S / start.elapsed().as_secs_f64());
        } else if factors.is_empty() && begun.elapsed() > 10 * length.max(Duration::from_secs(1)) {
            return None;
        }
    }
    factors.sort_unstable_by(f64::total_cmp);
    Some(factors[factors.len() / 2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packets_come_through_a_socket_on_each_thread() {
        let meter = Meter::new(Duration::from_millis(1), NonZeroUsize::new(2).unwrap(), 1);
        let measured = meter.measure_sockets("packets", "packets".to_owned()).unwrap();
        assert!(measured.times_real_time > 0.0);
    }

    #[test]
    fn threads_add_up() {
        let meter = Meter::new(Duration::ZERO, NonZeroUsize::new(3).unwrap(), 1);
        assert!((meter.together(|| 2.0) - 6.0).abs() < 1e-9);
    }
}
