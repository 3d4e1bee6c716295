//! What to draw and how, and what can go wrong.

use glam::DVec3;
use mesh_core::Cancelled;
use std::path::PathBuf;

/// Longest side of a picture, in pixels: keeps the memory for one below 4 GiB.
pub(crate) const MAX_SIDE: u32 = 8192;

/// How a picture is taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Pixels across, 1 to 8192.
    pub width: u32,
    /// Pixels down, 1 to 8192.
    pub height: u32,
    /// Where the camera stands, as a direction from the model; any length but zero. The whole model is always framed.
    pub view: DVec3,
    /// What is up in the picture. When it is (nearly) the view direction another axis takes its place.
    pub up: DVec3,
    /// How depth is flattened.
    pub projection: Projection,
    /// What colour shows.
    pub color: Color,
    /// How triangles are shaded.
    pub shading: Shading,
    /// Triangle edges drawn on top, if wanted.
    pub wireframe: Option<Wireframe>,
    /// Whether the model stands on something.
    pub ground: Ground,
    /// Background at the top and at the bottom of the picture, sRGB in [0, 1].
    pub background: [[f64; 3]; 2],
    /// Ambient-occlusion rays per pixel, at most 256; 0 turns it off. Neighbouring pixels share theirs, sixteen by
    /// sixteen, so few are enough.
    pub ambient_samples: u32,
    /// Rays per pixel along each axis where the picture has edges, 1 to 16; elsewhere one ray does.
    pub supersampling: u32,
}

impl Default for Params {
    /// A shaded model, three-quarter view from above, 1024 × 1024.
    fn default() -> Self {
        Self {
            width: 1024,
            height: 1024,
            view: DVec3::new(0.55, 0.4, 1.0),
            up: DVec3::Y,
            projection: Projection::default(),
            color: Color::Plain,
            shading: Shading::default(),
            wireframe: None,
            ground: Ground::Shadow,
            background: [[0.965, 0.97, 0.98], [0.85, 0.87, 0.9]],
            ambient_samples: 8,
            supersampling: 3,
        }
    }
}

/// How depth is flattened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Nearer is larger.
    Perspective {
        /// Vertical angle of view in degrees, clamped to [1, 120].
        angle: f64,
    },
    /// Parallel rays: lengths across the view compare.
    Orthographic,
}

impl Default for Projection {
    /// A long lens: little distortion, still some depth.
    fn default() -> Self {
        Self::Perspective { angle: 24.0 }
    }
}

/// What colour shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Color {
    /// One quiet colour.
    #[default]
    Plain,
    /// Mean curvature: blue where hollow, white where flat, red where bulging; scaled by its 95th percentile.
    Curvature,
    /// A colour out of a fixed palette per face, such as the part it came from. One index per face, taken modulo the
    /// palette's length.
    Origin(Vec<u32>),
    /// Triangle shape, 2·inradius/circumradius: red for needles, through yellow, to green-blue for equilateral.
    Quality,
    /// Stripes as a reflecting surface would show them: kinks are tangent breaks, sharp bends curvature breaks.
    Zebra,
    /// One sRGB colour in [0, 1] per face.
    PerFace(Vec<[f64; 3]>),
    /// One sRGB colour in [0, 1] per vertex, interpolated.
    PerVertex(Vec<[f64; 3]>),
}

/// How triangles are shaded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shading {
    /// Every facet shows.
    Flat,
    /// Normals are averaged across edges that turn by less than an angle.
    Smooth {
        /// Largest dihedral turn that still counts as smooth, in degrees.
        crease: f64,
    },
}

impl Default for Shading {
    fn default() -> Self {
        Self::Smooth { crease: 30.0 }
    }
}

/// Triangle edges on top of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wireframe {
    /// Line width in pixels.
    pub width: f64,
    /// sRGB in [0, 1].
    pub color: [f64; 3],
    /// From 0 (unseen) to 1 (opaque). Lines fade by themselves where triangles come down to a few pixels.
    pub opacity: f64,
}

impl Default for Wireframe {
    fn default() -> Self {
        Self { width: 1.0, color: [0.05, 0.07, 0.12], opacity: 0.75 }
    }
}

/// What the model stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ground {
    /// Nothing: the background alone.
    None,
    /// An unseen floor that receives a soft shadow, when seen from above.
    Shadow,
}

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// There is nothing to see.
    #[error("the mesh has no faces to draw; check that the file holds a surface and not only points")]
    Empty,
    /// The mesh cannot be drawn.
    #[error("cannot draw the mesh: {0}")]
    Mesh(#[from] mesh_query::Error),
    /// The picture's size is out of range.
    #[error("a picture of {width} × {height} pixels cannot be made; both sides must be between 1 and {MAX_SIDE}")]
    Size {
        /// Pixels asked for across.
        width: u32,
        /// Pixels asked for down.
        height: u32,
    },
    /// The camera has no direction to look from.
    #[error("the view direction {view} must be finite and not zero, such as 0,0,1 for a view from the front")]
    View {
        /// What was asked for.
        view: DVec3,
    },
    /// The caller's colours do not fit the mesh.
    #[error("{found} colours were given for {expected} {per}; give exactly one each")]
    ColorCount {
        /// `"faces"` or `"vertices"`.
        per: &'static str,
        /// How many the mesh has.
        expected: usize,
        /// How many were given.
        found: usize,
    },
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The file could not be written.
    #[error("cannot write {path}: {source}; check that the folder exists and is writable")]
    Save {
        /// The file.
        path: PathBuf,
        /// What went wrong.
        source: std::io::Error,
    },
}
