//! Contexts: the values beside the file that a reading refers to, such as the effects that it may name.
//!
//! A record or a codec names the type of its context, and each reading has it as an argument. `record!` passes to each
//! field the part of the record's context that the field's codec needs.

/// A context of readings that includes the smaller context `C`: that of a record within the record being read.
///
/// Every context includes the empty one.
pub trait Includes<C> {
    /// Returns the smaller context.
    fn included(&self) -> &C;
}

impl<C> Includes<()> for C {
    fn included(&self) -> &() {
        &()
    }
}
