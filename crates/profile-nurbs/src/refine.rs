//! Knot insertion, splitting, Bézier pieces: the same curve with more control points.

use crate::nurbs::Nurbs;

impl Nurbs {
    /// The same curve with `u` as a knot up to `times` more often, never more than `degree` times in all (\[Boehm1980\]).
    /// Unchanged when `u` is not strictly inside the domain.
    #[must_use]
    pub fn with_knot(&self, u: f64, times: usize) -> Self {
        let mut curve = self.clone();
        let [first, last] = self.domain();
        if !(first < u && u < last) {
            return curve;
        }
        let present = self.knots.iter().filter(|&&k| k == u).count();
        for _ in 0..times.min(self.degree.saturating_sub(present)) {
            curve.insert(u);
        }
        curve
    }

    fn insert(&mut self, u: f64) {
        let p = self.degree;
        let span = self.knots.partition_point(|&k| k <= u) - 1;
        let mut lifted = Vec::with_capacity(self.lifted.len() + 1);
        lifted.extend_from_slice(&self.lifted[..=span - p]);
        for i in span - p + 1..=span {
            let (left, right) = (self.knots[i], self.knots[i + p]);
            // Knots equal to `u` on the left keep their points: the share is then 0.
            lifted.push(self.lifted[i - 1].lerp(self.lifted[i], (u - left) / (right - left)));
        }
        lifted.extend_from_slice(&self.lifted[span..]);
        self.lifted = lifted;
        self.knots.insert(span + 1, u);
    }

    /// The part over [`from`, `to`], with its parameters kept; ends are clamped to the domain. `None` when nothing is
    /// left.
    pub fn part(&self, from: f64, to: f64) -> Option<Self> {
        let [first, last] = self.domain();
        let (from, to) = (from.max(first), to.min(last));
        if from.is_nan() || to.is_nan() || from >= to {
            return None;
        }
        let p = self.degree;
        let full = self.clone().clamped(first).clamped(last).with_knot(from, p).with_knot(to, p);
        // After this `from` and `to` are knots `degree` times or more: their last copies bound the points that matter.
        let start = full.knots.partition_point(|&k| k <= from) - 1 - p;
        let end = full.knots.partition_point(|&k| k < to);
        let mut knots = vec![from; p + 1];
        knots.extend(full.knots[start + p + 1..end].iter());
        knots.extend(std::iter::repeat_n(to, p + 1));
        let count = knots.len() - p - 1;
        Some(Self { degree: p, knots, lifted: full.lifted[start..start + count].to_vec() })
    }

    /// Raises the multiplicity of an end of the domain to at least `degree`.
    fn clamped(mut self, end: f64) -> Self {
        while self.knots.iter().filter(|&&k| k == end).count() < self.degree {
            // At the last end the span right of it may be past the points; insert from the left.
            self.insert_at_end(end);
        }
        self
    }

    fn insert_at_end(&mut self, u: f64) {
        let p = self.degree;
        let span = self.knots.partition_point(|&k| k <= u) - 1;
        if span < self.lifted.len() {
            return self.insert(u);
        }
        // Mirror image: the same as inserting at the start of the reversed curve.
        let reversed = |c: &Self| Self {
            degree: p,
            knots: c.knots.iter().rev().map(|k| -k).collect(),
            lifted: c.lifted.iter().rev().copied().collect(),
        };
        let mut mirror = reversed(self);
        mirror.insert(-u);
        *self = reversed(&mirror);
    }

    /// The two parts before and after `u`; `None` when `u` is not strictly inside the domain.
    pub fn split(&self, u: f64) -> Option<[Self; 2]> {
        let [first, last] = self.domain();
        if first < u && u < last { Some([self.part(first, u)?, self.part(u, last)?]) } else { None }
    }

    /// The polynomial pieces as Bézier segments, in order, each over its own knot span.
    pub fn beziers(&self) -> Vec<Self> {
        let [first, last] = self.domain();
        let mut ends: Vec<f64> = self.knots.iter().copied().filter(|k| (first..=last).contains(k)).collect();
        ends.dedup();
        ends.windows(2).filter_map(|w| self.part(w[0], w[1])).collect()
    }
}
