//! Blends made on a coarse level of a decimation hierarchy, with the finer levels' details put back (\[Liu2005\] §6.3).

use super::refusal::Refusal;
use super::{Params, blend_level, check_apart};
use crate::{Blended, Error, Params as BlendParams, sew};
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceOrigin, Faces, Origins, TriMesh, VertexId, VertexMap, VertexOrigin, Watch,
};
use remesh::Hierarchy;
use spine::BlendCurve;

/// Goes from level to level, up to `how.levels` of them, as long as blends are possible; where the first is too coarse
/// already, blends the mesh itself.
///
/// Vertices of the curves are on every level. Those of the mesh that neither were moved nor have a neighbour, on the level
/// they come back on, that was keep their bits.
///
/// # Errors
/// That of the mesh itself, where no level serves.
pub(super) fn blend(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &BlendParams,
    how: &Params,
    watch: &Watch,
) -> Result<Blended, Error> {
    let mut held = VertexMap::filled(mesh.vertex_count(), false);
    for &h in curves.iter().flat_map(|c| &c.halfedges) {
        held[mesh.tail(h)] = true;
        held[mesh.head(h)] = true;
    }
    let mut coarsest = None;
    for levels in 1..=how.levels {
        // What decimation refuses, a blend of the mesh itself may not.
        let Ok(hierarchy) = Hierarchy::build(mesh, &held, levels, watch) else { break };
        if hierarchy.levels() < levels {
            break;
        }
        match on_level(mesh, curves, params, how, &hierarchy, watch) {
            Err(Error::Cancelled(c)) => return Err(c.into()),
            Err(_) => break,
            Ok(blended) => coarsest = Some(blended),
        }
    }
    if let Some(blended) = coarsest {
        return Ok(blended);
    }
    watch.step("blend", 0.0)?;
    blend_level(mesh, curves, params, how, watch)
}

fn on_level(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &BlendParams,
    how: &Params,
    hierarchy: &Hierarchy,
    watch: &Watch,
) -> Result<Blended, Error> {
    let coarse = Connected::new(hierarchy.coarsest().clone())?;
    let mut now = vec![VertexId(u32::MAX); mesh.vertex_count()];
    for (v, &before) in hierarchy.survivors().iter().enumerate() {
        now[before.index()] = VertexId::from(v);
    }
    let edge = |a: VertexId, b: VertexId| {
        let [a, b] = [now[a.index()], now[b.index()]];
        coarse.halfedge(a, b).ok_or(spine::Error::NotAnEdge { from: a, to: b, at: DVec3::NAN })
    };
    let moved = |curve: &BlendCurve| -> Result<BlendCurve, spine::Error> {
        let halfedges = curve.halfedges.iter().map(|&h| edge(mesh.tail(h), mesh.head(h))).collect::<Result<_, _>>()?;
        Ok(BlendCurve { halfedges, closed: curve.closed })
    };
    let curves = curves.iter().map(moved).collect::<Result<Vec<_>, _>>()?;
    let made = blend_level(&coarse, &curves, params, how, watch)?;
    let at = made.mesh.positions.first().copied().unwrap_or(DVec3::ZERO);
    let fine = hierarchy.restore(&made.mesh.positions).map_err(|_| Refusal::Meets { pairs: 0, at })?;
    let (origins, changed) = account(mesh, &fine);
    check_apart(&fine, &changed, watch)?;
    Ok(Blended {
        first_blend_face: FaceId::from(fine.faces.len()),
        mesh: fine,
        origins,
        levels: hierarchy.levels(),
        ..made
    })
}

/// Vertices that were moved are new; so are faces all of whose vertices were, and the others beside them are pieces.
fn account(mesh: &Connected<TriMesh>, fine: &TriMesh) -> (Origins, Vec<FaceId>) {
    let mut origins = Origins::identity(0, mesh.vertex_count(), mesh.face_count());
    let is_moved = |v: VertexId| fine.positions[v.index()] != mesh.mesh().positions[v.index()];
    for v in mesh.vertex_ids().filter(|&v| is_moved(v)) {
        origins.vertices[v] = VertexOrigin::New { stage: sew::STAGE };
    }
    let mut changed = vec![];
    for f in mesh.face_ids() {
        match mesh.corners(f).into_iter().filter(|&v| is_moved(v)).count() {
            0 => continue,
            3 => origins.faces[f] = FaceOrigin::New { stage: sew::STAGE },
            _ => origins.faces[f] = FaceOrigin::Piece { part: 0, face: f },
        }
        changed.push(f);
    }
    (origins, changed)
}
