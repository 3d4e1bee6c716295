//! Linkage curves on the surface: fair feet joined by short walks into loops, then made edges of the mesh.
//!
//! Every loop has what stays on its left. A closed curve has two, one for each side; open curves share theirs: a loop
//! follows one side of a curve to its end, goes over the corner, stop or tip there, and on along the next curve.

use crate::ending::Layout;
use crate::network::{Dart, Network};
use crate::stretch::Ending;
use crate::trouble::Trouble;
use glam::DVec3;
use mesh_core::{Adjacency, Positions, SurfacePoint, TraceError, TraceLimits, VertexId, Watch};
use tri_intersect::{EmbedError, EmbedParams, Embedded, SurfaceCurve, embed};

/// One linkage as vertices of the cut mesh, in the direction of its rail.
#[derive(Clone, Debug, Default)]
pub(crate) struct Linkage {
    /// The chain; of a closed one the first vertex is repeated at the end.
    chain: Vec<VertexId>,
    /// For each profile, its foot's index in the chain; of a closed one, one more for the first profile again.
    feet: Vec<usize>,
}

impl Linkage {
    /// The foot of profile `i`.
    pub fn foot(&self, i: usize) -> VertexId {
        self.chain[self.feet[i]]
    }

    /// The chain from the foot of profile `i` to that of the next, both included.
    pub fn span(&self, i: usize) -> &[VertexId] {
        &self.chain[self.feet[i]..=self.feet[i + 1]]
    }
}

/// The mesh with all linkages cut into it.
pub(crate) struct Opened {
    pub embedded: Embedded,
    /// Left and right linkage of every stretch.
    pub linkages: Vec<[Linkage; 2]>,
    /// For each corner and dart, the chain from the dart's left foot to the next dart's right one.
    pub joints: Vec<Vec<Vec<VertexId>>>,
    /// For each stretch and end that stops at a surface, the chain over that from the left foot to the right one.
    pub stops: Vec<[Vec<VertexId>; 2]>,
    /// All loops, the first vertex repeated at the end.
    pub loops: Vec<Vec<VertexId>>,
}

/// What a piece of a loop is.
#[derive(Clone, Copy)]
enum Role {
    /// The linkage on the left of a dart.
    Linkage(Dart),
    /// The joint over a sector of a corner, against its direction.
    Joint { corner: usize, sector: usize },
    /// The profile in the surface where a stretch stops, from the left of a dart to its right.
    Stop(Dart),
}

/// A loop before it is cut: points, and which of them belong to what.
#[derive(Default)]
struct Loop {
    points: Vec<(SurfacePoint, DVec3)>,
    roles: Vec<(Role, usize, usize)>,
}

impl Loop {
    /// Adds the points of one piece.
    fn add(&mut self, role: Role, points: impl IntoIterator<Item = (SurfacePoint, DVec3)>) {
        let first = self.points.len();
        self.points.extend(points);
        self.roles.push((role, first, self.points.len()));
    }
}

/// Walks every loop of a layout.
fn loops<M: Adjacency + Positions>(mesh: &M, network: &Network, layout: &Layout) -> Vec<Loop> {
    let mut seen = vec![[false; 2]; layout.stretches.len()];
    let mut loops = Vec::new();
    for curve in 0..layout.stretches.len() {
        for end in 0..2 {
            if seen[curve][end] || layout.stretches[curve].is_none() {
                continue;
            }
            let (mut walk, mut dart) = (Loop::default(), Dart { curve, end });
            while let Some(stretch) = &layout.stretches[dart.curve]
                && !std::mem::replace(&mut seen[dart.curve][dart.end], true)
            {
                let n = stretch.stations();
                // A closed rail walked backwards begins with the same profile as forwards.
                let back = |k: usize| if stretch.rail.closed { (n - k) % n } else { n - 1 - k };
                let stations = (0..n).map(|k| if dart.end == 0 { k } else { back(k) });
                walk.add(Role::Linkage(dart), stations.map(|k| stretch.foot(mesh, dart.end, k)));
                match &stretch.endings[dart.twin().end] {
                    Ending::Joined | Ending::Tip(_) => {}
                    Ending::Stop(points) => {
                        let inner = &points[1..points.len() - 1];
                        let order = (0..inner.len()).map(|k| if dart.end == 0 { k } else { inner.len() - 1 - k });
                        walk.add(Role::Stop(dart), order.map(|k| inner[k]));
                    }
                    Ending::Corner => {
                        let next = network.next(dart);
                        let node = network.ends[dart.curve][dart.twin().end];
                        if let Some(corner) = node.and_then(|n| layout.corner_of[n]) {
                            let found = &layout.corners[corner];
                            let sector = found.darts.iter().position(|&d| d == next).unwrap_or(0);
                            let back = found.joints[sector].iter().rev().copied();
                            walk.add(Role::Joint { corner, sector }, back);
                        }
                    }
                }
                dart = network.next(dart);
            }
            loops.push(walk);
        }
    }
    loops
}

/// Cuts all loops of the layout into the mesh. Their points move at most `snap` radii to spare slivers.
pub(crate) fn cut_linkages<M: Adjacency + Positions + Sync>(
    mesh: &M,
    network: &Network,
    layout: &Layout,
    snap: f64,
    radius: f64,
    watch: &Watch,
) -> Result<Opened, Trouble> {
    let loops = loops(mesh, network, layout);
    let mut curves = Vec::with_capacity(loops.len());
    let mut places = Vec::with_capacity(loops.len());
    for walk in &loops {
        let limits = TraceLimits::default();
        let (curve, at) = SurfaceCurve::through(mesh, &walk.points, true, &limits).map_err(|e| match e {
            TraceError::Lost { from, to, .. } => Trouble::at("a linkage leaves the surface", vec![from.midpoint(to)]),
            TraceError::BadPoint { point } => Trouble::at("a linkage leaves the surface", vec![point.position(mesh)]),
        })?;
        curves.push(curve);
        places.push(at);
    }
    let embedded =
        embed(mesh, &curves, &EmbedParams { snap: (2.5 * snap).clamp(0.01, 0.1), reach: snap * radius }, watch)
            .map_err(|e| match e {
                EmbedError::Crossings(found) => Trouble::at("linkages cross", found.iter().map(|c| c.place).collect()),
                EmbedError::Apart { place, .. } | EmbedError::TooSmall { place, .. } => {
                    Trouble::at("a linkage cannot be cut into the mesh", vec![place])
                }
                EmbedError::Collapsed { curve } => {
                    let at = loops[curve].points.first().map(|p| p.0.position(mesh));
                    Trouble::at("a linkage shrinks to a point", at.into_iter().collect())
                }
                EmbedError::Cancelled(c) => Trouble::Cancelled(c),
                e @ (EmbedError::BadPoint { .. } | EmbedError::TooMany) => Trouble::Embed(e),
            })?;
    let mut opened = Opened {
        linkages: vec![[Linkage::default(), Linkage::default()]; layout.stretches.len()],
        joints: layout.corners.iter().map(|c| vec![Vec::new(); c.darts.len()]).collect(),
        stops: vec![[Vec::new(), Vec::new()]; layout.stretches.len()],
        loops: Vec::with_capacity(loops.len()),
        embedded,
    };
    for (c, walk) in loops.iter().enumerate() {
        let (chain, at) = unrolled(&opened.embedded, c, &places[c]);
        let index = |k: usize| at.get(k).copied().unwrap_or(chain.len() - 1);
        for &(role, first, end) in &walk.roles {
            match role {
                Role::Linkage(dart) => {
                    let closed = layout.stretches[dart.curve].as_ref().is_some_and(|s| s.rail.closed);
                    let mut feet: Vec<usize> = (first..end).map(index).collect();
                    if closed {
                        feet.push(chain.len() - 1);
                    }
                    let (low, high) = (feet[0], feet[feet.len() - 1]);
                    let mut own = Linkage { chain: chain[low..=high].to_vec(), feet };
                    own.feet.iter_mut().for_each(|f| *f -= low);
                    if dart.end == 1 {
                        own.reverse();
                    }
                    opened.linkages[dart.curve][dart.end] = own;
                }
                Role::Joint { corner, sector } => {
                    let mut joint = chain[index(first - 1)..=index(end)].to_vec();
                    joint.reverse();
                    opened.joints[corner][sector] = joint;
                }
                Role::Stop(dart) => {
                    let mut stop = chain[index(first - 1)..=index(end)].to_vec();
                    if dart.end == 1 {
                        stop.reverse();
                    }
                    opened.stops[dart.curve][dart.twin().end] = stop;
                }
            }
        }
        opened.loops.push(chain);
    }
    Ok(opened)
}

impl Linkage {
    /// Turns a linkage that was walked backwards round.
    fn reverse(&mut self) {
        let last = self.chain.len() - 1;
        self.chain.reverse();
        self.feet.iter_mut().for_each(|f| *f = last - *f);
        self.feet.reverse();
    }
}

/// The chain of embedded curve `c` from its first point round to that again, and the index in it of each of `points`.
fn unrolled(embedded: &Embedded, c: usize, points: &[usize]) -> (Vec<VertexId>, Vec<usize>) {
    let mut chain = embedded.curves[c].clone();
    let places: Vec<usize> = points.iter().map(|&p| embedded.places[c][p]).collect();
    // Merging may have moved the first point to the end of the chain: turn the chain to begin with it.
    let first = places.first().copied().unwrap_or(0);
    chain.rotate_left(first);
    let n = chain.len();
    // Points merged with the first one across the closure belong to the end.
    let mut highest = 0;
    let at = places
        .iter()
        .map(|&p| {
            let mut at = (p + n - first) % n;
            if at < highest {
                at = n;
            }
            highest = at;
            at
        })
        .collect();
    chain.push(chain[0]);
    (chain, at)
}
