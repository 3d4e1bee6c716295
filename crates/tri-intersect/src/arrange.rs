//! All crossings of two meshes: segments and coplanar cells between named points, with the points in exact order along
//! every edge and placed to the last bit.
//!
//! A *node* is a vertex of a (`0..na`), a vertex of b (`na..na+nb`), or a new point. A vertex of b that coincides with a
//! vertex of a is that node of a.

mod along;
mod part;

pub(crate) use part::{Key, Part, Simplex, parts};

use crate::crossing::{Crossing, Meeting, cross};
use crate::error::Error;
use crate::predicate::{Feature, rescaled};
use along::{OnEdge, place, touched_place};
use glam::DVec3;
use mesh_core::{Adjacency, Connected, FaceId, Faces, HalfedgeId, TriMesh, VertexId, Watch};
use rayon::prelude::*;

/// Pairs handed to one task.
const BATCH: usize = 512;

/// See [`Arrangement::grain`].
const GRAIN: f64 = 5.7e-14; // 2^-44

/// A segment that a face of a and a face of b share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment<N> {
    pub faces: [u32; 2],
    /// In the direction of the cross product of the normals, unless coplanar.
    pub ends: [N; 2],
    pub coplanar: bool,
}

/// An area that two coplanar faces share.
#[derive(Clone, Debug)]
pub(crate) struct Cell<N> {
    pub faces: [u32; 2],
    pub corners: Vec<N>,
    pub aligned: bool,
}

/// What all pairs of faces share, by name.
#[derive(Default)]
pub(crate) struct Crossings {
    pub segments: Vec<Segment<Key>>,
    pub cells: Vec<Cell<Key>>,
    /// Single points in which two faces touch.
    pub touches: Vec<([u32; 2], Key)>,
    /// A face without area in the way: part and face.
    pub degenerate: Option<(usize, u32)>,
}

impl Crossings {
    /// The error for a face without area in the way, if there is one.
    pub(crate) fn degenerate_error(&self, parts: &[Part; 2]) -> Option<Error> {
        self.degenerate.map(|(part, face)| {
            let at = parts[part].mesh.mesh().triangle(FaceId(face))[0];
            Error::Degenerate { part: part as u32, face: FaceId(face), at }
        })
    }
}

/// Intersects all candidate pairs.
pub(crate) fn crossings(parts: &[Part; 2], pairs: &[[FaceId; 2]], watch: &Watch) -> Result<Crossings, Error> {
    watch.step("intersect", 0.0)?;
    let batches: Vec<Crossings> = pairs
        .par_chunks(BATCH)
        .map(|batch| {
            let mut found = Crossings::default();
            for &[f, g] in batch {
                cross_faces(parts, [f.0, g.0], &mut found);
            }
            found
        })
        .collect();
    watch.step("intersect", 1.0)?;
    let mut all = Crossings::default();
    for batch in batches {
        all.segments.extend(batch.segments);
        all.cells.extend(batch.cells);
        all.touches.extend(batch.touches);
        all.degenerate = all.degenerate.or(batch.degenerate);
    }
    Ok(all)
}

fn cross_faces(parts: &[Part; 2], faces: [u32; 2], found: &mut Crossings) {
    let triangles = [parts[0].triangle(faces[0]), parts[1].triangle(faces[1])];
    let key = |m: Meeting| [0, 1].map(|w| simplex(parts[w].mesh, faces[w], m[w]));
    match cross(&triangles[0], &triangles[1]) {
        Crossing::Nothing => {}
        Crossing::Point(m) => found.touches.push((faces, key(m))),
        Crossing::Degenerate(part) => found.degenerate = found.degenerate.or(Some((part, faces[part]))),
        Crossing::Segment(ends) => found.segments.push(Segment { faces, ends: ends.map(key), coplanar: false }),
        Crossing::Coplanar(overlap) => {
            let corners: Vec<Key> = overlap.corners.iter().map(|&m| key(m)).collect();
            found.segments.extend(overlap.sides.iter().map(|s| Segment {
                faces,
                ends: s.map(|i| corners[usize::from(i)]),
                coplanar: true,
            }));
            if corners.len() > 2 {
                found.cells.push(Cell { faces, corners, aligned: overlap.aligned });
            }
        }
    }
}

fn simplex(mesh: &Connected<TriMesh>, face: u32, feature: Feature) -> Simplex {
    match feature {
        Feature::Corner(k) => Simplex::Vertex(mesh.corners(FaceId(face))[usize::from(k)].0),
        Feature::Side(k) => Simplex::Edge(mesh.edge(HalfedgeId::new(FaceId(face), usize::from(k))).0),
        Feature::Inside => Simplex::Face(face),
    }
}

/// The crossings as a graph on nodes.
pub(crate) struct Arrangement {
    /// Vertices of a and of b.
    pub counts: [u32; 2],
    pub segments: Vec<Segment<u32>>,
    pub cells: Vec<Cell<u32>>,
    /// New points: names, places, and where on the carrying edge (of a if one of a carries it).
    pub keys: Vec<Key>,
    pub places: Vec<DVec3>,
    pub parameters: Vec<f64>,
    /// Every node that two meshes share, with one of its names, by node.
    names: Vec<(u32, Key)>,
    /// Vertices of b that are vertices of a: (vertex of b, vertex of a), in order.
    pub twins: Vec<(u32, u32)>,
    /// For a and for b: (edge, node) for every node within an edge, in order along the edge.
    pub on_edges: [Vec<(u32, u32)>; 2],
    /// Pairs of faces that touch in a point that is on no segment, and the point.
    pub touches: Vec<([u32; 2], DVec3)>,
    /// Whether any two meet other than edge through face.
    pub degenerate: bool,
    /// How far apart, in scaled units, points may be that count as one once rounding has confused them: some hundred
    /// times the rounding of the largest coordinate. Nothing is moved farther.
    pub grain: f64,
    /// What coordinates were multiplied with for the predicates.
    scale: f64,
}

impl Arrangement {
    /// Names become nodes; nodes get places and an order along edges.
    pub(crate) fn new(parts: &[Part; 2], crossings: &Crossings) -> Self {
        let mut keys: Vec<Key> = crossings.segments.iter().flat_map(|s| s.ends).collect();
        keys.par_sort_unstable();
        keys.dedup();
        let counts = [0, 1].map(|w| parts[w].mesh.vertex_count() as u32);
        let (mut nodes, mut fresh, mut twins) = (Vec::with_capacity(keys.len()), vec![], vec![]);
        for key in &keys {
            nodes.push(match *key {
                [Simplex::Vertex(v), Simplex::Vertex(w)] => {
                    twins.push((w, v));
                    v
                }
                [Simplex::Vertex(v), _] => v,
                [_, Simplex::Vertex(w)] => counts[0] + w,
                _ => {
                    fresh.push(*key);
                    counts[0] + counts[1] + fresh.len() as u32 - 1
                }
            });
        }
        twins.sort_unstable();
        let node = |key: &Key| nodes[keys.binary_search(key).unwrap_or(0)];
        let placed: Vec<(f64, DVec3)> = fresh.par_iter().map(|key| place(parts, key)).collect();
        let (parameters, places) = placed.into_iter().unzip();
        let on_edges = [0, 1].map(|which| {
            let mut entries: Vec<OnEdge> = keys
                .iter()
                .zip(&nodes)
                .filter_map(|(key, &node)| match key[which] {
                    Simplex::Edge(edge) => Some(OnEdge::new(parts, which, edge, key[1 - which], node)),
                    _ => None,
                })
                .collect();
            entries.sort_by(|x, y| x.edge.cmp(&y.edge).then_with(|| x.compare(y, parts, which)));
            entries.into_iter().map(|e| (e.edge, e.node)).collect()
        });
        let generic =
            |k: &Key| matches!(k, [Simplex::Edge(_), Simplex::Face(_)] | [Simplex::Face(_), Simplex::Edge(_)]);
        let lone = crossings.touches.iter().filter(|t| keys.binary_search(&t.1).is_err());
        let mut names: Vec<(u32, Key)> = nodes.iter().copied().zip(keys.iter().copied()).collect();
        names.par_sort_unstable();
        Self {
            counts,
            names,
            touches: lone.map(|&(faces, key)| (faces, touched_place(parts, &key))).collect(),
            segments: crossings
                .segments
                .par_iter()
                .map(|s| Segment { faces: s.faces, ends: s.ends.map(|k| node(&k)), coplanar: s.coplanar })
                .collect(),
            cells: crossings
                .cells
                .iter()
                .map(|c| Cell { faces: c.faces, corners: c.corners.iter().map(node).collect(), aligned: c.aligned })
                .collect(),
            degenerate: !keys.iter().all(generic),
            grain: GRAIN * parts[0].scale * parts[0].largest,
            scale: parts[0].scale,
            keys: fresh,
            places,
            parameters,
            twins,
            on_edges,
        }
    }

    /// The node of a part's vertex.
    pub(crate) fn node(&self, part: usize, vertex: VertexId) -> u32 {
        if part == 0 {
            return vertex.0;
        }
        match self.twins.binary_search_by_key(&vertex.0, |t| t.0) {
            Ok(i) => self.twins[i].1,
            Err(_) => self.counts[0] + vertex.0,
        }
    }

    /// What carries a shared node.
    pub(crate) fn key(&self, node: u32) -> Key {
        let i = self.names.partition_point(|n| n.0 < node);
        self.names.get(i).map_or([Simplex::Vertex(node); 2], |n| n.1)
    }

    /// Where a node is.
    pub(crate) fn position(&self, parts: &[Part; 2], node: u32) -> DVec3 {
        let [a, b] = self.counts;
        if node < a {
            parts[0].mesh.mesh().positions[node as usize]
        } else if node < a + b {
            parts[1].mesh.mesh().positions[(node - a) as usize]
        } else {
            self.places[(node - a - b) as usize]
        }
    }

    /// Where a node is, scaled like the parts' points.
    pub(crate) fn scaled_position(&self, parts: &[Part; 2], node: u32) -> DVec3 {
        let [a, b] = self.counts;
        if node < a {
            parts[0].points[node as usize]
        } else if node < a + b {
            parts[1].points[(node - a) as usize]
        } else {
            rescaled(self.places[(node - a - b) as usize], self.scale)
        }
    }

    /// The nodes within an edge of a part, from the tail of the edge's halfedge to its head.
    pub(crate) fn along_edge(&self, part: usize, edge: u32) -> &[(u32, u32)] {
        let list = &self.on_edges[part];
        let start = list.partition_point(|e| e.0 < edge);
        let end = start + list[start..].partition_point(|e| e.0 == edge);
        &list[start..end]
    }
}
