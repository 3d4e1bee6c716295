//! Regression cases: procedural parts, an operation, an optional radius, as TOML.

use crate::Fault;
use glam::{DAffine3, DQuat, DVec3};
use mesh_core::{TriMesh, VertexId, shapes};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// One case, as its file holds it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    pub operation: Operation,
    /// Radius of the ball along the seam, in model units. Without it the seam stays sharp.
    pub radius: Option<f64>,
    pub part: Vec<Part>,
}

/// What to do with the parts.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Operation {
    Union,
    Difference,
    Intersection,
    /// All openings joined by one smooth surface.
    Compose,
}

/// A shape and where it stands: scaled, then turned, then moved.
#[derive(Debug, Deserialize)]
pub struct Part {
    #[serde(flatten)]
    pub shape: Shape,
    #[serde(default)]
    pub translate: [f64; 3],
    pub rotate: Option<Rotation>,
    #[serde(default = "one")]
    pub scale: f64,
}

/// A turn about an axis through the origin.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rotation {
    pub axis: [f64; 3],
    /// Degrees.
    pub angle: f64,
}

/// A procedural shape of `mesh_core::shapes`, by its parameters.
#[derive(Debug, Deserialize)]
#[serde(tag = "shape", rename_all = "lowercase")]
pub enum Shape {
    Box {
        size: [f64; 3],
    },
    Sphere {
        radius: f64,
        levels: u32,
    },
    Cylinder {
        radius: f64,
        height: f64,
        segments: u32,
        rows: u32,
    },
    Cone {
        radius: f64,
        height: f64,
        segments: u32,
        rows: u32,
    },
    Tube {
        inner: f64,
        outer: f64,
        height: f64,
        segments: u32,
        rows: u32,
    },
    Torus {
        major: f64,
        minor: f64,
        around: u32,
        across: u32,
    },
    Capsule {
        radius: f64,
        height: f64,
        segments: u32,
        rings: u32,
        rows: u32,
    },
    /// A capsule without its upper half ball: one opening, facing +z.
    Cup {
        radius: f64,
        height: f64,
        segments: u32,
        rings: u32,
        rows: u32,
    },
}

fn one() -> f64 {
    1.0
}

impl Part {
    /// The posed mesh.
    pub fn build(&self) -> TriMesh {
        let mut mesh = self.shape.build();
        let turn = self.rotate.as_ref().map_or(DQuat::IDENTITY, |r| {
            DQuat::from_axis_angle(DVec3::from(r.axis).normalize_or(DVec3::Z), r.angle.to_radians())
        });
        let pose = DAffine3::from_scale_rotation_translation(DVec3::splat(self.scale), turn, self.translate.into());
        mesh.positions.iter_mut().for_each(|p| *p = pose.transform_point3(*p));
        mesh
    }
}

impl Shape {
    fn build(&self) -> TriMesh {
        match *self {
            Self::Box { size } => shapes::cuboid(size.into()),
            Self::Sphere { radius, levels } => shapes::icosphere(radius, levels),
            Self::Cylinder { radius, height, segments, rows } => shapes::cylinder(radius, height, segments, rows),
            Self::Cone { radius, height, segments, rows } => shapes::cone(radius, height, segments, rows),
            Self::Tube { inner, outer, height, segments, rows } => shapes::tube(inner, outer, height, segments, rows),
            Self::Torus { major, minor, around, across } => shapes::torus(major, minor, around, across),
            Self::Capsule { radius, height, segments, rings, rows } => {
                shapes::capsule(radius, height, segments, rings, rows)
            }
            Self::Cup { radius, height, segments, rings, rows } => {
                below(&shapes::capsule(radius, height, segments, rings, rows), 0.5 * height)
            }
        }
    }
}

/// The faces of a mesh that reach no higher than `top`, up to rounding, and their vertices.
fn below(mesh: &TriMesh, top: f64) -> TriMesh {
    let low = |v: &VertexId| mesh.positions[v.index()].z <= top * (1.0 + 1e-9);
    let mut ids = vec![None; mesh.positions.len()];
    let mut part = TriMesh::default();
    for face in mesh.faces.iter().filter(|f| f.iter().all(low)) {
        part.faces.push(face.map(|v| {
            *ids[v.index()].get_or_insert_with(|| {
                part.positions.push(mesh.positions[v.index()]);
                VertexId::from(part.positions.len() - 1)
            })
        }));
    }
    part
}

/// Every case of a folder, in order of name.
pub fn read_all(folder: &Path) -> Result<Vec<(String, Case)>, Fault> {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder)?.flatten().map(|e| e.path()).collect();
    paths.retain(|p| p.extension().is_some_and(|e| e == "toml"));
    paths.sort();
    let read = |path: PathBuf| {
        let name = path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        let case = toml::from_str(&fs::read_to_string(&path)?).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok((name, case))
    };
    paths.into_iter().map(read).collect()
}
