//! From rims and a field to a mesh between the rims: the stages in order.

use crate::border::{normals, smooth};
use crate::error::Error;
use crate::extract::extract;
use crate::gap::{Curves, chords, fill, groups};
use crate::grid::{Field, Grid, KeySet, Limits, follow, key};
use crate::rim::{Near, Rim, Rims};
use crate::trim::{Trimmed, trim};
use glam::{DVec3, IVec3};
use mesh_core::{Bounds, Connected, Faces, Positions, TriMesh, VertexId, Watch, boundary_loops};

/// How a zero set is tessellated between rims.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// Edge of a cell, in model units. [`suggested_cell`] is a good one.
    pub cell: f64,
    /// How much of the zero set in front of a rim is left to the gap, in cells; 0.5 to 1.5.
    pub gap: f64,
    /// Rounds of root finding for every vertex, each one evaluation of the field. 0 interpolates linearly.
    pub steps: u32,
    /// How far from the rims' box the surface may go, as a multiple of the box's diagonal.
    pub space: f64,
    /// Most cells the surface may take; about 500 bytes each.
    pub most_cells: usize,
}

impl Default for Params {
    fn default() -> Self {
        Self { cell: 0.0, gap: 0.8, steps: 2, space: 1.0, most_cells: 1 << 22 }
    }
}

/// The surface between rims.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Transition {
    /// The rims' vertices first, rim after rim, bit for bit; then new ones. Oriented like the parts.
    pub mesh: TriMesh,
    /// The first vertex of each rim, and the first new one.
    pub starts: Vec<u32>,
    /// How many cells the surface takes.
    pub cells: usize,
}

/// A cell size for given rims: 0.8 of their mean edge, but a fifth of the smallest distance between two of them, though
/// not under 0.4 of the mean edge, below which the gap is bridged directly (\[Lin2008\] §3.1). O(n²) in rim vertices.
pub fn suggested_cell(rims: &[Rim]) -> f64 {
    let lengths: Vec<f64> = rims.iter().flat_map(Rim::lengths).collect();
    let edge = lengths.iter().sum::<f64>() / lengths.len() as f64;
    let mut least = f64::INFINITY;
    for (i, a) in rims.iter().enumerate() {
        for b in &rims[i + 1..] {
            for p in &a.points {
                least = b.points.iter().map(|q| p.distance_squared(*q)).fold(least, f64::min);
            }
        }
    }
    (0.8 * edge).min(least.sqrt() / 5.0).max(0.4 * edge)
}

/// Tessellates the zero set of `field` between the rims and welds it to their vertices.
///
/// The field is negative inside and must vanish at the rims' vertices. The surface starts at each rim on the side
/// away from its part and is followed until it meets other rims; sheets that no rim reaches never appear.
/// Deterministic. O(c) evaluations of the field and O(c log c) work for c cells, O(m·n) for gap curves of m and n vertices.
///
/// # Errors
/// [`Error`], with the place.
pub fn tessellate(rims: &[Rim], field: &impl Field, params: &Params, watch: &Watch) -> Result<Transition, Error> {
    let (grid, limits) = lay_out(rims, params)?;
    let samples = Rims::new(rims, field, &grid)?;
    let surface = follow(field, &grid, &seeds(&samples, &grid), |k| in_front(&samples, &grid, k), &limits, watch)?;
    watch.step("tessellate", 0.0)?;
    let mut zero_set = extract(field, &grid, &surface, params.steps);
    let trimmed = trim(&zero_set, &samples, params.gap * grid.size, grid.size)?;
    let normals = normals(&zero_set);
    smooth(&mut zero_set, &trimmed.borders, &normals, field, grid.size);
    let groups = groups(&zero_set, &samples, &trimmed, params.gap * grid.size);
    let (mesh, starts) = assemble(rims, &zero_set, &normals, &trimmed, &groups, grid.size, watch)?;
    check(&mesh, &starts)?;
    Ok(Transition { mesh, starts, cells: surface.cells.len() })
}

fn lay_out(rims: &[Rim], params: &Params) -> Result<(Grid, Limits), Error> {
    if let Some(rim) = rims.iter().position(|r| !r.is_sound()) {
        return Err(Error::BadRim { rim });
    }
    if rims.is_empty() {
        return Err(Error::BadRim { rim: 0 });
    }
    let bounds = Bounds::of(rims.iter().flat_map(|r| r.points.iter().copied()));
    let space = bounds.inflated(params.space.max(0.0) * bounds.diagonal() + 4.0 * params.cell);
    let far = space.min.abs().max(space.max.abs()).max_element();
    let cells = space.diagonal() / params.cell;
    // Keys hold 21 bits for each axis, and coordinates must tell neighbouring cells apart.
    if !(params.cell > 0.0 && cells < f64::from(1 << 20) && far + 1e-6 * params.cell > far) {
        return Err(Error::BadCell { cell: params.cell, suggested: suggested_cell(rims) });
    }
    Ok((Grid { origin: bounds.center(), size: params.cell }, Limits { space, cells: params.most_cells }))
}

/// The cells around all samples: the zero set passes through some of them.
fn seeds(rims: &Rims, grid: &Grid) -> Vec<IVec3> {
    let mut last = IVec3::MAX;
    let (mut seen, mut cells) = (KeySet::default(), vec![]);
    for s in &rims.samples {
        let k = grid.cell_at(s.point);
        if k != last {
            last = k;
            let around = (0..27).map(|i| k + IVec3::new(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
            cells.extend(around.filter(|&beside| seen.insert(key(beside))));
        }
    }
    // Out of reach of the rims, nothing tells the sides apart.
    cells.retain(|&k| rims.near(grid.center(k)).is_some_and(|n| before(n, grid)));
    cells
}

/// Whether a cell is not behind a rim, inside its part.
fn in_front(rims: &Rims, grid: &Grid, k: IVec3) -> bool {
    rims.near(grid.center(k)).is_none_or(|n| before(n, grid))
}

fn before(near: Near, grid: &Grid) -> bool {
    near.side > 0.0 || near.distance < 0.9 * grid.size
}

/// Welds the wanted faces to the rims: vertices of the rims first, then the used ones of the zero set.
fn assemble(
    rims: &[Rim],
    zero_set: &TriMesh,
    normals: &[DVec3],
    trimmed: &Trimmed,
    groups: &[Vec<usize>],
    cell: f64,
    watch: &Watch,
) -> Result<(TriMesh, Vec<u32>), Error> {
    let mut mesh = TriMesh::default();
    let (mut starts, mut curves, mut directions) = (vec![], vec![], vec![]);
    for rim in rims {
        let (first, n) = (mesh.positions.len() as u32, rim.points.len());
        starts.push(first);
        mesh.positions.extend(&rim.points);
        directions.extend((0..n).map(|i| (rim.normals[i] + rim.normals[(i + n - 1) % n]).normalize_or_zero()));
        // The part is on the left of its rim, so the gap is on the right.
        curves.push((first..first + n as u32).rev().collect::<Vec<u32>>());
    }
    starts.push(mesh.positions.len() as u32);
    let mut ids = vec![u32::MAX; zero_set.positions.len()];
    for face in zero_set.faces.iter().zip(&trimmed.kept).filter(|(_, k)| **k).map(|(f, _)| f) {
        mesh.faces.push(face.map(|v| {
            let id = &mut ids[v.index()];
            if *id == u32::MAX {
                *id = mesh.positions.len() as u32;
                mesh.positions.push(zero_set.positions[v.index()]);
                directions.push(normals[v.index()]);
            }
            VertexId(*id)
        }));
    }
    let mut on_border = vec![false; mesh.positions.len()];
    for curve in &trimmed.borders {
        let curve: Vec<u32> = curve.iter().map(|&v| ids[v as usize]).collect();
        for &v in &curve {
            on_border[v as usize] = true;
        }
        curves.push(curve);
    }
    let taken = chords(&mesh.faces, &on_border);
    let all = Curves { positions: &mesh.positions, normals: &directions, closed: &curves, taken: &taken, cell };
    let mut faces = vec![];
    for (i, group) in groups.iter().enumerate() {
        watch.step("tessellate", 0.5 + 0.5 * i as f64 / groups.len() as f64)?;
        faces.extend(fill(group, rims.len(), &all)?);
    }
    mesh.faces.extend(faces.into_iter().map(|t| t.map(VertexId)));
    Ok((mesh, starts))
}

/// The result must be a manifold whose boundary is the rims, turned round.
fn check(mesh: &TriMesh, starts: &[u32]) -> Result<(), Error> {
    let rim_of = |v: VertexId| starts.partition_point(|&s| s <= v.0).saturating_sub(1).min(starts.len() - 2);
    let gap = |v: VertexId| Error::Gap { rim: rim_of(v), at: mesh.position(v) };
    let connected = Connected::new(mesh).map_err(|e| {
        let edge = e.edges.iter().chain(&e.misoriented).flatten().chain(&e.vertices).next().copied();
        gap(edge.unwrap_or(VertexId(0)))
    })?;
    let last = starts[starts.len() - 1];
    let mut open = 0;
    for walk in boundary_loops(&connected) {
        for h in walk {
            let (a, b) = (connected.tail(h), connected.head(h));
            let rim = rim_of(b);
            let n = starts[rim + 1] - starts[rim];
            let next = |v: u32| starts[rim] + (v - starts[rim] + 1) % n;
            if b.0 >= last || a.0 != next(b.0) {
                return Err(gap(a));
            }
            open += 1;
        }
    }
    if open == last as usize { Ok(()) } else { Err(gap(VertexId(0))) }
}
