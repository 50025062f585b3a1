//! Notes that go down come up after any failure, and values and feet arrive as MIDI: over JACK's dummy server, heard by
//! Debian's `jack_midi_dump`.

use std::collections::BTreeSet;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

use crate::holds::client::Client;
use crate::holds::site::Site;
use crate::targets::{NO_DESK, Observer, comes_up_soon, guardian, holding, kill, page, twenty_rounds, until};

/// The client name of the listener.
const LISTENER: &str = "midi_listener";

/// A JACK server with the dummy driver, and a listener on it.
struct JackStage {
    name: String,
    server: Child,
    listener: Option<Child>,
    heard: Option<Receiver<Vec<u8>>>,
    /// All messages so far.
    all: Vec<Vec<u8>>,
    /// The notes that sound: channel from 0, and key.
    down: BTreeSet<(u8, u8)>,
}

impl JackStage {
    /// A server of its own; `None`, with the reason printed, where JACK or the listener is missing.
    fn open() -> Option<Self> {
        if !cfg!(feature = "midi-jack") {
            println!("not run: the program is built without the feature midi-jack");
            return None;
        }
        for (program, package) in [("jackd", "jackd2"), ("jack_midi_dump", "jack-example-tools")] {
            if let Err(error) =
                Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status()
            {
                println!("not run: there is no {program} (Debian: {package}): {error}");
                return None;
            }
        }
        let name = format!("underfoot_{}", std::process::id());
        let server = server(&name);
        let mut stage =
            Self { name, server, listener: None, heard: None, all: Vec::new(), down: BTreeSet::new() };
        stage.listen();
        Some(stage)
    }

    /// Starts the listener as soon as the server is there.
    fn listen(&mut self) {
        for _ in 0..100 {
            // A pipe would hold its lines back.
            let mut listener = self
                .tool("stdbuf")
                .args(["-oL", "jack_midi_dump", LISTENER])
                .stdout(Stdio::piped())
                .stderr(Stdio::null())
                .spawn()
                .unwrap();
            thread::sleep(Duration::from_millis(100));
            if listener.try_wait().unwrap().is_some() {
                continue;
            }
            let lines = BufReader::new(listener.stdout.take().unwrap()).lines();
            let (tell, heard) = channel();
            let read = move || {
                let messages = lines.map_while(Result::ok).filter_map(|line| bytes(&line));
                messages.map(|message| tell.send(message)).take_while(Result::is_ok).for_each(drop);
            };
            thread::spawn(read);
            (self.listener, self.heard) = (Some(listener), Some(heard));
            return;
        }
        panic!("no listener");
    }

    fn tool(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("JACK_DEFAULT_SERVER", &self.name).env("JACK_NO_START_SERVER", "1");
        command
    }

    /// Takes in what the listener has heard.
    fn hear(&mut self) {
        for message in self.heard.iter().flat_map(Receiver::try_iter) {
            match message.as_slice() {
                [status, key, velocity] if status & 0xf0 == 0x90 && *velocity > 0 => {
                    self.down.insert((status & 0x0f, *key));
                }
                [status, key, _] if [0x80, 0x90].contains(&(status & 0xf0)) => {
                    self.down.remove(&(status & 0x0f, *key));
                }
                _ => {}
            }
            self.all.push(message);
        }
    }

    /// A floor whose page `page.ron` has this text, and whose program finds the server.
    fn site(&self, page: &str) -> Site {
        let mut site = Site::new();
        site.environment = vec![("JACK_DEFAULT_SERVER", self.name.clone())];
        std::fs::write(site.folder().join("page.ron"), page).unwrap();
        site
    }

    /// The connections of all ports, as `jack_lsp` lists them.
    fn connections(&self) -> String {
        let listed = self.tool("jack_lsp").arg("-c").output().unwrap();
        String::from_utf8_lossy(&listed.stdout).into_owned()
    }
}

impl Observer for JackStage {
    fn is_down(&mut self) -> bool {
        self.hear();
        !self.down.is_empty()
    }
}

impl Drop for JackStage {
    fn drop(&mut self) {
        if let Some(listener) = &mut self.listener {
            let _ = listener.kill();
            let _ = listener.wait();
        }
        // A server that is killed keeps one of the eight places that JACK has for the servers of a user.
        kill(self.server.id(), "TERM");
        let _ = self.server.wait();
    }
}

/// A server with cycles of 5 ms.
fn server(name: &str) -> Child {
    Command::new("jackd")
        .args(["-n", name, "-r", "-d", "dummy", "-r", "48000", "-p", "256", "-C", "0", "-P", "0"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// The bytes of a line of `jack_midi_dump`, such as `  12345: 90 3c 40  note on  (channel  0): pitch  60, vel  64`.
fn bytes(line: &str) -> Option<Vec<u8>> {
    let (_, message) = line.split_once(':')?;
    let bytes = message
        .split_whitespace()
        .map_while(|word| (word.len() == 2).then(|| u8::from_str_radix(word, 16).ok()).flatten());
    Some(bytes.take(3).collect())
}

/// The target, with a port that connects to the listener by itself.
fn synth() -> String {
    format!("(name: \"synth\", to: Midi(\"underfoot\", (into: \"{LISTENER}\"))), {NO_DESK}")
}

const HOLD: &str = r#"While(pressed, Note("synth", "C4"))"#;

#[test]
fn a_note_that_is_held_ends_whatever_dies() {
    let Some(mut stage) = JackStage::open() else { return };
    let site = stage.site(&page(&synth(), HOLD));
    comes_up_soon(&site, &mut stage);
    let on = stage.all.iter().find(|message| message.first() == Some(&0x90));
    assert!(matches!(on.map(Vec::as_slice), Some([0x90, 60, 1..=127])), "{on:?}");
}

/// Twenty rounds of each end, the median and the longest time: for an idle machine, in a release build.
#[test]
#[ignore = "takes ten minutes; figures of a machine that is busy say nothing"]
fn twenty_rounds_of_each_end_of_a_note() {
    let Some(mut stage) = JackStage::open() else { return };
    let site = stage.site(&page(&synth(), HOLD));
    twenty_rounds(&site, &mut stage);
}

/// Receivers connect to a port as they like: after the guardian's death its note ends all the same, and the next guardian
/// has the connection again.
#[test]
fn a_connection_that_another_program_made_outlives_the_guardian() {
    let Some(mut stage) = JackStage::open() else { return };
    let targets = format!("(name: \"synth\", to: Midi(\"underfoot\")), {NO_DESK}");
    let site = stage.site(&page(&targets, HOLD));
    let client = Client::new();
    let run = site.run(&client, &[]);
    let ports = stage.connections();
    let input = ports.lines().find(|line| line.starts_with(LISTENER)).expect("its port").to_owned();
    let connected = stage.tool("jack_connect").args(["underfoot:out", &input]).status().unwrap();
    assert!(connected.success(), "{ports}");
    let receives = |stage: &JackStage, port: &str| {
        let all = stage.connections();
        all.lines().skip_while(|line| *line != port).nth(1).is_some_and(|line| line.trim() == input)
    };
    let boards = holding(&site, run.address, || stage.is_down());
    // The guardian looks at its connections five times a second. The server's own port connects when it is needed: until
    // then, a server that stands still would keep the receiver waiting.
    thread::sleep(Duration::from_millis(400));
    assert!(!receives(&stage, "underfoot standby:out"));
    kill(guardian(&run), "KILL");
    until("the note ends", || !stage.is_down());
    drop(boards);
    until("the new guardian is connected", || receives(&stage, "underfoot:out"));
}

#[test]
fn a_foot_on_free_floor_is_a_voice_and_a_slider_is_a_controller() {
    let Some(mut stage) = JackStage::open() else { return };
    let targets = synth();
    let text = format!(
        r#"Layout(
    version: 2,
    targets: [{targets}],
    regions: [
        (id: "left", at: (0, 0), size: (1, 2), send: [Contacts(Mpe("synth", (from: 48, to: 72)))]),
        (id: "right", at: (1, 0), size: (2, 2)),
    ],
    widgets: [
        (id: "zoom", kind: "slider", at: (1.2, 0), size: (1.8, 0.9), press_n: 60, release_n: 40,
         send: [Value(Cc("synth", (channel: 1, number: 7, fine: true)))]),
    ],
)"#
    );
    let site = stage.site(&text);
    let client = Client::new();
    let run = site.run(&client, &[]);
    let boards = holding(&site, run.address, || stage.is_down());
    let has = |stage: &mut JackStage, status: u8, number: Option<u8>| {
        stage.hear();
        let is_it = |message: &Vec<u8>| {
            message.first() == Some(&status) && number.is_none_or(|number| message.get(1) == Some(&number))
        };
        stage.all.iter().position(is_it)
    };
    let zone = has(&mut stage, 0xb0, Some(6)).expect("the zone");
    let bend = has(&mut stage, 0xe1, None).expect("a bend");
    let note = has(&mut stage, 0x91, None).expect("a note on the first member channel");
    assert!(zone < bend && bend < note, "{:02x?}", stage.all);
    until("the slider's upper half", || has(&mut stage, 0xb0, Some(7)).is_some());
    until("the slider's lower half", || has(&mut stage, 0xb0, Some(39)).is_some());
    // The floor is lost: the voice ends, though no foot lifts.
    drop(boards);
    until("the voice ends", || !stage.is_down());
}

/// A port that is gone gives one notice, and comes back; nothing waits for it.
#[test]
fn a_jack_server_that_ends_and_comes_back_gets_nothing_old() {
    let Some(mut stage) = JackStage::open() else { return };
    let site = stage.site(&page(&synth(), HOLD));
    let client = Client::new();
    let run = site.run(&client, &[]);
    let boards = holding(&site, run.address, || stage.is_down());
    let _ = stage.server.kill();
    let _ = stage.server.wait();
    if let Some(mut listener) = stage.listener.take() {
        let _ = listener.kill();
        let _ = listener.wait();
    }
    stage.down.clear();
    thread::sleep(Duration::from_millis(500));
    drop(boards);
    stage.server = server(&stage.name);
    stage.all.clear();
    stage.listen();
    until("the port is there again", || {
        let all = stage.connections();
        all.lines().any(|line| line == "underfoot:out")
    });
    thread::sleep(Duration::from_millis(500));
    stage.hear();
    assert!(stage.down.is_empty(), "{:02x?}", stage.all);
    let said = run.end();
    let told = said.iter().filter(|line| line.contains("the JACK server has ended")).count();
    assert!(told <= 2, "{said:#?}");
    assert!(said.iter().any(|line| line.contains("synth")), "{said:#?}");
}
