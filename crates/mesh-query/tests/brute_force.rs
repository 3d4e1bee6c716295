//! Every query against a twin that looks at every triangle, on random soups: degenerate triangles included, with
//! coordinates huge, tiny and far from the origin.

use glam::DVec3;
use mesh_core::{Bounds, FaceId, Faces, TriMesh};
use mesh_query::{TriBvh, closest_point_on_triangle};
use proptest::prelude::*;

/// Where a soup sits: its size and its offset from the origin.
const PLACES: [(f64, f64); 5] = [(1.0, 0.0), (1e300, 0.0), (1e-30, 0.0), (1.0, 1e9), (1e-200, 0.0)];

#[derive(Debug, Clone)]
struct Scene {
    mesh: TriMesh,
    size: f64,
    offset: DVec3,
}

impl Scene {
    fn place(&self, p: DVec3) -> DVec3 {
        p * self.size + self.offset
    }
}

fn point() -> impl Strategy<Value = DVec3> {
    // Coarse coordinates now and then: shared planes, equal boxes and ties.
    let coordinate = prop_oneof![-1.0..1.0, (-4i32..=4).prop_map(|i| f64::from(i) / 4.0)];
    [coordinate.clone(), coordinate.clone(), coordinate].prop_map(DVec3::from)
}

fn triangle() -> impl Strategy<Value = [DVec3; 3]> {
    (point(), point(), point(), 0..8u32, 0.0..1.0).prop_map(|(a, b, c, kind, t)| match kind {
        0 => [a, a, a],
        1 => [a, a, b],
        2 => [a, b, a + t * (b - a)],
        3..=5 => [a, a + 0.1 * b, a + 0.1 * c],
        _ => [a, b, c],
    })
}

fn scene() -> impl Strategy<Value = Scene> {
    (prop::collection::vec(triangle(), 1..60), 0..PLACES.len()).prop_map(|(triangles, place)| {
        let (size, offset) = PLACES[place];
        let offset = DVec3::new(1.0, -0.5, 0.25) * offset;
        let positions = triangles.iter().flatten().map(|&p| p * size + offset).collect();
        let faces = (0..triangles.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]);
        Scene { mesh: TriMesh::from_arrays(positions, faces), size, offset }
    })
}

fn box_of(mesh: &TriMesh, f: FaceId) -> Bounds {
    Bounds::of(mesh.triangle(f))
}

proptest! {
    #[test]
    fn closest_point_is_the_closest_of_all(scene in scene(), q in point(), far in prop_oneof![Just(1.0), Just(50.0), Just(1e-3)]) {
        let Scene { mesh, size, .. } = &scene;
        let p = scene.place(q * far);
        let twin = mesh.face_ids().map(|f| {
            let (x, _) = closest_point_on_triangle(p, mesh.triangle(f));
            ((x - p) / size).length()
        }).fold(f64::INFINITY, f64::min);
        let tree = TriBvh::build(mesh).unwrap();
        let found = tree.closest_point(mesh, p).unwrap();
        // Positions are rounded to 1e-16 of the offset, and so is everything derived from them.
        let tolerance = 1e-13 * far.max(1.0) + 1e-15 * scene.offset.length();
        prop_assert!((found.distance / size - twin).abs() <= tolerance, "{} {twin}", found.distance / size);
        prop_assert!((((found.point - p) / size).length() - twin).abs() <= tolerance);
        prop_assert!(found.barycentric.iter().all(|&w| w >= 0.0));
        prop_assert!((found.barycentric.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        prop_assert!(((found.surface_point(mesh).position(mesh) - found.point) / size).length() <= tolerance);
        // The limit is inclusive to rounding, and nothing beyond it is found.
        prop_assert_eq!(tree.closest_point_within(mesh, p, found.distance * 1.001), Some(found));
        if found.distance > 0.0 {
            prop_assert_eq!(tree.closest_point_within(mesh, p, found.distance * 0.999), None);
        }
    }

    #[test]
    fn closest_point_on_a_triangle_beats_a_grid_of_its_points(t in triangle(), p in point()) {
        let (x, w) = closest_point_on_triangle(p, t);
        let d = (x - p).length();
        let inside = w[0] * t[0] + w[1] * t[1] + w[2] * t[2];
        prop_assert!((inside - x).length() < 1e-14 && w.iter().all(|&w| (0.0..=1.0).contains(&w)));
        for i in 0..=40 {
            for j in 0..=40 - i {
                let (u, v) = (f64::from(i) / 40.0, f64::from(j) / 40.0);
                let q = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
                prop_assert!(d <= (q - p).length() + 1e-12, "{t:?} {p} {q}");
            }
        }
    }

    #[test]
    fn rays_hit_what_every_triangle_alone_would_give(scene in scene(), o in point(), towards in point(), far in prop_oneof![Just(2.0), Just(1e3)]) {
        let Scene { mesh, .. } = &scene;
        let (origin, direction) = (scene.place(o * far), (towards - o * far) * scene.size);
        prop_assume!(direction.length() > 0.0);
        let twin = mesh.face_ids().filter_map(|f| {
            TriBvh::build_subset(mesh, &[f]).unwrap().ray_cast(mesh, origin, direction, f64::INFINITY)
        }).min_by(|a, b| a.t.total_cmp(&b.t).then(a.face.cmp(&b.face)));
        let tree = TriBvh::build(mesh).unwrap();
        let hit = tree.ray_cast(mesh, origin, direction, f64::INFINITY);
        prop_assert_eq!(hit.map(|h| h.face), twin.map(|h| h.face));
        prop_assert_eq!(tree.ray_occluded(mesh, origin, direction, f64::INFINITY), hit.is_some());
        if let Some(hit) = hit {
            prop_assert!((hit.t - twin.unwrap().t).abs() <= 1e-12 * (1.0 + hit.t));
            prop_assert!(!tree.ray_occluded(mesh, origin, direction, hit.t * 0.999 - 1e-12));
            let [a, b, c] = mesh.triangle(hit.face);
            let [u, v, w] = hit.barycentric;
            let on_ray = origin + hit.t * direction;
            let off = ((a - on_ray) * u + (b - on_ray) * v + (c - on_ray) * w) / scene.size;
            prop_assert!(off.length() < 1e-9 + 1e-14 * scene.offset.length(), "{off}");
        }
    }

    #[test]
    fn boxes_and_pairs_are_exactly_those_of_all_triangles(s in scene(), t in scene(), corner in point(), opposite in point()) {
        let (a, b) = (&s.mesh, &t.mesh);
        let tree = TriBvh::build(a).unwrap();
        let bounds = Bounds::of([s.place(corner), s.place(opposite)]);
        let mut found = vec![FaceId(7)];
        tree.faces_in_box(a, &bounds, &mut found);
        prop_assert_eq!(found, a.face_ids().filter(|&f| box_of(a, f).overlaps(&bounds)).collect::<Vec<_>>());

        let other = TriBvh::build(b).unwrap();
        let pairs = tree.overlapping_pairs(a, &other, b);
        let twin: Vec<_> = a.face_ids().flat_map(|f| b.face_ids().map(move |g| [f, g]))
            .filter(|&[f, g]| box_of(a, f).overlaps(&box_of(b, g))).collect();
        prop_assert_eq!(pairs, twin);

        let twin: Vec<_> = a.face_ids().flat_map(|f| a.face_ids().map(move |g| [f, g]))
            .filter(|&[f, g]| f < g && box_of(a, f).overlaps(&box_of(a, g))).collect();
        prop_assert_eq!(tree.self_overlapping_pairs(a), twin);
    }

    #[test]
    fn a_subset_answers_with_the_ids_of_the_mesh(scene in scene(), p in point()) {
        let Scene { mesh, .. } = &scene;
        let p = scene.place(p);
        let odd: Vec<_> = mesh.face_ids().filter(|f| f.0 % 2 == 1).collect();
        let shuffled: Vec<_> = odd.iter().rev().chain(&odd).copied().collect();
        let (one, two) = (TriBvh::build_subset(mesh, &odd).unwrap(), TriBvh::build_subset(mesh, &shuffled).unwrap());
        let found = one.closest_point(mesh, p);
        prop_assert_eq!(found, two.closest_point(mesh, p));
        prop_assert_eq!(found.is_none(), odd.is_empty());
        prop_assert!(found.is_none_or(|c| c.face.0 % 2 == 1));
    }
}
