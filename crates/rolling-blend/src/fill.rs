//! Corner patches: the hole between the ends of the strips at a node, filled so that it is tangent to all around it.
//!
//! Where one ball touches every side, the patch is that ball's surface. Elsewhere it is the thin plate that leaves its
//! rim in the planes tangent to the strips and sides there.

use crate::corner::Corner;
use crate::plate::Plate;
use crate::stretch::Stretch;
use crate::strip::{Piece, Strip};
use crate::trouble::Trouble;
use glam::DVec3;
use mesh_core::VertexId;

/// Fills one corner. `joints` are its chains over the sides, `position` places every vertex so far.
pub(crate) fn fill(
    corner: &Corner,
    joints: &[Vec<VertexId>],
    stretches: &[Option<Stretch>],
    strips: &[Option<Strip>],
    position: impl Fn(VertexId) -> DVec3,
) -> Result<Patch, Trouble> {
    let rim = Rim::around(corner, joints, stretches, strips, &position);
    let n = rim.vertices.len();
    let middle = rim.points.iter().sum::<DVec3>() / n.max(1) as f64;
    let mut sorted = rim.vertices.clone();
    sorted.sort_unstable();
    sorted.dedup();
    if n < 3 || sorted.len() < n {
        return Err(Trouble::at("the blends at a corner leave no room for its patch", vec![middle]));
    }
    let mut plate = Plate::spanning(&rim.points);
    match corner.ball {
        Some((center, radius)) => plate.wrap(center, radius),
        None => plate.settle(&rim.ghosts()),
    }
    Ok(Patch { rim: rim.vertices, plate })
}

/// The patch of a corner.
pub(crate) struct Patch {
    rim: Vec<VertexId>,
    plate: Plate,
}

impl Patch {
    /// The patch with ids for its inner vertices.
    pub fn numbered_from(self, first_new: u32) -> Piece {
        let n = self.rim.len();
        let id = |v: u32| self.rim.get(v as usize).copied().unwrap_or_else(|| VertexId(first_new + v - n as u32));
        Piece { points: self.plate.points[n..].to_vec(), faces: self.plate.faces.iter().map(|f| f.map(id)).collect() }
    }
}

/// The closed boundary of a corner patch, counter-clockwise.
#[derive(Default)]
struct Rim {
    vertices: Vec<VertexId>,
    points: Vec<DVec3>,
    /// Outward normals of what the patch is to be tangent to.
    normals: Vec<DVec3>,
}

impl Rim {
    fn around(
        corner: &Corner,
        joints: &[Vec<VertexId>],
        stretches: &[Option<Stretch>],
        strips: &[Option<Strip>],
        position: &impl Fn(VertexId) -> DVec3,
    ) -> Self {
        let profiles: Vec<Self> = corner
            .darts
            .iter()
            .filter_map(|d| Some(Self::along(stretches[d.curve].as_ref()?, strips[d.curve].as_ref()?, d.end, position)))
            .collect();
        let mut rim = Self::default();
        for (i, profile) in profiles.iter().enumerate() {
            let next = &profiles[(i + 1) % profiles.len()];
            rim.append(profile);
            let joint = Self::over(&joints[i], [profile.normals[profile.normals.len() - 1], next.normals[0]], position);
            rim.append(&joint);
        }
        if rim.vertices.len() > 1 && rim.vertices.first() == rim.vertices.last() {
            rim.vertices.pop();
            rim.points.pop();
            rim.normals.pop();
        }
        rim
    }

    /// Adds a piece that begins where the rim so far ends.
    fn append(&mut self, piece: &Self) {
        let shared = usize::from(self.vertices.last().is_some_and(|v| Some(v) == piece.vertices.first()));
        self.vertices.extend(&piece.vertices[shared..]);
        self.points.extend(&piece.points[shared..]);
        self.normals.extend(&piece.normals[shared..]);
    }

    /// The profile at an end of a strip, from its right foot to its left one as seen from the corner.
    fn along(stretch: &Stretch, strip: &Strip, end: usize, position: &impl Fn(VertexId) -> DVec3) -> Self {
        let mut vertices = strip.ends[end].clone();
        if end == 0 {
            vertices.reverse();
        }
        let points: Vec<DVec3> = vertices.iter().map(|&v| position(v)).collect();
        let (last, before) = stretch.last_two(end);
        let along = last.center - before.center;
        let normal = |k: usize| {
            let radial = (stretch.outwards() * (points[k] - last.center)).normalize_or_zero();
            // At the feet a difference to one side is off by half a chord's turn, and the ball is right for most profiles.
            if k == 0 || k + 1 == points.len() {
                return radial;
            }
            let normal = along.cross(points[k + 1] - points[k - 1]).normalize_or_zero();
            normal * normal.dot(radial).signum()
        };
        let normals = (0..points.len()).map(normal).collect();
        Self { vertices, points, normals }
    }

    /// A chain over a side, its normals turning evenly from one end's to the other's.
    fn over(joint: &[VertexId], ends: [DVec3; 2], position: &impl Fn(VertexId) -> DVec3) -> Self {
        let points: Vec<DVec3> = joint.iter().map(|&v| position(v)).collect();
        let mut length = 0.0;
        let at: Vec<f64> = std::iter::once(0.0)
            .chain(points.windows(2).map(|w| {
                length += w[0].distance(w[1]);
                length
            }))
            .take(points.len())
            .collect();
        let normals = at.iter().map(|s| ends[0].lerp(ends[1], s / length.max(f64::MIN_POSITIVE)).normalize_or_zero());
        Self { vertices: joint.to_vec(), normals: normals.collect(), points }
    }

    /// For every vertex a point beyond the rim, in the plane tangent there: where the patch would go on to.
    fn ghosts(&self) -> Vec<DVec3> {
        let n = self.points.len();
        let reach = (0..n).map(|i| self.points[i].distance(self.points[(i + 1) % n])).sum::<f64>() / n as f64;
        (0..n)
            .map(|i| {
                let along = self.points[(i + 1) % n] - self.points[(i + n - 1) % n];
                self.points[i] - reach * self.normals[i].cross(along).normalize_or_zero()
            })
            .collect()
    }
}
