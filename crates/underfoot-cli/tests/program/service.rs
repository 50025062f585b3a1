//! The program under a service manager, and on a computer that starts before its network.
#![cfg(unix)]

use std::io::{BufRead, BufReader, Write};
use std::os::unix::net::UnixDatagram;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::end_to_end::{Served, underfoot};
use super::output::ended;
use crate::ports::free_port;

fn signal(served: &Served, name: &str) {
    let status = Command::new("kill").args(["-s", name, &served.0.id().to_string()]).status().unwrap();
    assert!(status.success());
}

/// Row R2. The sensing thread notifies systemd that the program is ready and alive; a hanging one sends nothing.
#[test]
fn a_service_manager_hears_signs_of_life_and_none_of_a_program_that_hangs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("notify");
    let manager = UnixDatagram::bind(&path).unwrap();
    manager.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    let address = format!("127.0.0.1:{}", free_port());
    let served = underfoot()
        .args(["run", "map", "--no-osc", "--listen", &address])
        .env("NOTIFY_SOCKET", &path)
        .stderr(Stdio::null())
        .spawn()
        .map(Served)
        .unwrap();
    let hear = || {
        let mut bytes = [0; 64];
        manager.recv(&mut bytes).map(|length| String::from_utf8_lossy(&bytes[..length]).into_owned())
    };
    assert_eq!(hear().unwrap(), "READY=1");
    let begun = Instant::now();
    for _ in 0..4 {
        assert_eq!(hear().unwrap(), "WATCHDOG=1");
    }
    assert!(begun.elapsed() >= Duration::from_millis(1900), "half a second apart: {:?}", begun.elapsed());
    signal(&served, "STOP");
    // Messages that were on their way.
    manager.set_read_timeout(Some(Duration::from_secs(2))).unwrap();
    while hear().is_ok() {}
    signal(&served, "CONT");
    manager.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    assert_eq!(hear().unwrap(), "WATCHDOG=1");
    assert_eq!(ended(served), Some(0));
    let rest: Vec<String> =
        std::iter::from_fn(|| hear().ok()).take_while(|said| said != "STOPPING=1").collect();
    assert!(rest.iter().all(|said| said == "WATCHDOG=1"), "{rest:?}");
}

/// Row N15. An address that this machine does not have (RFC 5737) may still appear.
#[test]
fn an_address_that_is_not_there_yet_is_waited_for() {
    let mut served = underfoot()
        .args(["run", "map", "--no-osc", "--await-address", "--listen", "192.0.2.1:9000"])
        .stderr(Stdio::piped())
        .spawn()
        .map(Served)
        .unwrap();
    let mut said = BufReader::new(served.0.stderr.take().unwrap()).lines().map_while(Result::ok);
    assert!(said.any(|line| line.contains("no address 192.0.2.1 yet: waiting for it")));
    std::thread::sleep(Duration::from_millis(700));
    assert!(served.0.try_wait().unwrap().is_none(), "it waits");
    assert_eq!(ended(served), Some(1), "stopped before it could begin");
}

/// The way to make a separate network here: as root, or as a user with root rights in it; `None`, with the reason
/// printed, if neither works.
#[cfg(target_os = "linux")]
fn own_network() -> Option<Vec<&'static str>> {
    let ways = [vec!["--net"], vec!["--user", "--map-root-user", "--net"]];
    let mut why = String::new();
    for way in ways {
        let tried = Command::new("unshare").args(&way).args(["ip", "link", "set", "lo", "up"]).output();
        match tried {
            Ok(output) if output.status.success() => return Some(way),
            Ok(output) => why = String::from_utf8_lossy(&output.stderr).into_owned(),
            Err(error) => why = error.to_string(),
        }
    }
    println!("not run: no network namespace can be made, or there is no `ip` (Debian: iproute2): {why}");
    None
}

/// Row N15. In a separate network the address appears while the program waits for it, and then boards send to it.
#[test]
#[cfg(target_os = "linux")]
fn an_address_that_comes_later_is_served_from_then_on() {
    const SCRIPT: &str = r#"
        ip link set lo up
        "$0" run map --no-osc --json --await-address --allow 192.0.2.1 --listen 192.0.2.1:9000 2>&1 &
        read -r _
        ip addr add 192.0.2.1/32 dev lo
        "$0" simulate --send 192.0.2.1:9000 --loop &
        read -r _
        kill -s TERM %1 %2
        wait %1
    "#;
    let Some(way) = own_network() else { return };
    let mut script = Command::new("unshare")
        .args(way)
        // Processes inside end with it.
        .args(["--pid", "--fork", "--kill-child", "bash", "-mec", SCRIPT, env!("CARGO_BIN_EXE_underfoot")])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .map(Served)
        .unwrap();
    let mut steps = script.0.stdin.take().unwrap();
    let mut said = BufReader::new(script.0.stdout.take().unwrap()).lines().map_while(Result::ok);
    let mut until = |text: &str| assert!(said.any(|line| line.contains(text)), "never said: {text}");
    until("no address 192.0.2.1 yet: waiting for it");
    writeln!(steps, "the network is there").unwrap();
    until("Listening on 192.0.2.1:9000");
    until(r#""event":"link","state":"live""#);
    writeln!(steps, "enough").unwrap();
    assert_eq!(script.0.wait().unwrap().code(), Some(0));
}
