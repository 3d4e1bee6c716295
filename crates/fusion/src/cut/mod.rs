//! Cuts by planes: the side that the normal points away from stays, with clean rims.
//!
//! ```
//! use fusion::cut::{Params, PlaneCut, cut};
//! use fusion::mesh_core::{Watch, shapes};
//! use glam::DVec3;
//! let ball = shapes::icosphere(1.0, 3).into();
//! let plane = PlaneCut::new(DVec3::new(0.0, 0.0, 0.5), DVec3::Z);
//! let outcome = cut(&ball, &Params::new(vec![plane], "off".parse()?), &Watch::default())?;
//! assert!(outcome.model.mesh.positions.iter().all(|p| p.z <= 0.5 + 1e-15));
//! assert_eq!(outcome.report.figures["rims"], 1.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `section.rs` | the contours of a plane on a mesh, and the one nearest a seed |
//! | `keep.rs` | the side that stays, as a mesh of its own |
//! | `error.rs` | why a plane cannot cut |

mod error;
mod keep;
mod section;

pub use error::Error;

use crate::outcome::{Outcome, Promise, finish_as};
use crate::{Counts, Report};
use glam::DVec3;
use keep::{kept_faces, submesh};
use mesh_core::{Connected, Faces, Origins, Stage, TriMesh, Watch, boundary_loops};
use mesh_io::{Format, Model};
use section::Section;
use tri_intersect::embed::{EmbedParams, embed};

/// One plane, and how much of its section is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneCut {
    /// A point of the plane, in model units.
    pub point: DVec3,
    /// The plane's normal, of any length. The side it points to is removed.
    pub normal: DVec3,
    /// Cut only the contour nearest to this point, however often the plane meets the mesh elsewhere.
    pub seed: Option<DVec3>,
    /// Crossings nearer to a vertex than this share of the edge move onto the vertex, in [0, 0.25]. More gives rims without short
    /// edges, and takes them off the plane by that share of an edge at most.
    pub snap: f64,
}

impl PlaneCut {
    /// Cuts along the whole plane, exactly.
    pub const fn new(point: DVec3, normal: DVec3) -> Self {
        // Enough to leave no edge that rounding could fold.
        Self { point, normal, seed: None, snap: 1e-6 }
    }
}

/// The cuts, in order.
#[derive(Clone, Debug)]
pub struct Params {
    /// Each is made in what the ones before it have left.
    pub cuts: Vec<PlaneCut>,
    /// The format the result is meant for, whose rounding it must survive.
    pub format: Format,
}

impl Params {
    /// Cuts for a format.
    pub const fn new(cuts: Vec<PlaneCut>, format: Format) -> Self {
        Self { cuts, format }
    }
}

/// Cuts `part`. Vertices and faces that stay keep their bits and their order; cut faces are split exactly along the contours, whose
/// points lie on edges of the mesh. O(n) per cut.
///
/// Vertices in the plane count as beyond it, so that a plane through a ring of vertices leaves that ring as the rim.
///
/// # Errors
/// [`crate::Error`]; a cut that is not possible comes as [`Error`] with the place.
pub fn cut(part: &Model, params: &Params, watch: &Watch) -> Result<Outcome, crate::Error> {
    let mut report = Report::new("cut", vec![Counts::of("", &part.mesh)]);
    let mut origins = Origins::identity(0, part.mesh.vertex_count(), part.mesh.face_count());
    let mut mesh = report
        .time("connect", || Connected::new(part.mesh.clone()))
        .map_err(|source| crate::Error::NotManifold { part: 0, source })?;
    let mut contours = 0;
    for plane in &params.cuts {
        let (kept, step, count) = report.time("cut", || cut_once(&mesh, plane, watch))?;
        origins = step.compose(&[Stage { origins: &origins, faces: &mesh }], &[&part.mesh]);
        mesh = kept;
        contours += count;
    }
    report.figures.insert("contours".into(), contours as f64);
    report.figures.insert("rims".into(), boundary_loops(&mesh).len() as f64);
    let parts = std::slice::from_ref(part);
    finish_as(Promise::Manifold, parts, mesh.into_mesh(), origins, params.format, report, watch)
}

/// One plane: what stays, where it came from, and how many contours were cut.
fn cut_once(
    mesh: &Connected<TriMesh>,
    plane: &PlaneCut,
    watch: &Watch,
) -> Result<(Connected<TriMesh>, Origins, usize), Error> {
    let section = Section::new(mesh, plane)?;
    let curves = section.contours(plane.seed)?;
    let params = EmbedParams { snap: plane.snap.clamp(0.0, 0.25), ..EmbedParams::default() };
    let embedded = embed(mesh, &curves, &params, watch).map_err(|e| section.explain(e))?;
    let open: Vec<bool> = curves.iter().map(|c| c.closed).collect();
    let parted = Connected::new(embedded.mesh).map_err(|e| Error::Pinched { at: e.place.unwrap_or(plane.point) })?;
    let kept = kept_faces(&parted, &embedded.curves, &open, &section, plane.seed.is_some())?;
    let (left, origins) = submesh(&parted, &embedded.origins, &kept);
    let left = Connected::new(left).map_err(|e| Error::Pinched { at: e.place.unwrap_or(plane.point) })?;
    Ok((left, origins, curves.len()))
}
