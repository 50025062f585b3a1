//! Our datagrams in strict TUIO clients: one that drops numbers it has passed, and follows `alive`.

use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;
use rosc::{OscMessage, OscPacket, OscTime, OscType};
use underfoot::floor::Geometry;
use underfoot::glam::Vec2;
use underfoot::outgoing::{Tuio1, Tuio2, TuioProfiles, tuio_first_frame};
use underfoot::sense::{Contact, ContactId};
use underfoot::units::{Instant, Newtons};

/// A client like tuio-client, tuioxide and the C++ reference: it drops a datagram as late if its number is not larger
/// than the last; an id missing from `alive` is gone; one in `alive` that was never set appears at the origin.
#[derive(Debug, Default)]
struct Client {
    number: i32,
    cursors: BTreeMap<i32, [f32; 2]>,
    ghosts: BTreeSet<i32>,
    late: usize,
}

impl Client {
    fn take(&mut self, datagram: &[u8], profile: &str) {
        let OscPacket::Bundle(bundle) = rosc::decoder::decode_udp(datagram).unwrap().1 else {
            panic!("no bundle")
        };
        let mut messages = Vec::new();
        for packet in bundle.content {
            let OscPacket::Message(message) = packet else { panic!("a bundle in a bundle") };
            messages.push(message);
        }
        if profile != "/tuio2" && messages[0].addr != profile {
            return;
        }
        let word = |message: &OscMessage| match &message.args[..] {
            [OscType::String(word), ..] if profile != "/tuio2" => word.clone(),
            _ => message.addr.trim_start_matches("/tuio2/").to_owned(),
        };
        let ints = |args: &[OscType]| args.iter().filter_map(|arg| arg.clone().int()).collect::<Vec<_>>();
        let float = |arg: &OscType| arg.clone().float().unwrap();
        let number = messages.iter().find(|message| matches!(word(message).as_str(), "fseq" | "frm"));
        let number = ints(&number.unwrap().args)[0];
        if number <= self.number {
            self.late += 1;
            return;
        }
        self.number = number;
        let mut alive = BTreeSet::new();
        for message in &messages {
            let args = &message.args;
            match word(message).as_str() {
                "alive" | "alv" => alive = ints(args).into_iter().collect(),
                "set" => drop(self.cursors.insert(ints(args)[0], [float(&args[2]), float(&args[3])])),
                "ptr" => drop(self.cursors.insert(ints(args)[0], [float(&args[3]), float(&args[4])])),
                _ => {}
            }
        }
        self.cursors.retain(|id, _| alive.contains(id));
        self.ghosts.extend(alive.iter().filter(|id| !self.cursors.contains_key(id)));
    }
}

fn clock(seconds: u32) -> OscTime {
    OscTime { seconds: 3_900_000_000 + seconds, fractional: 0 }
}

fn floor() -> Geometry {
    Geometry::of_paper_tiles(6, 6).unwrap()
}

/// Writes `frames`, sets of contacts with a place each, in every profile; a client of each must see them.
fn follow(frames: &[BTreeMap<u32, u8>], starts: usize) -> Result<(), TestCaseError> {
    for profile in ["/tuio/2Dcur", "/tuio/2Dblb", "/tuio2"] {
        let mut client = Client::default();
        for start in 0..starts {
            // A program that is started again a minute later.
            let first = tuio_first_frame(clock(60 * start as u32));
            let mut one = Tuio1::new(&floor(), "underfoot@host", first).with_profiles(TuioProfiles::Both);
            let mut two = Tuio2::new(&floor(), "underfoot:0@host", first);
            for (at, frame) in frames.iter().enumerate() {
                let foot = |(&id, &place): (&u32, &u8)| Contact {
                    id: ContactId(id),
                    centroid: Vec2::new(f32::from(place) * 0.007, 0.5),
                    force: Newtons(350.0),
                    ..Contact::default()
                };
                let contacts: Vec<Contact> = frame.iter().map(foot).collect();
                let at = Instant::from_millis(10 * at as u64);
                if profile == "/tuio2" {
                    two.write(at, clock(0), &contacts, |datagram| client.take(datagram, profile));
                } else {
                    one.write(at, &contacts, |datagram| client.take(datagram, profile));
                }
                let seen: Vec<(i32, i32)> = client
                    .cursors
                    .iter()
                    .map(|(id, at)| (*id, (at[0] * 1.824 / 0.007).round() as i32))
                    .collect();
                let there: Vec<(i32, i32)> =
                    frame.iter().map(|(id, place)| (*id as i32, i32::from(*place))).collect();
                prop_assert_eq!(seen, there, "{}", profile);
                prop_assert_eq!((client.ghosts.len(), client.late), (0, 0), "{}", profile);
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// Feet come, stay, move and leave in any number, also across a restart of the program.
    #[test]
    fn strict_clients_see_everybody_at_their_place_and_no_ghost(
        frames in prop::collection::vec(prop::collection::btree_map(0_u32..150, any::<u8>(), 0..120), 1..12),
        starts in 1_usize..3,
    ) {
        follow(&frames, starts)?;
    }
}

#[test]
fn a_hundred_contacts_in_three_hundred_frames_are_all_seen() {
    let frame = |moved: usize| (0..100).map(|id| (id, (id as usize + moved) as u8)).collect();
    let frames: Vec<BTreeMap<u32, u8>> = (0..300).map(frame).collect();
    follow(&frames, 2).unwrap();
}
