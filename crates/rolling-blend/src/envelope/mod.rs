//! Networks of curves blended by the ball's envelope: no spine, no strips, no corners.
//!
//! What a ball on one side of the surface cannot reach is cut out along exact contact curves, and the piece is drawn onto
//! the envelope of all balls, point by point. Short edges between corners, consumed faces, and corners of any valence need no
//! special case.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | the stages |
//! | `patches.rs` | smooth patches, and normals within them |
//! | `centre.rs` | the admissible centre nearest to a point |
//! | `mark.rs` | what the ball cannot reach |
//! | `outline.rs` | the curves around it |
//! | `flip.rs` | needles of the piece that is cut out |
//! | `draw.rs` | the piece drawn onto the envelope |

mod centre;
mod draw;
mod flip;
mod mark;
mod outline;
mod patches;

use crate::blended::Blended;
use crate::field::piece::{self, cut_out, kept_chords, put_back};
use crate::linkage::Opened;
use crate::params::{Overlap, Params, Surface};
use crate::radii::Radii;
use crate::sew::sew;
use crate::sketch::{Drawing, Page};
use crate::stitch::check;
use crate::trouble::Trouble;
use centre::Ground;
use glam::DVec3;
use mark::Fine;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceMap, Faces, HalfedgeId, Positions, TriMesh, VertexId, VertexOrigin, Watch,
};
use mesh_query::TriBvh;
use patches::Patches;
pub(crate) use patches::to_segment;
use profile_nurbs::Profile;
use rayon::prelude::*;
use spine::{BlendCurve, Convexity};
use std::collections::HashSet;
use tri_intersect::embed::{curve_edges, flood};
use tri_intersect::{EmbedError, EmbedParams, Embedded, SurfaceCurve, embed};

/// Length of the piece's edges at the usual tolerance, in radii: chords of a ball that stand off by 1.1% of its radius.
const EDGE: f64 = 0.3;
/// Shares of that length which are tried where the blend then meets itself in no more than a few places.
const FINER: [f64; 2] = [1.0, 0.6];
const FEW: usize = 32;
/// Levels of the scalar at which outlines are drawn, in radii, in the order in which they are tried. The first counts a face
/// that a ball touches along its whole middle as consumed.
const LEVELS: [f64; 3] = [1e-6, 4e-3, -4e-3];
/// How far points of an outline may be moved to spare slivers, in radii.
const SNAP: f64 = 2e-3;

/// Whether the envelope may take the place of a sweep.
pub(crate) fn serves(params: &Params) -> bool {
    params.surface == Surface::Auto
        && params.overlap != Overlap::Error
        && matches!(params.profile, Profile::Arc)
        && params.profile_at.is_empty()
        && params.reach.is_none()
        && params.radii == Radii::default()
}

/// The first end of a curve at which a crease stays sharp: there the blend has to stop at the surface ahead, which a ball that rolls on
/// all of the surface would round, too. `chosen` are the halfedges of all curves, both of each edge.
pub(crate) fn sharp_end(mesh: &Connected<TriMesh>, curves: &[&BlendCurve], chosen: &[bool]) -> Option<DVec3> {
    let patches = Patches::new(mesh, chosen);
    let ends = curves.iter().filter(|c| !c.closed).flat_map(|c| {
        let (first, last) = (c.halfedges.first(), c.halfedges.last());
        first.map(|&h| mesh.tail(h)).into_iter().chain(last.map(|&h| mesh.head(h)))
    });
    let stays = |v: &VertexId| mesh.ring(*v).any(|h| patches.is_wall(h) && !chosen[h.index()]);
    ends.into_iter().find(stays).map(|v| mesh.position(v))
}

/// Both halfedges of every edge of some curves.
pub(crate) fn halfedges_of<'a>(
    mesh: &Connected<TriMesh>,
    curves: impl IntoIterator<Item = &'a BlendCurve>,
) -> Vec<bool> {
    let mut chosen = vec![false; 3 * mesh.face_count()];
    for h in curves.into_iter().flat_map(|c| &c.halfedges) {
        chosen[h.index()] = true;
        if let Some(t) = mesh.twin(*h) {
            chosen[t.index()] = true;
        }
    }
    chosen
}

/// Blends `curves`, all of one convexity, by the envelope of a ball of the radius asked for.
pub(crate) fn blend(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    convexity: Convexity,
    params: &Params,
    watch: &Watch,
) -> Result<Blended, Trouble> {
    let r = params.radius;
    let chosen = halfedges_of(mesh, curves);
    let tree = TriBvh::build(mesh).map_err(|e| Trouble::Spine(e.into()))?;
    let patches = Patches::new(mesh, &chosen);
    let sign = if convexity == Convexity::Concave { 1.0 } else { -1.0 };
    let ground = Ground { mesh, patches: &patches, tree: &tree, sign };
    watch.step("blend", 0.0)?;
    let outlines = outlines(&ground, curves, &chosen, r)?;
    watch.step("blend", 0.3)?;
    let embedded = embed(mesh, &outlines, &EmbedParams { snap: 0.1, reach: SNAP * r }, watch).map_err(refusal)?;
    let page = params.sketch.page(mesh, &curves[0]);
    let chain = |c: &Vec<VertexId>| (c.iter().map(|&v| embedded.mesh.positions[v.index()]).collect(), true);
    page.draw_field("linkages", || Drawing::Lines(embedded.curves.iter().map(chain).collect()));
    let cut = Connected::new(&embedded.mesh).map_err(Trouble::not_manifold("the cut mesh is not a manifold"))?;
    let removed = enclosed(mesh, curves, &cut, &embedded)?;
    let pieces = cut_out(&embedded.mesh, &removed, &embedded.curves).pieces();
    let cut_out = CutOut { cut: &cut, removed: &removed, pieces: &pieces, embedded: &embedded };
    let edge = EDGE * r * (params.tolerance.clamp(1e-6, 0.5) / 0.005).sqrt().min(1.0);
    let mut refusal = Trouble::at("the blend cannot be tessellated", vec![]);
    for share in FINER {
        match tessellated(&cut_out, &ground, r, share * edge, page, watch) {
            Err(Trouble::Places { what, places }) if places.len() <= FEW => refusal = Trouble::at(what, places),
            other => return other,
        }
    }
    Err(refusal)
}

/// The mesh with everything cut, and what of it is to be drawn anew.
struct CutOut<'a> {
    cut: &'a Connected<&'a TriMesh>,
    removed: &'a FaceMap<bool>,
    pieces: &'a [piece::CutOut],
    embedded: &'a Embedded,
}

/// The pieces drawn with edges about `edge` long, put in and checked.
fn tessellated(
    CutOut { cut, removed, pieces, embedded }: &CutOut<'_>,
    ground: &Ground<'_>,
    r: f64,
    edge: f64,
    page: Page<'_>,
    watch: &Watch,
) -> Result<Blended, Trouble> {
    let drawn: Vec<TriMesh> = pieces
        .par_iter()
        .map(|piece| draw::draw(piece, ground, r, edge, &kept_chords(cut, removed, &piece.rim), watch))
        .collect::<Result<_, _>>()?;
    page.draw_field("surface", || Drawing::Mesh(TriMesh::merged(&drawn)));
    let mut first_new = embedded.mesh.vertex_count() as u32;
    let mut back = Vec::with_capacity(pieces.len());
    for (piece, drawn) in pieces.iter().zip(&drawn) {
        back.push(put_back(&piece.rim, drawn, first_new));
        first_new += (drawn.positions.len() - piece.rim.len()) as u32;
    }
    let opened =
        Opened { linkages: vec![], joints: vec![], stops: vec![], loops: vec![], embedded: (*embedded).clone() };
    let sewn = sew(&opened, removed, &back);
    check(&sewn, watch)?;
    Ok(Blended { fields: back.len(), ..Blended::new(sewn.mesh, sewn.origins, sewn.first_new_face) })
}

/// The outlines of what the ball cannot reach. Where they touch, they are drawn a little wider or narrower.
fn outlines(ground: &Ground<'_>, curves: &[BlendCurve], chosen: &[bool], r: f64) -> Result<Vec<SurfaceCurve>, Trouble> {
    let mut refusal = Trouble::at("the ball touches all of the surface", vec![]);
    let mut fine = Fine::around(ground, curves, r)?;
    for level in LEVELS {
        match outline::outlines(ground, fine.mark(ground, chosen, r, level), chosen, r) {
            Ok(found) if !found.is_empty() => return Ok(found),
            Ok(_) => {}
            Err(trouble) => refusal = trouble,
        }
    }
    Err(refusal)
}

fn refusal(error: EmbedError) -> Trouble {
    match error {
        EmbedError::Crossings(found) => Trouble::at("contact curves cross", found.iter().map(|c| c.place).collect()),
        EmbedError::Apart { place, .. } | EmbedError::TooSmall { place, .. } => {
            Trouble::at("a contact curve cannot be cut into the mesh", vec![place])
        }
        EmbedError::Cancelled(c) => Trouble::Cancelled(c),
        other => Trouble::Embed(other),
    }
}

/// The faces within the outlines; each outline must have them on one side and others on the other.
fn enclosed(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    cut: &Connected<&TriMesh>,
    embedded: &Embedded,
) -> Result<FaceMap<bool>, Trouble> {
    let chosen: HashSet<[VertexId; 2]> = curves
        .iter()
        .flat_map(|c| &c.halfedges)
        .map(|&h| (mesh.tail(h), mesh.head(h)))
        .map(|(a, b)| [a.min(b), a.max(b)])
        .collect();
    let on_curve = |h: HalfedgeId| {
        let origins = [cut.tail(h), cut.head(h)].map(|v| embedded.origins.vertices[v]);
        let ends = origins.iter().find_map(|o| match *o {
            VertexOrigin::Edge { ends: [a, b], .. } => Some([a.min(b), a.max(b)]),
            _ => None,
        });
        let within = |edge: [VertexId; 2]| {
            origins.iter().all(|o| match *o {
                VertexOrigin::Input { vertex, .. } => edge.contains(&vertex),
                VertexOrigin::Edge { ends: [a, b], .. } => edge == [a.min(b), a.max(b)],
                _ => false,
            })
        };
        let (a, b) = (cut.tail(h), cut.head(h));
        ends.map_or(chosen.contains(&[a.min(b), a.max(b)]), |e| chosen.contains(&e) && within(e))
    };
    let seeds: Vec<FaceId> = cut.halfedge_ids().filter(|&h| on_curve(h)).map(HalfedgeId::face).collect();
    let walls = embedded.curves.iter().flat_map(|c| curve_edges(c, true));
    let removed = flood(cut, walls, &seeds);
    for [a, b] in embedded.curves.iter().flat_map(|c| curve_edges(c, true)) {
        let faces = cut.halfedge(a, b).map(|h| [Some(h), cut.twin(h)].map(|h| h.map(|h| removed[h.face()])));
        if !matches!(faces, Some([Some(x), Some(y)]) if x != y) {
            return Err(Trouble::at("the contact curves do not enclose the blend curve", vec![cut.position(a)]));
        }
    }
    Ok(removed)
}
