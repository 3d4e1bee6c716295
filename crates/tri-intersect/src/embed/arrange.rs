//! The result's vertices, the points sorted along each edge, and the pieces of curve sorted by the face they run through.

use super::clash::{Clash, Site};
use super::error::EmbedError;
use super::normalise::Chain;
use glam::DVec3;
use mesh_core::{Adjacency, FaceId, HalfedgeId, Positions, SurfacePoint, VertexId};

/// A point strictly within an edge, which is named by its lower halfedge.
#[derive(Clone, Copy)]
pub(super) struct EdgePoint {
    edge: HalfedgeId,
    t: f64,
    pub vertex: VertexId,
}

/// A piece of curve through the inside of a face.
#[derive(Clone, Copy)]
pub(super) struct Segment {
    face: FaceId,
    pub ends: [VertexId; 2],
    pub site: Site,
}

pub(super) struct Arrangement {
    /// Input vertices; ids from here on are `new`.
    inherited: usize,
    pub new: Vec<(SurfacePoint, DVec3)>,
    pub chains: Vec<Vec<VertexId>>,
    edge_points: Vec<EdgePoint>,
    segments: Vec<Segment>,
}

impl Arrangement {
    /// Gives every node its vertex and every piece of curve its face. Also lists where curves share points they may not.
    pub fn new<M: Adjacency + Positions>(mesh: &M, chains: &[Chain]) -> Result<(Self, Vec<Clash>), EmbedError> {
        let mut clashes = vec![];
        let sites = sites_by_address(chains);
        let mut this =
            Self { inherited: mesh.vertex_count(), new: vec![], chains: vec![], edge_points: vec![], segments: vec![] };
        for group in sites.chunk_by(|a, b| a.0 == b.0) {
            if group.iter().filter(|(_, s)| !ends_here(chains, *s)).count() > 1 {
                clashes.extend(group[1..].iter().map(|(_, s)| Clash {
                    place: at(chains, *s).position(mesh),
                    face: at(chains, *s).faces(mesh).next().unwrap_or(FaceId(0)),
                    sites: [Some(group[0].1), Some(*s)],
                }));
            }
        }
        this.number(mesh, chains, &sites);
        this.lay_segments(mesh, chains, &mut clashes)?;
        Ok((this, clashes))
    }

    /// New vertices in the order of the curves; nodes at one address share one.
    fn number<M: Adjacency + Positions>(&mut self, mesh: &M, chains: &[Chain], sites: &[(Key, Site)]) {
        let mut leaders: Vec<Vec<Site>> = chains.iter().map(|c| Vec::with_capacity(c.nodes.len())).collect();
        for (curve, chain) in chains.iter().enumerate() {
            leaders[curve].extend((0..chain.nodes.len()).map(|node| Site { curve, node }));
        }
        for group in sites.chunk_by(|a, b| a.0 == b.0) {
            for (_, s) in group {
                leaders[s.curve][s.node] = group[0].1;
            }
        }
        for (curve, chain) in chains.iter().enumerate() {
            self.chains.push(Vec::with_capacity(chain.nodes.len()));
            for (node, &leader) in leaders[curve].iter().enumerate() {
                let vertex = match chain.nodes[node].at {
                    SurfacePoint::Vertex(v) => v,
                    _ if leader != (Site { curve, node }) => self.chains[leader.curve][leader.node],
                    address => {
                        self.new.push((address, address.position(mesh)));
                        VertexId::from(self.inherited + self.new.len() - 1)
                    }
                };
                self.chains[curve].push(vertex);
            }
        }
        for group in sites.chunk_by(|a, b| a.0 == b.0) {
            let s = group[0].1;
            if let SurfacePoint::Edge { halfedge, t } = at(chains, s) {
                self.edge_points.push(EdgePoint { edge: halfedge, t, vertex: self.chains[s.curve][s.node] });
            }
        }
    }

    fn lay_segments<M: Adjacency + Positions>(
        &mut self,
        mesh: &M,
        chains: &[Chain],
        clashes: &mut Vec<Clash>,
    ) -> Result<(), EmbedError> {
        for (curve, chain) in chains.iter().enumerate() {
            let all = chain.nodes.len();
            for node in 0..if chain.closed { all } else { all - 1 } {
                let next = (node + 1) % all;
                let (a, b) = (chain.nodes[node].at, chain.nodes[next].at);
                let site = Site { curve, node };
                let ends = [self.chains[curve][node], self.chains[curve][next]];
                if let Some((edge, t)) = along_edge(mesh, a, b) {
                    // The pieces of the edge are mesh edges already; only nothing may lie between.
                    for between in self.on_edge(edge).iter().filter(|p| t[0].min(t[1]) < p.t && p.t < t[0].max(t[1])) {
                        clashes.push(Clash {
                            place: self.position(mesh, between.vertex),
                            face: edge.face(),
                            sites: [Some(site), self.site_of(between.vertex)],
                        });
                    }
                } else if let Some(face) = common_face(mesh, a, b) {
                    self.segments.push(Segment { face, ends, site });
                } else {
                    let point = chain.nodes[node].first + chain.nodes[node].count - 1;
                    return Err(EmbedError::Apart { curve, point, place: a.position(mesh) });
                }
            }
        }
        self.segments.sort_by_key(|s| s.face);
        Ok(())
    }

    /// Every face that a curve runs through or has a point on a side of, in order.
    pub fn crossed_faces<M: Adjacency>(&self, mesh: &M) -> Vec<FaceId> {
        let beside = self.edge_points.iter().flat_map(|p| [Some(p.edge), mesh.twin(p.edge)]);
        let mut faces: Vec<_> =
            beside.flatten().map(HalfedgeId::face).chain(self.segments.iter().map(|s| s.face)).collect();
        faces.sort_unstable();
        faces.dedup();
        faces
    }

    /// The points within an edge from the tail of its lower halfedge on.
    pub fn on_edge(&self, lower: HalfedgeId) -> &[EdgePoint] {
        let start = self.edge_points.partition_point(|p| p.edge < lower);
        let count = self.edge_points[start..].iter().take_while(|p| p.edge == lower).count();
        &self.edge_points[start..start + count]
    }

    /// The pieces of curve inside a face, in the order of the curves.
    pub fn segments_in(&self, face: FaceId) -> &[Segment] {
        let start = self.segments.partition_point(|s| s.face < face);
        let count = self.segments[start..].partition_point(|s| s.face == face);
        &self.segments[start..start + count]
    }

    pub fn address(&self, v: VertexId) -> SurfacePoint {
        if v.index() < self.inherited { SurfacePoint::Vertex(v) } else { self.new[v.index() - self.inherited].0 }
    }

    pub fn position<M: Positions>(&self, mesh: &M, v: VertexId) -> DVec3 {
        if v.index() < self.inherited { mesh.position(v) } else { self.new[v.index() - self.inherited].1 }
    }

    /// The first node at a vertex. Linear: for error reports.
    pub fn site_of(&self, v: VertexId) -> Option<Site> {
        self.chains
            .iter()
            .enumerate()
            .find_map(|(curve, chain)| chain.iter().position(|&w| w == v).map(|node| Site { curve, node }))
    }
}

/// Orders addresses by element, and along an edge from its tail. Parameters are positive, so their bits sort as they do.
type Key = (u8, u32, [u64; 3]);

fn sites_by_address(chains: &[Chain]) -> Vec<(Key, Site)> {
    let mut sites: Vec<_> = chains
        .iter()
        .enumerate()
        .flat_map(|(curve, chain)| {
            chain.nodes.iter().enumerate().map(move |(node, n)| {
                let key = match n.at {
                    SurfacePoint::Vertex(v) => (0, v.0, [0; 3]),
                    SurfacePoint::Edge { halfedge, t } => (1, halfedge.0, [t.to_bits(), 0, 0]),
                    SurfacePoint::Face { face, barycentric } => (2, face.0, barycentric.map(f64::to_bits)),
                };
                (key, Site { curve, node })
            })
        })
        .collect();
    sites.sort_unstable();
    sites
}

fn at(chains: &[Chain], site: Site) -> SurfacePoint {
    chains[site.curve].nodes[site.node].at
}

fn ends_here(chains: &[Chain], site: Site) -> bool {
    let chain = &chains[site.curve];
    !chain.closed && (site.node == 0 || site.node + 1 == chain.nodes.len())
}

/// If both points lie on one edge: its lower halfedge and their parameters there.
fn along_edge<M: Adjacency>(mesh: &M, a: SurfacePoint, b: SurfacePoint) -> Option<(HalfedgeId, [f64; 2])> {
    let parameter = |p: SurfacePoint, h: HalfedgeId| match p {
        SurfacePoint::Vertex(v) if v == mesh.tail(h) => Some(0.0),
        SurfacePoint::Vertex(v) if v == mesh.head(h) => Some(1.0),
        SurfacePoint::Edge { halfedge, t } if halfedge == h => Some(t),
        _ => None,
    };
    let edge = match (a, b) {
        (SurfacePoint::Edge { halfedge, .. }, _) | (_, SurfacePoint::Edge { halfedge, .. }) => halfedge,
        (SurfacePoint::Vertex(v), SurfacePoint::Vertex(w)) => {
            let h = mesh.ring(v).flat_map(|h| [h, h.prev()]).find(|&h| {
                let (tail, head) = (mesh.tail(h), mesh.head(h));
                (tail == v && head == w) || (tail == w && head == v)
            })?;
            HalfedgeId(mesh.edge(h).0)
        }
        _ => return None,
    };
    Some((edge, [parameter(a, edge)?, parameter(b, edge)?]))
}

/// The lowest face whose closure holds both points.
fn common_face<M: Adjacency>(mesh: &M, a: SurfacePoint, b: SurfacePoint) -> Option<FaceId> {
    let (few, other) = if matches!(a, SurfacePoint::Vertex(_)) { (b, a) } else { (a, b) };
    few.faces(mesh).filter(|&f| other.lies_in(mesh, f)).min()
}
