//! Sensing as a whole, on recorded and simulated forces.

mod areas;
mod feet;
mod robust;
#[cfg(feature = "threads")]
mod thread_pools;
