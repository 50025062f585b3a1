//! Options for one computer of several.

use std::net::{IpAddr, SocketAddr};

use clap::Args;
use underfoot::floor::{Area, Floor, Forwarding, Geometry};
use underfoot::layout::Layout;
use underfoot::sink::{ContactsWithin, Fanout};
use underfoot::source::UdpSource;

use super::failure::Failure;

/// Option that selects a part of a large floor.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct AreaArgs {
    /// Serve only this area of the floor file: its boards and those within 1.2 m of it, its controls, its actuators.
    /// Its packets arrive at the address in the floor file, unless --listen gives one, and go on to the areas that
    /// need them too.
    #[arg(long, value_name = "NAME", requires = "floor", conflicts_with = "record")]
    area: Option<String>,
}

/// The part of a floor that one computer serves.
#[derive(Clone, Debug)]
pub(crate) struct Served {
    /// Geometry of the whole floor, to which layouts and outputs refer.
    pub(crate) geometry: Geometry,
    /// `None` for the whole floor.
    area: Option<Area>,
    /// Packets of its boards to forward to other areas, and addresses that forward packets to it.
    forwardings: Vec<Forwarding>,
    forwarders: Vec<IpAddr>,
}

impl AreaArgs {
    /// Returns the description of the served part, and this part of `floor`.
    pub(crate) fn of(&self, floor: Floor) -> Result<(Served, Floor), Failure> {
        let geometry = floor.geometry;
        let Some(id) = &self.area else {
            return Ok((
                Served { geometry, area: None, forwardings: Vec::new(), forwarders: Vec::new() },
                floor,
            ));
        };
        let found = floor.area(id).and_then(|area| Some((area.clone(), floor.part(area)?)));
        let Some((area, part)) = found else {
            let ids: Vec<&str> = floor.areas.iter().map(|area| area.id.as_str()).collect();
            let known = match ids.is_empty() {
                true => "its floor file has no `areas`".to_owned(),
                false => format!("there are {}", ids.join(", ")),
            };
            return Err(Failure::Other(format!("the floor has no area \"{id}\": {known}")));
        };
        if floor.key.is_some() {
            tracing::warn!(
                "`underfoot run` knows the other computers by their addresses, not by the floor's key; \
                 `underfoot-cluster node` uses the key"
            );
        }
        let (forwardings, forwarders) =
            (floor.forwardings(&area), floor.forwarding_addresses(&area).collect());
        Ok((Served { geometry, area: Some(area), forwardings, forwarders }, part))
    }
}

impl Served {
    /// The address for packets in the floor file.
    pub(crate) fn listen(&self) -> Option<SocketAddr> {
        self.area.as_ref()?.listen
    }

    /// Makes `source` accept packets that other areas' computers forward, and forward packets that they need.
    pub(crate) fn among_neighbours(&self, source: UdpSource) -> Result<UdpSource, Failure> {
        let source = source.also_allowing(self.forwarders.iter().copied());
        if self.forwardings.is_empty() {
            return Ok(source);
        }
        let (source, _) = source.forwarding(&self.forwardings)?;
        Ok(source)
    }

    /// The part of `layout` that is served here.
    pub(crate) fn layout(&self, layout: Layout) -> Layout {
        match &self.area {
            Some(area) => layout.part(area, &self.geometry),
            None => layout,
        }
    }

    /// Limits `outputs` to the part that is served here.
    pub(crate) fn outputs(&self, outputs: Fanout) -> Fanout {
        let Some(area) = &self.area else { return outputs };
        let mut own = Fanout::new();
        own.push(ContactsWithin::new(outputs, area.clone(), self.geometry));
        own
    }
}
