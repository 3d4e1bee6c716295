//! Feature polylines, and the vertices that slide along them.

use super::table::NONE;
use glam::DVec3;
use std::collections::HashMap;

/// A feature polyline of the input.
struct Chain {
    points: Vec<DVec3>,
    /// Arc length from the start to each point; one more than points when closed.
    reach: Vec<f64>,
    closed: bool,
}

impl Chain {
    fn length(&self) -> f64 {
        self.reach.last().copied().unwrap_or(0.0)
    }

    fn at(&self, s: f64) -> DVec3 {
        let i = self.reach.partition_point(|&r| r <= s).clamp(1, self.reach.len() - 1);
        let (a, b) = (self.points[i - 1], self.points[i % self.points.len()]);
        let span = self.reach[i] - self.reach[i - 1];
        let t = if span > 0.0 { ((s - self.reach[i - 1]) / span).clamp(0.0, 1.0) } else { 0.0 };
        if t == 0.0 { a } else { a + t * (b - a) }
    }
}

/// A vertex on a polyline.
#[derive(Clone, Copy)]
struct Node {
    chain: u32,
    /// Arc length from the chain's start.
    s: f64,
    before: u32,
    after: u32,
}

/// All polylines and the vertices on them.
#[derive(Default)]
pub(crate) struct Lines {
    chains: Vec<Chain>,
    nodes: Vec<Node>,
    /// Each vertex's node, or [`NONE`].
    of_vertex: Vec<u32>,
    /// Chains without nodes and the ends they start at, by both ends, the lower first. Only ever looked up.
    bare: HashMap<[u32; 2], (u32, u32)>,
}

impl Lines {
    /// Adds a polyline through `vertices`. The ends of an open one are no nodes: they stay where they are.
    pub fn add(&mut self, vertices: &[u32], points: Vec<DVec3>, closed: bool) {
        let n = points.len();
        let mut reach = vec![0.0];
        for i in 1..n + usize::from(closed) {
            reach.push(reach[i - 1] + points[i - 1].distance(points[i % n]));
        }
        let chain = self.chains.len() as u32;
        for i in 0..n {
            if closed || (i > 0 && i + 1 < n) {
                let (before, after) = (vertices[(i + n - 1) % n], vertices[(i + 1) % n]);
                self.set(vertices[i], Node { chain, s: reach[i], before, after });
            }
        }
        if !closed && n == 2 {
            self.bare.insert(ordered(vertices[0], vertices[1]), (chain, vertices[0]));
        }
        self.chains.push(Chain { points, reach, closed });
    }

    fn set(&mut self, v: u32, node: Node) {
        if self.of_vertex.len() <= v as usize {
            self.of_vertex.resize(v as usize + 1, NONE);
        }
        self.of_vertex[v as usize] = self.nodes.len() as u32;
        self.nodes.push(node);
    }

    fn node(&self, v: u32) -> Option<&Node> {
        self.nodes.get(*self.of_vertex.get(v as usize)? as usize)
    }

    fn node_mut(&mut self, v: u32) -> Option<&mut Node> {
        self.nodes.get_mut(*self.of_vertex.get(v as usize)? as usize)
    }

    /// The arc lengths of a node's neighbours, moved around a closed chain so that they enclose the node's own.
    fn around(&self, node: &Node) -> [f64; 2] {
        let chain = &self.chains[node.chain as usize];
        let length = chain.length();
        let before = self.node(node.before).map_or(0.0, |n| n.s);
        let after = self.node(node.after).map_or(length, |n| n.s);
        if !chain.closed {
            return [before, after];
        }
        [if before >= node.s { before - length } else { before }, if after <= node.s { after + length } else { after }]
    }

    /// The middle of the feature edge `a`–`b`: its chain, its arc length, and whether `b` comes after `a`.
    fn middle(&self, a: u32, b: u32) -> Option<(u32, f64, bool)> {
        let (one, other, turned) = match (self.node(a), self.node(b)) {
            (Some(node), _) => (node, b, false),
            (None, Some(node)) => (node, a, true),
            (None, None) => {
                let &(chain, start) = self.bare.get(&ordered(a, b))?;
                return Some((chain, 0.5 * self.chains[chain as usize].length(), start == a));
            }
        };
        let [before, after] = self.around(one);
        let onward = one.after == other;
        let s = self.wrapped(one.chain, 0.5 * (one.s + if onward { after } else { before }));
        Some((one.chain, s, onward != turned))
    }

    fn wrapped(&self, chain: u32, s: f64) -> f64 {
        let chain = &self.chains[chain as usize];
        if chain.closed { s.rem_euclid(chain.length()) } else { s }
    }

    /// Puts the new vertex `m` in the middle of the feature edge `a`–`b` and returns its place.
    pub fn insert(&mut self, a: u32, b: u32, m: u32, fallback: DVec3) -> DVec3 {
        let Some((chain, s, onward)) = self.middle(a, b) else { return fallback };
        let (before, after) = if onward { (a, b) } else { (b, a) };
        self.set(m, Node { chain, s, before, after });
        if let Some(node) = self.node_mut(before) {
            node.after = m;
        }
        if let Some(node) = self.node_mut(after) {
            node.before = m;
        }
        self.chains[chain as usize].at(s)
    }

    /// The middle of two neighbouring nodes: arc length and place.
    pub fn between(&self, a: u32, b: u32) -> Option<(f64, DVec3)> {
        let (chain, s, _) = self.middle(a, b)?;
        Some((s, self.chains[chain as usize].at(s)))
    }

    /// Takes the node `u` out in favour of its neighbour `v`, which slides to `s` if given.
    pub fn remove(&mut self, u: u32, v: u32, s: Option<f64>) {
        let Some(&gone) = self.node(u) else { return };
        let far = if gone.after == v { gone.before } else { gone.after };
        for (here, instead) in [(v, far), (far, v)] {
            if let Some(node) = self.node_mut(here) {
                if gone.after == here {
                    node.before = instead;
                } else {
                    node.after = instead;
                }
            }
        }
        if let (Some(node), Some(s)) = (self.node_mut(v), s) {
            node.s = s;
        }
        if self.node(v).is_none() && self.node(far).is_none() {
            self.bare.insert(ordered(v, far), (gone.chain, if gone.after == v { far } else { v }));
        }
        self.of_vertex[u as usize] = NONE;
    }

    /// Where the node of `v` is along its chain.
    pub fn arc(&self, v: u32) -> f64 {
        self.node(v).map_or(0.0, |n| n.s)
    }

    /// Slides the node of `v` to the arc length `s` and returns its place.
    pub fn slide_to(&mut self, v: u32, s: f64) -> Option<DVec3> {
        let chain = self.node(v)?.chain;
        let s = self.wrapped(chain, s);
        self.node_mut(v)?.s = s;
        Some(self.chains[chain as usize].at(s))
    }

    /// Slides the node of `v` the share `lambda` of the way to the middle of its neighbours.
    pub fn relax(&mut self, v: u32, lambda: f64) -> Option<DVec3> {
        let node = self.node(v)?;
        let [before, after] = self.around(node);
        self.slide_to(v, node.s + lambda * (0.5 * (before + after) - node.s))
    }
}

fn ordered(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}
