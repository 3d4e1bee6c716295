//! A swept blend from rails to the sewn mesh, and the loop that makes the ball smaller where it does not fit.

use crate::blended::Blended;
use crate::cap::Caps;
use crate::curve_blend;
use crate::ending::{Ends, Layout};
use crate::error::Error;
use crate::fill::fill;
use crate::linkage::{Opened, cut_linkages};
use crate::mends::Mends;
use crate::network::Network;
use crate::params::{Overlap, Params};
use crate::profiles::Profiles;
use crate::rolling::{REACH_AHEAD, roll_missing, step_length};
use crate::sew::{Sewn, between, sew};
use crate::sketch::{Sketch, piece_of};
use crate::strip::{Fineness, Piece, Strip, sweep};
use crate::trouble::Trouble;
use glam::DVec3;
use mesh_core::{Connected, FaceId, Faces, Positions, TriMesh, VertexId, Watch, centroid};
use rayon::prelude::*;
use spine::{BlendCurve, Rail};

/// The error for what stopped a sweep, with a smaller radius that works, if there is one.
pub(crate) fn explained(
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
pub(crate) const ROUNDS: usize = 14;
/// How often linkages are softened where no smaller ball is wanted.
const SOFTENINGS: usize = 2;
/// From which round on a blend is given up that has more than a `FEW` places of trouble, and more than half of those it
/// had at first.
const TELLING: usize = 4;
pub(crate) const FEW: usize = 32;

/// Rolls, cuts, sweeps, sews and checks; where a stage refuses, softens the linkages or shrinks the ball and begins
/// again with the rails concerned.
pub(crate) fn attempt(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
    rounds: usize,
    watch: &Watch,
) -> Result<Blended, Trouble> {
    attempt_between(mesh, curves, &Caps::default(), params, rounds, watch)
}

/// The same for curves some of which end at caps.
pub(crate) fn attempt_between(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    caps: &Caps,
    params: &Params,
    rounds: usize,
    watch: &Watch,
) -> Result<Blended, Trouble> {
    let mut mends = Mends::new(params.radius, params.radii.fields(mesh, curves, params.radius));
    let step = step_length(mesh, curves, params);
    let mut network = Network::of(mesh, curves, caps, REACH_AHEAD * params.radius);
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
    let position =
        |v: VertexId| if v.index() < first_new { cut.position(v) } else { new_points[v.index() - first_new] };
    let corners = layout.corners.par_iter().zip(&opened.joints);
    let filled: Vec<_> =
        corners.map(|(corner, joints)| fill(corner, joints, &layout.stretches, strips, position)).collect();
    let mut patches = Vec::with_capacity(filled.len());
    for patch in filled {
        let patch = patch?.numbered_from((first_new + new_points.len()) as u32);
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
pub(crate) fn check(sewn: &Sewn, watch: &Watch) -> Result<(), Trouble> {
    Connected::new(&sewn.mesh).map_err(Trouble::not_manifold("the blend pinches"))?;
    let new: Vec<FaceId> = (sewn.first_new_face.0..sewn.mesh.face_count() as u32).map(FaceId).collect();
    check_crossings(&sewn.mesh, &new, watch)
}

/// The listed faces must not meet themselves or anything else.
pub(crate) fn check_crossings(mesh: &TriMesh, listed: &[FaceId], watch: &Watch) -> Result<(), Trouble> {
    let hits = tri_intersect::self_intersections_among(mesh, listed, watch).map_err(|error| match error {
        tri_intersect::Error::Cancelled(c) => Trouble::from(c),
        _ => Trouble::at("the blend cannot be checked", vec![]),
    })?;
    if hits.is_empty() {
        return Ok(());
    }
    let is_listed = |f: &&FaceId| listed.binary_search(f).is_ok();
    let places = hits.iter().flatten().filter(is_listed).map(|&f| centroid(mesh.triangle(f))).collect();
    Err(Trouble::at("the blend meets itself or the mesh", places))
}
