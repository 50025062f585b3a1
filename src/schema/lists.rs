//! Limit on the number of controls in a layout.

/// Maximum number of controls, regions or stance zones of one layout.
pub const MAX_WIDGETS: usize = 4096;
