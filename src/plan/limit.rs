//! What runs out, and how much of it is used.

use serde::Serialize;

use super::{AreaDemand, Machine};

/// What a floor may run out of.
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
    /// What an area's network card takes in or gives out, whichever is more.
    Link,
    /// What the network card of one app takes in that hears all contacts.
    App,
    /// Boards that one floor file has numbers for.
    Boards,
    /// Tiles along one side of a floor file.
    Side,
}

impl Resource {
    /// What it is, for people.
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

    /// What it is counted in, for people.
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

/// How much of a resource is used.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Limit {
    /// Of what.
    pub resource: Resource,
    /// How much is needed, in its unit.
    pub needed: f64,
    /// How much may be used, headroom taken off.
    pub available: f64,
    /// The one divided by the other: above 1 it does not fit.
    pub share: f64,
}

impl Limit {
    /// Nothing needed takes no share, also where nothing is available.
    pub(super) fn new(resource: Resource, needed: f64, available: f64) -> Self {
        Self { resource, needed, available, share: if needed > 0.0 { needed / available } else { 0.0 } }
    }
}

/// What `area` uses of its computer, the resource used most first.
pub(super) fn limits(area: &AreaDemand, machine: &Machine, usable: f64) -> Vec<Limit> {
    let (sensing, sound) = (area.sensing_cores(machine), area.sound_cores(machine));
    let mut all = vec![
        Limit::new(Resource::Sensing, sensing, usable),
        Limit::new(Resource::Sound, sound, usable),
        Limit::new(Resource::Cores, sensing + sound, usable * f64::from(machine.cores)),
        // A channel is there or not: none is kept free.
        Limit::new(Resource::Channels, area.channels.into(), machine.channels.into()),
        Limit::new(Resource::Link, area.in_mbit.max(area.out_mbit), usable * machine.link_mbit),
    ];
    sort(&mut all);
    all
}

/// Puts what is used most first.
pub(super) fn sort(limits: &mut [Limit]) {
    limits.sort_by(|a, b| b.share.total_cmp(&a.share));
}

/// What is used most; none of the sensing thread if there is nothing to compare.
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
        // Sensing 20 + 100 + 80 + 200 = 400 us of 500; sound 32 + 64 = 96 us of 500; both of 1000; half of the
        // channels; 200 Mb/s of 500.
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
