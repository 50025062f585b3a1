//! Progress of long work, and its remaining time: a line on a terminal, nothing in a pipe.

use std::fmt;
use std::io::IsTerminal;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Work of equal parts; removes its line when dropped.
///
/// The thread that writes standard error also writes the line, so that a stalled terminal delays no work.
pub(crate) struct ProgressLine {
    /// One part of the work, such as "person".
    part: &'static str,
    parts: u64,
    done: AtomicU64,
    begun: Instant,
    is_shown: bool,
}

impl ProgressLine {
    /// Begins work of this many parts.
    pub(crate) fn of(part: &'static str, parts: u64) -> Self {
        let is_shown = std::io::stderr().is_terminal();
        let progress = Self { part, parts, done: AtomicU64::new(0), begun: Instant::now(), is_shown };
        progress.show(0);
        progress
    }

    /// Counts one more finished part.
    pub(crate) fn advance(&self) {
        self.show(self.done.fetch_add(1, Ordering::Relaxed) + 1);
    }

    /// Prints `rows` on standard output, with an empty line behind them; the next finished part shows the line again.
    pub(crate) fn print(&self, rows: &impl fmt::Display) {
        self.hide();
        outln!("{rows}");
    }

    fn hide(&self) {
        if self.is_shown {
            // Overwrites the line, so that the next output begins on a clean line.
            err!("\r{:60}\r", "");
        }
    }

    fn show(&self, done: u64) {
        if self.is_shown {
            err!(
                "\r{:60}\r{} {done} of {}{}",
                "",
                self.part,
                self.parts,
                self.left(self.begun.elapsed(), done)
            );
        }
    }

    /// The time for the remaining parts if they take as long as the ones before.
    fn left(&self, elapsed: Duration, done: u64) -> Left {
        if done == 0 {
            return Left(None);
        }
        Left(Some(elapsed.mul_f64(self.parts.saturating_sub(done) as f64 / done as f64)))
    }
}

impl Drop for ProgressLine {
    fn drop(&mut self) {
        self.hide();
    }
}

/// A remaining time in a short form; empty while it is unknown.
struct Left(Option<Duration>);

impl fmt::Display for Left {
    fn fmt(&self, text: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(left) = self.0 else { return Ok(()) };
        let seconds = left.as_secs_f64().ceil() as u64;
        match (seconds / 3600, seconds / 60 % 60, seconds % 60) {
            (0, 0, seconds) => write!(text, ", {seconds} s left"),
            (0, minutes, seconds) => write!(text, ", {minutes} min {seconds:02} s left"),
            (hours, minutes, _) => write!(text, ", {hours} h {minutes:02} min left"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_follows_from_what_is_done() {
        let progress = ProgressLine::of("person", 100);
        let left = |elapsed_s, done| progress.left(Duration::from_secs(elapsed_s), done).to_string();
        assert_eq!(left(5, 0), "");
        assert_eq!(left(5, 50), ", 5 s left");
        assert_eq!(left(60, 20), ", 4 min 00 s left");
        assert_eq!(left(7200, 40), ", 3 h 00 min left");
        // Never negative, for any count.
        assert_eq!(left(60, 200), ", 0 s left");
    }
}
