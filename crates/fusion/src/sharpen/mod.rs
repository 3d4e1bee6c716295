//! Roundings taken back: the surfaces beside a fillet are prolonged until they meet in an edge (\[Liu2005\] §6.2).
//!
//! The paper moves the vertices between two linkages onto the profile P1–P0–P2. Here the rounding is found by the ball
//! that cannot rest on it, taken out, and the planes tangent at its borders, which hold P1–P0 and P0–P2, put in.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | the stages, one place after the other |
//! | `refusal.rs` | why a rounding cannot be sharpened |
//! | `rounding.rs` | which faces are rounded |
//! | `rim.rs` | their border: two sides, and the creases at which an open rounding ends |
//! | `edge.rs` | the edge in which the sides meet, and the surface up to it |

mod edge;
mod refusal;
mod rim;
mod rounding;

pub use refusal::Refusal;

use crate::outcome::{Outcome, finish_as};
use crate::validity::Promise;
use crate::{Counts, Error, Report, extent};
use edge::Edge;
use glam::DVec3;
use mesh_core::{
    Connected, FaceId, FaceOrigin, Faces, Origins, Positions, Stage, TriMesh, VertexId, VertexOrigin, Watch,
    boundary_loops, centroid,
};
use mesh_io::{Format, Model};
use rim::Rim;
use rounding::Rounding;

/// What is sharpened.
#[derive(Clone, Debug)]
pub struct Params {
    /// A place on each rounding, in model units.
    pub near: Vec<DVec3>,
    /// What is rounded by this radius or less is sharpened; by as much as at each place where left out.
    pub radius: Option<f64>,
    /// Least turn of a crease, at which roundings end, in degrees.
    pub angle: f64,
    /// The format the result is meant for, whose rounding it must survive.
    pub format: Format,
}

/// Takes back the roundings at the places given, one after the other. All that is not rounded keeps its bits and its order.
///
/// O(n log n) for the search, then in proportion to the rounding; quadratic in the vertices along its sides.
///
/// # Errors
/// [`Error::Sharpen`] with a place and a reason.
pub fn sharpen(part: &Model, params: &Params, watch: &Watch) -> Result<Outcome, Error> {
    extent::check(std::slice::from_ref(part))?;
    let mut report = Report::new("blend", vec![Counts::of("", &part.mesh)]);
    let mut mesh = report
        .time("connect", || Connected::new(part.mesh.clone()))
        .map_err(|source| Error::NotManifold { part: 0, source })?;
    let openings = boundary_loops(&mesh).len();
    let mut origins = Origins::identity(0, mesh.vertex_count(), mesh.face_count());
    for (i, &at) in params.near.iter().enumerate() {
        watch.step("sharpen", i as f64 / params.near.len() as f64)?;
        let made = report.time("sharpen", || sharpen_one(&mesh, at, params, watch))?;
        report.notes.push(format!(
            "the rounding near {at}, of radius {:.6}, became an edge of length {:.6}",
            made.radius, made.length
        ));
        *report.figures.entry("sharpened".into()).or_default() += 1.0;
        origins = made.origins.compose(&[Stage { origins: &origins, faces: &mesh }], &[&part.mesh as &dyn Faces]);
        mesh = Connected::new(made.mesh).map_err(|e| Refusal::Meets { at: e.place.unwrap_or(at) })?;
    }
    let promise = Promise::Openings(openings);
    finish_as(promise, std::slice::from_ref(part), mesh.into_mesh(), origins, params.format, report, watch)
}

/// One rounding sharpened.
struct Sharpened {
    mesh: TriMesh,
    /// With respect to the mesh before.
    origins: Origins,
    /// Of the ball that fits the rounding where it was picked.
    radius: f64,
    /// Of the new edge.
    length: f64,
}

fn sharpen_one(mesh: &Connected<TriMesh>, at: DVec3, params: &Params, watch: &Watch) -> Result<Sharpened, Error> {
    let rounding = Rounding::find(mesh, at, params.radius, params.angle)?;
    let rim = Rim::around(mesh, &rounding)?;
    if let (false, Some([end, _])) = (rounding.convex, &rim.ends) {
        return Err(Refusal::OpenValley { at: mesh.position(end.vertices[0]) }.into());
    }
    let edge = Edge::between(&rim)?;
    let (made, origins, first_new) = put_in(mesh, &rounding, &rim, &edge);
    let new: Vec<FaceId> = (first_new..made.face_count()).map(FaceId::from).collect();
    let hits = tri_intersect::self_intersections_among(&made, &new, watch).map_err(|error| match error {
        tri_intersect::Error::Cancelled(c) => Error::from(c),
        _ => Refusal::Meets { at }.into(),
    })?;
    if let Some(pair) = hits.first() {
        return Err(Refusal::Meets { at: centroid(made.triangle(pair[0])) }.into());
    }
    let closing = rim.ends.is_none().then(|| edge.points[0]);
    let points: Vec<DVec3> = edge.points.iter().copied().chain(closing).collect();
    let length = points.windows(2).map(|w| w[0].distance(w[1])).sum();
    Ok(Sharpened { mesh: made, origins, radius: rounding.radius, length })
}

/// The mesh without the rounding and with the prolonged sides, its origins, and its first new face.
fn put_in(mesh: &Connected<TriMesh>, rounding: &Rounding, rim: &Rim, edge: &Edge) -> (TriMesh, Origins, usize) {
    let kept = || mesh.face_ids().filter(|&f| rounding.of[f] != 2);
    let mut used = vec![false; mesh.vertex_count()];
    kept().flat_map(|f| mesh.corners(f)).for_each(|v| used[v.index()] = true);
    let mut ids = vec![VertexId(u32::MAX); used.len()];
    let mut made = TriMesh::default();
    let mut vertex_origins = vec![];
    for v in mesh.vertex_ids().filter(|v| used[v.index()]) {
        ids[v.index()] = VertexId::from(made.positions.len());
        made.positions.push(mesh.position(v));
        vertex_origins.push(VertexOrigin::Input { part: 0, vertex: v });
    }
    let after = mesh.vertex_count() as u32;
    let shift = made.positions.len() as u32;
    made.positions.extend_from_slice(&edge.points);
    vertex_origins.extend(edge.points.iter().map(|_| VertexOrigin::New { stage: STAGE }));
    let id = |v: VertexId| if v.0 < after { ids[v.index()] } else { VertexId(v.0 - after + shift) };
    made.faces.extend(kept().map(|f| mesh.corners(f).map(id)));
    let mut face_origins: Vec<FaceOrigin> = kept().map(|face| FaceOrigin::Input { part: 0, face }).collect();
    let first_new = made.faces.len();
    made.faces.extend(edge.faces(rim, after).into_iter().map(|f| f.map(id)));
    face_origins.resize(made.faces.len(), FaceOrigin::New { stage: STAGE });
    (made, Origins { vertices: vertex_origins.into(), faces: face_origins.into() }, first_new)
}

/// What made the new vertices and faces.
const STAGE: &str = "blend";
