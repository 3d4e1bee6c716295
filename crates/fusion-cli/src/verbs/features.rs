//! `features`: the curves along which a surface turns sharply.

use crate::args::Features as Args;
use crate::failure::Failure;
use crate::output::{check_writable, print};
use crate::session::{Session, counts};
use fusion::blend::ListedRadius;
use fusion::features::{FeatureCurve, Params, feature_curves, point_within};
use fusion::mesh_core::{Connected, TriMesh};
use fusion::round::max_radius_of_each;
use fusion::{Report, convexity_word, list_curves};
use serde_json::json;
use std::fmt::Write;

/// Lists the feature curves of one mesh.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    if let Some(path) = &args.output {
        check_writable(path)?;
    }
    let model = session.read(&args.mesh, &args.source)?;
    let mut report = Report::new("features", counts(std::slice::from_ref(&args.mesh), std::slice::from_ref(&model)));
    let mesh = report.time("connect", || Connected::new(model.mesh)).map_err(Failure::impossible)?;
    let params = Params { angle: args.angle, ..Params::default() };
    let curves = report.time("features", || feature_curves(&mesh, &params));
    let limits = if args.no_radii {
        vec![None; curves.len()]
    } else {
        report
            .time("radii", || max_radius_of_each(&mesh, &curves, session.watch()))
            .map_err(|e| Failure::of(&e, e.to_string()))?
    };
    let json = || {
        let list = list_curves(&mesh, &curves, &limits);
        format!("{:#}\n", json!({ "version": 1, "angle": args.angle, "curves": list }))
    };
    let files = args.output.iter().map(|path| (path.clone(), json().into_bytes())).collect();
    session.write_files(files, &report)?;
    match (args.json, &args.output) {
        (true, _) => print(&json()),
        (false, Some(_)) => Ok(()),
        (false, None) => print(&table(&mesh, &curves, &limits)),
    }
}

fn table(mesh: &Connected<TriMesh>, curves: &[FeatureCurve], limits: &[Option<ListedRadius>]) -> String {
    let mut text = String::from("  id  edges        length  turn (degrees)  kind             largest radius  near\n");
    for (id, (curve, limit)) in curves.iter().zip(limits).enumerate() {
        let radius = limit.map_or("-".into(), |l| format!("{}{:.6}", if l.tried { "" } else { "<= " }, l.radius));
        let kind = format!("{}, {}", convexity_word(curve), if curve.closed { "closed" } else { "open" });
        let at = point_within(mesh, curve);
        let turn = format!("{:.1} to {:.1}", curve.angles[0], curve.angles[1]);
        let _ = writeln!(
            text,
            "{id:>4} {:>6} {:>13.6} {turn:>15}  {kind:<15}  {radius:>14}  {},{},{}",
            curve.halfedges.len(),
            curve.length,
            at.x,
            at.y,
            at.z
        );
    }
    text
}
