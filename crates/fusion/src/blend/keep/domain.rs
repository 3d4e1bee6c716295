//! The region laid onto the surface's rectangle, smoothed there, and lifted onto the surface.

use super::Params;
use super::border::outline;
use super::refusal::Refusal;
use super::region::Region;
use super::target::Target;
use glam::{DVec2, DVec3};
use mesh_core::{Adjacency, Faces, HalfedgeId, TriMesh};
use param_conformal::{Error as MapError, Outline, RingMap, Weights, map_ring_with, relax};

/// How far an edge may stand off the surface, in radii: an arc's edge that turns by 75 degrees.
const MOST_SAGITTA: f64 = 0.2;

/// The new position of each vertex of the region.
pub(super) fn settle(region: &Region, target: &Target, params: &Params) -> Result<Vec<DVec3>, Refusal> {
    let (cut, outline) = outline(region, target)?;
    let mut map = flatten(region, &cut, &outline, params)?;
    relax(&region.local, &mut map, |p| target.point(p), &params.relaxation);
    let distortion = map.distortion(&region.local);
    if let Some(&face) = distortion.flipped.first() {
        let at = region.local.mesh().triangle(face).iter().sum::<DVec3>() / 3.0;
        return Err(Refusal::Flipped { face: region.faces[face.index()], at, count: distortion.flipped.len() });
    }
    let points: Vec<DVec3> = map.points.as_slice().iter().map(|&p| target.point(p)).collect();
    check_fineness(region, target, &map, &points)?;
    Ok(points)
}

/// Conformal where that turns no triangle over; else with equal weights, from where smoothing goes on.
fn flatten(
    region: &Region,
    cut: &param_conformal::CutRing,
    outline: &Outline,
    params: &Params,
) -> Result<RingMap, Refusal> {
    let map = |weights| map_ring_with(&region.local, cut, outline, params.seam, weights);
    let refused = |source: MapError| Refusal::Map { at: region.local.mesh().positions[0], source };
    match map(Weights::Cotangent) {
        Err(MapError::Flipped { .. } | MapError::Loose { .. } | MapError::Singular { .. }) => {
            map(Weights::Uniform).map_err(refused)
        }
        other => other.map_err(refused),
    }
}

/// Refuses where an edge stands off the surface by too much.
fn check_fineness(region: &Region, target: &Target, map: &RingMap, points: &[DVec3]) -> Result<(), Refusal> {
    let local: &mesh_core::Connected<TriMesh> = &region.local;
    for h in (0..3 * local.face_count()).map(HalfedgeId::from) {
        if local.twin(h).is_some_and(|t| t < h) {
            continue;
        }
        let [p, q]: [DVec2; 2] = [h, h.next()].map(|c| map.corner(local, c));
        let [a, b] = [local.tail(h), local.head(h)].map(|v| points[v.index()]);
        let sagitta = target.point(p.midpoint(q)).distance(a.midpoint(b));
        if sagitta > MOST_SAGITTA * target.radius {
            return Err(Refusal::TooCoarse { at: a.midpoint(b), edge: a.distance(b), radius: target.radius, sagitta });
        }
    }
    Ok(())
}
