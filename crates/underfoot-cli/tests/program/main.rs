//! The program `underfoot` itself: processes, sockets, files, and its description in the pages.
#![allow(unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../../../../tests/support/pages.rs"]
mod pages;
#[path = "../../../../tests/support/ports.rs"]
mod ports;
#[path = "../../../../tests/support/sender.rs"]
mod sender;
#[path = "../../../../tests/support/steady.rs"]
mod steady;
#[path = "../../../../tests/support/units.rs"]
mod units;
#[path = "../../../../tests/support/xvfb.rs"]
mod xvfb;

mod app;
mod areas;
mod calibrate;
mod clients;
mod console;
#[cfg(all(feature = "preview", target_os = "linux"))]
mod desktop;
mod earlier_files;
mod end_to_end;
mod faults;
mod gallery;
mod holds;
mod hostile_pages;
mod input;
#[cfg(target_os = "linux")]
mod letters;
#[cfg(unix)]
mod lights;
mod linked;
#[cfg(target_os = "linux")]
mod midi;
mod mirror;
#[cfg(unix)]
mod mqtt;
mod output;
mod page_commands;
mod plan;
mod query;
mod rack;
mod recordings;
mod run_programs;
mod senders;
#[cfg(unix)]
mod serial;
mod service;
mod setup;
mod simulated;
mod soak;
mod storage;
mod strange_boards;
mod systemd;
mod tables;
mod targets;
mod unit_files;
mod watch;
mod web;
mod wiring;
