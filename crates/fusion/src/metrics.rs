//! What a blend did, in the report: figures, every curve, what is to be told.

use crate::blend::measure::{Curve, Measured, measure};
use crate::blend::{self, Blended, CurveBlend, Method};
use crate::choice::Source;
use crate::diagnostic::Diagnostic;
use crate::{CurveReport, Report};
use mesh_core::{Connected, HalfedgeId, Positions, TriMesh};
use profile_nurbs::Profile;

/// One chosen curve of a blend.
pub(crate) struct Part {
    pub source: Source,
    pub id: usize,
    pub halfedges: Vec<HalfedgeId>,
    /// Which of the curves given to the blend it is a part of.
    pub whole: usize,
    /// The radius asked for, in model units.
    pub radius: f64,
}

/// Notes in the report what a blend of `mesh` did to the chosen curves, and measures how well.
pub(crate) fn record(
    mesh: &Connected<TriMesh>,
    parts: &[Part],
    blended: &Blended,
    params: &blend::Params,
    report: &mut Report,
) {
    let curves: Vec<Curve<'_>> = parts.iter().map(|p| Curve { halfedges: &p.halfedges, radius: p.radius }).collect();
    let (measured, overall) = report.time("measure", || measure(mesh, &curves, blended));
    let is_round = params.profile == Profile::Arc
        && params.profile_at.is_empty()
        && params.reach.is_none()
        && params.radii.is_even()
        && params.radii.keys.is_empty();
    for (part, measured) in parts.iter().zip(&measured) {
        let made = blended.curves.get(part.whole).copied();
        report.curves.push(entry(mesh, part, made, measured, is_round));
    }
    if let Some(errors) = overall.filter(|_| is_round) {
        for (name, error) in ["ball_error_50", "ball_error_90", "ball_error_99"].into_iter().zip(errors) {
            let worst = report.figures.entry(name.into()).or_default();
            *worst = worst.max(error);
        }
    }
    if mesh_core::boundary_loops(mesh).is_empty() {
        *report.figures.entry("volume_changed".into()).or_default() += volume_changed(mesh, blended);
    }
    let smallest = blended.shrunk.iter().map(|s| s.1).fold(params.radius, f64::min);
    let smallest = report.curves.iter().map(|c| c.radius).filter(|&r| r > 0.0).fold(smallest, f64::min);
    let least = report.figures.entry("smallest_radius".into()).or_insert(smallest);
    *least = least.min(smallest);
    account(blended, params, report);
    tell_sharp(parts, blended, report);
    let total: f64 = report.curves.iter().map(|c| c.length).sum();
    let claims =
        |c: &CurveReport| c.full_share.unwrap_or(if c.method == Method::Sharp { 0.0 } else { blended.full_share });
    let full: f64 = report.curves.iter().map(|c| c.length * claims(c)).sum();
    let skipped = report.curves.iter().filter(|c| c.method == Method::Sharp).count();
    report.figures.insert("curves".into(), report.curves.len() as f64);
    report.figures.insert("skipped_curves".into(), skipped as f64);
    report.figures.insert("full_share".into(), if total > 0.0 { full / total } else { 0.0 });
}

fn entry(
    mesh: &Connected<TriMesh>,
    part: &Part,
    made: Option<CurveBlend>,
    measured: &Measured,
    is_round: bool,
) -> CurveReport {
    let length = part.halfedges.iter().map(|&h| mesh.edge_length(h)).sum();
    let made = made.unwrap_or(CurveBlend::sharp(length, None));
    let sharp = made.method == Method::Sharp;
    // Without a vertex of its own a blend is no wider than a facet: what the stages used is all there is to tell.
    let full = measured.full_share.unwrap_or(made.full_share * measured.blended_share);
    CurveReport {
        id: part.id,
        source: part.source,
        length,
        method: made.method,
        radius: made.radius,
        blended_share: if sharp { 0.0 } else { measured.blended_share },
        full_share: is_round.then_some(if sharp { 0.0 } else { full }),
        ball_error: measured.ball_error.filter(|_| is_round && !sharp),
        left_sharp: made.left_sharp.map(|(at, why)| (why.to_string(), at.to_array())),
    }
}

/// One warning for all curves that are left sharp for one reason.
fn tell_sharp(parts: &[Part], blended: &Blended, report: &mut Report) {
    let mut told: Vec<(blend::LeftSharp, glam::DVec3, usize, f64)> = vec![];
    for part in parts {
        let Some(curve) = blended.curves.get(part.whole) else { continue };
        let Some((at, why)) = curve.left_sharp else { continue };
        let length = report.curves.iter().rev().find(|c| c.id == part.id).map_or(0.0, |c| c.length);
        match told.iter_mut().find(|t| t.0 == why) {
            Some(known) => (known.2, known.3) = (known.2 + 1, known.3 + length),
            None => told.push((why, at, 1, length)),
        }
    }
    for (why, at, count, length) in told {
        report.tell(Diagnostic::left_sharp(at, count, length, &why.to_string()));
    }
}

/// Volume of the result less that of the mesh, from the faces that changed.
fn volume_changed(mesh: &Connected<TriMesh>, blended: &Blended) -> f64 {
    mesh_core::volume(&blended.mesh) - mesh_core::volume(mesh)
}

fn account(blended: &Blended, params: &blend::Params, report: &mut Report) {
    if blended.strips > 0 {
        let worst = report.residuals.entry("contact".into()).or_default();
        *worst = worst.max(blended.residual);
    }
    report.figures.insert("radius".into(), params.radius);
    let counts = [
        ("strips", blended.strips),
        ("fields", blended.fields),
        ("bridged", blended.bridged),
        ("corners", blended.corners),
        ("shrunk_places", blended.shrunk.len()),
        ("run_outs", blended.run_outs.len()),
    ];
    for (name, count) in counts {
        *report.figures.entry(name.into()).or_default() += count as f64;
    }
    if let blend::Surface::Keep(how) = &params.surface
        && how.levels > 0
    {
        report.figures.insert("levels".into(), blended.levels as f64);
        report.notes.push(match blended.levels {
            0 => "no coarser level served, so the blend was made on the mesh itself".into(),
            levels => format!(
                "the blend was made on level {levels} of a decimation hierarchy: vertices beside it that came back with their details moved with it"
            ),
        });
    }
    for &at in &blended.run_outs {
        report.tell(Diagnostic::run_out(at));
    }
    for &(at, what) in &blended.fallbacks {
        report.tell(Diagnostic::blended_as_field(at, what));
    }
    // The worst first: of many, the program shows these alone.
    let mut shrunk = blended.shrunk.clone();
    shrunk.sort_by(|a, b| a.1.total_cmp(&b.1));
    for (at, used) in shrunk {
        report.tell(Diagnostic::radius_reduced(at, params.radius, used));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use mesh_core::{FaceId, Origins};

    /// Two seams blended in turn: counts add up, the smallest radius is that of all, and every place has its sentence.
    #[test]
    fn blends_add_up_in_the_report() {
        let blended = |shrunk: &[(DVec3, f64)]| Blended {
            mesh: TriMesh::default(),
            origins: Origins::default(),
            first_blend_face: FaceId(0),
            strips: 1,
            fields: 1,
            corners: 0,
            residual: 1e-12,
            bridged: 2,
            shrunk: shrunk.to_vec(),
            fallbacks: vec![],
            run_outs: vec![DVec3::ZERO],
            levels: 0,
            full_share: 1.0,
            curves: vec![],
        };
        let mesh = Connected::new(TriMesh::default()).unwrap();
        let (params, mut report) = (blend::Params::new(0.5), Report::default());
        let mut add = |shrunk: &[(DVec3, f64)]| {
            record(&mesh, &[], &blended(shrunk), &params, &mut report);
            report.clone()
        };
        let figures = |report: &Report| ["strips", "smallest_radius", "shrunk_places"].map(|f| report.figures[f]);
        let first = add(&[]);
        assert_eq!((figures(&first), first.warnings.len()), ([1.0, 0.5, 0.0], 0));
        add(&[(DVec3::X, 0.25), (DVec3::Y, 0.35)]);
        let last = add(&[(DVec3::Z, 0.4)]);
        assert_eq!(figures(&last), [3.0, 0.25, 3.0]);
        assert_eq!((last.figures["run_outs"], last.notes.len(), last.diagnostics.len()), (3.0, 3, 6));
        let warnings = last.warnings.join("\n");
        assert!(["[1, 0, 0]: one of radius 0.25", "0.35", "0.4"].iter().all(|w| warnings.contains(w)), "{warnings}");
    }
}
