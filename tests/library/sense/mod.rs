//! Sensing as a whole, on recorded forces.

mod feet;
mod robust;
