//! Compositions held against surfaces that are known.

use fusion::compose::{Error, Kernel, Params, compose};
use fusion::mesh_core::{Connected, TriMesh, VertexId, Watch, centroid, shapes, topology, validate};
use glam::{DQuat, DVec3};
use mesh_io::{Format, Model};

/// The faces whose centroid passes, and the vertices they use.
fn part(mesh: &TriMesh, keep: impl Fn(DVec3) -> bool) -> Model {
    let mut cut = TriMesh::default();
    let mut ids = vec![None; mesh.positions.len()];
    for f in &mesh.faces {
        if keep(centroid(f.map(|v| mesh.positions[v.index()]))) {
            cut.faces.push(f.map(|v| {
                *ids[v.index()].get_or_insert_with(|| {
                    cut.positions.push(mesh.positions[v.index()]);
                    VertexId::from(cut.positions.len() - 1)
                })
            }));
        }
    }
    Model::from(cut)
}

fn caps(levels: u32) -> Vec<Model> {
    let ball = shapes::icosphere(1.0, levels);
    let axes = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    axes.map(|a| part(&ball, |p| p.dot(a) > 0.8)).to_vec()
}

fn join(parts: &[Model], kernel: Kernel) -> Result<TriMesh, fusion::Error> {
    let params = Params { kernel, ..Params::new(Format::Obj) };
    compose(parts, &params, &Watch::default()).map(|outcome| outcome.model.mesh)
}

#[test]
fn six_caps_of_a_ball_rejoin_to_the_ball() {
    let mesh = join(&caps(4), Kernel::Triharmonic).unwrap();
    assert!(validate(&mesh).is_closed());
    let off = mesh.positions.iter().map(|p| (p.length() - 1.0).abs()).fold(0.0, f64::max);
    assert!(off < 1e-3, "{off}");
}

/// Tubes of one radius face each other: the surface between them is the tube, nearly, at any resolution.
#[test]
fn tubes_of_one_radius_join_to_the_tube() {
    for n in [24, 48, 96] {
        let tube = |z: f64| {
            Model::from(shapes::posed(shapes::open_cylinder(1.0, 1.0, n, n / 6), DQuat::IDENTITY, z * DVec3::Z))
        };
        // Only the rims that face each other.
        let parts = [tube(-0.8), tube(0.8)];
        let near = |model: &Model, low: bool| {
            let mesh = Connected::new(&model.mesh).unwrap();
            let loops = fusion::mesh_core::boundary_loops(&mesh);
            let z = |i: usize| model.mesh.triangle(loops[i][0].face())[0].z;
            usize::from((z(1) > z(0)) == low)
        };
        let loops = vec![(0, near(&parts[0], true)), (1, near(&parts[1], false))];
        let params = Params { kernel: Kernel::Hermite, loops: Some(loops), ..Params::new(Format::Obj) };
        let mesh = compose(&parts, &params, &Watch::default()).unwrap().model.mesh;
        let off = mesh.positions.iter().map(|p| (p.truncate().length() - 1.0).abs()).fold(0.0, f64::max);
        assert!(off < 5e-4, "{n}: {off}");
    }
}

/// One opening faces two, and one three.
#[test]
fn one_opening_joins_several() {
    for legs in [2, 3] {
        let cup = |turn: DQuat, at: DVec3, radius: f64, n: u32| {
            let ball = shapes::uv_sphere(radius, n, n / 2);
            let mut open = part(&ball, |p| p.z > 0.3 * radius);
            open.mesh = shapes::posed(open.mesh, turn, at);
            open
        };
        let mut parts = vec![cup(DQuat::IDENTITY, DVec3::Z, 1.0, 40)];
        for i in 0..legs {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(legs);
            let at = DVec3::new(1.1 * angle.cos(), 1.1 * angle.sin(), -1.0);
            parts.push(cup(DQuat::from_rotation_x(std::f64::consts::PI), at, 0.5, 32));
        }
        let mesh = join(&parts, Kernel::Triharmonic).unwrap();
        let counts = topology(&Connected::new(mesh).unwrap());
        assert_eq!((counts.components, counts.boundary_loops, counts.genus()), (1, 0, 0));
    }
}

#[test]
fn bad_poses_are_named() {
    let mut all = caps(3);
    all[2].mesh.faces.iter_mut().for_each(|f| f.swap(0, 1));
    assert!(matches!(join(&all, Kernel::Triharmonic), Err(fusion::Error::Compose(Error::InsideOut { part: 2, .. }))));
    let closed = [Model::from(shapes::icosphere(1.0, 2))];
    assert!(matches!(join(&closed, Kernel::Triharmonic), Err(fusion::Error::Compose(Error::Closed))));
    let pair = [caps(3)[0].clone(), caps(3)[0].clone()];
    assert!(matches!(join(&pair, Kernel::Triharmonic), Err(fusion::Error::Compose(Error::Overlap { .. }))));
}
