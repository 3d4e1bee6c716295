//! Boxes and subdivided spheres.

use crate::ids::VertexId;
use crate::mesh::TriMesh;
use glam::DVec3;
use std::collections::HashMap;

/// A box of the given edge lengths, centred on the origin: 8 vertices, 12 triangles.
pub fn cuboid(size: DVec3) -> TriMesh {
    let corner = |i: u32| (DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) - 0.5) * size;
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    TriMesh::from_arrays((0..8).map(corner).collect(), quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]))
}

/// A sphere around the origin: an icosahedron whose triangles are split in four `levels` times, vertices on the
/// sphere. `20·4^levels` triangles.
pub fn icosphere(radius: f64, levels: u32) -> TriMesh {
    let g = 0.5 * (1.0 + 5.0f64.sqrt());
    let mut points: Vec<DVec3> = [
        [-1.0, g, 0.0],
        [1.0, g, 0.0],
        [-1.0, -g, 0.0],
        [1.0, -g, 0.0],
        [0.0, -1.0, g],
        [0.0, 1.0, g],
        [0.0, -1.0, -g],
        [0.0, 1.0, -g],
        [g, 0.0, -1.0],
        [g, 0.0, 1.0],
        [-g, 0.0, -1.0],
        [-g, 0.0, 1.0],
    ]
    .map(|p| DVec3::from(p).normalize())
    .to_vec();
    let mut faces: Vec<[u32; 3]> = vec![
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    for _ in 0..levels {
        let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                points.push((points[a as usize] + points[b as usize]).normalize());
                points.len() as u32 - 1
            })
        };
        faces = faces
            .iter()
            .flat_map(|&[a, b, c]| {
                let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    TriMesh {
        positions: points.into_iter().map(|p| radius * p).collect(),
        faces: faces.into_iter().map(|c| c.map(VertexId)).collect(),
    }
}

/// A sphere around the origin: each triangle of an icosahedron in `n²`, vertices pushed out to the sphere. `20·n²`
/// triangles, for sizes between those of [`icosphere`].
pub fn geodesic_sphere(radius: f64, n: u32) -> TriMesh {
    let n = n.max(1);
    let base = icosphere(1.0, 0);
    let mut mesh = TriMesh::default();
    // A vertex is known by the corners it is made of and their shares, so that neighbours find it again.
    let mut ids: HashMap<[(u32, u32); 3], VertexId> = HashMap::new();
    let mut at = |mesh: &mut TriMesh, mut shares: [(u32, u32); 3]| {
        for share in shares.iter_mut().filter(|s| s.1 == 0) {
            share.0 = 0;
        }
        shares.sort_unstable();
        *ids.entry(shares).or_insert_with(|| {
            let p: DVec3 = shares.iter().map(|&(c, w)| f64::from(w) * base.positions[c as usize]).sum();
            mesh.positions.push(radius * p.normalize());
            VertexId::from(mesh.positions.len() - 1)
        })
    };
    for corners in &base.faces {
        let [a, b, c] = corners.map(|v| v.0);
        for i in 0..n {
            for j in 0..n - i {
                let mut point = |i: u32, j: u32| at(&mut mesh, [(a, n - i - j), (b, i), (c, j)]);
                let [p, q, r] = [point(i, j), point(i + 1, j), point(i, j + 1)];
                let s = (i + j + 1 < n).then(|| point(i + 1, j + 1));
                mesh.faces.push([p, q, r]);
                mesh.faces.extend(s.map(|s| [q, s, r]));
            }
        }
    }
    mesh
}
