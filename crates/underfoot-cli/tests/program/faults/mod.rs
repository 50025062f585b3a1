//! Rows of the table of faults in the running program: processes, sockets and files.
//!
//! Rows about sensors, people and the boards' clocks are recordings of raw packets that the program replays (`tape`):
//! floor time passes as fast as possible, so that a busy machine does not affect the result. Rows about networks and
//! files run on a floor that is served in real time (`live`).

mod cards;
mod clocks;
mod files;
mod hostile;
mod links;
mod live;
mod pages;
mod people;
mod screen;
mod sensors;
mod session;
mod tape;
