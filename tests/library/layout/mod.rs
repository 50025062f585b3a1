//! Layout files: the shipped ones, the language, and its errors.

mod ergonomics;
mod language;
mod random_files;
mod reference;
mod shipped;
