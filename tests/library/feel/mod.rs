//! What the floor feels like, measured from rendered samples.

mod click;
mod friction;
mod safety;
mod wav;
