//! Faults of sensors, links and people, and the resulting events: one test per row of the fault table, named by its
//! id.
//!
//! Simulated packets go through the assembler into an engine, like those of a real floor.

mod bench;
mod broken;
mod creeping;
mod desk;
mod ends;
mod long_run;
mod loop_gain;
mod lost;
mod nemesis;
mod people;
mod repeating;
mod replayed;
mod scenes;
mod suspect;
mod swapped;
mod taps;
mod unreal;
mod visits;
