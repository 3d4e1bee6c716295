//! What may stand in a recipe, and in the tables of its steps. Keys that are in no table are refused by `keys.rs`.

use super::part_tables::{Part, Primitive};
use super::values::{DVec3Array, Length};
use crate::Picked;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::PathBuf;
use toml::Spanned;

/// A whole model: parts, and what is done with them.
#[derive(Clone, Debug, Deserialize)]
pub struct Recipe {
    /// Version of the language of recipes: 1.
    pub version: Spanned<u32>,
    /// Where the result goes, relative to the recipe.
    pub output: PathBuf,
    /// The kinds of steps in another order than cut, pose, boolean, compose, blend, cluster, detail. Kinds left out are not taken.
    pub steps: Option<Vec<Spanned<Step>>>,
    /// The parts.
    #[serde(default, rename = "part")]
    pub parts: Vec<Part>,
    /// What parts ride on, by name.
    #[serde(default, rename = "primitive")]
    pub primitives: BTreeMap<String, Primitive>,
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
    /// Geometry detail for smooth regions.
    #[serde(default)]
    pub detail: Vec<Detail>,
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
    /// Geometry detail for smooth regions.
    Detail,
    /// Writing. Always the last.
    Output,
}

impl Step {
    /// The order of steps where a recipe names none.
    pub const ORDER: [Self; 7] =
        [Self::Cut, Self::Pose, Self::Boolean, Self::Compose, Self::Blend, Self::Cluster, Self::Detail];
}

/// A boolean.
#[derive(Clone, Debug, Deserialize)]
pub struct Boolean {
    /// `"union"` (the default), `"difference"` or `"intersection"`.
    pub operation: Option<Spanned<String>>,
    /// The parts by name, in order. All there are where left out.
    pub parts: Option<Vec<Spanned<String>>>,
    /// What the result is called. The first part's name where left out.
    pub name: Option<Spanned<String>>,
    /// Blends the seam with a ball of this radius; of two, the first is kept from the first part.
    pub radius: Option<Spanned<BallRadius>>,
    /// As for a blend.
    #[serde(default)]
    pub radius_at: Vec<Spanned<RadiusAt>>,
    /// As for a blend.
    #[serde(default)]
    pub profile_at: Vec<Spanned<ProfileAt>>,
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
    /// As for a blend.
    pub reach: Option<Spanned<f64>>,
    /// As for a blend.
    pub spine: Option<Spanned<String>>,
}

/// A join of openings by one smooth surface.
#[derive(Clone, Debug, Deserialize)]
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
    /// By how many degrees the surface turns inward at the openings: one number for all, or one for each by name.
    pub crease: Option<Spanned<Creases>>,
    /// Trims openings nearer than this to those of other parts.
    pub adjust: Option<Spanned<Length>>,
    /// Silhouettes that the surface shall have.
    #[serde(default)]
    pub silhouette: Vec<Silhouette>,
}

/// Creases of a join, in degrees.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum Creases {
    /// At every opening.
    All(f64),
    /// At the openings named, as in [`Compose::loops`].
    Each(BTreeMap<String, f64>),
}

/// A silhouette; see [`crate::compose::Silhouette`].
#[derive(Clone, Debug, Deserialize)]
pub struct Silhouette {
    /// Direction of the view.
    pub view: Spanned<DVec3Array>,
    /// One stroke.
    pub stroke: Option<Spanned<Vec<DVec3Array>>>,
    /// Several that are chained.
    pub strokes: Option<Spanned<Vec<Vec<DVec3Array>>>>,
    /// Whether they outline a hole.
    pub hole: Option<bool>,
    /// Other places for the two middle control points.
    pub control: Option<Spanned<[DVec3Array; 2]>>,
    /// Moves of the two along the view; a hole takes one number.
    pub depth: Option<Spanned<Depth>>,
}

/// One move along a view, or two.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(untagged)]
pub enum Depth {
    /// Everything by as much.
    One(f64),
    /// Each of the two middle control points.
    Two([f64; 2]),
}

/// A blend along feature curves.
#[derive(Clone, Debug, Deserialize)]
pub struct Blend {
    /// Which part, by name. The only one there is where left out.
    pub part: Option<Spanned<String>>,
    /// Radius of the ball, or two: from the left side of a curve and from the right one.
    pub radius: Spanned<BallRadius>,
    /// Radii at places, between which it changes smoothly.
    #[serde(default)]
    pub radius_at: Vec<Spanned<RadiusAt>>,
    /// Cross-sections at places, between which one changes smoothly into the next.
    #[serde(default)]
    pub profile_at: Vec<Spanned<ProfileAt>>,
    /// Least angle of a feature curve, in degrees; 40 where left out.
    pub angle: Option<Spanned<f64>>,
    /// Only the feature curves nearest to these points.
    #[serde(default)]
    pub near: Vec<DVec3Array>,
    /// Only the curves in this file, relative to the recipe, as `features -o` writes it; see [`Recipe::read_curves`].
    pub curves: Option<Spanned<PathBuf>>,
    /// `"arc"` (the default), `"g2"`, `"chamfer"`, `"sharp"`, `"hermite"` or `"conic=W"`.
    pub profile: Option<Spanned<String>>,
    /// `"full"` (the default), `"shrink"` or `"error"`.
    pub overlap: Option<Spanned<String>>,
    /// `"auto"` (the default), `"stitch"`, `"field"` or `"keep"`.
    pub surface: Option<Spanned<String>>,
    /// Reach of the base patches in radii, from 1 to 16.
    pub alpha: Option<Spanned<f64>>,
    /// Chord tolerance as a share of the radius, from 1e-6 to 0.5.
    pub tolerance: Option<Spanned<f64>>,
    /// Distance of the section's apex from the ball's centre, in radii, from 0.1 to 100.
    pub reach: Option<Spanned<f64>>,
    /// `"contact"` (the default) or `"offset"`.
    pub spine: Option<Spanned<String>>,
    /// What stands in the file of curves.
    #[serde(skip)]
    pub(super) picked: Vec<Picked>,
}

/// A ball's radius: one, or one for each side.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum BallRadius {
    /// On both sides.
    One(Length),
    /// From the left side and from the right one.
    Two([Length; 2]),
}

/// A cross-section at the place of a curve nearest to a point.
#[derive(Clone, Debug, Deserialize)]
pub struct ProfileAt {
    /// The point.
    pub at: DVec3Array,
    /// The cross-section there, as for a blend.
    pub profile: String,
}

/// A radius at the place of a curve nearest to a point.
#[derive(Clone, Debug, Deserialize)]
pub struct RadiusAt {
    /// The point.
    pub at: DVec3Array,
    /// The radius there.
    pub radius: Length,
}

/// A polyhedron rounded by clusters.
#[derive(Clone, Debug, Deserialize)]
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

/// Detail for a region.
#[derive(Clone, Debug, Deserialize)]
pub struct Detail {
    /// `"unstructured"`, or `"structured"` with `along`. Decided by `along` where left out.
    pub mode: Option<Spanned<String>>,
    /// What gets detail; what joins of openings have made where left out. A part it names is what goes by that name at this point.
    pub target: Option<Spanned<DetailRegion>>,
    /// Where detail is taken from: a region, or a list of them. A part named here is that part as posed, whole; without a name the region lies on the target's own part.
    pub source: Spanned<DetailRegions>,
    /// A curve from detail into the target, along which detail is continued patch by patch first.
    #[serde(default)]
    pub along: Vec<DVec3Array>,
    /// The curve on the source, where that is another part; that of `along` where left out.
    #[serde(default)]
    pub source_along: Vec<DVec3Array>,
    /// Width of the band along the curve.
    pub width: Option<Spanned<Length>>,
    /// Distance of patches along the curve.
    pub spacing: Option<Spanned<Length>>,
    /// Factor of the detail; 1 where left out.
    pub intensity: Option<Spanned<f64>>,
    /// What is shorter counts as detail.
    pub wavelength: Option<Spanned<Length>>,
    /// How far around a vertex similarity is judged: `"diagonal"` (the default), `"edges"`, or a length.
    pub fan: Option<Spanned<Length>>,
    /// `"indexed"` (the default) or `"exhaustive"`.
    pub search: Option<Spanned<String>>,
}

/// One region or several.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum DetailRegions {
    /// One.
    One(DetailRegion),
    /// Several.
    Many(Vec<DetailRegion>),
}

impl DetailRegions {
    /// All of them.
    pub fn all(&self) -> &[DetailRegion] {
        match self {
            Self::One(region) => std::slice::from_ref(region),
            Self::Many(regions) => regions,
        }
    }
}

/// A region of a part.
#[derive(Clone, Debug, Deserialize)]
pub struct DetailRegion {
    /// Which part, by name.
    pub part: Option<String>,
    /// The faces around the surface point nearest to this one, as far as `radius`.
    pub near: Option<DVec3Array>,
    /// See `near`.
    pub radius: Option<Length>,
    /// The faces of a group of the part's file.
    pub group: Option<String>,
    /// What a stage made: `"transition"`, `"blend"`.
    pub origin: Option<String>,
}
