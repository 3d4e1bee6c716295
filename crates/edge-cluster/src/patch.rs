//! One blending patch, whatever its kind: a domain polygon, its surface, its sides.

use crate::control::Shape;
use crate::net::Net;
use crate::spatch::SPatch;
use glam::{DVec2, DVec3};
use profile_nurbs::{SurfaceJet, TensorBezier};

/// The surface of a control net.
#[derive(Clone, Debug)]
pub struct Patch {
    surface: Surface,
    /// The control points of each side's boundary curve.
    borders: Vec<Vec<DVec3>>,
}

#[derive(Clone, Debug)]
enum Surface {
    Tensor(TensorBezier),
    Simplex(SPatch),
}

impl Patch {
    /// The surface of a net; `None` if the net's points do not fit its shape or are not finite.
    pub fn new(net: &Net) -> Option<Self> {
        let points = net.points.clone();
        if net.shape.checked().is_err() || points.len() != net.shape.count() || points.iter().any(|p| !p.is_finite()) {
            return None;
        }
        let borders =
            (0..net.shape.sides()).map(|k| net.shape.border(k).into_iter().map(|i| points[i]).collect()).collect();
        let surface = match net.shape {
            Shape::Tensor(degrees) => Surface::Tensor(TensorBezier::new(degrees, points).ok()?),
            Shape::Simplex { sides, degree } => Surface::Simplex(SPatch::new(sides, degree, points)?),
        };
        Some(Self { surface, borders })
    }

    /// How many sides.
    pub fn sides(&self) -> usize {
        self.borders.len()
    }

    /// Corner k of the domain: a regular polygon around the origin, or the unit square. Any k, counted around.
    pub fn corner(&self, k: usize) -> DVec2 {
        match &self.surface {
            Surface::Tensor(_) => [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y][k % 4],
            Surface::Simplex(patch) => patch.polygon().corner(k),
        }
    }

    /// The middle of the domain.
    pub fn center(&self) -> DVec2 {
        match &self.surface {
            Surface::Tensor(_) => DVec2::splat(0.5),
            Surface::Simplex(_) => DVec2::ZERO,
        }
    }

    /// The domain point at share `u` of side k.
    pub fn side(&self, k: usize, u: f64) -> DVec2 {
        self.corner(k).lerp(self.corner(k + 1), u)
    }

    /// The surface at share `u` of side k, by the side's own Bézier curve: in its plane to rounding, the same from both
    /// sides of the curve. `k` is counted around.
    pub fn border(&self, k: usize, u: f64) -> DVec3 {
        let border = &self.borders[k % self.borders.len()];
        let mut points = [DVec3::ZERO; 64];
        let points = &mut points[..border.len()];
        points.copy_from_slice(border);
        for last in (1..points.len()).rev() {
            for i in 0..last {
                points[i] = points[i].lerp(points[i + 1], u);
            }
        }
        points[0]
    }

    /// The surface at a point of the domain.
    pub fn point(&self, p: DVec2) -> DVec3 {
        match &self.surface {
            Surface::Tensor(patch) => patch.point(p.x, p.y),
            Surface::Simplex(patch) => patch.point(p),
        }
    }

    /// The surface at many points of the domain, appended to `out`.
    pub fn points(&self, at: &[DVec2], out: &mut Vec<DVec3>) {
        match &self.surface {
            Surface::Tensor(patch) => out.extend(at.iter().map(|p| patch.point(p.x, p.y))),
            Surface::Simplex(patch) => patch.points(at, out),
        }
    }

    /// The surface at a point of the domain with derivatives by the domain's coordinates.
    pub fn jet(&self, p: DVec2) -> SurfaceJet {
        match &self.surface {
            Surface::Tensor(patch) => patch.jet(p.x, p.y),
            Surface::Simplex(patch) => patch.jet(p),
        }
    }
}
