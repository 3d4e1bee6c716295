//! Feature curves: chains of edges across which the surface turns sharply.

use glam::DVec3;
use mesh_core::{Adjacency, Faces, HalfedgeId, Positions, VertexId, dihedral_angle};
use rayon::prelude::*;
use spine::BlendCurve;

/// Which edges are features.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// Least angle between the normals of an edge's two faces, in degrees, in (0, 180).
    pub angle: f64,
    /// Open curves that hang on a junction with no more edges than this are noise and are dropped. 0 keeps all.
    pub spur: usize,
}

impl Default for Params {
    /// 40 degrees, the usual crease angle of renderers; spurs of one edge.
    fn default() -> Self {
        Self { angle: 40.0, spur: 1 }
    }
}

/// On which side of the edge the material is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Convexity {
    /// An outer edge, as of a box: the ball rolls inside the solid.
    Convex,
    /// An inner edge, as between a post and a plate: the ball rolls outside.
    Concave,
}

/// A chain of edges between two junctions, ends or changes of convexity, or a closed one.
#[derive(Clone, Debug, PartialEq)]
pub struct FeatureCurve {
    /// One halfedge of each edge, the head of each being the tail of the next.
    pub halfedges: Vec<HalfedgeId>,
    /// Whether the last edge ends where the first begins.
    pub closed: bool,
    /// The same for all its edges.
    pub convexity: Convexity,
    /// Sum of its edges' lengths, in model units.
    pub length: f64,
    /// The least and greatest turn along it, in degrees, both positive.
    pub angles: [f64; 2],
}

impl From<FeatureCurve> for BlendCurve {
    fn from(curve: FeatureCurve) -> Self {
        Self { halfedges: curve.halfedges, closed: curve.closed }
    }
}

impl FeatureCurve {
    /// The curve's vertices in order; the first is not repeated at the end of a closed curve.
    pub fn vertices(&self, mesh: &impl Faces) -> Vec<VertexId> {
        let mut vertices: Vec<_> = self.halfedges.iter().map(|&h| mesh.tail(h)).collect();
        if let (false, Some(&last)) = (self.closed, self.halfedges.last()) {
            vertices.push(mesh.head(last));
        }
        vertices
    }
}

/// All feature curves, in order of their lowest halfedge. O(n) for n faces.
///
/// Curves end at junctions (vertices with one or more than two feature edges) and where convexity changes.
pub fn feature_curves<M: Adjacency + Positions + Sync>(mesh: &M, params: &Params) -> Vec<FeatureCurve> {
    let mut edges = Edges::sharp(mesh, params.angle);
    if params.spur > 0 {
        let spurs = edges.chains(mesh).into_iter().filter(|c| edges.is_spur(mesh, c, params.spur));
        for h in spurs.flatten().collect::<Vec<_>>() {
            edges.remove(mesh, h);
        }
    }
    let mut curves: Vec<_> = edges.chains(mesh).into_iter().map(|chain| edges.curve(mesh, chain)).collect();
    curves.sort_by_key(|c| c.halfedges.iter().min().copied());
    curves
}

/// The index of the curve nearest to `point`, and its distance; the lower index where two are as near.
pub fn nearest_curve<M: Adjacency + Positions>(
    mesh: &M,
    curves: &[FeatureCurve],
    point: DVec3,
) -> Option<(usize, f64)> {
    let found = nearest(mesh, curves.iter().map(|c| &c.halfedges[..]), point)?;
    Some((found.0, found.2))
}

/// The curve nearest to a point, the nearest point on it, and its distance; the lower index where two are as near.
pub fn nearest<'a, M: Faces + Positions>(
    mesh: &M,
    curves: impl Iterator<Item = &'a [HalfedgeId]>,
    point: DVec3,
) -> Option<(usize, DVec3, f64)> {
    let on_edge = |h: &HalfedgeId| {
        let [a, b] = mesh.ends(*h);
        let t = (point - a).dot(b - a) / (b - a).length_squared();
        // A zero-length edge gives NaN; its start serves.
        let place = if t.is_nan() { a } else { a + t.clamp(0.0, 1.0) * (b - a) };
        (place, place.distance(point))
    };
    let on_curve = |(i, c): (usize, &[HalfedgeId])| {
        c.iter().map(on_edge).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, distance)| (i, place, distance))
    };
    curves.enumerate().filter_map(on_curve).min_by(|a, b| a.2.total_cmp(&b.2))
}

/// A point within a feature curve, half-way along it: what names this curve and no other that it meets.
pub fn point_within<M: Faces + Positions>(mesh: &M, curve: &FeatureCurve) -> DVec3 {
    // A feature curve has an edge at least.
    point_along(mesh, &curve.halfedges).unwrap_or_default()
}

/// The point half-way along a chain of halfedges.
pub fn point_along<M: Faces + Positions>(mesh: &M, chain: &[HalfedgeId]) -> Option<DVec3> {
    let mut left = 0.5 * chain.iter().map(|&h| mesh.edge_length(h)).sum::<f64>();
    for &h in chain {
        let ([a, b], length) = (mesh.ends(h), mesh.edge_length(h));
        if left < length {
            return Some(a.lerp(b, left / length));
        }
        left -= length;
    }
    chain.last().map(|&h| mesh.position(mesh.head(h)))
}

/// The edges that are features, both halfedges marked, and how many there are at each vertex.
struct Edges {
    /// Both halfedges of every feature, in order.
    sharp: Vec<HalfedgeId>,
    /// Signed dihedral angle in degrees, positive where convex; 0 where the edge is no feature.
    turn: Vec<f64>,
    degree: Vec<u32>,
}

impl Edges {
    fn sharp<M: Adjacency + Positions + Sync>(mesh: &M, angle: f64) -> Self {
        let cosine = angle.to_radians().cos().max(0.0);
        let turn = |low: HalfedgeId| {
            let twin = mesh.twin(low).filter(|&twin| low < twin && !is_flatter(mesh, [low, twin], cosine))?;
            let turn = dihedral_angle(mesh, low)?.to_degrees();
            (turn.abs() >= angle).then_some([(low, turn), (twin, turn)])
        };
        let all = (0..3 * mesh.face_count()).into_par_iter().map(HalfedgeId::from);
        let mut found: Vec<_> = all.filter_map(turn).flatten_iter().collect();
        found.sort_unstable_by_key(|f| f.0);
        let mut edges = Self {
            sharp: found.iter().map(|f| f.0).collect(),
            turn: vec![0.0; 3 * mesh.face_count()],
            degree: vec![0; mesh.vertex_count()],
        };
        for (h, turn) in found {
            edges.turn[h.index()] = turn;
            edges.degree[mesh.tail(h).index()] += 1;
        }
        edges
    }

    fn remove<M: Adjacency>(&mut self, mesh: &M, h: HalfedgeId) {
        for side in [Some(h), mesh.twin(h)].into_iter().flatten() {
            self.turn[side.index()] = 0.0;
            self.degree[mesh.tail(side).index()] -= 1;
        }
    }

    /// The only feature halfedge that carries on where `h` arrives, unless a curve ends there.
    fn next<M: Adjacency>(&self, mesh: &M, h: HalfedgeId) -> Option<HalfedgeId> {
        let v = mesh.head(h);
        let turn = self.turn[h.index()];
        let back = mesh.twin(h);
        // A feature edge has two faces, so one of them leaves `v`; the ring sees all.
        let next = mesh.ring(v).find(|&o| Some(o) != back && self.turn[o.index()] != 0.0);
        next.filter(|n| self.degree[v.index()] == 2 && (self.turn[n.index()] > 0.0) == (turn > 0.0))
    }

    /// Every maximal chain once. Open ones start at the end from which their lowest halfedge is first met.
    fn chains<M: Adjacency>(&self, mesh: &M) -> Vec<Vec<HalfedgeId>> {
        let mut used = vec![false; self.turn.len()];
        let mut chains = vec![];
        for &start in &self.sharp {
            if self.turn[start.index()] == 0.0 || used[start.index()] {
                continue;
            }
            let first = self.rewind(mesh, start);
            let mut chain = vec![];
            let mut here = Some(first);
            while let Some(h) = here {
                used[h.index()] = true;
                if let Some(t) = mesh.twin(h) {
                    used[t.index()] = true;
                }
                chain.push(h);
                here = self.next(mesh, h).filter(|&n| n != first);
            }
            chains.push(chain);
        }
        chains
    }

    /// The first halfedge of the chain through `start`; `start` itself where the chain is closed.
    fn rewind<M: Adjacency>(&self, mesh: &M, start: HalfedgeId) -> HalfedgeId {
        let Some(mut back) = mesh.twin(start) else { return start };
        let stop = back;
        while let Some(n) = self.next(mesh, back) {
            if n == stop {
                return start;
            }
            back = n;
        }
        mesh.twin(back).unwrap_or(start)
    }

    fn is_spur<M: Adjacency>(&self, mesh: &M, chain: &[HalfedgeId], longest: usize) -> bool {
        let [Some(&first), Some(&last)] = [chain.first(), chain.last()] else { return false };
        let ends = [mesh.tail(first), mesh.head(last)];
        // A curve that leaves through an opening was cut off there; it does not peter out.
        let frayed =
            |&v: &VertexId| self.degree[v.index()] == 1 && mesh.outgoing(v).is_some_and(|h| mesh.twin(h).is_some());
        chain.len() <= longest && ends.iter().any(frayed) && ends.iter().any(|v| self.degree[v.index()] > 2)
    }

    fn curve<M: Adjacency + Positions>(&self, mesh: &M, halfedges: Vec<HalfedgeId>) -> FeatureCurve {
        let length = |h: &HalfedgeId| mesh.edge_length(*h);
        let turns = || halfedges.iter().map(|h| self.turn[h.index()]);
        FeatureCurve {
            closed: halfedges.len() > 2
                && halfedges.last().and_then(|&l| self.next(mesh, l)) == halfedges.first().copied(),
            convexity: if turns().all(|t| t > 0.0) { Convexity::Convex } else { Convexity::Concave },
            length: halfedges.iter().map(length).sum(),
            angles: [turns().map(f64::abs).fold(f64::INFINITY, f64::min), turns().map(f64::abs).fold(0.0, f64::max)],
            halfedges,
        }
    }
}

/// Whether the turn between two faces surely has a cosine above `cosine`, at the price of two cross products: nearly all
/// edges of a scan do. Where rounding could decide, no.
fn is_flatter<M: Faces + Positions>(mesh: &M, sides: [HalfedgeId; 2], cosine: f64) -> bool {
    let [m, n] = sides.map(|h| {
        let [a, b, c] = mesh.triangle(h.face());
        (b - a).cross(c - a)
    });
    let (product, squares) = (m.dot(n), m.length_squared() * n.length_squared());
    let least = cosine + 1e-6;
    product > 0.0 && squares.is_normal() && product * product > least * least * squares
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::{Connected, TriMesh, shapes};

    fn curves(mesh: &TriMesh, params: &Params) -> Vec<FeatureCurve> {
        feature_curves(&Connected::new(mesh).unwrap(), params)
    }

    #[test]
    fn a_box_has_twelve_convex_edges() {
        let found = curves(&shapes::cuboid(DVec3::new(1.0, 2.0, 3.0)), &Params::default());
        assert_eq!(found.len(), 12);
        assert!(found.iter().all(|c| c.convexity == Convexity::Convex && !c.closed && c.halfedges.len() == 1));
        assert!((found.iter().map(|c| c.length).sum::<f64>() - 24.0).abs() < 1e-12);
        assert!(found.iter().all(|c| (c.angles[0] - 90.0).abs() < 1e-9));
    }

    #[test]
    fn the_rims_of_a_tube_are_four_closed_convex_circles() {
        let found = curves(&shapes::tube(1.0, 2.0, 1.0, 32, 2), &Params::default());
        assert_eq!(found.len(), 4);
        assert!(found.iter().all(|c| c.closed && c.halfedges.len() == 32 && c.convexity == Convexity::Convex));
    }

    #[test]
    fn an_inside_out_box_is_concave() {
        let mut mesh = shapes::cuboid(DVec3::ONE);
        mesh.faces.iter_mut().for_each(|f| f.swap(0, 1));
        assert!(curves(&mesh, &Params::default()).iter().all(|c| c.convexity == Convexity::Concave));
    }

    #[test]
    fn chains_are_connected_and_cover_every_sharp_edge_once() {
        let mesh = Connected::new(shapes::cylinder(1.0, 2.0, 12, 3)).unwrap();
        let found = feature_curves(&mesh, &Params { angle: 20.0, spur: 0 });
        let mut seen = std::collections::HashSet::new();
        for curve in &found {
            assert!(curve.halfedges.windows(2).all(|w| mesh.head(w[0]) == mesh.tail(w[1])));
            assert!(curve.halfedges.iter().all(|&h| seen.insert(mesh.edge(h))));
            let vertices = curve.vertices(&mesh);
            assert_eq!(vertices.len(), curve.halfedges.len() + usize::from(!curve.closed));
        }
        let sharp = mesh.halfedge_ids().filter(|&h| {
            mesh.edge(h).0 == h.0 && dihedral_angle(&mesh, h).is_some_and(|a| a.abs() >= 20f64.to_radians())
        });
        assert_eq!(seen.len(), sharp.count());
    }

    #[test]
    fn the_nearest_curve_is_the_one_through_the_point() {
        let mesh = Connected::new(shapes::cuboid(DVec3::splat(2.0))).unwrap();
        let found = feature_curves(&mesh, &Params::default());
        for (i, curve) in found.iter().enumerate() {
            let [a, b] = mesh.ends(curve.halfedges[0]);
            assert_eq!(nearest_curve(&mesh, &found, 1.1 * 0.5 * (a + b)).map(|n| n.0), Some(i));
        }
        assert_eq!(nearest_curve(&mesh, &[], DVec3::ZERO), None);
    }

    #[test]
    fn edges_that_end_at_an_opening_are_no_spurs() {
        let mut mesh = shapes::cuboid(DVec3::ONE);
        let height = |v: &VertexId| mesh.positions[v.index()].z;
        let open = mesh.faces.iter().copied().filter(|f| f.iter().any(|v| height(v) < 0.0)).collect();
        mesh.faces = open;
        assert_eq!(mesh.faces.len(), 10);
        assert_eq!(curves(&mesh, &Params::default()).len(), 8);
    }
}
