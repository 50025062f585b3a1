//! Position errors of feet: seeded tables, and the bounds that underfoot promises.

mod people;
mod phantom;
mod position_map;
mod spot;
mod taps;
mod tracks;
