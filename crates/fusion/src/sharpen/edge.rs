//! The edge in which the two sides meet once they are prolonged, and the surface up to it.

use super::Refusal;
use super::rim::{Rim, Side};
use glam::DVec3;
use mesh_core::VertexId;

/// Least square of the sine between two sides that meet: one degree.
const PARALLEL: f64 = 3e-4;
/// Least sine between an edge and the surface it ends at.
const GRAZING: f64 = 0.2;
/// Least advance of the edge, as a share of what its sides advance.
const LEAST_ADVANCE: f64 = 0.25;
/// Places on a side nearer than this, in its edges, are one.
const SAME: f64 = 1e-6;

/// The new edge.
pub(super) struct Edge {
    pub points: Vec<DVec3>,
    /// For each point the places on sides 0 and 1 that it belongs to: their vertex numbers with fractions, both rising.
    places: Vec<[f64; 2]>,
}

impl Edge {
    /// Pairs every vertex of a side with the nearest place of the other, and lets the planes tangent there meet.
    pub fn between(rim: &Rim) -> Result<Self, Refusal> {
        // Both sides in one direction, that of the first.
        let [one, other] = [Chain::of(&rim.sides[0], false), Chain::of(&rim.sides[1], true)];
        let closed = rim.ends.is_none();
        let mut places = pairs(&one, &other, closed);
        places.dedup_by(|a, b| (0..2).all(|s| (a[s] - b[s]).abs() < SAME));
        let mut met: Vec<DVec3> =
            places.iter().map(|&[s, t]| meeting(one.at(s), other.at(t))).collect::<Result<_, _>>()?;
        if let Some([after, before]) = &rim.ends {
            // The first end lies at the end of side 0.
            let last = met.len() - 1;
            for (i, end) in [(last, after), (0, before)] {
                let [s, t] = places[i];
                let along = one.at(s).1.cross(other.at(t).1).normalize_or_zero();
                let slope = end.normal.dot(along);
                if slope.abs() < GRAZING {
                    return Err(Refusal::Grazing { at: met[i] });
                }
                let short = end.normal.dot(one.at(s).0 - met[i]);
                met[i] += short / slope * along;
            }
        }
        // Where an end is askew, others may lie beyond it.
        let kept = advancing(&places, &met, |[s, t]| one.at(s).0 + other.at(t).0, closed);
        places = kept.iter().map(|&i| places[i]).collect();
        let points = kept.iter().map(|&i| met[i]).collect();
        Ok(Self { points, places })
    }

    /// Triangles between the rim and the edge, whose points are numbered from `first_new` on.
    pub fn faces(&self, rim: &Rim, first_new: u32) -> Vec<[VertexId; 3]> {
        let id = |i: usize| VertexId(first_new + i as u32);
        let n = self.points.len();
        let closed = rim.ends.is_none();
        let mut faces = vec![];
        for (s, side) in rim.sides.iter().enumerate() {
            let m = side.vertices.len();
            // Side 1 runs against the edge: its places count down.
            let turn = |place: f64| if s == 0 { place } else { (m - 1) as f64 - place };
            let mut edge: Vec<_> = (0..n).map(|i| (id(i), turn(self.places[i][s]))).collect();
            let mut chain: Vec<_> = (0..m).map(|i| (side.vertices[i], i as f64)).collect();
            if s == 1 {
                edge.reverse();
            }
            if closed {
                // Once round from the first point of the edge back to it.
                if s == 1 {
                    edge.rotate_right(1);
                    edge[0].1 = turn(self.places[0][1]) - m as f64;
                }
                let start = edge[0].1;
                edge.push((edge[0].0, start + m as f64));
                let wrapped = |i: f64| i + m as f64 * ((start - i) / m as f64).ceil();
                for place in &mut chain {
                    place.1 = wrapped(place.1);
                }
                chain.sort_by(|a, b| a.1.total_cmp(&b.1));
                chain.push((chain[0].0, chain[0].1 + m as f64));
            }
            zip(&chain, &edge, &mut faces);
        }
        for (end, tip) in rim.ends.iter().flatten().zip([id(n - 1), id(0)]) {
            faces.extend(end.vertices.windows(2).map(|w| [w[0], w[1], tip]));
        }
        faces
    }
}

/// A side in the direction of the edge.
struct Chain {
    points: Vec<DVec3>,
    normals: Vec<DVec3>,
}

impl Chain {
    fn of(side: &Side, reversed: bool) -> Self {
        let mut chain = Self { points: side.points.clone(), normals: side.normals.clone() };
        if reversed {
            chain.points.reverse();
            chain.normals.reverse();
        }
        chain
    }

    /// The point and normal at a place, round and round on a closed chain.
    fn at(&self, place: f64) -> (DVec3, DVec3) {
        let n = self.points.len();
        let i = place.floor();
        let t = place - i;
        let [i, j] = [i, i + 1.0].map(|i| i.rem_euclid(n as f64) as usize);
        if t == 0.0 {
            return (self.points[i], self.normals[i]);
        }
        (self.points[i].lerp(self.points[j], t), self.normals[i].lerp(self.normals[j], t).normalize_or_zero())
    }

    /// The place nearest to a point.
    fn nearest(&self, p: DVec3, closed: bool) -> f64 {
        let n = self.points.len();
        let mut best = (f64::INFINITY, 0.0);
        for i in 0..if closed { n } else { n - 1 } {
            let (a, b) = (self.points[i], self.points[(i + 1) % n]);
            let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            let t = if t.is_nan() { 0.0 } else { t };
            let d = a.lerp(b, t).distance_squared(p);
            if d < best.0 {
                best = (d, i as f64 + t);
            }
        }
        best.1
    }
}

/// Places of both chains that belong together, rising on both.
fn pairs(one: &Chain, other: &Chain, closed: bool) -> Vec<[f64; 2]> {
    let (m, n) = (one.points.len() as f64, other.points.len() as f64);
    let from_one = one.points.iter().zip(0..).map(|(&p, i)| [f64::from(i), other.nearest(p, closed)]);
    let from_other = other.points.iter().zip(0..).map(|(&p, i)| [one.nearest(p, closed), f64::from(i)]);
    let mut all: Vec<[f64; 2]> = from_one.chain(from_other).collect();
    let (first, last) = if closed {
        let start = all[0];
        for pair in &mut all {
            // As far round on one as on the other, counted from the first pair on.
            pair[1] -= n * (((pair[1] - start[1]) / n - (pair[0] - start[0]) / m).round());
        }
        (start, [start[0] + m, start[1] + n])
    } else {
        ([0.0, 0.0], [m - 1.0, n - 1.0])
    };
    let within = |p: &[f64; 2]| (0..2).all(|s| p[s] > first[s] + SAME && p[s] < last[s] - SAME);
    all.retain(within);
    all.sort_by(|a, b| (a[0] / m + a[1] / n).total_cmp(&(b[0] / m + b[1] / n)).then(a[0].total_cmp(&b[0])));
    let mut rising = vec![first];
    for pair in all {
        let before = rising[rising.len() - 1];
        if (0..2).all(|s| pair[s] >= before[s]) {
            rising.push(pair);
        }
    }
    if !closed {
        rising.push(last);
    }
    rising
}

/// Which points go on with the sides, the first and the last of an open edge always: where a side's normal turns from facet
/// to facet, points close to each other may change places.
fn advancing(places: &[[f64; 2]], points: &[DVec3], sides: impl Fn([f64; 2]) -> DVec3, closed: bool) -> Vec<usize> {
    let goes_on = |i: usize, j: usize| {
        let way = 0.5 * (sides(places[j]) - sides(places[i]));
        (points[j] - points[i]).dot(way) > LEAST_ADVANCE * way.length_squared()
    };
    let last = points.len() - 1;
    let mut kept = vec![0];
    for i in 1..=last {
        if goes_on(kept[kept.len() - 1], i) {
            kept.push(i);
        }
    }
    // What the last point is compared with: itself on an open edge, the first one on a closed one.
    let end = if closed { 0 } else { last };
    while kept.len() > 2 && kept[kept.len() - 1] != end && !goes_on(kept[kept.len() - 1], end) {
        kept.pop();
    }
    if !closed && kept[kept.len() - 1] != last {
        kept.push(last);
    }
    kept
}

/// The point of two planes, given by point and normal, that is nearest to the middle of their points.
fn meeting((a, n): (DVec3, DVec3), (b, m): (DVec3, DVec3)) -> Result<DVec3, Refusal> {
    let (middle, c) = (a.midpoint(b), n.dot(m));
    let det = n.cross(m).length_squared();
    if det < PARALLEL {
        return Err(Refusal::Parallel { at: middle });
    }
    let (s, t) = (n.dot(a - middle), m.dot(b - middle));
    Ok(middle + ((s - c * t) * n + (t - c * s) * m) / det)
}

/// Triangles between two chains of vertices with rising places, the first on the right of the strip as seen along it.
fn zip(chain: &[(VertexId, f64)], edge: &[(VertexId, f64)], faces: &mut Vec<[VertexId; 3]>) {
    let (mut i, mut j) = (0, 0);
    while i + 1 < chain.len() || j + 1 < edge.len() {
        let along_chain = j + 1 == edge.len() || i + 1 < chain.len() && chain[i + 1].1 <= edge[j + 1].1;
        if along_chain {
            faces.push([chain[i].0, chain[i + 1].0, edge[j].0]);
            i += 1;
        } else {
            faces.push([edge[j + 1].0, edge[j].0, chain[i].0]);
            j += 1;
        }
    }
}
