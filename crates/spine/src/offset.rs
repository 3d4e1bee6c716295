//! The spine as the crossing of two offset patches: the solver of [Liu2005] §3.
//!
//! Each base patch is moved along its normals by the radius. The moved patches keep their triangles, so every point in
//! which they cross has an image on either base patch by its barycentric coordinates there: the feet. Those feet move
//! continuously where a ball's true feet stick and jump; but the centres are off by the sagitta of the facets, and
//! where a patch bends more tightly than the ball its offset folds.

mod moved;
mod sampling;

use crate::curve::{BlendCurve, Convexity};
use crate::march::Trace;
use crate::patch::Patch;
use crate::radius::RadiusField;
use crate::{Error, MAX_ALPHA};
use glam::DVec3;
use mesh_core::{Adjacency, EdgeId, Positions, Watch};
use moved::MovedPatch;
use sampling::Loop;
use std::collections::HashSet;
use tri_intersect::{Curve, intersection_curves};

/// How offset patches are made and their crossing is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffsetParams {
    /// What stays at the radius from the base patch.
    pub keep: OffsetKeep,
    /// Fewest samples along the spine, evenly by arc length. The step of [`crate::Params`] may ask for more.
    pub samples: u32,
    /// Chord height over chord length above which an interval is halved. An arc of θ radians has θ/8.
    pub bend: f64,
}

impl Default for OffsetParams {
    fn default() -> Self {
        // 40 samples: [Liu2005] §4.1, which leaves the threshold open; 0.05 lets an arc turn by 23 degrees.
        Self { keep: OffsetKeep::Faces, samples: 40, bend: 0.05 }
    }
}

/// What of an offset patch is at distance r from its base.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OffsetKeep {
    /// Vertices move by r, as in the paper; the faces between them come nearer by the sagitta, and a crease of half
    /// angle θ to r·cos θ.
    Vertices,
    /// Vertices move farther, so that in the mean the faces around them are at r. Exact on facets; edges are mitred.
    #[default]
    Faces,
}

/// The spine of a closed `curve` from the crossing of its offset patches, as contacts whose feet are the images of the
/// crossing and whose residuals are measured.
///
/// # Errors
/// [`Error::NoLoop`], [`Error::Folded`].
pub(crate) fn trace<M: Adjacency + Positions + Sync>(
    mesh: &M,
    curve: &BlendCurve,
    convexity: Convexity,
    base: Base<'_>,
    radius: &RadiusField,
    step: f64,
    params: &OffsetParams,
) -> Result<Trace, Error> {
    let side = match convexity {
        Convexity::Concave => 1.0,
        Convexity::Convex => -1.0,
    };
    let offset = |k: usize| MovedPatch::new(mesh, &base.patches[k], base.barriers, radius, side, params.keep);
    let (left, right) = rayon::join(|| offset(0), || offset(1));
    let crossings = match (&left, &right) {
        (Some(l), Some(r)) => intersection_curves(&l.offset, &r.offset, &Watch::default()).unwrap_or_default(),
        _ => vec![],
    };
    let longest = |closed| {
        let candidates = crossings.iter().filter(|c| c.closed == closed).map(|c| (length(c), c));
        candidates.reduce(|best, c| if c.0 > best.0 { c } else { best })
    };
    let (closed, open) = (longest(true), longest(false));
    // A chain that ends where a patch was cut off goes on beyond.
    if base.alpha < MAX_ALPHA && open.is_some_and(|o| closed.is_none_or(|c| o.0 > c.0)) {
        return Ok(Trace::RanOff);
    }
    let (Some((_, found)), Some(left), Some(right)) = (closed, left, right) else {
        let start = curve.halfedges.first().map_or(DVec3::ZERO, |&h| mesh.position(mesh.tail(h)));
        let at = open.and_then(|(_, o)| o.points.last()).map_or(start, |p| p.position);
        return Err(Error::NoLoop { at, radius: radius.at(at).0 });
    };
    let spine = unfolded(found, convexity, [&left, &right], radius)?;
    Ok(Trace::Closed(spine.contacts(mesh, base.patches, radius, step, params)))
}

/// The base patches as they were flooded.
#[derive(Clone, Copy)]
pub(crate) struct Base<'a> {
    pub patches: &'a [Patch; 2],
    /// Edges no patch was flooded across.
    pub barriers: &'a HashSet<EdgeId>,
    /// How far they were flooded, in radii.
    pub alpha: f64,
}

fn length(curve: &Curve) -> f64 {
    let p = |i: usize| curve.points[i % curve.points.len()].position;
    let joints = curve.points.len() - usize::from(!curve.closed);
    (0..joints).map(|i| p(i).distance(p(i + 1))).sum()
}

/// The points of a crossing with their images, without those on folds; in the direction of the blend curve.
fn unfolded(
    found: &Curve,
    convexity: Convexity,
    patches: [&MovedPatch; 2],
    radius: &RadiusField,
) -> Result<Loop, Error> {
    let firm = |i: &usize| {
        let p = &found.points[*i];
        !patches[0].folds_at(&p.on_a) && !patches[1].folds_at(&p.on_b)
    };
    let n = found.points.len();
    let kept: Vec<usize> = (0..n).filter(firm).collect();
    let folded = |at: DVec3| Error::Folded { at, radius: radius.at(at).0 };
    if kept.len() < 3 {
        return Err(folded(found.points[0].position));
    }
    for (k, &i) in kept.iter().enumerate() {
        let j = kept[(k + 1) % kept.len()];
        let [p, q] = [i, j].map(|i| found.points[i].position);
        // Longer gaps are never bridged; see `regress`.
        if (i + 1) % n != j && p.distance(q) > 3.0 * radius.base {
            return Err(folded(p.midpoint(q)));
        }
    }
    let point = |i: usize| {
        let p = &found.points[i];
        [p.position, patches[0].image(&p.on_a), patches[1].image(&p.on_b)]
    };
    let mut points: Vec<[DVec3; 3]> = kept.into_iter().map(point).collect();
    // A crossing runs along left normal × right normal, which in a valley is backwards.
    if convexity == Convexity::Concave {
        points.reverse();
    }
    Ok(Loop::new(points))
}
