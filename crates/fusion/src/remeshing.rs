//! Remeshes a surface, or a region of it, and checks that it does not meet itself.

use crate::outcome::{Outcome, Promise, finish_as};
use crate::{Counts, Error, Region, Report};
use glam::DVec3;
use mesh_core::{Adjacency, Connected, FaceId, FaceMap, FaceOrigin, Faces, TriMesh, Watch};
use mesh_io::{Format, Model};
use remesh::{Frozen, Projection, Remeshed, Sizing};
use tri_intersect::self_intersections_among;

/// What is remeshed, and how.
#[derive(Clone, Debug)]
pub struct Params {
    /// Wanted edge length, rounds, features.
    pub remesh: remesh::Params,
    /// The faces to remesh; all if there is none. All others keep their bits.
    pub region: Option<Region>,
    /// The format the result is meant for, whose rounding it must survive.
    pub format: Format,
}

impl Params {
    /// Five rounds over the whole surface, features by the usual crease angle of 40 degrees.
    pub fn new(edge_length: f64, format: Format) -> Self {
        Self { remesh: remesh::Params::new(edge_length), region: None, format }
    }

    /// With another number of rounds.
    #[must_use]
    pub fn with_rounds(mut self, rounds: usize) -> Self {
        self.remesh.rounds = rounds;
        self
    }

    /// With features by another dihedral angle, in degrees; 180 keeps none.
    #[must_use]
    pub fn with_features(mut self, angle: f64) -> Self {
        self.remesh.feature_angle = angle;
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

/// Remeshes a surface, closed or open. Boundaries and what lies outside the region stay bit for bit.
///
/// Where coarse triangles would cut through a nearby sheet of the surface, the input is left as it is, with a warning.
///
/// # Errors
/// [`Error`].
pub fn remesh(part: &Model, params: &Params, watch: &Watch) -> Result<Outcome, Error> {
    let mut report = Report::new("remesh", vec![Counts::of("", &part.mesh)]);
    let mesh = report
        .time("connect", || Connected::new(part.mesh.clone()))
        .map_err(|source| Error::NotManifold { part: 0, source })?;
    let mut frozen = Frozen::default();
    if let Some(region) = &params.region {
        let inside = region.select(part, &mesh)?;
        frozen.faces = inside.as_slice().iter().map(|&f| !f).collect::<Vec<_>>().into();
    }
    let mut even = report.time("remesh", || once(&mesh, &frozen, params, watch))?;
    for retry in 0..RETRIES {
        let places = report.time("check", || crossings(&even, watch))?;
        let Some(&first) = places.first() else { break };
        report.warnings.push(format!(
            "triangles of edge length {} would cut through the surface near {first} and {} other places: it is left as it was there",
            params.remesh.edge_length,
            places.len() - 1
        ));
        freeze_near(&mesh, &places, params.remesh.edge_length * 1.3f64.powi(retry), &mut frozen);
        even = report.time("remesh", || once(&mesh, &frozen, params, watch))?;
    }
    measure(&even.mesh, &mut report);
    report.figures.insert("edge_length".into(), params.remesh.edge_length);
    let parts = std::slice::from_ref(part);
    finish_as(Promise::Manifold, parts, even.mesh, even.origins, params.format, report, watch)
}

fn once(mesh: &Connected<TriMesh>, frozen: &Frozen, params: &Params, watch: &Watch) -> Result<Remeshed, Error> {
    Ok(remesh::remesh(mesh, frozen, Sizing::Uniform, &params.remesh, Projection::Input, watch)?)
}

/// Where changed faces meet others.
fn crossings(even: &Remeshed, watch: &Watch) -> Result<Vec<DVec3>, Error> {
    let faces = even.mesh.face_ids().zip(even.origins.faces.as_slice());
    let changed: Vec<FaceId> = faces.filter(|(_, o)| !matches!(o, FaceOrigin::Input { .. })).map(|(f, _)| f).collect();
    match self_intersections_among(&even.mesh, &changed, watch) {
        Ok(pairs) => Ok(pairs.iter().flatten().map(|&f| even.mesh.triangle(f).iter().sum::<DVec3>() / 3.0).collect()),
        Err(tri_intersect::Error::Cancelled(c)) => Err(c.into()),
        Err(source) => Err(Error::Boolean { step: None, source }),
    }
}

fn freeze_near(mesh: &Connected<TriMesh>, places: &[DVec3], reach: f64, frozen: &mut Frozen) {
    if frozen.faces.is_empty() {
        frozen.faces = FaceMap::filled(mesh.face_count(), false);
    }
    let tree = mesh_query::TriBvh::build(mesh).ok();
    for &place in places {
        let near = tree.as_ref().and_then(|t| t.closest_point(mesh, place)).map_or(0.0, |c| c.distance);
        for f in mesh.face_ids() {
            let corners = mesh.mesh().triangle(f);
            let middle = corners.iter().sum::<DVec3>() / 3.0;
            let size = corners.iter().map(|p| p.distance(middle)).fold(0.0, f64::max);
            if middle.distance(place) <= near + 2.0 * reach + size {
                frozen.faces[f] = true;
            }
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
        let inner = shapes::icosphere(0.97, 4);
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(&inner.positions);
        mesh.faces.extend(inner.faces.iter().map(|&[a, b, c]| [a, c, b].map(|v| mesh_core::VertexId(v.0 + first))));
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
}
