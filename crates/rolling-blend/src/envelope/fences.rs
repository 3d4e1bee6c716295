//! Where the envelope ends in a plane: the rim of the piece there, on the ball instead of the sharp edge, and the cap between
//! the two. In a cross-section of the curve, these are fences.

use crate::cap::Fence;
use crate::field::piece::CutOut;
use crate::strip::Piece;
use crate::trouble::Trouble;
use glam::DVec3;
use mesh_core::{Adjacency, Connected, FaceMap, HalfedgeId, TriMesh, VertexId, VertexOrigin};
use tri_intersect::Embedded;

/// The stretch of an outline along which the piece ends in a plane, in the outline's direction; contact points at both ends.
pub(super) struct Row {
    pub chain: Vec<VertexId>,
    /// On the ball, for each vertex of the chain but the two contact points.
    pub on_ball: Vec<DVec3>,
}

/// Both halfedges of every edge of the fences.
pub(super) fn fenced(mesh: &Connected<TriMesh>, fences: &[Fence]) -> Vec<bool> {
    let mut marks = vec![false; 3 * mesh.mesh().faces.len()];
    let both = |w: &[VertexId]| [mesh.halfedge(w[0], w[1]), mesh.halfedge(w[1], w[0])];
    let all = fences.iter().flat_map(|f| f.chain.windows(2).flat_map(both));
    all.flatten().for_each(|h: HalfedgeId| marks[h.index()] = true);
    marks
}

impl Row {
    /// Finds the outline that runs along `fence`.
    pub fn of(fence: &Fence, embedded: &Embedded, r: f64) -> Result<Self, Trouble> {
        let on_fence = |v: &VertexId| match embedded.origins.vertices[*v] {
            VertexOrigin::Input { vertex, .. } => fence.chain.contains(&vertex),
            VertexOrigin::Edge { ends, .. } => ends.iter().all(|e| fence.chain.contains(e)),
            _ => false,
        };
        for curve in &embedded.curves {
            let Some(at) = curve.iter().position(|&v| v == fence.apex) else { continue };
            let n = curve.len();
            let run = |step: usize| (1..n).take_while(|k| on_fence(&curve[(at + k * step) % n])).count();
            // Backwards is forwards by one less than a whole turn.
            let (after, before) = (run(1), run(n - 1));
            if after == 0 || before == 0 || after + before + 1 >= n {
                break;
            }
            let chain: Vec<VertexId> = (0..=before + after).map(|k| curve[(at + n - before + k) % n]).collect();
            // Beyond the feet the piece lies in the surface.
            let feet = fence.feet.map(|f| fence.chain[f]);
            let is_foot = |v: &VertexId| feet.contains(v);
            let first = chain[..before].iter().rposition(is_foot).unwrap_or(0);
            let last = chain[before..].iter().position(is_foot).map_or(chain.len() - 1, |k| before + k);
            let chain = chain[first..=last].to_vec();
            let onto = |v: &VertexId| {
                fence.centre + r * (embedded.mesh.positions[v.index()] - fence.centre).normalize_or_zero()
            };
            return Ok(Self { on_ball: chain[1..chain.len() - 1].iter().map(onto).collect(), chain });
        }
        Err(Trouble::at("the blend does not reach its end", vec![fence.centre]))
    }

    /// The vertices that have a twin on the ball.
    fn inner(&self) -> &[VertexId] {
        &self.chain[1..self.chain.len() - 1]
    }

    /// The profile in which the piece ends instead, whose own vertices have ids from `next` on, and the triangles between.
    pub fn close(&self, cut: &Connected<&TriMesh>, removed: &FaceMap<bool>, next: &mut u32) -> (Vec<VertexId>, Piece) {
        let (first, last) = (self.chain[0], self.chain[self.chain.len() - 1]);
        let twins = (0..self.on_ball.len() as u32).map(|k| VertexId(*next + k));
        let end: Vec<VertexId> = std::iter::once(first).chain(twins).chain([last]).collect();
        *next += self.on_ball.len() as u32;
        let forwards = cut.halfedge(self.chain[0], self.chain[1]).is_some_and(|h| removed[h.face()]);
        let mut faces = vec![];
        for k in 0..end.len() - 1 {
            let ([a, b], [x, y]) = ([self.chain[k], self.chain[k + 1]], [end[k], end[k + 1]]);
            let pair = [[a, b, y], [a, y, x]].into_iter().filter(|f| f[0] != f[1] && f[1] != f[2] && f[2] != f[0]);
            faces.extend(pair.map(|f| if forwards { f } else { [f[0], f[2], f[1]] }));
        }
        (end, Piece { faces, points: self.on_ball.clone() })
    }
}

/// The piece with its rim along rows on the ball.
pub(super) fn on_balls<'a>(piece: &CutOut, rows: impl IntoIterator<Item = &'a Row>) -> CutOut {
    let (mut mesh, rim) = (piece.mesh.clone(), piece.rim.clone());
    for row in rows {
        for (p, v) in mesh.positions.iter_mut().zip(&rim) {
            if let Some(k) = row.inner().iter().position(|w| w == v) {
                *p = row.on_ball[k];
            }
        }
    }
    CutOut { mesh, rim }
}
