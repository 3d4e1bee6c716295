//! Hartmann's blend of two patches along an open edge (\[Hartmann2001\], eqs. 12 and 13 of \[EdgeCluster2019\]).

use crate::patch::Patch;
use glam::{DVec2, DVec3};

/// The strip that replaces the degenerate corners of two patches at the ends of one open edge, and the edge between.
///
/// x(s,t) = f(t)·x1(s,t) + (1 − f(t))·x2(s,t), from the first patch at t = 0 to the second at t = 1. Side s = 0 lies in
/// the face to the right of the edge from the first to the second, s = 1 in the face to its left.
#[derive(Clone, Copy, Debug)]
pub struct Strip {
    /// The patches, by cluster, and which of their corners is at the edge.
    pub ends: [(usize, usize); 2],
    /// How it is blended.
    pub params: Params,
}

/// How a strip is blended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// Order of contact h with both patches, 0 to 20.
    pub order: usize,
    /// Balance μ in (0, 1): above ½ the strip follows the first patch longer.
    pub balance: f64,
    /// Where the patches are cut off: the share of each side from the corner, in (0, ½).
    pub cut: f64,
    /// How far into its own corner each patch is followed, as a share of `cut`, in [0, 1).
    pub follow: f64,
}

impl Default for Params {
    fn default() -> Self {
        Self { order: 1, balance: 0.5, cut: 0.36, follow: 0.5 }
    }
}

impl Params {
    /// f(t): 1 at the first patch, 0 at the second, with `order` derivatives vanishing at both.
    pub fn weight(&self, t: f64) -> f64 {
        let power = i32::try_from(self.order).unwrap_or(20) + 1;
        let (a, b) = (self.balance * (1.0 - t).powi(power), (1.0 - self.balance) * t.powi(power));
        a / (a + b)
    }

    /// Share of the sides from the corner of the first patch at t; of the second at 1 − t.
    fn share(&self, t: f64) -> f64 {
        self.cut * (1.0 + (self.follow - 1.0) * t)
    }
}

impl Strip {
    /// Where x1 and x2 are taken at (s, t): bilinear in both patches' domains.
    pub fn domain(&self, patches: &[Patch], s: f64, t: f64) -> [DVec2; 2] {
        let across = |end: usize, s: f64, share: f64| {
            let (patch, k) = (&patches[self.ends[end].0], self.ends[end].1);
            let before = patch.side(k + patch.sides() - 1, 1.0 - share);
            before.lerp(patch.side(k, share), s)
        };
        // Seen from the second patch the edge runs the other way, and left is right.
        [across(0, s, self.params.share(t)), across(1, 1.0 - s, self.params.share(1.0 - t))]
    }

    /// The strip at (s, t) in [0, 1]².
    pub fn point(&self, patches: &[Patch], s: f64, t: f64) -> DVec3 {
        let [p, q] = self.domain(patches, s, t);
        let f = self.params.weight(t);
        // The ends are the patches' own curves, bit for bit.
        if t <= 0.0 {
            return patches[self.ends[0].0].point(p);
        }
        if t >= 1.0 {
            return patches[self.ends[1].0].point(q);
        }
        f * patches[self.ends[0].0].point(p) + (1.0 - f) * patches[self.ends[1].0].point(q)
    }

    /// The strip at many places (s, t) at once.
    pub fn points(&self, patches: &[Patch], at: &[[f64; 2]]) -> Vec<DVec3> {
        let domain: Vec<[DVec2; 2]> = at.iter().map(|&[s, t]| self.domain(patches, s, t)).collect();
        let [near, far] = [0, 1].map(|end| {
            let mut points = vec![];
            patches[self.ends[end].0].points(&domain.iter().map(|d| d[end]).collect::<Vec<_>>(), &mut points);
            points
        });
        let mix = |(&[_, t], (&a, &b)): (&[f64; 2], (&DVec3, &DVec3))| match t {
            // The ends are the patches' own curves, bit for bit.
            _ if t <= 0.0 => a,
            _ if t >= 1.0 => b,
            _ => self.params.weight(t) * a + (1.0 - self.params.weight(t)) * b,
        };
        at.iter().zip(near.iter().zip(&far)).map(mix).collect()
    }

    /// The strip's side in the face to the right (0) or left (1), at t: from the patches' boundary curves, so that it
    /// lies in the face's plane to rounding.
    pub fn side(&self, patches: &[Patch], left: usize, t: f64) -> DVec3 {
        let at = |end: usize, share: f64| {
            let (patch, k) = (&patches[self.ends[end].0], self.ends[end].1);
            if left == end { patch.border(k + patch.sides() - 1, 1.0 - share) } else { patch.border(k, share) }
        };
        let f = self.params.weight(t);
        f * at(0, self.params.share(t)) + (1.0 - f) * at(1, self.params.share(1.0 - t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// f, 1 − f and as many derivatives as promised vanish at the ends, whatever the balance.
    #[test]
    fn the_weight_is_flat_at_both_ends() {
        for order in 0..4 {
            for balance in [0.2, 0.5, 0.9] {
                let params = Params { order, balance, ..Params::default() };
                assert_eq!((params.weight(0.0), params.weight(1.0)), (1.0, 0.0));
                let slope = |a: f64, b: f64| (a / b).ln() / 2f64.ln();
                let low = slope(1.0 - params.weight(2e-3), 1.0 - params.weight(1e-3));
                let high = slope(params.weight(1.0 - 2e-3), params.weight(1.0 - 1e-3));
                assert!((low - (order as f64 + 1.0)).abs() < 0.02 && (high - (order as f64 + 1.0)).abs() < 0.02);
            }
        }
    }
}
