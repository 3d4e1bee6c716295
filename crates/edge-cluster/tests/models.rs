//! Polyhedra blended whole: closed, oriented, manifold, every part where it belongs.

use edge_cluster::{
    Blend, CoverParams, Degree, Move, Params, Part, Place, Polyhedron, PolyhedronParams, Spec, StripParams, Turn,
    blend, contact_slopes, cover, solids,
};
use glam::{DVec2, DVec3};
use mesh_core::{Connected, Faces, Watch, dihedral_angle, validate};

fn specs(clusters: &[Vec<u32>]) -> Vec<Spec> {
    clusters.iter().map(|v| Spec { vertices: v.clone(), ..Spec::default() }).collect()
}

fn read(model: &solids::Solid) -> Polyhedron {
    let (mesh, of) = model.triangles();
    Polyhedron::new(&mesh, Some(&of), &PolyhedronParams::default()).unwrap()
}

fn check(name: &str, solid: &Polyhedron, blended: &Blend) {
    let woven = &blended.woven;
    let report = validate(&woven.mesh);
    assert!(report.is_closed() && report.is_clean(), "{name}: {report}");
    for (face, part) in woven.mesh.faces.iter().zip(&woven.parts) {
        if let Part::Face(f) = *part {
            // Planar faces are in their planes and turn the right way.
            let [a, b, c] = face.map(|v| woven.mesh.positions[v.index()]);
            let plane = solid.faces[f as usize].plane;
            assert!([a, b, c].iter().all(|p| plane.height(*p).abs() < 1e-13 * solid.size), "{name}");
            assert!((b - a).cross(c - a).dot(plane.normal) > 0.0, "{name}");
        }
    }
    for (p, place) in woven.mesh.positions.iter().zip(&woven.places) {
        if let Place::Vertex(v) = *place {
            assert_eq!(*p, solid.positions[v as usize]);
        }
    }
    for (net, patch) in blended.layout.nets.iter().zip(&blended.layout.patches) {
        assert!(net.residual() < 1e-13 * solid.size, "{name}: {}", net.residual());
        let slopes = contact_slopes(net, patch);
        assert!(slopes.iter().all(|s| *s > net.continuity as f64 + 0.95), "{name}: {slopes:?}");
    }
}

#[test]
fn the_papers_models_are_watertight() {
    for (name, model) in [
        ("meter", solids::pressure_meter()),
        ("vase", solids::vase()),
        ("pot", solids::flower_pot()),
        ("knob", solids::door_knob()),
    ] {
        let solid = read(&model);
        let params = Params::default();
        let blended =
            blend(&solid, &specs(&model.clusters), &params, 1e-3 * solid.size, 1.0, &Watch::default()).unwrap();
        check(name, &solid, &blended);
        assert!(blended.woven.parts.iter().any(|p| matches!(p, Part::Strip(_))), "{name}");
    }
}

#[test]
fn regular_solids_are_covered_and_watertight() {
    for (name, model) in solids::regular() {
        let solid = read(&model);
        let found = cover(&solid, &CoverParams::default());
        let params = Params::default();
        let blended =
            blend(&solid, &specs(&found.clusters), &params, 5e-3 * solid.size, 1.0, &Watch::default()).unwrap();
        check(name, &solid, &blended);
        // Nothing of the polyhedron stays sharp.
        assert!(blended.woven.places.iter().all(|p| !matches!(p, Place::Vertex(_) | Place::Edge(_))), "{name}");
    }
}

#[test]
fn convex_concave_solids_are_covered_and_watertight() {
    for seed in 0..10 {
        let solid = read(&solids::convex_concave(seed));
        assert!(solid.vertices().any(|v| solid.turn(v) != Turn::Convex), "{seed}");
        let found = cover(&solid, &CoverParams::default());
        let blended =
            blend(&solid, &specs(&found.clusters), &Params::default(), 2e-3 * solid.size, 1.0, &Watch::default())
                .unwrap();
        check(&format!("concave {seed}"), &solid, &blended);
        assert!(blended.woven.places.iter().all(|p| !matches!(p, Place::Vertex(_) | Place::Edge(_))), "{seed}");
        // No sheet folds back over its neighbour, as blends beside reflex corners of faces are prone to.
        let mesh = Connected::new(blended.woven.mesh).unwrap();
        let turns = mesh.halfedge_ids().filter_map(|h| dihedral_angle(&mesh, h));
        let worst = turns.map(f64::abs).fold(0.0, f64::max);
        assert!(worst < 2.2, "{seed}: {worst}");
    }
}

/// Every strip leaves both patches with their own tangent planes and curvatures, and the faces with theirs.
#[test]
fn strips_have_contact_of_their_order() {
    for (order, continuity) in [(1, 1), (2, 2), (3, 1)] {
        let model = solids::flower_pot();
        let solid = read(&model);
        let strip = StripParams { order, balance: 0.4, ..StripParams::default() };
        let params = Params { continuity, strip, ..Params::default() };
        let made = blend(&solid, &specs(&model.clusters), &params, 1e-2 * solid.size, 1.0, &Watch::default()).unwrap();
        let patches = &made.layout.patches;
        for strip in &made.layout.strips {
            for s in [0.1, 0.5, 0.8] {
                // The strip parts from x1 as t^{h+1}, and from x2 likewise.
                for end in [0, 1] {
                    let gap = |t: f64| {
                        let t = if end == 0 { t } else { 1.0 - t };
                        let own = patches[strip.ends[end].0].point(strip.domain(patches, s, t)[end]);
                        strip.point(patches, s, t).distance(own)
                    };
                    let slope = (gap(0.02) / gap(0.01)).log2();
                    assert!(slope > order as f64 + 0.9, "{order} {end}: {slope}");
                }
            }
            let half = solid.halfedges[made.layout.clusters[strip.ends[0].0].open[strip.ends[0].1] as usize];
            for (left, face) in [(0, solid.halfedges[half.twin as usize].face), (1, half.face)] {
                let plane = solid.faces[face as usize].plane;
                for t in [0.0, 0.3, 0.5, 0.9] {
                    assert!(plane.height(strip.side(patches, left, t)).abs() < 1e-14 * solid.size);
                    let side = if left == 0 { 0.0 } else { 1.0 };
                    assert!(strip.point(patches, side, t).distance(strip.side(patches, left, t)) < 1e-14 * solid.size);
                    let height = |d: f64| plane.height(strip.point(patches, (side - d).abs(), t)).abs();
                    let slope = (height(1e-3) / height(5e-4)).log2();
                    assert!(slope > continuity as f64 + 0.9, "{continuity}: {slope}");
                }
            }
        }
    }
}

/// Fig. 14: moving b_{2,0} and b_{2,2} away from the backbone flattens more of the faces into the blend; moving b_{0,0}
/// and b_{0,2} lengthens the foot. Contact survives both, and moves out of the face are cut to the face.
#[test]
fn moved_control_points_change_the_shape_and_keep_contact() {
    let model = solids::pressure_meter();
    let solid = read(&model);
    let made = |moves: &[Move]| {
        let degree = Some(Degree::Tensor(4, 2));
        let spec = |v: &Vec<u32>| Spec { vertices: v.clone(), degree, extent: Some(0.3), ..Spec::default() };
        let mut specs: Vec<Spec> = model.clusters.iter().map(spec).collect();
        specs[0].moves = moves.to_vec();
        let params = Params { all_sharp: true, ..Params::default() };
        let made = blend(&solid, &specs, &params, 1e-3 * solid.size, 1.0, &Watch::default()).unwrap();
        check("moved", &solid, &made);
        made
    };
    let plain = made(&[]);
    let (net, patch) = (&plain.layout.nets[0], &plain.layout.patches[0]);
    let backbone = net.points[net.shape.number(&[2, 1]).unwrap()];
    let away = |index: [u8; 2]| {
        let d = net.points[net.shape.number(&index).unwrap()] - backbone;
        Move { index: index.to_vec(), by: 0.4 * d + 0.2 * DVec3::ONE }
    };
    let wide = made(&[away([2, 0]), away([2, 2])]);
    let middle = DVec2::splat(0.5);
    let distance = |p: &edge_cluster::Patch| p.point(middle).distance(backbone);
    assert!(distance(&wide.layout.patches[0]) > 1.02 * distance(patch), "the blend is larger");
    let along = |index: [u8; 2], corner: usize| {
        let h = plain.layout.clusters[0].open[corner];
        Move { index: index.to_vec(), by: 0.15 * solid.vector(h) }
    };
    let long = made(&[along([0, 0], 0), along([0, 2], 3)]);
    for (corner, index) in [(0, [0, 0]), (3, [0, 2])] {
        let h = plain.layout.clusters[0].open[corner];
        let tail = solid.positions[solid.halfedges[h as usize].tail as usize];
        let reach = |b: &Blend| b.layout.nets[0].points[b.layout.nets[0].shape.number(&index).unwrap()].distance(tail);
        assert!(reach(&long) > reach(&plain) + 0.14 * solid.length(h));
    }
}

/// Chords are no farther from the surface than asked for.
#[test]
fn chords_stay_within_tolerance() {
    let model = solids::flower_pot();
    let solid = read(&model);
    for share in [1e-3, 1e-4] {
        let tolerance = share * solid.size;
        let made =
            blend(&solid, &specs(&model.clusters), &Params::default(), tolerance, 1.0, &Watch::default()).unwrap();
        // A dense sample of each surface is the truth; its distance to the mesh is bounded by that to the nearest triangle.
        let mut worst: f64 = 0.0;
        for (p, patch) in made.layout.patches.iter().enumerate().take(1) {
            let woven = &made.woven;
            let faces: Vec<_> = (0..woven.parts.len())
                .filter(|&f| woven.parts[f] == Part::Patch(p as u32))
                .map(|f| woven.mesh.faces[f].map(|v| woven.mesh.positions[v.index()]))
                .collect();
            for i in 0..400 {
                let at = DVec2::from_angle(2.4 * f64::from(i)) * (0.55 * (f64::from(i) / 400.0).sqrt());
                let q = patch.point(at);
                worst = worst.max(faces.iter().map(|t| to_triangle(q, *t)).fold(f64::INFINITY, f64::min));
            }
        }
        assert!(worst < 1.2 * tolerance && worst > 0.1 * tolerance, "{worst} {tolerance}");
    }
}

fn to_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let n = (b - a).cross(c - a).normalize();
    let inside = [(a, b), (b, c), (c, a)].iter().all(|(s, e)| (*e - *s).cross(p - *s).dot(n) >= 0.0);
    let segment = |s: DVec3, e: DVec3| {
        let t = ((p - s).dot(e - s) / (e - s).length_squared()).clamp(0.0, 1.0);
        p.distance(s + t * (e - s))
    };
    if inside { (p - a).dot(n).abs() } else { segment(a, b).min(segment(b, c)).min(segment(c, a)) }
}
