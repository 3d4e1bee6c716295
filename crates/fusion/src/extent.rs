//! How large and how small a model may be: products of three lengths must stay finite and above zero.

use crate::Error;
use mesh_core::{Bounds, bounds};
use mesh_io::Model;
use std::ops::RangeInclusive;

/// Diagonals and coordinates with which distances, areas and volumes can be computed, in model units.
const WORKABLE: RangeInclusive<f64> = 1e-100..=1e100;

/// Refuses models whose joint box is too large or too small to measure in.
pub(crate) fn check(parts: &[Model]) -> Result<(), Error> {
    check_box(parts.iter().map(|m| bounds(&m.mesh)).fold(Bounds::EMPTY, Bounds::union))
}

/// The same for a box.
pub(crate) fn check_box(joint: Bounds) -> Result<(), Error> {
    let farthest = joint.min.abs().max(joint.max.abs()).max_element();
    let diagonal = joint.diagonal();
    // An empty model, or one in a single point, is refused for what it is.
    if joint.is_empty() || diagonal == 0.0 || (WORKABLE.contains(&diagonal) && farthest <= *WORKABLE.end()) {
        return Ok(());
    }
    Err(Error::Extent { size: if WORKABLE.contains(&diagonal) { farthest } else { diagonal } })
}
