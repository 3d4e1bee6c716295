//! Whether two closed triangles share a point. Exact, for coplanar and degenerate triangles too.

use crate::predicate::{facing, largest, locate, scaled, side, turn, volume_sign};
use glam::DVec3;

/// Whether two closed triangles share at least one point. Exact; triangles may be coplanar, or degenerate to a segment
/// or a point. A triangle with a coordinate that is not finite meets nothing.
pub fn triangles_intersect(p: [DVec3; 3], q: [DVec3; 3]) -> bool {
    let all = [p[0], p[1], p[2], q[0], q[1], q[2]];
    let size = largest(&all);
    if !size.is_finite() {
        return false;
    }
    let s = scaled(&all[..], size);
    meet(&[s[0], s[1], s[2]], &[s[3], s[4], s[5]])
}

/// [`triangles_intersect`] on scaled points.
pub(crate) fn meet(p: &[DVec3; 3], q: &[DVec3; 3]) -> bool {
    let apart = |t: &[DVec3; 3], u: &[DVec3; 3]| {
        let s = side(t, u[0]);
        s != 0 && s == side(t, u[1]) && s == side(t, u[2])
    };
    if !boxes_meet(p, q) || apart(p, q) || apart(q, p) {
        return false;
    }
    // Two triangles meet exactly if a side of one meets the other.
    (0..3).any(|k| segment_meets(p[k], p[(k + 1) % 3], q)) || (0..3).any(|k| segment_meets(q[k], q[(k + 1) % 3], p))
}

/// Whether two triangles that share the corner `p[i]` = `q[j]` share another point.
pub(crate) fn meet_beyond_corner(p: &[DVec3; 3], i: usize, q: &[DVec3; 3], j: usize) -> bool {
    // Whatever they share is convex and contains the corner, so it reaches the side opposite in one of them.
    segment_meets(p[(i + 1) % 3], p[(i + 2) % 3], q) || segment_meets(q[(j + 1) % 3], q[(j + 2) % 3], p)
}

/// Whether two triangles on the common side `u`–`v` with third corners `a` and `b` overlap beyond it.
pub(crate) fn fold(u: DVec3, v: DVec3, a: DVec3, b: DVec3) -> bool {
    if volume_sign(u, v, a, b) != 0 {
        return false;
    }
    facing(&[u, v, a]).is_none_or(|(axis, s)| turn(axis, u, v, b) == s)
}

/// Whether a closed segment meets a closed triangle.
pub(crate) fn segment_meets(a: DVec3, b: DVec3, t: &[DVec3; 3]) -> bool {
    let (sa, sb) = (side(t, a), side(t, b));
    if sa == sb && sa != 0 {
        return false;
    }
    if sa == 0 && sb == 0 {
        let Some((axis, _)) = facing(t) else {
            return (0..3).any(|k| segments_meet(a, b, t[k], t[(k + 1) % 3]));
        };
        return locate(axis, a, t).is_some()
            || locate(axis, b, t).is_some()
            || (0..3).any(|k| segments_meet(a, b, t[k], t[(k + 1) % 3]));
    }
    let s = [0, 1, 2].map(|k| volume_sign(a, b, t[k], t[(k + 1) % 3]));
    !(s.contains(&1) && s.contains(&-1))
}

/// Whether two closed segments share a point.
fn segments_meet(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> bool {
    if volume_sign(a, b, c, d) != 0 {
        return false;
    }
    let within = |p: DVec3, q: DVec3, r: DVec3| p.min(q).cmple(r).all() && r.cmple(p.max(q)).all();
    let Some((axis, _)) = facing(&[a, b, c]).or(facing(&[a, b, d])).or(facing(&[c, d, a])).or(facing(&[c, d, b]))
    else {
        // All on one line: there, boxes tell.
        return a.min(b).cmple(c.max(d)).all() && c.min(d).cmple(a.max(b)).all();
    };
    let o = [turn(axis, a, b, c), turn(axis, a, b, d), turn(axis, c, d, a), turn(axis, c, d, b)];
    (o[0] == 0 && within(a, b, c))
        || (o[1] == 0 && within(a, b, d))
        || (o[2] == 0 && within(c, d, a))
        || (o[3] == 0 && within(c, d, b))
        || (o[0] * o[1] < 0 && o[2] * o[3] < 0)
}

fn boxes_meet(p: &[DVec3; 3], q: &[DVec3; 3]) -> bool {
    let low = |t: &[DVec3; 3]| t[0].min(t[1]).min(t[2]);
    let high = |t: &[DVec3; 3]| t[0].max(t[1]).max(t[2]);
    low(p).cmple(high(q)).all() && low(q).cmple(high(p)).all()
}
