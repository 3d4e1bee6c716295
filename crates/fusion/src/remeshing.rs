//! Smooths and remeshes a surface, or a region of it, and checks that it does not meet itself.

use crate::outcome::Outcome;
use crate::validity::Promise;
use crate::validity::as_written;
use crate::{Counts, Error, Region, Report, carry, extent};
use glam::DVec3;
use mesh_core::{
    Adjacency, Bounds, Connected, FaceId, FaceMap, FaceOrigin, Faces, Origins, Stage, TriMesh, VertexOrigin, Watch,
    centroid,
};
use mesh_io::{Format, Model};
use mesh_query::{TriBvh, closest_point_on_triangle};
pub use remesh::{Fairing, Fairness, Flow, Taubin};
use remesh::{Frozen, Projection, Remeshed, Sizing, curvature_flow, fair, taubin};
use tri_intersect::self_intersections_among;

/// What is smoothed and remeshed, and how.
#[derive(Clone, Debug)]
pub struct Params {
    /// What is done before remeshing, if anything. Triangles stay, vertices move.
    pub smooth: Option<Smooth>,
    /// Wanted edge length and rounds; without it the triangles stay.
    pub remesh: Option<remesh::Params>,
    /// Least angle in degrees between the normals of an edge's two faces that makes it a feature; 180 keeps none.
    pub feature_angle: f64,
    /// The faces to work on; all if there is none. All others keep their bits.
    pub region: Option<Region>,
    /// The format the result is meant for, whose rounding it must survive.
    pub format: Format,
}

/// How vertices are moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Smooth {
    /// Towards their neighbours and back: short waves vanish, the volume stays.
    Taubin(Taubin),
    /// By the mean curvature: the surface shrinks as it smooths.
    Flow(Flow),
    /// To the surface that continues what is held most smoothly, whatever it was.
    Fair(Fairing),
}

impl Params {
    /// Five rounds over the whole surface, features by the usual crease angle of 40 degrees.
    pub fn new(edge_length: f64, format: Format) -> Self {
        Self { remesh: Some(remesh::Params::new(edge_length)), ..Self::keeping_triangles(format) }
    }

    /// Nothing yet but features by the usual crease angle of 40 degrees.
    pub fn keeping_triangles(format: Format) -> Self {
        Self { smooth: None, remesh: None, feature_angle: 40.0, region: None, format }
    }

    /// With another number of rounds.
    #[must_use]
    pub fn with_rounds(mut self, rounds: usize) -> Self {
        if let Some(remesh) = &mut self.remesh {
            remesh.rounds = rounds;
        }
        self
    }

    /// With features by another dihedral angle, in degrees; 180 keeps none.
    #[must_use]
    pub fn with_features(mut self, angle: f64) -> Self {
        self.feature_angle = angle;
        self
    }

    /// Smoothed first, if a way is given.
    #[must_use]
    pub fn smoothed(mut self, smooth: Option<Smooth>) -> Self {
        self.smooth = smooth;
        self
    }

    /// On some faces only, if a region is given.
    #[must_use]
    pub fn within(mut self, region: Option<Region>) -> Self {
        self.region = region;
        self
    }
}

/// How often places where the result meets itself are left as they were and the rest remeshed again.
const RETRIES: i32 = 10;

/// Smooths and remeshes a surface, closed or open. Boundaries and what lies outside the region stay bit for bit.
///
/// Where coarse triangles would cut through a nearby sheet of the surface, the input is left as it is, with a warning.
///
/// # Errors
/// [`Error`].
pub fn remesh(part: &Model, params: &Params, watch: &Watch) -> Result<Outcome, Error> {
    if part.mesh.faces.is_empty() {
        return Err(Error::Region("the mesh has no face, so there is nothing to remesh or smooth".into()));
    }
    extent::check(std::slice::from_ref(part))?;
    let mut report = Report::new("remesh", vec![Counts::of("", &part.mesh)]);
    let mut mesh = report
        .time("connect", || Connected::new(part.mesh.clone()))
        .map_err(|source| Error::NotManifold { part: 0, source })?;
    let mut frozen = Frozen::default();
    if let Some(region) = &params.region {
        let inside = region.select(part, &mesh)?;
        frozen.faces = inside.as_slice().iter().map(|&f| !f).collect::<Vec<_>>().into();
    }
    let mut origins = Origins::identity(0, mesh.vertex_count(), mesh.face_count());
    let mut base = part.clone();
    if let Some(smooth) = &params.smooth {
        base.mesh.positions = report.time("smooth", || moved(&mesh, &frozen, smooth, params.feature_angle, watch))?;
        base.normals = None;
        origins = origins_of_moved(&part.mesh, &base.mesh);
        mesh = Connected::new(base.mesh.clone()).map_err(|source| Error::NotManifold { part: 0, source })?;
    }
    if let Some(how) = &params.remesh {
        let how = remesh::Params { feature_angle: params.feature_angle, ..how.clone() };
        let even = evened(&mesh, frozen, &how, &mut report, watch)?;
        measure(&even.mesh, &mut report);
        report.figures.insert("edge_length".into(), how.edge_length);
        let model = report.time("attributes", || carry(std::slice::from_ref(&base), even.mesh, &even.origins));
        origins = even.origins.compose(&[Stage { origins: &origins, faces: &base.mesh }], &[&part.mesh]);
        base = model;
    } else {
        measure(&base.mesh, &mut report);
    }
    report.describe(&base.mesh, &origins);
    let found =
        report.time("validate", || as_written(&base, &origins, &[], params.format, Promise::Manifold, watch))?;
    report.checked(found);
    Ok(Outcome { model: base, origins, report })
}

/// Where the vertices go.
fn moved(
    mesh: &Connected<TriMesh>,
    frozen: &Frozen,
    smooth: &Smooth,
    angle: f64,
    watch: &Watch,
) -> Result<Vec<DVec3>, Error> {
    let held = if angle < 180.0 { frozen.clone().with_features(mesh, angle) } else { frozen.clone() };
    Ok(match smooth {
        Smooth::Taubin(params) => taubin(mesh, &held, params, watch)?,
        Smooth::Flow(flow) => curvature_flow(mesh, &held, flow, watch)?,
        // What is faired is replaced: its own creases are none to keep.
        Smooth::Fair(fairing) => fair(mesh, frozen, fairing, watch)?,
    })
}

/// Vertices that moved, and faces at them, are new.
fn origins_of_moved(before: &TriMesh, after: &TriMesh) -> Origins {
    const STAGE: &str = "smooth";
    let mut origins = Origins::identity(0, before.positions.len(), before.faces.len());
    let still: Vec<bool> = before.positions.iter().zip(&after.positions).map(|(p, q)| p == q).collect();
    for (v, _) in origins.vertices.as_mut_slice().iter_mut().zip(&still).filter(|v| !v.1) {
        *v = VertexOrigin::New { stage: STAGE };
    }
    for (f, corners) in origins.faces.as_mut_slice().iter_mut().zip(&before.faces) {
        if !corners.iter().all(|v| still[v.index()]) {
            *f = FaceOrigin::New { stage: STAGE };
        }
    }
    origins
}

/// Remeshes, and again with more of the input left as it is while the result meets itself.
fn evened(
    mesh: &Connected<TriMesh>,
    mut frozen: Frozen,
    how: &remesh::Params,
    report: &mut Report,
    watch: &Watch,
) -> Result<Remeshed, Error> {
    let once = |frozen: &Frozen| remesh::remesh(mesh, frozen, Sizing::Uniform, how, Projection::Input, watch);
    let mut even = report.time("remesh", || once(&frozen))?;
    for retry in 0..RETRIES {
        let places = report.time("check", || crossings(&even, watch))?;
        let Some(&first) = places.first() else { break };
        report.warnings.push(format!(
            "triangles of edge length {} would cut through the surface near {first} and {} other places: it is left as it was there",
            how.edge_length,
            places.len() - 1
        ));
        freeze_near(mesh, &places, how.edge_length * 1.3f64.powi(retry), &mut frozen);
        even = report.time("remesh", || once(&frozen))?;
    }
    Ok(even)
}

/// Where changed faces meet others.
fn crossings(even: &Remeshed, watch: &Watch) -> Result<Vec<DVec3>, Error> {
    let faces = even.mesh.face_ids().zip(even.origins.faces.as_slice());
    let changed: Vec<FaceId> = faces.filter(|(_, o)| !matches!(o, FaceOrigin::Input { .. })).map(|(f, _)| f).collect();
    match self_intersections_among(&even.mesh, &changed, watch) {
        Ok(pairs) => Ok(pairs.iter().flatten().map(|&f| centroid(even.mesh.triangle(f))).collect()),
        Err(tri_intersect::Error::Cancelled(c)) => Err(c.into()),
        Err(source) => Err(Error::Boolean { step: None, source }),
    }
}

/// Freezes the faces of the input within two `reach` of each place, farther where the place itself is off the input.
fn freeze_near(mesh: &Connected<TriMesh>, places: &[DVec3], reach: f64, frozen: &mut Frozen) {
    if frozen.faces.is_empty() {
        frozen.faces = FaceMap::filled(mesh.face_count(), false);
    }
    let Ok(tree) = TriBvh::build(mesh) else { return };
    let mut near = vec![];
    for &place in places {
        let reach = 2.0 * reach + tree.closest_point(mesh, place).map_or(0.0, |c| c.distance);
        tree.faces_in_box(mesh, &Bounds { min: place, max: place }.inflated(reach), &mut near);
        for &f in &near {
            let (q, _) = closest_point_on_triangle(place, mesh.mesh().triangle(f));
            frozen.faces[f] |= place.distance(q) <= reach;
        }
    }
}

/// Notes how even the triangles are.
fn measure(mesh: &TriMesh, report: &mut Report) {
    let (mut to_side, mut to_radius, mut count) = (0.0, 0.0, 0.0);
    for f in mesh.face_ids() {
        let [a, b, c] = mesh.triangle(f);
        let sides = [a.distance(b), b.distance(c), c.distance(a)];
        let (twice_area, round) = ((b - a).cross(c - a).length(), sides.iter().sum::<f64>());
        let inradius = twice_area / round;
        let circumradius = sides.iter().product::<f64>() / (2.0 * twice_area);
        let (side, radius) = (inradius / sides.iter().copied().fold(0.0, f64::max), inradius / circumradius);
        to_side += if side.is_finite() { 2.0 * 3f64.sqrt() * side } else { 0.0 };
        to_radius += if radius.is_finite() { 2.0 * radius } else { 0.0 };
        count += 1.0;
    }
    if count > 0.0 {
        report.figures.insert("mean_quality".into(), to_side / count);
        report.figures.insert("mean_radius_ratio".into(), to_radius / count);
    }
    if let Ok(mesh) = Connected::new(mesh) {
        let inner = |v: &_| mesh.outgoing(*v).is_some_and(|h| mesh.twin(h).is_some());
        let valences: Vec<usize> = mesh.vertex_ids().filter(inner).map(|v| mesh.ring(v).count()).collect();
        if !valences.is_empty() {
            let six = valences.iter().filter(|&&n| n == 6).count() as f64;
            report.figures.insert("valence_six_share".into(), six / valences.len() as f64);
        }
        if let Some(lengths) = mesh_core::edge_lengths(&mesh) {
            report.figures.insert("mean_edge".into(), lengths.mean);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::shapes;

    fn params(edge_length: f64) -> Params {
        Params::new(edge_length, Format::Obj)
    }

    #[test]
    fn an_open_tube_stays_open_and_valid() {
        let tube = Model::from(shapes::open_cylinder(1.0, 3.0, 40, 12));
        let outcome = remesh(&tube, &params(0.15), &Watch::default()).unwrap();
        assert_eq!(outcome.report.validity.closed, Some(false));
        assert_eq!(outcome.report.validity.self_intersections, Some(0));
        assert!(outcome.report.figures["mean_quality"] > 0.9);
        assert!((outcome.report.figures["mean_edge"] - 0.15).abs() < 0.02);
    }

    /// Two balls so near that coarse triangles would cut one with the other.
    #[test]
    fn sheets_nearer_than_the_chords_are_deep_are_left_alone() {
        let mut mesh = shapes::icosphere(1.0, 4);
        let mut inner = shapes::icosphere(0.97, 4);
        inner.faces.iter_mut().for_each(|c| c.swap(1, 2));
        mesh.append(&inner);
        let outcome = remesh(&Model::from(mesh), &params(0.6), &Watch::default()).unwrap();
        assert_eq!(outcome.report.validity.self_intersections, Some(0));
    }

    #[test]
    fn outside_the_region_nothing_changes() {
        let ball = Model::from(shapes::icosphere(1.0, 4));
        let region = Some(Region::Near { center: DVec3::Z, radius: 0.6 });
        let outcome = remesh(&ball, &Params { region, ..params(0.03) }, &Watch::default()).unwrap();
        let low = |p: &DVec3| p.z < 0.7;
        let kept = outcome.model.mesh.positions.iter().filter(|p| low(p));
        assert!(kept.eq(ball.mesh.positions.iter().filter(|p| low(p))));
        assert!(outcome.report.output.faces > ball.mesh.faces.len());
    }

    /// A noisy ball with a group: smoothing keeps triangles and groups, and what is outside the region.
    #[test]
    fn smoothing_keeps_triangles_and_what_is_outside() {
        let mut ball = Model::from(shapes::icosphere(1.0, 4));
        for (i, p) in ball.mesh.positions.iter_mut().enumerate() {
            *p *= 1.0 + 1e-3 * (i * i % 7) as f64;
        }
        let of_face: Vec<u32> = (0..ball.mesh.faces.len() as u32).map(|f| f % 2).collect();
        ball.groups = Some(mesh_io::Groups { of_face: of_face.into(), names: ["a", "b"].map(String::from).into() });
        let region = Some(Region::Near { center: DVec3::Z, radius: 0.6 });
        for smooth in [
            Smooth::Taubin(Taubin::default()),
            Smooth::Flow(Flow::halving(0.4)),
            Smooth::Fair(Fairing { fairness: Fairness::Triharmonic, rounds: 1 }),
        ] {
            let params = Params::keeping_triangles(Format::Obj).smoothed(Some(smooth)).within(region.clone());
            let outcome = remesh(&ball, &params, &Watch::default()).unwrap();
            assert_eq!((&outcome.model.mesh.faces, &outcome.model.groups), (&ball.mesh.faces, &ball.groups));
            let points = ball.mesh.positions.iter().zip(&outcome.model.mesh.positions);
            let kept = points.filter(|(p, q)| p == q).count();
            assert!(kept == outcome.report.kept_vertices && kept > 1000 && kept < ball.mesh.positions.len());
            assert!(outcome.report.changed_faces > 100 && outcome.report.validity.closed == Some(true));
            // And with remeshing on top: what is outside still has its bits.
            let both = Params { remesh: Some(remesh::Params::new(0.1)), ..params };
            let outcome = remesh(&ball, &both, &Watch::default()).unwrap();
            let low = |p: &&DVec3| p.z < 0.7;
            assert!(outcome.model.mesh.positions.iter().filter(low).eq(ball.mesh.positions.iter().filter(low)));
        }
    }
}
