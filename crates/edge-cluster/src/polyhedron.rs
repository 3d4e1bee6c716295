//! Polyhedra: planar faces with holes, read off a triangle mesh.

use crate::error::Error;
use crate::plane::Plane;
use glam::DVec3;
use mesh_core::{Adjacency, Connected, FaceId, Faces, HalfedgeId, Positions, TriMesh, area_vector, bounds};

/// A closed, oriented polyhedron. Its vertices keep the ids of the mesh it was read from; ids that no face uses are
/// passed over.
#[derive(Clone, Debug)]
pub struct Polyhedron {
    /// One point per vertex of the mesh, in model units.
    pub positions: Vec<DVec3>,
    /// The planar faces.
    pub faces: Vec<Face>,
    /// One per side of each face.
    pub halfedges: Vec<Halfedge>,
    /// Length of the diagonal of its box, which tolerances are shares of.
    pub size: f64,
    /// Largest distance of a vertex from the plane of one of its faces, in model units.
    pub flatness: f64,
    /// One halfedge that leaves each vertex; `u32::MAX` for ids that no face uses.
    leaving: Vec<u32>,
}

/// A planar face.
#[derive(Clone, Debug)]
pub struct Face {
    /// Its plane, normal outward.
    pub plane: Plane,
    /// A halfedge of each boundary loop: the outer one counter-clockwise, holes clockwise, seen from outside.
    pub loops: Vec<u32>,
    /// Lowest triangle of the mesh that belongs to it.
    pub parent: FaceId,
}

/// One side of a face, from `tail` to `head`, the face to its left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Halfedge {
    /// Where it begins.
    pub tail: u32,
    /// Where it ends.
    pub head: u32,
    /// The face to its left.
    pub face: u32,
    /// The next along the face's loop.
    pub next: u32,
    /// The one before along the face's loop.
    pub prev: u32,
    /// The other side of the edge.
    pub twin: u32,
}

/// How the faces at a vertex or edge turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// Outward at every edge.
    Convex,
    /// Inward at every edge.
    Reflex,
    /// Some outward, some inward.
    Mixed,
}

/// What counts as flat.
#[derive(Clone, Copy, Debug)]
pub struct Params {
    /// Largest distance of a face's vertices from its plane, as a share of the polyhedron's diagonal.
    pub planarity: f64,
    /// Neighbouring faces whose normals differ by no more than this many degrees are one face.
    pub merge: f64,
}

impl Default for Params {
    /// 1e-6, the rounding of files with seven digits, and 0.01°.
    fn default() -> Self {
        Self { planarity: 1e-6, merge: 0.01 }
    }
}

impl Polyhedron {
    /// Reads the planar faces of a closed mesh. `polygon_of` names the polygon of each triangle where the file had
    /// polygons; neighbouring triangles in one plane belong to one face either way. O(n log n).
    ///
    /// # Errors
    /// [`Error::NotManifold`], [`Error::Open`], [`Error::NotPlanar`] or [`Error::Pinched`].
    ///
    /// ```
    /// use edge_cluster::{Polyhedron, PolyhedronParams};
    /// let cube = mesh_core::shapes::cuboid(glam::DVec3::ONE);
    /// let cube = Polyhedron::new(&cube, None, &PolyhedronParams::default())?;
    /// assert_eq!((cube.faces.len(), cube.halfedges.len()), (6, 24));
    /// # Ok::<(), edge_cluster::Error>(())
    /// ```
    pub fn new(mesh: &TriMesh, polygon_of: Option<&[u32]>, params: &Params) -> Result<Self, Error> {
        let mesh = Connected::new(mesh).map_err(|e| Error::NotManifold(e.to_string(), e.place))?;
        let triangles = mesh.face_count();
        if let Some(p) = mesh.mesh().positions.iter().find(|p| !p.is_finite()) {
            return Err(Error::NotManifold("a mesh with a coordinate that is no finite number".into(), Some(*p)));
        }
        if let Some(h) = (0..3 * triangles).map(HalfedgeId::from).find(|&h| mesh.twin(h).is_none()) {
            return Err(Error::Open(mesh.position(mesh.tail(h))));
        }
        if triangles == 0 {
            return Err(Error::NotManifold("an empty mesh".into(), None));
        }
        let group = flat_groups(&mesh, polygon_of, params.merge);
        let size = bounds(mesh.mesh()).diagonal();
        let mut solid = Self {
            positions: mesh.mesh().positions.clone(),
            faces: vec![],
            halfedges: vec![],
            size,
            flatness: 0.0,
            leaving: vec![u32::MAX; mesh.vertex_count()],
        };
        solid.trace_faces(&mesh, &group);
        solid.drop_flat_vertices();
        if solid.faces.len() < 4 {
            return Err(Error::NotManifold(format!("a mesh with {} planar faces", solid.faces.len()), None));
        }
        solid.link_twins()?;
        solid.fit_planes(params.planarity * size)?;
        Ok(solid)
    }

    /// Vertices that faces meet at, ascending.
    pub fn vertices(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.leaving.len() as u32).filter(|&v| self.leaving[v as usize] != u32::MAX)
    }

    /// The halfedges that leave `v`, counter-clockwise seen from outside. Empty for ids that no face uses.
    pub fn ring(&self, v: u32) -> impl Iterator<Item = u32> + '_ {
        let start = self.leaving.get(v as usize).copied().filter(|&h| h != u32::MAX);
        std::iter::successors(start, move |&h| {
            let next = self.halfedges[self.halfedges[h as usize].prev as usize].twin;
            (Some(next) != start).then_some(next)
        })
    }

    /// Length of an edge, in model units.
    pub fn length(&self, h: u32) -> f64 {
        self.vector(h).length()
    }

    /// From an edge's tail to its head.
    pub fn vector(&self, h: u32) -> DVec3 {
        let h = self.halfedges[h as usize];
        self.positions[h.head as usize] - self.positions[h.tail as usize]
    }

    /// The plane to the left of a halfedge.
    pub fn plane(&self, h: u32) -> Plane {
        self.faces[self.halfedges[h as usize].face as usize].plane
    }

    /// Angle between the normals beside an edge, in radians, positive where convex.
    pub fn dihedral(&self, h: u32) -> f64 {
        let (left, right) = (self.plane(h).normal, self.plane(self.halfedges[h as usize].twin).normal);
        let sine = left.cross(right).dot(self.vector(h).normalize_or_zero());
        sine.atan2(right.dot(left))
    }

    /// How the faces at a vertex turn.
    pub fn turn(&self, v: u32) -> Turn {
        let convex = self.ring(v).filter(|&h| self.dihedral(h) > 0.0).count();
        match (convex, self.ring(v).count() - convex) {
            (_, 0) => Turn::Convex,
            (0, _) => Turn::Reflex,
            _ => Turn::Mixed,
        }
    }

    /// The halfedge from `tail` to `head`.
    pub fn halfedge(&self, tail: u32, head: u32) -> Option<u32> {
        self.ring(tail).find(|&h| self.halfedges[h as usize].head == head)
    }

    /// The loops of every group of triangles, as halfedges without twins.
    fn trace_faces(&mut self, mesh: &Connected<&TriMesh>, group: &[u32]) {
        let is_border =
            |h: HalfedgeId| mesh.twin(h).is_some_and(|t| group[t.face().index()] != group[h.face().index()]);
        let mut face_of = vec![u32::MAX; group.len()];
        let mut seen = vec![false; 3 * group.len()];
        for start in (0..seen.len()).map(HalfedgeId::from).filter(|&h| is_border(h)) {
            if seen[start.index()] {
                continue;
            }
            let name = &mut face_of[group[start.face().index()] as usize];
            if *name == u32::MAX {
                *name = self.faces.len() as u32;
                let plane = Plane { normal: DVec3::Z, offset: 0.0 };
                self.faces.push(Face { plane, loops: vec![], parent: start.face() });
            }
            let (face, first) = (*name, self.halfedges.len() as u32);
            self.faces[face as usize].loops.push(first);
            let mut h = start;
            while !seen[h.index()] {
                seen[h.index()] = true;
                let at = self.halfedges.len() as u32;
                let (tail, head) = (mesh.tail(h).0, mesh.head(h).0);
                self.halfedges.push(Halfedge {
                    tail,
                    head,
                    face,
                    next: at + 1,
                    prev: at.wrapping_sub(1),
                    twin: u32::MAX,
                });
                h = h.next();
                // Around the head, within the group, to the next border.
                while let Some(t) = mesh.twin(h).filter(|_| !is_border(h)) {
                    h = t.next();
                }
            }
            let last = self.halfedges.len() as u32 - 1;
            self.halfedges[last as usize].next = first;
            self.halfedges[first as usize].prev = last;
        }
        for f in 0..group.len() {
            let name = face_of[group[f] as usize];
            if let Some(face) = self.faces.get_mut(name as usize) {
                face.parent = face.parent.min(FaceId::from(f));
            }
        }
    }

    /// Takes vertices out of the middle of straight edges: those at which only two faces meet.
    fn drop_flat_vertices(&mut self) {
        let mut degree = vec![0u32; self.positions.len()];
        self.halfedges.iter().for_each(|h| degree[h.tail as usize] += 1);
        let keep: Vec<bool> = self.halfedges.iter().map(|h| degree[h.tail as usize] > 2).collect();
        let skip = |from: u32, step: &dyn Fn(u32) -> u32| {
            let mut h = step(from);
            while h != from && !keep[h as usize] {
                h = step(h);
            }
            h
        };
        let old = self.halfedges.clone();
        let mut renamed = vec![u32::MAX; old.len()];
        let mut count = 0;
        for h in 0..old.len() {
            if keep[h] {
                renamed[h] = count;
                count += 1;
            }
        }
        self.halfedges.clear();
        for (i, h) in old.iter().enumerate().filter(|(i, _)| keep[*i]) {
            let next = skip(i as u32, &|h| old[h as usize].next);
            let prev = skip(i as u32, &|h| old[h as usize].prev);
            let head = old[next as usize].tail;
            let (next, prev) = (renamed[next as usize], renamed[prev as usize]);
            self.halfedges.push(Halfedge { head, next, prev, ..*h });
        }
        for face in &mut self.faces {
            face.loops.retain_mut(|h| {
                let kept = if keep[*h as usize] { *h } else { skip(*h, &|h| old[h as usize].next) };
                *h = renamed[kept as usize];
                *h != u32::MAX
            });
        }
    }

    fn link_twins(&mut self) -> Result<(), Error> {
        let mut order: Vec<([u32; 2], u32)> = (0..).zip(&self.halfedges).map(|(i, h)| ([h.tail, h.head], i)).collect();
        order.sort_unstable();
        let pinched = |v: u32, at: DVec3| Err(Error::Pinched { vertex: v, at });
        if let Some(w) = order.windows(2).find(|w| w[0].0 == w[1].0) {
            return pinched(w[0].0[0], self.positions[w[0].0[0] as usize]);
        }
        for i in 0..self.halfedges.len() {
            let Halfedge { tail, head, next, .. } = self.halfedges[i];
            let found = order.binary_search_by_key(&[head, tail], |o| o.0);
            let (Ok(twin), true) = (found, next as usize != i && tail != head) else {
                return pinched(tail, self.positions[tail as usize]);
            };
            self.halfedges[i].twin = order[twin].1;
            let leaving = &mut self.leaving[tail as usize];
            *leaving = (*leaving).min(i as u32);
        }
        let mut degree = vec![0; self.positions.len()];
        self.halfedges.iter().for_each(|h| degree[h.tail as usize] += 1);
        match self.vertices().find(|&v| self.ring(v).take(degree[v as usize] + 1).count() != degree[v as usize]) {
            Some(v) => pinched(v, self.positions[v as usize]),
            None => Ok(()),
        }
    }

    fn fit_planes(&mut self, tolerance: f64) -> Result<(), Error> {
        for f in 0..self.faces.len() {
            let (mut normal, mut sum, mut count) = (DVec3::ZERO, DVec3::ZERO, 0.0);
            let origin = self.faces[f].loops.first().map_or(DVec3::ZERO, |&h| self.tail(h));
            for h in self.face_halfedges(f as u32) {
                let (a, b) = (self.tail(h) - origin, self.tail(self.halfedges[h as usize].next) - origin);
                normal += a.cross(b);
                sum += a;
                count += 1.0;
            }
            let at = origin + sum / f64::max(count, 1.0);
            let plane = Plane::new(normal, at).ok_or(Error::NotPlanar { face: f, at, off: 0.0, tolerance })?;
            for h in self.face_halfedges(f as u32).collect::<Vec<_>>() {
                let off = plane.height(self.tail(h)).abs();
                if off > tolerance {
                    return Err(Error::NotPlanar { face: f, at: self.tail(h), off, tolerance });
                }
                self.flatness = self.flatness.max(off);
            }
            self.faces[f].plane = plane;
        }
        Ok(())
    }

    /// Every halfedge of a face, loop by loop.
    pub fn face_halfedges(&self, face: u32) -> impl Iterator<Item = u32> + '_ {
        self.faces[face as usize].loops.iter().flat_map(move |&start| self.loop_from(start))
    }

    /// The halfedges of one loop, beginning with `start`.
    pub fn loop_from(&self, start: u32) -> impl Iterator<Item = u32> + '_ {
        std::iter::successors(Some(start), move |&h| Some(self.halfedges[h as usize].next).filter(|&n| n != start))
    }

    fn tail(&self, h: u32) -> DVec3 {
        self.positions[self.halfedges[h as usize].tail as usize]
    }
}

/// A label for each triangle: the same for those of one polygon, and for neighbours in one plane.
fn flat_groups(mesh: &Connected<&TriMesh>, polygon_of: Option<&[u32]>, merge: f64) -> Vec<u32> {
    let polygon_of = polygon_of.filter(|p| p.len() == mesh.face_count());
    let mut parent: Vec<u32> = (0..mesh.face_count() as u32).collect();
    let normals: Vec<DVec3> = mesh.face_ids().map(|f| area_vector(mesh.triangle(f)).normalize_or_zero()).collect();
    let sine = merge.to_radians().sin();
    for h in mesh.halfedge_ids() {
        let Some(t) = mesh.twin(h).filter(|&t| h < t) else { continue };
        let (f, g) = (h.face().index(), t.face().index());
        let (a, b) = (normals[f], normals[g]);
        let flat = a.dot(b) > 0.0 && a.cross(b).length() <= sine;
        // A triangle without area lies in whatever plane its longest side does.
        let needle = |t: usize, h: HalfedgeId| {
            let length = |h: HalfedgeId| mesh.edge_length(h);
            normals[t] == DVec3::ZERO && length(h) >= length(h.next()).max(length(h.prev()))
        };
        if flat || polygon_of.is_some_and(|p| p[f] == p[g]) || needle(f, h) || needle(g, t) {
            let (a, b) = (root(&mut parent, f as u32), root(&mut parent, g as u32));
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    (0..mesh.face_count() as u32).map(|f| root(&mut parent, f)).collect()
}

fn root(parent: &mut [u32], mut f: u32) -> u32 {
    while parent[f as usize] != f {
        parent[f as usize] = parent[parent[f as usize] as usize];
        f = parent[f as usize];
    }
    f
}
