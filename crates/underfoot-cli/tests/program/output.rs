//! The program's output without a reader: a full disk, a reader that has gone or stalls.
#![cfg(unix)]

use std::fs::OpenOptions;
use std::net::UdpSocket;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::end_to_end::{Served, terminate, underfoot};
use crate::ports::free_port;

/// A file on a disk that is always full, from Linux.
fn full() -> Option<Stdio> {
    OpenOptions::new().write(true).open("/dev/full").ok().map(Stdio::from)
}

/// A pipe with a closed reader.
fn closed() -> Stdio {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    writer.into()
}

/// Runs a command with these outputs; returns its exit status and its standard error, if `err` is `None`.
fn status(arguments: &[&str], folder: &Path, out: Stdio, err: Option<Stdio>) -> (Option<i32>, String) {
    let mut command: Command = underfoot();
    command.args(arguments).current_dir(folder).stdin(Stdio::null()).stdout(out);
    let output =
        command.stderr(err.unwrap_or_else(Stdio::piped)).spawn().unwrap().wait_with_output().unwrap();
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// Commands that print, on standard output or standard error.
const PRINTERS: [&[&str]; 10] = [
    &["--help"],
    &["--version"],
    &["completions", "bash"],
    &["man"],
    &["reference"],
    &["addresses", "map"],
    &["check", "map.ron"],
    &["check", "--rules"],
    &["rack", "map"],
    &["sense", "table.csv"],
];

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../../layouts/map.ron");
    std::fs::copy(layout, folder.path().join("map.ron")).unwrap();
    let table = "t_s,col,row,f_sw,f_se,f_nw,f_ne\n0.000,1,0,25,25,25,25\n";
    std::fs::write(folder.path().join("table.csv"), table).unwrap();
    folder
}

#[test]
fn a_full_disk_under_standard_output_is_said_and_fails() {
    let folder = folder();
    for arguments in PRINTERS {
        let Some(out) = full() else { return };
        let (code, said) = status(arguments, folder.path(), out, None);
        assert_eq!(code, Some(1), "{arguments:?}: {said}");
        assert!(
            said.contains("the output is not complete") && !said.contains("panicked"),
            "{arguments:?}: {said}"
        );
    }
}

#[test]
fn a_reader_of_standard_output_that_has_gone_is_no_panic() {
    let folder = folder();
    for arguments in PRINTERS {
        let (code, said) = status(arguments, folder.path(), closed(), None);
        assert_eq!(code, Some(1), "{arguments:?}: {said}");
        assert_eq!(said, "", "{arguments:?}: a reader that left need not be told");
    }
}

#[test]
fn standard_error_that_takes_nothing_fails_and_is_no_panic() {
    let folder = folder();
    std::fs::write(folder.path().join("bad.ron"), "Layout(").unwrap();
    // A panic ends with 101.
    for arguments in
        [&["check", "bad.ron"] as &[&str], &["measure", "--seconds", "0.1"], &["no_such_command"]]
    {
        for err in [Some(closed()), full()].into_iter().flatten() {
            let (code, _) = status(arguments, folder.path(), Stdio::null(), Some(err));
            assert!(matches!(code, Some(1 | 2)), "{arguments:?}: {code:?}");
        }
    }
}

/// Packets of an empty floor of 6 x 6, and one request each time that is refused.
fn flood(address: &str, until: Instant) -> u64 {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let refused = b"/underfoot/widget/nobody/get\0\0\0\0,\0\0\0";
    let mut sent = 0;
    while Instant::now() < until {
        for datagram in [&refused[..], b"rubbish", b"/no/such\0\0\0\0,\0\0\0"] {
            sent += u64::from(socket.send_to(datagram, address).is_ok());
        }
    }
    sent
}

/// Whether the server answers a request: then it still senses and answers.
fn answers(address: &str) -> bool {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    socket.set_read_timeout(Some(Duration::from_millis(200))).unwrap();
    let mut answer = [0; 256];
    (0..25).any(|_| {
        socket.send_to(b"/underfoot/page/get\0,\0\0\0", address).unwrap();
        socket.recv(&mut answer).is_ok_and(|length| answer[..length].starts_with(b"/underfoot/page"))
    })
}

/// A server with the standard error `err`.
fn serve(err: Stdio) -> (Served, String) {
    let address = format!("127.0.0.1:{}", free_port());
    let server = underfoot()
        .args(["run", "map", "--no-osc", "-v", "--wav", "/dev/null", "--listen", &address])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(err)
        .spawn()
        .map(Served)
        .unwrap();
    (server, address)
}

/// Ends the server by SIGTERM and returns its exit status.
pub(super) fn ended(mut server: Served) -> Option<i32> {
    terminate(&server.0);
    server.0.wait().unwrap().code()
}

// P6
#[test]
fn a_flood_of_refused_requests_and_rubbish_leaves_a_short_log() {
    let (mut server, address) = serve(Stdio::piped());
    let log = server.0.stderr.take().unwrap();
    let reader = std::thread::spawn(move || std::io::read_to_string(log).unwrap());
    assert!(answers(&address));
    let sent = flood(&address, Instant::now() + Duration::from_secs(2));
    assert!(answers(&address), "the server answers after {sent} datagrams");
    assert_eq!(ended(server), Some(0));
    let log = reader.join().unwrap();
    assert!(log.lines().count() < 60, "{} lines after {sent} datagrams:\n{log:.2000}", log.lines().count());
    assert!(log.contains("/underfoot/widget/nobody/get refused"), "{log}");
    assert!(!log.contains('\u{1b}'), "a pipe gets no colours: {log}");
}

/// The memory of a process, in kB.
#[cfg(target_os = "linux")]
pub(super) fn memory_kb(process: &str) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let memory = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
    memory.trim().trim_end_matches(" kB").parse().unwrap()
}

/// The memory of a process, in kB, and its processor time, in ticks of the kernel.
#[cfg(target_os = "linux")]
fn used(process: &Child) -> (u64, u64) {
    let stat = std::fs::read_to_string(format!("/proc/{}/stat", process.id())).unwrap();
    let ticks = stat.rsplit(')').next().unwrap().split_whitespace().skip(11).take(2);
    (memory_kb(&process.id().to_string()), ticks.map(|ticks| ticks.parse::<u64>().unwrap()).sum())
}

/// Row R4. A minute of the packets that one sender can send, and no others: for an idle machine, in a release build.
/// With the log in a pipe, on a full disk, and with standard error closed.
#[test]
#[ignore = "takes three minutes"]
#[cfg(target_os = "linux")]
fn a_minute_of_floods_takes_no_memory_and_half_a_core() {
    const TICKS_A_SECOND: f64 = 100.0;
    for err in [None, full(), Some(closed())] {
        let is_read = err.is_none();
        let (mut server, address) = serve(err.unwrap_or_else(Stdio::piped));
        let log = server.0.stderr.take();
        let reader = std::thread::spawn(move || log.map(|log| std::io::read_to_string(log).unwrap()));
        assert!(answers(&address));
        flood(&address, Instant::now() + Duration::from_secs(5));
        let (memory, ticks) = used(&server.0);
        let begun = Instant::now();
        let sent = flood(&address, begun + Duration::from_secs(60));
        let seconds = begun.elapsed().as_secs_f64();
        assert!(answers(&address), "after {sent} datagrams");
        let (memory_after, ticks_after) = used(&server.0);
        let core = (ticks_after - ticks) as f64 / TICKS_A_SECOND / seconds;
        assert_eq!(ended(server), Some(i32::from(!is_read)));
        let log = reader.join().unwrap().map_or(0, |log| log.len());
        println!(
            "{:.0} datagrams a second for {seconds:.0} s: {core:.2} of a core, memory {memory} -> {memory_after} kB, log \
             {log} bytes",
            sent as f64 / seconds
        );
        assert!(memory_after < memory + 1024 && core < 0.5 && log < 1_000_000);
    }
}

/// With any standard error, the server continues sensing, and its exit status reports the failure.
#[test]
fn a_server_outlives_its_log() {
    for err in [Some(closed()), full()].into_iter().flatten() {
        let (server, address) = serve(err);
        assert!(answers(&address));
        flood(&address, Instant::now() + Duration::from_millis(300));
        assert!(answers(&address));
        assert_eq!(ended(server), Some(1));
    }
}

/// A reader that stalls with a full pipe does not delay the server.
#[test]
fn a_reader_of_the_log_that_stalls_holds_up_nothing() {
    let (reader, writer) = std::io::pipe().unwrap();
    // Fills the pipe, so that the server's first message finds it full.
    let mut filler: Child = Command::new("sh")
        .args(["-c", "head -c 100000 /dev/zero"])
        .stdout(Stdio::from(writer.try_clone().unwrap()))
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(300));
    let (server, address) = serve(writer.into());
    assert!(answers(&address), "a stalled log holds the server up");
    flood(&address, Instant::now() + Duration::from_millis(300));
    assert!(answers(&address));
    assert_eq!(ended(server), Some(1));
    drop(reader);
    filler.wait().unwrap();
}

/// Events that do not fit on a full disk are reported, and so in the exit status; the server continues.
// F4
#[test]
fn events_on_a_full_disk_are_told_and_fail() {
    let Some(out) = full() else { return };
    let address = format!("127.0.0.1:{}", free_port());
    let mut server = underfoot()
        .args(["run", "map", "--json", "--no-osc", "--wav", "/dev/null", "--listen", &address])
        .stdout(out)
        .stderr(Stdio::piped())
        .spawn()
        .map(Served)
        .unwrap();
    assert!(answers(&address));
    // A change of the link's state is an event.
    for sequence in 1..20 {
        super::senders::packets(sequence).iter().for_each(|packet| {
            UdpSocket::bind("127.0.0.1:0").unwrap().send_to(packet, &address).unwrap();
        });
    }
    std::thread::sleep(Duration::from_millis(300));
    assert!(answers(&address), "sensing goes on");
    let err = server.0.stderr.take().unwrap();
    assert_eq!(ended(server), Some(1));
    let said = std::io::read_to_string(err).unwrap();
    assert!(said.contains("events are not written") && said.contains("the output is not complete"), "{said}");
}
