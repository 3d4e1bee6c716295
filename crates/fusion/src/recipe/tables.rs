//! What may stand in a recipe. Documented for its writers in docs/recipes.md.

use super::values::{DVec3Array, Length, Rotation};
use serde::Deserialize;
use std::path::PathBuf;
use toml::Spanned;

/// A whole model: parts, and what is done with them.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recipe {
    /// Version of the language of recipes: 1.
    pub version: Spanned<u32>,
    /// Where the result goes, relative to the recipe.
    pub output: PathBuf,
    /// The kinds of steps in another order than cut, pose, boolean, compose, blend, cluster. Kinds left out are not taken.
    pub steps: Option<Vec<Spanned<Step>>>,
    /// The parts.
    #[serde(default, rename = "part")]
    pub parts: Vec<Part>,
    /// Booleans.
    #[serde(default)]
    pub boolean: Vec<Boolean>,
    /// Joins of openings.
    #[serde(default)]
    pub compose: Vec<Compose>,
    /// Blends along feature curves.
    #[serde(default)]
    pub blend: Vec<Blend>,
    /// Polyhedra rounded by clusters.
    #[serde(default)]
    pub cluster: Vec<Cluster>,
    /// The recipe as written, for messages.
    #[serde(skip)]
    pub(super) text: String,
}

/// A kind of step.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Step {
    /// The parts' cuts, each in its own file's coordinates.
    Cut,
    /// The parts' poses.
    Pose,
    /// Booleans between parts.
    Boolean,
    /// Joins of openings by smooth surfaces.
    Compose,
    /// Blends along feature curves.
    Blend,
    /// Polyhedra rounded by clusters.
    Cluster,
    /// Writing. Always the last.
    Output,
}

impl Step {
    /// The order of steps where a recipe names none.
    pub const ORDER: [Self; 6] = [Self::Cut, Self::Pose, Self::Boolean, Self::Compose, Self::Blend, Self::Cluster];
}

/// One input.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// What other tables call it.
    pub name: Spanned<String>,
    /// Its file, relative to the recipe.
    pub mesh: PathBuf,
    /// Moves it, after turning.
    pub translate: Option<Spanned<DVec3Array>>,
    /// Turns it, after scaling.
    pub rotate: Option<Spanned<Rotation>>,
    /// Scales it about the origin.
    pub scale: Option<Spanned<f64>>,
    /// Cuts, in the file's own coordinates.
    #[serde(default)]
    pub cut: Vec<PartCut>,
}

/// A cut by a plane.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartCut {
    /// The plane; what its normal points to is removed.
    pub plane: Spanned<Plane>,
    /// Cut only the contour nearest to this point.
    pub seed: Option<Spanned<DVec3Array>>,
    /// See [`crate::cut::PlaneCut::snap`].
    pub snap: Option<Spanned<f64>>,
}

/// A plane.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// A point of it.
    pub point: DVec3Array,
    /// Its normal, of any length.
    pub normal: DVec3Array,
}

/// A boolean.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Boolean {
    /// `"union"` (the default), `"difference"` or `"intersection"`.
    pub operation: Option<Spanned<String>>,
    /// The parts by name, in order. All there are where left out.
    pub parts: Option<Vec<Spanned<String>>>,
    /// What the result is called. The first part's name where left out.
    pub name: Option<Spanned<String>>,
    /// Blends the seam with a ball of this radius.
    pub radius: Option<Spanned<Length>>,
    /// As for a blend.
    pub profile: Option<Spanned<String>>,
    /// As for a blend.
    pub overlap: Option<Spanned<String>>,
    /// As for a blend.
    pub surface: Option<Spanned<String>>,
    /// As for a blend.
    pub alpha: Option<Spanned<f64>>,
    /// As for a blend.
    pub tolerance: Option<Spanned<f64>>,
}

/// A join of openings by one smooth surface.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Compose {
    /// The openings, as `"part:loop"`, loops counted from 0 as `info` lists them for the part after its cuts; `"part"` alone is all of its
    /// loops. All open boundaries of all parts where left out.
    pub loops: Option<Vec<Spanned<String>>>,
    /// `"implicit"` (the default) or `"montage"`.
    pub method: Option<Spanned<String>>,
    /// `"triharmonic"` (the default), `"biharmonic"` or `"hermite"`.
    pub kernel: Option<Spanned<String>>,
    /// See [`crate::compose::Params::rings`].
    pub rings: Option<Spanned<u8>>,
    /// See [`crate::compose::Params::cell`].
    pub cell: Option<Spanned<f64>>,
    /// See [`crate::compose::Params::edge_length`].
    pub edge_length: Option<Spanned<Length>>,
    /// See [`crate::compose::Params::space`].
    pub space: Option<Spanned<f64>>,
    /// What the result is called. The name of the first part joined where left out.
    pub name: Option<Spanned<String>>,
}

/// A blend along feature curves.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Blend {
    /// Which part, by name. The only one there is where left out.
    pub part: Option<Spanned<String>>,
    /// Radius of the ball.
    pub radius: Spanned<Length>,
    /// Least angle of a feature curve, in degrees; 40 where left out.
    pub angle: Option<Spanned<f64>>,
    /// Only the feature curves nearest to these points.
    #[serde(default)]
    pub near: Vec<DVec3Array>,
    /// `"arc"` (the default), `"g2"`, `"chamfer"`, `"sharp"` or `"conic=W"`.
    pub profile: Option<Spanned<String>>,
    /// `"shrink"` (the default) or `"error"`.
    pub overlap: Option<Spanned<String>>,
    /// `"auto"` (the default), `"stitch"`, `"field"` or `"keep"`.
    pub surface: Option<Spanned<String>>,
    /// Reach of the base patches in radii, from 1 to 16.
    pub alpha: Option<Spanned<f64>>,
    /// Chord tolerance as a share of the radius, from 1e-6 to 0.5.
    pub tolerance: Option<Spanned<f64>>,
}

/// A polyhedron rounded by clusters.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cluster {
    /// Which part, by name. The only one there is where left out.
    pub part: Option<Spanned<String>>,
    /// Order of contact with the faces, 1 to 8.
    pub continuity: Option<Spanned<u8>>,
    /// A number, or two for clusters of four sides.
    pub degree: Option<crate::cluster::Degrees>,
    /// Reach along open edges, as a share of the edge.
    pub extent: Option<Spanned<f64>>,
    /// 0 for the fairest patches, towards 1 sharper ones.
    pub bulge: Option<Spanned<f64>>,
    /// Edges that stay sharp, by their vertices.
    #[serde(default)]
    pub sharp: Vec<[u32; 2]>,
    /// Whether all edges between clusters stay sharp.
    #[serde(default)]
    pub all_sharp: bool,
    /// Balance of the strips.
    pub mu: Option<Spanned<f64>>,
    /// Order of contact of strips with patches, 0 to 8.
    pub order: Option<Spanned<u8>>,
    /// Chord tolerance, as a share of the diagonal.
    pub tolerance: Option<Spanned<f64>>,
    /// The clusters; chosen where left out.
    pub clusters: Option<Vec<crate::cluster::Entry>>,
}
