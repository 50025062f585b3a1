//! What the floor feels like, measured from rendered samples.

mod ahap;
mod answers;
mod click;
mod effects;
mod friction;
mod loudspeakers;
mod rack;
mod safety;
mod wav;
