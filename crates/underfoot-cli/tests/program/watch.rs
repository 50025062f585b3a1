//! Health, metrics and dashboard of a running floor, over real sockets.

use std::collections::HashMap;
use std::net::SocketAddr;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tungstenite::{Message, client};

use crate::end_to_end::underfoot;
use crate::holds::client::Client;
use crate::holds::site::{BoardFault, Boards, Run, Site};
use crate::web::{answer, free_address, stream};

/// Time-out for an event that must happen.
const AT_LAST: Duration = Duration::from_secs(30);

fn run(site: &Site, more: &[&str]) -> (Run, SocketAddr) {
    let web = free_address();
    let others = Client::new();
    let run = site.run(&others, &[&["--web", &web.to_string()], more].concat());
    (run, web)
}

/// The status and the body of the answer at this path.
fn get(web: SocketAddr, path: &str) -> (u16, String) {
    let said = answer(web, path, "");
    let (head, body) = said.split_once("\r\n\r\n").unwrap_or_else(|| panic!("{said:?}"));
    (head.split(' ').nth(1).unwrap().parse().unwrap(), body.to_owned())
}

/// Health, once it is as wanted.
fn health_when(web: SocketAddr, what: &str, is_so: impl Fn(u16, &Value) -> bool) -> Value {
    let end = Instant::now() + AT_LAST;
    loop {
        let (status, body) = get(web, "/health");
        let health: Value = serde_json::from_str(&body).unwrap();
        if is_so(status, &health) {
            return health;
        }
        assert!(Instant::now() < end, "never so: {what}; {status} {health}");
        thread::sleep(Duration::from_millis(50));
    }
}

/// The samples of the metrics: names with labels, and values.
fn samples(web: SocketAddr) -> HashMap<String, f64> {
    let (status, text) = get(web, "/metrics");
    assert_eq!(status, 200);
    assert!(text.ends_with("# EOF\n"), "{text}");
    let samples = text.lines().filter(|line| !line.starts_with('#'));
    samples
        .map(|line| {
            let (name, value) = line.rsplit_once(' ').unwrap();
            (name.to_owned(), value.parse().unwrap_or_else(|_| panic!("{line}")))
        })
        .collect()
}

#[test]
fn a_watcher_learns_whether_a_floor_works_and_why_not() {
    let site = Site::new();
    let (run, web) = run(&site, &[]);
    let waiting =
        health_when(web, "it waits", |status, health| status == 503 && health["status"] == "failed");
    assert!(waiting["reasons"][0].as_str().unwrap().contains("waits for boards"), "{waiting}");
    assert_eq!(waiting["off"][0]["off"], "waiting");
    let boards = Boards::start(&site, run.address);
    let live = health_when(web, "it works", |status, health| status == 200 && health["link"] == "live");
    assert_eq!(live["status"], "ok", "{live}");
    boards.suffer(BoardFault::OneSilent);
    let partial = health_when(web, "a board is missing", |status, health| {
        status == 200 && health["status"] == "degraded"
    });
    let reason = partial["reasons"][0].as_str().unwrap();
    assert!(reason.contains("board 1"), "{partial}");
    assert_eq!(
        (&partial["boards"][0]["state"], &partial["boards"][1]["state"]),
        (&json!("live"), &json!("stale"))
    );
    boards.suffer(BoardFault::Silent);
    health_when(web, "the floor is lost", |status, health| status == 503 && health["link"] == "lost");
    boards.suffer(BoardFault::Well);
    let back = health_when(web, "it works again", |_, health| health["status"] == "ok");
    assert_eq!(back["packets"]["losses"], 1);
    drop(boards);
}

#[test]
fn metrics_count_packets_of_boards_and_events_of_feet() {
    let site = Site::new();
    let (run, web) = run(&site, &[]);
    let boards = Boards::start(&site, run.address);
    health_when(web, "feet hold both", |_, health| {
        health["held"].as_array().is_some_and(|held| held.len() == 2)
    });
    let first = samples(web);
    assert_eq!(first[r#"underfoot_events_total{kind="pressed"}"#], 2.0);
    assert_eq!(first[r#"underfoot_link{state="live"}"#], 1.0);
    assert_eq!(first[r#"underfoot_health{state="ok"}"#], 1.0);
    assert_eq!((first["underfoot_feet"], first["underfoot_controls_held"]), (2.0, 2.0));
    assert_eq!(first[&format!(r#"underfoot_build_info{{version="{}"}}"#, env!("CARGO_PKG_VERSION"))], 1.0);
    boards.suffer(BoardFault::OneSilent);
    thread::sleep(Duration::from_millis(500));
    let later = samples(web);
    let of_board = |samples: &HashMap<String, f64>, name: &str, number: usize| {
        let address = &site.floor.boards[number].address;
        samples[&format!(r#"underfoot_{name}{{board="{number}",address="{address}"}}"#)]
    };
    let grown = [0, 1].map(|number| {
        of_board(&later, "board_packets_total", number) - of_board(&first, "board_packets_total", number)
    });
    assert!(grown[0] > grown[1] + 100.0, "{grown:?}");
    assert!(of_board(&later, "board_age_seconds", 1) > 0.3);
    assert!(of_board(&later, "board_age_seconds", 0) < 0.3);
    assert_eq!(later["underfoot_boards_live"], 1.0);
    drop(boards);
}

#[test]
fn every_metric_has_its_help_and_its_type() {
    let site = Site::new();
    let (_run, web) = run(&site, &[]);
    let (_, text) = get(web, "/metrics");
    let names: Vec<&str> =
        text.lines().filter_map(|line| line.strip_prefix("# TYPE ")?.split(' ').next()).collect();
    assert!(names.len() > 30, "{names:?}");
    for name in &names {
        assert!(text.contains(&format!("# HELP {name} ")), "{name}");
    }
    for unit in ["underfoot_uptime_seconds seconds", "underfoot_board_age_seconds seconds"] {
        assert!(text.contains(&format!("# UNIT {unit}\n")), "{unit}: {text}");
    }
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let sample = line.split(['{', ' ']).next().unwrap();
        assert!(names.iter().any(|name| sample.starts_with(name)), "{line}");
    }
}

/// The first value of the result of a query.
fn queried(prometheus: SocketAddr, query: &str) -> Option<f64> {
    let said = answer(prometheus, &format!("/api/v1/query?query={query}"), "Connection: close\r\n");
    let (_, body) = said.split_once("\r\n\r\n")?;
    let body = body.get(body.find('{')?..=body.rfind('}')?)?;
    let found: Value = serde_json::from_str(body).ok()?;
    found["data"]["result"][0]["value"][1].as_str()?.parse().ok()
}

/// Debian's package `prometheus`; without it nothing is tried, which `./dev test` prints beforehand.
#[test]
fn prometheus_scrapes_a_floor() {
    let (site, folder) = (Site::new(), tempfile::tempdir().unwrap());
    let (run, web) = run(&site, &[]);
    let boards = Boards::start(&site, run.address);
    let own = free_address();
    let config = format!(
        "global: {{scrape_interval: 1s}}\nscrape_configs: [{{job_name: floor, static_configs: [{{targets: ['{web}']}}]}}]\n"
    );
    std::fs::write(folder.path().join("prometheus.yml"), config).unwrap();
    let started = Command::new("prometheus")
        .current_dir(folder.path())
        .args(["--config.file=prometheus.yml", "--storage.tsdb.path=data"])
        .arg(format!("--web.listen-address={own}"))
        .stderr(Stdio::null())
        .spawn();
    let Ok(mut prometheus) = started else {
        println!("not run: there is no prometheus; apt-get install prometheus");
        return;
    };
    // Until it has started, nobody listens there.
    let end = Instant::now() + AT_LAST;
    let is_up = || std::net::TcpStream::connect(own).is_ok() && queried(own, "up") == Some(1.0);
    let pressed = || queried(own, "underfoot_events_total{kind=%22pressed%22}") == Some(2.0);
    while !(is_up() && pressed()) && Instant::now() < end {
        thread::sleep(Duration::from_millis(200));
    }
    let found = [is_up(), pressed(), queried(own, "sum(underfoot_board_packets_total)") > Some(100.0)];
    prometheus.kill().unwrap();
    prometheus.wait().unwrap();
    assert_eq!(found, [true; 3], "up, events and packets");
    drop(boards);
}

#[test]
fn a_press_on_a_control_that_an_app_switched_off_is_counted_and_named() {
    let [floor, web] = [free_address(), free_address()].map(|address| address.to_string());
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("visit.ron"), include_str!("visit.ron")).unwrap();
    let mut served = underfoot()
        .current_dir(folder.path())
        .args(["run", "map", "--listen", &floor, "--web", &web, "--json", "--no-osc", "--wav", "out.wav"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let web: SocketAddr = web.parse().unwrap();
    let (mut socket, _) = client(format!("ws://{web}/"), stream(web)).unwrap();
    socket.send(Message::text(json!({"request": "widget/home/disable", "args": []}).to_string())).unwrap();
    let is_it = |line: &str| line.contains(r#""event":"ignored""#) && line.contains(r#""reason":"disabled""#);
    // A client that does not read would be dropped.
    let page = thread::spawn(move || {
        std::iter::from_fn(|| socket.read().ok())
            .filter_map(|message| message.into_text().ok())
            .find(|line| is_it(line))
    });
    let simulated = underfoot()
        .current_dir(folder.path())
        .args(["simulate", "--quality", "paper", "--scenario", "visit.ron", "--send", &floor])
        .stderr(Stdio::null())
        .status()
        .unwrap();
    assert!(simulated.success());
    let health = health_when(web, "it was ignored", |_, health| health["ignored"]["counts"]["disabled"] == 1);
    let latest = health["ignored"]["latest"].as_array().unwrap();
    let press = latest.iter().find(|press| press["reason"] == "disabled").unwrap();
    assert_eq!((&press["id"], &press["why"]), (&json!("home"), &json!("an app has switched it off")));
    assert!(press["force_n"].as_f64().unwrap() > 100.0);
    assert_eq!(samples(web)[r#"underfoot_presses_ignored_total{reason="disabled"}"#], 1.0);
    // The same over WebSocket and on standard output.
    let line = page.join().unwrap().unwrap();
    served.kill().unwrap();
    let out = std::io::read_to_string(served.stdout.take().unwrap()).unwrap();
    served.wait().unwrap();
    assert!(out.lines().any(|other| other == line.as_str()), "{line}");
}

// W4
#[test]
fn names_that_lead_here_by_a_trick_and_pages_from_elsewhere_read_nothing() {
    let site = Site::new();
    let (_run, web) = run(&site, &["--web-origin", "http://floor.lan:9002"]);
    let with_host = |path: &str, host: &str| {
        use std::io::{Read, Write};
        let mut stream = stream(web);
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {host}\r\n\r\n").unwrap();
        let mut said = String::new();
        stream.read_to_string(&mut said).unwrap();
        said
    };
    for path in ["/health", "/metrics", "/dashboard"] {
        assert!(with_host(path, "evil.example:9002").starts_with("HTTP/1.1 403"), "{path}");
        assert!(!with_host(path, "floor.lan:9002").starts_with("HTTP/1.1 403"), "{path}");
        let foreign = answer(web, path, "Origin: https://evil.example\r\n");
        assert!(foreign.starts_with("HTTP/1.1 403"), "{foreign}");
    }
}

#[test]
fn the_dashboard_runs_no_inline_script_and_asks_no_other_host() {
    let site = Site::new();
    let (_run, web) = run(&site, &[]);
    for path in ["/dashboard", "/dashboard.js", "/dashboard.css"] {
        let said = answer(web, path, "");
        let (head, body) = said.split_once("\r\n\r\n").unwrap();
        assert!(head.starts_with("HTTP/1.1 200"), "{head}");
        assert!(head.contains("default-src 'none'; script-src 'self'") && !head.contains("unsafe"), "{head}");
        assert!(!body.contains("//cdn") && !body.contains("http:") && !body.contains("https:"), "{path}");
    }
}
