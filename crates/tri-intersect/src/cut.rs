//! Cuts every crossed face along its segments. Nodes that rounding brought too close are merged until all faces can be
//! triangulated without folding.

use crate::arrange::{Arrangement, Part};
use crate::error::Error;
use crate::predicate::{facing, project};
use crate::triangulate::{TooClose, Triangulator};
use mesh_core::{Adjacency, FaceId, Faces, HalfedgeId};
use rayon::prelude::*;

/// Rounds of merging before giving up.
const ROUNDS: usize = 64;

/// How a piece lies to the other solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Class {
    /// Not yet known.
    Unknown,
    Outside,
    Inside,
    /// On a face of the other part that looks the same way.
    Same,
    /// On a face of the other part that looks the other way.
    Opposite,
}

/// The cut faces of one part and the triangles that replace them.
#[derive(Default)]
pub(crate) struct Pieces {
    /// Cut faces in order.
    pub faces: Vec<u32>,
    /// Where the triangles of each begin; one more at the end.
    pub starts: Vec<u32>,
    /// Corners, as nodes.
    pub triangles: Vec<[u32; 3]>,
    /// The face of each.
    pub parents: Vec<u32>,
    /// `Same` and `Opposite` are set here, the rest by the flood.
    pub classes: Vec<Class>,
}

/// Which new nodes became one with another.
#[derive(Default)]
pub(crate) struct Merges {
    first: u32,
    into: Vec<u32>,
    /// How many merges, and the first node merged.
    pub count: usize,
    pub example: Option<u32>,
}

impl Merges {
    pub(crate) fn find(&self, mut node: u32) -> u32 {
        while node >= self.first && self.into[(node - self.first) as usize] != node {
            node = self.into[(node - self.first) as usize];
        }
        node
    }

    /// Merges two nodes into the lower one. False if both are input vertices, which must not move.
    fn join(&mut self, x: u32, y: u32) -> bool {
        let (x, y) = (self.find(x), self.find(y));
        let (low, high) = (x.min(y), x.max(y));
        if low != high {
            if high < self.first {
                return false;
            }
            self.into[(high - self.first) as usize] = low;
            self.count += 1;
            self.example = self.example.or(Some(low));
        }
        true
    }
}

/// One face's way into the triangulator.
#[derive(Default)]
struct Workspace {
    triangulator: Triangulator,
    nodes: Vec<u32>,
    index: Vec<(u32, u32)>,
    xy: Vec<[f64; 2]>,
    sides: [Vec<u32>; 3],
    inner: Vec<u32>,
    ends: Vec<u32>,
    constraints: Vec<[u32; 2]>,
}

type Cut = Vec<[u32; 3]>;

/// Cuts both parts.
pub(crate) fn cut(parts: &[Part; 2], arrangement: &Arrangement) -> Result<([Pieces; 2], Merges), Error> {
    let first = arrangement.counts[0] + arrangement.counts[1];
    let new = arrangement.places.len() as u32;
    let mut merges = Merges { first, into: (first..first + new).collect(), count: 0, example: None };
    let work = [0, 1].map(|which| crossed_faces(parts, arrangement, which));
    for _ in 0..ROUNDS {
        let results: [Vec<Result<Cut, [u32; 2]>>; 2] = [0, 1].map(|which| {
            work[which]
                .par_iter()
                .map_init(Workspace::default, |space, (face, segments)| {
                    cut_face(parts, arrangement, &merges, which, *face, segments, space)
                })
                .collect()
        });
        let failures: Vec<[u32; 2]> = results.iter().flatten().filter_map(|r| r.as_ref().err().copied()).collect();
        if failures.is_empty() {
            let cuts = results.map(|r| r.into_iter().map(Result::unwrap_or_default).collect::<Vec<Cut>>());
            return Ok((gather(arrangement, &merges, &work, cuts), merges));
        }
        for [x, y] in failures {
            if x == y || !merges.join(x, y) {
                return Err(Error::Rounding { at: arrangement.position(parts, x) });
            }
        }
    }
    Err(Error::Rounding { at: arrangement.position(parts, merges.example.unwrap_or(0)) })
}

/// The faces of a part that are crossed or have a node on a side, each with its segments.
fn crossed_faces(parts: &[Part; 2], arrangement: &Arrangement, which: usize) -> Vec<(u32, Vec<u32>)> {
    let mesh = parts[which].mesh;
    let mut entries: Vec<(u32, u32)> =
        arrangement.segments.iter().enumerate().map(|(i, s)| (s.faces[which], i as u32)).collect();
    let mut previous = u32::MAX;
    for &(edge, _) in &arrangement.on_edges[which] {
        if edge != previous {
            previous = edge;
            let h = HalfedgeId(edge);
            entries.push((h.face().0, u32::MAX));
            entries.extend(mesh.twin(h).map(|t| (t.face().0, u32::MAX)));
        }
    }
    entries.par_sort_unstable();
    entries
        .chunk_by(|x, y| x.0 == y.0)
        .map(|group| (group[0].0, group.iter().map(|e| e.1).filter(|&s| s != u32::MAX).collect()))
        .collect()
}

fn cut_face(
    parts: &[Part; 2],
    arrangement: &Arrangement,
    merges: &Merges,
    which: usize,
    face: u32,
    segments: &[u32],
    space: &mut Workspace,
) -> Result<Cut, [u32; 2]> {
    let mesh = parts[which].mesh;
    let corners = mesh.corners(FaceId(face)).map(|v| arrangement.node(which, v));
    let Workspace { triangulator, nodes, index, xy, sides, inner, ends, constraints } = space;
    nodes.clear();
    nodes.extend(corners);
    for k in 0..3 {
        let (from, to) = (corners[k], corners[(k + 1) % 3]);
        let h = HalfedgeId::new(FaceId(face), k);
        let edge = mesh.edge(h);
        let along = arrangement.along_edge(which, edge.0);
        sides[k].clear();
        let mut last = from;
        let mut push = |node: u32| {
            let node = merges.find(node);
            if node != last && node != to {
                sides[k].push(nodes.len() as u32);
                nodes.push(node);
                last = node;
            }
        };
        if edge.0 == h.0 {
            along.iter().for_each(|e| push(e.1));
        } else {
            along.iter().rev().for_each(|e| push(e.1));
        }
    }
    let border = nodes.len();
    ends.clear();
    ends.extend(segments.iter().flat_map(|&s| arrangement.segments[s as usize].ends).map(|n| merges.find(n)));
    ends.sort_unstable();
    ends.dedup();
    if ends.iter().all(|n| corners.contains(n)) && border == 3 {
        return Ok(vec![corners]);
    }
    index.clear();
    index.extend(nodes.iter().enumerate().map(|(i, &n)| (n, i as u32)));
    index.sort_unstable();
    if let Some(twice) = index.windows(2).find(|w| w[0].0 == w[1].0) {
        return Err([twice[0].0; 2]);
    }
    inner.clear();
    for &n in ends.iter() {
        if index.binary_search_by_key(&n, |e| e.0).is_err() {
            inner.push(nodes.len() as u32);
            nodes.push(n);
        }
    }
    if !inner.is_empty() {
        index.extend(inner.iter().map(|&i| (nodes[i as usize], i)));
        index.sort_unstable();
    }
    let local = |n: u32| index.binary_search_by_key(&merges.find(n), |e| e.0).map_or(0, |i| index[i].1);
    constraints.clear();
    constraints.extend(segments.iter().filter_map(|&s| {
        let [p, q] = arrangement.segments[s as usize].ends.map(local);
        (p != q).then_some([p.min(q), p.max(q)])
    }));
    constraints.sort_unstable();
    constraints.dedup();
    let Some((axis, way)) = facing(&parts[which].triangle(face)) else { return Err([corners[0]; 2]) };
    xy.clear();
    xy.extend(nodes.iter().map(|&n| {
        let [x, y] = project(axis, arrangement.scaled_position(parts, n));
        if way > 0 { [x, y] } else { [y, x] }
    }));
    // A point per step along the chains keeps the walk between insertions short.
    let mut out = vec![];
    triangulator
        .run(xy, sides, inner, constraints, &mut out)
        .map_err(|TooClose(i, j)| [nodes[i as usize], nodes[j as usize]])?;
    Ok(out.into_iter().map(|t| t.map(|i| nodes[i as usize])).collect())
}

/// Flattens the cuts, and gives coplanar cells the same triangles in both parts.
fn gather(
    arrangement: &Arrangement,
    merges: &Merges,
    work: &[Vec<(u32, Vec<u32>)>; 2],
    cuts: [Vec<Cut>; 2],
) -> [Pieces; 2] {
    let classes = [0, 1].map(|w| cuts[w].iter().map(|c| vec![Class::Unknown; c.len()]).collect::<Vec<_>>());
    let ([mut cut_a, mut cut_b], [mut class_a, mut class_b]) = (cuts, classes);
    for cell in &arrangement.cells {
        let corners: Vec<u32> = cell.corners.iter().map(|&n| merges.find(n)).collect();
        let within = |t: &[u32; 3]| t.iter().all(|n| corners.contains(n));
        let place = |w: usize| work[w].binary_search_by_key(&cell.faces[w], |x| x.0);
        let (Ok(i), Ok(j)) = (place(0), place(1)) else { continue };
        let class = if cell.aligned { Class::Same } else { Class::Opposite };
        let mut kept = (vec![], vec![]);
        for (t, c) in cut_b[j].iter().zip(&class_b[j]) {
            if !within(t) {
                kept.0.push(*t);
                kept.1.push(*c);
            }
        }
        for (t, c) in cut_a[i].iter().zip(&mut class_a[i]) {
            if within(t) {
                *c = class;
                kept.0.push(if cell.aligned { *t } else { [t[0], t[2], t[1]] });
                kept.1.push(class);
            }
        }
        (cut_b[j], class_b[j]) = kept;
    }
    let flatten = |which: usize, cuts: &mut Vec<Cut>, classes: &mut Vec<Vec<Class>>| {
        let mut pieces = Pieces { starts: vec![0], ..Pieces::default() };
        for ((face, _), (cut, class)) in work[which].iter().zip(cuts.drain(..).zip(classes.drain(..))) {
            pieces.faces.push(*face);
            pieces.parents.extend(std::iter::repeat_n(*face, cut.len()));
            pieces.triangles.extend(cut);
            pieces.classes.extend(class);
            pieces.starts.push(pieces.triangles.len() as u32);
        }
        pieces
    };
    [flatten(0, &mut cut_a, &mut class_a), flatten(1, &mut cut_b, &mut class_b)]
}
