//! What goes wrong with sensors, links and people, and what becomes of the feet: one test per row of the fault table,
//! named by its id.
//!
//! Simulated packets go through the assembler into an engine, as those of a real floor do.

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
