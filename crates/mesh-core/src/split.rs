//! Copies of vertices where a mesh is not a 2-manifold, on request.

use crate::corner_table::{NONE, distinct, in_range};
use crate::edge_groups::{EdgeGroup, visit_edges};
use crate::ids::{FaceId, HalfedgeId, VertexId};
use crate::mesh::TriMesh;
use crate::origin::{FaceOrigin, Origins, VertexOrigin};
use crate::traits::Faces;
use crate::validate::validate;

/// Copies vertices until the mesh is an oriented 2-manifold: at vertices where separate parts touch, and along edges
/// whose faces disagree or are more than two.
///
/// Around an edge with several faces, those that bound one wedge of solid stay together, so that solids touching along
/// an edge come apart whole. Faces that name a missing vertex or one vertex twice are dropped, and so are repetitions of
/// a face in the same orientation. The first part at a vertex keeps its id; copies follow the old vertices.
/// O(n log n).
pub fn split(mesh: &TriMesh) -> (TriMesh, Origins) {
    let kept = kept_faces(mesh);
    let base = TriMesh { positions: mesh.positions.clone(), faces: kept.iter().map(|&f| mesh.corners(f)).collect() };
    let mut twins = wedge_twins(&base);
    let (out, sources) = loop {
        let (out, sources) = copy_fans(&base, &twins);
        let report = validate(&out);
        if report.is_manifold() {
            break (out, sources);
        }
        // Two fans may share an edge at both of its ends: let go of every face there. Each round frees some face, so
        // this ends.
        let mut bad = report.non_manifold_edges;
        bad.extend(report.misoriented_edges);
        bad.sort_unstable();
        for h in (0..twins.len() as u32).map(HalfedgeId) {
            let (a, b) = (out.tail(h), out.head(h));
            if bad.binary_search(&[a.min(b), a.max(b)]).is_ok() {
                for side in [h, h.next(), h.prev()] {
                    let t = std::mem::replace(&mut twins[side.index()], NONE);
                    if t != NONE {
                        twins[t as usize] = NONE;
                    }
                }
            }
        }
    };
    let vertices = sources.into_iter().map(|vertex| VertexOrigin::Input { part: 0, vertex }).collect::<Vec<_>>();
    let faces = kept.into_iter().map(|face| FaceOrigin::Input { part: 0, face }).collect::<Vec<_>>();
    (out, Origins { vertices: vertices.into(), faces: faces.into() })
}

/// The faces worth keeping, ascending.
fn kept_faces(mesh: &TriMesh) -> Vec<FaceId> {
    let cycle = |f: FaceId| {
        let mut c = mesh.corners(f);
        while c[0] != c[0].min(c[1]).min(c[2]) {
            c.rotate_left(1);
        }
        (c, f)
    };
    let usable = |&f: &FaceId| in_range(mesh, mesh.corners(f)) && distinct(mesh.corners(f));
    let mut cycles: Vec<_> = mesh.face_ids().filter(usable).map(cycle).collect();
    cycles.sort_unstable();
    cycles.dedup_by_key(|x| x.0);
    let mut kept: Vec<FaceId> = cycles.into_iter().map(|x| x.1).collect();
    kept.sort_unstable();
    kept
}

/// Pairs halfedges: the two of a plain edge, and around other edges those that bound one wedge of solid.
fn wedge_twins(mesh: &TriMesh) -> Vec<u32> {
    let pair = |pairs: &mut Vec<[HalfedgeId; 2]>, group: EdgeGroup<'_>| {
        let all: Vec<HalfedgeId> = (0..group.len()).map(|i| group.halfedge(i)).collect();
        if let [h, t] = all[..] {
            if mesh.tail(h) != mesh.tail(t) {
                pairs.push([h, t]);
            }
            return;
        }
        let [a, b] = group.ends.map(|v| mesh.positions[v.index()]);
        let axis = (b - a).normalize_or_zero();
        let across = axis.any_orthonormal_vector();
        let angle = |h: HalfedgeId| {
            let w = mesh.positions[mesh.tail(h.prev()).index()] - a;
            w.dot(axis.cross(across)).atan2(w.dot(across))
        };
        let mut around: Vec<(f64, HalfedgeId)> = all.into_iter().map(|h| (angle(h), h)).collect();
        around.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        for i in 0..around.len() {
            // Turning about the axis, solid begins behind a face that runs against it and ends at one that runs along.
            let (begin, end) = (around[i].1, around[(i + 1) % around.len()].1);
            if mesh.tail(begin) == group.ends[1] && mesh.tail(end) == group.ends[0] {
                pairs.push([begin, end]);
            }
        }
    };
    let mut twins = vec![NONE; 3 * mesh.faces.len()];
    for [h, t] in visit_edges(mesh, |_| true, pair).into_iter().flatten() {
        twins[h.index()] = t.0;
        twins[t.index()] = h.0;
    }
    twins
}

/// Gives every fan of paired corners a vertex of its own; also returns which vertex each one copies.
fn copy_fans(mesh: &TriMesh, twins: &[u32]) -> (TriMesh, Vec<VertexId>) {
    let mut out = mesh.clone();
    let mut sources: Vec<VertexId> = mesh.vertex_ids().collect();
    let mut taken = vec![false; mesh.positions.len()];
    let mut seen = vec![false; twins.len()];
    for first in (0..twins.len() as u32).map(HalfedgeId) {
        if seen[first.index()] {
            continue;
        }
        let old = mesh.tail(first);
        let mut new = old;
        if std::mem::replace(&mut taken[old.index()], true) {
            new = VertexId::from(sources.len());
            sources.push(old);
            out.positions.push(mesh.positions[old.index()]);
        }
        // Both ways around, since the fan may be open.
        for clockwise in [false, true] {
            let mut h = first;
            loop {
                seen[h.index()] = true;
                out.faces[h.face().index()][h.corner()] = new;
                let side = if clockwise { h } else { h.prev() };
                let t = twins[side.index()];
                if t == NONE {
                    break;
                }
                h = if clockwise { HalfedgeId(t).next() } else { HalfedgeId(t) };
                if h == first {
                    break;
                }
            }
        }
    }
    (out, sources)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Connected, components, shapes, volume};
    use glam::DVec3;
    use proptest::prelude::*;

    /// Vertices at equal places made one.
    fn welded(mesh: &TriMesh) -> TriMesh {
        let first = |v: VertexId| {
            let p = mesh.positions[v.index()];
            VertexId::from(mesh.positions.iter().position(|&q| q == p).unwrap())
        };
        TriMesh { positions: mesh.positions.clone(), faces: mesh.faces.iter().map(|c| c.map(first)).collect() }
    }

    fn moved(mesh: TriMesh, by: [f64; 3]) -> TriMesh {
        shapes::posed(mesh, glam::DQuat::IDENTITY, DVec3::from(by))
    }

    proptest! {
        /// Whatever goes in, an oriented 2-manifold of the same usable triangles comes out.
        #[test]
        fn any_soup_becomes_manifold(faces in prop::collection::vec(prop::array::uniform3(0u32..8), 0..24)) {
            let place = |i: u32| DVec3::new(f64::from(i % 3), f64::from(i * i % 5), f64::from(i * 5 % 7));
            let soup = TriMesh::from_arrays((0..7).map(place).collect(), faces);
            let (out, origins) = split(&soup);
            prop_assert!(Connected::new(&out).is_ok());
            let turns = |c: [VertexId; 3]| [c, [c[1], c[2], c[0]], [c[2], c[0], c[1]]];
            let repeats = |f: usize| soup.faces[..f].iter().any(|&c| turns(c).contains(&soup.faces[f]));
            let good: Vec<_> = (0..soup.faces.len())
                .filter(|&f| in_range(&soup, soup.faces[f]) && distinct(soup.faces[f]) && !repeats(f))
                .map(|f| &soup.faces[f])
                .collect();
            prop_assert_eq!(good.len(), out.faces.len());
            for (f, old) in good.into_iter().enumerate() {
                let source = out.faces[f].map(|v| match origins.vertices[v] {
                    VertexOrigin::Input { vertex, .. } => vertex,
                    _ => VertexId(99),
                });
                prop_assert_eq!(source, *old);
            }
            let (again, _) = crate::orient(&soup);
            prop_assert_eq!(again.faces.len(), soup.faces.len());
        }
    }

    /// Boxes that touch along an edge, and at a corner, come apart as whole boxes.
    #[test]
    fn touching_boxes_come_apart() {
        let cube = || shapes::cuboid(DVec3::ONE);
        for (by, copies) in [([1.0, 1.0, 0.0], 2), ([1.0, 1.0, 1.0], 1)] {
            let both = welded(&TriMesh::merged(&[cube(), moved(cube(), by)]));
            assert!(!validate(&both).is_manifold());
            let (out, origins) = split(&both);
            assert!(validate(&out).is_closed());
            assert_eq!((out.positions.len(), components(&out).face_counts), (16 + copies, vec![12, 12]));
            assert_eq!(origins.faces.len(), 24);
            assert!((volume(&out) - 2.0).abs() < 1e-14);
        }
        let ball = shapes::icosphere(1.0, 2);
        let mut doubled = ball.clone();
        doubled.faces.extend(ball.faces[30..90].iter().map(|&[a, b, c]| [b, c, a]));
        assert_eq!(split(&doubled).0, ball);
        let clean = shapes::torus(2.0, 0.5, 8, 6);
        assert_eq!(split(&clean).0, clean);
    }
}
