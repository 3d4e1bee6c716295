//! Pictures of outputs, and of places where jobs failed.

use crate::batch::outcome::{Outcome, State};
use crate::failure::Failure;
use crate::page::failures::{EXAMPLES, by_reason};
use crate::picture::draw;
use crate::session::Session;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use fusion::mesh_core::{TriMesh, bounds, shapes};
use fusion::render;
use glam::{DQuat, DVec3};
use mesh_io::Format;
use std::collections::BTreeMap;
use std::path::Path;

/// Most pictures of outputs.
const OUTPUTS: usize = 36;
/// Largest file that is drawn, in bytes.
const LARGEST: u64 = 200_000_000;
/// How far outside of a mesh's box a place may lie that is its, and the radius of the ball that marks it, as shares of the box's diagonal.
const REACH: f64 = 0.05;
const BALL: f64 = 0.02;
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
        let mut files = job.outputs.iter().map(|o| folder.join(place).join(&o.file));
        if let Some(mesh) = files.find_map(|f| mesh(&f)) {
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
                let (marked, look) = mark(mesh, at);
                pictures.places.insert(job.id.clone(), source(session, &marked, &look)?);
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

/// The mesh with a ball at the place, and a view from its side.
fn mark(mut mesh: TriMesh, at: DVec3) -> (TriMesh, render::Params) {
    let bounds = bounds(&mesh);
    let out = (at - 0.5 * (bounds.min + bounds.max)).normalize_or_zero();
    let view = out + 0.35 * render::Params::default().view.normalize();
    let ball = shapes::posed(shapes::icosphere(BALL * bounds.diagonal(), 2), DQuat::IDENTITY, at);
    let mut color = vec![PLAIN; mesh.faces.len()];
    mesh.append(&ball);
    color.resize(mesh.faces.len(), MARKED);
    let color = render::Color::PerFace(color);
    (mesh, render::Params { width: 320, height: 320, view, color, ..render::Params::default() })
}

fn source(session: &Session, mesh: &TriMesh, look: &render::Params) -> Result<String, Failure> {
    Ok(format!("data:image/png;base64,{}", STANDARD.encode(draw(session, mesh, look)?)))
}
