//! Composition: any number of openings joined by one smooth surface, the parts untouched ([Lin2008], [Zhu2005]).
//!
//! | file | holds |
//! |---|---|
//! | `openings.rs` | the loops to be joined, and whether the parts are posed so that they can be |
//! | `constraints.rs` | what the field must satisfy |
//! | `surface.rs` | the field's zero set between the openings, tessellated and remeshed |
//! | `lead.rs` | guides through necks that would break |
//! | `weld.rs` | parts and surface as one mesh, and whether it hangs together |
//! | `error.rs` | what can go wrong, where, and what would help |

mod constraints;
mod error;
mod lead;
mod openings;
mod surface;
mod weld;

pub use error::Error;

use crate::outcome::{Outcome, Promise, finish_as};
use crate::{Counts, Report};
use constraints::{constraints, fitting};
use glam::DVec3;
use lead::lead;
use mesh_core::{Connected, TriMesh, Watch};
use mesh_io::{Format, Model};
use openings::{Opening, check_pose, mean_edge, openings};
use rbf_solve::Field;
use surface::{split_chords, surface};
use weld::{Welded, check_pieces, name_crossing, part_edges, weld};

/// How parts are composed.
#[derive(Clone, Debug)]
pub struct Params {
    /// The kernel of the field.
    pub kernel: Kernel,
    /// Which constraints the field gets.
    pub method: Method,
    /// Rings of vertices around each opening that the field interpolates. `None`: 3, but 1 for [`Kernel::Hermite`] and
    /// 0 for [`Method::Montage`].
    pub rings: Option<usize>,
    /// Cells of the tessellation, as a share of the mean boundary edge; smaller where openings are close.
    pub cell: f64,
    /// Edge length of the surface away from the openings, in model units. `None`: that of the nearest openings.
    pub edge_length: Option<f64>,
    /// The loops to be joined, as (part, loop of the part). `None`: all.
    pub loops: Option<Vec<(usize, usize)>>,
    /// Places that the surface passes through besides, from silhouettes.
    pub guides: Vec<Guide>,
    /// How far from the openings' box the surface may go, as a multiple of the box's diagonal.
    pub space: f64,
    /// The format the result is meant for, whose rounding it must survive.
    pub format: Format,
}

impl Params {
    /// The defaults, for a format.
    pub fn new(format: Format) -> Self {
        Self {
            kernel: Kernel::Triharmonic,
            method: Method::Implicit,
            rings: None,
            cell: 1.0,
            edge_length: None,
            loops: None,
            guides: vec![],
            space: 1.0,
            format,
        }
    }

    fn ring_count(&self) -> usize {
        self.rings.unwrap_or(match (self.method, self.kernel) {
            (Method::Montage, _) => 0,
            (_, Kernel::Hermite) => 1,
            _ => 3,
        })
    }
}

/// The kernel of a field.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kernel {
    /// r: shrinks least, but bends sharply at the openings.
    Biharmonic,
    /// r³: smooth, and tolerant of noisy normals.
    #[default]
    Triharmonic,
    /// r³ with the parts' normals interpolated exactly: the smoothest joint, on meshes with clean normals.
    Hermite,
}

/// How the field is held at the openings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Rings of the parts' vertices, and points outside of them.
    #[default]
    Implicit,
    /// Boundary vertices alone, and points on both sides of them ([Zhu2005]).
    Montage,
}

/// A place that the surface passes through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guide {
    /// Where, in model units.
    pub point: DVec3,
    /// The surface's outward normal there.
    pub normal: Option<DVec3>,
}

/// Finer cells that are tried where the wanted ones fail.
const FINENESS: [f64; 3] = [1.0, 1.5, 2.2];

/// Joins the openings of all parts, or the chosen ones, by a smooth surface. The parts' vertices and faces come first,
/// in order and bit for bit, then those of the surface.
///
/// O(n³) for n constraints up to a few thousand, plus O(n) for each vertex of the surface.
///
/// # Errors
/// [`crate::Error`]: parts that are not manifold or badly posed, a surface that does not join them or crosses them.
pub fn compose(parts: &[Model], params: &Params, watch: &Watch) -> Result<Outcome, crate::Error> {
    let mut report = Report::new("compose", parts.iter().map(|m| Counts::of("", &m.mesh)).collect());
    let meshes = report.time("connect", || connect(parts))?;
    let openings = openings(&meshes, params.loops.as_deref())?;
    report.time("pose", || check_pose(&meshes, &openings))?;
    report.figures.insert("loops".into(), openings.len() as f64);
    let mut led = params.clone();
    let mut first_error = None;
    for _ in 0..openings.len() {
        let error = match fitted(parts, &meshes, &openings, &led, report.clone(), watch) {
            Err(crate::Error::Compose(error @ Error::Apart { .. })) => error,
            // Where leading it makes things worse, what was wrong at first says more.
            Err(error) if !error.is_cancelled() => return Err(first_error.map_or(error, crate::Error::Compose)),
            result => return result,
        };
        let guides = if let Error::Apart { joined, .. } = &error { lead(&openings, joined) } else { vec![] };
        if guides.is_empty() {
            return Err(first_error.unwrap_or(error).into());
        }
        if let Error::Apart { part, index, at, .. } = &error {
            report.notes.push(format!(
                "the neck to loop {index} of part {part}, around {at}, broke by itself and is led by {} guides",
                guides.len()
            ));
        }
        led.guides.extend(guides);
        first_error.get_or_insert(error);
    }
    Err(first_error.unwrap_or(Error::Closed).into())
}

/// Fits the field and tries the surface with finer and finer cells.
fn fitted(
    parts: &[Model],
    meshes: &[Connected<TriMesh>],
    openings: &[Opening],
    params: &Params,
    mut report: Report,
    watch: &Watch,
) -> Result<Outcome, crate::Error> {
    let field = report.time("fit", || fit(meshes, openings, params, watch))?;
    report.figures.insert("constraints".into(), field.centres() as f64);
    report.residuals.insert("field".into(), field.residual());
    let mut attempts = FINENESS.into_iter().peekable();
    loop {
        let fineness = attempts.next().unwrap_or(1.0);
        match attempt(parts, meshes, openings, &field, params, fineness, report.clone(), watch) {
            Err(e) if attempts.peek().is_some() && is_local(&e) => report.figures.insert("retries".into(), 1.0),
            result => return result,
        };
    }
}

/// Whether smaller cells may help.
fn is_local(error: &crate::Error) -> bool {
    use lmc_tessellate::Error as L;
    matches!(
        error,
        crate::Error::Compose(Error::Surface(L::Leak { .. } | L::Gap { .. }) | Error::Crossing { .. })
            | crate::Error::Invalid(_)
    )
}

#[expect(clippy::too_many_arguments, reason = "one attempt of the pipeline above")]
fn attempt(
    parts: &[Model],
    meshes: &[Connected<TriMesh>],
    openings: &[Opening],
    field: &Field,
    params: &Params,
    fineness: f64,
    mut report: Report,
    watch: &Watch,
) -> Result<Outcome, crate::Error> {
    let mut made = surface(openings, field, params, fineness, &mut report, watch)?;
    let taken = part_edges(meshes, openings, &made.starts);
    split_chords(&mut made.mesh, &taken, field, 0.5 * mean_edge(openings));
    check_pieces(meshes, openings, &made, &mut report)?;
    let Welded { mesh, origins } = report.time("weld", || weld(meshes, openings, &made));
    let promise = if params.loops.is_none() { Promise::Closed } else { Promise::Manifold };
    finish_as(promise, parts, mesh.clone(), origins.clone(), params.format, report, watch).map_err(|e| match e {
        crate::Error::Invalid(invalid) if invalid.format.is_none() => match name_crossing(&mesh, &origins, watch) {
            Some(crossing) => crossing.into(),
            None => invalid.into(),
        },
        e => e,
    })
}

fn connect(parts: &[Model]) -> Result<Vec<Connected<TriMesh>>, crate::Error> {
    let connect = |(part, model): (usize, &Model)| {
        Connected::new(model.mesh.clone()).map_err(|source| crate::Error::NotManifold { part, source })
    };
    parts.iter().enumerate().map(connect).collect()
}

fn fit(meshes: &[Connected<TriMesh>], openings: &[Opening], params: &Params, watch: &Watch) -> Result<Field, Error> {
    let wanted = constraints(meshes, openings, params);
    let progress = |share: f64| watch.step("fit", share).is_ok();
    Ok(Field::fit(&wanted.all, &fitting(params, wanted.merge), &progress)?)
}
