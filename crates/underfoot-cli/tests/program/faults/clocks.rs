//! N9 and N13: a wall clock that is set, and a program that reads too late.
#![cfg(target_os = "linux")]

use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::live::Live;
use super::tape::{BUTTON, PEDAL};

/// Number of attempts at a hold that a busy machine may lose packets of.
const TRIES: usize = 6;

/// libfaketime for programs with threads, in the folders of Debian and others.
fn faketime() -> Option<PathBuf> {
    let folders = ["/usr/lib", "/usr/lib64", "/usr/local/lib"].iter().map(Path::new);
    let triples = Path::new("/usr/lib").read_dir().into_iter().flatten().flatten().map(|entry| entry.path());
    let folders = folders.map(Path::to_owned).chain(triples);
    folders.map(|folder| folder.join("faketime/libfaketimeMT.so.1")).find(|path| path.is_file())
}

/// Row N9. The clock of this process alone is set, by a day forwards and by two back; a foot keeps holding its
/// control. The process's monotonic clock continues, as a computer's does when the time is set.
#[test]
fn a_wall_clock_that_is_set_by_a_day_ends_no_hold() {
    let Some(library) = faketime() else {
        println!("not run: there is no libfaketime (Debian: apt-get install libfaketime)");
        return;
    };
    for _ in 0..TRIES {
        let folder = tempfile::tempdir().unwrap();
        let clock = folder.path().join("clock");
        let set = |offset: &str| {
            let new = folder.path().join("new");
            std::fs::write(&new, format!("{offset}\n")).unwrap();
            std::fs::rename(new, &clock).unwrap();
        };
        set("+0");
        let live = Live::start_as(PEDAL, |run| {
            // The log names each other sender once a minute, which shows the program's clock.
            run.args(["--allow", "127.0.0.1"])
                .env("LD_PRELOAD", &library)
                .env("FAKETIME_TIMESTAMP_FILE", &clock)
                .env("FAKETIME_NO_CACHE", "1")
                .env("FAKETIME_DONT_FAKE_MONOTONIC", "1")
                .env("DONT_FAKE_MONOTONIC", "1");
        });
        live.press_until_it_is_held();
        let before = live.ends();
        let mut days = Vec::new();
        for offset in ["+0", "+1d", "-1d"] {
            set(offset);
            std::thread::sleep(Duration::from_secs(1));
            days.push(day_that_the_log_shows(&live, days.len() + 1));
        }
        if live.ends() > before {
            // If a starved machine has lost the floor as well, the attempt does not count.
            assert!(live.was_lost(), "cancelled although packets came: {:?}", live.lines());
            continue;
        }
        days.sort();
        days.dedup();
        assert_eq!(days.len(), 3, "the clock was not set: {days:?}");
        live.press(0.0);
        live.wait_until("it is released", |live| live.count("it released") > 0);
        assert_eq!(live.end().0, Some(0));
        return;
    }
    panic!("the floor was lost {TRIES} times");
}

/// The day of the program's clock, from the line that it logs about the `number`th sender that may not send.
fn day_that_the_log_shows(live: &Live, number: usize) -> String {
    let sender = UdpSocket::bind((format!("127.0.0.{}", 10 + number), 0)).unwrap();
    let from = format!("127.0.0.{}", 10 + number);
    sender.send_to(&live.take_sent()[0], live.address).unwrap();
    live.wait_until("it is logged", |live| live.has_said(&from));
    let line = live.chatter_line(&from);
    line.split('T').next().unwrap().to_owned()
}

/// Row N13. The program is stopped while datagrams fill its receive buffer: it counts the packets that the kernel
/// drops and reports them with the setting that helps.
#[test]
fn datagrams_that_the_kernel_drops_are_counted_and_the_setting_is_named() {
    let live = Live::start(BUTTON, &[]);
    live.signal("STOP");
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    // The kernel counts each with its own overhead: some 10,000 fill the 8 MiB that the program requests.
    let filler = [0; 1400];
    for _ in 0..60_000 {
        let _ = socket.send_to(&filler, live.address);
    }
    live.signal("CONT");
    live.wait_until("it says so", |live| live.has_said("the system dropped"));
    live.tap_until_it_clicks();
    let (code, said) = live.end();
    assert_eq!(code, Some(0));
    assert!(said.contains("net.core.rmem_max"), "{said}");
    let dropped = said.lines().rev().find(|line| line.contains("were dropped by the system")).unwrap();
    let count: u64 = dropped.split(' ').next().unwrap().parse().unwrap();
    assert!(count > 1000, "{dropped}");
}
