//! The largest radius that fits.

use crate::error::Error;
use crate::params::{Overlap, Params, Surface};
use crate::stitch::{ROUNDS, attempt};
use crate::trouble::Trouble;
use crate::vicinity::vicinity;
use crate::width;
use glam::DVec3;
use mesh_core::{Bounds, Connected, HalfedgeId, Positions, TriMesh, Watch};
use spine::BlendCurve;

/// How large a ball may be, and why no larger.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// The largest radius that works, within half a percent: the smallest tried that does not is at most that much larger.
    pub radius: f64,
    /// What goes wrong beyond it.
    pub what: &'static str,
    /// Where, in model units. `None` if balls up to the size of the curves all work, as they do where they can roll on the edges of
    /// both sides: no larger one is tried.
    pub at: Option<DVec3>,
}

/// What ends a search in which no ball fails.
const SEARCHED: &str = "the size of the curves, up to which balls are tried; larger ones may work too";

/// Ratio of the least radius that failed to the largest that worked at which the search ends.
const CLOSE_ENOUGH: f64 = 1.005;
/// First radius tried, as a share of the diagonal, and by what it grows until one fails. Smaller balls cost more, as the
/// inverse square of the radius.
const START: f64 = 1.0 / 64.0;
const GROWTH: f64 = 1.5;
/// How often a radius that fails is halved.
const HALVINGS: u32 = 5;
/// Shares of a radius that works at which smaller ones are tried too, as far as they are a thousandth of the diagonal.
const BELOW: [f64; 6] = [0.9, 0.7, 0.5, 0.25, 0.125, 0.05];
const LEAST: f64 = 1e-3;

/// The end of the interval from 0 in which every radius can be blended along `curves` with [`Overlap::Error`]: radii are
/// tried from a 64th of the curves' box downwards until one works, then upwards until one fails, and the gap is halved.
/// Six smaller ones are tried then; if one fails, the search goes on below it, unless nothing down to a thousandth of the
/// box fits there: a ball that is too small for the mesh is no reason to refuse larger ones.
///
/// # Errors
/// [`Error::DoesNotFit`] if even the smallest fails; those without a place as [`super::blend`].
pub fn max_radius(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
    watch: &Watch,
) -> Result<Limit, Error> {
    let search = Search { mesh, curves, params, watch };
    let diagonal = search.diagonal();
    let mut found = search.bracket(START * diagonal, None, HALVINGS)?;
    let below = |limit: &Limit| -> Result<Option<Failure>, Error> {
        let smaller = BELOW.map(|share| share * limit.radius).into_iter().filter(|&r| r >= LEAST * diagonal);
        for radius in smaller {
            if let Some(failure) = search.fails(radius)? {
                return Ok(Some(failure));
            }
        }
        Ok(None)
    };
    while let Some(failure) = below(&found)? {
        let first = 0.5 * failure.radius;
        let halvings = (first / (LEAST * diagonal)).max(1.0).log2() as u32;
        match search.bracket(first, Some(failure), halvings) {
            Ok(smaller) => found = smaller,
            Err(Error::DoesNotFit { .. }) => break,
            Err(other) => return Err(other),
        }
    }
    Ok(found)
}

/// How large a ball may be along one curve of a list, found in little time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ListedRadius {
    /// In model units.
    pub radius: f64,
    /// Whether a blend of this radius was made and checked; else it is what the width of the sides allows, and no more than an upper
    /// bound.
    pub tried: bool,
    /// What is in the way of a larger one.
    pub what: &'static str,
    /// Where, in model units.
    pub at: DVec3,
}

/// Shares of what the sides allow that are tried for a list.
const LISTED: [f64; 3] = [0.98, 0.49, 0.24];

/// The largest radius for one curve of a list: what the width of its sides allows, or if `attempts` the first share of it with which
/// the curve alone can be blended. `None` where the sides have no end or no share works.
///
/// # Errors
/// Cancelled, or a mesh that no tree can be built of.
pub fn listed_radius(
    mesh: &Connected<TriMesh>,
    curve: &BlendCurve,
    attempts: bool,
    watch: &Watch,
) -> Result<Option<ListedRadius>, Error> {
    let Some((widest, narrowest)) = width::widest_ball(mesh, curve) else { return Ok(None) };
    let (mut what, mut at) = ("the width of its sides", narrowest);
    if !attempts {
        return Ok(Some(ListedRadius { radius: widest, tried: false, what, at }));
    }
    let curves = std::slice::from_ref(curve);
    for radius in LISTED.map(|share| share * widest) {
        let params = Params { overlap: Overlap::Error, surface: Surface::Stitch, ..Params::new(radius) };
        let near = vicinity(mesh, curves, &params);
        let (part, own) = near.as_ref().map_or((mesh, curves), |n| (&n.mesh, &n.curves[..]));
        match attempt(part, own, &params, ROUNDS, watch) {
            Ok(_) => return Ok(Some(ListedRadius { radius, tried: true, what, at })),
            Err(Trouble::Cancelled(c)) => return Err(c.into()),
            Err(Trouble::Places { what: trouble, places }) => {
                (what, at) = (trouble, places.first().copied().unwrap_or(at));
            }
            Err(_) => {}
        }
    }
    Ok(None)
}

/// A radius that does not fit, and why.
struct Failure {
    radius: f64,
    what: &'static str,
    at: Option<DVec3>,
}

struct Search<'a> {
    mesh: &'a Connected<TriMesh>,
    curves: &'a [BlendCurve],
    params: &'a Params,
    watch: &'a Watch,
}

impl Search<'_> {
    /// Of the box around the curves.
    fn diagonal(&self) -> f64 {
        let ends = |h: &HalfedgeId| self.mesh.ends(*h);
        let points = self.curves.iter().flat_map(|c| &c.halfedges).flat_map(ends);
        let bounds = Bounds::of(points);
        bounds.max.distance(bounds.min)
    }

    fn fails(&self, radius: f64) -> Result<Option<Failure>, Error> {
        let params = Params { radius, overlap: Overlap::Error, ..self.params.clone() };
        match attempt(self.mesh, self.curves, &params, ROUNDS, self.watch) {
            Ok(_) => Ok(None),
            Err(Trouble::Places { what, places }) => Ok(Some(Failure { radius, what, at: places.first().copied() })),
            Err(other) => Err(other.into_error(radius)),
        }
    }

    /// Halves `works` until it does, makes it grow until it fails unless a larger one is known to, and halves the gap.
    fn bracket(&self, mut works: f64, mut known: Option<Failure>, halvings: u32) -> Result<Limit, Error> {
        let diagonal = self.diagonal();
        let mut halving = 0;
        while let Some(Failure { radius, what, at }) = self.fails(works)? {
            if halving == halvings {
                return Err(Error::DoesNotFit { what, at: at.unwrap_or(DVec3::ZERO), radius, workable: None });
            }
            known = Some(Failure { radius, what, at });
            works *= 0.5;
            halving += 1;
        }
        let mut failure = loop {
            if let Some(failure) = known {
                break failure;
            }
            if works >= diagonal {
                return Ok(Limit { radius: works, what: SEARCHED, at: None });
            }
            let next = (GROWTH * works).min(diagonal);
            known = self.fails(next)?;
            if known.is_none() {
                works = next;
            }
        };
        while failure.radius > CLOSE_ENOUGH * works {
            let middle = (failure.radius * works).sqrt();
            match self.fails(middle)? {
                None => works = middle,
                Some(found) => failure = found,
            }
        }
        Ok(Limit { radius: works, what: failure.what, at: failure.at })
    }
}
