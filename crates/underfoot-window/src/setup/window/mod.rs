//! The window of the set-up.
//!
//! It shows the last [`SetupView`](super::SetupView) and sends [`SetupOrder`](super::SetupOrder)s; it measures
//! nothing itself. The steps are at the left, the floor is in the middle, the present step at the right.

mod app;
mod board_cards;
mod drawing;
mod marks;
mod parts;
mod run;
mod setting_pages;
mod shape_choice;
mod stage;
mod steps_bar;
#[cfg(test)]
mod tests;
mod walk_pages;

pub use run::{SetupChannels, SetupOptions, run};
