//! `render`: a still picture.

use crate::args::{Color, Render as Args};
use crate::failure::Failure;
use crate::output::check_writable;
use crate::picture::draw;
use crate::session::{Session, counts};
use crate::text_file::read_text;
use fusion::{Report, render};
use serde_json::Value;
use std::path::Path;

/// Draws one mesh.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    if args.output.extension().is_none_or(|e| !e.eq_ignore_ascii_case("png")) {
        return Err(Failure::usage(format!("{} is no .png file; pictures are PNG only", args.output.display())));
    }
    check_writable(&args.output)?;
    let model = session.read(&args.mesh, &args.source)?;
    let mut report = Report::new("render", counts(std::slice::from_ref(&args.mesh), std::slice::from_ref(&model)));
    let color = match (args.color, &args.origins) {
        (None, None) => render::Color::Plain,
        (None | Some(Color::Origin), Some(path)) => render::Color::Origin(indices(path)?),
        (Some(Color::Origin), None) => {
            return Err(Failure::usage("--color origin needs the file that --origins wrote: --origins FILE.json"));
        }
        (Some(_), Some(_)) => return Err(Failure::usage("--origins goes with --color origin only")),
        (Some(Color::Curvature), _) => render::Color::Curvature,
        (Some(Color::Quality), _) => render::Color::Quality,
        (Some(Color::Zebra), _) => render::Color::Zebra,
    };
    let defaults = render::Params::default();
    let params = render::Params {
        width: args.size,
        height: args.size,
        view: args.view.unwrap_or(defaults.view),
        color,
        projection: if args.parallel { render::Projection::Orthographic } else { defaults.projection },
        wireframe: args.wireframe.then(render::Wireframe::default),
        ..defaults
    };
    let png = report.time("render", || draw(session, &model.mesh, &params))?;
    session.write_files(vec![(args.output.clone(), png)], &report)
}

/// A palette index per face, from a file of origins: the parts apart, and apart from what was made new.
fn indices(path: &Path) -> Result<Vec<u32>, Failure> {
    let index = |entry: &Value| match entry[0].as_str() {
        Some("new") => Some(fusion::palette_index(None)),
        Some(_) => entry[1].as_u64().map(|part| fusion::palette_index(Some(part as u32))),
        None => None,
    };
    read_text(path, |text| {
        let json: Value = serde_json::from_str(text).map_err(|e| e.to_string())?;
        let faces = json["faces"].as_array().ok_or("has no list of faces")?;
        let missing = || String::from("a face's entry is not as docs/report.md describes it");
        faces.iter().map(|entry| index(entry).ok_or_else(missing)).collect::<Result<_, String>>()
    })
}
