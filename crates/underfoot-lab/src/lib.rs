//! The laboratory of underfoot: measurements on simulated floors, and of machines.
//!
//! | module | content |
//! |---|---|
//! | [`experiment`] | the paper's figures, and tables of accuracy and errors |
//! | [`capacity`] | how large a floor a machine carries |
//! | [`plan`] | how many machines a floor takes |

pub mod capacity;
pub mod experiment;
pub mod plan;
