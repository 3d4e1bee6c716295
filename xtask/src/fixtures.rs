//! The parts of all regression cases as files, to look at or to try the command line on.

use crate::regress::{cluster::polyhedra, posed_parts};
use crate::{Fault, models, root};
use mesh_io::Model;
use std::fs;
use std::path::PathBuf;

/// Where the models go.
#[derive(clap::Args)]
pub struct Options {
    /// The folder to fill
    #[arg(short, long, value_name = "DIR", default_value = "target/fixtures")]
    output: PathBuf,
}

/// Writes every part and every model of the documents as double-precision PLY, and every polyhedron as OBJ with its clusters beside it.
pub fn run(options: &Options) -> Result<(), Fault> {
    let folder = root().join(&options.output);
    fs::create_dir_all(&folder)?;
    let mut count = 0;
    for (name, parts) in posed_parts()? {
        for (i, mesh) in parts.into_iter().enumerate() {
            mesh_io::write(&Model::from(mesh), &folder.join(format!("{name}-{i}.ply")))?;
            count += 1;
        }
    }
    for (name, polyhedron, clusters) in polyhedra() {
        mesh_io::write(&polyhedron, &folder.join(format!("{name}.obj")))?;
        if let Some(clusters) = clusters {
            fs::write(folder.join(format!("{name}.toml")), clusters)?;
        }
        count += 1;
    }
    for (name, mesh) in models::all()? {
        mesh_io::write(&Model::from(mesh), &folder.join(format!("{name}.ply")))?;
        count += 1;
    }
    println!("fixtures: wrote {count} models to {}", folder.display());
    Ok(())
}
