//! The parallel corner table and validator: the same for any thread count, and the same as a hash map finds.

use mesh_core::{
    Adjacency, Connected, Faces, TriMesh, VertexId, corner_normals, shapes, validate, vertex_normals, volume,
};
use std::collections::HashMap;

fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

/// Large enough to be cut into several tasks, in an order without locality.
fn shuffled_ball() -> TriMesh {
    let ball = shapes::icosphere(1.0, 6);
    let n = ball.positions.len();
    let order = |v: VertexId| VertexId::from(v.index() * 7919 % n);
    let mut positions = ball.positions.clone();
    (0..n).for_each(|v| positions[order(VertexId::from(v)).index()] = ball.positions[v]);
    let faces = (0..ball.faces.len()).map(|f| ball.faces[f * 7919 % ball.faces.len()].map(order)).collect();
    TriMesh { positions, faces }
}

#[test]
fn twins_are_those_of_a_hash_map() {
    let ball = shuffled_ball();
    let mesh = with_threads(3, || Connected::new(&ball).unwrap());
    let halfedges = || mesh.halfedge_ids();
    let by_ends: HashMap<_, _> = halfedges().map(|h| ((mesh.tail(h), mesh.head(h)), h)).collect();
    for h in halfedges() {
        assert_eq!(mesh.twin(h), by_ends.get(&(mesh.head(h), mesh.tail(h))).copied());
    }
}

#[test]
fn thread_count_does_not_show() {
    let mut mesh = shuffled_ball();
    let run = |mesh: &TriMesh, threads| {
        with_threads(threads, || {
            let connected = Connected::new(mesh).map(|c| {
                let starts: Vec<_> = c.vertex_ids().map(|v| c.outgoing(v)).collect();
                (starts, vertex_normals(&c), corner_normals(&c, 0.7), volume(&c).to_bits())
            });
            (connected, validate(mesh))
        })
    };
    let whole = run(&mesh, 1);
    assert!(whole.0.is_ok() && [2, 3, 7].iter().all(|&n| run(&mesh, n) == whole));
    // Defects of every kind all over the place: the lists must come out alike, complete and in order.
    for f in (0..mesh.faces.len()).step_by(97) {
        mesh.faces[f].swap(0, 1);
    }
    mesh.faces.extend_from_within(5000..5400);
    let broken = run(&mesh, 1);
    let defects = broken.0.as_ref().unwrap_err();
    assert_eq!(broken.1.duplicate_faces.len(), 400);
    assert_eq!(broken.1.misoriented_edges, defects.misoriented);
    assert_eq!(broken.1.non_manifold_edges, defects.edges);
    assert!(defects.edges.is_sorted() && defects.misoriented.len() > 2000);
    assert!([2, 3, 7].iter().all(|&n| run(&mesh, n) == broken));
}
