//! Cuts along picked paths.

use fusion::Error as Failed;
use fusion::cut::{Error, Keep, Params, PathCut, cut};
use fusion::mesh_core::{
    Connected, TriMesh, VertexId, VertexOrigin, Watch, area, boundary_loops, shapes, validate, volume,
};
use glam::DVec3;
use mesh_io::{Format, Model};
use std::collections::HashMap;

/// A ball drawn out along z with a waist at z = 0, where its radius is 0.35.
fn peanut(levels: u32) -> TriMesh {
    let mut mesh = shapes::icosphere(1.0, levels);
    for p in &mut mesh.positions {
        let s = 0.35 + 0.65 * p.z * p.z;
        *p = DVec3::new(s * p.x, s * p.y, 2.0 * p.z);
    }
    mesh
}

fn run(mesh: &TriMesh, path: &PathCut) -> Result<fusion::Outcome, Failed> {
    cut(&Model::from(mesh.clone()), &Params::new(vec![path.clone()], Format::Off), &Watch::default())
}

/// Three places round the z axis at height `z` and distance `r`.
fn round(r: f64, z: f64) -> Vec<DVec3> {
    [0.1f64, 2.3, 4.2].map(|a| DVec3::new(r * a.cos(), r * a.sin(), z)).to_vec()
}

fn rim(mesh: &TriMesh) -> Vec<DVec3> {
    let connected = Connected::new(mesh).unwrap();
    let loops = boundary_loops(&connected);
    assert_eq!(loops.len(), 1);
    loops[0].iter().map(|h| mesh.triangle(h.face())[h.corner()]).collect()
}

/// Both halves by their coordinates as one mesh.
fn welded(halves: [&TriMesh; 2]) -> TriMesh {
    let (mut ids, mut whole) = (HashMap::new(), TriMesh::default());
    for half in halves {
        for f in &half.faces {
            whole.faces.push(f.map(|v| {
                let p = half.positions[v.index()];
                *ids.entry(p.to_array().map(f64::to_bits)).or_insert_with(|| {
                    whole.positions.push(p);
                    VertexId::from(whole.positions.len() - 1)
                })
            }));
        }
    }
    whole
}

#[test]
fn halves_keep_their_bits_and_weld_back() {
    let mesh = peanut(4);
    for (picks, smooth) in
        [(round(0.4, 0.1), 0), (round(0.5, -0.6), 0), (round(0.4, 0.2)[..2].to_vec(), 0), (round(0.5, 0.7), 8)]
    {
        let path = PathCut { smooth, ..PathCut::new(picks) };
        let large = run(&mesh, &path).unwrap();
        let small = run(&mesh, &PathCut { keep: Keep::Smaller, ..path.clone() }).unwrap();
        let (a, b) = (&large.model.mesh, &small.model.mesh);
        assert!(area(a) >= area(b));
        for half in [&large, &small] {
            let mut kept = 0;
            for (p, origin) in half.model.mesh.positions.iter().zip(half.origins.vertices.as_slice()) {
                if let VertexOrigin::Input { vertex, .. } = origin {
                    assert_eq!(
                        p.to_array().map(f64::to_bits),
                        mesh.positions[vertex.index()].to_array().map(f64::to_bits)
                    );
                    kept += 1;
                }
            }
            assert!(kept > 100);
            rim(&half.model.mesh);
        }
        let whole = welded([a, b]);
        assert!(validate(&whole).is_closed());
        assert!((area(&whole) - area(&mesh)).abs() < 1e-12 && (volume(&whole) - volume(&mesh)).abs() < 1e-12);
    }
}

/// Picked beside the waist, the path runs along it: cheaper than the geodesic through the same picks, which stays beside it.
#[test]
fn creases_attract() {
    let mesh = peanut(5);
    let height = |crease: f64| {
        let made = run(&mesh, &PathCut { crease, snap: 0.0, ..PathCut::new(round(0.42, 0.3)) }).unwrap();
        let figures = &made.report.figures;
        assert!(figures["path_cost"] <= figures["geodesic_cost"], "{figures:?}");
        let rim = rim(&made.model.mesh);
        rim.iter().map(|p| p.z.abs()).sum::<f64>() / rim.len() as f64
    };
    let [plain, drawn] = [0.0, 8.0].map(height);
    assert!(drawn < 0.85 * plain, "{plain} {drawn}");
}

/// Without creases the path is a geodesic: on a cylinder, three picks at one height make a circle.
#[test]
fn a_path_round_a_cylinder_is_a_circle() {
    let mesh = shapes::open_cylinder(1.0, 4.0, 48, 31);
    let middle = mesh.positions.iter().sum::<DVec3>() / mesh.positions.len() as f64;
    let picks: Vec<DVec3> = round(1.0, 0.03).iter().map(|p| p + middle).collect();
    let rim = rim_of_larger(&mesh, picks);
    let length: f64 = (0..rim.len()).map(|i| rim[i].distance(rim[(i + 1) % rim.len()])).sum();
    assert!((length / std::f64::consts::TAU - 1.0).abs() < 0.01, "{length}");
}

/// The rim that the cut made, of a mesh that has two of its own.
fn rim_of_larger(mesh: &TriMesh, picks: Vec<DVec3>) -> Vec<DVec3> {
    let z = picks[0].z;
    let made = run(mesh, &PathCut { snap: 0.0, ..PathCut::new(picks) }).unwrap().model.mesh;
    let connected = Connected::new(&made).unwrap();
    let walks = boundary_loops(&connected);
    let places = walks.iter().map(|w| w.iter().map(|h| made.triangle(h.face())[h.corner()]).collect::<Vec<_>>());
    places.min_by(|a, b| (a[0].z - z).abs().total_cmp(&(b[0].z - z).abs())).unwrap()
}

#[test]
fn picks_of_no_use_are_refused() {
    let mesh = peanut(3);
    let error = |picks: Vec<DVec3>| run(&mesh, &PathCut::new(picks)).unwrap_err();
    for picks in [vec![], vec![DVec3::X], vec![DVec3::X, DVec3::X], vec![DVec3::NAN, DVec3::X]] {
        assert!(matches!(error(picks), Failed::Cut(Error::Pick { .. })));
    }
    let torus = shapes::torus(1.0, 0.4, 32, 16);
    let across = vec![DVec3::new(0.6, 0.0, 0.0), DVec3::new(1.0, 0.0, 0.4), DVec3::new(1.0, 0.0, -0.4)];
    let leak = run(&torus, &PathCut { crease: 0.0, ..PathCut::new(across) }).unwrap_err();
    assert!(matches!(leak, Failed::Cut(Error::DoesNotSeparate { .. })), "{leak}");
}
