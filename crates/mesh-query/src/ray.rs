//! Rays against triangles: nearest hit and any hit.

use crate::build::TriBvh;
use crate::frame::inverse_power_of_two;
use crate::stack::Stack;
use glam::{DVec3, Vec3A};
use mesh_core::{FaceId, Faces, Positions};
use obvhs::bvh2::node::Bvh2Node;

/// Relative rounding of the ray's origin and of the slab test, both in `f32`, with a wide margin. Boxes only sort out:
/// what is hit is decided in `f64`.
const SLACK: f32 = 1.0 / (1 << 20) as f32;

/// Direction components below this share of the largest count as this in the slab test.
const STEEPEST: f32 = 1e-30;

/// Origins farther than this, in box sizes, are beyond what even `f64` resolves.
const FARTHEST: f64 = 1e15;

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The face; the lowest id of those hit equally early.
    pub face: FaceId,
    /// Ray parameter: the place is `origin + t·direction`.
    pub t: f64,
    /// Barycentric coordinates in `face`: none negative, summing to 1 up to rounding.
    pub barycentric: [f64; 3],
}

impl TriBvh {
    /// The first triangle that the ray meets at 0 ≤ t ≤ `max_t`, from either side. `direction` need not be of unit
    /// length. `None` also when the direction is zero, anything is NaN, or the origin is more than 1e15 times the mesh's
    /// size away.
    ///
    /// A ray through an edge or vertex of a closed mesh never slips between its triangles \[WoopBenthinWald2013\];
    /// a triangle seen exactly edge-on is not hit.
    pub fn ray_cast<M: Faces + Positions>(
        &self,
        mesh: &M,
        origin: DVec3,
        direction: DVec3,
        max_t: f64,
    ) -> Option<RayHit> {
        let mut ray = Ray::new(self, origin, direction, max_t)?;
        let mut found: Option<RayHit> = None;
        ray.descend(self, |ray, f| {
            if let Some((t, barycentric)) = ray.meet(mesh.triangle(f))
                && (t < ray.max_t || (t == ray.max_t && found.is_none_or(|h| f < h.face)))
            {
                ray.max_t = t;
                found = Some(RayHit { face: f, t, barycentric });
            }
            false
        });
        found.map(|hit| RayHit { t: hit.t * ray.unit, ..hit })
    }

    /// Whether any triangle is met at 0 ≤ t ≤ `max_t`. Faster than [`TriBvh::ray_cast`].
    pub fn ray_occluded<M: Faces + Positions>(&self, mesh: &M, origin: DVec3, direction: DVec3, max_t: f64) -> bool {
        let Some(mut ray) = Ray::new(self, origin, direction, max_t) else { return false };
        ray.descend(self, |ray, f| ray.meet(mesh.triangle(f)).is_some_and(|(t, _)| t <= ray.max_t))
    }
}

/// A ray with its direction scaled to a largest component in [1/2, 1] and its parameter in box units.
struct Ray {
    origin: DVec3,
    /// Model units to box units.
    scale: f64,
    /// Box-unit parameter to the caller's.
    unit: f64,
    max_t: f64,
    /// Origin in box coordinates, moved by the slack so that lower sides of boxes come lower and upper sides higher.
    above: Vec3A,
    below: Vec3A,
    inverse: Vec3A,
    /// The axis along which the ray is longest, and the two others in an order that keeps orientation.
    axes: [usize; 3],
    /// The shear that turns the ray into the longest axis, and 1/direction on that axis.
    shear: DVec3,
}

impl Ray {
    fn new(tree: &TriBvh, origin: DVec3, direction: DVec3, max_t: f64) -> Option<Self> {
        let largest = direction.abs().max_element();
        let usable = origin.is_finite() && direction.is_finite() && largest > 0.0 && max_t >= 0.0;
        if tree.nodes.is_empty() || !usable {
            return None;
        }
        let to_unit = inverse_power_of_two(largest);
        let d = direction * to_unit;
        let longest = d.abs().max_position();
        let (mut kx, mut ky) = ((longest + 1) % 3, (longest + 2) % 3);
        if d[longest] < 0.0 {
            (kx, ky) = (ky, kx);
        }
        let local = tree.frame.local(origin);
        let distance = local.abs().max_element();
        if distance > FARTHEST {
            return None;
        }
        let slack = Vec3A::splat(SLACK * (1.0 + distance as f32));
        let steep = d.as_vec3a();
        let steep = Vec3A::select(steep.abs().cmplt(Vec3A::splat(STEEPEST)), Vec3A::splat(STEEPEST), steep);
        let unit = to_unit / tree.frame.scale;
        Some(Self {
            origin,
            scale: tree.frame.scale,
            unit,
            max_t: max_t / unit,
            above: local.as_vec3a() + slack,
            below: local.as_vec3a() - slack,
            inverse: steep.recip(),
            axes: [kx, ky, longest],
            shear: DVec3::new(d[kx] / d[longest], d[ky] / d[longest], d[longest].recip()),
        })
    }

    /// Where the ray enters a box; infinite when it does not, or not in time.
    #[inline]
    fn enters(&self, node: &Bvh2Node) -> f32 {
        let aabb = node.aabb();
        let (t0, t1) = ((aabb.min - self.above) * self.inverse, (aabb.max - self.below) * self.inverse);
        let near = t0.min(t1).max_element().max(0.0) * (1.0 - SLACK);
        let far = t0.max(t1).min_element() * (1.0 + SLACK);
        if near <= far && f64::from(near) <= self.max_t { near } else { f32::INFINITY }
    }

    /// The watertight test: the sign of each edge is computed from the two sheared corners alone, so the two faces of
    /// an edge see exactly opposite values.
    #[inline]
    fn meet(&self, triangle: [DVec3; 3]) -> Option<(f64, [f64; 3])> {
        let [kx, ky, kz] = self.axes;
        let [a, b, c] = triangle.map(|v| {
            let v = (v - self.origin) * self.scale;
            DVec3::new(v[kx] - self.shear.x * v[kz], v[ky] - self.shear.y * v[kz], self.shear.z * v[kz])
        });
        let (u, v, w) = (c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x);
        let mixed = (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0);
        let sum = u + v + w;
        if mixed || sum == 0.0 {
            return None;
        }
        let barycentric = [u / sum, v / sum, w / sum].map(f64::abs);
        let t = barycentric[0] * a.z + barycentric[1] * b.z + barycentric[2] * c.z;
        (t >= 0.0).then_some((t, barycentric))
    }

    /// Visits leaves near to far until `visit` says stop; whether it did.
    #[inline]
    fn descend(&mut self, tree: &TriBvh, mut visit: impl FnMut(&mut Self, FaceId) -> bool) -> bool {
        let mut stack: Stack<(u32, f32)> = Stack::new();
        let mut next = Some((0, self.enters(&tree.nodes[0])));
        while let Some((index, entry)) = next {
            let node = &tree.nodes[index as usize];
            if entry == f32::INFINITY || f64::from(entry) > self.max_t {
                next = stack.pop();
            } else if node.is_leaf() {
                for &f in tree.leaf(node) {
                    if visit(self, f) {
                        return true;
                    }
                }
                next = stack.pop();
            } else {
                let (i, j) = (node.first_index, node.first_index + 1);
                let (ti, tj) = (self.enters(&tree.nodes[i as usize]), self.enters(&tree.nodes[j as usize]));
                let (near, far) = if ti <= tj { ((i, ti), (j, tj)) } else { ((j, tj), (i, ti)) };
                if far.1 < f32::INFINITY {
                    stack.push(far);
                }
                next = Some(near);
            }
        }
        false
    }
}
