//! A surface while it is remeshed: topology, points, and what each vertex may do.

use super::agenda::Agenda;
use super::lines::Lines;
use super::table::{FEATURE, NONE, Table, next, prev};
use glam::DVec3;
use mesh_core::{EditObserver, VertexId};

/// What a vertex may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    /// Move over the surface.
    Free,
    /// Slide along its feature polyline.
    Line,
    /// Nothing.
    Fixed,
}

/// Edges longer than this share of the wanted length are split. \[BotschKobbelt2004\]
const SPLIT: f64 = 4.0 / 3.0;
/// Edges shorter than this share of the wanted length are collapsed. \[BotschKobbelt2004\]
const COLLAPSE: f64 = 4.0 / 5.0;
/// The least cosine between the normals of a face before and after an edit.
pub(crate) const TURN: f64 = 0.3;

pub(crate) struct State<'a, O> {
    pub table: Table,
    pub points: Vec<DVec3>,
    pub kinds: Vec<Kind>,
    /// Wanted edge length at each vertex.
    pub sizes: Vec<f64>,
    /// Wanted valence of each vertex.
    pub targets: Vec<u8>,
    /// A face of the input near each vertex.
    pub seats: Vec<u32>,
    pub lines: Lines,
    pub observer: &'a mut O,
}

impl<O> State<'_, O> {
    #[inline]
    pub fn point(&self, v: u32) -> DVec3 {
        self.points[v as usize]
    }

    #[inline]
    pub fn kind(&self, v: u32) -> Kind {
        self.kinds[v as usize]
    }
}

impl<O: EditObserver> State<'_, O> {
    fn may_edit(&self, h: u32) -> bool {
        self.observer.may_edit(VertexId(self.table.tail(h)), VertexId(self.table.head(h)))
    }

    /// The editable edges whose squared relative length is as wanted.
    fn edges_where(&self, wanted: impl Fn(f64) -> bool + Sync) -> Agenda {
        let (table, points, sizes) = (&self.table, &self.points, &self.sizes);
        let is_worth = |h| table.is_editable(h) && wanted(relative_length_squared(table, points, sizes, h));
        Agenda::of(table.halfedge_count(), is_worth)
    }

    /// Splits edges in the middle until none is too long. Returns how many splits there were.
    pub fn split_long(&mut self, max_faces: usize) -> usize {
        let mut splits = 0;
        let mut agenda = self.edges_where(|squared| squared > SPLIT * SPLIT);
        while let Some(first) = agenda.take(0) {
            let mut next = Some(first);
            while let Some(h) = next {
                if self.table.is_editable(h)
                    && relative_length_squared(&self.table, &self.points, &self.sizes, h) > SPLIT * SPLIT
                    && self.is_longest(h)
                    && self.may_edit(h)
                    && self.table.live_faces() + 2 <= max_faces
                    && let Some(middle) = self.split(h)
                {
                    splits += 1;
                    self.look_around(middle, &mut agenda);
                }
                next = agenda.take(h + 1);
            }
        }
        splits
    }

    /// Whatever has a triangle at `v` may have changed.
    fn look_around(&self, v: u32, agenda: &mut Agenda) {
        for h in self.table.ring(v) {
            // The other spokes are the last sides of these triangles.
            let rim = next(h);
            for h in [h, rim, prev(h), self.table.twin(rim)].into_iter().filter(|&h| h != NONE) {
                agenda.add(h);
            }
        }
    }

    /// Whether no other edge of its two triangles is longer. Splitting such an edge makes none as long, so that splits
    /// come to an end, whatever edges may not be split.
    fn is_longest(&self, h: u32) -> bool {
        let [a, b, c, d] = self.table.diamond(h).map(|v| self.point(v));
        let length = a.distance_squared(b);
        [c, d].into_iter().all(|p| p.distance_squared(a) <= length && p.distance_squared(b) <= length)
    }

    /// Splits an edge and returns the new vertex, unless its middle is one of its ends.
    fn split(&mut self, h: u32) -> Option<u32> {
        let (a, b) = (self.table.tail(h), self.table.head(h));
        let feature = self.table.flags[h as usize] & FEATURE != 0;
        let middle = 0.5 * (self.point(a) + self.point(b));
        if middle == self.point(a) || middle == self.point(b) {
            return None;
        }
        let (kind, place) = if feature {
            (Kind::Line, self.lines.insert(a, b, self.table.vertex_count(), middle))
        } else {
            (Kind::Free, middle)
        };
        let m = self.table.split(h);
        self.points.push(place);
        self.kinds.push(kind);
        self.sizes.push(0.5 * (self.sizes[a as usize] + self.sizes[b as usize]));
        self.targets.push(6);
        self.seats.push(self.seats[a as usize]);
        self.observer.split(VertexId(a), VertexId(b), 0.5, VertexId(m));
        Some(m)
    }

    /// Collapses edges that are too short where that makes none too long and turns no face. Returns how many.
    pub fn collapse_short(&mut self) -> usize {
        let mut collapses = 0;
        let mut agenda = self.edges_where(|squared| squared < COLLAPSE * COLLAPSE);
        let mut next = agenda.take(0);
        while let Some(h) = next {
            if self.table.is_editable(h)
                && relative_length_squared(&self.table, &self.points, &self.sizes, h) < COLLAPSE * COLLAPSE
                && self.may_edit(h)
            {
                let [a, b, ..] = self.table.diamond(h);
                if self.collapse(h) || self.collapse(self.table.twin(h)) {
                    collapses += 1;
                    // One of them is no more and has no edges.
                    self.look_around(a, &mut agenda);
                    self.look_around(b, &mut agenda);
                }
            }
            next = agenda.take(h + 1);
        }
        collapses
    }

    /// Merges the tail of `h` into its head, if that is sound.
    fn collapse(&mut self, h: u32) -> bool {
        let t = self.table.twin(h);
        let (u, v) = (self.table.tail(h), self.table.head(h));
        let feature = self.table.flags[h as usize] & FEATURE != 0;
        let allowed = match (self.kind(u), self.kind(v)) {
            (Kind::Free, _) => true,
            (Kind::Line, Kind::Line | Kind::Fixed) => feature,
            _ => false,
        };
        // The edges that vanish beside it must not be kept ones.
        let beside = [prev(h), next(t)].map(|h| self.table.flags[h as usize]);
        if !allowed || beside != [0, 0] || !self.table.collapses_cleanly(h) {
            return false;
        }
        let (place, slid) = match (self.kind(u), self.kind(v)) {
            (Kind::Free, Kind::Free) => (0.5 * (self.point(u) + self.point(v)), None),
            (Kind::Line, Kind::Line) => {
                let Some((s, place)) = self.lines.between(u, v) else { return false };
                (place, Some(s))
            }
            _ => (self.point(v), None),
        };
        if !self.collapse_fits(h, place) {
            return false;
        }
        if self.kind(u) == Kind::Line {
            self.lines.remove(u, v, slid);
        }
        self.table.collapse(h);
        self.points[v as usize] = place;
        if self.kind(v) == Kind::Free {
            self.sizes[v as usize] = 0.5 * (self.sizes[u as usize] + self.sizes[v as usize]);
        }
        self.observer.collapse(VertexId(u), VertexId(v));
        true
    }

    /// Whether both ends of `h` can move to `place` with no edge too long and no face turned or flattened.
    fn collapse_fits(&self, h: u32, place: DVec3) -> bool {
        let (u, v) = (self.table.tail(h), self.table.head(h));
        let wanted = 0.5 * (self.sizes[u as usize] + self.sizes[v as usize]);
        [(u, v), (v, u)].into_iter().all(|(moved, other)| {
            let old = self.point(moved);
            if moved == v && place == old {
                return true;
            }
            self.table.ring(moved).all(|ring| {
                let (b, c) = (self.table.head(ring), self.table.apex(ring));
                if b == other || c == other {
                    return true;
                }
                let (pb, pc) = (self.point(b), self.point(c));
                let longest = SPLIT * 0.5 * (wanted + self.sizes[b as usize]);
                place.distance_squared(pb) <= longest * longest && keeps_side([old, pb, pc], [place, pb, pc])
            })
        })
    }

    /// Flips edges while that brings valences nearer to what is wanted. Returns how many flips there were.
    pub fn flip_to_valence(&mut self) -> usize {
        let mut flips = 0;
        let (table, points, targets) = (&self.table, &self.points, &self.targets);
        let mut agenda = Agenda::of(table.halfedge_count(), |h| flip_pays(table, points, targets, h));
        // Every flip lowers the sum of squared deviations, so that this ends by itself; later sweeps find little.
        for _ in 0..4 {
            let mut next = agenda.take(0);
            while let Some(h) = next {
                if flip_pays(&self.table, &self.points, &self.targets, h) && self.may_edit(h) && self.flip_fits(h) {
                    let diamond = self.table.diamond(h);
                    let [a, b, c, d] = diamond.map(VertexId);
                    self.table.flip(h);
                    self.observer.flip(a, b, c, d);
                    flips += 1;
                    for v in diamond {
                        self.look_around(v, &mut agenda);
                    }
                }
                next = agenda.take(h + 1);
            }
        }
        flips
    }

    fn flip_fits(&self, h: u32) -> bool {
        let [a, b, c, d] = self.table.diamond(h);
        let fewest = |v: u32| self.table.valence[v as usize] > if self.table.is_boundary(v) { 2 } else { 3 };
        if c == d || !fewest(a) || !fewest(b) || self.table.between(c, d).is_some() {
            return false;
        }
        let [pa, pb, pc, pd] = [a, b, c, d].map(|v| self.point(v));
        let old = [[pa, pb, pc], [pb, pa, pd]];
        [[pc, pa, pd], [pd, pb, pc]].into_iter().all(|new| old.into_iter().all(|old| keeps_side(old, new)))
    }
}

/// Squared length of an edge over the squared wanted length.
#[inline]
fn relative_length_squared(table: &Table, points: &[DVec3], sizes: &[f64], h: u32) -> f64 {
    let (a, b) = (table.tail(h) as usize, table.head(h) as usize);
    let wanted = 0.5 * (sizes[a] + sizes[b]);
    points[a].distance_squared(points[b]) / (wanted * wanted)
}

/// Whether a flip brings valences nearer to the wanted ones, or leaves them as they are and opens angles.
#[inline]
fn flip_pays(table: &Table, points: &[DVec3], targets: &[u8], h: u32) -> bool {
    if !table.is_editable(h) || table.flags[h as usize] != 0 {
        return false;
    }
    let diamond = table.diamond(h);
    let gain = valence_gain(table, targets, diamond);
    gain > 0 || gain == 0 && opens(diamond.map(|v| points[v as usize]))
}

/// How much the sum of squared deviations from the wanted valences falls when the first two corners lose an edge to the others.
#[inline]
fn valence_gain(table: &Table, targets: &[u8], [a, b, c, d]: [u32; 4]) -> i32 {
    let off = |v: u32| table.valence[v as usize].cast_signed() - i32::from(targets[v as usize]);
    // (x − 1)² − x² = 1 − 2x at the ends, (x + 1)² − x² = 1 + 2x at the others.
    2 * (off(a) + off(b) - off(c) - off(d)) - 4
}

/// Whether a flip makes the angles that face the edge clearly smaller.
fn opens([a, b, c, d]: [DVec3; 4]) -> bool {
    let cosine =
        |p: DVec3, q: DVec3, r: DVec3| (p - q).dot(r - q) / (p.distance_squared(q) * r.distance_squared(q)).sqrt();
    cosine(a, c, b) + cosine(a, d, b) < cosine(c, a, d) + cosine(c, b, d) - 0.1
}

/// Twice the area vector.
#[inline]
pub(crate) fn cross([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// Whether a triangle that becomes another neither turns over nor loses its area; a flat one may become anything.
#[inline]
pub(crate) fn keeps_side(old: [DVec3; 3], new: [DVec3; 3]) -> bool {
    let (m, n) = (cross(old), cross(new));
    if is_flat(old) {
        return !is_flat(new) || n.length_squared() >= m.length_squared();
    }
    !is_flat(new) && m.dot(n) >= TURN * (m.length_squared() * n.length_squared()).sqrt()
}

/// Whether a triangle is a hundred times longer than high, or more.
#[inline]
pub(crate) fn is_flat([a, b, c]: [DVec3; 3]) -> bool {
    let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
    // Twice the area over the squared longest side: 0.87 when equilateral.
    cross([a, b, c]).length_squared() <= 1e-4 * longest * longest
}
