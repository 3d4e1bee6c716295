//! Polyhedra blended whole: closed, oriented, manifold, every part where it belongs.

use edge_cluster::{
    Blend, CoverParams, Params, Part, Place, Polyhedron, PolyhedronParams, Spec, blend, contact_slopes, cover, solids,
};
use mesh_core::{Watch, validate};

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
        assert!(slopes.iter().all(|s| *s > 1.95), "{name}: {slopes:?}");
    }
    if let Ok(folder) = std::env::var("DUMP") {
        let mut text = String::new();
        for p in &blended.woven.mesh.positions {
            text += &format!("v {:?} {:?} {:?}\n", p.x, p.y, p.z);
        }
        for f in &blended.woven.mesh.faces {
            text += &format!("f {} {} {}\n", f[0].0 + 1, f[1].0 + 1, f[2].0 + 1);
        }
        std::fs::write(format!("{folder}/{}.obj", name.replace(' ', "_")), text).unwrap();
        eprintln!(
            "{name} {} shrink {:?}",
            blended.woven.mesh.faces.len(),
            blended.shrink.iter().copied().fold(1.0, f64::min)
        );
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
