//! Models blended whole: closed, oriented, manifold, everything in its plane.

use edge_cluster::{Params, Part, Polyhedron, PolyhedronParams, Spec, blend, solids};
use mesh_core::{Watch, validate};

fn specs(clusters: &[Vec<u32>]) -> Vec<Spec> {
    clusters.iter().map(|v| Spec { vertices: v.clone(), ..Spec::default() }).collect()
}

fn models() -> Vec<(&'static str, solids::Solid)> {
    vec![
        ("meter", solids::pressure_meter()),
        ("vase", solids::vase()),
        ("pot", solids::flower_pot()),
        ("knob", solids::door_knob()),
    ]
}

#[test]
fn the_papers_models_are_watertight() {
    for (name, model) in models() {
        let (mesh, of) = model.triangles();
        let solid = Polyhedron::new(&mesh, Some(&of), &PolyhedronParams::default()).unwrap();
        let blended =
            blend(&solid, &specs(&model.clusters), &Params::default(), 1e-3 * solid.size, 1.0, &Watch::default())
                .unwrap();
        let report = validate(&blended.woven.mesh);
        assert!(report.is_closed() && report.is_clean(), "{name}: {report}");
        assert!(blended.woven.parts.iter().any(|p| matches!(p, Part::Strip(_))), "{name}");
    }
}
