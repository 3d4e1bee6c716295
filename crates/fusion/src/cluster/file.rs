//! Clusters as a file names them.

use edge_cluster::{Degree, Move, Spec};
use glam::DVec3;
use serde::Deserialize;

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

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    vertices: Vec<u32>,
    degree: Option<Degrees>,
    extent: Option<f64>,
    bulge: Option<f64>,
    #[serde(default, rename = "move")]
    moves: Vec<MoveEntry>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Degrees {
    Same(usize),
    Tensor([usize; 2]),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MoveEntry {
    point: Vec<u8>,
    by: [f64; 3],
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
    let file: File = toml::from_str(text).map_err(|e| FileError(e.to_string().trim_end().to_string()))?;
    if file.version != 1 {
        return Err(FileError(format!("version {} is not known; this program reads version 1", file.version)));
    }
    let spec = |entry: Entry| {
        if let Some(step) = entry.moves.iter().find(|m| !DVec3::from(m.by).is_finite()) {
            return Err(FileError(format!("control point {:?} is to move by a number that is not finite", step.point)));
        }
        Ok(Spec {
            vertices: entry.vertices,
            degree: entry.degree.map(|d| match d {
                Degrees::Same(n) => Degree::Same(n),
                Degrees::Tensor([a, b]) => Degree::Tensor(a, b),
            }),
            extent: entry.extent,
            bulge: entry.bulge,
            moves: entry.moves.into_iter().map(|m| Move { index: m.point, by: m.by.into() }).collect(),
        })
    };
    file.cluster.into_iter().map(spec).collect()
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
