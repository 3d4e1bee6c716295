//! Intelligent scissoring: a closed path over the surface through a few picks, along concave creases where there are any (\[LeeLee2002\],
//! \[Funkhouser2004\]).
//!
//! Dijkstra's algorithm runs over three places on every edge, which gives the strip of triangles; then the places slide along their edges to
//! the least cost within it. Legs do not share triangles, so the path cannot meet itself.

use super::Error;
use super::crease::weights;
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, EdgeId, FaceId, Faces, FloodParams, HalfedgeId, Positions, Seed, Source, SurfacePoint,
    TriMesh, Watch, area_vector, flood,
};
use mesh_query::TriBvh;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use tri_intersect::embed::SurfaceCurve;

/// Places on every edge that a path may take at first.
const PLACES: [f64; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];
/// How near a vertex a path may come, as a share of the edge.
const MARGIN: f64 = 0.02;
/// How deep in a triangle a pick is, as a barycentric coordinate.
const DEPTH: f64 = 0.05;
/// A loop with a smaller share of a disc's area for its length runs back beside itself.
const OPEN: f64 = 0.9;
/// How much dearer the way beside earlier legs is made then.
const AVERSION: f64 = 8.0;
/// Most rounds of sliding.
const ROUNDS: usize = 60;

/// A closed path.
pub(super) struct Scissored {
    pub curve: SurfaceCurve,
    /// Its cost, in model units, and that of the geodesic through the same picks.
    pub cost: [f64; 2],
}

/// A point of a path: a pick within a face, or a crossing of an edge.
#[derive(Clone, Copy)]
enum Stop {
    Pick(FaceId, [f64; 3]),
    Crossing(HalfedgeId, f64),
}

/// The cheapest closed path through `picks`, in their order. O(k n log n) for k picks.
pub(super) fn closed_path(
    mesh: &Connected<TriMesh>,
    picks: &[DVec3],
    strength: f64,
    watch: &Watch,
) -> Result<Scissored, Error> {
    let stops = on_surface(mesh, picks)?;
    let creased = weights(mesh, strength);
    let plain = vec![1.0; creased.len()];
    let mut found = vec![];
    for weights in [&creased, &plain] {
        let scissors = Scissors { mesh, weights, stops: &stops, picks };
        let (mut path, open) = scissors.around(watch)?;
        scissors.slide(&mut path);
        found.push((path, open >= OPEN));
    }
    let judge = Scissors { mesh, weights: &creased, stops: &stops, picks };
    let geodesic = judge.cost(&found[1].0);
    // The search is greedy from leg to leg; a geodesic may pass better between the legs before it, and may slide on.
    judge.slide(&mut found[1].0);
    let costs = [judge.cost(&found[0].0), judge.cost(&found[1].0)];
    let best = match [found[0].1, found[1].1] {
        [true, false] => 0,
        [false, true] => 1,
        _ => usize::from(costs[1] < costs[0]),
    };
    let points = found[best].0.iter().map(Stop::address).collect();
    Ok(Scissored { curve: SurfaceCurve { points, closed: true }, cost: [costs[best], geodesic] })
}

impl Stop {
    fn address(&self) -> SurfacePoint {
        match *self {
            Self::Pick(face, barycentric) => SurfacePoint::Face { face, barycentric },
            Self::Crossing(halfedge, t) => SurfacePoint::Edge { halfedge, t },
        }
    }
}

/// The picks on the surface, each well within a face of its own.
fn on_surface(mesh: &Connected<TriMesh>, picks: &[DVec3]) -> Result<Vec<Stop>, Error> {
    let trouble = |at: DVec3, reason: &'static str| Error::Pick { at, reason };
    if picks.len() < 2 {
        let at = picks.first().copied().unwrap_or_default();
        return Err(trouble(at, "a path needs two picks or more, better three round the limb"));
    }
    let tree = TriBvh::build(mesh.mesh()).map_err(|_| trouble(picks[0], "the mesh has no surface to cut"))?;
    let mut stops: Vec<Stop> = vec![];
    let mut taken = vec![];
    for &at in picks {
        let hit = tree.closest_point(mesh, at).ok_or_else(|| trouble(at, "a pick needs finite numbers"))?;
        if taken.contains(&hit.face) {
            return Err(trouble(at, "two picks are in one triangle; set them apart"));
        }
        taken.push(hit.face);
        let deep = hit.barycentric.map(|b| b.max(DEPTH));
        stops.push(Stop::Pick(hit.face, deep.map(|b| b / deep.iter().sum::<f64>())));
    }
    Ok(stops)
}

struct Scissors<'a> {
    mesh: &'a Connected<TriMesh>,
    /// Cost of a unit of length, by vertex.
    weights: &'a [f64],
    stops: &'a [Stop],
    picks: &'a [DVec3],
}

impl Scissors<'_> {
    /// The place of a stop and the weight there.
    fn place(&self, stop: Stop) -> (DVec3, f64) {
        match stop {
            Stop::Pick(face, b) => {
                let c = self.mesh.corners(face);
                let sum = |f: &dyn Fn(usize) -> f64| (0..3).map(|k| b[k] * f(k)).sum::<f64>();
                let at = (0..3).map(|k| b[k] * self.mesh.position(c[k])).sum();
                (at, sum(&|k| self.weights[c[k].index()]))
            }
            Stop::Crossing(h, t) => {
                let (a, b) = (self.mesh.tail(h), self.mesh.head(h));
                let (wa, wb) = (self.weights[a.index()], self.weights[b.index()]);
                (self.mesh.position(a).lerp(self.mesh.position(b), t), wa + t * (wb - wa))
            }
        }
    }

    /// What a closed path costs.
    fn cost(&self, path: &[Stop]) -> f64 {
        let step = |i: usize| step(self.place(path[i]), self.place(path[(i + 1) % path.len()]));
        (0..path.len()).map(step).sum()
    }

    /// All legs in turn; where they enclose next to nothing, once more with the neighbourhood of earlier legs made dearer. Also how open the
    /// path is.
    fn around(&self, watch: &Watch) -> Result<(Vec<Stop>, f64), Error> {
        let tried = (self.stops.len() > 2).then(|| self.legs(0.0, watch)).transpose()?;
        let tried = tried.map(|path| (self.openness(&path), path));
        match tried {
            Some((open, path)) if open >= OPEN => Ok((path, open)),
            Some((open, path)) => match self.legs(AVERSION, watch) {
                Ok(other) if self.openness(&other) > open => Ok((other.clone(), self.openness(&other))),
                Err(e @ Error::Cancelled(_)) => Err(e),
                _ => Ok((path, open)),
            },
            None => self.legs(AVERSION, watch).map(|path| (path.clone(), self.openness(&path))),
        }
    }

    /// All legs in turn, earlier ones being shunned.
    fn legs(&self, aversion: f64, watch: &Watch) -> Result<Vec<Stop>, Error> {
        let mut blocked = vec![false; self.mesh.face_count()];
        for &s in self.stops {
            mark(&mut blocked, self.mesh, s);
        }
        let mut path = vec![];
        let mut dearer = vec![1.0; self.weights.len()];
        for leg in 0..self.stops.len() {
            watch.step("scissor", leg as f64 / self.stops.len() as f64)?;
            path.push(self.stops[leg]);
            if leg > 0 && aversion > 0.0 {
                self.shun(&path, leg, aversion, &mut dearer);
            }
            let price = |h: HalfedgeId| 0.5 * (dearer[self.mesh.tail(h).index()] + dearer[self.mesh.head(h).index()]);
            let crossings = self.leg(leg, &blocked, &price)?;
            for &c in &crossings {
                mark(&mut blocked, self.mesh, c);
            }
            path.extend(crossings);
        }
        Ok(path)
    }

    /// Makes the neighbourhood of a path of so many legs dearer, out to half the length of a leg.
    fn shun(&self, path: &[Stop], legs: usize, aversion: f64, dearer: &mut [f64]) {
        let places: Vec<DVec3> = path.iter().map(|&s| self.place(s).0).collect();
        let length: f64 = places.windows(2).map(|w| w[0].distance(w[1])).sum();
        let reach = 0.5 * length / legs as f64;
        let seed = |stop: &Stop| Seed { source: Source::At(stop.address()), distance: 0.0 };
        let seeds: Vec<Seed> = path.iter().map(seed).collect();
        let near = flood(self.mesh, &seeds, &FloodParams { max_distance: reach, ..FloodParams::default() });
        dearer.fill(1.0);
        for (v, distance) in near.vertices() {
            dearer[v.index()] += aversion * (1.0 - distance / reach).max(0.0);
        }
    }

    /// 4π·area / length² of the smaller side of a closed path: at least about 1 round a limb, hardly anything where the path runs back beside
    /// itself. Infinite where the path parts nothing, as round a handle.
    fn openness(&self, path: &[Stop]) -> f64 {
        if !self.parts(path) {
            return f64::INFINITY;
        }
        let mut seen = vec![false; self.mesh.face_count()];
        for &stop in path {
            mark(&mut seen, self.mesh, stop);
        }
        let area = |f: FaceId| area_vector(self.mesh.triangle(f)).length();
        let border: Vec<FaceId> = self.mesh.face_ids().filter(|f| seen[f.index()]).collect();
        let (mut all, mut largest) = (border.iter().map(|&f| area(f)).sum::<f64>(), 0.0f64);
        let mut stack = vec![];
        for h in border.iter().flat_map(|f| f.halfedges()) {
            let mut side = 0.0;
            stack.extend(self.mesh.twin(h).map(HalfedgeId::face));
            while let Some(f) = stack.pop() {
                if std::mem::replace(&mut seen[f.index()], true) {
                    continue;
                }
                side += area(f);
                stack.extend(self.mesh.neighbours(f));
            }
            all += side;
            largest = largest.max(side);
        }
        let places: Vec<DVec3> = path.iter().map(|&s| self.place(s).0).collect();
        let length: f64 = (0..places.len()).map(|i| places[i].distance(places[(i + 1) % places.len()])).sum();
        4.0 * std::f64::consts::PI * (all - largest) / (length * length)
    }

    /// Whether no way along edges leads from the left of a closed path to its right without crossing it.
    fn parts(&self, path: &[Stop]) -> bool {
        let mut crossed: Vec<EdgeId> = vec![];
        let (mut left, mut right) = (vec![], vec![false; self.mesh.vertex_count()]);
        for (i, stop) in path.iter().enumerate() {
            let Stop::Crossing(h, _) = *stop else { continue };
            crossed.push(self.mesh.edge(h));
            // The path goes on into the face of `h` if what comes next is there; then the tail of `h` is on its left.
            let onward = match path[(i + 1) % path.len()] {
                Stop::Pick(face, _) => face == h.face(),
                Stop::Crossing(g, _) => {
                    [Some(g), self.mesh.twin(g)].into_iter().flatten().any(|g| g.face() == h.face())
                }
            };
            let ends = [self.mesh.tail(h), self.mesh.head(h)];
            let [l, r] = if onward { [ends[0], ends[1]] } else { [ends[1], ends[0]] };
            left.push(l);
            right[r.index()] = true;
        }
        crossed.sort_unstable();
        let mut seen = vec![false; self.mesh.vertex_count()];
        while let Some(v) = left.pop() {
            if std::mem::replace(&mut seen[v.index()], true) {
                continue;
            }
            if right[v.index()] {
                return false;
            }
            for h in self.mesh.ring(v) {
                for (h, w) in [(h, self.mesh.head(h)), (h.prev(), self.mesh.tail(h.prev()))] {
                    if crossed.binary_search(&self.mesh.edge(h)).is_err() {
                        left.push(w);
                    }
                }
            }
        }
        true
    }

    /// The crossings of the cheapest way from one stop to the next, through faces that are not blocked.
    fn leg(&self, leg: usize, blocked: &[bool], aversion: &dyn Fn(HalfedgeId) -> f64) -> Result<Vec<Stop>, Error> {
        let next = (leg + 1) % self.stops.len();
        let (Stop::Pick(start, _), Stop::Pick(goal, _)) = (self.stops[leg], self.stops[next]) else {
            return Ok(vec![]);
        };
        let count = PLACES.len();
        let node = |h: HalfedgeId, k: usize| (self.mesh.edge(h).0 as usize * count + k) as u32;
        let stop = |n: u32| Stop::Crossing(HalfedgeId(n / count as u32), PLACES[n as usize % count]);
        let edge = |n: u32| HalfedgeId(n / count as u32);
        let mut best = vec![f64::INFINITY; 3 * self.mesh.face_count() * count];
        let mut before = vec![u32::MAX; best.len()];
        let mut front = BinaryHeap::new();
        let (from, to) = (self.place(self.stops[leg]), self.place(self.stops[next]));
        let (mut arrival, mut least) = (u32::MAX, f64::INFINITY);
        for h in start.halfedges() {
            for n in (0..count).map(|k| node(h, k)) {
                let price = step(from, self.place(stop(n))) * aversion(h);
                best[n as usize] = price;
                front.push(Reverse((price.to_bits(), n)));
            }
        }
        while let Some(Reverse((bits, n))) = front.pop() {
            let here = f64::from_bits(bits);
            if here >= least {
                break;
            }
            if here > best[n as usize] {
                continue;
            }
            let at = self.place(stop(n));
            for h in [Some(edge(n)), self.mesh.twin(edge(n))].into_iter().flatten() {
                if h.face() == goal {
                    let total = here + step(at, to) * aversion(h);
                    if total < least {
                        (least, arrival) = (total, n);
                    }
                } else if !blocked[h.face().index()] {
                    for other in [h.next(), h.prev()] {
                        for m in (0..count).map(|k| node(other, k)) {
                            let total = here + step(at, self.place(stop(m))) * aversion(other);
                            if total < best[m as usize] {
                                best[m as usize] = total;
                                before[m as usize] = n;
                                front.push(Reverse((total.to_bits(), m)));
                            }
                        }
                    }
                }
            }
        }
        if arrival == u32::MAX {
            return Err(Error::NoPath { from: self.picks[leg], to: self.picks[next] });
        }
        let mut crossings = vec![];
        while arrival != u32::MAX {
            crossings.push(stop(arrival));
            arrival = before[arrival as usize];
        }
        crossings.reverse();
        Ok(crossings)
    }

    /// Slides crossings along their edges until the cost no longer falls.
    fn slide(&self, path: &mut [Stop]) {
        let n = path.len();
        let mut cost = self.cost(path);
        for _ in 0..ROUNDS {
            for i in 0..n {
                let Stop::Crossing(h, old) = path[i] else { continue };
                let (a, b) = (self.place(path[(i + n - 1) % n]), self.place(path[(i + 1) % n]));
                let through = |t: f64| {
                    let at = self.place(Stop::Crossing(h, t));
                    step(a, at) + step(at, b)
                };
                let t = least(&through);
                if through(t) < through(old) {
                    path[i] = Stop::Crossing(h, t);
                }
            }
            let now = self.cost(path);
            if now > (1.0 - 1e-7) * cost {
                break;
            }
            cost = now;
        }
    }
}

/// The cost of a straight step within a face.
fn step((p, wp): (DVec3, f64), (q, wq): (DVec3, f64)) -> f64 {
    0.5 * (wp + wq) * p.distance(q)
}

/// Golden-section search within the margins.
fn least(f: &impl Fn(f64) -> f64) -> f64 {
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    let (mut low, mut high) = (MARGIN, 1.0 - MARGIN);
    for _ in 0..24 {
        let width = ratio * (high - low);
        if f(high - width) <= f(low + width) {
            high = low + width;
        } else {
            low = high - width;
        }
    }
    0.5 * (low + high)
}

/// Blocks the faces that a stop touches.
fn mark(blocked: &mut [bool], mesh: &Connected<TriMesh>, stop: Stop) {
    match stop {
        Stop::Pick(face, _) => blocked[face.index()] = true,
        Stop::Crossing(h, _) => {
            for h in [Some(h), mesh.twin(h)].into_iter().flatten() {
                blocked[h.face().index()] = true;
            }
        }
    }
}
