//! TUIO as a client reads it: frames, coordinates, datagram sizes, final frames.

use std::borrow::Cow;
use std::net::UdpSocket;
use std::time::Duration;

use rosc::{OscMessage, OscPacket, OscTime, OscType};
use underfoot::floor::{Geometry, TileId};
use underfoot::glam::Vec2;
use underfoot::outgoing::{TUIO_CONTACTS, TUIO_DATAGRAM, Tuio1, Tuio2, TuioProfiles};
use underfoot::sense::{Contact, ContactId, TileLoad};
use underfoot::sink::{EventSink, Report, TuioSink, TuioVersion};
use underfoot::units::{Instant, Newtons};
use underfoot::wire::{DatagramLimits, LinkState, check};

const CLOCK: OscTime = OscTime { seconds: 3_900_000_000, fractional: 0 };

/// 6 x 3 tiles of 30.4 cm: 1.824 m wide, 0.912 m deep.
fn floor() -> Geometry {
    Geometry::of_paper_tiles(6, 3).unwrap()
}

fn foot(id: u32, x: f32, y: f32) -> Contact {
    let centroid = Vec2::new(x, y);
    let load = TileLoad { tile: TileId::new(0, 0), index: 0, force: Newtons(350.0), centroid };
    Contact {
        id: ContactId(id),
        centroid,
        force: Newtons(350.0),
        velocity: Vec2::new(0.912, 0.456),
        tiles: [load].into_iter().collect(),
        ..Contact::default()
    }
}

/// The messages of one datagram, each as its address and arguments.
fn messages(datagram: &[u8]) -> Vec<OscMessage> {
    assert!(datagram.len() <= TUIO_DATAGRAM, "{} bytes", datagram.len());
    assert_eq!(check(datagram, &DatagramLimits::default()), Ok(()));
    let OscPacket::Bundle(bundle) = rosc::decoder::decode_udp(datagram).unwrap().1 else {
        panic!("no bundle")
    };
    let message = |packet| match packet {
        OscPacket::Message(message) => message,
        OscPacket::Bundle(_) => panic!("a bundle in a bundle"),
    };
    bundle.content.into_iter().map(message).collect()
}

/// A frame of TUIO 1.1: per profile the last `alive` ids, the `set` messages' floats by id, and the last number.
#[derive(Debug, Default, PartialEq)]
struct Frame {
    alive: Vec<i32>,
    sets: Vec<(i32, Vec<f32>)>,
    fseq: i32,
    bundles: usize,
    /// Ids that were alive in a bundle before being set in this frame, a number per bundle.
    unset: Vec<i32>,
}

fn int(arg: &OscType) -> i32 {
    arg.clone().int().unwrap()
}

/// Reads a bundle in the order of the specification: source, alive, set..., fseq, all of one profile.
fn read(datagram: &[u8], frames: &mut [Frame; 2]) {
    let messages = messages(datagram);
    let profile =
        ["/tuio/2Dcur", "/tuio/2Dblb"].iter().position(|profile| *profile == messages[0].addr).unwrap();
    let frame = &mut frames[profile];
    let words: Vec<String> =
        messages.iter().map(|message| message.args[0].clone().string().unwrap()).collect();
    assert_eq!((words[0].as_str(), words[1].as_str()), ("source", "alive"));
    assert_eq!(words.last().unwrap(), "fseq");
    assert_eq!(messages[0].args[1], OscType::String("underfoot@host".into()));
    assert!(messages.iter().all(|message| message.addr == messages[0].addr));
    let alive: Vec<i32> = messages[1].args[1..].iter().map(int).collect();
    let fseq = int(&messages.last().unwrap().args[1]);
    assert!(fseq > frame.fseq, "every bundle has a larger number");
    let gone = frame.alive.iter().find(|id| !alive.contains(id));
    assert_eq!((frame.bundles > 0).then_some(gone).flatten(), None, "nobody leaves within a frame");
    (frame.alive, frame.fseq) = (alive, fseq);
    frame.bundles += 1;
    for (message, word) in messages[2..messages.len() - 1].iter().zip(&words[2..]) {
        assert_eq!(word, "set");
        let floats = message.args[2..].iter().map(|arg| arg.clone().float().unwrap()).collect();
        frame.sets.push((int(&message.args[1]), floats));
    }
    frame.unset.extend(frame.alive.iter().filter(|id| !frame.sets.iter().any(|(set, _)| set == *id)));
}

fn write(tuio: &mut Tuio1, ms: u64, contacts: &[Contact]) -> ([Frame; 2], usize) {
    let mut frames = [Frame::default(), Frame::default()];
    let left_out = tuio.write(Instant::from_millis(ms), contacts, |datagram| read(datagram, &mut frames));
    (frames, left_out)
}

fn near(found: &[f32], expected: &[f32]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-5, "{found} is not {expected}");
    }
}

#[test]
fn the_origin_is_the_north_west_corner() {
    let mut tuio = Tuio1::new(&floor(), "underfoot@host", 1);
    // A quarter from the west, a third from the south; moving by half a floor east and north a second.
    let ([cursors, blobs], _) = write(&mut tuio, 0, &[foot(7, 0.456, 0.304)]);
    assert_eq!((cursors.alive.as_slice(), cursors.fseq, cursors.bundles), ([7].as_slice(), 1, 1));
    assert_eq!(cursors.sets[0].0, 7);
    // x y X Y m
    near(&cursors.sets[0].1, &[0.25, 2.0 / 3.0, 0.5, -0.5, 0.0]);
    // x y a w h f X Y A m r: a shoe of 27 x 10 cm that points north.
    let (w, h) = (0.27 / 1.824, 0.10 / 0.912);
    let ellipse = std::f32::consts::FRAC_PI_4 * w * h;
    near(
        &blobs.sets[0].1,
        &[0.25, 2.0 / 3.0, std::f32::consts::FRAC_PI_2, w, h, ellipse, 0.5, -0.5, 0.0, 0.0, 0.0],
    );
    // Corners, and places beyond them.
    for (second, x, y, expected) in
        [(1, 0.0, 0.912, [0.0, 0.0]), (2, 1.824, 0.0, [1.0, 1.0]), (3, 2.5, -0.5, [1.0, 1.0])]
    {
        let ([cursors, _], _) = write(&mut tuio, 1000 * second, &[foot(7, x, y)]);
        near(&cursors.sets[0].1[..2], &expected);
    }
}

#[test]
fn a_blob_points_along_the_foot_where_two_tiles_hint_at_it() {
    let mut tuio = Tuio1::new(&floor(), "underfoot@host", 1);
    let mut angle = |ms, difference| {
        let contact = Contact { difference, ..foot(1, 0.5, 0.5) };
        write(&mut tuio, ms, &[contact]).0[1].sets.first().map(|(_, floats)| floats[2].to_degrees().round())
    };
    // Clockwise from the x axis, since y grows southwards; heel and toe are indistinguishable.
    assert_eq!(angle(0, Some(Vec2::new(0.1, 0.1))), Some(135.0));
    assert_eq!(angle(10, Some(Vec2::new(-0.1, -0.1))), None, "the same foot: nothing has changed");
    assert_eq!(angle(20, Some(Vec2::new(0.1, 0.0))), Some(0.0));
    // Without a hint it stays unchanged.
    assert_eq!(angle(30, None), None);
}

#[test]
fn only_what_has_changed_is_set_and_everything_once_a_second() {
    let mut tuio = Tuio1::new(&floor(), "underfoot@host", 1);
    let sets = |frame: &Frame| frame.sets.iter().map(|(id, _)| *id).collect::<Vec<_>>();
    let ([first, _], _) = write(&mut tuio, 0, &[foot(1, 0.5, 0.5), foot(2, 1.0, 0.5)]);
    assert_eq!(sets(&first), [1, 2]);
    let ([still, _], _) = write(&mut tuio, 10, &[foot(1, 0.5, 0.5), foot(2, 1.0, 0.5)]);
    assert_eq!((sets(&still), still.alive, still.fseq), (vec![], vec![1, 2], 3));
    let ([moved, _], _) = write(&mut tuio, 20, &[foot(1, 0.5, 0.5), foot(2, 1.1, 0.5)]);
    assert_eq!(sets(&moved), [2]);
    let ([gone, _], _) = write(&mut tuio, 30, &[foot(2, 1.1, 0.5), foot(3, 0.2, 0.2)]);
    assert_eq!((sets(&gone), gone.alive), (vec![3], vec![2, 3]));
    let ([again, _], _) = write(&mut tuio, 1000, &[foot(2, 1.1, 0.5), foot(3, 0.2, 0.2)]);
    assert_eq!(sets(&again), [2, 3], "a second after the first frame all are told again");
    let ([empty, _], _) = write(&mut tuio, 1010, &[]);
    assert_eq!((sets(&empty), empty.alive, empty.fseq), (vec![], vec![], 11));
}

#[test]
fn a_crowd_takes_several_datagrams() {
    for crowd in [1_u32, 60, 200] {
        let mut tuio = Tuio1::new(&floor(), "underfoot@host", 1);
        let feet: Vec<Contact> = (0..crowd).map(|id| foot(id, 0.001 * id as f32, 0.5)).collect();
        let (frames, left_out) = write(&mut tuio, 0, &feet);
        for frame in frames {
            let ids: Vec<i32> = (0..crowd as i32).collect();
            assert_eq!((left_out, &frame.unset), (0, &Vec::new()), "everybody is set before being alive");
            assert_eq!(frame.alive, ids);
            assert_eq!(frame.sets.iter().map(|(id, _)| *id).collect::<Vec<_>>(), ids);
            // 1472 bytes hold some ten of them beside `alive`.
            assert_eq!(frame.bundles > 1, crowd > 1, "{crowd} feet in {} bundles", frame.bundles);
        }
    }
    // More than fit into one `alive`: the heaviest are reported, the rest counted.
    let heavier = |id: u32| Contact { force: Newtons(100.0 + id as f32), ..foot(id, 0.5, 0.5) };
    let feet: Vec<Contact> = (0..250).map(heavier).collect();
    let ([cursors, _], left_out) = write(&mut Tuio1::new(&floor(), "underfoot@host", 1), 0, &feet);
    assert_eq!(left_out, 250 - TUIO_CONTACTS);
    assert_eq!(cursors.alive.first(), Some(&50));
}

#[test]
fn pointers_carry_force_as_pressure() {
    let mut tuio = Tuio2::new(&floor(), "underfoot:0@host", 1);
    let mut datagrams = Vec::new();
    let heavy = Contact { force: Newtons(1500.0), ..foot(8, 1.0, 0.5) };
    tuio.write(Instant::START, CLOCK, &[foot(7, 0.456, 0.304), heavy], |bytes| {
        datagrams.push(messages(bytes));
    });
    let [bundle] = datagrams.as_slice() else { panic!("{} bundles", datagrams.len()) };
    let addresses: Vec<&str> = bundle.iter().map(|message| message.addr.as_str()).collect();
    assert_eq!(addresses, ["/tuio2/frm", "/tuio2/ptr", "/tuio2/ptr", "/tuio2/alv"]);
    let dimension = (1824 << 16) | 912;
    let frm = [
        OscType::Int(1),
        OscType::Time(CLOCK),
        OscType::Int(dimension),
        OscType::String("underfoot:0@host".into()),
    ];
    assert_eq!(bundle[0].args, frm);
    let pointer = &bundle[1].args;
    assert_eq!(pointer[..3], [7, 0, 0].map(OscType::Int));
    let floats: Vec<f32> = pointer[3..].iter().map(|arg| arg.clone().float().unwrap()).collect();
    // x y angle shear radius press x_vel y_vel p_vel m_acc p_acc
    let half_shoe = 0.05 / 1.824;
    let north = std::f32::consts::FRAC_PI_2;
    near(&floats, &[0.25, 2.0 / 3.0, north, 0.0, half_shoe, 0.35, 0.5, -0.5, 0.0, 0.0, 0.0]);
    assert_eq!(bundle[2].args[8], OscType::Float(1.0), "never more than 1");
    assert_eq!(bundle[3].args, [7, 8].map(OscType::Int));

    // A crowd is split like TUIO 1.1's, and all leave at once.
    let feet: Vec<Contact> = (0..100).map(|id| foot(id, 0.01 * id as f32, 0.5)).collect();
    let (mut told, mut bundles) = (0, 0);
    tuio.write(Instant::from_millis(10), CLOCK, &feet, |bytes| {
        let bundle = messages(bytes);
        bundles += 1;
        assert_eq!(bundle[0].args[0], OscType::Int(1 + bundles), "a number of its own");
        told += bundle.len() - 2;
        // 7 and 8 were reported before; the others are alive from their first pointer on.
        let known = |id: i32| id == 7 || id == 8 || id < told as i32;
        let alive: Vec<i32> = (0..100).filter(|id| known(*id)).collect();
        assert_eq!(bundle.last().unwrap().args.iter().map(int).collect::<Vec<_>>(), alive);
    });
    assert!(told == 100 && bundles > 1, "{told} in {bundles}");
    tuio.write(Instant::from_millis(20), CLOCK, &[], |bytes| assert_eq!(messages(bytes)[1].args, []));
}

fn listen(version: TuioVersion) -> (UdpSocket, TuioSink) {
    let listener = UdpSocket::bind("127.0.0.1:0").unwrap();
    listener.set_read_timeout(Some(Duration::from_secs(5))).unwrap();
    let sink = TuioSink::new(listener.local_addr().unwrap(), &floor(), version).unwrap();
    (listener, sink)
}

/// The ids of the next datagram's alive message.
fn alive(listener: &UdpSocket) -> Vec<i32> {
    let mut buffer = [0; 2048];
    let length = listener.recv(&mut buffer).unwrap();
    let messages = messages(&buffer[..length]);
    let alive = messages.iter().find_map(|message| match message.addr.as_str() {
        "/tuio2/alv" => Some(message.args.as_slice()),
        _ => message
            .args
            .split_first()
            .filter(|(word, _)| **word == OscType::String("alive".into()))
            .map(|(_, ids)| ids),
    });
    alive.unwrap().iter().map(int).collect()
}

#[test]
fn nobody_stays_behind_as_a_ghost() {
    for (version, per_frame) in [
        (TuioVersion::One(TuioProfiles::Both), 2),
        (TuioVersion::One(TuioProfiles::Cursors), 1),
        (TuioVersion::Two, 1),
    ] {
        let (listener, mut sink) = listen(version);
        let frame = || (0..per_frame).map(|_| alive(&listener)).collect::<Vec<_>>();
        // An empty floor is reported too, so that a waiting client knows that the server runs.
        sink.report(&Report::Contacts(Instant::START, Cow::Borrowed(&[])));
        assert_eq!(frame(), vec![Vec::<i32>::new(); per_frame]);
        sink.report(&Report::Contacts(Instant::from_millis(1), Cow::Borrowed(&[foot(1, 0.5, 0.5)])));
        assert_eq!(frame(), vec![vec![1]; per_frame]);
        // The floor falls silent: there are no more frames that would report it.
        sink.report(&Report::Link(Instant::from_millis(100), LinkState::Lost));
        assert_eq!(frame(), vec![Vec::<i32>::new(); per_frame]);
        sink.report(&Report::Link(Instant::from_millis(200), LinkState::Live));
        sink.report(&Report::Contacts(Instant::from_millis(201), Cow::Borrowed(&[foot(2, 0.5, 0.5)])));
        assert_eq!(frame(), vec![vec![2]; per_frame]);
        // The program ends under a foot: two final frames, since one may be lost.
        drop(sink);
        assert_eq!(frame(), vec![Vec::<i32>::new(); per_frame]);
        assert_eq!(frame(), vec![Vec::<i32>::new(); per_frame]);
    }
}

#[test]
fn a_hundred_frames_a_second_at_most() {
    let (listener, mut sink) = listen(TuioVersion::Two);
    for ms in 0..100 {
        sink.report(&Report::Contacts(
            Instant::from_millis(ms),
            Cow::Borrowed(&[foot(1, 0.5, 0.001 * ms as f32)]),
        ));
        if ms % 10 == 0 {
            assert_eq!(alive(&listener), [1]);
        }
    }
    drop(sink);
    assert_eq!(alive(&listener), [] as [i32; 0], "nothing came in between");
}
