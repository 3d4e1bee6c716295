//! Joints held against the curves that were drawn for them.

use fusion::compose::{Crease, Error, Params, Silhouette, compose};
use fusion::mesh_core::{Connected, TriMesh, Watch, boundary_loops, shapes, topology};
use glam::{DQuat, DVec3};
use mesh_io::{Format, Model};

/// A tube about the z axis through the origin, closed by nothing.
fn tube(radius: f64, turn: DQuat, at: DVec3) -> Model {
    let mut mesh = shapes::open_cylinder(radius, 2.0, 40, 12);
    let middle = mesh.positions.iter().sum::<DVec3>() / mesh.positions.len() as f64;
    mesh.positions.iter_mut().for_each(|p| *p = turn * (*p - middle) + at);
    Model::from(mesh)
}

/// The loop of a model whose middle is nearest to a point.
fn near(model: &Model, p: DVec3) -> usize {
    let mesh = Connected::new(&model.mesh).unwrap();
    let middle = |walk: &Vec<fusion::mesh_core::HalfedgeId>| {
        walk.iter().map(|h| model.mesh.triangle(h.face())[h.corner()]).sum::<DVec3>() / walk.len() as f64
    };
    let far: Vec<f64> = boundary_loops(&mesh).iter().map(|w| middle(w).distance(p)).collect();
    (0..far.len()).min_by(|&a, &b| far[a].total_cmp(&far[b])).unwrap()
}

fn joined(parts: &[Model], at: &[DVec3], silhouettes: Vec<Silhouette>) -> Result<fusion::Outcome, fusion::Error> {
    let loops = parts.iter().zip(at).enumerate().map(|(i, (part, &p))| (i, near(part, p))).collect();
    let params = Params { loops: Some(loops), silhouettes, ..Params::new(Format::Ply) };
    compose(parts, &params, &Watch::default())
}

fn genus(mesh: &TriMesh) -> i64 {
    topology(&Connected::new(mesh).unwrap()).genus()
}

/// How far, seen along `view`, each point of a curve is from the mesh's contour: edges between a face that looks at the viewer and one that
/// looks away.
fn seen_off(mesh: &TriMesh, view: DVec3, curve: &[DVec3]) -> f64 {
    let connected = Connected::new(mesh).unwrap();
    let flat = |p: DVec3| p - p.dot(view) * view;
    let facing = |f| fusion::mesh_core::face_normal(mesh, f).dot(view) > 0.0;
    let mut contour = vec![];
    for h in (0..3 * mesh.faces.len() as u32).map(fusion::mesh_core::HalfedgeId) {
        use fusion::mesh_core::{Adjacency, Faces};
        if let Some(twin) = connected.twin(h)
            && facing(h.face())
            && !facing(twin.face())
        {
            contour.push([connected.tail(h), connected.head(h)].map(|v| flat(mesh.positions[v.index()])));
        }
    }
    let off = |p: DVec3| {
        let to = |[a, b]: &[DVec3; 2]| {
            let t = ((p - *a).dot(*b - *a) / a.distance_squared(*b)).clamp(0.0, 1.0);
            p.distance(a.lerp(*b, t))
        };
        contour.iter().map(to).fold(f64::INFINITY, f64::min)
    };
    curve.iter().map(|&p| off(flat(p))).fold(0.0, f64::max)
}

/// Figure 8: a bend of 60 to 180 degrees about an axis two radii away, led by its outer and its inner silhouette.
#[test]
fn bends_follow_their_silhouettes() {
    for degrees in [60.0f64, 90.0, 120.0, 150.0, 180.0] {
        let angle = degrees.to_radians();
        let turn = DQuat::from_rotation_y(angle);
        let axis = DVec3::new(2.5, 0.0, 0.0);
        let about = |p: DVec3| axis + turn * (p - axis);
        // The second tube goes on where the first was turned to.
        let (low, high) = (tube(1.0, DQuat::IDENTITY, DVec3::NEG_Z), tube(1.0, turn, about(DVec3::Z)));
        let arc = |radius: f64| -> Vec<DVec3> {
            (1..20)
                .map(|i| axis + DQuat::from_rotation_y(angle * f64::from(i) / 20.0) * DVec3::new(-radius, 0.0, 0.0))
                .collect()
        };
        let silhouettes =
            [3.5, 1.5].map(|r| Silhouette { view: DVec3::NEG_Y, strokes: vec![arc(r)], ..Silhouette::default() });
        let made = joined(&[low, high], &[DVec3::ZERO, about(DVec3::ZERO)], silhouettes.to_vec()).unwrap();
        assert!(made.report.residuals["silhouette"] < 1e-8, "{:?}", made.report.residuals);
        assert!(made.report.residuals["silhouette_normal"] < 1e-6, "{:?}", made.report.residuals);
        let mesh = &made.model.mesh;
        // A picture of 1024 pixels shows at least the box around everything.
        let pixel = fusion::mesh_core::bounds(mesh).diagonal() / 1024.0;
        let off = [3.5, 1.5].map(|r| seen_off(mesh, DVec3::Y, &arc(r)) / pixel);
        assert!(off.iter().all(|&o| o < 1.0), "{degrees}: {off:?} pixels");
    }
}

/// Figure 9: two tubes farther and farther apart, joined with a bulging stroke on either side.
#[test]
fn strokes_lead_across_growing_distances() {
    for distance in [4.0, 6.0, 8.0, 10.0, 12.0] {
        let half = 0.5 * distance;
        let parts = [-1.0, 1.0].map(|s| tube(1.0, DQuat::IDENTITY, DVec3::Z * (s * (half + 1.0))));
        // A bulge that leaves both rims along the tubes.
        let stroke = |side: f64| -> Vec<DVec3> {
            let bulge = |t: f64| 1.0 + 0.8 * distance * (t * (1.0 - t)).powi(2);
            let at = |t: f64| DVec3::new(side * bulge(t), 0.0, distance * (t - 0.5));
            (1..40).map(|i| at(f64::from(i) / 40.0)).collect()
        };
        let silhouettes =
            [1.0, -1.0].map(|s| Silhouette { view: DVec3::NEG_Y, strokes: vec![stroke(s)], ..Silhouette::default() });
        let made = joined(&parts, &[DVec3::Z * -half, DVec3::Z * half], silhouettes.to_vec()).unwrap();
        let residual = |name: &str| made.report.residuals[name];
        assert!(residual("silhouette") < 1e-8, "{distance}: {:?}", made.report.residuals);
        assert!(residual("silhouette_normal") < 1e-6, "{distance}: {:?}", made.report.residuals);
        let mesh = &made.model.mesh;
        assert_eq!(topology(&Connected::new(mesh).unwrap()).components, 1);
        let pixel = fusion::mesh_core::bounds(mesh).diagonal() / 1024.0;
        let off = [1.0, -1.0].map(|s| seen_off(mesh, DVec3::Y, &stroke(s)) / pixel);
        println!(
            "{distance}: {off:.2?} pixels, residual {:.1e}, normal {:.1e}",
            residual("silhouette"),
            residual("silhouette_normal")
        );
        assert!(off.iter().all(|&o| o < 1.0), "{distance}: {off:?} pixels");
    }
}

#[test]
fn a_hole_is_outlined() {
    let (low, high) =
        (tube(1.0, DQuat::IDENTITY, DVec3::new(0.0, 0.0, -3.0)), tube(1.0, DQuat::IDENTITY, DVec3::new(0.0, 0.0, 3.0)));
    let at = [DVec3::new(0.0, 0.0, -2.0), DVec3::new(0.0, 0.0, 2.0)];
    let parts = [low, high];
    let plain = joined(&parts, &at, vec![]).unwrap();
    let ring = |r: f64| {
        (0..12)
            .map(|i| f64::from(i) * std::f64::consts::TAU / 12.0)
            .map(|a| DVec3::new(r * a.cos(), 0.0, r * a.sin()))
            .collect::<Vec<_>>()
    };
    let outline = Silhouette { view: DVec3::Y, strokes: vec![ring(0.5)], hole: Some(true), ..Silhouette::default() };
    let side = |s: f64| Silhouette {
        view: DVec3::Y,
        strokes: vec![vec![DVec3::new(s, 0.0, -1.9), DVec3::new(1.6 * s, 0.0, 0.0), DVec3::new(s, 0.0, 1.9)]],
        ..Silhouette::default()
    };
    let with = joined(&parts, &at, vec![outline.clone(), side(1.0), side(-1.0)]).unwrap();
    assert_eq!(genus(&with.model.mesh), genus(&plain.model.mesh) + 1);
    // The outline alone does it, too, and the field keeps to it.
    let alone = joined(&parts, &at, vec![outline]).unwrap();
    assert_eq!(genus(&alone.model.mesh), genus(&plain.model.mesh) + 1);
    assert!(alone.report.residuals["silhouette"] < 1e-8 && alone.report.residuals["silhouette_normal"] < 1e-6);
}

#[test]
fn strokes_that_lead_nowhere_are_refused() {
    let parts =
        [tube(1.0, DQuat::IDENTITY, DVec3::new(0.0, 0.0, -2.0)), tube(1.0, DQuat::IDENTITY, DVec3::new(0.0, 0.0, 2.0))];
    let at = [DVec3::new(0.0, 0.0, -1.0), DVec3::new(0.0, 0.0, 1.0)];
    let point = vec![DVec3::X, DVec3::X + DVec3::Z];
    let nan = vec![DVec3::NAN, DVec3::Z, DVec3::X];
    for (view, stroke, hole) in [
        (DVec3::Z, point.clone(), None),
        (DVec3::ZERO, point.clone(), None),
        (DVec3::Y, nan, None),
        (DVec3::Y, point, Some(true)),
    ] {
        let stroke = Silhouette { view, strokes: vec![stroke], hole, ..Silhouette::default() };
        let error = joined(&parts, &at, vec![stroke]).unwrap_err();
        assert!(matches!(error, fusion::Error::Compose(Error::Silhouette { index: 0, .. })), "{error}");
    }
}

/// The angle at the weld is the crease, inward for positive ones and outward for negative, at each opening its own.
#[test]
fn creases_turn_the_surface_at_the_opening() {
    use fusion::mesh_core::{Adjacency, FaceOrigin, Faces, HalfedgeId};
    let parts =
        [tube(1.0, DQuat::IDENTITY, DVec3::new(0.0, 0.0, -2.0)), tube(1.0, DQuat::IDENTITY, DVec3::new(0.0, 0.0, 2.0))];
    let at = [DVec3::new(0.0, 0.0, -1.0), DVec3::new(0.0, 0.0, 1.0)];
    let loops: Vec<_> = parts.iter().zip(at).enumerate().map(|(i, (part, p))| (i, near(part, p))).collect();
    let wanted = [30.0, -20.0];
    let creases = loops.iter().zip(wanted).map(|(&(part, index), angle)| Crease { part, index, angle }).collect();
    let params = Params { loops: Some(loops), creases, ..Params::new(Format::Ply) };
    let made = compose(&parts, &params, &Watch::default()).unwrap();
    let mesh = Connected::new(&made.model.mesh).unwrap();
    let new = |h: HalfedgeId| matches!(made.origins.faces[h.face()], FaceOrigin::New { .. });
    for (part, wanted) in wanted.into_iter().enumerate() {
        let mut angles = vec![];
        for h in mesh.halfedge_ids() {
            let Some(twin) = mesh.twin(h).filter(|&t| new(t)) else { continue };
            if matches!(made.origins.faces[h.face()], FaceOrigin::Input { part: p, .. } if p == part as u32) {
                // Convex edges turn inward.
                let normals = [h, twin].map(|h| fusion::mesh_core::face_normal(&mesh, h.face()));
                let along =
                    made.model.mesh.positions[mesh.head(h).index()] - made.model.mesh.positions[mesh.tail(h).index()];
                let sine = normals[0].cross(normals[1]).dot(along.normalize());
                angles.push(sine.atan2(normals[0].dot(normals[1])).to_degrees());
            }
        }
        let mean = angles.iter().sum::<f64>() / angles.len() as f64;
        println!("{wanted}: {mean} of {}", angles.len());
        assert!((mean - wanted).abs() < 4.0, "{wanted}: {mean}");
    }
}

/// Tilted tubes that nearly touch are trimmed until they are as far apart as asked; without that they are joined as they are, or not at all.
#[test]
fn openings_too_near_are_moved_back() {
    let tilt = DQuat::from_rotation_y(0.5);
    let parts =
        [tube(1.0, DQuat::IDENTITY, DVec3::new(0.0, 0.0, -1.55)), tube(1.0, tilt, tilt * DVec3::new(0.0, 0.0, 1.05))];
    let at = [DVec3::new(0.0, 0.0, -0.5), DVec3::ZERO];
    let loops: Vec<_> = parts.iter().zip(at).enumerate().map(|(i, (part, p))| (i, near(part, p))).collect();
    let params = Params { loops: Some(loops), adjust: Some(0.6), ..Params::new(Format::Ply) };
    let made = compose(&parts, &params, &Watch::default()).unwrap();
    assert!(made.report.figures["trimmed"] >= 2.0);
    let inputs: Vec<&TriMesh> = parts.iter().map(|p| &p.mesh).collect();
    // Every vertex is the part's or on the part, or new; and the parts' vertices beside the joint are apart.
    let mut kept = [vec![], vec![]];
    for (p, origin) in made.model.mesh.positions.iter().zip(made.origins.vertices.as_slice()) {
        use fusion::mesh_core::VertexOrigin as O;
        if let O::Input { part, .. } | O::Edge { part, .. } | O::Face { part, .. } = *origin {
            assert!(origin.position(&inputs).is_some_and(|q| q.distance(*p) < 1e-12), "{origin:?}");
            kept[part as usize].push(*p);
        }
    }
    let apart = kept[0].iter().flat_map(|p| kept[1].iter().map(|q| p.distance(*q))).fold(f64::INFINITY, f64::min);
    assert!(apart > 0.55, "{apart}");
    assert_eq!(genus(&made.model.mesh), 0);
}
