//! R5 and J5: real windows on a separate display, with real input. They need Debian's packages `xvfb`, `xdotool`,
//! `libgl1-mesa-dri`, `libxkbcommon-x11-0`, `libxcursor1` and `libxi6`; without them, a test prints a message and
//! passes.
#![cfg(all(target_os = "linux", feature = "preview"))]

use std::io::{BufRead, BufReader};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use serde_json::Value;
use tungstenite::{Message, client};

use super::live::Live;
use super::tape::{BUTTON, events};
use crate::end_to_end::{Served, underfoot};
use crate::output::memory_kb;
use crate::web::free_address;
use crate::xvfb::Xvfb;

/// Time-out for an event that must happen: a busy machine draws windows by software.
const AT_LAST: Duration = Duration::from_secs(120);

fn wait_until(what: &str, mut happened: impl FnMut() -> bool) {
    let end = Instant::now() + AT_LAST;
    while !happened() {
        assert!(Instant::now() < end, "never happened: {what}");
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// A separate display.
struct Screen(Xvfb);

impl Screen {
    /// `None`, with a printed message, without Xvfb or xdotool.
    fn open() -> Option<Self> {
        if Command::new("xdotool").arg("version").output().is_err() {
            println!("not run: there is no xdotool (Debian: xdotool)");
            return None;
        }
        Some(Self(Xvfb::open("1600x900x24")?))
    }

    fn xdotool(&self, words: &str) -> String {
        let mut xdotool = Command::new("xdotool");
        let output = xdotool.env("DISPLAY", &self.0.display).args(words.split_whitespace()).output().unwrap();
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    /// The visible windows of the program.
    fn windows(&self) -> Vec<String> {
        let all = self.xdotool("search --onlyvisible --name underfoot");
        all.lines().map(str::to_owned).collect()
    }

    /// Opens a window of the program with its files in `folder`; returns the process, its lines of JSON and the
    /// window.
    fn show(&self, folder: &Path, arguments: &[&str]) -> (Served, Arc<Mutex<Vec<Value>>>, String) {
        let before = self.windows();
        let mut process = underfoot()
            .current_dir(folder)
            .arg("preview")
            .args(arguments)
            .env("DISPLAY", &self.0.display)
            .env("LIBGL_ALWAYS_SOFTWARE", "1")
            .envs(["HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME"].map(|name| (name, folder)))
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map(Served)
            .unwrap();
        let out = BufReader::new(process.0.stdout.take().unwrap());
        let lines = Arc::<Mutex<Vec<Value>>>::default();
        let kept = Arc::clone(&lines);
        std::thread::spawn(move || {
            for line in out.lines().map_while(Result::ok) {
                kept.lock().unwrap().push(serde_json::from_str(&line).unwrap());
            }
        });
        let mut window = None;
        wait_until("the window is shown", || {
            assert!(process.0.try_wait().unwrap().is_none(), "it ended at once");
            window = self.windows().into_iter().find(|window| !before.contains(window));
            window.is_some()
        });
        (process, lines, window.unwrap())
    }
}

/// A button that fills a floor of four tiles.
const PAGE: &str = r#"Layout(version: 1, regions: [(id: "all", at: (0, 0), size: (2, 2))],
    widgets: [(id: "it", kind: "button", at: (0, 0), size: (2, 2))])"#;

/// The mouse is a foot on the control while another window takes the keyboard.
#[test]
fn r5_a_window_that_loses_the_keyboard_lifts_the_foot_of_the_mouse() {
    let Some(screen) = Screen::open() else { return };
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("page.ron"), PAGE).unwrap();
    let arguments = ["page.ron", "--grid", "2x2", "--no-osc", "--json", "--sound", "off"];
    let (_shown, lines, window) = screen.show(folder.path(), &arguments);
    let (_other, _, other) = screen.show(folder.path(), &arguments);
    // Beside the first, which would not be drawn under another one.
    screen.xdotool(&format!("windowsize {other} 300 300"));
    screen.xdotool(&format!("windowmove {other} 1290 0"));
    let count = |event: &str| events(&lines.lock().unwrap()).iter().filter(|one| *one == event).count();
    screen.xdotool(&format!("windowfocus {window}"));
    // The first pointer event may be ignored while the window still draws itself.
    wait_until("the mouse presses", || {
        screen.xdotool("mouseup 1");
        screen.xdotool("mousemove 490 390 sleep 0.3 mousemove 500 400 sleep 0.3 mousedown 1 sleep 1");
        count("it pressed") > 0
    });
    std::thread::sleep(Duration::from_secs(1));
    assert_eq!(count("it released") + count("it cancelled"), 0, "it holds while the window has the keyboard");
    screen.xdotool(&format!("windowfocus {other}"));
    wait_until("the foot lifts", || count("it released") + count("it cancelled") > 0);
    screen.xdotool("mouseup 1");
}

/// The answers of a hostile server to a window that joins, connection by connection.
fn rubbish(connection: usize) -> Vec<Message> {
    match connection % 5 {
        0 => vec![Message::text("no JSON")],
        1 => vec![Message::binary(vec![0xff; 60_000]); 200],
        2 => vec![Message::text(r#"{"event":"mirror","version":1,"floor":"Floor(","layout":7}"#)],
        3 => vec![Message::text("[".repeat(1 << 20))],
        // Longer than any message that is accepted.
        _ => vec![Message::binary(vec![0; 17 << 20])],
    }
}

/// Row J5. A server lets a window join, and then sends invalid messages: the window continues, tries again each
/// second, and uses no more memory than before.
#[test]
fn a_window_that_joins_a_server_of_rubbish_goes_on_and_tries_again() {
    let Some(screen) = Screen::open() else { return };
    let web = free_address();
    let live = Live::start(BUTTON, &["--web", &web.to_string()]);
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let joined = Arc::<AtomicUsize>::default();
    let count = Arc::clone(&joined);
    std::thread::spawn(move || {
        for (connection, stream) in listener.incoming().enumerate() {
            count.fetch_add(1, Ordering::Relaxed);
            let Ok(mut socket) = tungstenite::accept(stream.unwrap()) else { continue };
            // The window opens once it knows the floor: a good server sends that much.
            let (mut good, _) =
                client(format!("ws://{web}/mirror"), TcpStream::connect(web).unwrap()).unwrap();
            let greeting = std::iter::repeat_with(|| good.read().unwrap()).take(20);
            for message in greeting.chain(rubbish(connection)) {
                if socket.send(message).is_err() {
                    break;
                }
            }
            // The window closes, or is closed after a while.
            let _ = socket.get_ref().set_read_timeout(Some(Duration::from_millis(500)));
            let _ = socket.read();
        }
    });
    let folder = tempfile::tempdir().unwrap();
    let (mut process, _, _) = screen.show(folder.path(), &["--join", &address.to_string()]);
    let connections = |number: usize| joined.load(Ordering::Relaxed) >= number;
    wait_until("it has seen all of it", || connections(6));
    let id = process.0.id().to_string();
    let warm = memory_kb(&id);
    wait_until("and twice more", || connections(16));
    assert!(process.0.try_wait().unwrap().is_none(), "the window is gone");
    let after = memory_kb(&id);
    assert!(after < warm + 40_000, "{warm} kB, then {after} kB");
    drop(process);
    live.tap_until_it_clicks();
}
