//! How the radius varies: from place to place along a curve, and from one side to the other.

use glam::DVec3;
use mesh_core::{Connected, Faces, Positions, TriMesh};
use spine::{BlendCurve, Law, RadiusField};
use std::sync::Arc;

/// How the radius varies, in shares of [`super::Params::radius`], the largest.
#[derive(Clone, Debug, PartialEq)]
pub struct Radii {
    /// How far the ball's centre keeps from the left and from the right side of a curve; the larger is 1.
    pub sides: [f64; 2],
    /// Places and the share there. Each belongs to the curve nearest to it, and counts where the curve is nearest.
    pub keys: Vec<(DVec3, f64)>,
    /// The share at the ends of open curves, half-way round from the only key of a closed one, and on curves without
    /// keys.
    pub rest: f64,
    /// Places and the share of the whole curve nearest to each, in place of `rest`.
    pub own: Vec<(DVec3, f64)>,
}

impl Default for Radii {
    /// The same radius everywhere.
    fn default() -> Self {
        Self { sides: [1.0; 2], keys: Vec::new(), rest: 1.0, own: Vec::new() }
    }
}

impl Radii {
    /// Radii in model units as shares of the largest of them, which comes first: `left` and `right` of a curve away from
    /// the places in `at`, there the larger of the two as given.
    pub fn of([left, right]: [f64; 2], at: &[(DVec3, f64)]) -> (f64, Self) {
        let rest = left.max(right);
        let largest = at.iter().map(|k| k.1).fold(rest, f64::max);
        let keys = at.iter().map(|&(p, r)| (p, r / largest)).collect();
        (largest, Self { sides: [left / rest, right / rest], keys, rest: rest / largest, own: Vec::new() })
    }

    /// The same with radii in model units for whole curves, each the one nearest to a place: the largest of all radii, and
    /// all as shares of it.
    #[must_use]
    pub fn with_curves(self, radius: f64, own: &[(DVec3, f64)]) -> (f64, Self) {
        let largest = own.iter().map(|k| k.1).fold(radius, f64::max);
        let keys = self.keys.iter().map(|&(p, share)| (p, share * radius / largest)).collect();
        let own = own.iter().map(|&(p, r)| (p, r / largest)).collect();
        (largest, Self { keys, own, rest: self.rest * radius / largest, ..self })
    }

    /// Whether there is one ball for both sides.
    pub fn is_even(&self) -> bool {
        self.sides[0] == self.sides[1]
    }

    /// The smallest share anywhere.
    pub fn least(&self) -> f64 {
        self.keys.iter().chain(&self.own).map(|k| k.1).fold(self.rest, f64::min) * self.sides[0].min(self.sides[1])
    }

    /// The field of each curve.
    pub(crate) fn fields(&self, mesh: &Connected<TriMesh>, curves: &[BlendCurve], radius: f64) -> Vec<RadiusField> {
        let keys = of_nearest(mesh, curves, self.keys.iter().map(|k| k.0));
        let rests = of_nearest(mesh, curves, self.own.iter().map(|k| k.0));
        let plain = RadiusField { sides: self.sides, ..RadiusField::constant(radius) };
        let field = |((curve, keys), rest): ((&BlendCurve, Vec<usize>), Vec<usize>)| {
            let keys: Vec<_> = keys.into_iter().map(|k| self.keys[k]).collect();
            let rest = rest.first().map_or(self.rest, |&k| self.own[k].1);
            let law = if keys.is_empty() { None } else { Law::new(chain(mesh, curve), curve.closed, &keys, rest) };
            match law {
                Some(law) => RadiusField { law: Some(Arc::new(law)), ..plain.clone() },
                None => RadiusField { base: radius * rest, ..plain.clone() },
            }
        };
        curves.iter().zip(keys).zip(rests).map(field).collect()
    }
}

/// For each curve, which of some places are nearer to it than to any other.
pub(crate) fn of_nearest(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    places: impl Iterator<Item = DVec3>,
) -> Vec<Vec<usize>> {
    let mut own = vec![vec![]; curves.len()];
    for (k, place) in places.enumerate() {
        let distance = |c: &BlendCurve| distance_to(&chain(mesh, c), c.closed, place);
        let nearest = curves.iter().map(distance).enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((i, _)) = nearest {
            own[i].push(k);
        }
    }
    own
}

/// The points of a curve, the last of an open one included.
pub(crate) fn chain(mesh: &Connected<TriMesh>, curve: &BlendCurve) -> Vec<DVec3> {
    let mut points = curve.points(mesh);
    points.extend(curve.halfedges.last().filter(|_| !curve.closed).map(|&h| mesh.position(mesh.head(h))));
    points
}

fn distance_to(points: &[DVec3], closed: bool, place: DVec3) -> f64 {
    let next = points.iter().skip(1).chain(points.first().filter(|_| closed));
    let distance = |(&a, &b): (&DVec3, &DVec3)| {
        let t = ((place - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        place.distance(if t.is_nan() { a } else { a.lerp(b, t) })
    };
    points.iter().zip(next).map(distance).fold(f64::INFINITY, f64::min)
}
