//! Materials underfoot, through packets, assembler and engine.

mod heard;
mod laws;
mod materials;
mod walks;
