//! Resources that can run out, and the share of each that is used.

use serde::Serialize;

use super::{AreaDemand, Machine};

/// A resource that limits the size of a floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Resource {
    /// Time of an area's sensing thread: one core.
    Sensing,
    /// Time of an area's sound: one core.
    Sound,
    /// Time of all cores of an area's computer.
    Cores,
    /// Channels of an area's sound card.
    Channels,
    /// Network card of an area: the larger of the received and the sent bandwidth.
    Link,
    /// Received bandwidth of the network card of one app that receives all contacts.
    App,
    /// Board numbers in one floor file.
    Boards,
    /// Tiles along one side of a floor file.
    Side,
}

impl Resource {
    /// Returns a readable name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sensing => "sensing thread",
            Self::Sound => "sound thread",
            Self::Cores => "all cores of a computer",
            Self::Channels => "channels of a sound card",
            Self::Link => "network card of a computer",
            Self::App => "network card of an app that hears all contacts",
            Self::Boards => "boards that a floor file can number",
            Self::Side => "tiles along a side of a floor file",
        }
    }

    /// Returns the unit, for display.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Sensing | Self::Sound | Self::Cores => "cores",
            Self::Channels | Self::Boards => "",
            Self::Link | Self::App => "Mb/s",
            Self::Side => "tiles",
        }
    }
}

/// Use of one resource.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Limit {
    /// The resource.
    pub resource: Resource,
    /// Amount needed, in the resource's unit.
    pub needed: f64,
    /// Amount available, in the resource's unit, after the headroom is subtracted.
    pub available: f64,
    /// `needed / available`: above 1 the floor does not fit.
    pub share: f64,
}

impl Limit {
    /// The share is 0 if `needed` is 0, even if `available` is 0 too.
    pub(super) fn new(resource: Resource, needed: f64, available: f64) -> Self {
        Self { resource, needed, available, share: if needed > 0.0 { needed / available } else { 0.0 } }
    }
}

/// Returns the use of each resource of the area's computer, the highest share first.
pub(super) fn limits(area: &AreaDemand, machine: &Machine, usable: f64) -> Vec<Limit> {
    let (sensing, sound) = (area.sensing_cores(machine), area.sound_cores(machine));
    let mut all = vec![
        Limit::new(Resource::Sensing, sensing, usable),
        Limit::new(Resource::Sound, sound, usable),
        Limit::new(Resource::Cores, sensing + sound, usable * f64::from(machine.cores)),
        // Channels need no headroom.
        Limit::new(Resource::Channels, area.channels.into(), machine.channels.into()),
        Limit::new(Resource::Link, area.in_mbit.max(area.out_mbit), usable * machine.link_mbit),
    ];
    sort(&mut all);
    all
}

/// Sorts by share, highest first.
pub(super) fn sort(limits: &mut [Limit]) {
    limits.sort_by(|a, b| b.share.total_cmp(&a.share));
}

/// Returns the limit with the highest share; the sensing thread at 0 if the list is empty.
pub(super) fn first(limits: &[Limit]) -> Limit {
    limits.first().copied().unwrap_or(Limit::new(Resource::Sensing, 0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::super::machine::tests::ROUND;
    use super::*;

    fn area() -> AreaDemand {
        AreaDemand {
            sensed_columns: 20,
            sensed_rows: 20,
            packets_per_s: 100_000.0,
            in_mbit: 200.0,
            channels: 32,
            people: 10.0,
            sensed_people: 20.0,
            ..AreaDemand::default()
        }
    }

    #[test]
    fn what_is_used_most_comes_first() {
        // Sensing uses 20 + 100 + 80 + 200 = 400 us of 500; sound uses 32 + 64 = 96 us of 500; both share 1000 us.
        // Half of the channels are used, and 200 Mb/s of 500.
        let limits = limits(&area(), &ROUND, 0.5);
        let shares: Vec<_> =
            limits.iter().map(|limit| (limit.resource, (limit.share * 1000.0).round())).collect();
        let expected = [
            (Resource::Sensing, 800.0),
            (Resource::Channels, 500.0),
            (Resource::Cores, 496.0),
            (Resource::Link, 400.0),
            (Resource::Sound, 192.0),
        ];
        assert_eq!(shares, expected);
    }

    #[test]
    fn one_core_has_to_do_for_sensing_and_sound() {
        let limits = limits(&area(), &Machine { cores: 1, ..ROUND }, 0.5);
        assert_eq!(first(&limits).resource, Resource::Cores);
        assert!((first(&limits).share - 0.992).abs() < 1e-9);
    }
}
