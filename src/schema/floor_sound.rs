//! Floor files: amplifiers, actuators, loudspeakers.

use std::ops::Range;

use glam::Vec2;

use super::behaviour::single;
use super::fields::Fields;
use super::floor::{Grid, Seen};
use super::node::Node;
use super::problem::Problem;
use crate::floor::{Actuator, Drive, Floor, Loudspeaker, Response};
use crate::units::Newtons;

/// Output channels that a device may have.
const CHANNELS: std::ops::RangeInclusive<u32> = 0..=4095;

/// Reads what moves and sounds: `drive`, `response_db` or `response_n`, `actuators`, `loudspeakers`.
pub(super) fn sound(fields: &mut Fields<'_>, grid: Grid, floor: &mut Floor) -> Option<()> {
    let drive = fields.read("drive", Some(Drive::default()), drive);
    let common = response(fields);
    let actuators = fields.read("actuators", Some(None), |node| actuators(node, grid).map(Some));
    if let Some(Some(actuators)) = actuators.clone() {
        (floor.actuators, floor.responses) = actuators.into_iter().unzip();
    }
    let loudspeakers = fields.read("loudspeakers", Some(Vec::new()), |node| loudspeakers(node, floor));
    actuators?;
    if let Some(common) = common? {
        for (own, actuator) in floor.responses.iter_mut().zip(&floor.actuators) {
            if let (None, Some(actuator)) = (&own, actuator) {
                *own = common.of(actuator.full_scale);
            }
        }
    }
    floor.drive = drive?;
    floor.loudspeakers = loudspeakers?;
    Some(())
}

/// The amplifiers and coils of all actuators.
fn drive(node: Node<'_>) -> Option<Drive> {
    let usual = Drive::default();
    let mut fields = node.fields("Drive")?;
    let volts = fields.read("full_scale_v", Some(usual.full_scale_v), |node| single(node, 0.01..=1000.0));
    let ohms = fields.read("load_ohm", Some(usual.load_ohm), |node| single(node, 0.1..=1000.0));
    let watts = fields.read("long_term_w", Some(usual.long_term_w), |node| single(node, 0.01..=10_000.0));
    fields.finish();
    Some(Drive { full_scale_v: volts?, load_ohm: ohms?, long_term_w: watts? })
}

/// A response as it is written.
#[derive(Clone, Debug)]
enum Measured {
    Decibels(Vec<(f32, f32)>),
    Newtons(Vec<(f32, f32)>),
}

impl Measured {
    /// The response of an actuator that is meant to give `full_scale`.
    fn of(&self, full_scale: Newtons) -> Option<Response> {
        match self {
            Self::Decibels(points) => Response::of(points.clone()),
            Self::Newtons(points) => Response::of_newtons(points, full_scale),
        }
    }
}

/// `response_db` or `response_n`, not both; none if neither is written.
fn response(fields: &mut Fields<'_>) -> Option<Option<Measured>> {
    let decibels = fields.read("response_db", Some(None), |node| points(node, -100.0..=60.0).map(Some));
    let newtons = fields.read("response_n", Some(None), |node| points(node, 1e-4..=10_000.0).map(Some));
    match (decibels?, newtons?) {
        (Some(_), Some(_)) => {
            let problem =
                Problem::error(fields.span("response_n"), "there is `response_db` or `response_n`, not both");
            fields.report(problem.expected("one too many"));
            None
        }
        (Some(points), None) => Some(Some(Measured::Decibels(points))),
        (None, Some(points)) => Some(Some(Measured::Newtons(points))),
        (None, None) => Some(None),
    }
}

/// Pairs of hertz, which rise, and a gain within `range`.
fn points(node: Node<'_>, range: std::ops::RangeInclusive<f64>) -> Option<Vec<(f32, f32)>> {
    let nodes = node.list("point", Response::MOST_POINTS)?;
    if nodes.len() < 2 {
        let problem = Problem::error(node.span(), format!("`{}` has too few points", node.name));
        node.report(problem.expected("expected 2 or more").help("write [(50, -3.5), (100, 0), (750, -6)]"));
        return None;
    }
    let mut last = 0.0;
    let points: Vec<Option<(f32, f32)>> = nodes
        .into_iter()
        .map(|node| {
            let [hz, gain] = node.tuple("(hertz, gain)")?;
            let hz = single(Node { name: "hertz", ..hz }, 1.0..=20_000.0);
            let gain = single(Node { name: "gain", ..gain }, range.clone());
            let (hz, gain) = (hz?, gain?);
            if hz <= last {
                let problem = Problem::error(node.span(), "the hertz of a response must rise");
                node.report(problem.expected(format!("expected more than {last}")));
                return None;
            }
            last = hz;
            Some((hz, gain))
        })
        .collect();
    points.into_iter().collect()
}

/// The actuators that are listed, with their own responses; tiles that are not have none.
fn actuators(node: Node<'_>, grid: Grid) -> Option<Vec<(Option<Actuator>, Option<Response>)>> {
    let geometry = grid.known.unwrap_or_default();
    let mut actuators = vec![(None, None); geometry.tile_count()];
    let mut seen = Seen::new();
    for node in node.list("actuator", usize::MAX)? {
        let Some(mut fields) = node.fields("Actuator") else { continue };
        let tile = fields.read("tile", None, |node| grid.tile(node));
        let channel = fields.read("channel", None, |node| node.whole(CHANNELS));
        let nominal = Actuator::nominal(0).full_scale.0;
        let full_scale = fields.read("full_scale_n", Some(nominal), |node| single(node, 0.1..=10_000.0));
        let response = response(&mut fields);
        let span = fields.span("tile");
        fields.finish();
        let Some(tile) = tile else { continue };
        seen.check(node.reader, tile, || format!("the actuator of tile {tile}"), span);
        let slot = geometry.index(tile).and_then(|index| actuators.get_mut(index));
        if let (Some(slot), Some(channel), Some(full_scale), Some(response)) =
            (slot, channel, full_scale, response)
        {
            let full_scale = Newtons(full_scale);
            let response = response.and_then(|response| response.of(full_scale));
            *slot = (Some(Actuator { channel: channel as u16, full_scale }), response);
        }
    }
    Some(actuators)
}

/// The loudspeakers that are listed, on channels of their own.
fn loudspeakers(node: Node<'_>, floor: &Floor) -> Option<Vec<Loudspeaker>> {
    let mut seen = Seen::new();
    let all: Vec<Option<Loudspeaker>> = node
        .list("loudspeaker", Loudspeaker::MOST)?
        .into_iter()
        .map(|node| {
            let mut fields = node.fields("Loudspeaker")?;
            let at = fields.read("at_m", None, |node| node.pair(-1000.0..=1000.0));
            let channel = fields.read("channel", None, |node| node.whole(CHANNELS));
            let gain_db = fields.read("gain_db", Some(0.0), |node| single(node, -60.0..=24.0));
            let span = fields.span("channel");
            fields.finish();
            let channel = channel? as u16;
            seen.check(node.reader, channel, || format!("channel {channel}"), span.clone());
            check_free(node, floor, channel, span)?;
            let [east, north] = at?;
            Some(Loudspeaker { at: Vec2::new(east as f32, north as f32), channel, gain_db: gain_db? })
        })
        .collect();
    all.into_iter().collect()
}

fn check_free(node: Node<'_>, floor: &Floor, channel: u16, span: Range<usize>) -> Option<()> {
    let mut moved = floor.geometry.tiles().zip(&floor.actuators);
    let Some((tile, _)) = moved.find(|(_, actuator)| actuator.is_some_and(|one| one.channel == channel))
    else {
        return Some(());
    };
    let problem = Problem::error(span, format!("channel {channel} moves tile {tile} already"));
    let free = floor.channel_count();
    node.report(problem.expected("expected a channel of its own").help(format!("channel {free} is free")));
    None
}

#[cfg(test)]
mod tests {
    use super::super::{parse_floor, write_floor};
    use super::*;

    fn read(text: &str) -> Floor {
        parse_floor(text, "floor.ron").unwrap_or_else(|problems| panic!("{problems}"))
    }

    #[test]
    fn what_moves_and_sounds_is_read_and_written_again() {
        let floor = read(
            "Floor(columns: 2, rows: 1,
                drive: (full_scale_v: 28, long_term_w: 60),
                response_n: [(50, 20), (200, 80)],
                actuators: [
                    (tile: (0, 0), channel: 1),
                    (tile: (1, 0), channel: 0, full_scale_n: 20, response_db: [(40, -3), (800, 3)]),
                ],
                loudspeakers: [(at_m: (-0.5, 1), channel: 2), (at_m: (1.1, 1), channel: 5, gain_db: -6)],
            )",
        );
        assert_eq!(floor.drive, Drive { full_scale_v: 28.0, load_ohm: 4.0, long_term_w: 60.0 });
        let common = floor.responses[0].as_ref().unwrap();
        assert!((common.gain_db(50.0) + 6.02).abs() < 0.01, "20 N of 40 N are -6 dB");
        assert_eq!(floor.responses[1], Response::of(vec![(40.0, -3.0), (800.0, 3.0)]));
        let second = Loudspeaker { at: Vec2::new(1.1, 1.0), channel: 5, gain_db: -6.0 };
        assert_eq!((floor.loudspeakers.len(), floor.loudspeakers[1]), (2, second));
        assert_eq!(floor.channel_count(), 6);
        assert_eq!(read(&write_floor(&floor)), floor);
    }

    #[test]
    fn one_response_for_all_is_written_once() {
        let floor = read("Floor(response_db: [(50, -6), (100, 0), (750, -9.5)])");
        let text = write_floor(&floor);
        assert_eq!(text.matches("response_db").count(), 1, "{text}");
        assert_eq!(read(&text), floor);
    }

    #[test]
    fn what_makes_no_sense_is_named() {
        let told = parse_floor(
            "Floor(columns: 2, rows: 1,
                drive: (load_ohm: 0),
                response_db: [(50, 0)],
                actuators: [
                    (tile: (0, 0), channel: 0, response_db: [(50, 0), (40, 0)]),
                    (tile: (1, 0), channel: 3, response_db: [(50, 0), (60, 1)], response_n: [(50, 1), (60, 1)]),
                ],
                loudspeakers: [
                    (at_m: (0, 0), channel: 7), (at_m: (0, 0), channel: 7), (channel: 8),
                ],
            )",
            "floor.ron",
        )
        .unwrap_err()
        .to_string();
        for said in [
            "`load_ohm` is out of range",
            "`response_db` has too few points",
            "the hertz of a response must rise",
            "`response_db` or `response_n`, not both",
            "channel 7 comes twice",
            "`at_m`",
        ] {
            assert!(told.contains(said), "{said}: {told}");
        }
        let taken =
            parse_floor("Floor(loudspeakers: [(at_m: (0, 0), channel: 4)])", "floor.ron").unwrap_err();
        assert!(taken.to_string().contains("channel 4 moves tile (4, 0) already"), "{taken}");
    }
}
