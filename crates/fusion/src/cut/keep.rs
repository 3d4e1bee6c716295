//! The side of the contours that stays.

use super::section::Section;
use super::{Error, Keep};
use mesh_core::{
    Connected, FaceId, FaceMap, FaceOrigin, Faces, Origins, Positions, TriMesh, VertexId, VertexOrigin, area_vector,
    components,
};
use mesh_query::TriBvh;
use tri_intersect::embed::{curve_edges, faces_left_of, flood};

/// Which faces stay: all but those reached from the right of the contours and, unless only a seed's contour was cut, components that lie
/// wholly beyond the plane.
pub(super) fn kept_faces(
    mesh: &Connected<TriMesh>,
    chains: &[Vec<VertexId>],
    closed: &[bool],
    section: &Section<'_>,
    seeded: bool,
) -> Result<FaceMap<bool>, Error> {
    let curves = || chains.iter().zip(closed);
    let walls: Vec<[VertexId; 2]> = curves().flat_map(|(chain, &closed)| curve_edges(chain, closed)).collect();
    let left: Vec<FaceId> = curves().flat_map(|(chain, &closed)| faces_left_of(mesh, chain, closed)).collect();
    let right: Vec<FaceId> = curves()
        .flat_map(|(chain, &closed)| {
            let back: Vec<VertexId> = chain.iter().rev().copied().collect();
            faces_left_of(mesh, &back, closed)
        })
        .collect();
    let mut gone = flood(mesh, walls.iter().copied(), &right);
    if let Some(&leak) = left.iter().find(|&&f| gone[f]) {
        return Err(Error::DoesNotSeparate { at: mesh.position(mesh.corners(leak)[0]) });
    }
    if !seeded {
        let stays = flood(mesh, walls, &left);
        for component in components(mesh).faces() {
            let untouched = component.iter().all(|&f| !stays[f] && !gone[f]);
            if untouched && component.iter().any(|&f| section.is_beyond(mesh, f)) {
                for &f in &component {
                    gone[f] = true;
                }
            }
        }
    }
    Ok(gone.as_slice().iter().map(|g| !g).collect::<Vec<_>>().into())
}

/// Which faces stay beside a closed path: all but those of the other side.
pub(super) fn kept_side(mesh: &Connected<TriMesh>, chain: &[VertexId], keep: Keep) -> Result<FaceMap<bool>, Error> {
    let back: Vec<VertexId> = chain.iter().rev().copied().collect();
    let sides = [chain, &back].map(|chain| flood(mesh, curve_edges(chain, true), &faces_left_of(mesh, chain, true)));
    if let Some(leak) = mesh.face_ids().find(|&f| sides[0][f] && sides[1][f]) {
        return Err(Error::DoesNotSeparate { at: mesh.position(mesh.corners(leak)[0]) });
    }
    let area = |side: &FaceMap<bool>| -> f64 {
        let faces = mesh.face_ids().filter(|&f| side[f]);
        faces.map(|f| area_vector(mesh.triangle(f)).length()).sum()
    };
    let left = match keep {
        Keep::Larger => area(&sides[0]) >= area(&sides[1]),
        Keep::Smaller => area(&sides[0]) < area(&sides[1]),
        Keep::Near(at) => {
            let faces: Vec<FaceId> = mesh.face_ids().filter(|&f| sides[0][f] || sides[1][f]).collect();
            let tree = TriBvh::build_subset(mesh.mesh(), &faces).ok();
            let hit = tree.and_then(|t| t.closest_point(mesh.mesh(), at));
            hit.is_some_and(|h| sides[0][h.face])
        }
    };
    let gone = &sides[usize::from(left)];
    Ok(gone.as_slice().iter().map(|g| !g).collect::<Vec<_>>().into())
}

/// The chosen faces and the vertices they use, all in their old order.
pub(super) fn submesh(mesh: &Connected<TriMesh>, origins: &Origins, kept: &FaceMap<bool>) -> (TriMesh, Origins) {
    const GONE: VertexId = VertexId(u32::MAX);
    let faces = || mesh.face_ids().filter(|&f| kept[f]);
    let mut new_id = vec![GONE; mesh.vertex_count()];
    for v in faces().flat_map(|f| mesh.corners(f)) {
        new_id[v.index()] = v;
    }
    // Points that no face of the input used are not the cut's to drop.
    for v in mesh.vertex_ids().filter(|&v| matches!(origins.vertices[v], VertexOrigin::Input { .. })) {
        if mesh_core::Adjacency::outgoing(mesh, v).is_none() {
            new_id[v.index()] = v;
        }
    }
    let (mut positions, mut vertex_origins) = (vec![], vec![]);
    for v in mesh.vertex_ids() {
        if new_id[v.index()] == GONE {
            continue;
        }
        new_id[v.index()] = VertexId::from(positions.len());
        positions.push(mesh.position(v));
        vertex_origins.push(origins.vertices[v]);
    }
    let corners = faces().map(|f| mesh.corners(f).map(|v| new_id[v.index()])).collect();
    let face_origins: Vec<FaceOrigin> = faces().map(|f| origins.faces[f]).collect();
    (TriMesh { positions, faces: corners }, Origins { vertices: vertex_origins.into(), faces: face_origins.into() })
}

#[cfg(test)]
mod tests {
    use super::super::{Params, PlaneCut, cut};
    use crate::Error as Failed;
    use crate::cut::Error;
    use glam::{DQuat, DVec3};
    use mesh_core::{Connected, FaceOrigin, TriMesh, VertexOrigin, Watch, area, boundary_loops, shapes};
    use mesh_io::{Format, Model};
    use proptest::prelude::*;

    fn run(mesh: TriMesh, planes: &[PlaneCut]) -> Result<crate::Outcome, Failed> {
        cut(&Model::from(mesh), &Params::new(planes.to_vec(), Format::Off), &Watch::default())
    }

    fn plane(point: [f64; 3], normal: [f64; 3]) -> PlaneCut {
        PlaneCut::new(DVec3::from(point), DVec3::from(normal))
    }

    /// The volume between the faces and the origin.
    fn cones(mesh: &TriMesh) -> f64 {
        mesh.faces.iter().map(|f| f.map(|v| mesh.positions[v.index()])).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
    }

    /// Two halves share a flat cap that neither has: the cap's two cone volumes cancel, so the halves add up to the whole.
    #[test]
    fn both_sides_together_are_the_whole() {
        for seed in 0..20 {
            let turn = DQuat::from_euler(glam::EulerRot::XYZ, f64::from(seed), 0.3 * f64::from(seed), 0.7);
            let mesh = shapes::posed(shapes::icosphere(1.0, 3), turn, DVec3::new(0.1, 0.2, 0.3));
            let at = plane([0.3, 0.2, 0.1], [0.5, -0.2, 1.0]);
            let back = PlaneCut { normal: -at.normal, ..at };
            let (one, two) = (run(mesh.clone(), &[at]).unwrap(), run(mesh.clone(), &[back]).unwrap());
            let (a, b) = (&one.model.mesh, &two.model.mesh);
            assert!((area(a) + area(b) - area(&mesh)).abs() < 1e-12);
            assert!((cones(a) + cones(b) - cones(&mesh)).abs() < 1e-12);
            let unit = at.normal.normalize();
            assert!(a.positions.iter().all(|&p| (p - at.point).dot(unit) < 1e-15));
            for (mesh, side) in [(a, 1.0), (b, -1.0)] {
                let rims = boundary_loops(&Connected::new(mesh).unwrap());
                assert_eq!(rims.len(), 1);
                assert!(rims[0].iter().all(|h| {
                    let p = mesh.triangle(h.face())[h.corner()];
                    (side * (p - at.point).dot(unit)).abs() < 1e-5
                }));
            }
        }
    }

    #[test]
    fn what_stays_keeps_its_bits_and_its_order() {
        let mesh = shapes::torus(2.0, 0.5, 48, 24);
        let outcome = run(mesh.clone(), &[plane([0.1, 0.0, 0.0], [1.0, 0.1, 0.0])]).unwrap();
        let mut last = None;
        for (p, origin) in outcome.model.mesh.positions.iter().zip(outcome.origins.vertices.as_slice()) {
            if let VertexOrigin::Input { vertex, .. } = origin {
                assert_eq!(p, &mesh.positions[vertex.index()]);
                assert!(last.is_none_or(|l| l < *vertex));
                last = Some(*vertex);
            }
            assert!(origin.position(&[&mesh]).is_some_and(|q| q.distance(*p) < 1e-14));
        }
        let whole = outcome.origins.faces.as_slice().iter().filter(|o| matches!(o, FaceOrigin::Input { .. })).count();
        assert!(whole > 1000 && outcome.report.changed_faces < 150);
        assert_eq!(outcome.report.figures["rims"], 2.0);
    }

    #[test]
    fn a_seed_cuts_one_contour_only() {
        // Two separate balls in one mesh, met by one plane.
        let (a, mut b) = (shapes::icosphere(1.0, 2), shapes::icosphere(1.0, 2));
        b.positions.iter_mut().for_each(|p| p.x += 3.0);
        let n = a.positions.len() as u32;
        let faces = a.faces.iter().map(|f| f.map(|v| v.0)).chain(b.faces.iter().map(|f| f.map(|v| v.0 + n)));
        let both = TriMesh::from_arrays([a.positions, b.positions].concat(), faces.collect::<Vec<_>>());
        let all = plane([0.0, 0.0, 0.2], [0.0, 0.0, 1.0]);
        let seeded = PlaneCut { seed: Some(DVec3::new(3.4, 0.0, 0.5)), ..all };
        let one = run(both.clone(), &[seeded]).unwrap();
        assert_eq!(one.report.figures["rims"], 1.0);
        let top = |m: &TriMesh, right: bool| {
            m.positions.iter().filter(|p| (p.x > 1.5) == right).map(|p| p.z).fold(f64::MIN, f64::max)
        };
        assert!(top(&one.model.mesh, false) > 0.9 && top(&one.model.mesh, true) < 0.21);
        assert_eq!(run(both, &[all]).unwrap().report.figures["rims"], 2.0);
    }

    #[test]
    fn a_contour_of_a_handle_does_not_part_it() {
        let torus = shapes::torus(2.0, 0.5, 48, 24);
        let one = PlaneCut { seed: Some(DVec3::new(0.0, 2.0, 0.0)), ..plane([0.013, 0.0, 0.0], [1.0, 0.0, 0.0]) };
        assert!(matches!(run(torus, &[one]), Err(Failed::Cut(Error::DoesNotSeparate { .. }))));
    }

    #[test]
    fn planes_through_vertices_leave_them_as_the_rim() {
        // The equator of a box of squares, its bottom and its top.
        let mesh = shapes::cuboid(DVec3::splat(2.0));
        let top = mesh.positions.iter().map(|p| p.z).fold(f64::MIN, f64::max);
        let lid = run(mesh.clone(), &[plane([0.0, 0.0, top], [0.0, 0.0, 1.0])]).unwrap();
        assert_eq!((lid.report.output.vertices, lid.report.output.faces), (8, 10));
        let ball = shapes::uv_sphere(1.0, 24, 12);
        let half = run(ball, &[plane([0.0; 3], [0.0, 0.0, 1.0])]).unwrap();
        assert_eq!(half.report.changed_faces, 0);
        let rim = boundary_loops(&Connected::new(&half.model.mesh).unwrap());
        assert_eq!(rim.iter().map(Vec::len).collect::<Vec<_>>(), [24]);
    }

    #[test]
    fn planes_that_cannot_cut_say_why() {
        let cube = || shapes::cuboid(DVec3::ONE);
        assert!(matches!(run(cube(), &[plane([0.0; 3], [0.0; 3])]), Err(Failed::Cut(Error::NoPlane { .. }))));
        let far = run(cube(), &[plane([0.0, 0.0, 9.0], [0.0, 0.0, 2.0])]).unwrap_err();
        assert!(far.to_string().contains("from -9 to -8") || far.to_string().contains("-8.5"), "{far}");
    }

    #[test]
    fn two_cuts_make_a_tube() {
        let mesh = shapes::icosphere(1.0, 3);
        let cuts = [plane([0.0, 0.0, 0.5], [0.0, 0.0, 1.0]), plane([0.0, 0.0, -0.5], [0.1, 0.0, -1.0])];
        let tube = run(mesh.clone(), &cuts).unwrap();
        assert_eq!((tube.report.figures["rims"], tube.report.figures["contours"]), (2.0, 2.0));
        for (p, origin) in tube.model.mesh.positions.iter().zip(tube.origins.vertices.as_slice()) {
            assert!(origin.position(&[&mesh]).is_some_and(|q| q.distance(*p) < 1e-14));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        /// Any plane through a torus: what stays has the area that lies below, and its rims are closed and in the plane.
        #[test]
        fn any_plane_through_a_torus(
            normal in prop::array::uniform3(-1.0..1.0f64),
            height in -0.9..0.9f64,
        ) {
            let mesh = shapes::torus(1.0, 0.4, 24, 12);
            let normal = DVec3::from(normal);
            prop_assume!(normal.length() > 0.1);
            let at = PlaneCut::new(height * normal.normalize(), normal);
            match (run(mesh.clone(), &[at]), run(mesh.clone(), &[PlaneCut { normal: -normal, ..at }])) {
                (Ok(a), Ok(b)) => {
                    let sum = area(&a.model.mesh) + area(&b.model.mesh);
                    prop_assert!((sum - area(&mesh)).abs() < 1e-9, "{sum}");
                }
                (Err(Failed::Cut(Error::Misses { .. })), _) | (_, Err(Failed::Cut(Error::Misses { .. }))) => {}
                (a, b) => prop_assert!(false, "{:?} {:?}", a.err(), b.err()),
            }
        }
    }
}
