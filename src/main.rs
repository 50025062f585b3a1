//! The program `underfoot`.

fn main() {}
