//! Whole files generated from the one definition of the operations, checked by `tidy`.

use crate::{Fault, root};
use std::fs;

/// A generated file.
pub struct Generated {
    /// Its path in the workspace.
    pub file: &'static str,
    /// The chore that writes it.
    pub chore: &'static str,
    /// Its contents.
    pub text: fn() -> Result<String, Fault>,
}

impl Generated {
    /// Writes it.
    pub fn write(&self) -> Result<(), Fault> {
        Ok(fs::write(root().join(self.file), (self.text)()?)?)
    }

    /// Whether the file is up to date.
    pub fn is_current(&self) -> Result<bool, Fault> {
        let written = fs::read_to_string(root().join(self.file)).unwrap_or_default();
        // Git may have converted the line ends.
        Ok(written.replace('\r', "") == (self.text)()?)
    }
}
