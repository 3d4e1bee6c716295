//! Isotropic remeshing: rounds of split, collapse, flip, relax and project.

mod agenda;
mod features;
mod grade;
mod lines;
mod params;
mod refine;
mod relax;
mod seat;
mod state;
mod table;

use crate::Error;
use features::find_features;
use glam::DVec3;
pub use grade::graded_sizes;
use mesh_core::{
    Adjacency, Connected, EditObserver, FaceId, FaceOrigin, Faces, Origins, Positions, TriMesh, VertexId, VertexOrigin,
    Watch,
};
pub use params::{Frozen, Params, Projection, Remeshed, Sizing};
use rayon::prelude::*;
pub use refine::refine;
use relax::{Rings, undo_folds};
use seat::{Ground, Seat};
pub(crate) use state::keeps_side;
use state::{Kind, State};
pub(crate) use table::{LOCKED, NONE, Table};

/// The stage's name in origins and progress.
const STAGE: &str = "remesh";

/// Remeshes a surface to triangles that are nearly equilateral and of the wanted size. See [`remesh_observed`].
///
/// # Errors
/// [`Error`].
pub fn remesh<M: Faces + Positions + Sync>(
    mesh: &Connected<M>,
    frozen: &Frozen,
    sizing: Sizing<'_>,
    params: &Params,
    projection: Projection<'_>,
    watch: &Watch,
) -> Result<Remeshed, Error> {
    remesh_observed(mesh, frozen, sizing, params, projection, &mut (), watch)
}

/// Remeshes a surface, telling every edit to `observer`, which may forbid it (\[BotschKobbelt2004\]).
///
/// Each round splits edges longer than 4/3 of the wanted length, collapses those shorter than 4/5 of it, flips towards
/// valence 6, relaxes along the surface towards equal areas, and projects. The boundary and what is frozen keep their
/// bits; feature polylines keep their corners, and their other vertices slide along them. No edit turns a face's normal by more than
/// 73°, and none makes the surface non-manifold or changes its genus. Whether distant parts of the surface come to cross
/// each other, where an edge is long beside the gap between them, is not checked.
///
/// O(rounds · (n + m)) for n input and m output triangles. The same input gives the same bits for any thread count.
///
/// # Errors
/// [`Error::NotPositive`], [`Error::NotFinite`], [`Error::TooFine`], [`Error::Count`], [`Error::Cancelled`].
pub fn remesh_observed<M: Faces + Positions + Sync, O: EditObserver>(
    mesh: &Connected<M>,
    frozen: &Frozen,
    sizing: Sizing<'_>,
    params: &Params,
    projection: Projection<'_>,
    observer: &mut O,
    watch: &Watch,
) -> Result<Remeshed, Error> {
    let mut state = prepare(mesh, frozen, sizing, params, observer)?;
    let ground = Ground::new(mesh);
    for round in 0..params.rounds {
        let done = |part: f64| watch.step(STAGE, (round as f64 + part) / params.rounds as f64);
        done(0.0)?;
        state.split_long(params.max_faces);
        done(0.2)?;
        state.collapse_short();
        done(0.4)?;
        state.flip_to_valence();
        done(0.6)?;
        relax_and_project(&mut state, &ground, params, projection);
        if let Sizing::Field(size) = sizing {
            resize(&mut state, size, params.edge_length);
        }
    }
    Ok(finish(mesh, &state, &ground, projection))
}

fn relax_and_project<M: Adjacency + Positions + Sync, O: EditObserver>(
    state: &mut State<'_, O>,
    ground: &Ground<'_, M>,
    params: &Params,
    projection: Projection<'_>,
) {
    let before = state.points.clone();
    let rings = Rings::of(&state.table, &state.kinds);
    let sliding: Vec<u32> = (0..state.table.vertex_count())
        .filter(|&v| state.kind(v) == Kind::Line && state.table.out[v as usize] != NONE)
        .collect();
    let arcs: Vec<(u32, f64)> = sliding.iter().map(|&v| (v, state.lines.arc(v))).collect();
    let weights = rings.weights(&state.table, &state.points, &state.sizes);
    rings.relax(&mut state.points, &weights, params.relaxations, params.lambda);
    for _ in 0..params.relaxations {
        for &v in &sliding {
            if let Some(place) = state.lines.relax(v, params.lambda) {
                state.points[v as usize] = place;
            }
        }
    }
    match projection {
        Projection::Off => {}
        Projection::Input => {
            let normals = rings.normals(&state.points);
            let (points, starts, sizes) = (&state.points, &state.seats, &state.sizes);
            let seats: Vec<Seat> = rings
                .moving
                .par_iter()
                .zip(normals)
                .with_min_len(256)
                .map(|(&v, normal)| {
                    let v = v as usize;
                    ground.settle(points[v], starts[v], normal, 0.25 * sizes[v])
                })
                .collect();
            for (&v, seat) in rings.moving.iter().zip(seats) {
                state.points[v as usize] = seat.point;
                state.seats[v as usize] = seat.face;
            }
        }
        Projection::Field(project) => {
            let mut moved: Vec<DVec3> = rings.moving.iter().map(|&v| state.point(v)).collect();
            project(&mut moved);
            for (&v, p) in rings.moving.iter().zip(moved) {
                state.points[v as usize] = if p.is_finite() { p } else { before[v as usize] };
            }
        }
    }
    undo_folds(state, &before, &arcs);
}

fn resize<O>(state: &mut State<'_, O>, size: &(dyn Fn(DVec3) -> f64 + Sync), fallback: f64) {
    let points = &state.points;
    state.sizes.par_iter_mut().with_min_len(256).zip(points).for_each(|(s, &p)| *s = usable(size(p), fallback));
}

fn usable(size: f64, fallback: f64) -> f64 {
    if size.is_finite() && size > 0.0 { size } else { fallback }
}

/// Checks the job and sets up the editable surface.
fn prepare<'a, M: Faces + Positions + Sync, O>(
    mesh: &Connected<M>,
    frozen: &Frozen,
    sizing: Sizing<'_>,
    params: &Params,
    observer: &'a mut O,
) -> Result<State<'a, O>, Error> {
    let (vertices, faces) = (mesh.vertex_count(), mesh.face_count());
    if !(params.edge_length > 0.0 && params.edge_length < 1e100) {
        return Err(Error::NotPositive { name: "edge length", value: params.edge_length });
    }
    if !(params.lambda > 0.0 && params.lambda <= 1.0) {
        return Err(Error::NotPositive { name: "lambda (at most 1)", value: params.lambda });
    }
    for (name, found, expected) in
        [("frozen vertices", frozen.vertices.len(), vertices), ("frozen faces", frozen.faces.len(), faces)]
    {
        if found != 0 && found != expected {
            return Err(Error::Count { name, found, expected });
        }
    }
    let points: Vec<DVec3> = mesh.vertex_ids().map(|v| mesh.position(v)).collect();
    let fine = |p: &DVec3| p.is_finite() && p.abs().max_element() < 1e100;
    if let Some(v) = points.iter().position(|p| !fine(p)) {
        return Err(Error::NotFinite { vertex: VertexId::from(v), place: points[v] });
    }
    let sizes: Vec<f64> = match sizing {
        Sizing::Uniform => vec![params.edge_length; vertices],
        Sizing::PerVertex(sizes) if sizes.len() != vertices => {
            return Err(Error::Count { name: "sizes", found: sizes.len(), expected: vertices });
        }
        Sizing::PerVertex(sizes) => sizes.as_slice().iter().map(|&s| usable(s, params.edge_length)).collect(),
        Sizing::Field(size) => points.par_iter().map(|&p| usable(size(p), params.edge_length)).collect(),
    };
    check_count(mesh, &sizes, params)?;
    let mut table = Table::new(mesh);
    let mut kinds = vec![Kind::Free; vertices];
    let is_frozen = |f: u32| frozen.faces.get(FaceId(f)).copied().unwrap_or(false);
    for h in 0..table.halfedge_count() {
        if is_frozen(h / 3) {
            table.flags[h as usize] |= LOCKED;
            if table.twin(h) != NONE {
                let t = table.twin(h);
                table.flags[t as usize] |= LOCKED;
            }
        }
        if table.flags[h as usize] & LOCKED != 0 {
            kinds[table.tail(h) as usize] = Kind::Fixed;
            kinds[table.head(h) as usize] = Kind::Fixed;
        }
    }
    for (kind, _) in kinds.iter_mut().zip(frozen.vertices.as_slice()).filter(|k| *k.1) {
        *kind = Kind::Fixed;
    }
    let lines = find_features(&mut table, &points, &mut kinds, &sizes, params);
    let targets = targets(&table, &points, &kinds, is_frozen);
    let seats = table.out.iter().map(|&h| if h == NONE { 0 } else { h / 3 }).collect();
    Ok(State { table, points, kinds, sizes, targets, seats, lines, observer })
}

/// Refuses jobs whose result would be too large to hold.
fn check_count<M: Faces + Positions + Sync>(mesh: &Connected<M>, sizes: &[f64], params: &Params) -> Result<(), Error> {
    let faces: f64 = mesh
        .face_ids()
        .map(|f| {
            let corners = mesh.corners(f);
            let wanted = corners.iter().map(|v| sizes[v.index()]).sum::<f64>() / 3.0;
            mesh_core::area_vector(corners.map(|v| mesh.position(v))).length() / (0.433 * wanted * wanted)
        })
        .sum();
    if faces <= params.max_faces as f64 {
        return Ok(());
    }
    let smallest = params.edge_length * (faces / params.max_faces as f64).sqrt();
    Err(Error::TooFine { edge_length: params.edge_length, faces, max: params.max_faces, smallest })
}

/// The wanted valence: six inside; where a vertex cannot move, as many triangles as fit its angle, beside those that
/// are frozen.
fn targets(table: &Table, points: &[DVec3], kinds: &[Kind], is_frozen: impl Fn(u32) -> bool) -> Vec<u8> {
    let target = |v: u32| {
        if kinds[v as usize] != Kind::Fixed {
            return 6;
        }
        let (mut kept, mut angle) = (0, 0.0);
        for h in table.ring(v) {
            if is_frozen(h / 3) {
                kept += 1;
            } else {
                let corners = [v, table.head(h), table.apex(h)].map(|v| points[v as usize]);
                angle += mesh_core::corner_angle(corners, 0);
            }
        }
        let free = (angle / std::f64::consts::FRAC_PI_3).round().max(1.0) as i32;
        (kept + free + i32::from(table.is_boundary(v))).clamp(2, 200) as u8
    };
    (0..table.vertex_count()).map(target).collect()
}

/// Packs what is left, in id order, and tells where it came from.
fn finish<M: Faces + Positions + Sync, O>(
    mesh: &Connected<M>,
    state: &State<'_, O>,
    ground: &Ground<'_, Connected<M>>,
    projection: Projection<'_>,
) -> Remeshed {
    let (table, points, kinds, seats) = (&state.table, &state.points, &state.kinds, &state.seats);
    let inputs = mesh.vertex_count() as u32;
    let alone = |v: u32| v < inputs && mesh.outgoing(VertexId(v)).is_none();
    let alive: Vec<u32> = (0..table.vertex_count()).filter(|&v| table.out[v as usize] != NONE || alone(v)).collect();
    let mut ids = vec![NONE; table.vertex_count() as usize];
    for (new, &v) in alive.iter().enumerate() {
        ids[v as usize] = new as u32;
    }
    let new = VertexOrigin::New { stage: STAGE };
    let origin = |v: u32| {
        let p = points[v as usize];
        if v < inputs && p == mesh.position(VertexId(v)) {
            return VertexOrigin::Input { part: 0, vertex: VertexId(v) };
        }
        if !matches!(projection, Projection::Input) || kinds[v as usize] != Kind::Free {
            return new;
        }
        let seat = ground.settle(p, seats[v as usize], DVec3::ZERO, f64::INFINITY);
        VertexOrigin::Face { part: 0, face: FaceId(seat.face), barycentric: seat.barycentric }
    };
    let live: Vec<u32> = (0..table.halfedge_count() / 3).filter(|&f| table.is_alive(3 * f)).collect();
    let corners = |f: u32| [0, 1, 2].map(|k| VertexId(ids[table.tail(3 * f + k) as usize]));
    let whole = |f: u32| {
        (f as usize) < mesh.face_count()
            && mesh
                .corners(FaceId(f))
                .into_iter()
                .zip([0, 1, 2])
                .all(|(v, k)| table.tail(3 * f + k) == v.0 && points[v.index()] == mesh.position(v))
    };
    Remeshed {
        origins: Origins {
            vertices: alive.par_iter().with_min_len(256).map(|&v| origin(v)).collect::<Vec<_>>().into(),
            faces: live
                .iter()
                .map(|&f| {
                    if whole(f) {
                        FaceOrigin::Input { part: 0, face: FaceId(f) }
                    } else {
                        FaceOrigin::New { stage: STAGE }
                    }
                })
                .collect::<Vec<_>>()
                .into(),
        },
        mesh: TriMesh {
            positions: alive.iter().map(|&v| points[v as usize]).collect(),
            faces: live.iter().map(|&f| corners(f)).collect(),
        },
        edit_ids: alive.iter().map(|&v| VertexId(v)).collect::<Vec<_>>().into(),
    }
}
