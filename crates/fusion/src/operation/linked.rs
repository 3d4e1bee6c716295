//! What an option takes from a file, or is given in its place.

use super::option_error::OptionError;
use glam::DVec3;
use mesh_core::{TriMesh, VertexId};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::convert::Infallible;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// A value, or the file it stands in. Operations run on values: see [`Files`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a path, or what would stand in the file")]
#[schemars(title = "path")]
pub enum Linked<T> {
    /// In this file.
    File(PathBuf),
    /// Here.
    Here(T),
}

impl<T> Linked<T> {
    /// The value.
    ///
    /// # Errors
    /// [`OptionError`] for one that is still in its file.
    pub(crate) fn value(&self, option: &'static str) -> Result<&T, OptionError> {
        match self {
            Self::Here(value) => Ok(value),
            Self::File(path) => Err(OptionError::new(option, format!("{} has not been read", path.display()))),
        }
    }

    /// Reads the value from its file.
    pub(super) fn load(
        &mut self,
        option: &'static str,
        read: impl FnOnce(&Path) -> Result<T, String>,
    ) -> Result<(), OptionError> {
        if let Self::File(path) = self {
            *self = Self::Here(read(path).map_err(|reason| OptionError::new(option, reason))?);
        }
        Ok(())
    }
}

impl<T> FromStr for Linked<T> {
    type Err = Infallible;

    fn from_str(path: &str) -> Result<Self, Infallible> {
        Ok(Self::File(path.into()))
    }
}

/// Where the files are read that options name.
pub trait Files {
    /// The text of a file.
    ///
    /// # Errors
    /// A sentence with the file's name.
    fn text(&mut self, path: &Path) -> Result<String, String>;

    /// The mesh in a file.
    ///
    /// # Errors
    /// A sentence with the file's name.
    fn mesh(&mut self, path: &Path) -> Result<TriMesh, String>;
}

/// What a parser makes of a file of text; what is wrong with it is said with its name.
pub(super) fn parsed<T, E: std::fmt::Display>(
    files: &mut dyn Files,
    path: &Path,
    parse: impl FnOnce(&str) -> Result<T, E>,
) -> Result<T, String> {
    parse(&files.text(path)?).map_err(|e| format!("{}: {e}", path.display()))
}

/// A solid as plain arrays.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(from = "Arrays", into = "Arrays")]
#[schemars(with = "Arrays")]
pub struct Solid(pub TriMesh);

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Arrays {
    #[schemars(with = "Vec<[f64; 3]>")]
    positions: Vec<DVec3>,
    faces: Vec<[u32; 3]>,
}

impl From<Arrays> for Solid {
    fn from(Arrays { positions, faces }: Arrays) -> Self {
        Self(TriMesh { positions, faces: faces.into_iter().map(|f| f.map(VertexId)).collect() })
    }
}

impl From<Solid> for Arrays {
    fn from(Solid(TriMesh { positions, faces }): Solid) -> Self {
        Self { positions, faces: faces.into_iter().map(|f| f.map(|v| v.0)).collect() }
    }
}
