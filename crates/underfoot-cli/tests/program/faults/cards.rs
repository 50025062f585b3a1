//! A1, A2, A4, A5 and A9: sound cards that vanish, hang or do not fit, and an actuator driven for too long.
//!
//! The card is a JACK server without hardware, which keeps time like a card, behind ALSA's own plugin: this needs
//! Debian's `jackd2` and `libasound2-plugins`. Without them, a test prints a message and passes.
#![cfg(all(target_os = "linux", feature = "audio"))]

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::live::Live;
use super::tape::BUTTON;
use crate::end_to_end::{channels, said, underfoot};

/// The card's name in ALSA.
const CARD: &str = "testfloor";

/// A JACK server with its own name, as a card of some channels at 48 kHz; `None`, with a printed message, without
/// JACK.
struct Card {
    folder: tempfile::TempDir,
    server: Option<Child>,
    channels: u16,
}

impl Card {
    fn plug_in(channels: u16) -> Option<Self> {
        let folder = tempfile::tempdir().unwrap();
        let ports: Vec<String> =
            (0..channels).map(|port| format!("{port} system:playback_{}", port + 1)).collect();
        let text = format!(
            "</usr/share/alsa/alsa.conf>\npcm.{CARD} {{\n type jack\n playback_ports {{ {} }}\n capture_ports {{ }}\n \
             hint {{ show on description \"A floor for tests\" }}\n}}\n",
            ports.join(" ")
        );
        std::fs::write(folder.path().join("alsa.conf"), text).unwrap();
        let mut card = Self { folder, server: None, channels };
        card.server = card.serve();
        let found = card.server.is_some() && card.is_found();
        if !found {
            println!(
                "not run: there is no jackd, or ALSA has no plugin for it (Debian: jackd2, libasound2-plugins)"
            );
        }
        found.then_some(card)
    }

    /// The server's own name.
    fn name(&self) -> String {
        format!(
            "underfoot{}",
            self.folder.path().file_name().unwrap().to_string_lossy().trim_start_matches('.')
        )
    }

    fn serve(&self) -> Option<Child> {
        let channels = self.channels.to_string();
        let mut jackd = Command::new("jackd");
        jackd.args([
            "-n",
            &self.name(),
            "-r",
            "-d",
            "dummy",
            "-p",
            "256",
            "-r",
            "48000",
            "-C",
            "0",
            "-P",
            &channels,
        ]);
        jackd.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().ok()
    }

    /// The environment that leads a program to this card.
    fn environment(&self) -> [(&'static str, String); 3] {
        let config = self.folder.path().join("alsa.conf").display().to_string();
        let start = ("JACK_NO_START_SERVER", "1".into());
        [("ALSA_CONFIG_PATH", config), ("JACK_DEFAULT_SERVER", self.name()), start]
    }

    /// Whether the program finds it within 20 s.
    fn is_found(&self) -> bool {
        let end = Instant::now() + Duration::from_secs(20);
        let devices = || underfoot().args(["rack", "devices"]).envs(self.environment()).output().unwrap();
        let is_there = |list: &str| list.lines().any(|line| line.contains(CARD) && line.contains("48000"));
        std::iter::repeat_with(devices)
            .take_while(|_| Instant::now() < end)
            .any(|output| is_there(&said(&output)))
    }

    /// Ends the server, first by SIGTERM: a killed one leaves its name occupied, and there are eight names.
    fn pull_out(&mut self) {
        let Some(mut server) = self.server.take() else { return };
        let process = server.id().to_string();
        for signal in ["CONT", "TERM"] {
            // It may have ended already.
            let _ = Command::new("kill").args(["-s", signal, &process]).stderr(Stdio::null()).status();
        }
        let end = Instant::now() + Duration::from_secs(10);
        while server.try_wait().is_ok_and(|status| status.is_none()) && Instant::now() < end {
            std::thread::sleep(Duration::from_millis(10));
        }
        let _ = server.kill();
        let _ = server.wait();
    }

    fn signal(&self, name: &str) {
        let process = self.server.as_ref().unwrap().id().to_string();
        assert!(Command::new("kill").args(["-s", name, &process]).status().unwrap().success());
    }
}

impl Drop for Card {
    fn drop(&mut self) {
        self.pull_out();
    }
}

/// The floor's latest report about its card.
fn card_state(live: &Live) -> Value {
    live.lines().into_iter().rfind(|line| line["event"] == "device").unwrap_or_default()
}

fn wait_until_it_plays(live: &Live, reopened: u64) {
    live.wait_until("the card plays", |live| {
        let state = card_state(live);
        state["state"] == "playing" && state["reopened"].as_u64() >= Some(reopened)
    });
}

// A1, A2
#[test]
fn a_card_that_vanishes_or_hangs_is_played_again_when_it_is_back() {
    let Some(mut card) = Card::plug_in(4) else { return };
    let environment = card.environment();
    let live = Live::start_as(BUTTON, |run| {
        run.args(["--device", CARD]).envs(environment);
    });
    wait_until_it_plays(&live, 0);
    live.tap_until_it_clicks();

    card.pull_out();
    live.wait_until("it is missed", |live| card_state(live)["state"] != "playing");
    live.tap_until_it_clicks();
    card.server = card.serve();
    wait_until_it_plays(&live, 1);

    card.signal("STOP");
    let hangs = |live: &Live| {
        let state = card_state(live);
        state["state"] == "faulty" && state["why"].as_str().unwrap().contains("stopped asking for samples")
    };
    live.wait_until("it is found to hang", hangs);
    live.tap_until_it_clicks();
    card.signal("CONT");
    wait_until_it_plays(&live, 2);
    live.tap_until_it_clicks();
    assert_eq!(live.end().0, Some(0));
}

/// Gravel all over the floor: each push of a foot is many cues.
const GRAVEL: &str = r#"Layout(version: 1, grounds: [Gravel()])"#;

// A2
#[test]
fn steps_on_a_floor_whose_card_hangs_are_not_felt_all_at_once_when_it_is_back() {
    let Some(card) = Card::plug_in(4) else { return };
    let live = Live::start_as(GRAVEL, |run| {
        run.args(["--device", CARD]).envs(card.environment());
    });
    wait_until_it_plays(&live, 0);
    card.signal("STOP");
    for _ in 0..15 {
        live.press(300.0);
        std::thread::sleep(Duration::from_millis(150));
        live.press(0.0);
        std::thread::sleep(Duration::from_millis(150));
    }
    card.signal("CONT");
    wait_until_it_plays(&live, 1);
    // Steps on the card that is back, so that a delay is measured: several, since a busy machine may lose some.
    for _ in 0..5 {
        live.press(300.0);
        std::thread::sleep(Duration::from_millis(400));
        live.press(0.0);
        std::thread::sleep(Duration::from_millis(200));
    }
    let (code, said) = live.end();
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("Cues: ") && said.contains("muted "), "{said}");
    let longest = said.split("longest ").nth(1).and_then(|rest| rest.split(' ').next());
    let longest = longest.unwrap_or_else(|| panic!("no delay was measured: {said}"));
    // The hang was detected after 200 ms; the steps continued for 4.5 s.
    assert!(longest.parse::<f64>().unwrap() < 1000.0, "{said}");
}

// A4
#[test]
fn a_card_that_does_not_fit_is_refused_with_the_map() {
    let Some(card) = Card::plug_in(2) else { return };
    let run = |options: &[&str]| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("page.ron"), BUTTON).unwrap();
        let listen = format!("127.0.0.1:{}", crate::ports::free_port());
        let mut run = underfoot();
        run.current_dir(folder.path()).envs(card.environment());
        run.args(["run", "page.ron", "--grid", "2x2", "--no-osc", "--listen", &listen, "--device", CARD]);
        run.args(["--seconds", "1"]).args(options).output().unwrap()
    };
    let refused = run(&["--sound", "tiles"]);
    assert_eq!(refused.status.code(), Some(1), "{}", said(&refused));
    for part in ["has 2 channels and the floor needs 4", "row   1 |  2  3", "row   0 |  0  1"] {
        assert!(said(&refused).contains(part), "{part}: {}", said(&refused));
    }
    let refused = run(&["--sound", "stereo", "--rate", "96000"]);
    assert!(refused.status.code() == Some(1) && said(&refused).contains("48000"), "{}", said(&refused));
    let converted = run(&["--sound", "stereo", "--rate", "96000", "--resample"]);
    assert_eq!(converted.status.code(), Some(0), "{}", said(&converted));
}

// A5
#[test]
fn without_real_time_priority_it_plays_and_says_what_helps() {
    // Even root has none without the capability; `prlimit` and `setpriv` belong to util-linux.
    let denied = ["--rtprio=0:0", "setpriv", "--bounding-set=-sys_nice", "--inh-caps=-sys_nice"];
    let made = Command::new("prlimit").args(denied).arg("true").output();
    let is_made = made.is_ok_and(|output| output.status.success());
    let live = Live::start_as(BUTTON, |run| {
        run.args(["--device", "paced"]);
        if is_made {
            let program = run.get_program().to_owned();
            let arguments: Vec<_> = run.get_args().map(ToOwned::to_owned).collect();
            let folder = run.get_current_dir().unwrap().to_owned();
            let mut wrapped = Command::new("prlimit");
            wrapped.args(denied).arg(program).args(arguments).current_dir(folder);
            wrapped.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("RUST_LOG");
            *run = wrapped;
        }
    });
    wait_until_it_plays(&live, 0);
    live.wait_until("its priority is known", |live| card_state(live)["priority"] != "host");
    let priority = card_state(&live)["priority"].clone();
    live.tap_until_it_clicks();
    let (code, said) = live.end();
    assert_eq!(code, Some(0), "{said}");
    if priority == "real-time" {
        println!("not run: real-time priority can't be taken away here");
        return;
    }
    assert!(said.contains("/etc/security/limits.d"), "{priority}: {said}");
}

/// A foot holds a control for a minute; the control's effect drives its actuator at full scale (36 V into 4 ohms).
// A9
#[test]
fn an_actuator_that_is_driven_too_long_is_turned_down() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    let level = "level_n: 40, hz: 75, noise: 0, length_ms: 60000, attack_ms: 5, release_ms: 5, priority: 9";
    file("effects/loud.ron", &format!("Effect(name: \"loud\", plays: Continuous({level}))"));
    file(
        "page.ron",
        "Layout(version: 1, regions: [(id: \"page\", at: (0, 2), size: (6, 4))], widgets: [(id: \"drive\", \
         kind: \"dead_man\", feel: (hold: \"loud\"), at: (0.1, 2.1), size: (0.8, 0.8))])",
    );
    file(
        "visit.ron",
        "Scenario(title: \"Long\", person: (mass_kg: 70, foot_m: 0.27), steps: [Wait(ms: 1200), \
         Enter(from: South, at: (2.2, 0.5)), Press(widget: \"drive\", force_n: 140, hold_ms: 60000), Wait(ms: 500)])",
    );
    super::session::play(folder.path(), &[]);
    let powers = powers(&folder.path().join("out/actuators.wav"));
    let most = powers.iter().copied().fold(0.0, f32::max);
    // The foot is down from second 5 on.
    let settled = powers[40];
    assert!(most > 100.0, "it begins loud: {powers:?}");
    assert!((40.0..80.0).contains(&settled), "and ends below 80 W: {powers:?}");
    let minute: f32 = powers.iter().sum::<f32>() / 60.0;
    assert!(minute <= 80.0, "{minute} W over the minute");
}

/// The mean power of each second in the coil that receives most, in watts.
fn powers(path: &Path) -> Vec<f32> {
    let (rate, channels) = channels(path);
    let energy = |samples: &[f32]| samples.iter().map(|sample| sample * sample).sum::<f32>();
    let loudest = channels.iter().max_by(|a, b| energy(a).total_cmp(&energy(b))).unwrap();
    let watts = 36.0 * 36.0 / 4.0;
    loudest.chunks(rate as usize).map(|second| energy(second) / second.len() as f32 * watts).collect()
}
