//! Output of the program: results on standard output, everything else on standard error.
//!
//! Either stream may be closed, on a full disk, or without a reader. The work then continues, and the exit status
//! reports the loss. A thread of its own writes standard error, so that a stalled reader blocks neither sensing nor
//! any other code that logs.

use std::fmt;
use std::io::{self, ErrorKind, Write};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::sync::{OnceLock, mpsc};
use std::thread;
use std::time::{Duration, Instant};

use serde::Serialize;
use tracing::{Level, Metadata};
use tracing_subscriber::fmt::MakeWriter;

use super::failure::Failure;

/// Prints a line on standard output.
macro_rules! outln {
    () => { $crate::output::print(format_args!("\n")) };
    ($($text:tt)*) => { $crate::output::print(format_args!("{}\n", format_args!($($text)*))) };
}

/// Prints on standard output.
macro_rules! out {
    ($($text:tt)*) => { $crate::output::print(format_args!($($text)*)) };
}

/// Prints a line on standard error.
macro_rules! errln {
    () => { $crate::output::say(format_args!("\n")) };
    ($($text:tt)*) => { $crate::output::say(format_args!("{}\n", format_args!($($text)*))) };
}

/// Prints on standard error.
macro_rules! err {
    ($($text:tt)*) => { $crate::output::say(format_args!($($text)*)) };
}

/// Maximum number of texts that wait for the reader of standard error.
const WAITING: usize = 1024;

/// Maximum time for which a command waits for that reader; the log does not wait.
const PATIENCE: Duration = Duration::from_secs(2);

/// Whether output was lost, which the exit status must report.
static LOST: AtomicBool = AtomicBool::new(false);

/// Number of texts dropped from standard error because its reader was too slow.
static LEFT_OUT: AtomicU64 = AtomicU64::new(0);

/// The first failure of standard output.
static FAILED: OnceLock<io::Error> = OnceLock::new();

/// Number of logged warnings and errors.
static WARNINGS: AtomicU64 = AtomicU64::new(0);

/// Input of the thread that writes standard error.
enum Job {
    Text(Vec<u8>),
    /// The status line below all texts from now on; empty for none.
    Line(String),
    /// Requests a message as soon as everything before is written.
    Flush(mpsc::Sender<()>),
}

/// Prints `text`; notes a failure for the exit status.
pub(crate) fn print(text: fmt::Arguments<'_>) {
    let mut out = anstream::stdout().lock();
    if let Err(error) = out.write_all(text.to_string().as_bytes()) {
        note_failure(error);
    }
}

/// Prints `value` as a line of JSON.
pub(crate) fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    let json = serde_json::to_string(value).map_err(|error| Failure::Other(error.to_string()))?;
    outln!("{json}");
    Ok(())
}

/// Notes a failure of standard output.
pub(crate) fn note_failure(error: io::Error) {
    LOST.store(true, Ordering::Relaxed);
    // Only the first failure is informative.
    let _ = FAILED.set(error);
}

/// Prints `text` on standard error, and waits for a slow reader up to the time-out.
pub(crate) fn say(text: fmt::Arguments<'_>) {
    let mut job = Job::Text(text.to_string().into_bytes());
    let until = Instant::now() + PATIENCE;
    while let Err(TrySendError::Full(back)) = queue().try_send(job) {
        if Instant::now() >= until {
            LEFT_OUT.fetch_add(1, Ordering::Relaxed);
            return;
        }
        job = back;
        thread::sleep(Duration::from_millis(1));
    }
}

/// Shows `line` below all other output, in place of the one before; for terminals only. Drops a line that does not
/// fit into the queue: another comes soon.
pub(crate) fn show_line(line: String) {
    let _ = queue().try_send(Job::Line(line));
}

/// Warnings and errors logged so far.
pub(crate) fn warnings() -> u64 {
    WARNINGS.load(Ordering::Relaxed)
}

/// Whether standard error shows colours; a file or a pipe gets none.
pub(crate) fn colours() -> bool {
    anstream::stderr().current_choice() != anstream::ColorChoice::Never
}

/// Completes all output; returns whether it is complete. Reports a full disk, but not a reader that has gone.
pub(crate) fn finish() -> bool {
    if let Err(error) = io::stdout().flush() {
        note_failure(error);
    }
    if let Some(error) = FAILED.get().filter(|error| error.kind() != ErrorKind::BrokenPipe) {
        say(format_args!("error: the output is not complete: {error}\n"));
    }
    let (done, written) = mpsc::channel();
    let is_written = queue().try_send(Job::Flush(done)).is_ok() && written.recv_timeout(PATIENCE).is_ok();
    is_written && !LOST.load(Ordering::Relaxed) && LEFT_OUT.load(Ordering::Relaxed) == 0
}

/// A writer for results: it notes a failure for the exit status.
pub(crate) struct Results<W>(pub(crate) W);

impl<W: Write> Write for Results<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes).inspect_err(|error| note_failure(copy(error)))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush().inspect_err(|error| note_failure(copy(error)))
    }
}

/// A copy of the error.
fn copy(error: &io::Error) -> io::Error {
    error.raw_os_error().map_or_else(|| error.kind().into(), io::Error::from_raw_os_error)
}

/// The writer of the log; never waits and never fails.
pub(crate) struct Log;

impl Write for Log {
    fn write(&mut self, text: &[u8]) -> io::Result<usize> {
        if let Err(TrySendError::Full(_)) = queue().try_send(Job::Text(text.to_vec())) {
            LEFT_OUT.fetch_add(1, Ordering::Relaxed);
        }
        Ok(text.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Makes a [`Log`] for each entry, and counts the warnings among them.
pub(crate) struct Logs;

impl MakeWriter<'_> for Logs {
    type Writer = Log;

    fn make_writer(&self) -> Log {
        Log
    }

    fn make_writer_for(&self, entry: &Metadata<'_>) -> Log {
        if *entry.level() <= Level::WARN {
            WARNINGS.fetch_add(1, Ordering::Relaxed);
        }
        Log
    }
}

/// The queue to the thread that writes standard error; the first call starts the thread.
fn queue() -> &'static SyncSender<Job> {
    static QUEUE: OnceLock<SyncSender<Job>> = OnceLock::new();
    QUEUE.get_or_init(|| {
        let (jobs, waiting) = sync_channel(WAITING);
        if thread::Builder::new().name("standard error".into()).spawn(move || write_all(&waiting)).is_err() {
            // Without a thread, messages are lost; only the exit status reports that.
            LOST.store(true, Ordering::Relaxed);
        }
        jobs
    })
}

fn write_all(jobs: &Receiver<Job>) {
    let (mut told, mut line) = (0, String::new());
    for job in jobs {
        let text = match job {
            Job::Text(text) => text,
            Job::Line(next) => {
                if next != line {
                    draw(&next);
                    line = next;
                }
                continue;
            }
            Job::Flush(done) => {
                // The caller may have stopped waiting.
                let _ = done.send(());
                continue;
            }
        };
        if !line.is_empty() {
            draw("");
        }
        let mut err = anstream::stderr().lock();
        let left_out = LEFT_OUT.load(Ordering::Relaxed);
        let missing = if left_out > told {
            format!("({} lines are missing here: standard error was read too slowly)\n", left_out - told)
        } else {
            String::new()
        };
        told = left_out;
        if err.write_all(missing.as_bytes()).and_then(|()| err.write_all(&text)).is_err() {
            LOST.store(true, Ordering::Relaxed);
        }
        drop(err);
        if !line.is_empty() {
            draw(&line);
        }
    }
}

/// Draws `line` in the terminal's last line, over the previous one. The terminal truncates a line that is too long: a
/// wrapped line could not be removed.
fn draw(line: &str) {
    let text =
        if line.is_empty() { "\r\x1b[K".to_owned() } else { format!("\r\x1b[K\x1b[?7l{line}\x1b[?7h") };
    let mut err = io::stderr().lock();
    if err.write_all(text.as_bytes()).and_then(|()| err.flush()).is_err() {
        LOST.store(true, Ordering::Relaxed);
    }
}
