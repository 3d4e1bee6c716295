//! Whether a result is sound in the coordinates that a file will hold.

use crate::diagnostic::Code;
use crate::inherited::{Inherited, inherited};
use crate::invalid::Invalid;
use crate::{Error, Report, Validity};
use glam::DVec3;
use mesh_core::{Connected, FaceId, FaceOrigin, Faces, Origins, TriMesh, Watch, boundary_loops, validate};
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
/// Looks where something changed, and so costs less than the job; [`look_everywhere`] costs more. Whole faces of the inputs may cross:
/// that is theirs, and told; those that rounding moves, only where they did before. Returns with the validity what the inputs brought
/// along there. `inputs` are those of the origins, or none: with them a large result is connected sooner.
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

/// Counts all crossings of a result as `format` will hold it in its report, with those of faces that were not touched, and names what
/// the inputs brought along. O(n log n), about a microsecond a face: more than a boolean takes, so it is for whoever writes the report.
///
/// # Errors
/// [`Error::Cancelled`].
pub fn look_everywhere(
    model: &Model,
    origins: &Origins,
    format: Format,
    report: &mut Report,
    watch: &Watch,
) -> Result<(), Error> {
    let rounded = mesh_io::as_written(model, format);
    let found = report.time("crossings", || crossings_of(rounded.as_ref().unwrap_or(&model.mesh), origins, watch))?;
    report.forget(Code::Inherited);
    let count = found.iter().map(|part| part.count).sum();
    let validity = Validity { self_intersections: Some(count), ..report.validity };
    report.checked((validity, found));
    Ok(())
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
        let rounded = !std::ptr::eq(self.shape, self.mesh);
        let moved = |f: FaceId| rounded && self.shape.triangle(f) != self.mesh.triangle(f);
        let changed = |f: &FaceId| !matches!(self.origins.faces[*f], FaceOrigin::Input { .. }) || moved(*f);
        let pairs = if self.promise == Promise::Repaired {
            self_intersections(self.shape, watch)?
        } else {
            let changed: Vec<FaceId> = self.shape.face_ids().filter(changed).collect();
            self_intersections_among(self.shape, &changed, watch)?
        };
        let doubtful: Vec<FaceId> = pairs.iter().flatten().copied().filter(|&f| moved(f)).collect();
        let before = if doubtful.is_empty() { vec![] } else { self_intersections_among(self.mesh, &doubtful, watch)? };
        let crossed = |pair: &[FaceId; 2]| !pair.iter().any(|f| moved(*f)) || before.binary_search(pair).is_ok();
        let (brought, made) = pairs.into_iter().partition(|pair| pair.iter().all(|&f| own(f)) && crossed(pair));
        Ok(Found { made, brought })
    }
}
