//! A ring on a rectangle with given boundary values.

use crate::distortion::{Distortion, check};
use crate::error::Error;
use crate::harmonic::{Harmonic, Pull, Weights, for_neighbours};
use crate::ring::CutRing;
use glam::DVec2;
use mesh_core::{Adjacency, CornerMap, FaceId, Faces, HalfedgeId, Positions, VertexId, VertexMap};

/// How the two ends of the rectangle, which are one seam on the surface, are treated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Seam {
    /// They meet as on a cylinder: the map does not depend on where the seam runs, and the seam need not become straight.
    #[default]
    Periodic,
    /// The seam is laid onto both ends at the same heights, by its length, as in \[Liu2005\] §5.1. Costs distortion
    /// where the seam zigzags.
    Straight,
}

/// Where the boundary goes: `[0, period] × [0, height]`, bottom on y = 0, top on y = height.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// x of each vertex of [`CutRing::bottom`]: strictly rising within one period, the first at or after 0.
    pub bottom: Vec<f64>,
    /// x of each vertex of [`CutRing::top`], likewise.
    pub top: Vec<f64>,
    /// Length all round, positive.
    pub period: f64,
    /// Distance of top and bottom, positive. The map scales with it.
    pub height: f64,
}

impl Outline {
    /// Both loops by arc length from the seam on, scaled to the longer one's length.
    pub fn by_length<M: Faces + Positions>(mesh: &M, ring: &CutRing, height: f64) -> Self {
        let measure = |chain: &[VertexId]| {
            let mut run = 0.0;
            let starts: Vec<f64> = (0..chain.len())
                .map(|i| {
                    let start = run;
                    run += mesh.position(chain[i]).distance(mesh.position(chain[(i + 1) % chain.len()]));
                    start
                })
                .collect();
            (starts, run)
        };
        let ((bottom, below), (top, above)) = (measure(ring.bottom()), measure(ring.top()));
        let period = below.max(above);
        let scaled = |starts: Vec<f64>, own: f64| starts.into_iter().map(|s| s * (period / own)).collect();
        Self { bottom: scaled(bottom, below), top: scaled(top, above), period, height }
    }

    fn check(&self, ring: &CutRing) -> Result<(), Error> {
        for (values, chain) in [(&self.bottom, ring.bottom()), (&self.top, ring.top())] {
            let fault = |i: usize| {
                let x = values[i];
                !x.is_finite() || i > 0 && x <= values[i - 1] || x >= values[0] + self.period
            };
            let index = (0..values.len()).find(|&i| fault(i)).unwrap_or(values.len());
            let sized = self.period > 0.0 && self.height > 0.0 && (self.period + self.height).is_finite();
            if values.len() != chain.len() || index < values.len() || !sized {
                return Err(Error::Outline { expected: chain.len(), given: values.len(), index });
            }
        }
        Ok(())
    }
}

/// A ring's map into the plane, x modulo a period.
#[derive(Clone, Debug, PartialEq)]
pub struct RingMap {
    /// Every vertex, seam vertices at the seam's right side.
    pub points: VertexMap<DVec2>,
    /// Length all round.
    pub period: f64,
    /// Whether a corner lies on the seam, to the left of it.
    left: CornerMap<bool>,
}

impl RingMap {
    /// The corners of a triangle, in one piece.
    pub fn corners<M: Faces>(&self, mesh: &M, f: FaceId) -> [DVec2; 3] {
        [0, 1, 2].map(|k| self.corner(mesh, HalfedgeId::new(f, k)))
    }

    /// The corner that `h` leaves, at its place in its triangle.
    #[inline]
    pub fn corner<M: Faces>(&self, mesh: &M, h: HalfedgeId) -> DVec2 {
        let point = self.points[mesh.tail(h)];
        if self.left[h] { point + DVec2::new(self.period, 0.0) } else { point }
    }

    /// How far the map is from keeping shapes.
    pub fn distortion<M: Faces + Positions>(&self, mesh: &M) -> Distortion {
        Distortion::of(mesh, |f| self.corners(mesh, f))
    }
}

/// Maps a ring conformally onto a rectangle with fixed boundary.
///
/// # Errors
/// [`Error::Outline`], [`Error::Flipped`], and those of [`Harmonic::new`].
pub fn map_ring<M: Adjacency + Positions + Sync>(
    mesh: &M,
    ring: &CutRing,
    outline: &Outline,
    seam: Seam,
) -> Result<RingMap, Error> {
    map_ring_with(mesh, ring, outline, seam, Weights::Cotangent)
}

/// The same with other weights.
///
/// # Errors
/// As [`map_ring`].
pub fn map_ring_with<M: Adjacency + Positions + Sync>(
    mesh: &M,
    ring: &CutRing,
    outline: &Outline,
    seam: Seam,
    weights: Weights,
) -> Result<RingMap, Error> {
    outline.check(ring)?;
    let map = lay_out(mesh, ring, outline, seam, weights)?;
    check(mesh, |f| map.corners(mesh, f))?;
    Ok(map)
}

fn lay_out<M: Adjacency + Positions + Sync>(
    mesh: &M,
    ring: &CutRing,
    outline: &Outline,
    seam: Seam,
    weights: Weights,
) -> Result<RingMap, Error> {
    let mut fixed: Vec<VertexId> = ring.bottom().iter().chain(ring.top()).copied().collect();
    let rows = [(&outline.bottom, 0.0), (&outline.top, outline.height)];
    let mut values: Vec<[f64; 2]> = rows.into_iter().flat_map(|(xs, y)| xs.iter().map(move |&x| [x, y])).collect();
    if seam == Seam::Straight {
        let inner = &ring.seam()[..ring.seam().len() - 1];
        let ends = [outline.bottom[0], outline.top[0]];
        let length = |h: &HalfedgeId| mesh.edge_length(*h);
        let total: f64 = ring.seam().iter().map(length).sum();
        let mut run = 0.0;
        for h in inner {
            run += length(h) / total;
            fixed.push(mesh.head(*h));
            values.push([ends[0] + run * (ends[1] - ends[0]), run * outline.height]);
        }
    }
    let pull = Pull::of(mesh, weights);
    // Where an edge crosses from the left of the seam onto it, x jumps by one period: a source at both its ends.
    let mut sources = Vec::new();
    let mut seen = VertexMap::filled(mesh.vertex_count(), false);
    for &h in ring.left_corners() {
        let v = mesh.tail(h);
        if std::mem::replace(&mut seen[v], true) {
            continue;
        }
        for_neighbours(mesh, v, |edge, w| {
            if seen[w] {
                return;
            }
            let leaves = mesh.tail(edge) == v;
            // The corner of v in a triangle at this edge; on the seam's own edges both sides tell the same of both ends.
            let (mine, other) = if leaves { (edge, edge.next()) } else { (edge.next(), edge) };
            let jump = f64::from(i8::from(ring.is_left(mine)) - i8::from(ring.is_left(other)));
            if jump != 0.0 {
                let flow = pull.along(mesh, edge) * jump * outline.period;
                sources.push((v, [-flow, 0.0]));
                sources.push((w, [flow, 0.0]));
            }
        });
    }
    let found = Harmonic::with_pull(mesh, &fixed, &pull)?.solve_with_sources(&values, &sources);
    let points: Vec<DVec2> = found.into_vec().into_iter().map(DVec2::from_array).collect();
    let mut left = CornerMap::filled(3 * mesh.face_count(), false);
    ring.left_corners().iter().for_each(|&h| left[h] = true);
    Ok(RingMap { points: points.into(), period: outline.period, left })
}
