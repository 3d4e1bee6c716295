//! Which curves are swept and which are blended as a field, one after the other on the same mesh.

use super::trouble::Trouble;
use super::{Blended, CurveBlend, Error, Method, Params, ROUNDS, Surface, attempt, explained, field};
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, FaceId, Faces, Origins, Positions, Stage, TriMesh, VertexId, VertexOrigin, Watch,
};
use spine::{BlendCurve, Convexity};

/// Curves nearer to each other than this, in radii, are blended in the same way: their blends may meet.
const NEIGHBOURS: f64 = 5.0;

/// Sweeps all curves, or with [`Surface::Field`] none; those near a place where that fails are blended as a field.
///
/// # Errors
/// That of the sweep where a field cannot serve, or where that fails too.
pub(crate) fn blend(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
    watch: &Watch,
) -> Result<Blended, Error> {
    if curves.is_empty() {
        return Err(Error::NoCurves);
    }
    let as_asked = params.surface == Surface::Field;
    let mut so_far = SoFar::new(mesh, curves, params.radius);
    let mut by_field = vec![as_asked; curves.len()];
    let mut refusal = None;
    while by_field.contains(&false) {
        let chosen: Vec<BlendCurve> = so_far.curves(|i| !by_field[i])?;
        match attempt(mesh, &chosen, params, ROUNDS, watch) {
            Ok(swept) => {
                so_far.add(swept, |i| !by_field[i]);
                break;
            }
            Err(Trouble::Cancelled(c)) => return Err(c.into()),
            Err(trouble) if !field::serves(curves, params) => return explained(mesh, curves, params, trouble, watch),
            Err(trouble) => {
                so_far.blended.fallbacks.extend(hand_over(mesh, curves, params, &trouble, &mut by_field));
                refusal = Some(trouble);
            }
        }
    }
    loop {
        let failure = match add_fields(&mut so_far, &by_field, params, watch) {
            Ok(()) => return Ok(so_far.blended),
            Err(failure) => failure,
        };
        let Some(trouble) = refusal.take_if(|_| !matches!(failure, Error::Cancelled(_))) else { return Err(failure) };
        if !by_field.contains(&false) {
            return explained(mesh, curves, params, trouble, watch);
        }
        // Some of the curves alone may not tell two sides apart.
        by_field.fill(true);
        let told = so_far.blended.fallbacks;
        so_far = SoFar::new(mesh, curves, params.radius);
        so_far.blended.fallbacks = told;
        refusal = Some(trouble);
    }
}

/// Blends the marked curves as fields, one for valleys and one for ridges.
fn add_fields(so_far: &mut SoFar<'_>, by_field: &[bool], params: &Params, watch: &Watch) -> Result<(), Error> {
    let (mesh, curves) = (so_far.input, so_far.all);
    for convexity in [Convexity::Concave, Convexity::Convex] {
        let own = |i: usize| by_field[i] && curves[i].convexity(mesh).unwrap_or(Convexity::Concave) == convexity;
        if !(0..curves.len()).any(own) {
            continue;
        }
        so_far.connect()?;
        let chosen = so_far.curves(own)?;
        let made = match &so_far.mesh {
            Some(changed) => field::blend(changed, &chosen, convexity, params, watch),
            None => field::blend(mesh, &chosen, convexity, params, watch),
        };
        so_far.add(made?, own);
    }
    Ok(())
}

/// Marks the curves around the places where sweeping fails; all of them if no place is near one. Returns for each such
/// group of curves a place and what fails there.
fn hand_over(
    mesh: &Connected<TriMesh>,
    curves: &[BlendCurve],
    params: &Params,
    trouble: &Trouble,
    by_field: &mut [bool],
) -> Vec<(DVec3, &'static str)> {
    let (what, places) = match trouble {
        Trouble::Places { what, places } => (*what, &places[..]),
        _ => ("the swept strip fails", &[][..]),
    };
    let points: Vec<Vec<DVec3>> = curves.iter().map(|c| c.points(mesh)).collect();
    let distance = |a: &[DVec3], b: &[DVec3]| {
        let pairs = a.iter().flat_map(|p| b.iter().map(move |q| p.distance_squared(*q)));
        pairs.fold(f64::INFINITY, f64::min).sqrt()
    };
    let mut told = vec![];
    for &place in places {
        let near = (0..curves.len()).filter(|&i| !points[i].is_empty());
        let Some(nearest) =
            near.min_by(|&i, &j| distance(&points[i], &[place]).total_cmp(&distance(&points[j], &[place])))
        else {
            break;
        };
        if by_field[nearest] {
            continue;
        }
        told.push((place, what));
        // The curve, its neighbours, and theirs.
        let mut stack = vec![nearest];
        while let Some(i) = stack.pop() {
            if std::mem::replace(&mut by_field[i], true) {
                continue;
            }
            let reach = NEIGHBOURS * params.radius;
            stack.extend((0..curves.len()).filter(|&j| !by_field[j] && distance(&points[i], &points[j]) < reach));
        }
    }
    if told.is_empty() {
        by_field.fill(true);
        let at = places.first().or_else(|| points.iter().flatten().next()).copied().unwrap_or(DVec3::ZERO);
        told.push((at, what));
    }
    told
}

/// The mesh as it is after some curves have been blended.
struct SoFar<'a> {
    input: &'a Connected<TriMesh>,
    all: &'a [BlendCurve],
    radius: f64,
    /// The present mesh; `None` while it is the input, or until [`SoFar::connect`].
    mesh: Option<Connected<TriMesh>>,
    blended: Blended,
    /// Length of the curves blended so far.
    length: f64,
}

impl<'a> SoFar<'a> {
    fn new(input: &'a Connected<TriMesh>, all: &'a [BlendCurve], radius: f64) -> Self {
        let mut blended = Blended::new(TriMesh::default(), Origins::default(), FaceId(0));
        blended.curves = all.iter().map(|c| CurveBlend::sharp(c.length(input), None)).collect();
        Self { input, all, radius, mesh: None, blended, length: 0.0 }
    }

    /// Makes ready for more curves to be blended.
    fn connect(&mut self) -> Result<(), Error> {
        if self.mesh.is_none() && !self.blended.mesh.faces.is_empty() {
            self.mesh = Some(Connected::new(self.blended.mesh.clone())?);
        }
        Ok(())
    }

    /// Some of the curves, as curves of the present mesh.
    fn curves(&self, chosen: impl Fn(usize) -> bool) -> Result<Vec<BlendCurve>, Error> {
        let chosen = (0..self.all.len()).filter(|&i| chosen(i)).map(|i| &self.all[i]);
        let Some(mesh) = &self.mesh else { return Ok(chosen.cloned().collect()) };
        let mut now = vec![None; self.input.vertex_count()];
        for (v, origin) in (0u32..).zip(self.blended.origins.vertices.as_slice()) {
            if let VertexOrigin::Input { vertex, .. } = origin {
                now[vertex.index()] = Some(VertexId(v));
            }
        }
        let moved = |curve: &BlendCurve| {
            let halfedge = |h| {
                let ends = [self.input.tail(h), self.input.head(h)];
                let [a, b] = [now[ends[0].index()]?, now[ends[1].index()]?];
                mesh.halfedge(a, b)
            };
            let halfedges: Option<Vec<_>> = curve.halfedges.iter().map(|&h| halfedge(h)).collect();
            let at = || curve.halfedges.first().map_or(DVec3::ZERO, |&h| self.input.position(self.input.tail(h)));
            let lost = || Trouble::at("a strip covers a neighbouring curve", vec![at()]).into_error(f64::NAN);
            Ok(BlendCurve { halfedges: halfedges.ok_or_else(lost)?, closed: curve.closed })
        };
        chosen.map(moved).collect()
    }

    /// Takes over what became of the present mesh, and the account of it.
    fn add(&mut self, made: Blended, chosen: impl Fn(usize) -> bool) {
        let own: f64 = (0..self.all.len()).filter(|&i| chosen(i)).map(|i| self.all[i].length(self.input)).sum();
        let so_far = &mut self.blended;
        for (k, i) in (0..self.all.len()).filter(|&i| chosen(i)).enumerate() {
            let by_field = || {
                let least = made.shrunk.iter().map(|s| s.1).fold(self.radius, f64::min);
                CurveBlend::made(Method::Field, least, so_far.curves[i].length, made.full_share)
            };
            so_far.curves[i] = made.curves.get(k).copied().unwrap_or_else(by_field);
        }
        let before = self.mesh.take();
        so_far.origins = match &before {
            Some(before) => {
                let stage = Stage { origins: &so_far.origins, faces: before };
                made.origins.compose(&[stage], &[self.input as &dyn Faces])
            }
            None => made.origins,
        };
        if before.is_none() {
            so_far.first_blend_face = made.first_blend_face;
        }
        so_far.strips += made.strips;
        so_far.fields += made.fields;
        so_far.corners += made.corners;
        so_far.residual = so_far.residual.max(made.residual);
        so_far.bridged += made.bridged;
        so_far.shrunk.extend(made.shrunk);
        so_far.run_outs.extend(made.run_outs);
        so_far.levels = so_far.levels.max(made.levels);
        so_far.full_share =
            (so_far.full_share * self.length + made.full_share * own) / (self.length + own).max(f64::MIN_POSITIVE);
        self.length += own;
        so_far.mesh = made.mesh;
    }
}
