//! What lines about variables ask for.

use crate::gcs::text::{Name, Text};

/// Variables that a line can ask for.
pub const MAX_NAMED_VARIABLES: usize = 8;

/// What a line wants of the variables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VariableRequest {
    /// `VAR`: set one, or, without a value, forget it.
    Set(Name, Option<Text>),
    /// `ADD`: set one to a sum.
    Add(Name, f64, f64),
    /// `VAR?`: tell those named, or all.
    Query([Option<Name>; MAX_NAMED_VARIABLES]),
}
