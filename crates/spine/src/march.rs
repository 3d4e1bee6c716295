//! The ball along the whole curve: the spine traced as the crossing of two offset surfaces.
//!
//! The spine is the set { distance to left = r, distance to right = r }. Following that set itself, instead of solving
//! in the normal planes of the blend curve, needs no plane to be well placed: where a plane cuts the spine twice or
//! not at all, the trace just goes on, and where the ball is blocked by a third contact it turns there, as a real
//! ball does.

use crate::contact::Contact;
use crate::curve::{BlendCurve, Convexity, face_normal};
use crate::patch::Patch;
use crate::radius::RadiusField;
use crate::{Error, Params};
use glam::DVec3;
use mesh_core::{Adjacency, HalfedgeId, Positions};

/// How a trace ended well.
pub(crate) enum Trace {
    /// Balls along the closed spine, in order, the last next to the first.
    Closed(Vec<Contact>),
    /// Balls along an open spine, from beyond the curve's beginning to beyond its end as far as the patches carry them.
    Open(Vec<Contact>),
    /// A foot came to where a patch was cut off: it is to be flooded farther.
    RanOff,
}

/// How a ball's feet stand on their patches.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Footing {
    /// On both patches.
    Firm,
    /// At the edge where a patch was cut off.
    AtRim,
    /// At a blend curve with the ball already beyond the side of its patch: rolling on would take it round the curve
    /// into the solid.
    Tipping,
    /// On an edge where the patches of an open curve end: the ball is past the curve's own end.
    Over,
}

/// Rolls a ball along `curve`, looking at every ball's `footing`. Where a closed trace cannot go on, `contacts` are the
/// balls so far.
///
/// # Errors
/// [`Error::NoStart`] where no ball can be seated anywhere, [`Error::Stuck`] where the trace cannot go on,
/// [`Error::Astray`] where it does not come back.
pub(crate) fn trace<M: Adjacency + Positions>(
    mesh: &M,
    curve: &BlendCurve,
    convexity: Convexity,
    patches: &[Patch; 2],
    params: &Params,
    footing: impl Fn(&Contact) -> Footing,
    contacts: &mut Vec<Contact>,
) -> Result<Trace, Error> {
    let (radius, step) = (&params.radius, params.step);
    let (start, sign) = first_contact(mesh, curve, convexity, patches, radius)?;
    let limit = 8.0 * curve.length(mesh) + 64.0 * radius.base;
    if !curve.closed {
        let ends = curve.ends(mesh).into_iter().map(|end| end.0).collect();
        return Ok(trace_open(mesh, patches, params, &Way { start, sign, limit, ends }, footing));
    }
    contacts.clear();
    contacts.push(start);
    let (mut here, mut travelled, mut stride) = (start, 0.0, step);
    while travelled < limit {
        let next = stride_from(mesh, patches, params, &here, sign, &mut stride).ok_or(stuck(&here, radius))?;
        match footing(&next) {
            Footing::Firm => {}
            Footing::AtRim => return Ok(Trace::RanOff),
            Footing::Tipping | Footing::Over => return Err(stuck(&next, radius)),
        }
        let chord = next.center - here.center;
        if travelled > 2.0 * step && closes(&start, &here, chord, step) {
            if contacts.len() > 3 && here.center.distance(start.center) < 0.3 * step {
                contacts.pop();
            }
            return Ok(Trace::Closed(std::mem::take(contacts)));
        }
        // Steps are as long as they can be, so a trace that needs more than this crawls round a place it cannot pass.
        if contacts.len() as f64 > 4.0 * limit / step {
            return Err(stuck(&next, radius));
        }
        travelled += chord.length();
        contacts.push(next);
        here = next;
        stride = (1.6 * stride).min(params.longest.max(step));
    }
    Err(Error::Astray { at: here.center, travelled, curve: curve.length(mesh) })
}

/// What an open trace starts from, and where it may end.
struct Way {
    start: Contact,
    /// Whether left × right runs along the curve or against it.
    sign: f64,
    /// Longest way in either direction.
    limit: f64,
    /// The curve's ends.
    ends: Vec<DVec3>,
}

/// How far from a curve's end long strides stop, in radii: there feet outrun the ball or lag behind.
const CAREFUL: f64 = 8.0;

/// Rolls the ball both ways from the start.
fn trace_open<M: Adjacency + Positions>(
    mesh: &M,
    patches: &[Patch; 2],
    params: &Params,
    Way { start, sign, limit, ends }: &Way,
    footing: impl Fn(&Contact) -> Footing,
) -> Trace {
    let careful = |ball: &Contact| ends.iter().any(|e| e.distance(ball.center) < CAREFUL * params.radius.base);
    let mut contacts = vec![*start];
    for sign in [-sign, *sign] {
        contacts.reverse();
        let (mut here, mut travelled, mut stride) = (contacts[contacts.len() - 1], 0.0, params.step);
        let most = contacts.len() as f64 + 4.0 * limit / params.step;
        // Past the curve's end there is nothing to demand, so whatever stops the ball ends the trace; whether it came far
        // enough is seen where the ends are made.
        while travelled < *limit && (contacts.len() as f64) < most {
            let Some(next) = stride_from(mesh, patches, params, &here, sign, &mut stride) else { break };
            match footing(&next) {
                Footing::Firm => {}
                Footing::AtRim => return Trace::RanOff,
                // A long stride must not fall short of the end.
                Footing::Tipping | Footing::Over if stride > params.step => {
                    stride = params.step;
                    continue;
                }
                Footing::Tipping | Footing::Over => break,
            }
            travelled += next.center.distance(here.center);
            contacts.push(next);
            here = next;
            let longest = if careful(&here) { params.step } else { params.longest.max(params.step) };
            stride = (1.6 * stride).min(longest);
        }
    }
    Trace::Open(contacts)
}

fn stuck(here: &Contact, radius: &RadiusField) -> Error {
    Error::Stuck { at: here.center, radius: here.radius, wanted: radius.base }
}

/// Whether the step from `here` along `chord` comes past the start.
fn closes(start: &Contact, here: &Contact, chord: DVec3, step: f64) -> bool {
    let to_start = start.center - here.center;
    let along = to_start.dot(chord) / chord.length_squared();
    (0.0..=1.0).contains(&along)
        && (to_start - along * chord).length() < 0.5 * step
        && start.tangent().zip(here.tangent()).is_some_and(|(s, h)| s.dot(h) > 0.0)
}

/// Shortest step along the spine, as a share of the radius: a place that a shorter one would pass needs a smaller ball.
const SHORTEST: f64 = 5e-4;

/// One step, halved until the seated ball is ahead and near. Where the spine turns sharply because the ball meets a
/// third contact, the tangent behind the corner serves in place of the one before it.
fn stride_from<M: Adjacency + Positions>(
    mesh: &M,
    patches: &[Patch; 2],
    params: &Params,
    here: &Contact,
    sign: f64,
    stride: &mut f64,
) -> Option<Contact> {
    let radius = &params.radius;
    let direction = sign * here.tangent()?;
    let known = here.feet.map(|f| f.point);
    while *stride > SHORTEST * radius.base {
        let reached = |heading: DVec3, guess: DVec3| {
            let next = Contact::seat(mesh, patches, radius, guess, Some(known))?;
            let chord = next.center - here.center;
            (chord.dot(heading) > 0.3 * *stride && chord.length() < 1.8 * *stride && next.tangent().is_some())
                .then_some(next)
                .filter(|next| *stride <= params.step || straight(mesh, patches, params, here, next))
        };
        let ahead = here.center + *stride * direction;
        // Where a third contact blocks the way, the point ahead is already nearer to it: its tangent leads round the
        // corner. The guess is put on the third contact's side, so that its branch is found and not the old one, from
        // which a spine that turns back in a crevice hardly differs.
        let round_the_corner = || {
            let blocked = Contact::probe(mesh, patches, radius, ahead, Some(known))?;
            let heading = sign * blocked.tangent()?;
            let jumped = |s: &usize| blocked.feet[*s].point.distance(known[*s]) > 2.0 * *stride;
            let lean: DVec3 = (0..2).filter(jumped).map(|s| blocked.normals()[s]).sum();
            reached(heading, here.center + *stride * (heading - 0.4 * lean))
        };
        if let Some(next) = reached(direction, ahead).or_else(round_the_corner) {
            return Some(next);
        }
        *stride *= 0.5;
    }
    None
}

/// Whether the spine runs nearly straight from one ball to the next: in its tangents, and where a ball in the middle
/// would stand.
fn straight<M: Adjacency + Positions>(
    mesh: &M,
    patches: &[Patch; 2],
    params: &Params,
    here: &Contact,
    next: &Contact,
) -> bool {
    let chord = next.center.distance(here.center);
    let Some((t, u)) = here.tangent().zip(next.tangent()) else { return false };
    let most = params.sagitta * params.radius.base;
    let probe = || Contact::probe(mesh, patches, &params.radius, here.center.midpoint(next.center), None);
    t.angle_between(u) * chord / 8.0 <= most && probe().is_some_and(|middle| middle.residual <= 2.0 * most)
}

/// In how many places along a curve a first ball is tried.
const STRETCHES: usize = 96;

/// Seats the first ball where the wedge is plainest, and tells whether left × right runs along the curve or against it.
fn first_contact<M: Adjacency + Positions>(
    mesh: &M,
    curve: &BlendCurve,
    convexity: Convexity,
    patches: &[Patch; 2],
    radius: &RadiusField,
) -> Result<(Contact, f64), Error> {
    let side = match convexity {
        Convexity::Concave => 1.0,
        Convexity::Convex => -1.0,
    };
    // The longest edge of each stretch proposes the centre that is exact between the planes of its two faces.
    let length = |h: &HalfedgeId| mesh.edge_length(*h);
    let mut guesses: Vec<(f64, DVec3, DVec3)> = Vec::new();
    for stretch in curve.halfedges.chunks(curve.halfedges.len().div_ceil(STRETCHES).max(1)) {
        let longest = stretch.iter().copied().max_by(|g, h| length(g).total_cmp(&length(h)));
        let Some((h, t)) = longest.and_then(|h| Some((h, mesh.twin(h)?))) else { continue };
        let [a, b] = mesh.ends(h);
        let (left, right) = (face_normal(mesh, h), face_normal(mesh, t));
        let (middle, spread) = (0.5 * (a + b), 1.0 + left.dot(right));
        if spread < 0.02 || left == DVec3::ZERO || right == DVec3::ZERO {
            continue;
        }
        let r = radius.at(middle).0;
        let [one, other] = radius.sides.map(|share| r * share);
        let mean = 0.5 * (one + other) / spread * (left + right);
        let skew = 0.5 * (one - other) / (2.0 - spread).max(0.02) * (left - right);
        let center = middle + side * (mean + skew);
        let miss = |i: usize| {
            patches[i].closest(mesh, center).map_or(f64::INFINITY, |c| (c.distance - r * radius.sides[i]).abs() / r)
        };
        let miss = miss(0).max(miss(1));
        guesses.push((miss, center, (b - a).normalize_or_zero()));
    }
    guesses.sort_by(|a, b| a.0.total_cmp(&b.0));
    for &(_, center, along) in &guesses {
        let Some(contact) = Contact::seat(mesh, patches, radius, center, None) else { continue };
        let Some(tangent) = contact.tangent() else { continue };
        let slope = tangent.dot(along);
        let near = contact.center.distance(center) < contact.radius;
        let apart = contact.feet[0].point.distance(contact.feet[1].point) > 1e-3 * contact.radius;
        if near && apart && slope.abs() > 0.5 {
            return Ok((contact, slope.signum()));
        }
    }
    let at = curve.halfedges.first().map_or(DVec3::ZERO, |&h| mesh.position(mesh.tail(h)));
    Err(Error::NoStart { at, radius: radius.at(at).0 })
}
