//! Materials underfoot, through packets, assembler and engine.

mod laws;
mod materials;
mod walks;
