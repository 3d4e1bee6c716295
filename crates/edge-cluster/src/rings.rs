//! Triangles over one patch: rings around its middle, as dense as curvature asks for in each direction.

use crate::patch::Patch;
use crate::sample::cuts;
use glam::{DVec2, DVec3};
use mesh_core::VertexId;

/// A straight piece of the domain's boundary, with the vertices already on it.
#[derive(Clone, Debug)]
pub struct Segment {
    /// Where it begins and ends in the domain; all segments run counter-clockwise.
    pub ends: [DVec2; 2],
    /// Shares of it at which there are vertices, from 0 to 1.
    pub shares: Vec<f64>,
    /// The vertices, one per share.
    pub vertices: Vec<VertexId>,
}

/// What a patch adds to the mesh.
#[derive(Clone, Debug, Default)]
pub struct Sheet {
    /// Points inside the patch.
    pub points: Vec<DVec3>,
    /// Triangles. Vertices from `first` on, as given to [`cover`], are these points.
    pub faces: Vec<[VertexId; 3]>,
}

/// Radii and places along a segment at which curvature is looked at.
const RADII: usize = 12;
const PLACES: usize = 4;

/// Covers the part of a patch within `border` by triangles whose chords stay within about `tolerance`. New points are
/// numbered from `first`. The border must be a convex polygon around the domain's middle.
pub fn cover(patch: &Patch, border: &[Segment], tolerance: f64, first: u32) -> Sheet {
    let center = patch.center();
    let bends = Bends::look(patch, border, tolerance);
    // From the border inward.
    let inward: Vec<f64> = cuts(&bends.radial, 2).into_iter().map(|x| 1.0 - x).collect();
    let rings = inward.len() - 1;
    let mut at: Vec<DVec2> = vec![];
    let mut faces = vec![];
    let mut outer: Vec<(Vec<f64>, Vec<VertexId>)> =
        border.iter().map(|s| (s.shares.clone(), s.vertices.clone())).collect();
    for &radius in &inward[1..rings] {
        let mut inner: Vec<(Vec<f64>, Vec<VertexId>)> = vec![];
        let start = first + at.len() as u32;
        for (s, segment) in border.iter().enumerate() {
            let shares = cuts(&bends.around(s, radius), 1);
            let vertices = shares[..shares.len() - 1].iter().map(|&x| {
                at.push(center + radius * (segment.ends[0].lerp(segment.ends[1], x) - center));
                VertexId(first + at.len() as u32 - 1)
            });
            inner.push((shares.clone(), vertices.collect()));
        }
        for s in 0..inner.len() {
            let next = if s + 1 < inner.len() { inner[s + 1].1[0] } else { VertexId(start) };
            inner[s].1.push(next);
        }
        for (o, i) in outer.iter().zip(&inner) {
            zip(o, i, &mut faces);
        }
        outer = inner;
    }
    let middle = VertexId(first + at.len() as u32);
    at.push(center);
    for (_, vertices) in &outer {
        faces.extend(vertices.windows(2).map(|w| [w[0], w[1], middle]));
    }
    let mut points = vec![];
    patch.points(&at, &mut points);
    Sheet { points, faces }
}

/// Triangles between two rows of vertices over the same segment, the outer one first; both run counter-clockwise.
fn zip(outer: &(Vec<f64>, Vec<VertexId>), inner: &(Vec<f64>, Vec<VertexId>), faces: &mut Vec<[VertexId; 3]>) {
    let (mut i, mut j) = (0, 0);
    let (last_i, last_j) = (outer.1.len() - 1, inner.1.len() - 1);
    while i < last_i || j < last_j {
        // The step whose middle comes first, so that rungs stay upright.
        let next =
            |shares: &[f64], i: usize, last: usize| if i < last { shares[i] + shares[i + 1] } else { f64::INFINITY };
        if next(&outer.0, i, last_i) <= next(&inner.0, j, last_j) {
            faces.push([outer.1[i], outer.1[i + 1], inner.1[j]]);
            i += 1;
        } else {
            faces.push([outer.1[i], inner.1[j + 1], inner.1[j]]);
            j += 1;
        }
    }
}

/// How many pieces curvature asks for, over a grid of radii and places.
struct Bends {
    /// Pieces per part of the radius, from the border inward.
    radial: Vec<f64>,
    /// Pieces per place of each segment at each radius, from the border inward, for rings of radius one.
    along: Vec<Vec<[f64; PLACES]>>,
}

impl Bends {
    fn look(patch: &Patch, border: &[Segment], tolerance: f64) -> Self {
        let center = patch.center();
        // Errors across and along add up, and the diagonals bring the mixed derivative in.
        let scale = 1.0 / (8.0 * 0.5 * tolerance);
        let mut bends = Self { radial: vec![0.0; RADII], along: vec![vec![[0.0; PLACES]; RADII]; border.len()] };
        for (s, segment) in border.iter().enumerate() {
            let along = segment.ends[1] - segment.ends[0];
            for place in 0..PLACES {
                let spoke = segment.ends[0].lerp(segment.ends[1], (place as f64 + 0.5) / PLACES as f64) - center;
                for ring in 0..RADII {
                    let radius = 1.0 - (ring as f64 + 0.5) / RADII as f64;
                    let [xx, xy, yy] = patch.jet(center + radius * spoke).second;
                    let bend = |d: DVec2| (d.x * d.x * xx + 2.0 * d.x * d.y * xy + d.y * d.y * yy).length();
                    let radial = &mut bends.radial[ring];
                    *radial = radial.max((bend(spoke) * scale).sqrt() / RADII as f64);
                    bends.along[s][ring][place] = (bend(along) * scale).sqrt() / PLACES as f64;
                }
            }
        }
        bends
    }

    /// Pieces per place along a segment of a ring.
    fn around(&self, segment: usize, radius: f64) -> [f64; PLACES] {
        let ring = (((1.0 - radius) * RADII as f64) as usize).min(RADII - 1);
        self.along[segment][ring].map(|d| d * radius)
    }
}
