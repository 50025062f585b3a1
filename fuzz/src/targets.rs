//! The readers.

use underfoot::floor::{Floor, Geometry};
use underfoot::layout::Layout;
use underfoot::schema::{self, Kinds};
use underfoot::sense::{Assembler, ForceFrame, ForceTable, LoadTable, PressTable};
use underfoot_sim::Scenario;
use underfoot::source::LinkFaults;
use underfoot::units::Instant;
use underfoot::wire::{Batch, Decoder};

/// The names of the targets.
pub const NAMES: [&str; 8] =
    ["datagrams", "layouts", "effects", "floors", "scenarios", "csv", "ahap", "faults"];

/// A reader with its dependencies.
pub struct Target {
    name: &'static str,
    floor: Floor,
    kinds: Kinds,
    page: Option<Layout>,
    decoder: Decoder,
    assembler: Assembler,
    batch: Batch,
    /// Number of datagrams so far; they come a tenth of a millisecond apart.
    count: u64,
}

impl Target {
    pub fn named(name: &str) -> Option<Self> {
        let name = NAMES.into_iter().find(|known| *known == name)?;
        let floor = Floor::default();
        let kinds = Kinds::builtin();
        let page = schema::builtin_layout("map")
            .and_then(|text| schema::parse_layout(text, "map", &kinds, &floor.geometry).ok());
        Some(Self {
            name,
            page: page.map(|loaded| loaded.layout),
            decoder: Decoder::new(&floor),
            assembler: Assembler::new(&floor),
            batch: Batch::default(),
            kinds,
            floor,
            count: 0,
        })
    }

    pub const fn name(&self) -> &'static str {
        self.name
    }

    /// Length of the longest input: that of a datagram, or of a file that is read at once.
    pub fn most_bytes(&self) -> usize {
        if self.name == "datagrams" { 65_507 } else { 32 << 10 }
    }

    /// Reads `input`; returns whether the reader accepted it.
    pub fn read(&mut self, input: &[u8]) -> bool {
        if self.name == "datagrams" {
            return self.take(input);
        }
        let Ok(text) = std::str::from_utf8(input) else {
            // Readers of files refuse everything that is not UTF-8 first.
            return false;
        };
        let geometry = &self.floor.geometry;
        match self.name {
            "layouts" => schema::parse_layout(text, "it", &self.kinds, geometry).is_ok(),
            "effects" => schema::parse_effect(text, "it", self.kinds.effects()).is_ok(),
            "floors" => match schema::parse_floor(text, "it") {
                Ok(floor) => {
                    assert!(
                        schema::parse_floor(&schema::write_floor(&floor), "again").is_ok(),
                        "written and read"
                    );
                    true
                }
                Err(_) => false,
            },
            "scenarios" => Scenario::parse("it", text).is_ok_and(|scenario| {
                self.page.as_ref().is_some_and(|page| scenario.resolve(page, geometry).is_ok())
            }),
            "csv" => {
                let forces = is_force_table(text, geometry);
                let loads = LoadTable::read(text.as_bytes(), geometry)
                    .map(|table| table.sensors.iter().map(|sensor| sensor.judge()).count());
                let presses = PressTable::read(text.as_bytes(), &self.floor);
                forces || loads.is_ok() || presses.is_ok()
            }
            "ahap" => schema::read_ahap(text, "it").is_ok(),
            _ => text.parse::<LinkFaults>().is_ok(),
        }
    }

    /// Processes a datagram like the code behind the socket.
    fn take(&mut self, input: &[u8]) -> bool {
        self.count += 1;
        let now = Instant::from_micros(self.count * 100);
        let is_good = self.decoder.decode(input, now, &mut self.batch).is_ok();
        if is_good {
            self.batch.packets.iter().for_each(|packet| self.assembler.take(packet));
        } else {
            self.assembler.poll(now);
        }
        while let Some(frame) = self.assembler.ready() {
            assert!(frame.forces.iter().flatten().all(|force| force.is_finite()), "forces stay finite");
        }
        is_good
    }
}

/// Whether every row of a force table is valid and all its numbers are finite.
fn is_force_table(text: &str, geometry: &Geometry) -> bool {
    let Ok(mut table) = ForceTable::new(text.as_bytes(), *geometry) else { return false };
    let mut frame = ForceFrame::empty(geometry);
    loop {
        match table.next_frame(&mut frame) {
            Ok(Some(_)) => assert!(frame.forces.iter().flatten().all(|force| force.is_finite())),
            Ok(None) => return table.problems().is_empty(),
            Err(_) => return false,
        }
    }
}
