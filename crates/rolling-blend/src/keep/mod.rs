//! Blends that keep the mesh's connectivity, as published (\[Liu2005\]): the vertices between the linkages slide onto the
//! swept surface.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | the stages |
//! | `target.rs` | the virtual surface S(t, u) through the profiles |
//! | `region.rs` | the ring of triangles around the curve that the blend takes |
//! | `border.rs` | where the ring's two borders go on the linkages |
//! | `domain.rs` | the ring laid onto the surface's rectangle and smoothed there |
//! | `coarse.rs` | the same on a coarser level, with details put back |
//! | `refusal.rs` | what cannot be served, and why |

mod border;
mod coarse;
mod domain;
mod refusal;
mod region;
mod target;

pub use refusal::Refusal;

use crate::blended::Blended;
use crate::error::Error;
use crate::params::Params as BlendParams;
use crate::sew;
use crate::sketch::Drawing;
use domain::settle;
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, FaceId, FaceOrigin, Faces, HalfedgeId, Origins, Positions, TriMesh, VertexId, VertexOrigin,
    Watch, centroid, triangle_normal,
};
use param_conformal::{RelaxParams, Seam};
use rayon::prelude::*;
use region::Region;
use spine::{BlendCurve, Rail, roll_or_halt};
use target::Target;
use tri_intersect::self_intersections_among;

/// How the vertices of a region find their places on the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Params {
    /// Whether the ring is mapped as a cylinder, or its seam is pinned to the rectangle's sides as in the paper. The
    /// first has no seam to see, and less distortion.
    pub seam: Seam,
    /// Smoothing of the parameter domain, by which triangles become even on the surface.
    pub relaxation: RelaxParams,
    /// Samples along a spine before refinement.
    pub samples: u32,
    /// Most levels of a decimation hierarchy on the coarsest of which that serves the blend is made, before details are
    /// put back (\[Liu2005\] §6.3); 0 blends the mesh itself.
    pub levels: usize,
}

impl Default for Params {
    fn default() -> Self {
        // n = 40: [Liu2005] §4.1.
        Self { seam: Seam::Periodic, relaxation: RelaxParams::default(), samples: 40, levels: 0 }
    }
}

/// Blends closed `curves` of `mesh` by moving vertices alone: ids, faces and neighbourhoods stay, and so do the positions
/// of all vertices outside the regions. Cost grows with the regions but for one pass over the mesh.
///
/// # Errors
/// [`Error::Keep`] names what cannot be served, where and why; [`Error::Spine`] where the ball cannot be rolled.
pub fn blend(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &BlendParams,
    how: &Params,
    watch: &Watch,
) -> Result<Blended, Error> {
    if how.levels > 0 {
        return coarse::blend(mesh, curves, params, how, watch);
    }
    blend_level(mesh, curves, params, how, watch)
}

/// One level.
fn blend_level(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &BlendParams,
    how: &Params,
    watch: &Watch,
) -> Result<Blended, Error> {
    params.sketch.begin(mesh, curves);
    if let Some(&(at, _)) = params.profile_at.first() {
        return Err(Refusal::KeyedProfiles { at }.into());
    }
    let rails = roll_all(mesh, curves, params, how)?;
    watch.step("blend", 0.3)?;
    let mut regions = Vec::with_capacity(curves.len());
    let mut places = region::Places::new(mesh);
    for (curve, rail) in curves.iter().zip(&rails) {
        let target = Target::new(rail, params)?;
        let page = params.sketch.page(mesh, curve);
        page.draw("profiles", || target.profiles());
        let region = Region::around(mesh, curve, rail, &target, &mut places)?;
        page.draw("region", || Drawing::Mesh(region.local.mesh().clone()));
        regions.push((region, target));
    }
    apart(mesh, &regions)?;
    watch.step("blend", 0.5)?;
    let settled: Vec<_> = regions
        .par_iter()
        .zip(curves)
        .map(|((region, target), curve)| settle(region, target, how, params.sketch.page(mesh, curve)))
        .collect();
    let mut positions = mesh.mesh().positions.clone();
    for ((region, _), settled) in regions.iter().zip(settled) {
        for (&v, p) in region.vertices.iter().zip(settled?) {
            positions[v.index()] = p;
        }
    }
    watch.step("blend", 0.8)?;
    let moved = TriMesh { positions, faces: mesh.mesh().faces.clone() };
    let origins = account(mesh, &regions);
    check(mesh, &moved, &regions, &origins, watch)?;
    let first_blend_face = FaceId::from(moved.faces.len());
    Ok(Blended {
        strips: rails.len(),
        residual: rails.iter().map(|r| r.residual).fold(0.0, f64::max) / params.radius,
        ..Blended::new(moved, origins, first_blend_face)
    })
}

/// Rolls along every curve with steps of the curve's length over the number of samples, half a radius at most; once
/// more with shorter ones where a spine's chords then stand off by more than the tolerance, and the mesh can show it. Where a foot outruns the
/// centre, [`roll`] itself puts more samples in.
fn roll_all(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &BlendParams,
    how: &Params,
) -> Result<Vec<Rail>, Error> {
    let fields = params.radii.fields(mesh, curves, params.radius);
    let rolled = curves.par_iter().zip(&fields).map(|(curve, field)| {
        let with_step = |step: f64| {
            let (alpha, solver) = (params.alpha, params.solver);
            let rolling =
                spine::Params { radius: field.clone(), alpha, solver, step, ..spine::Params::new(params.radius) };
            roll_or_halt(mesh, curve, curves, &rolling).map_err(|halt| {
                params.sketch.page(mesh, curve).halt(mesh, &halt);
                halt.error
            })
        };
        let step = (curve.length(mesh) / f64::from(how.samples.max(8))).min(0.5 * params.radius);
        let rail = with_step(step)?;
        // Finer than a quarter of what the mesh's own edges stand off by would be lost on it.
        let edge = curve.length(mesh) / curve.halfedges.len() as f64;
        let wanted = (params.tolerance * params.radius).max(edge * edge / (32.0 * params.radius));
        // Heights fall as the square of the step.
        let refined = (chord_height(&rail) / wanted).sqrt();
        let mut rail = if refined > 1.0 { with_step(step / refined.min(FINEST))? } else { rail };
        if params.uses(&profile_nurbs::Profile::G2) {
            rail.measure_bends(mesh);
        }
        params.sketch.page(mesh, curve).rail(mesh, &rail);
        Ok::<_, spine::Error>(rail)
    });
    rolled.collect::<Result<_, _>>().map_err(Error::from)
}

/// Most samples for one of the first round.
const FINEST: f64 = 8.0;

/// How far the spine's chords stand off it: a quarter of what every second sample stands off the chord around it.
fn chord_height(rail: &Rail) -> f64 {
    let n = rail.samples.len();
    let center = |i: usize| rail.samples[i % n].center;
    let height = |i: usize| center(i + 1).distance(center(i).midpoint(center(i + 2)));
    (0..n).map(height).fold(0.0, f64::max) / 4.0
}

/// No vertex may belong to two regions.
fn apart(mesh: &Connected<TriMesh>, regions: &[(Region, Target)]) -> Result<(), Refusal> {
    let mut all: Vec<VertexId> = regions.iter().flat_map(|r| r.0.vertices.iter().copied()).collect();
    all.sort_unstable();
    match all.windows(2).find(|w| w[0] == w[1]) {
        Some(w) => Err(Refusal::Overlap { at: mesh.position(w[0]) }),
        None => Ok(()),
    }
}

/// Moved vertices and the faces of the regions are new; faces beside them are pieces of what they were.
fn account(mesh: &Connected<TriMesh>, regions: &[(Region, Target)]) -> Origins {
    let mut origins = Origins::identity(0, mesh.vertex_count(), mesh.face_count());
    for (region, _) in regions {
        for &v in &region.vertices {
            origins.vertices[v] = VertexOrigin::New { stage: sew::STAGE };
            for h in mesh.ring(v) {
                origins.faces[h.face()] = FaceOrigin::Piece { part: 0, face: h.face() };
            }
        }
    }
    for &f in regions.iter().flat_map(|r| &r.0.faces) {
        origins.faces[f] = FaceOrigin::New { stage: sew::STAGE };
    }
    origins
}

/// Faces beside a region keep their direction within this: their borders slide along the surface they lie on.
const LEAST_COSINE: f64 = 0.5;

/// Triangles beside the regions must stay on their surface, those within must follow it, and none may meet another.
fn check(
    mesh: &Connected<TriMesh>,
    moved: &TriMesh,
    regions: &[(Region, Target)],
    origins: &Origins,
    watch: &Watch,
) -> Result<(), Error> {
    let mut changed = Vec::new();
    for (region, _) in regions {
        let beside = region.vertices.iter().flat_map(|&v| mesh.ring(v)).map(HalfedgeId::face);
        let mut beside: Vec<FaceId> =
            beside.filter(|&f| matches!(origins.faces[f], FaceOrigin::Piece { .. })).collect();
        beside.sort_unstable();
        beside.dedup();
        for &f in &beside {
            let (before, after) = (triangle_normal(mesh.triangle(f)), triangle_normal(moved.triangle(f)));
            if before.dot(after) < LEAST_COSINE {
                return Err(Refusal::Sheared { face: f, at: centroid(moved.triangle(f)) }.into());
            }
        }
        changed.extend(beside);
        changed.extend_from_slice(&region.faces);
    }
    check_apart(moved, &changed, watch)
}

/// None of the changed faces may meet another.
fn check_apart(mesh: &TriMesh, changed: &[FaceId], watch: &Watch) -> Result<(), Error> {
    let middle = |f: &FaceId| centroid(mesh.triangle(*f));
    let hits = self_intersections_among(mesh, changed, watch).map_err(|error| match error {
        tri_intersect::Error::Cancelled(c) => Error::from(c),
        _ => Refusal::Meets { pairs: 0, at: changed.first().map_or(DVec3::ZERO, middle) }.into(),
    })?;
    match hits.first() {
        None => Ok(()),
        Some(pair) => Err(Refusal::Meets { pairs: hits.len(), at: middle(&pair[0]) }.into()),
    }
}
