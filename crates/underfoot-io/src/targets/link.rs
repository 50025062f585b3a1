//! The messages between server and guardian: lines of JSON on a pipe in each direction.

use std::io::{self, BufRead, Write};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use underfoot::messages::{Act, Holdable, SendTarget};

/// Maximum length of one line, in bytes: a plan of a layout with thousands of controls.
const LONGEST: u64 = 4 << 20;

/// From the server.
#[derive(Debug, Deserialize, Serialize)]
pub(super) enum ToGuardian {
    /// The targets, everything that messages can hold down there, which is released first, and the states that last there.
    Setup(Vec<SendTarget>, Vec<(usize, Holdable)>, Vec<(usize, Act)>),
    /// An order for the target with this index.
    Act(usize, Act),
    /// The server works; the guardian answers with the same number.
    Beat(u64),
    /// Let everything come up.
    Release,
    /// These ports received from the target with this index of an earlier guardian.
    Connect(usize, Vec<String>),
}

/// From the guardian.
#[derive(Debug, Deserialize, Serialize)]
pub(super) enum FromGuardian {
    /// The guardian works.
    Beat(u64),
    /// A line for people.
    Notice(String),
    /// Orders that were not carried out since the last such message.
    Undone(u64),
    /// These ports receive from the target with this index.
    Receivers(usize, Vec<String>),
}

/// Writes one message.
///
/// # Errors
/// The other side has ended.
pub(super) fn put(to: &mut impl Write, message: &impl Serialize) -> io::Result<()> {
    let mut line = serde_json::to_vec(message)?;
    line.push(b'\n');
    to.write_all(&line)?;
    to.flush()
}

/// Reads the next message; `None` at the end, and for a line that is no message: the two sides are one program.
pub(super) fn next<T: DeserializeOwned>(from: &mut impl BufRead) -> Option<T> {
    let mut line = Vec::new();
    let read = io::Read::take(&mut *from, LONGEST).read_until(b'\n', &mut line).ok()?;
    if read == 0 || line.last() != Some(&b'\n') {
        return None;
    }
    serde_json::from_slice(&line).ok()
}
