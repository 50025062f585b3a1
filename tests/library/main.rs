//! All features of the underfoot library, on simulated floors, files and loopback sockets.
//!
//! One test program for all: linking a program for each file would take minutes and gigabytes.
#![allow(unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../support/corrupt.rs"]
mod corrupt;
#[path = "../support/pages.rs"]
mod pages;
#[path = "../support/sender.rs"]
mod sender;
#[path = "../sense_support/mod.rs"]
mod sense_support;
#[path = "../support/mod.rs"]
mod support;

mod accuracy;
mod calibrate;
mod controls;
mod dragging;
mod examples;
mod fault_table;
mod faults;
mod feel;
mod floor_walks;
mod floors;
mod ground;
mod ignored;
mod intent;
mod laws;
mod layers;
mod layout;
mod off;
mod page_files;
mod regions;
mod runtime;
mod sense;
mod standing;
mod switched_off;
mod wire;
