//! Names that the program, the laboratory, tests and benches use and an app does not need.

/// Re-exports that are public with the feature `internals`, and the crate's own without it.
///
/// What is re-exported this way may change in any version.
macro_rules! internal {
    ($(use $module:ident :: { $($name:ident),* $(,)? };)*) => {$(
        #[cfg(feature = "internals")]
        pub use $module::{$($name),*};
        #[cfg(not(feature = "internals"))]
        #[allow(unused_imports, reason = "some are used by their own module only")]
        pub(crate) use $module::{$($name),*};
    )*};
}
