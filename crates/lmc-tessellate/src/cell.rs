//! Which surfaces a trilinear field makes in one cell: face and interior tests, no table.
//!
//! Corners are numbered by their bits (x, y, z). Edges are numbered 4·axis + the two other bits of their lower corner.

/// The corner at the low end of an edge; the high end has bit `axis` set too.
pub(crate) const fn low_corner(edge: usize) -> usize {
    let (axis, k) = (edge / 4, edge % 4);
    (k & 1) << ((axis + 1) % 3) | (k >> 1) << ((axis + 2) % 3)
}

/// The axis of an edge.
pub(crate) const fn axis(edge: usize) -> usize {
    edge / 4
}

/// The edge between two corners that differ in one bit.
const fn edge_between(p: usize, q: usize) -> usize {
    let (axis, low) = ((p ^ q).trailing_zeros() as usize, p & q);
    4 * axis + (low >> ((axis + 1) % 3) & 1) + 2 * (low >> ((axis + 2) % 3) & 1)
}

/// The corners of face 2·axis + side, counter-clockwise seen from outside the cell.
pub(crate) const fn face_corners(face: usize) -> [usize; 4] {
    let (axis, side) = (face / 2, face % 2);
    let (b, c, base) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3), side << axis);
    if side == 1 { [base, base | b, base | b | c, base | c] } else { [base, base | c, base | b | c, base | b] }
}

/// Whether two edges lie in one face of the cell. A chord between points on them would lie in that face, where the
/// neighbouring cell could use it too.
pub(crate) fn share_face(e: usize, f: usize) -> bool {
    let faces = |e: usize| {
        let (a, low) = (axis(e), low_corner(e));
        [(a + 1) % 3, (a + 2) % 3].map(|x| 2 * x + (low >> x & 1))
    };
    faces(e).iter().any(|x| faces(f).contains(x))
}

/// The surfaces of a cell, as the closed curves in which they meet the cell's faces.
///
/// Every curve is a sequence of crossed edges with its surface on the left, seen from where the field is positive.
/// Curves that bound one surface have one label: alone a disc, two a tunnel.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Contours {
    pub curves: Vec<Vec<u8>>,
    pub surfaces: Vec<u8>,
}

/// The bits of the corners where the field is negative. Zero counts as positive.
pub(crate) fn signs(values: &[f64; 8]) -> u8 {
    values.iter().enumerate().fold(0, |mask, (i, &v)| mask | u8::from(v < 0.0) << i)
}

/// Whether the negative corners of a face with diagonal signs hang together within it: the sign at the saddle of the
/// bilinear interpolant (\[Chernyaev1995\]). Products commute exactly, so both cells of the face agree.
fn negatives_joined(values: [f64; 4]) -> bool {
    let negative = usize::from(values[0] >= 0.0);
    values[negative] * values[negative + 2] > values[1 - negative] * values[3 - negative]
}

fn is_diagonal(values: [f64; 4]) -> bool {
    let s = values.map(|v| v < 0.0);
    s[0] == s[2] && s[1] == s[3] && s[0] != s[1]
}

/// The surfaces of a cell by the signs of its faces and of its interior.
pub(crate) fn contours(values: &[f64; 8]) -> Contours {
    // Pieces of the cell's surface on one side of the zero set, by corner.
    let mut pieces = Union::default();
    let mut next = [u8::MAX; 12];
    for face in 0..6 {
        let corners = face_corners(face);
        let v = corners.map(|c| values[c]);
        let joined = is_diagonal(v) && negatives_joined(v);
        for i in 0..4 {
            let (here, after) = (corners[i], corners[(i + 1) % 4]);
            if (v[i] < 0.0) == (v[(i + 1) % 4] < 0.0) {
                pieces.join(here, after);
            } else if v[i] >= 0.0 {
                // The curve enters here and goes round the negatives, to where they next end; negatives that hang
                // together leave only the positive corner before to go round.
                let mut end = (i + 1) % 4;
                while v[(end + 1) % 4] < 0.0 {
                    end = (end + 1) % 4;
                }
                let exit = if joined {
                    edge_between(corners[(i + 3) % 4], here)
                } else {
                    edge_between(corners[end], corners[(end + 1) % 4])
                };
                next[edge_between(here, after)] = exit as u8;
            }
        }
        if is_diagonal(v) {
            let first = usize::from((v[0] < 0.0) != joined);
            pieces.join(corners[first], corners[first + 2]);
        }
    }
    let mut found = Contours::default();
    let mut sides: Vec<[usize; 2]> = vec![];
    for start in 0..12 {
        let mut curve = vec![];
        let mut e = start;
        while next[e] != u8::MAX {
            curve.push(e as u8);
            e = std::mem::replace(&mut next[e], u8::MAX) as usize;
        }
        if !curve.is_empty() {
            let (low, high) = (low_corner(start), low_corner(start) | 1 << axis(start));
            sides.push([low, high]);
            found.curves.push(curve);
        }
    }
    if found.curves.len() > 1 {
        join_through_interior(values, &mut pieces);
    }
    // A surface parts one region of the interior from one other, and the regions form a tree.
    let keys: Vec<[usize; 2]> = sides
        .iter()
        .map(|s| {
            let [p, q] = s.map(|c| pieces.root(c));
            [p.min(q), p.max(q)]
        })
        .collect();
    found.surfaces = keys.iter().map(|k| keys.iter().position(|l| l == k).unwrap_or(0) as u8).collect();
    found
}

/// Joins the corners that hang together through the interior.
///
/// Every slice z = t is bilinear: each of its regions holds one of its corners, and diagonal corners of one sign hang
/// together by the sign of its saddle. Between the heights where a vertical edge changes sign or the saddle does,
/// slices are alike; one slice of each kind decides.
fn join_through_interior(values: &[f64; 8], pieces: &mut Union) {
    const RING: [usize; 4] = [0, 1, 3, 2];
    let low = RING.map(|c| values[c]);
    let slope = RING.map(|c| values[c | 4] - values[c]);
    let at = |t: f64| [0, 1, 2, 3].map(|i| low[i] + t * slope[i]);
    let mut heights: Vec<f64> = (0..4).map(|i| -low[i] / slope[i]).collect();
    let a = slope[0] * slope[2] - slope[1] * slope[3];
    let b = low[0] * slope[2] + slope[0] * low[2] - low[1] * slope[3] - slope[1] * low[3];
    let c = low[0] * low[2] - low[1] * low[3];
    let root = b.mul_add(b, -4.0 * a * c).sqrt();
    let q = -0.5 * (b + root.copysign(b));
    heights.extend([q / a, c / q]);
    heights.retain(|t| *t > 0.0 && *t < 1.0);
    heights.extend([0.0, 1.0]);
    heights.sort_by(f64::total_cmp);
    for pair in heights.windows(2) {
        let v = at(0.5 * (pair[0] + pair[1]));
        if is_diagonal(v) {
            // A vertical edge is cut in two at most: the part with this sign reaches an end of it.
            let corner = |i: usize| RING[i] | if (low[i] < 0.0) == (v[i] < 0.0) { 0 } else { 4 };
            let first = usize::from((v[0] < 0.0) != negatives_joined(v));
            pieces.join(corner(first), corner(first + 2));
        }
    }
}

/// Union of corners.
struct Union([u8; 8]);

impl Default for Union {
    fn default() -> Self {
        Self([0, 1, 2, 3, 4, 5, 6, 7])
    }
}

impl Union {
    fn root(&self, mut c: usize) -> usize {
        while self.0[c] as usize != c {
            c = self.0[c] as usize;
        }
        c
    }
    fn join(&mut self, p: usize, q: usize) {
        let (p, q) = (self.root(p), self.root(q));
        self.0[p.max(q)] = p.min(q) as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn trilinear(v: &[f64; 8], [x, y, z]: [f64; 3]) -> f64 {
        (0..8).fold(0.0, |sum, c| {
            let w = |bit: usize, t: f64| if c >> bit & 1 == 1 { t } else { 1.0 - t };
            sum + v[c] * w(0, x) * w(1, y) * w(2, z)
        })
    }

    /// Coordinates of the critical points of the field and of its faces, axis by axis.
    ///
    /// Around a critical point the field has no linear part, so it is constant along the three lines through it: samples
    /// on these lines cross the thinnest neck, however close to ambiguous it is.
    fn critical_coordinates(v: &[f64; 8]) -> [Vec<f64>; 3] {
        let mut found: [Vec<f64>; 3] = Default::default();
        for axis in 0..3 {
            let [p, q] = [(axis + 1) % 3, (axis + 2) % 3];
            for low in [0, 1 << axis] {
                let [a, b, c, d] = [0, 1 << p, 1 << q, 1 << p | 1 << q].map(|corner| v[low | corner]);
                let twist = a - b - c + d;
                found[p].push((a - c) / twist);
                found[q].push((a - b) / twist);
            }
        }
        // f = … + k (x - m₀)(y - m₁)(z - m₂) + Σ linear[i] xᵢ once the shift m has taken the quadratic terms away.
        let along = |axis: usize, c: usize| v[c | 1 << axis] - v[c & !(1 << axis)];
        let cubic = along(0, 6) - along(0, 2) - along(0, 4) + along(0, 0);
        let m = [0, 1, 2].map(|i| {
            let [p, q] = [(i + 1) % 3, (i + 2) % 3];
            (along(p, 0) - along(p, 1 << q)) / cubic
        });
        let gradient = |i: usize| {
            let [p, q] = [(i + 1) % 3, (i + 2) % 3];
            let [s, t] = [m[p], m[q]];
            (1.0 - s) * (1.0 - t) * along(i, 0)
                + s * (1.0 - t) * along(i, 1 << p)
                + (1.0 - s) * t * along(i, 1 << q)
                + s * t * along(i, 1 << p | 1 << q)
        };
        let product = [0, 1, 2].map(|i| -gradient(i) / cubic);
        for i in 0..3 {
            let step = (product[(i + 1) % 3] * product[(i + 2) % 3] / product[i]).sqrt();
            found[i].extend([m[i] - step, m[i] + step]);
        }
        found
    }

    /// Regions of each sign by flooding a grid of `n` planes an axis, and of those through critical points.
    fn flooded_regions(v: &[f64; 8], n: usize) -> [usize; 2] {
        let planes = critical_coordinates(v).map(|mut of_axis| {
            of_axis.retain(|t| (0.0..=1.0).contains(t));
            of_axis.extend((0..n).map(|i| i as f64 / (n - 1) as f64));
            of_axis.sort_by(f64::total_cmp);
            of_axis
        });
        let [nx, ny, nz] = [0, 1, 2].map(|axis| planes[axis].len());
        let at = |i: usize| [i % nx, i / nx % ny, i / nx / ny];
        let negative: Vec<bool> = (0..nx * ny * nz)
            .map(|i| {
                let p = at(i);
                trilinear(v, [0, 1, 2].map(|axis| planes[axis][p[axis]])) < 0.0
            })
            .collect();
        let mut seen = vec![false; negative.len()];
        let mut counts = [0, 0];
        for start in 0..seen.len() {
            if seen[start] {
                continue;
            }
            counts[usize::from(negative[start])] += 1;
            let mut stack = vec![start];
            seen[start] = true;
            while let Some(i) = stack.pop() {
                let p = at(i);
                for (axis, step) in [1, nx, nx * ny].into_iter().enumerate() {
                    let next = (p[axis] + 1 < planes[axis].len()).then_some(i + step);
                    for j in [(p[axis] > 0).then(|| i - step), next].into_iter().flatten() {
                        if !seen[j] && negative[j] == negative[i] {
                            seen[j] = true;
                            stack.push(j);
                        }
                    }
                }
            }
        }
        counts
    }

    /// Discs and tunnels only, and as many regions as flooding finds: surfaces + 1 regions in a ball.
    fn check(v: &[f64; 8]) -> Result<(), String> {
        let c = contours(v);
        let surfaces: std::collections::BTreeSet<u8> = c.surfaces.iter().copied().collect();
        let bounds = |s: u8| c.surfaces.iter().map(|&t| u8::from(t == s)).sum::<u8>();
        if surfaces.iter().any(|&s| bounds(s) > 2) {
            return Err(format!("three curves bound one surface: {v:?} {c:?}"));
        }
        let want = surfaces.len() + 1;
        for n in [12, 40] {
            let [p, q] = flooded_regions(v, n);
            if p + q == want {
                return Ok(());
            }
        }
        Err(format!("{v:?}: {c:?}, flooded {:?}", flooded_regions(v, 40)))
    }

    #[test]
    fn numbering_is_consistent() {
        for e in 0..12 {
            assert_eq!(edge_between(low_corner(e), low_corner(e) | 1 << axis(e)), e);
        }
        for f in 0..6 {
            let c = face_corners(f);
            assert!((0..4).all(|i| c[i] >> (f / 2) & 1 == f % 2 && (c[i] ^ c[(i + 1) % 4]).is_power_of_two()));
        }
    }

    /// Every crossed edge is on exactly one curve, for all sign patterns and many magnitudes.
    #[test]
    fn all_patterns_have_the_topology_of_the_trilinear_field() {
        let mut rng = fastrand::Rng::with_seed(1);
        let mut random = || rng.f64();
        for mask in 0..256 {
            for _ in 0..24 {
                let v: [f64; 8] =
                    std::array::from_fn(|i| (0.02 + random()) * if mask >> i & 1 == 1 { -1.0 } else { 1.0 });
                let mut met: Vec<u8> = contours(&v).curves.concat();
                met.sort_unstable();
                let crossed = |e: &u8| {
                    let low = low_corner(*e as usize);
                    (mask >> low ^ mask >> (low | 1 << axis(*e as usize))) & 1 == 1
                };
                assert_eq!(met, (0..12).filter(crossed).collect::<Vec<_>>());
                check(&v).unwrap();
            }
        }
    }

    /// The neck between corners 3 and 5 is 1e-5 wide: no grid of even planes found it.
    #[test]
    fn a_face_close_to_ambiguous_is_decided_by_its_saddle() {
        let m = [0.01, 0.937_484_871_044_072_1, 0.01, 0.932_248_804_554_579_3];
        let n = [0.782_736_957_916_767_9, 0.517_683_284_803_046_9, 0.01, 0.514_750_244_063_156_8];
        assert_eq!(check(&[m[0], m[1], m[2], -m[3], n[0], -n[1], -n[2], n[3]]), Ok(()));
    }

    proptest! {
        #[test]
        fn diagonal_patterns_have_the_topology_of_the_trilinear_field(m in prop::array::uniform8(0.01f64..1.0), case in 0usize..6) {
            // The patterns of the known ambiguous interiors: 4, 6, 7, 10, 12 and 13.
            let mask = [0b1000_0001, 0b1000_0011, 0b0110_1000, 0b1001_1001, 0b0110_1011, 0b0110_1001][case];
            let v: [f64; 8] = std::array::from_fn(|i| if mask >> i & 1 == 1 { -m[i] } else { m[i] });
            prop_assert_eq!(check(&v), Ok(()));
        }
    }
}
