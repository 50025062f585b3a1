//! Every behaviour and guard, driven by a foot through each line of the timeline written above it.
//!
//! The numbers in the names of tests are those lines.
#![allow(unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../support/mod.rs"]
mod support;

mod bench;
mod buttons;
mod dials;
mod guards;
mod held;
mod locked;
mod selectors;
mod sliders;
mod steppers;
