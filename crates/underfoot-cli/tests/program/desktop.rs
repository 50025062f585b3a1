//! The window with real keys, beside other programs, on a separate display. Skipped without Xvfb, openbox, xdotool or
//! xclip.

use std::ffi::OsStr;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::xvfb::Xvfb;

/// Time-out of a wait: normally a second or two; a busy machine gets a hundred times that.
const LONGEST: Duration = Duration::from_secs(180);
const PAUSE: Duration = Duration::from_millis(100);

const PROGRAMS: [&str; 3] = ["openbox", "xdotool", "xclip"];

const LAYOUT: &str = "Layout(version: 1, regions: [(id: \"r\", at: (0, 2), size: (6, 4))], widgets: [
    (id: \"first\", kind: \"button\", at: (0.2, 2.2), size: (0.6, 0.6), label: \"A\"),
])
";

/// Ends with the test.
struct Ended(Child);

impl Drop for Ended {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A display with a window manager, and a window of `underfoot preview mine.ron` on it.
struct Desk {
    folder: tempfile::TempDir,
    window: Ended,
    _manager: Ended,
    server: Xvfb,
}

/// Whether all programs that these tests need are installed.
fn can_run() -> bool {
    let is_here = |program: &&str| {
        let path = std::env::var_os("PATH").unwrap_or_default();
        std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
    };
    let missing: Vec<&str> = PROGRAMS.into_iter().filter(|program| !is_here(program)).collect();
    if !missing.is_empty() {
        eprintln!("not run: {} is missing", missing.join(", "));
    }
    missing.is_empty()
}

/// Calls `look` repeatedly until it finds something.
fn until<T>(what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let begun = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(begun.elapsed() < LONGEST, "no {what}");
        sleep(PAUSE);
    }
}

impl Desk {
    /// `None` without one of the programs.
    fn open() -> Option<Self> {
        if !can_run() {
            return None;
        }
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("mine.ron"), LAYOUT).unwrap();
        let server = Xvfb::open("1280x800x24")?;
        let on = |program: &OsStr| {
            let mut command = Command::new(program);
            command
                .env("DISPLAY", &server.display)
                .env_remove("WAYLAND_DISPLAY")
                .env("LIBGL_ALWAYS_SOFTWARE", "1");
            command.env("XDG_STATE_HOME", folder.path().join("state"));
            command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
            command.current_dir(folder.path());
            command
        };
        let manager = Ended(on("openbox".as_ref()).spawn().unwrap());
        let program = env!("CARGO_BIN_EXE_underfoot");
        let window = on(program.as_ref()).args(["preview", "mine.ron", "--no-osc"]).spawn().unwrap();
        let desk = Self { window: Ended(window), _manager: manager, server, folder };
        // The title names the file once the first frame is drawn.
        let id = until("window", || desk.x(&["search", "--onlyvisible", "--name", "^mine.ron - underfoot$"]));
        let id = id.lines().last().unwrap().to_owned();
        until("focus", || {
            desk.x(&["windowfocus", &id])
                .and_then(|_| desk.x(&["getwindowfocus"]))
                .filter(|own| own.trim() == id)
        });
        desk.x(&["mousemove", "640", "300"]);
        Some(desk)
    }

    fn run(&self, program: &str, arguments: &[&str]) -> Output {
        Command::new(program).args(arguments).env("DISPLAY", &self.server.display).output().unwrap()
    }

    /// A command of xdotool; `None` if it failed.
    fn x(&self, arguments: &[&str]) -> Option<String> {
        let output = self.run("xdotool", arguments);
        output.status.success().then(|| String::from_utf8(output.stdout).unwrap())
    }

    fn keys(&self, keys: &[&str]) {
        for key in keys {
            self.x(&["key", "--clearmodifiers", key]).unwrap();
            sleep(PAUSE);
        }
    }

    fn title(&self) -> String {
        let title = self.x(&["getactivewindow", "getwindowname"]);
        title.map(|title| title.trim().to_owned()).unwrap_or_default()
    }

    fn until_title(&self, wanted: &str) {
        until(&format!("title {wanted}"), || (self.title() == wanted).then_some(()));
    }

    fn file(&self) -> String {
        fs::read_to_string(self.folder.path().join("mine.ron")).unwrap()
    }

    /// Copies `text` in another program.
    fn copy_elsewhere(&self, text: &str) -> Ended {
        let mut other = Command::new("xclip")
            .args(["-selection", "clipboard", "-in", "-quiet"])
            .env("DISPLAY", &self.server.display)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        other.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
        let other = Ended(other);
        until("text on the clipboard", || (self.pasted_elsewhere() == text).then_some(()));
        other
    }

    /// The text that another program would paste.
    fn pasted_elsewhere(&self) -> String {
        let output = self.run("timeout", &["5", "xclip", "-selection", "clipboard", "-out"]);
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    fn until_closed(&mut self) -> ExitStatus {
        until("end of the program", || self.window.0.try_wait().unwrap())
    }
}

fn is_there(folder: &Path, name: &str) -> bool {
    folder.join(name).exists()
}

#[test]
fn controls_go_to_other_programs_and_come_from_them_by_the_systems_clipboard() {
    let Some(desk) = Desk::open() else { return };
    desk.keys(&["F2"]);
    let other = desk.copy_elsewhere(
        "(id: \"from_editor\", kind: \"button\", at: (2, 4), size: (0.6, 0.6), label: \"B\"), // elsewhere\n",
    );
    desk.keys(&["ctrl+v"]);
    desk.until_title("• mine.ron - underfoot");
    desk.keys(&["ctrl+s"]);
    desk.until_title("mine.ron - underfoot");
    assert!(desk.file().contains("from_editor") && desk.file().contains("// elsewhere"), "{}", desk.file());
    drop(other);
    desk.keys(&["ctrl+a", "ctrl+c"]);
    let copied = until("controls on the clipboard", || {
        Some(desk.pasted_elsewhere()).filter(|text| text.contains("first"))
    });
    assert!(copied.contains("from_editor"), "{copied}");
    // A text that is not a control changes nothing.
    let saved = desk.file();
    let _other = desk.copy_elsewhere("Dear all, see you at five (room B).");
    desk.keys(&["ctrl+v", "ctrl+s", "F2"]);
    sleep(Duration::from_secs(2));
    assert_eq!((desk.file(), desk.title()), (saved, "mine.ron - underfoot".to_owned()));
}

#[test]
fn a_window_with_changes_asks_before_alt_f4_and_ctrl_q_close_it() {
    let Some(mut desk) = Desk::open() else { return };
    desk.keys(&["F2"]);
    let other =
        desk.copy_elsewhere("(id: \"new\", kind: \"button\", at: (2, 4), size: (0.6, 0.6), label: \"B\")");
    desk.keys(&["ctrl+v"]);
    desk.until_title("• mine.ron - underfoot");
    drop(other);
    let before = desk.file();
    desk.keys(&["alt+F4"]);
    sleep(Duration::from_secs(2));
    assert!(desk.window.0.try_wait().unwrap().is_none(), "it asks");
    desk.keys(&["Escape"]);
    sleep(Duration::from_secs(1));
    assert!(desk.window.0.try_wait().unwrap().is_none() && desk.file() == before);
    // After a test with feet it asks as well; Enter saves.
    desk.keys(&["F2", "ctrl+q"]);
    sleep(Duration::from_secs(2));
    assert!(desk.window.0.try_wait().unwrap().is_none(), "it asks");
    desk.keys(&["Return"]);
    assert!(desk.until_closed().success());
    assert!(desk.file().contains("id: \"new\""), "{}", desk.file());
    assert!(!is_there(desk.folder.path(), ".mine.ron.draft"));
}
