//! `demo`: the showcase models, made from nothing.

use crate::args::Demo as Args;
use crate::failure::Failure;
use crate::output::print;
use crate::picture::draw;
use crate::session::Session;
use fusion::mesh_core::{FaceOrigin, shapes};
use fusion::operation::{Boolean, Precision, SetOperation};
use fusion::{palette_index, render};
use glam::{DQuat, DVec3};
use mesh_io::{Format, Model};
use std::fs;

/// One model of the showcase.
struct Piece {
    name: &'static str,
    what: &'static str,
    parts: Vec<Model>,
    operation: SetOperation,
    radius: f64,
    view: DVec3,
}

/// Builds every piece and writes its model, report and picture.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    let folder = &args.output;
    fs::create_dir_all(folder)
        .map_err(|e| Failure::unwritable(format!("cannot make the folder {}: {e}", folder.display())))?;
    for piece in pieces() {
        let boolean = Boolean::default().with_operation(piece.operation).with_radius(piece.radius);
        let mut outcome = boolean
            .run(&piece.parts, Precision::F64, session.watch())
            .map_err(|e| Failure::of(&e, format!("{}: {e}", piece.name)))?;
        outcome.report.command = "demo".into();
        let color = outcome.origins.faces.as_slice().iter().map(|o| match *o {
            FaceOrigin::Input { part, .. } | FaceOrigin::Piece { part, .. } => palette_index(Some(part)),
            FaceOrigin::New { .. } => palette_index(None),
        });
        let look =
            render::Params { color: render::Color::Origin(color.collect()), view: piece.view, ..Default::default() };
        let png = draw(session, &outcome.model.mesh, &look)?;
        let ply = mesh_io::to_bytes(&outcome.model, Format::Ply).map_err(Failure::unwritable)?;
        let report = outcome.report.to_json().into_bytes();
        let files = [("ply", ply), ("json", report), ("png", png)];
        let files = files.map(|(kind, bytes)| (folder.join(format!("{}.{kind}", piece.name)), bytes));
        session.write_files(files.into(), &outcome.report)?;
        let milliseconds = outcome.report.milliseconds();
        let (faces, name) = (outcome.report.output.faces, folder.join(piece.name));
        print(&format!("{:<24} {faces:>7} triangles {milliseconds:>7.0} ms  {}\n", name.display(), piece.what))?;
    }
    print("Each .ply has a picture (.png) and a report (.json) beside it.\n")
}

fn pieces() -> Vec<Piece> {
    let at = |mesh, x, y, z| Model::from(shapes::posed(mesh, DQuat::IDENTITY, DVec3::new(x, y, z)));
    let lying =
        |mesh| Model::from(shapes::posed(mesh, DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2), DVec3::ZERO));
    vec![
        Piece {
            name: "blobs",
            what: "two organic blobs, joined with a fillet",
            parts: vec![
                at(shapes::blob(1.0, 5, 0.35, 7), 0.0, 0.0, 0.0),
                at(shapes::blob(0.75, 5, 0.35, 12), 1.05, 0.45, 0.2),
            ],
            operation: SetOperation::Union,
            radius: 0.16,
            view: DVec3::new(0.3, 0.45, 1.0),
        },
        Piece {
            name: "rods",
            what: "two crossing rods with a fillet",
            parts: vec![
                lying(shapes::cylinder(0.5, 3.2, 96, 64)),
                at(shapes::cylinder(0.36, 3.0, 96, 64), 0.013, 0.021, 0.0),
            ],
            operation: SetOperation::Union,
            radius: 0.15,
            view: DVec3::new(1.0, 0.7, 0.8),
        },
        Piece {
            name: "bitten",
            what: "a ball less a ball, the edge rounded",
            parts: vec![at(shapes::icosphere(1.0, 5), 0.0, 0.0, 0.0), at(shapes::icosphere(0.7, 5), 0.75, 0.45, 0.55)],
            operation: SetOperation::Difference,
            radius: 0.1,
            view: DVec3::new(0.9, 0.6, 1.0),
        },
    ]
}
