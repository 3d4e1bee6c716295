//! How one triangle of a meets one triangle of b, in names and not in numbers: the points are keyed by the pair of
//! vertex, edge or face that carries them, so neighbouring pairs of triangles agree on them exactly.
//!
//! Every decision is the sign of an exact predicate on input points. Zeros are explicit cases: a vertex on a face, an
//! edge through an edge, faces in one plane.

use crate::predicate::{Feature, facing, locate, pierce, side, turn};
use glam::DVec3;

/// A point at which two triangles meet: where it lies in the one and in the other.
pub(crate) type Meeting = [Feature; 2];

/// What two triangles share.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Crossing {
    /// Nothing.
    Nothing,
    /// A single point, in which they only touch.
    Point(Meeting),
    /// A segment; from its first end to its second it runs along the cross product of the normals of a and b.
    Segment([Meeting; 2]),
    /// They lie in one plane and share a segment or an area.
    Coplanar(Overlap),
    /// A triangle without area is involved: the first, or else the second.
    Degenerate(usize),
}

/// What two coplanar triangles share: a convex polygon, or one segment.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Overlap {
    /// Its corners, in no order: 2 for a segment, 3 to 6 for an area.
    pub corners: Vec<Meeting>,
    /// Its sides as pairs of indices into `corners`.
    pub sides: Vec<[u8; 2]>,
    /// Whether the normals agree.
    pub aligned: bool,
}

/// Intersects two triangles.
pub(crate) fn cross(a: &[DVec3; 3], b: &[DVec3; 3]) -> Crossing {
    let sb = b.map(|p| side(a, p));
    if one_sided(sb) {
        return Crossing::Nothing;
    }
    let sa = a.map(|p| side(b, p));
    if one_sided(sa) {
        return Crossing::Nothing;
    }
    if sa == [0; 3] || sb == [0; 3] {
        return flat(a, b);
    }
    let mut points = Points::default();
    for k in 0..3u8 {
        let (i, j) = (usize::from(k), usize::from(k + 1) % 3);
        if sa[i] == 0 {
            let (axis, _) = facing(b).unwrap_or((2, 1));
            points.push(locate(axis, a[i], b).map(|f| [Feature::Corner(k), f]));
        } else if sa[i] * sa[j] < 0 {
            points.push(pierce(a[i], a[j], b).map(|f| [Feature::Side(k), f]));
        }
        if sb[i] == 0 {
            let (axis, _) = facing(a).unwrap_or((2, 1));
            points.push(locate(axis, b[i], a).map(|f| [f, Feature::Corner(k)]));
        } else if sb[i] * sb[j] < 0 {
            points.push(pierce(b[i], b[j], a).map(|f| [f, Feature::Side(k)]));
        }
    }
    let (p, q) = match *points.as_slice() {
        [p, q] => (p, q),
        [p] => return Crossing::Point(p),
        _ => return Crossing::Nothing,
    };
    // Along na × nb the common line enters a where a's outline rises through b's plane, and b where b's falls.
    let (in_a, out_a) = passage(sa);
    let (out_b, in_b) = passage(sb);
    let starts = |m: Meeting| m[0] == in_a || m[1] == in_b;
    let ends = |m: Meeting| m[0] == out_a || m[1] == out_b;
    if starts(p) && ends(q) && !(starts(q) && ends(p)) {
        Crossing::Segment([p, q])
    } else {
        debug_assert!(starts(q) && ends(p), "{a:?} {b:?}");
        Crossing::Segment([q, p])
    }
}

fn one_sided(s: [i8; 3]) -> bool {
    s[0] != 0 && s[0] == s[1] && s[1] == s[2]
}

/// Where a triangle's outline, walked counter-clockwise, rises through a plane and where it falls. For a side in the
/// plane: the ends at which the line through it enters and leaves.
fn passage(s: [i8; 3]) -> (Feature, Feature) {
    let (mut rise, mut fall) = (None, None);
    for k in 0..3usize {
        let (j, l) = ((k + 1) % 3, (k + 2) % 3);
        let (corner, next) = (Feature::Corner(k as u8), Feature::Corner(j as u8));
        match (s[k], s[j], s[l]) {
            (-1, 1, _) => rise = Some(Feature::Side(k as u8)),
            (1, -1, _) => fall = Some(Feature::Side(k as u8)),
            (0, 1, -1) => rise = Some(corner),
            (0, -1, 1) => fall = Some(corner),
            (0, 0, 1) => (rise, fall) = (Some(next), Some(corner)),
            (0, 0, -1) => (rise, fall) = (Some(corner), Some(next)),
            (0, x, y) if x == y => (rise, fall) = (Some(corner), Some(corner)),
            _ => {}
        }
    }
    (rise.unwrap_or(Feature::Inside), fall.unwrap_or(Feature::Inside))
}

/// A few distinct meetings, without allocation.
struct Points {
    items: [Meeting; 8],
    len: usize,
}

impl Default for Points {
    fn default() -> Self {
        Self { items: [[Feature::Inside; 2]; 8], len: 0 }
    }
}

impl Points {
    fn push(&mut self, m: Option<Meeting>) {
        if let Some(m) = m
            && !self.as_slice().contains(&m)
            && self.len < self.items.len()
        {
            self.items[self.len] = m;
            self.len += 1;
        }
    }

    fn as_slice(&self) -> &[Meeting] {
        &self.items[..self.len]
    }
}

/// Two triangles in one plane, or one without area.
fn flat(a: &[DVec3; 3], b: &[DVec3; 3]) -> Crossing {
    let (Some((axis, way_a)), Some((axis_b, _))) = (facing(a), facing(b)) else {
        let bad = usize::from(facing(a).is_some());
        return if crate::contact::meet(a, b) { Crossing::Degenerate(bad) } else { Crossing::Nothing };
    };
    // The planes are parallel exactly, but rounding may have chosen another axis for b: a's serves both.
    let way_b = turn(axis, b[0], b[1], b[2]);
    debug_assert!(way_b != 0, "{axis} {axis_b}");
    let mut points = Points::default();
    for k in 0..3u8 {
        points.push(locate(axis, a[usize::from(k)], b).map(|f| [Feature::Corner(k), f]));
        points.push(locate(axis, b[usize::from(k)], a).map(|f| [f, Feature::Corner(k)]));
    }
    for k in 0..3usize {
        for l in 0..3usize {
            let (p, q, r, s) = (a[k], a[(k + 1) % 3], b[l], b[(l + 1) % 3]);
            if turn(axis, p, q, r) * turn(axis, p, q, s) < 0 && turn(axis, r, s, p) * turn(axis, r, s, q) < 0 {
                points.push(Some([Feature::Side(k as u8), Feature::Side(l as u8)]));
            }
        }
    }
    let corners = points.as_slice().to_vec();
    match corners[..] {
        [] => return Crossing::Nothing,
        [p] => return Crossing::Point(p),
        _ => {}
    }
    // A side of the common polygon lies on a side of a or of b, which holds no other of its corners.
    let on = |f: Feature, k: u8| f == Feature::Side(k) || f == Feature::Corner(k) || f == Feature::Corner((k + 1) % 3);
    let mut sides = vec![];
    for which in 0..2 {
        for k in 0..3u8 {
            let mut ends = (0..corners.len() as u8).filter(|&i| on(corners[usize::from(i)][which], k));
            if let (Some(i), Some(j), None) = (ends.next(), ends.next(), ends.next())
                && !sides.contains(&[i, j])
            {
                sides.push([i, j]);
            }
        }
    }
    Crossing::Coplanar(Overlap { corners, sides, aligned: way_a == way_b })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn t(p: [[i32; 3]; 3]) -> [DVec3; 3] {
        p.map(|q| DVec3::from(q.map(f64::from)))
    }

    /// All pairs from a small grid of triangles: what is found must agree with the independent closed test, be the same
    /// seen from b, and turn round when a is flipped.
    #[test]
    fn agrees_with_the_closed_test_and_is_symmetric() {
        let mut rng = fastrand::Rng::with_seed(1);
        let mut random = || rng.i32(0..4);
        let (mut segments, mut areas) = (0, 0);
        for _ in 0..40_000 {
            let height = random().min(1); // half of the pairs lie in one plane
            let [a, b] = [0, 1].map(|_| t([0, 1, 2].map(|_| [random(), random(), height * random()])));
            if facing(&a).is_none() || facing(&b).is_none() {
                continue;
            }
            let ab = cross(&a, &b);
            let ba = cross(&b, &a);
            let flipped = cross(&[a[0], a[2], a[1]], &b);
            match &ab {
                Crossing::Nothing => {
                    assert_eq!(ba, Crossing::Nothing);
                    assert!(!crate::contact::meet(&a, &b));
                }
                Crossing::Point(m) => {
                    assert_eq!(ba, Crossing::Point([m[1], m[0]]));
                    assert!(crate::contact::meet(&a, &b));
                }
                Crossing::Segment([p, q]) => {
                    segments += 1;
                    assert!(crate::contact::meet(&a, &b));
                    let swap = |m: &Meeting| [m[1], m[0]];
                    assert_eq!(ba, Crossing::Segment([swap(q), swap(p)]));
                    let turned = |m: &Meeting| {
                        let f = match m[0] {
                            Feature::Corner(k) => Feature::Corner((3 - k) % 3),
                            Feature::Side(k) => Feature::Side(2 - k),
                            f @ Feature::Inside => f,
                        };
                        [f, m[1]]
                    };
                    assert_eq!(flipped, Crossing::Segment([turned(q), turned(p)]));
                }
                Crossing::Coplanar(o) => {
                    areas += 1;
                    assert!(o.corners.len() == o.sides.len() || o.corners.len() == 2, "{a:?} {b:?} {o:?}");
                    assert!(matches!(&ba, Crossing::Coplanar(x) if x.corners.len() == o.corners.len()));
                }
                Crossing::Degenerate(_) => unreachable!(),
            }
        }
        assert!(segments > 1000 && areas > 100, "{segments} {areas}");
    }
}
