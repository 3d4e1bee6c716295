//! From constraints to a clean system: checked, merged, centred and scaled.

use crate::constraint::Constraint;
use crate::error::Error;
use crate::kernel::Kernel;
use crate::neighbours::Cells;
use crate::params::Params;
use glam::DVec3;

/// Points nearer than this share of the extent are one point: rounding leaves no digits to tell them apart by.
const COINCIDENT: f64 = 1e-12;

/// A system in coordinates centred on the data and scaled to about one. Lengths and values are divided by `scale`, so gradients stay.
pub(crate) struct System {
    pub(crate) centre: DVec3,
    /// A power of two, so that scaling rounds nothing.
    pub(crate) scale: f64,
    /// Points without gradient first, then those with one.
    pub(crate) points: Vec<DVec3>,
    pub(crate) values: Vec<f64>,
    /// The gradients at the last points.
    pub(crate) gradients: Vec<DVec3>,
    /// Which constraint each point came from.
    pub(crate) sources: Vec<u32>,
    /// Constraints left out, each beside the one kept for it.
    pub(crate) merged: Vec<[usize; 2]>,
}

impl System {
    /// How many points have no gradient.
    pub(crate) fn plain(&self) -> usize {
        self.points.len() - self.gradients.len()
    }

    /// Unknowns: one per value and one per component of each gradient.
    pub(crate) fn unknowns(&self) -> usize {
        self.points.len() + 3 * self.gradients.len()
    }

    /// The point an unknown belongs to. Values come first, then the gradients' x, y and z.
    pub(crate) fn point_of(&self, unknown: usize) -> usize {
        let n = self.points.len();
        if unknown < n { unknown } else { self.plain() + (unknown - n) % self.gradients.len() }
    }

    /// What every unknown's functional is asked to be.
    pub(crate) fn wanted(&self) -> Vec<f64> {
        let component = |k: usize| self.gradients.iter().map(move |g| g[k]);
        self.values.iter().copied().chain((0..3).flat_map(component)).collect()
    }

    pub(crate) fn place(&self, point: usize) -> DVec3 {
        self.points[point] * self.scale + self.centre
    }

    /// Names the two points that make the system singular: the one of `unknown` and its nearest.
    pub(crate) fn singular_at(&self, unknown: usize) -> Error {
        let here = self.point_of(unknown);
        let far = |i: usize| self.points[i].distance_squared(self.points[here]);
        let others = (0..self.points.len()).filter(|&i| i != here);
        let next = others.min_by(|&a, &b| far(a).total_cmp(&far(b))).unwrap_or(here);
        Error::Singular {
            first: self.sources[here] as usize,
            second: self.sources[next] as usize,
            at: self.place(here),
            distance: far(next).sqrt() * self.scale,
        }
    }
}

/// Checks, merges, centres and scales. O(n).
pub(crate) fn admit(constraints: &[Constraint], params: &Params) -> Result<System, Error> {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (index, c) in constraints.iter().enumerate() {
        if !(c.point.is_finite() && c.value.is_finite() && c.gradient.is_none_or(DVec3::is_finite)) {
            return Err(Error::NotFinite { index, at: c.point });
        }
        if c.gradient.is_some() && params.kernel == Kernel::Biharmonic {
            return Err(Error::NoGradient { index, at: c.point });
        }
        (low, high) = (low.min(c.point), high.max(c.point));
    }
    let extent = (high - low).max_element();
    if constraints.is_empty() || extent <= 0.0 {
        let at = constraints.first().map_or(DVec3::ZERO, |c| c.point);
        return Err(Error::Flat { count: constraints.len(), at, thickness: 0.0 });
    }
    let centre = low.midpoint(high);
    let scale = extent.log2().round().exp2();
    let out_of_range =
        |c: &Constraint| !((c.value / scale).abs() < 1e100 && c.gradient.is_none_or(|g| g.length() < 1e100));
    if !(extent.is_finite() && scale > f64::MIN_POSITIVE && constraints.iter().all(|c| !out_of_range(c))) {
        let index = constraints.iter().position(out_of_range).unwrap_or(0);
        return Err(Error::NotFinite { index, at: constraints[index].point });
    }
    let points: Vec<DVec3> = constraints.iter().map(|c| (c.point - centre) / scale).collect();
    let (kept, merged) = merge(constraints, &points, (params.merge / scale).max(COINCIDENT))?;
    let tilted = |&&i: &&u32| constraints[i as usize].gradient.is_some();
    let sources: Vec<u32> = kept.iter().filter(|i| !tilted(i)).chain(kept.iter().filter(tilted)).copied().collect();
    Ok(System {
        centre,
        scale,
        points: sources.iter().map(|&i| points[i as usize]).collect(),
        values: sources.iter().map(|&i| constraints[i as usize].value / scale).collect(),
        gradients: sources.iter().filter_map(|&i| constraints[i as usize].gradient).collect(),
        sources,
        merged,
    })
}

/// Keeps the first of constraints that ask for the same value within `distance`; refuses contradictions.
fn merge(constraints: &[Constraint], points: &[DVec3], distance: f64) -> Result<(Vec<u32>, Vec<[usize; 2]>), Error> {
    let mut cells = Cells::new(4.0 * distance);
    let (mut kept, mut merged) = (vec![], vec![]);
    for (i, c) in constraints.iter().enumerate() {
        let mut same = None;
        for j in cells.around(points[i], distance) {
            let apart = points[i].distance(points[j]);
            let agree = constraints[j].value == c.value;
            if apart <= COINCIDENT && !(agree && constraints[j].gradient == c.gradient) {
                let values = [constraints[j].value, c.value];
                return Err(Error::Contradiction { first: j, second: i, at: c.point, values });
            }
            if apart <= distance && agree && same.is_none_or(|s| j < s) {
                same = Some(j);
            }
        }
        if let Some(j) = same {
            merged.push([i, j]);
        } else {
            cells.insert(i, points[i]);
            kept.push(i as u32);
        }
    }
    Ok((kept, merged))
}
