//! Silhouettes: curves that the surface passes through and along which it turns away from the viewer (\[Lin2008\] §2.2).
//!
//! A stroke between two openings becomes a Bézier curve of degree five that leaves both parts along their own silhouettes. Its shape is the
//! stroke's, seen along the view, in the plane Ω through both ends whose normal is nearest to the view. A closed stroke outlines a hole and becomes
//! a smooth closed curve in the plane through the middle of the openings. Along either the field gets places and normals, the latter t × view.

use super::Error;
use super::bezier::{Bezier, closed_curve, through};
use super::openings::Opening;
use glam::DVec3;

/// A silhouette that the joint shall have in a view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Silhouette {
    /// Direction of the view, of any length but zero. Either way along it means the same.
    pub view: DVec3,
    /// What was drawn: polylines, of which only what is seen along the view matters. Several are chained end to end, each turned
    /// round where that brings its nearer end to the chain's.
    pub strokes: Vec<Vec<DVec3>>,
    /// Whether the strokes outline a hole. `None`: they do where the chain returns to within a tenth of its length of where it began.
    pub hole: Option<bool>,
    /// Other places for the two middle control points of the six. Not for holes.
    pub control: Option<[DVec3; 2]>,
    /// Moves those two along the view, in model units; the picture stays. The first moves a hole.
    pub depth: [f64; 2],
}

/// One place on a silhouette.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SilhouettePoint {
    /// Where, in model units.
    pub point: DVec3,
    /// The surface's outward unit normal, across the view.
    pub normal: DVec3,
}

/// A silhouette as it was understood.
#[derive(Clone, Debug, PartialEq)]
pub struct SilhouetteCurve {
    /// The six control points of a curve between openings; none for a hole.
    pub control: Vec<DVec3>,
    /// The places that the field interpolates, an opening's edge apart.
    pub points: Vec<SilhouettePoint>,
    /// The unit view.
    pub view: DVec3,
}

/// An opening's own silhouette: a point of its boundary whose normal is across the view.
#[derive(Clone, Copy)]
struct End {
    point: DVec3,
    normal: DVec3,
    /// Out of the part, along its surface.
    away: DVec3,
}

/// Every silhouette's curve, in order.
pub(super) fn curves(openings: &[Opening], silhouettes: &[Silhouette]) -> Result<Vec<SilhouetteCurve>, Error> {
    let curve = |(index, s): (usize, &Silhouette)| {
        curve(openings, s).map_err(|(reason, at)| Error::Silhouette { index, at, reason })
    };
    silhouettes.iter().enumerate().map(curve).collect()
}

type Trouble = (&'static str, DVec3);

fn curve(openings: &[Opening], silhouette: &Silhouette) -> Result<SilhouetteCurve, Trouble> {
    let stroke = chain(&silhouette.strokes);
    let start = stroke.first().copied().unwrap_or_default();
    let view = silhouette.view.try_normalize().ok_or(("the view must be a direction other than 0,0,0", start))?;
    let across: Vec<DVec3> = stroke.iter().map(|p| p - p.dot(view) * view).collect();
    let length: f64 = across.windows(2).map(|w| w[0].distance(w[1])).sum();
    if stroke.len() < 2 || !(length > 0.0 && length.is_finite()) || !silhouette.depth.iter().all(|d| d.is_finite()) {
        return Err(("a stroke needs two finite points or more that are apart as seen", start));
    }
    let closes = across[0].distance(across[across.len() - 1]) <= 0.1 * length;
    if silhouette.hole.unwrap_or(closes && stroke.len() > 3) {
        return hole(openings, silhouette, &across, view);
    }
    let ends = [across[0], across[across.len() - 1]];
    let chosen = ends.map(|p| nearest_opening(openings, p, view));
    let candidates = [0, 1].map(|k| silhouette_ends(chosen[k], ends[k], view));
    let seen_from = |k: usize, end: &End| (end.point - end.point.dot(view) * view).distance(ends[k]);
    let mut best: Option<(f64, (Bezier, f64))> = None;
    for from in &candidates[0] {
        for to in &candidates[1] {
            let far = seen_from(0, from) + seen_from(1, to);
            if best.as_ref().is_none_or(|b| far < b.0)
                && let Some(curve) = between(from, to, &across, view, silhouette)
            {
                best = Some((far, curve));
            }
        }
    }
    let Some((_, (bezier, sign))) = best else {
        return Err((
            "its ends cannot be led along the openings nearest to them: these are seen face on, or their silhouettes lie on other sides of the stroke; start and end it beside the openings, or change the view",
            ends[0],
        ));
    };
    let spacing = 0.5 * (chosen[0].mean_edge() + chosen[1].mean_edge());
    let clear = |p: DVec3| {
        let near = |o: &Opening| o.rim.points.iter().all(|q| q.distance_squared(p) > (0.5 * spacing).powi(2));
        chosen.iter().all(|&o| near(o))
    };
    let points = bezier
        .uniform(spacing)
        .into_iter()
        .map(|(point, tangent)| SilhouettePoint { point, normal: sign * normal_at(tangent, view) })
        .filter(|s| clear(s.point) && s.normal.is_normalized())
        .collect();
    Ok(SilhouetteCurve { control: bezier.control.to_vec(), points, view })
}

fn normal_at(tangent: DVec3, view: DVec3) -> DVec3 {
    tangent.cross(view).normalize_or_zero()
}

/// All strokes as one.
fn chain(strokes: &[Vec<DVec3>]) -> Vec<DVec3> {
    let mut all: Vec<DVec3> = vec![];
    for (i, stroke) in strokes.iter().filter(|s| !s.is_empty()).enumerate() {
        let ends = |s: &[DVec3]| (s[0], s[s.len() - 1]);
        if let (false, (a, b)) = (all.is_empty(), ends(stroke)) {
            let (head, tail) = ends(&all);
            let near = |p: DVec3| p.distance_squared(a).min(p.distance_squared(b));
            // Only the first stroke may have been drawn backwards; later ones are turned themselves.
            if i == 1 && near(head) < near(tail) {
                all.reverse();
            }
            if all[all.len() - 1].distance_squared(b) < all[all.len() - 1].distance_squared(a) {
                all.extend(stroke.iter().rev());
                continue;
            }
        }
        all.extend(stroke);
    }
    all
}

/// The opening nearest to a point as seen.
fn nearest_opening(openings: &[Opening], p: DVec3, view: DVec3) -> &Opening {
    let far = |o: &Opening| {
        let seen = o.rim.points.iter().map(|q| (q - q.dot(view) * view).distance_squared(p));
        seen.fold(f64::INFINITY, f64::min)
    };
    let best = (0..openings.len()).min_by(|&a, &b| far(&openings[a]).total_cmp(&far(&openings[b])));
    &openings[best.unwrap_or(0)]
}

/// Where the opening's normals turn across the view; where they never do, its point nearest to `p` as seen.
fn silhouette_ends(opening: &Opening, p: DVec3, view: DVec3) -> Vec<End> {
    let (normals, points) = (&opening.normals, &opening.rim.points);
    let n = points.len();
    let end = |i: usize, t: f64| {
        let j = (i + 1) % n;
        let normal = normals[i].lerp(normals[j], t);
        let normal = (normal - normal.dot(view) * view).normalize_or_zero();
        // The part is on the left of its boundary.
        End {
            point: points[i].lerp(points[j], t),
            normal,
            away: (points[j] - points[i]).cross(normal).normalize_or_zero(),
        }
    };
    let turns: Vec<End> = (0..n)
        .filter_map(|i| {
            let (a, b) = (normals[i].dot(view), normals[(i + 1) % n].dot(view));
            ((a < 0.0) != (b < 0.0)).then(|| end(i, a / (a - b)))
        })
        .filter(|e| e.normal.is_normalized())
        .collect();
    if !turns.is_empty() {
        return turns;
    }
    let seen = |i: usize| (points[i] - points[i].dot(view) * view).distance_squared(p);
    let nearest = (0..n).min_by(|&a, &b| seen(a).total_cmp(&seen(b))).unwrap_or(0);
    Some(end(nearest, 0.0)).filter(|e| e.normal.is_normalized()).into_iter().collect()
}

/// The curve between two ends along a stroke, and the sign with which t × view points out; `None` where one end cannot lead into the
/// other with the same side out.
fn between(from: &End, to: &End, across: &[DVec3], view: DVec3, silhouette: &Silhouette) -> Option<(Bezier, f64)> {
    let chord = (to.point - from.point).try_normalize()?;
    let omega = (view - view.dot(chord) * chord).try_normalize()?;
    let facing = view.dot(omega);
    if facing.abs() < 1e-3 {
        return None;
    }
    let onto = |p: DVec3| p - (p - from.point).dot(omega) / facing * view;
    let mut shape: Vec<DVec3> = across.iter().map(|&p| onto(p)).collect();
    // What was drawn over the parts themselves is left out.
    let nearest = |range: std::ops::Range<usize>, p: DVec3| {
        range.min_by(|&a, &b| shape[a].distance_squared(p).total_cmp(&shape[b].distance_squared(p)))
    };
    let half = shape.len() / 2;
    let (first, last) =
        (nearest(0..half.max(1), from.point)?, nearest(half.min(shape.len() - 1)..shape.len(), to.point)?);
    shape = if first + 1 < last { shape[first + 1..last].to_vec() } else { vec![] };
    shape.insert(0, from.point);
    shape.push(to.point);
    let leave = |end: &End, towards: DVec3| {
        let t = omega.cross(end.normal).normalize_or_zero();
        let (own, drawn) = (t.dot(end.away), t.dot(towards));
        t * if own.abs() > 0.2 { own.signum() } else { drawn.signum() }
    };
    let n = shape.len();
    let tangents = [leave(from, shape[1] - shape[0]), leave(to, shape[n - 2] - shape[n - 1])];
    // One side is out all along: the normals t × view at both ends must agree with the parts'.
    let side = |t: DVec3, end: &End| normal_at(t, view).dot(end.normal);
    if side(tangents[0], from) * side(-tangents[1], to) <= 0.0 {
        return None;
    }
    let mut bezier = through(&shape, tangents);
    if let Some(control) = silhouette.control.filter(|c| c.iter().all(|p| p.is_finite())) {
        bezier.control[2..4].copy_from_slice(&control);
    }
    for (c, depth) in bezier.control[2..4].iter_mut().zip(silhouette.depth) {
        *c += depth * view;
    }
    Some((bezier, side(tangents[0], from).signum()))
}

/// A closed curve in the plane through the middle of the openings, its normals towards the hole.
fn hole(
    openings: &[Opening],
    silhouette: &Silhouette,
    across: &[DVec3],
    view: DVec3,
) -> Result<SilhouetteCurve, Trouble> {
    let centres = openings.iter().map(|o| o.rim.points.iter().sum::<DVec3>() / o.rim.points.len() as f64);
    let depth = centres.map(|c| c.dot(view)).sum::<f64>() / openings.len() as f64 + silhouette.depth[0];
    let spacing = openings.iter().map(Opening::mean_edge).fold(f64::INFINITY, f64::min);
    let shape: Vec<DVec3> = across.iter().map(|p| p + depth * view).collect();
    let samples = closed_curve(&shape, spacing);
    let area: DVec3 = (0..samples.len())
        .map(|i| (samples[i].0 - samples[0].0).cross(samples[(i + 1) % samples.len()].0 - samples[0].0))
        .sum();
    let length: f64 = samples.windows(2).map(|w| w[0].0.distance(w[1].0)).sum();
    if samples.len() < 4 || area.dot(view).abs() <= 1e-3 * length * length {
        return Err(("the outline of a hole must go round an area", shape[0]));
    }
    // Counter-clockwise about the view, t × view points outward; the solid is there.
    let sign = -area.dot(view).signum();
    let point = |&(point, tangent): &(DVec3, DVec3)| SilhouettePoint { point, normal: sign * normal_at(tangent, view) };
    let points = samples.iter().map(point).filter(|s| s.normal.is_normalized()).collect();
    Ok(SilhouetteCurve { control: vec![], points, view })
}
