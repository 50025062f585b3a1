//! A virtual X display for tests.

use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Stdio};

/// A server of its own, which ends with this value.
pub(crate) struct Xvfb {
    server: Child,
    /// The name of its display, for the variable `DISPLAY`.
    pub(crate) display: String,
}

impl Xvfb {
    /// Starts a server with a screen such as `640x480x24`; `None`, with the reason printed, if there is no Xvfb.
    pub(crate) fn open(screen: &str) -> Option<Self> {
        let server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", screen, "+extension", "GLX", "-nolisten", "tcp"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .inspect_err(|error| println!("not run: there is no Xvfb (Debian: xvfb): {error}"))
            .ok()?;
        let mut own = Self { server, display: String::new() };
        let mut number = String::new();
        BufReader::new(own.server.stdout.take().unwrap()).read_line(&mut number).unwrap();
        assert!(!number.trim().is_empty(), "Xvfb has no free display");
        own.display = format!(":{}", number.trim());
        Some(own)
    }
}

impl Drop for Xvfb {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}
