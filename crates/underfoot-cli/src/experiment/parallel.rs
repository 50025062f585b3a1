//! Work of equal parts on all processors.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use underfoot_lab::experiment::ExperimentError;

use crate::failure::Failure;
use crate::progress::ProgressLine;

/// A table of all parts, each added by `add` to a table of its own and then appended.
///
/// It grows in the order of the parts, not of their completion: the same seed gives the same table.
pub(super) fn gathered<T: Send>(
    progress: &ProgressLine,
    parts: u64,
    empty: impl Fn() -> T + Sync,
    add: impl Fn(&mut T, u64) -> Result<(), ExperimentError> + Sync,
    append: impl Fn(&mut T, T),
) -> Result<T, Failure> {
    let mut table = empty();
    for part in in_parallel(progress, parts, |number| {
        let mut part = empty();
        add(&mut part, number)?;
        Ok(part)
    })? {
        append(&mut table, part);
    }
    Ok(table)
}

/// Calls `act` `times` times on all processors, and counts each call in `progress`; returns the results in order.
fn in_parallel<T: Send>(
    progress: &ProgressLine,
    times: u64,
    act: impl Fn(u64) -> Result<T, ExperimentError> + Sync,
) -> Result<Vec<T>, Failure> {
    let next = AtomicU64::new(0);
    let done = Mutex::new(Vec::new());
    let workers = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= times {
                        break;
                    }
                    let result = act(number);
                    let failed = result.is_err();
                    let Ok(mut done) = done.lock() else { break };
                    done.push((number, result));
                    progress.advance();
                    if failed {
                        next.store(times, Ordering::Relaxed);
                    }
                }
            });
        }
    });
    let mut done = done.into_inner().map_err(|_| Failure::Other("a thread of the experiment died".into()))?;
    done.sort_by_key(|(number, _)| *number);
    Ok(done.into_iter().map(|(_, result)| result).collect::<Result<_, _>>()?)
}
