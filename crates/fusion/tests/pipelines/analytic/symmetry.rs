//! What must not matter: the number of threads, the order of the parts, a quarter turn.

use super::cases::Pair::{self, Branch, Cross, PlateCylinder, PlateSphere, Spheres};
use super::cases::{COARSE, Case, RADIUS, SMALLER};
use super::measure::run;
use glam::DVec3;
use mesh_core::{Connected, Faces, TriMesh, centroid};
use mesh_query::TriBvh;
use tri_intersect::Operation::{self, Difference, Intersection, Union};

const CASES: &[(Pair, Operation)] = &[
    (PlateSphere, Union),
    (PlateSphere, Difference),
    (PlateCylinder, Union),
    (Spheres, Intersection),
    (Branch(SMALLER), Union),
    (Cross(SMALLER), Difference),
    (Cross(SMALLER), Intersection),
];

#[test]
fn one_thread_and_two_give_the_same_bits() {
    for &(pair, operation) in CASES {
        let case = Case::new(pair, operation, 2 * COARSE, RADIUS);
        let [one, two] = [1, 2].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| run(&case, |_| {}).expect("clean cases blend").blended)
        });
        let bits = |m: &TriMesh| m.positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect::<Vec<_>>();
        assert_eq!(bits(&one.mesh), bits(&two.mesh));
        assert_eq!(one.mesh.faces, two.mesh.faces);
        assert_eq!(one.origins, two.origins);
    }
}

/// Largest distance of a corner or a middle of a face of one mesh to the other, both ways.
fn apart(a: &TriMesh, b: &TriMesh) -> f64 {
    let one_way = |a: &TriMesh, b: &TriMesh| {
        let tree = TriBvh::build(b).expect("not empty");
        let middles = a.face_ids().map(|f| centroid(a.triangle(f)));
        let points = a.positions.iter().copied().chain(middles);
        points.map(|p| tree.closest_point(b, p).map_or(f64::INFINITY, |c| c.distance)).fold(0.0, f64::max)
    };
    one_way(a, b).max(one_way(b, a))
}

fn turned(mesh: &TriMesh, quarter: impl Fn(DVec3) -> DVec3) -> TriMesh {
    TriMesh { positions: mesh.positions.iter().map(|&p| quarter(p)).collect(), faces: mesh.faces.clone() }
}

/// A quarter turn changes nothing but rounding. With the parts swapped the trace runs the other way, so that profiles fall
/// elsewhere: results agree to the sagitta of the chords along and across.
#[test]
fn quarter_turns_and_swapped_parts_give_the_same_shape() {
    for &(pair, operation) in CASES {
        let case = Case::new(pair, operation, 2 * COARSE, RADIUS);
        let plain = run(&case, |_| {}).expect("clean cases blend").blended.mesh;
        let solid = |m| Connected::new(m).expect("still manifold");
        let quarter = |p: DVec3| DVec3::new(-p.y, p.x, p.z);
        let parts = case.parts.each_ref().map(|p| solid(turned(p.mesh(), quarter)));
        let turned_case = Case { parts, ..Case::new(pair, operation, 2 * COARSE, RADIUS) };
        let turned_back =
            turned(&run(&turned_case, |_| {}).expect("clean cases blend").blended.mesh, |p| DVec3::new(p.y, -p.x, p.z));
        let turn = apart(&plain, &turned_back) / RADIUS;
        println!("{pair:?} {operation:?}: a quarter turn moves it by {turn:.1e} of the radius");
        assert!(turn < 1e-5, "{pair:?} {operation:?}: {turn}");
        if operation != Difference {
            let [a, b] = case.parts;
            let swapped = Case { parts: [b, a], ..Case::new(pair, operation, 2 * COARSE, RADIUS) };
            let swap = apart(&plain, &run(&swapped, |_| {}).expect("clean cases blend").blended.mesh) / RADIUS;
            println!("{pair:?} {operation:?}: swapping the parts moves it by {swap:.1e} of the radius");
            assert!(swap < 0.025, "{pair:?} {operation:?}: {swap}");
        }
    }
}
