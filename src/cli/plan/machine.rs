//! A computer's constants: measured on this one, or read from a file.

use std::num::NonZeroUsize;
use std::path::Path;
use std::thread;
use std::time::Duration;

use serde_json::Value;
use underfoot::capacity::{AssemblyLoad, RenderLoad, RenderWork, ServeLoad, SocketLoad};
use underfoot::plan::Machine;
use underfoot::schema;

use crate::cli::failure::Failure;
use crate::cli::meter::Meter;

/// Loads that are measured.
const LOADS: u64 = 7;

/// Most channels that ALSA opens on a card.
const CHANNELS: u32 = 64;

/// An ordinary network card.
const LINK_MBIT: f64 = 1000.0;

/// The floor whose tiles and people are measured: as large as areas are.
const SIDE: u16 = 36;

/// Walkers on it: two on 6 x 6.
const WALKERS: u16 = SIDE * SIDE / 18;

/// The smallest floor that is measured, to tell what a floor takes whatever its size.
const SMALL: u16 = 6;

/// Channels of the loads that are rendered.
const RENDERED: f64 = 36.0;

/// More than any file of constants has.
const MOST_BYTES: u64 = 1 << 20;

/// Reads constants as `underfoot plan --json` prints them: all of it, or what stands under `machine`.
pub(super) fn read(path: &Path) -> Result<Machine, Failure> {
    let wrong = |error: &dyn std::fmt::Display| Failure::Other(format!("{}: {error}", path.display()));
    let text =
        schema::read_bounded(path, MOST_BYTES).map_err(|error| Failure::File(path.to_path_buf(), error))?;
    let mut value: Value = serde_json::from_str(&text).map_err(|error| wrong(&error))?;
    if let Some(machine) = value.get_mut("machine") {
        value = machine.take();
    }
    let machine: Machine = serde_json::from_value(value).map_err(|error| wrong(&error))?;
    machine.check().map_err(|error| wrong(&error))?;
    Ok(machine)
}

/// Measures this computer, each load for `length`.
pub(super) fn measured(length: Duration) -> Result<Machine, Failure> {
    if cfg!(debug_assertions) {
        errln!("This is a debug build: a release build is many times faster.");
    }
    let meter = Meter::new(length, NonZeroUsize::MIN, LOADS);
    let packets = meter.measure_sockets("", String::new())?;
    let packet_us = 1e6 / (packets.times_real_time * SocketLoad::PACKETS_PER_S);
    let assemble_us = millisecond_us(&meter, || {
        let mut load = AssemblyLoad::new(SIDE);
        move || {
            load.second();
        }
    });
    let [small_us, empty_us, crowd_us] = [(SMALL, 0), (SIDE, 0), (SIDE, WALKERS)].map(|(side, walkers)| {
        millisecond_us(&meter, || {
            let mut load = ServeLoad::new(side, walkers);
            move || {
                load.second();
            }
        })
    });
    let [silent_us, active_us] =
        [RenderWork::of_modes(0), RenderWork::with_friction_and_limiter()].map(|work| {
            millisecond_us(&meter, || {
                let mut load = RenderLoad::new(work);
                move || load.second()
            })
        });
    let [small, tiles] = [SMALL, SIDE].map(|side| f64::from(side).powi(2));
    let tile_us = (empty_us - small_us) / (tiles - small);
    let assemble_tile_us = assemble_us / tiles;
    // A machine that is busy with something else may measure less than nothing.
    Ok(Machine {
        cores: thread::available_parallelism().map_or(1, |cores| cores.get().min(1024) as u32),
        base_us: (small_us - small * tile_us).max(0.0),
        packet_us,
        assemble_tile_us,
        sense_tile_us: (tile_us - assemble_tile_us).max(0.0),
        person_us: ((crowd_us - empty_us) / f64::from(WALKERS)).max(0.0),
        channel_us: silent_us / RENDERED,
        active_channel_us: ((active_us - silent_us) / RENDERED).max(0.0),
        channels: CHANNELS,
        link_mbit: LINK_MBIT,
    })
}

/// Microseconds of work for each millisecond of floor.
fn millisecond_us<Load: FnMut()>(meter: &Meter, load: impl Fn() -> Load + Sync) -> f64 {
    1000.0 / meter.measure("", String::new(), load).times_real_time
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONSTANTS: &str = r#"{"cores":2,"base_us":20,"packet_us":2,"assemble_tile_us":0.05,"sense_tile_us":0.05,
        "person_us":5,"channel_us":0.1,"active_channel_us":0.2,"channels":64,"link_mbit":1000}"#;

    fn of(text: &str) -> Result<Machine, String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        read(file.path()).map_err(|error| error.to_string())
    }

    #[test]
    fn constants_are_read_alone_or_out_of_a_plan() {
        let alone = of(CONSTANTS).unwrap();
        assert_eq!((alone.cores, alone.packet_us), (2, 2.0));
        assert_eq!(of(&format!(r#"{{"columns":6,"machine":{CONSTANTS}}}"#)), Ok(alone));
    }

    #[test]
    fn what_is_wrong_with_constants_is_told() {
        let wrong = |text: &str| of(text).unwrap_err();
        assert!(wrong("{").contains("EOF"));
        assert!(wrong("{}").contains("cores"));
        assert!(wrong(&CONSTANTS.replace("packet_us", "paket_us")).contains("paket_us"));
        assert!(wrong(&CONSTANTS.replace(":5,", ":-5,")).contains("person_us"));
    }
}
