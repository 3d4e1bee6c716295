//! Closed curves on a surface made smooth: even samples, averaged in turns that keep the length (\[Taubin1995\]), and put back.

use super::Error;
use glam::DVec3;
use mesh_core::{Connected, TraceLimits, TriMesh, face_normal};
use mesh_query::TriBvh;
use tri_intersect::embed::SurfaceCurve;

const SHRINK: f64 = 0.5;
const GROW: f64 = -0.53;
/// Most samples of a curve.
const MOST: usize = 20_000;

/// The curve after `rounds` of smoothing on the surface. Open curves stay.
pub(super) fn smoothed(mesh: &Connected<TriMesh>, curve: &SurfaceCurve, rounds: usize) -> Result<SurfaceCurve, Error> {
    let places: Vec<DVec3> = curve.points.iter().map(|p| p.position(mesh)).collect();
    if rounds == 0 || !curve.closed || places.len() < 4 {
        return Ok(curve.clone());
    }
    let lost = || Error::Lost { at: places[0] };
    let tree = TriBvh::build(mesh.mesh()).map_err(|_| lost())?;
    // A curve crosses about two edges for every edge it is long.
    let mut points = even(&places, (places.len() / 2).clamp(12, MOST));
    for _ in 0..rounds {
        for factor in [SHRINK, GROW] {
            let n = points.len();
            let moved = |i: usize| {
                let middle = 0.5 * (points[(i + n - 1) % n] + points[(i + 1) % n]);
                points[i].lerp(middle, factor)
            };
            points = (0..n).map(moved).collect();
        }
        for p in &mut points {
            *p = tree.closest_point(mesh, *p).ok_or_else(lost)?.point;
        }
    }
    let mut samples = vec![];
    for p in &points {
        let hit = tree.closest_point(mesh, *p).ok_or_else(lost)?;
        let sample = (hit.surface_point(mesh), face_normal(mesh, hit.face));
        if samples.last().is_none_or(|last: &(_, DVec3)| last.0 != sample.0) {
            samples.push(sample);
        }
    }
    let (curve, _) = SurfaceCurve::through(mesh, &samples, true, &TraceLimits::default()).map_err(|_| lost())?;
    Ok(curve)
}

/// `count` points evenly along a closed polyline.
pub(crate) fn even(places: &[DVec3], count: usize) -> Vec<DVec3> {
    let next = |i: usize| places[(i + 1) % places.len()];
    let mut lengths = vec![0.0];
    for i in 0..places.len() {
        lengths.push(lengths[i] + places[i].distance(next(i)));
    }
    let at = |k: usize| {
        let s = lengths[places.len()] * k as f64 / count as f64;
        let i = lengths.partition_point(|&l| l <= s).clamp(1, places.len()) - 1;
        let t = (s - lengths[i]) / (lengths[i + 1] - lengths[i]);
        places[i].lerp(next(i), if t.is_finite() { t } else { 0.0 })
    };
    (0..count).map(at).collect()
}
