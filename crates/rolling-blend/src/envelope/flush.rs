//! Where the envelope ends at a face that goes on, as a fillet between two walls does at the end of these: the face is continued
//! in its plane up to the ball, as CAD kernels do, and no ball comes from beyond it. Facets of a curved face are continued
//! each in its own.

use super::centre::{Ground, Stop};
use super::fences::Row;
use super::mark;
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceMap, HalfedgeId, Positions, TriMesh, VertexId, VertexOrigin, dihedral_angle,
};
use tri_intersect::Embedded;

/// How far the boundary of the face may be moved, in radii.
const FARTHEST: f64 = 3.0;
/// A boundary that is moved by less, in radii, is on the ball already.
const MOVED: f64 = 1e-6;
/// An area, as a share of the radius squared, that is none.
const NO_AREA: f64 = 1e-9;

/// A stretch of the boundary of a smooth face, with the ball in its planes, and a stop for each of these.
pub(super) struct Flush {
    pub row: Row,
    pub stops: Vec<Stop>,
}

/// One edge of an outline that runs along a wall.
#[derive(Clone, Copy)]
struct OnWall {
    /// The face that goes on, and the one that is taken away.
    end: FaceId,
    under: FaceId,
}

/// The stretches of the outlines that run along edges of the other convexity, with one smooth face beyond. `chosen` are the
/// halfedges of the curves that are blended. Stretches that cannot be continued are left out.
pub(super) fn flush(
    ground: &Ground<'_>,
    r: f64,
    chosen: &[bool],
    cut: &Connected<&TriMesh>,
    removed: &FaceMap<bool>,
    embedded: &Embedded,
) -> Vec<Flush> {
    let mut found = vec![];
    for curve in &embedded.curves {
        let n = curve.len();
        let on_wall: Vec<Option<OnWall>> =
            (0..n).map(|k| on_wall(ground, chosen, cut, removed, embedded, [curve[k], curve[(k + 1) % n]])).collect();
        let patch = |k: usize| on_wall[k % n].map(|w| ground.patches.of(w.end));
        let Some(first) = (0..n).find(|&k| patch(k) != patch(k + n - 1)) else { continue };
        let mut k = first;
        while k < first + n {
            let length = (0..first + n - k).take_while(|i| patch(k + i) == patch(k)).count();
            if patch(k).is_some() && length > 1 {
                let chain: Vec<VertexId> = (k..=k + length).map(|i| curve[i % n]).collect();
                let sides: Vec<OnWall> = (k..k + length).filter_map(|i| on_wall[i % n]).collect();
                found.extend(continued(ground, r, cut, removed, &sides, chain));
            }
            k += length;
        }
    }
    found
}

/// What an edge of an outline runs along, if it is a wall of the other convexity with one side taken away.
fn on_wall(
    ground: &Ground<'_>,
    chosen: &[bool],
    cut: &Connected<&TriMesh>,
    removed: &FaceMap<bool>,
    embedded: &Embedded,
    ends: [VertexId; 2],
) -> Option<OnWall> {
    let edge = |v: VertexId| match embedded.origins.vertices[v] {
        VertexOrigin::Input { vertex, .. } => Some([vertex, vertex]),
        VertexOrigin::Edge { ends, .. } => Some(ends),
        _ => None,
    };
    let [first, second] = [edge(ends[0])?, edge(ends[1])?];
    let [a, b] = match [first, second] {
        [[a, c], [b, d]] if a == c && b == d => [a, b],
        [[a, c], other] if a == c => other,
        [other, _] => other,
    };
    let along = first.iter().chain(&second).all(|v| [a, b].contains(v));
    let wall = ground.mesh.halfedge(a, b).or_else(|| ground.mesh.halfedge(b, a)).filter(|_| along)?;
    let is_open = ground.patches.is_wall(wall) && !chosen[wall.index()] && !ground.fences[wall.index()];
    // Seen by the ball, a valley that is not blended ends nothing.
    let turns_away = dihedral_angle(ground.mesh, wall)? * ground.sign > 0.0;
    let faces = [cut.halfedge(ends[0], ends[1]), cut.halfedge(ends[1], ends[0])].map(|h| h.map(HalfedgeId::face));
    let [Some(f), Some(g)] = faces else { return None };
    let (end, under) = match (removed[f], removed[g]) {
        (true, false) => (g, f),
        (false, true) => (f, g),
        _ => return None,
    };
    let parent = |f| mark::parent(&embedded.origins, f);
    (is_open && turns_away).then(|| OnWall { end: parent(end), under: parent(under) })
}

/// The stretch on the ball in the planes of the face ahead.
fn continued(
    ground: &Ground<'_>,
    r: f64,
    cut: &Connected<&TriMesh>,
    removed: &FaceMap<bool>,
    sides: &[OnWall],
    chain: Vec<VertexId>,
) -> Option<Flush> {
    let facets: Vec<u32> = sides.iter().map(|s| ground.patches.facet(s.end)).collect();
    let normals: Vec<DVec3> = sides.iter().map(|s| ground.patches.face_normal(s.end)).collect();
    let onto = |k: usize| {
        let x = cut.position(chain[k]);
        // Where two facets meet, both are followed as far as that can be.
        let normal = if facets[k - 1] == facets[k] { normals[k] } else { (normals[k - 1] + normals[k]).normalize() };
        let centre = ground.centre_in_plane(x, r, sides[k].under, normal, &facets)?;
        let moved = centre + r * (x - centre).normalize_or_zero();
        (moved.distance(x) <= FARTHEST * r).then_some(moved)
    };
    let on_ball = (1..chain.len() - 1).map(onto).collect::<Option<Vec<DVec3>>>()?;
    let along: Vec<DVec3> = chain.iter().map(|&v| cut.position(v)).collect();
    // The face grows: what is added faces as it does.
    let place = |k: usize| if k == 0 || k + 1 == along.len() { along[k] } else { on_ball[k - 1] };
    let forwards = cut.halfedge(chain[0], chain[1]).is_some_and(|h| removed[h.face()]);
    let out = if forwards { 1.0 } else { -1.0 };
    let grows = (0..along.len() - 1).all(|k| {
        let (a, b, x, y) = (along[k], along[k + 1], place(k), place(k + 1));
        [(b - a).cross(y - a), (y - a).cross(x - a)].iter().all(|area| out * area.dot(normals[k]) > -NO_AREA * r * r)
    });
    let moves = on_ball.iter().zip(&along[1..]).any(|(p, q)| p.distance(*q) > MOVED * r);
    let mut stops = vec![];
    let mut k = 0;
    while k < facets.len() {
        let length = facets[k..].iter().take_while(|f| **f == facets[k]).count();
        stops.push(Stop { normal: ground.sign * normals[k], along: along[k..=k + length].to_vec() });
        k += length;
    }
    (grows && moves).then_some(Flush { row: Row { chain, on_ball }, stops })
}

#[cfg(test)]
mod tests {
    use crate::envelope::blend;
    use crate::features::{self, feature_curves};
    use crate::params::Params;
    use glam::{DQuat, DVec3};
    use mesh_core::{Connected, Positions, VertexOrigin, Watch, shapes};
    use spine::{BlendCurve, Convexity};
    use tri_intersect::{Operation, boolean};

    /// The valley of a bracket ends at both side faces: these grow in their planes up to the cylinder, and the fillet lies on
    /// it as far as there.
    #[test]
    fn a_valley_ends_flush_with_the_faces_at_its_ends() {
        let slab = |size: [f64; 3], at: [f64; 3]| {
            Connected::new(shapes::posed(shapes::cuboid(size.into()), DQuat::IDENTITY, at.into())).unwrap()
        };
        let parts = [slab([10.0, 4.0, 2.0], [5.0, 2.0, 1.0]), slab([2.0, 4.0, 8.0], [1.0, 2.0, 4.0])];
        let params = tri_intersect::Params::default();
        let made = boolean(&parts[0], &parts[1], Operation::Union, &params, &Watch::default()).unwrap();
        let mesh = Connected::new(made.mesh).unwrap();
        let valley = feature_curves(&mesh, &features::Params::default());
        let valley =
            valley.into_iter().find(|c| c.convexity == features::Convexity::Concave).map(BlendCurve::from).unwrap();
        let (r, axis) = (1.0, DVec3::new(3.0, 0.0, 3.0));
        let made = blend(&mesh, &[valley], Convexity::Concave, &[], &Params::new(r), &Watch::default()).unwrap();
        assert_eq!(made.continued.len(), 2);
        let (mut on_ball, result) = (0, &made.blended.mesh);
        for (v, origin) in (0u32..).map(mesh_core::VertexId).zip(made.blended.origins.vertices.as_slice()) {
            if matches!(origin, VertexOrigin::New { .. }) {
                let p = result.position(v);
                assert!((0.0..=4.0).contains(&p.y), "{p}");
                assert!(((p - axis).reject_from(DVec3::Y).length() - r).abs() < 1e-6, "{p}");
                on_ball += 1;
            }
        }
        assert!(on_ball > 20, "{on_ball}");
        let arc = &made.continued[0].now;
        assert!(arc.iter().all(|&v| [0.0, 4.0].contains(&result.position(v).y)));
    }
}
