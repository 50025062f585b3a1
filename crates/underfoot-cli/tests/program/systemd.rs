//! The shipped unit under a real systemd, as process 1 of namespaces of its own: sandbox, watchdog and restarts.
//!
//! This needs root (or `sudo` without a password), Linux's namespaces and Debian's packages `systemd` and `iproute2`;
//! without one of them, the test prints its name and passes.
#![cfg(target_os = "linux")]

use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::units::Unit;

/// Time-out for an event that must happen.
const AT_LAST: Duration = Duration::from_secs(60);

/// An address for documentation (RFC 5737), which the box gets while the program waits for it.
const LATER: &str = "192.0.2.1";

const UNIT: &str = "underfoot.service";

/// A systemd with only this unit.
struct Machine {
    folder: tempfile::TempDir,
    script: Child,
    init: String,
}

/// A command as root.
fn as_root(program: &str) -> Command {
    let is_root = Command::new("id").arg("-u").output().is_ok_and(|output| output.stdout == b"0\n");
    if is_root {
        return Command::new(program);
    }
    let mut sudo = Command::new("sudo");
    sudo.arg("-n").arg(program);
    sudo
}

/// The reason why no systemd can be started here.
fn missing() -> Option<String> {
    let runs = |command: &mut Command| {
        let status = command.stdout(Stdio::null()).stderr(Stdio::null()).status();
        status.is_ok_and(|status| status.success())
    };
    let init = ["/usr/lib/systemd/systemd", "/lib/systemd/systemd"];
    let groups = || std::fs::read_to_string("/proc/mounts").is_ok_and(|mounts| mounts.contains(" cgroup2 "));
    let lacks = |what: &str| Some(format!("{what} is missing"));
    match () {
        () if !runs(&mut as_root("true")) => Some("this is neither root nor may it become root".into()),
        () if !init.iter().any(|path| Path::new(path).exists()) => lacks("systemd (Debian: systemd)"),
        () if !runs(as_root("ip").arg("-V")) => lacks("ip (Debian: iproute2)"),
        () if !groups() => lacks("a mounted cgroup2"),
        () => {
            let all = ["--mount", "--pid", "--fork", "--ipc", "--uts", "--net", "--cgroup", "true"];
            (!runs(as_root("unshare").args(all))).then(|| "namespaces can't be made".into())
        }
    }
}

impl Machine {
    fn start() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let (units, files) = (folder.path().join("etc/systemd/system"), folder.path().join("etc/underfoot"));
        std::fs::create_dir_all(&units).unwrap();
        std::fs::create_dir_all(&files).unwrap();
        let text = Unit::named(UNIT).text.replace("ExecStart=underfoot ", "ExecStart=/opt/program ");
        std::fs::write(units.join(UNIT), text).unwrap();
        std::fs::copy(
            concat!(env!("CARGO_MANIFEST_DIR"), "/../../layouts/map.ron"),
            files.join("layout.ron"),
        )
        .unwrap();
        std::fs::write(files.join("floor.ron"), "Floor(version: 1, columns: 6, rows: 6)").unwrap();
        let options = "UNDERFOOT_OPTIONS=--listen 127.0.0.1:9000 --device paced --record visit.mcap\n";
        std::fs::write(files.join("options"), options).unwrap();
        let script = as_root("bash")
            .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/program/systemd_box.sh"))
            .args([folder.path().as_os_str(), env!("CARGO_BIN_EXE_underfoot").as_ref(), UNIT.as_ref()])
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(std::fs::File::create(folder.path().join("log")).unwrap())
            .spawn()
            .unwrap();
        let mut started = Self { folder, script, init: String::new() };
        let (path, end) = (started.folder.path().join("init"), Instant::now() + AT_LAST);
        while started.init.is_empty() {
            started.init = std::fs::read_to_string(&path).unwrap_or_default().trim().to_owned();
            let is_over = started.script.try_wait().unwrap().is_some() || Instant::now() > end;
            assert!(!is_over, "{}", std::fs::read_to_string(started.folder.path().join("log")).unwrap());
            std::thread::sleep(Duration::from_millis(20));
        }
        started
    }

    /// A command that runs inside.
    fn command(&self, words: &str) -> Command {
        let mut command = as_root("nsenter");
        let root = format!("--root=/proc/{}/root", self.init);
        command.args(["-t", &self.init, "-m", "-p", "-i", "-u", "-n", "-C", &root, "--wd=/"]);
        command.args(words.split_whitespace());
        command
    }

    fn run(&self, words: &str) -> Output {
        self.command(words).output().unwrap()
    }

    fn say(&self, words: &str) -> String {
        String::from_utf8_lossy(&self.run(words).stdout).trim().to_owned()
    }

    /// A property of the unit, such as `MainPID`.
    fn property(&self, name: &str) -> String {
        self.say(&format!("systemctl show --value -p {name} {UNIT}"))
    }

    fn wait_until(&self, what: &str, happened: impl Fn() -> bool) {
        let end = Instant::now() + AT_LAST;
        while !happened() {
            assert!(
                Instant::now() < end,
                "never happened: {what}\n{}\n{}",
                self.say(&format!("systemctl status --no-pager {UNIT}")),
                self.say("tail -n 20 /run/said")
            );
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Waits until the program serves again, as another process than `before`; returns the number of the new one.
    fn wait_until_another_serves(&self, what: &str, before: &str) -> String {
        let is_other = || !["0", "", before].contains(&self.property("MainPID").as_str());
        self.wait_until(what, || is_other() && self.property("ActiveState") == "active");
        self.property("MainPID")
    }

    /// Sends a signal to the unit's program.
    fn signal(&self, process: &str, name: &str) {
        assert!(self.run(&format!("kill -s {name} {process}")).status.success());
    }
}

impl Drop for Machine {
    fn drop(&mut self) {
        // The script ends its systemd, and all processes there, when its input ends.
        drop(self.script.stdin.take());
        let _ = self.script.wait();
    }
}

// N15, R1, R2
#[test]
fn systemd_starts_the_unit_locked_up_and_again_whatever_becomes_of_it() {
    if let Some(why) = missing() {
        println!("not run: {why}");
        return;
    }
    let inside = Machine::start();
    let first = inside.wait_until_another_serves("it serves", "");

    let status = inside.say(&format!("cat /proc/{first}/status"));
    for line in ["NoNewPrivs:\t1", "Seccomp:\t2", "CapEff:\t0000000000000000", "CapBnd:\t0000000000000000"] {
        assert!(status.contains(line), "{line} in {status}");
    }
    assert!(!status.contains("Uid:\t0"), "a user of its own: {status}");
    let recording = inside.say("stat -c %a /var/lib/underfoot/visit.mcap");
    assert_eq!(recording, "600", "{}", inside.say("ls -lR /var/lib"));

    // Six crashes in a row: by systemd's default rule (five starts in ten seconds) it would not start again.
    let mut process = first;
    for _ in 0..6 {
        inside.signal(&process, "KILL");
        process = inside.wait_until_another_serves("it serves again after it was killed", &process);
    }
    inside.signal(&process, "STOP");
    let process = inside.wait_until_another_serves("it serves again after it hung", &process);
    assert_eq!(inside.property("NRestarts"), "7");

    // A network card that appears later.
    let options = format!("UNDERFOOT_OPTIONS=--listen {LATER}:9000 --device paced");
    std::fs::write(inside.folder.path().join("options"), options).unwrap();
    let mut tee = inside.command("tee /etc/underfoot/options");
    let new = std::fs::File::open(inside.folder.path().join("options")).unwrap();
    assert!(tee.stdin(new).stdout(Stdio::null()).status().unwrap().success());
    inside.signal(&process, "KILL");
    let waits = || inside.say("cat /run/said").contains(&format!("no address {LATER} yet: waiting for it"));
    inside.wait_until("it waits for the address", waits);
    assert_eq!(inside.property("ActiveState"), "activating");
    assert!(inside.run("ip link set lo up").status.success());
    assert!(inside.run(&format!("ip addr add {LATER}/32 dev lo")).status.success());
    inside.wait_until_another_serves("it serves once the address is there", &process);

    assert!(inside.run(&format!("systemctl stop {UNIT}")).status.success());
    assert_eq!(
        (inside.property("ActiveState"), inside.property("Result")),
        ("inactive".into(), "success".into())
    );
}
