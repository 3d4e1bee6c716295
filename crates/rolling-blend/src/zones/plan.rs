//! Which stretches of the curves lie in zones: those around the places where a sweep fails, as far as the ball has more
//! than its two sides to touch.

use super::section::{CutBall, CutBalls};
use glam::DVec3;
use mesh_core::{Connected, Faces, Positions, TriMesh, VertexId};
use spine::BlendCurve;
use std::collections::{BTreeMap, BTreeSet};

/// Distance between the stations at which a curve may be cut, in radii.
const SPACING: f64 = 0.5;
/// Stations of a curve, at most.
const MOST: usize = 20_000;
/// How far from a place of failure curves that do not pass it are taken in at most, in radii.
const OTHERS: f64 = 10.0;
/// What is nearer to a place than this, in radii, is next to it.
const NEXT_TO: f64 = 2.5;
/// Stretches of fewer stations between zones are not worth a strip.
const SHORTEST: usize = 4;

/// Stations along a curve.
#[derive(Clone)]
struct Stations {
    /// Place of each, by halfedge of the curve and share of it. The two ends of an open curve are stations.
    at: Vec<(usize, f64)>,
    closed: bool,
    /// Whether each lies in a zone.
    zoned: Vec<bool>,
}

/// A stretch of a curve between the stations of two cuts; `None` stands for the end of an open curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Span {
    pub curve: usize,
    pub from: Option<usize>,
    pub to: Option<usize>,
}

/// The stretches of all curves.
#[derive(Clone)]
pub(super) struct Plan<'a> {
    mesh: &'a Connected<TriMesh>,
    curves: &'a [BlendCurve],
    pub balls: &'a CutBalls<'a>,
    stations: Vec<Stations>,
    ends: BTreeMap<VertexId, Vec<(usize, usize)>>,
    /// What was found at stations: `None` where the ball touches more than two sides.
    known: BTreeMap<(usize, usize), Option<CutBall>>,
}

impl Stations {
    fn of(mesh: &Connected<TriMesh>, curve: &BlendCurve, r: f64) -> Self {
        let lengths: Vec<f64> = curve.halfedges.iter().map(|&h| mesh.edge_length(h)).collect();
        let length: f64 = lengths.iter().sum();
        let n = ((length / (SPACING * r)).ceil() as usize).clamp(2, MOST);
        let count = if curve.closed { n } else { n + 1 };
        let (mut edge, mut before) = (0, 0.0);
        let at = (0..count).map(|k| {
            let s = length * k as f64 / n as f64;
            while edge + 1 < lengths.len() && s > before + lengths[edge] {
                before += lengths[edge];
                edge += 1;
            }
            let l = lengths[edge].max(f64::MIN_POSITIVE);
            // Off the ends of the edge, where the cross-section would not be square to the curve.
            let margin = (0.3 * r / l).min(0.5);
            (edge, ((s - before) / l).clamp(margin, 1.0 - margin))
        });
        let at: Vec<_> = at.collect();
        Self { zoned: vec![false; at.len()], at, closed: curve.closed }
    }

    /// The neighbours of a station.
    fn beside(&self, k: usize) -> impl Iterator<Item = usize> {
        let n = self.at.len();
        let before = if k > 0 { Some(k - 1) } else { self.closed.then_some(n - 1) };
        let after = if k + 1 < n { Some(k + 1) } else { self.closed.then_some(0) };
        before.into_iter().chain(after)
    }

    fn is_end(&self, k: usize) -> bool {
        !self.closed && (k == 0 || k + 1 == self.at.len())
    }

    /// The station nearest to a place of the curve, counted in edges.
    fn nearest(&self, edge: usize, t: f64) -> usize {
        let after = self.at.partition_point(|a| *a < (edge, t)).min(self.at.len() - 1);
        let gap = |k: usize| (self.at[k].0 as f64 + self.at[k].1 - edge as f64 - t).abs();
        if after > 0 && gap(after - 1) < gap(after) { after - 1 } else { after }
    }

    /// The stations of a stretch, its cuts left out.
    fn within(&self, span: Span) -> impl Iterator<Item = usize> + use<> {
        let n = self.at.len();
        let first = span.from.map_or(0, |k| k + 1);
        let last = span.to.map_or(n, |k| if span.from.is_some_and(|f| f >= k) { k + n } else { k });
        (first..last).map(move |k| k % n)
    }
}

impl<'a> Plan<'a> {
    /// Plans zones around places, each with the distance up to which curves are part of its zone, in radii.
    pub fn around(balls: &'a CutBalls<'a>, places: &[(DVec3, f64)]) -> Self {
        let (mesh, curves) = (balls.ground_mesh(), balls.curves);
        let stations: Vec<Stations> = curves.iter().map(|c| Stations::of(mesh, c, balls.r)).collect();
        let mut ends: BTreeMap<VertexId, Vec<(usize, usize)>> = BTreeMap::new();
        for (c, curve) in curves.iter().enumerate().filter(|(_, c)| !c.closed) {
            if let (Some(&first), Some(&last)) = (curve.halfedges.first(), curve.halfedges.last()) {
                ends.entry(mesh.tail(first)).or_default().push((c, 0));
                ends.entry(mesh.head(last)).or_default().push((c, stations[c].at.len() - 1));
            }
        }
        let mut plan = Self { mesh, curves, balls, stations, ends, known: BTreeMap::new() };
        let mut waiting = vec![];
        for &(p, reach) in places {
            plan.seed(p, reach * balls.r, &mut waiting);
        }
        plan.grow(waiting);
        plan
    }

    /// Takes in the stations near a place: the nearest one, those next to the place, and as far as `near` those that hang
    /// together with them. What lies near but belongs to another network has no part in what fails here.
    fn seed(&self, p: DVec3, near: f64, waiting: &mut Vec<(usize, usize)>) {
        let stations = || (0..self.stations.len()).flat_map(|c| (0..self.stations[c].at.len()).map(move |k| (c, k)));
        let distance = |&(c, k): &(usize, usize)| self.place(c, k).distance(p);
        let Some(nearest) = stations().min_by(|a, b| distance(a).total_cmp(&distance(b))) else { return };
        let r = self.balls.r;
        let is_near = |s: &(usize, usize)| {
            let most = if s.0 == nearest.0 { near } else { near.min(OTHERS * r) };
            distance(s) < most
        };
        let mut stack: Vec<(usize, usize)> = stations().filter(|s| is_near(s) && distance(s) < NEXT_TO * r).collect();
        stack.push(nearest);
        let mut taken = BTreeSet::new();
        while let Some((c, k)) = stack.pop() {
            if !taken.insert((c, k)) {
                continue;
            }
            let along = self.stations[c].beside(k).map(|j| (c, j));
            let linked = along.chain(self.at_end(c, k)).chain(self.beside(c, k));
            stack.extend(linked.filter(|s| is_near(s) && !taken.contains(s)));
        }
        waiting.extend(taken);
    }

    /// What meets at the end of a curve.
    fn at_end(&self, c: usize, k: usize) -> impl Iterator<Item = (usize, usize)> {
        let meet = self.stations[c].is_end(k).then(|| self.ends.values().find(|e| e.contains(&(c, k)))).flatten();
        meet.into_iter().flatten().copied()
    }

    /// Stations of other curves whose blends may change what a ball at a station touches.
    fn beside(&self, c: usize, k: usize) -> impl Iterator<Item = (usize, usize)> {
        let others = self.balls.beside(c, self.place(c, k));
        others.into_iter().map(|(d, edge, t)| (d, self.stations[d].nearest(edge, t)))
    }

    fn place(&self, c: usize, k: usize) -> DVec3 {
        let (edge, t) = self.stations[c].at[k];
        let [a, b] = self.mesh.ends(self.curves[c].halfedges[edge]);
        a.lerp(b, t)
    }

    /// Takes in stations and their neighbours until all at the border can be cut, and no short stretch is left between.
    fn grow(&mut self, mut waiting: Vec<(usize, usize)>) {
        loop {
            while let Some((c, k)) = waiting.pop() {
                if std::mem::replace(&mut self.stations[c].zoned[k], true) {
                    continue;
                }
                waiting.extend(self.at_end(c, k).chain(self.beside(c, k)));
                let beside: Vec<usize> = self.stations[c].beside(k).collect();
                for j in beside {
                    if !self.stations[c].zoned[j] && self.ball(c, j).is_none() {
                        waiting.push((c, j));
                    }
                }
            }
            for c in 0..self.stations.len() {
                waiting.extend(self.short_stretches(c).into_iter().map(|k| (c, k)));
            }
            if waiting.is_empty() {
                return;
            }
        }
    }

    /// Stations of stretches outside zones that are too short, beside one.
    fn short_stretches(&self, c: usize) -> Vec<usize> {
        let stations = &self.stations[c];
        let n = stations.at.len();
        if !stations.zoned.contains(&true) {
            return vec![];
        }
        let first = if stations.closed { stations.zoned.iter().position(|z| *z).unwrap_or(0) } else { 0 };
        let (mut found, mut run) = (vec![], vec![]);
        for i in 0..=n {
            let k = (first + i) % n;
            if i < n && !stations.zoned[k] {
                run.push(k);
            } else {
                if run.len() < SHORTEST {
                    found.append(&mut run);
                }
                run.clear();
            }
        }
        found
    }

    /// Whether the zones are the same.
    pub fn is_like(&self, other: &Self) -> bool {
        self.stations.iter().zip(&other.stations).all(|(a, b)| a.zoned == b.zoned)
    }

    /// Whether a stretch lies in a zone.
    pub fn is_zoned(&self, span: Span) -> bool {
        let stations = &self.stations[span.curve];
        stations.within(span).any(|k| stations.zoned[k])
    }

    /// Takes a stretch out of its zone.
    pub fn release(&mut self, span: Span) {
        let stations = &mut self.stations[span.curve];
        for k in stations.within(span) {
            stations.zoned[k] = false;
        }
    }

    /// Where the curve can be cut at a station. The ends of an open curve are never cut.
    fn ball(&mut self, c: usize, k: usize) -> Option<CutBall> {
        if self.stations[c].is_end(k) {
            // A strip ends there as everywhere; next to a zone the end joins the zone.
            return None;
        }
        let (edge, t) = self.stations[c].at[k];
        let balls = self.balls;
        self.known.entry((c, k)).or_insert_with(|| balls.at(c, edge, t)).clone()
    }

    /// The cuts: curve, station and ball of the stations next to zones, in order.
    pub fn cuts(&mut self) -> Vec<(usize, usize, CutBall)> {
        let mut found = vec![];
        for c in 0..self.stations.len() {
            for k in 0..self.stations[c].at.len() {
                let beside_zone = self.stations[c].beside(k).any(|j| self.stations[c].zoned[j]);
                if !self.stations[c].zoned[k] && beside_zone {
                    found.extend(self.ball(c, k).map(|s| (c, k, s)));
                }
            }
        }
        found
    }
}
