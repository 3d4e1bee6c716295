//! Floods of geodesic distance between bounds that need no flood.

use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, Faces, FloodParams, Positions, Seed, Source, SurfacePoint, VertexId, flood, shapes,
};
use proptest::prelude::*;

/// How much shorter than the straight way a flood may be on such meshes.
const SHORT: f64 = 0.03;

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

    /// No shorter than the straight way but for the flood's own error, which grows with the triangles' thinness, no longer than along
    /// edges, and hardly changing by more than an edge is long.
    #[test]
    fn distances_lie_between_chords_and_edges(
        roughness in 0.0f64..0.6,
        seed in 0u64..1000,
        from in prop::collection::vec(0u32..642, 1),
        squeeze in 0.3f64..1.0,
        reach in 0.2f64..4.0,
    ) {
        let mut blob = shapes::blob(1.0, 3, roughness, seed);
        blob.positions.iter_mut().for_each(|p| p.z *= squeeze);
        let mesh = Connected::new(blob).unwrap();
        let at = |v: VertexId| mesh.position(v);
        let seeds: Vec<Seed> = from
            .iter()
            .map(|&v| Seed { source: Source::At(SurfacePoint::Vertex(VertexId(v))), distance: 0.0 })
            .collect();
        let params = FloodParams { max_distance: reach, ..FloodParams::default() };
        let near = flood(&mesh, &seeds, &params);
        let mut along: Vec<f64> = vec![f64::INFINITY; mesh.vertex_count()];
        for &v in &from {
            along[v as usize] = 0.0;
        }
        // Bellman and Ford: slow, and nothing like the flood.
        loop {
            let mut changed = false;
            for v in mesh.vertex_ids() {
                for w in mesh.ring(v).map(|h| mesh.head(h)) {
                    let way = along[w.index()] + at(v).distance(at(w));
                    if way < along[v.index()] {
                        along[v.index()] = way;
                        changed = true;
                    }
                }
            }
            if !changed {
                break;
            }
        }
        for v in mesh.vertex_ids() {
            let chord = from.iter().map(|&s| at(VertexId(s)).distance(at(v))).fold(f64::INFINITY, f64::min);
            let Some(distance) = near.vertex(v) else {
                prop_assert!(along[v.index()] > reach * (1.0 - 1e-12));
                continue;
            };
            prop_assert!(distance <= reach);
            prop_assert!(chord <= distance * (1.0 + SHORT) && distance <= along[v.index()] * (1.0 + 1e-9));
            for w in mesh.ring(v).map(|h| mesh.head(h)) {
                let step = at(v).distance(at(w));
                let other = near.vertex(w).unwrap_or(reach);
                prop_assert!((distance - other).abs() <= step * (1.0 + SHORT) || other == reach);
            }
        }
        prop_assert!(near.vertices().windows(2).all(|w| w[0].1 <= w[1].1));
        prop_assert_eq!(near.vertex(VertexId(from[0])), Some(0.0));
    }

    /// On a plane the distance is the plane's, whatever the triangles.
    #[test]
    fn planes_are_exact(shift in prop::array::uniform2(-0.3f64..0.3), from in 0u32..121) {
        let mut plane = shapes::grid(2.0, 2.0, 10, 10);
        for p in &mut plane.positions {
            let inner = (1.0 - p.x * p.x) * (1.0 - p.y * p.y);
            *p += inner * DVec3::new(shift[0] * p.y, shift[1] * p.x, 0.0);
        }
        let mesh = Connected::new(plane).unwrap();
        let seed = Seed { source: Source::At(SurfacePoint::Vertex(VertexId(from))), distance: 0.0 };
        let seeds = [seed];
        let near = flood(&mesh, &seeds, &FloodParams::default());
        for v in mesh.vertex_ids() {
            let truth = mesh.position(v).distance(mesh.position(VertexId(from)));
            prop_assert!((near.vertex(v).unwrap() - truth).abs() < 1e-9);
        }
    }
}
