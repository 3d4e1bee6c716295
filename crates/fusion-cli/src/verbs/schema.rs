//! `schema`: every operation and its options, as JSON schema.

use crate::failure::Failure;
use crate::output::print;

/// Prints the schema.
pub fn run() -> Result<(), Failure> {
    print(&format!("{:#}\n", fusion::operation::schema()))
}
