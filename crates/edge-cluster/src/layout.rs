//! From clusters to patches and strips: how far each blend reaches along each edge.

use crate::cluster::Cluster;
use crate::control::Shape;
use crate::error::Error;
use crate::hartmann::{self, Strip};
use crate::net::{self, Move, Net};
use crate::patch::Patch;
use crate::polyhedron::Polyhedron;
use glam::DVec3;
use rayon::prelude::*;

/// One cluster as asked for. `None` takes the value of [`Params`].
#[derive(Clone, Debug, Default)]
pub struct Spec {
    /// Its vertices.
    pub vertices: Vec<u32>,
    /// Degree n of its S-patch, or (n1, n2) of its tensor-product patch if it has four sides.
    pub degree: Option<Degree>,
    /// See [`Params::extent`].
    pub extent: Option<f64>,
    /// See [`Params::bulge`].
    pub bulge: Option<f64>,
    /// Control points moved by hand.
    pub moves: Vec<Move>,
}

/// A degree as it is asked for, before the number of sides is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Degree {
    /// n for S-patches, (n, n) for tensor-product patches.
    Same(usize),
    /// (n1, n2) for tensor-product patches; S-patches keep the default.
    Tensor(usize, usize),
}

/// How clusters are blended.
#[derive(Clone, Debug)]
pub struct Params {
    /// Order of contact with the faces, g ≥ 1.
    pub continuity: usize,
    /// The degree; `None` for 2g + 1, which suits every cluster.
    pub degree: Option<Degree>,
    /// How far patches reach along their open edges, as a share of the edge, in (0, 1]. An edge that a strip blends
    /// may be reached over from both ends, since the strip cuts the corners off; along a sharp edge between two
    /// clusters each reaches 0.48 of it at most. Where blends would meet within a face they are shortened.
    pub extent: f64,
    /// 0 for the fairest patch, towards 1 sharper.
    pub bulge: f64,
    /// Edges between two clusters that stay sharp, by their vertices.
    pub sharp: Vec<[u32; 2]>,
    /// Whether all edges between two clusters stay sharp.
    pub all_sharp: bool,
    /// Strips along all other edges between two clusters.
    pub strip: hartmann::Params,
}

impl Default for Params {
    fn default() -> Self {
        Self {
            continuity: 1,
            degree: None,
            extent: 0.7,
            bulge: 0.0,
            sharp: vec![],
            all_sharp: false,
            strip: hartmann::Params::default(),
        }
    }
}

/// Patches and strips, and where they stand on the polyhedron.
#[derive(Clone, Debug)]
pub struct Layout {
    /// The clusters.
    pub clusters: Vec<Cluster>,
    /// The control net of each.
    pub nets: Vec<Net>,
    /// The surface of each.
    pub patches: Vec<Patch>,
    /// Strips along open edges.
    pub strips: Vec<Strip>,
    /// For each corner of each patch, the strip that cuts it off and which end of the strip that is.
    pub strip_at: Vec<Vec<Option<(usize, usize)>>>,
    /// For each halfedge that leaves a cluster, the cluster and its corner.
    pub corner_of: Vec<Option<(usize, usize)>>,
    /// The cluster of each vertex.
    pub cluster_of: Vec<Option<usize>>,
}

impl Layout {
    /// Lays out patches and strips. `shrink` scales the reach along each halfedge.
    ///
    /// # Errors
    /// [`Error::TwoClusters`], [`Error::NoCluster`], [`Error::Conflict`], [`Error::Range`], …
    pub fn new(solid: &Polyhedron, specs: &[Spec], params: &Params, shrink: &[f64]) -> Result<Self, Error> {
        check(params, specs)?;
        let clusters = specs.iter().map(|s| Cluster::new(solid, &s.vertices)).collect::<Result<Vec<_>, _>>()?;
        let mut cluster_of = vec![None; solid.positions.len()];
        let mut corner_of = vec![None; solid.halfedges.len()];
        for (c, cluster) in clusters.iter().enumerate() {
            for &v in &cluster.vertices {
                if cluster_of[v as usize].replace(c).is_some() {
                    return Err(Error::TwoClusters { vertex: v, at: solid.positions[v as usize] });
                }
            }
            for (k, &h) in cluster.open.iter().enumerate() {
                corner_of[h as usize] = Some((c, k));
            }
        }
        let mut sharp = vec![params.all_sharp; solid.halfedges.len()];
        for &[a, b] in &params.sharp {
            let h = solid.halfedge(a, b).ok_or(Error::NoEdge(a, b))?;
            sharp[h as usize] = true;
            sharp[solid.halfedges[h as usize].twin as usize] = true;
        }
        let meets_other = |h: u32| corner_of[solid.halfedges[h as usize].twin as usize].is_some();
        let build = |(c, cluster): (usize, &Cluster)| {
            let spec = &specs[c];
            let extent = spec.extent.unwrap_or(params.extent);
            let reach = |&h: &u32| {
                let share = if sharp[h as usize] && meets_other(h) { extent.min(0.48) } else { extent.min(0.95) };
                share * shrink[h as usize] * solid.length(h)
            };
            let wanted = net::Params {
                continuity: params.continuity,
                shape: shape_of(cluster.sides(), spec.degree.or(params.degree), params.continuity),
                reach: cluster.open.iter().map(reach).collect(),
                bulge: spec.bulge.unwrap_or(params.bulge),
                moves: spec.moves.clone(),
            };
            Net::new(solid, cluster, &wanted)
        };
        let nets = clusters.par_iter().enumerate().map(build).collect::<Result<Vec<_>, _>>()?;
        let patches = nets.iter().zip(&clusters).map(|(net, cluster)| {
            // Only coordinates beyond 1e300 could make a net that is not finite.
            let at = solid.positions[cluster.vertices[0] as usize];
            Patch::new(net).ok_or(Error::NoCluster {
                vertices: cluster.vertices.clone(),
                at,
                why: "is too large for 64-bit numbers",
            })
        });
        let patches = patches.collect::<Result<Vec<_>, _>>()?;
        let mut strip_at: Vec<Vec<_>> = clusters.iter().map(|c| vec![None; c.sides()]).collect();
        let mut strips = vec![];
        for (h, half) in solid.halfedges.iter().enumerate() {
            let (Some(near), Some(far)) = (corner_of[h], corner_of[half.twin as usize]) else { continue };
            if (h as u32) < half.twin && !sharp[h] {
                strip_at[near.0][near.1] = Some((strips.len(), 0));
                strip_at[far.0][far.1] = Some((strips.len(), 1));
                strips.push(Strip { ends: [near, far], params: params.strip });
            }
        }
        Ok(Self { clusters, nets, patches, strips, strip_at, corner_of, cluster_of })
    }

    /// The part of side k that is left between its strips, as shares.
    pub fn side_range(&self, cluster: usize, k: usize) -> [f64; 2] {
        let m = self.clusters[cluster].sides();
        let cut = |k: usize| self.strip_at[cluster][k % m].map_or(0.0, |(s, _)| self.strips[s].params.cut);
        [cut(k), 1.0 - cut(k + 1)]
    }

    /// The point on the open edge where the patch has its corner, if no strip cuts it off.
    pub fn tip(&self, cluster: usize, k: usize) -> DVec3 {
        self.patches[cluster].border(k, 0.0)
    }
}

/// The shape of a patch with so many sides, of the degree asked for or else 2g + 1.
pub(crate) fn shape_of(sides: usize, degree: Option<Degree>, g: usize) -> Shape {
    let simplex = |degree| Shape::Simplex { sides, degree };
    match (sides, degree) {
        (4, Some(Degree::Tensor(a, b))) => Shape::Tensor([a, b]),
        (4, Some(Degree::Same(n))) => Shape::Tensor([n, n]),
        (4, None) => Shape::Tensor([2 * g + 1; 2]),
        (_, Some(Degree::Same(n))) => simplex(n),
        (_, Some(Degree::Tensor(..)) | None) => simplex(2 * g + 1),
    }
}

fn check(params: &Params, specs: &[Spec]) -> Result<(), Error> {
    let refuse = |name, value, range| Err(Error::Range { name, value, range });
    if params.continuity == 0 || params.continuity > 20 {
        return refuse("continuity", params.continuity as f64, "1 to 20");
    }
    for extent in specs.iter().filter_map(|s| s.extent).chain([params.extent]) {
        if !(extent > 0.0 && extent <= 1.0) {
            return refuse("extent", extent, "(0, 1]");
        }
    }
    for bulge in specs.iter().filter_map(|s| s.bulge).chain([params.bulge]) {
        if !(0.0..1.0).contains(&bulge) {
            return refuse("bulge", bulge, "[0, 1)");
        }
    }
    let hartmann::Params { order, balance, cut, follow } = params.strip;
    if order > 20 {
        return refuse("order", order as f64, "0 to 20");
    }
    if !(balance > 0.0 && balance < 1.0) {
        return refuse("mu", balance, "(0, 1)");
    }
    if !(cut > 0.0 && cut < 0.5) {
        return refuse("cut", cut, "(0, 0.5)");
    }
    if !(0.0..1.0).contains(&follow) {
        return refuse("follow", follow, "[0, 1)");
    }
    Ok(())
}
