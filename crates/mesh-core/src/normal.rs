//! Normals of faces, vertices, one side of a vertex, and corners split at creases.

use crate::ids::{FaceId, HalfedgeId, VertexId};
use crate::map::{CornerMap, FaceMap, VertexMap};
use crate::traits::{Adjacency, Faces, Positions};
use glam::DVec3;
use rayon::prelude::*;

/// Half the cross product of two sides: along the normal, as long as the area.
#[inline]
pub fn area_vector([a, b, c]: [DVec3; 3]) -> DVec3 {
    0.5 * (b - a).cross(c - a)
}

/// The unit normal of a triangle by the right-hand rule; zero when it has none (collinear, NaN or infinite corners).
///
/// Sides are scaled to one before they are multiplied, so that neither 1e-200 nor 1e300 loses the direction, and the
/// two shorter sides are used, which keeps needles accurate.
#[inline]
pub fn triangle_normal(corners: [DVec3; 3]) -> DVec3 {
    let [a, b, c] = unit_sized(corners);
    let (ab, bc, ca) = (b - a, c - b, a - c);
    let (l, m, n) = (ab.length_squared(), bc.length_squared(), ca.length_squared());
    let cross = if l >= m && l >= n {
        bc.cross(ca)
    } else if m >= n {
        ca.cross(ab)
    } else {
        ab.cross(bc)
    };
    cross.try_normalize().or_else(|| (1e150 * cross).try_normalize()).unwrap_or(DVec3::ZERO)
}

/// The triangle moved to the origin and scaled to sides near one; zeros when that is impossible.
#[inline]
fn unit_sized([a, b, c]: [DVec3; 3]) -> [DVec3; 3] {
    let (u, v) = (b - a, c - a);
    let size = u.abs().max(v.abs()).max_element();
    // The common case needs no scaling: even a needle's squared area stays well inside f64's range.
    if (1e-30..1e30).contains(&size) {
        return [DVec3::ZERO, u, v];
    }
    let (u, v) = (0.5 * b - 0.5 * a, 0.5 * c - 0.5 * a);
    let size = u.abs().max(v.abs()).max_element();
    if size > 0.0 && size < f64::INFINITY { [DVec3::ZERO, u / size, v / size] } else { [DVec3::ZERO; 3] }
}

/// The angle of a triangle at its corner `k`, in radians in [0, π]; 0 where a side has no length.
#[inline]
pub fn corner_angle(corners: [DVec3; 3], k: usize) -> f64 {
    let p = unit_sized(corners);
    let (u, v) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
    let angle = u.cross(v).length().atan2(u.dot(v));
    if angle.is_finite() && u != DVec3::ZERO && v != DVec3::ZERO { angle } else { 0.0 }
}

/// The unit normal of a face; zero when it has none. See [`triangle_normal`].
#[inline]
pub fn face_normal<M: Faces + Positions>(mesh: &M, f: FaceId) -> DVec3 {
    triangle_normal(mesh.triangle(f))
}

/// The unit normals of all faces; zero for faces that have none. O(n), parallel.
pub fn face_normals<M: Faces + Positions + Sync>(mesh: &M) -> FaceMap<DVec3> {
    (0..mesh.face_count() as u32).into_par_iter().map(|f| face_normal(mesh, FaceId(f))).collect::<Vec<_>>().into()
}

/// The unit normals of all vertices, face normals weighted by the angle they hold there (\[Baerentzen2005\]), which is
/// independent of how flat neighbourhoods are triangulated. Zero for vertices without a face. O(n), parallel.
pub fn vertex_normals<M: Adjacency + Positions + Sync>(mesh: &M) -> VertexMap<DVec3> {
    let normal = |v| one_sided_normal(mesh, VertexId(v), mesh.ring(VertexId(v)).map(HalfedgeId::face));
    (0..mesh.vertex_count() as u32).into_par_iter().map(normal).collect::<Vec<_>>().into()
}

/// The unit normal at `v` from some of its faces only, angle-weighted: the normal on one side of a crease.
///
/// Faces without a corner at `v` are passed over; zero when nothing is left. O(faces).
pub fn one_sided_normal<M: Faces + Positions>(mesh: &M, v: VertexId, faces: impl IntoIterator<Item = FaceId>) -> DVec3 {
    let weighted = |f: FaceId| {
        let corner = mesh.corners(f).iter().position(|&c| c == v)?;
        let p = mesh.triangle(f);
        Some(corner_angle(p, corner) * triangle_normal(p))
    };
    faces.into_iter().filter_map(weighted).sum::<DVec3>().normalize_or_zero()
}

/// One unit normal per corner: the angle-weighted mean over the faces reached around the vertex without crossing an
/// edge bent by more than `crease_angle` (radians, 0 flat to π folded back).
///
/// Corners of one smooth group carry the same bits. A face without a normal adds nothing and is never a crease; its
/// corners take the normal of a neighbouring group. O(n · valence), parallel.
pub fn corner_normals<M: Adjacency + Positions + Sync>(mesh: &M, crease_angle: f64) -> CornerMap<DVec3> {
    let normals = face_normals(mesh);
    let angles: Vec<[f64; 3]> = (0..mesh.face_count() as u32)
        .into_par_iter()
        .map(|f| mesh.triangle(FaceId(f)))
        .map(|p| [0, 1, 2].map(|k| corner_angle(p, k)))
        .collect();
    let flattest = crease_angle.cos();
    let smooth = |a: DVec3, b: DVec3| a == DVec3::ZERO || b == DVec3::ZERO || a.dot(b) >= flattest;
    let last_normal = |kept: DVec3, h: HalfedgeId| {
        let n = normals[h.face()];
        if n == DVec3::ZERO { kept } else { n }
    };
    let group_normal = |h: HalfedgeId| {
        let (mut start, mut normal) = (h, normals[h.face()]);
        while let Some(before) = mesh.twin(start).map(HalfedgeId::next) {
            if before == h {
                // No crease met: every corner must start its sum at the same place.
                start = mesh.outgoing(mesh.tail(h)).unwrap_or(h);
                break;
            }
            if !smooth(normal, normals[before.face()]) {
                break;
            }
            (start, normal) = (before, last_normal(normal, before));
        }
        let (mut here, mut normal, mut sum) = (start, normals[start.face()], DVec3::ZERO);
        loop {
            sum += angles[here.face().index()][here.corner()] * normals[here.face()];
            match mesh.twin(here.prev()) {
                Some(after) if after != start && smooth(normal, normals[after.face()]) => {
                    (here, normal) = (after, last_normal(normal, after));
                }
                _ => return sum.normalize_or_zero(),
            }
        }
    };
    (0..3 * mesh.face_count() as u32).into_par_iter().map(|h| group_normal(HalfedgeId(h))).collect::<Vec<_>>().into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Connected, shapes};
    use proptest::prelude::*;

    #[test]
    fn direction_survives_any_size() {
        let shape = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(2.0, 2.5, 3.0), DVec3::new(1.0, 3.0, 4.0)];
        let expected = (shape[1] - shape[0]).cross(shape[2] - shape[0]).normalize();
        for size in [1e-300, 1e-200, 1e-30, 1.0, 1e30, 1e200, 5e307] {
            let n = triangle_normal(shape.map(|p| 0.25 * size * p));
            assert!((n - expected).length() < 1e-14, "{size:e}: {n}");
            assert!((corner_angle(shape.map(|p| 0.25 * size * p), 0) - corner_angle(shape, 0)).abs() < 1e-14);
        }
        assert_eq!(triangle_normal([DVec3::ZERO, DVec3::X, 3.0 * DVec3::X]), DVec3::ZERO);
        assert_eq!(triangle_normal([DVec3::ZERO, DVec3::X, DVec3::NAN]), DVec3::ZERO);
        assert_eq!(triangle_normal([DVec3::ZERO, DVec3::X, DVec3::INFINITY]), DVec3::ZERO);
        assert_eq!(corner_angle([DVec3::NAN; 3], 0), 0.0);
    }

    /// A corner of a cube is symmetric however its faces are split into triangles.
    #[test]
    fn cube_corners_point_along_the_diagonal() {
        let cube = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
        let normals = vertex_normals(&cube);
        for v in cube.vertex_ids() {
            assert!((normals[v] - cube.position(v).normalize()).length() < 1e-14);
        }
    }

    #[test]
    fn creases_split_a_cube_and_not_a_ball() {
        let cube = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
        let (split, whole) = (corner_normals(&cube, 1.0), corner_normals(&cube, 2.0));
        for h in (0..36).map(HalfedgeId) {
            assert!((split[h] - face_normal(&cube, h.face())).length() < 1e-15);
            assert!((whole[h] - cube.position(cube.tail(h)).normalize()).length() < 1e-14);
        }
        let ball = Connected::new(shapes::icosphere(1.0, 3)).unwrap();
        let (corners, vertices) = (corner_normals(&ball, 0.7), vertex_normals(&ball));
        for h in ball.halfedge_ids() {
            assert_eq!(corners[h], corners[ball.outgoing(ball.tail(h)).unwrap()]);
            assert!((corners[h] - vertices[ball.tail(h)]).length() < 1e-15);
        }
    }

    #[test]
    fn one_side_of_a_cube_edge_is_flat() {
        let cube = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
        let top = |f: &FaceId| face_normal(&cube, *f).z > 0.5;
        let v = cube.vertex_ids().find(|&v| cube.position(v).z > 0.0).unwrap();
        assert_eq!(one_sided_normal(&cube, v, cube.face_ids().filter(top)), DVec3::Z);
        assert_eq!(one_sided_normal(&cube, v, []), DVec3::ZERO);
    }

    /// The error of angle-weighted normals on a sphere falls with the edge length, even on an irregular one.
    #[test]
    fn ball_normals_converge() {
        let worst = |levels| {
            let ball = Connected::new(shapes::icosphere(2.0, levels)).unwrap();
            let normals = vertex_normals(&ball);
            ball.vertex_ids().map(|v| normals[v].angle_between(ball.position(v))).fold(0.0, f64::max)
        };
        let errors = [3, 4, 5].map(worst);
        assert!(errors[0] / errors[1] > 1.9 && errors[1] / errors[2] > 1.9, "{errors:?}");
    }

    proptest! {
        #[test]
        fn normals_turn_with_the_triangle(p in prop::array::uniform9(-1.0f64..1.0), angle in 0.0f64..6.0) {
            let corners = [0, 3, 6].map(|i| DVec3::new(p[i], p[i + 1], p[i + 2]));
            prop_assume!(area_vector(corners).length() > 1e-3);
            let turn = glam::DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), angle);
            let turned = triangle_normal(corners.map(|q| turn * q));
            prop_assert!((turned - turn * triangle_normal(corners)).length() < 1e-10);
            let angles: f64 = (0..3).map(|k| corner_angle(corners, k)).sum();
            prop_assert!((angles - std::f64::consts::PI).abs() < 1e-12);
        }
    }
}
