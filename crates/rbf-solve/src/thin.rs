//! Fewer constraints far from the boundary.

use crate::neighbours::Cells;
use glam::DVec3;

/// How constraints are thinned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thinning {
    /// Mean boundary edge, in model units: the length everything else is measured in.
    pub edge: f64,
    /// Everything within this many edges of the boundary is kept.
    pub keep: f64,
    /// How fast the least distance between kept points grows beyond that, per unit of distance from the boundary.
    pub growth: f64,
}

impl Thinning {
    /// Keeps all within 1.5 edges, and beyond that points as far apart as they are beyond it.
    pub const fn new(edge: f64) -> Self {
        Self { edge, keep: 1.5, growth: 1.0 }
    }
}

/// Which of `points` to keep, ascending. Boundary points that are among them are always kept.
///
/// Thinning evenly moves a composed surface by a third of an edge or more; what is far from the boundary shapes it little.
/// O(n) for points spread over a surface a few edges wide.
pub fn thin(points: &[DVec3], boundary: &[DVec3], thinning: &Thinning) -> Vec<usize> {
    let Thinning { edge, keep, growth } = *thinning;
    if !(edge > 0.0 && edge.is_finite() && growth > 0.0) {
        return (0..points.len()).collect();
    }
    // Beyond this distance the spacing no longer grows, so that searches stay local.
    let reach = (keep + 3.0) * edge;
    let mut rim = Cells::new(reach);
    for (i, &p) in boundary.iter().enumerate() {
        rim.insert(i, p);
    }
    let distance = |p: DVec3| {
        let near = rim.around(p, reach).map(|i| boundary[i].distance(p));
        near.fold(reach, f64::min)
    };
    let spacing = |p: DVec3| growth * (distance(p) - keep * edge).max(0.0);
    let mut filed = Cells::new(edge);
    let mut kept = vec![];
    for (i, &p) in points.iter().enumerate() {
        let least = spacing(p);
        if least <= 0.0 || filed.around(p, least).all(|j| points[j].distance(p) >= least) {
            filed.insert(i, p);
            kept.push(i);
        }
    }
    kept
}
