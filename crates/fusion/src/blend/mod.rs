//! Rolling-ball blends: swept strips and corner patches sewn in between exactly cut linkages.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | the stages, and the loop that makes the ball smaller where it does not fit |
//! | `params.rs`, `error.rs` | how curves are blended; why they cannot be |
//! | `vicinity.rs` | the part of a large mesh that the blend is made on |
//! | `curve_blend.rs`, `measure.rs` | what each curve was blended by; the ball error of the result
//! | `auto.rs` | which curves are swept and which are blended as a field |
//! | `networks.rs` | networks on which a plain sweep fails |
//! | `so_far.rs` | a mesh on its way through several blends |
//! | `limit.rs`, `width.rs` | the largest radius that fits; how wide the sides of a curve are |
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
//! | `envelope/` | networks by the envelope of all balls: any corner, consumed faces |
//! | `keep/` | the other surface: vertices slid onto the sweep, connectivity kept |
//! | `sketch.rs` | what the stages draw for whoever wants to look |
//! | `trouble.rs` | what a stage refuses, and where |

mod auto;
mod corner;
mod curve_blend;
mod dwindle;
mod ending;
mod envelope;
mod error;
mod field;
mod fill;
pub mod keep;
mod limit;
mod linkage;
pub(crate) mod measure;
mod mends;
mod network;
mod networks;
mod params;
mod plate;
mod profiles;
mod radii;
mod rolling;
mod sew;
mod sketch;
mod so_far;
mod stretch;
mod strip;
mod trouble;
mod vicinity;
mod width;

pub use curve_blend::{CurveBlend, LeftSharp, Method};
use ending::{Ends, Layout};
pub use error::Error;
use fill::fill;
use glam::DVec3;
pub(crate) use limit::listed_radius;
pub use limit::{Limit, ListedRadius, max_radius};
use linkage::{Opened, cut_linkages};
use mends::Mends;
use mesh_core::{Connected, FaceId, Faces, Origins, Positions, TriMesh, VertexId, Watch, centroid};
use network::Network;
pub use params::{Overlap, Params, Surface};
use profiles::Profiles;
pub use radii::Radii;
use rolling::{REACH_AHEAD, affordable, roll_missing, step_length};
use sew::{between, sew};
use sketch::piece_of;
pub use sketch::{Drawing, Sketch};
pub use spine::BlendCurve;
use spine::Rail;
use strip::{Fineness, Piece, Strip, sweep};
use trouble::Trouble;

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
    /// How each of the curves was blended, in their order.
    pub curves: Vec<CurveBlend>,
}

impl Blended {
    /// A mesh of whose blend nothing has been told yet.
    fn new(mesh: TriMesh, origins: Origins, first_blend_face: FaceId) -> Self {
        Self {
            mesh,
            origins,
            first_blend_face,
            strips: 0,
            fields: 0,
            corners: 0,
            residual: 0.0,
            bridged: 0,
            shrunk: vec![],
            fallbacks: vec![],
            run_outs: vec![],
            levels: 0,
            full_share: 1.0,
            curves: vec![],
        }
    }
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
        let mut blended = keep::blend(mesh, curves, params, how, watch)?;
        let made = |c: &BlendCurve| CurveBlend::made(Method::Keep, params.radius, c.length(mesh), blended.full_share);
        blended.curves = curves.iter().map(made).collect();
        return Ok(blended);
    }
    affordable(mesh, curves, params)?;
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
/// How often linkages are softened where no smaller ball is wanted.
const SOFTENINGS: usize = 2;
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
                blended.curves = curve_blend::swept(mesh, curves, &rails, |i| mends.field(i));
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
        let refused = params.overlap != Overlap::Shrink && round >= SOFTENINGS;
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
    let mut new_points = vec![];
    let strips = sweep_all(&ends, &layout, &opened, &params.sketch, &mut new_points)?;
    let patches = fill_corners(&layout, &opened, &strips, &params.sketch, &mut new_points)?;
    let cut = Connected::new(&opened.embedded.mesh).map_err(Trouble::not_manifold("the cut mesh is not a manifold"))?;
    let removed = between(mesh, &cut, &opened, curves)?;
    let count = strips.iter().flatten().count();
    let pieces: Vec<Piece> = strips.into_iter().flatten().map(|s| s.piece).chain(patches).collect();
    let sewn = sew(&opened, &removed, &pieces);
    check(&sewn, watch)?;
    Ok(Blended {
        strips: count,
        corners: layout.corners.len(),
        residual: rails.iter().flatten().map(|r| r.residual).fold(0.0, f64::max) / params.radius,
        bridged: rails.iter().flatten().map(|r| r.bridged).sum(),
        run_outs: network.run_outs().map(|v| mesh.position(v)).collect(),
        ..Blended::new(sewn.mesh, sewn.origins, sewn.first_new_face)
    })
}

/// The strip of each curve that has a stretch of its own; their new vertices are added to `new_points`.
fn sweep_all(
    ends: &Ends<'_>,
    layout: &Layout,
    opened: &Opened,
    sketch: &Sketch,
    new_points: &mut Vec<DVec3>,
) -> Result<Vec<Option<Strip>>, Trouble> {
    let cut = &opened.embedded.mesh;
    let mut strips = Vec::with_capacity(layout.stretches.len());
    let mut folds = vec![];
    for (i, stretch) in layout.stretches.iter().enumerate() {
        let first = (cut.vertex_count() + new_points.len()) as u32;
        let sweep_along = |stretch| {
            let (linkages, stops) = (&opened.linkages[i], &opened.stops[i]);
            sweep(stretch, linkages, stops, &ends.profiles[i], ends.fineness, first, |v| cut.position(v))
        };
        let strip = stretch.as_ref().map(sweep_along);
        if let Some(strip) = &strip {
            new_points.extend_from_slice(&strip.piece.points);
            sketch.page(ends.mesh, &ends.curves[i]).draw("strip", || piece_of(&strip.piece, cut, new_points));
            folds.extend_from_slice(&strip.folds);
        }
        strips.push(strip);
    }
    if folds.is_empty() { Ok(strips) } else { Err(Trouble::at("the swept surface folds", folds)) }
}

/// The patch of each corner, between the strips' ends; their new vertices are added to `new_points`.
fn fill_corners(
    layout: &Layout,
    opened: &Opened,
    strips: &[Option<Strip>],
    sketch: &Sketch,
    new_points: &mut Vec<DVec3>,
) -> Result<Vec<Piece>, Trouble> {
    let cut = &opened.embedded.mesh;
    let first_new = cut.vertex_count();
    let mut patches = Vec::with_capacity(layout.corners.len());
    for (corner, joints) in layout.corners.iter().zip(&opened.joints) {
        let position =
            |v: VertexId| if v.index() < first_new { cut.position(v) } else { new_points[v.index() - first_new] };
        let first = (first_new + new_points.len()) as u32;
        let patch = fill(corner, joints, &layout.stretches, strips, first, position)?;
        new_points.extend_from_slice(&patch.points);
        sketch.draw(&format!("corner-{}", patches.len()), || piece_of(&patch, cut, new_points));
        patches.push(patch);
    }
    Ok(patches)
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
    Connected::new(&sewn.mesh).map_err(Trouble::not_manifold("the blend pinches"))?;
    let new: Vec<FaceId> = (sewn.first_new_face.0..sewn.mesh.face_count() as u32).map(FaceId).collect();
    let hits = tri_intersect::self_intersections_among(&sewn.mesh, &new, watch).map_err(|error| match error {
        tri_intersect::Error::Cancelled(c) => Trouble::from(c),
        _ => Trouble::at("the blend cannot be checked", vec![]),
    })?;
    if hits.is_empty() {
        return Ok(());
    }
    let middle = |f: FaceId| centroid(sewn.mesh.triangle(f));
    let first_new = sewn.first_new_face;
    let places = hits.iter().flatten().filter(|&&f| f >= first_new).map(|&f| middle(f)).collect();
    Err(Trouble::at("the blend meets itself or the mesh", places))
}
