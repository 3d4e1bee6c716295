//! The fans of all source vertices, and the search for the one most like a partly known fan.
//!
//! The distance of two fans is the sum of squared differences of their samples, where the query's are known, least over the eight
//! rotations. An exhaustive search looks at every fan and rotation. The indexed one gives the same answer: some branches in a row that the query knows in
//! full are turned to the front, where a tree of the sources' leading branches, in few principal axes, bounds the distance from below.

use crate::fan::{BRANCH, BRANCHES, NUMBERS, STEPS};
use crate::tree::Tree;
use rayon::prelude::*;
use std::sync::OnceLock;

/// A query: a fan known in part.
#[derive(Clone, Debug)]
pub(crate) struct Query {
    /// Samples; zero where unknown.
    pub values: [f32; NUMBERS],
    /// Which samples are known, ascending.
    pub known: Vec<u8>,
}

impl Query {
    /// The longest run of branches known but for their first sample, whose face is mostly the queried vertex's own: first branch and
    /// length.
    fn run(&self) -> (usize, usize) {
        let mut counts = [0; BRANCHES];
        self.known.iter().map(|&s| usize::from(s)).filter(|s| s % STEPS > 0).for_each(|s| counts[s / STEPS] += 1);
        let length = |s: usize| (0..BRANCHES).take_while(|i| counts[(s + i) % BRANCHES] == STEPS - 1).count();
        (0..BRANCHES).map(|s| (s, length(s))).fold((0, 0), |best, r| if r.1 > best.1 { r } else { best })
    }
}

/// A source fan and how it is turned: branch i of the query faces branch i + `turn` of the source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Match {
    pub entry: u32,
    pub turn: u8,
    /// Sum of squared differences over the query's known numbers.
    pub distance: f32,
}

impl Match {
    /// What is to be improved on: nothing, at a distance of `limit`.
    fn none(limit: f32) -> Self {
        // Greater than any entry, though not any turn of a missing one: a fan at the very limit counts as found.
        Self { entry: u32::MAX, turn: 0, distance: limit }
    }

    fn found(self) -> Option<Self> {
        (self.entry != u32::MAX).then_some(self)
    }

    /// The nearer one; ties go to the lower entry, then to the lesser turn.
    fn better(self, other: Self) -> Self {
        let key = |m: Self| (m.entry, m.turn);
        let wins = self.distance < other.distance || self.distance == other.distance && key(self) < key(other);
        if wins { self } else { other }
    }
}

/// How many leading branches the trees look at.
const RUNS: [usize; 2] = [3, 2];
/// Numbers of a branch that the trees look at.
const OUTER: usize = BRANCH - 3;

/// Source fans.
pub(crate) struct Library {
    /// Each fan twice in a row, so that a turned fan is a window.
    fans: Vec<[f32; 2 * NUMBERS]>,
    /// Made when first asked for.
    trees: [OnceLock<Tree>; RUNS.len()],
}

impl Library {
    /// A library of these fans.
    pub fn new(fans: &[[f32; NUMBERS]]) -> Self {
        let twice = |fan: &[f32; NUMBERS]| std::array::from_fn(|i| fan[i % NUMBERS]);
        Self { fans: fans.iter().map(twice).collect(), trees: Default::default() }
    }

    /// The tree for runs of at least `length` branches, and how many it looks at. O(n log n) the first time.
    fn tree(&self, length: usize) -> Option<(usize, &Tree)> {
        let at = RUNS.iter().position(|&run| run <= length)?;
        let run = RUNS[at];
        let make = || {
            let outer = |id: u32, out: &mut [f32]| {
                let (fan, turn) = (&self.fans[id as usize / BRANCHES], id as usize % BRANCHES);
                for (b, numbers) in out.chunks_exact_mut(OUTER).enumerate() {
                    let end = (turn + b + 1) * BRANCH;
                    numbers.copy_from_slice(&fan[end - OUTER..end]);
                }
            };
            Tree::build((self.fans.len() * BRANCHES) as u32, run * OUTER, &outer)
        };
        Some((run, self.trees[at].get_or_init(make)))
    }

    /// The distance of a query to a turned fan, if it is not above `limit`.
    #[inline]
    pub fn distance(&self, q: &Query, entry: u32, turn: u8, limit: f32) -> Option<f32> {
        let start = usize::from(turn) * BRANCH;
        let fan = &self.fans[entry as usize][start..start + NUMBERS];
        let mut sum = 0.0;
        for &sample in &q.known {
            let range = 3 * usize::from(sample)..3 * usize::from(sample) + 3;
            for (a, b) in q.values[range.clone()].iter().zip(&fan[range]) {
                sum += (a - b).powi(2);
            }
            if sum > limit {
                return None;
            }
        }
        Some(sum)
    }

    fn consider(&self, q: &Query, best: Match, entry: u32, turn: u8) -> Match {
        match self.distance(q, entry, turn, best.distance) {
            Some(distance) => best.better(Match { entry, turn, distance }),
            None => best,
        }
    }

    /// The distance of a query to one fan, least over the turns.
    pub fn nearest_turn(&self, q: &Query, entry: u32) -> f32 {
        (0..BRANCHES as u8).fold(Match::none(f32::INFINITY), |best, turn| self.consider(q, best, entry, turn)).distance
    }

    /// The most similar fan that is nearer than `limit`, found by looking at all. O(n), parallel.
    pub fn exhaustive(&self, q: &Query, limit: f32) -> Option<Match> {
        let entries = (0..self.fans.len() as u32).into_par_iter().with_min_len(1024);
        let one = |best: Match, entry: u32| (0..BRANCHES as u8).fold(best, |b, turn| self.consider(q, b, entry, turn));
        entries.fold(|| Match::none(limit), one).reduce(|| Match::none(limit), Match::better).found()
    }

    /// The same, by the index.
    pub fn search(&self, q: &Query, limit: f32) -> Option<Match> {
        let (first, length) = q.run();
        let Some((run, tree)) = self.tree(length) else { return self.exhaustive(q, limit) };
        let mut best = Match::none(limit);
        let front: Vec<f32> = (0..run * OUTER)
            .map(|i| q.values[((first + i / OUTER) * BRANCH + BRANCH - OUTER + i % OUTER) % NUMBERS])
            .collect();
        tree.visit(&front, best.distance, |id| {
            let (entry, leading) = (id / BRANCHES as u32, id as usize % BRANCHES);
            let turn = (leading + BRANCHES - first) % BRANCHES;
            best = self.consider(q, best, entry, turn as u8);
            best.distance
        });
        best.found()
    }
}
