//! Radii and profiles that vary along an edge, and radii from one side of it to the other, against the surfaces known for a
//! cube.

use fusion::blend::{Blended, Error, Overlap, Params, Radii, blend, max_radius};
use fusion::features::{self, feature_curves, nearest_curve};
use fusion::round::max_radius_of_each;
use glam::DVec3;
use mesh_core::{Connected, Faces, Positions, TriMesh, VertexId, VertexOrigin, Watch, shapes, volume};
use spine::BlendCurve;
use std::f64::consts::PI;

/// The cube's edge along x where y and z are a half, and all others behind it.
fn edges(mesh: &Connected<TriMesh>) -> Vec<BlendCurve> {
    let mut all = feature_curves(mesh, &features::Params::default());
    let first = nearest_curve(mesh, &all, DVec3::new(0.0, 0.5, 0.5)).unwrap().0;
    all.swap(0, first);
    all.into_iter().map(|c| BlendCurve { halfedges: c.halfedges, closed: c.closed }).collect()
}

fn rounded(mesh: &Connected<TriMesh>, [left, right]: [f64; 2], at: &[(DVec3, f64)]) -> Blended {
    let (radius, radii) = Radii::of([left, right], at);
    let params = Params { radii, overlap: Overlap::Error, tolerance: 1e-4, snap: 0.0, ..Params::new(radius) };
    let done = blend(mesh, &edges(mesh)[..1], &params, &Watch::default()).unwrap();
    let found = mesh_core::validate(&done.mesh);
    assert!(found.is_manifold() && found.is_closed(), "{found:?}");
    done
}

fn new_points(done: &Blended) -> impl Iterator<Item = DVec3> {
    let is_new = |(_, o): &(usize, &VertexOrigin)| !matches!(o, VertexOrigin::Input { .. });
    let ids = done.origins.vertices.as_slice().iter().enumerate().filter(is_new).map(|(v, _)| v);
    ids.map(|v| done.mesh.positions[v])
}

/// The centre keeps r1 from one face and r2 from the other, and the conic between the feet is a quarter of an ellipse.
#[test]
fn two_radii_make_a_quarter_of_an_ellipse() {
    let mesh = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
    let done = rounded(&mesh, [0.1, 0.3], &[]);
    let h = edges(&mesh)[0].halfedges[0];
    let left_is_top = mesh.corners(h.face()).iter().all(|&v| mesh.position(v).z > 0.0);
    // Depths below the faces y = ½ and z = ½.
    let [a, b] = if left_is_top { [0.3, 0.1] } else { [0.1, 0.3] };
    for p in new_points(&done) {
        let (y, z) = ((p.y - 0.5 + a) / a, (p.z - 0.5 + b) / b);
        // Edges of the end faces cross the chords, which are inscribed.
        let off = y.hypot(z) - 1.0;
        assert!(off < 1e-9 && (off > -1e-9 || p.x.abs() == 0.5 && off > -1e-3), "{p}");
    }
    let (got, exact) = (volume(&done.mesh), 1.0 - (1.0 - PI / 4.0) * a * b);
    assert!(got <= exact + 1e-12 && got > exact - 1e-4, "{got} {exact}");
}

/// Feet in the faces are as far from the edge as the radius is there: a cubic between its values at the ends.
#[test]
fn a_radius_keyed_at_one_end_changes_smoothly_to_the_other() {
    let mesh = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
    let done = rounded(&mesh, [0.1; 2], &[(DVec3::splat(0.5), 0.3)]);
    let mut feet = 0;
    for p in new_points(&done).filter(|p| p.x.abs() < 0.49) {
        let t = p.x + 0.5;
        let r = 0.1 + 0.2 * t * t * (3.0 - 2.0 * t);
        for (on, across) in [(p.y, p.z), (p.z, p.y)] {
            if (on - 0.5).abs() < 1e-12 {
                feet += 1;
                // Chords of the linkage, whose bend is the law's second derivative of at most 1.2, are 0.02 long.
                assert!((0.5 - across - r).abs() < 1.2 * 0.02f64.powi(2) / 8.0 + 1e-9, "{p} {r}");
            }
        }
        assert!(p.y < 0.5 + 1e-12 && p.z < 0.5 + 1e-12);
    }
    assert!(feet > 40, "{feet}");
}

#[test]
fn all_edges_with_a_thicker_place_are_valid() {
    let mesh = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
    let (radius, radii) = Radii::of([0.1; 2], &[(DVec3::new(0.0, 0.5, 0.5), 0.2)]);
    let params = Params { radii, overlap: Overlap::Error, ..Params::new(radius) };
    let done = blend(&mesh, &edges(&mesh), &params, &Watch::default()).unwrap();
    assert_eq!((done.strips, done.corners), (12, 8));
    let even = Params { overlap: Overlap::Error, ..Params::new(0.1) };
    let even = blend(&mesh, &edges(&mesh), &even, &Watch::default()).unwrap();
    assert!(volume(&done.mesh) < volume(&even.mesh) - 1e-3);
}

#[test]
fn corners_have_one_radius() {
    let mesh = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
    let (radius, radii) = Radii::of([0.1, 0.2], &[]);
    let params = Params { radii, ..Params::new(radius) };
    let refusal = blend(&mesh, &edges(&mesh), &params, &Watch::default());
    assert!(matches!(refusal, Err(Error::TwoRadiiMeet(at)) if at.abs() == DVec3::splat(0.5)), "{refusal:?}");
}

/// Alone, an edge of a cube stops in the faces at its ends.
#[test]
fn the_largest_radius_of_one_edge_is_right() {
    let mesh = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
    let curves = &edges(&mesh)[..1];
    let limit = max_radius(&mesh, curves, &Params::new(1.0), &Watch::default()).unwrap();
    let fits = |radius| {
        let params = Params { overlap: Overlap::Error, ..Params::new(radius) };
        blend(&mesh, curves, &params, &Watch::default()).is_ok()
    };
    assert!(limit.radius > 0.45 && fits(0.99 * limit.radius) && !fits(1.02 * limit.radius), "{limit:?}");
}

/// Balls of a ten-thousandth on long edges of huge triangles took seconds each, and a list of them minutes.
#[test]
fn the_radii_of_a_star_are_listed_in_seconds() {
    let mut star = shapes::cuboid(DVec3::splat(0.25));
    let sides: Vec<[[VertexId; 3]; 2]> = star.faces.chunks(2).map(|pair| [pair[0], pair[1]]).collect();
    star.faces.clear();
    for side in sides {
        let corners: Vec<DVec3> = side.iter().flatten().map(|&v| star.position(v)).collect();
        let tip = VertexId(star.positions.len() as u32);
        let out = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
        star.positions.push(0.5 * out);
        // The outline of the two triangles: every edge but the one both have.
        let edges: Vec<[VertexId; 2]> = side.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]).collect();
        let rim = edges.iter().filter(|e| !edges.contains(&[e[1], e[0]]));
        star.faces.extend(rim.map(|&[a, b]| [a, b, tip]));
    }
    let star = Connected::new(star).unwrap();
    let curves = feature_curves(&star, &features::Params::default());
    assert_eq!((star.face_count(), curves.len()), (24, 36));
    let limits = max_radius_of_each(&star, &curves, &Watch::default()).unwrap();
    assert_eq!(limits.len(), 36);
    // What is listed for an edge as tried works, and is half as large as what asking for it alone gives, at least.
    for (curve, limit) in curves.iter().zip(&limits).filter(|l| l.1.is_some_and(|l| l.tried)).take(2) {
        let alone = BlendCurve { halfedges: curve.halfedges.clone(), closed: curve.closed };
        let exact = max_radius(&star, &[alone], &Params::new(1.0), &Watch::default()).unwrap().radius;
        assert!(limit.is_some_and(|l| (0.48..1.01).contains(&(l.radius / exact))), "{exact}, {limit:?}");
    }
}

/// Along an edge of a cube the profiles at the keys are exact, and between them points move evenly from one to the other: of
/// an arc and its chord every mixture is known.
#[test]
fn a_profile_keyed_in_the_middle_is_mixed_with_the_one_at_the_ends() {
    let mesh = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
    let middle = DVec3::new(0.0, 0.5, 0.5);
    let params = Params {
        profile_at: vec![(middle, fusion::Profile::Chamfer)],
        overlap: Overlap::Error,
        tolerance: 1e-4,
        snap: 0.0,
        ..Params::new(0.2)
    };
    let done = blend(&mesh, &edges(&mesh)[..1], &params, &Watch::default()).unwrap();
    let found = mesh_core::validate(&done.mesh);
    assert!(found.is_manifold() && found.is_closed(), "{found:?}");
    let mut seen = [0; 2];
    for p in new_points(&done).filter(|p| p.x.abs() < 0.49) {
        // Along the diagonal of the cross-section: 0 on the chord, 1 on the arc at the profile's middle.
        let (y, z) = (p.y - 0.3, p.z - 0.3);
        if (y - z).abs() > 1e-9 {
            continue;
        }
        let stands = ((y + z) / 2f64.sqrt() - 0.2 / 2f64.sqrt()) / (0.2 - 0.2 / 2f64.sqrt());
        let t = 1.0 - (p.x / 0.5).abs();
        let chamfered = t * t * (3.0 - 2.0 * t);
        assert!((stands - (1.0 - chamfered)).abs() < 1e-9, "{p}: {stands} {chamfered}");
        seen[usize::from(chamfered > 0.5)] += 1;
    }
    assert!(seen[0] > 2 && seen[1] > 2, "{seen:?}");
}
