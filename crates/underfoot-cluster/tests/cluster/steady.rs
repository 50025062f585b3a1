//! Six programs that keep time on one machine, which must not stand still meanwhile.
//!
//! It stands still for others while threads of real-time priority take all processors: Linux leaves other threads 50 ms
//! of each second then.

use std::fs::OpenOptions;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crate::hall::say;

/// Time (ms) for which a machine stands still if it may take the floor from a program, which takes 100 ms.
const STANDS_STILL_MS: u64 = 50;

/// Longest time (ms) for which this process was kept from running while `work` ran.
fn stood_still_ms(work: impl FnOnce()) -> u64 {
    let is_over = AtomicBool::new(false);
    thread::scope(|scope| {
        let watch = scope.spawn(|| {
            let (mut last, mut longest) = (Instant::now(), Duration::ZERO);
            while !is_over.load(Ordering::Relaxed) {
                thread::sleep(Duration::from_millis(1));
                longest = longest.max(last.elapsed());
                last = Instant::now();
            }
            longest.as_millis() as u64
        });
        work();
        is_over.store(true, Ordering::Relaxed);
        watch.join().unwrap()
    })
}

/// Runs a test that fails where the machine takes time from one of the programs. If it fails and the machine stood
/// still meanwhile, it runs again; after three times there is no result, and a file says so, which `./dev test` prints.
///
/// # Panics
///
/// If it fails although the machine kept time.
pub(crate) fn while_time_is_kept(test: impl Fn()) {
    for _ in 0..3 {
        let mut result = Ok(());
        let longest = stood_still_ms(|| result = catch_unwind(AssertUnwindSafe(&test)));
        match result {
            Ok(()) => return,
            Err(failure) if longest < STANDS_STILL_MS => resume_unwind(failure),
            Err(_) => say(&format!("the machine stood still for {longest} ms")),
        }
    }
    let name = thread::current().name().unwrap_or("a test").to_owned();
    let line =
        format!("{name}: the machine stood still for {STANDS_STILL_MS} ms and more at each of three tries");
    let list = Path::new(env!("CARGO_TARGET_TMPDIR")).join("without_result");
    let mut list = OpenOptions::new().create(true).append(true).open(list).unwrap();
    writeln!(list, "{line}").unwrap();
}
