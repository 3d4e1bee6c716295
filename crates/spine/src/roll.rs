//! The way from a blend curve to a rail: patches wide enough for the ball, its spine, and fair linkages.

use crate::march::{self, Footing, Trace};
use crate::{
    BlendCurve, Contact, Convexity, Error, Halt, Params, Patch, Rail, Side, Solver, curve, fair, offset, regress,
};
use glam::DVec3;
use mesh_core::{Adjacency, EdgeId, HalfedgeId, IdSet, Positions};
use mesh_query::ClosestPoint;
use std::sync::Arc;

/// Rolls a ball along `curve`. `all_curves` are the curves being blended together: no patch floods across any of them.
///
/// Cost grows with the faces within reach and the samples along the curve, not with the mesh.
///
/// # Errors
/// Every [`Error`]; those with a place may pass with a smaller radius there.
pub fn roll<M: Adjacency + Positions + Sync>(
    mesh: &M,
    curve: &BlendCurve,
    all_curves: &[BlendCurve],
    params: &Params,
) -> Result<Rail, Error> {
    roll_or_halt(mesh, curve, all_curves, params).map_err(|halt| halt.error)
}

/// [`roll`], with what there is to look at where the ball halts.
///
/// # Errors
/// [`Halt`].
pub fn roll_or_halt<M: Adjacency + Positions + Sync>(
    mesh: &M,
    curve: &BlendCurve,
    all_curves: &[BlendCurve],
    params: &Params,
) -> Result<Rail, Box<Halt>> {
    let radius = &params.radius;
    if !(radius.base > 0.0 && radius.base.is_finite()) {
        return Err(Error::BadRadius { radius: radius.base }.into());
    }
    let convexity = curve.convexity(mesh)?;
    let edges = all_curves.iter().flat_map(|c| &c.halfedges).map(|&h| mesh.edge(h));
    let barriers: IdSet<EdgeId> = edges.chain(params.walls.iter().copied()).collect();
    let own: IdSet<EdgeId> = curve.halfedges.iter().map(|&h| mesh.edge(h)).collect();
    let ends = curve.ends(mesh);
    let mut alpha = params.alpha.max(wedge_alpha(mesh, curve));
    loop {
        let patch = |side| Patch::flood(mesh, curve, side, &barriers, alpha * radius.base, 0.5 * radius.base);
        let patches = [patch(Side::Left)?, patch(Side::Right)?];
        let ground = Ground {
            mesh,
            closed: curve.closed,
            convexity,
            patches: &patches,
            barriers: &barriers,
            own: &own,
            ends: &ends,
            alpha,
            radius: radius.base,
        };
        let mut way = Vec::new();
        let traced = match &params.solver {
            Solver::Contact => march::trace(mesh, curve, convexity, &patches, params, |c| ground.footing(c), &mut way),
            Solver::Offset(offset) => {
                let base = offset::Base { patches: &patches, barriers: &barriers, alpha };
                offset::trace(mesh, curve, convexity, base, radius, params.step, offset)
            }
        };
        let halted = |error, balls, patches| Err(Box::new(Halt { error, patches: Some(Arc::new(patches)), balls }));
        let (contacts, closed) = match traced {
            Ok(Trace::Closed(contacts)) => (contacts, true),
            Ok(Trace::Open(contacts)) => (contacts, false),
            Ok(Trace::RanOff) => {
                alpha *= 1.6;
                continue;
            }
            Err(error) => return halted(error, way.iter().map(|c| c.center).collect(), patches),
        };
        if let [only] = contacts[..] {
            let error = Error::Stuck { at: only.center, radius: only.radius, wanted: radius.base };
            return halted(error, vec![only.center], patches);
        }
        let gaps = [1.5 * params.step, if params.longest > params.step { params.longest } else { 0.0 }];
        let fairing = fair::Fairing {
            fairness: params.fairness,
            gaps,
            softenings: &params.softenings,
            closed,
            ends: &ends,
            reach: 3.0 * alpha * radius.base,
        };
        let (samples, filled) = fair::fair(mesh, &patches, radius, &contacts, fairing);
        let fair = samples.len();
        let samples = regress::regress(&samples, closed, convexity, params.bridge * radius.base);
        let bridged = fair - samples.len();
        let samples = fair::fill_gaps(mesh, &patches, &samples, closed, gaps);
        let residual = contacts.iter().map(|c| c.residual).fold(filled, f64::max);
        return Ok(Rail { samples, closed, convexity, residual, bridged, alpha, patches: Arc::new(patches) });
    }
}

/// Beyond this reach the wedge is so sharp that a ball rolls half a dozen diameters away from the curve.
pub(crate) const MAX_ALPHA: f64 = 16.0;

/// A ball between planes that meet at normals φ apart touches them r·tan(φ/2) from the edge. The nineteenth
/// twentieth of the edges sets the reach, the rest is left to the check that no foot ran off.
fn wedge_alpha<M: Adjacency + Positions>(mesh: &M, curve: &BlendCurve) -> f64 {
    let mut tangents: Vec<f64> = curve
        .halfedges
        .iter()
        .filter_map(|&h| {
            let cosine = curve::face_normal(mesh, h).dot(curve::face_normal(mesh, mesh.twin(h)?));
            Some(((1.0 - cosine) / (1.0 + cosine).max(1e-3)).sqrt())
        })
        .collect();
    tangents.sort_by(f64::total_cmp);
    let typical = tangents.get(tangents.len() * 19 / 20).copied().unwrap_or(1.0);
    (1.3 * typical + 0.75).min(MAX_ALPHA)
}

/// What a ball stands on, and where that ends.
struct Ground<'a, M> {
    mesh: &'a M,
    closed: bool,
    convexity: Convexity,
    patches: &'a [Patch; 2],
    barriers: &'a IdSet<EdgeId>,
    /// The curve's own edges, which are barriers too.
    own: &'a IdSet<EdgeId>,
    ends: &'a [(DVec3, DVec3)],
    alpha: f64,
    radius: f64,
}

impl<M: Adjacency + Positions> Ground<'_, M> {
    fn footing(&self, ball: &Contact) -> Footing {
        let at_end = |e| !self.closed && self.barriers.contains(&e) && !self.own.contains(&e);
        let on_curve = |e| self.barriers.contains(&e);
        // Beyond the plane square to an end; a curve that bends back comes there too, but farther off.
        let near = |at: DVec3| ball.center.distance(at) < 3.0 * self.alpha * self.radius;
        let beyond = |(at, out): &(DVec3, DVec3)| near(*at).then(|| (ball.center - *at).dot(*out));
        let past = self.ends.iter().filter_map(beyond).fold(f64::NEG_INFINITY, f64::max);
        if past > self.alpha * self.radius
            || (0..2).any(|s| self.on_edge(&ball.feet[s], at_end) || past > 0.0 && self.at_rim(ball, s))
        {
            Footing::Over
        } else if (0..2).any(|s| self.on_edge(&ball.feet[s], on_curve) && self.tips(ball, s)) {
            Footing::Tipping
        } else if self.alpha < MAX_ALPHA && (0..2).any(|s| self.at_rim(ball, s)) {
            Footing::AtRim
        } else {
            Footing::Firm
        }
    }

    /// Whether a foot lies on an edge beyond which its patch was cut off.
    fn at_rim(&self, ball: &Contact, side: usize) -> bool {
        let cut_off = |t: HalfedgeId| self.patches[side].faces.binary_search(&t.face()).is_err();
        sides_under(&ball.feet[side])
            .any(|h| !self.barriers.contains(&self.mesh.edge(h)) && self.mesh.twin(h).is_some_and(cut_off))
    }

    /// Whether a foot lies on an edge of a kind.
    fn on_edge(&self, foot: &ClosestPoint, kind: impl Fn(EdgeId) -> bool) -> bool {
        sides_under(foot).any(|h| kind(self.mesh.edge(h)))
    }

    /// Whether the ball has left the side that a patch faces: with its foot on a blend curve, it tips over that.
    fn tips(&self, ball: &Contact, side: usize) -> bool {
        let facing = curve::face_normal(self.mesh, HalfedgeId::new(ball.feet[side].face, 0)).dot(ball.normals()[side]);
        TIPPING > if self.convexity == Convexity::Concave { facing } else { -facing }
    }
}

/// The sides of its triangle on which a foot lies.
fn sides_under(foot: &ClosestPoint) -> impl Iterator<Item = HalfedgeId> {
    let on = |&h: &HalfedgeId| foot.barycentric[(h.corner() + 2) % 3] == 0.0;
    foot.face.halfedges().into_iter().filter(on)
}

/// Cosine of the angle between a patch's normal and the ball at which a ball that touches only the patch's edge is
/// taken to be leaving it: 60 degrees.
const TIPPING: f64 = 0.5;
