//! Composition: any number of openings joined by one smooth surface, the parts untouched (\[Lin2008\], \[Zhu2005\]).
//!
//! | file | holds |
//! |---|---|
//! | `adjust.rs` | openings that are too near to others, trimmed |
//! | `openings.rs` | the loops to be joined, and whether the parts are posed so that they can be |
//! | `silhouette.rs`, `bezier.rs` | strokes made into curves that the surface shows as its silhouette |
//! | `constraints.rs` | what the field must satisfy |
//! | `surface.rs` | the field's zero set between the openings, tessellated and remeshed |
//! | `lead.rs` | guides through necks that would break |
//! | `weld.rs` | parts and surface as one mesh, and whether it hangs together |
//! | `error.rs` | what can go wrong, where, and what would help |

mod adjust;
mod bezier;
mod constraints;
mod error;
mod lead;
mod openings;
mod silhouette;
mod surface;
mod weld;

pub use error::Error;
pub use silhouette::{Silhouette, SilhouetteCurve, SilhouettePoint};

use crate::attributes::TRANSITION;
use crate::outcome::{Outcome, finish_as};
use crate::validity::Promise;
use crate::{Counts, Report, extent};
use adjust::adjust;
use constraints::{constraints, fitting};
use glam::DVec3;
use lead::lead;
use mesh_core::{Bounds, Connected, FaceOrigin, Origins, TriMesh, Watch, bounds};
use mesh_io::{Format, Groups, Model};
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
    /// By how many degrees the surface turns inward where it leaves an opening, from −90 to 90; negative outward. 0 is smooth.
    pub crease: f64,
    /// The same for single openings.
    pub creases: Vec<Crease>,
    /// Trims openings nearer than this to an opening of another part back along their own part, in model units. `None`: parts stay whole.
    pub adjust: Option<f64>,
    /// Silhouettes that the surface shall have.
    pub silhouettes: Vec<Silhouette>,
    /// Places that the surface passes through besides.
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
            crease: 0.0,
            creases: vec![],
            adjust: None,
            silhouettes: vec![],
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
    /// Boundary vertices alone, and points on both sides of them (\[Zhu2005\]).
    Montage,
}

/// A transition that is not smooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crease {
    /// The part.
    pub part: usize,
    /// Its loop.
    pub index: usize,
    /// As [`Params::crease`].
    pub angle: f64,
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
    extent::check(parts)?;
    let mut report = Report::new("compose", parts.iter().map(|m| Counts::of("", &m.mesh)).collect());
    let given = report.time("connect", || connect(parts))?;
    let trimmed = params.adjust.map(|d| report.time("adjust", || adjust(&given, params, d, watch))).transpose()?;
    if let Some(t) = &trimmed {
        report.figures.insert("trimmed".into(), t.trimmed as f64);
    }
    let (meshes, params) = trimmed.as_ref().map_or((&given[..], params), |t| (&t.meshes, &t.params));
    let openings = openings(meshes, params)?;
    report.time("pose", || check_pose(meshes, &openings))?;
    let curves = report.time("silhouettes", || silhouette::curves(&openings, &params.silhouettes))?;
    let own = trimmed.as_ref().map(|t| &t.origins[..]);
    let scene = Scene { parts, meshes, own, openings: &openings, curves: &curves };
    report.figures.insert("loops".into(), openings.len() as f64);
    let mut led = params.clone();
    let mut first_error = None;
    for _ in 0..openings.len() {
        let error = match fitted(&scene, &led, report.clone(), watch) {
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

/// What is to be joined.
struct Scene<'a> {
    parts: &'a [Model],
    /// The parts, trimmed if asked for.
    meshes: &'a [Connected<TriMesh>],
    /// The trimmed parts' origins.
    own: Option<&'a [Origins]>,
    openings: &'a [Opening],
    curves: &'a [SilhouetteCurve],
}

/// Fits the field and tries the surface with finer and finer cells.
fn fitted(scene: &Scene<'_>, params: &Params, mut report: Report, watch: &Watch) -> Result<Outcome, crate::Error> {
    let field = report.time("fit", || fit(scene, params, watch))?;
    account(scene, &field, &mut report);
    report.figures.insert("constraints".into(), field.centres() as f64);
    report.residuals.insert("field".into(), field.residual());
    let mut attempts = FINENESS.into_iter().peekable();
    loop {
        let fineness = attempts.next().unwrap_or(1.0);
        match attempt(scene, &field, params, fineness, report.clone(), watch) {
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

fn attempt(
    scene: &Scene<'_>,
    field: &Field,
    params: &Params,
    fineness: f64,
    mut report: Report,
    watch: &Watch,
) -> Result<Outcome, crate::Error> {
    let Scene { parts, meshes, own, openings, .. } = *scene;
    let mut made = surface(openings, field, params, fineness, &mut report, watch)?;
    let taken = part_edges(meshes, openings, &made.starts);
    split_chords(&mut made.mesh, &taken, field, 0.5 * mean_edge(openings));
    check_pieces(meshes, openings, &made, &mut report)?;
    let Welded { mesh, origins } = report.time("weld", || weld(meshes, own, openings, &made));
    let promise = if params.loops.is_none() { Promise::Openings(0) } else { Promise::Manifold };
    let finished = finish_as(promise, parts, mesh.clone(), origins.clone(), params.format, report, watch);
    finished.map(|outcome| named(outcome, params.format)).map_err(|e| match e {
        crate::Error::Invalid(invalid) if invalid.format.is_none() => match name_crossing(&mesh, &origins, watch) {
            Some(crossing) => crossing.into(),
            None => invalid.into(),
        },
        e => e,
    })
}

/// With a group for the transition where no part has groups. In OBJ only: other formats would take the surface apart by its groups.
fn named(mut outcome: Outcome, format: Format) -> Outcome {
    if format == Format::Obj && outcome.model.groups.is_none() {
        let is_new = |o: &FaceOrigin| u32::from(matches!(o, FaceOrigin::New { .. }));
        let of_face = outcome.origins.faces.as_slice().iter().map(is_new).collect::<Vec<_>>().into();
        outcome.model.groups = Some(Groups { of_face, names: [String::new(), TRANSITION.into()].into() });
    }
    outcome
}

fn connect(parts: &[Model]) -> Result<Vec<Connected<TriMesh>>, crate::Error> {
    let connect = |(part, model): (usize, &Model)| {
        Connected::new(model.mesh.clone()).map_err(|source| crate::Error::NotManifold { part, source })
    };
    parts.iter().enumerate().map(connect).collect()
}

fn fit(scene: &Scene<'_>, params: &Params, watch: &Watch) -> Result<Field, Error> {
    let wanted = constraints(scene.meshes, scene.openings, scene.curves, params);
    let progress = |share: f64| watch.step("fit", share).is_ok();
    Ok(Field::fit(&wanted.all, &fitting(params, wanted.merge), &progress)?)
}

/// Notes how well the field keeps to the silhouettes, and where their control points are.
fn account(scene: &Scene<'_>, field: &Field, report: &mut Report) {
    if scene.curves.is_empty() {
        return;
    }
    let size = scene.meshes.iter().map(bounds).fold(Bounds::EMPTY, Bounds::union).diagonal();
    let (mut off, mut turned) = (0.0f64, 0.0f64);
    for (k, curve) in scene.curves.iter().enumerate() {
        for at in &curve.points {
            off = off.max(field.value(at.point).abs() / size);
            turned = turned.max(field.gradient(at.point).normalize_or_zero().dot(curve.view).abs());
        }
        let control = match &curve.control[..] {
            [] => String::new(),
            six => format!(", control points {}", six.iter().map(DVec3::to_string).collect::<Vec<_>>().join(" ")),
        };
        report.notes.push(format!("silhouette {k}: {} places{control}", curve.points.len()));
    }
    report.figures.insert("silhouettes".into(), scene.curves.len() as f64);
    report.residuals.insert("silhouette".into(), off);
    report.residuals.insert("silhouette_normal".into(), turned);
}
