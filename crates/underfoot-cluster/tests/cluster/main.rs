//! A hall of four areas, served by real processes over real loopback sockets, with people walking over all borders.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../../../../tests/support/ports.rs"]
mod ports;
#[path = "../../../../tests/support/steady.rs"]
mod steady;
#[path = "../../../../tests/support/units.rs"]
mod unit_files;

mod border;
mod commands;
mod cost;
mod faults;
mod forger;
mod hall;
mod halo;
mod key;
mod lines;
mod link;
mod many;
mod netns;
mod offline;
mod same;
mod soak;
mod units;
