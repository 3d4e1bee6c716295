//! A ball too large for a waist: the curve at its distance from both sides crosses itself, as in \[Liu2005\] Fig. 6.

use fusion::blend::{Blended, Overlap, Params, Surface, blend};
use glam::{DVec2, DVec3};
use mesh_core::{Connected, Faces, TriMesh, VertexOrigin, Watch, shapes, validate};
use spine::{BlendCurve, Rail, roll};
use std::f64::consts::TAU;
use tri_intersect::{Operation, boolean, self_intersections_among};

const DEPTH: f64 = 0.25;
const RADIUS: f64 = 0.25;
const TOP: f64 = 0.3;

/// A post's outline, r = ½ + DEPTH · cos 2θ: its waist bends with a radius of a twelfth, a third of the ball's.
fn outline(angle: f64) -> DVec2 {
    (0.5 + DEPTH * (2.0 * angle).cos()) * DVec2::from_angle(angle)
}

/// The curve at the ball's distance from the outline.
fn offset(angle: f64) -> DVec2 {
    let tangent = (outline(angle + 1e-6) - outline(angle - 1e-6)).normalize();
    outline(angle) - RADIUS * tangent.perp()
}

/// Whether a closed polygon crosses itself.
fn crosses_itself(points: &[DVec2]) -> bool {
    let n = points.len();
    let side = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
    let cross = |i: usize, j: usize| {
        let [a, b, c, d] = [points[i], points[(i + 1) % n], points[j], points[(j + 1) % n]];
        side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
    };
    (0..n).any(|i| (i + 2..n).any(|j| (j + 1) % n != i && cross(i, j)))
}

/// The post standing through a plate, and its upper seam.
fn post_on_plate() -> (Connected<TriMesh>, BlendCurve) {
    let mut post = shapes::cylinder(1.0, 2.0, 192, 24);
    for p in &mut post.positions {
        let at = p.truncate();
        *p = (at.length() * outline(at.to_angle())).extend(p.z);
    }
    let plate = shapes::cuboid_grid(DVec3::new(3.0, 3.0, 2.0 * TOP), [15, 15, 3]);
    let [post, plate] = [post, plate].map(|m| Connected::new(m).unwrap());
    let made = boolean(&post, &plate, Operation::Union, &tri_intersect::Params::default(), &Watch::default()).unwrap();
    let upper = made.seams.iter().find(|s| made.mesh.positions[s.vertices[0].index()].z > 0.0).unwrap();
    let mesh = Connected::new(made.mesh).unwrap();
    let curve = BlendCurve::from_vertices(&mesh, &upper.vertices).unwrap();
    (mesh, curve)
}

fn blended(bridge: f64) -> Blended {
    let (mesh, curve) = post_on_plate();
    let params = Params { bridge, overlap: Overlap::Error, surface: Surface::Stitch, ..Params::new(RADIUS) };
    blend(&mesh, &[curve], &params, &Watch::default()).unwrap()
}

#[test]
fn where_the_offset_crosses_itself_the_spine_turns() {
    let raw: Vec<DVec2> = (0..720).map(|i| offset(f64::from(i) * TAU / 720.0)).collect();
    assert!(crosses_itself(&raw));
    let (mesh, curve) = post_on_plate();
    let rail: Rail = roll(&mesh, &curve, std::slice::from_ref(&curve), &spine::Params::new(RADIUS)).unwrap();
    let centers: Vec<DVec2> = rail.samples.iter().map(|s| s.center.truncate()).collect();
    assert!(!crosses_itself(&centers));
    let distance =
        |c: &DVec2| (0..2000).map(|i| outline(f64::from(i) * TAU / 2000.0).distance(*c)).fold(f64::INFINITY, f64::min);
    // Every ball touches the post and none cuts into it. Where it turns between both sides of the waist, balls are means.
    for c in &centers {
        let allowed = if c.x.abs() < 0.05 { 0.03 } else { 0.005 };
        assert!((distance(c) - RADIUS).abs() < allowed * RADIUS, "{c} {}", distance(c));
    }
    let waist = centers.iter().map(|c| c.x.abs()).fold(f64::INFINITY, f64::min);
    assert!(waist < 0.02);
    let on_axis = (0..400).map(|i| 0.5 * f64::from(i) / 400.0 + 0.25).find(|&y| distance(&DVec2::new(0.0, y)) > RADIUS);
    let deepest = centers.iter().filter(|c| c.x.abs() < 0.02).map(|c| c.y.abs()).fold(f64::INFINITY, f64::min);
    assert!((deepest - on_axis.unwrap()).abs() < 0.01, "{deepest} {on_axis:?}");
}

#[test]
fn its_blend_is_valid_with_the_full_ball() {
    let done = blended(3.0);
    assert!(validate(&done.mesh).is_closed());
    assert!(done.shrunk.is_empty() && done.full_share == 1.0);
    let new: Vec<_> = done.mesh.face_ids().filter(|&f| f >= done.first_blend_face).collect();
    assert!(self_intersections_among(&done.mesh, &new, &Watch::default()).unwrap().is_empty());
    // Profiles between the feet lie outside the solids: on the plate's side and off the post.
    for (p, o) in done.mesh.positions.iter().zip(done.origins.vertices.as_slice()) {
        if matches!(o, VertexOrigin::New { .. }) {
            assert!(p.z > TOP - 1e-9 && p.z < TOP + RADIUS + 1e-9);
        }
    }
}
