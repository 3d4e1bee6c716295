//! Clusters as a file names them.

use edge_cluster::{Degree, Move, Spec};
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A file of clusters that cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct FileError(String);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    version: u32,
    #[serde(default)]
    cluster: Vec<Entry>,
}

/// One cluster, as files and documents name it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Its vertices.
    pub vertices: Vec<u32>,
    /// A number, or two for a cluster of four sides.
    pub degree: Option<Degrees>,
    /// Reach along its open edges, as a share of the edge.
    pub extent: Option<f64>,
    /// 0 for the fairest patch, towards 1 a sharper one.
    pub bulge: Option<f64>,
    /// Control points moved by hand.
    #[serde(default, rename = "move")]
    pub moves: Vec<MoveEntry>,
}

/// A degree, as files and documents write it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a degree is a whole number, or two for clusters of four sides")]
#[schemars(title = "whole number, or two")]
pub enum Degrees {
    /// `3`
    Same(usize),
    /// `[4, 2]`
    Tensor([usize; 2]),
}

/// A control point to be moved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MoveEntry {
    /// Its index.
    pub point: Vec<u8>,
    /// By how much, in model units.
    pub by: [f64; 3],
}

impl Degrees {
    /// The same for the library.
    pub fn degree(&self) -> Degree {
        match *self {
            Self::Same(n) => Degree::Same(n),
            Self::Tensor([a, b]) => Degree::Tensor(a, b),
        }
    }
}

impl Entry {
    /// The same for the library.
    ///
    /// # Errors
    /// [`FileError`] for moves by numbers that are not finite.
    pub fn spec(&self) -> Result<Spec, FileError> {
        if let Some(step) = self.moves.iter().find(|m| !DVec3::from(m.by).is_finite()) {
            return Err(FileError(format!("control point {:?} is to move by a number that is not finite", step.point)));
        }
        Ok(Spec {
            vertices: self.vertices.clone(),
            degree: self.degree.as_ref().map(Degrees::degree),
            extent: self.extent,
            bulge: self.bulge,
            moves: self.moves.iter().map(|m| Move { index: m.point.clone(), by: m.by.into() }).collect(),
        })
    }
}

/// Reads `version = 1` and a list of `[[cluster]]` with `vertices`, and optionally `degree` (a number, or two for a
/// four-sided cluster), `extent`, `bulge`, and `move` (a list of `{ point = [index], by = [x, y, z] }`).
///
/// # Errors
/// [`FileError`] with line and reason.
///
/// ```
/// let two = "version = 1\n[[cluster]]\nvertices = [0, 4]\ndegree = [4, 2]\n[[cluster]]\nvertices = [1]\n";
/// assert_eq!(fusion::cluster::clusters_from_toml(two)?.len(), 2);
/// # Ok::<(), fusion::cluster::FileError>(())
/// ```
pub fn clusters_from_toml(text: &str) -> Result<Vec<Spec>, FileError> {
    entries_from_toml(text)?.iter().map(Entry::spec).collect()
}

/// The same as written.
pub(crate) fn entries_from_toml(text: &str) -> Result<Vec<Entry>, FileError> {
    let file: File = toml::from_str(text).map_err(|e| FileError(e.to_string().trim_end().to_string()))?;
    if file.version != 1 {
        return Err(FileError(format!("version {} is not known; this program reads version 1", file.version)));
    }
    Ok(file.cluster)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_is_read_and_nothing_else_taken() {
        let text = "version = 1\n[[cluster]]\nvertices = [3, 7]\ndegree = 5\nextent = 0.5\nbulge = 0.2\nmove = [{ point = [2, 0], by = [0, 0, 0.5] }]\n";
        let spec = clusters_from_toml(text).unwrap().remove(0);
        assert_eq!((spec.vertices, spec.degree), (vec![3, 7], Some(Degree::Same(5))));
        assert_eq!((spec.extent, spec.bulge), (Some(0.5), Some(0.2)));
        assert_eq!(spec.moves, [Move { index: vec![2, 0], by: DVec3::new(0.0, 0.0, 0.5) }]);
        for bad in
            ["", "version = 2", "version = 1\n[[cluster]]\n", "version = 1\n[[cluster]]\nvertices = [1]\nradius = 2"]
        {
            assert!(clusters_from_toml(bad).is_err(), "{bad}");
        }
    }
}
