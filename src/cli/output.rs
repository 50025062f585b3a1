//! What the program says: results on standard output, everything else on standard error.
//!
//! Either may be closed, on a full disk, or read by nobody. The work goes on then, and the exit status says that
//! something was lost. Standard error is written by a thread of its own, so that a reader that stalls holds up
//! neither sensing nor anything else that logs.

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
    () => { $crate::cli::output::print(format_args!("\n")) };
    ($($text:tt)*) => { $crate::cli::output::print(format_args!("{}\n", format_args!($($text)*))) };
}

/// Prints on standard output.
macro_rules! out {
    ($($text:tt)*) => { $crate::cli::output::print(format_args!($($text)*)) };
}

/// Says a line on standard error.
macro_rules! errln {
    () => { $crate::cli::output::say(format_args!("\n")) };
    ($($text:tt)*) => { $crate::cli::output::say(format_args!("{}\n", format_args!($($text)*))) };
}

/// Says something on standard error.
macro_rules! err {
    ($($text:tt)*) => { $crate::cli::output::say(format_args!($($text)*)) };
}

/// Texts that may wait for the reader of standard error.
const WAITING: usize = 1024;

/// How long a command waits for that reader; the log does not wait.
const PATIENCE: Duration = Duration::from_secs(2);

/// Whether something was lost that the exit status must tell of.
static LOST: AtomicBool = AtomicBool::new(false);

/// Texts that were left out of standard error because its reader was too slow.
static LEFT_OUT: AtomicU64 = AtomicU64::new(0);

/// The first failure of standard output.
static FAILED: OnceLock<io::Error> = OnceLock::new();

/// Warnings and errors that were logged.
static WARNINGS: AtomicU64 = AtomicU64::new(0);

/// What the thread that writes standard error is handed.
enum Job {
    Text(Vec<u8>),
    /// The line below all texts from now on; empty for none.
    Line(String),
    /// All before is written: say so.
    Flush(mpsc::Sender<()>),
}

/// Prints `text`; what cannot be written is noted for [`was_lost`].
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

/// Notes that standard output takes no more.
pub(crate) fn note_failure(error: io::Error) {
    LOST.store(true, Ordering::Relaxed);
    // Only the first one tells something.
    let _ = FAILED.set(error);
}

/// Says `text` on standard error, and waits for a slow reader, but not for ever.
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

/// Shows `line` below everything that is said, in place of the one before; for terminals only. One that does not fit
/// into the queue is left out: another comes soon.
pub(crate) fn show_line(line: String) {
    let _ = queue().try_send(Job::Line(line));
}

/// Warnings and errors logged so far.
pub(crate) fn warnings() -> u64 {
    WARNINGS.load(Ordering::Relaxed)
}

/// Whether somebody looks at standard error who sees colours; a file or a pipe gets none.
pub(crate) fn colours() -> bool {
    anstream::stderr().current_choice() != anstream::ColorChoice::Never
}

/// Brings everything to its end: whether nothing was lost. Says so of a disk; a reader that left knows.
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

/// What is written through it is a result: a failure is noted for the exit status.
pub(crate) struct Results<W>(pub(crate) W);

impl<W: Write> Write for Results<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes).inspect_err(|error| note_failure(copy(error)))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush().inspect_err(|error| note_failure(copy(error)))
    }
}

/// The same error once more.
fn copy(error: &io::Error) -> io::Error {
    error.raw_os_error().map_or_else(|| error.kind().into(), io::Error::from_raw_os_error)
}

/// Takes what is logged; never waits and never fails.
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

/// The way to the thread that writes standard error, which is started when something is first said.
fn queue() -> &'static SyncSender<Job> {
    static QUEUE: OnceLock<SyncSender<Job>> = OnceLock::new();
    QUEUE.get_or_init(|| {
        let (jobs, waiting) = sync_channel(WAITING);
        if thread::Builder::new().name("standard error".into()).spawn(move || write_all(&waiting)).is_err() {
            // Without a thread nobody takes what is said; that much the exit status tells.
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
                // Who asked may have lost patience.
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

/// Draws `line` in the terminal's last line, over what is there. The terminal cuts what is too long for it: wrapped, it
/// could not be taken away again.
fn draw(line: &str) {
    let text =
        if line.is_empty() { "\r\x1b[K".to_owned() } else { format!("\r\x1b[K\x1b[?7l{line}\x1b[?7h") };
    let mut err = io::stderr().lock();
    if err.write_all(text.as_bytes()).and_then(|()| err.flush()).is_err() {
        LOST.store(true, Ordering::Relaxed);
    }
}
