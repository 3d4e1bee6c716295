//! Still pictures as bytes.

use crate::failure::Failure;
use crate::session::Session;
use fusion::mesh_core::TriMesh;
use fusion::render;
use std::fs;

/// A picture as the bytes of a PNG file.
pub fn draw(session: &Session, mesh: &TriMesh, params: &render::Params) -> Result<Vec<u8>, Failure> {
    let picture = render::picture(mesh, params, session.watch()).map_err(|e| match e {
        render::Error::Cancelled(_) => Failure::cancelled(),
        e => Failure::impossible(e),
    })?;
    // The renderer saves to files only; its place is taken by the output once everything has worked.
    let save = || -> Result<Vec<u8>, Box<dyn std::error::Error>> {
        let file = tempfile::Builder::new().suffix(".png").tempfile()?.into_temp_path();
        render::save(&picture, &file)?;
        Ok(fs::read(&file)?)
    };
    save().map_err(Failure::unwritable)
}
