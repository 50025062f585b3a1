//! A broker of others (`mosquitto`) and its client see holds, values and whether the floor is there.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

use crate::holds::client::Client;
use crate::holds::site::{Boards, Site};
use crate::targets::{Observer, comes_up_soon, guardian, kill, until};

/// The topic of the pedal.
const DRIVE: &str = "floor/drive";

/// A broker, and a client that reads all topics.
struct Broker {
    folder: tempfile::TempDir,
    port: u16,
    broker: Child,
    client: Option<Child>,
    heard: Option<Receiver<String>>,
    /// The latest text of each topic.
    texts: BTreeMap<String, String>,
    /// All messages of the pedal's click.
    clicks: usize,
}

impl Broker {
    /// A broker of its own; `None`, with the reason printed, where it or its client is missing.
    fn start() -> Option<Self> {
        if !cfg!(feature = "mqtt") {
            println!("not run: the program is built without the feature mqtt");
            return None;
        }
        for (program, package) in [("mosquitto", "mosquitto"), ("mosquitto_sub", "mosquitto-clients")] {
            let tried = tool(program).arg("--help").stdout(Stdio::null()).stderr(Stdio::null()).status();
            if let Err(error) = tried {
                println!("not run: there is no {program} (Debian: {package}): {error}");
                return None;
            }
        }
        let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
        let folder = tempfile::tempdir().unwrap();
        let settings = format!("listener {port} 127.0.0.1\nallow_anonymous true\npersistence false\n");
        std::fs::write(folder.path().join("broker.conf"), settings).unwrap();
        let broker = broker(&folder, port);
        let (texts, clicks) = (BTreeMap::new(), 0);
        let mut started = Self { folder, port, broker, client: None, heard: None, texts, clicks };
        started.listen();
        Some(started)
    }

    /// Reads all topics from now on, and those that are retained.
    fn listen(&mut self) {
        let mut client = tool("mosquitto_sub")
            .args(["-h", "127.0.0.1", "-p", &self.port.to_string(), "-t", "#", "-v"])
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let lines = BufReader::new(client.stdout.take().unwrap()).lines().map_while(Result::ok);
        let (tell, heard) = channel();
        thread::spawn(move || lines.map(|line| tell.send(line)).take_while(Result::is_ok).for_each(drop));
        (self.client, self.heard) = (Some(client), Some(heard));
    }

    fn hear(&mut self) {
        for line in self.heard.iter().flat_map(Receiver::try_iter) {
            let (topic, text) = line.split_once(' ').unwrap_or((line.as_str(), ""));
            // The client's word for a topic that is no longer retained.
            let text = if text == "(null)" { "" } else { text };
            self.clicks += usize::from(topic == "floor/go");
            self.texts.insert(topic.to_owned(), text.to_owned());
        }
    }

    fn text(&mut self, topic: &str) -> Option<String> {
        self.hear();
        self.texts.get(topic).cloned()
    }

    fn until(&mut self, topic: &str, text: &str) {
        until(&format!("{topic} is {text}"), || self.text(topic).as_deref() == Some(text));
    }

    /// A floor whose page has this broker as the target `home`.
    fn site(&self) -> Site {
        let port = self.port;
        let text = format!(
            r#"Layout(
    version: 4,
    targets: [(name: "home", to: Mqtt("127.0.0.1:{port}", (base: "floor", discovery: true)))],
    regions: [(id: "left", at: (0, 0), size: (1, 2)), (id: "right", at: (1, 0), size: (2, 2))],
    widgets: [
        (id: "drive", kind: "dead_man", at: (0, 0), size: (0.9, 0.9),
         send: [While(pressed, Mqtt("home", "{DRIVE}")), On(pressed, Mqtt("home", "floor/go", (payload: "GO")))]),
        (id: "zoom", kind: "slider", at: (1.2, 0), size: (1.8, 0.9), press_n: 60, release_n: 40,
         send: [Value(Mqtt("home", "floor/zoom", (from: 0, to: 100)))]),
    ],
)"#
        );
        let site = Site::new();
        std::fs::write(site.folder().join("page.ron"), text).unwrap();
        site
    }

    fn stop(&mut self) {
        for child in self.client.iter_mut().chain([&mut self.broker]) {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

impl Observer for Broker {
    fn is_down(&mut self) -> bool {
        self.text(DRIVE).as_deref() == Some("ON")
    }
}

impl Drop for Broker {
    fn drop(&mut self) {
        self.stop();
    }
}

/// A program of Debian's, also where only root has its folder.
fn tool(program: &str) -> Command {
    let inside = format!("/usr/sbin/{program}");
    Command::new(if std::path::Path::new(&inside).exists() { inside } else { program.to_owned() })
}

fn broker(folder: &tempfile::TempDir, port: u16) -> Child {
    let mut broker = tool("mosquitto")
        .arg("-c")
        .arg(folder.path().join("broker.conf"))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    until("the broker listens", || {
        assert!(matches!(broker.try_wait(), Ok(None)), "the broker has ended");
        TcpStream::connect(("127.0.0.1", port)).is_ok()
    });
    broker
}

#[test]
fn a_topic_that_is_held_goes_off_whatever_dies() {
    let Some(mut broker) = Broker::start() else { return };
    let site = broker.site();
    comes_up_soon(&site, &mut broker);
}

#[test]
fn a_broker_retains_what_the_floor_is_and_hears_of_its_end() {
    let Some(mut broker) = Broker::start() else { return };
    let site = broker.site();
    let client = Client::new();
    let run = site.run(&client, &[]);
    // Clients get all that is retained.
    broker.until("floor/status", "online");
    broker.until(DRIVE, "OFF");
    broker.until("floor/zoom", "0");
    let boards = Boards::start(&site, run.address);
    broker.until(DRIVE, "ON");
    until("the slider has moved", || {
        broker.text("floor/zoom").and_then(|text| text.parse::<f32>().ok()).is_some_and(|zoom| zoom > 30.0)
    });
    // Home Assistant's descriptions name the topics and the texts.
    let description = |broker: &mut Broker, topic: &str| -> serde_json::Value {
        let text = broker.text(topic).unwrap_or_else(|| panic!("{topic}: {:?}", broker.texts.keys()));
        serde_json::from_str(&text).unwrap()
    };
    let held = description(&mut broker, "homeassistant/binary_sensor/floor/floor_drive_held/config");
    let parts = ["state_topic", "payload_on", "availability_topic"];
    assert_eq!(parts.map(|part| held[part].clone()), [DRIVE, "ON", "floor/status"]);
    let event = description(&mut broker, "homeassistant/event/floor/floor_drive_pressed/config");
    assert_eq!(event["event_types"][0], "pressed");
    assert_eq!(event["state_topic"], "floor/go");
    let zoom = description(&mut broker, "homeassistant/sensor/floor/floor_zoom_value/config");
    assert_eq!(zoom["unique_id"], "floor_zoom_value");
    // The guardian dies: the broker says that the floor is gone, until the next one is there.
    kill(guardian(&run), "KILL");
    broker.until(DRIVE, "OFF");
    broker.until("floor/status", "online");
    drop(boards);
    kill(run.child.id(), "TERM");
    broker.until("floor/status", "offline");
    assert_eq!(broker.clicks, 1);
}

/// A control that the layout no longer has is no longer described.
#[test]
fn a_layout_that_was_saved_anew_takes_back_what_it_described() {
    let Some(mut broker) = Broker::start() else { return };
    let site = broker.site();
    let run = site.run(&Client::new(), &[]);
    let zoom = "homeassistant/sensor/floor/floor_zoom_value/config";
    until("the slider is described", || broker.text(zoom).is_some_and(|text| !text.is_empty()));
    let path = site.folder().join("page.ron");
    let before = std::fs::read_to_string(&path).unwrap();
    let after =
        before.replace(r#"send: [Value(Mqtt("home", "floor/zoom", (from: 0, to: 100)))]"#, "send: []");
    assert_ne!(before, after);
    std::fs::File::create(&path).unwrap().write_all(after.as_bytes()).unwrap();
    broker.until(zoom, "");
    broker.until("floor/zoom", "");
    broker.until("floor/status", "online");
    drop(run);
}

/// A broker that ends is told once; one that comes back gets the states, and no event that it missed.
#[test]
fn a_broker_that_ends_and_comes_back_gets_states_and_nothing_old() {
    let Some(mut broker) = Broker::start() else { return };
    let site = broker.site();
    let client = Client::new();
    let run = site.run(&client, &[]);
    broker.until("floor/status", "online");
    broker.stop();
    broker.texts.clear();
    // A foot presses while there is no broker.
    let boards = Boards::start(&site, run.address);
    thread::sleep(Duration::from_millis(2500));
    broker.broker = self::broker(&broker.folder, broker.port);
    broker.listen();
    broker.until("floor/status", "online");
    until("the slider's latest state is there", || {
        broker.text("floor/zoom").and_then(|text| text.parse::<f32>().ok()).is_some_and(|zoom| zoom > 30.0)
    });
    broker.until(DRIVE, "OFF");
    thread::sleep(Duration::from_millis(500));
    assert_eq!((broker.is_down(), broker.clicks), (false, 0), "the press is lost");
    drop(boards);
    let said = run.end();
    let told: Vec<&String> = said.iter().filter(|line| line.contains("target home: ")).collect();
    assert_eq!(told.len(), 2, "its end and its return: {said:#?}");
    assert!(told[1].contains("works again"), "{told:?}");
}
