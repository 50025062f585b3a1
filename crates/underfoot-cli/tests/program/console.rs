//! The operator's console in a terminal.
#![cfg(target_os = "linux")]

use std::io::Read;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use super::holds::site::{BoardFault, Boards, Site};

/// A program that runs in a terminal of its own.
struct Terminal {
    child: Child,
    bytes: Arc<Mutex<Vec<u8>>>,
}

impl Terminal {
    /// Runs `command` in `script`, which gives it a terminal and forwards the output; `None` without `script`.
    fn run(site: &Site, command: &str) -> Option<Self> {
        let spawned = Command::new("script")
            .args(["--quiet", "--flush", "--return", "--command", command, "/dev/null"])
            .current_dir(site.folder())
            .env("TERM", "xterm")
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("RUST_LOG")
            .env_remove("NO_COLOR")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        let Ok(mut child) = spawned else {
            println!("not run: there is no `script` here");
            return None;
        };
        let bytes = Arc::<Mutex<Vec<u8>>>::default();
        let (mut out, kept) = (child.stdout.take().unwrap(), Arc::clone(&bytes));
        std::thread::spawn(move || {
            let mut some = [0; 4096];
            while let Ok(length @ 1..) = out.read(&mut some) {
                kept.lock().unwrap().extend(&some[..length]);
            }
        });
        Some(Self { child, bytes })
    }

    /// Every line of output, including overwritten ones, without codes for the cursor and colours.
    fn lines(&self) -> Vec<String> {
        let text = String::from_utf8_lossy(&self.bytes.lock().unwrap()).into_owned();
        let mut plain = String::new();
        let mut rest = text.as_str();
        while let Some((before, after)) = rest.split_once('\u{1b}') {
            plain.push_str(before);
            let end = after.find(|c: char| c.is_ascii_alphabetic()).map_or(after.len(), |end| end + 1);
            rest = &after[end..];
        }
        plain.push_str(rest);
        let lines = plain.split(['\r', '\n']).filter(|line| !line.trim().is_empty());
        lines.map(str::to_owned).collect()
    }

    /// Waits for a line with all of `parts` after the first `after` lines; returns the number of lines up to it.
    fn until(&self, after: usize, parts: &[&str]) -> usize {
        let end = Instant::now() + Duration::from_secs(30);
        loop {
            let lines = self.lines();
            let found =
                lines.iter().skip(after).position(|line| parts.iter().all(|part| line.contains(part)));
            if let Some(found) = found {
                return after + found + 1;
            }
            assert!(
                Instant::now() < end,
                "never shown: {parts:?} in {:#?}",
                &lines[after.min(lines.len())..]
            );
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A start without boards, boards that appear, a foot that holds, a board that fails, a link that is cut and comes
/// back. The test prints the output: `--no-capture` makes a recording of it.
// N3, N10
#[test]
fn one_line_on_a_terminal_tells_what_the_floor_does() {
    let site = Site::new();
    let address = format!("127.0.0.1:{}", crate::ports::free_port());
    let program = env!("CARGO_BIN_EXE_underfoot");
    let command = format!("exec {program} run page.ron --floor floor.ron --no-osc --listen {address}");
    let Some(terminal) = Terminal::run(&site, &command) else { return };
    let at = terminal.until(0, &["waiting for boards | boards 0/2 | 0 packets/s"]);
    let at = terminal.until(at, &["nothing has arrived on port", "for 2 s: are the boards switched on"]);
    let boards = Boards::start(&site, address.parse().unwrap());
    let at = terminal.until(at, &["live | boards 2/2", "held drive"]);
    boards.suffer(BoardFault::OneSilent);
    let at = terminal.until(at, &["some boards missing | boards 1/2", "held drive"]);
    boards.suffer(BoardFault::Silent);
    let at = terminal.until(at, &["FLOOR LOST | boards 0/2 | 0 packets/s", "nothing held"]);
    boards.suffer(BoardFault::Well);
    let at = terminal.until(at, &["live | boards 2/2", "nothing held"]);
    assert!(terminal.lines()[..at].iter().any(|line| line.contains("feet 2")));
    let shown = terminal.lines().join("\n");
    println!("{shown}");
}

/// A pipe gets no changing line, only messages that are printed once.
#[test]
fn a_pipe_gets_no_line_that_changes() {
    let address = format!("127.0.0.1:{}", crate::ports::free_port());
    let output = super::end_to_end::underfoot()
        .args(["run", "map", "--no-osc", "--seconds", "3", "--listen", &address])
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    assert_eq!(said.matches("nothing has arrived on port").count(), 1, "{said}");
    assert!(!said.contains('\r') && !said.contains('\u{1b}') && !said.contains("boards 0/6"), "{said}");
}
