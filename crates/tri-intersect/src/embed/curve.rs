//! Curves on a mesh, and how they are embedded.

use glam::DVec3;
use mesh_core::{Adjacency, Positions, SurfacePoint, TraceError, TraceLimits, trace};

/// A curve on a mesh. Consecutive points lie in the closure of a common face; so do the last and the first of a closed curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceCurve {
    /// The points in order. The first is not repeated at the end of a closed curve.
    pub points: Vec<SurfacePoint>,
    /// Whether the last point joins the first.
    pub closed: bool,
}

impl SurfaceCurve {
    /// The curve through `samples`, each with the rough surface normal there, by [`trace`] between neighbours. Also
    /// gives the index in the curve of every sample.
    ///
    /// # Errors
    /// [`TraceError`] where two neighbours are not joined by a short stretch of surface.
    pub fn through<M: Adjacency + Positions>(
        mesh: &M,
        samples: &[(SurfacePoint, DVec3)],
        closed: bool,
        limits: &TraceLimits,
    ) -> Result<(Self, Vec<usize>), TraceError> {
        let (mut points, mut places) = (vec![], Vec::with_capacity(samples.len()));
        for (i, &(from, normal)) in samples.iter().enumerate() {
            places.push(points.len());
            points.push(from);
            let next = samples.get(i + 1).or(closed.then(|| &samples[0]));
            if let Some(&(to, other)) = next {
                points.extend(trace(mesh, from, to, normal + other, limits)?);
            }
        }
        Ok((Self { points, closed }, places))
    }
}

/// How curves are embedded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmbedParams {
    /// Points nearer to an edge than this share of the face's height over it move onto the edge, and points nearer to a
    /// vertex than this share of the edge move onto the vertex; in [0, 0.25]. A share of the triangle's own size, so
    /// that needles are treated as well as equilateral ones.
    ///
    /// Points are not moved where that would make curves meet, so a larger snap costs accuracy only. It buys shape: of the pieces left by
    /// 415 pairs of plane sections of real meshes, 1.7% had an angle under 1° at 0, 1.6% at 1e-3, 1.0% at 1e-2, 0.1%
    /// at 5e-2.
    pub snap: f64,
    /// No point is moved farther than this, in model units. Set it where triangles may be large beside what the curves bound; a
    /// hundredth of a fillet's radius, say.
    pub reach: f64,
}

impl Default for EmbedParams {
    fn default() -> Self {
        Self { snap: 1e-2, reach: f64::INFINITY }
    }
}
