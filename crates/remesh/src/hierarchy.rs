//! A decimation hierarchy: a coarse surface to work on, and the details to put back.

use crate::Error;
use crate::isotropic::{LOCKED, NONE, Table, keeps_side};
use glam::{DMat3, DVec3};
use mesh_core::{Adjacency, Positions, TriMesh, VertexId, VertexMap, Watch};
use rayon::prelude::*;

/// No vertex gets more neighbours than this by decimation.
const MOST_NEIGHBOURS: u32 = 12;
/// What a removed vertex costs by its distance from the one it merges into, beside what it costs by height: enough to
/// prefer short edges where all is flat.
const SHORT: f64 = 1e-3;

/// A surface decimated level by level, which keeps what each level lost (\[Guskov1999\]).
///
/// A vertex that is removed remembers its place in a frame that its neighbours of then span. When the coarsest surface
/// has been reshaped, [`Hierarchy::restore`] puts all vertices back, finest last, each in its frame as that has been
/// turned and moved: connectivity is that of the input again, with its details on the new shape.
#[derive(Clone, Debug)]
pub struct Hierarchy {
    input: TriMesh,
    levels: Vec<Level>,
    coarsest: TriMesh,
    survivors: Vec<VertexId>,
}

/// The vertices that one level lost. No two of them are neighbours.
#[derive(Clone, Debug, Default)]
struct Level {
    removed: Vec<u32>,
    /// Where the ring of each begins.
    starts: Vec<u32>,
    rings: Vec<u32>,
    /// The place of each in its ring's frame.
    details: Vec<DVec3>,
}

impl Hierarchy {
    /// Decimates a surface `levels` times, each time by about a third, flattest places first.
    ///
    /// Boundary vertices and those flagged in `protected` (empty protects none) are never removed. Levels end early when
    /// nothing more can go without folding a face or changing the topology. O(levels · n log n). The same input gives
    /// the same bits for any number of threads.
    ///
    /// ```
    /// use mesh_core::{Connected, VertexMap, Watch, shapes};
    /// let ball = shapes::icosphere(1.0, 4);
    /// let levels = remesh::Hierarchy::build(&Connected::new(&ball)?, &VertexMap::default(), 4, &Watch::default())?;
    /// assert!(levels.coarsest().faces.len() * 3 < ball.faces.len());
    /// assert_eq!(levels.restore(&levels.coarsest().positions)?, ball);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Count`], [`Error::NotFinite`], [`Error::Cancelled`].
    pub fn build<M: Adjacency + Positions>(
        mesh: &M,
        protected: &VertexMap<bool>,
        levels: usize,
        watch: &Watch,
    ) -> Result<Self, Error> {
        let count = mesh.vertex_count();
        if !protected.is_empty() && protected.len() != count {
            return Err(Error::Count { name: "protected vertices", found: protected.len(), expected: count });
        }
        let positions: Vec<DVec3> = mesh.vertex_ids().map(|v| mesh.position(v)).collect();
        let fine = |p: &DVec3| p.is_finite() && p.abs().max_element() < 1e100;
        if let Some(v) = positions.iter().position(|p| !fine(p)) {
            return Err(Error::NotFinite { vertex: VertexId::from(v), place: positions[v] });
        }
        let input = TriMesh { positions, faces: mesh.face_ids().map(|f| mesh.corners(f)).collect() };
        let mut table = Table::new(mesh);
        let mut held: Vec<bool> = (0..count as u32).map(|v| table.is_boundary(v)).collect();
        for (held, _) in held.iter_mut().zip(protected.as_slice()).filter(|h| *h.1) {
            *held = true;
        }
        let mut all = vec![];
        for done in 0..levels {
            watch.step("decimate", done as f64 / levels as f64)?;
            let level = decimate(&mut table, &input.positions, &held);
            if level.removed.is_empty() {
                break;
            }
            all.push(level);
        }
        Ok(Self::packed(input, &table, all))
    }

    fn packed(input: TriMesh, table: &Table, levels: Vec<Level>) -> Self {
        let mut gone = vec![false; input.positions.len()];
        for &v in levels.iter().flat_map(|l| &l.removed) {
            gone[v as usize] = true;
        }
        let survivors: Vec<VertexId> = (0..gone.len()).filter(|&v| !gone[v]).map(VertexId::from).collect();
        let mut ids = vec![VertexId(NONE); gone.len()];
        for (new, v) in survivors.iter().enumerate() {
            ids[v.index()] = VertexId::from(new);
        }
        let live = (0..table.halfedge_count()).step_by(3).filter(|&h| table.is_alive(h));
        let coarsest = TriMesh {
            positions: survivors.iter().map(|v| input.positions[v.index()]).collect(),
            faces: live.map(|h| [h, h + 1, h + 2].map(|h| ids[table.tail(h) as usize])).collect(),
        };
        Self { input, levels, coarsest, survivors }
    }

    /// The coarsest surface: an oriented 2-manifold of the input's topology, whose vertices are some of the input's, in order.
    pub fn coarsest(&self) -> &TriMesh {
        &self.coarsest
    }

    /// The input's vertex that each vertex of the coarsest surface is.
    pub fn survivors(&self) -> &[VertexId] {
        &self.survivors
    }

    /// How many levels there are.
    pub fn levels(&self) -> usize {
        self.levels.len()
    }

    /// The input's triangles over the coarsest surface as it has been reshaped to `positions`.
    ///
    /// A vertex none of whose neighbours has moved keeps its bits; a rigid motion of the coarsest surface gives that of
    /// the input. O(n).
    ///
    /// # Errors
    /// [`Error::Count`], [`Error::NotFinite`] with the vertex of the coarsest surface.
    pub fn restore(&self, positions: &[DVec3]) -> Result<TriMesh, Error> {
        let (found, expected) = (positions.len(), self.survivors.len());
        if found != expected {
            return Err(Error::Count { name: "positions", found, expected });
        }
        if let Some(v) = positions.iter().position(|p| !p.is_finite()) {
            return Err(Error::NotFinite { vertex: VertexId::from(v), place: positions[v] });
        }
        let mut mesh = self.input.clone();
        let before = &self.input.positions;
        for (v, &p) in self.survivors.iter().zip(positions) {
            mesh.positions[v.index()] = p;
        }
        for level in self.levels.iter().rev() {
            let points = &mesh.positions;
            let place = |i: usize| {
                let ring = &level.rings[level.starts[i] as usize..level.starts[i + 1] as usize];
                if ring.iter().all(|&n| points[n as usize] == before[n as usize]) {
                    return before[level.removed[i] as usize];
                }
                let (center, frame) = frame(ring, points);
                center + frame * level.details[i]
            };
            let back: Vec<DVec3> = (0..level.removed.len()).into_par_iter().with_min_len(512).map(place).collect();
            for (&v, p) in level.removed.iter().zip(back) {
                mesh.positions[v as usize] = p;
            }
        }
        Ok(mesh)
    }
}

/// The middle of a ring, and its frame: first neighbour, across, normal.
fn frame(ring: &[u32], points: &[DVec3]) -> (DVec3, DMat3) {
    let at = |i: usize| points[ring[i % ring.len()] as usize];
    let center = ring.iter().map(|&v| points[v as usize]).sum::<DVec3>() / ring.len() as f64;
    let normal: DVec3 = (0..ring.len()).map(|i| (at(i) - center).cross(at(i + 1) - center)).sum();
    let along = at(0) - center;
    let Some(z) = normal.try_normalize() else { return (center, DMat3::IDENTITY) };
    let Some(x) = (along - along.dot(z) * z).try_normalize() else { return (center, DMat3::IDENTITY) };
    (center, DMat3::from_cols(x, z.cross(x), z))
}

/// Removes as many vertices as it can, cheapest first, no two of them neighbours.
fn decimate(table: &mut Table, points: &[DVec3], held: &[bool]) -> Level {
    let candidate = |v: u32| !held[v as usize] && table.out[v as usize] != NONE;
    let mut costs: Vec<(f64, u32, u32)> = (0..table.vertex_count())
        .into_par_iter()
        .with_min_len(512)
        .filter(|&v| candidate(v))
        .filter_map(|v| cheapest(table, points, v).map(|(cost, h)| (cost, v, h)))
        .collect();
    costs.par_sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut level = Level { starts: vec![0], ..Level::default() };
    let mut kept = vec![false; points.len()];
    for (_, v, h) in costs {
        // The halfedge still leaves v: only faces at removed vertices have changed, and none of those is a neighbour.
        if kept[v as usize] || !fits(table, points, h) {
            continue;
        }
        let first = level.rings.len();
        level.rings.extend(table.ring(v).map(|h| table.head(h)));
        let (center, frame) = frame(&level.rings[first..], points);
        for &n in &level.rings[first..] {
            kept[n as usize] = true;
        }
        level.details.push(frame.transpose() * (points[v as usize] - center));
        level.removed.push(v);
        level.starts.push(level.rings.len() as u32);
        table.collapse(h);
    }
    level
}

/// The cheapest halfedge along which `v` can be merged into a neighbour: the least height of the neighbour over the planes
/// of the faces at `v` (\[GarlandHeckbert1997\]).
fn cheapest(table: &Table, points: &[DVec3], v: u32) -> Option<(f64, u32)> {
    let p = points[v as usize];
    let normals: Vec<DVec3> =
        table.ring(v).map(|h| (points[table.head(h) as usize] - p).cross(points[table.apex(h) as usize] - p)).collect();
    let area: f64 = normals.iter().map(|n| n.length()).sum();
    let cost = |h: u32| {
        let d = points[table.head(h) as usize] - p;
        let height: f64 = normals.iter().map(|n| n.dot(d).powi(2) / n.length().max(f64::MIN_POSITIVE)).sum();
        height + SHORT * area * d.length_squared()
    };
    let mut all: Vec<(f64, u32)> = table.ring(v).map(|h| (cost(h), h)).filter(|c| c.0.is_finite()).collect();
    all.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    all.into_iter().find(|c| fits(table, points, c.1))
}

/// Whether the tail of `h` can be merged into its head with no face folded, and no vertex crowded.
fn fits(table: &Table, points: &[DVec3], h: u32) -> bool {
    let (u, v) = (table.tail(h), table.head(h));
    table.flags[h as usize] & LOCKED == 0
        && table.valence[u as usize] + table.valence[v as usize] <= MOST_NEIGHBOURS + 4
        && table.collapses_cleanly(h)
        && table.ring(u).all(|ring| {
            let (b, c) = (table.head(ring), table.apex(ring));
            let [old, new, pb, pc] = [u, v, b, c].map(|v| points[v as usize]);
            b == v || c == v || keeps_side([old, pb, pc], [new, pb, pc])
        })
}
