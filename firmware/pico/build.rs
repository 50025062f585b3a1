//! Gives the linker the map of the memory.

// Cargo reads the lines that a build script prints.
#![allow(clippy::disallowed_macros)]

fn main() {
    println!("cargo:rustc-link-search={}", env!("CARGO_MANIFEST_DIR"));
    println!("cargo:rerun-if-changed=memory.x");
    println!("cargo:rerun-if-env-changed=UNDERFOOT_RATE_HZ");
}
