//! Fairing: the surface that bends least, or whose bending changes least, within what is held.

use super::held::{Task, inner_areas};
use crate::{Error, Frozen};
use glam::DVec3;
use mesh_core::{Adjacency, Positions, VertexId, Watch};
use mesh_operators::{Laplacian, SparseRows};

/// What a fair surface minimises, and how smoothly it continues what is held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fairness {
    /// Its area, like a soap film: Δx = 0. Continues positions.
    Harmonic,
    /// Its bending, like a thin plate: Δ²x = 0. Continues tangent planes.
    #[default]
    Biharmonic,
    /// The variation of its bending: Δ³x = 0. Continues curvatures.
    Triharmonic,
}

/// How a surface is faired.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fairing {
    /// What is minimised.
    pub fairness: Fairness,
    /// How often the system is set up anew on the surface that it gave. One solves Δᵏx = 0 on the metric of the input;
    /// with more, the metric becomes that of the result.
    pub rounds: usize,
}

impl Default for Fairing {
    fn default() -> Self {
        Self { fairness: Fairness::default(), rounds: 1 }
    }
}

/// The vertices' places after fairing all that is not frozen (\[BotschFreeform2004\]).
///
/// The boundary of the mesh and what is frozen keep their bits. Two or three rings of held vertices around a region make it
/// meet them with their tangents or curvatures; at a boundary of the mesh nothing is there to be continued, and the
/// surface leaves it without bending. Each round solves one sparse system, O(n^1.5) for n free vertices. The same input gives the same bits for any
/// number of threads.
///
/// ```
/// use mesh_core::{Connected, Watch, shapes};
/// use remesh::{Fairing, Frozen, fair};
/// let mut dented = shapes::grid(1.0, 1.0, 20, 20);
/// dented.positions.iter_mut().for_each(|p| p.z = 0.3 * (0.09 - p.length_squared()).max(0.0));
/// let still = dented.positions.iter().map(|p| p.length() > 0.35).collect::<Vec<_>>();
/// let frozen = Frozen { vertices: still.into(), ..Frozen::default() };
/// let points = fair(&Connected::new(dented)?, &frozen, &Fairing::default(), &Watch::default())?;
/// assert!(points.iter().all(|p| p.z.abs() < 1e-12));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Singular`] where a connected piece of the surface is free as a whole, [`Error::NotFinite`], [`Error::Count`],
/// [`Error::IllConditioned`], [`Error::Cancelled`].
pub fn fair<M: Adjacency + Positions + Sync>(
    mesh: &M,
    frozen: &Frozen,
    fairing: &Fairing,
    watch: &Watch,
) -> Result<Vec<DVec3>, Error> {
    let mut task = Task::new(mesh, frozen)?;
    if let Some(v) = unheld(mesh, task.free()) {
        return Err(Error::Singular { at: mesh.position(v) });
    }
    let mut before = None;
    for round in 0..fairing.rounds {
        watch.step("fair", round as f64 / fairing.rounds as f64)?;
        if task.free().is_empty() {
            break;
        }
        let (laplacian, areas) = (Laplacian::cotangent(&task.moved), inner_areas(&task.moved));
        let further = match fairing.fairness {
            Fairness::Harmonic => 0,
            Fairness::Biharmonic => 1,
            Fairness::Triharmonic => 2,
        };
        let system = task.prepared(before.take(), |v, row| {
            laplacian.add_row(v, 1.0, row);
            for _ in 0..further {
                // Vertices of the boundary count for nothing, which lets the surface leave it without bending.
                SparseRows::add_up(row);
                for (n, x) in std::mem::take(row) {
                    let area = areas[n as usize];
                    if area > 0.0 {
                        laplacian.add_row(n, x / area, row);
                    }
                }
            }
        })?;
        system.solve(&mut task.moved.points, &[], 2);
        before = Some(system);
    }
    Ok(task.finish())
}

/// A free vertex that hangs together with no held one.
fn unheld<M: Adjacency>(mesh: &M, free: &[u32]) -> Option<VertexId> {
    let mut waiting = vec![false; mesh.vertex_count()];
    for &v in free {
        waiting[v as usize] = true;
    }
    for &start in free {
        if !std::mem::replace(&mut waiting[start as usize], false) {
            continue;
        }
        let (mut stack, mut held) = (vec![VertexId(start)], false);
        while let Some(v) = stack.pop() {
            for n in mesh.ring(v).map(|h| mesh.head(h)) {
                if std::mem::replace(&mut waiting[n.index()], false) {
                    stack.push(n);
                } else {
                    held |= free.binary_search(&n.0).is_err();
                }
            }
        }
        if !held {
            return Some(VertexId(start));
        }
    }
    None
}
