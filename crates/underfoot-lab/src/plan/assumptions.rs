//! Assumptions of the calculation.

use super::area_demand::{CHANNELS_PER_PERSON, FEET};
use super::{Crowd, Machine};
use underfoot::floor::SENSED_BEYOND_M;
use underfoot::wire::SensorFormat;

/// People per tile in the crowd that the constants are measured with: two on each 6 x 6 tiles.
pub(super) const MEASURED_DENSITY: f64 = 2.0 / 36.0;

/// Returns the assumptions as sentences; `densest` is the number of people per sensed tile in the fullest area.
pub(super) fn of(crowd: &Crowd, machine: &Machine, densest: f64) -> Vec<String> {
    let format = match crowd.format {
        SensorFormat::Counts => "an OSC integer for each sensor",
        SensorFormat::Newtons => "an OSC float for each sensor",
        SensorFormat::Blob => "a blob of 16-bit counts",
    };
    let mut all = vec![
        format!("Each board sends {format} 1000 times a second, one datagram each time, to one computer, which forwards it to the others that need it."),
        "The boards of one computer send at the same moment, and each neighbour that forwards wakes it once a millisecond at most."
            .to_owned(),
        "On the wire a datagram is 66 bytes longer: 8 of UDP, 20 of IPv4, 38 of Ethernet with preamble and gap.".to_owned(),
        "Without a floor file, each row of tiles has boards of 32 channels for eight tiles, and tiles are 0.304 m apart.".to_owned(),
        format!("A computer senses {SENSED_BEYOND_M} m beyond its area, in whole tiles."),
        format!("A person has {FEET} feet on the floor and moves {CHANNELS_PER_PERSON} channels; contacts are told 100 times a second, 20 to a datagram."),
        format!(
            "People are {:.1} times as dense in the fullest area as on average, or three standard deviations above it.",
            crowd.crowding
        ),
        format!(
            "Of processors and links {:.0} % may be used, of {} channels all; sensing is one thread, sound another.",
            100.0 * crowd.usable, machine.channels
        ),
        "Links of boards, switches, clocks and whatever joins the contacts of all computers are not in the plan.".to_owned(),
    ];
    if densest > 1.05 * MEASURED_DENSITY {
        all.push(format!(
            "Where it is fullest, {densest:.2} people stand on a tile; constants are measured at {MEASURED_DENSITY:.2}. Feet of \
             several people then share tiles, which costs more than is planned here."
        ));
    }
    all
}
