//! Pictures of outputs, and of places where jobs failed.

use crate::batch::outcome::{Outcome, State};
use crate::failure::Failure;
use crate::page::failures::{EXAMPLES, by_reason};
use crate::picture::draw;
use crate::session::Session;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use fusion::mesh_core::{TriMesh, bounds};
use fusion::render;
use glam::DVec3;
use mesh_io::Format;
use std::collections::BTreeMap;
use std::path::Path;

/// Most pictures of outputs.
const OUTPUTS: usize = 36;
/// Largest file that is drawn, in bytes.
const LARGEST: u64 = 200_000_000;
/// Around a place, as a share of the model's diagonal, faces are marked.
const REACH: f64 = 0.05;
const PLAIN: [f64; 3] = [0.72, 0.75, 0.8];
const MARKED: [f64; 3] = [0.9, 0.3, 0.1];

/// Sources of pictures, by job.
#[derive(Default)]
pub struct Pictures {
    /// What was made.
    pub outputs: BTreeMap<String, String>,
    /// Where it failed.
    pub places: BTreeMap<String, String>,
}

/// Draws what can be read; paths of outputs are relative to `folder`.
pub fn take(session: &Session, outcomes: &[Outcome], folder: &Path) -> Result<Pictures, Failure> {
    let mut pictures = Pictures::default();
    for job in outcomes.iter().filter(|o| o.state == State::Done) {
        if pictures.outputs.len() >= OUTPUTS {
            break;
        }
        let Some(place) = &job.folder else { continue };
        let files = job.outputs.iter().map(|o| folder.join(place).join(&o.file));
        if let Some(mesh) = files.filter_map(|f| mesh(&f)).next() {
            let look = render::Params { width: 220, height: 220, ..render::Params::default() };
            pictures.outputs.insert(job.id.clone(), source(session, &mesh, &look)?);
        }
    }
    for (_, jobs) in by_reason(outcomes) {
        for job in jobs.into_iter().take(EXAMPLES) {
            let at = job.diagnostics.iter().find_map(|d| serde_json::from_value::<[f64; 3]>(d["at"].clone()).ok());
            let Some(at) = at.map(DVec3::from) else { continue };
            let mut meshes = job.inputs.iter().filter_map(|f| mesh(Path::new(f)));
            if let Some(mesh) = meshes.find(|mesh| is_at(mesh, at)) {
                pictures.places.insert(job.id.clone(), source(session, &mesh, &look_at(&mesh, at))?);
            }
        }
    }
    Ok(pictures)
}

/// A mesh, if the file is one that can be read in reasonable time.
fn mesh(path: &Path) -> Option<TriMesh> {
    let small = std::fs::metadata(path).is_ok_and(|m| m.len() <= LARGEST);
    let model = (small && Format::from_path(path).is_ok()).then(|| mesh_io::read(path).ok()).flatten()?;
    (!model.mesh.faces.is_empty()).then_some(model.mesh)
}

/// Whether a place lies at a mesh: a part that the document moves is elsewhere.
fn is_at(mesh: &TriMesh, at: DVec3) -> bool {
    let bounds = bounds(mesh);
    let margin = DVec3::splat(REACH * bounds.diagonal());
    at.cmpge(bounds.min - margin).all() && at.cmple(bounds.max + margin).all()
}

/// A view from the side of the place, with the faces around it marked.
fn look_at(mesh: &TriMesh, at: DVec3) -> render::Params {
    let bounds = bounds(mesh);
    let reach = REACH * bounds.diagonal();
    let out = (at - 0.5 * (bounds.min + bounds.max)).normalize_or_zero();
    let view = out + 0.35 * render::Params::default().view.normalize();
    let near = |face: &[_; 3]| {
        let corners = face.map(|v: fusion::mesh_core::VertexId| mesh.positions[v.index()]);
        corners.iter().any(|p| p.distance(at) < reach) || (corners.iter().sum::<DVec3>() / 3.0).distance(at) < reach
    };
    let color = mesh.faces.iter().map(|face| if near(face) { MARKED } else { PLAIN }).collect();
    render::Params { width: 320, height: 320, view, color: render::Color::PerFace(color), ..render::Params::default() }
}

fn source(session: &Session, mesh: &TriMesh, look: &render::Params) -> Result<String, Failure> {
    Ok(format!("data:image/png;base64,{}", STANDARD.encode(draw(session, mesh, look)?)))
}
