//! Sums over all areas, and the limits that they share.

use serde::Serialize;

use super::area_demand::{BOARD_HZ, FEET, mbit};
use super::datagram::{CONTACT_HZ, contacts};
use super::limit::{Limit, Resource, sort};
use super::{AreaDemand, Crowd, Machine};
use underfoot::floor::Geometry;

/// Sums over all areas, with people spread evenly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Total {
    /// Number of computers: one for each area.
    pub computers: u32,
    /// Number of boards, each with a link of its own.
    pub boards: u32,
    /// Number of links of boards and computers.
    pub links: u32,
    /// Packets that the computers receive, per second; a board near a border reaches several computers.
    pub packets_per_s: f64,
    /// Packets per second among them that another computer forwards.
    pub forwards_per_s: f64,
    /// Mean number of computers that a board's packets reach.
    pub copies: f64,
    /// Bandwidth of those packets on the wires to the computers (Mb/s).
    pub sensor_mbit: f64,
    /// Contact reports, per second.
    pub contacts_per_s: f64,
    /// Contact datagrams that one app with all contacts receives, per second.
    pub app_packets_per_s: f64,
    /// Bandwidth of these datagrams on the app's wire (Mb/s).
    pub app_mbit: f64,
    /// Number of cores that sensing needs.
    pub sensing_cores: f64,
    /// Number of cores that sound needs.
    pub sound_cores: f64,
}

impl Total {
    /// Sums over the areas `even`, which have people spread evenly, on a floor with `boards` boards.
    pub(super) fn of(even: &[AreaDemand], boards: u32, crowd: &Crowd, machine: &Machine) -> Self {
        let sum = |of: &dyn Fn(&AreaDemand) -> f64| even.iter().map(of).sum::<f64>();
        let packets_per_s = sum(&|area| area.packets_per_s);
        let computers = u32::try_from(even.len()).unwrap_or(u32::MAX);
        // Each computer sends its own contacts: at least one datagram each, and full datagrams where there are many.
        let feet = (FEET * f64::from(crowd.people) / f64::from(computers.max(1))).ceil() as u32;
        let (datagrams, bytes) = contacts(feet);
        let app = f64::from(computers) * CONTACT_HZ;
        Self {
            computers,
            boards,
            links: boards.saturating_add(computers),
            packets_per_s,
            forwards_per_s: sum(&|area| area.forwards_per_s),
            copies: packets_per_s / (f64::from(boards.max(1)) * BOARD_HZ),
            sensor_mbit: sum(&|area| area.in_mbit),
            contacts_per_s: FEET * f64::from(crowd.people) * CONTACT_HZ,
            app_packets_per_s: app * f64::from(datagrams),
            app_mbit: mbit(app * bytes),
            sensing_cores: sum(&|area| area.sensing_cores(machine)),
            sound_cores: sum(&|area| area.sound_cores(machine)),
        }
    }
}

/// Maximum number of boards: a floor file has 16-bit board numbers.
const MOST_BOARDS: f64 = 65_536.0;

/// Limits that more computers do not raise, the highest share first.
pub(super) fn limits(columns: u32, rows: u32, total: &Total, machine: &Machine, usable: f64) -> Vec<Limit> {
    let mut all = vec![
        Limit::new(Resource::App, total.app_mbit, usable * machine.link_mbit),
        Limit::new(Resource::Boards, total.boards.into(), MOST_BOARDS),
        Limit::new(Resource::Side, columns.max(rows).into(), Geometry::MAX_SIDE.into()),
    ];
    sort(&mut all);
    all
}
