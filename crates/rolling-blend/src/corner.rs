//! Where curves meet: how far each is set back, the ball that touches all sides if there is one, and the curves on the
//! sides that join the linkages of neighbours.

use crate::network::{Dart, Node};
use crate::stretch::{Outward, Stretch, bezier};
use crate::trouble::Trouble;
use glam::{DMat3, DVec3};
use mesh_core::{Connected, Positions, SurfacePoint, TriMesh};
use mesh_query::ClosestPoint;
use spine::{Patch, Rail, Sample};

/// A corner as it is to be built.
pub(crate) struct Corner {
    /// The curves' ends, counter-clockwise.
    pub darts: Vec<Dart>,
    /// The ball that touches every side, if one does: centre and radius.
    pub ball: Option<(DVec3, f64)>,
    /// For each dart, points of the surface between its left foot and the next dart's right one, with normals.
    pub joints: Vec<Vec<(SurfacePoint, DVec3)>>,
}

/// Where the rails of a corner are cut.
pub(crate) struct Setbacks {
    pub ball: Option<(DVec3, f64)>,
    /// For each dart: where on its rail, and what its last ball is if that is known better.
    pub cuts: Vec<(f64, Option<Sample>)>,
    /// For each sector, where the linkages on it cross.
    crossings: Vec<Option<DVec3>>,
}

/// How much farther than needed the rails are set back where no ball touches all sides, as a share of the radius: room
/// for a patch between them that need not turn more sharply than they do.
const SETBACK: f64 = 0.5;
/// Linkages that meet at less than this cosine run past each other: 165 degrees.
const STRAIGHT_ON: f64 = -0.966;

/// Finds how far back from `node` every rail is cut.
pub(crate) fn set_back(
    mesh: &Connected<TriMesh>,
    node: &Node,
    rails: &[Option<Rail>],
    step: f64,
) -> Result<Setbacks, Trouble> {
    let place = mesh.position(node.vertex);
    let missing = || Trouble::at("the ball cannot roll on", vec![place]);
    let views = node
        .darts
        .iter()
        .map(|&d| rails[d.curve].as_ref().map(|r| Outward { rail: r, end: d.end }))
        .collect::<Option<Vec<_>>>()
        .ok_or_else(missing)?;
    let k = views.len();
    let crossings: Vec<Option<Meeting>> = (0..k)
        .map(|i| {
            meeting(&views[i], node.darts[i].end, &views[(i + 1) % k], node.darts[(i + 1) % k].right(), place, step)
        })
        .collect();
    let alike = views.iter().all(|v| v.rail.convexity == views[0].rail.convexity);
    if alike && let Some(found) = crossings.iter().copied().collect::<Option<Vec<Meeting>>>() {
        let sides: Vec<&Patch> = (0..k).map(|i| &views[i].rail.patches[node.darts[i].end]).collect();
        let radius = views.iter().enumerate().map(|(i, v)| v.sample(found[i].at[0]).radius).sum::<f64>() / k as f64;
        let guess = (0..k).map(|i| views[i].sample(found[i].at[0]).center).sum::<DVec3>() / k as f64;
        if let Some((center, feet)) = seat_in_corner(mesh, &sides, guess, radius)
            && (0..k).all(|i| feet[i].point.distance(found[i].place) < 0.5 * radius)
        {
            let feet: Vec<_> = (0..k).map(|i| fair_foot(mesh, sides[i], feet[i], found[i].place, radius)).collect();
            let cuts = (0..k)
                .map(|i| {
                    let mut own = [feet[i]; 2];
                    own[node.darts[i].right()] = feet[(i + k - 1) % k];
                    // The rail's last ball but one stays clear of the corner's.
                    let at = views[i].advance(views[i].nearest(center), 0.35 * step);
                    (at, Some(Sample { center, radius, feet: own, ..views[i].sample(at) }))
                })
                .collect();
            let crossings = feet.iter().map(|f| Some(f.point)).collect();
            return Ok(Setbacks { ball: Some((center, radius)), cuts, crossings });
        }
    }
    let mut cuts = Vec::with_capacity(k);
    for (i, view) in views.iter().enumerate() {
        let before = crossings[(i + k - 1) % k].map(|m| m.at[1]);
        let after = crossings[i].map(|m| m.at[0]);
        let own = view.nearest(place);
        let reached = view.sample(own);
        if own == 0.0 && before.is_none() && after.is_none() && view.before_end(place) > 0.5 * reached.radius {
            return Err(Trouble::at("the ball cannot roll on", vec![reached.center]));
        }
        let needed = [before, after].map(|at| at.unwrap_or(own)).into_iter().fold(0.0, f64::max);
        cuts.push((view.advance(needed, SETBACK * reached.radius), None));
    }
    Ok(Setbacks { ball: None, cuts, crossings: crossings.iter().map(|m| m.map(|m| m.place)).collect() })
}

/// Joins the linkages of neighbouring darts over their sector, once the rails are cut.
pub(crate) fn join(
    mesh: &Connected<TriMesh>,
    node: &Node,
    setbacks: &Setbacks,
    stretches: &[Option<Stretch>],
    step: f64,
) -> Option<Corner> {
    let k = node.darts.len();
    let mut joints = Vec::with_capacity(k);
    for i in 0..k {
        if setbacks.ball.is_some() {
            joints.push(Vec::new());
            continue;
        }
        let (from, to) = (node.darts[i], node.darts[(i + 1) % k]);
        let tip = |dart: Dart, side: usize| {
            let stretch = stretches[dart.curve].as_ref()?;
            let (last, before) = stretch.last_two(dart.end);
            let foot = last.feet[side].point;
            let inwards = (foot - before.feet[side].point).normalize_or_zero();
            Some((foot, inwards, (foot - last.center).normalize_or_zero() * stretch.outwards()))
        };
        let ((p, u, n), (q, v, m)) = (tip(from, from.end)?, tip(to, to.right())?);
        let patch = &stretches[from.curve].as_ref()?.rail.patches[from.end];
        let chord = p.distance(q);
        let apex = setbacks.crossings[i].or_else(|| lines_meet(p, u, q, v, 4.0 * chord));
        let controls = match apex {
            Some(x) => [p, p.lerp(x, 0.6), q.lerp(x, 0.6), q],
            None => [p, p + 0.4 * chord * u, q + 0.4 * chord * v, q],
        };
        let pieces = (1.2 * chord / step).ceil().clamp(1.0, 256.0) as usize;
        let inner = (1..pieces).filter_map(|j| {
            let t = j as f64 / pieces as f64;
            let on = patch.closest(mesh, bezier(controls, t))?;
            Some((on.surface_point(mesh), n.lerp(m, t)))
        });
        joints.push(inner.collect());
    }
    Some(Corner { darts: node.darts.clone(), ball: setbacks.ball, joints })
}

/// Where the linkages on a side end that a corner's ball touches at `foot` and that cross at `crossing`. Between facets a
/// ball touches several, and the foot on either is behind the linkage on the other; fair linkages cross between them.
fn fair_foot(
    mesh: &Connected<TriMesh>,
    side: &Patch,
    foot: ClosestPoint,
    crossing: DVec3,
    radius: f64,
) -> ClosestPoint {
    let fair = side.closest(mesh, crossing);
    fair.filter(|fair| fair.point.distance(foot.point) > 1e-3 * radius).unwrap_or(foot)
}

/// Where two linkages on one side cross.
#[derive(Clone, Copy)]
struct Meeting {
    /// Place on the first and the second rail, outwards.
    at: [f64; 2],
    place: DVec3,
}

/// The crossing of the linkage of `a` on side `sa` with that of `b` on side `sb`, as far as both are near `node`.
fn meeting(a: &Outward, sa: usize, b: &Outward, sb: usize, node: DVec3, step: f64) -> Option<Meeting> {
    let chain = |v: &Outward, side: usize| -> Vec<DVec3> { (0..v.len()).map(|i| v.raw(i).feet[side].point).collect() };
    let (p, q) = (chain(a, sa), chain(b, sb));
    let reach = 40.0 * a.raw(0).radius.max(b.raw(0).radius);
    let near = |s: &[DVec3]| s[0].distance_squared(node) < reach * reach;
    let mut best: Option<(f64, Meeting)> = None;
    for (i, s) in p.windows(2).enumerate().filter(|(_, s)| near(s)) {
        let (middle, half) = (s[0].midpoint(s[1]), 0.5 * s[0].distance(s[1]));
        for (j, t) in q.windows(2).enumerate().filter(|(_, t)| near(t)) {
            let gap = middle.distance(t[0].midpoint(t[1])) - half - 0.5 * t[0].distance(t[1]);
            if best.is_some_and(|(d, _)| gap > d) {
                continue;
            }
            let (x, y) = closest_between([s[0], s[1]], [t[0], t[1]]);
            let (from, to) = (s[0].lerp(s[1], x), t[0].lerp(t[1], y));
            let d = from.distance(to);
            if best.is_none_or(|(least, _)| d < least) {
                best = Some((d, Meeting { at: [i as f64 + x, j as f64 + y], place: from.midpoint(to) }));
            }
        }
    }
    let (distance, meeting) = best?;
    let direction = |c: &[DVec3], at: f64| {
        let i = (at as usize).min(c.len() - 2);
        (c[i + 1] - c[i]).normalize_or_zero()
    };
    let apart = direction(&p, meeting.at[0]).dot(direction(&q, meeting.at[1]));
    (distance < 0.25 * step && apart > STRAIGHT_ON).then_some(meeting)
}

/// Parameters in [0, 1] of the points of two segments that are closest to each other.
pub(crate) fn closest_between([p0, p1]: [DVec3; 2], [q0, q1]: [DVec3; 2]) -> (f64, f64) {
    let (u, v, w) = (p1 - p0, q1 - q0, p0 - q0);
    let (a, b, c, d, e) = (u.dot(u), u.dot(v), v.dot(v), u.dot(w), v.dot(w));
    let unit = |x: f64| if x.is_nan() { 0.0 } else { x.clamp(0.0, 1.0) };
    let det = a * c - b * b;
    let mut s = if det > 1e-12 * a * c { unit((b * e - c * d) / det) } else { 0.0 };
    let t = unit((b * s + e) / c);
    s = unit((b * t - d) / a);
    (s, unit((b * s + e) / c))
}

/// The middle of the shortest link between two lines, if it lies ahead of both, within `reach`.
fn lines_meet(p: DVec3, u: DVec3, q: DVec3, v: DVec3, reach: f64) -> Option<DVec3> {
    let (w, c) = (p - q, u.dot(v));
    let det = 1.0 - c * c;
    let (s, t) = ((c * w.dot(v) - w.dot(u)) / det, (w.dot(v) - c * w.dot(u)) / det);
    (det > 1e-3 && s > 0.0 && t > 0.0 && s < reach && t < reach).then(|| (p + s * u).midpoint(q + t * v))
}

/// The centre near `guess` of a ball that touches all `sides`, with its feet: Newton, in the least-squares sense for more
/// than three. `None` where not every side is touched to 1e-9 of the radius.
fn seat_in_corner(
    mesh: &Connected<TriMesh>,
    sides: &[&Patch],
    guess: DVec3,
    radius: f64,
) -> Option<(DVec3, Vec<ClosestPoint>)> {
    let mut center = guess;
    for _ in 0..30 {
        let feet = sides.iter().map(|s| s.closest(mesh, center)).collect::<Option<Vec<_>>>()?;
        if feet.iter().all(|f| (f.distance - radius).abs() <= 1e-10 * radius) {
            return Some((center, feet));
        }
        let (mut normal, mut rhs) = (DMat3::ZERO, DVec3::ZERO);
        for f in &feet {
            let n = (center - f.point).try_normalize()?;
            normal += DMat3::from_cols(n * n.x, n * n.y, n * n.z);
            rhs += (radius - f.distance) * n;
        }
        if normal.determinant().abs() < 1e-6 {
            return None;
        }
        center += (normal.inverse() * rhs).clamp_length_max(0.5 * radius);
        if center.is_nan() || center.distance(guess) > 4.0 * radius {
            return None;
        }
    }
    None
}
