//! What the floor feels like, measured from rendered samples.

mod click;
mod friction;
mod loudspeakers;
mod rack;
mod safety;
mod wav;
