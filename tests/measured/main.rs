//! Measurements of the test's own process: no allocation where none is allowed, and constant memory.
#![allow(unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use assert_no_alloc::AllocDisabler;

#[path = "../support/corrupt.rs"]
mod corrupt;
#[path = "../sense_support/mod.rs"]
mod sense_support;
#[path = "../support/mod.rs"]
mod support;

mod engine;
mod feel;
mod noise;
mod sensing;
mod wire;

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;
