//! What must hold for any blend: it vanishes with its radius, moves with its mesh, and does not depend on the order of curves.

use fusion::blend::{Blended, Overlap, Params, blend};
use fusion::features::{self, feature_curves};
use fusion::{Choice, cluster, round, sharpen};
use glam::{DQuat, DVec3};
use mesh_core::{
    Connected, Faces, Positions, TriMesh, VertexId, Watch, centroid, shapes, triangle_normal, validate, volume,
};
use mesh_io::Format;
use mesh_query::TriBvh;
use proptest::prelude::*;
use spine::BlendCurve;
use std::f64::consts::TAU;

/// A pyramid without its top: every side of it a feature, every vertex a corner of three edges.
#[derive(Clone, Debug)]
struct Frustum {
    /// How far the corners of its base lie out, three to five of them.
    radii: Vec<f64>,
    /// Size of its top, as a share of its base.
    taper: f64,
    height: f64,
    turn: DQuat,
}

impl Frustum {
    fn any() -> impl Strategy<Value = Self> {
        let radii = prop::collection::vec(0.8..1.2, 3..=5);
        let turn = prop::array::uniform3(-2.0..2.0).prop_map(|t| DQuat::from_scaled_axis(t.into()));
        (radii, 0.6..1.0, 0.8..1.5, turn).prop_map(|(radii, taper, height, turn)| Self { radii, taper, height, turn })
    }

    fn mesh(&self) -> TriMesh {
        let n = self.radii.len() as u32;
        let level = |z: f64, size: f64| {
            self.radii.iter().zip(0..).map(move |(&r, i)| {
                let (sin, cos) = (TAU * f64::from(i) / f64::from(n)).sin_cos();
                self.turn * DVec3::new(size * r * cos, size * r * sin, z)
            })
        };
        let caps = (1..n - 1).flat_map(|i| [[0, i + 1, i], [n, n + i, n + i + 1]]);
        let wall = |i: u32| [[i, (i + 1) % n, n + (i + 1) % n], [i, n + (i + 1) % n, n + i]];
        let faces = caps.chain((0..n).flat_map(wall)).map(|f| f.map(VertexId)).collect();
        TriMesh { positions: level(0.0, 1.0).chain(level(self.height, self.taper)).collect(), faces }
    }
}

fn rounded(mesh: TriMesh, radius: f64, order: impl Fn(&mut Vec<BlendCurve>)) -> Blended {
    let mesh = Connected::new(mesh).unwrap();
    let found = feature_curves(&mesh, &features::Params::default());
    let mut curves = found.into_iter().map(|c| BlendCurve { halfedges: c.halfedges, closed: c.closed }).collect();
    order(&mut curves);
    let params = Params { overlap: Overlap::Error, ..Params::new(radius) };
    blend(&mesh, &curves, &params, &Watch::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// Largest distance from a mesh's vertices and middles of faces to another, and back.
fn apart(a: &TriMesh, b: &TriMesh) -> f64 {
    let one_way = |a: &TriMesh, b: &TriMesh| {
        let tree = TriBvh::build(b).unwrap();
        let middles = a.face_ids().map(|f| centroid(a.triangle(f)));
        let points = a.positions.iter().copied().chain(middles);
        points.map(|p| tree.closest_point(b, p).unwrap().distance).fold(0.0, f64::max)
    };
    one_way(a, b).max(one_way(b, a))
}

fn moved(mesh: TriMesh, motion: impl Fn(DVec3) -> DVec3) -> TriMesh {
    TriMesh { positions: mesh.positions.into_iter().map(motion).collect(), ..mesh }
}

/// Same triangles, points to rounding: this share of the radius.
const ROUNDING: f64 = 1e-7;

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, failure_persistence: None, ..ProptestConfig::default() })]

    /// What is taken away falls as the square of the radius, and reaches as deep as the radius.
    #[test]
    fn a_blend_vanishes_with_its_radius(solid in Frustum::any()) {
        let mesh = solid.mesh();
        let [one, quarter] = [0.08, 0.02].map(|r| rounded(mesh.clone(), r, |_| {}).mesh);
        let [whole, one_volume, quarter_volume] = [&mesh, &one, &quarter].map(volume);
        let share = (whole - quarter_volume) / (whole - one_volume);
        prop_assert!(whole > one_volume && (0.055..0.085).contains(&share), "{share}");
        let depth = [&one, &quarter].map(|m| apart(m, &mesh));
        prop_assert!((depth[1] / depth[0] - 0.25).abs() < 0.01, "{depth:?}");
    }

    /// A power of two changes exponents only.
    #[test]
    fn scaling_by_a_power_of_two_keeps_every_bit(solid in Frustum::any(), power in -40..40) {
        let scale = 2f64.powi(power);
        let plain = rounded(solid.mesh(), 0.1, |_| {});
        let scaled = rounded(moved(solid.mesh(), |p| scale * p), scale * 0.1, |_| {});
        prop_assert_eq!(&plain.mesh.faces, &scaled.mesh.faces);
        let bits = |m: &TriMesh, s: f64| m.positions.iter().map(|&p| (s * p).to_array().map(f64::to_bits)).collect::<Vec<_>>();
        prop_assert_eq!(bits(&plain.mesh, scale), bits(&scaled.mesh, 1.0));
    }

    #[test]
    fn scaling_and_motion_commute_with_blending(
        solid in Frustum::any(),
        scale in 0.01..100.0,
        turn in prop::array::uniform3(-3.0..3.0),
        shift in prop::array::uniform3(-5.0..5.0),
    ) {
        let motion = |p: DVec3| scale * (DQuat::from_scaled_axis(turn.into()) * p + DVec3::from(shift));
        let after = moved(rounded(solid.mesh(), 0.1, |_| {}).mesh, motion);
        let before = rounded(moved(solid.mesh(), motion), 0.1 * scale, |_| {}).mesh;
        let off = apart(&after, &before) / (0.1 * scale);
        prop_assert!(off < ROUNDING, "{off}");
    }

    /// A convex polyhedron rounded by clusters stays within its faces, and closed.
    #[test]
    fn clusters_stay_inside(solid in Frustum::any()) {
        let mesh = solid.mesh();
        let made = cluster::cluster(&mesh.clone().into(), &cluster::Params::new(Format::Off), &Watch::default());
        let round = made.unwrap().outcome.model.mesh;
        prop_assert!(validate(&round).is_closed());
        prop_assert!((0.5..1.0).contains(&(volume(&round) / volume(&mesh))));
        for f in mesh.face_ids() {
            let (on, normal) = (mesh.triangle(f)[0], triangle_normal(mesh.triangle(f)));
            let out = round.positions.iter().map(|p| (*p - on).dot(normal)).fold(f64::MIN, f64::max);
            prop_assert!(out.abs() < 1e-9, "{out}");
        }
    }

    /// A rounded edge of a convex polyhedron, taken back, is the edge.
    #[test]
    fn roundings_are_taken_back(solid in Frustum::any(), edge in 0usize..9, radius in 0.03..0.12) {
        let mesh = solid.mesh();
        let connected = Connected::new(&mesh).unwrap();
        let curves = feature_curves(&connected, &features::Params::default());
        let [a, b] = connected.ends(curves[edge % curves.len()].halfedges[0]);
        let rounding = round::Params {
            features: features::Params::default(),
            choice: Choice { near: vec![a.midpoint(b).into()], ..Choice::default() },
            blend: Params::new(radius),
            format: Format::Off,
        };
        let soft = round::round(&mesh.clone().into(), &rounding, &Watch::default()).unwrap().model;
        let taken = volume(&mesh) - volume(&soft.mesh);
        let place = TriBvh::build(&soft.mesh).unwrap().closest_point(&soft.mesh, a.midpoint(b)).unwrap().point;
        let how = sharpen::Params { near: vec![place], radius: None, angle: 40.0, format: Format::Off };
        let back = sharpen::sharpen(&soft, &how, &Watch::default()).unwrap().model.mesh;
        prop_assert!(taken > 0.0 && (volume(&back) - volume(&mesh)).abs() < 1e-6 * taken, "{}", volume(&back) - volume(&mesh));
    }

    #[test]
    fn the_order_of_curves_does_not_matter(solid in Frustum::any(), by in 1..8usize) {
        let plain = rounded(solid.mesh(), 0.1, |_| {}).mesh;
        let other = rounded(solid.mesh(), 0.1, |curves| {
            let n = curves.len();
            curves.rotate_left(by % n);
            curves.swap(0, n - 1);
        }).mesh;
        let off = apart(&plain, &other) / 0.1;
        prop_assert!(off < ROUNDING, "{off}");
        prop_assert_eq!(plain.faces.len(), other.faces.len());
    }
}

/// The same on curved solids, closed seams and valleys: a post on a plate.
#[test]
fn a_filleted_post_scales_to_the_bit() {
    let post = |scale: f64| {
        let plate = shapes::posed(shapes::cuboid(DVec3::new(4.0, 4.0, 1.0)), DQuat::IDENTITY, DVec3::NEG_Z * 0.5);
        let post = shapes::posed(shapes::cylinder(1.0, 2.0, 32, 2), DQuat::IDENTITY, DVec3::new(0.01, 0.02, 0.25));
        let [plate, post] = [plate, post].map(|m| Connected::new(moved(m, |p| scale * p)).unwrap());
        let how = tri_intersect::Params::default();
        let cut =
            tri_intersect::boolean(&plate, &post, tri_intersect::Operation::Union, &how, &Watch::default()).unwrap();
        let whole = Connected::new(cut.mesh).unwrap();
        let seams = cut.seams.iter().map(|s| BlendCurve::from_vertices(&whole, &s.vertices).unwrap());
        blend(&whole, &seams.collect::<Vec<_>>(), &Params::new(0.2 * scale), &Watch::default()).unwrap().mesh
    };
    let (plain, scaled) = (post(1.0), post(2f64.powi(-20)));
    assert_eq!(plain.faces, scaled.faces);
    assert!(plain.positions.iter().zip(&scaled.positions).all(|(p, q)| *p == 2f64.powi(20) * *q));
}
