//! Geodesic distance, flooded from seeds over the surface without crossing barriers.
//!
//! A front of triangles unfolded into the plane (\[KimmelSethian1998\]), with the seed's unfolded place kept instead of
//! a plane wave where both corners hear the same seed (\[Novotni2002\]): exact on flat meshes from point seeds, within 0.5% of a
//! great circle at one radius on a ball of 1 280 triangles, error falling with the edge length. A late
//! better value re-opens a vertex, which is what obtuse triangles need in place of their special unfolding.

use crate::id_hash::IdTable;
use crate::ids::{EdgeId, FaceId, HalfedgeId, VertexId};
use crate::sectors::Sectors;
use crate::surface_point::SurfacePoint;
use crate::traits::{Adjacency, Positions};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Where a flood starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// A point of the mesh; at a vertex on a barrier, all its sides.
    At(SurfacePoint),
    /// The corner that a halfedge leaves: its vertex, but only the side of the barriers on which this corner lies.
    Side(HalfedgeId),
}

/// A start of the flood and the distance it counts from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seed {
    /// Where.
    pub source: Source,
    /// Distance already run, in model units; 0 for a plain source.
    pub distance: f64,
}

/// How far a flood goes.
#[derive(Clone, Debug)]
pub struct FloodParams {
    /// Farther vertices are not reached, in model units.
    pub max_distance: f64,
    /// Edges that the front may run along but not cross.
    pub barriers: Vec<EdgeId>,
}

impl Default for FloodParams {
    fn default() -> Self {
        Self { max_distance: f64::INFINITY, barriers: vec![] }
    }
}

/// Distances over the region that a flood reached.
pub struct Flood<'a, M> {
    mesh: &'a M,
    sectors: Sectors,
    nodes: IdTable<u32, Node>,
    /// Keys in order of first touch, so that nothing is read out in hash order.
    touched: Vec<u32>,
}

/// A vertex, or one side of it when it lies on a barrier.
#[derive(Clone, Copy)]
struct Node {
    distance: f64,
    seed: u32,
    parent: u32,
    done: bool,
}

/// Spreads from `seeds`. Time O(k log k) and memory O(k) in the reached vertices k, whatever the size of the mesh.
///
/// Seeds that are out of range or whose distance is NaN are passed over. Equal floods give equal bits.
///
/// ```
/// use mesh_core::{Connected, FloodParams, Seed, Source, SurfacePoint, VertexId, flood, shapes};
/// let ball = Connected::new(shapes::icosphere(1.0, 4))?;
/// let seed = Seed { source: Source::At(SurfacePoint::Vertex(VertexId(0))), distance: 0.0 };
/// let near = flood(&ball, &[seed], &FloodParams { max_distance: 0.5, ..FloodParams::default() });
/// let (v, distance) = near.vertices().pop().unwrap();
/// assert!(distance <= 0.5 && near.vertex(v) == Some(distance));
/// # Ok::<(), mesh_core::NotManifold>(())
/// ```
pub fn flood<'a, M: Adjacency + Positions>(mesh: &'a M, seeds: &[Seed], params: &FloodParams) -> Flood<'a, M> {
    let sectors = Sectors::new(mesh, &params.barriers);
    let mut field = Flood { mesh, sectors, nodes: IdTable::default(), touched: vec![] };
    let mut front = BinaryHeap::new();
    for (i, seed) in (0..).zip(seeds) {
        for (h, distance) in starts(mesh, &field.sectors, seed) {
            let key = field.sectors.key(mesh, h);
            let node = Node { distance, seed: i, parent: key, done: false };
            field.offer(key, node, params.max_distance, &mut front);
        }
    }
    while let Some(Entry { distance, key }) = front.pop() {
        let Some(node) = field.nodes.get_mut(&key).filter(|n| n.distance == distance) else { continue };
        node.done = true;
        let node = *node;
        let mut h = HalfedgeId(key);
        loop {
            let [ka, kb] = [h.next(), h.prev()].map(|c| field.sectors.key(mesh, c));
            for (to, via) in [(h.next(), (kb, h.prev())), (h.prev(), (ka, h.next()))] {
                let found = field.across(h, key, node, to, via, seeds);
                let target = field.sectors.key(mesh, to);
                field.offer(target, found, params.max_distance, &mut front);
            }
            match field.sectors.turn(mesh, h) {
                Some(after) if after.0 != key => h = after,
                _ => break,
            }
        }
    }
    field
}

/// The corners a seed gives a distance to.
fn starts<M: Adjacency + Positions>(mesh: &M, sectors: &Sectors, seed: &Seed) -> Vec<(HalfedgeId, f64)> {
    let halfedges = 3 * mesh.face_count();
    let face_corners = |f: FaceId, p: SurfacePoint| {
        let at = p.position(mesh);
        let corners = (0..3).map(move |k| HalfedgeId::new(f, k));
        corners.map(move |h| (h, seed.distance + mesh.position(mesh.tail(h)).distance(at)))
    };
    match seed.source {
        _ if seed.distance.is_nan() => vec![],
        Source::Side(h) if h.index() < halfedges => vec![(h, seed.distance)],
        Source::At(SurfacePoint::Vertex(v)) if v.index() < mesh.vertex_count() => {
            let ring: Vec<_> = mesh.ring(v).collect();
            let first = ring.iter().filter(|&&h| sectors.key(mesh, h) == h.0);
            first.map(|&h| (h, seed.distance)).collect()
        }
        Source::At(p @ SurfacePoint::Edge { halfedge, .. }) if halfedge.index() < halfedges => {
            let sides = [Some(halfedge), mesh.twin(halfedge)].into_iter().flatten();
            sides.flat_map(|h| face_corners(h.face(), p)).collect()
        }
        Source::At(p @ SurfacePoint::Face { face, .. }) if face.index() < mesh.face_count() => {
            face_corners(face, p).collect()
        }
        _ => vec![],
    }
}

impl<M: Adjacency + Positions> Flood<'_, M> {
    /// Takes a distance if it is better than what is known by more than rounding.
    fn offer(&mut self, key: u32, new: Node, max: f64, front: &mut BinaryHeap<Entry>) {
        if new.distance.is_nan() || new.distance > max {
            return;
        }
        match self.nodes.get_mut(&key) {
            Some(old) if new.distance < old.distance - 1e-12 * old.distance.abs() => *old = new,
            Some(_) => return,
            None => {
                self.nodes.insert(key, new);
                self.touched.push(key);
            }
        }
        front.push(Entry { distance: new.distance, key });
    }

    /// The best way to the corner `to` of the face of `h`: along its edge from `h`'s vertex, or through the edge to the
    /// third corner `via`.
    fn across(
        &self,
        h: HalfedgeId,
        key: u32,
        node: Node,
        to: HalfedgeId,
        via: (u32, HalfedgeId),
        seeds: &[Seed],
    ) -> Node {
        let [a, b, c] = [h, via.1, to].map(|h| self.mesh.position(self.mesh.tail(h)));
        let along = Node { distance: node.distance + a.distance(c), parent: key, done: false, ..node };
        let Some(other) = self.nodes.get(&via.0).filter(|n| n.done) else { return along };
        // The edge a–b on the x axis, c above it.
        let length = a.distance(b);
        let x = (c - a).dot(b - a) / length;
        let y = (b - a).cross(c - a).length() / length;
        let (distance, foot) = if node.seed == other.seed {
            let start = seeds[node.seed as usize].distance;
            from_point(length, [x, y], [node.distance - start, other.distance - start])
                .map_or((f64::NAN, 0.0), |(d, t)| (start + d, t))
        } else {
            from_line(length, [x, y], [node.distance, other.distance]).unwrap_or((f64::NAN, 0.0))
        };
        if distance < along.distance {
            let (parent, seed) = if foot < 0.5 * length { (key, node.seed) } else { (via.0, other.seed) };
            Node { distance, seed, parent, done: false }
        } else {
            along
        }
    }

    /// The distance of a vertex, the least of its sides; `None` where the flood did not come.
    pub fn vertex(&self, v: VertexId) -> Option<f64> {
        self.mesh.ring(v).filter_map(|h| self.corner(h)).reduce(f64::min)
    }

    /// The distance at the corner that `h` leaves, on its own side of the barriers.
    pub fn corner(&self, h: HalfedgeId) -> Option<f64> {
        self.nodes.get(&self.sectors.key(self.mesh, h)).map(|n| n.distance)
    }

    /// Every reached vertex with its distance, nearest first, ties by id. A vertex on a barrier comes once.
    pub fn vertices(&self) -> Vec<(VertexId, f64)> {
        let node = |&key: &u32| (self.mesh.tail(HalfedgeId(key)), self.nodes[&key].distance);
        let mut all: Vec<_> = self.touched.iter().map(node).collect();
        all.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        all.dedup_by_key(|a| a.0);
        all.sort_unstable_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        all
    }

    /// Every face with a reached corner, ascending: the patch of a side, out to the first face beyond the distance.
    pub fn faces(&self) -> Vec<FaceId> {
        let mut faces = vec![];
        for &key in &self.touched {
            let mut h = HalfedgeId(key);
            loop {
                faces.push(h.face());
                match self.sectors.turn(self.mesh, h) {
                    Some(after) if after.0 != key => h = after,
                    _ => break,
                }
            }
        }
        faces.sort_unstable();
        faces.dedup();
        faces
    }

    /// The way back from the corner that `h` leaves to its seed along edges, both ends included; empty where the flood
    /// did not come. Follows the front, so it is close to straight, but not the shortest path along edges.
    pub fn path(&self, h: HalfedgeId) -> Vec<VertexId> {
        let mut path = vec![];
        let mut key = self.sectors.key(self.mesh, h);
        while let Some(node) = self.nodes.get(&key) {
            path.push(self.mesh.tail(HalfedgeId(key)));
            // A parent may have improved since: never more steps than vertices.
            if node.parent == key || path.len() > self.touched.len() {
                break;
            }
            key = node.parent;
        }
        path
    }
}

/// Distance at `c` from a point seed heard at distances `d` at (0, 0) and (length, 0), and where the ray crosses the
/// edge; `None` when it misses the edge.
fn from_point(length: f64, [x, y]: [f64; 2], [da, db]: [f64; 2]) -> Option<(f64, f64)> {
    let sx = 0.5 * (length + (da - db) * ((da + db) / length));
    let below = (da - sx) * (da + sx);
    // Both distances are rounded and, on curved meshes, approximate: a seed on the line may come out beyond it.
    let sy = below.max(0.0).sqrt();
    let foot = sx + (x - sx) * (sy / (sy + y));
    (below >= -1e-9 * da * da && (0.0..=length).contains(&foot)).then(|| ((x - sx).hypot(y + sy), foot))
}

/// Distance at `c` from a straight front that passed the edge's ends at distances `d`; `None` when its ray misses.
fn from_line(length: f64, [x, y]: [f64; 2], [da, db]: [f64; 2]) -> Option<(f64, f64)> {
    let cos = (db - da) / length;
    let sin = (1.0 - cos * cos).sqrt();
    let foot = x - cos / sin * y;
    (sin > 0.0 && (0.0..=length).contains(&foot)).then_some((da + cos * x + sin * y, foot))
}

/// An entry of the front; the heap's greatest is the nearest, ties by key.
struct Entry {
    distance: f64,
    key: u32,
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        other.distance.total_cmp(&self.distance).then(other.key.cmp(&self.key))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Entry {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Connected, Faces, TriMesh, shapes};
    use glam::DVec3;
    use std::f64::consts::PI;

    /// A unit square of n × n cells with its inner vertices shaken, so that obtuse triangles abound.
    fn shaken(n: u32, amount: f64) -> Connected<TriMesh> {
        let mut mesh = shapes::grid(1.0, 1.0, n, n);
        let mut rng = fastrand::Rng::with_seed(1);
        let mut noise = || rng.f64() - 0.5;
        for p in &mut mesh.positions {
            if p.x.abs() < 0.499 && p.y.abs() < 0.499 {
                *p += amount / f64::from(n) * DVec3::new(noise(), noise(), 0.0);
            }
        }
        Connected::new(mesh).unwrap()
    }

    fn from(v: VertexId) -> Seed {
        Seed { source: Source::At(SurfacePoint::Vertex(v)), distance: 0.0 }
    }

    #[test]
    fn a_point_on_a_plane_is_exact_even_through_obtuse_triangles() {
        let plane = shaken(30, 0.45);
        let face = SurfacePoint::Face { face: FaceId(777), barycentric: [0.2, 0.3, 0.5] };
        let edge = SurfacePoint::Edge { halfedge: HalfedgeId(901), t: 0.3 };
        for point in [SurfacePoint::Vertex(VertexId(400)), face, edge] {
            let all = flood(&plane, &[Seed { source: Source::At(point), distance: 2.0 }], &FloodParams::default());
            let at = point.position(&plane);
            for v in plane.vertex_ids() {
                let error = all.vertex(v).unwrap() - 2.0 - plane.position(v).distance(at);
                assert!(error.abs() < 1e-9, "{point:?} {v}: {error}");
            }
        }
    }

    #[test]
    fn a_straight_front_is_nearly_exact() {
        let plane = shaken(40, 0.45);
        let low = plane.vertex_ids().filter(|&v| plane.position(v).y < -0.4999);
        let all = flood(&plane, &low.map(from).collect::<Vec<_>>(), &FloodParams::default());
        let error = |v| all.vertex(v).unwrap() - (plane.position(v).y + 0.5);
        let worst = plane.vertex_ids().map(|v| error(v).abs()).fold(0.0, f64::max);
        assert!(worst < 0.2 / 40.0, "{worst}");
    }

    #[test]
    fn distances_on_a_ball_converge_to_great_circles() {
        let worst = |levels| {
            let ball = Connected::new(shapes::icosphere(1.0, levels)).unwrap();
            let all = flood(&ball, &[from(VertexId(0))], &FloodParams::default());
            let truth = |v| ball.position(v).angle_between(ball.position(VertexId(0)));
            let error = |v| (all.vertex(v).unwrap() - truth(v)).abs();
            let worst = |far| ball.vertex_ids().filter(|&v| truth(v) < far).map(error).fold(0.0, f64::max);
            [worst(1.0), worst(PI)]
        };
        let errors = [3, 4, 5].map(worst);
        assert!(errors[0][0] < 0.005 && errors[0][1] < 0.08, "{errors:?}");
        // At the far pole the fronts of all sides meet, and errors add up.
        for (k, least) in [(0, 1.8), (1, 1.5)] {
            assert!(errors[0][k] / errors[1][k] > least && errors[1][k] / errors[2][k] > least, "{errors:?}");
        }
    }

    #[test]
    fn a_barrier_is_walked_around() {
        // A wall along x = 0 from the lower border up to y = 0.25: around its tip is the only way.
        let plane = Connected::new(shapes::grid(1.0, 1.0, 40, 40)).unwrap();
        let on_wall = |v: VertexId| plane.position(v).x.abs() < 1e-9 && plane.position(v).y < 0.25 + 1e-9;
        let wall = plane.halfedge_ids();
        let wall = wall.filter(|&h| on_wall(plane.tail(h)) && on_wall(plane.head(h)) && plane.edge(h).0 == h.0);
        let params = FloodParams { barriers: wall.map(|h| plane.edge(h)).collect(), ..FloodParams::default() };
        assert_eq!(params.barriers.len(), 30);
        let at = |p: DVec3| plane.vertex_ids().find(|&v| plane.position(v).distance(p) < 1e-9).unwrap();
        let (left, right) = (at(DVec3::new(-0.25, -0.25, 0.0)), at(DVec3::new(0.25, -0.25, 0.0)));
        let all = flood(&plane, &[from(left)], &params);
        let around = 2.0 * DVec3::new(0.25, 0.5, 0.0).length();
        let found = all.vertex(right).unwrap();
        assert!(found > around - 1e-9 && found < 1.02 * around, "{found} {around}");
        // The wall's two sides know their own distances, and a vertex the lesser.
        let mid = at(DVec3::new(0.0, -0.25, 0.0));
        let mut sides: Vec<f64> = plane.ring(mid).filter_map(|h| all.corner(h)).collect();
        sides.sort_unstable_by(f64::total_cmp);
        sides.dedup();
        assert!(sides.len() == 2 && (sides[0] - 0.25).abs() < 1e-9 && sides[1] > 1.0, "{sides:?}");
        assert_eq!(all.vertex(mid), Some(sides[0]));
        let path = all.path(plane.outgoing(right).unwrap());
        assert_eq!((path[0], path[path.len() - 1]), (right, left));
        let steps = path.windows(2).map(|w| plane.position(w[0]).distance(plane.position(w[1]))).sum::<f64>();
        assert!(steps < 1.5 * around, "{steps}");
    }

    #[test]
    fn one_side_of_a_curve_is_flooded_alone() {
        let tube = Connected::new(shapes::open_cylinder(1.0, 4.0, 64, 40)).unwrap();
        let waist = |v: VertexId| tube.position(v).z.abs() < 1e-9;
        let ring: Vec<_> = tube
            .halfedge_ids()
            .filter(|&h| waist(tube.tail(h)) && waist(tube.head(h)))
            .filter(|&h| tube.position(tube.tail(h.prev())).z > 0.0)
            .collect();
        assert_eq!(ring.len(), 64);
        let seeds: Vec<_> = ring.iter().map(|&h| Seed { source: Source::Side(h), distance: 0.0 }).collect();
        let barriers = ring.iter().map(|&h| tube.edge(h)).collect();
        let upper = flood(&tube, &seeds, &FloodParams { max_distance: 1.05, barriers });
        assert_eq!(upper.faces().len(), 64 * 2 * 11);
        for (v, d) in upper.vertices() {
            assert!((d - tube.position(v).z).abs() < 1e-9);
        }
    }

    #[test]
    fn the_front_stays_near_its_seed() {
        let ball = Connected::new(shapes::icosphere(1.0, 5)).unwrap();
        let params = FloodParams { max_distance: 0.1, ..FloodParams::default() };
        let near = flood(&ball, &[from(VertexId(9))], &params);
        assert!(near.touched.len() < 60 && near.vertices().len() == near.touched.len());
        let wild = [from(VertexId(1 << 30)), Seed { distance: f64::NAN, ..from(VertexId(0)) }];
        assert!(flood(&ball, &wild, &params).vertices().is_empty());
        let wild = Seed { source: Source::Side(HalfedgeId(u32::MAX)), distance: 0.0 };
        assert_eq!(flood(&ball, &[wild], &params).path(HalfedgeId(0)), []);
    }
}
