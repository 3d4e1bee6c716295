//! Repair: any mesh in, a solid out, or the reason why not.
//!
//! | file | holds |
//! |---|---|
//! | `step.rs` | the steps, each on its own |
//! | `work.rs` | a mesh between two steps: its origins, and what was counted |

mod step;
mod work;

pub use crate::repair_refusal::Refusal;
pub use step::Step;

use crate::diagnostic::Code;
use crate::outcome::{Outcome, finish_model};
use crate::validity::Promise;
use crate::{Error, extent};
use mesh_core::{Connected, Faces, TriMesh, Watch, boundary_loops};
use mesh_io::{Format, Model};
use work::Work;

/// How a mesh is repaired.
#[derive(Clone, Debug)]
pub struct Params {
    /// The steps, in the order in which they are done.
    pub steps: Vec<Step>,
    /// Whether a result with boundary loops is one.
    pub holes: Holes,
    /// The format the result is meant for, whose rounding it must survive.
    pub format: Format,
}

/// Whether a result with boundary loops is one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Holes {
    /// No: the result is a solid.
    #[default]
    Refused,
    /// Yes.
    Kept,
}

/// Does every step in order, and checks the result.
///
/// # Errors
/// [`Error::Repair`] where no solid comes out; [`Error::Invalid`] where the format cannot hold it, or rounding makes faces cross. Crossings are told, not refused.
pub fn repair(part: &Model, params: &Params, watch: &Watch) -> Result<Outcome, Error> {
    let mut work = Work::new("repair", part);
    let (mut measured, mut torn) = (false, 0);
    for &step in &params.steps {
        // Vertices at infinity are dropped before anything is measured.
        if !measured && !matches!(step, Step::Unusable | Step::Unused) {
            extent::check(std::slice::from_ref(&work.model))?;
            measured = true;
        }
        if step == Step::Split {
            torn = tangled_edges(&work.model.mesh);
        }
        work.step(step, watch)?;
    }
    let unfilled = work.report.diagnostics.iter().filter(|d| d.code == Code::HoleLeft).count();
    check(&work.model.mesh, params.holes, torn, unfilled)?;
    let Work { model, origins, report, .. } = work;
    finish_model(Promise::Repaired, model, origins, params.format, report, watch)
}

/// Edges with more than two faces, or whose two faces disagree.
fn tangled_edges(mesh: &TriMesh) -> usize {
    Connected::new(mesh).err().map_or(0, |e| e.edges.len() + e.misoriented.len())
}

/// Refuses what is no solid.
fn check(mesh: &TriMesh, holes: Holes, torn: usize, unfilled: usize) -> Result<(), Error> {
    if mesh.faces.is_empty() {
        return Err(Refusal::Nothing.into());
    }
    let connected = Connected::new(mesh).map_err(|source| Error::NotManifold { part: 0, source })?;
    let loops = boundary_loops(&connected);
    match loops.iter().max_by_key(|walk| walk.len()) {
        Some(longest) if holes == Holes::Refused => {
            let at = mesh.positions[mesh.corners(longest[0].face())[longest[0].corner()].index()];
            Err(Refusal::Open { loops: loops.len(), edges: longest.len(), at, torn, unfilled }.into())
        }
        _ => Ok(()),
    }
}

/// Does some steps in order and nothing else, whatever comes out: the short form of `convert`.
///
/// # Errors
/// [`Error::Cancelled`].
pub fn apply_steps(part: &Model, steps: &[Step], watch: &Watch) -> Result<Outcome, Error> {
    let mut work = Work::new("convert", part);
    for &step in steps {
        work.step(step, watch)?;
    }
    let Work { model, origins, mut report, .. } = work;
    let defects = mesh_core::validate(&model.mesh);
    report.validity.manifold = Some(defects.is_manifold());
    report.validity.closed = Some(defects.is_closed());
    report.describe(&model.mesh, &origins);
    Ok(Outcome { model, origins, report })
}

#[cfg(test)]
mod tests;
