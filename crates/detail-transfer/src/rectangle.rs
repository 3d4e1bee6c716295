//! Rectangles around anchors of a governing curve, laid into the plane.

use crate::relief::{Detail, Relief};
use glam::{DVec2, DVec3};
use mesh_core::{Adjacency, Connected, FaceId, Faces, Positions, TriMesh, VertexId, triangle_normal};
use mesh_query::TriBvh;
use param_conformal::map_free;
use std::collections::HashSet;

/// A point of a governing curve on a base surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Anchor {
    pub face: FaceId,
    pub at: DVec3,
    pub along: DVec3,
}

/// Points of a polyline at even distances, at most `spacing` apart, on the base of a relief; those farther than `reach` from it are left
/// out. Also the curve's length.
pub(crate) fn anchors(relief: &Relief, curve: &[DVec3], spacing: f64, reach: f64) -> Vec<Anchor> {
    let base = relief.base();
    let Ok(tree) = TriBvh::build(base) else { return vec![] };
    let total = length(curve);
    let count = (total / spacing).ceil().clamp(1.0, MOST_ANCHORS) as usize;
    let point = |k: usize| at_length(curve, total * k as f64 / count as f64);
    let one = |k: usize| {
        let found = tree.closest_point_within(base, point(k), reach)?;
        let along = point((k + 1).min(count)) - point(k.saturating_sub(1));
        Some(Anchor { face: found.face, at: found.point, along })
    };
    (0..=count).filter_map(one).collect()
}

/// A bound on the work that a mistyped spacing can ask for.
const MOST_ANCHORS: f64 = 1e4;

/// The length of a polyline.
pub(crate) fn length(curve: &[DVec3]) -> f64 {
    curve.windows(2).map(|w| w[0].distance(w[1])).sum()
}

fn at_length(curve: &[DVec3], mut left: f64) -> DVec3 {
    for w in curve.windows(2) {
        let step = w[0].distance(w[1]);
        if left <= step && step > 0.0 {
            return w[0].lerp(w[1], left / step);
        }
        left -= step;
    }
    curve.last().copied().unwrap_or_default()
}

/// The base around an anchor as a plane: x along the curve, y across to the left, both in model units, the anchor at the origin.
pub(crate) struct Rectangle {
    /// Vertices by number in the relief's patch, ascending.
    pub vertices: Vec<u32>,
    pub places: Vec<DVec2>,
    /// Cosine and sine of the plane's x axis in each vertex's frame.
    directions: Vec<DVec2>,
    /// Corners by place in `vertices`.
    faces: Vec<[u32; 3]>,
    cells: Cells,
}

impl Rectangle {
    /// The faces that project into the rectangle of half extents `half` in the anchor's tangent plane, hanging together with the anchor's,
    /// mapped conformally where they are a disc, else projected.
    pub fn new(relief: &Relief, anchor: &Anchor, half: DVec2) -> Option<Self> {
        let base = relief.base();
        let normal = triangle_normal(base.triangle(anchor.face));
        let x = (anchor.along - anchor.along.dot(normal) * normal).try_normalize()?;
        let y = normal.cross(x);
        let flat = |p: DVec3| DVec2::new((p - anchor.at).dot(x), (p - anchor.at).dot(y));
        let faces = around(base, anchor.face, normal, |p| flat(p).abs().cmple(half).all());
        let mut vertices: Vec<u32> = faces.iter().flat_map(|&f| base.corners(f).map(|v| v.0)).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let place = |v: VertexId| vertices.binary_search(&v.0).unwrap_or(0) as u32;
        let corners: Vec<[u32; 3]> = faces.iter().map(|&f| base.corners(f).map(place)).collect();
        let points: Vec<DVec3> = vertices.iter().map(|&v| base.position(VertexId(v))).collect();
        let projected: Vec<DVec2> = points.iter().map(|&p| flat(p)).collect();
        let own = TriMesh::from_arrays(points.clone(), corners.iter().copied());
        let places = Connected::new(own)
            .ok()
            .and_then(|own| map_free(&own).ok())
            .and_then(|map| aligned(map.as_slice(), &projected, half))
            .unwrap_or(projected);
        let directions = directions(relief, &vertices, &points, &places, &corners);
        let cells = Cells::new(&places, &corners);
        Some(Self { vertices, places, directions, faces: corners, cells })
    }

    /// A detail of the `k`-th vertex in coordinates of the plane.
    pub fn to_plane(&self, k: usize, d: &Detail) -> Detail {
        let back = DVec2::new(self.directions[k].x, -self.directions[k].y);
        turned(d, back)
    }

    /// A detail in coordinates of the plane as one of the `k`-th vertex.
    pub fn on_surface(&self, k: usize, d: &Detail) -> Detail {
        turned(d, self.directions[k])
    }

    /// The face over a place and the weights of its corners.
    pub fn locate(&self, at: DVec2) -> Option<([u32; 3], [f64; 3])> {
        self.cells.at(at).iter().find_map(|&f| {
            let corners = self.faces[f as usize];
            let [a, b, c] = corners.map(|k| self.places[k as usize]);
            let area = (b - a).perp_dot(c - a);
            let weights = [(b - at).perp_dot(c - at) / area, (c - at).perp_dot(a - at) / area];
            let weights = [weights[0], weights[1], 1.0 - weights[0] - weights[1]];
            (area > 0.0 && weights.iter().all(|&w| w >= -1e-9)).then_some((corners, weights))
        })
    }
}

fn turned(d: &Detail, by: DVec2) -> Detail {
    let turn = |v: DVec3| by.rotate(v.truncate()).extend(v.z);
    Detail { bend: turn(d.bend), offset: turn(d.offset) }
}

/// Faces reached from `first` over faces that look its way and have a corner where `within` holds.
fn around(base: &Connected<TriMesh>, first: FaceId, normal: DVec3, within: impl Fn(DVec3) -> bool) -> Vec<FaceId> {
    let fits = |f: FaceId| {
        let p = base.triangle(f);
        p.iter().any(|&p| within(p)) && triangle_normal(p).dot(normal) > 0.2
    };
    let mut found = HashSet::from([first]);
    let mut all = vec![first];
    let mut next = 0;
    while let Some(&f) = all.get(next) {
        next += 1;
        for g in base.neighbours(f) {
            if !found.contains(&g) && fits(g) {
                found.insert(g);
                all.push(g);
            }
        }
    }
    all.sort_unstable();
    all
}

/// A conformal map turned, scaled and moved to where the projection has the middle of the rectangle.
fn aligned(map: &[DVec2], projected: &[DVec2], half: DVec2) -> Option<Vec<DVec2>> {
    let middle: Vec<usize> = (0..map.len()).filter(|&k| (projected[k] / half).abs().max_element() < 0.5).collect();
    let middle = if middle.len() < 3 { (0..map.len()).collect() } else { middle };
    let mean = |of: &[DVec2]| middle.iter().map(|&k| of[k]).sum::<DVec2>() / middle.len() as f64;
    let (from, to) = (mean(map), mean(projected));
    let conjugate = |z: DVec2| DVec2::new(z.x, -z.y);
    let (mut product, mut size) = (DVec2::ZERO, 0.0);
    for &k in &middle {
        product += conjugate(map[k] - from).rotate(projected[k] - to);
        size += (map[k] - from).length_squared();
    }
    let factor = product / size;
    factor.is_finite().then(|| map.iter().map(|&z| to + factor.rotate(z - from)).collect())
}

/// The direction of the plane's x axis on the surface, in each vertex's frame.
fn directions(relief: &Relief, vertices: &[u32], points: &[DVec3], places: &[DVec2], faces: &[[u32; 3]]) -> Vec<DVec2> {
    let mut sums = vec![DVec3::ZERO; vertices.len()];
    for corners in faces {
        let [p, q, r] = corners.map(|k| points[k as usize]);
        let [a, b, c] = corners.map(|k| places[k as usize]);
        let (e, f) = (b - a, c - a);
        // Times the area, so that large faces count more and flat ones nothing.
        let ahead = DVec2::X.perp_dot(f) * (q - p) + e.perp_dot(DVec2::X) * (r - p);
        for &k in corners {
            sums[k as usize] += ahead;
        }
    }
    let unit = |(&v, sum): (&u32, &DVec3)| {
        let local = relief.frames()[v as usize].local(*sum);
        DVec2::new(local.x, local.y).try_normalize().unwrap_or(DVec2::X)
    };
    vertices.iter().zip(&sums).map(unit).collect()
}

/// Faces by the square cells that their boxes meet.
struct Cells {
    low: DVec2,
    size: f64,
    count: [usize; 2],
    lists: Vec<Vec<u32>>,
}

impl Cells {
    fn new(places: &[DVec2], faces: &[[u32; 3]]) -> Self {
        let (low, high) =
            places.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)));
        let extent = (high - low).max(DVec2::ZERO);
        // About one face a cell.
        let size = (extent.x * extent.y / faces.len().max(1) as f64).sqrt();
        let size = if size > 0.0 && size.is_finite() { size } else { 1.0 };
        let count = [extent.x, extent.y].map(|e| ((e / size) as usize).min(4 * faces.len()) + 1);
        let mut out = Self { low, size, count, lists: vec![vec![]; count[0] * count[1]] };
        for (f, corners) in faces.iter().enumerate() {
            let [a, b, c] = corners.map(|k| places[k as usize]);
            let (from, to) = (out.cell(a.min(b).min(c)), out.cell(a.max(b).max(c)));
            for j in from[1]..=to[1] {
                for i in from[0]..=to[0] {
                    out.lists[j * count[0] + i].push(f as u32);
                }
            }
        }
        out
    }

    fn cell(&self, p: DVec2) -> [usize; 2] {
        let q = (p - self.low) / self.size;
        [(q.x as usize).min(self.count[0] - 1), (q.y as usize).min(self.count[1] - 1)]
    }

    fn at(&self, p: DVec2) -> &[u32] {
        let [i, j] = self.cell(p);
        &self.lists[j * self.count[0] + i]
    }
}
