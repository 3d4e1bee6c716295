//! The openings to be joined, and whether the parts are posed so that they can be.

use super::{Error, Params};
use glam::DVec3;
use lmc_tessellate::Rim;
use mesh_core::{
    Adjacency, Bounds, Connected, FaceId, Faces, HalfedgeId, Positions, TriMesh, VertexId, boundary_loops, bounds,
    components, one_sided_normal,
};
use mesh_query::TriBvh;
use tri_intersect::triangles_intersect;

/// One boundary loop of a part.
pub(super) struct Opening {
    pub part: usize,
    /// Its place among the part's loops.
    pub index: usize,
    pub walk: Vec<HalfedgeId>,
    /// Its vertices in order.
    pub vertices: Vec<VertexId>,
    pub rim: Rim,
    /// Outward unit normals at the vertices, turned by the crease.
    pub normals: Vec<DVec3>,
    /// By how much the surface turns inward at the opening, in radians.
    pub crease: f64,
}

impl Opening {
    fn new(part: usize, index: usize, mesh: &Connected<TriMesh>, walk: Vec<HalfedgeId>, crease: f64) -> Self {
        let vertices: Vec<VertexId> = walk.iter().map(|&h| mesh.tail(h)).collect();
        let mut rim = Rim::of(mesh, &walk);
        let own = |&v: &VertexId| one_sided_normal(mesh, v, mesh.ring(v).map(HalfedgeId::face));
        let mut normals: Vec<DVec3> = vertices.iter().map(own).collect();
        let (n, (sin, cos)) = (walk.len(), crease.sin_cos());
        if crease != 0.0 {
            // The part is on the left of its boundary, so t × n leads out of it.
            let turned = |along: DVec3, normal: DVec3| {
                (cos * normal + sin * along.cross(normal).normalize_or_zero()).normalize_or(normal)
            };
            let at = |i: usize| rim.points[i % n];
            normals = (0..n).map(|i| turned(at(i + 1) - at(i + n - 1), normals[i])).collect();
            rim.normals = (0..n).map(|i| turned(at(i + 1) - at(i), rim.normals[i])).collect();
        }
        Self { part, index, walk, vertices, rim, normals, crease }
    }

    /// Its length.
    pub fn perimeter(&self) -> f64 {
        self.rim.lengths().sum()
    }

    /// Its edges' mean length.
    pub fn mean_edge(&self) -> f64 {
        self.perimeter() / self.walk.len() as f64
    }
}

/// The chosen loops as (part, loop), or all.
pub(super) fn openings(parts: &[Connected<TriMesh>], params: &Params) -> Result<Vec<Opening>, Error> {
    let chosen = params.loops.as_deref();
    let mut found = vec![];
    for (part, mesh) in parts.iter().enumerate() {
        for (index, walk) in boundary_loops(mesh).into_iter().enumerate() {
            let own = params.creases.iter().rev().find(|c| (c.part, c.index) == (part, index));
            let crease = own.map_or(params.crease, |c| c.angle);
            found.push(Opening::new(part, index, mesh, walk, crease.to_radians()));
        }
    }
    let named = chosen.unwrap_or_default().iter().copied().chain(params.creases.iter().map(|c| (c.part, c.index)));
    for (part, index) in named {
        let count = found.iter().filter(|o| o.part == part).count();
        if index >= count {
            return Err(Error::NoLoop { part, index, count });
        }
    }
    found.retain(|o| chosen.is_none_or(|c| c.contains(&(o.part, o.index))));
    if found.is_empty() { Err(Error::Closed) } else { Ok(found) }
}

/// Refuses parts that are inside out, that cross each other, or whose openings lie inside each other.
pub(super) fn check_pose(parts: &[Connected<TriMesh>], openings: &[Opening]) -> Result<(), Error> {
    for (part, mesh) in parts.iter().enumerate() {
        check_orientation(part, mesh)?;
    }
    let boxes: Vec<Bounds> = parts.iter().map(bounds).collect();
    for (first, a) in parts.iter().enumerate() {
        for (second, b) in parts.iter().enumerate().skip(first + 1) {
            if boxes[first].overlaps(&boxes[second]) {
                let shared = Bounds {
                    min: boxes[first].min.max(boxes[second].min),
                    max: boxes[first].max.min(boxes[second].max),
                };
                if let Some(at) = first_crossing(a, b, &shared) {
                    return Err(Error::Overlap { first, second, at });
                }
            }
        }
    }
    for opening in openings {
        for (other, mesh) in parts.iter().enumerate().filter(|(other, _)| *other != opening.part) {
            let at = opening.rim.points[0];
            // An open part winds less than once round what it holds; far outside it winds hardly at all.
            if boxes[other].overlaps(&Bounds::of([at])) && winding(mesh, at) > 0.75 {
                return Err(Error::Buried { part: opening.part, index: opening.index, other, at });
            }
        }
    }
    Ok(())
}

/// Every component, closed by cones over its openings, must enclose a positive volume, or hardly any.
fn check_orientation(part: usize, mesh: &Connected<TriMesh>) -> Result<(), Error> {
    /// Share of a ball's volume under which a sheet has no inside to speak of.
    const FLAT: f64 = 0.2;
    let pieces = components(mesh);
    let mut volumes = vec![(0.0, 0.0, DVec3::ZERO); pieces.len()];
    let corners = |f: usize| mesh.triangle(FaceId::from(f));
    let center = bounds(mesh).center();
    for (f, &label) in pieces.labels.as_slice().iter().enumerate() {
        let [a, b, c] = corners(f).map(|p| p - center);
        let sum = &mut volumes[label as usize];
        *sum = (sum.0 + a.dot(b.cross(c)) / 6.0, sum.1 + 0.5 * (b - a).cross(c - a).length(), a + center);
    }
    for walk in boundary_loops(mesh) {
        let points: Vec<DVec3> = walk.iter().map(|&h| mesh.position(mesh.tail(h)) - center).collect();
        let middle = points.iter().sum::<DVec3>() / points.len() as f64;
        let label = pieces.labels[walk[0].face()] as usize;
        // The cone's faces run against the loop.
        volumes[label].0 +=
            (0..points.len()).map(|i| middle.dot(points[(i + 1) % points.len()].cross(points[i])) / 6.0).sum::<f64>();
    }
    for (volume, area, at) in volumes {
        if volume < -FLAT * area.powf(1.5) / (6.0 * std::f64::consts::PI.sqrt()) {
            return Err(Error::InsideOut { part, at });
        }
    }
    Ok(())
}

/// Where two parts cross, if they do.
fn first_crossing(a: &Connected<TriMesh>, b: &Connected<TriMesh>, shared: &Bounds) -> Option<DVec3> {
    let within = |mesh: &TriMesh| -> Vec<FaceId> {
        let near = |f: &usize| Bounds::of(mesh.triangle(FaceId::from(*f))).overlaps(shared);
        (0..mesh.faces.len()).filter(near).map(FaceId::from).collect()
    };
    let (p, q) = (a.mesh(), b.mesh());
    let (fp, fq) = (within(p), within(q));
    if fp.is_empty() || fq.is_empty() {
        return None;
    }
    let (Ok(tp), Ok(tq)) = (TriBvh::build_subset(p, &fp), TriBvh::build_subset(q, &fq)) else { return None };
    let pairs = tp.overlapping_pairs(p, &tq, q);
    let crossing = |pair: &&[FaceId; 2]| triangles_intersect(p.triangle(pair[0]), q.triangle(pair[1]));
    pairs.iter().find(crossing).map(|pair| p.triangle(pair[0])[0])
}

/// How often a part winds round a point: 1 inside a closed one, 0 outside (\[VanOosterom1983\]).
fn winding(mesh: &Connected<TriMesh>, p: DVec3) -> f64 {
    let solid_angle = |f: &[VertexId; 3]| {
        let [a, b, c] = f.map(|v| mesh.position(v) - p);
        let (l, m, n) = (a.length(), b.length(), c.length());
        2.0 * a.dot(b.cross(c)).atan2(l * m * n + a.dot(b) * n + b.dot(c) * l + c.dot(a) * m)
    };
    mesh.mesh().faces.iter().map(solid_angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// Mean edge of all openings and area of all parts, for the report.
pub(super) fn mean_edge(openings: &[Opening]) -> f64 {
    let edges: usize = openings.iter().map(|o| o.walk.len()).sum();
    openings.iter().flat_map(|o| o.rim.lengths()).sum::<f64>() / edges as f64
}
