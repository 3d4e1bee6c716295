//! Planar faces around the blends, by constrained Delaunay triangulation.

use crate::plane::Plane;
use glam::DVec3;
use mesh_core::VertexId;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};

/// A vertex of the mesh in the plane.
#[derive(Clone, Copy)]
struct Spot {
    at: Point2<f64>,
    id: VertexId,
}

impl HasPosition for Spot {
    type Scalar = f64;
    fn position(&self) -> Point2<f64> {
        self.at
    }
}

/// Triangles over the region that `loops` bound, counter-clockwise around the plane's normal. No vertex is added.
///
/// # Errors
/// The place where two loops cross or touch.
pub fn triangulate(plane: Plane, loops: &[Vec<VertexId>], positions: &[DVec3]) -> Result<Vec<[VertexId; 3]>, DVec3> {
    let [u, v] = plane.axes();
    let all: Vec<VertexId> = loops.concat();
    let Some(&start) = all.first() else { return Ok(vec![]) };
    let origin = positions[start.index()];
    let size = all.iter().map(|v| positions[v.index()].distance(origin)).fold(0.0, f64::max);
    let flat = |id: VertexId| {
        let d = (positions[id.index()] - origin) / size;
        // The triangulation takes no coordinate next to zero but zero itself.
        let clean = |x: f64| if x.abs() < 1e-30 { 0.0 } else { x };
        Spot { at: Point2::new(clean(d.dot(u)), clean(d.dot(v))), id }
    };
    let (mut sides, mut from) = (Vec::with_capacity(all.len()), 0);
    for border in loops {
        let n = border.len();
        sides.extend((0..n).map(|i| [from + i, from + (i + 1) % n]));
        from += n;
    }
    let mut crossed = None;
    let spots: Vec<Spot> = all.iter().map(|&id| flat(id)).collect();
    let mesh =
        ConstrainedDelaunayTriangulation::<Spot>::try_bulk_load_cdt(spots, sides.clone(), |[i, _]| crossed = Some(i))
            .map_err(|_| positions[start.index()])?;
    if let Some(at) = crossed {
        let at = mesh.vertices().nth(at).map_or(start, |v| v.data().id);
        return Err(positions[at.index()]);
    }
    if mesh.num_vertices() != all.len() {
        let twice = mesh.vertices().zip(&all).find(|(v, id)| v.data().id != **id).map_or(start, |(_, id)| *id);
        return Err(positions[twice.index()]);
    }
    // A vertex in the middle of a side would leave a gap to the neighbour.
    let handle = FixedVertexHandle::from_index;
    if let Some(&[a, _]) = sides.iter().find(|[a, b]| !mesh.exists_constraint(handle(*a), handle(*b))) {
        return Err(positions[all[a].index()]);
    }
    let triangles = inside(&mesh);
    // Blends that have passed each other leave a loop that runs backwards, and no crossing.
    let area = |i: VertexId, j: VertexId| {
        let [a, b] = [i, j].map(|v| positions[v.index()] - origin);
        a.cross(b).dot(plane.normal)
    };
    let wanted: f64 = sides.iter().map(|&[a, b]| area(all[a], all[b])).sum();
    let covered: f64 = triangles.iter().map(|&[a, b, c]| area(a, b) + area(b, c) + area(c, a)).sum();
    // Slivers lose what rounding does, relative to the face's extent.
    if (wanted - covered).abs() <= 1e-9 * size * size { Ok(triangles) } else { Err(origin) }
}

/// The triangles an odd number of constraints away from infinity.
fn inside(mesh: &ConstrainedDelaunayTriangulation<Spot>) -> Vec<[VertexId; 3]> {
    let mut depth = vec![u32::MAX; mesh.num_all_faces()];
    let outer = mesh.outer_face().fix().index();
    depth[outer] = 0;
    let mut open: Vec<usize> = vec![];
    let mut later: Vec<usize> = vec![outer];
    let mut level = 0;
    // Border by border: all that can be reached without crossing another constraint, then across the next.
    let mut neighbours: Vec<Vec<(usize, bool)>> = vec![vec![]; mesh.num_all_faces()];
    for edge in mesh.undirected_edges() {
        let [a, b] = [edge.as_directed().face().fix().index(), edge.as_directed().rev().face().fix().index()];
        neighbours[a].push((b, edge.is_constraint_edge()));
        neighbours[b].push((a, edge.is_constraint_edge()));
    }
    while !later.is_empty() {
        open.append(&mut later);
        while let Some(f) = open.pop() {
            if depth[f] != level {
                continue;
            }
            for &(g, wall) in &neighbours[f] {
                if depth[g] == u32::MAX {
                    depth[g] = level + u32::from(wall);
                    if wall { later.push(g) } else { open.push(g) }
                } else if depth[g] > level && !wall {
                    depth[g] = level;
                    open.push(g);
                }
            }
        }
        level += 1;
    }
    let faces = mesh.inner_faces().filter(|f| depth[f.fix().index()] % 2 == 1);
    faces.map(|f| f.vertices().map(|v| v.data().id)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: f64, high: f64) -> Vec<DVec3> {
        [[low, low], [high, low], [high, high], [low, high]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec()
    }

    #[test]
    fn a_face_with_a_hole_keeps_its_area() {
        let positions = [square(0.0, 4.0), square(1.0, 3.0), square(1.5, 2.5)].concat();
        let plane = Plane { normal: DVec3::Z, offset: 0.0 };
        let ids = |range: std::ops::Range<u32>| range.map(VertexId).collect::<Vec<_>>();
        let hole = ids(4..8).into_iter().rev().collect();
        let triangles = triangulate(plane, &[ids(0..4), hole, ids(8..12)], &positions).unwrap();
        let area: f64 = triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| positions[v.index()]);
                0.5 * (b - a).cross(c - a).z
            })
            .sum();
        assert!((area - (16.0 - 4.0 + 1.0)).abs() < 1e-12);
    }

    #[test]
    fn crossing_and_touching_loops_are_refused() {
        let plane = Plane { normal: DVec3::Z, offset: 0.0 };
        let backwards: Vec<_> = (0..4).rev().map(VertexId).collect();
        assert!(triangulate(plane, &[backwards], &square(0.0, 1.0)).is_err());
        let positions = [square(0.0, 2.0), square(1.0, 3.0)].concat();
        let loops = [(0..4).map(VertexId).collect(), (4..8).map(VertexId).collect()];
        assert!(triangulate(plane, &loops, &positions).is_err());
        let positions = [square(0.0, 2.0), square(2.0, 3.0)].concat();
        assert!(triangulate(plane, &loops, &positions).is_err());
    }
}
