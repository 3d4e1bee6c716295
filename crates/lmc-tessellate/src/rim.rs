//! The rims between which a surface is wanted, and how near points are to them.

use crate::error::Error;
use crate::grid::{Field, Grid, KeyMap, key};
use glam::DVec3;
use mesh_core::{Adjacency, HalfedgeId, Positions, closest_on_segment, face_normal};

/// One boundary loop of a part: a closed curve with the part on its left, seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rim {
    /// The curve's vertices in order, in model units.
    pub points: Vec<DVec3>,
    /// The part's outward unit normal at each edge, from point `i` to the next.
    pub normals: Vec<DVec3>,
}

impl Rim {
    /// A boundary loop of a mesh, as [`mesh_core::boundary_loops`] gives it.
    pub fn of(mesh: &(impl Adjacency + Positions), walk: &[HalfedgeId]) -> Self {
        Self {
            points: walk.iter().map(|&h| mesh.position(mesh.tail(h))).collect(),
            normals: walk.iter().map(|&h| face_normal(mesh, h.face())).collect(),
        }
    }

    /// Length of the edges, in model units.
    pub fn lengths(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.points.len()).map(|i| self.points[i].distance(self.points[(i + 1) % self.points.len()]))
    }

    pub(crate) fn is_sound(&self) -> bool {
        let finite = |p: &DVec3| p.is_finite();
        self.points.len() > 2
            && self.normals.len() == self.points.len()
            && self.points.iter().all(finite)
            && self.normals.iter().all(finite)
    }
}

/// A point of a rim, moved onto the zero set.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub point: DVec3,
    pub normal: DVec3,
    /// Out of the part, along the surface.
    pub conormal: DVec3,
    pub rim: u32,
    /// The next sample of the rim.
    pub next: u32,
}

/// The rims as dense samples, with an index.
pub(crate) struct Rims {
    pub samples: Vec<Sample>,
    /// The first sample of each rim.
    pub starts: Vec<u32>,
    reach: f64,
    buckets: Grid,
    /// Samples by bucket.
    order: Vec<u32>,
    ranges: KeyMap<[u32; 2]>,
}

/// Where a point is, seen from the nearest rim.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Near {
    pub sample: u32,
    pub distance: f64,
    /// The part of the distance along the conormal: positive outside the part.
    pub side: f64,
}

/// Cells within which [`Rims::near`] sees a rim.
pub(crate) const REACH: f64 = 2.0;

impl Rims {
    /// Samples every rim twice per cell and moves the samples between its vertices onto the zero set, so that coarse
    /// chords do not leave it.
    pub fn new(rims: &[Rim], field: &impl Field, grid: &Grid) -> Result<Self, Error> {
        let mut samples = vec![];
        let mut starts = vec![];
        for (r, rim) in rims.iter().enumerate() {
            let (n, first) = (rim.points.len(), samples.len());
            starts.push(first as u32);
            for i in 0..n {
                let (a, b) = (rim.points[i], rim.points[(i + 1) % n]);
                let parts = (a.distance(b) / (0.5 * grid.size)).ceil().max(1.0);
                for k in 0..parts as u32 {
                    let t = f64::from(k) / parts;
                    let before = if k == 0 { rim.normals[(i + n - 1) % n] } else { rim.normals[i] };
                    samples.push(Sample {
                        point: a + t * (b - a),
                        normal: (before + rim.normals[i]).normalize_or_zero(),
                        conormal: DVec3::ZERO,
                        rim: r as u32,
                        next: samples.len() as u32 + 1,
                    });
                }
            }
            if let Some(last) = samples.last_mut() {
                last.next = first as u32;
            }
        }
        settle(&mut samples, field, grid.size)?;
        for i in 0..samples.len() {
            let next = samples[i].next as usize;
            // Both edges at a sample have a say, so it is found from the edge before too.
            let along = (samples[next].point - samples[i].point).normalize_or_zero();
            let out = along.cross((samples[i].normal + samples[next].normal).normalize_or_zero()).normalize_or_zero();
            samples[i].conormal += out;
            samples[next].conormal += out;
        }
        for s in &mut samples {
            s.conormal = s.conormal.normalize_or_zero();
        }
        let buckets = Grid { origin: grid.origin, size: (REACH + 0.5) * grid.size };
        let keys: Vec<u64> = samples.iter().map(|s| key(buckets.cell_at(s.point))).collect();
        let mut order: Vec<u32> = (0..samples.len() as u32).collect();
        order.sort_by_key(|&i| (keys[i as usize], i));
        let mut ranges: KeyMap<[u32; 2]> = KeyMap::default();
        for (place, &i) in (0..).zip(&order) {
            ranges.entry(keys[i as usize]).or_insert([place, place])[1] = place + 1;
        }
        Ok(Self { samples, starts, reach: REACH * grid.size, buckets, order, ranges })
    }

    /// The nearest point of the rims, if it is within reach and on the same sheet: not seen too steeply.
    pub fn near(&self, p: DVec3) -> Option<Near> {
        let mut best: Option<Near> = None;
        self.visit(p, |i| {
            let (s, t) = (&self.samples[i as usize], &self.samples[self.samples[i as usize].next as usize]);
            let (at, place) = closest_on_segment(p, [s.point, t.point]);
            let offset = p - place;
            let distance = offset.length();
            if distance > self.reach || best.is_some_and(|b| b.distance <= distance) {
                return;
            }
            let normal = (1.0 - at) * s.normal + at * t.normal;
            // Nearer than this, noise in the normals tells nothing.
            if distance > 0.35 * self.reach && offset.dot(normal).abs() > 0.8 * distance {
                return;
            }
            let conormal = (1.0 - at) * s.conormal + at * t.conormal;
            best = Some(Near { sample: i, distance, side: offset.dot(conormal) });
        });
        best
    }

    /// Calls `hit` with every sample that may be within reach of `p`, in a fixed order.
    pub fn visit(&self, p: DVec3, mut hit: impl FnMut(u32)) {
        let k = self.buckets.cell_at(p);
        for step in 0..27 {
            let beside = k + glam::IVec3::new(step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1);
            if let Some(&[from, to]) = self.ranges.get(&key(beside)) {
                self.order[from as usize..to as usize].iter().for_each(|&i| hit(i));
            }
        }
    }
}

/// Moves samples along their normals onto the zero set, by secants. A sample that finds none stays.
fn settle(samples: &mut [Sample], field: &impl Field, size: f64) -> Result<(), Error> {
    const ROUNDS: usize = 4;
    let step = 0.1 * size;
    let mut values = vec![0.0; samples.len()];
    let mut before = vec![0.0; samples.len()];
    let points: Vec<DVec3> = samples.iter().map(|s| s.point).collect();
    field.values(&points, &mut before);
    let ahead: Vec<DVec3> = samples.iter().map(|s| s.point + step * s.normal).collect();
    field.values(&ahead, &mut values);
    let mut slopes: Vec<f64> = before.iter().zip(&values).map(|(u, v)| (v - u) / step).collect();
    check_slopes(samples, &slopes)?;
    let mut moved = vec![0.0; samples.len()];
    let reach = 2.0 * size;
    for round in 0..ROUNDS {
        let steps: Vec<f64> = before
            .iter()
            .zip(&slopes)
            .map(|(u, s)| if *s > 0.0 && u.is_finite() { (-u / s).clamp(-size, size) } else { 0.0 })
            .collect();
        for (m, s) in moved.iter_mut().zip(&steps) {
            *m += s;
        }
        if round + 1 == ROUNDS || steps.iter().all(|s| s.abs() < 1e-3 * size) {
            break;
        }
        let points: Vec<DVec3> = samples.iter().zip(&moved).map(|(s, m)| s.point + *m * s.normal).collect();
        field.values(&points, &mut values);
        for i in 0..samples.len() {
            let slope = (values[i] - before[i]) / steps[i];
            if slope.is_finite() && slope > 0.1 * slopes[i] && slope < 10.0 * slopes[i] {
                slopes[i] = slope;
            }
            before[i] = values[i];
        }
    }
    for (s, m) in samples.iter_mut().zip(&moved) {
        if m.abs() <= reach {
            s.point += *m * s.normal;
        }
    }
    Ok(())
}

/// The field must grow outward around most of every rim.
fn check_slopes(samples: &[Sample], slopes: &[f64]) -> Result<(), Error> {
    let rims = samples.last().map_or(0, |s| s.rim as usize + 1);
    let mut counts = vec![(0, 0, DVec3::ZERO); rims];
    for (s, &slope) in samples.iter().zip(slopes) {
        let count = &mut counts[s.rim as usize];
        if slope > 0.0 {
            count.0 += 1;
        } else {
            (count.1, count.2) = (count.1 + 1, s.point);
        }
    }
    match counts.iter().position(|c| c.1 > c.0) {
        Some(rim) => Err(Error::Inverted { rim, at: counts[rim].2 }),
        None => Ok(()),
    }
}
