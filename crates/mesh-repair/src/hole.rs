//! Boundary loops filled one by one: a loop that cannot be filled stays as it is, and says why.

use crate::patch::Patch;
use glam::DVec3;
use mesh_core::{
    Cancelled, Connected, FaceId, FaceOrigin, Faces, HalfedgeId, Origins, TriMesh, VertexId, VertexOrigin, Watch,
    boundary_loops,
};
use rayon::prelude::*;
use tri_intersect::self_intersections_among;

/// A mesh whose holes are filled.
#[derive(Clone, Debug)]
pub struct Filled {
    /// The mesh: all vertices and faces that were there, then those of the patches.
    pub mesh: TriMesh,
    /// Where they came from; part 0 is the mesh before.
    pub origins: Origins,
    /// How many holes were filled.
    pub count: usize,
    /// The holes that are left.
    pub left: Vec<Unfilled>,
}

/// A hole that is left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unfilled {
    /// A point on its boundary loop.
    pub at: DVec3,
    /// Edges of the loop.
    pub edges: usize,
    /// Why.
    pub why: Why,
}

/// Why a hole is left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Why {
    /// No triangles between vertices of the loop make a surface that shares no edge with the mesh.
    NoSurface,
    /// Every surface that was tried crosses the mesh, itself or another hole's.
    Crosses,
}

/// What surfaces are called in origins.
const STAGE: &str = "fill";

/// Surfaces in the order in which they are tried.
const MANNERS: [Manner; 3] = [Manner::Smooth, Manner::Even, Manner::Plain];

#[derive(Clone, Copy)]
enum Manner {
    /// Continues what is around the hole.
    Smooth,
    /// Of least area, in triangles as large as those around.
    Even,
    /// Of least area, between the loop's own vertices.
    Plain,
}

/// Fills every boundary loop with a smooth surface; where that crosses something, with one of least area. The mesh's own vertices and
/// faces keep their bits and their order. Counts the loops filled. O(n³) for loops of up to 400 edges, O(n²) beyond.
///
/// # Errors
/// [`Cancelled`].
pub fn fill_holes(mesh: &Connected<TriMesh>, watch: &Watch) -> Result<Filled, Cancelled> {
    let loops = boundary_loops(mesh);
    let plain: Vec<Option<Patch>> = loops.par_iter().map(|walk| Patch::plain(mesh, walk)).collect();
    let mut done: Vec<Option<Patch>> = vec![None; loops.len()];
    for (step, manner) in MANNERS.into_iter().enumerate() {
        watch.step("fill", step as f64 / MANNERS.len() as f64)?;
        let made = |(plain, done): (&Option<Patch>, &Option<Patch>)| match (plain, done) {
            (Some(plain), None) => manner.surface(plain, mesh, watch),
            _ => None,
        };
        let tried: Vec<Option<Patch>> = plain.par_iter().zip(&done).map(made).collect();
        let wrong = crossing(mesh, &done, &tried, watch)?;
        for ((done, tried), wrong) in done.iter_mut().zip(tried).zip(wrong) {
            if !wrong && tried.is_some() {
                *done = tried;
            }
        }
    }
    let left = loops.iter().zip(&plain).zip(&done).filter(|(_, done)| done.is_none());
    let left = left.map(|((walk, plain), _)| Unfilled {
        at: start(mesh, walk),
        edges: walk.len(),
        why: if plain.is_some() { Why::Crosses } else { Why::NoSurface },
    });
    let left: Vec<Unfilled> = left.collect();
    let (filled, origins, _) = assembled(mesh, &done.iter().map(Option::as_ref).collect::<Vec<_>>());
    Ok(Filled { mesh: filled, origins, count: loops.len() - left.len(), left })
}

impl Manner {
    fn surface(self, plain: &Patch, mesh: &Connected<TriMesh>, watch: &Watch) -> Option<Patch> {
        match self {
            Self::Plain => Some(plain.clone()),
            Self::Even => plain.even(mesh, watch),
            Self::Smooth => plain.even(mesh, watch)?.smooth(mesh, watch),
        }
    }
}

fn start(mesh: &Connected<TriMesh>, walk: &[HalfedgeId]) -> DVec3 {
    walk.first().map_or(DVec3::ZERO, |&h| mesh.mesh().positions[mesh.tail(h).index()])
}

/// Which of the surfaces tried cross the mesh, one that is done, themselves, or one tried for an earlier hole.
fn crossing(
    mesh: &Connected<TriMesh>,
    done: &[Option<Patch>],
    tried: &[Option<Patch>],
    watch: &Watch,
) -> Result<Vec<bool>, Cancelled> {
    let mut wrong = vec![false; tried.len()];
    let all: Vec<Option<&Patch>> = done.iter().zip(tried).map(|(d, t)| d.as_ref().or(t.as_ref())).collect();
    let (whole, _, owners) = assembled(mesh, &all);
    let first = mesh.face_count();
    let owner = |f: FaceId| f.index().checked_sub(first).map(|i| owners[i]).filter(|&o| done[o].is_none());
    let fresh: Vec<FaceId> = whole.face_ids().filter(|&f| owner(f).is_some()).collect();
    match self_intersections_among(&whole, &fresh, watch) {
        Ok(pairs) => {
            for [f, g] in pairs {
                match (owner(f), owner(g)) {
                    (Some(a), Some(b)) if a != b => {
                        let (low, high) = (a.min(b), a.max(b));
                        wrong[high] |= !wrong[low];
                    }
                    (a, b) => a.or(b).into_iter().for_each(|o| wrong[o] = true),
                }
            }
        }
        Err(tri_intersect::Error::Cancelled(c)) => return Err(c),
        // What cannot be tested is not put in.
        Err(_) => wrong.fill(true),
    }
    Ok(wrong)
}

/// The mesh with patches, where each vertex and face came from, and the hole of each face of a patch.
fn assembled(mesh: &Connected<TriMesh>, patches: &[Option<&Patch>]) -> (TriMesh, Origins, Vec<usize>) {
    let mut whole = mesh.mesh().clone();
    let mut origins = Origins::identity(0, mesh.vertex_count(), mesh.face_count());
    let mut owners = vec![];
    for (hole, patch) in patches.iter().enumerate() {
        let Some(patch) = patch else { continue };
        let first = whole.positions.len();
        let inner = &patch.mesh.positions[patch.rim.len()..];
        whole.positions.extend_from_slice(inner);
        for _ in inner {
            origins.vertices.push(VertexOrigin::New { stage: STAGE });
        }
        for f in &patch.mesh.faces {
            let name = |v: VertexId| match patch.rim.get(v.index()) {
                Some(&own) => own,
                None => VertexId::from(first + v.index() - patch.rim.len()),
            };
            whole.faces.push(f.map(name));
            origins.faces.push(FaceOrigin::New { stage: STAGE });
            owners.push(hole);
        }
    }
    (whole, origins, owners)
}
