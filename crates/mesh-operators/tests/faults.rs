//! One answer to each thing that goes wrong below every caller: a degenerate face, a zero cotangent, a disconnected submesh, a singular
//! system.

use glam::DVec3;
use mesh_core::{Connected, FaceId, Faces, TriMesh, VertexId, components, shapes};
use mesh_operators::{
    Cholesky, HeldSystem, Laplacian, LowerTriangle, NARROWEST, NotPositiveDefinite, Stop, Submesh, Unknowns,
    conjugate_gradients, cotangents, vertex_areas,
};

/// A square of four triangles around a vertex that lies on its lower side, so that one triangle has no area.
fn square_with_flat_face(at: DVec3) -> Connected<TriMesh> {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut positions: Vec<DVec3> = corners.iter().map(|c| DVec3::new(c[0], c[1], 0.0)).collect();
    positions.push(at);
    let faces = (0..4).map(|i| [i, (i + 1) % 4, 4].map(VertexId)).collect();
    Connected::new(TriMesh { positions, faces }).unwrap()
}

/// A face without area counts as [`NARROWEST`] wide: its weights are large and finite, the limit of those of ever thinner ones, and the
/// system that holds it is solved to working precision.
#[test]
fn a_degenerate_face_counts_as_a_thin_one() {
    let flat = square_with_flat_face(DVec3::new(0.3, 0.0, 0.0));
    let cot = cotangents(&flat);
    let of_face = [0, 1, 2].map(|k| cot.as_slice()[k]);
    assert!(of_face.iter().all(|c| c.is_finite() && c.abs() < 1.01 / NARROWEST), "{of_face:?}");
    let thin = square_with_flat_face(DVec3::new(0.3, 1e-9, 0.0));
    let near = cotangents(&thin);
    assert!((0..3).all(|k| (near.as_slice()[k] - of_face[k]).abs() < 1e-3 * of_face[k].abs()));
    for laplacian in [Laplacian::cotangent(&flat), Laplacian::mean_value(&flat)] {
        assert!((0..5).all(|v| laplacian.row(v).all(|(_, w)| w.is_finite())));
        // Harmonic between the corners: linear, whichever the weights.
        let system = HeldSystem::new(Unknowns::new(5, |v| v == 4), |v, row| laplacian.add_row(v, 1.0, row)).unwrap();
        let mut x: Vec<DVec3> = flat.mesh().positions.clone();
        x[4] = DVec3::ZERO;
        system.solve(&mut x, &[], 2);
        assert!(x[4].distance(flat.mesh().positions[4]) < 1e-3, "{}", x[4]);
    }
    // Where all corners coincide there is nothing to weigh.
    let mut point = flat.mesh().clone();
    point.positions.fill(DVec3::ONE);
    let point = Connected::new(point).unwrap();
    assert!(cotangents(&point).as_slice().iter().all(|&c| c == 0.0));
    assert!(vertex_areas(&point).as_slice().iter().all(|&a| a == 0.0));
}

/// Right angles facing an edge give it no weight; its ends are then related through their other neighbours alone.
#[test]
fn a_zero_cotangent_is_a_weight_like_any_other() {
    let grid = Connected::new(shapes::grid(1.0, 1.0, 4, 4)).unwrap();
    let laplacian = Laplacian::cotangent(&grid);
    let zeros = (0..25).flat_map(|v| laplacian.neighbours(v)).filter(|e| e.1.abs() < 1e-15).count();
    assert_eq!(zeros, 2 * 16, "each cell's diagonal, seen from both ends");
    let rim = |v: usize| grid.mesh().positions[v].abs().max_element() > 0.49;
    let system = HeldSystem::new(Unknowns::new(25, |v| !rim(v)), |v, row| laplacian.add_row(v, 1.0, row)).unwrap();
    let mut x: Vec<DVec3> = (0..25).map(|v| if rim(v) { grid.mesh().positions[v] } else { DVec3::ZERO }).collect();
    system.solve(&mut x, &[], 1);
    assert!(x.iter().zip(&grid.mesh().positions).all(|(a, b)| a.distance(*b) < 1e-14));
}

/// Pieces come out side by side, each vertex once, in the order of the mesh, and every id leads back.
#[test]
fn a_disconnected_submesh_keeps_its_pieces() {
    let ball = Connected::new(shapes::icosphere(1.0, 2)).unwrap();
    // The faces around a vertex, and those around the one opposite.
    let place = |v: VertexId| ball.mesh().positions[v.index()];
    let poles = ball.vertex_ids().filter(|&v| v.0 == 0 || place(v).distance(-place(VertexId(0))) < 1e-9);
    let poles: Vec<VertexId> = poles.collect();
    let part = Submesh::new(&ball, |f: FaceId| ball.corners(f).iter().any(|v| poles.contains(v)));
    assert!(part.vertices.is_sorted() && part.faces.is_sorted());
    for (face, &f) in part.mesh.faces.iter().zip(&part.faces) {
        assert_eq!(face.map(|v| part.vertices[v.index()]), ball.corners(f));
    }
    for (i, &v) in part.vertices.iter().enumerate() {
        assert_eq!(
            (part.local(v), part.mesh.positions[i]),
            (Some(VertexId::from(i)), ball.mesh().positions[v.index()])
        );
    }
    assert_eq!(part.local(VertexId(u32::MAX)), None);
    let pieces = components(&Connected::new(part.mesh.clone()).unwrap());
    assert_eq!(pieces.len(), 2);
    // One piece held, the other free as a whole: no system, and a vertex of the free piece named.
    let own = Connected::new(part.mesh).unwrap();
    let laplacian = Laplacian::cotangent(&own);
    let upper = |v: usize| own.mesh().positions[v].dot(place(VertexId(0))) > 0.0;
    let loose = |v: usize| upper(v) != upper(0);
    let refused = HeldSystem::new(Unknowns::new(own.vertex_count(), loose), |v, row| laplacian.add_row(v, 1.0, row));
    assert!(loose(refused.unwrap_err().unknown));
}

/// A matrix that has no inverse is an error that names an unknown; conjugate gradients stop where they are.
#[test]
fn a_singular_system_is_refused() {
    let mut lower = LowerTriangle::default();
    lower.column(&[(0, 1.0), (1, 1.0)]);
    lower.column(&[(1, 1.0)]);
    assert!(Cholesky::new(&lower).unwrap_err().unknown < 2);
    let mut unsorted = LowerTriangle::default();
    unsorted.column(&[(0, 1.0), (7, 1.0)]);
    assert_eq!(Cholesky::new(&unsorted).unwrap_err(), NotPositiveDefinite { unknown: 0 });
    let apply = |x: &[f64]| vec![x[0] + x[1], x[0] + x[1]];
    let mut x = vec![0.0; 2];
    let stop = Stop { share: 1e-12, steps: 50 };
    // With a solution, one of the many is found; without, the numbers stay finite and the residual says so.
    conjugate_gradients(apply, &[1.0; 2], &[1.0, 1.0], &mut x, stop);
    assert!((x[0] + x[1] - 1.0).abs() < 1e-12);
    let found = conjugate_gradients(apply, &[1.0; 2], &[1.0, -1.0], &mut x, stop);
    assert!(x.iter().all(|x| x.is_finite()) && found.share > 0.5, "{found:?}");
}
