//! The Laplacian with fixed vertices, factorised once for many right-hand sides.

use crate::distortion::{check, face_corners};
use crate::error::Error;
use glam::{DVec2, DVec3};
use mesh_core::{Adjacency, CornerMap, Faces, HalfedgeId, Positions, VertexId, VertexMap};
use mesh_operators::{Cholesky, LowerTriangle, cotangent_weight, cotangents};

/// How strongly an edge pulls its ends together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Weights {
    /// ½(cot α + cot β): keeps angles, but may turn triangles over where edges are far from Delaunay
    /// (\[PinkallPolthier1993\]).
    #[default]
    Cotangent,
    /// 1: no triangle is turned over when the boundary is mapped to a convex outline with no triangle flat along it
    /// (\[Tutte1963\]).
    Uniform,
}

/// A prepared solver: values at fixed vertices in, harmonic values at all vertices out.
#[derive(Debug)]
pub struct Harmonic {
    factor: Option<Cholesky>,
    /// Unknown of each vertex; fixed ones and those without faces have none.
    unknowns: VertexMap<Node>,
    free: Vec<VertexId>,
    /// Pulls of fixed vertices: unknown, index among the fixed, weight.
    pulls: Vec<(u32, u32, f64)>,
}

/// What a vertex is to the equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Node {
    /// Of no triangle.
    Absent,
    /// The k-th fixed one.
    Fixed(u32),
    /// The k-th unknown.
    Free(u32),
}

impl Harmonic {
    /// Factorises the cotangent Laplacian of `mesh` with the vertices `fixed` held; of repeated ones the first counts.
    ///
    /// Time and memory are those of a sparse Cholesky factorisation in nested order, about O(n^1.5) and O(n log n).
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::Loose`], [`Error::Singular`].
    pub fn new<M: Adjacency + Positions + Sync>(mesh: &M, fixed: &[VertexId]) -> Result<Self, Error> {
        Self::with_weights(mesh, fixed, Weights::Cotangent)
    }

    /// The same with other weights.
    ///
    /// # Errors
    /// As [`Harmonic::new`].
    pub fn with_weights<M: Adjacency + Positions + Sync>(
        mesh: &M,
        fixed: &[VertexId],
        weights: Weights,
    ) -> Result<Self, Error> {
        Self::with_pull(mesh, fixed, &Pull::of(mesh, weights))
    }

    pub(crate) fn with_pull<M: Adjacency + Positions + Sync>(
        mesh: &M,
        fixed: &[VertexId],
        pull: &Pull,
    ) -> Result<Self, Error> {
        let mut unknowns = VertexMap::filled(mesh.vertex_count(), Node::Absent);
        let mut reached = Vec::with_capacity(mesh.vertex_count());
        for (k, &v) in (0..).zip(fixed) {
            if v.index() < unknowns.len() && unknowns[v] == Node::Absent {
                unknowns[v] = Node::Fixed(k);
                reached.push(v);
            }
        }
        // Unknowns are numbered as they are reached from the fixed ones, so that no piece is left loose.
        let mut free = Vec::with_capacity(mesh.vertex_count());
        let mut next = 0;
        while let Some(&v) = reached.get(next) {
            next += 1;
            for_neighbours(mesh, v, |_, w| {
                if unknowns[w] == Node::Absent {
                    unknowns[w] = Node::Free(free.len() as u32);
                    free.push(w);
                    reached.push(w);
                }
            });
        }
        for v in mesh.vertex_ids() {
            let at = mesh.position(v);
            if mesh.outgoing(v).is_some() && unknowns[v] == Node::Absent {
                return Err(Error::Loose { vertex: v, at });
            }
            if unknowns[v] != Node::Absent && !is_usable(at) {
                return Err(Error::NotFinite { vertex: v, at });
            }
        }
        let (lower, pulls) = assemble(mesh, &unknowns, &free, pull)?;
        let factor = if free.is_empty() { None } else { Some(factorise(mesh, &lower, &free)?) };
        Ok(Self { factor, unknowns, free, pulls })
    }

    /// Harmonic values for K sets of boundary values at once, `boundary` in the order of the fixed vertices. Vertices
    /// of no triangle get zero, as do fixed ones beyond the end of `boundary`.
    pub fn solve<const K: usize>(&self, boundary: &[[f64; K]]) -> VertexMap<[f64; K]> {
        self.solve_with_sources(boundary, &[])
    }

    /// The same with flow put in at vertices: the solution of Σ w (f_i − f_j) = source. Sources at fixed vertices are
    /// lost there.
    pub fn solve_with_sources<const K: usize>(
        &self,
        boundary: &[[f64; K]],
        sources: &[(VertexId, [f64; K])],
    ) -> VertexMap<[f64; K]> {
        let n = self.free.len();
        let held = |k: u32| boundary.get(k as usize).copied().unwrap_or([0.0; K]);
        let mut x = vec![0.0; n * K];
        for &(i, k, w) in &self.pulls {
            let value = held(k);
            for (c, value) in value.into_iter().enumerate() {
                x[c * n + i as usize] += w * value;
            }
        }
        for &(v, source) in sources {
            if let Some(&Node::Free(i)) = self.unknowns.get(v) {
                for (c, value) in source.into_iter().enumerate() {
                    x[c * n + i as usize] += value;
                }
            }
        }
        if let Some(factor) = &self.factor {
            factor.solve(&mut x);
        }
        let value = |node: &Node| match *node {
            Node::Absent => [0.0; K],
            Node::Fixed(k) => held(k),
            Node::Free(i) => std::array::from_fn(|c| x[c * n + i as usize]),
        };
        self.unknowns.as_slice().iter().map(value).collect::<Vec<_>>().into()
    }
}

/// The Dirichlet map of a surface with the boundary (or any vertices) fixed in the plane, without turned triangles.
///
/// ```
/// use glam::DVec2;
/// use mesh_core::{Connected, Faces, Positions, boundary_loops, shapes};
/// use param_conformal::{Weights, map_fixed};
/// let grid = Connected::new(shapes::grid(2.0, 1.0, 8, 4))?;
/// let rim = boundary_loops(&grid).concat();
/// let fixed: Vec<_> = rim.iter().map(|&h| grid.tail(h)).map(|v| (v, 3.0 * grid.position(v).truncate())).collect();
/// let map = map_fixed(&grid, &fixed, Weights::Cotangent)?;
/// assert!(grid.vertex_ids().all(|v| map[v].distance(3.0 * grid.position(v).truncate()) < 1e-12));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`Harmonic::new`], and [`Error::Flipped`].
pub fn map_fixed<M: Adjacency + Positions + Sync>(
    mesh: &M,
    fixed: &[(VertexId, DVec2)],
    weights: Weights,
) -> Result<VertexMap<DVec2>, Error> {
    let ids: Vec<VertexId> = fixed.iter().map(|f| f.0).collect();
    let values: Vec<[f64; 2]> = fixed.iter().map(|f| f.1.to_array()).collect();
    let found = Harmonic::with_weights(mesh, &ids, weights)?.solve(&values);
    let map: VertexMap<DVec2> = found.into_vec().into_iter().map(DVec2::from_array).collect::<Vec<_>>().into();
    check(mesh, face_corners(mesh, &map))?;
    Ok(map)
}

/// The halfedge and the other end of every edge at `v`, counter-clockwise; a boundary edge that only arrives comes last.
pub(crate) fn for_neighbours<M: Adjacency>(mesh: &M, v: VertexId, mut visit: impl FnMut(HalfedgeId, VertexId)) {
    for h in mesh.ring(v) {
        visit(h, mesh.head(h));
        if mesh.twin(h.prev()).is_none() {
            visit(h.prev(), mesh.tail(h.prev()));
        }
    }
}

/// Weights of edges.
pub(crate) enum Pull {
    Uniform,
    Cotangent(CornerMap<f64>),
}

impl Pull {
    pub fn of<M: Faces + Positions + Sync>(mesh: &M, weights: Weights) -> Self {
        match weights {
            Weights::Uniform => Self::Uniform,
            Weights::Cotangent => Self::Cotangent(cotangents(mesh)),
        }
    }

    pub fn along<M: Adjacency>(&self, mesh: &M, h: HalfedgeId) -> f64 {
        match self {
            Self::Uniform => 1.0,
            Self::Cotangent(cotangents) => cotangent_weight(mesh, cotangents, h),
        }
    }
}

/// Whether squares and cubes of a coordinate stay finite.
pub(crate) fn is_usable(p: DVec3) -> bool {
    p.is_finite() && p.abs().max_element() <= 1e100
}

type Pulls = Vec<(u32, u32, f64)>;

fn assemble<M: Adjacency + Positions + Sync>(
    mesh: &M,
    unknowns: &VertexMap<Node>,
    free: &[VertexId],
    pull: &Pull,
) -> Result<(LowerTriangle<f64>, Pulls), Error> {
    let mut lower = LowerTriangle::default();
    let mut pulls = Vec::new();
    let mut column: Vec<(u32, f64)> = Vec::new();
    for (i, &v) in (0..).zip(free) {
        let mut diagonal = 0.0;
        column.clear();
        column.push((i, 0.0));
        for_neighbours(mesh, v, |h, w| {
            let pull = pull.along(mesh, h);
            diagonal += pull;
            match unknowns[w] {
                Node::Fixed(k) => pulls.push((i, k, pull)),
                Node::Free(j) if j > i => column.push((j, -pull)),
                _ => {}
            }
        });
        if diagonal.is_nan() || diagonal <= 0.0 {
            return Err(Error::Loose { vertex: v, at: mesh.position(v) });
        }
        column[0].1 = diagonal;
        column.sort_unstable_by_key(|c| c.0);
        lower.column(&column);
    }
    Ok((lower, pulls))
}

fn factorise<M: Positions>(mesh: &M, lower: &LowerTriangle<f64>, free: &[VertexId]) -> Result<Cholesky, Error> {
    let singular = |vertex| Error::Singular { vertex, at: mesh.position(vertex) };
    Cholesky::new(lower).map_err(|e| singular(free[e.unknown]))
}
