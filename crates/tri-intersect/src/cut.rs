//! Cuts every crossed face along its segments. Nodes that rounding brought too close are merged until all faces can be
//! triangulated without folding.

use crate::arrange::{Arrangement, Part};
use crate::error::Error;
use crate::predicate::{facing, project};
use crate::triangulate::{Conflict, Triangulator};
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

/// What rounding forced: nodes that became one, and edges that were led through a node.
pub(crate) struct Snaps {
    first: u32,
    into: Vec<u32>,
    /// (edge, node), in order; nodes as they are after merging.
    bends: Vec<([u32; 2], u32)>,
    /// How often, and the first node.
    pub count: usize,
    pub example: Option<u32>,
}

impl Snaps {
    pub(crate) fn new(arrangement: &Arrangement) -> Self {
        let first = arrangement.counts[0] + arrangement.counts[1];
        let into = (first..first + arrangement.places.len() as u32).collect();
        Self { first, into, bends: vec![], count: 0, example: None }
    }

    pub(crate) fn find(&self, mut node: u32) -> u32 {
        while node >= self.first && self.into[(node - self.first) as usize] != node {
            node = self.into[(node - self.first) as usize];
        }
        node
    }

    /// Merges two nodes into the lower one. False if both are input vertices, which must not move, or already one.
    pub(crate) fn join(&mut self, x: u32, y: u32) -> bool {
        let (x, y) = (self.find(x), self.find(y));
        let (low, high) = (x.min(y), x.max(y));
        if low == high || high < self.first {
            return false;
        }
        self.into[(high - self.first) as usize] = low;
        self.note(low);
        let bends = std::mem::take(&mut self.bends);
        for ([p, q], via) in bends {
            self.insert(p, q, via);
        }
        true
    }

    /// Leads the edge between two nodes through a third. False if it goes there already.
    pub(crate) fn bend(&mut self, p: u32, q: u32, via: u32) -> bool {
        self.note(via);
        self.insert(p, q, via)
    }

    fn note(&mut self, node: u32) {
        self.count += 1;
        self.example = self.example.or(Some(node));
    }

    fn insert(&mut self, p: u32, q: u32, via: u32) -> bool {
        let (p, q, via) = (self.find(p), self.find(q), self.find(via));
        let edge = [p.min(q), p.max(q)];
        let place = self.bends.partition_point(|b| b.0 < edge);
        if p == q || via == p || via == q || self.bends.get(place).is_some_and(|b| b.0 == edge) {
            return false;
        }
        self.bends.insert(place, (edge, via));
        true
    }

    /// Hands out the nodes through which the edge from `p` to `q` goes, in order, without its ends.
    pub(crate) fn between(&self, p: u32, q: u32, depth: u32, visit: &mut impl FnMut(u32)) {
        if self.bends.is_empty() || depth > 20 {
            return;
        }
        if let Ok(i) = self.bends.binary_search_by_key(&[p.min(q), p.max(q)], |b| b.0) {
            let via = self.bends[i].1;
            self.between(p, via, depth + 1, visit);
            visit(via);
            self.between(via, q, depth + 1, visit);
        }
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
    pairs: Vec<[u32; 2]>,
}

type Cut = Vec<[u32; 3]>;

/// Cuts both parts, snapping what rounding brought too close.
pub(crate) fn cut(parts: &[Part; 2], arrangement: &Arrangement, snaps: &mut Snaps) -> Result<[Pieces; 2], Error> {
    let mut work = [0, 1].map(|which| crossed_faces(parts, arrangement, which));
    for _ in 0..ROUNDS {
        let results: [Vec<Result<Cut, Conflict>>; 2] = [0, 1].map(|which| {
            work[which]
                .par_iter()
                .map_init(Workspace::default, |space, (face, segments)| {
                    cut_face(parts, arrangement, snaps, which, *face, segments, space)
                })
                .collect()
        });
        let mut failures = vec![];
        for which in 0..2 {
            let failed = results[which].iter().zip(&work[which]);
            failures.extend(failed.filter_map(|(r, w)| r.as_ref().err().map(|&c| (which, w.0, c))));
        }
        if failures.is_empty() {
            let cuts = results.map(|r| r.into_iter().map(Result::unwrap_or_default).collect::<Vec<Cut>>());
            return Ok(gather(arrangement, snaps, &work, cuts));
        }
        let mut progress = false;
        for (which, face, conflict) in failures {
            progress |= match conflict {
                Conflict::Merge(x, y) => snaps.join(x, y),
                Conflict::Bend { edge: [p, q], via } => {
                    widen(parts, arrangement, &mut work[which], which, face, [p, q]);
                    snaps.bend(p, q, via)
                }
                Conflict::Crossing(x) => return Err(Error::Rounding { at: arrangement.position(parts, x) }),
            };
        }
        if !progress {
            break;
        }
    }
    Err(Error::Rounding { at: arrangement.position(parts, snaps.example.unwrap_or(0)) })
}

/// If an edge to be bent is a whole side of `face`, the face across must be cut too.
fn widen(
    parts: &[Part; 2],
    arrangement: &Arrangement,
    work: &mut Vec<(u32, Vec<u32>)>,
    which: usize,
    face: u32,
    ends: [u32; 2],
) {
    let mesh = parts[which].mesh;
    let corners = mesh.corners(FaceId(face)).map(|v| arrangement.node(which, v));
    let Some(k) = (0..3).find(|&k| ends.contains(&corners[k]) && ends.contains(&corners[(k + 1) % 3])) else { return };
    let Some(across) = mesh.twin(HalfedgeId::new(FaceId(face), k)).map(|t| t.face().0) else { return };
    if let Err(place) = work.binary_search_by_key(&across, |w| w.0) {
        work.insert(place, (across, vec![]));
    }
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
    snaps: &Snaps,
    which: usize,
    face: u32,
    segments: &[u32],
    space: &mut Workspace,
) -> Result<Cut, Conflict> {
    let mesh = parts[which].mesh;
    let corners = mesh.corners(FaceId(face)).map(|v| arrangement.node(which, v));
    let Workspace { triangulator, nodes, index, xy, sides, inner, ends, constraints, pairs } = space;
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
            if node != *nodes.last().unwrap_or(&from) && node != to && node != from {
                sides[k].push(nodes.len() as u32);
                nodes.push(node);
            }
        };
        let mut reach = |node: u32| {
            let node = snaps.find(node);
            snaps.between(last, node, 0, &mut push);
            push(node);
            last = node;
        };
        if edge.0 == h.0 {
            for e in along {
                reach(e.1);
            }
        } else {
            for e in along.iter().rev() {
                reach(e.1);
            }
        }
        reach(to);
    }
    let border = nodes.len();
    ends.clear();
    pairs.clear();
    for &s in segments {
        let [p, q] = arrangement.segments[s as usize].ends.map(|n| snaps.find(n));
        let mut last = p;
        ends.push(p);
        let mut reach = |node: u32| {
            if node != last {
                ends.push(node);
                pairs.push([last.min(node), last.max(node)]);
                last = node;
            }
        };
        snaps.between(p, q, 0, &mut reach);
        reach(q);
    }
    ends.sort_unstable();
    ends.dedup();
    if ends.iter().all(|n| corners.contains(n)) && border == 3 {
        return Ok(vec![corners]);
    }
    index.clear();
    index.extend(nodes.iter().enumerate().map(|(i, &n)| (n, i as u32)));
    index.sort_unstable();
    if let Some(twice) = index.windows(2).find(|w| w[0].0 == w[1].0) {
        return Err(Conflict::Crossing(twice[0].0));
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
    let local = |n: u32| index.binary_search_by_key(&n, |e| e.0).map_or(0, |i| index[i].1);
    constraints.clear();
    constraints.extend(pairs.iter().map(|pair| {
        let [p, q] = pair.map(local);
        [p.min(q), p.max(q)]
    }));
    constraints.sort_unstable();
    constraints.dedup();
    let Some((axis, way)) = facing(&parts[which].triangle(face)) else { return Err(Conflict::Crossing(corners[0])) };
    xy.clear();
    xy.extend(nodes.iter().map(|&n| {
        let [x, y] = project(axis, arrangement.scaled_position(parts, n));
        if way > 0 { [x, y] } else { [y, x] }
    }));
    let mut out = vec![];
    let node = |i: u32| nodes[i as usize];
    triangulator.run(xy, sides, inner, constraints, arrangement.grain, &mut out).map_err(
        |conflict| match conflict {
            Conflict::Merge(i, j) => Conflict::Merge(node(i), node(j)),
            Conflict::Bend { edge, via } => Conflict::Bend { edge: edge.map(node), via: node(via) },
            Conflict::Crossing(i) => Conflict::Crossing(node(i)),
        },
    )?;
    Ok(out.into_iter().map(|t| t.map(node)).collect())
}

/// Flattens the cuts, and gives coplanar cells the same triangles in both parts.
fn gather(
    arrangement: &Arrangement,
    snaps: &Snaps,
    work: &[Vec<(u32, Vec<u32>)>; 2],
    cuts: [Vec<Cut>; 2],
) -> [Pieces; 2] {
    let classes = [0, 1].map(|w| cuts[w].iter().map(|c| vec![Class::Unknown; c.len()]).collect::<Vec<_>>());
    let ([mut cut_a, mut cut_b], [mut class_a, mut class_b]) = (cuts, classes);
    let mut bent = vec![];
    for cell in &arrangement.cells {
        let mut corners: Vec<u32> = cell.corners.iter().map(|&n| snaps.find(n)).collect();
        for i in 1..cell.corners.len() {
            for j in 0..i {
                snaps.between(corners[i], corners[j], 0, &mut |via| bent.push(via));
            }
        }
        corners.append(&mut bent);
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
