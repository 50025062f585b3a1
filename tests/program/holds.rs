//! Every hold ends: a client believes that nothing is held soon after the program, its floor or the way
//! between them has failed, in whatever way.

mod client;
mod session;
mod site;

use std::process::Command;
use std::time::{Duration, Instant};

use self::client::Client;
use self::site::{BoardFault, Boards, Run, Site};

/// How long a client may still believe that something is held.
const SOON: Duration = Duration::from_millis(150);

/// How often it is tried again on a machine that had something else to do; what is said and in which order
/// is not a matter of time and counts every time.
const TRIES: usize = 6;

/// What becomes of the program.
#[derive(Clone, Copy, PartialEq)]
enum Then {
    /// It ends by itself, and all was well.
    Ends,
    /// It would go on, or is gone already.
    IsEnded,
}

/// Holds `drive` and drags `zoom`, then does `end`; gives how long the slower of two clients believed the holds.
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
        // Notices for people are looked after ten times a second.
        std::thread::sleep(Duration::from_millis(300));
    }
    drop(boards);
    client.chatter = Some(run.end());
    client.hear_the_rest();
    (took, client)
}

/// As [`believed_for`], until it is soon; the last of the clients.
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
