//! Every hold ends: a client has no hold any more soon after the program, its floor or the way between them has
//! failed in any way.

pub mod client;
mod session;
pub mod site;

use std::process::Command;
use std::time::{Duration, Instant};

use underfoot::wire::SensorFormat;

use self::client::Client;
use self::site::{BoardFault, Boards, Run, Site};

/// Longest time that a client may still keep a hold.
const SOON: Duration = Duration::from_millis(150);

/// Number of attempts on a machine that may be busy; the messages and their order do not depend on time and count
/// every time.
const TRIES: usize = 6;

/// The expected end of the program.
#[derive(Clone, Copy, PartialEq)]
enum Then {
    /// It ends by itself with success.
    Ends,
    /// It would continue, or has ended already.
    IsEnded,
}

/// Holds `drive` and drags `zoom`, then does `end`; returns the time for which the slower of two clients kept the
/// holds.
fn believed_for(
    site: &Site,
    more: &[&str],
    then: Then,
    end: impl FnOnce(&Run, &Boards),
) -> (Duration, Client) {
    let mut client = Client::new();
    let mut run = site.run(&client, more);
    let boards = Boards::start(site, run.address);
    client.wait_until("both are held", |client| client.holds() == ["drive", "zoom"]);
    client.watch_json(&mut run.child);
    client.wait_until("the reader of JSON knows", |client| client.json_holds() == ["drive", "zoom"]);
    let begun = Instant::now();
    end(&run, &boards);
    client
        .wait_until("nothing is held", |client| client.holds().is_empty() && client.json_holds().is_empty());
    let took = begun.elapsed();
    if then == Then::Ends {
        assert!(run.child.wait().unwrap().success());
    } else {
        // Notices for the operator are checked ten times a second.
        std::thread::sleep(Duration::from_millis(300));
    }
    drop(boards);
    client.chatter = Some(run.end());
    client.hear_the_rest();
    (took, client)
}

/// Time for which a client keeps the pedal's hold after sensors under it begin to repeat and the foot begins to
/// leave.
fn pedal_believed_for(site: &Site, fault: BoardFault) -> Duration {
    let mut client = Client::new();
    let run = site.run(&client, &[]);
    let boards = Boards::start(site, run.address);
    client.wait_until("both are held", |client| client.holds() == ["drive", "zoom"]);
    let begun = Instant::now();
    boards.suffer(fault);
    client.wait_until("the pedal is let go", |client| !client.holds().contains(&"drive".to_owned()));
    let took = begun.elapsed();
    drop(boards);
    run.end();
    took
}

/// Faults in which sensors repeat their readings and the foot leaves.
const STANDING_STILL: [BoardFault; 3] =
    [BoardFault::TwoCorners, BoardFault::FourCorners, BoardFault::AllButOneBit];

const FORMATS: [SensorFormat; 3] = [SensorFormat::Counts, SensorFormat::Newtons, SensorFormat::Blob];

/// Repeats [`believed_for`] until the time is at most [`SOON`]; returns the last client.
fn soon(site: &Site, more: &[&str], then: Then, end: impl Fn(&Run, &Boards)) -> Client {
    let mut times = Vec::new();
    for _ in 0..TRIES {
        let (took, client) = believed_for(site, more, then, &end);
        times.push(took);
        if took <= SOON {
            println!("believed for {took:?}");
            return client;
        }
    }
    panic!("never within {SOON:?}: {times:?}");
}

/// The time for which a client keeps the holds when the sensing thread panics, and when `--seconds` are over: from
/// the first message about it to the other clients.
fn believed_after_the_first_word(site: &Site, more: &[&str]) -> (Duration, Client) {
    let mut client = Client::new();
    let mut run = site.run(&client, more);
    let boards = Boards::start(site, run.address);
    client.wait_until("both are held", |client| client.holds() == ["drive", "zoom"]);
    client.watch_json(&mut run.child);
    client.wait_until("somebody hears of the end", |client| client.said("drive", "cancelled") > 0);
    let begun = Instant::now();
    client
        .wait_until("nothing is held", |client| client.holds().is_empty() && client.json_holds().is_empty());
    let took = begun.elapsed();
    run.child.wait().unwrap();
    drop(boards);
    client.chatter = Some(run.end());
    client.hear_the_rest();
    (took, client)
}

/// Row R1. The sensing thread panics, in the program itself.
#[test]
fn a_panic_in_the_sensing_thread_cancels_what_is_held_and_fails() {
    let site = Site::new();
    let (_, mut client) = believed_after_the_first_word(&site, &["--fault", "panic=7s"]);
    client.expect_an_orderly_end("panic");
    let chatter = client.chatter.take().unwrap();
    assert!(chatter.iter().any(|line| line.contains("a part of the program failed")), "{chatter:?}");
}

/// In any format of boards, and with any sensors that repeat their readings.
#[test]
fn sensors_that_stand_still_keep_no_pedal() {
    for format in FORMATS {
        let site = Site::sending(format);
        for fault in STANDING_STILL {
            let mut times = Vec::new();
            while times.last().is_none_or(|took| *took > SOON) {
                assert!(times.len() < TRIES, "{format:?}, {fault:?}: never within {SOON:?}: {times:?}");
                times.push(pedal_believed_for(&site, fault));
            }
        }
    }
}

/// `cargo nextest run --release --test program --run-ignored all twenty_rounds_of_sensors --no-capture`
#[test]
#[ignore = "a measurement of minutes; figures of a machine that is busy say nothing"]
fn twenty_rounds_of_sensors_that_stand_still() {
    let mut late = Vec::new();
    for format in FORMATS {
        let site = Site::sending(format);
        for fault in [BoardFault::Frozen].into_iter().chain(STANDING_STILL) {
            let mut times: Vec<Duration> = (0..20).map(|_| pedal_believed_for(&site, fault)).collect();
            times.sort();
            println!("{format:?}, {fault:?}: median {:?}, longest {:?}", times[10], times[19]);
            late.extend((times[19] > SOON).then(|| format!("{format:?}, {fault:?}: {times:?}")));
        }
    }
    assert!(late.is_empty(), "{late:#?}");
}

/// Twenty rounds of each end, the longest time of each: for an idle machine, in a release build.
#[test]
#[ignore = "takes ten minutes; figures of a machine that is busy say nothing"]
fn twenty_rounds_of_each_end() {
    let site = Site::new();
    type Ending<'a> = Box<dyn Fn() -> Duration + 'a>;
    let site = &site;
    let by = |end: fn(&Run, &Boards), then| -> Ending<'_> {
        Box::new(move || believed_for(site, &[], then, end).0)
    };
    let endings: [(&str, Ending<'_>); 10] = [
        ("SIGTERM", by(|run, _| signal(run, "TERM"), Then::Ends)),
        ("SIGINT", by(|run, _| signal(run, "INT"), Then::Ends)),
        ("SIGHUP", by(|run, _| signal(run, "HUP"), Then::Ends)),
        ("kill -9", by(|run, _| signal(run, "KILL"), Then::IsEnded)),
        ("SIGSTOP", by(|run, _| signal(run, "STOP"), Then::IsEnded)),
        ("packets stop", by(|_, boards| boards.suffer(BoardFault::Silent), Then::IsEnded)),
        ("values frozen", by(|_, boards| boards.suffer(BoardFault::Frozen), Then::IsEnded)),
        ("a row jumps", by(|_, boards| boards.suffer(BoardFault::Jumped), Then::IsEnded)),
        ("panic", Box::new(|| believed_after_the_first_word(site, &["--fault", "panic=4s"]).0)),
        ("--seconds", Box::new(|| believed_after_the_first_word(site, &["--seconds", "4"]).0)),
    ];
    let mut late = Vec::new();
    for (name, end) in &endings {
        let mut times: Vec<Duration> = (0..20).map(|_| end()).collect();
        times.sort();
        println!("{name}: median {:?}, longest {:?}", times[10], times[19]);
        late.extend((times[19] > SOON).then(|| format!("{name}: {times:?}")));
    }
    assert!(late.is_empty(), "{late:#?}");
}

/// A simulated fault ends all holds as well, and is marked as simulated.
#[test]
fn a_rehearsed_fault_ends_what_is_held() {
    let site = Site::new();
    let (_, mut client) = believed_for(&site, &["--fault", "silent=7s..60s"], Then::IsEnded, |_, _| {});
    client.expect_cancelled("rehearsed");
    let chatter = client.chatter.take().unwrap();
    assert!(chatter.iter().any(|line| line.contains("nothing usable")), "{chatter:?}");
}

/// Row N11. Feet stand on the tiles of one board, which sends its packets under the address of the other.
#[test]
fn boards_that_have_changed_places_are_named_and_press_nothing() {
    let site = Site::new();
    let mut client = Client::new();
    let run = site.run(&client, &["--fault", "swapped=0:1"]);
    let boards = Boards::start(&site, run.address);
    client.wait_until("it runs for three seconds", |client| client.alive.len() > 40);
    drop(boards);
    let chatter = run.end();
    assert!(chatter.iter().any(|line| line.contains("boards 0 and 1 are swapped")), "{chatter:?}");
    for id in ["drive", "zoom"] {
        assert_eq!(client.said(id, "pressed"), 0, "{id} although nobody touched it");
    }
}

/// Row R3. The program is stopped for three seconds under a foot and wakes: its holds end, and the packets of the
/// meantime press nothing.
#[test]
fn a_host_that_was_frozen_wakes_without_holds_and_acts_on_nothing_old() {
    let site = Site::new();
    let mut client = Client::new();
    let mut run = site.run(&client, &[]);
    let boards = Boards::start(&site, run.address);
    client.wait_until("both are held", |client| client.holds() == ["drive", "zoom"]);
    client.watch_json(&mut run.child);
    signal(&run, "STOP");
    std::thread::sleep(Duration::from_secs(3));
    assert_eq!(client.holds().len(), 0, "nobody believes it any longer");
    signal(&run, "CONT");
    client.wait_until("it says so", |client| client.said("drive", "cancelled") == 1);
    let (alive, pressed) = (client.alive.len(), client.said("drive", "pressed"));
    client.wait_until("two more seconds pass", |client| client.alive.len() > alive + 20);
    assert_eq!(client.said("drive", "pressed"), pressed, "the foot that was there must lift first");
    assert!(client.holds().is_empty(), "{:?}", client.holds());
    drop(boards);
    run.end();
}

fn signal(run: &Run, name: &str) {
    let status = Command::new("kill").args(["-s", name, &run.child.id().to_string()]).status().unwrap();
    assert!(status.success());
}

#[test]
fn a_program_that_is_asked_to_end_cancels_first_and_says_goodbye_last() {
    let site = Site::new();
    for name in ["TERM", "INT", "HUP"] {
        let client = soon(&site, &[], Then::Ends, |run, _| signal(run, name));
        client.expect_an_orderly_end(name);
    }
}

#[test]
fn a_program_whose_time_is_over_cancels_as_well() {
    let site = Site::new();
    let (_, client) = believed_for(&site, &["--seconds", "6"], Then::Ends, |_, _| {});
    client.expect_an_orderly_end("--seconds");
}

// F11, R2
#[test]
fn a_program_that_is_gone_or_stands_still_is_no_longer_believed() {
    let site = Site::new();
    for name in ["KILL", "STOP"] {
        let client = soon(&site, &[], Then::IsEnded, |run, _| signal(run, name));
        for what in ["cancelled", "released"] {
            assert_eq!(client.said("drive", what), 0, "{name}: nobody was there to say it");
        }
    }
}

// N3, R6, S6, S13
#[test]
fn boards_that_fall_silent_stand_still_or_jump_end_what_is_held() {
    let site = Site::new();
    for (fault, said) in [
        (BoardFault::Silent, "nothing usable"),
        (BoardFault::Frozen, "board 0: all its readings have stood still"),
        (BoardFault::Jumped, "its load jumped by"),
    ] {
        let mut client = soon(&site, &[], Then::IsEnded, |_, boards| boards.suffer(fault));
        client.expect_cancelled(&format!("{fault:?}"));
        let chatter = client.chatter.take().unwrap();
        assert!(chatter.iter().any(|line| line.contains(said)), "{fault:?}: {chatter:?}");
    }
}
