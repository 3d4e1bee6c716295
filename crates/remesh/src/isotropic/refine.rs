//! Long edges split in the middle, and nothing else.

use super::table::{LOCKED, NONE, Table};
use crate::Error;
use glam::DVec3;
use mesh_core::{Adjacency, FaceId, FaceOrigin, Faces, Origins, Positions, TriMesh, VertexId, VertexOrigin};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Splits edges until none is longer than `wanted` says of its middle; the boundary is kept. Only splits: every new
/// vertex is the middle of an edge, so the surface stays as it is and its vertices keep ids and bits.
///
/// Longer edges of the same faces are split first, which keeps angles; so some that are not too long are split too.
/// Lengths below `least` are taken as `least`, which bounds the work.
///
/// # Errors
/// [`Error::NotPositive`] for `least`.
pub fn refine<M: Faces + Positions + Sync>(
    mesh: &mesh_core::Connected<M>,
    wanted: &(dyn Fn(DVec3) -> f64 + Sync),
    least: f64,
) -> Result<(TriMesh, Origins), Error> {
    if !(least > 0.0 && least.is_finite()) {
        return Err(Error::NotPositive { name: "least length", value: least });
    }
    let mut work = Refined {
        table: Table::new(mesh),
        points: mesh.vertex_ids().map(|v| mesh.position(v)).collect(),
        origins: mesh.vertex_ids().map(|v| VertexOrigin::Input { part: 0, vertex: v }).collect(),
        parents: mesh.face_ids().map(|f| f.0).collect(),
        urged: vec![false; mesh.face_count()],
        length: vec![Length::Unknown; 3 * mesh.face_count()],
    };
    let mut due: BinaryHeap<Reverse<u32>> = (0..work.table.halfedge_count()).map(Reverse).collect();
    while !due.is_empty() {
        due = work.sweep(mesh, wanted, least, due);
    }
    let pieces = work.pieces(mesh.face_count());
    let corners = |f: usize| [0, 1, 2].map(|k| VertexId(work.table.tails[3 * f + k]));
    Ok((
        TriMesh { positions: work.points, faces: (0..work.parents.len()).map(corners).collect() },
        Origins { vertices: work.origins.into(), faces: pieces.into() },
    ))
}

struct Refined {
    table: Table,
    points: Vec<DVec3>,
    origins: Vec<VertexOrigin>,
    /// The input face that each face is a piece of.
    parents: Vec<u32>,
    /// Faces whose longest edge stands in the way of a split.
    urged: Vec<bool>,
    /// What is known of each halfedge.
    length: Vec<Length>,
}

/// Whether an edge is to be split.
#[derive(Clone, Copy, PartialEq)]
enum Length {
    Unknown,
    Short,
    Long,
}

impl Refined {
    /// Splits every edge among those `due` that is too long, or urged, and the longest of both its faces. Returns those to
    /// be looked at in the next sweep; none where nothing was done. A sweep goes through the halfedges in order; those
    /// that it changes behind itself wait for the next.
    fn sweep<M: Adjacency>(
        &mut self,
        mesh: &M,
        wanted: &(dyn Fn(DVec3) -> f64 + Sync),
        least: f64,
        mut due: BinaryHeap<Reverse<u32>>,
    ) -> BinaryHeap<Reverse<u32>> {
        let mut next = BinaryHeap::new();
        let mut done = false;
        while let Some(Reverse(h)) = due.pop() {
            if due.peek() == Some(&Reverse(h)) {
                continue;
            }
            let t = self.table.twin(h);
            if t == NONE || h > t || self.table.flags[h as usize] & LOCKED != 0 {
                continue;
            }
            let stands = [h, t].map(|h| self.is_longest(h));
            let urged = [h, t].into_iter().zip(stands).any(|(h, s)| s && self.urged[h as usize / 3]);
            if self.length[h as usize] == Length::Unknown && !urged {
                let long = self.is_too_long(h, wanted, least);
                self.length[h as usize] = if long { Length::Long } else { Length::Short };
            }
            if !urged && self.length[h as usize] != Length::Long {
                continue;
            }
            if stands == [true, true] {
                let appended = self.table.halfedge_count() / 3;
                if self.split(mesh, h) {
                    for f in [h / 3, t / 3, appended, appended + 1] {
                        self.look_at(f, h, &mut due, &mut next);
                    }
                    done = true;
                }
            } else {
                for (side, is_longest) in [h, t].into_iter().zip(stands) {
                    if !is_longest && !std::mem::replace(&mut self.urged[side as usize / 3], true) {
                        self.look_at(side / 3, h, &mut due, &mut next);
                        done = true;
                    }
                }
                next.push(Reverse(h));
            }
        }
        if done { next } else { BinaryHeap::new() }
    }

    /// Makes the edges of a face due: in this sweep if they come after `h`, else in the next. The lower halfedge stands for an
    /// edge.
    fn look_at(&self, face: u32, h: u32, due: &mut BinaryHeap<Reverse<u32>>, next: &mut BinaryHeap<Reverse<u32>>) {
        for k in 3 * face..3 * face + 3 {
            let k = k.min(self.table.twin(k));
            if k > h { due.push(Reverse(k)) } else { next.push(Reverse(k)) }
        }
    }

    fn is_too_long(&self, h: u32, wanted: &(dyn Fn(DVec3) -> f64 + Sync), least: f64) -> bool {
        let length = self.length_squared(h).sqrt();
        let [a, b] = [self.table.tail(h), self.table.head(h)].map(|v| self.points[v as usize]);
        // The closure may be dear: short edges need not ask it.
        length > least && length > wanted(0.5 * (a + b)).max(least)
    }

    fn length_squared(&self, h: u32) -> f64 {
        let [a, b] = [self.table.tail(h), self.table.head(h)].map(|v| self.points[v as usize]);
        a.distance_squared(b)
    }

    fn is_longest(&self, h: u32) -> bool {
        let length = self.length_squared(h);
        length >= self.length_squared(super::table::next(h)) && length >= self.length_squared(super::table::prev(h))
    }

    /// Splits an edge in the middle; false where rounding leaves no middle.
    fn split<M: Adjacency>(&mut self, mesh: &M, h: u32) -> bool {
        let t = self.table.twin(h);
        let (a, b, parent) = (self.table.tail(h) as usize, self.table.head(h) as usize, self.parents[h as usize / 3]);
        let middle = 0.5 * (self.points[a] + self.points[b]);
        if middle == self.points[a] || middle == self.points[b] {
            return false;
        }
        let corners = mesh.corners(FaceId(parent));
        let [u, v] = [a, b].map(|v| self.origins[v].barycentric(corners).unwrap_or([1.0, 0.0, 0.0]));
        let mean = [0, 1, 2].map(|k| 0.5 * (u[k] + v[k]));
        self.origins.push(match mean.iter().position(|&w| w == 0.0) {
            Some(k) => {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                VertexOrigin::Edge { part: 0, ends: [corners[i], corners[j]], t: mean[j] }
            }
            None => VertexOrigin::Face { part: 0, face: FaceId(parent), barycentric: mean },
        });
        self.points.push(middle);
        self.table.split(h);
        // The table appends one face on either side, that of `h` first.
        for side in [h, t] {
            self.parents.push(self.parents[side as usize / 3]);
            self.urged[side as usize / 3] = false;
            self.urged.push(false);
            self.length.extend([Length::Unknown; 3]);
            let changed = 3 * (side / 3) as usize;
            self.length[changed..changed + 3].fill(Length::Unknown);
        }
        true
    }

    fn pieces(&self, whole: usize) -> Vec<FaceOrigin> {
        let mut split = vec![false; whole];
        self.parents[whole..].iter().for_each(|&f| split[f as usize] = true);
        let origin = |&f: &u32| {
            let face = FaceId(f);
            if split[f as usize] { FaceOrigin::Piece { part: 0, face } } else { FaceOrigin::Input { part: 0, face } }
        };
        self.parents.iter().map(origin).collect()
    }
}
