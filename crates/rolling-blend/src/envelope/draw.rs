//! The cut-out piece of the surface, drawn onto the envelope.

use super::centre::{Ground, Stop};
use super::flip::flip_needles;
use crate::field::piece::{CutOut, Evenness, even_out, split_chords};
use crate::trouble::Trouble;
use glam::DVec3;
use mesh_core::{TriMesh, VertexId, Watch, area};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Rounds of each remeshing of the piece, and how far its vertices may then be drawn, in radii: the cut-out piece has needles,
/// and an edge of 35 degrees is 2.3 radii away from its ball.
const PASSES: [(usize, f64); 3] = [(10, 3.0), (5, 3.0), (5, 1.0)];
/// The drawn piece is smaller than what was cut out; where it is larger than this many times, vertices went astray.
const WIDEST: f64 = 1.2;
/// So many vertices, or such a share, may be without a ball: the search for one is local. They follow their neighbours.
const FEW: usize = 3;
const SHARE: usize = 50;
/// What is said where there is none.
pub(crate) const NO_BALL: &str = "no ball of this size fits";

/// Draws the piece onto the envelope of balls of radius `r` behind the `stops`, with edges about `edge` long. Its topology
/// stays.
pub(super) fn draw(
    piece: &CutOut,
    ground: &Ground<'_>,
    (r, edge): (f64, f64),
    stops: &[Stop],
    taken: &BTreeSet<[VertexId; 2]>,
    watch: &Watch,
) -> Result<TriMesh, Trouble> {
    let mut mesh = piece.mesh.clone();
    flip_needles(&mut mesh, 0.0, |_| false);
    let most = WIDEST * area(&piece.mesh);
    for (rounds, reach) in PASSES {
        mesh = even_out(mesh, edge, Evenness { rounds, slope: 0.5, finest: 0.5 }, watch)?;
        split_chords(&mut mesh, piece.rim.len(), taken, 0.5 * edge);
        let inner = &mesh.positions[piece.rim.len()..];
        let found: Vec<Option<(DVec3, DVec3)>> = inner
            .par_iter()
            .with_min_len(16)
            .map(|&p| ground.envelope(p, r, stops).filter(|q| q.0.distance(p) < reach * r))
            .collect();
        let lost: Vec<DVec3> = inner.iter().zip(&found).filter(|f| f.1.is_none()).map(|f| *f.0).collect();
        if lost.len() > FEW.max(inner.len() / SHARE) {
            return Err(Trouble::at(NO_BALL, lost));
        }
        let first = piece.rim.len();
        let missing: Vec<usize> = (0..found.len()).filter(|&i| found[i].is_none()).map(|i| first + i).collect();
        for (at, found) in mesh.positions[first..].iter_mut().zip(&found) {
            *at = found.map_or(*at, |f| f.0);
        }
        let centre = |v: usize| v.checked_sub(first).and_then(|i| found[i]).map(|f| f.1);
        follow_neighbours(&mut mesh, &missing, centre, r);
        if area(&mesh) > most {
            return Err(Trouble::at(NO_BALL, mesh.positions.first().copied().into_iter().collect()));
        }
    }
    Ok(mesh)
}

/// Moves some vertices to the mean of their neighbours, and from there onto the balls that touch these.
fn follow_neighbours(mesh: &mut TriMesh, some: &[usize], centre: impl Fn(usize) -> Option<DVec3>, r: f64) {
    for &v in some {
        let has = |f: &&[VertexId; 3]| f.iter().any(|w| w.index() == v);
        let around: BTreeSet<usize> =
            mesh.faces.iter().filter(has).flatten().map(|w| w.index()).filter(|&w| w != v).collect();
        let mean = |points: Vec<DVec3>| points.iter().sum::<DVec3>() / points.len() as f64;
        if around.is_empty() {
            continue;
        }
        let middle = mean(around.iter().map(|&w| mesh.positions[w]).collect());
        let on_balls: Vec<DVec3> =
            around.iter().filter_map(|&w| centre(w)).map(|c| c + r * (middle - c).normalize_or_zero()).collect();
        mesh.positions[v] = if on_balls.is_empty() { middle } else { mean(on_balls) };
    }
}
