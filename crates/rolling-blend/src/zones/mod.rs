//! Networks on which a plain sweep fails at some places: the envelope in zones around these, strips everywhere else.
//!
//! Curves are cut where a ball touches their two sides and nothing else. The sharp mesh gets the cross-sections there as
//! edges; the envelope is drawn as far as these and ends in plane caps; the strips take the caps away again. Where the envelope
//! fails, the curves stay sharp within the zone, and the strips around it end in caps of their own.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | the stages |
//! | `plan.rs` | which stretches of the curves lie in zones |
//! | `section.rs` | where a curve can be cut, and the cross-section there |
//! | `cut.rs` | the mesh with the sections, the curves in pieces |

mod cut;
mod plan;
mod section;

use crate::blended::Blended;
use crate::cap::{Caps, Moved};
use crate::curve_blend::{CurveBlend, Method};
use crate::envelope::{self, Continued, Ground, Made, NO_BALL, Patches, TOO_NARROW};
use crate::error::Error;
use crate::networks::groups;
use crate::params::{Overlap, Params};
use crate::so_far::SoFar;
use crate::stitch::{ROUNDS, attempt_between, check_crossings};
use crate::trouble::Trouble;
use cut::{Cut, ZoneEnd};
use glam::DVec3;
use mesh_core::{Adjacency, Connected, EdgeId, FaceId, FaceOrigin, Faces, HalfedgeId, Stage, TriMesh, VertexId, Watch};
use mesh_query::TriBvh;
use plan::{Plan, Span};
use section::CutBalls;
use spine::{BlendCurve, Convexity};
use std::collections::BTreeMap;

/// How often places where strips fail are added to the zones.
const TRIES: usize = 6;
/// How far from a place of failure its curve is part of the zone, in radii: at first, and at most.
const NEAR: f64 = 2.5;
const WIDEST: f64 = 40.0;
/// Work spent on envelopes, in visits to faces; zones beyond that stay sharp. Each costs one visit to every face, and about so
/// many for each radius of its curves' length.
const VISITS: f64 = 2e6;
const VISITS_PER_RADIUS: f64 = 2.5e3;
/// How much wider zones get.
const WIDER: f64 = 4.0;
/// What is said of these.
const NO_TIME: &str = "too many places where the ball does not fit";
/// Share of the full ball that is given up rather than have an edge sharp.
const DEARER: f64 = 0.05;
/// Places nearer to each other than this, in radii, are one.
const SAME: f64 = 0.5;

/// Blends as much of the `curves` as can be, given places where sweeping them fails. Where the envelope fails, too, stretches
/// stay sharp.
pub(crate) fn by_zones(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    trouble: Trouble,
    params: &Params,
    watch: &Watch,
) -> Result<Blended, Trouble> {
    let r = params.radius;
    let chosen = envelope::halfedges_of(mesh, curves);
    let tree = TriBvh::build(mesh).map_err(|e| Trouble::Spine(e.into()))?;
    let patches = Patches::new(mesh, &chosen, curves, r);
    let fences = vec![false; chosen.len()];
    let ground = |sign: f64| Ground { mesh, patches: &patches, tree: &tree, sign, fences: &fences };
    let (inside, outside) = (ground(-1.0), ground(1.0));
    let convexity = |c: &BlendCurve| c.convexity(mesh).unwrap_or(Convexity::Concave);
    let balls = CutBalls::new(curves, curves.iter().map(convexity).collect(), [&inside, &outside], r);
    let balls = balls.ok_or_else(|| Trouble::at("the curves have no extent", vec![]))?;
    let mut places: Vec<(DVec3, f64)> = vec![];
    let mut more = trouble;
    let mut best: Option<(Candidate, Plan<'_>)> = None;
    let mut last = Plan::around(&balls, &[]);
    let mut spent = Spent { budget: VISITS, failures: BTreeMap::new() };
    let mut tries = 0;
    while tries < TRIES {
        tries += 1;
        let mut plan = loop {
            let Trouble::Places { places: new, .. } = &more else { break None };
            if !widen(&mut places, new, r) {
                break None;
            }
            let plan = Plan::around(&balls, &places);
            if !plan.is_like(&last) {
                break Some(plan);
            }
        };
        let Some(plan) = &mut plan else { break };
        let made = candidate(plan, &mut spent, params, watch);
        last = plan.clone();
        match made {
            Ok(made) => {
                more =
                    Trouble::at("a zone fails", made.failed.iter().filter(|f| f.may_be_wider).map(|f| f.at).collect());
                if best.as_ref().is_none_or(|b| b.0.blended.full_share < made.blended.full_share) {
                    best = Some((made, last.clone()));
                }
            }
            Err(Trouble::Cancelled(c)) => return Err(c.into()),
            Err(trouble) => more = trouble,
        }
    }
    let Some((best, mut plan)) = best else { return Err(more) };
    if best.failed.is_empty() {
        return Ok(best.blended);
    }
    // Where the envelope fails, a strip with a smaller ball here and there may not: in all zones, or in some of them.
    let shrinking = Params { overlap: Overlap::Shrink, ..params.clone() };
    let zones: Vec<Vec<Span>> = best.failed.iter().map(|f| f.spans.clone()).collect();
    let each = zones.iter().filter(|_| zones.len() > 1).take(TRIES - tries).cloned();
    let mut best = best.blended;
    for (k, released) in std::iter::once(zones.concat()).chain(each).enumerate() {
        let mut eased = plan.clone();
        for &span in &released {
            eased.release(span);
        }
        match candidate(&mut eased, &mut spent, &shrinking, watch) {
            Ok(made) if made.blended.full_share >= best.full_share - DEARER => {
                (best, plan) = (made.blended, eased);
                // All together.
                if k == 0 {
                    break;
                }
            }
            Err(Trouble::Cancelled(c)) => return Err(c.into()),
            _ => {}
        }
    }
    Ok(best)
}

/// What earlier tries have cost and shown.
struct Spent {
    /// Visits to faces that are left.
    budget: f64,
    /// Zones that the envelope does not fill, by their stretches: where and why.
    failures: BTreeMap<Vec<Span>, (DVec3, &'static str)>,
}

/// A blend of all curves, and the zones in which they stay sharp.
struct Candidate {
    blended: Blended,
    failed: Vec<Failed>,
}

/// A zone that the envelope does not fill.
struct Failed {
    at: DVec3,
    /// Whether one cut elsewhere may do.
    may_be_wider: bool,
    spans: Vec<Span>,
}

/// Blends all curves as planned.
fn candidate(plan: &mut Plan<'_>, spent: &mut Spent, params: &Params, watch: &Watch) -> Result<Candidate, Trouble> {
    let cut = Cut::along(plan, params)?;
    let (made, failed) = by_pieces(&cut, spent, params, watch)?;
    let blended = on_whole(plan.balls.ground_mesh(), plan.balls.curves, &cut, made);
    // Each piece was checked against what was there, but not what it left of the faces that it was cut into.
    let is_whole = |f: &FaceId| matches!(blended.origins.faces[*f], FaceOrigin::Input { .. });
    let changed: Vec<FaceId> = blended.mesh.face_ids().filter(|f| !is_whole(f)).collect();
    check_crossings(&blended.mesh, &changed, watch)?;
    Ok(Candidate { blended, failed })
}

/// Adds places to those around which there are zones; those that have one already get a wider one, and those next to one
/// are as wide, since a strip may fail all along a curve. Returns whether anything has changed.
fn widen(places: &mut Vec<(DVec3, f64)>, new: &[DVec3], r: f64) -> bool {
    let before = places.clone();
    for &p in new {
        let reach =
            |q: &(DVec3, f64)| if q.0.distance(p) <= (q.1 + NEAR) * r { (WIDER * q.1).min(WIDEST) } else { NEAR };
        let wide = before.iter().map(reach).fold(NEAR, f64::max);
        match places.iter_mut().find(|q| q.0.distance(p) <= SAME * r) {
            Some(known) => known.1 = wide,
            None => places.push((p, wide)),
        }
    }
    before != *places
}

/// What became of the pieces, and the zones that stay sharp.
type Pieces<'a> = (SoFar<'a>, Vec<Failed>);

/// Blends the pieces: zones by the envelope, the others by strips.
fn by_pieces<'a>(cut: &'a Cut, spent: &mut Spent, params: &Params, watch: &Watch) -> Result<Pieces<'a>, Trouble> {
    let mut failed = vec![];
    let mut so_far = SoFar::new(&cut.mesh, &cut.pieces, params.radius);
    let mut ends = cut.ends.clone();
    let chosen = envelope::halfedges_of(&cut.mesh, &cut.pieces);
    for (group, first) in groups(&cut.mesh, &cut.pieces, &cut.zoned, params.radius) {
        let own: Vec<&BlendCurve> = cut.pieces.iter().zip(&group).filter(|c| *c.1).map(|c| c.0).collect();
        let length: f64 = own.iter().map(|c| c.length(&cut.mesh)).sum();
        let cost = cut.mesh.face_count() as f64 + VISITS_PER_RADIUS * length / params.radius;
        let spans: Vec<Span> = (0..group.len()).filter(|&i| group[i]).map(|i| cut.spans[i]).collect();
        let mut made = match (spent.failures.get(&spans), envelope::sharp_end(&cut.mesh, &own, &chosen)) {
            (Some(&(at, what)), _) => Err(Trouble::at(what, vec![at])),
            (_, Some(at)) => Err(Trouble::at("the curve ends at edges that stay sharp", vec![at])),
            _ => Ok(()),
        };
        if made.is_ok() {
            for first in [first, first.opposite()] {
                spent.budget -= cost;
                if spent.budget < 0.0 {
                    made = Err(Trouble::at(NO_TIME, vec![]));
                    break;
                }
                let (mut tried, mut moved) = (so_far.clone(), ends.clone());
                made = by_envelope(&mut tried, &mut moved, cut, &group, first, params, watch);
                if let Err(Trouble::Cancelled(c)) = made {
                    return Err(c.into());
                }
                if made.is_ok() {
                    (so_far, ends) = (tried, moved);
                    break;
                }
                if !is_mixed(cut, &group) {
                    break;
                }
            }
        }
        if let Err(trouble) = made {
            let at = trouble.place().unwrap_or_else(|| own[0].points(&cut.mesh).first().copied().unwrap_or_default());
            so_far.leave(|i| group[i], at, trouble.what());
            spent.failures.insert(spans.clone(), (at, trouble.what()));
            failed.push(Failed { at, may_be_wider: ![NO_BALL, TOO_NARROW, NO_TIME].contains(&trouble.what()), spans });
        }
    }
    if cut.zoned.contains(&false) {
        let lost = |error| {
            let place = if let Error::DoesNotFit { at, .. } = error { vec![at] } else { vec![] };
            Trouble::at("a blend covers a neighbouring curve", place)
        };
        so_far.connect().map_err(lost)?;
        let chosen = so_far.curves(|i| !cut.zoned[i]).map_err(lost)?;
        let present = so_far.mesh.as_ref().unwrap_or(&cut.mesh);
        let at = ends.into_iter().map(ZoneEnd::into_cap).collect();
        let caps = Caps { at, border: border(present, &so_far, cut) };
        let made = attempt_between(present, &chosen, &caps, params, ROUNDS, watch)?;
        so_far.add(made, |i| !cut.zoned[i]);
    }
    if so_far.blended.mesh.faces.is_empty() {
        return Err(Trouble::at(NO_BALL, vec![]));
    }
    Ok((so_far, failed))
}

/// Whether a zone has ridges and valleys.
fn is_mixed(cut: &Cut, group: &[bool]) -> bool {
    let mut kinds = cut.convexities.iter().zip(group).filter(|k| *k.1).map(|k| *k.0);
    let first = kinds.next();
    kinds.any(|k| Some(k) != first)
}

/// Blends the pieces of one zone by the envelope, one convexity after the other.
fn by_envelope(
    so_far: &mut SoFar<'_>,
    ends: &mut [ZoneEnd],
    cut: &Cut,
    group: &[bool],
    first: Convexity,
    params: &Params,
    watch: &Watch,
) -> Result<(), Trouble> {
    let mut continued: Vec<Continued> = vec![];
    for convexity in [first, first.opposite()] {
        let own = |i: usize| group[i] && cut.convexities[i] == convexity;
        if !(0..cut.pieces.len()).any(own) {
            continue;
        }
        so_far.connect().map_err(|_| Trouble::at("the blend pinches", vec![]))?;
        let present = so_far.mesh.as_ref().unwrap_or(so_far.input);
        let chosen = on_continued(present, so_far.pieces(own), &continued);
        if chosen.is_empty() {
            // The other convexity's blend has consumed them.
            so_far.consumed(own, Method::Envelope);
            continue;
        }
        let here: Vec<usize> = (0..ends.len()).filter(|&l| own(ends[l].zone)).collect();
        let fences: Vec<_> = here.iter().map(|&l| ends[l].fence.clone()).collect();
        let Made { blended: mut made, caps, continued: own_continued } =
            envelope::blend(present, &chosen, convexity, &fences, params, watch)?;
        continued = own_continued;
        let moved = Moved::by(&made.origins);
        for end in ends.iter_mut() {
            end.move_on(&moved)
                .ok_or_else(|| Trouble::at("a blend covers a neighbouring curve", vec![end.fence.centre]))?;
        }
        for (l, cap) in here.into_iter().zip(caps) {
            ends[l].cap = Some(cap);
        }
        let by_ball =
            |i: usize| CurveBlend::made(Method::Envelope, params.radius, so_far.blended.curves[i].length, 1.0);
        made.curves = (0..cut.pieces.len()).filter(|&i| own(i)).map(by_ball).collect();
        so_far.add(made, own);
    }
    Ok(())
}

/// Curves of which some edges bounded plane faces that were continued since: there they follow the new boundary.
fn on_continued(mesh: &Connected<TriMesh>, curves: Vec<BlendCurve>, continued: &[Continued]) -> Vec<BlendCurve> {
    let edge = |a: VertexId, b: VertexId| [a.min(b), a.max(b)];
    let gone: BTreeMap<[VertexId; 2], usize> =
        (0..continued.len()).flat_map(|i| continued[i].before.windows(2).map(move |w| (edge(w[0], w[1]), i))).collect();
    let mut followed = vec![false; continued.len()];
    let (mut found, mut run) = (vec![], vec![]);
    for curve in curves {
        let count = curve.halfedges.len();
        for h in curve.halfedges {
            match gone.get(&edge(mesh.tail(h), mesh.head(h))) {
                Some(&i) => {
                    followed[i] = true;
                    found.push(BlendCurve { halfedges: std::mem::take(&mut run), closed: false });
                }
                None => run.push(h),
            }
        }
        let closed = curve.closed && run.len() == count;
        found.push(BlendCurve { halfedges: std::mem::take(&mut run), closed });
    }
    for (now, _) in continued.iter().zip(followed).filter(|f| f.1) {
        let halfedges = now.now.windows(2).filter_map(|w| mesh.halfedge(w[0], w[1])).collect();
        found.push(BlendCurve { halfedges, closed: false });
    }
    found.retain(|c| !c.halfedges.is_empty());
    found
}

/// The edges around what the zones got, and those that stay sharp in them.
fn border(present: &Connected<TriMesh>, so_far: &SoFar<'_>, cut: &Cut) -> Vec<EdgeId> {
    let faces = &so_far.blended.origins.faces;
    let is_new = |h: HalfedgeId| so_far.mesh.is_some() && matches!(faces[h.face()], FaceOrigin::New { .. });
    let around = |h: &HalfedgeId| is_new(*h) && present.twin(*h).is_some_and(|t| !is_new(t));
    let sharp = so_far.pieces(|i| cut.zoned[i]).into_iter().flat_map(|p| p.halfedges);
    present.halfedge_ids().filter(around).chain(sharp).map(|h| present.edge(h)).collect()
}

/// The account of the pieces as one of the whole curves.
fn on_whole(mesh: &Connected<TriMesh>, curves: &[BlendCurve], cut: &Cut, made: SoFar<'_>) -> Blended {
    let mut blended = made.blended;
    let stage = Stage { origins: &cut.origins, faces: &cut.mesh };
    blended.origins = blended.origins.compose(&[stage], &[mesh as &dyn Faces]);
    let parts = |c: usize| cut.spans.iter().zip(&blended.curves).filter(move |p| p.0.curve == c).map(|p| p.1);
    let whole = |(c, curve): (usize, &BlendCurve)| {
        let length = curve.length(mesh);
        let on = |method: Method| parts(c).filter(|p| p.method == method).map(|p| p.length).sum::<f64>();
        let methods = [Method::Strip, Method::Envelope, Method::Sharp];
        let method = methods.into_iter().max_by(|a, b| on(*a).total_cmp(&on(*b))).unwrap_or(Method::Sharp);
        let full = parts(c).map(|p| p.length * p.full_share).sum::<f64>() / parts(c).map(|p| p.length).sum::<f64>();
        let radius = parts(c).filter(|p| p.method != Method::Sharp).map(|p| p.radius).fold(f64::INFINITY, f64::min);
        let radius = if radius.is_finite() { radius } else { 0.0 };
        let left_sharp = parts(c).find_map(|p| p.left_sharp);
        CurveBlend { left_sharp, ..CurveBlend::made(method, radius, length, if full.is_nan() { 0.0 } else { full }) }
    };
    blended.curves = curves.iter().enumerate().map(whole).collect();
    blended
}
