//! Formats by their names.

use crate::error::Error;
use crate::format::Format;
use std::path::Path;

impl Format {
    /// The format called `name`, in any case, with or without a leading dot.
    ///
    /// # Errors
    /// [`Error::UnknownFormat`].
    pub fn from_name(name: &str) -> Result<Self, Error> {
        let bare = name.strip_prefix('.').unwrap_or(name);
        Self::ALL
            .into_iter()
            .find(|format| format.name().eq_ignore_ascii_case(bare))
            .ok_or_else(|| Error::UnknownFormat { name: name.to_owned() })
    }

    /// The format that the extension of `path` names.
    ///
    /// # Errors
    /// [`Error::UnknownFormat`].
    pub fn from_path(path: &Path) -> Result<Self, Error> {
        let extension = path.extension().map(|e| e.to_string_lossy().into_owned());
        Self::from_name(&extension.unwrap_or_default())
            .map_err(|_| Error::UnknownFormat { name: path.display().to_string() })
    }
}

impl std::str::FromStr for Format {
    type Err = Error;
    fn from_str(name: &str) -> Result<Self, Error> {
        Self::from_name(name)
    }
}
