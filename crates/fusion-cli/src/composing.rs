//! What can be typed for `compose`.

use crate::args::{Source, Target};
use crate::detailing::PartPlace;
use crate::length::{Length, crease, mesh_and_loop, positive_length, share};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Args)]
pub struct Compose {
    /// The open parts, as they are posed in their files
    #[arg(required = true, value_name = "MESH")]
    pub inputs: Vec<PathBuf>,
    #[command(flatten)]
    pub target: Target,
    #[command(flatten)]
    pub source: Source,
    /// Kernel of the field
    #[arg(long, value_enum, default_value = "triharmonic")]
    pub kernel: Kernel,
    /// How the field is held at the openings
    #[arg(long, value_enum, default_value = "implicit")]
    pub method: Method,
    /// Rings of vertices around each opening that the field interpolates [default: 3; hermite 1, montage 0]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=16))]
    pub rings: Option<u8>,
    /// Size of the tessellation's cells, as a share of the openings' mean edge
    #[arg(long, value_name = "SHARE", default_value_t = 1.0, value_parser = share)]
    pub cell: f64,
    /// Edge length of the surface away from the openings [default: that of the nearest openings]
    #[arg(long, value_name = "L", value_parser = positive_length)]
    pub edge_length: Option<Length>,
    /// Join only this loop: MESH:LOOP, both counted from 0, as `info` lists them; may be given more than once
    #[arg(long = "loop", value_name = "MESH:LOOP", value_parser = mesh_and_loop)]
    pub loops: Vec<(usize, usize)>,
    /// By how many degrees the surface turns inward where it leaves the openings; negative outward
    #[arg(long, value_name = "DEG", default_value_t = 0.0, value_parser = crease, allow_hyphen_values = true)]
    pub crease: f64,
    /// Trim openings nearer than this to one of another part back along their own part
    #[arg(long, value_name = "DISTANCE", value_parser = positive_length)]
    pub adjust: Option<Length>,
    /// Give the surface the geometry detail of a region of a part: MESH:REGION, counted from 0; may be given more than once
    #[arg(long = "detail", value_name = "MESH:REGION", allow_hyphen_values = true)]
    pub details: Vec<PartPlace>,
    /// How far from the openings the surface may go, in diagonals of the box around them
    #[arg(long, value_name = "N", default_value_t = 1.0, value_parser = share)]
    pub space: f64,
}

/// The kernel of a field.
#[derive(Clone, Copy, ValueEnum)]
pub enum Kernel {
    /// r: shrinks least, bends sharply at the openings
    Biharmonic,
    /// r³: smooth, tolerant of noise
    Triharmonic,
    /// r³ with exact normals: smoothest on clean meshes
    Hermite,
}

impl From<Kernel> for fusion::compose::Kernel {
    fn from(kernel: Kernel) -> Self {
        match kernel {
            Kernel::Biharmonic => Self::Biharmonic,
            Kernel::Triharmonic => Self::Triharmonic,
            Kernel::Hermite => Self::Hermite,
        }
    }
}

/// How a field is held.
#[derive(Clone, Copy, ValueEnum)]
pub enum Method {
    /// Rings of the parts' vertices, and points outside of them
    Implicit,
    /// Boundary vertices alone, and points on both sides of them
    Montage,
}

impl From<Method> for fusion::compose::Method {
    fn from(method: Method) -> Self {
        match method {
            Method::Implicit => Self::Implicit,
            Method::Montage => Self::Montage,
        }
    }
}
