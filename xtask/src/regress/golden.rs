//! What a case gave when it was last approved: topology exactly, places to a tolerance.

use crate::Fault;
use mesh_core::{Connected, Faces, TriMesh, area, bounds, topology, volume};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::Path;

/// Places may differ by this share of the diagonal: compilers and processors round `sin` and `cos` differently.
const TOLERANCE: f64 = 1e-9;
/// How many vertices a record samples.
const SAMPLES: usize = 16;

/// The record of one result.
#[derive(Debug, Serialize, Deserialize, PartialEq)]
pub struct Golden {
    vertices: usize,
    faces: usize,
    components: usize,
    genus: i64,
    /// Hash of the triangles' corners in order.
    connectivity: String,
    /// Diagonal of the bounding box, in model units.
    diagonal: f64,
    area: f64,
    volume: f64,
    /// Every n-th vertex.
    samples: Vec<[f64; 3]>,
}

impl Golden {
    /// The record of a mesh, which must be closed.
    pub fn of(mesh: &TriMesh) -> Result<Self, Fault> {
        let topology = topology(&Connected::new(mesh)?);
        if topology.boundary_loops > 0 {
            return Err(format!("the result is open: {} boundary loops", topology.boundary_loops).into());
        }
        let stride = (mesh.vertex_count() / SAMPLES).max(1);
        Ok(Self {
            vertices: mesh.vertex_count(),
            faces: mesh.face_count(),
            components: topology.components,
            genus: topology.genus(),
            connectivity: format!("{:016x}", connectivity(mesh)),
            diagonal: bounds(mesh).diagonal(),
            area: area(mesh),
            volume: volume(mesh),
            samples: mesh.positions.iter().step_by(stride).map(glam::DVec3::to_array).collect(),
        })
    }

    /// What differs from an approved record, in words.
    pub fn differences(&self, approved: &Self) -> Vec<String> {
        let mut all = vec![];
        let mut exact = |what: &str, is: String, was: String| {
            if is != was {
                all.push(format!("{what} is {is}, was {was}"));
            }
        };
        exact("vertex count", self.vertices.to_string(), approved.vertices.to_string());
        exact("face count", self.faces.to_string(), approved.faces.to_string());
        exact("component count", self.components.to_string(), approved.components.to_string());
        exact("genus", self.genus.to_string(), approved.genus.to_string());
        exact("connectivity", self.connectivity.clone(), approved.connectivity.clone());
        let size = approved.diagonal;
        for (what, is, was, scale) in [
            ("diagonal", self.diagonal, approved.diagonal, size),
            ("area", self.area, approved.area, size * size),
            ("volume", self.volume, approved.volume, size * size * size),
        ] {
            if (is - was).abs() > TOLERANCE * scale {
                all.push(format!("{what} is {is}, was {was}"));
            }
        }
        for (i, (is, was)) in self.samples.iter().zip(&approved.samples).enumerate() {
            if is.iter().zip(was).any(|(a, b)| (a - b).abs() > TOLERANCE * size) {
                all.push(format!("sample {i} is at {is:?}, was at {was:?}"));
                break;
            }
        }
        all
    }

    /// Reads an approved record; `None` where there is none yet.
    pub fn read(path: &Path) -> Result<Option<Self>, Fault> {
        match fs::read_to_string(path) {
            Ok(text) => Ok(Some(toml::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))?)),
            Err(_) => Ok(None),
        }
    }

    /// Approves this record.
    pub fn bless(&self, path: &Path) -> Result<(), Fault> {
        fs::create_dir_all(path.parent().unwrap_or(path))?;
        Ok(fs::write(path, toml::to_string(self)?)?)
    }
}

/// FNV-1a over the corners of all faces.
pub fn connectivity(mesh: &TriMesh) -> u64 {
    mesh.faces
        .iter()
        .flatten()
        .flat_map(|v| v.0.to_le_bytes())
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}
