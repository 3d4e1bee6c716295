//! The largest radius that fits.

use super::{Error, Overlap, Params, ROUNDS, Trouble, attempt};
use glam::DVec3;
use mesh_core::{Bounds, Connected, Faces, HalfedgeId, Positions, TriMesh, Watch};
use spine::BlendCurve;

/// How large a ball may be, and why no larger.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// The largest radius that works, within half a percent; the smallest tried that does not is at most that much larger.
    pub radius: f64,
    /// What goes wrong beyond it.
    pub what: &'static str,
    /// Where, in model units. `None` if nothing was in the way of any ball up to the size of the mesh.
    pub at: Option<DVec3>,
}

/// Ratio of the least radius that failed to the largest that worked at which the search ends.
const CLOSE_ENOUGH: f64 = 1.005;
/// First radius tried, as a share of the diagonal, and by what it grows until one fails. Smaller balls cost more, as the
/// inverse square of the radius.
const START: f64 = 1.0 / 64.0;
const GROWTH: f64 = 1.5;
/// How often the first radius is halved when it fails.
const HALVINGS: u32 = 10;

/// The end of the interval in which every radius can be blended along `curves` with [`Overlap::Error`]: radii are tried
/// from a 64th of the curves' box downwards until one works, then upwards until one fails, and the gap is halved.
///
/// # Errors
/// [`Error::DoesNotFit`] if even the smallest fails; those without a place as [`super::blend`].
pub fn max_radius(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
    watch: &Watch,
) -> Result<Limit, Error> {
    max_radius_above(HALVINGS, mesh, curves, params, watch)
}

/// The same, where the first radius is halved no more than `halvings` times: very small balls on long edges cost seconds.
pub(crate) fn max_radius_above(
    halvings: u32,
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
    watch: &Watch,
) -> Result<Limit, Error> {
    let ends = |h: &HalfedgeId| [mesh.position(mesh.tail(*h)), mesh.position(mesh.head(*h))];
    let points = curves.iter().flat_map(|c| &c.halfedges).flat_map(ends);
    let bounds = points.fold(Bounds::EMPTY, |b, p| b.union(Bounds::of([p; 3])));
    let diagonal = bounds.max.distance(bounds.min);
    let fits = |radius: f64| {
        let params = Params { radius, overlap: Overlap::Error, ..params.clone() };
        match attempt(mesh, curves, &params, ROUNDS, watch) {
            Ok(_) => Ok(None),
            Err(Trouble::Places { what, places }) => Ok(Some((what, places.first().copied()))),
            Err(other) => Err(other.into_error(radius)),
        }
    };
    let mut works = START * diagonal;
    let mut fails = None;
    for halving in 0.. {
        match fits(works)? {
            None => break,
            Some((what, at)) if halving == halvings => {
                let at = at.unwrap_or(DVec3::ZERO);
                return Err(Error::DoesNotFit { what, at, radius: works, workable: None });
            }
            Some(trouble) => {
                fails = Some((works, trouble));
                works *= 0.5;
            }
        }
    }
    while fails.is_none() {
        let next = GROWTH * works;
        if next > diagonal {
            return Ok(Limit { radius: works, what: "nothing", at: None });
        }
        match fits(next)? {
            None => works = next,
            Some(trouble) => fails = Some((next, trouble)),
        }
    }
    let (mut limit, mut trouble) = fails.unwrap_or((works, ("nothing", None)));
    while limit > CLOSE_ENOUGH * works {
        let middle = (limit * works).sqrt();
        match fits(middle)? {
            None => works = middle,
            Some(found) => (limit, trouble) = (middle, found),
        }
    }
    Ok(Limit { radius: works, what: trouble.0, at: trouble.1 })
}
