//! `info`: what a mesh is.

use crate::args::Info as Args;
use crate::failure::Failure;
use crate::output::print;
use crate::session::{Session, counts};
use fusion::{Info, Report};
use std::fmt::Write;

/// Measures one mesh and prints a table or JSON.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    let model = session.read(&args.mesh, &args.source)?;
    let paths = [args.mesh.clone()];
    let mut report = Report::new("info", counts(&paths, std::slice::from_ref(&model)));
    let info = report.time("measure", || Info::of(&model.mesh, session.watch())).map_err(|_| Failure::cancelled())?;
    report.warnings = model.notes.iter().map(ToString::to_string).collect();
    session.write_files(vec![], &report)?;
    if args.json {
        let json = serde_json::to_string_pretty(&info).map_err(Failure::impossible)?;
        print(&(json + "\n"))
    } else {
        print(&table(&args.mesh.display().to_string(), &info))
    }
}

fn table(name: &str, info: &Info) -> String {
    let mut text = format!("{name}\n");
    let mut row = |key: &str, value: String| {
        let _ = writeln!(text, "  {key:<20} {value}");
    };
    let known = |n: Option<String>| n.unwrap_or_else(|| "unknown: not a manifold".into());
    row("vertices", info.vertices.to_string());
    row("triangles", info.faces.to_string());
    row("edges", known(info.edges.map(|n| n.to_string())));
    row("components", info.components.to_string());
    row("boundary loops", known(info.boundary_loops.as_ref().map(|l| l.len().to_string())));
    for (id, l) in info.boundary_loops.iter().flatten().enumerate() {
        row(&format!("  loop {id}"), format!("{} edges, length {}, through {}", l.edges, l.length, place(l.at)));
    }
    row("genus", known(info.genus.map(|n| n.to_string())));
    if let (Some(low), Some(high)) = (info.lowest, info.highest) {
        row("box", format!("{} to {}", place(low), place(high)));
        row("diagonal", info.diagonal.to_string());
    }
    row("area", info.area.to_string());
    row("volume", info.volume.map_or_else(|| "unknown: not closed".into(), |v| v.to_string()));
    if let Some([min, mean, max]) = info.edge_lengths {
        row("edge lengths", format!("{min} shortest, {mean} mean, {max} longest"));
    }
    let state = match (info.manifold, info.closed) {
        (true, true) => "closed, oriented 2-manifold",
        (true, false) => "open, oriented 2-manifold",
        _ => "no oriented 2-manifold; `repair` may mend it",
    };
    row("validity", state.into());
    if let Some(n) = info.self_intersections {
        row("self-intersections", n.to_string());
    }
    for defect in &info.defects {
        let first: Vec<_> = defect.first.iter().map(ToString::to_string).collect();
        row("defect", format!("{} {}, first {}", defect.count, defect.kind, first.join("-")));
    }
    text
}

fn place([x, y, z]: [f64; 3]) -> String {
    format!("({x}, {y}, {z})")
}
