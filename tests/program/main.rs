//! The program `underfoot` itself: processes, sockets, files, and what the pages for people say of it.
#![allow(unreachable_pub, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../support/pages.rs"]
mod pages;
#[path = "../support/ports.rs"]
mod ports;
#[path = "../support/sender.rs"]
mod sender;

mod app;
mod areas;
mod calibrate;
mod clients;
mod console;
mod earlier_files;
mod end_to_end;
mod holds;
mod input;
mod mirror;
mod output;
mod page_commands;
mod plan;
mod rack;
mod recordings;
mod senders;
mod service;
mod soak;
mod storage;
mod web;
mod wiring;
