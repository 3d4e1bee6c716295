//! The curves in which two surfaces cross, whether they are closed solids or open patches.

use crate::arrange::{self, Arrangement, Part, Simplex};
use crate::error::Error;
use crate::near::near;
use crate::seam::chain;
use glam::DVec3;
use mesh_core::{Bounds, Connected, FaceId, HalfedgeId, Positions, SurfacePoint, TriMesh, VertexId, Watch};

/// A curve in which two surfaces cross.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Its corners in order. Walking along with a's normal up, what lies behind b is on the left.
    pub points: Vec<CurvePoint>,
    /// Whether the last point is joined to the first.
    pub closed: bool,
}

/// A corner of a curve: an edge of one surface through a face of the other, or a degenerate case of that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// The place, rounded once from the exact point.
    pub position: DVec3,
    /// Where it is on a.
    pub on_a: SurfacePoint,
    /// Where it is on b.
    pub on_b: SurfacePoint,
}

/// The curves in which two oriented surfaces cross, closed or open; where they only touch there is none. The surfaces may
/// be open, and may even intersect themselves: curves are chained by the names of their points (edge, face), never by
/// distance.
///
/// # Errors
/// [`Error::NotFinite`], [`Error::Degenerate`], [`Error::Cancelled`].
pub fn intersection_curves(a: &Connected<TriMesh>, b: &Connected<TriMesh>, watch: &Watch) -> Result<Vec<Curve>, Error> {
    let parts = arrange::parts(a, b)?;
    let bounds = [a, b].map(|m| Bounds::of(m.mesh().faces.iter().flatten().map(|&v| m.position(v))));
    let crossings = arrange::crossings(&parts, &near(a.mesh(), b.mesh(), bounds).pairs, watch)?;
    if let Some(error) = crossings.degenerate_error(&parts) {
        return Err(error);
    }
    let arrangement = Arrangement::new(&parts, &crossings);
    let seams = chain(&net_segments(&arrangement));
    let point = |v: VertexId| curve_point(&parts, &arrangement, v.0);
    Ok(seams
        .into_iter()
        .map(|s| Curve { points: s.vertices.into_iter().map(point).collect(), closed: s.closed })
        .collect())
}

/// Directed segments between nodes, in order. Where one runs along an edge it is found once for each face there: if all
/// agree on its direction the surfaces cross, if they cancel out they touch.
fn net_segments(arrangement: &Arrangement) -> Vec<[VertexId; 2]> {
    let mut directed: Vec<([u32; 2], i32)> = arrangement
        .segments
        .iter()
        .filter(|s| !s.coplanar && s.ends[0] != s.ends[1])
        .map(|s| match s.ends {
            [p, q] if p < q => ([p, q], 1),
            [p, q] => ([q, p], -1),
        })
        .collect();
    directed.sort_unstable();
    let mut net: Vec<[VertexId; 2]> = directed
        .chunk_by(|x, y| x.0 == y.0)
        .filter_map(|group| {
            let [p, q] = group[0].0.map(VertexId);
            match group.iter().map(|g| g.1).sum::<i32>() {
                0 => None,
                n if n > 0 => Some([p, q]),
                _ => Some([q, p]),
            }
        })
        .collect();
    net.sort_unstable();
    net
}

fn curve_point(parts: &[Part; 2], arrangement: &Arrangement, node: u32) -> CurvePoint {
    let position = arrangement.position(parts, node);
    let key = arrangement.key(node);
    let [on_a, on_b] = [0, 1].map(|w| surface_point(parts[w].mesh, key[w], position));
    CurvePoint { position, on_a, on_b }
}

fn surface_point(mesh: &Connected<TriMesh>, simplex: Simplex, position: DVec3) -> SurfacePoint {
    match simplex {
        Simplex::Vertex(v) => SurfacePoint::Vertex(VertexId(v)),
        Simplex::Edge(e) => {
            let halfedge = HalfedgeId(e);
            let [p, q] = mesh.ends(halfedge);
            let d = (q - p) / (q - p).abs().max_element();
            let t = (position - p).dot(d) / (q - p).dot(d);
            SurfacePoint::Edge { halfedge, t: t.clamp(f64::EPSILON, 1.0 - f64::EPSILON) }
        }
        Simplex::Face(f) => {
            let barycentric = barycentric(&mesh.triangle(FaceId(f)), position);
            SurfacePoint::Face { face: FaceId(f), barycentric }
        }
    }
}

/// Barycentric coordinates of the foot of `p` on the plane of `t`, kept within the triangle.
pub(crate) fn barycentric(t: &[DVec3; 3], p: DVec3) -> [f64; 3] {
    let size = (t[1] - t[0]).abs().max((t[2] - t[0]).abs()).max_element();
    let [u, v, w] = [t[1] - t[0], t[2] - t[0], p - t[0]].map(|x| x / size);
    let n = u.cross(v);
    let area = n.length_squared();
    let (b, c) = (w.cross(v).dot(n) / area, u.cross(w).dot(n) / area);
    let clamped = [1.0 - b - c, b, c].map(|x| x.clamp(f64::EPSILON, 1.0));
    let sum: f64 = clamped.iter().sum();
    clamped.map(|x| x / sum)
}
