//! Geometry detail: a smooth region gets the detail of others (\[Lin2008\] §4.2).

use crate::diagnostic::Code;
use crate::outcome::Outcome;
use crate::validity::{Promise, as_written, crossings_of};
use crate::{Counts, Error, Region, Report, extent};
use detail_transfer::{Exemplar, Transferred, roughness, transfer};
use glam::DVec3;
use mesh_core::{
    Adjacency, Connected, FaceMap, FaceOrigin, Faces, HalfedgeId, Origins, Stage, TriMesh, VertexOrigin, Watch,
};
use mesh_io::{Format, Model};

/// What gets detail, and from where.
#[derive(Clone, Debug)]
pub struct Params {
    /// The region of the first input that gets detail.
    pub target: Region,
    /// Inputs, counted from 0, and their regions to take detail from.
    pub sources: Vec<(usize, Region)>,
    /// Wavelength, fans, intensity, curve.
    pub transfer: detail_transfer::Params,
    /// The format the result is meant for, whose rounding it must survive.
    pub format: Format,
}

const STAGE: &str = "detail";

/// Replaces the detail of a region of the first input by that of the sources. Connectivity, all other vertices and all attributes but normals
/// stay.
///
/// # Errors
/// [`crate::Error`]: inputs that are not manifold, regions that are not there, detail that cannot be carried, a result that meets itself.
pub fn detail(parts: &[Model], params: &Params, watch: &Watch) -> Result<Outcome, Error> {
    extent::check(parts)?;
    let mut report = Report::new(STAGE, parts.iter().map(|m| Counts::of("", &m.mesh)).collect());
    let meshes = report.time("connect", || connect(parts))?;
    if parts.is_empty() {
        return Err(Error::Region("there is no input 0".into()));
    }
    let target = params.target.select(&parts[0], &meshes[0])?;
    let regions = params.sources.iter().map(|(i, region)| match (parts.get(*i), meshes.get(*i)) {
        (Some(model), Some(mesh)) => Ok((mesh, region.select(model, mesh)?)),
        _ => Err(Error::Region(format!("there is no input {i}"))),
    });
    let mut regions = regions.collect::<Result<Vec<_>, _>>()?;
    for (mesh, inside) in &mut regions {
        if std::ptr::eq(*mesh, &raw const meshes[0]) {
            // What is to be replaced is no source.
            for f in mesh.face_ids().filter(|&f| target[f]) {
                inside[f] = false;
            }
        }
    }
    let exemplars: Vec<Exemplar<'_>> = regions.iter().map(|(mesh, inside)| Exemplar { mesh, inside }).collect();
    let made = report.time("transfer", || transfer(&meshes[0], &target, &exemplars, &params.transfer, watch))?;
    let rough = report.time("measure", || account(&meshes[0], &target, &exemplars, &made))?;
    report.figures.extend(rough);
    report.warnings.extend(made.warnings.iter().map(ToString::to_string));
    let origins = origins(&meshes[0], &made);
    report.describe(&made.mesh, &origins);
    let model = dress(&parts[0], made);
    let found =
        report.time("validate", || as_written(&model, &origins, &[], params.format, Promise::Manifold, watch))?;
    report.checked(found);
    Ok(Outcome { model, origins, report })
}

/// Gives detail to what a composition has made; `parts` are its inputs, by which `params.sources` counts. The target is all that is new.
///
/// # Errors
/// As [`detail`].
pub fn onto(composed: Outcome, parts: &[Model], params: &Params, watch: &Watch) -> Result<Outcome, Error> {
    let made = composed.model.mesh.face_ids().zip(composed.origins.faces.as_slice());
    let target = made.filter(|(_, o)| matches!(o, FaceOrigin::New { .. })).map(|(f, _)| f).collect();
    let sources = params.sources.iter().map(|(i, region)| (i + 1, region.clone())).collect();
    let params = Params { target: Region::Faces(target), sources, ..params.clone() };
    let Outcome { model, origins, report: mut first } = composed;
    let mut all = vec![model];
    all.extend_from_slice(parts);
    let mut out = detail(&all, &params, watch)?;
    let inputs: Vec<&dyn Faces> = parts.iter().map(|m| &m.mesh as &dyn Faces).collect();
    out.origins = out.origins.compose(&[Stage { origins: &origins, faces: &all[0].mesh }], &inputs);
    first.validity.manifold = out.report.validity.manifold;
    first.validity.self_intersections = out.report.validity.self_intersections;
    first.inherited = crossings_of(&out.model.mesh, &out.origins, watch)?;
    first.figures.extend(out.report.figures);
    // What the parts brought along is told by the composition.
    let told = |w: &String| out.report.diagnostics.iter().any(|d| d.code == Code::Inherited && d.message == *w);
    first.warnings.extend(out.report.warnings.iter().filter(|w| !told(w)).cloned());
    for mut stage in out.report.stages {
        stage.name = format!("{STAGE}: {}", stage.name);
        first.stages.push(stage);
    }
    first.describe(&out.model.mesh, &out.origins);
    out.report = first;
    Ok(out)
}

fn connect(parts: &[Model]) -> Result<Vec<Connected<TriMesh>>, Error> {
    let connect = |(part, model): (usize, &Model)| {
        Connected::new(model.mesh.clone()).map_err(|source| Error::NotManifold { part, source })
    };
    parts.iter().enumerate().map(connect).collect()
}

/// The figures of the report: what was used, and how rough source and target are, before and after.
fn account(
    mesh: &Connected<TriMesh>,
    target: &FaceMap<bool>,
    exemplars: &[Exemplar<'_>],
    made: &Transferred,
) -> Result<Vec<(String, f64)>, Error> {
    let after = Connected::new(made.mesh.clone()).map_err(|source| Error::NotManifold { part: 0, source })?;
    let scale = made.wavelength / 8.0;
    let variance = |mesh: &Connected<TriMesh>, inside: &FaceMap<bool>| roughness(mesh, inside, scale).variance;
    let sources: f64 = exemplars.iter().map(|e| variance(e.mesh, e.inside)).sum();
    let choices = &made.filled.choices;
    let mean = choices.iter().map(|c| c.distance).sum::<f64>() / choices.len().max(1) as f64;
    let mut figures = vec![
        ("wavelength", made.wavelength),
        ("fan", made.fan),
        ("filled", made.moved.len() as f64),
        ("source_vertices", made.source_vertices as f64),
        ("mismatch", mean),
        ("roughness_source", sources / exemplars.len().max(1) as f64),
        ("roughness_before", variance(mesh, target)),
        ("roughness", variance(&after, target)),
    ];
    let bands = ["gain_eighth", "gain_quarter", "gain_half", "gain_whole"];
    figures.extend(bands.into_iter().zip(made.gains));
    if let Some(banded) = made.banded {
        figures.extend([("patches", banded.patches as f64), ("band_mismatch", banded.mismatch)]);
    }
    Ok(figures.into_iter().map(|(name, value)| (name.to_string(), value)).collect())
}

/// Moved vertices are new; faces that one of them bounds are pieces of what they were.
fn origins(mesh: &Connected<TriMesh>, made: &Transferred) -> Origins {
    let mut origins = Origins::identity(0, mesh.vertex_count(), mesh.face_count());
    for &v in &made.moved {
        origins.vertices[v] = VertexOrigin::New { stage: STAGE };
        for h in mesh.ring(v) {
            origins.faces[h.face()] = FaceOrigin::Piece { part: 0, face: h.face() };
        }
    }
    origins
}

/// The first input's attributes on the new mesh. Normals of moved vertices are those of another surface.
fn dress(part: &Model, made: Transferred) -> Model {
    let mut model = Model { mesh: made.mesh, polygons: None, notes: vec![], ..part.clone() };
    if let Some(normals) = &mut model.normals {
        for f in model.mesh.face_ids() {
            for (k, v) in model.mesh.corners(f).into_iter().enumerate() {
                if made.moved.binary_search(&v).is_ok() {
                    normals[HalfedgeId::new(f, k)] = DVec3::NAN;
                }
            }
        }
    }
    model
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::{FaceId, shapes};
    use mesh_io::Groups;

    /// A wavy ball with a smooth cap, in a group of its own.
    fn capped() -> Model {
        let mut mesh = shapes::icosphere(1.0, 5);
        for p in &mut mesh.positions {
            if p.z < 0.8 {
                *p *= 1.0 + 0.012 * ((25.0 * p.x).sin() + (25.0 * p.y).sin() + (25.0 * p.z).sin());
            }
        }
        let high = |f: FaceId| mesh.triangle(f).iter().all(|p| p.z > 0.8);
        let of_face = mesh.face_ids().map(|f| u32::from(high(f))).collect::<Vec<_>>().into();
        let names = ["ball", "cap"].map(String::from).into();
        Model { groups: Some(Groups { of_face, names }), ..Model::from(mesh) }
    }

    fn params(intensity: f64) -> Params {
        Params {
            target: Region::Group("cap".into()),
            sources: vec![(0, Region::Group("ball".into()))],
            transfer: detail_transfer::Params {
                wavelength: Some(0.5),
                intensity: Some(intensity),
                ..detail_transfer::Params::default()
            },
            format: Format::Obj,
        }
    }

    #[test]
    fn a_smooth_cap_gets_the_detail_of_the_ball() {
        let ball = capped();
        let done = detail(std::slice::from_ref(&ball), &params(1.0), &Watch::default()).unwrap();
        let figure = |name: &str| done.report.figures[name];
        assert!(figure("roughness_before") < 0.3 * figure("roughness_source"), "{:?}", done.report.figures);
        let share = figure("roughness") / figure("roughness_source");
        assert!((0.8..1.2).contains(&share), "{:?}", done.report.figures);
        assert_eq!(done.report.validity.self_intersections, Some(0));
        assert_eq!((&done.model.groups, &done.model.mesh.faces), (&ball.groups, &ball.mesh.faces));
        for (v, origin) in done.origins.vertices.as_slice().iter().enumerate() {
            let same = done.model.mesh.positions[v] == ball.mesh.positions[v];
            assert!(same || matches!(origin, VertexOrigin::New { stage: "detail" }));
        }
        let kept = ball.mesh.positions.len() as f64 - figure("filled");
        assert_eq!(done.report.kept_vertices as f64, kept);
    }

    #[test]
    fn regions_that_are_not_there_are_refused() {
        let ball = capped();
        let missing = Params { target: Region::Group("hat".into()), ..params(1.0) };
        let detail = |p: &Params| detail(std::slice::from_ref(&ball), p, &Watch::default());
        assert!(matches!(detail(&missing), Err(Error::Region(_))));
        let missing = Params { sources: vec![(1, Region::Group("ball".into()))], ..params(1.0) };
        assert!(matches!(detail(&missing), Err(Error::Region(_))));
        // Nothing is left of a source that is the target.
        let same = Params { sources: vec![(0, Region::Group("cap".into()))], ..params(1.0) };
        assert!(matches!(detail(&same), Err(Error::Detail(detail_transfer::Error::Empty { which: "source" }))));
    }
}
