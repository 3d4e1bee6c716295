//! Parts and surface as one mesh, and whether it is what was wanted.

use super::Error;
use super::openings::Opening;
use crate::Report;
use crate::attributes::TRANSITION;
use lmc_tessellate::Transition;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceOrigin, Faces, Origins, TriMesh, VertexId, VertexOrigin, Watch, components,
};
use std::collections::BTreeSet;
use tri_intersect::self_intersections_among;

/// The composed mesh.
pub(super) struct Welded {
    pub mesh: TriMesh,
    pub origins: Origins,
}

/// All parts in order, then the surface, sharing the openings' vertices. `own` are the parts' origins, if they are not the inputs themselves.
pub(super) fn weld(
    parts: &[Connected<TriMesh>],
    own: Option<&[Origins]>,
    openings: &[Opening],
    surface: &Transition,
) -> Welded {
    let mut mesh = TriMesh::default();
    let mut origins = Origins::default();
    let mut firsts = vec![];
    for (part, one) in (0..).zip(parts.iter().map(Connected::mesh)) {
        firsts.push(mesh.positions.len() as u32);
        mesh.append(one);
        let own = own.map_or_else(
            || Origins::identity(part, one.positions.len(), one.faces.len()),
            |own| own[part as usize].clone(),
        );
        for &v in own.vertices.as_slice() {
            origins.vertices.push(v);
        }
        for &f in own.faces.as_slice() {
            origins.faces.push(f);
        }
    }
    let mut ids: Vec<VertexId> =
        openings.iter().flat_map(|o| o.vertices.iter().map(|v| VertexId(v.0 + firsts[o.part]))).collect();
    for &p in &surface.mesh.positions[ids.len()..] {
        ids.push(VertexId::from(mesh.positions.len()));
        mesh.positions.push(p);
        origins.vertices.push(VertexOrigin::New { stage: TRANSITION });
    }
    for face in &surface.mesh.faces {
        mesh.faces.push(face.map(|v| ids[v.index()]));
        origins.faces.push(FaceOrigin::New { stage: TRANSITION });
    }
    Welded { mesh, origins }
}

/// Edges of the parts between two vertices of an opening, in the surface's numbers, low first.
pub(super) fn part_edges(parts: &[Connected<TriMesh>], openings: &[Opening], starts: &[u32]) -> BTreeSet<[u32; 2]> {
    let mut edges = BTreeSet::new();
    for (part, mesh) in parts.iter().enumerate() {
        let mut ids: Vec<(VertexId, u32)> = vec![];
        for (o, &start) in openings.iter().zip(starts).filter(|(o, _)| o.part == part) {
            ids.extend(o.vertices.iter().copied().zip(start..));
        }
        ids.sort_unstable();
        let id = |v: VertexId| ids.binary_search_by_key(&v, |e| e.0).ok().map(|k| ids[k].1);
        for &(v, a) in &ids {
            for h in mesh.ring(v).filter(|&h| mesh.twin(h).is_some()) {
                if let Some(b) = id(mesh.head(h)) {
                    edges.insert([a.min(b), a.max(b)]);
                }
            }
        }
    }
    edges
}

/// All parts must hang together through the surface. Openings of one part that are closed alone are only noted.
pub(super) fn check_pieces(
    parts: &[Connected<TriMesh>],
    openings: &[Opening],
    surface: &Transition,
    report: &mut Report,
) -> Result<(), Error> {
    let pieces = components(&surface.mesh);
    let mut label_of_vertex = vec![u32::MAX; surface.mesh.vertex_count()];
    for (f, &label) in surface.mesh.faces.iter().zip(pieces.labels.as_slice()) {
        for v in f {
            label_of_vertex[v.index()] = label;
        }
    }
    let labels: Vec<u32> = surface.starts[..openings.len()].iter().map(|&s| label_of_vertex[s as usize]).collect();
    let alone = |i: usize| labels.iter().filter(|l| **l == labels[i]).count() == 1;
    // Components of the parts, joined by pieces of the surface.
    let own: Vec<_> = parts.iter().map(components).collect();
    let node = |o: &Opening| (o.part, own[o.part].labels[o.walk[0].face()]);
    let mut reached = vec![false; openings.len()];
    let mut stack = vec![0];
    while let Some(i) = stack.pop() {
        if std::mem::replace(&mut reached[i], true) {
            continue;
        }
        let near = |j: &usize| !reached[*j] && (labels[*j] == labels[i] || node(&openings[*j]) == node(&openings[i]));
        stack.extend((0..openings.len()).filter(near));
    }
    if let Some(o) = (0..openings.len()).find(|&i| !reached[i]).map(|i| &openings[i]) {
        let at = o.rim.points.iter().sum::<glam::DVec3>() / o.rim.points.len() as f64;
        let joined = openings.iter().zip(&reached).filter(|o| *o.1).map(|(o, _)| (o.part, o.index)).collect();
        return Err(Error::Apart { pieces: pieces.len(), part: o.part, index: o.index, at, joined });
    }
    for i in (0..openings.len()).filter(|&i| openings.len() > 1 && alone(i)) {
        let (part, index) = (openings[i].part, openings[i].index);
        report.warnings.push(format!("loop {index} of part {part} is closed by itself, not joined to another"));
    }
    Ok(())
}

/// What the surface crosses, if it does.
pub(super) fn name_crossing(mesh: &TriMesh, origins: &Origins, watch: &Watch) -> Option<Error> {
    let new = |f: FaceId| matches!(origins.faces[f], FaceOrigin::New { .. });
    let faces: Vec<FaceId> = mesh.face_ids().filter(|&f| new(f)).collect();
    let pairs = self_intersections_among(mesh, &faces, watch).ok()?;
    let [f, g] = *pairs.first()?;
    let what = match (origins.faces[f], origins.faces[g]) {
        (FaceOrigin::Input { part, .. }, _) | (_, FaceOrigin::Input { part, .. }) => format!("part {part}"),
        _ => "itself".into(),
    };
    Some(Error::Crossing { what, pairs: pairs.len(), at: mesh.triangle(f)[0] })
}
