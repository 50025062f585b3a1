//! P1 to P5, P7, P9 to P11 and R4: datagrams that no board or app sends. After each kind the floor still works.

use std::net::UdpSocket;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use underfoot::wire::Readings;

use super::live::Live;
use super::tape::BUTTON;

/// Text padded as in OSC.
fn text(text: &str) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    bytes.resize((bytes.len() / 4 + 1) * 4, 0);
    bytes
}

/// A message with one integer, or without arguments.
fn message(address: &str, argument: Option<i32>) -> Vec<u8> {
    let mut bytes = text(address);
    bytes.extend(text(if argument.is_some() { ",i" } else { "," }));
    bytes.extend(argument.map(i32::to_be_bytes).into_iter().flatten());
    bytes
}

/// A bundle that is due at an OSC time tag.
fn bundle(tag: u64, elements: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = b"#bundle\0".to_vec();
    bytes.extend(tag.to_be_bytes());
    for element in elements {
        bytes.extend((element.len() as u32).to_be_bytes());
        bytes.extend(element);
    }
    bytes
}

/// The time tag that means "at once".
const AT_ONCE: u64 = 1;

/// The time tag `seconds` from now.
fn from_now(seconds: i64) -> u64 {
    const FROM_1900_TO_1970: u64 = 2_208_988_800;
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_secs() + FROM_1900_TO_1970;
    now.wrapping_add_signed(seconds) << 32
}

fn send(live: &Live, datagram: &[u8]) {
    UdpSocket::bind("127.0.0.1:0").unwrap().send_to(datagram, live.address).unwrap();
}

/// Whether the floor is muted, which only a request can do.
fn is_muted(live: &Live) -> bool {
    let answer = live.ask(&message("/underfoot/mute/get", None)).expect("the floor answers");
    assert!(answer == message("/underfoot/mute", Some(0)) || answer == message("/underfoot/mute", Some(1)));
    answer.ends_with(&[1])
}

/// The number behind `name` in the program's final report.
fn counted(said: &str, name: &str) -> u64 {
    let rest = said.split(&format!("{name} ")).nth(1).unwrap_or_else(|| panic!("no {name}: {said}"));
    rest.split(|letter: char| !letter.is_ascii_digit()).next().unwrap().parse().unwrap()
}

/// Checks that the control was not pressed, that a foot presses it, and that the program ends normally; returns its
/// messages.
fn works_still(live: Live) -> String {
    assert_eq!(live.count("it pressed"), 0, "{:?}", live.lines());
    assert!(!is_muted(&live));
    live.tap_until_it_clicks();
    let (code, said) = live.end();
    assert_eq!(code, Some(0), "{said}");
    assert!(!said.contains("panicked"), "{said}");
    said
}

// P1, P2, P5
#[test]
fn bombs_and_giants_are_refused_and_the_floor_goes_on() {
    let live = Live::start(BUTTON, &[]);
    let mute = message("/underfoot/mute/set", Some(1));
    let mut nested = mute.clone();
    while nested.len() < 60_000 {
        nested = bundle(AT_ONCE, &[nested]);
    }
    let mut arrays = text("/underfoot/mute/set");
    arrays.extend(text(&format!(",{}i{}", "[".repeat(15_000), "]".repeat(15_000))));
    arrays.extend(1_i32.to_be_bytes());
    let mut giant = text("/underfoot/mute/set");
    giant.extend(text(&format!(",i{}", "N".repeat(65_400))));
    giant.extend(1_i32.to_be_bytes());
    for bomb in [nested, arrays, giant] {
        (0..20).for_each(|_| send(&live, &bomb));
    }
    let said = works_still(live);
    assert_eq!(counted(&said, "refused"), 60, "{said}");
}

// P3, P4
#[test]
fn damaged_datagrams_change_nothing_and_the_floor_goes_on() {
    let live = Live::start(BUTTON, &[]);
    let mute = message("/underfoot/mute/set", Some(1));
    let get = message("/underfoot/mute/get", None);
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    // Every prefix of a bundle with a good request, and random bytes.
    let whole = bundle(AT_ONCE, &[get.clone(), mute.clone()]);
    (1..whole.len()).for_each(|length| send(&live, &whole[..length]));
    for _ in 0..500 {
        let mut noise = vec![0; rng.random_range(1..400)];
        rng.fill_bytes(&mut noise);
        send(&live, &noise);
    }
    // A good request before a truncated element, and behind one.
    let broken = b"/underfoot/mu".to_vec();
    send(&live, &bundle(AT_ONCE, &[mute.clone(), broken.clone()]));
    send(&live, &bundle(AT_ONCE, &[broken, mute]));
    let said = works_still(live);
    assert!(counted(&said, "refused") >= 500, "{said}");
}

/// Packets of the boards with an inverted bit, repeatedly.
// P3
#[test]
fn packets_with_damaged_bits_end_nothing() {
    let live = Live::start(BUTTON, &[]);
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    let sent = live.take_sent();
    for _ in 0..2000 {
        let mut packet = sent[rng.random_range(0..sent.len())].clone();
        let at = rng.random_range(0..packet.len());
        packet[at] ^= 1 << rng.random_range(0..8);
        send(&live, &packet);
    }
    live.tap_until_it_clicks();
    let (code, said) = live.end();
    assert_eq!(code, Some(0), "{said}");
    assert!(!said.contains("panicked"), "{said}");
}

// P7
#[test]
fn readings_that_are_not_finite_press_nothing_and_reach_nobody() {
    let live = Live::start(BUTTON, &[]);
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e38, f32::MIN_POSITIVE / 2.0, -0.0];
    let mut turn = 0;
    live.change(move |board, readings| {
        if board == 0 {
            turn += 1;
            let channels = readings.len();
            *readings = Readings::Newtons((0..channels).map(|at| bad[(turn + at) % bad.len()]).collect());
        }
        true
    });
    let is_faulty = |live: &Live| live.has(|line| line["faulty"].as_u64() > Some(0));
    live.wait_until("its sensors are faulty", is_faulty);
    std::thread::sleep(Duration::from_secs(1));
    live.change(|_, _| true);
    for line in live.lines() {
        assert!(!line.to_string().contains("e38"), "{line}");
    }
    let said = works_still(live);
    assert!(counted(&said, "bad readings") > 100, "{said}");
}

// P9
#[test]
fn a_press_that_is_sent_again_later_presses_nothing() {
    let live = Live::start(BUTTON, &[]);
    live.take_sent();
    live.tap_until_it_clicks();
    let press = live.take_sent();
    std::thread::sleep(Duration::from_millis(500));
    let pressed = live.count("it pressed");
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    for packets in press.chunks(2) {
        packets.iter().for_each(|packet| {
            socket.send_to(packet, live.address).unwrap();
        });
        std::thread::sleep(Duration::from_millis(1));
    }
    std::thread::sleep(Duration::from_millis(300));
    assert_eq!(live.count("it pressed"), pressed);
    live.tap_until_it_clicks();
    assert_eq!(live.end().0, Some(0));
}

// P10
#[test]
fn requests_for_later_than_a_second_are_refused_and_those_of_now_or_before_are_met() {
    let live = Live::start(BUTTON, &[]);
    let mute = |on: i32| message("/underfoot/mute/set", Some(on));
    for tag in [from_now(60), from_now(3600), u64::MAX] {
        send(&live, &bundle(tag, &[mute(1)]));
        assert!(!is_muted(&live), "{tag:#x}");
    }
    for tag in [AT_ONCE, 0, 2, from_now(-3600), from_now(0)] {
        send(&live, &bundle(tag, &[mute(1)]));
        live.wait_until("it is met", is_muted);
        send(&live, &bundle(tag, &[mute(0)]));
        live.wait_until("it is met", |live| !is_muted(live));
    }
    works_still(live);
}

// P11
#[test]
fn hostile_addresses_reach_no_control() {
    let live = Live::start(BUTTON, &[]);
    let long = format!("/underfoot/widget/{}/set", "x".repeat(60_000));
    let addresses = [
        "/*",
        "//",
        "/",
        "no/slash",
        "/underfoot/widget/../mute/set",
        "/underfoot/widget/it/../../mute/set",
        "/underfoot/mute/set\u{1b}[2J",
        "/underfoot/board/99999999999999999999",
        "/underfoot/board/-1",
        "/underfoot/widget/[!a-/set",
        "/underfoot/widget/{{{{{{/set",
        &long,
    ];
    for address in addresses {
        (0..5).for_each(|_| send(&live, &message(address, Some(1))));
    }
    let said = works_still(live);
    assert!(!said.contains('\u{1b}'), "{said:?}");
    assert!(counted(&said, "refused") + counted(&said, "requests not met") >= 50, "{said}");
}

/// Ten thousand datagrams of each refused kind, twice: the second pass allocates no memory.
// R4
#[test]
#[cfg(target_os = "linux")]
fn floods_of_refused_datagrams_take_no_memory() {
    let live = Live::start(BUTTON, &[]);
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let kinds = [
        b"rubbish".to_vec(),
        message("/no/such/address", Some(1)),
        message("/underfoot/widget/nobody/get", None),
        bundle(from_now(60), &[message("/underfoot/mute/set", Some(1))]),
    ];
    let flood = || {
        for number in 0..40_000_usize {
            // A full receive buffer makes the kernel drop packets.
            let _ = socket.send_to(&kinds[number % kinds.len()], live.address);
        }
        assert!(!is_muted(&live));
        crate::output::memory_kb(&live.served.0.id().to_string())
    };
    let (warm, after) = (flood(), flood());
    assert!(after < warm + 1024, "{warm} kB, then {after} kB");
    works_still(live);
}
