//! The region laid onto the surface's rectangle, smoothed there, and lifted onto the surface.

use super::Params;
use super::border::outline;
use super::refusal::Refusal;
use super::region::Region;
use super::target::Target;
use crate::sketch::{Drawing, Page};
use glam::{DVec2, DVec3};
use mesh_core::{Adjacency, Connected, Faces, TriMesh, VertexId, centroid};
use param_conformal::{Error as MapError, Outline, RingMap, Weights, map_ring_with, relax};

/// How far an edge may stand off the surface, in radii: an arc's edge that turns by 63 degrees.
const MOST_SAGITTA: f64 = 0.15;

/// The new position of each vertex of the region.
pub(super) fn settle(region: &Region, target: &Target, params: &Params, page: Page<'_>) -> Result<Vec<DVec3>, Refusal> {
    let (cut, outline) = outline(region, target)?;
    let mut map = flatten(region, &cut, &outline, params)?;
    relax(&region.local, &mut map, |p| target.point(p), &params.relaxation);
    page.draw("domain", || Drawing::Mesh(flat(region, &map)));
    let distortion = map.distortion(&region.local);
    if let Some(&face) = distortion.flipped.first() {
        let at = centroid(region.local.mesh().triangle(face));
        return Err(Refusal::Flipped { face: region.faces[face.index()], at, count: distortion.flipped.len() });
    }
    let points: Vec<DVec3> = map.points.as_slice().iter().map(|&p| target.point(p)).collect();
    page.draw("surface", || {
        Drawing::Mesh(TriMesh { positions: points.clone(), faces: region.local.mesh().faces.clone() })
    });
    check_fineness(region, target, &map, &points)?;
    Ok(points)
}

/// The region in the plane: t along x, the way across along y; cut open, so that every corner is a vertex of its own.
fn flat(region: &Region, map: &RingMap) -> TriMesh {
    let corners = region.local.halfedge_ids();
    let face = |f: usize| [0, 1, 2].map(|k| VertexId::from(3 * f + k));
    TriMesh {
        positions: corners.map(|h| map.corner(&region.local, h).extend(0.0)).collect(),
        faces: (0..region.local.face_count()).map(face).collect(),
    }
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

/// Refuses where an edge stands off the ball by too much. What counts is the part of the profile that it spans, and the
/// bend of the sweep along it, so that a mesh fit for the arc is fit for any profile, sharp ones included.
fn check_fineness(region: &Region, target: &Target, map: &RingMap, points: &[DVec3]) -> Result<(), Refusal> {
    let local: &Connected<TriMesh> = &region.local;
    let most = MOST_SAGITTA * target.radius;
    for h in local.halfedge_ids() {
        if local.twin(h).is_some_and(|t| t < h) {
            continue;
        }
        let [p, q]: [DVec2; 2] = [h, h.next()].map(|c| map.corner(local, c));
        let across = target.radius * (1.0 - (0.5 * target.turn(p.x) * (p.y - q.y).abs() / target.across).cos());
        let along = target.bend * (p.x - q.x) * (p.x - q.x) / 8.0;
        // The greatest bend of all is an upper bound; where it is passed the edge's own decides.
        let along = if along > most { chord_height(target, p, q) } else { 0.0 };
        let sagitta = across.max(along);
        if sagitta > most {
            let [a, b] = [local.tail(h), local.head(h)].map(|v| points[v.index()]);
            return Err(Refusal::TooCoarse { at: a.midpoint(b), edge: a.distance(b), radius: target.radius, sagitta });
        }
    }
    Ok(())
}

/// How far the surface bends away from the chord between two stations, half way across both.
fn chord_height(target: &Target, p: DVec2, q: DVec2) -> f64 {
    let y = 0.5 * (p.y + q.y);
    let at = |x: f64| target.point(DVec2::new(x, y));
    at(0.5 * (p.x + q.x)).distance(at(p.x).midpoint(at(q.x)))
}
