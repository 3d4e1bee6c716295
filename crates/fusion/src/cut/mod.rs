//! Cuts by planes, of which the side that the normal points away from stays, and by closed paths over the surface; either with clean rims.
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
//! | `scissor.rs`, `crease.rs` | closed paths through a few picks, along concave creases |
//! | `smooth.rs` | contours and paths made smooth on the surface |
//! | `keep.rs` | the side that stays, as a mesh of its own |
//! | `error.rs` | why a cut is not possible |

mod crease;
mod error;
mod keep;
mod scissor;
mod section;
mod smooth;

pub use error::Error;

use crate::outcome::{Outcome, finish_as};
use crate::validity::Promise;
use crate::{Counts, Report, extent};
use glam::DVec3;
use keep::{kept_faces, kept_side, submesh};
use mesh_core::{Connected, Faces, Origins, Stage, TriMesh, Watch, boundary_loops};
use mesh_io::{Format, Model};
use scissor::closed_path;
use section::Section;
pub(crate) use smooth::even;
use smooth::smoothed;
use tri_intersect::embed::{EmbedError, EmbedParams, embed};

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
    /// Rounds by which closed contours are made smooth on the surface, off the plane.
    pub smooth: usize,
}

impl PlaneCut {
    /// Cuts along the whole plane, exactly.
    pub const fn new(point: DVec3, normal: DVec3) -> Self {
        // Enough to leave no edge that rounding could fold.
        Self { point, normal, seed: None, snap: 1e-6, smooth: 0 }
    }
}

/// A closed path over the surface through a few picks, along concave creases where there are any.
#[derive(Clone, Debug, PartialEq)]
pub struct PathCut {
    /// Two points or more near the surface, in order round the limb, in model units. The path closes by itself.
    pub picks: Vec<DVec3>,
    /// Which side stays.
    pub keep: Keep,
    /// How strongly creases attract: a unit of length costs 1 / (1 + this) in one. 0 gives the geodesic.
    pub crease: f64,
    /// As for a plane.
    pub snap: f64,
    /// As for a plane.
    pub smooth: usize,
}

impl PathCut {
    /// Cuts along the path, of which the larger side stays.
    pub const fn new(picks: Vec<DVec3>) -> Self {
        // Paths hug vertices in creases; a share of 0.05 leaves hardly a needle.
        Self { picks, keep: Keep::Larger, crease: 4.0, snap: 0.05, smooth: 0 }
    }
}

/// Which side of a path stays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Keep {
    /// The one with more area.
    #[default]
    Larger,
    /// The one with less.
    Smaller,
    /// The one with the point of the surface nearest to this.
    Near(DVec3),
}

/// One cut.
#[derive(Clone, Debug, PartialEq)]
pub enum Cut {
    /// Along a plane.
    Plane(PlaneCut),
    /// Along a path over the surface.
    Path(PathCut),
}

impl From<PlaneCut> for Cut {
    fn from(plane: PlaneCut) -> Self {
        Self::Plane(plane)
    }
}

impl From<PathCut> for Cut {
    fn from(path: PathCut) -> Self {
        Self::Path(path)
    }
}

/// The cuts, in order.
#[derive(Clone, Debug)]
pub struct Params {
    /// Each is made in what the ones before it have left.
    pub cuts: Vec<Cut>,
    /// The format the result is meant for, whose rounding it must survive.
    pub format: Format,
}

impl Params {
    /// Cuts for a format.
    pub fn new<C: Into<Cut>>(cuts: Vec<C>, format: Format) -> Self {
        Self { cuts: cuts.into_iter().map(Into::into).collect(), format }
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
    extent::check(std::slice::from_ref(part))?;
    let mut report = Report::new("cut", vec![Counts::of("", &part.mesh)]);
    let mut origins = Origins::identity(0, part.mesh.vertex_count(), part.mesh.face_count());
    let mut mesh = report
        .time("connect", || Connected::new(part.mesh.clone()))
        .map_err(|source| crate::Error::NotManifold { part: 0, source })?;
    let mut contours = 0;
    for one in &params.cuts {
        let (kept, step, count) = match one {
            Cut::Plane(plane) => report.time("cut", || cut_plane(&mesh, plane, watch))?,
            Cut::Path(path) => {
                let (kept, step, cost) = report.time("cut", || cut_path(&mesh, path, watch))?;
                report.figures.insert("path_cost".into(), cost[0]);
                report.figures.insert("geodesic_cost".into(), cost[1]);
                (kept, step, 1)
            }
        };
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
fn cut_plane(
    mesh: &Connected<TriMesh>,
    plane: &PlaneCut,
    watch: &Watch,
) -> Result<(Connected<TriMesh>, Origins, usize), Error> {
    cut_section(mesh, &Section::new(mesh, plane)?, plane, watch)
}

fn cut_section(
    mesh: &Connected<TriMesh>,
    section: &Section<'_>,
    plane: &PlaneCut,
    watch: &Watch,
) -> Result<(Connected<TriMesh>, Origins, usize), Error> {
    let curves = section.contours(plane.seed)?;
    let curves = curves.iter().map(|c| smoothed(mesh, c, plane.smooth)).collect::<Result<Vec<_>, _>>()?;
    let params = EmbedParams { snap: plane.snap.clamp(0.0, 0.25), ..EmbedParams::default() };
    let embedded = embed(mesh, &curves, &params, watch).map_err(|e| section.explain(e))?;
    let open: Vec<bool> = curves.iter().map(|c| c.closed).collect();
    let parted = Connected::new(embedded.mesh).map_err(|e| Error::Pinched { at: e.place.unwrap_or(plane.point) })?;
    let kept = kept_faces(&parted, &embedded.curves, &open, section, plane.seed.is_some())?;
    let (left, origins) = submesh(&parted, &embedded.origins, &kept);
    let left = Connected::new(left).map_err(|e| Error::Pinched { at: e.place.unwrap_or(plane.point) })?;
    Ok((left, origins, curves.len()))
}

/// One path: what stays, where it came from, and what the path and the geodesic cost.
fn cut_path(
    mesh: &Connected<TriMesh>,
    path: &PathCut,
    watch: &Watch,
) -> Result<(Connected<TriMesh>, Origins, [f64; 2]), Error> {
    let found = closed_path(mesh, &path.picks, path.crease.max(0.0), watch)?;
    let curve = smoothed(mesh, &found.curve, path.smooth)?;
    let params = EmbedParams { snap: path.snap.clamp(0.0, 0.25), ..EmbedParams::default() };
    let embedded = embed(mesh, &[curve], &params, watch).map_err(|e| match e {
        EmbedError::Crossings(all) => Error::Crossed { at: all.first().map_or(path.picks[0], |c| c.place) },
        EmbedError::Cancelled(c) => c.into(),
        other => other.into(),
    })?;
    let pinched = |e: mesh_core::NotManifold| Error::Crossed { at: e.place.unwrap_or(path.picks[0]) };
    let parted = Connected::new(embedded.mesh).map_err(pinched)?;
    let kept = kept_side(&parted, &embedded.curves[0], path.keep)?;
    let (left, origins) = submesh(&parted, &embedded.origins, &kept);
    let left = Connected::new(left).map_err(pinched)?;
    Ok((left, origins, found.cost))
}

/// Takes away what has a height of zero or more, one height per vertex; what stays, and where it came from.
pub(crate) fn trim(
    mesh: &Connected<TriMesh>,
    heights: &[f64],
    watch: &Watch,
) -> Result<(Connected<TriMesh>, Origins), Error> {
    let section = Section::of_heights(mesh, heights.to_vec());
    let (left, origins, _) = cut_section(
        mesh,
        &section,
        &PlaneCut { snap: 0.05, ..PlaneCut::new(mesh_core::bounds(mesh).center(), DVec3::Z) },
        watch,
    )?;
    Ok((left, origins))
}
