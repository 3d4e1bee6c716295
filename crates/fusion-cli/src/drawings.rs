//! What the stages of a blend draw, as files.

use crate::failure::Failure;
use crate::output::{self, Outputs};
use clap::Args;
use fusion::blend::Sketch;
use std::path::PathBuf;

/// Where drawings go.
#[derive(Args)]
pub struct Drawings {
    /// Write what the stages of the blend drew into this folder as OBJ files
    ///
    /// The path of the ball's centre, the contact curves, profiles, patches and surfaces, even where the blend is refused
    /// (docs/blend.md lists them).
    #[arg(long, value_name = "DIR", requires = "ball", hide_short_help = true)]
    debug_geometry: Option<PathBuf>,
}

impl Drawings {
    /// What to draw in, if drawings are wanted. Makes their folder before any work is done.
    pub fn sketch(&self) -> Result<Sketch, Failure> {
        let Some(folder) = &self.debug_geometry else { return Ok(Sketch::default()) };
        output::make_folder(folder)?;
        Ok(Sketch::new())
    }

    /// Writes what was drawn, whatever came of the blend, and passes that on.
    pub fn keep<T>(&self, sketch: &Sketch, result: Result<T, Failure>) -> Result<T, Failure> {
        let Some(folder) = &self.debug_geometry else { return result };
        let mut outputs = Outputs::default();
        for (name, bytes) in fusion::drawings_to_files(sketch) {
            outputs.add(folder.join(name), bytes);
        }
        let written = outputs.commit_after(|| Ok(()));
        result.and_then(|value| written.map(|()| value))
    }
}
