//! What holds of cuts, remeshing, compositions, features, detail and repair whatever they are given.

use fusion::cut::{Params, PlaneCut, cut};
use fusion::features::{self, feature_curves};
use fusion::mesh_core::{
    Adjacency, Connected, Faces, HalfedgeId, Positions, TriMesh, Watch, area, shapes, triangle_normal, validate,
};
use fusion::repair::{Step, apply_steps};
use fusion::{Info, Region, compose, detail, detail_transfer, remeshing};
use glam::{DQuat, DVec3};
use mesh_io::{Format, Model};
use proptest::prelude::*;

/// A bumpy solid, and a plane through its inside.
fn solid_and_plane() -> impl Strategy<Value = (TriMesh, DVec3, DVec3)> {
    let direction = prop::array::uniform3(-1.0f64..1.0).prop_filter("a direction", |d| DVec3::from(*d).length() > 0.1);
    (0.0f64..0.5, 0u64..1000, direction, -0.4f64..0.4).prop_map(|(roughness, seed, normal, along)| {
        let normal = DVec3::from(normal);
        (shapes::blob(1.0, 3, roughness, seed), along * normal.normalize(), normal)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, failure_persistence: None, ..ProptestConfig::default() })]

    /// Both sides of a cut together are the whole, and each stays on its side.
    #[test]
    fn halves_add_up((mesh, point, normal) in solid_and_plane()) {
        let whole = Model::from(mesh);
        let [this, that] = [normal, -normal].map(|n| {
            let params = Params::new(vec![PlaneCut::new(point, n)], Format::Ply);
            let half = cut(&whole, &params, &Watch::default()).unwrap().model.mesh;
            assert!(half.positions.iter().all(|p| (*p - point).dot(n.normalize()) < 1e-5));
            half
        });
        prop_assert!(validate(&this).is_manifold() && validate(&that).is_manifold());
        let total = area(&whole.mesh);
        prop_assert!((area(&this) + area(&that) - total).abs() < 1e-5 * total);
    }

    /// Even triangles of any size are a solid of about the same volume.
    #[test]
    fn remeshing_keeps_the_solid((mesh, ..) in solid_and_plane(), edge in 0.08f64..0.25) {
        let volume = fusion::mesh_core::volume(&mesh);
        let params = remeshing::Params::new(edge, Format::Ply);
        let even = fusion::remesh(&Model::from(mesh), &params, &Watch::default()).unwrap().model.mesh;
        let info = Info::of(&even, &Watch::default()).unwrap();
        prop_assert!(info.closed && info.genus == Some(0) && info.self_intersections == Some(0));
        prop_assert!((info.volume.unwrap() / volume - 1.0).abs() < 1.5 * edge * edge + 1e-3, "{:?} {}", info.volume, volume);
    }

    /// Curves hold every edge that turns by the angle or more once, in order, and no other.
    #[test]
    fn feature_curves_are_the_sharp_edges((mesh, ..) in solid_and_plane(), angle in 2.0f64..30.0) {
        let mesh = Connected::new(mesh).unwrap();
        let curves = feature_curves(&mesh, &features::Params { angle, spur: 0 });
        let low = |h: HalfedgeId| mesh.twin(h).map_or(h, |t| h.min(t));
        let mut found: Vec<_> = curves.iter().flat_map(|c| &c.halfedges).map(|&h| low(h)).collect();
        found.sort_unstable();
        let normal = |h: HalfedgeId| triangle_normal(mesh.triangle(h.face()));
        let turn = |h: HalfedgeId| normal(h).angle_between(mesh.twin(h).map_or(DVec3::ZERO, normal)).to_degrees();
        let edges = mesh.face_ids().flat_map(|f| [0, 1, 2].map(|k| HalfedgeId::new(f, k)));
        let sharp: Vec<_> = edges.filter(|&h| low(h) == h && turn(h) >= angle).collect();
        prop_assert_eq!(found, sharp);
        for curve in &curves {
            prop_assert!(curve.halfedges.windows(2).all(|w| mesh.head(w[0]) == mesh.tail(w[1])));
            let ends = curve.halfedges.first().map(|&h| mesh.tail(h)) == curve.halfedges.last().map(|&h| mesh.head(h));
            prop_assert!(ends || !curve.closed);
        }
    }

    /// Detail from one side of a solid on the other: the same triangles, and nothing moves but in the region.
    #[test]
    fn detail_stays_in_its_region((mesh, _, toward) in solid_and_plane(), radius in 0.3f64..0.6, intensity in 0.2f64..1.0) {
        let toward = 1.2 * toward.normalize();
        let near = |center: DVec3| Region::Near { center, radius };
        let params = detail::Params {
            target: near(toward),
            sources: vec![(0, near(-toward))],
            transfer: detail_transfer::Params { intensity: Some(intensity), ..detail_transfer::Params::default() },
            format: Format::Off,
        };
        let model = Model::from(mesh);
        let outcome = detail::detail(std::slice::from_ref(&model), &params, &Watch::default()).unwrap();
        let (before, after) = (&model.mesh, &outcome.model.mesh);
        prop_assert_eq!(&before.faces, &after.faces);
        let chosen = params.target.select(&model, &Connected::new(before.clone()).unwrap()).unwrap();
        let mut inside = vec![false; before.positions.len()];
        before.face_ids().filter(|&f| chosen[f]).flat_map(|f| before.corners(f)).for_each(|v| inside[v.index()] = true);
        let moved: Vec<usize> = (0..inside.len()).filter(|&v| before.positions[v] != after.positions[v]).collect();
        prop_assert!(!moved.is_empty() && moved.iter().all(|&v| inside[v]));
        prop_assert!(Info::of(after, &Watch::default()).unwrap().self_intersections == Some(0));
    }

    /// Any triangles at all: described without fail, and an oriented manifold once oriented and split.
    #[test]
    fn any_soup_is_described_and_mended(
        points in prop::collection::vec(prop::array::uniform3(prop::sample::select(vec![0.0, 1.0, 2.0, 1e300, f64::NAN])), 3..12),
        corners in prop::collection::vec(prop::array::uniform3(0usize..12), 0..30),
    ) {
        let count = points.len();
        let faces: Vec<_> = corners.iter().map(|f| f.map(|v| (v % count) as u32)).collect();
        let soup = TriMesh::from_arrays(points.into_iter().map(DVec3::from).collect(), faces);
        let info = Info::of(&soup, &Watch::default()).unwrap();
        prop_assert_eq!((info.vertices, info.faces), (soup.positions.len(), soup.faces.len()));
        let mended = apply_steps(&Model::from(soup), &[Step::Weld(0.0), Step::Orient, Step::Split], &Watch::default()).unwrap().model.mesh;
        let after = Info::of(&mended, &Watch::default()).unwrap();
        prop_assert!(after.manifold == mended.faces.iter().all(|[a, b, c]| a != b && b != c && c != a), "{:?}", after.defects);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 8, failure_persistence: None, ..ProptestConfig::default() })]

    /// Two cups with their mouths towards each other, tilted, and farther apart than the tilt makes them dip: one closed ball.
    #[test]
    fn cups_are_joined(
        gap in 0.9f64..2.5,
        tilt in prop::array::uniform2(-0.2f64..0.2),
        radius in 0.6f64..1.4,
        segments in 16u32..48,
    ) {
        let cup = |radius: f64, segments: u32| {
            let mut mesh = shapes::capsule(radius, 1.0, segments, 6, 4);
            mesh.faces.retain(|f| f.iter().any(|v| mesh.positions[v.index()].z < 0.5 - 1e-9));
            let (sound, _) = fusion::mesh_core::split(&mesh);
            Model::from(used(&sound))
        };
        let turn = DQuat::from_rotation_x(std::f64::consts::PI + tilt[0]) * DQuat::from_rotation_y(tilt[1]);
        let mut other = cup(radius, 24);
        other.mesh = shapes::posed(other.mesh, turn, DVec3::new(0.0, 0.0, 1.0 + gap));
        let parts = [cup(1.0, segments), other];
        let outcome = compose::compose(&parts, &compose::Params::new(Format::Ply), &Watch::default()).unwrap();
        let info = Info::of(&outcome.model.mesh, &Watch::default()).unwrap();
        prop_assert!(info.closed && info.components == 1 && info.genus == Some(0) && info.self_intersections == Some(0));
        let kept = parts.iter().flat_map(|p| &p.mesh.positions);
        prop_assert!(kept.zip(&outcome.model.mesh.positions).all(|(p, q)| p == q));
    }
}

/// The mesh without vertices of no face.
fn used(mesh: &TriMesh) -> TriMesh {
    let mut ids = vec![None; mesh.positions.len()];
    let mut part = TriMesh::default();
    for face in &mesh.faces {
        part.faces.push(face.map(|v| {
            *ids[v.index()].get_or_insert_with(|| {
                part.positions.push(mesh.positions[v.index()]);
                fusion::mesh_core::VertexId::from(part.positions.len() - 1)
            })
        }));
    }
    part
}
