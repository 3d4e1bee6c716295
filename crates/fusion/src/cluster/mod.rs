//! Polyhedra rounded cluster by cluster, by patches in contact with the faces around (\[EdgeCluster2019\]).
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | the stages, and the loop that shortens reaches where the result would meet itself |
//! | `file.rs` | clusters as a file names them |
//! | `nets.rs` | control nets as JSON |

mod file;
mod nets;

pub use edge_cluster::solids;
pub use edge_cluster::{CoverParams, Degree, Params as PatchParams, PolyhedronParams, Spec, StripParams};
pub(crate) use file::entries_from_toml;
pub use file::{Degrees, Entry, FileError, MoveEntry, clusters_from_toml};

use crate::outcome::{Outcome, finish};
use crate::{Counts, Error, Report, extent};
use edge_cluster::{Blend, Part, Place, Polyhedron, Shape, blend, check_budget, contact_slopes, cover};
use mesh_core::{FaceOrigin, Origins, VertexId, VertexOrigin, Watch};
use mesh_io::{Format, Groups, Model};

/// How a polyhedron is rounded.
#[derive(Clone, Debug)]
pub struct Params {
    /// The clusters; `None` chooses them.
    pub clusters: Option<Vec<Spec>>,
    /// How they are chosen.
    pub cover: CoverParams,
    /// Patches and strips.
    pub patch: PatchParams,
    /// What counts as planar.
    pub polyhedron: PolyhedronParams,
    /// Largest distance of the mesh's chords from the surface, as a share of the polyhedron's diagonal.
    pub tolerance: f64,
    /// The format the result is meant for, whose rounding it must survive.
    pub format: Format,
}

impl Params {
    /// Automatic clusters in contact of order one, with chords within 2e-4 of the diagonal.
    pub fn new(format: Format) -> Self {
        Self {
            clusters: None,
            cover: CoverParams::default(),
            patch: PatchParams::default(),
            polyhedron: PolyhedronParams::default(),
            tolerance: 2e-4,
            format,
        }
    }
}

/// A rounded polyhedron.
#[derive(Clone, Debug)]
pub struct Clustered {
    /// The mesh, with a group for every patch, strip and face, and the report.
    pub outcome: Outcome,
    /// The polyhedron as it was read.
    pub solid: Polyhedron,
    /// The exact surfaces.
    pub blend: Blend,
}

impl Clustered {
    /// The control nets and strips as JSON; docs/cluster.md lists the keys.
    pub fn nets_to_json(&self) -> String {
        nets::to_json(&self.solid, &self.blend)
    }
}

impl Clustered {
    /// The exact blend as a STEP file, and how many S-patches it leaves out; docs/cluster.md says what it holds.
    ///
    /// # Errors
    /// [`Error::Cluster`] where strips run along open edges.
    pub fn to_step(&self) -> Result<(String, usize), Error> {
        let step = edge_cluster::to_step(&self.solid, &self.blend.layout)?;
        Ok((step.text, step.left_out))
    }
}

/// By what reaches are multiplied, one after the other, while the result meets itself in space.
const SHORTER: [f64; 4] = [1.0, 0.8, 0.6, 0.4];

/// Rounds a closed polyhedron: its planar faces are read off the mesh, its clusters chosen unless given, and each is
/// replaced by a patch.
///
/// # Errors
/// [`Error::Cluster`] where the polyhedron or a degree does not allow it; [`Error::Invalid`].
///
/// ```
/// use fusion::cluster::{Params, cluster};
/// use fusion::mesh_core::{Watch, shapes};
/// let cube = shapes::cuboid(glam::DVec3::ONE).into();
/// let round = cluster(&cube, &Params::new(mesh_io::Format::Ply), &Watch::default())?;
/// assert_eq!(round.outcome.report.figures["patches"], 8.0);
/// # Ok::<(), fusion::Error>(())
/// ```
pub fn cluster(part: &Model, params: &Params, watch: &Watch) -> Result<Clustered, Error> {
    extent::check(std::slice::from_ref(part))?;
    let mut report = Report::new("cluster", vec![Counts::of("", &part.mesh)]);
    let mut notes = vec![];
    let polygon_of = part.polygons.as_ref().filter(|p| p.fit(&part.mesh)).map(|p| p.of_face.as_slice());
    let solid = report.time("polyhedron", || Polyhedron::new(&part.mesh, polygon_of, &params.polyhedron))?;
    let specs = if let Some(specs) = &params.clusters {
        specs.clone()
    } else {
        check_budget(&solid, &params.patch)?;
        report.time("cover", || choose(&solid, &params.cover, &mut notes))
    };
    report.notes = notes;
    let mut last = None;
    for shorter in SHORTER {
        let mut attempt = report.clone();
        let tolerance = params.tolerance * solid.size;
        let made = attempt.time("blend", || blend(&solid, &specs, &params.patch, tolerance, shorter, watch))?;
        account(&solid, &made, params, &mut attempt);
        match finish(
            std::slice::from_ref(part),
            made.woven.mesh.clone(),
            origins(&solid, &made),
            params.format,
            attempt,
            watch,
        ) {
            Ok(mut outcome) => {
                outcome.model.groups = Some(groups(&made));
                return Ok(Clustered { outcome, solid, blend: made });
            }
            Err(Error::Invalid(invalid)) => last = Some(Error::Invalid(invalid)),
            Err(other) => return Err(other),
        }
    }
    // SHORTER is not empty, so an attempt has failed.
    Err(last.unwrap_or(Error::Cluster(edge_cluster::Error::Open(glam::DVec3::ZERO))))
}

fn choose(solid: &Polyhedron, params: &CoverParams, notes: &mut Vec<String>) -> Vec<Spec> {
    let found = cover(solid, params);
    notes.extend(found.reasons);
    found.clusters.into_iter().map(|vertices| Spec { vertices, ..Spec::default() }).collect()
}

/// What was made, in numbers.
fn account(solid: &Polyhedron, made: &Blend, params: &Params, report: &mut Report) {
    let nets = &made.layout.nets;
    let tensor = nets.iter().filter(|n| matches!(n.shape, Shape::Tensor(_))).count();
    let reach = made.shrink.iter().copied().fold(1.0, f64::min);
    let mut figure = |name: &str, value: f64| report.figures.insert(name.into(), value);
    figure("patches", nets.len() as f64);
    figure("tensor_patches", tensor as f64);
    figure("strips", made.layout.strips.len() as f64);
    figure("control_points", nets.iter().map(|n| n.points.len()).sum::<usize>() as f64);
    figure("planar_faces", solid.faces.len() as f64);
    figure("continuity", params.patch.continuity as f64);
    figure("reach", reach);
    let mut least = f64::INFINITY;
    for (p, (net, patch)) in nets.iter().zip(&made.layout.patches).enumerate() {
        for (k, slope) in contact_slopes(net, patch).into_iter().enumerate() {
            least = least.min(slope);
            report.figures.insert(format!("contact_slope.{p}.{}", k + 1), slope);
        }
    }
    report.figures.insert("contact_slope".into(), least);
    let off = nets.iter().map(edge_cluster::Net::residual).fold(0.0, f64::max);
    report.residuals.insert("plane".into(), off / solid.size);
    report.residuals.insert("planarity".into(), solid.flatness / solid.size);
    if reach < 1.0 {
        report.notes.push(format!("reaches were shortened to {reach:.2} at most, so that blends do not meet"));
    }
}

fn origins(solid: &Polyhedron, made: &Blend) -> Origins {
    let new = |place: &Place| match *place {
        Place::Vertex(v) => VertexOrigin::Input { part: 0, vertex: VertexId(v) },
        _ => VertexOrigin::New { stage: "cluster" },
    };
    let parent = |part: &Part| match *part {
        Part::Face(f) => FaceOrigin::Piece { part: 0, face: solid.faces[f as usize].parent },
        _ => FaceOrigin::New { stage: "cluster" },
    };
    Origins {
        vertices: made.woven.places.iter().map(new).collect::<Vec<_>>().into(),
        faces: made.woven.parts.iter().map(parent).collect::<Vec<_>>().into(),
    }
}

/// A group for every part, in the order of the mesh.
fn groups(made: &Blend) -> Groups {
    let mut names = vec![];
    let mut of_face = vec![];
    let mut last = None;
    for &part in &made.woven.parts {
        if last != Some(part) {
            last = Some(part);
            names.push(match part {
                Part::Patch(p) => format!("patch_{p}"),
                Part::Strip(s) => format!("strip_{s}"),
                Part::Face(f) => format!("face_{f}"),
            });
        }
        of_face.push(names.len() as u32 - 1);
    }
    Groups { of_face: of_face.into(), names }
}
