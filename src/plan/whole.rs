//! All areas together, and what they share.

use serde::Serialize;

use super::area_demand::{BOARD_HZ, FEET, mbit};
use super::datagram::{CONTACT_HZ, contacts};
use super::limit::{Limit, Resource, sort};
use super::{AreaDemand, Crowd, Machine};
use crate::floor::Geometry;

/// All areas together, with people spread evenly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Total {
    /// Computers: one for each area.
    pub computers: u32,
    /// Boards, each with a link of its own.
    pub boards: u32,
    /// Links of boards and computers.
    pub links: u32,
    /// Packets that the computers receive, per second: those of a board near a border come to several.
    pub packets_per_s: f64,
    /// How many of them another computer forwards.
    pub forwards_per_s: f64,
    /// How many computers a board's packets reach, on average.
    pub copies: f64,
    /// What those packets take on the wires to the computers.
    pub sensor_mbit: f64,
    /// Contacts that are told, per second.
    pub contacts_per_s: f64,
    /// Datagrams with contacts that one app hears that is told of all, per second.
    pub app_packets_per_s: f64,
    /// What they take on its wire.
    pub app_mbit: f64,
    /// Cores that sensing keeps busy.
    pub sensing_cores: f64,
    /// Cores that sound keeps busy.
    pub sound_cores: f64,
}

impl Total {
    /// Of `even`, the areas with people spread evenly, on a floor with so many boards.
    pub(super) fn of(even: &[AreaDemand], boards: u32, crowd: &Crowd, machine: &Machine) -> Self {
        let sum = |of: &dyn Fn(&AreaDemand) -> f64| even.iter().map(of).sum::<f64>();
        let packets_per_s = sum(&|area| area.packets_per_s);
        let computers = u32::try_from(even.len()).unwrap_or(u32::MAX);
        // Each computer tells of its own: at least one datagram each, and full ones where there are many.
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

/// Boards that a floor file has numbers for.
const MOST_BOARDS: f64 = 65_536.0;

/// What more computers do not help against, the resource used most first.
pub(super) fn limits(columns: u32, rows: u32, total: &Total, machine: &Machine, usable: f64) -> Vec<Limit> {
    let mut all = vec![
        Limit::new(Resource::App, total.app_mbit, usable * machine.link_mbit),
        Limit::new(Resource::Boards, total.boards.into(), MOST_BOARDS),
        Limit::new(Resource::Side, columns.max(rows).into(), Geometry::MAX_SIDE.into()),
    ];
    sort(&mut all);
    all
}
