//! Tests whose programs keep time on one machine, which must not stand still meanwhile.
//!
//! It stands still where a host takes a processor from its guest, and where threads of real-time priority take all
//! processors: Linux leaves other threads 50 ms of each second then.

use std::fs::OpenOptions;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// Whether a program of the present test has reported that the machine is too slow for it.
static OVERLOADED: AtomicBool = AtomicBool::new(false);

/// Notes that a thread of a program under test gave up its real-time priority: it took a whole processor.
pub(crate) fn note_overload() {
    OVERLOADED.store(true, Ordering::Relaxed);
}

/// Keeps the calling thread on processor `number`, so that it sees what is taken from that one; elsewhere than on
/// Linux a thread runs wherever there is time.
fn stay_on(number: usize) {
    #[cfg(target_os = "linux")]
    {
        use nix::sched::{CpuSet, sched_setaffinity};
        use nix::unistd::Pid;
        let mut only = CpuSet::new();
        // A processor that is not for this process is watched by a thread on any other.
        let _ = only.set(number).and_then(|()| sched_setaffinity(Pid::from_raw(0), &only));
    }
    #[cfg(not(target_os = "linux"))]
    let _ = number;
}

/// Longest time (ms) for which a thread that sleeps for 1 ms at a time was kept from a processor until `is_over`.
fn stood_still_ms(is_over: &AtomicBool) -> u64 {
    let (mut last, mut longest) = (Instant::now(), Duration::ZERO);
    while !is_over.load(Ordering::Relaxed) {
        thread::sleep(Duration::from_millis(1));
        longest = longest.max(last.elapsed());
        last = Instant::now();
    }
    longest.as_millis() as u64
}

/// Longest time (ms) for which any processor did not run this process while `work` ran.
fn longest_stand_still_ms(work: impl FnOnce()) -> u64 {
    let is_over = &AtomicBool::new(false);
    thread::scope(|scope| {
        let processors = thread::available_parallelism().map_or(1, usize::from);
        let watches = (0..processors).map(|number| {
            scope.spawn(move || {
                stay_on(number);
                stood_still_ms(is_over)
            })
        });
        let watches: Vec<_> = watches.collect();
        work();
        is_over.store(true, Ordering::Relaxed);
        watches.into_iter().map(|watch| watch.join().unwrap()).max().unwrap_or(0)
    })
}

/// Runs a test that fails where the machine takes time from one of its programs. If it fails, and meanwhile a processor
/// stood still for `stands_still_ms` or longer or a program was too slow for the machine ([`note_overload`]), it runs
/// again; after three times there is no result, and a file says so, which `./dev test` prints.
///
/// # Panics
///
/// If it fails although the machine kept time.
pub(crate) fn while_time_is_kept(stands_still_ms: u64, test: impl Fn()) {
    let mut reason = String::new();
    for _ in 0..3 {
        OVERLOADED.store(false, Ordering::Relaxed);
        let mut result = Ok(());
        let longest = longest_stand_still_ms(|| result = catch_unwind(AssertUnwindSafe(&test)));
        let Err(failure) = result else { return };
        let is_overloaded = OVERLOADED.load(Ordering::Relaxed);
        if longest < stands_still_ms && !is_overloaded {
            eprintln!("the machine kept time: it stood still for {longest} ms at most");
            resume_unwind(failure);
        }
        let slow = if is_overloaded { " and was too slow for a program" } else { "" };
        reason = format!("the machine stood still for {longest} ms{slow}");
        eprintln!("{reason}");
    }
    let name = thread::current().name().unwrap_or("a test").to_owned();
    let list = Path::new(env!("CARGO_TARGET_TMPDIR")).join("without_result");
    let mut list = OpenOptions::new().create(true).append(true).open(list).unwrap();
    writeln!(list, "{name}: {reason}, at the last of three tries").unwrap();
}
