//! Which edges are features, and the polylines they form.

use super::lines::Lines;
use super::params::Params;
use super::state::{Kind, cross};
use super::table::{FEATURE, NONE, Table};
use glam::DVec3;
use rayon::prelude::*;

/// A polyline that turns by more than this cosine at a vertex has a corner there.
const CORNER: f64 = 0.5;

/// Marks feature edges in `table`, tells what each vertex on them may do, and returns the polylines. O(n).
pub(crate) fn find_features(
    table: &mut Table,
    points: &[DVec3],
    kinds: &mut [Kind],
    sizes: &[f64],
    params: &Params,
) -> Lines {
    let mut lines = Lines::default();
    if params.feature_angle >= 180.0 {
        return lines;
    }
    let mut degree = mark_sharp(table, points, params.feature_angle.to_radians().cos());
    // Dropping a spur may turn a junction into the inside of a polyline, which is then long enough, or not.
    for _ in 0..2 {
        let chains = chains(table, points, kinds, &degree);
        for chain in chains {
            let (start, end) = (table.tail(chain[0]), table.head(*chain.last().unwrap_or(&chain[0])));
            let loose = |v: u32| degree[v as usize] == 1 && kinds[v as usize] != Kind::Fixed;
            if start != end && (loose(start) || loose(end)) {
                let relative = |&h: &u32| {
                    let (a, b) = (table.tail(h) as usize, table.head(h) as usize);
                    points[a].distance(points[b]) / (0.5 * (sizes[a] + sizes[b]))
                };
                if chain.iter().map(relative).sum::<f64>() < params.shortest_feature {
                    for h in chain {
                        for h in [h, table.twin(h)] {
                            table.flags[h as usize] = 0;
                            degree[table.tail(h) as usize] -= 1;
                        }
                    }
                }
            }
        }
    }
    for chain in chains(table, points, kinds, &degree) {
        let mut vertices: Vec<u32> = chain.iter().map(|&h| table.tail(h)).collect();
        let end = chain.last().map_or(NONE, |&h| table.head(h));
        let closed = end == vertices[0] && is_inner(table, points, kinds, &degree, end);
        if !closed {
            vertices.push(end);
            kinds[vertices[0] as usize] = Kind::Fixed;
            kinds[end as usize] = Kind::Fixed;
        }
        for &v in &vertices {
            if kinds[v as usize] == Kind::Free {
                kinds[v as usize] = Kind::Line;
            }
        }
        let place = vertices.iter().map(|&v| points[v as usize]).collect();
        lines.add(&vertices, place, closed);
    }
    lines
}

/// Marks edges that turn by more than the angle, and counts them at each vertex.
fn mark_sharp(table: &mut Table, points: &[DVec3], flattest: f64) -> Vec<u32> {
    let normal =
        |f: u32| cross([3 * f, 3 * f + 1, 3 * f + 2].map(|h| points[table.tail(h) as usize])).normalize_or_zero();
    let normals: Vec<DVec3> = (0..table.halfedge_count() / 3).into_par_iter().with_min_len(4096).map(normal).collect();
    let sharp: Vec<u32> = (0..table.halfedge_count())
        .into_par_iter()
        .with_min_len(4096)
        .filter(|&h| {
            table.is_editable(h) && {
                let t = table.twin(h);
                let (m, n) = (normals[h as usize / 3], normals[t as usize / 3]);
                m != DVec3::ZERO && n != DVec3::ZERO && m.dot(n) < flattest
            }
        })
        .collect();
    let mut degree = vec![0; points.len()];
    for h in sharp {
        for h in [h, table.twin(h)] {
            table.flags[h as usize] |= FEATURE;
            degree[table.tail(h) as usize] += 1;
        }
    }
    degree
}

/// The two feature edges of a vertex, leaving it.
fn feature_edges(table: &Table, v: u32) -> impl Iterator<Item = u32> + '_ {
    table.ring(v).filter(|&h| table.flags[h as usize] & FEATURE != 0)
}

/// Whether a polyline passes through `v` rather than ending there.
fn is_inner(table: &Table, points: &[DVec3], kinds: &[Kind], degree: &[u32], v: u32) -> bool {
    if degree[v as usize] != 2 || kinds[v as usize] == Kind::Fixed {
        return false;
    }
    let mut along =
        feature_edges(table, v).map(|h| (points[table.head(h) as usize] - points[v as usize]).normalize_or_zero());
    match (along.next(), along.next()) {
        (Some(a), Some(b)) => -a.dot(b) >= CORNER,
        _ => false,
    }
}

/// Polylines as halfedges in order, from corner to corner or closed; in order of their lowest start.
fn chains(table: &Table, points: &[DVec3], kinds: &[Kind], degree: &[u32]) -> Vec<Vec<u32>> {
    let inner = |v: u32| is_inner(table, points, kinds, degree, v);
    let mut seen = vec![false; table.flags.len()];
    let mut chains = vec![];
    let walk = |start: u32, seen: &mut Vec<bool>| {
        let mut chain = vec![];
        let mut h = start;
        loop {
            seen[h as usize] = true;
            seen[table.twin(h) as usize] = true;
            chain.push(h);
            let v = table.head(h);
            if !inner(v) {
                return chain;
            }
            let back = table.twin(h);
            match feature_edges(table, v).find(|&e| e != back) {
                Some(e) if !seen[e as usize] => h = e,
                _ => return chain,
            }
        }
    };
    for open in [true, false] {
        for h in 0..table.halfedge_count() {
            let feature = table.flags[h as usize] & FEATURE != 0;
            if feature && !seen[h as usize] && (!open || !inner(table.tail(h))) {
                chains.push(walk(h, &mut seen));
            }
        }
    }
    chains
}
