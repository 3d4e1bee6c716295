//! Edge clusters {n + m}: a tree of vertices, and the open edges and faces around it.

use crate::error::Error;
use crate::polyhedron::Polyhedron;
use glam::DVec3;

/// An edge cluster of a polyhedron (\[EdgeCluster2019\] §4.1).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cluster {
    /// Its n vertices, ascending.
    pub vertices: Vec<u32>,
    /// Its m open edges, counter-clockwise seen from outside, each as the halfedge that leaves the cluster. Side k of
    /// the patch lies in the face to the left of open edge k, between it and open edge k + 1.
    pub open: Vec<u32>,
    /// The backbone's vertices along each side, from the tail of open edge k to that of open edge k + 1.
    pub walks: Vec<Vec<u32>>,
}

impl Cluster {
    /// The cluster of some vertices. With four sides, the first and third are those along the longer backbone; with any
    /// other number it begins at the lowest halfedge.
    ///
    /// # Errors
    /// [`Error::NoCluster`] unless the edges between the vertices form a tree and three or more edges lead out of it.
    pub fn new(solid: &Polyhedron, vertices: &[u32]) -> Result<Self, Error> {
        let mut vertices = vertices.to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        let refuse = |why: &'static str| {
            let at = vertices.first().and_then(|&v| solid.positions.get(v as usize)).copied().unwrap_or(DVec3::ZERO);
            Err(Error::NoCluster { vertices: vertices.clone(), at, why })
        };
        if vertices.is_empty() || vertices.iter().any(|&v| solid.ring(v).next().is_none()) {
            return refuse("names a vertex that no edge of the polyhedron ends at");
        }
        let inside = |v: u32| vertices.binary_search(&v).is_ok();
        let leaving = || vertices.iter().flat_map(|&v| solid.ring(v));
        let is_open = |h: u32| !inside(solid.halfedges[h as usize].head);
        let backbone = leaving().filter(|&h| !is_open(h)).count() / 2;
        let count = leaving().filter(|&h| is_open(h)).count();
        let Some(first) = leaving().filter(|&h| is_open(h)).min() else { return refuse("has no open edge") };
        let (mut open, mut walks) = (vec![], vec![]);
        let mut h = first;
        loop {
            open.push(h);
            // Back along the face to the left, as long as it follows the backbone.
            let mut walk = vec![solid.halfedges[h as usize].tail];
            h = solid.halfedges[solid.halfedges[h as usize].prev as usize].twin;
            while !is_open(h) {
                h = solid.halfedges[solid.halfedges[solid.halfedges[h as usize].twin as usize].prev as usize].twin;
                walk.push(solid.halfedges[h as usize].tail);
                if walk.len() > 2 * vertices.len() {
                    return refuse("swallows a whole face: its vertices must hang together without a closed ring");
                }
            }
            walks.push(walk);
            if h == first || open.len() > count {
                break;
            }
        }
        if backbone + 1 != vertices.len() || open.len() != count {
            return refuse("is no tree: its vertices must hang together by edges, without a closed ring");
        }
        if count < 3 {
            return refuse("has fewer than three open edges");
        }
        let mut cluster = Self { vertices, open, walks };
        if count == 4 {
            let length = |k: usize| cluster.backbone_length(solid, k) + cluster.backbone_length(solid, k + 2);
            if length(0) < length(1) {
                cluster.open.rotate_left(1);
                cluster.walks.rotate_left(1);
            }
        }
        Ok(cluster)
    }

    /// How many sides: the m of {n + m}.
    pub fn sides(&self) -> usize {
        self.open.len()
    }

    /// Its name in the literature, such as `{2+6}`.
    pub fn name(&self) -> String {
        format!("{{{}+{}}}", self.vertices.len(), self.sides())
    }

    /// Whether the face of side k is reflex at the cluster: whether its boundary, followed with the face to the left,
    /// turns right altogether from open edge k + 1 over the backbone to open edge k.
    pub fn is_hollow(&self, solid: &Polyhedron, k: usize) -> bool {
        let normal = solid.plane(self.open[k]).normal;
        let walk = &self.walks[k];
        let mut before = -solid.vector(self.open[(k + 1) % self.sides()]);
        let backbone = walk.windows(2).rev().map(|w| solid.positions[w[0] as usize] - solid.positions[w[1] as usize]);
        let mut turn = 0.0;
        for after in backbone.chain([solid.vector(self.open[k])]) {
            turn += before.cross(after).dot(normal).atan2(before.dot(after));
            before = after;
        }
        turn < 0.0
    }

    /// Length of the backbone along side k, in model units.
    pub fn backbone_length(&self, solid: &Polyhedron, k: usize) -> f64 {
        let at = |v: u32| solid.positions[v as usize];
        self.walks[k].windows(2).map(|w| at(w[0]).distance(at(w[1]))).sum()
    }
}
