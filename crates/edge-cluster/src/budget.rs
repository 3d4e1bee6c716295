//! Whether a polyhedron is small enough to be covered by clusters automatically, told by a count before anything is fitted.

use crate::error::Error;
use crate::layout::{Params, shape_of};
use crate::polyhedron::Polyhedron;

/// Polyhedra with no more vertices are tried, whatever their patches cost.
const FEW: usize = 100;
/// Control points of all patches, if each vertex has one: 12 000 take some seconds.
const MOST: usize = 12_000;

/// Refuses scans and other curved surfaces, whose every vertex would get a patch of its own. O(n).
///
/// # Errors
/// [`Error::TooLarge`].
///
/// ```
/// use edge_cluster::{Error, Params, Polyhedron, PolyhedronParams, check_budget};
/// let solid = |level| Polyhedron::new(&mesh_core::shapes::icosphere(1.0, level), None, &PolyhedronParams::default());
/// assert_eq!(check_budget(&solid(2)?, &Params::default()), Ok(()));
/// assert!(matches!(check_budget(&solid(3)?, &Params::default()), Err(Error::TooLarge { vertices: 642, .. })));
/// # Ok::<(), Error>(())
/// ```
pub fn check_budget(solid: &Polyhedron, params: &Params) -> Result<(), Error> {
    let vertices = solid.vertices().count();
    if vertices <= FEW {
        return Ok(());
    }
    let patch = |v: u32| shape_of(solid.ring(v).count(), params.degree, params.continuity).count();
    let points = solid.vertices().map(patch).fold(0, usize::saturating_add);
    if points > MOST { Err(Error::TooLarge { vertices, points, most: MOST }) } else { Ok(()) }
}
