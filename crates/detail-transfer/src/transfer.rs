//! The whole way: surfaces taken apart, detail propagated, the target put together again.

use crate::error::Error;
use crate::reconstruct::Reconstruction;
use crate::relief::{BaseParams, Detail, Relief};
use crate::spectrum::match_bands;
use crate::structured::{Banded, Ribbon, fill_structured};
use crate::unstructured::{Filled, Search, fill_unstructured};
use glam::DVec3;
use mesh_core::{Adjacency, Bounds, Connected, FaceMap, Faces, Positions, TriMesh, VertexId, Watch, bounds};

/// A region to take detail from, on the same mesh as the target or on another.
#[derive(Clone, Copy, Debug)]
pub struct Exemplar<'a> {
    /// The mesh.
    pub mesh: &'a Connected<TriMesh>,
    /// Its faces that may be copied from.
    pub inside: &'a FaceMap<bool>,
}

/// How long fans are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum FanLength {
    /// A hundredth of the diagonal of the target mesh's box, as in all examples of \[Lin2008\] (§5.1), but no less than [`FanLength::Edges`]:
    /// shorter fans hardly leave the faces of the vertex itself, of which nothing is known.
    #[default]
    Diagonal,
    /// One and a half longest edges of the target's base (\[Lin2008\] §4.2), the longest hundredth left aside.
    Edges,
    /// In model units.
    Units(f64),
}

/// How detail is transferred.
#[derive(Clone, Debug, Default)]
pub struct Params {
    /// What is shorter counts as detail, in model units; see [`BaseParams::wavelength`]. `None`: twelve mean edges of the first source.
    pub wavelength: Option<f64>,
    /// Length of geodesic fans.
    pub fan: FanLength,
    /// How fans are searched for.
    pub search: Search,
    /// Factor of the detail; negative turns bumps into dents. `None`: 1.
    pub intensity: Option<f64>,
    /// A curve along which detail is propagated first, patch by patch; fans do the rest.
    pub ribbon: Option<Ribbon>,
    /// See [`BaseParams::most_folded`]. `None`: its default.
    pub most_folded: Option<f64>,
}

/// What the user should know although it went well.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Warning {
    /// Some of a source folds over its base.
    #[error(
        "{:.2}% of source {source_index} folds over its own base near {at}: such detail is smeared where it is copied", 100.0 * share
    )]
    Folds {
        /// Which source.
        source_index: usize,
        /// The share of its area.
        share: f64,
        /// Where.
        at: DVec3,
    },
    /// The target's edges are much longer than the source's.
    #[error(
        "the target's mean edge is {target} and that of source {source_index} {source_edge}: finer detail is lost; remesh the target first"
    )]
    Coarse {
        /// Which source.
        source_index: usize,
        /// The target's mean edge, in model units.
        target: f64,
        /// The source's.
        source_edge: f64,
    },
}

/// A target with its new detail.
#[derive(Clone, Debug)]
pub struct Transferred {
    /// The mesh; connectivity unchanged, all vertices but `moved` bit for bit.
    pub mesh: TriMesh,
    /// The target's inner vertices, ascending.
    pub moved: Vec<VertexId>,
    /// What was found vertex by vertex.
    pub filled: Filled,
    /// What was found along the curve.
    pub banded: Option<Banded>,
    /// By how much the detail put together was too weak or strong at waves up to an eighth, a quarter, a half and the whole of the wavelength: what it was multiplied by.
    pub gains: [f64; 4],
    /// The wavelength used, in model units.
    pub wavelength: f64,
    /// The length of fans, in model units.
    pub fan: f64,
    /// Vertices that detail could be copied from.
    pub source_vertices: usize,
    /// What the user should know.
    pub warnings: Vec<Warning>,
}

/// How much longer the target's edges may be than the source's.
const COARSE: f64 = 1.6;

/// Replaces the detail of the region `target` of a mesh by that of the sources, continuing what is around it. The region's boundary and all outside
/// stay bit for bit.
///
/// # Errors
/// [`Error`]; [`Error::Folded`] for a source whose detail is of another topology than its base.
pub fn transfer(
    mesh: &Connected<TriMesh>,
    target: &FaceMap<bool>,
    exemplars: &[Exemplar<'_>],
    params: &Params,
    watch: &Watch,
) -> Result<Transferred, Error> {
    let Some(first) = exemplars.first() else { return Err(Error::Empty { which: "source" }) };
    let wavelength = params.wavelength.unwrap_or_else(|| EDGES * mean_edge(first.mesh, first.inside));
    let mut base = BaseParams::new(wavelength);
    base.most_folded = params.most_folded.unwrap_or(base.most_folded);
    let mut warnings = vec![];
    // Fans reach beyond the regions: detail must be good there as well.
    let reach = match params.fan {
        FanLength::Units(length) if length > 0.0 => length,
        _ => FAN_SHARE * finite_diagonal(mesh),
    };
    let reliefs = exemplars.iter().map(|e| Relief::encode_as("source", e.mesh, e.inside, &base, reach, watch));
    let reliefs = reliefs.collect::<Result<Vec<_>, _>>()?;
    for (source_index, relief) in reliefs.iter().enumerate() {
        if let Some((share, at, handles)) = relief.folded() {
            if share > base.most_folded {
                return Err(Error::Folded { share, at, handles });
            }
            warnings.push(Warning::Folds { source_index, share, at });
        }
    }
    let mut goal = Relief::encode_as("target", mesh, target, &base, reach, watch)?;
    let own = mean_edge(mesh, target);
    for (source_index, e) in exemplars.iter().enumerate() {
        let source_edge = mean_edge(e.mesh, e.inside);
        if own > COARSE * source_edge {
            warnings.push(Warning::Coarse { source_index, target: own, source_edge });
        }
    }
    let longest = goal.longest_edge();
    let fan = match params.fan {
        FanLength::Units(length) => length,
        FanLength::Edges => 1.5 * longest,
        FanLength::Diagonal => reach.max(1.5 * longest),
    };
    let free = goal.interior();
    let is_free = |v: VertexId| goal.vertices().binary_search(&v).is_ok_and(|k| free[k]);
    // A source on the target's own mesh must not lend what is about to be replaced.
    let excluded = |(e, relief): (&Exemplar<'_>, &Relief)| -> Vec<bool> {
        let same = std::ptr::eq(e.mesh, mesh);
        relief.vertices().iter().map(|&v| same && is_free(v)).collect()
    };
    let excluded: Vec<Vec<bool>> = exemplars.iter().zip(&reliefs).map(excluded).collect();
    let source_vertices = reliefs.iter().zip(&excluded).map(|(r, e)| r.region_vertices(e).count()).sum();
    let sources: Vec<(&Relief, Vec<bool>)> = reliefs.iter().zip(excluded).collect();
    goal.weigh(&sources);
    let mut details: Vec<Option<Detail>> = known_details(&goal, &free);
    let banded = match &params.ribbon {
        Some(ribbon) => Some(fill_structured(&goal, &mut details, &sources, ribbon, watch)?),
        None => None,
    };
    let filled = fill_unstructured(&goal, &mut details, &sources, fan, params.search, watch)?;
    watch.step("reconstruct", 0.0)?;
    let prepared = Reconstruction::new(&goal, &free)?;
    let mut details: Vec<Detail> = details.iter().map(|d| d.unwrap_or_default()).collect();
    let made = prepared.solve(&details);
    watch.step("reconstruct", 0.4)?;
    let made: Vec<DVec3> = made.iter().zip(&goal.base().mesh().positions).map(|(p, b)| *p - *b).collect();
    let gains = match_bands(&goal, &free, &made, &sources, &mut details)?;
    watch.step("reconstruct", 0.8)?;
    let intensity = params.intensity.unwrap_or(1.0);
    let details: Vec<Detail> = details.iter().map(|d| d.scaled(intensity)).collect();
    let places = prepared.solve(&details);
    let mut out = mesh.mesh().clone();
    let mut moved = vec![];
    for ((&v, place), _) in goal.vertices().iter().zip(places).zip(&free).filter(|(_, free)| **free) {
        if !place.is_finite() {
            return Err(Error::Singular { at: mesh.position(v) });
        }
        out.positions[v.index()] = place;
        moved.push(v);
    }
    Ok(Transferred { mesh: out, moved, filled, banded, gains, wavelength, fan, source_vertices, warnings })
}

/// The details that do not depend on where the free vertices are.
fn known_details(relief: &Relief, free: &[bool]) -> Vec<Option<Detail>> {
    let mut known: Vec<Option<Detail>> = relief.details().iter().copied().map(Some).collect();
    for v in relief.base().vertex_ids().filter(|v| free[v.index()]) {
        known[v.index()] = None;
        for h in relief.base().ring(v) {
            known[relief.base().head(h).index()] = None;
        }
    }
    known
}

/// Mean edges in the default wavelength.
const EDGES: f64 = 12.0;
/// The default length of fans, as a share of the diagonal (\[Lin2008\] §5.1).
const FAN_SHARE: f64 = 0.01;

fn finite_diagonal(mesh: &Connected<TriMesh>) -> f64 {
    let all: Bounds = bounds(mesh);
    let diagonal = all.diagonal();
    if diagonal.is_finite() { diagonal } else { 0.0 }
}

/// The mean side of a region's faces.
fn mean_edge(mesh: &Connected<TriMesh>, inside: &FaceMap<bool>) -> f64 {
    let faces = mesh.face_ids().filter(|&f| inside.get(f) == Some(&true));
    let sides = faces.map(|f| mesh.triangle(f)).flat_map(|p| [0, 1, 2].map(|k| p[k].distance(p[(k + 1) % 3])));
    let (sum, count) = sides.fold((0.0, 0usize), |(s, n), l| (s + l, n + 1));
    sum / count.max(1) as f64
}
