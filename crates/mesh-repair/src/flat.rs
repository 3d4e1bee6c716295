//! Faces without area.

use crate::mended::Mended;
use crate::sides::{around, edge, sides};
use mesh_core::{FaceId, FaceOrigin, Faces, HalfedgeId, Origins, TriMesh, VertexId, collinear};

/// Sweeps over all faces. A chain of k points on one line needs about log k.
const SWEEPS: usize = 64;

/// Takes out faces without area, and leaves no gap: the face on the far side of a flat face's longest edge is split at the flat
/// face's third corner. Counts the faces taken out. Corners must be in range and distinct. O(n log n) for each of a few sweeps.
///
/// ```
/// use glam::DVec3;
/// use mesh_core::{TriMesh, validate};
/// // A tetrahedron, one of whose edges has a point in the middle that only one of its two faces knows.
/// let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.5, 0.0, 0.0)];
/// let faces = [[0, 2, 4], [4, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2], [0, 4, 1]];
/// let mended = mesh_repair::drop_flat(&TriMesh::from_arrays(points, faces));
/// assert_eq!(mended.count, 1);
/// assert!(validate(&mended.mesh).is_closed() && validate(&mended.mesh).zero_area.is_empty());
/// ```
pub fn drop_flat(mesh: &TriMesh) -> Mended {
    let mut out = Mended::unchanged(mesh);
    for _ in 0..SWEEPS {
        let flat: Vec<FaceId> = out.mesh.face_ids().filter(|&f| collinear(out.mesh.triangle(f))).collect();
        if flat.is_empty() {
            break;
        }
        out.count += sweep(&mut out.mesh, &mut out.origins, &flat);
    }
    // What goes on splitting is dropped as it is.
    let rest = Mended::kept(&out.mesh, |f| !collinear(out.mesh.triangle(f)));
    if rest.count > 0 {
        let faces = rest.origins.faces.as_slice().iter().filter_map(|o| match o {
            FaceOrigin::Input { face, .. } => Some(out.origins.faces[*face]),
            _ => None,
        });
        out.origins = Origins { faces: faces.collect::<Vec<_>>().into(), ..out.origins };
        out.count += rest.count;
        out.mesh = rest.mesh;
    }
    out
}

/// Takes out those flat faces that no other one is in the way of.
fn sweep(mesh: &mut TriMesh, origins: &mut Origins, flat: &[FaceId]) -> usize {
    let sides = sides(mesh);
    let mut touched = vec![false; mesh.face_count()];
    let mut gone = vec![false; mesh.face_count()];
    let mut added: Vec<([VertexId; 3], FaceOrigin)> = vec![];
    for &f in flat {
        let Some((along, apex)) = longest(mesh, f) else {
            // Two corners at one place: there is nothing between the neighbours.
            gone[f.index()] = !touched[f.index()];
            continue;
        };
        let others: Vec<HalfedgeId> = around(&sides, edge(mesh.tail(along), mesh.head(along)))
            .iter()
            .map(|s| s.1)
            .filter(|h| h.face() != f)
            .collect();
        if touched[f.index()] || others.iter().any(|h| touched[h.face().index()] || gone[h.face().index()]) {
            continue;
        }
        (touched[f.index()], gone[f.index()]) = (true, true);
        for h in others {
            let g = h.face();
            touched[g.index()] = true;
            let [x, y, d] = [mesh.tail(h), mesh.head(h), mesh.tail(h.prev())];
            if d == apex {
                // Back to back: together they are nothing.
                gone[g.index()] = true;
                continue;
            }
            let piece = match origins.faces[g] {
                FaceOrigin::Input { part, face } => FaceOrigin::Piece { part, face },
                other => other,
            };
            mesh.faces[g.index()] = [x, apex, d];
            origins.faces[g] = piece;
            added.push(([apex, y, d], piece));
        }
    }
    let count = gone.iter().filter(|&&g| g).count();
    let keep = |i: &usize| !gone[*i];
    let (faces, of): (Vec<_>, Vec<_>) = (0..mesh.face_count())
        .filter(keep)
        .map(|i| (mesh.faces[i], origins.faces[FaceId::from(i)]))
        .chain(added)
        .unzip();
    mesh.faces = faces;
    origins.faces = of.into();
    count
}

/// The longest edge of a face and the corner across; `None` if two corners are at one place.
fn longest(mesh: &TriMesh, f: FaceId) -> Option<(HalfedgeId, VertexId)> {
    let points = mesh.triangle(f);
    if (0..3).any(|k| points[k] == points[(k + 1) % 3]) {
        return None;
    }
    let length = |h: &HalfedgeId| points[h.corner()].distance(points[(h.corner() + 1) % 3]);
    let along = f.halfedges().into_iter().max_by(|a, b| length(a).total_cmp(&length(b)))?;
    Some((along, mesh.tail(along.prev())))
}
