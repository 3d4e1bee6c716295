//! What varies along a curve: a monotone cubic through given places for the radius, and where between them it is.

use glam::DVec3;

/// A share of the radius for every place along a curve, C¹ in the curve's length.
///
/// Between two keys the share is monotone (\[FritschCarlson1980\]). An open curve has the resting share at its ends, a
/// closed one with a single key half-way round from it; a key at an end takes its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    /// The curve, its beginning repeated at the end if it is closed.
    points: Vec<DVec3>,
    /// Length from the beginning to each point.
    lengths: Vec<f64>,
    knots: Vec<Knot>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Knot {
    length: f64,
    share: f64,
    slope: f64,
}

/// Keys nearer to each other, or to an end, than this share of the curve are one.
const ONE_PLACE: f64 = 1e-6;

impl Law {
    /// The law with `keys`, places near the curve through `points` and their shares of the radius; shares are positive.
    /// Of two keys at one place the first counts. `None` where the curve has no length.
    pub fn new(mut points: Vec<DVec3>, closed: bool, keys: &[(DVec3, f64)], rest: f64) -> Option<Self> {
        if closed {
            points.push(*points.first()?);
        }
        let mut lengths = vec![0.0];
        for pair in points.windows(2) {
            lengths.push(lengths[lengths.len() - 1] + pair[0].distance(pair[1]));
        }
        let total = *lengths.last()?;
        if !(total > 0.0 && total.is_finite()) {
            return None;
        }
        let mut law = Self { points, lengths, knots: Vec::new() };
        let mut places: Vec<(f64, f64)> = keys.iter().map(|&(at, share)| (law.nearest(at).0, share)).collect();
        if closed {
            if let [(only, _)] = places[..] {
                places.push(((only + 0.5 * total) % total, rest));
            }
        } else {
            for end in [0.0, total] {
                if places.iter().all(|p| (p.0 - end).abs() >= ONE_PLACE * total) {
                    places.push((end, rest));
                }
            }
        }
        // Stable, so that of two at one place the first given stays.
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        law.knots = places.iter().map(|&(length, share)| Knot { length, share, slope: 0.0 }).collect();
        law.knots.dedup_by(|next, kept| next.length - kept.length < ONE_PLACE * total);
        law.slope(closed);
        Some(law)
    }

    /// Slopes that keep every piece monotone: zero where the share turns, else harmonic means of the pieces' own.
    fn slope(&mut self, closed: bool) {
        let (n, total) = (self.knots.len(), self.total());
        let piece = |a: Knot, b: Knot| {
            let length = if b.length > a.length { b.length - a.length } else { b.length - a.length + total };
            (length, (b.share - a.share) / length)
        };
        for i in 0..n {
            let inner = closed && n > 1 || i > 0 && i + 1 < n;
            if inner {
                let (before, here, after) = (self.knots[(i + n - 1) % n], self.knots[i], self.knots[(i + 1) % n]);
                let ((g, d), (h, e)) = (piece(before, here), piece(here, after));
                let (u, v) = (2.0 * h + g, h + 2.0 * g);
                self.knots[i].slope = if d * e > 0.0 { (u + v) / (u / d + v / e) } else { 0.0 };
            }
        }
    }

    fn total(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// The share at the point of the curve nearest to `x`, and its gradient by `x`.
    pub fn at(&self, x: DVec3) -> (f64, DVec3) {
        let (length, along) = self.nearest(x);
        let (share, slope) = self.share(length);
        (share, slope * along)
    }

    /// Length along the curve of its point nearest to `x`, and the gradient of that length.
    fn nearest(&self, x: DVec3) -> (f64, DVec3) {
        let mut best = (f64::INFINITY, 0.0, DVec3::ZERO);
        for (i, pair) in self.points.windows(2).enumerate() {
            let way = pair[1] - pair[0];
            let length = way.length();
            if length == 0.0 {
                continue;
            }
            let t = (x - pair[0]).dot(way) / (length * length);
            let clamped = t.clamp(0.0, 1.0);
            let distance = x.distance_squared(pair[0] + clamped * way);
            if distance < best.0 {
                let along = if t == clamped { way / length } else { DVec3::ZERO };
                best = (distance, self.lengths[i] + clamped * length, along);
            }
        }
        (best.1, best.2)
    }

    /// The shares at the keys before and after the point of the curve nearest to `x`, and how far it is from one to the
    /// other: from 0 to 1, smoothly at both.
    pub fn between(&self, x: DVec3) -> ([f64; 2], f64) {
        let (a, b, _, t) = self.piece(self.nearest(x).0);
        ([a.share, b.share], t * t * (3.0 - 2.0 * t))
    }

    /// The knots around a length, how far they are apart, and the place between them in [0, 1].
    fn piece(&self, length: f64) -> (Knot, Knot, f64, f64) {
        let after = self.knots.partition_point(|k| k.length <= length);
        let n = self.knots.len();
        let (a, b) = (self.knots[(after + n - 1) % n], self.knots[after % n]);
        let wrapped = |x: f64| if x < 0.0 { x + self.total() } else { x };
        let (h, s) = (wrapped(b.length - a.length), wrapped(length - a.length));
        let beyond = h == 0.0 || after == n && s > h;
        (a, b, h, if beyond { 0.0 } else { s / h })
    }

    fn share(&self, length: f64) -> (f64, f64) {
        let (a, b, h, t) = self.piece(length);
        if t == 0.0 {
            return (a.share, a.slope);
        }
        let (rise, p, q) = (b.share - a.share, a.slope * h, b.slope * h);
        let (c2, c3) = (3.0 * rise - 2.0 * p - q, p + q - 2.0 * rise);
        (a.share + t * (p + t * (c2 + t * c3)), (p + t * (2.0 * c2 + 3.0 * t * c3)) / h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn line() -> Vec<DVec3> {
        (0..=10).map(|i| DVec3::new(f64::from(i), 0.0, 0.0)).collect()
    }

    #[test]
    fn an_open_curve_rests_at_its_ends_unless_keyed_there() {
        let law = Law::new(line(), false, &[(DVec3::new(5.0, 1.0, 0.0), 1.0)], 0.25).unwrap();
        let at = |x: f64| law.at(DVec3::new(x, 2.0, 0.0)).0;
        assert_eq!([at(-1.0), at(0.0), at(5.0), at(10.0), at(11.0)], [0.25, 0.25, 1.0, 0.25, 0.25]);
        let keys = [(DVec3::ZERO, 0.5), (DVec3::new(10.0, 0.0, 0.0), 1.0)];
        let law = Law::new(line(), false, &keys, 0.25).unwrap();
        assert_eq!([0.0, 10.0].map(|x| law.at(DVec3::new(x, 0.0, 3.0)).0), [0.5, 1.0]);
    }

    #[test]
    fn a_closed_curve_rests_opposite_its_only_key() {
        let square = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let law = Law::new(square.clone(), true, &[(0.5 * DVec3::X, 1.0)], 0.5).unwrap();
        assert_eq!(law.at(DVec3::new(0.5, 1.0, 0.0)).0, 0.5);
        assert_eq!(law.at(DVec3::new(0.5, -1.0, 0.0)).0, 1.0);
        // The two ways round are mirror images.
        assert!((law.at(DVec3::new(0.0, 0.3, 0.0)).0 - law.at(DVec3::new(1.0, 0.3, 0.0)).0).abs() < 1e-15);
        let two = Law::new(square, true, &[(0.5 * DVec3::X, 1.0), (DVec3::new(0.5, 1.0, 0.0), 0.2)], 0.7).unwrap();
        assert_eq!(two.at(DVec3::new(0.5, 1.0, 0.0)).0, 0.2);
    }

    proptest! {
        /// Never beyond the keys on either side, and with the gradient of finite differences.
        #[test]
        fn between_keys_it_is_monotone_and_smooth(
            shares in proptest::collection::vec(0.1f64..1.0, 1..5),
            places in proptest::collection::vec(0.1f64..9.9, 5),
            x in 0.01f64..9.99,
        ) {
            let keys: Vec<_> = shares.iter().zip(&places).map(|(&s, &p)| (DVec3::new(p, 0.0, 0.0), s)).collect();
            let law = Law::new(line(), false, &keys, 0.5).unwrap();
            let at = |x: f64| law.at(DVec3::new(x, 1.0, 0.0)).0;
            let after = law.knots.partition_point(|k| k.length <= x);
            let ends = [law.knots[after - 1].share, law.knots[after.min(law.knots.len() - 1)].share];
            prop_assert!(at(x) >= ends[0].min(ends[1]) - 1e-12 && at(x) <= ends[0].max(ends[1]) + 1e-12);
            let h = 1e-6;
            let slope = (at(x + h) - at(x - h)) / (2.0 * h);
            let told = law.at(DVec3::new(x, 1.0, 0.0)).1.x;
            let near_knot = law.knots.iter().any(|k| (k.length - x).abs() < 1e-5);
            prop_assert!(near_knot || (slope - told).abs() < 1e-5 * (1.0 + told.abs()) || x.fract() < 1e-5 || x.fract() > 1.0 - 1e-5);
        }
    }
}
