//! The editable corner table: split, collapse and flip on an oriented 2-manifold whose boundary stays as it is.

use mesh_core::{Adjacency, HalfedgeId};

/// No halfedge, no vertex.
pub(crate) const NONE: u32 = u32::MAX;

/// The edge is part of a feature polyline: split and collapsed along it, never flipped.
pub(crate) const FEATURE: u8 = 1;
/// The edge is not edited at all: boundary, or the border of a frozen face.
pub(crate) const LOCKED: u8 = 2;

/// Next halfedge around the same triangle.
#[inline]
pub(crate) const fn next(h: u32) -> u32 {
    HalfedgeId(h).next().0
}

/// Previous halfedge around the same triangle.
#[inline]
pub(crate) const fn prev(h: u32) -> u32 {
    HalfedgeId(h).prev().0
}

/// Halfedge `h = 3·face + corner`; dead faces have [`NONE`] for corners. Slots of dead faces are used again, vertex ids
/// are not.
pub(crate) struct Table {
    /// The vertex each halfedge leaves.
    pub tails: Vec<u32>,
    pub twins: Vec<u32>,
    /// [`FEATURE`] and [`LOCKED`], the same on both halfedges of an edge.
    pub flags: Vec<u8>,
    /// One halfedge leaving each vertex, the boundary one if there is one; [`NONE`] for vertices without a face.
    pub out: Vec<u32>,
    /// How many edges meet at each vertex.
    pub valence: Vec<u32>,
    dead: Vec<u32>,
}

impl Table {
    pub fn new<M: Adjacency>(mesh: &M) -> Self {
        let halfedges = || (0..3 * mesh.face_count() as u32).map(HalfedgeId);
        let twins: Vec<u32> = halfedges().map(|h| mesh.twin(h).map_or(NONE, |t| t.0)).collect();
        let mut valence = vec![0; mesh.vertex_count()];
        for h in halfedges() {
            valence[mesh.tail(h).index()] += 1;
            if twins[h.index()] == NONE {
                valence[mesh.head(h).index()] += 1;
            }
        }
        Self {
            tails: mesh.face_ids().flat_map(|f| mesh.corners(f)).map(|v| v.0).collect(),
            flags: twins.iter().map(|&t| if t == NONE { LOCKED } else { 0 }).collect(),
            out: mesh.vertex_ids().map(|v| mesh.outgoing(v).map_or(NONE, |h| h.0)).collect(),
            twins,
            valence,
            dead: vec![],
        }
    }

    #[inline]
    pub fn tail(&self, h: u32) -> u32 {
        self.tails[h as usize]
    }

    #[inline]
    pub fn head(&self, h: u32) -> u32 {
        self.tails[next(h) as usize]
    }

    #[inline]
    pub fn twin(&self, h: u32) -> u32 {
        self.twins[h as usize]
    }

    /// The vertex of the triangle of `h` that is not on `h`.
    #[inline]
    pub fn apex(&self, h: u32) -> u32 {
        self.tails[prev(h) as usize]
    }

    #[inline]
    pub fn is_alive(&self, h: u32) -> bool {
        self.tails[h as usize] != NONE
    }

    /// Whether an edge may be edited and this is the first of its halfedges.
    #[inline]
    pub fn is_editable(&self, h: u32) -> bool {
        let t = self.twin(h);
        t != NONE && h < t && self.is_alive(h) && self.flags[h as usize] & LOCKED == 0
    }

    /// The ends of an edge, then the corners across.
    #[inline]
    pub fn diamond(&self, h: u32) -> [u32; 4] {
        [self.tail(h), self.head(h), self.apex(h), self.apex(self.twin(h))]
    }

    #[inline]
    pub fn is_boundary(&self, v: u32) -> bool {
        let h = self.out[v as usize];
        h == NONE || self.twin(h) == NONE
    }

    pub fn halfedge_count(&self) -> u32 {
        self.tails.len() as u32
    }

    pub fn vertex_count(&self) -> u32 {
        self.out.len() as u32
    }

    pub fn live_faces(&self) -> usize {
        self.tails.len() / 3 - self.dead.len()
    }

    /// The halfedges that leave `v`, counter-clockwise, one per triangle.
    #[inline]
    pub fn ring(&self, v: u32) -> Ring<'_> {
        let start = self.out[v as usize];
        Ring { table: self, start, next: start }
    }

    /// The neighbours of `v`, counter-clockwise.
    #[inline]
    pub fn neighbours(&self, v: u32) -> impl Iterator<Item = u32> + '_ {
        let last = self.ring(v).last().filter(|&h| self.twin(prev(h)) == NONE).map(|h| self.apex(h));
        self.ring(v).map(|h| self.head(h)).chain(last)
    }

    /// The halfedge from `a` to `b`, or from `b` to `a` on the boundary.
    pub fn between(&self, a: u32, b: u32) -> Option<u32> {
        self.ring(a).find_map(|h| {
            if self.head(h) == b {
                Some(h)
            } else if self.apex(h) == b {
                Some(prev(h))
            } else {
                None
            }
        })
    }

    fn link(&mut self, h: u32, t: u32, flags: u8) {
        for (h, t) in [(h, t), (t, h)] {
            if h != NONE {
                self.twins[h as usize] = t;
                self.flags[h as usize] = flags;
            }
        }
    }

    fn set_face(&mut self, f: u32, corners: [u32; 3]) {
        self.tails[3 * f as usize..][..3].copy_from_slice(&corners);
    }

    fn new_face(&mut self) -> u32 {
        self.dead.pop().unwrap_or_else(|| {
            self.tails.extend([NONE; 3]);
            self.twins.extend([NONE; 3]);
            self.flags.extend([0; 3]);
            (self.tails.len() / 3 - 1) as u32
        })
    }

    /// Puts a new vertex on the inner edge of `h` and returns it.
    pub fn split(&mut self, h: u32) -> u32 {
        let t = self.twin(h);
        let flags = self.flags[h as usize];
        let m = self.vertex_count();
        self.out.push(NONE);
        self.valence.push(4);
        let (f, g) = (self.new_face(), self.new_face());
        for (h, new) in [(h, f), (t, g)] {
            // `h`, from u to v, ends at m now; its other half bounds the new face (m, v, w).
            let (v, w, side) = (self.head(h), self.apex(h), next(h));
            let (outer, outer_flags) = (self.twin(side), self.flags[side as usize]);
            self.set_face(new, [m, v, w]);
            self.link(3 * new + 1, outer, outer_flags);
            if self.out[v as usize] == side {
                self.out[v as usize] = 3 * new + 1;
            }
            self.link(3 * new + 2, side, 0);
            self.valence[w as usize] += 1;
        }
        self.tails[next(h) as usize] = m;
        self.tails[next(t) as usize] = m;
        self.link(h, 3 * g, flags);
        self.link(t, 3 * f, flags);
        self.out[m as usize] = 3 * f;
        m
    }

    /// Turns the inner edge of `h` inside its two triangles.
    pub fn flip(&mut self, h: u32) {
        let t = self.twin(h);
        let (a, b, c, d) = (self.tail(h), self.tail(t), self.apex(h), self.apex(t));
        let (f, g) = (h / 3, t / 3);
        let outer = |table: &Self, h: u32| (h, table.twin(h), table.flags[h as usize]);
        let (bc, ca) = (outer(self, next(h)), outer(self, prev(h)));
        let (ad, db) = (outer(self, next(t)), outer(self, prev(t)));
        self.set_face(f, [c, a, d]);
        self.set_face(g, [d, b, c]);
        let slots = [(ca, 3 * f), (ad, 3 * f + 1), (db, 3 * g), (bc, 3 * g + 1)];
        // Read before any is written: the new slots are the old ones in another order.
        let outs = [c, a, d, b].map(|v| self.out[v as usize]);
        for (v, out, (old, slot)) in [
            (c, outs[0], (ca.0, 3 * f)),
            (a, outs[1], (ad.0, 3 * f + 1)),
            (d, outs[2], (db.0, 3 * g)),
            (b, outs[3], (bc.0, 3 * g + 1)),
        ] {
            if out == old {
                self.out[v as usize] = slot;
            }
        }
        for (v, out, removed, slot) in [(a, outs[1], h, 3 * f + 1), (b, outs[3], t, 3 * g + 1)] {
            if out == removed {
                self.out[v as usize] = slot;
            }
        }
        for ((_, twin, flags), slot) in slots {
            self.link(slot, twin, flags);
        }
        self.link(3 * f + 2, 3 * g + 2, 0);
        for (v, by) in [(a, -1), (b, -1), (c, 1), (d, 1)] {
            self.valence[v as usize] = self.valence[v as usize].wrapping_add_signed(by);
        }
    }

    /// Whether `h` can be collapsed without pinching the surface: the ends share two neighbours only, and its tail is
    /// inside the surface.
    pub fn collapses_cleanly(&self, h: u32) -> bool {
        let (u, v, w, x) = (self.tail(h), self.head(h), self.apex(h), self.apex(self.twin(h)));
        if self.is_boundary(u) || self.valence[w as usize] <= 3 || self.valence[x as usize] <= 3 || w == x {
            return false;
        }
        let of_v = |n: u32| self.neighbours(v).any(|m| m == n);
        self.ring(u).map(|h| self.head(h)).all(|n| n == v || n == w || n == x || !of_v(n))
    }

    /// Merges the tail of `h` into its head. [`Table::collapses_cleanly`] must hold.
    pub fn collapse(&mut self, h: u32) {
        let t = self.twin(h);
        let (u, v, w, x) = (self.tail(h), self.head(h), self.apex(h), self.apex(t));
        let mut ring = h;
        loop {
            self.tails[ring as usize] = v;
            ring = self.twin(prev(ring));
            if ring == h {
                break;
            }
        }
        let (hn, hp, tn, tp) = (next(h), prev(h), next(t), prev(t));
        let (wv, vw, vx, xv) = (self.twin(hn), self.twin(hp), self.twin(tp), self.twin(tn));
        // `hn` and `tp` may be boundary edges of v, which those of u become then.
        for (of_v, of_u, flags) in [
            (wv, vw, self.flags[hn as usize] | self.flags[hp as usize]),
            (vx, xv, self.flags[tp as usize] | self.flags[tn as usize]),
        ] {
            self.link(of_u, of_v, flags);
        }
        for (vertex, gone, instead) in [(w, hp, wv), (v, hn, vw), (v, t, vw), (x, tp, xv)] {
            if self.out[vertex as usize] == gone {
                self.out[vertex as usize] = instead;
            }
        }
        self.valence[w as usize] -= 1;
        self.valence[x as usize] -= 1;
        self.valence[v as usize] = self.valence[v as usize] + self.valence[u as usize] - 4;
        self.valence[u as usize] = 0;
        self.out[u as usize] = NONE;
        for f in [h / 3, t / 3] {
            self.set_face(f, [NONE; 3]);
            self.dead.push(f);
        }
    }
}

/// Turns around a vertex; see [`Table::ring`].
pub(crate) struct Ring<'a> {
    table: &'a Table,
    start: u32,
    next: u32,
}

impl Iterator for Ring<'_> {
    type Item = u32;
    #[inline]
    fn next(&mut self) -> Option<u32> {
        if self.next == NONE {
            return None;
        }
        let here = self.next;
        let after = self.table.twin(prev(here));
        self.next = if after == self.start { NONE } else { after };
        Some(here)
    }
}
