//! Corner normals, averaged up to creases.

use crate::params::Shading;
use glam::DVec3;
use mesh_core::TriMesh;
use rayon::prelude::*;

/// The unit normal at each corner of each face; zero where a face has none and no smooth neighbour either.
pub(crate) fn corner_normals(mesh: &TriMesh, shading: Shading) -> Vec<[DVec3; 3]> {
    let facets: Vec<DVec3> =
        mesh.faces.par_iter().map(|c| facet_normal(c.map(|v| mesh.positions[v.index()]))).collect();
    let Shading::Smooth { crease } = shading else {
        return facets.into_iter().map(|n| [n; 3]).collect();
    };
    let cosine = crease.clamp(0.0, 180.0).to_radians().cos();
    let fans = Fans::new(mesh);
    let smooth: Vec<Vec<DVec3>> = (0..mesh.positions.len())
        .into_par_iter()
        .with_min_len(256)
        .map(|v| fan_normals(mesh, &facets, fans.corners(v), cosine))
        .collect();
    let mut normals: Vec<[DVec3; 3]> = facets.into_iter().map(|n| [n; 3]).collect();
    for (v, averaged) in smooth.iter().enumerate() {
        for (&corner, n) in fans.corners(v).iter().zip(averaged) {
            normals[corner as usize / 3][corner as usize % 3] = *n;
        }
    }
    normals
}

fn facet_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

/// The corners (3·face + k) around each vertex.
pub(crate) struct Fans {
    starts: Vec<u32>,
    corners: Vec<u32>,
}

impl Fans {
    pub(crate) fn new(mesh: &TriMesh) -> Self {
        let mut starts = vec![0u32; mesh.positions.len() + 1];
        let vertices = || mesh.faces.iter().flatten().map(|v| v.index());
        vertices().for_each(|v| starts[v + 1] += 1);
        for v in 1..starts.len() {
            starts[v] += starts[v - 1];
        }
        let (mut next, mut corners) = (starts.clone(), vec![0; 3 * mesh.faces.len()]);
        for (corner, v) in vertices().enumerate() {
            corners[next[v] as usize] = corner as u32;
            next[v] += 1;
        }
        Self { starts, corners }
    }

    pub(crate) fn corners(&self, v: usize) -> &[u32] {
        &self.corners[self.starts[v] as usize..self.starts[v + 1] as usize]
    }
}

/// The normals of the corners around one vertex: groups of faces that hang together by smooth edges share one.
fn fan_normals(mesh: &TriMesh, facets: &[DVec3], corners: &[u32], cosine: f64) -> Vec<DVec3> {
    // Spokes of the fan, by their other end: two faces with a spoke in common are neighbours.
    let mut spokes: Vec<(u32, usize)> = corners
        .iter()
        .enumerate()
        .flat_map(|(i, &corner)| {
            let face = mesh.faces[corner as usize / 3];
            [1, 2].map(|k| (face[(corner as usize + k) % 3].0, i))
        })
        .collect();
    spokes.sort_unstable();
    let mut group: Vec<usize> = (0..corners.len()).collect();
    for pair in spokes.windows(2) {
        let [(p, i), (q, j)] = [pair[0], pair[1]];
        let (m, n) = (facets[corners[i] as usize / 3], facets[corners[j] as usize / 3]);
        if p == q && m.dot(n) >= cosine {
            let (i, j) = (root(&mut group, i), root(&mut group, j));
            group[i.max(j)] = i.min(j);
        }
    }
    let mut sums = vec![DVec3::ZERO; corners.len()];
    for (i, &corner) in corners.iter().enumerate() {
        let (face, k) = (mesh.faces[corner as usize / 3], corner as usize % 3);
        let [o, a, b] = [0, 1, 2].map(|s| mesh.positions[face[(k + s) % 3].index()]);
        let angle = (a - o).normalize_or_zero().dot((b - o).normalize_or_zero()).clamp(-1.0, 1.0).acos();
        sums[root(&mut group, i)] += angle * facets[corner as usize / 3];
    }
    (0..corners.len()).map(|i| sums[root(&mut group, i)].normalize_or(facets[corners[i] as usize / 3])).collect()
}

fn root(group: &mut [usize], mut i: usize) -> usize {
    while group[i] != i {
        group[i] = group[group[i]];
        i = group[i];
    }
    i
}
