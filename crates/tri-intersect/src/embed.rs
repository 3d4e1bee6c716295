//! Curves made part of a mesh: every curve becomes a chain of mesh edges, and only the faces it meets are split.
//!
//! What lies where is decided by addresses (vertex, edge, face), never by distance: points on an edge are shared by
//! both its faces, and each crossed face is triangulated by itself, constrained to the pieces of curve within it. The
//! triangulation is made in the face's plane seen along a coordinate axis, which leaves coordinates unchanged, so that exact predicates
//! judge the points as they are stored. Where rounding leaves no room for that (a needle thinner than the spacing of the numbers), it is made
//! in barycentric coordinates instead, and the face is reported.
//!
//! ```
//! use mesh_core::{Connected, FaceId, SurfacePoint, Watch, shapes};
//! use tri_intersect::embed::{EmbedParams, SurfaceCurve, curve_edges, embed, faces_left_of, flood};
//! let cube = Connected::new(shapes::cuboid(glam::DVec3::ONE))?;
//! // A triangle within a face of the cube, cut out.
//! let corners = [[0.6, 0.2, 0.2], [0.2, 0.6, 0.2], [0.2, 0.2, 0.6]];
//! let points = corners.map(|barycentric| SurfacePoint::Face { face: FaceId(0), barycentric }).to_vec();
//! let curves = [SurfaceCurve { points, closed: true }];
//! let embedded = embed(&cube, &curves, &EmbedParams::default(), &Watch::default())?;
//! let chain = &embedded.curves[0];
//! let cut = Connected::new(embedded.mesh)?;
//! let inside = flood(&cut, curve_edges(chain, true), &faces_left_of(&cut, chain, true));
//! assert_eq!(inside.as_slice().iter().filter(|&&f| f).count(), 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `curve.rs`, `error.rs` | curves on a mesh and how they are embedded; why they cannot be |
//! | `normalise.rs` | addresses made canonical: snapping, repeats, excursions around a vertex |
//! | `arrange.rs` | vertices of the result, points sorted along edges, pieces of curve sorted by face |
//! | `clash.rs` | places on curves that meet and should not |
//! | `face.rs` | the triangulation of one crossed face |
//! | `small.rs` | the same for few chains, without a general triangulation |
//! | `flood.rs` | the parts into which embedded curves divide a mesh |

mod arrange;
mod clash;
mod curve;
mod error;
mod face;
mod flood;
mod normalise;
mod small;

pub use curve::{EmbedParams, SurfaceCurve};
pub use error::{Crossing, EmbedError};
pub use flood::{curve_edges, faces_left_of, flood};

use arrange::Arrangement;
use clash::{Clash, Site};
use mesh_core::{
    Adjacency, FaceId, FaceOrigin, Origins, Positions, SurfacePoint, TriMesh, VertexId, VertexOrigin, Watch,
};
use normalise::{Chain, normalise};
use rayon::prelude::*;

/// A mesh with curves in it.
#[derive(Clone, Debug)]
pub struct Embedded {
    /// The mesh. Input vertices keep their ids and bits, untouched faces their ids and corners; new vertices and all but the first piece
    /// of every split face follow.
    pub mesh: TriMesh,
    /// Origins with respect to the input, which is part 0.
    pub origins: Origins,
    /// Each curve as a chain of vertices; consecutive ones (and last to first, if closed) are joined by a mesh edge.
    pub curves: Vec<Vec<VertexId>>,
    /// For each input curve and point: its index in the chain. Neighbouring points that were merged share one.
    pub places: Vec<Vec<usize>>,
    /// Faces of the input so thin that rounding left some piece without positive area. Empty on sound meshes.
    pub flattened: Vec<FaceId>,
}

/// Makes `curves` part of `mesh`. Cost ∝ crossed faces and points (n log n), plus one copy of the arrays.
///
/// Curves may not meet, except that open ones may end on a point of another. The output does not depend on the number of threads.
///
/// # Errors
/// See [`EmbedError`].
pub fn embed<M: Adjacency + Positions + Sync>(
    mesh: &M,
    curves: &[SurfaceCurve],
    params: &EmbedParams,
    watch: &Watch,
) -> Result<Embedded, EmbedError> {
    // Points that must not be snapped, because snapping them made curves meet.
    let mut exact: Vec<Vec<bool>> = curves.iter().map(|c| vec![false; c.points.len()]).collect();
    loop {
        watch.step("embed", 0.0)?;
        let chains = curves
            .iter()
            .zip(&exact)
            .enumerate()
            .map(|(c, (curve, exact))| normalise(mesh, c, curve, exact, params))
            .collect::<Result<Vec<_>, _>>()?;
        let (arrangement, mut clashes) = Arrangement::new(mesh, &chains)?;
        watch.step("embed", 0.3)?;
        let jobs = arrangement.crossed_faces(mesh);
        // A face takes about a microsecond; smaller shares cost more to hand out than to do.
        let pieces: Vec<_> = jobs.par_iter().with_min_len(128).map(|&f| face::split(mesh, &arrangement, f)).collect();
        let mut whole = Vec::with_capacity(pieces.len());
        for (piece, &f) in pieces.into_iter().zip(&jobs) {
            match piece {
                Ok(piece) => whole.push((f, piece)),
                Err(found) => clashes.extend(found),
            }
        }
        if clashes.is_empty() {
            watch.step("embed", 0.8)?;
            return assemble(mesh, &chains, &arrangement, whole);
        }
        if !forbid_snapping(&chains, &clashes, &mut exact) {
            return Err(report(mesh, &chains, &arrangement, &clashes));
        }
    }
}

/// Marks the input points around every clash that had been moved or merged. False if none is left to mark.
fn forbid_snapping(chains: &[Chain], clashes: &[Clash], exact: &mut [Vec<bool>]) -> bool {
    let mut any = false;
    for site in clashes.iter().flat_map(|c| c.sites).flatten() {
        let chain = &chains[site.curve];
        for node in [site.node, (site.node + 1) % chain.nodes.len()].map(|k| &chain.nodes[k]) {
            let marks = &mut exact[site.curve];
            let all = marks.len();
            for k in (0..node.count).map(|k| (node.first + k) % all) {
                any |= node.moved && !std::mem::replace(&mut marks[k], true);
            }
        }
    }
    any
}

fn report<M: Adjacency + Positions>(
    mesh: &M,
    chains: &[Chain],
    arrangement: &Arrangement,
    clashes: &[Clash],
) -> EmbedError {
    let crossings: Vec<_> = clashes
        .iter()
        .filter_map(|clash| match clash.sites {
            [Some(a), Some(b)] => Some(Crossing {
                place: clash.place,
                face: clash.face,
                curves: [a.curve, b.curve],
                points: [a, b].map(|Site { curve, node }| chains[curve].nodes[node].first),
            }),
            _ => None,
        })
        .collect();
    if crossings.is_empty() {
        let face = clashes.first().map_or(FaceId(0), |c| c.face);
        return EmbedError::TooSmall { face, place: arrangement.position(mesh, mesh.corners(face)[0]) };
    }
    EmbedError::Crossings(crossings)
}

fn assemble<M: Adjacency + Positions>(
    mesh: &M,
    chains: &[Chain],
    arrangement: &Arrangement,
    pieces: Vec<(FaceId, face::Split)>,
) -> Result<Embedded, EmbedError> {
    let more: usize = pieces.iter().map(|(_, s)| s.triangles.len() - 1).sum();
    let limit = (u32::MAX / 3) as usize;
    if mesh.face_count() + more >= limit || mesh.vertex_count() + arrangement.new.len() >= limit {
        return Err(EmbedError::TooMany);
    }
    let mut origins = Origins::identity(0, mesh.vertex_count(), mesh.face_count());
    let mut positions = Vec::with_capacity(mesh.vertex_count() + arrangement.new.len());
    positions.extend(mesh.vertex_ids().map(|v| mesh.position(v)));
    for (address, place) in &arrangement.new {
        positions.push(*place);
        origins.vertices.push(origin_of(mesh, *address));
    }
    let mut faces = Vec::with_capacity(mesh.face_count() + more);
    faces.extend(mesh.face_ids().map(|f| mesh.corners(f)));
    let mut flattened = vec![];
    for (f, split) in pieces {
        let piece = FaceOrigin::Piece { part: 0, face: f };
        origins.faces[f] = piece;
        faces[f.index()] = split.triangles[0];
        for &triangle in &split.triangles[1..] {
            faces.push(triangle);
            origins.faces.push(piece);
        }
        if split.flattened {
            flattened.push(f);
        }
    }
    let places = chains
        .iter()
        .map(|chain| {
            let total = chain.nodes.iter().map(|n| n.count).sum();
            let mut places = vec![0; total];
            for (k, node) in chain.nodes.iter().enumerate() {
                for i in 0..node.count {
                    places[(node.first + i) % total] = k;
                }
            }
            places
        })
        .collect();
    Ok(Embedded { mesh: TriMesh { positions, faces }, origins, curves: arrangement.chains.clone(), places, flattened })
}

fn origin_of<M: Adjacency>(mesh: &M, address: SurfacePoint) -> VertexOrigin {
    match address {
        SurfacePoint::Vertex(vertex) => VertexOrigin::Input { part: 0, vertex },
        SurfacePoint::Edge { halfedge, t } => {
            VertexOrigin::Edge { part: 0, ends: [mesh.tail(halfedge), mesh.head(halfedge)], t }
        }
        SurfacePoint::Face { face, barycentric } => VertexOrigin::Face { part: 0, face, barycentric },
    }
}
