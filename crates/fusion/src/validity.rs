//! Whether a result is sound in the coordinates that a file will hold.

use crate::invalid::Invalid;
use crate::{Error, Validity};
use glam::DVec3;
use mesh_core::{Connected, FaceId, FaceOrigin, Faces, Origins, TriMesh, Watch, boundary_loops, validate};
use mesh_io::{Format, Model};
use rayon::prelude::*;
use tri_intersect::self_intersections_among;

/// What a result is promised to be, beside free of self-intersections in what was changed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Promise {
    /// Oriented and 2-manifold, with this many boundary loops: closed if none.
    Openings(usize),
    /// Oriented and 2-manifold.
    Manifold,
}

/// Checks a result as `format` will hold it: finite, oriented, 2-manifold, closed where promised, and no changed face meeting another.
///
/// Faces that rounding moves count as changed. Whole faces of the inputs are trusted among each other. `inputs` are those of
/// the origins, or none: with them a large result is connected sooner.
pub(crate) fn as_written(
    model: &Model,
    origins: &Origins,
    inputs: &[&Connected<TriMesh>],
    format: Format,
    promise: Promise,
    watch: &Watch,
) -> Result<Validity, Error> {
    let mesh = &model.mesh;
    let rounded = mesh_io::as_written(model, format);
    let (shape, format) = rounded.as_ref().map_or((mesh, None), |r| (r, Some(format)));
    let invalid = |reason: String, at: Option<DVec3>| Err(Invalid { reason, at, format }.into());
    let connected = match Connected::carried(shape, inputs, origins) {
        Ok(connected) if shape.positions.par_iter().all(|p| p.is_finite()) => connected,
        fault => return invalid(validate(shape).to_string().replace('\n', ";"), fault.err().and_then(|e| e.place)),
    };
    let loops = boundary_loops(&connected);
    if let Promise::Openings(promised) = promise
        && loops.len() != promised
    {
        let at = loops.last().and_then(|l| l.first()).map(|h| shape.triangle(h.face())[h.corner()]);
        return invalid(format!("it has {} boundary loops instead of {promised}", loops.len()), at);
    }
    let closed = loops.is_empty();
    let moved = |f: FaceId| rounded.as_ref().is_some_and(|r| r.triangle(f) != mesh.triangle(f));
    let changed: Vec<FaceId> =
        shape.face_ids().filter(|&f| !matches!(origins.faces[f], FaceOrigin::Input { .. }) || moved(f)).collect();
    match self_intersections_among(shape, &changed, watch) {
        Ok(pairs) => match pairs.first() {
            None => Ok(Validity { manifold: Some(true), closed: Some(closed), self_intersections: Some(0) }),
            Some(&[f, _]) => invalid(format!("{} pairs of faces intersect", pairs.len()), Some(shape.triangle(f)[0])),
        },
        Err(tri_intersect::Error::Cancelled(c)) => Err(c.into()),
        Err(error) => invalid(error.to_string(), None),
    }
}
