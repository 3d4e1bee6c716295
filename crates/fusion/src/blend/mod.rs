//! Rolling-ball blends: swept strips and corner patches sewn in between exactly cut linkages.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | the stages, and the loop that makes the ball smaller where it does not fit |
//! | `vicinity.rs` | the part of a large mesh that the blend is made on |
//! | `auto.rs` | which curves are swept and which are blended as a field |
//! | `limit.rs` | the largest radius that fits |
//! | `radii.rs`, `profiles.rs` | how radius and cross-section vary along a curve, and the radius between its sides |
//! | `mends.rs` | what has been done so far to make the blend fit |
//! | `rolling.rs` | a ball rolled along every curve |
//! | `network.rs` | the nodes at which open curves meet or end |
//! | `dwindle.rs` | the ball that dwindles where a curve runs out |
//! | `ending.rs` | rails cut to length there: set back, run out, or stopped at the surface ahead |
//! | `corner.rs` | how far curves that meet are set back, and the ball that touches all sides |
//! | `stretch.rs` | a rail cut to length |
//! | `linkage.rs` | linkage curves on the surface, cut into the mesh |
//! | `strip.rs` | the swept surface as triangles |
//! | `fill.rs` | corner patches: their rims, and what they are tangent to |
//! | `plate.rs` | a disc of triangles bent onto a ball or into a thin plate |
//! | `sew.rs` | removal of what lies between, sewing |
//! | `field/` | the blend as a field: no spine, cannot fold |
//! | `keep/` | the other surface: vertices slid onto the sweep, connectivity kept |
//! | `sketch.rs` | what the stages draw for whoever wants to look |
//! | `trouble.rs` | what a stage refuses, and where |

mod auto;
mod corner;
mod dwindle;
mod ending;
mod field;
mod fill;
pub mod keep;
mod limit;
mod linkage;
mod mends;
mod network;
mod plate;
mod profiles;
mod radii;
mod rolling;
mod sew;
mod sketch;
mod stretch;
mod strip;
mod trouble;
mod vicinity;

use ending::Ends;
use fill::fill;
use glam::DVec3;
pub(crate) use limit::rough_max_radius;
pub use limit::{Limit, max_radius};
use linkage::cut_linkages;
use mends::Mends;
use mesh_core::{Cancelled, Connected, FaceId, Faces, NotManifold, Origins, Positions, TriMesh, VertexId, Watch};
use network::Network;
use profile_nurbs::Profile;
use profiles::Profiles;
pub use radii::Radii;
use rolling::{REACH_AHEAD, roll_missing, step_length};
use sew::{between, sew};
use sketch::piece_of;
pub use sketch::{Drawing, Sketch};
pub use spine::BlendCurve;
use spine::{Rail, Solver};
use strip::{Fineness, sweep};
use trouble::Trouble;

/// How curves are blended.
#[derive(Clone, Debug)]
pub struct Params {
    /// Ball radius, in model units; the largest one where it varies. Positive and finite.
    pub radius: f64,
    /// How it varies.
    pub radii: Radii,
    /// Cross-section of the blend.
    pub profile: Profile,
    /// Places and the cross-section there, as for the keys of [`Radii`]; `profile` is the one away from them. In between
    /// the two are mixed point by point.
    pub profile_at: Vec<(DVec3, Profile)>,
    /// Distance of the apex from the ball's centre in radii, if it is moved out along its line; see
    /// [`profile_nurbs::Section::with_reach`]. The blend then meets the surfaces at an angle.
    pub reach: Option<f64>,
    /// What to do where the ball does not fit.
    pub overlap: Overlap,
    /// What finds the way of the ball's centre.
    pub solver: Solver,
    /// Least reach of the base patches, as a multiple of the radius; see [`spine::Params::alpha`].
    pub alpha: f64,
    /// Longest gap that is bridged where the sweep folds, in radii; see [`spine::Params::bridge`].
    pub bridge: f64,
    /// Largest sagitta of the blend's chords across, as a share of the radius.
    pub tolerance: f64,
    /// How far linkage vertices may be moved to spare slivers, as a share of the radius, in [0, 0.02]. A point moved by
    /// this much turns the linkage edges next to it, and with them the normals there: at the default, a five-thousandth,
    /// by less than a picture shows. More makes a mesh that survives 32-bit coordinates.
    pub snap: f64,
    /// How the surface is put in.
    pub surface: Surface,
    /// Where the stages draw what they do.
    pub sketch: Sketch,
}

/// How the surface is put in.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Surface {
    /// Swept as [`Surface::Stitch`]; where that fails, as [`Surface::Field`].
    #[default]
    Auto,
    /// Swept, and sewn between exact cuts along the linkages.
    Stitch,
    /// The mesh's own vertices are moved onto it; connectivity is kept.
    Keep(keep::Params),
    /// As a field of balls around both sides, which cannot fold; an arc in profile.
    Field,
}

/// What to do where a ball of the full radius does not fit, or its sweep would fold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Overlap {
    /// Refuse, naming the place and a radius that works.
    Error,
    /// Use a smaller ball there, fading into the full one, and say so.
    #[default]
    Shrink,
    /// Let the ball's envelope trim itself: where a sweep of the full ball would fold, the blend is the outside of all
    /// places the full ball can take, as a field gives it. Refused where a field cannot serve.
    Trim,
}

impl Params {
    /// Whether any cross-section is of a kind.
    pub(crate) fn uses(&self, kind: &Profile) -> bool {
        self.profile == *kind || self.profile_at.iter().any(|k| k.1 == *kind)
    }

    /// An arc of radius `radius`, made smaller where it does not fit.
    pub fn new(radius: f64) -> Self {
        Self {
            radius,
            radii: Radii::default(),
            profile: Profile::Arc,
            profile_at: Vec::new(),
            reach: None,
            overlap: Overlap::default(),
            solver: Solver::Contact,
            alpha: 1.75,
            bridge: 3.0,
            tolerance: 0.005,
            snap: 2e-4,
            surface: Surface::default(),
            sketch: Sketch::default(),
        }
    }
}

/// A blended mesh and what is to be said of it.
#[derive(Clone, Debug)]
pub struct Blended {
    /// The result; the blend's faces are the last ones, unless some curves were swept and others blended as a field.
    pub mesh: TriMesh,
    /// With respect to the input, as part 0.
    pub origins: Origins,
    /// First face of the blend.
    pub first_blend_face: FaceId,
    /// How many strips were swept; fewer than curves where neighbouring curves share one.
    pub strips: usize,
    /// How many pieces of surface were blended as a field.
    pub fields: usize,
    /// How many corner patches were made.
    pub corners: usize,
    /// Largest | distance of a ball's centre to a base patch − radius | over the radius.
    pub residual: f64,
    /// How many balls stood where the sweep folds, and gave way to bridges.
    pub bridged: usize,
    /// Where the ball was made smaller: place, and the radius there.
    pub shrunk: Vec<(DVec3, f64)>,
    /// Where sweeping failed and a field took its place: place, and what failed there.
    pub fallbacks: Vec<(DVec3, &'static str)>,
    /// Where a curve ends alone with no surface to stop at, so that the blend runs out in a point.
    pub run_outs: Vec<DVec3>,
    /// On which level of a decimation hierarchy the blend was made; 0 is the mesh itself.
    pub levels: usize,
    /// Share of the spine's length on which the ball has its full radius.
    pub full_share: f64,
}

/// Why a blend is impossible.
#[derive(Clone, Debug, thiserror::Error)]
pub enum Error {
    /// There is nothing to blend.
    #[error("no blend curve given; lower the dihedral angle, or name a curve")]
    NoCurves,
    /// A field cannot do what is asked for.
    #[error("a field blends closed curves with an arc; {0}")]
    NotByField(&'static str),
    /// The radius does not fit.
    #[error(
        "{what} at {at} with radius {radius}; {}",
        .workable.map_or("no smaller radius tried worked either".to_string(), |r| format!("a radius of {r} works"))
    )]
    DoesNotFit {
        /// What went wrong there.
        what: &'static str,
        /// Where, in model units.
        at: DVec3,
        /// The radius asked for.
        radius: f64,
        /// The largest of the smaller radii tried that works everywhere.
        workable: Option<f64>,
    },
    /// The ball could not be rolled for a reason that no smaller radius mends.
    #[error(transparent)]
    Spine(#[from] spine::Error),
    /// A corner of a blend with two radii.
    #[error(
        "three or more curves meet at {0}, where a blend with two radii has no corner; blend the curves in several calls, or with one radius"
    )]
    TwoRadiiMeet(DVec3),
    /// Vertices cannot be slid onto the surface.
    #[error(transparent)]
    Keep(#[from] keep::Refusal),
    /// The linkages could not be cut into the mesh.
    #[error(transparent)]
    Embed(#[from] tri_intersect::EmbedError),
    /// A stage made a mesh that is not a manifold; nothing is returned.
    #[error("the blend failed its own check: {0}")]
    Invalid(#[from] NotManifold),
    /// See [`Watch`].
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Blends `curves` of `mesh`. Vertices outside the blend keep their bits and their order.
///
/// Where three or more open curves meet they are set back from a corner patch. One that ends alone stops at the surface
/// that bounds both its sides, or runs out where there is none.
///
/// # Errors
/// [`Error::DoesNotFit`] where the radius is the reason, with a place and a radius that works.
pub fn blend(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
    watch: &Watch,
) -> Result<Blended, Error> {
    if let Surface::Keep(how) = &params.surface {
        return keep::blend(mesh, curves, params, how, watch);
    }
    if let Some(near) = vicinity::vicinity(mesh, curves, params) {
        match blend_whole(&near.mesh, &near.curves, params, watch) {
            Ok(blended) if near.holds(&blended) => return Ok(near.put_back(blended)),
            Err(Error::Cancelled(c)) => return Err(c.into()),
            // It may be the rest of the mesh that was wanted.
            Ok(_) | Err(_) => {}
        }
    }
    blend_whole(mesh, curves, params, watch)
}

fn blend_whole(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
    watch: &Watch,
) -> Result<Blended, Error> {
    if params.surface == Surface::Stitch {
        return attempt(mesh, curves, params, ROUNDS, watch)
            .or_else(|refusal| explained(mesh, curves, params, refusal, watch));
    }
    auto::blend(mesh, curves, params, watch)
}

/// The error for what stopped a sweep, with a smaller radius that works, if there is one.
fn explained(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
    refusal: Trouble,
    watch: &Watch,
) -> Result<Blended, Error> {
    match refusal {
        Trouble::Places { what, places } => {
            let mut workable = None;
            // What fails in many places is no matter of a little: one try tells.
            for halvings in if places.len() > FEW { 3 } else { 1 }..=3 {
                let radius = params.radius * 0.5f64.powi(halvings);
                let smaller = Params { radius, sketch: Sketch::default(), ..params.clone() };
                match attempt(mesh, curves, &smaller, ROUNDS / 2, watch) {
                    Ok(_) => {
                        workable = Some(smaller.radius);
                        break;
                    }
                    Err(Trouble::Cancelled(c)) => return Err(c.into()),
                    Err(_) => {}
                }
            }
            let at = places.first().copied().unwrap_or(DVec3::ZERO);
            Err(Error::DoesNotFit { what, at, radius: params.radius, workable })
        }
        other => Err(other.into_error(params.radius)),
    }
}

/// How often places may be mended before the blend is given up.
const ROUNDS: usize = 14;
/// From which round on a blend is given up that has more than a `FEW` places of trouble, and more than half of those it
/// had at first.
const TELLING: usize = 4;
const FEW: usize = 32;

/// Rolls, cuts, sweeps, sews and checks; where a stage refuses, softens the linkages or shrinks the ball and begins
/// again with the rails concerned.
fn attempt(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
    rounds: usize,
    watch: &Watch,
) -> Result<Blended, Trouble> {
    let mut mends = Mends::new(params.radius, params.radii.fields(mesh, curves, params.radius));
    let step = step_length(mesh, curves, params);
    let mut network = Network::of(mesh, curves, REACH_AHEAD * params.radius);
    let meeting = network.nodes.iter().find(|n| n.darts.len() > 2 && !params.radii.is_even());
    if let Some(node) = meeting {
        return Err(Trouble::TwoRadiiMeet(mesh.position(node.vertex)));
    }
    let mut rails: Vec<Option<Rail>> = curves.iter().map(|_| None).collect();
    params.sketch.begin(mesh, curves);
    let mut at_first = None;
    for round in 0.. {
        watch.step("blend", round as f64 / rounds as f64)?;
        let trouble = match roll_missing(mesh, curves, &network, params, &mends, step, &mut rails)
            .and_then(|()| assemble(mesh, curves, &network, params, step, &rails, watch))
        {
            Ok(mut blended) => {
                mends.account_for(&rails, &mut blended);
                return Ok(blended);
            }
            Err(trouble) => trouble,
        };
        if let Trouble::NoStop(nodes) = &trouble {
            for &n in nodes {
                network.run_out(mesh, curves, n, REACH_AHEAD * params.radius);
                network.nodes[n].darts.iter().for_each(|d| rails[d.curve] = None);
            }
            continue;
        }
        params.sketch.refusal(&trouble, params.radius);
        let Trouble::Places { ref places, .. } = trouble else { return Err(trouble) };
        let first = *at_first.get_or_insert(places.len());
        let hopeless = round >= TELLING && places.len() > FEW && 2 * places.len() > first;
        let refused = params.overlap != Overlap::Shrink && round >= 2;
        if refused || hopeless || round >= rounds || !mends.add(places, params.overlap) {
            return Err(trouble);
        }
        for rail in &mut rails {
            if rail.as_ref().is_some_and(|r| mends.touches(r)) {
                *rail = None;
            }
        }
    }
    Err(Trouble::at("the blend does not settle", vec![]))
}

/// One pass of all later stages over finished rails.
fn assemble(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    network: &Network,
    params: &Params,
    step: f64,
    rails: &[Option<Rail>],
    watch: &Watch,
) -> Result<Blended, Trouble> {
    let fineness =
        Fineness { tolerance: params.tolerance, chord: step, reach: params.reach, sides: params.radii.sides };
    let profiles = Profiles::of(mesh, curves, params);
    let ends = Ends { mesh, curves, network, profiles: &profiles, fineness };
    let layout = ends.lay_out(rails, &distinct(rails, step))?;
    for ((curve, stretch), profiles) in curves.iter().zip(&layout.stretches).zip(&profiles) {
        if let Some(stretch) = stretch {
            params.sketch.page(mesh, curve).stretch(stretch, profiles, fineness);
        }
    }
    let opened = cut_linkages(mesh, network, &layout, params.snap, params.radius, watch)?;
    let cut = &opened.embedded.mesh;
    let (mut strips, mut new_points) = (Vec::with_capacity(rails.len()), Vec::new());
    let first_new = cut.vertex_count() as u32;
    let mut folds = Vec::new();
    for (i, stretch) in layout.stretches.iter().enumerate() {
        let first = first_new + new_points.len() as u32;
        let sweep_along = |stretch| {
            let (linkages, stops) = (&opened.linkages[i], &opened.stops[i]);
            sweep(stretch, linkages, stops, &profiles[i], fineness, first, |v| cut.position(v))
        };
        let strip = stretch.as_ref().map(sweep_along);
        if let Some(strip) = &strip {
            new_points.extend_from_slice(&strip.piece.points);
            params.sketch.page(mesh, &curves[i]).draw("strip", || piece_of(&strip.piece, cut, &new_points));
            folds.extend_from_slice(&strip.folds);
        }
        strips.push(strip);
    }
    if !folds.is_empty() {
        return Err(Trouble::at("the swept surface folds", folds));
    }
    let mut patches = Vec::with_capacity(layout.corners.len());
    for (corner, joints) in layout.corners.iter().zip(&opened.joints) {
        let position =
            |v: VertexId| if v.0 < first_new { cut.position(v) } else { new_points[(v.0 - first_new) as usize] };
        let patch = fill(corner, joints, &layout.stretches, &strips, first_new + new_points.len() as u32, position)?;
        new_points.extend_from_slice(&patch.points);
        params.sketch.draw(&format!("corner-{}", patches.len()), || piece_of(&patch, cut, &new_points));
        patches.push(patch);
    }
    let connected = Connected::new(cut)
        .map_err(|e| Trouble::at("the cut mesh is not a manifold", e.place.into_iter().collect()))?;
    let removed = between(mesh, &connected, &opened, curves)?;
    let strips: Vec<_> = strips.into_iter().flatten().collect();
    let count = strips.len();
    let pieces: Vec<_> = strips.into_iter().map(|s| s.piece).chain(patches).collect();
    let sewn = sew(&opened, &removed, &pieces);
    check(&sewn, watch)?;
    let residual = rails.iter().flatten().map(|r| r.residual).fold(0.0, f64::max) / params.radius;
    Ok(Blended {
        mesh: sewn.mesh,
        origins: sewn.origins,
        first_blend_face: sewn.first_new_face,
        strips: count,
        fields: 0,
        corners: layout.corners.len(),
        residual,
        bridged: rails.iter().flatten().map(|r| r.bridged).sum(),
        shrunk: Vec::new(),
        fallbacks: Vec::new(),
        run_outs: network.run_outs().map(|v| mesh.position(v)).collect(),
        levels: 0,
        full_share: 1.0,
    })
}

/// Which rails do not run along an earlier one: neighbouring closed curves whose balls roll the same way are swallowed by
/// one strip.
fn distinct(rails: &[Option<Rail>], step: f64) -> Vec<bool> {
    let mut kept = vec![true; rails.len()];
    for (i, rail) in rails.iter().enumerate() {
        let Some(rail) = rail.as_ref().filter(|r| r.closed) else { continue };
        let start = rail.samples[0].center;
        let near = |other: &Rail| other.samples.iter().any(|s| s.center.distance(start) < 0.75 * step);
        kept[i] = !(0..i).any(|j| kept[j] && rails[j].as_ref().is_some_and(|r| r.closed && near(r)));
    }
    kept
}

/// The result must be a manifold, and the blend must not meet itself or anything else.
fn check(sewn: &sew::Sewn, watch: &Watch) -> Result<(), Trouble> {
    if let Err(e) = Connected::new(&sewn.mesh) {
        return Err(Trouble::at("the blend pinches", e.place.into_iter().collect()));
    }
    let new: Vec<FaceId> = (sewn.first_new_face.0..sewn.mesh.face_count() as u32).map(FaceId).collect();
    let hits = tri_intersect::self_intersections_among(&sewn.mesh, &new, watch)
        .map_err(|_| Trouble::at("the blend cannot be checked", vec![]))?;
    if hits.is_empty() {
        return Ok(());
    }
    let middle = |f: FaceId| sewn.mesh.triangle(f).iter().sum::<DVec3>() / 3.0;
    let first_new = sewn.first_new_face;
    let places = hits.iter().flatten().filter(|&&f| f >= first_new).map(|&f| middle(f)).collect();
    Err(Trouble::at("the blend meets itself or the mesh", places))
}
