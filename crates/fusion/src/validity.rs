//! Whether a result is sound in the coordinates that a file will hold.

use crate::inherited::{Inherited, inherited};
use crate::invalid::Invalid;
use crate::{Error, Validity};
use glam::DVec3;
use mesh_core::{Connected, FaceId, FaceOrigin, Origins, TriMesh, Watch, boundary_loops, validate};
use mesh_io::{Format, Model};
use rayon::prelude::*;
use tri_intersect::{self_intersections, self_intersections_among};

/// What a result is promised to be, beside free of self-intersections in what was changed.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Promise {
    /// Oriented and 2-manifold, with this many boundary loops: closed if none.
    Openings(usize),
    /// Oriented and 2-manifold.
    Manifold,
    /// Oriented and 2-manifold; where it crosses itself is told, whatever was changed.
    Repaired,
}

/// Checks a result as `format` will hold it: finite, oriented, 2-manifold, closed where promised, and no changed face meeting another.
///
/// All crossings are counted. Those of whole faces of the inputs are theirs, and are told; faces that rounding moves may cross only
/// where they did before. Returns with the validity what the inputs brought along. `inputs` are those of the origins, or none: with them a large result is connected sooner. O(n log n).
pub(crate) fn as_written(
    model: &Model,
    origins: &Origins,
    inputs: &[&Connected<TriMesh>],
    format: Format,
    promise: Promise,
    watch: &Watch,
) -> Result<(Validity, Vec<Inherited>), Error> {
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
    let crossings = Crossings { mesh, shape, origins, promise };
    let found = match crossings.sort(watch) {
        Ok(found) => found,
        Err(tri_intersect::Error::Cancelled(c)) => return Err(c.into()),
        Err(error) => return invalid(error.to_string(), None),
    };
    if let Some(&[f, _]) = found.made.first() {
        return invalid(format!("{} pairs of faces intersect", found.made.len()), Some(shape.triangle(f)[0]));
    }
    let count = Some(found.brought.len());
    let validity = Validity { manifold: Some(true), closed: Some(closed), self_intersections: count };
    Ok((validity, inherited(shape, &found.brought, origins)))
}

/// The crossings of a mesh that was checked before, by the parts of other origins.
pub(crate) fn crossings_of(mesh: &TriMesh, origins: &Origins, watch: &Watch) -> Result<Vec<Inherited>, Error> {
    match self_intersections(mesh, watch) {
        Ok(pairs) => Ok(inherited(mesh, &pairs, origins)),
        Err(tri_intersect::Error::Cancelled(c)) => Err(c.into()),
        // The mesh was found finite before.
        Err(_) => Ok(vec![]),
    }
}

/// A result and the same with rounded coordinates.
struct Crossings<'a> {
    mesh: &'a TriMesh,
    shape: &'a TriMesh,
    origins: &'a Origins,
    promise: Promise,
}

/// Pairs of faces that cross, in order.
struct Found {
    /// Made by the job or by rounding.
    made: Vec<[FaceId; 2]>,
    /// Brought along by the inputs.
    brought: Vec<[FaceId; 2]>,
}

impl Crossings<'_> {
    fn sort(&self, watch: &Watch) -> Result<Found, tri_intersect::Error> {
        let own =
            |f: FaceId| self.promise == Promise::Repaired || matches!(self.origins.faces[f], FaceOrigin::Input { .. });
        let moved = |f: FaceId| self.shape.triangle(f) != self.mesh.triangle(f);
        let pairs = self_intersections(self.shape, watch)?;
        let doubtful: Vec<FaceId> =
            pairs.iter().flatten().copied().filter(|&f| !std::ptr::eq(self.shape, self.mesh) && moved(f)).collect();
        let before = if doubtful.is_empty() { vec![] } else { self_intersections_among(self.mesh, &doubtful, watch)? };
        let crossed = |pair: &[FaceId; 2]| !pair.iter().any(|f| moved(*f)) || before.binary_search(pair).is_ok();
        let (brought, made) = pairs.into_iter().partition(|pair| pair.iter().all(|&f| own(f)) && crossed(pair));
        Ok(Found { made, brought })
    }
}
