//! The spine as the crossing of two offset patches: the solver of \[Liu2005\] §3.
//!
//! Each base patch is moved along its normals by the radius. The moved patches keep their triangles, so every point in
//! which they cross has an image on either base patch by its barycentric coordinates there: the feet. Those feet move
//! continuously where a ball's true feet stick and jump; but the centres are off by the sagitta of the facets, and
//! where a patch bends more tightly than the ball its offset folds.

mod moved;
mod sampling;

use crate::Error;
use crate::curve::{BlendCurve, Convexity};
use crate::march::Trace;
use crate::patch::Patch;
use crate::radius::RadiusField;
use crate::roll::MAX_ALPHA;
use glam::DVec3;
use mesh_core::{Adjacency, EdgeId, IdSet, Positions, Watch};
use moved::MovedPatch;
use sampling::Loop;
use tri_intersect::{Curve, CurvePoint, intersection_curves};

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
/// [`Error::NoLoop`], [`Error::Folded`], [`Error::TooFine`].
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
    let offset =
        |k: usize| MovedPatch::new(mesh, &base.patches[k], base.barriers, &radius.of_side(k), side, params.keep);
    let (left, right) = rayon::join(|| offset(0), || offset(1));
    // What could fail, faces without area and numbers that are not finite, has been left out.
    let crossings = match (&left, &right) {
        (Some(l), Some(r)) => intersection_curves(&l.offset, &r.offset, &Watch::default()).unwrap_or_default(),
        _ => vec![],
    };
    let (open, mut closed): (Vec<_>, Vec<_>) = crossings.into_iter().partition(|c| !c.closed);
    let chain = join(open, radius.base);
    let mut open = None;
    match chain {
        Some(c) if c.closed => closed.push(c),
        c => open = c,
    }
    let found = longest(closed);
    // A chain that ends where a patch was cut off goes on beyond.
    let beyond = |o: &Curve| found.as_ref().is_none_or(|c| length(o) > length(c));
    if base.alpha < MAX_ALPHA && open.as_ref().is_some_and(beyond) {
        return Ok(Trace::RanOff);
    }
    let (Some(found), Some(left), Some(right)) = (found, left, right) else {
        let start = curve.halfedges.first().map_or(DVec3::ZERO, |&h| mesh.position(mesh.tail(h)));
        let at = open.and_then(|o| o.points.last().copied()).map_or(start, |p| p.position);
        return Err(Error::NoLoop { at, radius: radius.at(at).0 });
    };
    let spine = unfolded(&found, convexity, [&left, &right], radius)?;
    if spine.length() / step > MOST_SAMPLES {
        return Err(Error::TooFine { at: spine.start(), length: spine.length(), step });
    }
    Ok(Trace::Closed(spine.contacts(mesh, base.patches, radius, step, params)))
}

/// Steps beyond this number are not worth their memory: the radius is lost beside the model.
const MOST_SAMPLES: f64 = 1e5;

/// The base patches as they were flooded.
#[derive(Clone, Copy)]
pub(crate) struct Base<'a> {
    pub patches: &'a [Patch; 2],
    /// Edges no patch was flooded across.
    pub barriers: &'a IdSet<EdgeId>,
    /// How far they were flooded, in radii.
    pub alpha: f64,
}

/// The longest open chain, with others joined to its end over gaps of at most `reach`, and closed if its start is the
/// next within reach.
///
/// Where the surface hardly turns at the blend curve, the feet lie beside it, and a crossing slips over the rim of one
/// patch for a little way.
fn join(mut open: Vec<Curve>, reach: f64) -> Option<Curve> {
    open.sort_by(|a, b| length(b).total_cmp(&length(a)));
    let mut rest: Vec<Vec<CurvePoint>> = open.into_iter().map(|c| c.points).collect();
    if rest.is_empty() {
        return None;
    }
    let mut points = rest.remove(0);
    loop {
        let (start, end) = (points[0].position, points[points.len() - 1].position);
        let gap = |chain: &[CurvePoint]| chain[0].position.distance(end);
        let next = (0..rest.len()).min_by(|&a, &b| gap(&rest[a]).total_cmp(&gap(&rest[b])));
        let next = next.filter(|&i| gap(&rest[i]) <= reach && gap(&rest[i]) < start.distance(end));
        let Some(i) = next else {
            let chain = Curve { points, closed: false };
            // A chain hardly longer than its gap is no loop.
            let closed = start.distance(end) <= reach.min(0.25 * length(&chain));
            return Some(Curve { closed, ..chain });
        };
        points.extend(rest.remove(i));
    }
}

fn longest(curves: Vec<Curve>) -> Option<Curve> {
    curves.into_iter().reduce(|best, c| if length(&c) > length(&best) { c } else { best })
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

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::{SurfacePoint, VertexId};

    /// An arc of the unit circle, from and to in degrees.
    fn arc(from: u32, to: u32) -> Curve {
        let on = SurfacePoint::Vertex(VertexId(0));
        let point = |degrees: u32| {
            let (y, x) = f64::from(degrees).to_radians().sin_cos();
            CurvePoint { position: DVec3::new(x, y, 0.0), on_a: on, on_b: on }
        };
        Curve { points: (from..=to).map(point).collect(), closed: false }
    }

    #[test]
    fn broken_chains_join_and_short_ones_stay_open() {
        let joined = join(vec![arc(300, 356), arc(0, 170), arc(174, 296)], 0.1).unwrap();
        assert!(joined.closed && joined.points.len() == 57 + 171 + 123);
        assert!((length(&joined) - std::f64::consts::TAU).abs() < 1e-3);
        // Wider gaps, the wrong direction, and a chain no longer than its gap.
        assert!(!join(vec![arc(0, 170), arc(180, 350)], 0.1).unwrap().closed);
        let mut backward = arc(180, 356);
        backward.points.reverse();
        assert!(!join(vec![arc(0, 176), backward], 0.1).unwrap().closed);
        assert!(!join(vec![arc(0, 4)], 0.1).unwrap().closed);
        assert!(join(vec![], 0.1).is_none());
    }
}
