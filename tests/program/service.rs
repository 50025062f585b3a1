//! The program under a service manager, and on a computer that starts before its network does.
#![cfg(unix)]

use std::io::{BufRead, BufReader};
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

/// Row R2. systemd is told that the program is ready and lives, by the thread that senses; one that hangs says nothing.
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
    // What was on its way.
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

/// Row N15. An address that this machine does not have (RFC 5737) may yet come.
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
