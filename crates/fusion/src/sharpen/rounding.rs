//! Which faces are rounded: those against which a ball a little larger than the rounding cannot rest.

use super::Refusal;
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceMap, Faces, HalfedgeId, TriMesh, area_vector, centroid, dihedral_angle,
    face_normal,
};
use mesh_query::TriBvh;

/// The ball that tells what is rounded, as a multiple of the rounding's radius.
const LARGER: f64 = 1.05;
/// A ball rests where nothing reaches into it by more than this share of its radius.
const SLACK: f64 = 2e-4;
/// Least cosine between the normals where a ball touches twice: those of a rounding turn by little more than a right angle
/// from one side to the middle, those of a wall's two faces by a half turn.
const WALL: f64 = -0.2;
/// Faces whose normals differ by less than this, in radians, lie in one plane.
const FLAT: f64 = 1e-6;

/// The faces of one rounding.
pub(super) struct Rounding {
    /// Ascending.
    pub faces: Vec<FaceId>,
    /// 2 on the rounding, 1 on the smooth surface that it is a part of, else 0.
    pub of: FaceMap<u8>,
    /// Whether the ball rolls inside the solid.
    pub convex: bool,
    /// Radius of the ball at the place that was picked, in model units.
    pub radius: f64,
    /// Least turn of a crease, in degrees.
    angle: f64,
}

impl Rounding {
    /// The rounding at the surface point nearest to `at`, as far as creases of `angle` degrees. With a `radius`, all that is
    /// rounded by that or less counts; without, what is rounded as it is at that place.
    pub fn find(mesh: &Connected<TriMesh>, at: DVec3, radius: Option<f64>, angle: f64) -> Result<Self, Refusal> {
        let lost = |_| Refusal::NotRounded { at };
        let whole = TriBvh::build(mesh).map_err(lost)?;
        let seed = whole.closest_point(mesh, at).ok_or(Refusal::NotRounded { at })?.face;
        let mut found =
            Self { faces: vec![], of: FaceMap::filled(mesh.face_count(), 0), convex: true, radius: 0.0, angle };
        let smooth = found.flood(mesh, seed, 1, |_| true);
        let balls = Balls { mesh, surface: TriBvh::build_subset(mesh, &smooth).map_err(lost)? };
        let largest = balls.surface.bounds().diagonal();
        let [inside, outside] = [true, false].map(|convex| balls.largest_at(seed, convex, largest));
        found.convex = inside <= outside;
        found.radius = inside.min(outside);
        if found.radius >= largest {
            return Err(Refusal::NotRounded { at });
        }
        let ball = LARGER * radius.unwrap_or(found.radius);
        let convex = found.convex;
        let rounded = found.flood(mesh, seed, 2, |f| !balls.rests(f, convex, ball));
        found.faces = found.by_planes(mesh, &rounded);
        // Of a surface that is rounded all over there is nothing left to prolong.
        if found.of[seed] != 2 || found.faces.len() == smooth.len() {
            return Err(Refusal::NotRounded { at });
        }
        // What was given back may have cut something off.
        found.faces.iter().for_each(|&f| found.of[f] = 1);
        let faces = std::mem::take(&mut found.faces);
        let own: std::collections::BTreeSet<FaceId> = faces.into_iter().collect();
        found.faces = found.flood(mesh, seed, 2, |f| own.contains(&f));
        Ok(found)
    }

    /// Whether an edge is a crease, or bounds the mesh.
    pub fn is_crease(&self, mesh: &Connected<TriMesh>, h: HalfedgeId) -> bool {
        dihedral_angle(mesh, h).is_none_or(|a| a.abs().to_degrees() >= self.angle)
    }

    /// Labels what is reached from `seed` over faces of the kind without crossing a crease, and lists it, ascending.
    fn flood(
        &mut self,
        mesh: &Connected<TriMesh>,
        seed: FaceId,
        label: u8,
        kind: impl Fn(FaceId) -> bool,
    ) -> Vec<FaceId> {
        let mut all = vec![];
        let mut stack = vec![seed];
        while let Some(f) = stack.pop() {
            if self.of[f] == label || !kind(f) {
                continue;
            }
            self.of[f] = label;
            all.push(f);
            let edges = f.halfedges().into_iter().filter(|&h| !self.is_crease(mesh, h));
            stack.extend(edges.filter_map(|h| mesh.twin(h)).map(HalfedgeId::face));
        }
        all.sort_unstable();
        all
    }

    /// Lets every plane be all rounded or not at all, as most of its area is, and lists what is rounded then, ascending. Near
    /// its linkage a flat side has no room for the ball; where a rounding ends askew, little of what is opposite is left,
    /// and the ball may find room.
    fn by_planes(&mut self, mesh: &Connected<TriMesh>, rounded: &[FaceId]) -> Vec<FaceId> {
        let mut seen = FaceMap::filled(mesh.face_count(), false);
        let mut all = vec![];
        for &first in rounded {
            if std::mem::replace(&mut seen[first], true) {
                continue;
            }
            let mut plane = vec![first];
            for i in 0.. {
                let Some(&f) = plane.get(i) else { break };
                let n = face_normal(mesh, f);
                let level = |g: &FaceId| self.of[*g] != 0 && n.cross(face_normal(mesh, *g)).length() < FLAT;
                plane.extend(mesh.neighbours(f).filter(level).filter(|&g| !std::mem::replace(&mut seen[g], true)));
            }
            let area = |label: u8| -> f64 {
                let own = plane.iter().filter(|&&f| self.of[f] == label);
                own.map(|&f| area_vector(mesh.mesh().triangle(f)).length()).sum()
            };
            let label = if area(2) > area(1) { 2 } else { 1 };
            for &f in &plane {
                self.of[f] = label;
            }
            if label == 2 {
                all.extend(plane);
            }
        }
        all.sort_unstable();
        all
    }
}

/// Balls that touch a surface.
struct Balls<'a> {
    mesh: &'a Connected<TriMesh>,
    surface: TriBvh,
}

impl Balls<'_> {
    /// The middle of a face, and the direction from there to the ball's centre.
    fn place(&self, face: FaceId, convex: bool) -> (DVec3, DVec3) {
        let middle = centroid(self.mesh.mesh().triangle(face));
        let normal = face_normal(self.mesh, face);
        (middle, if convex { -normal } else { normal })
    }

    /// The radius of the largest ball that touches a face and enters the surface nowhere. A ball is largest where it touches
    /// a facet of a rounding half-way across, which is in the middle of one of a triangle's edges.
    fn largest_at(&self, face: FaceId, convex: bool, largest: f64) -> f64 {
        let (middle, inwards) = self.place(face, convex);
        let [a, b, c] = self.mesh.mesh().triangle(face);
        let places = [middle, a.midpoint(b), b.midpoint(c), c.midpoint(a)];
        places.into_iter().map(|p| self.largest_touching(p, inwards, face, largest)).fold(0.0, f64::max)
    }

    /// The same at one point: a ball made smaller until nothing reaches into it. `largest` if nothing ever does, or if it is
    /// a wall's other face.
    fn largest_touching(&self, p: DVec3, inwards: DVec3, face: FaceId, largest: f64) -> f64 {
        let (mut radius, mut last) = (largest, None);
        for _ in 0..64 {
            let center = p + radius * inwards;
            let Some(met) = self.surface.closest_point_within(self.mesh, center, radius * (1.0 - 1e-9)) else { break };
            let d = met.point - p;
            let smaller = d.length_squared() / (2.0 * d.dot(inwards));
            if !(smaller > 0.0 && smaller < radius * (1.0 - 1e-6)) {
                break;
            }
            (radius, last) = (smaller, Some(met.face));
        }
        let facing = |other: FaceId| face_normal(self.mesh, other).dot(face_normal(self.mesh, face));
        if last.is_some_and(|other| facing(other) > WALL) { radius } else { largest }
    }

    /// Whether a ball can rest on the middle of a face.
    fn rests(&self, face: FaceId, convex: bool, radius: f64) -> bool {
        let (p, inwards) = self.place(face, convex);
        let reach = radius * (1.0 - SLACK);
        self.surface.closest_point_within(self.mesh, p + radius * inwards, reach).is_none()
    }
}
