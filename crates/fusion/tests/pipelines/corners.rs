//! Open curves: corners, stops and run-outs, against solids whose rounding is known.

use fusion::blend::{Blended, Method, Overlap, Params, blend, max_radius};
use fusion::features::{self, feature_curves};
use fusion::{Choice, round};
use glam::{DMat3, DQuat, DVec3};
use mesh_core::{Connected, Faces, Positions, TriMesh, VertexId, VertexOrigin, Watch, shapes, volume};
use mesh_io::{Format, Model};
use spine::BlendCurve;
use std::f64::consts::PI;
use tri_intersect::Operation;

fn curves(mesh: &Connected<TriMesh>) -> Vec<BlendCurve> {
    let found = feature_curves(mesh, &features::Params::default());
    found.into_iter().map(|c| BlendCurve { halfedges: c.halfedges, closed: c.closed }).collect()
}

fn rounded(mesh: &Connected<TriMesh>, curves: &[BlendCurve], params: &Params) -> Blended {
    let params = Params { overlap: Overlap::Error, ..params.clone() };
    let done = blend(mesh, curves, &params, &Watch::default()).unwrap_or_else(|e| panic!("{e}"));
    let found = tri_intersect::self_intersections(&done.mesh, &Watch::default()).unwrap();
    assert!(found.is_empty(), "{found:?}");
    let connected = Connected::new(&done.mesh).unwrap();
    assert!(mesh_core::boundary_loops(&connected).is_empty());
    done
}

/// Signed distance of a point to the cuboid of half sides `half` rounded with radius `r`, centred on the origin.
fn from_rounded_box(p: DVec3, half: DVec3, r: f64) -> f64 {
    let q = p.abs() - (half - DVec3::splat(r));
    q.max(DVec3::ZERO).length() + q.max_element().min(0.0) - r
}

#[test]
fn a_cube_with_all_its_edges_blended_is_the_rounded_cube() {
    let mesh = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
    for r in [0.02, 0.1, 0.3] {
        let done = rounded(&mesh, &curves(&mesh), &Params::new(r));
        assert_eq!((done.strips, done.corners), (12, 8));
        let worst =
            done.mesh.positions.iter().map(|&p| from_rounded_box(p, DVec3::splat(0.5), r).abs()).fold(0.0, f64::max);
        assert!(worst <= 1e-9, "{worst} off with radius {r}");
    }
    // Volume: faces, edges and corners put together.
    let (r, fine) = (0.1, Params { tolerance: 1e-3, ..Params::new(0.1) });
    let inner: f64 = 1.0 - 2.0 * r;
    let exact = inner.powi(3) + 6.0 * inner * inner * r + 3.0 * inner * PI * r * r + 4.0 / 3.0 * PI * r.powi(3);
    let off = (volume(&rounded(&mesh, &curves(&mesh), &fine).mesh) - exact).abs() / exact;
    assert!(off < 1e-3, "{off}");
}

#[test]
fn the_largest_radius_of_a_cube_is_half_its_side() {
    let mesh = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
    let limit = max_radius(&mesh, &curves(&mesh), &Params::new(1.0), &Watch::default()).unwrap();
    assert!(limit.radius > 0.49 && limit.radius <= 0.5 && limit.at.is_some(), "{limit:?}");
    let fits = |r: f64| {
        let params = Params { overlap: Overlap::Error, ..Params::new(r) };
        blend(&mesh, &curves(&mesh), &params, &Watch::default()).is_ok()
    };
    assert!(fits(0.99 * limit.radius) && !fits(1.02 * limit.radius));
}

/// Four edges around a face, and no fifth: one closed curve, not four that stop at each other.
#[test]
fn edges_that_meet_in_pairs_are_one_curve() {
    let cube = Model::from(shapes::cuboid(DVec3::ONE));
    let params = round::Params {
        features: features::Params::default(),
        choice: Choice {
            near: [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y]
                .map(|side| (0.5 * (side + DVec3::Z)).into())
                .to_vec(),
            ..Choice::default()
        },
        blend: Params { overlap: Overlap::Error, ..Params::new(0.1) },
        format: Format::Ply,
    };
    let figures = round::round(&cube, &params, &Watch::default()).unwrap().report.figures;
    assert_eq!(["curves", "strips", "corners"].map(|f| figures[f]), [4.0, 1.0, 0.0]);
}

#[test]
fn one_edge_stops_in_the_faces_at_its_ends() {
    let mesh = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
    let r = 0.2;
    let done = rounded(&mesh, &curves(&mesh)[..1], &Params { tolerance: 1e-4, ..Params::new(r) });
    let exact = 1.0 - (1.0 - PI / 4.0) * r * r;
    let got = volume(&done.mesh);
    // Inscribed chords take up to two thirds of their sagitta off along the arc.
    assert!(got <= exact + 1e-12 && got > exact - r * 1e-4 * 0.5 * PI * r, "{got} {exact}");
    assert!(done.mesh.positions.iter().all(|p| p.abs().max_element() <= 0.5 + 1e-12));
}

/// Two convex edges and a concave one meet in the inner corners.
#[test]
fn an_l_bracket_has_fair_mixed_corners() {
    let outline = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
    let positions = [0.0, 1.0].iter().flat_map(|&z| outline.map(|(x, y)| DVec3::new(x, y, z))).collect();
    let mut faces: Vec<[u32; 3]> = (0..6)
        .flat_map(|i| {
            let j = (i + 1) % 6;
            [[i, j, 6 + j], [i, 6 + j, 6 + i]]
        })
        .collect();
    for [a, b, c] in [[0, 1, 2], [0, 2, 3], [0, 3, 5], [3, 4, 5]] {
        faces.extend([[a, c, b], [6 + a, 6 + b, 6 + c]]);
    }
    let mesh = TriMesh { positions, faces: faces.into_iter().map(|f| f.map(VertexId)).collect() };
    let mesh = Connected::new(mesh).unwrap();
    let r = 0.15;
    let done = rounded(&mesh, &curves(&mesh), &Params::new(r));
    assert_eq!((done.strips, done.corners), (18, 12));
    let inside = |p: &DVec3| p.min_element() > -1e-9 && p.x < 2.0 + 1e-9 && p.y < 2.0 + 1e-9 && p.z < 1.0 + 1e-9;
    assert!(done.mesh.positions.iter().all(inside));
    // Tangent all around: no edge turns by more than the chords of the arcs and of the mixed patches do.
    let connected = Connected::new(&done.mesh).unwrap();
    let sharpest = connected
        .halfedge_ids()
        .filter_map(|h| mesh_core::dihedral_angle(&connected, h))
        .fold(0.0, |a: f64, b| a.max(b.abs()));
    assert!(sharpest.to_degrees() < 30.0, "{}", sharpest.to_degrees());
}

#[test]
fn half_a_rim_runs_out_at_both_ends() {
    let mesh = Connected::new(shapes::cylinder(1.0, 2.0, 64, 16)).unwrap();
    let rim = curves(&mesh).remove(0);
    let half = BlendCurve { halfedges: rim.halfedges[..32].to_vec(), closed: false };
    let done = rounded(&mesh, std::slice::from_ref(&half), &Params::new(0.1));
    assert_eq!((done.strips, done.corners, done.run_outs.len()), (1, 0, 2));
    // What is farther than three radii from the curve keeps its bits.
    let near = |p: DVec3| half.points(&mesh).iter().any(|q| q.distance(p) < 0.3);
    let kept: std::collections::HashSet<_> = done
        .origins
        .vertices
        .as_slice()
        .iter()
        .filter_map(|o| match o {
            VertexOrigin::Input { vertex, .. } => Some(*vertex),
            _ => None,
        })
        .collect();
    assert!(mesh.vertex_ids().all(|v| near(mesh.position(v)) || kept.contains(&v)));
}

/// A block with a step in its top whose height falls to nothing at (½, 0, 1): there a valley and a ridge part at 18 degrees.
fn tapering_step() -> TriMesh {
    let tip = DVec3::new(0.5, 0.0, 1.0);
    let positions = vec![
        tip,
        DVec3::new(0.0, -1.0, 0.0),
        DVec3::new(2.0, -1.0, 0.0),
        DVec3::new(2.0, 1.0, 0.0),
        DVec3::new(0.0, 1.0, 0.0),
        DVec3::new(0.0, -1.0, 1.0),
        DVec3::new(2.0, -1.0, 1.0),
        DVec3::new(2.0, 0.0, 1.0),
        DVec3::new(2.0, 0.0, 1.5),
        DVec3::new(2.0, 1.0, 1.5),
        DVec3::new(0.5, 1.0, 1.0),
        DVec3::new(0.0, 1.0, 1.0),
    ];
    let polygons: [&[u32]; 8] = [
        &[0, 10, 11, 5, 6, 7],
        &[0, 8, 9, 10],
        &[0, 7, 8],
        &[7, 6, 2, 3, 9, 8],
        &[10, 9, 3, 4, 11],
        &[1, 2, 6, 5],
        &[4, 1, 5, 11],
        &[1, 4, 3, 2],
    ];
    let fan = |p: &&[u32]| (1..p.len() - 1).map(|k| [p[0], p[k], p[k + 1]].map(VertexId)).collect::<Vec<_>>();
    TriMesh { positions, faces: polygons.iter().flat_map(fan).collect() }
}

/// Both linkages on the wall of such a step have to stay within its height, so both balls dwindle long before its end.
#[test]
fn a_step_that_tapers_off_is_rounded_to_its_tip() {
    let mesh = Connected::new(tapering_step()).unwrap();
    let all = curves(&mesh);
    for r in [0.01, 0.02, 0.05] {
        let done = rounded(&mesh, &all, &Params::new(r));
        let connected = Connected::new(&done.mesh).unwrap();
        // Far from the tip the valley has its full radius: no kept vertex or face is near its edge there.
        let middle = DVec3::new(1.6, 0.0, 1.0);
        let nearest = done.mesh.positions.iter().map(|p| p.distance(middle)).fold(f64::INFINITY, f64::min);
        assert!(nearest > 0.4 * r, "{nearest} with {r}");
        assert!(connected.face_count() > mesh.face_count());
    }
}

/// No piece of such a curve is left whole by the cuts.
#[test]
fn a_curve_of_one_edge_runs_out_at_both_ends() {
    let ball = Connected::new(shapes::uv_sphere(1.0, 24, 12)).unwrap();
    let equator = |v: VertexId| ball.position(v).z.abs() < 1e-9;
    let mut all = ball.halfedge_ids();
    let edge = all.find(|&h| equator(ball.tail(h)) && equator(ball.head(h))).unwrap();
    let curve = BlendCurve { halfedges: vec![edge], closed: false };
    for r in [0.002, 0.02] {
        let done = rounded(&ball, std::slice::from_ref(&curve), &Params::new(r));
        assert_eq!(done.strips, 1);
    }
}

/// A unit cube whose top is a fan of needles from one corner, the first of which leave an edge at a small angle.
fn fanned_cube() -> TriMesh {
    let corner = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) - 0.5;
    let mut positions: Vec<DVec3> = [0.0, 1.0]
        .into_iter()
        .flat_map(|z| [corner(0.0, 0.0, z), corner(1.0, 0.0, z), corner(1.0, 1.0, z), corner(0.0, 1.0, z)])
        .collect();
    let first = positions.len() as u32;
    positions.extend((1..20).map(|k| corner(1.0, 0.02 * f64::from(k), 1.0)));
    let last = positions.len() as u32;
    let top: Vec<u32> = [4, 5].into_iter().chain(first..last).chain([6, 7]).collect();
    let right: Vec<u32> = [1, 2, 6].into_iter().chain((first..last).rev()).chain([5]).collect();
    let polygons: [&[u32]; 6] = [&[3, 2, 1, 0], &[0, 1, 5, 4], &right, &[2, 3, 7, 6], &[3, 0, 4, 7], &top];
    let fan = |p: &&[u32]| (1..p.len() - 1).map(|k| [p[0], p[k], p[k + 1]].map(VertexId)).collect::<Vec<_>>();
    TriMesh { positions, faces: polygons.iter().flat_map(fan).collect() }
}

/// Base patches left needles out that touch the curve in one corner only, and the ball leaned over their edge.
#[test]
fn needles_beside_an_edge_are_rolled_on() {
    let mesh = Connected::new(fanned_cube()).unwrap();
    for r in [0.002, 0.01, 0.1] {
        let done = rounded(&mesh, &curves(&mesh), &Params::new(r));
        let off = |&p: &DVec3| from_rounded_box(p, DVec3::splat(0.5), r).abs();
        let worst = done.mesh.positions.iter().map(off).fold(0.0, f64::max);
        assert!(worst <= 1e-9, "{worst} off with radius {r}");
    }
}

/// A plate as thick as the ball: its rim is consumed whole, and the corners of top and bottom meet.
#[test]
fn a_plate_as_thick_as_the_ball_has_a_round_rim() {
    let size = DVec3::new(1.0, 0.8, 0.2);
    let mesh = Connected::new(shapes::cuboid(size)).unwrap();
    let r = 0.1;
    let done = blend(&mesh, &curves(&mesh), &Params::new(r), &Watch::default()).unwrap_or_else(|e| panic!("{e}"));
    assert!(tri_intersect::self_intersections(&done.mesh, &Watch::default()).unwrap().is_empty());
    let off = done.mesh.positions.iter().map(|&p| from_rounded_box(p, 0.5 * size, r).abs()).fold(0.0, f64::max);
    assert!(off < 1e-3 * r && done.curves.iter().all(|c| c.radius == r), "{off} {:?}", done.curves);
}

/// A box with a hole through its end faces: both ends of a rounded edge stop at faces whose triangles all lead to the hole.
#[test]
fn an_edge_stops_cleanly_at_faces_with_holes() {
    let drill = shapes::cylinder(4.0, 20.0, 32, 1);
    let plate = Connected::new(shapes::cuboid(DVec3::new(40.0, 20.0, 6.0))).unwrap();
    let drill = Connected::new(drill).unwrap();
    let how = tri_intersect::Params::default();
    let cut = tri_intersect::boolean(&plate, &drill, tri_intersect::Operation::Difference, &how, &Watch::default());
    let mesh = Connected::new(cut.unwrap().mesh).unwrap();
    let upright = |c: &BlendCurve| {
        let [a, b] = mesh.ends(c.halfedges[0]);
        !c.closed && a.x < -19.0 && a.y > 9.0 && (a - b).normalize().z.abs() > 0.9
    };
    let chosen: Vec<BlendCurve> = curves(&mesh).into_iter().filter(upright).collect();
    assert_eq!(chosen.len(), 1);
    let done = rounded(&mesh, &chosen, &Params { tolerance: 1e-4, ..Params::new(1.0) });
    let connected = Connected::new(&done.mesh).unwrap();
    let sharpest = connected
        .halfedge_ids()
        .filter_map(|h| mesh_core::dihedral_angle(&connected, h))
        .map(f64::abs)
        .fold(0.0, f64::max);
    assert!(sharpest.to_degrees() < 91.0, "{}", sharpest.to_degrees());
    // What a quarter of a cylinder takes from the box' edge, to the chords' accuracy.
    let taken = volume(&mesh) - volume(&done.mesh);
    let exact = 6.0 * (1.0 - 0.25 * PI);
    assert!((taken / exact - 1.0).abs() < 3e-3, "{taken} beside {exact}");
}

/// An open network with corners closer together than their ball needs: nothing is refused, and what is left sharp is told.
#[test]
fn what_cannot_be_rounded_stays_sharp_and_is_told() {
    let mesh = Connected::new(shapes::cuboid(DVec3::new(1.0, 1.0, 0.12))).unwrap();
    let all = curves(&mesh);
    let done = blend(&mesh, &all, &Params::new(0.2), &Watch::default());
    let done = done.unwrap_or_else(|e| panic!("{e}"));
    assert!(tri_intersect::self_intersections(&done.mesh, &Watch::default()).unwrap().is_empty());
    assert_eq!(done.curves.len(), all.len());
    assert!(done.curves.iter().all(|c| c.left_sharp.is_some() == (c.method == Method::Sharp)));
    let Err(refusal) = blend(&mesh, &all, &Params { overlap: Overlap::Error, ..Params::new(0.2) }, &Watch::default())
    else {
        panic!("a ball of 0.2 does not fit into a plate of 0.12")
    };
    assert!(refusal.to_string().contains("works"), "{refusal}");
}

/// A plate less hexagonal prisms, one after the other: every edge has vertices along it, where the faces that each left behind met the next.
fn plate_with_hexagonal_holes() -> Connected<TriMesh> {
    let mut plate = Connected::new(shapes::cuboid(DVec3::new(6.0, 4.0, 0.6))).unwrap();
    for at in [[0.6, 0.4], [-0.7, 0.4], [-0.7, -0.8]] {
        let mut prism = shapes::cylinder(0.4, 0.8, 6, 1);
        for p in &mut prism.positions {
            *p = DMat3::from_rotation_z(0.1) * *p + DVec3::new(at[0], at[1], 0.0);
        }
        let params = tri_intersect::Params::default();
        let prism = Connected::new(prism).unwrap();
        let made = tri_intersect::boolean(&plate, &prism, Operation::Difference, &params, &Watch::default()).unwrap();
        plate = Connected::new(made.mesh).unwrap();
    }
    plate
}

/// At each corner of a hole two ridges meet a valley, whose balls are on the other side of the surface.
#[test]
fn ridges_and_valleys_of_holes_are_swept() {
    let mesh = plate_with_hexagonal_holes();
    let done = rounded(&mesh, &curves(&mesh), &Params::new(0.036));
    // Eight corners of the plate and twelve of each hole, between as many edges and half as many again.
    assert_eq!((done.strips, done.corners), (12 + 3 * 18, 8 + 3 * 12));
}

/// Beyond half its side no ball rolls within a cube.
#[test]
fn where_no_ball_fits_a_smaller_one_is_told() {
    let mesh = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
    for r in [0.51, 0.6, 0.75] {
        let done = blend(&mesh, &curves(&mesh), &Params::new(r), &Watch::default()).unwrap();
        assert!(volume(&done.mesh) < 0.99, "nothing is blended with radius {r}");
        assert!(done.shrunk.iter().any(|s| s.1 < 0.5) && done.full_share == 0.0, "radius {r}: {:?}", done.shrunk);
    }
}

fn difference(mesh: &Connected<TriMesh>, tool: TriMesh) -> Connected<TriMesh> {
    let (tool, params) = (Connected::new(tool).unwrap(), tri_intersect::Params::default());
    let made = tri_intersect::boolean(mesh, &tool, Operation::Difference, &params, &Watch::default());
    Connected::new(made.unwrap().mesh).unwrap()
}

/// A hole that leaves a wall a little thinner than the ball: the wall stays, and the smaller ball or the sharp edge is told.
#[test]
fn a_wall_thinner_than_the_ball_is_not_cut_away() {
    let plate = Connected::new(shapes::cuboid(DVec3::new(30.0, 14.0, 5.0))).unwrap();
    let mesh = difference(&plate, shapes::cylinder(5.0, 20.0, 48, 1));
    let done = blend(&mesh, &curves(&mesh), &Params::new(1.06), &Watch::default()).unwrap();
    assert!(tri_intersect::self_intersections(&done.mesh, &Watch::default()).unwrap().is_empty());
    assert!(!done.shrunk.is_empty() || done.curves.iter().any(|c| c.left_sharp.is_some()));
    assert!(done.curves.iter().filter(|c| c.radius > 0.0).count() > 6, "{:?}", done.curves);
    let tree = mesh_query::TriBvh::build(&done.mesh).unwrap();
    for x in [-1.0, -0.5, -0.1, 0.0, 0.3, 0.7] {
        let from = DVec3::new(x, 10.0, 0.0);
        let outside = tree.ray_cast(&done.mesh, from, -DVec3::Y, 20.0).unwrap().t;
        let inside = tree.ray_cast(&done.mesh, from - (outside + 1e-6) * DVec3::Y, -DVec3::Y, 20.0).unwrap().t;
        assert!(inside > 1.95, "the wall is {inside} thick at {x}");
    }
}

/// A slot in a shaft: its valleys end at facets of the shaft, which go on up to the ball.
#[test]
fn valleys_end_flush_with_a_faceted_cylinder() {
    let shaft = Connected::new(shapes::cylinder(5.0, 60.0, 48, 1)).unwrap();
    let slot = shapes::posed(shapes::cuboid(DVec3::new(3.0, 7.0, 11.0)), DQuat::IDENTITY, DVec3::new(0.0, 6.5, 0.0));
    let mesh = difference(&shaft, slot);
    let done = blend(&mesh, &curves(&mesh), &Params::new(0.96), &Watch::default()).unwrap();
    assert!(tri_intersect::self_intersections(&done.mesh, &Watch::default()).unwrap().is_empty());
    assert!(done.curves.iter().all(|c| c.radius == 0.96 && c.left_sharp.is_none()), "{:?}", done.curves);
    let connected = Connected::new(&done.mesh).unwrap();
    let turn = connected.halfedge_ids().filter_map(|h| mesh_core::dihedral_angle(&connected, h));
    let sharpest = turn.map(f64::abs).fold(0.0, f64::max).to_degrees();
    assert!(sharpest < 40.0, "{sharpest}");
}
