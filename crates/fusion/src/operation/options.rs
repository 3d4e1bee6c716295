//! What all operations have in common.

use super::linked::Files;
use super::option_error::OptionError;
use schemars::JsonSchema;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// The options of an operation.
pub trait Options: Clone + Default + Serialize + DeserializeOwned + JsonSchema {
    /// Its name, a verb in documents and on the command line.
    const NAME: &'static str;

    /// Checks every option against its range, and all against each other.
    ///
    /// # Errors
    /// [`OptionError`] with the first one that cannot be.
    fn validate(&self) -> Result<(), OptionError>;

    /// Reads the files that options name.
    ///
    /// # Errors
    /// [`OptionError`] with the option whose file cannot be read.
    fn load(&mut self, files: &mut dyn Files) -> Result<(), OptionError> {
        let _ = files;
        Ok(())
    }
}
