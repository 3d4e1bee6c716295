//! Framing, rays and projection.

use crate::params::{Error, Params, Projection};
use glam::{DVec2, DVec3};

/// Share of the picture that the model may fill.
const FILL: f64 = 0.86;

/// Distance of the picture plane for parallel rays, in unit-frame lengths: outside of any model there.
const BACK: f64 = 8.0;

pub(crate) struct Camera {
    /// Right, up and towards the camera: an orthonormal frame.
    pub(crate) axes: [DVec3; 3],
    target: DVec3,
    /// Distance from the target; unused for parallel rays.
    distance: f64,
    /// Half the picture's height at the target (parallel) or at distance 1 (perspective).
    half_height: f64,
    perspective: bool,
    size: DVec2,
}

pub(crate) struct Ray {
    pub(crate) origin: DVec3,
    /// Of unit length.
    pub(crate) direction: DVec3,
}

impl Camera {
    /// A camera that has all `points` in view.
    pub(crate) fn framing(points: &[DVec3], params: &Params) -> Result<Self, Error> {
        let axes = axes_of(params)?;
        let size = DVec2::new(f64::from(params.width), f64::from(params.height));
        let aspect = size.x / size.y;
        let seen = |p: DVec3| DVec3::from_array(axes.map(|axis| p.dot(axis)));
        let (low, high) =
            points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), &p| (l.min(seen(p)), h.max(seen(p))));
        let middle = 0.5 * (low + high);
        let target = axes[0] * middle.x + axes[1] * middle.y + axes[2] * middle.z;
        let reach = points.iter().map(|&p| seen(p) - middle);
        // The share of the half height that a point takes up, were the half height 1.
        let share = |q: DVec3| (q.y.abs()).max(q.x.abs() / aspect) / FILL;
        let (distance, half_height, perspective) = match params.projection {
            Projection::Perspective { angle } => {
                let tangent = (0.5 * angle.clamp(1.0, 120.0)).to_radians().tan();
                let needed = reach.map(|q| q.z + (share(q) / tangent).max(0.05)).fold(0.05, f64::max);
                (needed, tangent, true)
            }
            Projection::Orthographic => (BACK, reach.map(share).fold(1e-9, f64::max), false),
        };
        Ok(Self { axes, target, distance, half_height, perspective, size })
    }

    /// The ray through a place on the picture, in pixels from its top left.
    pub(crate) fn ray(&self, at: DVec2) -> Ray {
        let [right, up, back] = self.axes;
        let x = (2.0 * at.x - self.size.x) / self.size.y * self.half_height;
        let y = (1.0 - 2.0 * at.y / self.size.y) * self.half_height;
        let eye = self.target + self.distance * back;
        if self.perspective {
            Ray { origin: eye, direction: (x * right + y * up - back).normalize() }
        } else {
            Ray { origin: eye + x * right + y * up, direction: -back }
        }
    }

    /// Where a point appears, in pixels from the top left.
    pub(crate) fn project(&self, p: DVec3) -> DVec2 {
        let [right, up, back] = self.axes;
        let q = p - self.target;
        let depth = if self.perspective { (self.distance - q.dot(back)).max(1e-9) } else { 1.0 };
        let unit = 0.5 * self.size.y / (self.half_height * depth);
        DVec2::new(0.5 * self.size.x + q.dot(right) * unit, 0.5 * self.size.y - q.dot(up) * unit)
    }
}

fn axes_of(params: &Params) -> Result<[DVec3; 3], Error> {
    let back = unit(params.view).ok_or(Error::View { view: params.view })?;
    // Looking along the up axis: any other will do, but always the same one.
    let right = [params.up, DVec3::NEG_Z, DVec3::Y]
        .into_iter()
        .filter_map(unit)
        .map(|up| up.cross(back))
        .find(|right| right.length() > 1e-3)
        .map_or(DVec3::X, DVec3::normalize);
    Ok([right, back.cross(right), back])
}

/// The direction of any finite vector but zero.
pub(crate) fn unit(v: DVec3) -> Option<DVec3> {
    let largest = v.abs().max_element();
    if v.is_finite() && largest > 0.0 { (v / largest).try_normalize() } else { None }
}
