//! A ball rolled along the upper rim of any truncated cone, where its place is known.

use glam::DVec3;
use mesh_core::{Connected, Faces, Positions, VertexId, shapes};
use proptest::prelude::*;
use spine::{BlendCurve, Convexity, Params, roll};

proptest! {
    #![proptest_config(ProptestConfig { cases: 32, failure_persistence: None, ..ProptestConfig::default() })]

    /// Every centre is the radius away from the lid, and its foot there above it, to a twentieth of the radius at the rim's
    /// corners, where linkages are faired; the other foot is on the side, no nearer than the radius.
    #[test]
    fn the_ball_touches_lid_and_side(
        lower in 0.5f64..1.6,
        height in 0.5f64..2.0,
        segments in 12u32..48,
        radius in 0.02f64..0.15,
        size in -20i32..20,
    ) {
        let size = 2f64.powi(size);
        let cone = shapes::truncated_cone([size * lower, size], size * height, segments, 3);
        let mesh = Connected::new(cone).unwrap();
        let (top, radius) = (0.5 * size * height, size * radius);
        let mut rim: Vec<VertexId> = mesh.vertex_ids().filter(|&v| {
            let p = mesh.position(v);
            (p.z - top).abs() < 1e-9 * size && (p.truncate().length() - size).abs() < 1e-9 * size
        }).collect();
        let angle = |v: &VertexId| mesh.position(*v).y.atan2(mesh.position(*v).x);
        rim.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        let curve = BlendCurve::from_vertices(&mesh, &rim).unwrap();
        prop_assert_eq!(curve.convexity(&mesh).unwrap(), Convexity::Convex);
        let rail = roll(&mesh, &curve, std::slice::from_ref(&curve), &Params::new(radius)).unwrap();
        prop_assert!(rail.closed && rail.residual <= 1e-9 * radius);
        for sample in &rail.samples {
            prop_assert!((sample.center.z - (top - radius)).abs() <= 1e-8 * radius, "{}", sample.center.z);
            let feet = sample.feet.map(|f| f.point);
            let lid = usize::from((feet[1].z - top).abs() < (feet[0].z - top).abs());
            prop_assert!(feet[lid].distance(sample.center + radius * DVec3::Z) <= 0.05 * radius, "{}", feet[lid]);
            prop_assert!(feet[1 - lid].distance(sample.center) >= (1.0 - 1e-9) * radius);
        }
    }
}
