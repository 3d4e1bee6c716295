//! `run`: replays a recipe.

use crate::args::Run as Args;
use crate::failure::Failure;
use crate::options::Read;
use crate::session::{Destination, Session, counts};
use crate::shared_args::{Source, Target};
use fusion::{Error, Recipe};
use std::path::{Path, PathBuf};

/// Reads the recipe and its parts, takes its steps, and writes the result.
pub fn run(session: &Session, args: &Args) -> Result<(), Failure> {
    let name = args.recipe.display();
    let text = std::fs::read_to_string(&args.recipe)
        .map_err(|e| Failure::unreadable(format!("cannot read the recipe {name}: {e}")))?;
    let malformed = |e: &fusion::recipe::Error| Failure::unreadable(format!("{name}: {e}"));
    let mut recipe = Recipe::parse(&text).map_err(|e| malformed(&e))?;
    let folder = args.recipe.parent().unwrap_or(Path::new(""));
    recipe.load(&mut Read::beside(session, folder)).map_err(|e| malformed(&e))?;
    let output = args.output.clone().unwrap_or_else(|| folder.join(&recipe.output));
    let target = Target { output, to: args.to.clone(), origins: args.origins.clone() };
    let destination = Destination::check(&target, session)?;
    let paths: Vec<PathBuf> = recipe.parts.iter().map(|p| folder.join(&p.mesh)).collect();
    let models = session.read_all(&paths, &Source { from: None })?;
    let mut outcome = recipe.run(&models, destination.format, session.watch()).map_err(|error| match &error {
        Error::Recipe(e) => malformed(e),
        _ => Failure::of(&error, error.to_string()),
    })?;
    outcome.report.inputs = counts(&paths, &models);
    session.write(&destination, &outcome.model, Some(&outcome.origins), &outcome.report)
}
