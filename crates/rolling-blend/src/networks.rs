//! Networks of curves swept in part, with a smaller ball, or not at all.

use crate::blended::Blended;
use crate::corner::closest_between;
use crate::envelope;
use crate::error::Error;
use crate::params::{Overlap, Params};
use crate::so_far::SoFar;
use crate::stitch::{ROUNDS, attempt, explained};
use crate::trouble::Trouble;
use glam::DVec3;
use mesh_core::{Bounds, Connected, Faces, Positions, TriMesh, VertexId, Watch};
use rayon::prelude::*;
use spine::{BlendCurve, Convexity};
use std::collections::BTreeMap;

/// Curves nearer to each other than this, in radii, belong to one network: their blends may meet.
pub(crate) const NEIGHBOURS: f64 = 5.0;

/// Sweeps the marked curves network by network with a smaller ball here and there, or a smaller one everywhere. Curves for
/// which no ball is found stay sharp. `failure` is what stops the ball of the radius asked for.
pub(crate) fn by_network(
    mut so_far: SoFar<'_>,
    marked: &[bool],
    failure: Trouble,
    params: &Params,
    watch: &Watch,
) -> Result<Blended, Error> {
    let (mesh, curves) = (so_far.input, so_far.all);
    if params.overlap == Overlap::Error {
        return explained(mesh, curves, params, failure, watch);
    }
    for (group, _) in groups(mesh, curves, marked, params.radius) {
        let mut left = None;
        for (share, omissions) in SHARES {
            let smaller = Params { radius: share * params.radius, overlap: Overlap::Shrink, ..params.clone() };
            left = swept_in_part(&mut so_far, &group, &smaller, (params.radius, omissions), watch)?;
            if left.is_some() {
                break;
            }
        }
        let at = failure.place().unwrap_or_else(|| start_of(mesh, &curves[0]));
        let all = || (0..curves.len()).filter(|&i| group[i]).map(|i| (i, at, failure.what())).collect();
        for (i, at, what) in left.unwrap_or_else(all) {
            so_far.leave(|j| j == i, at, what);
        }
    }
    if so_far.blended.mesh.faces.is_empty() {
        return explained(mesh, curves, params, failure, watch);
    }
    Ok(so_far.blended)
}

/// Shares of the radius at which a network is swept where the envelope of the full ball fails, and how often curves are left
/// out at each.
const SHARES: [(f64, usize); 3] = [(1.0, 4), (0.5, 1), (0.25, 1)];
/// A curve that stays sharp, a place where the ball fails and why.
type Omitted = (usize, DVec3, &'static str);
/// Sweeps a network with a ball that is made smaller where it does not fit; curves near places where that fails are left
/// out. Gives for each of these a place and what failed there; `None` if nothing could be swept.
fn swept_in_part(
    so_far: &mut SoFar<'_>,
    group: &[bool],
    params: &Params,
    (full, omissions): (f64, usize),
    watch: &Watch,
) -> Result<Option<Vec<Omitted>>, Error> {
    let (mesh, curves) = (so_far.input, so_far.all);
    let (mut kept, mut left) = (group.to_vec(), vec![]);
    for _ in 0..=omissions {
        so_far.connect()?;
        if !kept.contains(&true) {
            break;
        }
        let Ok(chosen) = so_far.curves(|i| kept[i]) else { break };
        let present = so_far.mesh.as_ref().unwrap_or(mesh);
        let (what, places) = match attempt(present, &chosen, params, ROUNDS / 2, watch) {
            Ok(mut made) => {
                if params.radius < full {
                    made.full_share = 0.0;
                    made.shrunk.push((start_of(present, &chosen[0]), params.radius));
                }
                so_far.add(made, |i| kept[i]);
                return Ok(Some(left));
            }
            Err(Trouble::Cancelled(c)) => return Err(c.into()),
            Err(Trouble::Places { what, places }) => (what, places),
            Err(_) => break,
        };
        let before = left.len();
        for place in places {
            let distance = |i: usize| {
                let edges = curves[i].halfedges.iter().map(|&h| mesh.ends(h));
                edges.map(|e| envelope::to_segment(place, e)).fold(f64::INFINITY, f64::min)
            };
            let nearest = (0..curves.len()).filter(|&i| group[i]).min_by(|&i, &j| distance(i).total_cmp(&distance(j)));
            if let Some(i) = nearest.filter(|&i| kept[i]) {
                kept[i] = false;
                left.push((i, place, what));
            }
        }
        if left.len() == before {
            break;
        }
    }
    Ok(None)
}

fn start_of(mesh: &Connected<TriMesh>, curve: &BlendCurve) -> DVec3 {
    curve.halfedges.first().map_or(DVec3::ZERO, |&h| mesh.position(mesh.tail(h)))
}

/// The marked curves in networks that are blended together, each with the convexity that is blended first: where ridges and
/// valleys meet, the lone one of a corner comes first and the others roll over it, as CAD kernels do.
pub(crate) fn groups(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    marked: &[bool],
    radius: f64,
) -> Vec<(Vec<bool>, Convexity)> {
    let mut at: BTreeMap<VertexId, Vec<usize>> = BTreeMap::new();
    for i in (0..curves.len()).filter(|&i| marked[i]) {
        for &h in &curves[i].halfedges {
            for v in [mesh.tail(h), mesh.head(h)] {
                let here = at.entry(v).or_default();
                if here.last() != Some(&i) {
                    here.push(i);
                }
            }
        }
    }
    let convex = |i: usize| curves[i].convexity(mesh).unwrap_or(Convexity::Concave) == Convexity::Convex;
    let near = neighbours(mesh, curves, marked, NEIGHBOURS * radius);
    let mut seen = vec![false; curves.len()];
    let mut found = vec![];
    for start in (0..curves.len()).filter(|&i| marked[i]) {
        if seen[start] {
            continue;
        }
        let mut group = vec![false; curves.len()];
        let (mut stack, mut votes) = (vec![start], 0i64);
        while let Some(i) = stack.pop() {
            if std::mem::replace(&mut group[i], true) {
                continue;
            }
            seen[i] = true;
            stack.extend(near[i].iter().filter(|&&j| !group[j]));
        }
        for here in at.values().filter(|here| group[here[0]] && here.len() > 2) {
            let ridges = here.iter().filter(|&&i| convex(i)).count();
            let valleys = here.len() - ridges;
            if ridges > 0 && valleys > 0 {
                votes += ridges.cmp(&valleys) as i64;
            }
        }
        found.push((group, if votes >= 0 { Convexity::Concave } else { Convexity::Convex }));
    }
    found
}

/// For each marked curve, the others that come within `reach` of it.
fn neighbours(mesh: &Connected<TriMesh>, curves: &[BlendCurve], marked: &[bool], reach: f64) -> Vec<Vec<usize>> {
    let edges = |i: usize| curves[i].halfedges.iter().map(|&h| mesh.ends(h));
    let boxes: Vec<Bounds> = (0..curves.len()).map(|i| Bounds::of(edges(i).flatten()).inflated(0.5 * reach)).collect();
    let close = |i: usize, j: usize| {
        boxes[i].overlaps(&boxes[j])
            && edges(i).any(|e| {
                edges(j).any(|f| {
                    let (s, t) = closest_between(e, f);
                    e[0].lerp(e[1], s).distance(f[0].lerp(f[1], t)) < reach
                })
            })
    };
    let others = |i: usize| (0..curves.len()).filter(|&j| j != i && marked[i] && marked[j] && close(i, j)).collect();
    (0..curves.len()).into_par_iter().map(others).collect()
}
