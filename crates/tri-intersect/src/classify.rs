//! Which side of the other solid every face is on: decided exactly along the seam, then flooded.

use crate::arrange::{Arrangement, Part, Segment};
use crate::cut::{Class, Pieces, Snaps};
use crate::error::Error;
use crate::inside::winding;
use crate::predicate::side;
use glam::DVec3;
use mesh_core::{Adjacency, Bounds, FaceId, Faces, HalfedgeId};
use mesh_query::TriBvh;
use rayon::prelude::*;

/// The segments by their nodes, for look-up.
pub(crate) struct SeamTable {
    /// Edge (low, high), segment, and whether the segment runs from low to high.
    entries: Vec<([u32; 2], u32, bool)>,
}

impl SeamTable {
    pub(crate) fn new(arrangement: &Arrangement, snaps: &Snaps) -> Self {
        let mut entries: Vec<([u32; 2], u32, bool)> = Vec::with_capacity(arrangement.segments.len());
        for (i, s) in arrangement.segments.iter().enumerate() {
            let [p, q] = s.ends.map(|n| snaps.find(n));
            let mut last = p;
            let mut reach = |n: u32| {
                if n != last {
                    entries.push(([last.min(n), last.max(n)], i as u32, last < n));
                    last = n;
                }
            };
            snaps.between(p, q, 0, &mut reach);
            reach(q);
        }
        entries.par_sort_unstable();
        Self { entries }
    }

    fn segments(&self, p: u32, q: u32) -> &[([u32; 2], u32, bool)] {
        let key = [p.min(q), p.max(q)];
        let start = self.entries.partition_point(|e| e.0 < key);
        let end = start + self.entries[start..].iter().take_while(|e| e.0 == key).count();
        &self.entries[start..end]
    }
}

/// Everything about one part that the flood needs.
pub(crate) struct Flood<'a> {
    pub parts: &'a [Part<'a>; 2],
    pub arrangement: &'a Arrangement,
    pub seams: &'a SeamTable,
    pub which: usize,
}

/// Marks a face that was cut, in the array of face classes.
pub(crate) const CUT: u8 = 255;

impl Flood<'_> {
    /// `bounds` and `tree` are those of the other part. Sets the class of every piece, and returns one for every whole face: `Class` as a number, [`CUT`] for cut ones.
    pub(crate) fn run<'t>(
        &self,
        pieces: &mut Pieces,
        bounds: Bounds,
        tree: impl Fn() -> Option<&'t TriBvh>,
    ) -> Result<Vec<u8>, Error> {
        let mesh = self.parts[self.which].mesh;
        let mut faces = vec![Class::Unknown as u8; mesh.face_count()];
        pieces.faces.iter().for_each(|&f| faces[f as usize] = CUT);
        let edges = edges(pieces);
        let mut stack: Vec<Item> = self.seeds(pieces)?;
        self.spread(pieces, &mut faces, &edges, &mut stack)?;
        for f in 0..faces.len() {
            if faces[f] == Class::Unknown as u8 {
                let class = self.alone(FaceId::from(f), bounds, &tree);
                faces[f] = class as u8;
                stack.push(Item::Face(f as u32, class));
                self.spread(pieces, &mut faces, &edges, &mut stack)?;
            }
        }
        Ok(faces)
    }

    /// Classes that the seam itself decides.
    fn seeds(&self, pieces: &mut Pieces) -> Result<Vec<Item>, Error> {
        let decided: Vec<Option<Class>> = pieces
            .triangles
            .par_iter()
            .enumerate()
            .map(|(i, t)| {
                if pieces.classes[i] != Class::Unknown {
                    return Ok(None);
                }
                let mut class = None;
                for k in 0..3 {
                    let (u, v) = (t[k], t[(k + 1) % 3]);
                    let here = self.beside(pieces.parents[i], u, v);
                    if class.is_some() && here.is_some() && here != class {
                        return Err(self.tangled(u));
                    }
                    class = class.or(here);
                }
                Ok(class)
            })
            .collect::<Result<_, Error>>()?;
        let mut stack = vec![];
        for (i, class) in decided.into_iter().enumerate() {
            if let Some(class) = class {
                pieces.classes[i] = class;
                stack.push(Item::Piece(i as u32));
            }
        }
        Ok(stack)
    }

    /// The class of what lies left of the seam edge from `u` to `v` in `face`; `None` if it is no seam edge.
    fn beside(&self, face: u32, u: u32, v: u32) -> Option<Class> {
        let (mine, theirs) = (self.which, 1 - self.which);
        let mut met: [Option<(u32, i8)>; 2] = [None; 2];
        for &(_, s, rising) in self.seams.segments(u, v) {
            let s: &Segment<u32> = &self.arrangement.segments[s as usize];
            if s.faces[mine] != face {
                continue;
            }
            // Left of na × nb, face a is behind b and face b before a.
            let along = rising == (u < v);
            let left = if along == (mine == 0) { -1 } else { 1 };
            let slot = usize::from(met[0].is_some_and(|m| m.0 != s.faces[theirs]));
            met[slot] = Some((s.faces[theirs], if s.coplanar { 0 } else { left }));
        }
        let class = |inside: bool| Some(if inside { Class::Inside } else { Class::Outside });
        match met {
            [None, _] | [Some((_, 0)), None] => None,
            [Some((_, s)), None] => class(s < 0),
            [Some((f, s)), Some((g, t))] => {
                // Along an edge of the other part: its two faces form a wedge.
                let reflex = self.wedge(f, g);
                match (s, t) {
                    (0, 0) => None,
                    // In the plane of one face but not on it, so beyond the edge.
                    (0, _) | (_, 0) if reflex != 0 => class(reflex > 0),
                    (0, x) | (x, 0) => class(x < 0),
                    _ if reflex > 0 => class(s < 0 || t < 0),
                    _ => class(s < 0 && t < 0),
                }
            }
        }
    }

    /// +1 where two neighbouring faces of the other part form a reflex edge, −1 a convex one, 0 a flat one.
    fn wedge(&self, f: u32, g: u32) -> i8 {
        let other = &self.parts[1 - self.which];
        let corners = other.mesh.corners(FaceId(f));
        let apex = other.mesh.corners(FaceId(g)).into_iter().find(|v| !corners.contains(v));
        apex.map_or(0, |v| side(&other.triangle(f), other.points[v.index()]))
    }

    fn tangled(&self, node: u32) -> Error {
        Error::Tangled { part: 1 - self.which as u32, at: self.arrangement.position(self.parts, node) }
    }

    fn spread(
        &self,
        pieces: &mut Pieces,
        faces: &mut [u8],
        edges: &[([u32; 2], u32)],
        stack: &mut Vec<Item>,
    ) -> Result<(), Error> {
        let mesh = self.parts[self.which].mesh;
        while let Some(item) = stack.pop() {
            match item {
                Item::Face(f, class) => {
                    for k in 0..3 {
                        let h = HalfedgeId::new(FaceId(f), k);
                        let Some(t) = mesh.twin(h) else { continue };
                        let g = t.face();
                        match faces[g.index()] {
                            c if c == class as u8 => {}
                            CUT => {
                                let (u, v) = (mesh.tail(h), mesh.head(h));
                                let (u, v) =
                                    (self.arrangement.node(self.which, u), self.arrangement.node(self.which, v));
                                if self.seams.segments(u, v).is_empty() {
                                    self.enter(pieces, edges, [u, v], class, stack)?;
                                }
                            }
                            c if c == Class::Unknown as u8 => {
                                faces[g.index()] = class as u8;
                                stack.push(Item::Face(g.0, class));
                            }
                            _ => return Err(self.tangled(self.arrangement.node(self.which, mesh.tail(h)))),
                        }
                    }
                }
                Item::Piece(i) => {
                    let (t, class) = (pieces.triangles[i as usize], pieces.classes[i as usize]);
                    for k in 0..3 {
                        let (u, v) = (t[k], t[(k + 1) % 3]);
                        if !self.seams.segments(u, v).is_empty() {
                            continue;
                        }
                        self.enter(pieces, edges, [u, v], class, stack)?;
                        self.leave(pieces.parents[i as usize], u, v, class, faces, stack)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Gives a class to the pieces at an edge.
    fn enter(
        &self,
        pieces: &mut Pieces,
        edges: &[([u32; 2], u32)],
        [u, v]: [u32; 2],
        class: Class,
        stack: &mut Vec<Item>,
    ) -> Result<(), Error> {
        let key = [u.min(v), u.max(v)];
        let start = edges.partition_point(|e| e.0 < key);
        for &(_, j) in edges[start..].iter().take_while(|e| e.0 == key) {
            let there = &mut pieces.classes[j as usize];
            if *there == Class::Unknown {
                *there = class;
                stack.push(Item::Piece(j));
            } else if *there != class {
                return Err(self.tangled(u));
            }
        }
        Ok(())
    }

    /// Passes a class from a piece to the whole face across, if its edge is a whole edge.
    fn leave(
        &self,
        face: u32,
        u: u32,
        v: u32,
        class: Class,
        faces: &mut [u8],
        stack: &mut Vec<Item>,
    ) -> Result<(), Error> {
        let mesh = self.parts[self.which].mesh;
        let corners = mesh.corners(FaceId(face)).map(|c| self.arrangement.node(self.which, c));
        let Some(k) = (0..3).find(|&k| corners[k] == u && corners[(k + 1) % 3] == v) else { return Ok(()) };
        let Some(g) = mesh.twin(HalfedgeId::new(FaceId(face), k)).map(HalfedgeId::face) else { return Ok(()) };
        match faces[g.index()] {
            CUT => {}
            c if c == Class::Unknown as u8 => {
                faces[g.index()] = class as u8;
                stack.push(Item::Face(g.0, class));
            }
            c if c != class as u8 => return Err(self.tangled(u)),
            _ => {}
        }
        Ok(())
    }

    /// The class of a face whose component meets no seam, from its corners or else its middle.
    fn alone<'t>(&self, face: FaceId, bounds: Bounds, tree: &impl Fn() -> Option<&'t TriBvh>) -> Class {
        let (part, other) = (&self.parts[self.which], &self.parts[1 - self.which]);
        let mesh = other.mesh.mesh();
        let corners = part.mesh.corners(face);
        let scaled = part.triangle(face.0);
        let places = corners.map(|v| part.mesh.mesh().positions[v.index()]);
        let middle = |t: [DVec3; 3]| 0.5 * t[0] + 0.25 * (t[1] + t[2]);
        let samples =
            [(places[0], scaled[0]), (places[1], scaled[1]), (places[2], scaled[2]), (middle(places), middle(scaled))];
        for (place, p) in samples {
            // What counts as zero is met by all that does.
            let blur = DVec3::select(p.cmpeq(DVec3::ZERO), DVec3::splat(2.0 * part.vanishing()), DVec3::ZERO);
            let far = DVec3::new(bounds.max.x.max(place.x), place.y, place.z);
            let ray = Bounds { min: place - blur, max: far + blur };
            if !ray.overlaps(&bounds) {
                return Class::Outside;
            }
            let Some(tree) = tree() else { return Class::Outside };
            if let Some(w) = winding(tree, mesh, &ray, p, |f| other.triangle(f.0)) {
                return if w > 0 { Class::Inside } else { Class::Outside };
            }
        }
        Class::Outside
    }
}

/// The sides of all pieces, grouped by their nodes.
fn edges(pieces: &Pieces) -> Vec<([u32; 2], u32)> {
    let mut edges: Vec<([u32; 2], u32)> = pieces
        .triangles
        .par_iter()
        .enumerate()
        .flat_map_iter(|(i, t)| {
            (0..3).map(move |k| {
                let (u, v) = (t[k], t[(k + 1) % 3]);
                ([u.min(v), u.max(v)], i as u32)
            })
        })
        .collect();
    edges.par_sort_unstable();
    edges
}

/// What the flood has reached.
pub(crate) enum Item {
    Face(u32, Class),
    Piece(u32),
}
