//! Every behaviour and guard, driven by a foot through each line of the timeline in its source file.
//!
//! The numbers in the names of tests are those lines.

pub(crate) mod bench;
mod buttons;
mod dials;
mod guards;
mod held;
mod locked;
mod random_feet;
mod selectors;
mod sliders;
mod steppers;
