//! The mesh with the cross-sections at the borders of the zones as edges, and the curves in pieces.

use super::plan::{Plan, Span};
use crate::cap::{Cap, Fence, Moved};
use crate::params::Params;
use crate::so_far::SoFar;
use crate::trouble::Trouble;
use mesh_core::{Connected, Faces, HalfedgeId, Origins, TriMesh, VertexId, Watch};
use spine::{BlendCurve, Convexity};
use tri_intersect::{EmbedParams, embed};

/// Where a curve is cut between a zone and a strip.
#[derive(Clone)]
pub(super) struct ZoneEnd {
    pub fence: Fence,
    /// Of the zone's piece.
    pub zone: usize,
    /// Once the zone is blended.
    pub cap: Option<Cap>,
}

impl ZoneEnd {
    /// Follows a change of the mesh, if all of it is left.
    pub fn move_on(&mut self, moved: &Moved) -> Option<()> {
        match &mut self.cap {
            Some(cap) => {
                *cap = moved.cap(cap)?;
                self.fence.apex = moved.chain(&[self.fence.apex])?[0];
            }
            None => self.fence = self.fence.moved(moved)?,
        }
        Some(())
    }

    /// The cap by the vertex in which the strip's curve ends.
    pub fn into_cap(self) -> (VertexId, Cap) {
        (self.fence.apex, self.cap.unwrap_or_else(|| self.fence.flat()))
    }
}

/// The curves in pieces, on a mesh in which each piece is a chain of edges.
pub(super) struct Cut {
    pub mesh: Connected<TriMesh>,
    pub origins: Origins,
    pub pieces: Vec<BlendCurve>,
    /// Of each piece: where it is, its convexity, whether it lies in a zone.
    pub spans: Vec<Span>,
    pub convexities: Vec<Convexity>,
    pub zoned: Vec<bool>,
    pub ends: Vec<ZoneEnd>,
}

impl Cut {
    /// Cuts the curves as planned.
    pub fn along(plan: &mut Plan<'_>, params: &Params) -> Result<Self, Trouble> {
        let cuts = plan.cuts();
        let balls = plan.balls;
        let (mesh, curves) = (balls.ground_mesh(), balls.curves);
        let turn = 2.0 * (1.0 - params.tolerance.clamp(1e-4, 0.5)).acos();
        let lost = |at| Trouble::at("a cross-section leaves the surface", vec![at]);
        let mut sections = vec![];
        for (c, _, ball) in &cuts {
            sections.push(balls.section(*c, ball, turn).ok_or_else(|| lost(ball.centre))?);
        }
        let lines: Vec<_> = sections.iter().map(|s| s.0.clone()).collect();
        let embedded = embed(mesh, &lines, &EmbedParams { snap: 0.02, reach: 1e-3 * params.radius }, &Watch::default())
            .map_err(|_| lost(cuts[0].2.centre))?;
        let fence = |i: usize| {
            let at = sections[i].1.map(|p| embedded.places[i][p]);
            let chain = embedded.curves[i].clone();
            Fence { apex: chain[at[0]], chain, centre: cuts[i].2.centre, feet: [at[1], at[2]] }
        };
        let fences: Vec<Fence> = (0..cuts.len()).map(fence).collect();
        let so_far = SoFar::new(mesh, curves, params.radius);
        let mut so_far = so_far.refined(embedded.mesh.clone(), embedded.origins.clone());
        so_far.connect().map_err(|_| lost(cuts[0].2.centre))?;
        let connected = Connected::new(embedded.mesh).map_err(|_| lost(cuts[0].2.centre))?;
        let mut cut = Self {
            mesh: connected,
            origins: embedded.origins,
            pieces: vec![],
            spans: vec![],
            convexities: vec![],
            zoned: vec![],
            ends: vec![],
        };
        for c in 0..curves.len() {
            let own: Vec<usize> = (0..cuts.len()).filter(|&i| cuts[i].0 == c).collect();
            let whole = so_far.pieces(|j| j == c);
            let [whole] = &whole[..] else { return Err(lost(cuts[0].2.centre)) };
            let stations: Vec<(VertexId, usize)> = own.iter().map(|&i| (fences[i].apex, cuts[i].1)).collect();
            let first = cut.pieces.len();
            for (piece, from, to) in pieces(&cut.mesh, whole, &stations) {
                let span = Span { curve: c, from, to };
                cut.zoned.push(plan.is_zoned(span));
                cut.pieces.push(piece);
                cut.spans.push(span);
                cut.convexities.push(balls.convexities[c]);
            }
            for i in own {
                let ends_there = |p: &usize| {
                    let chain = &cut.pieces[*p].halfedges;
                    let ends = [chain.first().map(|&h| cut.mesh.tail(h)), chain.last().map(|&h| cut.mesh.head(h))];
                    cut.zoned[*p] && ends.contains(&Some(fences[i].apex))
                };
                let zone = (first..cut.pieces.len()).find(ends_there).ok_or_else(|| lost(fences[i].centre))?;
                cut.ends.push(ZoneEnd { fence: fences[i].clone(), zone, cap: None });
            }
        }
        Ok(cut)
    }
}

/// A curve in pieces, each with the stations of the cuts at which it begins and ends.
fn pieces(
    mesh: &Connected<TriMesh>,
    whole: &BlendCurve,
    cuts: &[(VertexId, usize)],
) -> Vec<(BlendCurve, Option<usize>, Option<usize>)> {
    let cut_at = |v: VertexId| cuts.iter().find(|c| c.0 == v).map(|c| c.1);
    let mut chain: Vec<HalfedgeId> = whole.halfedges.clone();
    if let (true, Some(start)) = (whole.closed, chain.iter().position(|&h| cut_at(mesh.tail(h)).is_some())) {
        chain.rotate_left(start);
    } else if whole.closed {
        return vec![(whole.clone(), None, None)];
    }
    let (mut found, mut from, mut piece) = (vec![], None, vec![]);
    for h in chain {
        if piece.is_empty() {
            from = cut_at(mesh.tail(h));
        }
        piece.push(h);
        if let Some(to) = cut_at(mesh.head(h)) {
            found.push((BlendCurve { halfedges: std::mem::take(&mut piece), closed: false }, from, Some(to)));
        }
    }
    if !piece.is_empty() {
        found.push((BlendCurve { halfedges: piece, closed: false }, from, None));
    }
    found
}
