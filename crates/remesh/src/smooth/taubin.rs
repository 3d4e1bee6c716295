//! Smoothing without shrinking, by alternating steps inward and outward.

use super::held::Task;
use crate::{Error, Frozen};
use glam::DVec3;
use mesh_core::{Adjacency, Positions, VertexId, Watch};
use rayon::prelude::*;

/// How a surface is smoothed without shrinking.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taubin {
    /// Pairs of steps.
    pub rounds: usize,
    /// Share of the way to the mean of the neighbours that the inward step goes, in (0, 1).
    pub lambda: f64,
    /// Frequency that neither grows nor shrinks, in (0, 1/λ), on a scale where a flat surface has 0 and the roughest
    /// possible 2. The outward step is 1/(pass − 1/λ).
    pub pass: f64,
}

impl Default for Taubin {
    // The usual ones of [Taubin1995].
    fn default() -> Self {
        Self { rounds: 10, lambda: 0.6307, pass: 0.1 }
    }
}

/// Vertices per parallel task.
const CHUNK: usize = 1024;

/// The vertices' places after `rounds` pairs of a shrinking and an inflating step towards the mean of the neighbours
/// (\[Taubin1995\]).
///
/// A wave that the mean of the neighbours lowers by the share k keeps ((1 − λk)(1 − μk))^rounds of its height: short waves
/// vanish, those below `pass` stay, and with them the volume. The boundary and what is frozen keep their bits. O(rounds · n).
/// The same input gives the same bits for any number of threads.
///
/// # Errors
/// [`Error::NotPositive`], [`Error::NotFinite`], [`Error::Count`], [`Error::Cancelled`].
pub fn taubin<M: Adjacency + Positions + Sync>(
    mesh: &M,
    frozen: &Frozen,
    params: &Taubin,
    watch: &Watch,
) -> Result<Vec<DVec3>, Error> {
    let Taubin { rounds, lambda, pass } = *params;
    if !(lambda > 0.0 && lambda < 1.0) {
        return Err(Error::NotPositive { name: "lambda (below 1)", value: lambda });
    }
    if !(pass > 0.0 && pass * lambda < 1.0) {
        return Err(Error::NotPositive { name: "pass (below 1/lambda)", value: pass });
    }
    let mu = 1.0 / (pass - 1.0 / lambda);
    let mut task = Task::new(mesh, frozen)?;
    let mut starts = vec![0];
    let mut neighbours: Vec<u32> = vec![];
    for &v in task.free() {
        neighbours.extend(mesh.ring(VertexId(v)).map(|h| mesh.head(h).0));
        starts.push(neighbours.len());
    }
    let mut next: Vec<DVec3> = vec![];
    for round in 0..rounds {
        watch.step("smooth", round as f64 / rounds as f64)?;
        for share in [lambda, mu] {
            let points = &task.moved.points;
            let at = |i: usize| {
                let (p, ring) = (points[task.free()[i] as usize], &neighbours[starts[i]..starts[i + 1]]);
                let mean = ring.iter().map(|&n| points[n as usize]).sum::<DVec3>() / ring.len() as f64;
                p + share * (mean - p)
            };
            (0..task.free().len()).into_par_iter().with_min_len(CHUNK).map(at).collect_into_vec(&mut next);
            for (&v, &p) in task.unknowns.free().iter().zip(&next) {
                task.moved.points[v as usize] = p;
            }
        }
    }
    Ok(task.finish())
}
