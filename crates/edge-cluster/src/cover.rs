//! Clusters chosen automatically: every vertex in one, short edges inside, as symmetric as the polyhedron.

use crate::cluster::Cluster;
use crate::polyhedron::Polyhedron;
use crate::symmetry::symmetries;

/// What an automatic cover may do.
#[derive(Clone, Copy, Debug)]
pub struct Params {
    /// Edges shorter than this share of the mean of the edges next to them have no room for two blends, and go inside
    /// one cluster.
    pub short: f64,
    /// Two vertices become one cluster if the edge between them is shorter than this share of the cluster's mean open
    /// edge. A longer backbone would distort the patch; 0 blends every vertex by itself.
    pub distortion: f64,
}

impl Default for Params {
    fn default() -> Self {
        Self { short: 0.2, distortion: 0.999 }
    }
}

/// A cover of all vertices by clusters.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cover {
    /// The vertices of each cluster, ascending, in order of the lowest.
    pub clusters: Vec<Vec<u32>>,
    /// Why these, as sentences.
    pub reasons: Vec<String>,
}

/// Covers every vertex. Whole orbits of edges under the polyhedron's symmetries are taken or left, so that the cover is
/// as symmetric as the polyhedron: first edges too short for two blends, then edges that pair vertices, those with the
/// shortest backbone first; what remains is blended vertex by vertex.
pub fn cover(solid: &Polyhedron, params: &Params) -> Cover {
    let group = symmetries(solid);
    let orbits = edge_orbits(solid, &group);
    let mut cover = Cover::default();
    let mut cluster_of: Vec<u32> = (0..solid.positions.len() as u32).collect();
    let count = solid.vertices().count();
    cover.reasons.push(match group.len() {
        1 => format!("the polyhedron has {count} vertices and no symmetry"),
        order => format!("the polyhedron has {count} vertices and {order} symmetries, which the clusters share"),
    });
    let short: Vec<u32> = orbits.iter().filter(|o| crowding(solid, o[0]) < params.short).flatten().copied().collect();
    let merged = contracted(solid, &short);
    if !short.is_empty() && all_are_clusters(solid, &merged) {
        cover.reasons.push(format!("{} edges are too short for two blends and lie inside clusters", short.len()));
        cluster_of = merged;
    }
    let mut size = vec![0u32; cluster_of.len()];
    for &c in &cluster_of {
        size[c as usize] += 1;
    }
    let mut candidates: Vec<(f64, &Vec<u32>)> =
        orbits.iter().filter_map(|o| Some((distortion(solid, o[0])?, o))).filter(|c| c.0 < params.distortion).collect();
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (ratio, orbit) in candidates {
        let ends = |h: &u32| [solid.halfedges[*h as usize].tail, solid.halfedges[*h as usize].head];
        let mut all: Vec<u32> = orbit.iter().flat_map(ends).collect();
        all.sort_unstable();
        let alone = |&v: &u32| size[cluster_of[v as usize] as usize] == 1;
        if !all.iter().all(alone) || all.windows(2).any(|w| w[0] == w[1]) {
            continue;
        }
        for [a, b] in orbit.iter().map(ends) {
            cluster_of[a.max(b) as usize] = a.min(b);
            size[a.min(b) as usize] = 2;
        }
        let [a, b] = ends(&orbit[0]);
        cover.reasons.push(format!(
            "{} pairs of vertices like {a}-{b} share a patch: the edge between them is {ratio:.2} of their mean open edge",
            orbit.len()
        ));
    }
    let single = solid.vertices().filter(|&v| size[cluster_of[v as usize] as usize] == 1).count();
    if single > 0 {
        cover.reasons.push(format!("{single} vertices have a patch each"));
    }
    cover.clusters = members(solid, &cluster_of);
    cover
}

/// An edge's length over the mean of those that share a vertex with it.
fn crowding(solid: &Polyhedron, h: u32) -> f64 {
    let half = solid.halfedges[h as usize];
    let (mut sum, mut count) = (0.0, 0.0);
    for other in solid.ring(half.tail).chain(solid.ring(half.head)).filter(|&o| o != h && o != half.twin) {
        sum += solid.length(other);
        count += 1.0;
    }
    solid.length(h) * count / sum
}

/// Backbone over mean open edge of the cluster of an edge's two ends; `None` if they are no cluster.
fn distortion(solid: &Polyhedron, h: u32) -> Option<f64> {
    let half = solid.halfedges[h as usize];
    let cluster = Cluster::new(solid, &[half.tail, half.head]).ok()?;
    let open: f64 = cluster.open.iter().map(|&h| solid.length(h)).sum();
    Some(solid.length(h) * cluster.sides() as f64 / open)
}

/// Edges grouped by symmetry, each by its lower halfedge, in order of the lowest.
fn edge_orbits(solid: &Polyhedron, group: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let mut orbits: Vec<Vec<u32>> = vec![];
    let mut seen = vec![false; solid.halfedges.len()];
    for h in 0..solid.halfedges.len() as u32 {
        if seen[h as usize] || solid.halfedges[h as usize].twin < h {
            continue;
        }
        let half = solid.halfedges[h as usize];
        let images = group.iter().filter_map(|map| solid.halfedge(map[half.tail as usize], map[half.head as usize]));
        let mut orbit: Vec<u32> = images.map(|g| g.min(solid.halfedges[g as usize].twin)).collect();
        orbit.sort_unstable();
        orbit.dedup();
        for &g in &orbit {
            seen[g as usize] = true;
        }
        orbits.push(orbit);
    }
    orbits
}

/// The clusters if some edges go inside, each by its lowest vertex.
fn contracted(solid: &Polyhedron, edges: &[u32]) -> Vec<u32> {
    let mut parent: Vec<u32> = (0..solid.positions.len() as u32).collect();
    let root = |parent: &[u32], mut v: u32| {
        while parent[v as usize] != v {
            v = parent[v as usize];
        }
        v
    };
    for &h in edges {
        let half = solid.halfedges[h as usize];
        let (a, b) = (root(&parent, half.tail), root(&parent, half.head));
        parent[a.max(b) as usize] = a.min(b);
    }
    (0..parent.len() as u32).map(|v| root(&parent, v)).collect()
}

fn members(solid: &Polyhedron, cluster_of: &[u32]) -> Vec<Vec<u32>> {
    let mut all: Vec<Vec<u32>> = vec![vec![]; cluster_of.len()];
    solid.vertices().for_each(|v| all[cluster_of[v as usize] as usize].push(v));
    all.retain(|c| !c.is_empty());
    all
}

fn all_are_clusters(solid: &Polyhedron, cluster_of: &[u32]) -> bool {
    members(solid, cluster_of).iter().all(|c| Cluster::new(solid, c).is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PolyhedronParams, solids};
    use glam::DVec3;

    fn of(mesh: &mesh_core::TriMesh) -> Cover {
        cover(&Polyhedron::new(mesh, None, &PolyhedronParams::default()).unwrap(), &Params::default())
    }

    /// A slab's corners pair up along its short edges, a cube's stay alone; every vertex is covered once.
    #[test]
    fn short_backbones_pair_vertices() {
        let slab = of(&mesh_core::shapes::cuboid(DVec3::new(3.0, 2.0, 0.5)));
        assert_eq!(slab.clusters.len(), 4);
        assert!(slab.clusters.iter().all(|c| c.len() == 2));
        let cube = of(&mesh_core::shapes::cuboid(DVec3::ONE));
        assert_eq!(cube.clusters.len(), 8);
        assert!(cube.reasons.iter().any(|r| r.contains("48 symmetries")), "{:?}", cube.reasons);
    }

    #[test]
    fn covers_are_as_symmetric_as_the_solid() {
        for (name, solid) in
            solids::regular().into_iter().chain([("pot", solids::flower_pot()), ("knob", solids::door_knob())])
        {
            let (mesh, polygon) = solid.triangles();
            let solid = Polyhedron::new(&mesh, Some(&polygon), &PolyhedronParams::default()).unwrap();
            let found = cover(&solid, &Params::default());
            let mut all = found.clusters.concat();
            all.sort_unstable();
            assert!(all.iter().copied().eq(solid.vertices()), "{name}");
            for map in symmetries(&solid) {
                for cluster in &found.clusters {
                    let mut image: Vec<u32> = cluster.iter().map(|&v| map[v as usize]).collect();
                    image.sort_unstable();
                    assert!(found.clusters.contains(&image), "{name}");
                }
            }
        }
    }
}
