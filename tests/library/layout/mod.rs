//! Layout files: what is shipped, what can be written, what can be wrong.

mod ergonomics;
mod language;
mod random_files;
mod reference;
mod shipped;
