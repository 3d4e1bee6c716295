//! Blends that keep connectivity: against the torus, against themselves, and where they must refuse.

use fusion::blend::keep::{self, Refusal};
use fusion::blend::{Blended, Error, Params, Surface, blend};
use fusion::{Profile, profile_from_text};
use glam::{DMat3, DQuat, DVec3};
use mesh_core::{Connected, Faces, Origins, TriMesh, VertexOrigin, Watch, shapes, volume};
use param_conformal::Seam;
use spine::BlendCurve;
use tri_intersect::{Operation, boolean};

type Mesh = Connected<TriMesh>;

/// Two unit balls joined, their centres `2 · HALF` apart along z.
const HALF: f64 = 0.6;
const RADIUS: f64 = 0.3;

fn joined(a: TriMesh, b: TriMesh) -> (Mesh, Vec<BlendCurve>) {
    let [a, b] = [a, b].map(|m| Connected::new(m).unwrap());
    let both = boolean(&a, &b, Operation::Union, &tri_intersect::Params::default(), &Watch::default()).unwrap();
    let mesh = Connected::new(both.mesh).unwrap();
    let curves = both.seams.iter().map(|s| BlendCurve::from_vertices(&mesh, &s.vertices).unwrap()).collect();
    (mesh, curves)
}

fn balls(n: u32) -> (Mesh, Vec<BlendCurve>) {
    let tilted = |z: f64, angle: f64| {
        shapes::posed(
            shapes::geodesic_sphere(1.0, n),
            DQuat::from_axis_angle(DVec3::new(0.6, 0.64, 0.48), angle),
            DVec3::Z * z,
        )
    };
    joined(tilted(-HALF, 0.3), tilted(HALF, 1.1))
}

fn kept(params: &Params) -> Params {
    Params { surface: Surface::Keep(keep::Params::default()), ..params.clone() }
}

fn run(mesh: &Mesh, curves: &[BlendCurve], params: &Params) -> Result<Blended, Error> {
    blend(mesh, curves, &kept(params), &Watch::default())
}

fn refusal(mesh: &Mesh, curves: &[BlendCurve], params: &Params) -> Refusal {
    match run(mesh, curves, params) {
        Err(Error::Keep(refusal)) => refusal,
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("blended"),
    }
}

fn is_new(origins: &Origins, v: mesh_core::VertexId) -> bool {
    matches!(origins.vertices[v], VertexOrigin::New { .. })
}

/// The ball between two balls rolls on a circle; the error falls as the square of the edge length.
#[test]
fn moved_vertices_lie_on_the_torus() {
    let ring = ((1.0 + RADIUS) * (1.0 + RADIUS) - HALF * HALF).sqrt();
    let error = |n: u32| {
        let (mesh, curves) = balls(n);
        // The surface itself is ruled between profiles: it must not be what is measured.
        let params = Params { tolerance: 1e-4, ..Params::new(RADIUS) };
        let done = run(&mesh, &curves, &params).unwrap();
        assert_eq!(done.mesh.faces, mesh.mesh().faces);
        assert!(done.residual <= 1e-9);
        let moved: Vec<_> = mesh.vertex_ids().filter(|&v| is_new(&done.origins, v)).collect();
        assert!(moved.len() > 3 * n as usize);
        for v in mesh.vertex_ids().filter(|&v| !is_new(&done.origins, v)) {
            assert_eq!(done.mesh.positions[v.index()], mesh.mesh().positions[v.index()]);
        }
        assert!(volume(&done.mesh) > volume(mesh.mesh()));
        let off = |p: DVec3| {
            let out = DVec3::new(p.x, p.y, 0.0).normalize();
            (p.distance(ring * out) - RADIUS).abs()
        };
        moved.iter().map(|v| off(done.mesh.positions[v.index()])).fold(0.0, f64::max)
    };
    let errors = [12, 24, 48].map(error);
    assert!(errors[0] < 0.05 * RADIUS && errors[0] / errors[2] > 9.0, "{errors:?}");
}

#[test]
fn the_published_seam_works_too() {
    let (mesh, curves) = balls(16);
    let how = keep::Params { seam: Seam::Straight, ..keep::Params::default() };
    let params = Params { surface: Surface::Keep(how), ..Params::new(RADIUS) };
    let done = blend(&mesh, &curves, &params, &Watch::default()).unwrap();
    assert_eq!(done.mesh.faces, mesh.mesh().faces);
}

/// Every profile moves the same vertices, and stays on the side of the apex it should.
#[test]
fn profiles_stand_out_as_they_should() {
    let (mesh, curves) = balls(24);
    let wave = profile_from_text(
        "degree = 3\npoints = [[1, 0], [0.7, 0], [0.5, 0.3], [0.15, 0.15], [0.3, 0.5], [0, 0.7], [0, 1]]",
    );
    let waist = |profile: Profile| {
        let done = run(&mesh, &curves, &Params { profile, ..Params::new(RADIUS) }).unwrap();
        volume(&done.mesh)
    };
    let sharper: Vec<f64> =
        [Profile::Chamfer, Profile::Arc, Profile::Conic(2.0), Profile::Conic(5.0)].map(waist).to_vec();
    assert!(sharper.windows(2).all(|w| w[1] < w[0]), "{sharper:?}");
    assert!(waist(wave.unwrap()) > 0.0);
    // A pulled-out apex cuts deeper still.
    let reach = Params { profile: Profile::Conic(2.0), reach: Some(2.4), ..Params::new(RADIUS) };
    assert!(volume(&run(&mesh, &curves, &reach).unwrap().mesh) < sharper[2]);
}

/// Moving and scaling commute with blending, up to rounding.
#[test]
fn motions_commute() {
    let (mesh, curves) = balls(12);
    let turn = DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(0.36, 0.48, 0.8), 0.9));
    let place = |p: DVec3| 3.0 * (turn * p) + DVec3::new(5.0, -2.0, 1.0);
    let there = TriMesh { positions: mesh.mesh().positions.iter().map(|&p| place(p)).collect(), ..mesh.mesh().clone() };
    let there = Connected::new(there).unwrap();
    let [one, two] = [(&mesh, RADIUS), (&there, 3.0 * RADIUS)].map(|(m, r)| run(m, &curves, &Params::new(r)).unwrap());
    let apart = one.mesh.positions.iter().zip(&two.mesh.positions).map(|(&p, &q)| place(p).distance(q));
    assert!(apart.fold(0.0, f64::max) < 1e-6);
}

#[test]
fn threads_do_not_change_bits() {
    let (mesh, curves) = balls(16);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run(&mesh, &curves, &Params::new(RADIUS)).unwrap().mesh)
    };
    assert_eq!(on(1), on(4));
}

#[test]
fn what_cannot_be_served_is_named() {
    // A cube of twelve triangles has no vertices to slide.
    let cube = Connected::new(shapes::cuboid(DVec3::ONE)).unwrap();
    let rim = BlendCurve::from_vertices(&cube, &[4, 5, 7, 6].map(mesh_core::VertexId)).unwrap();
    let coarse = refusal(&cube, &[rim], &Params::new(0.1));
    assert!(
        matches!(
            coarse,
            Refusal::NotARing { .. } | Refusal::Sheared { .. } | Refusal::Pinched { .. } | Refusal::Border { .. }
        ),
        "{coarse}"
    );
    // A hole beside the curve.
    let (mesh, curves) = balls(16);
    let mut torn = mesh.mesh().clone();
    let near = |c: &[mesh_core::VertexId; 3]| {
        c.iter().all(|&v| {
            let p = torn.positions[v.index()];
            p.x > 0.0 && p.y.abs() < 0.15 && p.z.abs() > 0.06 && p.z.abs() < 0.2
        })
    };
    let keep_face: Vec<bool> = torn.faces.iter().map(|c| !near(c)).collect();
    let mut it = keep_face.iter();
    torn.faces.retain(|_| *it.next().unwrap());
    let torn = Connected::new(torn).unwrap();
    let cycle: Vec<_> = curves[0].halfedges.iter().map(|&h| mesh.tail(h)).collect();
    if let Ok(curve) = BlendCurve::from_vertices(&torn, &cycle) {
        assert!(matches!(
            run(&torn, &[curve], &Params::new(RADIUS)),
            Err(Error::Keep(Refusal::Boundary { .. }) | Error::Spine(_))
        ));
    }
}
