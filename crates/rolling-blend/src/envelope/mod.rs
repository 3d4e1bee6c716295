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
//! | `sides.rs` | on which side of a curve faces lie, where a patch reaches around its end |
//! | `centre.rs` | the admissible centre nearest to a point |
//! | `mark.rs` | what the ball cannot reach |
//! | `outline.rs` | the curves around it |
//! | `flip.rs` | needles of the piece that is cut out |
//! | `flush.rs` | plane faces at which it ends, continued up to the ball |
//! | `fences.rs` | cross-sections at which the piece ends, and the caps there |
//! | `draw.rs` | the piece drawn onto the envelope |
//! | `sound.rs` | folds, and walls and gaps narrower than the ball |

mod centre;
mod draw;
mod fences;
mod flip;
mod flush;
mod mark;
mod outline;
mod patches;
mod sides;
mod sound;

use crate::blended::Blended;
use crate::cap::{Cap, Fence};
use crate::field::piece::{self, cut_out, kept_chords, put_back};
use crate::linkage::Opened;
use crate::params::{Overlap, Params, Surface};
use crate::radii::Radii;
use crate::sew::sew;
use crate::sketch::{Drawing, Page};
use crate::stitch::check;
use crate::strip::Piece;
use crate::trouble::Trouble;
pub(crate) use centre::Ground;
use centre::Stop;
pub(crate) use draw::NO_BALL;
use fences::{Row, fenced, on_balls};
use flip::{flip_within, sorted};
use flush::flush;
use glam::DVec3;
use mark::Fine;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceMap, Faces, HalfedgeId, Origins, Positions, TriMesh, VertexId, VertexOrigin,
    Watch, dihedral_angle,
};
use mesh_query::TriBvh;
pub(crate) use patches::{Patches, to_segment};
use profile_nurbs::Profile;
use rayon::prelude::*;
pub(crate) use sound::TOO_NARROW;
use sound::{roomy, unfolded};
use spine::{BlendCurve, Convexity};
use std::collections::{BTreeMap, HashSet};
use tri_intersect::embed::{curve_edges, flood};
use tri_intersect::{EmbedError, EmbedParams, Embedded, SurfaceCurve, embed};

/// Length of the piece's edges at the usual tolerance, in radii: chords of a ball that stand off by 1.1% of its radius.
const EDGE: f64 = 0.3;
/// Shares of that length which are tried where the blend then meets itself in no more than a few places.
const FINER: [f64; 2] = [1.0, 0.6];
const FEW: usize = 32;
/// A turn between two faces, in radians, of which nothing is to be rounded.
const FLAT: f64 = 1e-6;
/// Levels of the scalar at which outlines are drawn, in radii, in the order in which they are tried. The first counts a face
/// that a ball touches along its whole middle as consumed.
const LEVELS: [f64; 3] = [1e-6, 4e-3, -4e-3];
/// Faces lower than this, in radii, no eye sees, so they may look anywhere: edges are flipped until they do not.
const NEEDLE: f64 = 1e-3;
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

/// The first end of a curve at which a crease of its own convexity stays sharp: there the blend has to stop at the surface
/// ahead, which a ball that rolls on all of the surface would round, too. `chosen` are the halfedges of all curves, both of
/// each edge.
pub(crate) fn sharp_end(mesh: &Connected<TriMesh>, curves: &[&BlendCurve], chosen: &[bool]) -> Option<DVec3> {
    let patches = Patches::new(mesh, chosen, [], 0.0);
    let is_ridge = |h: HalfedgeId| dihedral_angle(mesh, h).is_some_and(|a| a > 0.0);
    let ends = curves.iter().filter(|c| !c.closed).flat_map(|c| {
        let (first, last) = (c.halfedges.first(), c.halfedges.last());
        first.map(|&h| (mesh.tail(h), h)).into_iter().chain(last.map(|&h| (mesh.head(h), h)))
    });
    let stays = |&(v, own): &(VertexId, HalfedgeId)| {
        mesh.ring(v).any(|h| patches.is_wall(h) && !chosen[h.index()] && is_ridge(h) == is_ridge(own))
    };
    ends.into_iter().find(stays).map(|(v, _)| mesh.position(v))
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

/// An envelope, and where it ends in planes.
pub(crate) struct Made {
    pub blended: Blended,
    /// A cap for each fence.
    pub caps: Vec<Cap>,
    pub continued: Vec<Continued>,
}

/// A plane face that was continued up to the ball.
pub(crate) struct Continued {
    /// Where its boundary was, and is no edge of the surface any more; and where it is now.
    pub before: Vec<VertexId>,
    pub now: Vec<VertexId>,
}

/// Blends `curves`, all of one convexity, by the envelope of a ball of the radius asked for, as far as the `fences`.
pub(crate) fn blend(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    convexity: Convexity,
    fences: &[Fence],
    params: &Params,
    watch: &Watch,
) -> Result<Made, Trouble> {
    let r = params.radius;
    let chosen = halfedges_of(mesh, curves);
    let fenced = fenced(mesh, fences);
    let tree = TriBvh::build(mesh).map_err(|e| Trouble::Spine(e.into()))?;
    let patches = Patches::new(mesh, &chosen, curves, r);
    let sign = if convexity == Convexity::Concave { 1.0 } else { -1.0 };
    let ground = Ground { mesh, patches: &patches, tree: &tree, sign, fences: &fenced };
    watch.step("blend", 0.0)?;
    let outlines = outlines(&ground, curves, &chosen, r)?;
    if outlines.is_empty() {
        // No point is touched, or all are.
        let turns = |h: HalfedgeId| dihedral_angle(mesh, h).is_some_and(|a| a.abs() > FLAT);
        if let Some(&h) = curves.iter().flat_map(|c| &c.halfedges).find(|&&h| turns(h)) {
            return Err(Trouble::at(NO_BALL, vec![mesh.position(mesh.tail(h))]));
        }
        let origins = Origins::identity(0, mesh.vertex_count(), mesh.face_count());
        let blended = Blended::new(mesh.mesh().clone(), origins, FaceId::from(mesh.face_count()));
        return Ok(Made { blended, caps: vec![], continued: vec![] });
    }
    watch.step("blend", 0.3)?;
    let embedded = embed(mesh, &outlines, &EmbedParams { snap: 0.1, reach: SNAP * r }, watch).map_err(refusal)?;
    let page = params.sketch.page(mesh, &curves[0]);
    let chain = |c: &Vec<VertexId>| (c.iter().map(|&v| embedded.mesh.positions[v.index()]).collect(), true);
    page.draw_field("linkages", || Drawing::Lines(embedded.curves.iter().map(chain).collect()));
    let cut = Connected::new(&embedded.mesh).map_err(Trouble::not_manifold("the cut mesh is not a manifold"))?;
    let removed = enclosed(&ground, r, curves, &cut, &embedded)?;
    let pieces = cut_out(&embedded.mesh, &removed, &embedded.curves).pieces();
    let mut rows = fences.iter().map(|f| Row::of(f, &embedded, r)).collect::<Result<Vec<_>, _>>()?;
    let (flush, stops): (Vec<Row>, Vec<Vec<Stop>>) =
        flush(&ground, r, &chosen, &cut, &removed, &embedded).into_iter().map(|f| (f.row, f.stops)).unzip();
    let stops: Vec<Stop> = stops.into_iter().flatten().collect();
    rows.extend(flush);
    let cut_out = CutOut {
        cut: &cut,
        removed: &removed,
        pieces: &pieces,
        embedded: &embedded,
        rows: &rows,
        fences,
        stops: &stops,
    };
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

/// The mesh with everything cut, and what of it is replaced.
struct CutOut<'a> {
    cut: &'a Connected<&'a TriMesh>,
    removed: &'a FaceMap<bool>,
    pieces: &'a [piece::CutOut],
    embedded: &'a Embedded,
    /// Those of the fences first.
    rows: &'a [Row],
    fences: &'a [Fence],
    stops: &'a [Stop],
}

/// The pieces drawn with edges about `edge` long, put in and checked.
fn tessellated(
    CutOut { cut, removed, pieces, embedded, rows, fences, stops }: &CutOut<'_>,
    ground: &Ground<'_>,
    r: f64,
    edge: f64,
    page: Page<'_>,
    watch: &Watch,
) -> Result<Made, Trouble> {
    let drawn: Vec<TriMesh> = pieces
        .par_iter()
        .map(|piece| {
            let piece = on_balls(piece, *rows);
            draw::draw(&piece, ground, (r, edge), stops, &kept_chords(cut, removed, &piece.rim), watch)
        })
        .collect::<Result<_, _>>()?;
    page.draw_field("surface", || Drawing::Mesh(TriMesh::merged(&drawn)));
    let mut first_new = embedded.mesh.vertex_count() as u32;
    let (ends, mut back): (Vec<Vec<VertexId>>, Vec<Piece>) =
        rows.iter().map(|row| row.close(cut, removed, &mut first_new)).unzip();
    let twins: BTreeMap<VertexId, VertexId> =
        rows.iter().zip(&ends).flat_map(|(row, end)| row.chain.iter().copied().zip(end.iter().copied())).collect();
    for (piece, drawn) in pieces.iter().zip(&drawn) {
        let rim: Vec<VertexId> = piece.rim.iter().map(|v| twins.get(v).copied().unwrap_or(*v)).collect();
        back.push(put_back(&rim, drawn, first_new));
        first_new += (drawn.positions.len() - piece.rim.len()) as u32;
    }
    let opened =
        Opened { linkages: vec![], joints: vec![], stops: vec![], loops: vec![], embedded: (*embedded).clone() };
    let mut sewn = sew(&opened, removed, &back);
    let on_rows: HashSet<[VertexId; 2]> =
        ends.iter().flat_map(|e| e.windows(2)).map(|w| [sewn.id(w[0]), sewn.id(w[1])]).map(sorted).collect();
    flip_within(&mut sewn.mesh, sewn.first_new_face, NEEDLE * r, |edge| on_rows.contains(&edge));
    check(&sewn, watch)?;
    let in_caps: usize = back[..rows.len()].iter().map(|p| p.faces.len()).sum();
    let first = sewn.first_new_face.index() + in_caps;
    unfolded(&sewn.mesh, first)?;
    roomy(&sewn.mesh, first, r, ground.sign)?;
    let ids = |chain: &[VertexId]| chain.iter().map(|&v| sewn.id(v)).collect();
    let closed = rows.iter().zip(&ends);
    let cap = |(fence, (row, end)): (&Fence, (&Row, &Vec<VertexId>))| Cap {
        centre: fence.centre,
        end: ids(end),
        section: ids(&row.chain),
    };
    let caps = fences.iter().zip(closed.clone()).map(cap).collect();
    let continued = closed.skip(fences.len());
    let continued = continued.map(|(row, end)| Continued { before: ids(&row.chain), now: ids(end) }).collect();
    let blended = Blended { fields: drawn.len(), ..Blended::new(sewn.mesh, sewn.origins, sewn.first_new_face) };
    Ok(Made { blended, caps, continued })
}

/// The outlines of what the ball cannot reach; none where it touches all of the surface, as along the edges of a sliver in a
/// smooth patch. Where they touch, they are drawn a little wider or narrower.
fn outlines(ground: &Ground<'_>, curves: &[BlendCurve], chosen: &[bool], r: f64) -> Result<Vec<SurfaceCurve>, Trouble> {
    let mut refusal = None;
    let mut fine = Fine::around(ground, curves, r)?;
    for level in LEVELS {
        match outline::outlines(ground, fine.mark(ground, chosen, r, level), chosen, r) {
            Ok(found) if !found.is_empty() => return Ok(found),
            Ok(_) => {}
            Err(trouble) => refusal = Some(trouble),
        }
    }
    refusal.map_or(Ok(vec![]), Err)
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

/// The faces within the outlines: of the parts into which these divide the mesh, those in which most of the curves is under
/// the ball. No outline may have such faces on both sides.
fn enclosed(
    ground: &Ground<'_>,
    r: f64,
    curves: &[BlendCurve],
    cut: &Connected<&TriMesh>,
    embedded: &Embedded,
) -> Result<FaceMap<bool>, Trouble> {
    let chosen: HashSet<[VertexId; 2]> = curves
        .iter()
        .flat_map(|c| &c.halfedges)
        .map(|&h| (ground.mesh.tail(h), ground.mesh.head(h)))
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
    // Where a valley opens towards its end, the ball reaches its last bit.
    let is_under_ball = |h: HalfedgeId| {
        let [a, b] = cut.ends(h);
        mark::scalar(ground, mark::parent(&embedded.origins, h.face()), a.midpoint(b), r) < 0.0
    };
    let walls = || embedded.curves.iter().flat_map(|c| curve_edges(c, true));
    let mut removed = FaceMap::filled(cut.face_count(), false);
    let mut seen = removed.clone();
    for seed in cut.halfedge_ids().filter(|&h| on_curve(h)).map(HalfedgeId::face) {
        if seen[seed] {
            continue;
        }
        let part = flood(cut, walls(), &[seed]);
        let own = || cut.face_ids().filter(|&f| part[f]);
        let along: f64 = own()
            .flat_map(FaceId::halfedges)
            .filter(|&h| on_curve(h))
            .map(|h| if is_under_ball(h) { cut.edge_length(h) } else { -cut.edge_length(h) })
            .sum();
        for f in own() {
            (seen[f], removed[f]) = (true, along > 0.0);
        }
    }
    for [a, b] in walls() {
        let faces = cut.halfedge(a, b).map(|h| [Some(h), cut.twin(h)].map(|h| h.map(|h| removed[h.face()])));
        if !matches!(faces, Some([Some(x), Some(y)]) if !(x && y)) {
            return Err(Trouble::at("the contact curves do not enclose the blend curve", vec![cut.position(a)]));
        }
    }
    Ok(removed)
}
